"""The paper's proposal, and what is published on gases of rough or long grains, each sentence judged.

Quotations are from the paper, Sec. V, and from the abstracts of the others.
"""

import numpy as np
import xarray as xr

import restitution as rs
from restitution.papers.claims import SIGNIFICANT, Claims, Finding, Measurement, verdict
from restitution.papers.gases._figures import rate
from restitution.papers.gases._runs import Runs, across, half, late, ratio
from restitution.papers.gases._settings import Settings

CLAIMS: Claims[Runs, Settings] = Claims()
_PAPER = "Glielmo, Gunkelmann and Pöschel, PRE 90, 052204 (2014), Sec. V, DOI 10.1103/PhysRevE.90.052204"
_NEAR = 0.12
"""Relative difference of two rates up to which they count as one."""


@CLAIMS.add(
    "substantial",
    "We expect substantial differences of the kinetic properties of such gases as compared to gases of "
    "spherical particles.",
    _PAPER,
)
def substantial(runs: Runs, s: Settings) -> Finding:
    found = {
        (e, x): (rate(runs, s, (e, x), "grains"), _error(runs.grains[e, x]) / s.spheres(e))
        for e, x in runs.grains
    }
    apart = [abs(value - 1.0) > max(SIGNIFICANT * error, 0.1) for value, error in found.values()]
    value, _ = found[s.normals[0], s.slightly]
    return Finding(
        tuple(
            Measurement("rate of cooling, of spheres 1", *both, at=f"ε_n = {e:g}, L/R = {x:g}")
            for (e, x), both in found.items()
        ),
        verdict(all(apart), any(apart)),
        "Holds if smooth dumbbells of every L/R cool, in a collision, more than a tenth faster or slower "
        f"than smooth spheres, by more than {SIGNIFICANT:g} standard errors; in part if some do; fails "
        "otherwise.",
        f"A gas of nearly round grains, L/R = {s.slightly:g}, loses {1 / value:.1f} times less of its "
        f"temperature in a collision than one of spheres at ε_n = {s.normals[0]:g}.",
    )


def _error(data: xr.Dataset) -> float:
    """Return the standard error of -d ln T_tr/d(collisions) in the second half, from its two ends."""
    second = half(data)
    ends = second.isel(time=[0, -1])
    parts = ends["translational_temperature_error"] / ends["translational_temperature"]
    return float(np.hypot(*parts) / ends["collisions"].diff("time").item())


@CLAIMS.add(
    "fluctuating",
    "From our results we conclude that the assumption of a fluctuating coefficient of restitution is a "
    "possible way to extend the kinetic theory of granular gases to slightly nonspherical particles",
    _PAPER,
)
def fluctuating(runs: Runs, s: Settings) -> Finding:
    measured: list[Measurement] = []
    good: dict[str, list[bool]] = {"scaled": [], "kernel": []}
    names = {"scaled": "spheres with p(ε|v in thermal speeds)", "kernel": "spheres with E_rot drawn too"}
    for e, x in runs.rules:
        exact = rate(runs, s, (e, x), "grains")
        measured.append(Measurement("rate, the grains", exact, at=f"ε_n = {e:g}, L/R = {x:g}"))
        for rule, of in names.items():
            value = rate(runs, s, (e, x), rule)
            measured.append(Measurement(f"rate, {of}", value, at=f"ε_n = {e:g}, L/R = {x:g}"))
            good[rule].append(abs(value / exact - 1.0) < _NEAR)
    for (e, x), rules in runs.rules.items():
        for rule, of in (("pair", "p(ε|v) of a pair"), ("plane", "p(ε|v) of a body on a plane")):
            if rule in rules:
                end = float(rules[rule]["translational_temperature"][-1]) / s.temperature
                measured.append(Measurement(f"T_tr/T₀ at the end, {of}", end, at=f"ε_n = {e:g}, L/R = {x:g}"))
    return Finding(
        tuple(measured),
        verdict(all(good["scaled"]), all(good["kernel"][: len(s.elongations) - 1])),
        "Rates are of -ln T_tr over the collisions of a particle, of smooth spheres 1. Holds if spheres "
        f"that draw ε at v in thermal speeds cool as the grains to {100 * _NEAR:g} % at every L/R; in part "
        f"if they do where the change of E_rot is drawn too, up to L/R = {s.elongations[-2]:g}; fails "
        "otherwise.",
        "ε as a function of v alone stops the gas at a temperature that nothing in it sets, or cools it as "
        "spheres; ε together with the change of E_rot, at the T_rot/T_tr of the gas, cools it as the grains.",
    )


