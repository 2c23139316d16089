"""Pictures of a recording: the waveform with its impacts, and close-ups of onsets."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from restitution.experiment.flight.times import DOUBLED, DOUBTFUL, FLAGS, GOOD
from restitution.experiment.listen._analysis import Recording
from restitution.experiment.sound.load import load
from restitution.figures.style import COLORS, PAGE, panels, styled

_MARKS = {GOOD: COLORS[0], DOUBTFUL: COLORS[1], DOUBLED: COLORS[3]}
_COLUMNS = 1400
"""Pixels across which the highest and the lowest sample are drawn."""
_CLOSE_UPS = 6
_BEFORE, _AFTER = 1.5e-3, 4e-3


@styled
def drawn_shape(draws: xr.DataTree) -> Figure:
    """Draw the posterior: draws of the parameter of ε_n against L/R, and the likelihood of L/R alone."""
    found = draws["posterior"].to_dataset()
    [name] = [str(name) for name in found.data_vars if name in _PARAMETERS]
    figure, [[joint, profile]] = panels(PAGE, 2.6, 1, 2)
    joint.plot(found.elongation.values.ravel(), found[name].values.ravel(), ".", markersize=1.5, alpha=0.4)
    joint.set_xscale("log")
    joint.set_xlabel("$L/R$")
    joint.set_ylabel(_PARAMETERS[name])
    likelihood = draws["likelihood"].to_dataset()
    profile.plot(likelihood.elongation, np.maximum(likelihood.profile, _LEAST), color=COLORS[0])
    profile.set_xscale("log")
    profile.set_ylim(_LEAST, 1.0)
    profile.set_xlabel("$L/R$")
    profile.set_ylabel(r"$\ln$ likelihood, less its largest")
    return figure


_PARAMETERS = {
    "normal": r"$\varepsilon_n$",
    "beta": r"$\beta$ ((s/m)$^{1/5}$)",
    "yield_speed": "yield speed (m/s)",
}
_LEAST = -12.0
"""Likelihoods below this, in the logarithm, are treated as zero."""


@styled
def waveform(given: Recording) -> Figure:
    """Draw the whole recording with a mark at each impact."""
    samples, rate = load(given.path, None)
    sound = samples[:, given.heard.attrs["channel"]]
    figure, [[axes]] = panels(PAGE, 2.4)
    step = max(sound.size // _COLUMNS, 1)
    whole = sound[: sound.size // step * step].reshape(-1, step)
    times = (np.arange(whole.shape[0]) + 0.5) * step / rate
    axes.fill_between(times, whole.min(axis=1), whole.max(axis=1), color="0.6", linewidth=0.3)
    top = float(np.abs(sound).max())
    flags = given.heard.flag.values
    for flag, color in _MARKS.items():
        at = given.heard.time.values[flags == flag]
        if at.size:
            axes.vlines(at, 1.05 * top, 1.2 * top, color=color, linewidth=0.8, label=FLAGS[flag])
    axes.set_xlim(0.0, sound.size / rate)
    axes.set_ylim(-1.1 * top, 1.25 * top)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("sound (full scale 1)")
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower right", ncols=3)
    return figure


@styled
def close_ups(given: Recording) -> Figure:
    """Draw a few impacts, from the first to the last, with their onsets and standard errors."""
    samples, rate = load(given.path, None)
    sound = samples[:, given.heard.attrs["channel"]]
    heard = given.heard.isel(impact=np.flatnonzero(given.heard.flag.values <= DOUBTFUL))
    chosen = np.unique(np.linspace(0, heard.sizes["impact"] - 1, _CLOSE_UPS).astype(int))
    figure, rows = panels(PAGE, 3.4, 2, 3)
    places = [axes for row in rows for axes in row]
    for axes, place in zip(places, chosen, strict=False):
        time, error = float(heard.time[place]), float(heard.uncertainty[place])
        begin, end = (int(np.clip((time + part) * rate, 0, sound.size)) for part in (-_BEFORE, _AFTER))
        axes.plot((np.arange(begin, end) / rate - time) * 1e3, sound[begin:end], color="0.3", linewidth=0.6)
        axes.axvspan(-1e3 * error, 1e3 * error, color=_MARKS[int(heard.flag[place])], alpha=0.3, linewidth=0)
        axes.axvline(0.0, color=_MARKS[int(heard.flag[place])], linewidth=0.8)
        axes.set_title(f"{time:.4f} s", fontsize=8)
        axes.set_xlim(-1e3 * _BEFORE, 1e3 * _AFTER)
    for axes in places[len(chosen) :]:
        axes.set_visible(False)
    for axes in rows[-1]:
        axes.set_xlabel("time from the onset (ms)")
    return figure
