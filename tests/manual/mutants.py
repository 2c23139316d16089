"""Changes of the core that no test notices.

`cargo mutants` lists the changes: an operator, a sign, the value of a function, a condition or an arm of a
match, a field. Instead of a build for each, those of some files are compiled together into one copy of the
core, each behind the number that the environment variable MUTANT has; a test program then takes seconds to
judge one. A constant with changes is a function in that copy. Left out is what does not compile: a type
without a default value, or the length of an array, which cannot look at a variable.
"""

import argparse
import collections
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tree_sitter_rust
from tree_sitter import Language, Node, Parser

ROOT = Path(__file__).resolve().parents[2]
CORE = ROOT / "crates" / "core" / "src"
OUTSIDE = b"".join(path.read_bytes() for path in (ROOT / "crates/core/tests").rglob("*.rs"))
# Campaigns that run side by side have a folder each.
WORK = Path(os.environ.get("MUTANTS_FOLDER", ROOT / "target" / "mutants"))
HOME = WORK / "core" / "crates" / "core"
LIVES = "LIVES"
SWITCH = """
#[doc(hidden)]
mod mutant {
    use std::sync::atomic::{AtomicU32, Ordering};
    static NUMBER: AtomicU32 = AtomicU32::new(0);
    #[inline(always)]
    pub fn number() -> u32 {
        NUMBER.load(Ordering::Relaxed)
    }
    extern "C" fn read() {
        let number = std::env::var("MUTANT").ok().and_then(|text| text.parse().ok());
        NUMBER.store(number.unwrap_or(0), Ordering::Relaxed);
    }
    // Before anything else runs, so that no look at the number needs a check.
    #[used]
    #[unsafe(link_section = ".init_array")]
    static READ: extern "C" fn() = read;
}
"""
SLOWER = 3
"""A test program may take so many times more of the processor's time than without a change."""
ASLEEP = 3600.0
"""Seconds by the clock after which a test program is taken to wait for ever."""
FEW = 200
"""So many changes are compiled together, from whichever folders they are."""
MOST = 6 << 30
"""Bytes that a test program may have, since a change can make it ask for more and more."""


@dataclass(frozen=True)
class Mutant:
    """A change: its number, what `cargo mutants` says of it, and the bytes of the file that it is about."""

    number: int
    name: str
    file: str
    genre: str
    replacement: str
    start: int
    end: int


def listed() -> list[Mutant]:
    """Give every change that `cargo mutants` knows of the core, in its order."""
    words = ["cargo", "mutants", "--list", "--json", "--package", "restitution-core"]
    found = json.loads(subprocess.run(words, cwd=ROOT, capture_output=True, check=True).stdout)
    lines = {
        file: (ROOT / file).read_text(encoding="utf-8").splitlines(keepends=True)
        for file in {m["file"] for m in found}
    }

    def place(file: str, at: dict[str, int]) -> int:
        before = "".join(lines[file][: at["line"] - 1]) + lines[file][at["line"] - 1][: at["column"] - 1]
        return len(before.encode())

    return [
        Mutant(
            number,
            one["name"],
            one["file"],
            one["genre"],
            one["replacement"],
            place(one["file"], one["span"]["start"]),
            place(one["file"], one["span"]["end"]),
        )
        for number, one in enumerate(found, 1)
    ]


