"""Standard errors of the quantities that a learned distribution returns."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from restitution.distribution._table import Floats
from restitution.distribution._tabulated import TabulatedDistribution, Values, numbers


class EstimatedDistribution(TabulatedDistribution):
    """A table whose entries are estimates, with the standard errors of all that it says.

    Batches of particles are the draws, not impacts. What is said between two nodes, or two conditions, is a
    weighted sum over neighbours that share impacts: their errors are added as if they were one, so that the
    stated error is the true one at most.
    """

    def pdf_error(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `pdf`, at most.

        Raises
        ------
        ValueError
            If the distribution was made from counts, which say nothing of the particles behind them.
        """
        return self._error("probability_error", numbers("x", x), v, given)

    def cdf_error(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `cdf` and `sf`, at most, as `pdf_error`."""
        return self._error("probability_below_error", numbers("x", x), v, given)

    def ppf_error(self, q: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `ppf`, at most: that of `cdf` over the density there, as `pdf_error`.

        It is 0 at both ends, which are the least and the greatest ε that were seen.
        """
        x = self.ppf(q, v, given)
        below, density = self.cdf_error(x, v, given), self.pdf(x, v, given)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(below == 0.0, 0.0, below / density)[()]

    def mean_error(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `mean`, at most, as `pdf_error`."""
        return self._moment_error("mean_error", v, given)

    def std_error(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `std`, at most, as `pdf_error`."""
        return self._moment_error("std_error", v, given)

    def skewness_error(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `skewness`, at most, as `pdf_error`."""
        return self._moment_error("skewness_error", v, given)

    def kurtosis_error(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `kurtosis`, at most, as `pdf_error`."""
        return self._moment_error("kurtosis_error", v, given)

    def var_error(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `var`, at most: 2 σ times that of σ, as `pdf_error`."""
        return 2.0 * self.std(v, given) * self.std_error(v, given)

    @property
    def has_errors(self) -> bool:
        """True if standard errors are known; they are not if the distribution was made from counts."""
        return "probability_error" in self.data

    def _errors(self, name: str, given: npt.ArrayLike | None) -> Floats:
        if not self.has_errors:
            raise ValueError(
                f"{name}: not known; the distribution was made from counts, which do not say "
                "what particle an impact belongs to; learn gives errors"
            )
        errors: Floats = self.data[name if given is None else f"given_{name}"].to_numpy()
        if not np.isfinite(errors).any():
            raise ValueError(
                f"{name}: not known; all impacts are those of a single particle, learn from more"
            )
        return errors

    def _moment_error(self, name: str, v: npt.ArrayLike, given: npt.ArrayLike | None) -> Values:
        errors = self._errors(name, given)
        table, speeds, z = self._at(v, given)
        return np.asarray(sum(weight * errors[i] for weight, i in table.parts(speeds, z)))[()]

    def _error(self, name: str, x: Floats, v: npt.ArrayLike, given: npt.ArrayLike | None) -> Values:
        errors = self._errors(name, given)
        table, speeds, z = self._at(v, given)
        x, speeds, z = np.broadcast_arrays(x, speeds, z)
        total = np.zeros(x.shape)
        for weight, component in table.parts(speeds, z):
            for i in np.unique(component):
                here = component == i
                edges = table[int(i)].edges
                own = errors[table.start[i] : table.start[i + 1]]
                if name == "probability_below_error":
                    found = np.interp(x[here], edges, own)
                else:
                    density = np.concatenate([[0.0], own[:-1] / np.diff(edges), [0.0]])
                    found = density[np.searchsorted(edges, x[here], side="right")]
                total[here] += weight[here] * found
        total[np.isnan(x) | np.isnan(speeds) | np.isnan(z)] = np.nan
        return total[()]
