"""Impacts heard in made-up recordings whose impacts are known, with the troubles that recordings have."""

from pathlib import Path

import numpy as np
import pytest
import soundfile
import xarray as xr

import restitution as rs
from benchmarks.recording import BASKETBALL, PLATE, RUBBER, STEEL, TABLE_TENNIS, TRAMPOLINE, Sound, recording
from reference.bouncing import impact_times


def ball(
    ratio: float, speed: float, impacts: int, sound: Sound, rate: float = 44100.0, **trouble: float
) -> tuple[np.ndarray, np.ndarray]:
    """Samples of a ball whose flights fall by one ratio, and the true times of its impacts."""
    times = impact_times(lambda _: ratio, speed, impacts)
    speeds = speed * ratio ** np.arange(impacts)
    samples, offset = recording(times, speeds, sound, rate=rate, **trouble)  # type: ignore[arg-type]
    return samples, times + offset


def errors(heard: xr.Dataset, true: np.ndarray) -> tuple[np.ndarray, int]:
    """By how much times are off, less their common delay, and how many true impacts were found."""
    times = heard.time.values[heard.flag.values < 2]
    nearest = np.abs(times[:, None] - true).argmin(axis=1)
    off = times - true[nearest]
    off = off - np.median(off)
    return off, np.unique(nearest[np.abs(off) < 3e-3]).size


@pytest.mark.parametrize(
    ("name", "make"),
    [
        ("quiet", lambda: ball(0.94, 1.0, 30, TABLE_TENNIS, echo=0.3)),
        ("noise", lambda: ball(0.94, 1.0, 30, TABLE_TENNIS, echo=0.3, noise=-30.0)),
        ("clipped", lambda: ball(0.94, 1.0, 30, TABLE_TENNIS, echo=0.3, clipping=0.7)),
        ("reverberant", lambda: ball(0.94, 1.0, 30, TABLE_TENNIS, echo=0.3, reverberation=0.6)),
        ("8 bit", lambda: ball(0.94, 1.0, 30, TABLE_TENNIS, echo=0.3, bits=8)),
        ("steel", lambda: ball(0.6, 1.5, 5, STEEL, noise=-45.0)),
        ("plate", lambda: ball(0.9, 2.0, 25, PLATE, noise=-40.0, reverberation=0.4)),
    ],
)
def test_all_impacts_are_heard_to_a_few_microseconds(name: str, make: object) -> None:
    """A sample lasts 22.7 µs: all are found, none is invented, and half are within a fifth of a sample.

    One may be doubtful: steel still rings when the last impact comes, and as loud.
    """
    samples, true = make()  # type: ignore[operator]
    heard = rs.sound.impacts(samples, 44100)
    off, found = errors(heard, true)
    assert found == true.size == off.size, name
    assert np.median(np.abs(off)) < 5e-6
    good = heard.flag.values == 0
    assert good.sum() >= true.size - 1
    assert np.abs(off[good] - np.median(off[good])).max() < 5.0 * heard.uncertainty.values[good].max()


def test_a_telephone_rate_still_tells_times_below_its_sample() -> None:
    samples, true = ball(0.94, 1.0, 30, TABLE_TENNIS, rate=8800.0, echo=0.3)
    off, found = errors(rs.sound.impacts(samples, 8800), true)
    assert found == off.size == 30
    assert np.median(np.abs(off)) < 0.2 / 8800.0


@pytest.mark.parametrize(
    ("make", "rate", "least", "within"),
    [
        (lambda: ball(0.97, 2.0, 30, TRAMPOLINE, 8000.0, noise=-40.0, reverberation=0.3), 8000, 30, 0.3e-3),
        (lambda: ball(0.85, 3.0, 21, RUBBER, noise=-50.0), 44100, 20, 0.1e-3),
        (lambda: ball(0.78, 4.0, 15, BASKETBALL, noise=-50.0, reverberation=0.3), 44100, 12, 2e-3),
    ],
)
def test_soft_sounds_are_heard(make: object, rate: float, least: int, within: float) -> None:
    """Contacts last 12, 3 and 8 ms; the last impacts drown in the sound of those before."""
    samples, true = make()  # type: ignore[operator]
    off, found = errors(rs.sound.impacts(samples, rate), true)
    assert found >= least
    assert off.size <= true.size
    assert np.median(np.abs(off)) < within