class Switched:
    """A source file with changes behind switches."""

    def __init__(
        self, text: bytes, mutants: list[Mutant], elsewhere: dict[bytes, list[int]] | None = None
    ) -> None:
        self._text = text
        self._at: dict[int, list[Mutant]] = collections.defaultdict(list)
        self.placed: set[int] = set()
        self.constants: dict[bytes, list[int]] = collections.defaultdict(list)
        """The names of the constants that are functions now, with the numbers of their changes."""
        tree = Parser(Language(tree_sitter_rust.language())).parse(text)
        for mutant in mutants:
            node = self._node(tree.root_node, mutant)
            if node is None or self._is_opaque(node):
                continue
            name = self._constant_around(tree.root_node, node)
            if name is not None:
                # Those that the test programs use as well remain constants, and so do tables of words.
                if re.search(rb"\b%s\b" % name, OUTSIDE) or mutant.genre == "StructField":
                    continue
                self.constants[name].append(mutant.number)
            self._at[node.id].append(mutant)
            self.placed.add(mutant.number)
        self._calls = {**self._imported(tree.root_node, elsewhere or {}), **self.constants}
        self.text = self._rendered(tree.root_node)

    def _constant_around(self, root: Node, node: Node) -> bytes | None:
        """Give the name of the constant in whose value an expression is."""
        around: Node | None = node
        while around is not None and around.type not in ("const_item", "function_item"):
            around = around.parent
        # That of a type may differ from one parameter of it to another.
        if around is None or around.type == "function_item" or around.parent != root:
            return None
        name = around.child_by_field_name("name")
        return None if name is None else self._source(name)

    def _imported(self, root: Node, elsewhere: dict[bytes, list[int]]) -> dict[bytes, list[int]]:
        """Give those of the constants of other files that this one uses by their names."""
        uses = [self._source(node) for node in root.children if node.type == "use_declaration"]
        return {
            name: numbers
            for name, numbers in elsewhere.items()
            if any(re.search(rb"\b%s\b" % name, use) for use in uses)
        }

    def _node(self, root: Node, mutant: Mutant) -> Node | None:
        """Give the expression, or the body of the function, that a change is about."""
        # The comma after a field is not part of it.
        end = mutant.start if mutant.genre == "StructField" else mutant.end
        found = root.descendant_for_byte_range(mutant.start, end)
        kinds = {
            "BinaryOperator": ("binary_expression", "compound_assignment_expr"),
            "UnaryOperator": ("unary_expression",),
            "FnValue": ("function_item",),
            "MatchArm": ("match_arm",),
            "StructField": ("field_initializer", "shorthand_field_initializer"),
        }.get(mutant.genre, ())
        if mutant.genre == "MatchArmGuard":
            return found
        while found is not None and found.type not in kinds:
            found = found.parent
        return found

    def _is_opaque(self, node: Node) -> bool:
        """Whether a function returns a type without a name, of which it can give no other value."""
        returned = node.child_by_field_name("return_type")
        return returned is not None and b"impl " in self._source(returned)

    def _source(self, node: Node) -> bytes:
        return self._text[node.start_byte : node.end_byte]

    def _rendered(self, node: Node) -> bytes:
        """The text of a node, with the switches in it."""
        if node.type == "identifier" and self._source(node) in self._calls and not self._is_name(node):
            return self._called(node)
        if node.type == "const_item":
            return self._constant(node)
        mutants = self._at.get(node.id, [])
        plain = self._children(node)
        if not mutants:
            return plain
        names = b" ".join(b"%d" % one.number for one in mutants)
        if node.type == "function_item":
            body = node.child_by_field_name("body")
            assert body is not None
            head = self._children(node, until=body)
            early = b"".join(
                b"if crate::mutant::number() == %d { return %s; }"
                % (one.number, self._marked(one, one.replacement.encode()))
                for one in mutants
            )
            return head + b"{ " + early + self._rendered(body)[1:]
        if node.type == "match_arm":
            return self._without_arm(node, mutants[0])
        if node.type in ("field_initializer", "shorthand_field_initializer"):
            return self._without_field(node, mutants[0])
        arms = b"".join(
            b"%d => { %s } " % (one.number, self._marked(one, self._changed(node, one))) for one in mutants
        )
        whole = b"match crate::mutant::number() { %s _ => { %s } }" % (arms, plain)
        if node.type != "compound_assignment_expr":
            whole = b"(" + whole + b")"
        return b"/*[%s*/" % names + whole + b"/*]*/"

    @staticmethod
    def _is_name(node: Node) -> bool:
        """Whether an identifier is imported, not used."""
        around: Node | None = node
        while around is not None and around.type != "use_declaration":
            around = around.parent
        return around is not None

    def _called(self, node: Node) -> bytes:
        name = self._source(node)
        numbers = b" ".join(b"%d" % number for number in self._calls[name])
        return b"/*[%s*/%s()/*]*/" % (numbers, name)

    def _constant(self, node: Node) -> bytes:
        """A constant with changes as a function, which can look at a variable."""
        name, value = node.child_by_field_name("name"), node.child_by_field_name("value")
        kind = node.child_by_field_name("type")
        assert name is not None
        assert kind is not None
        numbers = self.constants.get(self._source(name))
        if value is None or numbers is None:
            return self._children(node)
        seen = self._source(node.children[0]) if node.children[0].type == "visibility_modifier" else b""
        words = seen, self._source(name), self._source(kind), self._rendered(value)
        marks = b" ".join(b"%d" % number for number in numbers)
        return b"/*[%s*/" % marks + b"%s fn %s() -> %s { %s }" % words + b"/*]*/"

    def _without_arm(self, node: Node, one: Mutant) -> bytes:
        """An arm that is left out behind its switch, by another guard."""
        pattern = node.child_by_field_name("pattern")
        assert pattern is not None
        guard = pattern.child_by_field_name("condition")
        bare = self._text[node.start_byte : pattern.end_byte]
        also = b""
        if guard is not None:
            bare = self._text[node.start_byte : guard.start_byte].rstrip().removesuffix(b"if")
            also = b" && (" + self._rendered(guard) + b")"
        here = b"crate::mutant::number() != %d" % one.number
        parts, at = [], pattern.end_byte
        for child in node.children:
            if child.start_byte >= pattern.end_byte:
                parts += [self._text[at : child.start_byte], self._rendered(child)]
                at = child.end_byte
        return bare + b" if " + self._marked(one, here) + also + b" " + b"".join(parts)

    def _without_field(self, node: Node, one: Mutant) -> bytes:
        """A field that behind its switch is that of the structure from which the others come."""
        assert node.parent is not None
        bases = (other for other in node.parent.children if other.type == "base_field_initializer")
        base = self._source(next(bases)).removeprefix(b"..")
        value = node.child_by_field_name("value")
        name = self._source(node.children[0])
        given = name if value is None else self._rendered(value)
        other = self._marked(one, b"(" + base + b")." + name)
        text = b"match crate::mutant::number() { %d => %s, _ => %s }" % (one.number, other, given)
        return b"/*[%d*/" % one.number + name + b": " + text + b"/*]*/"

    def _children(self, node: Node, until: Node | None = None) -> bytes:
        parts, at = [], node.start_byte
        for child in node.children:
            if until is not None and child.start_byte >= until.start_byte:
                break
            parts += [self._text[at : child.start_byte], self._rendered(child)]
            at = child.end_byte
        return b"".join(parts) + self._text[at : node.end_byte if until is None else until.start_byte]

    def _changed(self, node: Node, one: Mutant) -> bytes:
        before, after = self._text[node.start_byte : one.start], self._text[one.end : node.end_byte]
        return before + one.replacement.encode() + after

    @staticmethod
    def _marked(one: Mutant, text: bytes) -> bytes:
        return b"/*[%d*/" % one.number + text + b"/*]*/"