@CLAIMS.add(
    "two-stages",
    "cooling of both rough spheres and smooth needles proceeds in two stages: An exponentially fast decay "
    "to a state with stationary ratio of translational and rotational energy and a subsequent algebraic "
    "decay of the total energy",
    "Aspelmeier, Huthmann and Zippelius, Free cooling of particles with rotational degrees of freedom "
    "(2000); needles: Huthmann, Aspelmeier and Zippelius, PRE 60, 654 (1999)",
)
def two_stages(runs: Runs, s: Settings) -> Finding:
    measured, steady, powers = [], [], []
    for x in s.elongations[1:]:
        data = half(runs.grains[s.normals[0], x])
        warm = data["translational_temperature"]
        quotient = np.log(data["rotational_temperature"] / warm)
        change = float(quotient[-1] - quotient[0])
        # T = T₀/(1 + t/τ)²: T^(-1/2) is linear in t, and T falls as the power -2 of t + τ.
        times = data["time"].to_numpy()
        slope, first = np.polyfit(times, warm**-0.5, 1)
        power = -float(np.polyfit(np.log(np.abs(times + first / slope)), np.log(warm), 1)[0])
        at = f"L/R = {x:g}"
        measured += [
            Measurement("T_rot/T_tr", *ratio(runs.grains[s.normals[0], x]), at=at),
            Measurement("change of ln(T_rot/T_tr)", change, at=at),
            Measurement("power of 1/(t + τ)", power, at=at),
        ]
        steady.append(abs(change) < 0.05)
        powers.append(abs(power - 2.0) < 0.05)
    cold = runs.cold
    begun = (cold["rotational_temperature"] / cold["translational_temperature"]).to_numpy()
    wanted = rs.gas.theory.steady_ratio(s.dumbbell(s.elongations[0]), rs.Frictionless(normal=s.normals[0]))
    reached = np.interp(0.9 * wanted, begun, cold["collisions"])
    until = f"collisions until nine tenths of the ratio, from T_rot = 0, L/R = {s.elongations[0]:g}"
    measured.append(Measurement(until, reached))
    return Finding(
        tuple(measured),
        verdict(all(steady) and all(powers), all(steady)),
        f"Smooth dumbbells, ε_n = {s.normals[0]:g}, second half of the collisions. Holds if ln(T_rot/T_tr) "
        "changes by less than 0.05 and T_tr falls with a power of t + τ within 0.05 of -2, for every L/R "
        "but the smallest; in part if the first; fails otherwise.",
        f"So do dumbbells. The first stage is long for round ones: from T_rot = 0 it takes {reached:.0f} "
        f"collisions of a particle at L/R = {s.elongations[0]:g}.",
    )


def _rough(value: float) -> str:
    return f"β = {value:g}"


@CLAIMS.add(
    "rough-spheres",
    "both energies decay algebraically like t⁻² with a fixed ratio of amplitudes, different from 1",
    "Huthmann and Zippelius, PRE 56, R6275 (1997), DOI 10.1103/PhysRevE.56.R6275; the ratio is that of their "
    "Maxwellian theory",
)
def rough_spheres(runs: Runs, s: Settings) -> Finding:
    measured, near = [], []
    for value in s.roughness[1::2]:
        law = rs.TangentialRestitution(normal=s.rough_normal, tangential=-value)
        theory = rs.gas.theory.steady_ratio(s.dumbbell(0.0), law)
        found, error = ratio(runs.rough[value])
        measured += [
            Measurement("T_rot/T_tr", found, error, at=_rough(value)),
            Measurement("T_rot/T_tr, Maxwellian theory", theory, at=_rough(value)),
            Measurement("a₀₂", *late(runs.rough[value], "a02"), at=_rough(value)),
        ]
        near.append(abs(found / theory - 1.0) < 0.05)
    return Finding(
        tuple(measured),
        verdict(all(near), any(near)),
        f"Spheres with ε = {s.rough_normal:g}. Holds if T_rot/T_tr is that of the theory to 5 % for each β; "
        "in part for some; fails otherwise.",
        "Where spins exchange little, those of a few particles stay hot (a₀₂), and the ratio is below the "
        f"Maxwellian one: by {100 * (1 - measured[0].value / measured[1].value):.0f} % at {measured[0].at}.",
    )


