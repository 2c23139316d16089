"""Arguments of a run that are refused, with what is said of each, and how a refusal is read."""

import math
import pickle
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from restitution import bodies, laws
from restitution.drop.toml import _KINDS

POSITIVE = "must be a finite number > 0"
NOT_NEGATIVE = "must be a finite number >= 0"
COUNT = "must be a whole number in [1, 2**40)"
SEED = "must be a whole number in [0, 2**64)"


def one_of(kinds: Sequence[type]) -> str:
    """Classes in words."""
    *others, last = (kind.__name__ for kind in kinds)
    return f"a {', '.join(others)} or {last}"


def quoted(place: str) -> str:
    """What a file calls the kinds of body, law or material."""
    return " or ".join(f'"{name}"' for name in _KINDS[place][1])


BODIES = one_of((*bodies.KINDS, *bodies.RIGID))
LAWS = one_of(laws.KINDS)
SHAPES, LAW_TYPES, MATERIAL_TYPES = map(quoted, ("body", "law", "normal"))
THREADS = "must be a whole number in [1, 1024] or None"
ORIENTATION = "must be 'uniform-angle', 'isotropic' or a 1-D array of angles in rad, one per particle"
SPIN = "must be None, (ωx, ωy, ωz) in rad/s, an array of them, one per particle, or a RandomSpin"
VELOCITY = "must be None or (vx, vy, vz), finite, in m/s"
ANGLE = "must be a finite angle in rad, at most 2**20 either way"

NOT_FINITE = (math.nan, math.inf, -math.inf)
NO_NUMBERS = (True, np.True_, None, "0.5", b"1", 1j, [1.0], np.array([1.0, 2.0, 3.0]))
NO_WHOLE_NUMBERS = (*NO_NUMBERS, 2.0, 2.5, np.float64(3), math.nan, math.inf)


def whole(name: str, values: tuple[Any, ...], allowed: str) -> list[tuple[str, Any, str]]:
    """Cases of an argument that must be a whole number."""
    return [(name, value, allowed) for value in (*values, *NO_WHOLE_NUMBERS)]


def real(name: str, values: tuple[float, ...], allowed: str) -> list[tuple[str, Any, str]]:
    """Cases of an argument that must be a real number."""
    return [(name, value, allowed) for value in (*values, *NO_NUMBERS, *NOT_FINITE)]


BODY = [
    *real("radius", (0, -3e-3, np.float64(-1), -5e-324, 10**400), POSITIVE),
    *real("separation", (-1e-9,), NOT_NEGATIVE),
    *real("density", (0.0, -1), POSITIVE),
]
LAW = [
    *real("normal", (-0.01, 1.0000001, 2), "must be a real number in [0, 1]"),
    *real("tangential", (-1.01, 1.01), "must be a real number in [-1, 1]"),
]
RUN = [
    *whole("particles", (0, -1, 2**40, 10**15, 10**30, np.int64(0)), COUNT),
    *whole("impacts", (0, -1, 2**40, 10**15), COUNT),
    *whole("seed", (-1, 2**64, -(2**64), np.int64(-1)), SEED),
    *real("release_height", (0, -0.06), POSITIVE),
    *real("gravity", (0, -9.81), POSITIVE),
    *real("minimum_speed", (-1e-9,), NOT_NEGATIVE),
    ("release_height", 3.1e-3, "must be at least 0.00315 m, or a part of the body"),
    ("orientation", "upright", ORIENTATION),
    ("orientation", None, ORIENTATION),
    ("orientation", 0.3, ORIENTATION),
    ("orientation", [[0.1, 0.2, 0.3]], ORIENTATION),
    ("orientation", [[0.1], [0.1, 0.2]], ORIENTATION),
    ("orientation", ["0.1", "0.2"], ORIENTATION),
    ("orientation", [True, False], ORIENTATION),
    ("orientation", [0.1, 1j], ORIENTATION),
    ("orientation", np.zeros((40, 40)), ORIENTATION),
    ("orientation", np.zeros((40, 2, 1)), ORIENTATION),
    *real("incline", (-0.1, math.pi / 2, 90), "must be a real number in [0, π/2)"),
    *(
        ("spin", value, SPIN)
        for value in (1.0, "fast", True, [1, 2], [1, 2, "3"], np.zeros((4, 2)), [[1, 2]])
    ),
    *(("release_velocity", value, VELOCITY) for value in (1.0, "up", [1, 2], [1, 2, None], [[1, 2, 3]])),
    *(("release_velocity", [0, 0, value], VELOCITY) for value in NOT_FINITE),
]
THREADS_CASES = [
    ("threads", value, THREADS) for value in (0, -1, 1025, 10**30, 1.5, True, "2", [1], math.nan)
]


def message(call: Callable[[], object]) -> str:
    """What the ValueError of a call says."""
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - the callers look at the message
        call()
    # Errors cross process borders when runs are spread over workers.
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)
    return str(caught.value)


def check(text: str, name: str, value: object, allowed: str) -> None:
    """One line: the name, the value unless it is too long for a line, and what is allowed."""
    start = f"{name} = "
    assert text.startswith(start)
    given, _, rest = text.removeprefix(start).partition(": ")
    assert rest.startswith(allowed)
    plain = value.item() if isinstance(value, np.generic) else value
    if (isinstance(plain, int) and abs(plain) >= 2**256) or (
        isinstance(plain, np.ndarray) and plain.size > 6
    ):
        assert len(given) <= 40
    else:
        assert given == repr(plain)
    assert "\n" not in text
    assert len(text) < 240


def identify(case: object) -> str:
    """Short names for the cases, also of numbers with thousands of digits."""
    return f"{case.bit_length()}bits" if isinstance(case, int) and abs(case) > 2**70 else str(case)[:24]
