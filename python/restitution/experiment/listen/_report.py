"""The report as one page that needs nothing else, with a table and a netCDF file beside it."""

import math
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from restitution import flight
from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import flag
from restitution._internal.datasets import put
from restitution._internal.files import check, check_apart, path_from, whole_file
from restitution._internal.parameters import ParameterError, wrong
from restitution._internal.text import digits, with_error
from restitution.experiment.flight.times import DOUBLED, DOUBTFUL, FLAGS, GOOD
from restitution.experiment.listen._analysis import (
    Analysis,
    Recording,
    Series,
    analyse,
    heard_in,
    paths_of,
    spread,
)
from restitution.experiment.listen._setting import Setting, checked
from restitution.experiment.listen._shape import Shape
from restitution.experiment.sound.load import load
from restitution.figures.report import Section, drawing, page, paragraph, prose, table, text
from restitution.figures.style import COLORS, PAGE, panels, styled

_FAR = 10.0
"""Laws that are worse by this, in Akaike's criterion, are in the table and not in the figure."""
_MARKS = {GOOD: COLORS[0], DOUBTFUL: COLORS[1], DOUBLED: COLORS[3]}
_COLUMNS = 1400
"""Pixels across which the highest and the lowest sample are drawn."""
_CLOSE_UPS = 6
_BEFORE, _AFTER = 1.5e-3, 4e-3
_PARAMETERS = {
    "normal": r"$\varepsilon_n$",
    "beta": r"$\beta$ ((s/m)$^{1/5}$)",
    "yield_speed": "yield speed (m/s)",
}
_LEAST = -12.0
"""Likelihoods below this, in the logarithm, are treated as zero."""
_NAMES = {
    "normal": "ε_n",
    "elongation": "L/R",
    "scatter": "scatter of ε_n",
    "out_of_roundness": "out-of-roundness (µm)",
    "roughness": "or, of a round ball, Ra (µm)",
}


def write(file: Path | Sequence[Path], out: Path, setting: Setting, *, replace: bool = False) -> Analysis:
    """Analyse recordings of a ball and write ``out``, and beside it the same name with .csv and .nc.

    Raises
    ------
    ValueError
        If `out` is not an HTML file, or nothing is heard.
    OSError
        If a file cannot be read or written.
    """
    read = paths_of(file)
    out, replace = path_from("out", out), flag("replace", replace)
    if out.suffix.lower() not in (".html", ".htm"):
        raise ParameterError(wrong("out", str(out), "a file that ends with .html"))
    checked(setting)
    beside = [out.with_suffix(suffix) for suffix in (".csv", ".nc")]
    # The times of times.csv may have their page times.html: its table then is times.out.csv.
    paths = [*(path.with_suffix(f".out{path.suffix}") if path in read else path for path in beside), out]
    check_apart(read, paths)
    for path in paths:
        check(path, replace=replace)
    analysis = analyse(read, setting)
    csv, nc, html = (whole_file(path, replace=replace) for path in paths)
    with html as page, nc as numbers, csv as table:  # the page takes its place last
        table.write_text(analysis.csv(), encoding="utf-8", newline="")
        put(analysis.dataset(), numbers)
        page.write_text(_page(analysis), encoding="utf-8", newline="")
    return analysis


def _page(analysis: Analysis) -> str:
    setting, together = analysis.setting, analysis.together
    sections, details = [], []
    if together is not None:
        parts = _series(together, setting, analysis.series)
        words = f"{together.drops} drops together"
        sections.append(Section("together", words, [*parts[:1], _drops(analysis), *parts[1:]]))
    for place, one in enumerate(analysis.recordings):
        title = "The recording" if heard_in(one.heard) else "The times"
        title, key = (analysis.named(one), f"-{place}") if len(analysis.recordings) > 1 else (title, "")
        parts = _recording(one, setting)
        if together is None:
            details.append(Section(f"recording{key}", title, parts))
            for series in one.series:
                title = (
                    "Coefficient of restitution" if len(analysis.series) == 1 else f"Series {series.number}"
                )
                details.append(Section(f"series-{series.number}", title, _series(series, setting)))
            continue
        pieces = []
        for series in one.series:
            words = f"Series {series.number}: coefficients and laws"
            pieces += [paragraph(series.sentence(setting)), *_folded(words, _series(series, setting))]
        details.append(Section(f"recording{key}", title, [*pieces, *_folded("Sound and set-up", parts)]))
    for shown in analysis.answers:
        if shown.shape is not None:
            of = f" (series {shown.number})" if len(analysis.answers) > 1 else ""
            sections.append(Section(f"shape-{shown.number}", f"Shape of the ball{of}", _shape(shown.shape)))
            sections.append(Section(f"budget-{shown.number}", f"Error budget{of}", _budget(shown.shape)))
    sections = [*details, *sections] if together is None else [*sections, *details]
    sections.append(Section("impacts", "All impacts", [_impacts(analysis)]))
    warnings = "".join(f"<li>{text(warning)}</li>" for warning in analysis.warnings)
    careful = f"<ul>{warnings}</ul>" if warnings else ""
    lead = "".join(paragraph(sentence, "lead") for sentence in analysis.sentences)
    return page(
        f"{analysis.file}: impacts and coefficient of restitution",
        f'<h1 class="of">{text(analysis.file)}</h1>\n{_answers(analysis)}{lead}\n{careful}',
        sections,
        f"Made by restitution {version('restitution')}.",
    )


