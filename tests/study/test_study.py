"""Parameter studies: every point is the run it stands for, and its standard errors are those of particles."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference import measuring
from reference.command import Program, invoke
from reference.studies import SMALL_STUDY, bits, written
from restitution.study import Refused, estimate, merge, status, study_of, sweep
from restitution.study._results import study_in

BINS = {
    "velocity_bins": {"from": 0.0, "to": 1.1, "bins": 11},
    "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 40},
}


def tables(**more: object) -> dict[str, object]:
    return {
        "body": rs.Dumbbell(radius=3e-3, separation=3e-4),
        "law": rs.TangentialRestitution(normal=0.98),
        "run": {"particles": 64, "impacts": 60, "seed": 7},
        "sweep": {"body.separation": [1e-4, 2e-3]},
        "statistics": BINS,
        **more,
    }


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small study, undisturbed, on one thread."""
    folder = tmp_path_factory.mktemp("study")
    sweep(written(folder), folder / "study.zarr", threads=1)
    return folder / "study.zarr"


def test_every_point_is_the_run_it_stands_for_to_the_bit(store: Path) -> None:
    """Four batches counted apart and merged are the run in one go: counts and moments have the same bits."""
    found = xr.load_dataset(store, engine="zarr")
    assert found["std_restitution"].dims == ("separation", "normal", "velocity")
    assert found["separation"].values.tolist() == [1e-4, 3e-4, 2e-3]
    for separation in found["separation"].values:
        for normal in found["normal"].values:
            whole = rs.statistics(
                rs.Dumbbell(radius=3e-3, separation=float(separation)),
                rs.TangentialRestitution(normal=float(normal)),
                particles=64,
                impacts=60,
                seed=7,
                velocity_bins=np.linspace(0.0, 1.1, 12),
                restitution_bins=np.linspace(-1.0, 3.0, 41),
            )
            point = found.sel(separation=separation, normal=normal)
            exact = [str(name) for name in whole.data_vars if not str(name).endswith("_error")]
            for name in exact:  # a store has errors of its own, over its batches
                np.testing.assert_array_equal(point[name], whole[name], err_msg=name)
            np.testing.assert_array_equal(point["std_restitution"], np.sqrt(whole["variance"]))
    assert (found["status"] == 1).all()
    assert (found["particles"] == 64).all()


