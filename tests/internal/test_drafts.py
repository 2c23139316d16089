"""Whose a draft is: what the dead left goes, what the living write stays, in containers too."""

import os
import platform
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from restitution._internal.files import check, discard, prefix, whole_file, whole_folder, write


def names(folder: Path) -> set[str]:
    return {file.name for file in folder.iterdir()}


def of_the_dead(name: str) -> str:
    """Name a draft of a process of this machine that is no more."""
    return f"{prefix(name)}x.part".replace(f"-{os.getpid()}.", f"-{2**22 + 1}.")


def test_a_draft_of_a_process_in_another_container_stays(tmp_path: Path) -> None:
    """The host name is the same and the number of the process means nothing there: nobody there has it."""
    code = "import sys; from pathlib import Path; from restitution._internal.files import check; "
    code += "check(Path(sys.argv[1]), replace=True)"
    apart = ["unshare", "--pid", "--fork"]
    if os.geteuid():
        apart += ["--user", "--map-root-user"]
    try:
        subprocess.run([*apart, "true"], check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("no right to give processes numbers of their own here")
    path = tmp_path / "run.nc"
    with whole_file(path) as draft:
        draft.write_text("hours of work")
        subprocess.run([*apart, sys.executable, "-c", code, str(path)], check=True)
        assert names(tmp_path) == {draft.name}
    assert path.read_text() == "hours of work"


def test_a_machine_that_does_not_number_its_containers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Elsewhere than on Linux, or without /proc: the name of the machine alone tells it apart, as ever."""

    def none(path: object) -> str:
        raise FileNotFoundError(path)

    here = prefix("run.nc")
    monkeypatch.setattr(os, "readlink", none)
    assert prefix("run.nc") == prefix("run.nc") != here
    (tmp_path / of_the_dead("run.nc")).touch()
    check(tmp_path / "run.nc", replace=False)
    assert names(tmp_path) == set()


def test_a_draft_of_another_machine_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a disk that several share, the same number is another process."""
    with monkeypatch.context() as there:
        there.setattr(platform, "node", lambda: "another")
        left = of_the_dead("run.nc")
    assert left != of_the_dead("run.nc")
    (tmp_path / left).touch()
    check(tmp_path / "run.nc", replace=False)
    assert names(tmp_path) == {left}


def test_a_draft_of_another_user_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of whose processes the system tells nothing but that they are not ours."""

    def forbid(process: int, number: int) -> None:
        raise PermissionError

    left = tmp_path / of_the_dead("run.nc")
    left.touch()
    monkeypatch.setattr(os, "kill", forbid)
    check(tmp_path / "run.nc", replace=False)
    assert left.exists()
    monkeypatch.undo()
    check(tmp_path / "run.nc", replace=False)
    assert not left.exists()


def test_a_draft_goes_with_all_folders_in_it(tmp_path: Path) -> None:
    """However deep, as those of a Zarr store."""
    for draft in (tmp_path / "a", tmp_path / of_the_dead("run.zarr")):
        (draft / "b" / "c" / "d").mkdir(parents=True)
        for folder in (draft, draft / "b", draft / "b" / "c" / "d"):
            (folder / "file").touch()
    discard([tmp_path / "a"])
    check(tmp_path / "run.zarr", replace=False)
    assert names(tmp_path) == set()


@pytest.mark.parametrize("name", ["x" * 255, "é" * 127, "€" * 85, "x" + "𝜀" * 63])
def test_the_longest_names_have_drafts(name: str, tmp_path: Path) -> None:
    """255 bytes leave no room for what a draft's name has besides; characters may take two, three or four."""
    path, left = tmp_path / name, tmp_path / of_the_dead(name)
    left.touch()
    with whole_file(path) as draft:
        assert not left.exists()
        assert len(os.fsencode(draft.name)) <= 255
        draft.write_text("all")
    assert names(tmp_path) == {name}


DYING = """
import os, sys
from pathlib import Path
from restitution._internal.files import whole_files, whole_folder

folder, several = Path(sys.argv[1]), sys.argv[2] == "files"
replace = os.replace
def dying(draft, target):
    replace(draft, target)
    os.kill(os.getpid(), 9)
os.replace = dying
paths = [folder / name for name in ("laws.md", "laws.png")]
if several:
    with whole_files(paths, replace=True) as drafts:
        for draft in drafts:
            draft.write_text("new")
else:
    with whole_folder(folder, replace=True) as drafts:
        for path in paths:
            (drafts / path.name).write_text("new")
"""


@pytest.mark.parametrize("kind", ["files", "folder"])
def test_copies_that_a_killed_process_left_are_removed(kind: str, tmp_path: Path) -> None:
    """Of what stood where it wrote; by the next one that writes those names, even if they are gone."""
    folder = tmp_path / "laws"
    folder.mkdir()
    for name in ("laws.md", "laws.png"):
        (folder / name).write_text("old")
    died = subprocess.run([sys.executable, "-c", DYING, str(folder), kind], check=False)
    assert died.returncode == -signal.SIGKILL
    assert any(name.startswith((".laws.md.", ".laws.png.")) for name in names(folder))
    for name in ("laws.md", "laws.png"):
        (folder / name).unlink()
    if kind == "files":
        for name in ("laws.md", "laws.png"):
            write(folder / name, "next")
    else:
        with whole_folder(folder) as draft:
            for name in ("laws.md", "laws.png"):
                (draft / name).write_text("next")
    assert names(folder) == {"laws.md", "laws.png"}
