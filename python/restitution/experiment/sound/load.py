"""Sound files and arrays as samples: what can be heard in them, and what is wrong with them."""

import math
import shlex
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import numpy.typing as npt

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import real, reals
from restitution._internal.files import check_regular, path_from
from restitution._internal.parameters import ParameterError, Problem, TooLargeError, wrong
from restitution._internal.resources import available_memory

LOWEST_RATE = 2000.0
"""In Hz; below it nothing is left of an impact's sound."""
HIGHEST_RATE = 1e6
_SHORTEST = 0.1
_LOUDEST = 1e100
"""Over full scale; the power of such a sound is a number."""
_QUIET = 1e-10
"""Quieter samples are amplified, as 16 bits in integers of 64: floors of powers are made for full scale."""
_OF_TIME, _OF_SAMPLE = 40, 8
"""Bytes that it takes at least to listen to a time, and to each of its samples in a channel."""
_DECODED = (".m4a", ".aac", ".mp4", ".3gp", ".amr", ".wma")
"""Endings of recordings as telephones make them, which libsndfile does not read and ffmpeg decodes."""
_SOURCE = "a path, or samples of shape (n,) or (n, channels)"


def load(source: str | PathLike[str] | npt.ArrayLike, rate: float | None) -> tuple[Array, float]:
    """Return samples, shape (n, channels), full scale being 1, and their rate in Hz.

    Raises
    ------
    ValueError
        If it is not a sound, is silent or too short, or the rate is missing or is not that of the file.
    OSError
        If the file cannot be read.
    """
    given = rate
    if rate is not None:
        allowed = f"a number in [{LOWEST_RATE:g}, {HIGHEST_RATE:g}] (Hz)"
        rate = real("rate", rate, allowed, lambda one: LOWEST_RATE <= one <= HIGHEST_RATE, unit="Hz")
    if isinstance(source, str | PathLike):
        path = path_from("source", source)
        name = str(path)
        check_regular(path)
        path.open("rb").close()  # an OSError that names the file, if it cannot be read
        with _decoded(path) if path.suffix.lower() in _DECODED else nullcontext(path) as readable:
            samples, own = _read(readable, name)
        if rate is not None and rate != own:
            raise ParameterError(wrong("rate", given, f"left out, or {own:g}, which {name} says it has (Hz)"))
    else:
        name = "source"
        if rate is None:
            text = ": missing; must be the samples per second of the array (Hz)"
            raise ParameterError(Problem("rate", text))
        samples, own = _array(source), rate
    if not LOWEST_RATE <= own <= HIGHEST_RATE:
        raise ParameterError(Problem(name, f": {own:g} samples per second; must be at least {LOWEST_RATE:g}"))
    if samples.shape[0] < _SHORTEST * own:
        text = f": {samples.shape[0] / own:.3g} s of sound; must be at least {_SHORTEST} s"
        raise ParameterError(Problem(name, text))
    if not np.isfinite(samples).all():
        raise ParameterError(Problem(name, ": samples that are NaN or infinite; must be finite"))
    if not samples.shape[1]:
        raise ParameterError(Problem(name, ": no channel; must have at least one"))
    if not np.abs(samples).max() <= _LOUDEST:
        text = f": samples up to {np.abs(samples).max():.3g} of full scale; must be at most {_LOUDEST:g}"
        raise ParameterError(Problem(name, text))
    # Asked before the mean is taken off, whose rounding would be heard.
    if not np.ptp(samples, axis=0).max() > 0.0:
        raise ParameterError(Problem(name, ": silence; every sample has the same value"))
    samples = samples - np.mean(samples, axis=0)
    largest = float(np.abs(samples).max())
    if largest < _QUIET:
        samples = np.ldexp(samples, -math.frexp(largest)[1])  # by a power of two, which is exact
    return samples, own


@contextmanager
def _decoded(path: Path) -> Iterator[Path]:
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


def _read(path: Path, name: str) -> tuple[Array, float]:
    try:
        import soundfile
    except ImportError:
        message = ": reading sound files needs soundfile: pip install 'restitution[measure]'"
        raise ParameterError(Problem(name, message)) from None
    try:
        about = soundfile.info(path)
        check_memory(name, about.frames, about.channels)
        samples, rate = soundfile.read(path, dtype="float64", always_2d=True)
    except (soundfile.LibsndfileError, RuntimeError) as error:
        reason = str(error).partition(": ")[2].strip() or str(error)
        text = f": not a sound file that can be read (WAV, FLAC, OGG, MP3, AIFF): {reason}"
        raise ParameterError(Problem(name, text)) from None
    return np.asarray(samples, dtype=np.float64), float(rate)


def _array(source: Any) -> Array:
    """Take integers at their full scale, and floats as they are; shape (n,) or (n, channels)."""
    numbers = reals("source", source, _SOURCE, unit=None, dimensions=(1, 2), finite=False)
    array = np.asarray(source)
    check_memory("source", array.shape[0], array[:1].size)
    scale = 1.0
    if array.dtype.kind in "iu":
        info = np.iinfo(array.dtype)
        scale = float(info.max) if array.dtype.kind == "i" else 0.5 * float(info.max)
    samples = numbers / scale
    return samples[:, None] if samples.ndim == 1 else samples


def check_memory(name: str, times: int, channels: int) -> None:
    """Refuse what is too long to be listened to in the memory that this process can have.

    Raises
    ------
    TooLargeError
        Naming the file, or the argument.
    """
    needed, available = times * (_OF_TIME + _OF_SAMPLE * channels), available_memory()
    if needed > available:
        text = (
            f": {times:,} samples in {channels} channel{'s' * (channels > 1)} take {needed / 1e9:.3g} GB of "
            f"memory: must be at most {available / 1e9:.3g} GB, what this process can have"
        )
        raise TooLargeError(Problem(name, text))


def clipped_share(samples: Array) -> float:
    """Find which share of the loud samples sits at the very limit, above or below; shape (n, channels)."""
    low, high = samples.min(axis=0), samples.max(axis=0)
    loud, at_limit = (
        np.count_nonzero((samples > part * high) | (samples < part * low), axis=0) for part in (0.5, 0.999)
    )
    # The loudest sample of a sound is not clipping.
    return max(0.0, float(np.max((at_limit - 2) / np.maximum(loud, 1))))
