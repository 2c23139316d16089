"""Captions: what a figure shows, every parameter of it, and which are the paper's and which ours."""

import numpy as np
import xarray as xr

from restitution.papers.glielmo2014._data import QUANTILES
from restitution.papers.glielmo2014._settings import Settings

_BAND = "Band: ± one standard error, each particle counting as one draw; mostly narrower than the line."


def restitution_map(drawn: xr.Dataset, s: Settings) -> str:
    """Caption of Fig. 2."""
    return _join(
        "Fig. 2 redrawn. Coefficient of restitution ε (Eq. 1) against impact velocity v_G^n.",
        _colour(drawn["restitution_count"]),
        "The largest population is that of the first impacts, which arrive with nearly one velocity.",
        _share(drawn["restitution_count"], drawn),
        paper=[_lattice(s), f"L/R = {s.elongation:g}", *_law(drawn), _angle(drawn)],
        ours=_drop(drawn),
        drawn=drawn,
    )


def fraction_map(drawn: xr.Dataset, s: Settings) -> str:
    """Caption of Fig. 3."""
    return _join(
        "Fig. 3 redrawn. Rotational over total kinetic energy before the impact (Eq. 12) against impact",
        "velocity v_G^n.",
        _colour(drawn["fraction_count"]),
        _share(drawn["fraction_count"], drawn),
        paper=[f"L/R = {s.elongation:g}", *_law(drawn), _angle(drawn)],
        ours=[
            f"lattice with origin (0, 0), mesh {s.velocity_mesh:g} m/s × {s.fraction_mesh:g}",
            *_drop(drawn),
        ],
        drawn=drawn,
    )


def restitution_histograms(drawn: xr.Dataset, s: Settings) -> str:
    """Caption of Fig. 4."""
    fits = "; ".join(
        f"{float(part['speed']):g} m/s: {_number(part['number'])} impacts ({_number(part['outside'])} outside"
        f" the bins), m = {float(part['fit_location']):.4f}, a = {float(part['fit_above']):.4f},"
        f" b = {float(part['fit_below']):.4f} from {_number(part['fit_number'])} recorded ones"
        for part in _parts(drawn)
    )
    return _join(
        "Fig. 4 redrawn. Probability density of the coefficient of restitution ε (Eq. 1) at four impact",
        "velocities. Points: simulation, ± one standard error, each particle counting as one draw.",
        "Lines: asymmetric Laplace density, exp[−(ε−m)/a]/(a+b) above m and exp[−(m−ε)/b]/(a+b) below,",
        f"by maximum likelihood from the recorded impacts. {fits}.",
        paper=[f"L/R = {s.elongation:g}", _named_speed(s), *_law(drawn), _angle(drawn)],
        ours=[*_windows(s), f"bin widths {_list(s.histogram_widths)} in (a)-(d)", *_drop(drawn)],
        drawn=drawn,
        recorded="the fits and the standard errors",
    )


def fraction_histograms(drawn: xr.Dataset, s: Settings) -> str:
    """Caption of Fig. 5."""
    parts = _parts(drawn)
    numbers = ", ".join(f"{_number(part['number'])} at {float(part['speed']):g} m/s" for part in parts)
    return _join(
        "Fig. 5 redrawn. Probability density of the rotational over the total kinetic energy before the",
        f"impact (Eq. 12) at four impact velocities; impacts: {numbers}. Bars: ± one standard error, each",
        "particle counting as one draw. Lines join the points.",
        paper=[f"L/R = {s.elongation:g}", _named_speed(s), *_law(drawn), _angle(drawn)],
        ours=[*_windows(s), f"bin width {s.fraction_mesh:g}", *_drop(drawn)],
        drawn=drawn,
    )


