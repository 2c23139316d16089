"""Whose a store is, what it says of itself, and what a merge of stores takes."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import zarr

from reference.studies import TINY, bits
from restitution.study import Refused, Status, merge, status, study_of, sweep
from restitution.study._identity import attribute, check, identity, readable
from restitution.study._results import open_store, study_in
from restitution.study._store import create_or_open
from restitution.study._study import Study

pytestmark = pytest.mark.usefixtures("small_tasks")


def test_whose_a_store_is(done: Path, tiny: Study) -> None:
    check(done, tiny)
    assert identity(done) == json.loads(attribute(tiny)["restitution_study"])
    assert study_in(done) == tiny
    with pytest.raises(Refused) as raised:
        check(done, study_of(TINY | {"run": TINY["run"] | {"seed": 8, "impacts": 21}}))
    told = str(raised.value).splitlines()
    assert told[0] == f"{done}: is the store of another study; write to a new store. What differs:"
    assert [line.strip() for line in told[1:]] == [
        "run.impacts: 20 in the store, 21 here",
        "run.seed: 7 in the store, 8 here",
    ]


def changed(done: Path, tmp_path: Path, change: Any) -> Path:
    """Copy the store and change what it says that it is."""
    path = tmp_path / "changed.zarr"
    shutil.copytree(done, path)
    file = path / "zarr.json"
    meta = json.loads(file.read_text())
    own = json.loads(meta["attributes"]["restitution_study"])
    own = change(own) or own
    meta["attributes"]["restitution_study"] = json.dumps(own)
    file.write_text(json.dumps(meta))
    return path


def test_a_store_of_another_physics(done: Path, tiny: Study, tmp_path: Path) -> None:
    """Says so; what is long is cut, and what is much is counted."""
    path = changed(
        done, tmp_path, lambda own: own["physics"].update({f"p{i:02}": "x" * 70 for i in range(14)})
    )
    with pytest.raises(Refused) as raised:
        check(path, tiny)
    told = str(raised.value).splitlines()
    advice = "install that version to go on with it, or write to a new store"
    assert told[0] == f"{path}: is the store of another study; {advice}. What differs:"
    assert told[1] == f'  physics.p00: "{"x" * 39} … {"x" * 11}" in the store, nothing here'
    assert len(told) == 14
    assert told[-1] == "  and 2 more"


def test_what_is_read_of_a_store_names_it_where_it_is_damaged(done: Path, tmp_path: Path) -> None:
    path = changed(done, tmp_path, lambda own: own.update(effort=None))
    for read in (status, study_in):
        with pytest.raises(Refused, match=rf"^{path}: is damaged \(TypeError: "):
            read(path)
    meta = json.loads((path / "zarr.json").read_text())
    meta["consolidated_metadata"]["metadata"]["normal"] = {}
    (path / "zarr.json").write_text(json.dumps(meta))
    with pytest.raises(Refused, match=rf"^{path}: is damaged \("):
        open_store(path)


@pytest.mark.parametrize(
    "content", [b"{}", b"[]", b"\xff", b"", b'{"attributes": {"restitution_study": "[1]"}}']
)
def test_what_is_no_store(content: bytes, tmp_path: Path, tiny: Study) -> None:
    (tmp_path / "zarr.json").write_bytes(content)
    for action in (
        lambda: identity(tmp_path),
        lambda: status(tmp_path),
        lambda: open_store(tmp_path),
        lambda: study_in(tmp_path),
        lambda: sweep(TINY, tmp_path),
        lambda: merge(tmp_path),
    ):
        with pytest.raises(Refused, match=r"is not the store of a study.*; give another path"):
            action()


def test_a_study_that_cannot_be_made_again(done: Path, tmp_path: Path) -> None:
    path = changed(done, tmp_path, lambda own: own["run"].update(impacts=-1))
    with pytest.raises(ValueError, match=r"changed\.zarr: its study cannot be made again: .*impacts"):
        study_in(path)


@pytest.mark.parametrize(
    "more",
    [
        {"effort": {"batches": 4, "until": {"std": "1 %"}, "velocities": (0.1, 0.9), "most_particles": 64}},
        {"effort": {"batches": 4, "until": {"mean": 0.1}}},
        {"measure": {"function": "math:floor", "of": "statistics"}},
    ],
    ids=["until in a range", "until", "measure"],
)
def test_a_study_is_read_back_from_its_store(more: dict[str, Any], tmp_path: Path) -> None:
    """With all that can be left out, and without."""
    study = study_of(TINY | more)
    create_or_open(tmp_path / "new.zarr", study, 5)
    assert study_in(tmp_path / "new.zarr") == study


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (KeyError("tasks"), r"store: is damaged \(KeyError: 'tasks'\)"),
        (OSError("of Zarr"), r"store: is damaged \(OSError: of Zarr\)"),
        (OSError(28, "of the system"), r"^\[Errno 28\] of the system: 'store'$"),
        (OSError(28, "of the system", "c/.partial"), r"^\[Errno 28\] of the system: 'store'$"),
        (PermissionError(13, "of a chunk", "store/c"), r"^\[Errno 13\] of a chunk: 'store/c'$"),
        (Refused("already"), "^already$"),
        (MemoryError("much"), "^much$"),
        (RuntimeError("other"), r"store: is damaged \(RuntimeError: other\)"),
    ],
)
def test_errors_of_a_store_name_it(error: Exception, told: str) -> None:
    """Of the system they stay what they are."""
    kind = Refused if "damaged" in told else type(error)
    with pytest.raises(kind, match=told), readable(Path("store")):
        raise error


def test_the_status_counts_what_is_there(done: Path, tmp_path: Path) -> None:
    found = status(done)
    assert (found.points, found.finished, found.tasks, found.there) == (6, 6, 12, 12)
    assert str(found) == "6 of 6 points are finished (100 %), and 12 of 12 tasks are done."
    opened = open_store(done)
    assert opened["mean_restitution"].dims == ("separation", "normal", "velocity")
    assert not opened.chunks, "read when it is needed, and by no library besides"
    part = tmp_path / "part.zarr"
    sweep(TINY, part, shard=(2, 4), threads=1)
    found = status(str(part))
    assert (found.points, found.finished, found.tasks, found.there) == (6, 0, 12, 4)
    merge(part)
    assert str(status(part)) == "2 of 6 points are finished (33 %), and 4 of 12 tasks are done."
    with pytest.raises(Refused, match=r"none\.zarr: does not exist"):
        status(tmp_path / "none.zarr")
    with pytest.raises(ValueError, match=r"^out = 3: must be the path"):
        status(3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"^path = 3: must be the path"):
        open_store(3)  # type: ignore[arg-type]


def test_a_merge_takes_what_is_there(done: Path, tiny: Study, tmp_path: Path) -> None:
    """From any of the parts, which stay as they are; what is there already is not written again."""
    parts = [tmp_path / f"{i}.zarr" for i in (1, 2)]
    for i, part in enumerate(parts, start=1):
        sweep(TINY, part, shard=(i, 2), threads=1)
    words = Path("tasks") / "words" / "c"
    spoilt = parts[0] / words / "0" / "1" / "0"
    whole = spoilt.read_bytes()
    spoilt.write_bytes(whole[:-7])
    with pytest.raises(OSError, match="is damaged; delete it") as raised:
        merge(tmp_path / "all.zarr", parts, threads=1)
    assert raised.value.filename == str(spoilt)
    spoilt.unlink()
    before = [bits(part) for part in parts]
    found = merge(tmp_path / "all.zarr", list(map(str, parts)), threads=1)
    assert (found.points, found.finished, found.there) == (6, 5, 11)
    assert [bits(part) for part in parts] == before
    kept = tmp_path / "all.zarr" / words / "1" / "0" / "0"
    at = kept.stat().st_mtime_ns
    spoilt.write_bytes(whole)
    (tmp_path / "all.zarr" / words / "2" / "1" / "0").unlink()
    found = merge(tmp_path / "all.zarr", parts, study=TINY)
    assert (found.finished, found.there) == (6, 12)
    assert kept.stat().st_mtime_ns == at
    assert bits(tmp_path / "all.zarr") == bits(done)


@pytest.mark.parametrize(
    ("out", "parts", "told"),
    [
        ("none.zarr", [], r"^out = 'none\.zarr': there is no such store, and no parts for it"),
        (3, [], r"^out = 3: must be the path"),
        ("none.zarr", "one.zarr", r"^parts = 'one\.zarr': must be a list of paths"),
        ("none.zarr", 3, r"^parts = 3: must be a list of paths"),
        ("none.zarr", [3], r"^parts\[0\] = 3: must be the path"),
        ("none.zarr", ["none"], "none: does not exist; must be the store"),
        ("none.csv", ["done"], r"^out = 'none\.csv': must be the name of a Zarr store"),
    ],
)
def test_what_cannot_be_merged(
    out: Any, parts: Any, told: str, done: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=told):
        merge(out, [str(done)] if parts == ["done"] else parts)
    assert not list(tmp_path.iterdir())


def test_parts_of_another_study_are_refused(done: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.zarr"
    sweep(TINY | {"run": TINY["run"] | {"seed": 8}}, other, shard=(1, 6), threads=1)
    for out in (tmp_path / "all.zarr", done):
        with pytest.raises(Refused, match=r"other\.zarr: is the store of another study"):
            merge(out, [done, other])
    assert not (tmp_path / "all.zarr").exists()


WORDS = Path("tasks") / "words"


def reshaped(name: Path | str, **to: Any) -> Callable[[Path], object]:
    """Change what an array says of itself."""

    def harm(store: Path) -> None:
        file = store / name / "zarr.json"
        file.write_text(json.dumps(json.loads(file.read_text()) | to))

    return harm


def filled(name: str, value: int) -> Callable[[Path], object]:
    def harm(store: Path) -> None:
        array: Any = zarr.open_group(str(store), mode="r+")[name]
        array[...] = value

    return harm


HARMS: dict[str, tuple[Callable[[Path], object], str | None, str | None]] = {
    # what is done to a store; what is then said by its status, and by a sweep that goes on with it
    "many points": (reshaped(WORDS, shape=[10**12, 4, 598]), "of 1000000000000 points", "words is uint64 of"),
    "no points": (reshaped(WORDS, shape=[0, 4, 598]), "tasks of 0 points, and the status of 6", "words is"),
    "a point less": (
        reshaped(WORDS, shape=[5, 4, 598]),
        "tasks of 5 points",
        "tasks/words is uint64 of shape",
    ),
    "few words": (reshaped(WORDS, shape=[6, 4, 3]), None, "tasks/words is uint64 of shape"),
    "other chunks": (
        reshaped(WORDS, chunk_grid={"name": "regular", "configuration": {"chunk_shape": [1, 4, 598]}}),
        None,
        r"the chunks of tasks/words are \(1, 4, 598\)",
    ),
    "other words": (
        reshaped(WORDS, data_type="float64", fill_value=0.0),
        None,
        "words is float64 of shape .* instead of uint64",
    ),
    "no status": (lambda store: shutil.rmtree(store / "status"), "KeyError: 'status'", "KeyError: 'status'"),
    "no axis": (lambda store: shutil.rmtree(store / "normal"), None, "KeyError: 'normal'"),
    "much status": (reshaped("status", shape=[10**6, 10**6]), "status of 1000000000000", "status is uint8"),
    "many results": (reshaped("mean_restitution", shape=[2, 3, 50]), None, "mean_restitution is float64"),
    "particles without end": (filled("particles", 2**62), None, None),
    "particles below none": (filled("particles", -5), None, None),
    "folders of others": (lambda store: (store / WORDS / "c" / "0" / "\u00b2").mkdir(), None, None),
    "points of others": (
        lambda store: (store / WORDS / "c" / ("9" * 20) / "0").mkdir(parents=True),
        None,
        None,
    ),
}


@pytest.mark.parametrize("name", list(HARMS))
def test_a_store_whose_arrays_are_others(name: str, done: Path, tmp_path: Path) -> None:
    """Is called damaged at once, and nothing is written to it; marks that are wrong are set right."""
    harm, of_status, of_sweep = HARMS[name]
    store = tmp_path / "harmed.zarr"
    shutil.copytree(done, store)
    harm(store)
    if of_status is None:
        assert status(store).points == 6
    else:
        with pytest.raises(Refused, match=rf"harmed\.zarr: is damaged \(.*{of_status}"):
            status(store)
    if of_sweep is None:
        sweep(TINY, store, threads=1)
        assert bits(store).items() >= bits(done).items()
        return
    before = bits(store)
    with pytest.raises(ValueError, match=rf"harmed\.zarr: is damaged \(.*{of_sweep}"):
        sweep(TINY, store, threads=1)
    assert bits(store) == before
    if "words" in of_sweep:
        with pytest.raises(Refused, match=rf"harmed\.zarr: is damaged \(.*{of_sweep}"):
            merge(tmp_path / "all.zarr", [store])


def test_the_status_of_a_study_whose_last_driver_was_stopped() -> None:
    told = "0 of 8 points are finished (0 %), and 8 of 8 tasks are done. Run the sweep again to finish them."
    assert str(Status(points=8, finished=0, tasks=8, there=8)) == told
