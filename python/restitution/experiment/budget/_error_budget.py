"""`error_budget`: which error comes from where."""

from importlib.metadata import version
from typing import Any, Literal

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import flag
from restitution._internal.parameters import ParameterError, wrong
from restitution.bodies import BODIES, Body
from restitution.experiment.budget import _sources
from restitution.experiment.budget._closed_forms import near_round
from restitution.experiment.budget._closed_forms import roughness as rough
from restitution.experiment.budget._results import ErrorBudget
from restitution.experiment.budget._sources import Source, unbiased
from restitution.experiment.budget.experiment import Experiment, Setting, mean_radius
from restitution.experiment.flight.contact import ContactTime, contact_of
from restitution.experiment.flight.drag import Drag
from restitution.experiment.flight.setting import QUARTZ, attributes
from restitution.laws import Law, Material


def error_budget(
    body: Body,
    law: Law | Material | float,
    *,
    drop: float,
    impacts: int = 20,
    timing: float = 0.0,
    gravity: float = 9.81,
    gravity_uncertainty: float | None = None,
    clock_uncertainty: float = QUARTZ,
    drop_uncertainty: float = 0.0,
    tilt: float = 0.0,
    spin: float = 0.0,
    roughness: float = 0.0,
    drag: Drag | Literal["sphere"] | None = "sphere",
    drag_corrected: bool = False,
    contact_time: ContactTime | float | None = None,
    contact_corrected: bool = False,
    particles: int = 1000,
    seed: int = 1,
) -> ErrorBudget:
    """Return errors that each part of a bouncing-ball experiment causes in its results.

    The ball falls from rest and the times of its impacts are heard. From these come n coefficients, the
    first by the height of the drop. Each source of error gives them a bias and a covariance, and these are
    carried on to the mean over the run and to the law ε_n(v) that is fitted to it. Sources are taken to be
    independent.

    Parameters
    ----------
    body : Dumbbell or another body
        The ball; `restitution.from_roundness` makes it from a diameter and an out-of-roundness.
    law : Law, Material or float
        The collision law; or its normal coefficient alone, where friction is unknown: errors are then those
        of balls of which half slide at contacts without friction, and half stick. Fitted is what goes with
        its normal coefficient: a constant, the Padé approximant of viscoelastic spheres, plastic spheres, or
        for a table a power law.
    drop : float
        Height of the fall to the first impact, in m, > 0.
    impacts : int
        Number n of coefficients, from 3 to 1000: one impact more is heard.
    timing : float
        Standard error of each time, in s, >= 0.
    gravity, gravity_uncertainty : float
        g and its standard error, in m/s²; left out 3e-3 of g, as in `restitution.flight.restitution`.
    clock_uncertainty : float
        Standard error of the clock over what it shows, in [0, 1).
    drop_uncertainty : float
        Standard error of the height of the drop, in m, >= 0.
    tilt : float
        Angle by which the plate is inclined, in rad, in [0, 0.5).
    spin : float
        Angular velocity at release, about an axis of any direction, in rad/s, >= 0.
    roughness : float
        Arithmetic mean roughness Ra of the surface, in m, >= 0, and at most a thousandth of the radius;
        `restitution.ball_roughness` gives that of a grade. Asperities with exponentially distributed heights,
        of which impacts flatten none: the most that roughness can do. For unknown friction, Frictionless,
        TangentialRestitution with ``tangential=1`` and Coulomb with ``friction`` of 0.1 or more.
    drag : Drag, "sphere" or None
        Air drag; "sphere" is a sphere with the diameter and mass of the body in air, for which the body needs
        its true density.
    drag_corrected : bool
        Whether drag is accounted for, as by `restitution.flight.restitution`: what remains is the standard
        deviation that the uncertainty of the drag causes. Otherwise all of it is a bias.
    contact_time : ContactTime or float, optional
        How long ball and plate touch at 1 m/s, in s, with its standard error. What is not given is not zero:
        its standard error is then what it may be, as of `restitution.flight.ContactTime.possible`.
    contact_corrected : bool
        Whether it is accounted for, as by `restitution.flight.restitution`; otherwise it is a bias.
    particles : int
        Number of simulated drops, >= 50. A standard deviation of shape, spin or tilt is known to a part
        1/√(2 particles); what spin and tilt add is a difference of two such variances.
    seed : int
        Seed of the random numbers.

    Returns
    -------
    ErrorBudget
        Prints as a table. Its ``data`` is a Dataset with bias and standard deviation by ``source`` and
        ``impact``, of the mean over the run and of the fitted law.

    Raises
    ------
    ValueError
        If a value is out of range, or the ball does not bounce so often; the message names it.

    Notes
    -----
    Errors of g and of the clock do not enter ε, which is a quotient of times, but for the first coefficient
    and the speeds.
    Drag that is neglected makes ε too small by the factor 1 - (1 + ε²) v²/(4 V²), to lowest order in the
    speed over the terminal velocity V. Shape, spin and tilt are simulated, without any approximation.
    Roughness is a closed form, docs/rough.md, of a ball that has no other error of shape.

    Examples
    --------
    >>> import restitution as rs
    >>> ball = rs.from_roundness(6e-3, 15e-6)
    >>> budget = rs.error_budget(ball, rs.Frictionless(normal=0.95), drop=0.1, impacts=10, timing=5e-6)
    >>> shape, timing = budget.data.mean_standard_deviation.sel(source=["shape", "timing"]).values
    >>> bool(shape > timing)
    True
    """
    if not isinstance(body, Body):
        raise ParameterError(wrong("body", body, BODIES))
    setting = Setting(
        drop=drop,
        impacts=impacts,
        timing=timing,
        gravity=gravity,
        gravity_uncertainty=gravity_uncertainty,
        clock_uncertainty=clock_uncertainty,
        drop_uncertainty=drop_uncertainty,
        tilt=tilt,
        spin=spin,
        roughness=roughness,
        particles=particles,
        seed=seed,
    )
    force = _force(drag, body, setting)
    touching = contact_of(contact_time) or possible(body)
    drag_corrected = flag("drag_corrected", drag_corrected)
    contact_corrected = flag("contact_corrected", contact_corrected)
    experiment = Experiment.of(law, setting)
    shape = _sources.shape(experiment, body)
    nothing = _sources.nothing(setting.impacts)
    sources = {
        "shape": shape,
        "roughness": rough(experiment, body),
        "timing": _sources.timing(experiment),
        # ε is a quotient of times, but for the first. Its speed is that of the drop, which no clock changes.
        "gravity": unbiased(experiment.covariance(gravity=setting.gravity_error)),
        "clock": unbiased(experiment.covariance(clock=setting.clock_uncertainty)),
        "drop": unbiased(experiment.covariance(drop=setting.drop_uncertainty)),
        "tilt": _sources.added(experiment, body, shape, tilt=setting.tilt),
        "spin": _sources.added(experiment, body, shape, spin=setting.spin),
        "drag": nothing if force is None else _sources.drag(experiment, force, drag_corrected),
        "contact": _sources.contact(experiment, touching, contact_corrected),
    }
    accounted = touching.uncertainty if contact_corrected else 0.0
    data = _dataset(experiment, body, sources, force, accounted)
    said = {"contact_given": int(contact_time is not None), "contact_corrected": int(contact_corrected)}
    return ErrorBudget(data.assign_attrs(drag_corrected=int(drag_corrected), **attributes(touching), **said))