def test_errors_are_what_they_are_said_to_be() -> None:
    """Over recordings that differ in noise and sound, (heard - true)/error has a spread of about one."""
    pulls = []
    for seed in range(5):
        samples, true = ball(0.9, 2.0, 18, PLATE, noise=-25.0, seed=seed + 1)
        heard = rs.sound.impacts(samples, 44100)
        off, _ = errors(heard, true)
        good = (heard.flag == 0).values[heard.flag.values < 2]
        pulls.extend((off / heard.uncertainty.values[heard.flag.values < 2])[good])
    assert 0.8 < 1.4826 * np.median(np.abs(pulls)) < 1.3


def test_three_series_in_a_noisy_hall() -> None:
    parts, truth, begin = [], [], 0.0
    for number, (ratio, speed, impacts, sound) in enumerate(
        [(0.9, 2.0, 16, PLATE), (0.85, 2.5, 12, PLATE), (0.93, 1.5, 20, TABLE_TENNIS)]
    ):
        samples, true = ball(ratio, speed, impacts, sound, noise=-30.0, reverberation=1.5, seed=number + 1)
        parts.append(samples)
        truth.append(true + begin)
        begin += samples.size / 44100.0
    heard = rs.sound.impacts(np.concatenate(parts), 44100)
    for number, true in enumerate(truth):
        one = heard.isel(impact=(heard.series == number).values)
        off, found = errors(one, true)
        assert found >= true.size - 1
        assert off.size == found
        assert np.median(np.abs(off)) < 20e-6
    assert set(heard.series.values.tolist()) == {0, 1, 2}


@pytest.mark.parametrize("pause", [0.5, 1.3])
def test_drops_that_follow_soon_are_heard_one_by_one(pause: float) -> None:
    """One impact of each also follow one another, with longer flights: they are neither series nor ball."""
    speeds = [np.sqrt(2.0 * 9.81 * 0.1) * ratio ** np.arange(12) for ratio in (0.898, 0.901, 0.902, 0.9)]
    parts = [np.append(0.0, np.cumsum(2.0 * one[1:] / 9.81)) for one in speeds]
    starts = np.append(0.0, np.cumsum([part[-1] + pause for part in parts[:-1]]))
    times = np.concatenate([part + start for part, start in zip(parts, starts, strict=True)])
    samples, offset = recording(times, np.concatenate(speeds), PLATE)
    heard = rs.sound.impacts(samples, 44100)
    assert heard.other_ball_impacts == 0
    for number, (part, start) in enumerate(zip(parts, starts, strict=True)):
        # After the last of a drop a faint sound may be where one more is expected; it is flagged.
        found = heard.time.values[(heard.series.values == number) & (heard.flag.values == 0)]
        np.testing.assert_allclose(found - offset, part + start, atol=1e-3)


def test_a_missed_impact_leaves_its_place() -> None:
    samples, true = ball(0.9, 2.0, 14, PLATE, noise=-50.0)
    # A door closes on the sixth: nothing of it is left.
    lost = slice(int((true[5] - 0.01) * 44100), int((true[5] + 0.1) * 44100))
    samples[lost] = 1e-4 * np.random.default_rng(1).standard_normal(samples[lost].size)
    heard = rs.sound.impacts(samples, 44100)
    assert heard.flag.values.tolist() == [0] * 5 + [2] + [0] * 8
    assert np.isnan(heard.time.values[5])
    data = rs.flight.restitution(heard)
    assert np.flatnonzero(np.isnan(data.restitution)).tolist() == [0, 4, 5, 6, 13]


def test_a_second_sound_as_loud_as_the_impact_is_told() -> None:
    samples, true = ball(0.9, 2.0, 14, PLATE, noise=-50.0)
    click = samples[int(true[3] * 44100) :][:2000].copy()
    place = int((0.5 * (true[3] + true[4])) * 44100)
    samples[place : place + 2000] += click
    heard = rs.sound.impacts(samples, 44100)
    assert (heard.flag == 3).sum() == 1
    assert abs(float(heard.time[heard.flag == 3][0]) - place / 44100.0) < 5e-3
    assert rs.flight.restitution(heard).sizes["impact"] == 14


