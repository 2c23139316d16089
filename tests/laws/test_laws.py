"""The laws: against an independent integration in the impulse, and what a run with each of them shows."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.friction import Contact, respond
from reference.refused import MATERIAL_TYPES
from restitution.drop.toml import read
from restitution.laws import Law

GLASS = rs.Viscoelastic(young_modulus=6e10, poisson_ratio=0.22, dissipation=1e-7, density=2500.0, radius=3e-3)
MATERIALS = [GLASS, rs.Plastic(yield_speed=0.05), rs.Tabulated(v=[0.1, 0.5, 1.0], e=[0.97, 0.95, 0.9])]
LAWS: list[Law] = [
    rs.TangentialRestitution(normal=0.98, tangential=0.5),
    rs.TangentialRestitution(normal=GLASS),
    rs.Frictionless(normal=0.98),
    rs.Frictionless(normal=MATERIALS[1]),
    rs.Coulomb(normal=0.9, friction=0.3),
    rs.Coulomb(normal=0.9, friction=0.3, hypothesis="poisson"),
    rs.Coulomb(normal=MATERIALS[2], friction=0.3, hypothesis="newton"),
    rs.ChatterjeeRuina(normal=0.9, tangential=0.0, friction=0.3),
]


def contact(random: np.random.Generator, *, planar: bool) -> Contact:
    """Draw a contact of a body of revolution that comes down with about unit speed."""
    inertia = random.uniform(0.3, 3.0)
    reach = 2.0 * np.sqrt(inertia)
    along, across = random.uniform(-1.5, 1.5, 2)
    return Contact(
        slip=(-random.uniform(0.1, 1.5), along, 0.0 if planar else across),
        arm=(-random.uniform(0.1, 1.0) * reach, random.uniform(-1.0, 1.0) * reach),
        inertia=inertia,
        across=random.uniform(1.0, 5.0),
    )


@pytest.mark.parametrize("planar", [True, False], ids=["plane", "space"])
@pytest.mark.parametrize("hypothesis", ["stronge", "poisson", "newton"])
def test_coulomb_is_the_integral_over_the_impulse(hypothesis: Any, planar: bool) -> None:
    """Slip, stick, reversal and jam, in the plane in closed form and in space by series, against DOP853.

    Its relative tolerance is 1e-13 a step; measured: at most 1e-12.
    """
    random = np.random.default_rng(14)
    for _ in range(60):
        one = contact(random, planar=planar)
        normal, friction = random.uniform(0.0, 1.0), random.uniform(0.0, 1.5)
        law = rs.Coulomb(normal=normal, friction=friction, hypothesis=hypothesis)
        expected = respond(one, normal, friction, hypothesis)
        triple, separation = law.compiled.respond(*one)
        impulse, size = np.array(triple), float(np.linalg.norm(expected))
        np.testing.assert_allclose(impulse, expected, rtol=0, atol=1e-11 * size)
        left = one.slip[0] + one.matrix[0] @ impulse
        assert separation == pytest.approx(left, abs=1e-13 * size)


def test_turning_slip_is_solved_alike_by_two_references() -> None:
    """The impulses to 28 digits that the core is held to, against DOP853; every tenth of them.

    The ends that SciPy finds are right to 1e-15 of the whole path, which is too much for the slowest impacts.
    """
    text = (Path(__file__).parents[2] / "crates/core/tests/friction/random.txt").read_text(encoding="utf-8")
    names = {"s": "stronge", "p": "poisson", "n": "newton"}
    for line in text.splitlines()[::10]:
        hypothesis, *numbers = line.split()
        v, u, w, inertia, height, side, across, friction, normal, *expected = map(float, numbers)
        if v < 1e-9:
            continue
        one = Contact(slip=(-v, u, w), arm=(height, side), inertia=inertia, across=across)
        found = respond(one, normal, friction, names[hypothesis])
        size = float(np.linalg.norm(expected[:3]))
        np.testing.assert_allclose(found, expected[:3], rtol=0, atol=1e-11 * size)


def test_the_first_impact_without_friction(body: rs.Dumbbell) -> None:
    """ε = -1 + (1 + ε_n)/(1 + mL² sin²θ/(4J_xx)) at every angle; for touching spheres its known moments.

    The angles are midpoints of 20000 equal parts: the smooth periodic integrals are exact, and the share of
    negative coefficients is to within two parts.
    """
    touching = rs.Dumbbell(radius=3e-3, separation=6e-3)
    angles = (np.arange(20_000) + 0.5) * np.pi / 20_000
    for one, normal in ((body, 0.98), (touching, 0.4)):
        data = rs.simulate(
            one, rs.Frictionless(normal=normal), particles=angles.size, impacts=1, orientation=angles
        )
        arm = one.mass * one.separation**2 * np.sin(angles) ** 2 / (4 * one.transverse_inertia)
        np.testing.assert_allclose(data.restitution[:, 0], -1 + (1 + normal) / (1 + arm), rtol=0, atol=4e-15)
    first = data.restitution.values[:, 0]
    assert first.min() == pytest.approx(-0.1833, abs=5e-5)
    assert first.mean() == pytest.approx(0.0693, abs=5e-5)
    assert first.std() == pytest.approx(0.2044, abs=5e-5)
    assert (first < 0).mean() == pytest.approx(0.462, abs=5e-4)


def test_the_law_dominates_the_result() -> None:
    """The particle of the paper's Fig. 2 at 0.4 m/s: without friction ε scatters three times as much.

    Ten thousand impacts of thousands of particles: the standard errors are below 1 % of σ and 2 % of the
    rotational fraction; the windows are more than three of them wide.
    """
    body = rs.Dumbbell(radius=10e-3, separation=1e-3)
    height = 10e-3 + 1 / (2 * 9.81)
    expected = {"paper": (0.0275, 0.042), "frictionless": (0.082, 0.28)}
    laws = {"paper": rs.TangentialRestitution(normal=0.98), "frictionless": rs.Frictionless(normal=0.98)}
    for name, law in laws.items():
        data = rs.simulate(body, law, particles=4000, impacts=200, release_height=height, seed=5)
        near = (abs(data.impact_velocity - 0.4) < 0.02).values
        found = (data.restitution.values[near].std(), data.rotational_fraction.values[near].mean())
        np.testing.assert_allclose(found, expected[name], rtol=0.06)


def test_energy_in_whole_runs() -> None:
    """A long body gains energy under the paper's law and never, to rounding, under those that cannot."""
    body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    never = [law for law in LAWS if not isinstance(law, rs.TangentialRestitution)]
    for law in (*never[:-2], rs.ChatterjeeRuina(normal=1.0, tangential=1.0, friction=0.5)):
        data = rs.simulate(body, law, particles=300, impacts=300)
        assert float(data.energy_ratio.max()) <= 1 + 1e-13
    assert float(rs.simulate(body, rs.TangentialRestitution(normal=0.98)).energy_ratio.max()) > 2


