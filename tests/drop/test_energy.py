"""The energy ledger: what warns, what is counted, and when a law can create energy at all."""

import warnings
from typing import Any

import numpy as np
import pytest
import sympy as sp

import restitution as rs
from restitution.drop.energy import by_row, factor, ledger, ledger_of, percent, reported_elsewhere
from restitution.figures.laws import bound, coupling, growth
from restitution.laws import Law

SILENT: list[Law] = [
    rs.Frictionless(normal=1.0),
    rs.Coulomb(normal=1.0, friction=0.3),
    rs.Coulomb(normal=1.0, friction=1.0, hypothesis="poisson"),
    rs.ChatterjeeRuina(normal=1.0, tangential=1.0, friction=0.5),
    rs.TangentialRestitution(normal=0.7, tangential=-0.7),
]
BINS: dict[str, Any] = {
    "velocity_bins": np.linspace(0.2, 1.0, 9),
    "restitution_bins": np.linspace(-1.0, 3.0, 41),
}


@pytest.fixture
def long() -> rs.Dumbbell:
    """L/R = 0.5, where a third of the paper's impacts create energy."""
    return rs.Dumbbell(radius=3e-3, separation=1.5e-3)


def test_a_run_that_creates_energy_warns_once_and_says_how_much(
    long: rs.Dumbbell, law: rs.TangentialRestitution
) -> None:
    """Share, number, largest factor and the laws that cannot, in the message and in the attributes."""
    with pytest.warns(rs.EnergyWarning) as caught:
        data = rs.simulate(long, law, particles=50, impacts=100)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    ratio = data["energy_ratio"].to_numpy()
    created = int((ratio > 1 + 1e-12).sum())
    impacts = int(data["impacts"].sum())
    assert data.attrs["energy_created_impacts"] == created > 0
    assert data.attrs["all_impacts"] == impacts
    assert data.attrs["energy_created_share"] == created / impacts
    assert data.attrs["largest_energy_ratio"] == np.nanmax(ratio)
    message = str(caught[0].message)
    for part in (
        "TangentialRestitution",
        f"({created:,} of {impacts:,})",
        f"{np.nanmax(ratio):.6g}",
        "Frictionless",
    ):
        assert part in message


