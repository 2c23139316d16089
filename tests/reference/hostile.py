"""One catalogue of hostile values: whatever once broke something, and its kin. It grows with every find."""

import ctypes
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr


class Exploding:
    """Raises whatever is asked of it."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        raise RuntimeError("no array")

    def __float__(self) -> float:
        raise ZeroDivisionError("no number")

    def __index__(self) -> int:
        raise OSError("no index")

    def __repr__(self) -> str:
        raise KeyError("no words")


def _itself() -> list[Any]:
    """A list that holds itself."""
    found: list[Any] = [1.0]
    found.append(found)
    return found


def masked_with_fields() -> Any:
    """Values with fields, of which one is masked: NumPy's `is_masked` raises."""
    fields = [("a", "f8"), ("b", "f8")]
    mask = np.array([(True, False)], dtype=[("a", "?"), ("b", "?")])
    return np.ma.masked_array([(1.0, 2.0)], mask=mask, dtype=fields)


VALUES: dict[str, Callable[[], Any]] = {
    "None": lambda: None,
    "True": lambda: True,
    "numpy False": lambda: np.False_,
    "nan": lambda: float("nan"),
    "inf": lambda: float("inf"),
    "-inf": lambda: float("-inf"),
    "-0.0": lambda: -0.0,
    "0": lambda: 0,
    "-1": lambda: -1,
    "tiny": lambda: 5e-324,
    "huge": lambda: 1.7e308,
    "2**64": lambda: 2**64,
    "10**400": lambda: 10**400,
    "whole number of a byte": lambda: np.int8(100),
    "of C": lambda: ctypes.c_double(0.5),
    "longdouble beyond": lambda: np.longdouble("1e4000"),
    "complex": lambda: 1 + 0j,
    "numpy complex": lambda: np.complex64(1.0),
    "Decimal": lambda: Decimal("0.5"),
    "Fraction": lambda: Fraction(1, 2),
    "date": lambda: np.datetime64("2020-01-01"),
    "duration": lambda: np.timedelta64(3, "ns"),
    "text": lambda: "fast",
    "digits": lambda: "0.5",
    "empty text": lambda: "",
    "bytes": lambda: b"0.5",
    "null character": lambda: "a\0b",
    "masked": lambda: np.ma.masked,
    "masked array": lambda: np.ma.masked_array([0.1, 0.2, 0.3], [False, True, False]),
    "list of masked": lambda: [np.ma.masked_array([0.1, 0.2], [True, False])],
    "empty list": lambda: [],
    "one": lambda: [0.5],
    "falling": lambda: [3.0, 2.0, 1.0],
    "equal": lambda: [1.0, 1.0],
    "uneven": lambda: [0.0, 1.0, 5.0],
    "nan inside": lambda: [0.0, float("nan"), 1.0],
    "inf inside": lambda: [0.0, 1.0, float("inf")],
    "wide": lambda: [-1.7e308, 1.7e308],
    "narrow": lambda: [1.0, np.nextafter(1.0, 2.0)],
    "bools": lambda: [True, False],
    "bool inside": lambda: [0.0, True, 2.0],
    "digits inside": lambda: ["0", "1", "2"],
    "mixed": lambda: [0.0, "1"],
    "None inside": lambda: [0.0, None],
    "ragged": lambda: [[0.0], [1.0, 2.0]],
    "two dimensions": lambda: np.zeros((2, 3)),
    "masked with fields": masked_with_fields,
    "subnormal": lambda: [1e-310, 2e-310, 3e-310],
    "data array of no dimension": lambda: xr.DataArray(0.5),
    "table in memory": lambda: np.zeros((2, 2)).data,
    "masked whole number": lambda: np.ma.masked_array(3, mask=True),
    "other units": lambda: xr.DataArray([0.5, 1.0], dims="x", attrs={"units": "furlong"}),
    "no dimension": lambda: np.array(0.5),
    "objects": lambda: np.array([0.0, 1.0], dtype=object),
    "structured": lambda: np.zeros(2, dtype=[("a", "f8")]),
    "dates": lambda: np.array(["2020-01-01", "2020-01-02"], dtype="datetime64[D]"),
    "durations": lambda: np.array([1, 2, 3], dtype="timedelta64[s]"),
    "complex array": lambda: np.array([0.0, 1.0], dtype=complex),
    "big-endian": lambda: np.array([0.0, 1.0, 2.0], dtype=">f8"),
    "strided": lambda: np.linspace(0.0, 1.0, 7)[::3],
    "series": lambda: pd.Series([0.0, 1.0, None], dtype="Float64"),
    "frame": lambda: pd.DataFrame({"a": [1.0]}),
    "dataset": xr.Dataset,
    "data array": lambda: xr.DataArray([0.0, 1.0], dims="x"),
    "set": lambda: {0.0, 1.0},
    "dict": lambda: {"a": 1},
    "generator": lambda: (x for x in (0.0, 1.0)),
    "itself": _itself,
    "exploding": Exploding,
    "function": lambda: len,
    "class": lambda: int,
    "path": lambda: Path("none"),
    "name of a table": lambda: "hostile.csv",
    "dash": lambda: "-",
    "no name": lambda: "/",
    "what has no end": lambda: "/dev/zero",
}
"""By name, what makes the value: some can be used only once."""
