"""The contract of every public function: our error, which names the argument, or a right answer, in time."""

import importlib
import inspect
import pkgutil
import re
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import xarray as xr

import restitution as rs
from reference import calls, measuring, methods
from restitution._internal.parameters import shown

SLOW = 30.0
"""Seconds that no call of these sizes may take, on a busy machine either."""

CALLS: dict[str, calls.Call] = calls.CALLS | methods.CALLS | measuring.CALLS
"""Every public function, class and method that takes anything, with what it is given."""

RESULTS = {
    "ErrorBudget",
    "RequiredRoundness",
    "analytic.FirstImpact",
    *(f"fit.{name}" for name in ("Bootstrap", "Comparison", "Fit", "Goodness", "PowerLaw", "Slopes")),
    "figures.Film",
    "flight.LawFit",
    "listen.Analysis",
    "listen.Series",
    *(f"study.{name}" for name in ("Estimate", "Status", "Study")),
    "bodies.Body",
    "laws.Law",
    "pair.KernelDraw",
    "theory.Rates",
}
"""Classes that nobody makes but the functions that return them, or that are bases of others."""
WORKINGS = {
    *(f"laws.{name}" for name in ("bound", "coupling", "draw", "growth", "measure", "table")),
    "flight.ContactTime.possible",
    "bodies.Form",
    "distribution.image",
    "distribution.image_format",
    "distribution.in_gaps",
    "distribution.quantiles",
    "distribution.sealed",
    "flight.LawFit.estimates",
    "gases.Table",
    "gases.redraw",
    "gases.tables",
    "laws.Material",
    "laws.check_steady",
    "listen.Analysis.named",
    "listen.Setting",
    "study.Study.where",
}
"""Functions that other folders call, with what they have checked, and types of arguments."""