def compile_all(mutants: list[Mutant], tests: list[str], vectors: bool) -> tuple[list[Path], list[Mutant]]:
    """Give those test programs, all if none is named, and the changes that they hold."""
    sources = WORK / "core"
    shutil.rmtree(sources, ignore_errors=True)
    shutil.copytree(ROOT / "crates" / "core", sources / "crates" / "core")
    shutil.copy(ROOT / "Cargo.lock", sources)
    plan = (ROOT / "Cargo.toml").read_text(encoding="utf-8")
    plan = re.sub(r"members = .*", 'members = ["crates/core"]', plan)
    plan = plan.replace('opt-level = 2\ndebug = "line-tables-only"', "opt-level = 1\ndebug = false")
    (sources / "Cargo.toml").write_text(plan, encoding="utf-8")
    kept = {one.number: one for one in mutants}
    by_file: dict[str, list[Mutant]] = collections.defaultdict(list)
    for one in mutants:
        by_file[one.file].append(one)
    while True:
        texts = {str(path.relative_to(ROOT)): path.read_bytes() for path in CORE.rglob("*.rs")}
        ours = {file: [one for one in by_file[file] if one.number in kept] for file in texts}
        constants: dict[bytes, list[int]] = collections.defaultdict(list)
        for file, text in texts.items():
            for name, numbers in Switched(text, ours[file]).constants.items():
                constants[name] += numbers
        for file, text in texts.items():
            switched = Switched(text, ours[file], constants)
            for one in ours[file]:
                if one.number not in switched.placed:
                    del kept[one.number]
            (sources / file).write_bytes(_plain(switched.text, vectors))
        lib = (ROOT / "crates/core/src/lib.rs").read_bytes()
        (sources / "crates/core/src/lib.rs").write_bytes(_plain(lib, vectors) + SWITCH.encode())
        refused = set(_refused(sources))
        print(f"{len(kept)} changes, {len(refused & set(kept))} of them do not compile", flush=True)
        if not refused & set(kept):
            break
        for number in refused:
            kept.pop(number, None)
    words = [
        "cargo",
        "test",
        "--no-run",
        "--offline",
        "--message-format=json",
        "--package",
        "restitution-core",
        *(word for test in tests for word in (["--lib"] if test == "lib" else ["--test", test])),
    ]
    built = subprocess.run(words, cwd=sources, stdout=subprocess.PIPE, check=True, env=_environment())
    told = map(json.loads, built.stdout.splitlines())
    return [Path(one["executable"]) for one in told if one.get("executable")], list(kept.values())


