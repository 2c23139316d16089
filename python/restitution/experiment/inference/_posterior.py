"""`posterior`: what measured times say of ε_n, of the shape and of friction."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from importlib.metadata import version
from itertools import product
from typing import Annotated, Any

import numpy as np
import xarray as xr
from pydantic import Field
from scipy.interpolate import Akima1DInterpolator

from restitution import flight
from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import pair
from restitution._internal.parameters import (
    Number,
    ParameterError,
    Parameters,
    Problem,
    Whole,
    in_terms_of,
    wrong,
)
from restitution.bodies import Form, Wall
from restitution.experiment.budget.experiment import HEIGHT, STICKS, frictions
from restitution.experiment.flight.chain import series_of
from restitution.experiment.flight.setting import Length
from restitution.experiment.inference._family import Family
from restitution.experiment.inference._series import NEEDED, Series, check_from_release
from restitution.experiment.inference._table import Table, table
from restitution.experiment.inference._verdict import agreeing, answer, disagreement, judge, sentence
from restitution.laws import Coulomb, Law, Material

_SHAPES, _SCATTERS, _FRICTIONS = 8, 3, 6
"""Values of L/R and of the scatter of ε_n in a decade, and values of friction."""
_LEAST_SCATTER = 1e-9
_USUAL_NORMAL = 0.9
"""Of a law that is left out; its value is inferred."""
_USUAL = (1e-3, 0.3)
"""L/R of balls that are inferred unless told otherwise."""
_UNSEEN = 0.1
"""Part of the variance of ε that a shape may add and is not seen."""
_ROUNDEST = 1e-9
"""L/R below which no ball is: of a millimetre it is less than an atom."""
_CHAINS = 4
"""Into which the draws, all independent, are divided, as other tools expect them."""
_PER_SHAPE = 1.0 / (8.0 * np.sqrt(2.0))
"""Mean height over R of asperities that make ε scatter as a ball of two lobes does, over (L/R)²."""
_MEASURED = 0.3
"""Standard deviation of ln of an out-of-roundness or Ra that was measured: of other places of the ball."""
_MOST_RANGE = 1e6
"""Of L/R: the grid has points all the way."""


class Setting(Parameters):
    """The settings of an inference besides the times."""

    diameter: Annotated[Number, Field(gt=0, le=1e6, description="m")]
    lobes: Annotated[Whole, Field(ge=2)]
    wall: Wall
    particles: Annotated[Whole, Field(ge=100)]
    draws: Annotated[Whole, Field(ge=100, le=10**8)]
    seed: Annotated[Whole, Field(ge=0, lt=2**32)]
    out_of_roundness: Length = None
    roughness: Length = None


def posterior(
    data: xr.Dataset | Iterable[xr.Dataset],
    law: Law | Material | float | None = None,
    *,
    diameter: float,
    form: Form = "dumbbell",
    lobes: int = 2,
    wall: float | None = None,
    out_of_roundness: float | None = None,
    roughness: float | None = None,
    elongation: tuple[float, float] | None = None,
    scatter: tuple[float, float] | None = (1e-6, 0.05),
    friction: tuple[float, float] | None = None,
    particles: int = 500,
    draws: int = 2000,
    seed: int = 1,
) -> xr.DataTree:
    """Infer ε_n, its scatter, the shape and friction of a ball from the times of its impacts.

    Errors of g and of the clock are one factor of all speeds: they are part of the errors of β and of a yield
    speed, cancel in ε, a ratio of times, and change L/R and Ra by less than they are.

    A ball is released from rest at any angle; how it turns is not measured. Its times are compared with
    those of simulated balls with the same errors, through four numbers: the parameter of ε_n by least
    squares, and how large the residuals are early and late. Their joint density is estimated from simulations
    on a grid of L/R, scatter of ε_n and friction, and draws are taken from what is interpolated.
    Asperities of a round ball act through a lever arm as a shape does, and are simulated by the map of
    docs/rough.md. Whether shape or asperities make ε scatter, or the material, or both, is decided by the
    Bayes factors of these explanations.

    Parameters
    ----------
    data : Dataset or iterable of Dataset
        As `restitution.flight.restitution` returns it: one series, or several of the same ball. The first
        impact must be the first after the release. Air drag is to be accounted for there. The normal
        coefficients of several may differ, as on other plates: inferred is their mean.
    law : Law, Material or float, optional
        Its kind and everything that is not inferred. Inferred is the normal coefficient, or the parameter of
        its material: β of a `Viscoelastic`, the yield speed of a `Plastic`. Its own value there is not used.
        Left out, or with a normal coefficient alone, the friction is unknown: none and so much that contacts
        stick have the same prior probability, and so has what lies between.
    diameter : float
        In m, > 0.
    form, lobes
        Kind of deviation from a sphere, as in `restitution.from_roundness`; L = 2t. It is assumed, and the
        result depends on it: an L/R of one form scatters ε as some other L/R of another.
    wall : float, optional
        Thickness of the wall of a hollow ball, in m. A table-tennis ball that is taken for a full one has an
        L/R that is too small by a fifth.
    out_of_roundness, roughness : float, optional
        The out-of-roundness t and the arithmetic mean roughness Ra of the ball in m, where they were
        measured, >= 0. Without the first L = 2t has the prior `elongation`; with it ln t is Gaussian about
        ln of what was measured, with a deviation of 0.3. Impacts flatten asperities, which are rigid here:
        ln of the Ra that acts is uniform up to what was measured, and falls with the same deviation beyond.
        0 is a smooth ball.
    elongation : (float, float), optional
        Prior: ln(L/R) is uniform between these, 10⁻⁹ <= low < high < 10⁶ low, and the low end stands for a
        round ball. Without it from 10⁻³ to 0.3, or from as low as the times tell a ball from a round one.
    scatter : (float, float) or None
        Prior of the standard deviation with which ε_n itself scatters from impact to impact, as by
        `restitution.Scattered`: its logarithm is uniform between these, 10⁻⁹ <= low < high <= 1, and the low
        end stands for none; up to 10⁻⁶ there is none. With None no material scatters, and all scatter of ε is
        of the shape.
    friction : (float, float), optional
        Prior of the friction of a `Coulomb` law: uniform between these, 0 <= low < high. Not inferred unless
        given.
    particles : int
        Drops that are simulated at each point of the grid, >= 100. Sampling errors of the likelihood add up
        over series; what they may do to a Bayes factor is stated, and no verdict rests on it. More particles
        decide more.
    draws : int
        Draws of the posterior, >= 100.
    seed : int
        In [0, 2³²).

    Returns
    -------
    xarray.DataTree
        In ArviZ's schema, of independent draws: ``posterior``, of balls with a shape, with ``normal`` (or
        ``beta``, ``yield_speed``), ``elongation`` (L/R), ``out_of_roundness`` (m), ``scatter`` (of ε_n) and
        ``friction``, over chain and draw; ``rough``, of round balls with asperities, the same with
        ``roughness`` (Ra in m) in the place of the shape; ``sample_stats`` with ``lp``; ``observed_data``;
        ``likelihood`` with ``profile``, the log-likelihood as a function of L/R, largest over the rest. The
        attributes hold the settings; ``explained_by``, what makes ε scatter: 'shape', 'roughness', 'surface'
        (one of these, and the times do not tell which), 'material', 'both' (surface and material), 'neither'
        (errors of the times suffice) or 'undecided' (surface or material); ``log_bayes_factor_surface``,
        ``_shape``, ``_roughness`` and ``_scatter``, ln of the factors for each against its absence, with
        ``log_bayes_factor_error``, their standard error of the finite number of simulated drops;
        ``elongation_determined`` (1 or 0), ``elongation_upper_limit`` (95 %, for L/R uniform from 0),
        ``roughness_upper_limit`` (m, likewise); ``predictive_p_value``, the probability that the best ball
        scatters ε as far from its usual as observed, or with as little growth towards low speeds, as large a
        residual, or as much of a trend with the speed; ``verdict``, a sentence, which says first if this is
        small, and ``answer``, the result in one line.

    Raises
    ------
    ValueError
        If a value is out of range or the data are too few; the message names it.
    ImportError
        If arviz-base is not installed.

    Notes
    -----
    docs/inference.md shows that the intervals cover what they should.

    Examples
    --------
    >>> import numpy as np, restitution as rs
    >>> ball, law = rs.from_roundness(6e-3, 6e-5), rs.Frictionless(normal=0.93)
    >>> run = rs.simulate(ball, law, particles=1, impacts=14, release_height=0.103)
    >>> data = rs.flight.restitution(run.time.values[0], 1e-5, drop_height=0.1)
    >>> found = rs.posterior(data, law, diameter=6e-3, particles=200, draws=500)
    >>> found.attrs["explained_by"]  # of one drop; more drops decide
    'undecided'
    """
    _from_dict()  # before anything is simulated
    setting = Setting(
        diameter=diameter,
        lobes=lobes,
        wall=wall,
        particles=particles,
        draws=draws,
        seed=seed,
        out_of_roundness=out_of_roundness,
        roughness=roughness,
    )
    given = frictions(_USUAL_NORMAL if law is None else law)
    law, unknown = given[-1], len(given) > 1 and friction is None
    low, high = _USUAL if elongation is None else _prior("elongation", elongation, least=_ROUNDEST)
    if not high < _MOST_RANGE * low:
        raise ParameterError(wrong("elongation", elongation, f"high < {_MOST_RANGE:g} low"))
    family = Family(law, setting.diameter, form, setting.lobes, setting.wall)
    if friction is not None and not isinstance(law, Coulomb):
        kind = type(law).__name__
        raise ParameterError(Problem("friction", f": given for a {kind}; only a Coulomb law has it"))
    hollow = {} if wall is None else {"wall": wall}
    if out_of_roundness is not None:
        of_it = 4.0 * out_of_roundness / diameter
        high = max(high, 3.0 * of_it) if elongation is None else high
    with in_terms_of(elongation=(low, high), diameter=diameter, **hollow):
        family.body(high)
    coefficients: Sequence[float | None] = [None]
    if unknown:
        coefficients = [0.0, STICKS]
    elif friction is not None:
        bottom, top = _prior("friction", friction, least=0.0)
        coefficients = [float(mu) for mu in bottom + (top - bottom) * np.linspace(0.0, 1.0, _FRICTIONS) ** 2]
    scatters: Sequence[float | None] = [None]
    if scatter is not None:
        bottom, top = _prior("scatter", scatter, least=_LEAST_SCATTER)
        if not top <= 1.0:
            raise ParameterError(wrong("scatter", scatter, "at most 1, as ε_n is"))
        scatters = np.geomspace(bottom, top, 1 + math.ceil(_SCATTERS * math.log10(top / bottom))).tolist()
    named = series_of(data, *NEEDED)
    for name, one in named.items():
        check_from_release(name, one)
    first = flight.fit(
        data if data is named.get("data") else named.values(), family.of_speed.name, scatter="fit"
    )
    reference = next(iter(first.parameters.values()))
    series = [Series.of(one, family.of_speed, reference, first.scatter, name) for name, one in named.items()]
    with in_terms_of(diameter=diameter, elongation=(low, high)):
        for measured, end in product(series, (low, high)):
            measured.check_release(family.body(end), law, setting.particles)
    if elongation is None:
        low = max(_resolved(series, family, coefficients[0], low, setting), 1.01 * high / _MOST_RANGE)
    nodes = np.geomspace(low, high, 1 + math.ceil(_SHAPES * math.log10(high / low)))

    def shaped(one: Series, parameter: float, x: float, mu: float | None, start: int) -> Array:
        return one.simulated(family.body(x), family.law_of(parameter, mu), setting.particles, start)

    smooth = table(series, family, shaped, nodes, scatters, coefficients, setting.particles, setting.seed)
    found = smooth
    if out_of_roundness is not None:
        place = max(math.log(max(of_it, _ROUNDEST)), found.axes[1][0])
        found = found.weighted(-0.5 * ((found.axes[1] - place) / _MEASURED) ** 2)
    rough = _rough(series, family, nodes, scatters, coefficients, setting)
    tables = (found, rough, smooth)
    return _tree(family, setting, tables, series, scatters=scatter is not None, unknown=unknown)


def _rough(
    series: Sequence[Series],
    family: Family,
    nodes: Array,
    scatters: Sequence[float | None],
    frictions: Sequence[float | None],
    setting: Setting,
) -> Table | None:
    """Return the likelihood over ln of the mean height of asperities that scatter ε as the shapes do.

    None where the ball is known to be smooth, or the law is one of which no closed form is known.
    """
    couplings = [family.coupling(mu) for mu in frictions]
    known = [q for q in couplings if q is not None]
    if setting.roughness == 0.0 or len(known) < len(couplings):
        return None
    radius = 0.5 * setting.diameter
    heights = _PER_SHAPE * radius * nodes**2
    # From k of the lowest asperities that hold to that of the highest that slide.
    low, high = min(known) * radius * heights[0], max(known) * radius * heights[-1]
    kicks = np.geomspace(low, high, 1 + math.ceil(0.5 * _SHAPES * math.log10(high / low)))

    def bounced(one: Series, parameter: float, kick: float, _: float | None, start: int) -> Array:
        return one.simulated_rough(parameter, kick, setting.particles, start)

    found = table(series, family, bounced, kicks, scatters, [None], setting.particles, setting.seed)
    # A likelihood over ln k is one over ln of the height, and over the friction where there are several.
    between, ends = Akima1DInterpolator(found.axes[1], found.values, axis=1), found.axes[1][[0, -1]]
    fine = np.geomspace(heights[0], heights[-1], found.axes[1].size)
    each = [between(np.clip(np.log(fine * (q * radius)), *ends)) for q in known]
    axes, values = [found.axes[0], np.log(fine), *found.axes[2:]], each[0]
    if len(known) > 1:
        axes, values = [*axes, np.array(frictions, dtype=np.float64)], np.stack(each, axis=-1)
    found = replace(found, axes=tuple(axes), values=np.asarray(values))
    if setting.roughness is not None:
        beyond = found.axes[1] - max(math.log(HEIGHT * setting.roughness), found.axes[1][0])
        found = found.weighted(-0.5 * (np.maximum(beyond, 0.0) / _MEASURED) ** 2)
    return found


def _resolved(
    series: Sequence[Series], family: Family, friction: float | None, low: float, setting: Setting
) -> float:
    """Return an L/R, at most `low`, that no series tells from 0; a shape's variance goes as (L/R)⁴."""
    law = family.law_of(family.inside(series[0].observed[0]), friction)
    part = 0.0
    for one in series:
        noise = one.noise(setting.particles, setting.seed)
        shape, none = (
            np.median(one.heard(flight, 0.0, noise).statistics[:, 1:3], axis=0)
            for flight in (
                one.simulated(family.body(x), law, setting.particles, setting.seed) for x in (low, 0.0)
            )
        )
        part = max(part, float(np.expm1(shape - none).max()))
    return low * min(1.0, (_UNSEEN / part) ** 0.25) if part > 0.0 else low


