"""Arrays of any shape, type, order and value, for every argument of which the core makes a table."""

import warnings
from random import Random
from typing import Any

import numpy as np

from reference.commands import same
from reference.contract import CALLS, attack

ARGUMENTS: tuple[tuple[str, str], ...] = (
    *(("simulate", name) for name in ("orientation", "spin", "release_velocity", "release_height")),
    *(
        ("statistics", name)
        for name in ("velocity_bins", "restitution_bins", "fraction_bins", "orientation", "spin")
    ),
    *(("reduce", name) for name in ("velocity_bins", "restitution_bins")),
    ("Tabulated", "v"),
    ("Tabulated", "e"),
    ("trajectory", "times"),
    ("FluctuatingRestitution.cdf", "x"),
    ("FluctuatingRestitution.cdf", "v"),
    ("FluctuatingRestitution.ppf", "q"),
    ("fit.Counts", "edges"),
    ("fit.Counts", "count"),
    ("fit.slopes", "velocity_bins"),
    ("flight.restitution", "times"),
    ("flight.restitution", "uncertainty"),
    ("sound.impacts", "source"),
)
_SHAPES = (
    (),
    (0,),
    (1,),
    (2,),
    (3,),
    (3, 2),
    (3, 3),
    (3, 4),
    (1, 3),
    (2, 3, 3),
    (12,),
    (40,),
    (0, 3),
    (3, 0),
)
_TYPES = (
    "f8",
    "f8",
    "f8",
    ">f8",
    "f4",
    "f2",
    "g",
    "i1",
    "i8",
    "u8",
    ">i4",
    "?",
    "c16",
    "O",
    "U3",
    "M8[s]",
    "m8[s]",
)
_SCALES = (0.0, 1e-320, 1e-30, 1e-3, 1.0, 1.0, 1.0, 3.0, 100.0, 1e17, 1e308)
_ODD = (np.nan, np.inf, -np.inf, -0.0, 5e-324, 1.7976931348623157e308)


class _Own(np.ndarray[Any, Any]):
    """A class of somebody's own."""


def table(draw: Random) -> Any:
    """Give an array, often one that is right; the same of the same draw."""
    shape, kind = draw.choice(_SHAPES), draw.choice(_TYPES)
    random = np.random.default_rng(draw.getrandbits(32))
    values = random.uniform(draw.choice((-1.0, 0.0, 0.0)), 1.0, shape) * draw.choice(_SCALES)
    if draw.random() < 0.6:
        values = np.sort(values, axis=0) if values.ndim else values
    if values.size and draw.random() < 0.3:
        values = np.array(values)
        values.flat[draw.randrange(values.size)] = draw.choice(_ODD)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made: Any = np.asarray(values.astype(kind))
    way = draw.randrange(8)
    if way == 0:
        made = np.asfortranarray(made)
    elif way == 1:
        made = np.repeat(made, 2, axis=0)[::2] if made.ndim else made
    elif way == 2:
        made = made[::-1][::-1] if made.ndim else made
    elif way == 3:
        made.flags.writeable = False
    elif way == 4:
        made = np.ma.masked_array(made, np.zeros(made.shape, dtype=bool))
    elif way == 5:
        made = made.view(_Own)
    elif way == 6:
        made = made.tolist()
    return made


def trial(name: str, argument: str, seed: int) -> str | None:
    """Give a table to a function; say what breaks the contract, if anything does."""
    bad = table(Random(seed))
    found = attack(name, argument, bad)
    if found is not None:
        return f"{found} [{bad!r:.200}]"
    plain = np.array(bad, dtype=object)
    # Lists do not tell the shape of an array without numbers.
    if not 0 < plain.size <= 12 or not all(type(one) is float for one in plain.ravel()):
        return None
    function, make = CALLS[name]
    try:
        result = function(**make() | {argument: bad})
    except (ValueError, OSError):
        return None
    # Neither order nor kind of an array of the same doubles may matter.
    again = function(**make() | {argument: np.array(bad, dtype=float).tolist()})
    return None if same(result, again) else f"depends on more than the values [{bad!r:.200}]"