def _plain(text: bytes, vectors: bool) -> bytes:
    """Without what would make the build long: inlining, and, unless they are asked for, vectors.

    Inlined everywhere, every change would be compiled a hundred times.

    Vectors are four doubles in a row, with any instructions: functions that are not inlined would not be
    compiled for those of a level.
    """
    text = text.replace(b"#[inline(always)]", b"#[inline]").replace(b"#![forbid(unsafe_code)]", b"")
    if vectors:
        four = b"Some(Simd::vectorize(pulp::Scalar256b, work)),"
        text = re.sub(rb"V3::try_new\(\)\.map\(.*?work\)\),", four, text)
    return re.sub(rb"V[34]::try_new\(\)\.map\(.*?work\)\),", b"None,", text)


def _environment() -> dict[str, str]:
    return os.environ | {
        "CARGO_TARGET_DIR": str(WORK / "build"),
        "RUSTFLAGS": "-Awarnings -Aarithmetic-overflow -Ctarget-cpu=native",
    }


def _refused(sources: Path) -> Iterator[int]:
    """Give the numbers of the changes in which the compiler finds errors."""
    words = [
        "cargo",
        "check",
        "--lib",
        "--profile",
        "test",
        "--offline",
        "--message-format=json",
        "--package",
        "restitution-core",
    ]
    done = subprocess.run(words, cwd=sources, capture_output=True, check=False, env=_environment())
    errors = 0
    for line in done.stdout.splitlines():
        told = json.loads(line)
        message = told.get("message") or {}
        if told["reason"] != "compiler-message" or message["level"] != "error":
            continue
        errors += 1
        numbers = [
            number for span in message["spans"] for number in _around(sources / span["file_name"], span)
        ]
        yield from numbers
        if not numbers and message["spans"]:
            print(message["rendered"], flush=True)
    if done.returncode and not errors:
        raise RuntimeError(done.stderr.decode())


def _around(file: Path, span: dict[str, Any]) -> list[int]:
    """Give the numbers of the innermost switch or arm of one around a place."""
    text = file.read_bytes()[: span["byte_start"]]
    depth = 0
    for mark in reversed(list(re.finditer(rb"/\*\[([\d ]+)\*/|/\*\]\*/", text))):
        if mark[1] is None:
            depth += 1
        elif depth:
            depth -= 1
        else:
            return [int(number) for number in mark[1].split()]
    return []


