"""Recordings of telephones, decoded by ffmpeg, and by a program that stands for it on the PATH."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import soundfile

import restitution as rs
from reference.clicks import RATE as FULL
from reference.clicks import bouncing
from reference.command import invoke
from reference.measuring import samples
from restitution.experiment.listen import Setting, analyse

RATE = 8000
SAMPLES = samples()[: int(1.35 * RATE)].astype(np.float32)
"""Five impacts, too few for a shape, which takes long."""
CONTENT = b"\0\0\0\x20ftypM4A " + bytes(100)
DECODES = """
import shutil
import sys
from pathlib import Path

words = sys.argv[1:]
assert words[words.index("-i") + 1] == "file:{recording}", words
Path("{log}").open("a").write(words[-1] + "\\n")
shutil.copy("{decoded}", words[-1])
"""
FAILS = """
import sys
print("moov atom not found", file=sys.stderr)
print("{recording}: Invalid data found when processing input", file=sys.stderr)
sys.exit(183)
"""


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """A file as a telephone writes it; beside it, what ffmpeg makes of it."""
    path = tmp_path / "my ball.m4a"
    path.write_bytes(CONTENT)
    soundfile.write(tmp_path / "decoded.wav", SAMPLES, RATE, subtype="FLOAT")
    return path


def installed(recording: Path, monkeypatch: pytest.MonkeyPatch, program: str) -> Path:
    """Put a program that is called ffmpeg on the PATH, alone; return where it writes down its output."""
    if sys.platform == "win32":
        pytest.skip("a program is no script")
    folder, log = recording.parent / "bin", recording.parent / "log"
    folder.mkdir()
    code = program.format(recording=recording, log=log, decoded=recording.with_name("decoded.wav"))
    (folder / "ffmpeg").write_text(f"#!{sys.executable}\n{code}", encoding="utf-8")
    (folder / "ffmpeg").chmod(0o755)
    monkeypatch.setenv("PATH", str(folder))
    return log


def test_ffmpeg_decodes_what_libsndfile_does_not_read(
    recording: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The times are those of the samples, and the decoded file is gone."""
    log = installed(recording, monkeypatch, DECODES)
    heard = rs.sound.impacts(recording)
    expected = rs.sound.impacts(SAMPLES, RATE)
    np.testing.assert_allclose(heard.time, expected.time, rtol=0, atol=1e-9)
    assert heard.attrs["source"].startswith("my ball.m4a, listened to by restitution")
    [decoded] = log.read_text(encoding="utf-8").splitlines()
    assert not Path(decoded).parent.exists()


def test_the_page_says_that_the_file_is_compressed(recording: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Unless it is of the kind that loses nothing."""
    installed(recording, monkeypatch, DECODES)
    [*_, lossy] = analyse(recording, Setting(diameter=0.02)).warnings
    assert lossy.startswith(".m4a compresses with loss, which moves onsets, unless it is Apple Lossless")


def test_without_ffmpeg_the_command_is_said(recording: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is written."""
    monkeypatch.setenv("PATH", str(recording.parent))
    done = invoke("listen", recording, "--diameter", 0.02, "--out", recording.with_name("a.html"))
    assert done.exit_code == 2
    assert "ffmpeg -i 'my ball.m4a' 'my ball.wav'" in done.output
    assert not list(recording.parent.glob("a.*"))


def test_a_file_that_ffmpeg_does_not_read(recording: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its last words are passed on."""
    installed(recording, monkeypatch, FAILS)
    with pytest.raises(ValueError, match=r"my ball\.m4a: not a sound that ffmpeg can read: .*Invalid data"):
        rs.sound.impacts(recording)


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="there is no ffmpeg on this machine")
@pytest.mark.parametrize(("codec", "off"), [("alac", 0.5e-6), ("aac", 1e-6)])
def test_what_ffmpeg_itself_writes_is_read(
    codec: str, off: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a ball whose times are known; the name looks like an option."""
    monkeypatch.chdir(tmp_path)
    truth = bouncing("ping", seed=101, noise=-45.0)
    soundfile.write("ball.wav", 0.9 * truth.samples, FULL)
    encode = ["ffmpeg", "-v", "error", "-i", "ball.wav", "-c:a", codec, "-b:a", "128k", "file:-my ball é.m4a"]
    subprocess.run(encode, stdin=subprocess.DEVNULL, check=True)
    times = rs.sound.impacts("-my ball é.m4a").time.values
    assert np.std(times - truth.times) < off