def _answers(analysis: Analysis) -> str:
    """Put the numbers first, large, each with its line."""
    found = []
    for one in analysis.answers:
        if one.answer is not None:
            number, line = one.answer
            begin = f"Series {one.number}: " if len(analysis.answers) > 1 else ""
            found.append(paragraph(begin + number, "answer") + paragraph(line, "line"))
    return "\n".join(found)


def _folded(summary: str, parts: list[str]) -> list[str]:
    """Put details behind a line that opens them."""
    return [f"<details><summary>{text(summary)}</summary>", *parts, "</details>"]


def _drops(analysis: Analysis) -> str:
    """Make a table with the mean and the scatter of each drop, by file."""
    rows = []
    for recording in analysis.recordings:
        for one in recording.series:
            mean, cells = one.mean, ["–", "–"]
            if mean is not None:
                cells[0] = prose(mean.estimates()[0][1])
            if mean is not None and mean.scatter_error > 0.0:
                cells[1] = prose(spread(mean.scatter, mean.scatter_error))
            rows.append([text(analysis.named(recording)), str(one.number), str(one.coefficients), *cells])
    caption = "The drops by themselves. The scatter is what errors of measurement do not explain."
    head = ["file", "series", "coefficients", "mean ε", "scatter of ε"]
    return table(head, rows, caption=caption, numbers=(1, 2))


def _recording(given: Recording, setting: Setting) -> list[str]:
    rows = [
        ["diameter", f"{1e3 * setting.diameter:g} mm"],
        ["gravity", f"{with_error(setting.gravity, setting.gravity_error)} m/s²"],
        ["clock", f"right to {setting.clock_uncertainty:g} of what it shows"],
    ]
    if setting.wall is not None:
        rows.append(["wall", f"{1e3 * setting.wall:g} mm"])
    if setting.drop is not None:
        rows.append(["drop height", f"{with_error(setting.drop, setting.drop_uncertainty)} m"])
    drag = setting.drag
    if drag is None:
        rows.append(["air drag", "neglected; give the mass to account for it"])
    else:
        speed = with_error(drag.terminal_velocity, drag.uncertainty)
        rows.append(["air drag", f"quadratic, terminal velocity {speed} m/s"])
    contact = setting.contact
    touching = f"{digits(1e6 * contact.uncertainty)} µs at most; give it"
    if setting.contact_time is not None:
        touching = f"{with_error(1e6 * contact.at_1_m_s, 1e6 * contact.uncertainty)} µs, accounted for"
    rows.append(["time of contact at 1 m/s", touching])
    if not heard_in(given.heard):
        return [table(["", ""], rows, caption="Set-up")]
    attrs = given.heard.attrs
    samples, rate = load(given.path, None)
    sound = samples[:, attrs["channel"]]
    rows[:0] = [
        ["sample rate", f"{attrs['rate']:g} Hz"],
        ["channel", str(attrs["channel"])],
        ["band", text(attrs["band"])],
        ["rule for the onset", text(attrs["rule"])],
    ]
    return [
        drawing(_waveform(given.heard, sound, rate), "The sound against time, with a mark at each impact."),
        drawing(
            _close_ups(given.heard, sound, rate),
            "Onsets, from the first impact to the last, with their standard error.",
        ),
        table(["", ""], rows, caption="Recording and set-up"),
    ]


def _series(one: Series, setting: Setting, drops: Sequence[Series] = ()) -> list[str]:
    parts = []
    if one.coefficients:
        shown = [each.data for each in drops or [one] if each.coefficients]
        figure = flight.figure(shown, *(fit for fit in one.fits if fit.aic < one.fits[0].aic + _FAR))
        parts.append(drawing(figure, "ε against v with standard errors, and the laws with their bands."))
    if one.fits:
        best = one.fits[0].aic
        rows = []
        for fit in one.fits:
            parameters = ", ".join(map(" = ".join, fit.estimates()))
            scatter = spread(fit.scatter, fit.scatter_error) if fit.scatter_error > 0.0 else "none fitted"
            chance = "" if fit.scatter_error > 0.0 else f"{fit.p_value:.2g}"
            quality = [f"{fit.chi2:.1f}/{fit.degrees_of_freedom}", chance, f"{fit.aic - best:.1f}"]
            rows.append([text(fit.law), prose(parameters), prose(scatter), *quality])
        caption = "Laws, the best first. The scatter is what errors of measurement do not explain."
        head = ["law", "parameters", "scatter of ε", "χ²/n", "p", "ΔAIC"]
        parts.append(table(head, rows, caption=caption, numbers=(3, 4, 5)))
    else:
        parts.append(paragraph("Fewer than three coefficients: no law is fitted."))
    return parts


