"""Bodies and laws side by side."""

import warnings
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution import SimulationInterrupted

BODIES = {
    "short": rs.Dumbbell(radius=3e-3, separation=3e-4),
    "long": rs.Dumbbell(radius=3e-3, separation=6e-3),
}
LAWS = [
    rs.TangentialRestitution(normal=0.98),
    rs.Frictionless(normal=0.98),
    rs.Coulomb(normal=0.98, friction=0.3),
    rs.Coulomb(normal=0.98, friction=0.3, hypothesis="newton"),
]
RUN: dict[str, Any] = {
    "particles": 40,
    "impacts": 50,
    "seed": 3,
    "velocity_bins": np.linspace(0.0, 1.2, 13),
    "restitution_bins": np.linspace(-1.0, 3.0, 41),
}


@pytest.fixture(scope="module")
def found() -> xr.Dataset:
    return rs.compare(BODIES, LAWS, **RUN)


def test_each_combination_is_the_run_alone(found: xr.Dataset) -> None:
    """Every variable and every number of it, and the totals from the attributes."""
    assert list(found["body"].values) == ["short", "long"]
    for name, body in BODIES.items():
        for law, label in zip(LAWS, found["law"].values, strict=True):
            alone, here = rs.statistics(body, law, **RUN), found.sel(body=name, law=label)
            for variable in alone.data_vars:
                np.testing.assert_array_equal(here[variable], alone[variable], err_msg=str(variable))
            for total in ("all_impacts", "energy_created_impacts", "energy_created_share"):
                assert here[total].item() == alone.attrs[total]
            assert here["largest_energy_ratio_of_all"].item() == alone.attrs.get("largest_energy_ratio", 1.0)


def test_names_tell_what_differs(found: xr.Dataset) -> None:
    """By class, and parameters only where classes are not enough; every parameter stands beside."""
    assert list(found["law"].values) == [
        "TangentialRestitution",
        "Frictionless",
        "Coulomb(hypothesis = 'stronge')",
        "Coulomb(hypothesis = 'newton')",
    ]
    assert "friction=0.3" in found["law_parameters"].values[2]
    assert "separation=0.006" in found["body_parameters"].values[1]
    assert found.attrs["particles"] == 40
    assert "separation" not in found.attrs
    assert "energy_created_share" not in found.attrs


def test_it_warns_once_and_names_the_laws() -> None:
    """Those that created energy on any of the bodies, and no others."""
    with pytest.warns(rs.EnergyWarning) as caught:
        rs.compare(BODIES, {"paper": LAWS[0], "smooth": LAWS[1]}, **RUN)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert "under paper:" in str(caught[0].message)
    with warnings.catch_warnings():
        warnings.simplefilter("error", rs.EnergyWarning)
        rs.compare(BODIES, LAWS[1:3], **RUN)


def test_it_can_be_written_and_read(found: xr.Dataset, tmp_path: Any) -> None:
    """A netCDF file gives back the same."""
    found.to_netcdf(tmp_path / "found.nc")
    with xr.open_dataset(tmp_path / "found.nc") as again:
        xr.testing.assert_equal(found, again.load())


def test_rows_by_number() -> None:
    """Without velocity bins the rows are the numbers of the impacts, as in `statistics`."""
    found = rs.compare(BODIES, LAWS[1:2], **(RUN | {"velocity_bins": None}))
    assert found["restitution_count"].dims == ("body", "law", "impact", "restitution")


def test_an_interruption_keeps_what_was_finished(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C in the first batch of the second run, which has no standard errors yet: the first is whole."""
    runs: list[Any] = [rs.statistics(BODIES["short"], LAWS[1], **RUN), SimulationInterrupted]
    begun = rs.statistics(BODIES["short"], LAWS[2], **(RUN | {"batches": 1}))

    def next_one(*_: Any, **__: Any) -> xr.Dataset:
        run = runs.pop(0)
        if isinstance(run, xr.Dataset):
            return run
        raise run(begun)

    monkeypatch.setattr("restitution._compare.statistics", next_one)
    with pytest.raises(SimulationInterrupted) as stop:
        rs.compare({"short": BODIES["short"]}, LAWS[1:3], **RUN)
    kept = stop.value.data
    assert kept.finished.to_numpy().tolist() == [[True, False]]
    alone = rs.statistics(BODIES["short"], LAWS[1], **RUN)
    for name in ("restitution_count", "mean_restitution_error"):
        np.testing.assert_array_equal(kept[name][0, 0], alone[name])
    assert np.isnan(kept.mean_restitution_error[0, 1]).all()


@pytest.mark.parametrize(
    ("bodies", "laws", "reason"),
    [
        ({}, LAWS, "bodies: must not be empty"),
        (BODIES["short"], LAWS, "bodies = Dumbbell.*must be a dict or list of Body"),
        (BODIES, ["frictionless"], "laws holds 'frictionless': must be objects of a Law"),
        (BODIES, {1: LAWS[0]}, "laws: 1 is not a name"),
        (BODIES, [LAWS[0], LAWS[0]], "laws: TangentialRestitution is there twice"),
    ],
)
def test_bad_input_is_named(bodies: Any, laws: Any, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        rs.compare(bodies, laws, **RUN)


def test_arguments_of_the_runs_are_checked_in_its_own_name() -> None:
    with pytest.raises(TypeError, match=r"compare\(\): missing a required .*'velocity_bins'"):
        rs.compare(BODIES, LAWS)
    with pytest.raises(TypeError, match=r"compare\(\): got an unexpected keyword argument 'particle'"):
        rs.compare(BODIES, LAWS, **RUN, particle=3)


def test_progress_counts_combinations(capsys: pytest.CaptureFixture[str]) -> None:
    rs.compare(BODIES, LAWS[1:3], **RUN, progress=True)
    assert "4/4" in capsys.readouterr().err
