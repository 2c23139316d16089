"""Where a paper's formulas, as printed, are not what its model says: each with a proof and with numbers."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple


class Check(NamedTuple):
    """Three numbers for one quantity; the last two agree."""

    printed: float
    right: float
    independent: float


@dataclass(frozen=True)
class Misprint:
    """A formula that is wrong as printed ("misprint"), or right only where the paper does not say ("caveat").

    Attributes
    ----------
    equation : str
        The paper's label.
    kind : {"misprint", "caveat"}
        Wrong, or of smaller range than it seems.
    printed, corrected : str
        The formula, in plain text.
    proof : str
        Why the printed formula cannot be right.
    quantity : str
        What `check` calculates.
    check : callable
        Gives that quantity by the printed formula, by the corrected one, and by independent means.
    """

    equation: str
    kind: Literal["misprint", "caveat"]
    printed: str
    corrected: str
    proof: str
    quantity: str
    check: Callable[[], Check]
