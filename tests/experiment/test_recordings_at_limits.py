"""Recordings at the limits of doubles: silence, samples far from full scale, no channel."""

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import restitution as rs
from reference.command import invoke

RATE = 44100


def clicks() -> npt.NDArray[np.float64]:
    """Five impacts, 0.4 s and less apart, in noise; the largest sample is 1."""
    rng = np.random.default_rng(1)
    samples = 1e-3 * rng.standard_normal(2 * RATE)
    for time in 0.2 + np.cumsum([0.0, 0.4, 0.36, 0.324, 0.2916]):
        samples[round(time * RATE) :][:200] += rng.standard_normal(200) * np.exp(-np.arange(200) / 40)
    return np.asarray(samples / np.abs(samples).max())


@pytest.mark.parametrize("shape", [(8000,), (8000, 2)])
def test_a_constant_is_silence(shape: tuple[int, ...]) -> None:
    """The mean of many 0.1 is not 0.1: what rounding leaves of the difference is no sound."""
    constant = np.full(shape, 0.1)
    assert np.mean(constant) != 0.1
    with pytest.raises(ValueError, match=r"^source: silence; every sample has the same value$"):
        rs.sound.impacts(constant, 8000.0)


def test_a_constant_file_is_silence(tmp_path: Path) -> None:
    """The command says so in a line, without a traceback."""
    soundfile = pytest.importorskip("soundfile")
    path = tmp_path / "constant.wav"
    soundfile.write(path, np.full(8000, 0.1), 8000, subtype="DOUBLE")
    result = invoke("listen", path, "--diameter", 6e-3, "--out", tmp_path / "page.html")
    assert result.exit_code == 2
    assert "silence" in result.output


def test_one_silent_channel_does_not_matter() -> None:
    one, two = clicks(), np.stack([np.full(2 * RATE, 0.1), clicks()], axis=1)
    heard = rs.sound.impacts(two, RATE)
    assert heard.attrs["channel"] == 1
    np.testing.assert_array_equal(heard.time, rs.sound.impacts(one, RATE).time)


@pytest.mark.parametrize(
    ("source", "text"),
    [
        (
            1e300 * np.random.default_rng(1).normal(size=8000),
            r"samples up to .*e\+300 of full scale; must be at most 1e\+100",
        ),
        (np.zeros((8000, 0)), "no channel; must have at least one"),
    ],
)
def test_what_cannot_be_a_sound(source: Any, text: str) -> None:
    """Squares of 1e300 overflow; of no channel nothing can be heard."""
    with pytest.raises(ValueError, match=f"^source: {text}"):
        rs.sound.impacts(source, 8000.0)


@pytest.mark.parametrize("power", [-1030, -600, -100, 300])
def test_the_scale_does_not_matter(power: int) -> None:
    """A power of two is exact: the times are the same to the bit, but where it leaves subnormal numbers."""
    heard = rs.sound.impacts(np.ldexp(clicks(), power), RATE)
    expected = rs.sound.impacts(clicks(), RATE)
    # Of 52 bits 44 are left at 2**-1030.
    np.testing.assert_allclose(heard.time, expected.time, rtol=0, atol=1e-8 if power < -1000 else 0)


@pytest.mark.parametrize("kind", [np.int64, np.uint64])
def test_few_bits_in_long_integers(kind: type) -> None:
    """16 bits are 2**-48 of the full scale of 64; they are heard all the same."""
    samples = np.rint(32000 * clicks())
    expected = rs.sound.impacts(samples.astype(np.int16), RATE).time
    offset = 2**15 if kind is np.uint64 else 0
    heard = rs.sound.impacts((samples + offset).astype(kind), RATE)
    np.testing.assert_allclose(heard.time, expected, rtol=0, atol=1e-9)


def test_a_list_of_integers_is_an_array_of_them() -> None:
    """16 bits in a list have the full scale of NumPy's own integers, of which they are nearly nothing."""
    samples = np.rint(32000 * clicks()).astype(np.int64)
    for given in (samples, np.stack([samples, 0 * samples], axis=1)):
        xr.testing.assert_identical(rs.sound.impacts(given.tolist(), RATE), rs.sound.impacts(given, RATE))
