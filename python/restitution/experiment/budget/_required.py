"""`required_roundness`: how round a ball must be."""

import math
from importlib.metadata import version
from typing import Annotated, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from restitution._internal.parameters import Allowed, Number, ParameterError, Parameters, TooLargeError
from restitution.bodies import Body, Form, from_roundness
from restitution.experiment.budget._closed_forms import roughness as rough
from restitution.experiment.budget._error_budget import possible, weights
from restitution.experiment.budget._results import RequiredRoundness
from restitution.experiment.budget._sources import contact, shape
from restitution.experiment.budget.experiment import Experiment, Setting
from restitution.experiment.flight.contact import ContactTime, contact_of
from restitution.laws import Law, Material

_ROUNDEST, _LEAST_ROUND, _STEPS = 1e-6, 0.03, 19
"""Out-of-roundness over diameter that is looked at: four steps a decade."""


class _Asked(Parameters):
    precision: Annotated[Number, Field(gt=0, lt=1)]
    diameter: Annotated[Number, Field(gt=0, le=1e6, description="m")]
    quantity: Annotated[Literal["single", "mean", "fit"], Allowed("'single', 'mean' or 'fit'")]


def required_roundness(
    precision: float,
    *,
    diameter: float,
    law: Law | Material | float,
    drop: float,
    impacts: int = 20,
    quantity: Literal["single", "mean", "fit"] = "mean",
    form: Form = "lobed",
    lobes: int = 2,
    wall: float | None = None,
    gravity: float = 9.81,
    roughness: float = 0.0,
    contact_time: ContactTime | float | None = None,
    particles: int = 400,
    seed: int = 1,
) -> RequiredRoundness:
    """Find how round a ball must be for its shape to cause no more than an error.

    Balls of increasing out-of-roundness are dropped, all at the same random angles, and for each the root
    mean square error that shape, roughness and time of contact cause is taken: √(bias² + variance), over ε.

    Parameters
    ----------
    precision : float
        The error over ε, in (0, 1): 1e-3 is 0.1 %.
    diameter : float
        In m, > 0.
    law : Law, Material or float
        The collision law; or its normal coefficient alone, where friction is unknown, as in
        `restitution.error_budget`.
    drop : float
        Height of the fall to the first impact, in m, > 0.
    impacts : int
        Number of coefficients, from 3 to 1000.
    quantity : {"single", "mean", "fit"}
        One coefficient (root mean square over the run), the mean over the run, or the fitted ε_n(v).
    form, lobes, wall
        Kind of deviation from a sphere, and the wall of a hollow ball, as in `restitution.from_roundness`.
    gravity : float
        In m/s², > 0.
    roughness : float
        Ra of the surface in m, as in `restitution.error_budget`, whose error counts too: where it alone is
        more than `precision`, no ball is round enough.
    contact_time : ContactTime or float, optional
        As in `restitution.error_budget`; taken to be neglected, so that its error counts too.
    particles, seed : int
        Number of simulated drops for each out-of-roundness, >= 50, and the seed.

    Returns
    -------
    RequiredRoundness
        The number, which ``float`` gives, the curve, ``table()`` and ``figure()``.

    Raises
    ------
    ValueError
        If a value is out of range; the message names it.

    Examples
    --------
    >>> import restitution as rs
    >>> needed = rs.required_roundness(1e-3, diameter=6e-3, law=rs.Frictionless(normal=0.95), drop=0.1)
    >>> 2e-5 < float(needed) < 5e-5
    True
    """
    asked = _Asked(precision=precision, diameter=diameter, quantity=quantity)
    # The errors of what makes the balls come first.

    def ball(share: float) -> Body:
        return from_roundness(asked.diameter, asked.diameter * share, form=form, lobes=lobes, wall=wall)

    ball(_ROUNDEST)
    setting = Setting(
        drop=drop,
        impacts=impacts,
        gravity=gravity,
        gravity_uncertainty=0.0,
        clock_uncertainty=0.0,
        roughness=roughness,
        particles=particles,
        seed=seed,
    )
    experiment = Experiment.of(law, setting)
    surface = rough(experiment, ball(0.0))
    touching = contact(experiment, contact_of(contact_time) or possible(ball(0.0)), corrected=False)
    rows: list[tuple[float, ...]] = []
    for share in np.geomspace(_ROUNDEST, _LEAST_ROUND * 2.0 / lobes, _STEPS):
        body = ball(float(share))
        try:
            alone = shape(experiment, body)
        except TooLargeError:
            raise
        except ParameterError:
            if not rows:
                raise
            break  # such balls no longer bounce that often
        _, curve = experiment.fitted(weights(experiment, alone, surface))
        n = setting.impacts
        # ⟨δ δᵀ⟩ with its bias.
        bias = alone.bias + surface.bias + touching.bias
        square = alone.covariance + surface.covariance + touching.covariance + np.outer(bias, bias)
        one = 1.0 / experiment.coefficient
        single, fit = (
            math.sqrt(np.mean(np.diag(each) * one**2)) for each in (square, curve @ square @ curve.T)
        )
        mean = math.sqrt(square.sum()) / n / float(experiment.coefficient.mean())
        rows.append((asked.diameter * share, single, mean, fit))
    deviations, *columns = np.array(rows).T
    quantities = {"single": "one coefficient", "mean": "mean over a run", "fit": "fitted law"}
    data = xr.Dataset(
        {
            name: ("out_of_roundness", column, {"units": "1", "long_name": f"error of ε over ε, {what}"})
            for (name, what), column in zip(quantities.items(), columns, strict=True)
        },
        coords={"out_of_roundness": ("out_of_roundness", deviations, {"units": "m"})},
        attrs={
            "title": "Error of the coefficient of restitution that an out-of-roundness causes",
            "source": f"restitution {version('restitution')}",
            "law": experiment.words,
            "form": form,
            "lobes": lobes,
            "diameter": asked.diameter,
            "quantity": asked.quantity,
            **setting.model_dump(include={"drop", "impacts", "gravity", "roughness", "particles", "seed"}),
        },
    )
    found = RequiredRoundness(float("nan"), asked.precision, data)
    return RequiredRoundness(found.allowed(asked.precision, asked.quantity), asked.precision, data)