@CLAIMS.add(
    "tennis-balls",
    "spins mostly perpendicular to the velocity ('sliced tennis ball'), parallel ('rifled bullet') only in a "
    "small range of the parameters [our words]",
    "Brilliantov et al., PRL 98, 128001 (2007), DOI 10.1103/PhysRevLett.98.128001; Kranz et al., EPJ ST "
    "179, 91 (2009), DOI 10.1140/epjst/e2010-01196-0",
)
def tennis_balls(runs: Runs, s: Settings) -> Finding:
    found = {value: late(data, "cos2_velocity_spin") for value, data in runs.rough.items()}
    below = [mean - 1 / 3 < -2.0 * error for mean, error in found.values()]
    above = [mean - 1 / 3 > SIGNIFICANT * error for mean, error in found.values()]
    return Finding(
        tuple(
            Measurement("<cos²> - 1/3, in %", 100 * (mean - 1 / 3), 100 * error, at=_rough(value))
            for value, (mean, error) in found.items()
        ),
        verdict(any(below) and not any(above), not any(above)),
        f"Spheres with ε = {s.rough_normal:g}. Holds if <cos²> between velocity and spin is below 1/3 by "
        f"more than two standard errors for some β and above it by {SIGNIFICANT:g} for none; in part if for "
        "none; fails otherwise.",
        "Spins are more often across the velocity, by less than a hundredth.",
    )


@CLAIMS.add(
    "friction",
    "for small ε and small μ, the dissipation of rotational energy is suppressed, so that the asymptotic "
    "state is characterized by constant rotational energy while the translational energy continues to "
    "decay; ε close to 1 and large μ: a constant ratio of rotational and translational energies",
    "Herbst, Huthmann and Zippelius, Granular Matter 2, 211 (2000)",
)
def friction(runs: Runs, s: Settings) -> Finding:
    gases = runs.friction["spheres"]
    loose, tight = gases[s.normals[1], s.frictions[0]], gases[s.normals[0], s.frictions[-1]]
    measured, kept = [], []
    for data, at in ((loose, "small ε, small μ"), (tight, "ε near 1, large μ")):
        second = half(data)
        falls = [
            -float(np.log(second[f"{of}_temperature"][-1] / second[f"{of}_temperature"][0]))
            for of in ("translational", "rotational")
        ]
        measured += [
            Measurement("fall of ln T_tr", falls[0], at=at),
            Measurement("fall of ln T_rot", falls[1], at=at),
        ]
        kept.append(falls[1] / falls[0])
    stays, alike = kept[0] < 0.1, abs(kept[1] - 1.0) < 0.1
    return Finding(
        tuple(measured),
        verdict(stays and alike, stays or alike),
        f"Spheres, ε_n = {s.normals[1]:g} and μ = {s.frictions[0]:g}, and {s.normals[0]:g} and "
        f"{s.frictions[-1]:g}; second half of the collisions. Holds if T_rot falls less than a tenth as "
        "fast as T_tr in the first, and as fast to a tenth in the second; in part if one; fails otherwise.",
        "Rotation stays where contacts slide to their end, and falls with translation where most end by "
        "rolling.",
    )


@CLAIMS.add(
    "rods",
    "energy equipartition between rotational and translational degrees of freedom was better satisfied as "
    "one gets closer to the elastic limit; scaled particle velocity distributions remain approximately "
    "Gaussian regardless of the particle shape",
    "Rubio-Largo et al., Physica A 443, 477 (2016)",
)
def rods(runs: Runs, s: Settings) -> Finding:
    found = {key: ratio(data) for key, data in runs.rods.items()}
    tails = {key: late(data, "a20") for key, data in runs.rods.items()}
    first, second = s.rod_normals

    def far(key: tuple[float, float]) -> float:
        return abs(float(np.log(found[key][0])))

    nearer = [far((x, first)) < far((x, second)) + 0.02 for x in s.rods]
    gaussian = [abs(value) < 0.03 for value, _ in tails.values()]
    return Finding(
        tuple(
            Measurement(name, *of[x, e], at=f"{x:g} diameters, ε_n = {e:g}")
            for name, of in (("T_rot/T_tr", found), ("a₂₀", tails))
            for x, e in found
        ),
        verdict(all(nearer) and all(gaussian), all(nearer) or all(gaussian)),
        f"Smooth rods, {', '.join(f'{x:g}' for x in s.rods)} diameters long. Holds if ln(T_rot/T_tr) at ε_n "
        f"= {first:g} is nearer to 0 than at {second:g}, to 0.02, and a₂₀ at most 0.03; in part if one; "
        "fails otherwise.",
        f"T_rot/T_tr is {', '.join(f'{found[x, first][0]:.2f}' for x in s.rods)} at ε_n = {first:g} and "
        f"{', '.join(f'{found[x, second][0]:.2f}' for x in s.rods)} at {second:g}.",
    )


