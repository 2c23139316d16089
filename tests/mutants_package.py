"""Changes of the package's Python code that no test notices.

`mutmut` makes the changes; its own way of running them leaves out every function that is decorated, and what
other processes do. Here each change is a file of its own, in a copy of the package that comes first in the
path, and a process that was forked for it runs the tests that are about it.
"""

import argparse
import difflib
import os
import random
import resource
import shutil
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import libcst
from libcst.metadata import MetadataWrapper
from mutmut.mutation.file_mutation import MutationVisitor
from mutmut.mutation.mutators import mutation_operators
from mutmut.mutation.pragma_handling import IgnoredCode

ROOT = Path(__file__).resolve().parents[1]
WORK = ROOT / "target" / "mutants" / "package"
TESTS = {
    "_files.py": ("test_files.py", "test_believed.py"),
    "_signals.py": ("test_signals.py",),
    "study/_identity.py": ("test_study_merge.py",),
    "study/_merge.py": ("test_study_merge.py",),
    "study/_status.py": ("test_study_merge.py",),
    "study/_store.py": ("test_study_store.py",),
    "distribution/_store.py": ("test_believed.py", "test_distribution_contract.py"),
}
"""What reads and writes files or handles signals, and the tests that are about it."""
PATIENCE = 10
"""A test may take so many times longer than without a change, and a minute besides."""


class _Changes(MutationVisitor):
    """Those of `mutmut`, and those of functions that are decorated."""

    def __init__(self) -> None:
        super().__init__(mutation_operators, IgnoredCode(set(), set(), set()))

    def _skip_node_and_children(self, node: libcst.CSTNode) -> bool:
        if isinstance(node, libcst.FunctionDef) and node.decorators:
            return False
        return super()._skip_node_and_children(node)


def changes(source: str) -> Iterator[str]:
    """Yield the source with one change each."""
    wrapper = MetadataWrapper(libcst.parse_module(source))
    visitor = _Changes()
    wrapper.visit(visitor)
    for one in visitor.mutations:
        changed = wrapper.module.deep_replace(one.original_node, one.mutated_node)
        assert isinstance(changed, libcst.Module)
        yield changed.code


def notices(tests: tuple[str, ...], seconds: float) -> bool:
    """Whether the tests fail, or do not end in time."""
    child = os.fork()
    if child == 0:
        os.setpgid(0, 0)
        null = os.open(os.devnull, os.O_RDWR)
        for number in (0, 1, 2):
            os.dup2(null, number)
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds)))
        import pytest

        os._exit(
            int(pytest.main(["-x", "-q", "-p", "no:cacheprovider", *(f"tests/{test}" for test in tests)]))
        )
    until = time.monotonic() + 3 * seconds  # what sleeps takes no time of a core
    while time.monotonic() < until:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return status != 0
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return True


def main() -> int:
    """Say which changes live."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draw", type=int, help="so many of each file, drawn evenly")
    parser.add_argument("only", nargs="*", help="words of paths")
    asked = parser.parse_args()
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)
    ignore = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "python" / "restitution", WORK / "restitution", ignore=ignore)
    shutil.copytree(ROOT / "tests", WORK / "tests", ignore=ignore)
    shutil.copy(ROOT / "pyproject.toml", WORK)
    os.chdir(WORK)
    os.environ |= {"PYTHONPATH": str(WORK), "PYTHONDONTWRITEBYTECODE": "1"}
    sys.path.insert(0, str(WORK))
    sys.dont_write_bytecode = True
    import scipy.stats  # noqa: F401
    import xarray  # noqa: F401

    lived = 0
    for name, tests in TESTS.items():
        if not all(word in name for word in asked.only):
            continue
        file = WORK / "restitution" / name
        source = file.read_text(encoding="utf-8")
        started = time.monotonic()
        if notices(tests, 600.0):
            print(f"{name}: its tests fail without a change")
            return 1
        seconds = PATIENCE * (time.monotonic() - started) + 60
        every = list(changes(source))
        chosen = every if asked.draw is None else random.Random(0).sample(every, min(asked.draw, len(every)))
        print(f"{name}: {len(chosen)} of {len(every)} changes", flush=True)
        alive = 0
        for changed in chosen:
            file.write_text(changed, encoding="utf-8")
            if not notices(tests, seconds):
                alive += 1
                lines = difflib.unified_diff(source.splitlines(), changed.splitlines(), lineterm="", n=0)
                print("\n".join(list(lines)[2:]), flush=True)
        file.write_text(source, encoding="utf-8")
        print(f"{name}: {alive} live", flush=True)
        lived += alive
    return min(lived, 1)


if __name__ == "__main__":
    sys.exit(main())
