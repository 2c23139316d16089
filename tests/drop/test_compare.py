"""Bodies and laws side by side."""

import re
import warnings
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution import SimulationInterrupted
from restitution.drop.compare import _warn

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
            for variable in alone.variables:
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


def test_coordinates_of_bodies_and_laws(found: xr.Dataset) -> None:
    assert {*found.dims} == {*rs.statistics(BODIES["short"], LAWS[0], **RUN).dims, "body", "law"}
    for name, objects in (("body", list(BODIES.values())), ("law", LAWS)):
        parameters = found[f"{name}_parameters"]
        assert parameters.dims == (name,)
        assert parameters.values.tolist() == list(map(repr, objects))


def test_one_body_under_one_law() -> None:
    found = rs.compare([BODIES["short"]], [LAWS[1]], **RUN)
    assert found.sizes["body"] == found.sizes["law"] == 1
    assert found["law"].values.tolist() == ["Frictionless"]


def test_names_have_all_parameters_that_differ() -> None:
    bodies = [rs.Dumbbell(radius=r, separation=s) for r, s in ((1e-3, 1e-3), (2e-3, 3e-3))]
    found = rs.compare(bodies, [LAWS[1]], **(RUN | {"particles": 32, "impacts": 2}))
    assert found["body"].values.tolist() == [
        "Dumbbell(radius = 0.001, separation = 0.001)",
        "Dumbbell(radius = 0.002, separation = 0.003)",
    ]


def test_a_single_impact_that_creates_energy_is_told(found: xr.Dataset) -> None:
    one = found.isel(body=[0], law=[1]).copy()
    one["energy_created_impacts"][:] = 1
    with pytest.warns(rs.EnergyWarning, match="created kinetic energy in up to"):
        _warn(one)


def test_it_warns_once_and_names_the_laws() -> None:
    """Those that created energy on any of the bodies, and no others."""
    with pytest.warns(rs.EnergyWarning) as caught:
        rs.compare(BODIES, {"paper": LAWS[0], "smooth": LAWS[1]}, **RUN)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert str(caught[0].message).startswith("paper created kinetic energy in up to")
    with warnings.catch_warnings():
        warnings.simplefilter("error", rs.EnergyWarning)
        rs.compare(BODIES, LAWS[1:3], **RUN)


def test_the_warning_has_the_largest_share_and_factor(found: xr.Dataset) -> None:
    """Of the impacts of one run, and not of all runs together."""
    with pytest.warns(rs.EnergyWarning, match="up to") as caught:
        rs.compare(BODIES, {"paper": LAWS[0], "newton": LAWS[3]}, **RUN)
    kept = found.isel(law=[0, 3])
    share, largest = float(kept.energy_created_share.max()), float(kept.largest_energy_ratio_of_all.max())
    told = str(caught[0].message)
    assert (
        f"paper, newton created kinetic energy in up to {100 * share:.3g} % of the impacts of a run" in told
    )
    assert f"by a factor of {largest:.6g}. The law does this" in told
    assert caught[0].filename == __file__


def test_parameters_that_differ_are_coordinates(found: xr.Dataset) -> None:
    """Numbers with NaN, and words with nothing, where there are none; what is the same for all is no axis."""
    assert found["separation"].dims == ("body",)
    assert found["separation"].values.tolist() == [3e-4, 6e-3]
    assert found["separation"].attrs == {"long_name": "separation of the body", "units": "m"}
    assert found["friction"].dims == ("law",)
    np.testing.assert_array_equal(found["friction"], [np.nan, np.nan, 0.3, 0.3])
    assert found["friction"].attrs == {"long_name": "friction of the law", "units": "1"}
    assert found["hypothesis"].values.tolist() == ["", "", "stronge", "newton"]
    assert found["hypothesis"].attrs == {"long_name": "hypothesis of the law"}
    assert not {"radius", "density", "normal"} & set(found.coords)
    assert found.attrs["radius"] == 3e-3
    assert found.attrs["normal"] == 0.98
    assert found.attrs["title"].startswith("Statistics of the impacts of bodies")
    assert all(found[name].attrs["long_name"] for name in found.data_vars if "edges" not in str(name))
    assert found["velocity_edges"].dims == ("velocity_edge",)