def public() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Yield each public function, class and method once, by the shortest name that it has."""
    seen: set[int] = set()
    folders = [name for _, name, folder in pkgutil.walk_packages(rs.__path__, "restitution.") if folder]
    for path in ("restitution", *folders):
        if "._" in path or path == "restitution.cli":
            continue
        module, home = importlib.import_module(path), path.partition(".")[2].rpartition(".")[2]
        for name in getattr(module, "__all__", ()):
            thing = getattr(module, name)
            if id(thing) in seen or isinstance(thing, ModuleType) or not callable(thing):
                continue
            seen.add(id(thing))
            full = f"{home}.{name}" if home else name
            if not isinstance(thing, type):
                yield full, thing
            elif not issubclass(thing, BaseException):
                if full not in RESULTS:
                    yield full, thing
                yield from _methods(full, thing)


_OF_THE_CORE = ("attributes", "entry", "example", "formula", "parameters")
"""Methods of bodies, laws and materials that give what the core takes, or has of them in its tables."""


def _methods(home: str, kind: type) -> Iterator[tuple[str, Callable[..., Any]]]:
    for name in dir(kind):
        method = getattr(kind, name)
        ours = getattr(method, "__module__", None) or ""
        workings = name.startswith("_") or name in _OF_THE_CORE
        if not workings and callable(method) and ours.startswith("restitution"):
            yield f"{home}.{name}", method


def arguments(name: str) -> list[str]:
    """Give what can be attacked: what the signature has, and what is given besides."""
    function, make = CALLS[name]
    kinds = (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)
    taken = {key for key, one in inspect.signature(function).parameters.items() if one.kind not in kinds}
    # A server that tells any function its address is right to serve until it is stopped.
    endless = {"tell"} if name == "explorer.serve" else set()
    return sorted((taken | set(make())) - {"self"} - endless)


_PLACE = r"(?:\[[\d, ]*\]|\['\w+'\]|\.\w+)*"
_AFTER = r"(?= = |: | has | holds | goes | lacks | gave |, \w+(?:: |, )| \* )"
"""Text that follows the name of an argument, of several, or of an element of it."""

FITTING: dict[str, str] = {
    "Revolution.from_file.scale": "profile",
    "ConvexPolyhedron.from_file.scale": "points",
    "pair.rates.temperature_ratios": "rotational_temperature",
    "PairKernel.learn.temperature_ratios": "rotational_temperature",
    "pair.encounters.states": "translational_temperature",
    "pair.encounters.speed": "translational_temperature",
    "pair.encounters.spin": "rotational_temperature",
    "flight.ContactTime.of_spheres.ball": "young_modulus poisson_ratio",
    "flight.ContactTime.of_spheres.plate": "young_modulus poisson_ratio",
    "gas.cool.state": "particles",
    "gas.cool.spin_temperature": "rotational_temperature",
    "gas.cool.batches": "particles",
    "gas.cool.translational_temperature": "rotational_temperature",
    "theory.cooling.number_density": "times",
    "theory.cooling.translational_temperature": "times",
    "Spheroid.equatorial": "polar",
    "fit.Counts.edges": "count",
    "study.study_of.source": "study",
    "study.merge.study": "sweep",
    "flight.restitution.times": "uncertainty",
    "FluctuatingRestitution.rvs.v": "size",
    "from_roundness.lobes": "out_of_roundness",
    "posterior.lobes": "elongation",
    **dict.fromkeys(
        (
            f"FluctuatingRestitution.learn.{name}"
            for name in ("gravity", "minimum_speed", "particles", "release_height")
        ),
        "velocities",  # between which too few impacts are left
    ),
}
"""Where an argument is right in itself, the other that no longer fits it may be the one that is named."""


class Late(BaseException):
    """Puts an end to a call that goes on, before it takes all memory."""


def _late(*_: object) -> None:
    raise Late


@contextmanager
def _alarm(seconds: float) -> Iterator[None]:
    """Raise Late after so long; never on Windows, which has no alarms."""
    if sys.platform == "win32":
        yield
        return
    before = signal.signal(signal.SIGALRM, _late)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def attack(name: str, argument: str, bad: Any) -> str | None:
    """Call with one hostile argument; say what is wrong with what happens, if anything is."""
    function, make = CALLS[name]
    given = make() | {argument: bad}
    started = time.perf_counter()
    try:
        with _alarm(2.0 * SLOW):
            function(**given)
    except Late:
        found = None
    except ValueError as error:
        found = judged(name, str(error), argument, bad)
    except OSError as error:  # of a file, which it names
        found = None if error.filename is not None else f"names no file: {error}"
    except Exception as error:
        found = f"{type(error).__name__}: {error}"
    else:
        found = None
    seconds = time.perf_counter() - started
    return found if seconds < SLOW else f"took {seconds:.0f} s"


def judged(name: str, text: str, argument: str, bad: Any) -> str | None:
    """Say what is wrong with the words of an error, if anything is."""
    if measuring.ENOUGH in text:
        return None
    if len(text) > 2000:
        return f"goes on and on: {text[:200]}"
    files = bad if isinstance(bad, list) else [bad]
    if any(isinstance(one, str | Path) and text.startswith(f"{one}: ") for one in files):
        return None  # of a file, which it names
    names = [argument, *FITTING.get(f"{name}.{argument}", "").split()]
    if not any(re.search(rf"(?<![\w.]){re.escape(one)}{_PLACE}{_AFTER}", text) for one in names):
        return f"does not name {argument}: {text}"
    for line in text.splitlines():
        value = line.removeprefix(f"{argument} = ")
        # As the parameter holds it.
        kept = str(bad) if isinstance(bad, Path) else bad
        if isinstance(bad, list | np.ndarray | xr.DataArray):
            parts = bad if isinstance(bad, list) else np.asarray(bad).ravel()
            kept = tuple(one.item() if isinstance(one, np.generic) else one for one in parts)
        alike = (shown(bad), shown(kept))
        if value != line and not value.startswith(alike) and not _same_number(value, bad):
            return f"shows another value than {shown(bad)}: {text}"
    return None


def _same_number(text: str, bad: Any) -> bool:
    """Whether a number is shown that is equal, if written otherwise."""
    try:
        number = np.asarray(bad)  # in whatever form it was given
        plain = number.ndim == 0 and (number.dtype.kind in "iuf" or isinstance(bad, int))
        return plain and float(re.split(r"[:;,] ", text)[0]) == float(number)
    except Exception:  # whatever the object raises
        return False