def possible(body: Body) -> ContactTime:
    """Return what the time of contact may be where it is not given."""
    return ContactTime.possible(diameter=2.0 * mean_radius(body), mass=body.mass)


def _force(drag: object, body: Body, setting: Setting) -> Drag | None:
    if drag is None or isinstance(drag, Drag):
        return drag
    if not isinstance(drag, str) or drag != "sphere":
        raise ParameterError(wrong("drag", drag, 'a Drag, "sphere" or None'))
    return Drag.of_sphere(diameter=2.0 * mean_radius(body), mass=body.mass, gravity=setting.gravity)


def weights(experiment: Experiment, *sources: Source, contact: float = 0.0) -> Array:
    """Return the covariance that a fit assumes: of what is measured, and one scatter of ε for all."""
    setting = experiment.setting
    known = experiment.covariance(
        setting.timing,
        setting.gravity_error,
        setting.drop_uncertainty,
        contact,
        setting.clock_uncertainty,
    )
    # Without any error all impacts have equal weight.
    scatter = max(sum(float(np.mean(np.diag(one.covariance))) for one in sources), 1e-24)
    return np.asarray(known + scatter * np.eye(experiment.speed.size))


def _dataset(
    experiment: Experiment, body: Body, sources: dict[str, Source], force: Drag | None, contact: float
) -> xr.Dataset:
    n = experiment.speed.size
    assumed = weights(experiment, sources["shape"], sources["roughness"], contact=contact)
    estimator, curve = experiment.fitted(assumed)
    one = {"units": "1"}
    variables: dict[str, Any] = {}
    for prefix, by, dimensions, what in (
        ("", np.eye(n), ("source", "impact"), "ε of one impact"),
        ("mean_", np.full((1, n), 1.0 / n), ("source",), "the mean of a run"),
        ("fit_", curve, ("source", "impact"), "the fitted ε_n(v)"),
        ("parameter_", estimator, ("source", "parameter"), "the parameters"),
    ):
        unit = one if prefix != "parameter_" else {}
        for name, values in _carried(list(sources.values()), by).items():
            shaped = values[:, 0] if prefix == "mean_" else values
            variables[prefix + name] = (dimensions, shaped, unit | {"long_name": f"{_LONG[name]} {what}"})
    variables |= {
        "impact_velocity": ("impact", experiment.speed, {"units": "m s-1", "symbol": "v"}),
        "restitution": ("impact", experiment.coefficient, one | {"long_name": "ε_n at that speed"}),
        "parameter_value": ("parameter", experiment.parameters),
        "parameter_unit": ("parameter", list(experiment.form.units)),
    }
    limit = near_round(experiment, body)
    if limit is not None:
        kick, bias, deviation = limit
        text = "closed form of shape and spin, angles independent"
        variables |= {
            "kick": ("impact", kick, one | {"long_name": "kick parameter K of the rotation"}),
            "turning_bias": ("impact", bias, one | {"long_name": f"bias of ε, {text}"}),
            "turning_standard_deviation": (
                "impact",
                deviation,
                one | {"long_name": f"standard deviation of ε, {text}"},
            ),
        }
    coords = {
        "source": [*sources, "total"],
        "parameter": list(experiment.form.parameters),
        "impact": np.arange(n),
    }
    attrs = {
        "title": "Error budget of a bouncing-ball experiment",
        "source": f"restitution {version('restitution')}",
        "body": repr(body),
        "law": experiment.words,
        "fitted_law": experiment.form.name,
        **experiment.setting.model_dump(),
        "gravity_uncertainty": experiment.setting.gravity_error,
        **attributes(force),
    }
    return xr.Dataset(variables, coords, attrs)


_LONG = {
    "bias": "mean error of",
    "standard_deviation": "standard deviation of",
    "bias_error": "sampling error of the mean error of",
    "standard_deviation_error": "sampling error of the standard deviation of",
}


def _carried(sources: list[Source], by: Array) -> dict[str, Array]:
    """Return the errors of m quantities by each source, and by all; arrays of shape (sources + 1, m)."""
    every = [one.carried(by) for one in sources]
    each = {name: np.stack([one[name] for one in every]) for name in _LONG}
    deviation = each["standard_deviation"]
    total = np.sqrt(np.sum(deviation**2, axis=0))
    spread = np.sqrt(np.sum((deviation * each["standard_deviation_error"]) ** 2, axis=0))
    of_all = {
        "bias": each["bias"].sum(axis=0),
        "standard_deviation": total,
        "bias_error": np.sqrt(np.sum(each["bias_error"] ** 2, axis=0)),
        "standard_deviation_error": spread / np.maximum(total, 1e-300),
    }
    return {name: np.vstack([values, of_all[name]]) for name, values in each.items()}
