"""Densities fitted to coefficients of restitution: maximum likelihood, errors, goodness, dependence."""

from restitution.fit._asymmetric import asymmetric_laplace, asymmetric_power
from restitution.fit._bootstrap import Bootstrap, bootstrap
from restitution.fit._counts import Counts
from restitution.fit._dependence import dependence
from restitution.fit._families import gaussian, laplace, logistic, student_t
from restitution.fit._judgement import Comparison, Goodness, compare, goodness
from restitution.fit._mixture import cusp_mixture
from restitution.fit._result import Fit
from restitution.fit._slopes import PowerLaw, Slopes, slopes

__all__ = [
    "Bootstrap",
    "Comparison",
    "Counts",
    "Fit",
    "Goodness",
    "PowerLaw",
    "Slopes",
    "asymmetric_laplace",
    "asymmetric_power",
    "bootstrap",
    "compare",
    "cusp_mixture",
    "dependence",
    "gaussian",
    "goodness",
    "laplace",
    "logistic",
    "slopes",
    "student_t",
]
