"""What stands for more numbers than any memory holds is refused before memory is filled."""

from typing import Any

import numpy as np
import pytest

import restitution as rs
from reference.refused import message
from restitution._internal import arrays as _arrays
from restitution._internal.arrays import reals, shape
from restitution._internal.parameters import TooLargeError

VAST: dict[str, Any] = {
    "range": range(10**12),
    "range beyond 64 bits": range(10**30),
    "endless range": range(10**5000),
    "broadcast": np.broadcast_to(0.5, (10**13,)),
    "broadcast of another kind": np.broadcast_to(np.int8(1), (10**7, 10**7)),
}


@pytest.mark.parametrize("value", VAST.values(), ids=VAST)
def test_more_than_memory_holds(value: Any) -> None:
    """It names the argument; to whoever catches them it is a MemoryError too."""
    told = r"^orientation = .*: must be at most [\d,]+ numbers, for which this process has the memory$"
    with pytest.raises(TooLargeError, match=told):
        reals("orientation", value, "numbers")
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    with pytest.raises(ValueError, match=told):
        rs.simulate(body, law, particles=2, orientation=value)


@pytest.mark.parametrize("value", [range(4), range(5, -6, -5), range(0), range(-3, 3, 2)], ids=str)
def test_a_range_is_its_numbers(value: range) -> None:
    found = reals("x", value, "numbers")
    assert found.dtype == np.float64
    assert found.tolist() == [float(one) for one in value]


def test_a_range_beyond_64_bits_is_no_array_of_numbers() -> None:
    """As a list of the same numbers is none."""
    for value in (range(2**70, 2**70 + 3), [2**70, 2**70 + 1]):
        assert message(lambda value=value: reals("x", value, "numbers")).startswith("x = ")  # type: ignore[misc]


def test_what_is_taken_as_it_is_needs_no_room(monkeypatch: pytest.MonkeyPatch) -> None:
    """Doubles in order are in memory already; other numbers are copied."""
    monkeypatch.setattr(_arrays, "available_memory", lambda: 0)
    monkeypatch.setattr(_arrays, "_MANY", 10)
    given = np.linspace(0.0, 1.0, 22)
    assert reals("x", given, "numbers") is given
    for other in (given[::2], given.astype(np.float32), range(22)):
        with pytest.raises(TooLargeError, match=r"^x = "):
            reals("x", other, "numbers")


def test_memory_that_the_object_itself_asks_for() -> None:
    """As a lazy array, which is worked out when it is asked for its numbers."""

    class Lazy:
        def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
            raise MemoryError("Unable to allocate 72.8 TiB")

    with pytest.raises(
        TooLargeError, match=r"^x = .*: must be as many numbers as this process has the memory"
    ):
        reals("x", Lazy(), "numbers")


def test_a_shape_is_not_gone_through_for_ever() -> None:
    assert message(lambda: shape("size", range(10**12))).startswith(
        "size = range(0, 1000000000000): must be "
    )
