"""Densities fitted to measured coefficients of restitution: maximum likelihood, goodness, comparison."""

from restitution.fit._asymmetric import asymmetric_laplace, asymmetric_power
from restitution.fit._families import gaussian, laplace, logistic, student_t
from restitution.fit._judgement import Comparison, Goodness, compare, goodness
from restitution.fit._result import Fit

__all__ = [
    "Comparison",
    "Fit",
    "Goodness",
    "asymmetric_laplace",
    "asymmetric_power",
    "compare",
    "gaussian",
    "goodness",
    "laplace",
    "logistic",
    "student_t",
]