@pytest.mark.parametrize("law", SILENT, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize("elongation", [1e-6, 0.5, 2.0, 8.0])
def test_laws_that_cannot_create_energy_do_not_warn(law: Law, elongation: float) -> None:
    """Even where the laws conserve all of it: rounding stays a hundred times below the margin."""
    body = rs.Dumbbell(radius=3e-3, separation=3e-3 * elongation)
    with warnings.catch_warnings():
        warnings.simplefilter("error", rs.EnergyWarning)
        data = rs.simulate(body, law, particles=100, impacts=200)
        counted = rs.statistics(body, law, particles=100, impacts=200, **BINS)
    assert float(data["energy_ratio"].max()) < 1 + 1e-14
    for one in (data, counted):
        assert one.attrs["energy_created_impacts"] == 0
        assert "largest_energy_ratio" not in one.attrs
    assert int(counted["energy_created"].sum()) == 0
    assert bool(np.isnan(counted["largest_energy_ratio"]).all())


def test_statistics_count_what_simulate_records(long: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """Number and largest factor in each velocity bin, and in all even where bins leave impacts out."""
    run: dict[str, Any] = {"particles": 300, "impacts": 60, "seed": 5}
    data = rs.simulate(long, law, **run)
    with pytest.warns(rs.EnergyWarning, match="created kinetic energy in") as caught:
        found = rs.statistics(long, law, **run, **BINS)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    for name in ("all_impacts", "energy_created_impacts", "energy_created_share", "largest_energy_ratio"):
        assert found.attrs[name] == data.attrs[name]
    velocity, ratio = data["impact_velocity"].to_numpy(), data["energy_ratio"].to_numpy()
    edges = BINS["velocity_bins"]
    for k in range(edges.size - 1):
        inside = ratio[(velocity >= edges[k]) & (velocity < edges[k + 1])]
        gains = inside[inside > 1 + 1e-12]
        assert int(found["energy_created"][k]) == gains.size
        np.testing.assert_equal(float(found["largest_energy_ratio"][k]), max(gains, default=np.nan))
    assert 0 < int(found["energy_created"].sum()) < found.attrs["energy_created_impacts"]


def test_statistics_by_the_number_of_the_impact(long: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """No first impact from rest creates energy, as 1 - (1 - ε_n)(1 + ε) says; later ones do."""
    run: dict[str, Any] = {"particles": 300, "impacts": 6, "seed": 5}
    found = rs.statistics(long, law, **run, **(BINS | {"velocity_bins": None}))
    created = found["energy_created"].to_numpy()
    assert created[0] == 0
    assert created[1:].sum() == found.attrs["energy_created_impacts"] > 0


@pytest.mark.parametrize(
    "law",
    [
        rs.TangentialRestitution(normal=0.4, tangential=1.0),
        rs.TangentialRestitution(normal=0.4, tangential=-0.5),
        rs.Frictionless(normal=0.4),
    ],
    ids=["paper", "reversing", "frictionless"],
)
def test_the_first_impact_from_rest(law: Law) -> None:
    """Energy after over before is 1 - (1 - ε_n)(1 + ε): no slip, or no force along it, does work."""
    data = rs.simulate(rs.Dumbbell(radius=3e-3, separation=6e-3), law, particles=500, impacts=1)
    expected = 1 - (1 - 0.4) * (1 + data["restitution"])
    np.testing.assert_allclose(data["energy_ratio"], expected, rtol=0, atol=4e-15)


def test_the_condition_for_energy_not_to_grow() -> None:
    """K⁻¹ - D K⁻¹ D ≥ 0 is κ² ≤ (1 - ε_n²)(1 - ε_t²)/(1 + ε_n ε_t)²; trace and determinant of K D K⁻¹ D."""
    a, c, k, n, t = sp.symbols("a c kappa epsilon_n epsilon_t", real=True)
    b = k * sp.sqrt(a) * sp.sqrt(c)
    mobility, change = sp.Matrix([[a, b], [b, c]]), sp.diag(-n, t)
    loss = mobility.inv() - change * mobility.inv() * change
    # Diagonal entries are (1 - ε²) over a positive number; the determinant decides.
    expected = ((1 - n**2) * (1 - t**2) - k**2 * (1 + n * t) ** 2) / (a * c * (1 - k**2) ** 2)
    assert sp.simplify(loss.det() - expected) == 0
    factor = mobility * change * mobility.inv() * change
    assert sp.simplify(factor.trace() - (n**2 + t**2 + 2 * k**2 * n * t) / (1 - k**2)) == 0
    assert sp.simplify(factor.det() - n**2 * t**2) == 0


def test_growth_is_the_larger_eigenvalue() -> None:
    """Of K D K⁻¹ D by numpy; it exceeds 1 just where the condition is broken."""
    random = np.random.default_rng(1)
    for _ in range(500):
        kappa2, normal, tangential = random.uniform(0, 0.99), random.uniform(0, 1), random.uniform(-1, 1)
        mobility = np.array([[2.0, np.sqrt(2 * 3 * kappa2)], [np.sqrt(2 * 3 * kappa2), 3.0]])
        change = np.diag([-normal, tangential])
        largest = np.linalg.eigvals(mobility @ change @ np.linalg.inv(mobility) @ change).real.max()
        found = float(growth(np.array(kappa2), normal, tangential))
        assert found == pytest.approx(largest, rel=1e-10)
        limit = (1 - normal**2) * (1 - tangential**2) / (1 + normal * tangential) ** 2
        assert (found > 1) == (kappa2 > limit)


@pytest.mark.parametrize("tangential", [1.0, 0.7, 0.0, -0.5, -1.0])
def test_no_impact_exceeds_the_bound_at_its_angle(tangential: float) -> None:
    """Every recorded energy ratio obeys the bound of the angle at which the body touched."""
    body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    law = rs.TangentialRestitution(normal=0.9, tangential=tangential)
    data = rs.simulate(body, law, particles=500, impacts=100)
    ratio, angle = data["energy_ratio"].to_numpy(), data["angle"].to_numpy()
    happened = ~np.isnan(ratio)
    # Energy that the contact does not reach has the factor 1.
    allowed = np.maximum(1.0, growth(coupling(body, angle[happened]), 0.9, tangential))
    assert np.all(ratio[happened] <= allowed * (1 + 1e-13))
    assert ratio[happened].max() <= bound(body, 0.9, tangential) * (1 + 1e-6)
    assert (ratio[happened].max() > 1 + 1e-12) == (bound(body, 0.9, tangential) > 1)


def recorded(energy_ratio: Any) -> dict[str, Any]:
    """The ledger of impacts with these energy ratios, in which nothing pulls."""
    return ledger_of(np.ones_like(energy_ratio), np.ones_like(energy_ratio), energy_ratio)


def test_a_gain_of_just_the_bound_is_rounding() -> None:
    """Only what is above 1 + 1e-12 counts as created."""
    bound = 1.0 + 1e-12
    assert recorded(np.array([bound, np.nan, 0.5]))["energy_created_impacts"] == 0
    assert recorded(np.array([np.nextafter(bound, 2.0), np.nan, 0.5]))["energy_created_impacts"] == 1


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0.21, "21 %"),
        (1.0, "100 %"),
        (1.234e-4, "0.0123 %"),
        (3e-7, "0.00003 %"),
        (1.234e-7, "0.0000123 %"),
        (9.876e-8, "0.00000988 %"),
        (1e-8, "1e-06 %"),
        (2e-8, "0.000002 %"),
        (0.0, "0 %"),
        (2e-9, "2e-07 %"),  # nobody counts that many zeros
    ],
)
def test_shares_read_well(share: float, text: str) -> None:
    """Three digits, and no exponent in a sentence."""
    assert percent(share) == text


