"""Whether tests notice a change: they are loaded once, and each change has a fork of the process with them.

In the fork the functions that are there already get the code of the changed ones, so that nothing is imported
again. Only tests that reached the changed function without a change are run, first those that noticed most
changes of it, then one of each test function, the fast ones first, and the first failure ends it.
"""

import ast
import math
import os
import pickle
import resource
import signal
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from importlib import import_module
from itertools import accumulate
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import pytest

_PATIENCE = 10
"""The tests may take so many times longer than without a change, and some seconds besides."""
_SECONDS = 20
"""So long may a process do nothing: tests that wait for a signal that does not come do so by the clock."""
_MEMORY = 8 << 30
"""Bytes that the tests may take: a loop without an end may fill the memory before its time is over."""
_TICK = 0.01
REACHED: set[tuple[str, str]] = set()
"""Files and functions that were called since it was last emptied."""
KEPT: set[tuple[str, str]] = set()
"""Functions whose results are kept: only the first test that needs one calls it."""


class Judge:
    """A plugin of pytest that runs something else than the tests that were collected.

    Parameters
    ----------
    modules : sequence of str
        Their names, whose functions are changed.
    campaign : callable
        Called with this judge when the tests are loaded.
    enough : float
        So many seconds of tests are asked about a change, and at least one test.
    """

    def __init__(
        self, modules: Sequence[str], campaign: Callable[["Judge"], None], enough: float = math.inf
    ) -> None:
        self._modules, self._campaign, self._enough = modules, campaign, enough
        self._items: list[pytest.Item] = []
        self._seconds: dict[str, float] = {}
        self._reached: dict[str, set[tuple[str, str]]] = {}
        self._noticed: Counter[tuple[str, str, str]] = Counter()
        self._fixtures: dict[str, set[tuple[str, str]]] = defaultdict(set)

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Look which test reaches what, and begin."""
        self._items = session.items
        if session.testsfailed:
            raise RuntimeError("the tests cannot be loaded")
        found, self._seconds, self._reached = self._forked(self._watched, session, seconds=3600.0)
        if found:
            raise RuntimeError(f"{found} fails without a change")
        self._campaign(self)
        return True

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: pytest.FixtureDef[Any]) -> Iterator[None]:
        """Add what a fixture reaches to what the tests reach that use it."""
        before = set(REACHED)
        REACHED.clear()
        try:
            return (yield)
        finally:
            self._fixtures[fixturedef.argname] |= REACHED
            REACHED.update(before)

    def _watched(
        self, session: pytest.Session
    ) -> tuple[str, dict[str, float], dict[str, set[tuple[str, str]]]]:
        """Run all tests as they are; return one that fails, their times and the functions that they reach."""
        for module in map(import_module, self._modules):
            replace(module, _telling(module))
        seconds, reached = {}, {}
        for item, following in zip(session.items, [*session.items[1:], None], strict=True):
            REACHED.clear()
            started = time.process_time()
            session.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            seconds[item.nodeid] = time.process_time() - started
            reached[item.nodeid] = REACHED.union(
                *(self._fixtures[name] for name in getattr(item, "fixturenames", ()))
            )
            if session.testsfailed:
                return item.nodeid, {}, {}
        kept = KEPT & set().union(*reached.values())
        return "", seconds, {test: places | kept for test, places in reached.items()}

    def reaching(self, module: ModuleType, function: str) -> list[pytest.Item]:
        """Give the tests that reach a function."""
        place = str(module.__file__), function
        return [item for item in self._items if place in self._reached[item.nodeid]]

    def noticed(self, module: ModuleType, function: str, changed: str) -> str:
        """Name the test that notices a change of a function; empty if none does."""
        place = str(module.__file__), function
        items = sorted(self.reaching(module, function), key=lambda item: self._seconds[item.nodeid])
        first = {item.nodeid.partition("[")[0]: item for item in reversed(items)}.values()
        items.sort(key=lambda item: (-self._noticed[*place, item.nodeid], item not in first))
        ends = accumulate(self._seconds[item.nodeid] for item in items)
        items = [
            item for item, end in zip(items, ends, strict=True) if item is items[0] or end <= self._enough
        ]
        allowed = _PATIENCE * sum(self._seconds[item.nodeid] for item in items) + _SECONDS
        found = str(self._forked(lambda session: _run(session, items, module, changed), seconds=allowed))
        self._noticed[*place, found] += 1
        return found

    def _forked(self, work: Callable[[pytest.Session], Any], *given: Any, seconds: float) -> Any:
        """Give what is returned in a process of its own, or words of how that ended."""
        with tempfile.TemporaryFile() as told:
            child = os.fork()
            if child == 0:
                os.setpgid(0, 0)
                null = os.open(os.devnull, os.O_RDWR)
                for number in (0, 1, 2):
                    os.dup2(null, number)
                resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))
                resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 1))
                pickle.dump(work(*(given or (self._items[0].session,))), told)
                told.flush()
                os._exit(0)
            try:
                if not _ends(child):
                    return "waits for ever"
                told.seek(0)
                with suppress(EOFError):
                    return pickle.load(told)
                return "ends the process"
            finally:
                with suppress(ProcessLookupError):
                    os.killpg(child, signal.SIGKILL)


def _run(session: pytest.Session, items: list[pytest.Item], module: ModuleType, changed: str) -> str:
    try:
        replace(module, changed)
    except Exception:
        return "import"
    for item, following in zip(items, [*items[1:], None], strict=False):
        session.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        if session.testsfailed:
            return item.nodeid
    return ""


def _ends(child: int) -> bool:
    """Wait for a process as long as it does anything; the clock counts only while this process runs."""
    idle, used = 0.0, -1
    while idle < _SECONDS:
        time.sleep(_TICK)
        if os.waitpid(child, os.WNOHANG)[0]:
            return True
        with open(f"/proc/{child}/stat", encoding="ascii") as file:
            now = sum(map(int, file.read().rpartition(")")[2].split()[11:13]))
        idle = idle + _TICK if now == used else 0.0
        used = now
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return False


def _telling(module: ModuleType) -> str:
    """Give the source of a module whose functions say that they were called."""
    tree = ast.parse(Path(str(module.__file__)).read_text(encoding="utf-8"))
    for node in tree.body:
        inner = node.body if isinstance(node, ast.ClassDef) else [node]
        above = f"{node.name}." if isinstance(node, ast.ClassDef) else ""
        for function in inner:
            if isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef):
                place = (str(module.__file__), above + function.name)
                if any("cache" in ast.unparse(decorator) for decorator in function.decorator_list):
                    KEPT.add(place)
                tell = f"__import__('sys').modules['mutants_judge'].REACHED.add({place!r})"
                for one in ast.walk(function):
                    if isinstance(one, ast.FunctionDef | ast.AsyncFunctionDef):
                        one.body[:0] = ast.parse(tell).body
    return ast.unparse(ast.fix_missing_locations(tree))


def replace(module: ModuleType, changed: str) -> None:
    """Give the functions of a module the code that they have in a changed source.

    Raises
    ------
    LookupError
        If nothing in them differs: what is changed is outside of functions.
    """
    namespace = {"__name__": module.__name__, "__package__": module.__package__, "__file__": module.__file__}
    exec(compile(changed, str(module.__file__), "exec"), namespace)
    there = dict(_functions(vars(module), module.__name__))
    for name, function in _functions(namespace, module.__name__):
        old = there[name]
        old.__code__ = function.__code__
        old.__defaults__, old.__kwdefaults__ = function.__defaults__, function.__kwdefaults__


def _functions(namespace: dict[str, Any], module: str, above: str = "") -> Iterator[tuple[str, FunctionType]]:
    """Give all functions and methods, and what decorators have made of them."""
    for name, thing in list(namespace.items()):
        if isinstance(thing, type):
            if thing.__module__ == module:
                yield from _functions(dict(vars(thing)), module, f"{above}{name}.")
            continue
        for part in ("", "fget", "fset", "__func__", "func"):
            inner, depth = getattr(thing, part, None) if part else thing, 0
            while inner is not None:
                if isinstance(inner, FunctionType) and inner.__module__ == module:
                    yield f"{above}{name}.{part}.{depth}", inner
                inner, depth = getattr(inner, "__wrapped__", None), depth + 1
