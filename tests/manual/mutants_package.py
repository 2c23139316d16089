"""Changes of the package's Python code that no test notices.

`mutmut` makes the changes; its own way of running them leaves out every function that is decorated, and what
other processes do. Here each change is a file of its own, in a copy of the package that comes first in the
path, and `mutants_judge.py` runs the tests that are about it.
"""

import argparse
import difflib
import json
import math
import os
import random
import shutil
import sys
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from pathlib import Path

import libcst
import pytest
from libcst.metadata import MetadataWrapper
from mutants_judge import Judge
from mutmut.mutation.file_mutation import MutationVisitor
from mutmut.mutation.mutators import mutation_operators
from mutmut.mutation.pragma_handling import IgnoredCode

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "target" / "mutants" / "package"
OUTCOMES = WORK.with_suffix(".txt")
BODIES = tuple(f"bodies/_{name}.py" for name in ("body", "dumbbell", "loaded_sphere", "pair", "spheroid"))
FIRST_IMPACT = tuple(
    f"analytic/_{name}.py"
    for name in (
        *("branched", "curve", "disc", "first_impact", "frozen", "hull", "impact_from_rest", "impulse"),
        *("normal", "orientation", "pair", "panels", "threshold", "tilt"),
    )
)
FIRST_IMPACT_TESTS = (
    "test_analytic.py",
    "test_analytic_manners.py",
    "test_first_impact_derived.py",
    "test_first_impact_manners.py",
    "test_first_impact_materials.py",
    "test_first_impact_panels.py",
    "test_first_impact_simulated.py",
)
LAWS = ("laws/_law.py", "laws/_materials.py")
FITS = tuple(
    f"fit/_{name}.py" for name in ("asymmetric", "bootstrap", "clusters", "counts", "families", "mixture")
)
FIT_TESTS = (
    "test_fit.py",
    "test_fit_clusters.py",
    "test_fit_counts.py",
    "test_fit_dependence.py",
    "test_fit_flanks.py",
    "test_fit_manners.py",
    "test_fit_references.py",
    "test_fit_slopes.py",
)
SLOPES = tuple(f"fit/_{name}.py" for name in ("dependence", "judgement", "result", "slopes", "source"))
FLIGHT = tuple(
    f"flight/_{name}.py"
    for name in (
        *("chain", "clock", "drag", "fit", "law_fit", "laws"),
        *("problem", "restitution", "series", "setting", "times"),
    )
)
FLIGHT_TESTS = (
    *("test_flight.py", "test_flight_fit.py", "test_flight_references.py", "test_flight_times.py"),
    *("test_parts_of_datasets.py", "test_selected.py"),
)
BUDGET = tuple(
    f"budget/_{name}.py"
    for name in ("error_budget", "experiment", "near_round", "required", "results", "sources")
)
INFERENCE = tuple(
    f"inference/_{name}.py" for name in ("family", "likelihood", "posterior", "series", "table")
)
TESTS = {
    "_files.py": ("test_files.py", "test_files_errors.py", "test_files_words.py"),
    "_drafts.py": ("test_drafts.py", "test_files.py", "test_files_signals.py"),
    "_signals.py": ("test_signals.py", "test_undisturbed.py"),
    "study/_store.py": ("test_study_store.py", "test_study_create.py"),
    "study/_create.py": ("test_study_store.py", "test_study_create.py"),
    "study/_identity.py": ("test_study_merge.py",),
    "study/_layout.py": ("test_study_merge.py",),
    "study/_merge.py": ("test_study_merge.py",),
    "study/_status.py": ("test_study_merge.py",),
    "study/_folder.py": ("test_study_spoilt.py",),
    "distribution/_store.py": ("test_distribution_store.py", "test_distribution_errors.py"),
    "distribution/_errors.py": ("test_distribution_errors.py",),
    "distribution/_nodes.py": ("test_distribution_nodes.py",),
    "distribution/_check.py": (
        "test_distribution_nodes.py",
        "test_distribution_ensemble.py",
        "test_distribution_pilot.py",
    ),
    "distribution/_table.py": ("test_distribution_table.py",),
    "distribution/_ensemble.py": ("test_distribution_ensemble.py", "test_distribution_pilot.py"),
    "distribution/_pilot.py": ("test_distribution_ensemble.py", "test_distribution_pilot.py"),
    "distribution/_count.py": ("test_distribution_ensemble.py", "test_distribution_pilot.py"),
    "distribution/_learn.py": ("test_distribution_ensemble.py", "test_distribution_pilot.py"),
    "_reading.py": ("test_reading.py",),
    "_formats.py": ("test_reading.py",),
    "_dataset.py": (
        "test_dataset.py",
        "test_columns.py",
        "test_given_files.py",
        "test_release.py",
        "test_limits.py",
    ),
    "_reduce.py": ("test_statistics.py", "test_standard_errors.py"),
    "_batches.py": ("test_statistics.py", "test_standard_errors.py"),
    "_energy.py": ("test_energy.py",),
    "_statistics.py": ("test_streaming.py", "test_statistics.py", "test_standard_errors.py"),
    "study/_point.py": ("test_study_point.py", "test_study.py", "test_study_forms.py"),
    **dict.fromkeys(BUDGET, ("test_budget_references.py", "test_budget.py")),
    "_compare.py": ("test_compare.py",),
    **dict.fromkeys(BODIES, ("test_bodies.py", "test_objects.py")),
    **dict.fromkeys(FIRST_IMPACT, FIRST_IMPACT_TESTS),
    "analytic/_near_round.py": ("test_near_round.py",),
    **dict.fromkeys(LAWS, ("test_laws_materials.py",)),
    **dict.fromkeys(FITS + SLOPES, FIT_TESTS),
    **dict.fromkeys(FLIGHT, FLIGHT_TESTS),
    **dict.fromkeys(
        INFERENCE, ("test_inference_tree.py", "test_inference.py", "test_inference_references.py")
    ),
    "_trajectory.py": ("test_trajectory.py",),
}
"""What reads and writes files, handles signals, or works out numbers, and the tests that are about it."""


