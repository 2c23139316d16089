"""Check what `reduce` says of the impacts that it was given, which need not be those of a whole run."""

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution.drop.energy import LEDGER
from restitution.drop.reduce import standard_errors

VELOCITY, RESTITUTION = [0.0, 2.0], [-1.0, 3.0]


@pytest.fixture(scope="module")
def run() -> xr.Dataset:
    """Impacts under a law that creates energy in some of them, particle by particle at most 8."""
    with pytest.warns(rs.EnergyWarning):
        return rs.simulate(
            rs.Dumbbell(radius=3e-3, separation=3e-3),
            rs.TangentialRestitution(normal=0.98),
            particles=50,
            impacts=8,
        )


def ledger(data: xr.Dataset) -> dict[str, float]:
    return {name: data.attrs[name] for name in LEDGER if name in data.attrs}


def test_the_ledger_is_of_what_was_reduced(run: xr.Dataset) -> None:
    """Counted by hand from the energy ratios of the particles that were taken; of the whole run it is the
    run's own."""
    part = run.isel(particle=slice(3))
    ratio = part["energy_ratio"].to_numpy()
    created = ratio[ratio > 1.0 + 1e-12]
    impacts = int(np.isfinite(ratio).sum())
    assert 0 < created.size < run.attrs["energy_created_impacts"]
    assert ledger(rs.reduce(part, VELOCITY, RESTITUTION)) == {
        "all_impacts": impacts,
        "energy_created_impacts": created.size,
        "energy_created_share": created.size / impacts,
        "largest_energy_ratio": created.max(),
    }
    assert ledger(rs.reduce(run, VELOCITY, RESTITUTION)) == ledger(run)


def test_a_part_that_created_no_energy_has_no_largest_ratio(run: xr.Dataset) -> None:
    """The largest of the whole run would be wrong of it; a part without particles has no impacts at all."""
    quiet = run.isel(particle=~(run["energy_ratio"] > 1.0).any("impact").to_numpy())
    assert quiet.sizes["particle"] > 0
    for part, impacts in ((quiet, int(quiet["impacts"].sum())), (run.isel(particle=[]), 0)):
        assert ledger(rs.reduce(part, VELOCITY, RESTITUTION)) == {
            "all_impacts": impacts,
            "energy_created_impacts": 0,
            "energy_created_share": 0.0,
        }


def test_standard_errors_keep_no_ledger(run: xr.Dataset) -> None:
    """They take no energy ratios, so what the attributes of a part say of energy would be the run's."""
    found = standard_errors(run.isel(particle=slice(3)), VELOCITY)
    assert ledger(found) == {}
    assert found.attrs["body"] == run.attrs["body"]


@pytest.mark.parametrize("fraction", [1e300, -1.7e308, 2.0**33, np.inf])
@pytest.mark.filterwarnings("error")
def test_a_fraction_far_from_one_is_undefined(run: xr.Dataset, fraction: float) -> None:
    """E_rot/E_tot is in [0, 1]: what is as far off as an undefined restitution would overflow the moments."""
    spoilt = run.copy(deep=True)
    spoilt["rotational_fraction"][0, 0] = fraction
    found, good = (rs.reduce(data, VELOCITY, RESTITUTION) for data in (spoilt, run))
    assert int(found["undefined"].sum()) == 1
    assert int(found["number"].sum()) == int(good["number"].sum()) - 1
    assert np.isfinite(found["mean_fraction_error"]).all()
