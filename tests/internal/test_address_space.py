"""What commands and studies take of address space, said before they begin; and Python without assertions."""

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from reference.command import AMONG_TESTS
from reference.processes import inputs
from restitution.study import open_store

MIB = 2**20


def under(limit: int, folder: Path, *words: str, flags: tuple[str, ...] = ()) -> tuple[int, str]:
    """Run the command line with so many bytes of address space; give its status and what it says."""
    code = f"import resource; resource.setrlimit(resource.RLIMIT_AS, ({limit}, {limit}))\n" if limit else ""
    code += "from restitution.cli import main; main()"
    command = [sys.executable, *flags, "-c", code, *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=120)
    return done.returncode, done.stderr


@pytest.mark.parametrize("limit", [640 * MIB, 700 * MIB, 760 * MIB])
def test_listen_takes_more_than_other_commands(limit: int, tmp_path: Path) -> None:
    """Libraries of netCDF, of sound and of figures; each would fail in words of its own."""
    (tmp_path / "ball.wav").symlink_to(inputs() / "ball.wav")
    words = ("listen", "ball.wav", "--diameter", "0.02", "--out", "ball.html")
    status, said = under(limit, tmp_path, *words)
    expected = r"error: this command: takes 800 MB of address space, and this process can have \d+ MB\n"
    assert (status, bool(re.fullmatch(expected, said))) == (1, True), said
    assert [file.name for file in tmp_path.iterdir()] == ["ball.wav"]
    assert under(900 * MIB, tmp_path, *words, "--quiet") == (0, "")


@pytest.mark.parametrize("limit", [680 * MIB, 760 * MIB, 900 * MIB])
def test_a_study_says_what_it_takes(limit: int, tmp_path: Path) -> None:
    """Before there is a store: Zarr and its threads are there only when all else is."""
    (tmp_path / "study.toml").symlink_to(inputs() / "study.toml")
    words = ("sweep", "study.toml", "--out", "study.zarr", "--threads", "2", "--quiet")
    status, said = under(limit, tmp_path, *words)
    expected = (
        r"error: a study, threads = 2: takes 850 MB of address space, and this process can have \d+ MB\n"
    )
    assert (status, bool(re.fullmatch(expected, said))) == (1, True), said
    assert [file.name for file in tmp_path.iterdir()] == ["study.toml"]
    assert under(1150 * MIB, tmp_path, *words) == (0, "")


def test_what_zarr_takes_is_not_asked_for_twice(done: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is left when a study ends, which may be because Zarr is there."""
    monkeypatch.setattr("restitution._internal.resources.available_memory", lambda: 0)
    assert open_store(done).sizes


@pytest.mark.parametrize(("limit", "field"), [("AS", 0), ("DATA", 5)])
@pytest.mark.parametrize("room", [-50 * MIB, 0, 10 * MIB])
def test_no_thread_is_begun_where_memory_has_ended(
    limit: str, field: int, room: int, tmp_path: Path, done: Path
) -> None:
    """Such a thread is waited for without end, also where Zarr is there already."""
    (tmp_path / "study.toml").symlink_to(inputs() / "study.toml")
    code = f"""
import resource
import restitution as rs
from pathlib import Path
assert rs.study.open_store({str(done)!r}).sizes
asked = rs.study.study_of("study.toml")
used = int(open("/proc/self/statm").read().split()[{field}]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_{limit}, (used + {room}, resource.RLIM_INFINITY))
for work in (lambda: rs.sweep(asked, "new.zarr"), lambda: rs.study.open_store({str(done)!r})):
    try:
        work()
    except MemoryError as error:
        print(error)
"""
    command = [sys.executable, "-c", code]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60)
    kind = {"AS": "address space", "DATA": "data"}[limit]
    line = rf"a study: takes 20 MB of {kind}, and this process can have \d+ MB\n"
    assert re.fullmatch(2 * line, ended.stdout), ended
    assert not (tmp_path / "new.zarr").exists()


def test_a_short_file_takes_no_room_of_the_longest() -> None:
    """Python makes room for as much as it is asked to read, and tables may have 256 MiB."""
    code = (
        AMONG_TESTS
        + f"""
import resource
from pathlib import Path
from restitution._internal.files import content
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + {64 * MIB}, resource.RLIM_INFINITY))
print(len(content(Path({__file__!r}))))
"""
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == (f"{Path(__file__).stat().st_size}\n", "")


def test_an_error_without_words_names_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Python's own MemoryError has none."""
    from reference.command import invoke

    def none(*_: Any, **__: Any) -> None:
        raise MemoryError

    monkeypatch.setattr("restitution.drop.toml.tables_in", none)
    found = invoke("simulate", inputs() / "run.toml", "--out", tmp_path / "run.nc")
    assert found.exit_code == 1
    assert found.stderr.endswith(" simulate: out of memory\n")


WITHOUT = "parameter studies: zarr [0-9.]+ does not work under python -O or PYTHONOPTIMIZE: leave that out"


@pytest.mark.parametrize(
    "words",
    [
        "sweep study.toml --out new.zarr",
        "sweep merge --out done.zarr",
        "sweep --status study.toml --out done.zarr",
    ],
)
def test_a_study_without_assertions(words: str, tmp_path: Path) -> None:
    """Zarr reads a group's metadata in one; where it no longer does, this is a study as any other."""
    (tmp_path / "study.toml").symlink_to(inputs() / "study.toml")
    (tmp_path / "done.zarr").symlink_to(inputs() / "done.zarr")
    status, said = under(0, tmp_path, *words.split(), flags=("-O",))
    assert (status == 0) or (status == 1 and re.fullmatch(f"error: {WITHOUT}\n", said)), said
    if status:
        assert sorted(file.name for file in tmp_path.iterdir()) == ["done.zarr", "study.toml"]
