"""Trends of a quantity along its bins, and quantities in bins of falling impact velocity."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from restitution.papers.claims import SIGNIFICANT, Finding, Measurement, Verdict, listed, verdict
from restitution.papers.estimate import Array, Estimate, Impacts, in_bins, settled_speed

RISING_RULE = (
    f"Holds if the last value is above the first by more than {SIGNIFICANT:g} standard errors and no step "
    f"between neighbours goes down by more than {SIGNIFICANT:g}; in part if only the first is so; fails "
    "otherwise."
)


@dataclass(frozen=True)
class Trend:
    """Changes of an estimate along its bins, in standard errors of the change."""

    span: float  # last − first value
    worst: float  # the most negative step between neighbours; 0 if none is negative

    @property
    def rises(self) -> bool:
        """True if the last value is significantly above the first."""
        return self.span > SIGNIFICANT

    @property
    def monotone(self) -> bool:
        """True if it rises and no step down is significant."""
        return self.rises and self.worst > -SIGNIFICANT

    @property
    def verdict(self) -> Verdict:
        """By `RISING_RULE`."""
        return verdict(self.monotone, self.rises)

    @property
    def step(self) -> Measurement:
        """The step that speaks most against it."""
        return Measurement("largest step against the trend", self.worst, unit="standard errors")


def trend(estimate: Estimate) -> Trend:
    """Return the trend of an estimate from its first bin to its last."""
    return Trend(float(estimate.take([0, -1]).steps()[0]), float(min(0.0, *estimate.steps())))


@dataclass(frozen=True)
class Falling:
    """Impacts in bins of impact velocity, fastest bin first."""

    impacts: Impacts
    speeds: Array  # centres of the bins in m/s, decreasing

    @property
    def labels(self) -> list[str]:
        """The speeds as text."""
        return [f"{v:.2g} m/s" for v in self.speeds]


def falling(data: xr.Dataset, lowest: float, bins: int) -> Falling:
    """Make logarithmic bins from the fastest impact down to `lowest`, or to where data become incomplete."""
    fastest = float(data["impact_velocity"].max())
    # The fastest impact itself is inside.
    edges = np.geomspace(max(lowest, settled_speed(data)), fastest * (1 + 1e-12), bins + 1)
    impacts = in_bins(data["impact_velocity"], edges)
    return Falling(impacts.regrouped(bins - 1 - impacts.cell, bins), np.sqrt(edges[1:] * edges[:-1])[::-1])


def grows(
    bins: Falling,
    names: tuple[str, str],
    found: Estimate,
    every: int,
    *exact: Measurement,
    of: str = "",
    ends: tuple[str, str] = ("", ""),
) -> Finding:
    """Judge whether what has these names, in a table and in a sentence, grows as the velocity falls.

    The table has every so many bins; the sentence ends in one of two ways, where it grows throughout or not.
    """
    (name, what), course = names, trend(found)
    return Finding(
        (*listed(name, bins.labels[::every], found.take(slice(None, None, every))), *exact, course.step),
        course.verdict,
        f"{of}{len(bins.labels)} logarithmic bins of impact velocity, fastest first. {RISING_RULE}",
        f"{what} goes from {found.value[0]:.2g} at {bins.labels[0]} to {found.value[-1]:.2g} at "
        f"{bins.labels[-1]}{ends[not course.monotone]}.",
    )