def test_a_factor_never_reads_as_one() -> None:
    """Gains of nearly round bodies are small, and are what the warning is about."""
    assert factor(2.7015346) == "2.70153"
    assert factor(1 + 5.6e-9) == "1 + 5.6e-09"
    assert factor(1.001) == "1.001"
    assert factor(1.0004) == "1 + 0.0004"


def test_a_run_without_impacts_has_a_ledger() -> None:
    """No share of nothing, and no factor."""
    empty = {"all_impacts": 0, "energy_created_impacts": 0, "energy_created_share": 0.0}
    assert ledger(0, 0, np.nan, 0) == empty
    assert ledger(1, 1, 2.0, 0)["energy_created_share"] == 1.0
    assert recorded(np.full((2, 3), np.nan)) == empty
    assert recorded(np.array([[0.5, np.nan], [1.0, 1 + 4e-12]])) == {
        "all_impacts": 3,
        "energy_created_impacts": 1,
        "energy_created_share": 1 / 3,
        "largest_energy_ratio": 1 + 4e-12,
    }


def test_energy_of_rows() -> None:
    """A factor only where impacts created energy; both say what they are."""
    found = by_row("velocity", np.array([0, 2, 1]), np.array([0.0, 3.0, 1.5]))
    assert [found[name][0] for name in found] == ["velocity"] * 2
    assert found["energy_created"][1].tolist() == [0, 2, 1]
    np.testing.assert_array_equal(found["largest_energy_ratio"][1], [np.nan, 3.0, 1.5])
    assert found["largest_energy_ratio"][2]["units"] == "1"
    assert all(found[name][2]["long_name"] for name in found)


def test_only_this_warning_is_reported_elsewhere() -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with reported_elsewhere():
            warnings.warn("energy", rs.EnergyWarning, stacklevel=1)
            warnings.warn("another", UserWarning, stacklevel=1)
        warnings.warn("afterwards", rs.EnergyWarning, stacklevel=1)
    assert [str(one.message) for one in caught] == ["another", "afterwards"]