class _Changes(MutationVisitor):
    """Those of `mutmut`, and those of functions that are decorated."""

    def __init__(self) -> None:
        super().__init__(mutation_operators, IgnoredCode(set(), set(), set()))

    def _skip_node_and_children(self, node: libcst.CSTNode) -> bool:
        if isinstance(node, libcst.FunctionDef) and node.decorators:
            return False
        return super()._skip_node_and_children(node)


def changes(source: str) -> Iterator[tuple[str, Callable[[], str]]]:
    """Yield the function or method that a change is in, and what gives the source with it.

    What is outside of functions is no behaviour. Of words, a change of only the case of letters is left out.
    """
    wrapper = MetadataWrapper(libcst.parse_module(source))
    visitor = _Changes()
    wrapper.visit(visitor)
    names: dict[libcst.CSTNode | None, str] = {}
    for node in wrapper.module.body:
        inner = node.body.body if isinstance(node, libcst.ClassDef) else [node]
        above = f"{node.name.value}." if isinstance(node, libcst.ClassDef) else ""
        names |= {one: above + one.name.value for one in inner if isinstance(one, libcst.FunctionDef)}
    for one in visitor.mutations:
        function = names.get(one.contained_by_top_level_function)
        if function is not None and not _is_repeated(one.original_node, one.mutated_node):
            yield function, partial(_changed, wrapper.module, one.original_node, one.mutated_node)


def _is_repeated(old: libcst.CSTNode, new: libcst.CSTNode) -> bool:
    if isinstance(old, libcst.SimpleString) and isinstance(new, libcst.SimpleString):
        return old.value.lower() == new.value.lower()
    return False


def _changed(module: libcst.Module, old: libcst.CSTNode, new: libcst.CSTNode) -> str:
    changed = module.deep_replace(old, new)
    assert isinstance(changed, libcst.Module)
    return str(changed.code)


def module_of(file: str) -> str:
    """Name a module of the package by its path."""
    return f"restitution.{file.removesuffix('.py').replace('/', '.')}"