def ran(program: Path, number: int, limit: float) -> tuple[int, float]:
    """Run a test program with a change, 0 for none; give its exit status and the processor's seconds."""
    env = os.environ | {"MUTANT": str(number), "PROPTEST_MAX_SHRINK_ITERS": "0"}
    env["RUSTC_BOOTSTRAP"] = "1"  # for --fail-fast
    words = [str(program), "-q", "-Zunstable-options", "--fail-fast"]
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    child = subprocess.Popen(words, cwd=HOME, env=env, **quiet)
    # Its own time: the clock's goes on where the machine is busy or the campaign stopped.
    resource.prlimit(child.pid, resource.RLIMIT_CPU, (round(limit), round(limit) + 1))
    resource.prlimit(child.pid, resource.RLIMIT_AS, (MOST, MOST))
    alarm = threading.Timer(ASLEEP, child.kill)
    alarm.start()
    _, status, used = os.wait4(child.pid, 0)
    alarm.cancel()
    child.returncode = os.waitstatus_to_exitcode(status)
    return child.returncode, used.ru_utime + used.ru_stime


def timed_alone(program: Path) -> float:
    """Run a test program without a change, with which it must pass; give its seconds."""
    status, seconds = ran(program, 0, ASLEEP)
    if status:
        raise RuntimeError(f"{program} fails without any change: {status}")
    return seconds


def judge(programs: list[tuple[float, Path]], number: int) -> str:
    """Say which test program notices a change, or that none does."""
    for seconds, program in programs:
        status, _ = ran(program, number, SLOWER * seconds + 5)
        name = program.stem.rpartition("-")[0]
        if status in (-signal.SIGXCPU, -signal.SIGKILL):
            return f"{name}, which goes on for ever"
        if status != 0:
            return name
    return LIVES


def before(outcomes: Path) -> dict[str, str]:
    """Give what noticed the changes that were tried before, by their names."""
    lines = outcomes.read_text(encoding="utf-8").splitlines() if outcomes.exists() else []
    return {name: found for found, _, name in (line.partition("\t") for line in lines)}


def main() -> None:
    """Try a part of the changes, folder by folder; tell what noticed each, or that it lives."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--shard", default="0/1", help="0/8 takes every eighth change")
    parser.add_argument("--tests", default="", help="which of crates/core/tests to ask, as lib,flight")
    parser.add_argument("files", nargs="*", help="words of the paths of the files that are changed")
    parser.add_argument("--vectors", action="store_true", help="four lanes as well as one")
    parser.add_argument("--go-on", action="store_true", help="keep outcomes.txt, and try what it lacks")
    asked = parser.parse_args()
    wanted = [one for one in listed() if not asked.files or any(word in one.file for word in asked.files)]
    random.Random(1).shuffle(wanted)
    first, _, count = asked.shard.partition("/")
    chosen = wanted[int(first) :: int(count)]
    WORK.mkdir(parents=True, exist_ok=True)
    outcomes = WORK / "outcomes.txt"
    if not asked.go_on:
        outcomes.unlink(missing_ok=True)
    known = before(outcomes)
    chosen = [one for one in chosen if one.name not in known]

    few = len(chosen) <= FEW

    def folder(one: Mutant) -> str:
        return "all" if few else str(Path(*Path(one.file).parts[3:-1][:1]))

    # More changes in one build would take the compiler longer than two builds.
    groups = sorted(set(map(folder, chosen)))
    with outcomes.open("a", encoding="utf-8") as out:
        for group in groups:
            ours = [one for one in chosen if folder(one) == group]
            tests = [test for test in asked.tests.split(",") if test]
            programs, mutants = compile_all(ours, tests, asked.vectors)
            # The digests last: they tell that bits have changed, not which of the two is wrong.
            timed = sorted(
                ((timed_alone(program), program) for program in programs),
                key=lambda one: (one[1].name.startswith("digest-"), one[0]),
            )
            print(
                group, *(f"{program.stem.rpartition('-')[0]} {seconds:.1f} s" for seconds, program in timed)
            )
            for one in mutants:
                print(f"{judge(timed, one.number)}\t{one.name}", file=out, flush=True)
    tried = before(outcomes)
    lives = sum(found == LIVES for found in tried.values())
    print(f"{len(tried)} of {len(wanted)} changes tried, {lives} live: {outcomes}")


if __name__ == "__main__":
    main()