@CLAIMS.add(
    "rods-in-flight",
    "We compare kinetic energies in the individual degrees of freedom, and find a slight predominance of "
    "the translational motions. In addition, we detect a certain preference of the grains to align with "
    "their long axis in flight direction",
    "Harth et al., PRL 120, 214301 (2018), DOI 10.1103/PhysRevLett.120.214301, an experiment",
)
def rods_in_flight(runs: Runs, s: Settings) -> Finding:
    warm, along = across(runs.long), late(runs.long, "cos2_velocity_axis")
    less, aligned = warm[0] < 1.0, along[0] - 1 / 3 > SIGNIFICANT * along[1]
    return Finding(
        (
            Measurement("T_rot/T_tr, across the axis", *warm),
            Measurement("<cos²> of velocity and axis, - 1/3", along[0] - 1 / 3, along[1]),
        ),
        verdict(less and aligned, less),
        f"Rods of {s.rods[-1]:g} diameters, ε_n = {s.long_normal:g}, μ = {s.long_friction:g}. Holds if "
        "T_rot/T_tr across the axis is below 1 and <cos²> of velocity and axis above 1/3 by "
        f"{SIGNIFICANT:g} standard errors; in part if the first; fails otherwise.",
        "Translation has more energy; "
        + ("rods fly along their axis." if aligned else "no alignment is seen."),
    )


@CLAIMS.add(
    "two-thirds",
    "Equipartition is violated, the rotational degrees of freedom were excited only to roughly 2/3 of the "
    "translational ones.",
    "Trittel et al., npj Microgravity 10, 81 (2024), DOI 10.1038/s41526-024-00420-5, an experiment with "
    "spheres",
)
def two_thirds(runs: Runs, s: Settings) -> Finding:
    tight, lossy = ratio(runs.friction["spheres"][s.normals[0], 0.5]), ratio(runs.lossy)
    return Finding(
        tuple(
            Measurement("T_rot/T_tr, μ = 0.5", *value, at=f"ε_n = {e:g}")
            for e, value in ((s.normals[0], tight), (s.lossy, lossy))
        ),
        verdict(tight[0] < 2 / 3 < lossy[0], abs(np.log(1.5 * tight[0])) < 0.3),
        f"Holds if 2/3 is between the ratios of spheres with μ = 0.5 at ε_n = {s.normals[0]:g} and "
        f"{s.lossy:g}; in part if the first is within a third of it; fails otherwise.",
        "Such spheres have it for an ε_n between.",
    )


@CLAIMS.add(
    "haff",
    "the kinetic energy dropped to about 5% of its initial value [after] three times the Haff time",
    "Trittel et al. (2024); Haff's law for ellipsoids: Pitikaris et al., npj Microgravity 8, 11 (2022), "
    "DOI 10.1038/s41526-022-00196-6; for planar dimers: Costantini et al., J. Chem. Phys. 122, 164505 "
    "(2005), DOI 10.1063/1.1884999",
)
def haff(runs: Runs, s: Settings) -> Finding:
    measured, near = [], []
    for x in s.elongations[1:]:
        body, law = s.dumbbell(x), rs.Frictionless(normal=s.normals[0])
        warm = {"translational_temperature": s.temperature, "number_density": s.number_density}
        tau = rs.gas.theory.haff_time(body, law, **warm)
        data = runs.grains[s.normals[0], x]
        # Beside 1/16, from T_rot = T_tr: at the end of the run, if that is earlier.
        end = min(3.0 * tau, float(data["time"][-1]))
        kept = np.exp(np.interp(end, data["time"], np.log(data["translational_temperature"] / s.temperature)))
        measured.append(Measurement("T_tr/T₀ after 3τ", float(kept), at=f"L/R = {x:g}"))
        near.append(abs(kept / (1.0 + end / tau) ** -2 - 1.0) < 0.3)
    return Finding(
        tuple(measured),
        verdict(all(near), any(near)),
        f"Smooth dumbbells, ε_n = {s.normals[0]:g}; Haff's law has 1/16. Holds if what is left is this to "
        "30 % for every L/R but the smallest; in part for some; fails otherwise.",
        f"What is left is {', '.join(f'{100 * m.value:.1f} %' for m in measured)}.",
    )