def difference(source: str, changed: str) -> str:
    """Give the lines that differ, without their numbers."""
    lines = difflib.unified_diff(source.splitlines(), changed.splitlines(), lineterm="", n=0)
    return "\n".join(line for line in list(lines)[2:] if not line.startswith("@@"))


def campaign(judge: Judge, names: list[str], asked: argparse.Namespace, known: dict[str, str]) -> int:
    """Try the changes of files; return how many live."""
    lived = 0
    with OUTCOMES.open("a", encoding="utf-8") as outcomes:
        for name in names:
            file = WORK / "restitution" / name
            source = file.read_text(encoding="utf-8")
            module = import_module(module_of(name))
            functions = [word.partition(":")[2] for word in asked.only]
            asked_for = [one for one in changes(source) if all(word in one[0] for word in functions)]
            every = [one for one in asked_for if judge.reaching(module, one[0])]
            draw = len(every) if asked.draw is None else min(asked.draw, len(every))
            chosen = random.Random(asked.seed).sample(every, draw)
            alive = 0
            for function, change in chosen:
                changed = change()
                what = difference(source, changed)
                key = f"{name} {function}\n{what}"
                found = known.get(key)
                if not found:
                    file.write_text(changed, encoding="utf-8")
                    found = judge.noticed(module, function, changed)
                    print(json.dumps([key, found]), file=outcomes, flush=True)
                if not found:
                    alive += 1
                    print(f"{key}\n", file=sys.__stdout__, flush=True)
            file.write_text(source, encoding="utf-8")
            told = f"{name}: {len(chosen)} of {len(asked_for)} changes tried, {alive} live; "
            told += f"{len(asked_for) - len(every)} are in functions that these tests do not reach"
            print(told, file=sys.__stdout__, flush=True)
            lived += alive
    return lived


def main() -> int:
    """Say which changes live."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draw", type=int, help="so many of each file, drawn evenly")
    parser.add_argument("--seed", type=int, default=0, help="another draw")
    parser.add_argument("--go-on", action="store_true", help="leave out what a test has noticed before")
    parser.add_argument(
        "--enough",
        type=float,
        default=math.inf,
        help="so many seconds of tests about a change; go on without",
    )
    parser.add_argument("only", nargs="*", help="words of paths, or _store.py:read for a function")
    asked = parser.parse_args()
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)
    ignore = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "python" / "restitution", WORK / "restitution", ignore=ignore)
    shutil.copytree(ROOT / "tests", WORK / "tests", ignore=ignore)
    shutil.copy(ROOT / "pyproject.toml", WORK)
    for read in ("benchmarks", "docs", "examples"):
        (WORK / read).symlink_to(ROOT / read)
    known: dict[str, str] = {}
    if asked.go_on and OUTCOMES.exists():
        known = dict(json.loads(line) for line in OUTCOMES.read_text(encoding="utf-8").splitlines())
    elif OUTCOMES.exists():
        OUTCOMES.unlink()
    os.chdir(WORK)
    os.environ |= {"PYTHONPATH": str(WORK), "PYTHONDONTWRITEBYTECODE": "1"}
    sys.path.insert(0, str(WORK))
    sys.dont_write_bytecode = True
    lived, chosen = 0, 0
    for tests in dict.fromkeys(TESTS.values()):
        names = [
            name
            for name, own in TESTS.items()
            if own == tests and all(word.partition(":")[0] in name for word in asked.only)
        ]
        if not names:
            continue
        chosen += len(names)
        counted: list[int] = []
        child = os.fork()  # whose pytest can be loaded once
        if child == 0:

            def work(judge: Judge, names: list[str] = names, counted: list[int] = counted) -> None:
                counted.append(campaign(judge, names, asked, known))

            judge = Judge(list(map(module_of, names)), work, asked.enough)
            options = ["-q", "-s", "-p", "no:cacheprovider", "--basetemp", str(WORK / "tmp")]
            pytest.main([*options, *(f"tests/{test}" for test in tests)], plugins=[judge])
            os._exit(min(counted[0], 1) if counted else 2)
        lived = max(lived, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    if not chosen:
        print(f"no file that is tried has all of these words in its path: {' '.join(asked.only)}")
        return 2
    return lived


if __name__ == "__main__":
    sys.exit(main())
