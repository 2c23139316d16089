"""Laws fitted to measured impacts: impacts of a planted law, the engine's own, and what the page says."""

import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import restitution as rs

ROOT = Path(__file__).parents[2]
SCRIPT: dict[str, Any] = runpy.run_path(str(ROOT / "examples" / "real_collisions.py"))
Impacts = SCRIPT["Impacts"]
SIZE = 4e-4
"""J/m in m²."""


def planted(normal: float, friction: float, noise: float, number: int, seed: int = 1) -> Any:
    """Impacts in a plane under Coulomb's law and Poisson's hypothesis, by steps in the normal impulse.

    The steps know neither the package nor a closed form: friction acts against the slip, and holds where a
    step would turn it.
    """
    rng = np.random.default_rng(seed)
    x, h = rng.uniform(-0.012, 0.012, number), rng.uniform(0.025, 0.035, number)
    vx, vz, w = rng.uniform(-1, 1, number), rng.uniform(-3, -2, number), rng.normal(0, 8, number)
    before = np.stack([vx, vz, w])
    slip, normal_velocity = vx - h * w, vz - x * w  # ω × r with r = (x, 0, -h) and ω along y
    kzz, kxx, kxz = 1 + x**2 / SIZE, 1 + h**2 / SIZE, h * x / SIZE
    impulse_x, impulse_z, end = np.zeros(number), np.zeros(number), np.full(number, np.inf)
    step = 1e-3
    for _ in range(12000):
        going = impulse_z < end
        holding = -(slip + step * kxz) / kxx  # what stops the slip within this step
        push = np.clip(holding, -friction * step, friction * step) * going
        impulse_x, impulse_z = impulse_x + push, impulse_z + step * going
        slip = slip + kxx * push + kxz * step * going
        normal_velocity = normal_velocity + kzz * step * going + kxz * push
        end = np.where(np.isinf(end) & (normal_velocity >= 0), (1 + normal) * impulse_z, end)
    spin = w - (x * impulse_z + h * impulse_x) / SIZE
    after = np.stack([vx + impulse_x, vz + impulse_z, spin])
    scale = noise * np.array([[1.0], [1.0], [1 / np.sqrt(SIZE)]])
    (vx, vz, w), (Vx, Vz, W) = (part + scale * rng.normal(size=part.shape) for part in (before, after))
    zero = np.zeros(number)
    columns = [(x, zero, -h), (vx, zero, vz), (zero, w, zero), (Vx, zero, Vz), (zero, W, zero)]
    return Impacts(*(np.stack(column, axis=1) for column in columns))


def test_the_law_that_made_the_impacts_is_found() -> None:
    """Steps of 10⁻³ m/s in an impulse of 4 m/s: parameters and motion to that."""
    impacts = planted(0.6, 0.15, noise=0.0, number=120)
    k, floor = SCRIPT["balance"](impacts)
    # Inertias are tried in steps of 1/400 of r², about 2·10⁻⁶ m².
    assert k == pytest.approx(SIZE, abs=1.5e-6)
    assert floor < 5e-3
    law, found = SCRIPT["fit"]("`Coulomb`, Poisson", impacts, SIZE)
    assert found["normal"] == pytest.approx(0.6, abs=2e-3)
    assert found["friction"] == pytest.approx(0.15, abs=1e-3)
    assert SCRIPT["distance"](impacts, *SCRIPT["predict"](law, impacts, SIZE), SIZE).mean() < 3e-3
    others = ("`Frictionless`", "`TangentialRestitution`", "Whittaker, a `CustomLaw`")
    for other in others:
        law, _ = SCRIPT["fit"](other, impacts, SIZE)
        assert SCRIPT["distance"](impacts, *SCRIPT["predict"](law, impacts, SIZE), SIZE).mean() > 0.05


def test_noise_moves_neither_inertia_nor_law_far() -> None:
    """With errors of 5 cm/s, as in the table of the ellipse: four standard errors, from repeated seeds."""
    impacts = planted(0.55, 0.19, noise=0.05, number=300, seed=3)
    k, floor = SCRIPT["balance"](impacts)
    assert k == pytest.approx(SIZE, rel=0.06)
    # One combination of six errors is left, √2 times 5 cm/s Gaussian: its mean size.
    assert floor == pytest.approx(0.05 * np.sqrt(2) * np.sqrt(2 / np.pi), rel=0.2)
    _, found = SCRIPT["fit"]("`Coulomb`, Poisson", impacts, k)
    assert found["normal"] == pytest.approx(0.55, abs=0.015)
    assert found["friction"] == pytest.approx(0.19, abs=0.01)


@pytest.mark.parametrize(
    "law",
    [
        rs.Coulomb(normal=0.4, friction=0.2),
        rs.ChatterjeeRuina(normal=0.4, friction=0.2, tangential=0.3),
        SCRIPT["whittaker"](0.4, 0.2),
    ],
)
def test_what_is_predicted_is_what_a_run_does(law: Any) -> None:
    """First impacts of a die thrown with spin, impact by impact to rounding."""
    die, fall = rs.Box(a=0.1, b=0.1, c=0.1), 0.2
    spin = np.random.default_rng(2).normal(size=(30, 3)) * 5
    data = rs.simulate(
        die,
        law,
        particles=30,
        impacts=1,
        release_height=fall,
        spin=spin,
        release_velocity=(1.0, 0.5, 0.0),
        seed=1,
        record="state",
    ).isel(impact=0)
    corners = np.array(np.meshgrid(*3 * [(-0.05, 0.05)])).reshape(3, 8).T
    arms = []
    for w, *v in data.attitude.to_numpy():
        turned = corners + 2 * np.cross(v, w * corners + np.cross(v, corners))
        arms.append(turned[np.argmin(turned[:, 2])])
    before, after = (
        [data[f"{name}_{time}"].to_numpy() for name in ("velocity", "angular_velocity")]
        for time in ("before", "after")
    )
    impacts = Impacts(np.array(arms), *before, *after)
    found = SCRIPT["predict"](law, impacts, 0.1**2 / 6)
    np.testing.assert_allclose(found[0], after[0], atol=1e-12)
    np.testing.assert_allclose(found[1], after[1], atol=1e-10)


def test_the_page_states_what_is_in_the_files() -> None:
    """Mean and deviation of ε, numbers of impacts, and the balance with and without what it found."""
    page = (ROOT / "docs" / "real-collisions.md").read_text(encoding="utf-8")
    table = np.genfromtxt(ROOT / "docs" / "data" / "ellipse.csv", delimiter=",", names=True)
    epsilon = -table["Vz"] / table["vz"]
    assert f"of all 2000 is {epsilon.mean():.3f} ± {epsilon.std():.3f}" in page
    ellipse, cube = SCRIPT["load"]("ellipse"), SCRIPT["load"]("cube")
    assert f"those {len(ellipse.arm)} impacts" in page
    assert f"{len(cube.arm)} tosses were kept" in page
    k, floor = SCRIPT["balance"](ellipse)
    assert f"$J/m = {1e4 * k:.1f}\\cdot10^{{-4}}$" in page.replace("\n  ", " ")
    assert f"{100 * (1 - 4 * k / (0.035**2 + 0.025**2)):.0f} % less" in page
    mirrored = {name: array * (-1.0, 1.0, 1.0) for name, array in vars(ellipse).items() if "velo" in name}
    before = SCRIPT["balance"](Impacts(**(vars(ellipse) | mirrored)))[1]
    assert f"falls from {before:.2f} to {floor:.2f} m/s" in page
    assert f"$J/m = {SCRIPT['balance'](cube)[0] / 0.0524**2:.2f}\\,a^2$" in page
