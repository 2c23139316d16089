"""Recordings of bouncing balls, made up: the sound that impacts at known times would make."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.signal import fftconvolve

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Sound:
    """The sound of one impact.

    Attributes
    ----------
    modes : tuple of (frequency in Hz, decay time in s, amplitude)
        Damped vibrations of ball and plate that the impact starts.
    contact : float
        Duration of the contact in s: the force on the plate rises and falls as sin² within it.
    click : float
        Amplitude of the force pulse itself in the recording.
    """

    modes: tuple[tuple[float, float, float], ...]
    contact: float
    click: float = 0.3


TABLE_TENNIS = Sound(((350, 12e-3, 0.5), (1300, 9e-3, 0.5), (9100, 5e-3, 0.6), (12900, 4e-3, 0.7)), 0.7e-3)
STEEL = Sound(((2300, 60e-3, 0.4), (5200, 90e-3, 0.7), (8700, 50e-3, 0.6), (13100, 25e-3, 0.5)), 0.06e-3)
RUBBER = Sound(((180, 15e-3, 0.7), (420, 10e-3, 0.6), (950, 6e-3, 0.3)), 3e-3)
BASKETBALL = Sound(((95, 45e-3, 0.7), (480, 30e-3, 0.5), (1150, 60e-3, 0.25)), 8e-3, 0.6)
TRAMPOLINE = Sound(((55, 60e-3, 0.8), (140, 35e-3, 0.5), (310, 15e-3, 0.25)), 12e-3, 0.6)
PLATE = Sound(((700, 20e-3, 0.5), (2900, 12e-3, 0.6), (6400, 6e-3, 0.5)), 0.2e-3)


def recording(
    times: Array,
    speeds: Array,
    sound: Sound,
    *,
    rate: float = 44100.0,
    noise: float = -60.0,
    reverberation: float = 0.0,
    echo: float = 0.0,
    clipping: float = 0.0,
    bits: int = 16,
    before: float = 0.3,
    after: float = 0.4,
    seed: int = 1,
) -> tuple[Array, float]:
    """Make the recording of one ball; the loudest sample of the impacts is 1 before it is clipped.

    Parameters
    ----------
    times, speeds : ndarray, shape (n,)
        Impacts: when (s), and how fast (m/s). The sound begins at these times, plus the offset returned.
    sound : Sound
        What an impact sounds like at the speed of the first; amplitudes grow as the 1.2th power of the speed.
    rate : float
        Samples per second.
    noise : float
        Level of pink noise in dB, its standard deviation against the loudest sample.
    reverberation : float
        Time in s in which the sound of the room falls by 60 dB; 0 is an open field.
    echo : float
        Amplitude of a second burst, 16.7 ms after each impact.
    clipping : float
        Share of the loudest sample by which the recording is overdriven.
    bits : int
        Depth to which it is rounded.
    before, after : float
        Seconds of noise before the first and after the last impact.

    Returns
    -------
    tuple of ndarray and float
        Samples in [-1, 1], and the time in s at which the clock of `times` was 0.
    """
    rng = np.random.default_rng(seed)
    offset = before - float(times[0])
    total = int((times[-1] + offset + after) * rate)
    clean = np.zeros(total)
    length = int(rate * min(10.0 * max(decay for _, decay, _ in sound.modes), 1.0))
    for time, speed in zip(times + offset, speeds, strict=True):
        first = int(np.ceil(time * rate))
        if first >= total:
            continue
        t = (np.arange(first, min(first + length, total)) / rate) - time
        burst = _burst(t, sound, rng)
        clean[first : first + t.size] += (speed / speeds[0]) ** 1.2 * burst
        late = first + int(0.0167 * rate)
        if echo and late < total:
            part = burst[: total - late]
            clean[late : late + part.size] += echo * (speed / speeds[0]) ** 1.2 * part
    if reverberation:
        tail = np.arange(int(reverberation * rate)) / rate
        room = rng.standard_normal(tail.size) * 10.0 ** (-3.0 * tail / reverberation)
        room *= 0.5 / np.sqrt(np.sum(room**2))
        room[0] += 1.0
        clean = fftconvolve(clean, room)[:total]
    clean /= np.abs(clean).max()
    samples = clean + 10.0 ** (noise / 20.0) * _pink(total, rng)
    if clipping:
        samples = np.clip(samples / (1.0 - clipping), -1.0, 1.0)
    samples /= max(1.0, float(np.abs(samples).max()))
    steps = 2.0 ** (bits - 1)
    return np.round(samples * (steps - 1.0)) / steps, offset


def _burst(t: Array, sound: Sound, rng: np.random.Generator) -> Array:
    """One impact: a pulse while the bodies touch, and vibrations that it starts."""
    rise = np.clip(t / sound.contact, 0.0, 1.0)
    pulse = np.where(t < sound.contact, np.sin(np.pi * rise) ** 2, 0.0)
    burst = sound.click * pulse
    for frequency, decay, amplitude in sound.modes:
        # Where the ball lands on the plate decides how far each mode is excited.
        strength = amplitude * rng.uniform(0.6, 1.4)
        burst = burst + strength * np.sin(0.5 * np.pi * rise) ** 2 * np.exp(-t / decay) * np.sin(
            2.0 * np.pi * frequency * t
        )
    return np.asarray(burst)


def _pink(samples: int, rng: np.random.Generator) -> Array:
    """Noise whose power falls as the frequency grows, standard deviation 1."""
    spectrum = np.fft.rfft(rng.standard_normal(samples))
    spectrum /= np.sqrt(np.maximum(np.arange(spectrum.size), 1.0))
    noise = np.fft.irfft(spectrum, samples)
    return np.asarray(noise / noise.std())
