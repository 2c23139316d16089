"""Gases that are cut off and go on, that are followed on a cluster, and that become very cold."""

import math
import os
import signal
import threading
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.unit import dumbbell
from restitution._internal import datasets
from restitution.gas import _cool

SMOOTH = rs.Frictionless(normal=0.9)
GAS: dict[str, Any] = {
    "particles": 1000,
    "collisions": 30.0,
    "translational_temperature": 1.0,
    "seed": 3,
    "batches": 5,
    "record": "state",
    "distributions": True,
}


@pytest.mark.parametrize("heating", [0.0, 5.0])
def test_a_run_that_pauses_has_the_same_bits(
    heating: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its file is written whenever it can be; other threads go on, and a finished run is read."""
    how = GAS | {"particles": 4000, "heating": heating}
    whole = rs.gas.cool(dumbbell(1.0), SMOOTH, threads=1, **how)
    monkeypatch.setattr(_cool, "_EACH", 0.0)
    written = []

    def counted(data: xr.Dataset, path: Path, **how: Any) -> None:
        written.append(path)
        datasets.save(data, path, **how)

    monkeypatch.setattr(_cool, "save", counted)
    for threads in (2, 1):
        file = tmp_path / "gas.nc"
        found = rs.gas.cool(dumbbell(1.0), SMOOTH, threads=threads, checkpoint=file, **how)
        xr.testing.assert_identical(found, whole)
    assert len(written) > 1


def test_ctrl_c_loses_nothing(tmp_path: Path) -> None:
    """The same call goes on from where it was interrupted, as often as that happens."""
    file, stops, started = tmp_path / "gas.nc", 0, 0.0
    how = GAS | {"particles": 4000}
    whole = rs.gas.cool(dumbbell(1.0), SMOOTH, **how)
    while True:
        timer = threading.Timer(0.15, lambda: os.kill(os.getpid(), signal.SIGINT))
        try:
            timer.start()
            found = rs.gas.cool(dumbbell(1.0), SMOOTH, checkpoint=file, **how)
            timer.cancel()
            break
        except KeyboardInterrupt:
            with xr.open_dataset(file) as data:
                done = float((data["store"] != 0.0).sum())
            assert done >= started
            stops, started = stops + 1, done
            assert stops < 40
    xr.testing.assert_identical(found, whole)


def test_the_file_of_another_run(tmp_path: Path) -> None:
    file = tmp_path / "gas.nc"
    short = GAS | {"collisions": 1.0}
    rs.gas.cool(dumbbell(1.0), SMOOTH, checkpoint=file, **short)
    for other in ({"seed": 4}, {"collisions": 2.0}, {"translational_temperature": 2.0}):
        with pytest.raises(ValueError, match=r"checkpoint = .*must be a new file, or that of the same run"):
            rs.gas.cool(dumbbell(1.0), SMOOTH, checkpoint=file, **(short | other))
    with pytest.raises(ValueError, match="checkpoint = "):
        rs.gas.cool(dumbbell(1.0), rs.Frictionless(normal=0.8), checkpoint=file, **short)
    with pytest.raises(ValueError, match="must be the name of a netCDF file"):
        rs.gas.cool(dumbbell(1.0), SMOOTH, checkpoint=tmp_path / "gas.txt", **short)


def test_a_very_cold_gas_of_spheres() -> None:
    """A thousand collisions and more at ε = 0.5 take T below the smallest normal number.

    T falls by (1 - ε²)/3 = 1/4 of itself in a collision of each particle, with a₂ = 0.03 faster by 3a₂/16.
    """
    law = rs.Frictionless(normal=0.5)
    how: dict[str, Any] = {"particles": 400, "batches": 2, "translational_temperature": 1e-9, "samples": 6}
    with pytest.warns(rs.gas.GasWarning, match="cooled below the smallest normal numbers"):
        cold = rs.gas.cool(rs.Dumbbell(radius=1e-3, separation=0.0), law, collisions=3300, **how)
    power = cold["velocity_exponent"]
    assert int(power[0]) == 0
    assert int(power[-1]) >= 200
    logs = np.log(cold["translational_temperature"]) - 2.0 * math.log(2.0) * power
    falls = -np.diff(logs) / np.diff(cold["collisions"])
    np.testing.assert_allclose(falls, 0.25, rtol=0.03)
    assert np.isfinite(cold["a20"]).all()
    assert abs(float(cold["a20"][1:].mean())) < 0.15
    assert (cold["translational_temperature_error"][1:] > 0.0).all()
    # As long as numbers can say it, nothing is told too great.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        less = rs.gas.cool(rs.Dumbbell(radius=1e-3, separation=0.0), law, collisions=1100, **how)
    assert "velocity_exponent" not in less
    assert float(less["translational_temperature"][-1]) < 1e-110
    assert (np.diff(less["time"]) > 0.0).all()


def test_a_very_cold_gas_of_dumbbells() -> None:
    """Both temperatures fall alike, below what velocities are lifted at."""
    how: dict[str, Any] = {"particles": 100, "batches": 2, "spin_temperature": 0.0, "seed": 2, "samples": 4}
    body, law = dumbbell(1.0), rs.Frictionless(normal=0.3)
    data = rs.gas.cool(body, law, collisions=2000, translational_temperature=1e-60, **how)
    kept = data["rotational_temperature"] / data["translational_temperature"]
    assert float(data["translational_temperature"][-1]) < 1e-150
    assert (kept[1:] < 10.0).all()
    assert (kept[1:] > 0.1).all()


def test_rotation_that_outruns_translation_is_named() -> None:
    """Smooth dumbbells keep the spin about their axis while all else cools."""
    with pytest.raises(ValueError, match=r"collisions = .*spin_temperature is better 0"):
        rs.gas.cool(
            rs.Dumbbell(radius=1e-3, separation=1e-3),
            rs.Frictionless(normal=0.1),
            particles=4,
            batches=2,
            collisions=200,
            translational_temperature=1e-9,
            spin_temperature=1e-3,
        )


def test_gases_on_a_cluster() -> None:
    """As docs/gas.md says it: the same bits as here, whichever worker follows which gas."""
    distributed = pytest.importorskip("distributed")
    bodies = [dumbbell(elongation) for elongation in (0.5, 1.0)]
    how: dict[str, Any] = {
        "particles": 200,
        "collisions": 2.0,
        "translational_temperature": 1.0,
        "threads": 1,
    }
    with distributed.Client(
        processes=False, n_workers=2, threads_per_worker=1, dashboard_address=None
    ) as client:
        found = client.gather(client.map(lambda body: rs.gas.cool(body, SMOOTH, **how), bodies))
    for body, data in zip(bodies, found, strict=True):
        xr.testing.assert_identical(data, rs.gas.cool(body, SMOOTH, **how))
