"""A fitted law: parameters with errors and covariance, and how well it fits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import check_each, reals
from restitution._internal.datasets import Content
from restitution._internal.text import table, with_error
from restitution.experiment.flight.laws import LawOfSpeed, by_parameters


@dataclass(frozen=True, eq=False)
class LawFit(Content):
    """A law ε_n(v) fitted to measured impacts.

    Attributes
    ----------
    law : str
        Its name.
    parameters, errors : Mapping[str, float]
        Value and standard error of each parameter.
    units : Mapping[str, str]
        Their units.
    covariance : ndarray, shape (p, p)
        Of the parameters, in their order.
    scatter, scatter_error : float
        Standard deviation of ε about the law that no error of measurement explains, and its standard error;
        as it was given, with error 0, unless it was fitted.
    between, between_error : float
        Standard deviation of ε between series, of drops or plates, and its standard error; 0 for one series.
    between_groups, between_groups_error : float
        That between groups of series, as the tables of a class, beside it; 0 without groups.
    impacts : int
        Number of coefficients that were fitted.
    chi2 : float
        r C⁻¹ r for the residuals r and their covariance C.
    degrees_of_freedom : int
        Coefficients less parameters.
    loglikelihood : float
        Natural logarithm of the likelihood, up to a constant that all fits of the same data share.
    note : str
        What is known of the errors of times that came without an uncertainty; empty where they had one.

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.flight.restitution([0.0, 0.4001, 0.7800, 1.1411, 1.4841], 1e-4)
    >>> found = rs.flight.fit(data, "constant")
    >>> found.law, list(found.parameters), found.degrees_of_freedom
    ('constant', ['restitution'], 2)
    """

    law: str
    parameters: Mapping[str, float]
    errors: Mapping[str, float]
    units: Mapping[str, str]
    covariance: Array = field(repr=False)
    scatter: float
    scatter_error: float
    impacts: int
    chi2: float
    degrees_of_freedom: int
    loglikelihood: float
    _form: LawOfSpeed = field(repr=False)
    note: str = ""
    between: float = 0.0
    between_error: float = 0.0
    between_groups: float = 0.0
    between_groups_error: float = 0.0

    @property
    def p_value(self) -> float:
        """Probability of a larger χ² if the law is right; says nothing where the scatter was fitted."""
        return float(chi2.sf(self.chi2, self.degrees_of_freedom))

    @property
    def aic(self) -> float:
        """Akaike's criterion 2 k - 2 ln L; lower is better."""
        errors = (self.scatter_error, self.between_error, self.between_groups_error)
        free = len(self.parameters) + sum(error > 0.0 for error in errors)
        return 2.0 * free - 2.0 * self.loglikelihood

    def __call__(self, speed: npt.ArrayLike) -> Array:
        """Return ε_n at speeds in m/s, > 0; shape of `speed`."""
        return self._form.coefficient(_speeds(speed), self._values)

    def error(self, speed: npt.ArrayLike) -> Array:
        """Return the standard error of ε_n at speeds in m/s, from those of the parameters."""
        v = _speeds(speed)
        slopes = by_parameters(self._form, v, self._values)
        return np.asarray(np.sqrt(np.einsum("...i,ij,...j", slopes, self.covariance, slopes)))

    @property
    def _values(self) -> Array:
        return np.array(list(self.parameters.values()))

    def estimates(self) -> list[tuple[str, str]]:
        """Return parameters in words, with their errors and units, as text."""
        units = {name: "" if unit == "1" else f" {unit}" for name, unit in self.units.items()}
        return [
            (_WORDS.get(name, name), with_error(value, self.errors[name]) + units[name])
            for name, value in self.parameters.items()
        ]

    def _repr_html_(self) -> str:
        rows = self.estimates()
        if self.scatter_error > 0.0:
            rows.append(("scatter", with_error(self.scatter, self.scatter_error)))
        else:
            rows.append(("p", f"{self.p_value:.2g}"))
        rows += [("χ²", f"{self.chi2:.1f}"), ("degrees of freedom", str(self.degrees_of_freedom))]
        return table(f"{self.law}, fitted to {self.impacts} coefficients of restitution", rows)

    def __str__(self) -> str:
        parts = list(map(" = ".join, self.estimates()))
        if self.scatter_error > 0.0:
            parts.append(f"scatter {with_error(self.scatter, self.scatter_error)}")
        if self.between_error > 0.0:
            parts.append(f"between series {with_error(self.between, self.between_error)}")
        if self.between_groups_error > 0.0:
            parts.append(f"between groups {with_error(self.between_groups, self.between_groups_error)}")
        freedom = self.degrees_of_freedom
        quality = f"χ²/n = {self.chi2:.1f}/{freedom}"
        if not self.scatter_error > 0.0:
            quality += f", p = {self.p_value:.2g}"
        return f"{self.law}: {', '.join(parts)}; {quality}" + f"\n{self.note}" * bool(self.note)


_WORDS = {"restitution_at_1_m_s": "ε at 1 m/s", "yield_speed": "yield speed"}


def _speeds(speed: npt.ArrayLike) -> Array:
    allowed = "speeds > 0, in m/s"
    v = reals("speed", speed, allowed, unit="m s-1")
    check_each("speed", v, v > 0.0, allowed)
    return v