def test_parameters_that_are_pairs_or_laws() -> None:
    """A pair is two coordinates with the unit of both, what is itself an object stands in words."""
    bodies = [
        rs.Dumbbell(radius=(3e-3, 2e-3), separation=3e-4),
        rs.Dumbbell(radius=3e-3, separation=3e-4),
        rs.Spheroid(equatorial=3e-3, polar=2e-3),
    ]
    steel = rs.Viscoelastic(young_modulus=1e9, poisson_ratio=0.3, dissipation=1e-6, density=1e3, radius=3e-3)
    laws = [rs.Frictionless(normal=steel), rs.Frictionless(normal=0.9)]
    found = rs.compare(bodies, laws, **(RUN | {"particles": 32, "impacts": 2}))
    nan = np.nan
    for name, values in {
        "radius_1": [3e-3, nan, nan],
        "radius_2": [2e-3, nan, nan],
        "radius": [nan, 3e-3, nan],
        "separation": [3e-4, 3e-4, nan],
        "equatorial": [nan, nan, 3e-3],
        "polar": [nan, nan, 2e-3],
    }.items():
        np.testing.assert_array_equal(found[name], values)
        assert found[name].attrs == {"long_name": f"{name} of the body", "units": "m"}
    assert "density" not in found.coords
    assert found["normal"].values.tolist() == [repr(steel), "0.9"]
    assert found["law"].values.tolist() == [f"Frictionless(normal = {steel!r})", "Frictionless(normal = 0.9)"]
    assert found["body"].values[2] == "Spheroid"
    densities = [
        rs.Dumbbell(radius=3e-3, separation=s, density=d) for s, d in ((1e-3, (1e3, 2e3)), (2e-3, 3e3))
    ]
    found = rs.compare(densities, laws[1:], **(RUN | {"particles": 32, "impacts": 2}))
    np.testing.assert_array_equal(found["separation"], [1e-3, 2e-3])
    np.testing.assert_array_equal(found["density_2"], [2e3, nan])
    assert found["density_2"].attrs["units"] == found["density"].attrs["units"] == "kg m-3"


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
    runs: list[Any] = [rs.statistics(BODIES["long"], LAWS[0], **RUN), SimulationInterrupted]
    begun = rs.statistics(BODIES["long"], LAWS[1], **(RUN | {"batches": 1}))

    def next_one(*_: Any, **__: Any) -> xr.Dataset:
        run = runs.pop(0)
        if isinstance(run, xr.Dataset):
            return run
        raise run(begun)

    monkeypatch.setattr("restitution.drop.compare.statistics", next_one)
    with pytest.raises(SimulationInterrupted) as stop:
        rs.compare({"long": BODIES["long"]}, LAWS[:2], **RUN)
    kept = stop.value.data
    assert kept.finished.to_numpy().tolist() == [[True, False]]
    alone = rs.statistics(BODIES["long"], LAWS[0], **RUN)
    for name in ("restitution_count", "mean_restitution_error"):
        np.testing.assert_array_equal(kept[name][0, 0], alone[name])
    assert np.isnan(kept.mean_restitution_error[0, 1]).all()
    assert np.array_equal(kept.velocity_edges, alone.velocity_edges)
    assert not kept.restitution_count[0, 1].any()
    assert kept.all_impacts.values.tolist() == [[alone.attrs["all_impacts"], 0]]
    assert kept.energy_created_impacts[0, 1] == kept.energy_created_share[0, 1] == 0
    assert kept.energy_created_share[0, 0] > 0
    assert kept.largest_energy_ratio_of_all[0, 1] == 1
    assert kept.attrs["incomplete"] == "interrupted: 1 of 2 combinations are finished"
    assert (kept.attrs["radius"], kept.attrs["seed"]) == (alone.attrs["radius"], 3)
    assert kept.finished.dims == ("body", "law")
    assert "whether" in kept.finished.attrs["long_name"]


def test_an_interruption_of_the_first_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leaves nothing but the shape of what would have been."""
    begun = rs.statistics(BODIES["short"], LAWS[1], **(RUN | {"batches": 1}))

    def stopped(*_: Any, **__: Any) -> xr.Dataset:
        raise SimulationInterrupted(begun)

    monkeypatch.setattr("restitution.drop.compare.statistics", stopped)
    with pytest.raises(SimulationInterrupted) as stop:
        rs.compare(BODIES, LAWS[:3], **RUN)
    kept = stop.value.data
    assert kept.finished.shape == (2, 3)
    assert not kept.finished.any()
    assert not kept.all_impacts.any()
    assert np.isnan(kept.mean_restitution).all()
    assert np.array_equal(kept.velocity_edges, begun.velocity_edges)


@pytest.mark.parametrize(
    ("bodies", "laws", "reason"),
    [
        ({}, LAWS, "bodies: must not be empty"),
        (BODIES["short"], LAWS, "bodies = Dumbbell.*must be a dict or list of Body"),
        (BODIES, ["frictionless"], "laws holds 'frictionless': must be objects of a CollisionLaw"),
        (BODIES, {1: LAWS[0]}, "laws: 1 is not a name"),
        (BODIES, [LAWS[0], LAWS[0]], "laws: TangentialRestitution appears twice"),
        (BODIES, [LAWS[1], LAWS[0], LAWS[0]], "laws: TangentialRestitution appears twice"),
        ("short", LAWS, "^bodies = 'short': must be a dict or list of Body"),
        (np.array(3.0), LAWS, "^bodies = .*3.*: must be a dict or list of Body"),
        (BODIES, {"one": 3}, "^laws holds 3: must be objects of a CollisionLaw"),
    ],
)
def test_bad_input_is_named(bodies: Any, laws: Any, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        rs.compare(bodies, laws, **RUN)


def test_progress_counts_combinations(capsys: pytest.CaptureFixture[str]) -> None:
    rs.compare(BODIES, LAWS[1:3], **RUN, progress=True)
    assert re.search(r"compare: .*4/4 .*combinations", capsys.readouterr().err)
    rs.compare(BODIES, LAWS[1:3], **RUN)
    assert not capsys.readouterr().err