def _shape(found: Shape) -> list[str]:
    parts = [paragraph(found.verdict)]
    if found.draws is None:
        return parts
    drawn = found.draws["posterior"].to_dataset()
    if "rough" in found.draws:
        drawn = drawn.assign(roughness=found.draws["rough"].to_dataset().roughness)
    rows = []
    for name, values in drawn.data_vars.items():
        low, middle, high = np.quantile(values, (0.05, 0.5, 0.95))
        scale = 1e6 if name in ("out_of_roundness", "roughness") else 1.0
        digits = 6 if name in _PARAMETERS else 3
        words = _NAMES.get(str(name), str(name).replace("_", " "))
        rows.append([prose(words), *(f"{scale * x:.{digits}g}" for x in (middle, low, high))])
    parts += [
        drawing(_drawn_shape(found.draws), "Draws of the posterior, and the likelihood of the shape alone."),
        table(
            ["", "median", "5 %", "95 %"], rows, caption="Posterior: median and quantiles", numbers=(1, 2, 3)
        ),
        paragraph(
            "A ball with two lobes, L = 2t, released at rest at an unknown angle, on a plate with unknown "
            "friction: where it sticks at the contact a full ball gets 2/7 of the spin, and the same times "
            "need twice the L/R. Asperities act through a lever arm as a shape does: L/R is of a smooth "
            "ball, Ra of a round one. The priors are uniform in ln L/R and ln Ra unless they were measured. "
            "A ball that was already spinning would be taken for shape; drag that is neglected, for a "
            "material."
        ),
    ]
    return parts


def _budget(found: Shape) -> list[str]:
    parts = [paragraph(found.assumed)]
    if found.budget is None:
        return parts
    head, _, *lines = [line.strip("| ").split(" | ") for line in found.budget.table().splitlines()]
    rows = [[text(cell.replace(" ± ", "\u00a0±\u00a0")) for cell in line] for line in lines]
    caption = (
        "Bias ± standard deviation of each source; “below”: not distinguishable from 0 in the simulation."
    )
    parts += [
        table([text(cell) for cell in head], rows, caption=caption),
        drawing(found.budget.figure(), "Root mean square error of one ε by its source, against the speed."),
    ]
    return parts


def _impacts(analysis: Analysis) -> str:
    data = analysis.dataset()
    shown = np.flatnonzero(data.flag != DOUBLED)
    data = data.isel(impact=shown)

    def written(name: str) -> list[str]:
        """Write numbers with their errors."""
        pairs = zip(data[name].values.tolist(), data[f"{name}_error"].values.tolist(), strict=True)
        return ["–" if math.isnan(value) else with_error(value, error) for value, error in pairs]

    times = data.time.values.tolist()
    errors = zip(times, data.uncertainty.values.tolist(), strict=True)
    rows = zip(
        map(str, shown),
        map(str, data.series.values),
        [FLAGS[flag] for flag in data.flag.values],
        ["–" if math.isnan(time) else f"{time:.6f}" for time in times],
        ["–" if math.isnan(time) else digits(1e6 * error) for time, error in errors],
        written("impact_velocity"),
        written("restitution"),
        strict=True,
    )
    head = ["row", "series", "flag", "time (s)", "error (µs)", "v (m/s)", "ε"]
    return table(head, rows, caption="All impacts, with their standard errors", numbers=(3, 4, 5, 6))


@styled
def _drawn_shape(draws: xr.DataTree) -> Figure:
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


@styled
def _waveform(heard: xr.Dataset, sound: Array, rate: float) -> Figure:
    """Draw the whole recording with a mark at each impact."""
    figure, [[axes]] = panels(PAGE, 2.4)
    step = max(sound.size // _COLUMNS, 1)
    whole = sound[: sound.size // step * step].reshape(-1, step)
    times = (np.arange(whole.shape[0]) + 0.5) * step / rate
    axes.fill_between(times, whole.min(axis=1), whole.max(axis=1), color="0.6", linewidth=0.3)
    top = float(np.abs(sound).max())
    for code, color in _MARKS.items():
        at = heard.time.values[heard.flag.values == code]
        if at.size:
            axes.vlines(at, 1.05 * top, 1.2 * top, color=color, linewidth=0.8, label=FLAGS[code])
    axes.set_xlim(0.0, sound.size / rate)
    axes.set_ylim(-1.1 * top, 1.25 * top)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("sound (full scale 1)")
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower right", ncols=3)
    return figure


@styled
def _close_ups(heard: xr.Dataset, sound: Array, rate: float) -> Figure:
    """Draw a few impacts, from the first to the last, with their onsets and standard errors."""
    heard = heard.isel(impact=np.flatnonzero(heard.flag.values <= DOUBTFUL))
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
