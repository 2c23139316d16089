"""Recordings of balls whose coefficient scatters, made up by code that shares nothing with the package.

Every impact is written into a spectrum, so that it may begin between two samples.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

RATE = 44100
KINDS = ("crackle", "ping", "knock", "slap")
_FINE = 8
"""Points to a sample at which a click is written before it is taken down to the rate of the recording."""
_LENGTH = 2048


@dataclass(frozen=True)
class Recording:
    """Samples at `RATE`, and the truth: times in s and the coefficient of each impact."""

    samples: Array
    times: Array
    coefficients: Array


def bouncing(
    kind: str,
    *,
    seed: int,
    noise: float,
    normal: float = 0.92,
    scatter: float = 0.003,
    speed: float = 1.5,
    impacts: int = 25,
    gravity: float = 9.81,
    silence: float = 0.4,
) -> Recording:
    """Record a ball whose coefficient has a constant mean and scatters by itself.

    Parameters
    ----------
    kind : {"crackle", "ping", "knock", "slap"}
        A burst of noise, the same at each impact; ringing, the same at each; ringing whose modes are
        excited to an extent that differs between impacts, by a contact that lasts longer at low speed; a
        burst that is another one at each impact.
    seed : int
        Of everything that is drawn.
    noise : float
        Standard deviation of the noise against the loudest sample, in dB.
    normal, scatter : float
        Mean and standard deviation of the coefficient.
    speed : float
        Of the first impact, in m/s.
    impacts : int
        Their number.
    gravity : float
        In m/s².
    silence : float
        Seconds of noise alone after the last impact.
    """
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    coefficients = np.clip(rng.normal(normal, scatter, impacts), 0.0, 1.0)
    speeds = speed * np.concatenate([[1.0], np.cumprod(coefficients[:-1])])
    times = 0.3 + rng.uniform(0.0, 0.01) + np.concatenate([[0.0], np.cumsum(2.0 * speeds[1:] / gravity)])
    samples = np.zeros(int((times[-1] + silence) * RATE))
    for time, click in zip(times, clicks(kind, speeds, rng), strict=True):
        put(samples, click, time)
    samples /= np.abs(samples).max()
    return Recording(samples + 10.0 ** (noise / 20.0) * hiss(samples.size, rng), times, coefficients)


def clicks(kind: str, speeds: Array, rng: np.random.Generator) -> list[Array]:
    """Write the sound of each impact, on a grid `_FINE` times as fine as that of the samples."""
    t = np.arange(_LENGTH * _FINE) / (_FINE * RATE)
    frequencies = rng.uniform([500.0, 2000.0, 5000.0, 9000.0], [1500.0, 4000.0, 9000.0, 15000.0])
    decays = rng.uniform(1e-3, 6e-3, 4)
    phases = rng.uniform(0.0, 2.0 * np.pi, 4)
    burst = rng.standard_normal(t.size)
    fade = -np.expm1(-t / 5e-5) * np.exp(-t / 1.5e-3)
    rings = np.exp(-t / decays[:, None]) * np.sin(2.0 * np.pi * frequencies[:, None] * t + phases[:, None])
    found = []
    for speed in speeds:
        if kind in ("crackle", "slap"):
            if kind == "slap":
                burst = rng.standard_normal(t.size)
            click = burst * fade
        else:
            strengths, contact = np.ones(4), 5e-5
            if kind == "knock":
                strengths, contact = rng.uniform(0.6, 1.4, 4), 1.5e-4 * speed**-0.2
            rise = np.sin(0.5 * np.pi * np.clip(t / contact, 0.0, 1.0)) ** 2
            click = rise * (strengths @ rings)
        found.append(speed * click)
    return found


def put(samples: Array, click: Array, time: float) -> None:
    """Add a click that begins at a time in s, without what lies above half the rate."""
    first = int(time * RATE)
    spectrum = np.fft.rfft(click, 2 * click.size)[: _LENGTH + 1] / _FINE
    f = np.arange(_LENGTH + 1) / (2.0 * _LENGTH)
    ahead = 8.0  # samples, for what precedes a click whose upper frequencies are cut off
    spectrum = spectrum * np.exp(-2j * np.pi * f * (time * RATE - first + ahead))
    spectrum *= np.clip((0.5 - f) / 0.05, 0.0, 1.0)
    written = np.fft.irfft(spectrum)[: _LENGTH + int(ahead)]
    begin = first - int(ahead)
    end = min(begin + written.size, samples.size)
    samples[begin:end] += written[: end - begin]


def hiss(number: int, rng: np.random.Generator) -> Array:
    """Draw noise of standard deviation 1, a part of it white and the rest with power that falls as 1/f."""
    spectrum = np.fft.rfft(rng.standard_normal(number))
    spectrum *= np.sqrt(0.3 + number / 44.1 / np.maximum(np.arange(spectrum.size), 20.0))
    noise = np.fft.irfft(spectrum, number)
    return np.asarray(noise / noise.std())