def bead_deviation(drawn: xr.Dataset, s: Settings) -> str:
    """Caption of Fig. 6."""
    return _join(
        "Fig. 6 redrawn. Standard deviation σ of the coefficient of restitution (Eq. 1) against impact",
        f"velocity v_G^n. {_BAND} Steps above 0.5 m/s: beads so nearly round keep nearly the same share of",
        "their velocity at each impact, so that a bin holds the impacts of only one or two generations.",
        paper=[f"L/R = {_list(s.bead_elongations)}", *_law(drawn), _angle(drawn)],
        ours=[f"velocity bins of {s.deviation_mesh:g} m/s", *_drop(drawn)],
        drawn=drawn,
        each="for each L/R",
    )


def low_velocity_map(drawn: xr.Dataset, s: Settings) -> str:
    """Caption of Fig. 7."""
    return _join(
        "Fig. 7 redrawn. As Fig. 2, the same data, at low impact velocity v_G^n. Right branch of ε < 0,",
        "v_G^n > 0: the centre of mass falls before and after the impact. Left branch, v_G^n < 0: it rises",
        "before and after, and ε < −1 as the plane can only push.",
        _colour(drawn["restitution_count"]),
        "The most populated sites, at ε ≈ −1 and v_G^n ≈ 0, are the ever weaker impacts by which one",
        "sphere comes to lasting contact with the plane.",
        _share(drawn["restitution_count"], drawn),
        paper=[_lattice(s), f"L/R = {s.elongation:g}", *_law(drawn), _angle(drawn)],
        ours=_drop(drawn),
        drawn=drawn,
    )


def first_impact(drawn: xr.Dataset, s: Settings) -> str:
    """Caption of Fig. 9."""
    share, exact = float(drawn["negative"]), float(drawn["negative_exact"])
    error = np.sqrt(share * (1 - share) / float(drawn["number"]))
    return _join(
        "Fig. 9 redrawn. (a) Probability density of the coefficient of restitution ε (Eq. 1) at the first",
        "impact from rest: simulation, Eq. 21 with its misprints corrected, and Eq. 21 as printed. (b) Pull:",
        "(count − expected count) / standard error in each bin, expected from the corrected equation.",
        f"Simulated probability of ε < 0: {share:.3%} ± {error:.3%}; by the corrected equation {exact:.3%}.",
        paper=[f"L/R = {s.first_elongation:g}", *_law(drawn), _angle(drawn)],
        ours=[
            f"bin width {s.first_mesh:g}, the lowest bin cut off where the density begins",
            *_drop(drawn),
            "of which none matters here, since ε of a first impact depends on the angle alone",
        ],
        drawn=drawn,
    )


def map_sensitivity(drawn: xr.Dataset, s: Settings) -> str:
    """Caption of the sensitivity of Fig. 2."""
    low, _, high = QUANTILES
    return _join(
        f"How Fig. 2 depends on what the paper does not state: median (solid) and quantiles {low:g} and",
        f"{high:g} (dotted) of the coefficient of restitution ε (Eq. 1) against impact velocity v_G^n,",
        f"{_sides(s)}.",
        paper=[f"L/R = {s.elongation:g}", *_law(drawn), _angle(drawn)],
        ours=_variation(drawn, s),
        drawn=drawn,
        each="for each curve",
    )


def deviation_sensitivity(drawn: xr.Dataset, s: Settings) -> str:
    """Caption of the sensitivity of Fig. 6."""
    return _join(
        "How Fig. 6 depends on what the paper does not state: standard deviation σ of the coefficient of",
        f"restitution (Eq. 1) against impact velocity v_G^n, {_sides(s)}. {_BAND}",
        paper=[f"L/R = {s.bead_elongations[0]:g}", *_law(drawn), _angle(drawn)],
        ours=_variation(drawn, s),
        drawn=drawn,
        each="for each curve",
    )


