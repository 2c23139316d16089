"""The energies of each kind of motion before and after impacts, and who pays for a rebound above the fall."""

import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution.drop.energy import reported_elsewhere

R = 3e-3
DUMBBELL = rs.Dumbbell(radius=R, separation=3e-4)
PAPER = rs.TangentialRestitution(normal=0.98)
SPIN: dict[str, Any] = {"spin": (30.0, 20.0, 10.0), "release_velocity": (0.3, 0.0, 0.0)}


@reported_elsewhere()
def states(body: rs.bodies.AnyBody, law: rs.laws.Law, **run: Any) -> xr.Dataset:
    how: dict[str, Any] = {"particles": 60, "impacts": 40, "record": "state", "seed": 3} | run
    return rs.simulate(body, law, **how)


@pytest.mark.parametrize(
    ("body", "law"),
    [
        (DUMBBELL, PAPER),
        (rs.Spheroid(equatorial=2e-3, polar=3e-3), rs.Coulomb(normal=0.9, friction=0.3)),
        (rs.Box(a=8e-3, b=9e-3, c=1e-2), rs.Coulomb(normal=0.9, friction=0.3)),
        (rs.Clump(spheres=[(0, 0, 0, 3e-3), (2e-3, 1e-3, 0, 2e-3)]), rs.Frictionless(normal=0.9)),
    ],
)
def test_the_kinds_add_up_to_what_the_engine_records(body: rs.bodies.AnyBody, law: rs.laws.Law) -> None:
    """Their sum has the recorded ratio of energies, and rotation the recorded share (12); 1e-12: rounding."""
    data = states(body, law, **SPIN)
    budget = rs.energy_budget(data)
    before, after = (budget[name].sum("energy", skipna=False) for name in ("before", "after"))
    np.testing.assert_allclose(after / before, data.energy_ratio, rtol=1e-12)
    np.testing.assert_allclose(
        budget.before.sel(energy="rotational") / before, data.rotational_fraction, rtol=1e-12, atol=1e-13
    )
    fall = 0.5 * body.mass * data.impact_velocity**2
    np.testing.assert_allclose(budget.before.sel(energy="vertical"), fall, rtol=1e-12)


def test_energy_waits_in_flight() -> None:
    """Over a level plane neither sideways motion nor rotation changes between impacts."""
    budget = rs.energy_budget(states(rs.Box(a=8e-3, b=9e-3, c=1e-2), rs.Coulomb(normal=0.9, friction=0.3)))
    kinds = ["sideways", "rotational"]
    np.testing.assert_allclose(
        budget.before.sel(energy=kinds)[:, 1:], budget.after.sel(energy=kinds)[:, :-1], rtol=1e-11
    )


@pytest.mark.parametrize("law", [PAPER, rs.TangentialRestitution(normal=0.9, tangential=0.0)])
def test_sideways_motion_and_rotation_are_as_in_rolling(law: rs.laws.Law) -> None:
    """To the order of L a body that is released without spin has the sideways velocity ωR after each impact.

    L/R = 1e-3 leaves 2e-3 of the largest; the ratio of the energies is mR²/J.
    """
    body = rs.Dumbbell(radius=R, separation=1e-3 * R)
    budget = rs.energy_budget(states(body, law, impacts=20)).after
    sideways = np.sqrt(budget.sel(energy="sideways") / body.mass)
    turning = R * np.sqrt(budget.sel(energy="rotational") / body.transverse_inertia)
    assert bool((abs(sideways - turning) < 2e-3 * turning.max("impact")).all())


def test_without_friction_rotation_pays_all() -> None:
    budget = rs.energy_budget(states(DUMBBELL, rs.Frictionless(normal=0.98), **SPIN))
    sideways = budget.sel(energy="sideways")
    np.testing.assert_allclose(sideways.after, sideways.before, rtol=1e-13)


@pytest.mark.parametrize("velocity_bins", [None, [0.1, 0.4, 1.2]])
@pytest.mark.parametrize("body", [DUMBBELL, rs.Ellipsoid(semi_axes=(3e-3, 3.2e-3, 3.5e-3))])
def test_statistics_are_means_of_the_budgets(
    body: rs.bodies.AnyBody, velocity_bins: list[float] | None
) -> None:
    run: dict[str, Any] = {"particles": 64, "impacts": 40, "seed": 3}
    data = states(body, PAPER, **run)
    with reported_elsewhere():
        found = rs.statistics(
            body, PAPER, velocity_bins=velocity_bins, restitution_bins=[0.0, 2.0], energy_budget=True, **run
        )
    change = rs.energy_budget(data)
    change = change.after - change.before
    if velocity_bins is None:
        rows = [data.impact == k for k in range(40)]
    else:
        rows = [(a <= data.impact_velocity) & (data.impact_velocity < b) for a, b in ((0.1, 0.4), (0.4, 1.2))]
    for k, row in enumerate(rows):
        np.testing.assert_allclose(
            found.energy_change[k], change.where(row).mean(("particle", "impact")), rtol=1e-10, atol=1e-18
        )
        above = change.where(row & (data.restitution > 1))
        assert found.above_one[k] == np.isfinite(above[..., 0]).sum()
        lost = above.sum(("particle", "impact"))
        if found.above_one[k]:
            assert float(found.paid_by_rotation[k]) == pytest.approx(float(lost[2] / (lost[1] + lost[2])))


def test_rotation_pays_two_sevenths() -> None:
    """Two runs differ by less than five of their standard errors; L/R = 0.1 is 0.005 above 2/7."""
    with reported_elsewhere():
        shares = [
            rs.statistics(
                DUMBBELL,
                PAPER,
                particles=400,
                impacts=150,
                seed=seed,
                velocity_bins=[0.1, 1.2],
                restitution_bins=[0.0, 2.0],
                energy_budget=True,
            )
            for seed in (1, 2)
        ]
    values = [float(one.paid_by_rotation[0]) for one in shares]
    error = sum(float(one.paid_by_rotation_error[0]) ** 2 for one in shares) ** 0.5
    assert abs(values[0] - values[1]) < 5 * error
    assert 2 / 7 < values[0] < 2 / 7 + 0.01


def test_shares_that_the_pages_state() -> None:
    """Of the film on README, and of the impact with the largest ε that stop 3 of the tour replays."""
    root = Path(__file__).parents[2]
    pictures = runpy.run_path(str(root / "examples" / "pictures.py"))
    film, stop = pictures["drops"](), states(DUMBBELL, PAPER, particles=250, impacts=50, seed=1)
    fast = stop.restitution.where(stop.impact_velocity > 0.1 * stop.impact_velocity.max())
    assert float(fast.max()) == float(fast[115, 49]) > 1.3
    for data, (particle, impact), stated, pages in (
        (film, pictures["GAIN"], "pays 98 %", ("README.md", "docs/index.md", "docs/gallery.md")),
        (stop, (115, 49), "rotation 29 %", ("web/src/tour.ts", "docs/tutorial-lecturer.md")),
    ):
        budget = rs.energy_budget(data).isel(particle=particle, impact=impact)
        lost = (budget.before - budget.after).sel(energy=["sideways", "rotational"])
        assert f"{float(lost[1] / lost.sum()):.0%}".replace("%", " %") in stated
        assert all(stated in (root / page).read_text(encoding="utf-8") for page in pages)


def test_data_without_states_are_refused() -> None:
    with reported_elsewhere():
        data = rs.simulate(DUMBBELL, PAPER, particles=2, impacts=3)
    with pytest.raises(ValueError, match=r"lacks velocity_before.*record=.state."):
        rs.energy_budget(data)