def _from_dict() -> Any:
    """Import what this alone needs."""
    try:
        from arviz_base import from_dict
    except ImportError:
        text = "a posterior needs ArviZ's arviz-base: pip install 'restitution[measure]'"
        raise ImportError(text) from None
    return from_dict


def _prior(name: str, value: object, *, least: float) -> tuple[float, float]:
    allowed = f"a pair (low, high) with {least:g} <= low < high"
    return pair(name, value, allowed, lambda low, high: least <= low < high < math.inf)


def _tree(
    family: Family,
    setting: Setting,
    tables: tuple[Table, Table | None, Table],
    series: Sequence[Series],
    *,
    scatters: bool,
    unknown: bool,
) -> xr.DataTree:
    found, rough, smooth = tables
    inferred = found.values.ndim > 2 + scatters and not unknown
    names = [*(["scatter"] if scatters else []), *(["friction"] if inferred else [])]

    def drawn(one: Table) -> tuple[dict[str, Array], Array]:
        points, log = one.draws(setting.draws + -setting.draws % _CHAINS, np.random.default_rng(setting.seed))
        chain = points.reshape(_CHAINS, -1, points.shape[1])
        values = {family.parameter: chain[..., 0], "surface": np.exp(chain[..., 1])}
        values |= {name: chain[..., 2 + place] for place, name in enumerate(names)}
        if scatters:
            values["scatter"] = np.exp(values["scatter"])
        # All speeds, g Δt/2, are off by one factor; ε, a ratio of times, is not.
        factor = np.random.default_rng([setting.seed, 1]).standard_normal(chain.shape[:-1]) * series[0].common
        values[family.parameter] = values[family.parameter] * np.exp(family.power * factor)
        return values, log.reshape(_CHAINS, -1)

    shaped, log = drawn(found)
    elongation = shaped.pop("surface")
    shaped = {
        family.parameter: shaped[family.parameter],
        "elongation": elongation,
        "out_of_roundness": 0.25 * setting.diameter * elongation,
    } | shaped
    groups = {
        "posterior": shaped,
        "sample_stats": {"lp": log},
        "observed_data": {"numbers": np.array([one.observed for one in series])},
    }
    tree: xr.DataTree = _from_dict()(groups, sample_dims=["chain", "draw"])
    roughness = None
    if rough is not None:
        asperities, _ = drawn(rough)
        roughness = asperities["roughness"] = asperities.pop("surface") / HEIGHT
        values = {name: (("chain", "draw"), each) for name, each in asperities.items()}
        tree["rough"] = xr.DataTree(xr.Dataset(values, coords=tree["posterior"].coords))
        tree["rough"]["roughness"].attrs["units"] = "m"
    for node in tree.subtree:  # the same draws are the same result, whenever they were made
        node.attrs.pop("created_at", None)
    tree["posterior"]["out_of_roundness"].attrs["units"] = "m"
    profile = found.profile(1)
    shape = xr.Dataset(
        {"profile": ("elongation", profile - profile.max(), {"long_name": "ln L, less its largest"})},
        coords={"elongation": np.exp(found.axes[1])},
    )
    tree["likelihood"] = xr.DataTree(shape)
    verdict = judge(found, rough, smooth, scatters=scatters)
    best = agreeing(found, rough)
    disagrees = disagreement(best)
    tree.attrs |= {
        "title": "Posterior from the times of impacts",
        "source": f"restitution {version('restitution')}",
        "law": f"normal = {family.law.normal!r}, friction unknown" if unknown else repr(family.law),
        "form": family.form,
        **setting.model_dump(exclude_none=True),
        "explained_by": verdict.cause,
        "log_bayes_factor_error": verdict.error,
        "log_bayes_factor_surface": verdict.for_surface,
        "log_bayes_factor_shape": verdict.for_shape,
        **({"log_bayes_factor_scatter": verdict.for_scatter} if scatters else {}),
        "elongation_determined": int(verdict.surface == "shape" and verdict.cause in ("shape", "both")),
        "elongation_upper_limit": found.limit(1),
        "answer": answer(verdict, shaped, roughness, 0.25 * setting.diameter * found.limit(1), disagrees),
        "predictive_p_value": min(1.0, len(best.signs) * min(best.signs)),
        "verdict": disagrees + sentence(found, rough, verdict, family, shaped, unknown=unknown),
    }
    if rough is not None:
        tree.attrs |= {
            "log_bayes_factor_roughness": verdict.for_roughness,
            "roughness_upper_limit": rough.limit(1) / HEIGHT,
        }
    return tree