@pytest.mark.parametrize("subtype", ["PCM_U8", "PCM_16", "PCM_24", "PCM_32", "FLOAT"])
def test_files_of_every_depth(tmp_path: Path, subtype: str) -> None:
    samples, true = ball(0.85, 1.5, 8, PLATE, noise=-45.0)
    two = np.stack([0.02 * np.random.default_rng(2).standard_normal(samples.size), 0.9 * samples], axis=1)
    soundfile.write(tmp_path / "ball.wav", two, 44100, subtype=subtype)
    heard = rs.sound.impacts(tmp_path / "ball.wav")
    assert heard.attrs["channel"] == 1
    off, found = errors(heard, true)
    assert found == off.size == 8


@pytest.mark.parametrize("suffix", ["flac", "ogg"])
def test_compressed_files(tmp_path: Path, suffix: str) -> None:
    samples, true = ball(0.85, 1.5, 8, PLATE, noise=-45.0)
    soundfile.write(tmp_path / f"ball.{suffix}", 0.9 * samples, 44100)
    off, found = errors(rs.sound.impacts(str(tmp_path / f"ball.{suffix}")), true)
    assert found == off.size == 8
    assert np.median(np.abs(off)) < 50e-6


def test_integers_are_taken_at_full_scale() -> None:
    samples, _ = ball(0.85, 1.5, 8, PLATE, noise=-45.0)
    whole = np.round(samples * 32767).astype(np.int16)
    assert rs.sound.impacts(whole, 44100).time.values == pytest.approx(
        rs.sound.impacts(whole / 32767.0, 44100).time.values, abs=1e-9
    )


def test_noise_and_speech_like_noise_hold_no_series() -> None:
    rng = np.random.default_rng(4)
    for swell in (0.0, 1.0):
        slow = np.interp(np.arange(6 * 44100), np.arange(0, 6 * 44100, 4410), rng.standard_normal(60))
        noise = 0.05 * rng.standard_normal(6 * 44100) * np.exp(swell * slow)
        with pytest.raises(ValueError, match=r"^source: no (impact|series of impacts) is heard"):
            rs.sound.impacts(noise, 44100)


def test_one_impact_is_told() -> None:
    rng = np.random.default_rng(1)
    samples = 1e-3 * rng.standard_normal(44100)
    samples[20000:20400] += rng.standard_normal(400) * np.exp(-np.arange(400) / 60)
    with pytest.raises(
        ValueError, match=r"^source: one impact is heard, at 0.45 s; at least three are needed"
    ):
        rs.sound.impacts(samples, 44100)


@pytest.mark.parametrize(
    ("source", "rate", "message"),
    [
        (np.zeros(44100), 44100, "source: silence; every sample has the same value"),
        (np.ones(100), 44100, "source: 0.00227 s of sound; must be at least 0.1 s"),
        (np.ones(44100), None, "rate: missing; must be the samples per second of the array (Hz)"),
        (np.ones(44100), 0, "rate = 0: must be a number in [2000, 1e+06] (Hz)"),
        (np.full(44100, np.nan), 44100, "source: samples that are NaN or infinite; must be finite"),
        (["a"], 44100, "source = ['a']: must be a path, or samples of shape (n,) or (n, channels)"),
    ],
)
def test_errors_name_what_is_wrong(source: object, rate: float | None, message: str) -> None:
    with pytest.raises(ValueError) as error:  # noqa: PT011  # the text is compared
        rs.sound.impacts(source, rate)  # type: ignore[arg-type]
    assert str(error.value).startswith(message)


def test_a_file_that_is_no_sound(tmp_path: Path) -> None:
    path = tmp_path / "notes.wav"
    path.write_text("these are notes\n" * 100)
    with pytest.raises(ValueError, match=r"^\S+/notes.wav: not a sound file that can be read"):
        rs.sound.impacts(path)
    with pytest.raises(FileNotFoundError):
        rs.sound.impacts(tmp_path / "none.wav")
    soundfile.write(tmp_path / "ball.wav", ball(0.85, 1.5, 8, PLATE)[0], 44100)
    with pytest.raises(
        ValueError, match=r"^rate = 48000: must be left out, or 44100, which \S+/ball.wav says it has"
    ):
        rs.sound.impacts(tmp_path / "ball.wav", 48000)
