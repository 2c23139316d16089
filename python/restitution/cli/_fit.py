"""`restitution fit`: a density fitted to recorded or counted impacts, with errors and a verdict."""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from restitution.cli._common import Overwrite, Quiet, errors_in_a_line
from restitution.cli._process import say

_CUSP = ("asymmetric-laplace", "asymmetric-power", "cusp-mixture")
"""Families that take the location of the cusp."""
_FAMILIES = (*_CUSP, "laplace", "gaussian", "logistic", "student-t")


def fit(
    data: Annotated[Path, typer.Argument(metavar="DATA.nc", help="A file from simulate or statistics.")],
    velocity: Annotated[
        tuple[float, float],
        typer.Option(
            metavar="LOW HIGH",
            help="Window of impact velocity, m/s; in counts, edges of bins.",
        ),
    ],
    family: Annotated[
        str, typer.Option(metavar="FAMILY", help=f"The density: {', '.join(_FAMILIES)}.")
    ] = "asymmetric-laplace",
    location: Annotated[
        float | None,
        typer.Option(
            metavar="X", help="The cusp, such as the law's normal coefficient; fitted unless given."
        ),
    ] = None,
    table: Annotated[
        Path | None, typer.Option(metavar="FILE.tex", help="Also a LaTeX table of the parameters.")
    ] = None,
    resamples: Annotated[
        int, typer.Option(metavar="N", help="Number of resamples of the particles, for errors and p-values.")
    ] = 199,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the resampling.")] = 1,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Fit a density to the restitution at given impact velocity.

    Prints the parameters with their standard errors, and whether the density
    fits: the Kolmogorov-Smirnov and the Anderson-Darling distance with their
    p-values. Errors and p-values come from resampled particles, because the
    impacts of one particle are correlated. A file from statistics does not say
    which particle an impact belongs to; it gives the parameters alone.
    """
    with errors_in_a_line("netCDF4", "scipy.stats"):
        from restitution import fit as fits
        from restitution._internal.datasets import load
        from restitution._internal.files import LATEX, check, check_apart, path_for, write
        from restitution._internal.parameters import ParameterError, wrong

        if family not in _FAMILIES:
            raise ParameterError(wrong("family", family, " or ".join(_FAMILIES)))
        if location is not None and family not in _CUSP:
            raise ParameterError(wrong("location", location, f"for {' or '.join(_CUSP)} alone"))
        if location is None and family == "cusp-mixture":
            raise ValueError("location: missing; a cusp-mixture needs that of its cusp")
        if table is not None:
            check_apart([data], [table])
            path_for("table", table, LATEX)
            check(table, replace=overwrite)
        impacts = load(data)
        function = getattr(fits, family.replace("-", "_"))
        where: dict[str, Any] = {} if location is None else {"location": location}
        if "restitution_count" in impacts:
            found = function(impacts, velocity=velocity, **where)
            lines = _counted(found)
        else:
            where |= {"velocity": velocity, "resamples": resamples, "seed": seed}
            found = fits.bootstrap(function, impacts, **where)
            lines = _recorded(found, fits.goodness(function, impacts, **where))
        if table is not None:
            write(table, found.to_latex().encode(), replace=overwrite)
        for line in lines if not quiet else ():
            say(line)


def _counted(found: Any) -> Iterator[str]:
    yield f"The {found.family} density is fitted to {found.samples} impacts."
    for name, value in found.parameters.items():
        yield f"{name} = {value:.6g}"
    yield from filter(None, [found.limit])
    yield "Standard errors are not known, because counts do not say which particle an impact belongs to."


def _recorded(found: Any, judged: Any) -> Iterator[str]:
    samples = f"{found.fit.samples} impacts of {found.clusters} particles"
    yield f"The {found.fit.family} density is fitted to {samples}."
    for name, value in found.fit.parameters.items():
        error = found.standard_errors[name]
        yield f"{name} = {value:.6g} +- {error:.2g}" if error else f"{name} = {value:.6g} (given)"
    yield from filter(None, [found.fit.limit])
    for name, distance, p in (
        ("Kolmogorov-Smirnov", judged.kolmogorov_smirnov, judged.kolmogorov_smirnov_p),
        ("Anderson-Darling", judged.anderson_darling, judged.anderson_darling_p),
    ):
        yield f"The {name} distance is {distance:.4g}, p = {p:.3f}."