def test_stronge_where_slip_stops_in_compression() -> None:
    """W. J. Stronge, Proc. R. Soc. A 431, 169 (1990): e² is work of restitution over work of compression.

    v_n is linear in the impulse p: it grows by K_s = K_nn - sμK_nu while slip of sign s lasts, and by
    K_t = K_nn - K_nu²/K_uu while the contact sticks. Slip that stops at v_s < 0 leaves the work
    (v² - v_s²)/2K_s + v_s²/2K_t, hence v' = e√(v_s² + (v² - v_s²)K_t/K_s).
    """
    random = np.random.default_rng(5)
    met = 0
    while met < 200:
        one = contact(random, planar=True)
        normal, friction = random.uniform(0.0, 1.0), random.uniform(0.0, 1.5)
        (nn, nu), (_, uu) = one.matrix[0][:2], one.matrix[1][:2]
        sign = np.sign(one.slip[1])
        stops = -one.slip[1] / (nu - sign * friction * uu)
        sliding, sticking = nn - sign * friction * nu, nn - nu**2 / uu
        slow = one.slip[0] + sliding * stops
        if not (stops > 0 and slow < 0 and abs(nu / uu) < friction):
            continue
        met += 1
        _, separation = rs.Coulomb(normal=normal, friction=friction).compiled.respond(*one)
        square = slow**2 + (one.slip[0] ** 2 - slow**2) * sticking / sliding
        assert separation == pytest.approx(normal * np.sqrt(square), rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_statistics_count_what_simulate_records(body: rs.Dumbbell, law: Law) -> None:
    """Whatever the law, and also where the sums have no constant ε_n to be taken about."""
    size: dict[str, Any] = {"particles": 70, "impacts": 60, "seed": 3}
    data = rs.simulate(body, law, **size)
    counted = rs.statistics(
        body, law, velocity_bins=None, restitution_bins=np.linspace(-1, 2, 301), threads=2, **size
    )
    # Values are rounded to 2⁻²⁴ or, more than 2 from an ε_n in [0, 1], to 2⁻²⁰; the means are rounded, too.
    half = np.where(abs(data.restitution) > 1.0, 2.0**-21, 2.0**-25) + 1e-15 * abs(data.restitution)
    off = abs(counted["mean_restitution"] - data.restitution.mean("particle"))
    assert (off <= half.mean("particle")).all()


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_the_law_is_in_the_file(tmp_path: Path, body: rs.Dumbbell, law: Law) -> None:
    """Every parameter is a plain attribute that netCDF keeps; a material's follow the name `normal`."""
    data = rs.simulate(body, law, particles=2, impacts=2)
    data.to_netcdf(tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc") as back:
        attributes = back.attrs
    assert attributes["law"] == type(law).__name__
    expected = law.attributes()
    assert {name: attributes[name] for name in expected if np.ndim(expected[name]) == 0} == {
        name: value for name, value in expected.items() if np.ndim(value) == 0
    }
    if isinstance(law.normal, rs.Tabulated):
        assert attributes["normal"] == "Tabulated"
        np.testing.assert_array_equal(attributes["normal_v"], law.normal.v)
        np.testing.assert_array_equal(attributes["normal_e"], law.normal.e)


TOML = {
    "frictionless": ('type = "frictionless"\nnormal = 0.9', rs.Frictionless(normal=0.9)),
    "coulomb": (
        'type = "coulomb"\nfriction = 0.3\nhypothesis = "poisson"\nnormal = 1',
        rs.Coulomb(normal=1.0, friction=0.3, hypothesis="poisson"),
    ),
    "chatterjee-ruina": (
        'type = "chatterjee-ruina"\nfriction = 0.3\ntangential = 0\n'
        '[law.normal]\ntype = "plastic"\nyield_speed = 0.1',
        rs.ChatterjeeRuina(normal=rs.Plastic(yield_speed=0.1), tangential=0.0, friction=0.3),
    ),
    "viscoelastic": (
        'type = "tangential-restitution"\n[law.normal]\ntype = "viscoelastic"\nyoung_modulus = 6e10\n'
        "poisson_ratio = 0.22\ndissipation = 1e-7\ndensity = 2500.0\nradius = 3e-3",
        rs.TangentialRestitution(normal=GLASS),
    ),
    "tabulated": (
        'type = "frictionless"\nnormal = { type = "tabulated", v = [0, 1], e = [1, 0.9] }',
        rs.Frictionless(normal=rs.Tabulated(v=[0, 1], e=[1, 0.9])),
    ),
}
HEAD = '[body]\nshape = "dumbbell"\nradius = 3e-3\nseparation = 3e-4\n[law]\n'


@pytest.mark.parametrize("name", TOML)
def test_every_law_can_be_written_down(tmp_path: Path, name: str) -> None:
    text, expected = TOML[name]
    path = tmp_path / "run.toml"
    path.write_text(HEAD + text, encoding="utf-8")
    assert read(path).law == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            'type = "coulomb"\nhypothesis = "hertz"\n[law.normal]\ntype = "elastic"',
            [
                f"law.normal.type = 'elastic': must be {MATERIAL_TYPES}",
                "law.friction: missing; must be a real number in [0, 1e+100]",
                "law.hypothesis = 'hertz': must be 'stronge', 'poisson' or 'newton'",
            ],
        ),
        (
            'type = "frictionless"\n[law.normal]\ntype = "plastic"\nyield = 1',
            [
                "law.normal.yield: unknown; did you mean law.normal.yield_speed? "
                "[law.normal] takes type, yield_speed",
                "law.normal.yield_speed: missing; must be a finite number > 0 (m/s)",
            ],
        ),
        (
            'type = "frictionless"',
            ["law.normal: missing; must be a real number in [0, 1] or a table [law.normal]"],
        ),
    ],
    ids=["unknown material", "bad material", "no coefficient"],
)
def test_what_is_wrong_with_a_law_in_a_file(tmp_path: Path, text: str, expected: list[str]) -> None:
    path = tmp_path / "run.toml"
    path.write_text(HEAD + text, encoding="utf-8")
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - looked at below
        read(path)
    assert str(caught.value).splitlines() == [f"{path}: {line}" for line in expected]


@pytest.mark.parametrize("material", [rs.Plastic(yield_speed=0.1), rs.Tabulated(v=[0.0, 1.0], e=[0.9, 0.5])])
def test_speeds_are_in_metres_per_second_for_every_shape(material: rs.Plastic | rs.Tabulated) -> None:
    """A sphere has at every impact the coefficient of its speed in m/s, whichever engine follows it.

    Dumbbells of equal spheres go through the lanes, other hulls do not."""
    law = rs.Frictionless(normal=material)
    round_bodies = (
        rs.Dumbbell(radius=3e-3, separation=0.0),
        rs.LoadedSphere(radius=3e-3, density=2500.0, load=1e-3, offset=0.0),
        rs.Spheroid(equatorial=3e-3, polar=3e-3, density=2500.0),
    )
    for body in round_bodies:
        data = rs.simulate(body, law, particles=2, impacts=5)
        expected = material(data.impact_velocity.values)
        np.testing.assert_allclose(data.restitution, expected, rtol=1e-12)
