"""Recordings as telephones make them, which libsndfile does not read, decoded by ffmpeg."""

import shlex
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from restitution._internal.parameters import ParameterError, Problem

ENDINGS = (".m4a", ".aac", ".mp4", ".3gp", ".amr", ".wma")
"""Of files that are given to ffmpeg."""


@contextmanager
def decoded(path: Path) -> Iterator[Path]:
    """Decode a recording, and yield the WAV file, which is removed afterwards.

    Raises
    ------
    ValueError
        If there is no ffmpeg, with the command that converts the recording elsewhere, or it finds no sound.
    """
    program = shutil.which("ffmpeg")
    if program is None:
        text = (
            ": is read with ffmpeg, which is not installed; install it, or convert the file where it is: "
            f"ffmpeg -i {shlex.quote(path.name)} {shlex.quote(path.stem + '.wav')}"
        )
        raise ParameterError(Problem(str(path), text))
    with TemporaryDirectory(prefix="restitution-") as folder:
        wave = Path(folder) / "sound.wav"
        # The name of a file may look like an option or an address.
        of_file = ["-i", f"file:{path.absolute()}", "-vn", "-c:a", "pcm_f32le", "-f", "wav"]
        command = [program, "-nostdin", "-v", "error", *of_file, str(wave)]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=False)
        if done.returncode:
            said = done.stderr.decode(errors="replace").strip().splitlines()
            reason = said[-1] if said else f"it ended with status {done.returncode}"
            raise ParameterError(Problem(str(path), f": not a sound that ffmpeg can read: {reason}"))
        yield wave
