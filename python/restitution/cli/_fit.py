"""`restitution fit`: a density fitted to recorded or counted impacts, with errors and a verdict."""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from restitution._internal.process import say
from restitution.cli._common import Quiet, errors_in_a_line

_FAMILIES = ("asymmetric-laplace", "laplace", "gaussian", "logistic", "student-t", "cusp-mixture")


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
    resamples: Annotated[
        int, typer.Option(metavar="N", help="Number of resamples of the particles, for errors and p-values.")
    ] = 199,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the resampling.")] = 1,
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
        from restitution._internal.parameters import ParameterError, wrong

        if family not in _FAMILIES:
            raise ParameterError(wrong("family", family, " or ".join(_FAMILIES)))
        impacts = load(data)
        function = getattr(fits, family.replace("-", "_"))
        how: dict[str, Any] = {"velocity": velocity, "resamples": resamples, "seed": seed}
        if "restitution_count" in impacts:
            lines = _counted(function(impacts, velocity=velocity))
        else:
            lines = _recorded(
                fits.bootstrap(function, impacts, **how), fits.goodness(function, impacts, **how)
            )
        for line in lines if not quiet else ():
            say(line)


def _counted(found: Any) -> Iterator[str]:
    yield f"{found.family}, {found.samples} impacts"
    for name, value in found.parameters.items():
        yield f"{name} = {value:.6g}"
    yield "standard errors: not known, because counts do not say which particle an impact belongs to"


def _recorded(found: Any, judged: Any) -> Iterator[str]:
    yield f"{found.fit.family}, {found.fit.samples} impacts of {found.clusters} particles"
    for name, value in found.fit.parameters.items():
        error = found.standard_errors[name]
        yield f"{name} = {value:.6g} +- {error:.2g}" if error else f"{name} = {value:.6g} (given)"
    for name, distance, p in (
        ("Kolmogorov-Smirnov", judged.kolmogorov_smirnov, judged.kolmogorov_smirnov_p),
        ("Anderson-Darling", judged.anderson_darling, judged.anderson_darling_p),
    ):
        yield f"{name} distance {distance:.4g}, p = {p:.3f}"