def _join(
    *text: str,
    paper: list[str],
    ours: list[str],
    drawn: xr.Dataset,
    each: str = "",
    recorded: str = "the standard errors",
) -> str:
    about = drawn.attrs
    sizes = [
        f"{_number(about['particles'])} particles{f' {each}' if each else ''}, each followed for at most"
        f" {_number(about['impacts'])} impacts (ours), {_number(_impacts(drawn))} in all"
    ]
    if "impacts_counted" in about and "impacts_recorded" in about:
        sizes.append(
            f"recorded, for {recorded}, the first {_number(about['particles_recorded'])} particles"
            f"{f' {each}' if each else ''}, {_number(about['impacts_recorded'])} impacts in all"
        )
    run = f"Run: {'; '.join(sizes)}; {_seeds(about['seeds'])}; restitution {about['version']}."
    sources = [f"Stated in the paper: {'; '.join(paper)}.", f"Our choice: {'; '.join(ours)}."]
    return " ".join([*text, *sources, run])


def _seeds(seeds: list[int]) -> str:
    text = ", ".join(map(str, seeds))
    return f"seed {text}" if len(seeds) == 1 else f"seeds {text} in the order of the legend"


def _impacts(drawn: xr.Dataset) -> int:
    """Give the number of impacts behind a figure."""
    about = drawn.attrs
    return int(about["impacts_counted"] if "impacts_counted" in about else about["impacts_recorded"])


def _colour(count: xr.DataArray) -> str:
    most = _number(count.max())
    return (
        f"Colour: impacts at a lattice site divided by those at the most populated one ({most}); blank: none."
    )


def _share(count: xr.DataArray, drawn: xr.Dataset) -> str:
    share = float(count.sum()) / _impacts(drawn)
    return f"{share:.1%} of all impacts lie in the range drawn."


def _lattice(s: Settings) -> str:
    return f"lattice with origin (0, 0), mesh {s.velocity_mesh:g} m/s × {s.restitution_mesh:g}"


def _law(drawn: xr.Dataset) -> list[str]:
    return [f"ε_n = {drawn.attrs['normal']:g}", f"ε_t = {drawn.attrs['tangential']:g}"]


def _angle(drawn: xr.Dataset) -> str:
    about = {"uniform-angle": "θ uniform in [0, π)", "isotropic": "isotropic orientation"}
    return f"released from rest with {about[drawn.attrs['orientation']]}"


def _drop(drawn: xr.Dataset) -> list[str]:
    about = drawn.attrs
    return [
        f"R = {1e3 * about['radius']:g} mm",
        f"centre of mass released at {1e3 * about['release_height']:g} mm",
        f"g = {about['gravity']:g} m/s²",
    ]


def _sides(s: Settings) -> str:
    return (
        f"by (a) radius R, at h = {1e3 * s.release_height:g} mm;"
        f" (b) release height h of the centre of mass, at R = {1e3 * s.radius:g} mm"
    )


def _variation(drawn: xr.Dataset, s: Settings) -> list[str]:
    return [
        f"R = {_list(tuple(1e3 * r for r in s.radii))} mm",
        f"h = {_list(tuple(1e3 * h for h in s.heights))} mm",
        f"g = {drawn.attrs['gravity']:g} m/s²",
        f"velocity bins of {s.sensitivity_mesh:g} m/s",
    ]


def _named_speed(s: Settings) -> str:
    return f"impact velocity {s.lowest_speed:g} m/s"


def _windows(s: Settings) -> list[str]:
    others = f"impact velocities {_list(s.other_speeds)} m/s"
    return [others, f"windows of ± {s.speed_tolerance:.0%} about each velocity"]


def _parts(drawn: xr.Dataset) -> list[xr.Dataset]:
    return [drawn.isel(speed=k) for k in range(drawn.sizes["speed"])]


def _list(values: tuple[float, ...]) -> str:
    *most, last = (f"{value:g}" for value in values)
    return f"{', '.join(most)} and {last}" if most else last


def _number(value: xr.DataArray | int) -> str:
    return f"{int(value):,}".replace(",", " ")