def test_threads_and_size_of_tasks_do_not_matter(
    store: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Three threads and a task for each batch, where the fixture has one for each point."""
    monkeypatch.setattr("restitution.study._tables.TASK", 64 * 60 // 4)
    study = study_of(written(tmp_path))
    assert study.effort.block_tasks == 4
    found = sweep(study, tmp_path / "fine.zarr", threads=3).load()
    plain = xr.load_dataset(store, engine="zarr")
    xr.testing.assert_identical(found.drop_attrs(deep=False), plain.drop_attrs(deep=False))


def test_standard_errors_are_those_of_particles(tmp_path: Path) -> None:
    """Jackknife over 64 groups against cluster-robust errors of the recorded impacts, which share no code.

    With 63 degrees of freedom the logarithm of a jackknife error scatters by 1/√126 = 9 % about the true one;
    the mean over 8 bins, which are correlated, by less than that. Three times as much is allowed.
    """
    from restitution.drop.reduce import standard_errors

    run = {"particles": 1024, "impacts": 100, "seed": 3}
    found = sweep(tables(run=run, effort={"batches": 64}), tmp_path / "s.zarr").isel(separation=0)
    data = rs.simulate(
        rs.Dumbbell(radius=3e-3, separation=1e-4),
        rs.TangentialRestitution(normal=0.98),
        particles=1024,
        impacts=100,
        seed=3,
    )
    expected = standard_errors(data, np.linspace(0.0, 1.1, 12))
    full = found["number"].values > 2000
    assert full.sum() >= 6
    for name, other in (
        ("mean_restitution", "mean"), ("variance", "variance"), ("std_restitution", "deviation"),
    ):  # fmt: skip
        ratio = found[f"{name}_error"].values[full] / expected[f"{other}_standard_error"].values[full]
        assert abs(np.log(ratio).mean()) < 0.27, name


def test_particles_are_added_until_the_error_is_reached(tmp_path: Path) -> None:
    """And the result is that of a study which had so many from the beginning."""
    effort = {"until": {"mean": 4e-3}, "velocities": (0.5, 0.8), "most_particles": 64 * 64}
    found = sweep(tables(effort=effort), tmp_path / "s.zarr", threads=2).load()
    window = found["mean_restitution_error"].sel(velocity=slice(0.5, 0.8))
    particles = found["particles"].values
    assert (window <= 4e-3).all()
    assert particles[0] == 64 < particles[1] < 64 * 64  # an elongated body scatters more
    for i, separation in enumerate((1e-4, 2e-3)):
        whole = rs.statistics(
            rs.Dumbbell(radius=3e-3, separation=separation),
            rs.TangentialRestitution(normal=0.98),
            particles=int(particles[i]),
            impacts=60,
            seed=7,
            velocity_bins=np.linspace(0.0, 1.1, 12),
            restitution_bins=np.linspace(-1.0, 3.0, 41),
        )
        np.testing.assert_array_equal(found["restitution_count"][i], whole["restitution_count"])
        np.testing.assert_array_equal(found["mean_restitution"][i], whole["mean_restitution"])
    again = sweep(tables(effort=effort), tmp_path / "other.zarr", threads=1)
    xr.testing.assert_identical(found, again.load())
    share = sweep(tables(effort=effort | {"until": {"mean": "0.5 %"}}), tmp_path / "share.zarr")
    share = share.sel(velocity=slice(0.5, 0.8))
    assert (share["mean_restitution_error"] <= 0.005 * share["mean_restitution"]).all()


@pytest.mark.parametrize("design", ["latin-hypercube", "sobol"])
def test_points_may_be_spread_over_all_parameters(tmp_path: Path, design: str) -> None:
    """Each parameter has one value in each eighth of its range, in both designs."""
    varied = {
        "design": design,
        "points": 8,
        "body.separation": {"from": 1e-5, "to": 1e-3, "scale": "log"},
        "law.normal": {"from": 0.5, "to": 0.9},
    }
    found = sweep(tables(sweep=varied), tmp_path / "s.zarr").load()
    assert found["std_restitution"].dims == ("point", "velocity")
    assert set(found.coords) >= {"separation", "normal"}
    for unit in (np.log10(found["separation"].values / 1e-5) / 2, (found["normal"].values - 0.5) / 0.4):
        assert sorted(np.floor(8 * unit).astype(int)) == list(range(8))
    body = rs.Dumbbell(radius=3e-3, separation=float(found["separation"][3]))
    law = rs.TangentialRestitution(normal=float(found["normal"][3]))
    whole = rs.simulate(body, law, particles=64, impacts=60, seed=7)
    point = found.isel(point=3)
    outside = point["velocity_underflow"] + point["velocity_overflow"] + point["undefined"].sum()
    assert int(point["number"].sum() + outside) == int(whole["impacts"].sum())


def test_the_results_can_be_saved_as_netcdf(store: Path, tmp_path: Path) -> None:
    data = xr.load_dataset(store, engine="zarr")
    data.to_netcdf(tmp_path / "study.nc")
    xr.testing.assert_identical(xr.load_dataset(tmp_path / "study.nc"), data)


def test_a_finished_study_is_only_looked_at(store: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in store.rglob("*") if path.is_file()}
    sweep(written(store.parent), store)
    assert before == {path: path.stat().st_mtime_ns for path in store.rglob("*") if path.is_file()}


def test_shards_in_one_store_and_in_several_merge_to_the_same_bits(store: Path, tmp_path: Path) -> None:
    study = written(tmp_path)
    for i in (1, 2, 3):
        assert invoke("sweep", study, "--out", tmp_path / "one.zarr", "--shard", f"{i}/3").exit_code == 0
        assert invoke("sweep", study, "--out", tmp_path / f"{i}.zarr", "--shard", f"{i}/3").exit_code == 0
    assert status(tmp_path / "one.zarr").finished == 0
    assert invoke("sweep", "merge", "--out", tmp_path / "one.zarr").exit_code == 0
    parts = [tmp_path / f"{i}.zarr" for i in (3, 1)]
    result = invoke("sweep", "merge", "--out", tmp_path / "all.zarr", *parts)
    assert result.exit_code == 1
    assert "4 of 6 points are finished (67 %), and 4 of 6 tasks are done." in result.stdout
    assert invoke("sweep", study, "--out", tmp_path / "all.zarr", "--status").stdout == (
        "4 of 6 points are finished (67 %), and 4 of 6 tasks are done.\n"
    )
    assert merge(tmp_path / "all.zarr", [tmp_path / "2.zarr"]).finished == 6
    assert bits(tmp_path / "one.zarr") == bits(tmp_path / "all.zarr") == bits(store)


def test_the_store_of_another_study_is_refused_with_what_differs(
    store: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = bits(store)
    other = tmp_path / "other.toml"
    text = written(tmp_path).read_text()
    other.write_text(text.replace("seed = 7", "seed = 8").replace("3e-4", "4e-4"))
    result = invoke("sweep", other, "--out", store)
    assert result.exit_code == 2
    assert "run.seed: 7 in the store, 8 here" in result.stderr
    assert "sweep.body.separation: [0.0001, 0.0003, 0.002] in the store" in result.stderr
    monkeypatch.setattr("restitution.study._identity.fingerprint", lambda: {"version": "9.9", "runs": "0"})
    with pytest.raises(Refused, match=r'install that version.*\n.*physics.runs: .*\n.*"9.9" here'):
        sweep(written(tmp_path), store)
    with pytest.raises(Refused, match="is not the store of a study"):
        sweep(written(tmp_path), tmp_path)
    with pytest.raises(Refused, match="physics"):
        merge(tmp_path / "new.zarr", [store], study=written(tmp_path))
    assert not (tmp_path / "new.zarr").exists()
    assert bits(store) == before


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"sweep": {}}, "sweep: nothing is varied"),
        ({"sweep": {"body.separaton": [1.0]}}, "separaton: unknown; did you mean"),
        ({"sweep": {"separation": [1.0]}}, 'sweep."separation": must be the table and the name'),
        ({"sweep": {"body.separation": []}}, r"sweep.body.separation = \[\]: must be a list of different"),
        ({"sweep": {"body.separation": ["a"]}}, "list of different numbers"),
        ({"sweep": {"body.separation": {"from": 0.0, "to": 1.0, "points": 1}}}, "whole number in"),
        ({"sweep": {"law.normal": {"from": 0, "to": 1, "points": 3, "scale": "log"}}}, "from = 0: must be"),
        ({"sweep": {"design": "sobol", "points": 6, "law.normal": {"from": 0, "to": 1}}}, "a power of 2"),
        ({"sweep": {"design": "spiral", "law.normal": [0.5]}}, "'spiral': must be 'grid' or"),
        ({"sweep": {"law.normal": [0.5, 1.5]}}, r"at law.normal = 1.5: .*normal = 1.5: must be"),
        ({"sweep": {"body.separation": [1e-4, 1.0]}}, "release_height = 0.06: must be at least"),
        ({"statistics": {}}, "statistics.restitution_bins: missing"),
        ({"statistics": {**BINS, "velocity": 3}}, "statistics.velocity: unknown; did you mean"),
        ({"effort": {"batches": 1}}, r"effort.batches = 1: must be a whole number in \[2, 64\]"),
        ({"effort": {"until": {"std": -1}}}, "effort.until.std = -1: must be a number > 0"),
        ({"effort": {"most_particles": 128}}, "is used with `until` only"),
        ({"measure": {"function": "no_such_module:f"}}, "importable where the study runs"),
        ({"measures": {}}, "measures: unknown; did you mean measure?"),
        ({"first_impact": {"mean": True}}, "an empty table"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_before_anything_is_written(
    tmp_path: Path, more: dict[str, object], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        sweep(tables(**more), tmp_path / "s.zarr")
    assert list(tmp_path.iterdir()) == []


def test_a_measure_that_fails_names_the_point(tmp_path: Path) -> None:
    def fails(_: xr.Dataset) -> xr.Dataset:
        raise ValueError("no such thing")

    with pytest.raises(ValueError, match=r"at body\.separation = 0\.0001: no such thing"):
        sweep(tables(measure=fails), tmp_path / "s.zarr", threads=1)
    assert status(tmp_path / "s.zarr").finished == 0


# In a process of its own: the garbage of other tests takes processor time, too.
FORETELLS = """
import json, sys, time
from pathlib import Path
from restitution.study import _sweep, estimate, study_of, sweep
study, out = study_of(sys.argv[1]), Path(sys.argv[2])
foretold = []
for _sweep._WHOLE in (2.0, 0.05):
    cost = estimate(study, 2)
    foretold.append((cost.points, cost.tasks, cost.particles, cost.most, cost.store, cost.seconds))
start = time.process_time()
sweep(study, out, threads=1)
took = time.process_time() - start
size = sum(file.stat().st_size for file in out.rglob("*") if file.is_file())
print(json.dumps([foretold, size, took]))
"""


def test_the_cost_is_foretold(tmp_path: Path) -> None:
    """Counts exactly; processor time and size within 30 %, from whole points or a part of their particles.

    Other work on the machine makes one of both slower than the other: the best of three tries counts.
    """
    path = tmp_path / "study.toml"
    path.write_text(SMALL_STUDY.format(impacts=100, normals=4).replace("= 64", "= 2048"), encoding="utf-8")
    off: list[list[float]] = []
    for out in ("1.zarr", "2.zarr", "3.zarr"):
        (whole, part), size, took = json.loads(Program(FORETELLS, path, tmp_path / out).said())
        assert whole[:4] == part[:4] == [12, 12, 12 * 2048, 1]
        assert abs(np.log(whole[4] / size)) < np.log(1.3)
        assert part[4] is None
        off.append([abs(np.log(cost[5] / took)) for cost in (whole, part)])
        if np.min(off, axis=0).max() < np.log(1.3):
            break
    assert np.min(off, axis=0).max() < np.log(1.3), off


def test_a_dry_run_writes_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    result = invoke("sweep", written(tmp_path), "--out", tmp_path / "s.zarr", "--dry-run")
    assert result.exit_code == 0
    assert re.fullmatch(
        r"The study has 6 points in 6 tasks, with 384 particles\.\n"
        r"These take .* s of processor time(, which \d+ threads share)?\. The store takes .* MB\.\n",
        result.stdout,
    )
    assert not (tmp_path / "s.zarr").exists()
    monkeypatch.setattr("restitution.study._sweep._WHOLE", 0.05)
    adaptive = estimate(study_of(tables(effort={"until": {"mean": 2e-3}})), 1)
    more = "128 particles, and at most 1024 times as many until the standard error is reached.\n"
    assert more in str(adaptive)


def test_elements_of_lists_are_varied_by_their_numbers() -> None:
    """A semi-axis, and the radius of a sphere of a clump; a number that there is none of is refused."""
    rest = {"law": rs.Frictionless(normal=0.9), "run": {"particles": 2}, "first_impact": {}}
    ellipsoid, clump = rs.Ellipsoid(semi_axes=(3e-3, 2e-3, 1e-3)), rs.Clump.example()
    spheres = {"body.spheres.0.3": [1.5e-3, 2.5e-3]}
    found = study_of({"body": ellipsoid, "sweep": {"body.semi_axes.2": [1e-3, 2e-3]}, **rest})
    assert found.run(1).body.semi_axes == (3e-3, 2e-3, 2e-3)  # type: ignore[attr-defined]
    assert found.design.dims == ("semi_axes_2",)
    found = study_of({"body": clump, "sweep": spheres, **rest})
    assert found.run(1).body == rs.Clump(spheres=[(*clump.spheres[0][:3], 2.5e-3), *clump.spheres[1:]])
    with pytest.raises(ValueError, match=r"sweep\.body\.semi_axes\.3: semi_axes is .* and has no"):
        study_of({"body": ellipsoid, "sweep": {"body.semi_axes.3": [1.0, 2.0]}, **rest})


def test_points_over_elements_have_the_bits_of_their_bodies(tmp_path: Path) -> None:
    """An exponent, and the radius of a sphere, which has the unit of its row."""
    ball = (0.0, 0.0, 0.0, 1.5e-3)
    exponent = [rs.Superellipsoid(semi_axes=(3e-3, 2e-3, 1e-3), exponents=(2.0, n)) for n in (2.5, 3.0)]
    radius = [rs.Clump(spheres=[ball, (2e-3, 0.0, 0.0, r)]) for r in (1e-3, 2e-3)]
    law = rs.Frictionless(normal=0.9)
    run: dict[str, Any] = {"particles": 8, "impacts": 3}
    edges = np.array([-9.0, 0.0, 1.0, 9.0])
    for key, values, unit, bodies in (
        ("exponents.1", [2.5, 3.0], "1", exponent),
        ("spheres.1.3", [1e-3, 2e-3], "m", radius),
    ):
        study = {"body": bodies[0], "law": law, "run": run, "sweep": {f"body.{key}": values}}
        study["statistics"] = {"restitution_bins": edges.tolist()}
        found = rs.sweep(study, out=tmp_path / key, threads=1)
        name = key.replace(".", "_")
        assert found[name].attrs["units"] == unit
        for value, body in zip(values, bodies, strict=True):
            alone = rs.statistics(body, law, velocity_bins=None, restitution_bins=edges, **run)
            for count in ("restitution_count", "mean_restitution"):
                np.testing.assert_array_equal(found[count].sel({name: value}), alone[count])


def test_studies_compare_and_hash_by_what_they_are() -> None:
    tables = measuring.study_tables()
    one, same = study_of(tables), study_of(tables)
    other = study_of(tables | {"sweep": {"law.normal": [0.8]}})
    assert one == same
    assert hash(one) == hash(same)
    assert one != other
    assert one != "study"


def test_several_bodies(tmp_path: Path) -> None:
    """Each with the bits of a study of its own; in a file with their names, and again from the store."""
    bodies = {"round": rs.Dumbbell(radius=3e-3, separation=3e-4), "a box": rs.Box(a=6e-3, b=5e-3, c=4e-3)}
    rest = {
        "law": rs.Frictionless(normal=0.9),
        "run": {"particles": 32, "impacts": 5, "orientation": "isotropic"},
        "statistics": {"restitution_bins": {"from": -1.0, "to": 3.0, "bins": 40}},
    }
    found = rs.sweep({"body": bodies, "sweep": {"law.normal": [0.8, 0.9]}, **rest}, out=tmp_path / "all")
    assert found["mean_restitution"].dims == ("body", "normal", "impact")
    assert found["body"].values.tolist() == [0.0, 1.0]
    assert found["body"].attrs["flag_meanings"] == "round a_box"
    for i, body in enumerate(bodies.values()):
        alone = rs.sweep({"body": body, "sweep": {"law.normal": [0.8, 0.9]}, **rest}, out=tmp_path / str(i))
        np.testing.assert_array_equal(found["mean_restitution"][i], alone["mean_restitution"])
    again = study_in(tmp_path / "all")
    assert list(again.bodies.values()) == list(bodies.values())
    assert "at body = 'a box'" in again.where(2)
    assert study_of({"body": list(bodies.values()), **rest}).design.dims == ("body",)
    file = tmp_path / "study.toml"
    file.write_text(
        '[[body]]\nname = "thick"\nshape = "dumbbell"\nradius = 3e-3\nseparation = 1e-3\n'
        '[[body]]\nname = "long"\nshape = "dumbbell"\nradius = 3e-3\nseparation = 6e-3\n'
        '[law]\ntype = "frictionless"\nnormal = 0.9\n[first_impact]\n',
        encoding="utf-8",
    )
    assert list(study_of(file).bodies) == ["thick", "long"]
    for more, message in (
        ({"sweep": {"body.radius": [1e-3, 2e-3]}}, r"sweep\.body"),
        ({"sweep": {"design": "sobol", "points": 2, "law.normal": {"from": 0.5, "to": 0.9}}}, r"'grid'"),
        ({"body": [bodies["round"]]}, "body = "),
    ):
        with pytest.raises(ValueError, match=message):
            study_of({"body": bodies, **rest, **more})
