"""The Dataset of a run, and the file that it is written to and read from."""

import errno
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution._internal.datasets import load, put


@pytest.fixture(scope="module")
def data() -> xr.Dataset:
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.98)
    return rs.simulate(body, law, particles=3, impacts=4, orientation=[0.1, 0.2, 0.3])


def test_numbers_of_particles_and_impacts_are_coordinates(data: xr.Dataset) -> None:
    for name, size in (("particle", 3), ("impact", 4)):
        assert data[name].values.tolist() == list(range(size))
        assert data[name].attrs == {"long_name": f"number of the {name}, from 0"}


def test_angles_that_were_given_are_kept(data: xr.Dataset) -> None:
    assert data["orientation"].values.tolist() == [0.1, 0.2, 0.3]
    assert data["orientation"].attrs == {
        "long_name": "angle (and azimuth) of the axis at release, as given",
        "units": "rad",
    }


def test_a_run_that_was_finished_does_not_say_that_it_was_not(data: xr.Dataset) -> None:
    assert "incomplete" not in data.attrs


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (spoilt := tmp_path / "spoilt.nc").write_bytes(b"x" * 100)
    for path, told in ((spoilt, "NetCDF: Unknown file format"), (tmp_path / "none.nc", "No such file")):
        with pytest.raises(OSError, match=re.escape(told)) as raised:
            load(path)
        assert raised.value.filename == str(path)
        assert raised.value.errno

    def broken(*_: object, **__: object) -> None:
        raise ValueError("of a decoder")

    monkeypatch.setattr(xr, "open_dataset", broken)
    with pytest.raises(OSError, match="cannot be read as netCDF: of a decoder") as raised:
        load(spoilt)
    assert raised.value.filename == str(spoilt)


def test_records_say_how_many_impacts_there_were(data: xr.Dataset) -> None:
    assert data.attrs["all_impacts"] == np.isfinite(data["time"]).sum()


def test_a_run_says_where_it_comes_from(data: xr.Dataset) -> None:
    expected = {
        "title": "Impacts of bouncing aspherical particles",
        "Conventions": "CF-1.11",
        "source": f"restitution {rs.__version__}",
        "version": rs.__version__,
        "references": "A. Glielmo, N. Gunkelmann, T. Pöschel, Phys. Rev. E 90, 052204 (2014)",
    }
    assert data.attrs.items() >= expected.items()


def test_a_disk_that_netcdf_cannot_write_to(
    data: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The error is an OSError that names the file, where the system itself has nothing to say."""

    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("NetCDF: HDF error")

    monkeypatch.setattr(xr.Dataset, "to_netcdf", fail)
    with pytest.raises(OSError, match="cannot be written: NetCDF: HDF error") as raised:
        put(data, tmp_path / "draft")
    assert (raised.value.errno, raised.value.filename) == (errno.EIO, str(tmp_path / "draft"))
    assert raised.value.strerror == "cannot be written: NetCDF: HDF error"
    assert (tmp_path / "draft").stat().st_size == data.nbytes + 2**20, "room was asked for"


def test_records_of_the_state_have_vectors_and_the_body_they_are_of() -> None:
    """With the body's mass and moments of inertia, by which energies follow from velocities."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.98)
    given = [[0.1, 0.2], [0.3, 0.4]]
    plain = rs.simulate(body, law, particles=2, impacts=2, orientation=given)
    full = rs.simulate(body, law, particles=2, impacts=2, orientation=given, record="state")
    for data in (plain, full):
        assert data["orientation"].dims == ("particle", "angle_and_azimuth")
        assert data["orientation"].values.tolist() == given
        assert data.attrs["title"] == "Impacts of bouncing aspherical particles"
    assert full["component"].dims == ("component",)
    assert full["component"].values.tolist() == ["x", "y", "z"]
    assert full["component"].attrs == {"long_name": "z: the plane normal"}
    inertia = {name: getattr(body, name) for name in ("mass", "transverse_inertia", "axial_inertia")}
    assert full.attrs.items() >= inertia.items()
    assert "component" not in plain.coords
    assert "mass" not in plain.attrs
