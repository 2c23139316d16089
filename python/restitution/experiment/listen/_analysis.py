"""Analysis of a recording: impacts, coefficients, laws, and warnings."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
import xarray as xr

from restitution import flight
from restitution._internal.datasets import Content
from restitution._internal.files import path_from
from restitution._internal.parameters import ParameterError, Problem, TooLargeError, wrong
from restitution._internal.text import digits, with_error
from restitution.bodies import from_roundness
from restitution.experiment.flight.chain import measured_of
from restitution.experiment.flight.laws import LAWS
from restitution.experiment.flight.separation import KNOWN, Separation, separation
from restitution.experiment.flight.times import DOUBLED, DOUBTFUL, FLAGS, GOOD
from restitution.experiment.listen._setting import Setting, checked
from restitution.experiment.listen._shape import Shape, shape
from restitution.experiment.sound import impacts

_CLIPPED = 0.02
"""Share of loud samples at the limit from which clipping is reported."""
_FEWEST_FOR_SCATTER = 6
"""Coefficients that are needed to fit a scatter beside a law."""
_EXPLAINED = 0.01
"""Probability of a law from which on errors of measurement explain all scatter."""
_BETTER = 6.0
"""In Akaike's criterion, from which on a law is said to fit better than a constant."""
_FIRST = 0.3
"""The first ε over the later ones, below which the drop was not in m."""
_LIGHT = 500.0
"""Mean density in kg/m³ below which a ball is asked about: of wood, cork and foam, or hollow."""
_LOSSY = (".mp3", ".ogg", ".oga", ".opus", ".aac", ".3gp", ".amr", ".wma")
"""Endings of files that are compressed with loss."""
_OFTEN_LOSSY = (".m4a", ".mp4")
"""And of those that are, unless they are Apple Lossless."""
_TABLES = (".csv", ".tsv", ".txt", ".xls", ".xlsx", ".zip")
"""Endings of files that hold times of impacts."""
_UNITS = {
    "time": "s",
    "uncertainty": "s",
    "impact_velocity": "m/s",
    "impact_velocity_error": "m/s",
    "restitution": "1",
    "restitution_error": "1",
}
"""Of the columns of the table with a line for each impact."""


@dataclass(frozen=True, eq=False)
class Series(Content):
    """One series of impacts, or all that are combined.

    Attributes
    ----------
    number : int
        Of the series, from 0 over all files.
    heard : Dataset
        Its rows of what `sound.impacts` found.
    data : Dataset
        What `flight.restitution` makes of them.
    fits : tuple of LawFit
        The laws that could be fitted, the best first; none where there are too few impacts.
    shape : Shape or None
        What the times say of the ball's shape, and the error budget; None where no law was fitted, or where
        the errors of the times are not known.
    note : str
        What is known of these errors where the table did not give them.
    drops, tables : int
        Number of series that are combined in it, and of folders they come from: those of the tables of a
        class, each with a ball and a plate of its own.
    """

    number: int
    heard: xr.Dataset
    data: xr.Dataset
    fits: tuple[flight.LawFit, ...]
    shape: Shape | None
    note: str = ""
    drops: int = 1
    tables: int = 1

    @property
    def _known(self) -> xr.Dataset:
        """The impacts whose coefficient of restitution is known."""
        return self.data.isel(impact=np.flatnonzero(np.isfinite(self.data.restitution)))

    @property
    def coefficients(self) -> int:
        """Number of coefficients of restitution."""
        return self._known.sizes["impact"]

    @property
    def _speeds(self) -> str:
        """Between which speeds they are."""
        speeds = self._known.impact_velocity.values
        return f"between {speeds.min():.2f} and {speeds.max():.2f} m/s"

    @property
    def mean(self) -> flight.LawFit | None:
        """The constant that fits, which is the mean coefficient."""
        return next((fit for fit in self.fits if fit.law == "constant"), None)

    @property
    def answer(self) -> tuple[str, str] | None:
        """The result: the mean ε with its error, and a line on where it holds and what makes ε scatter."""
        if self.mean is None:
            return None
        line = f"The mean {self._speeds}"
        if self.tables > 1 and self.mean.between_groups_error > 0.0:
            differ = spread(self.mean.between_groups, self.mean.between_groups_error)
            line += f". Tables differ by {differ}"
        if self.shape is not None and self.shape.draws is not None:
            line += f". {self.shape.draws.attrs['answer']}"
        [(_, value)] = self.mean.estimates()
        return f"ε = {value}", f"{line}."

    def sentence(self, setting: Setting) -> str:
        """State the result in a sentence, as a paper would."""
        checked(setting)
        error = float(np.nanmedian(self.data.uncertainty.values)) * 1e6
        number = int(np.isfinite(self.data.time).sum())
        timed = f"timed to {digits(error)} µs (standard error)" if error else "with times of unknown error"
        drops = f" in {self.drops} drops" if self.drops > 1 else ""
        what = "a ball" if self.tables == 1 else f"balls at {self.tables} tables,"
        begin = (
            f"From the {'sound' if heard_in(self.heard) else 'times'} of {number} impacts{drops} of {what} "
            f"of {1e3 * setting.diameter:g} mm diameter, {timed}"
        )
        if not self.coefficients:
            return f"{begin}, no coefficient of restitution can be given."
        mean = self.mean
        if mean is None:
            columns = (self._known.restitution.values.tolist(), self._known.restitution_error.values.tolist())
            values = ", ".join(map(with_error, *columns))
            return f"{begin}, the coefficient of restitution is {values} {self._speeds}."
        best = self.fits[0]
        [(_, value)] = mean.estimates()
        text = f"{begin}, the mean coefficient of restitution {self._speeds} is {value}"
        if mean.scatter_error > 0.0:
            text += f", with a scatter of {spread(mean.scatter, mean.scatter_error)} from impact to impact"
            text += " that errors of the times do not explain" if error else ""
        between = "between drops"
        if self.tables == self.drops:
            between = "between tables"
        elif self.tables > 1:
            between = "between drops at one table"
        if mean.between_error > 0.0:
            text += f", and of {spread(mean.between, mean.between_error)} {between}"
        if mean.between_groups_error > 0.0:
            text += f", and of {spread(mean.between_groups, mean.between_groups_error)} between tables"
        text += "; air drag is accounted for" if setting.mass is not None else "; air drag is neglected"
        if setting.contact_time is None:
            most = digits(1e6 * setting.contact.uncertainty)
            text += f", and the time of contact may be anything up to {most} µs at 1 m/s"
        gain = mean.aic - best.aic
        if gain >= _BETTER and setting.mass is not None:
            text += f". The law that fits best is {str(best).splitlines()[0]}"
            text += f", by {gain:.1f} in Akaike's criterion over a constant"
            if self.shape is not None and self.shape.bends:
                text += "; a surface that is not that of a sphere makes ε depend on the speed, too"
        elif gain >= _BETTER:
            text += (
                ". It depends on the speed, as neglected drag alone would have it: give the mass of the ball"
            )
        if self.shape is not None and self.shape.draws is not None:
            text += f". {self.shape.verdict.rstrip('.')}"
        return f"{text}. {self.note}".rstrip() if self.note else f"{text}."


class Recording(NamedTuple):
    """A file: its path, what `sound.impacts` or `flight.read` found in it, and its series."""

    path: Path
    heard: xr.Dataset
    series: tuple[Series, ...]


@dataclass(frozen=True, eq=False)
class Analysis(Content):
    """All results of one recording, or of several of one ball.

    Attributes
    ----------
    setting : Setting
        What was known besides.
    recordings : tuple of Recording
    together : Series or None
        Where there are several drops, what they say together, with a term between them; the shape is inferred
        from all of them, and that of each is None.
    """

    setting: Setting
    recordings: tuple[Recording, ...]
    together: Series | None

    @property
    def file(self) -> str:
        """Names of the files."""
        return ", ".join(map(self.named, self.recordings))

    def named(self, recording: Recording) -> str:
        """Return the name of a file, with its folder where there are several."""
        several = len({one.path.parent for one in self.recordings}) > 1
        path = recording.path
        return f"{path.parent.name}/{path.name}" if several else path.name

    @property
    def series(self) -> tuple[Series, ...]:
        """All series, by file and time."""
        return tuple(one for recording in self.recordings for one in recording.series)

    @property
    def answers(self) -> tuple[Series, ...]:
        """All drops together, or each series."""
        return self.series if self.together is None else (self.together,)

    @property
    def sentences(self) -> list[str]:
        """The result, of each of the answers."""
        return [one.sentence(self.setting) for one in self.answers]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Reasons for care, a sentence or two each; disagreements come first."""
        return tuple(_warnings(self))

    def dataset(self) -> xr.Dataset:
        """Put everything into one Dataset over ``impact``; the covariance is that of each series.

        Of several files, ``file`` is the number of the impact's file, from 0, whose times begin with it.
        """
        heard = [one.heard for one in self.recordings]
        table = heard[0].copy()
        if len(heard) > 1:
            table = xr.concat(heard, "impact", combine_attrs="override")
            files = np.repeat(np.arange(len(heard)), [one.sizes["impact"] for one in heard])
            table["file"] = ("impact", files)
            table.attrs = {"files": self.file}
        rows = table.sizes["impact"]
        names = ("impact_velocity", "impact_velocity_error", "restitution", "restitution_error")
        for name in names:
            table[name] = ("impact", np.full(rows, np.nan), self.series[0].data[name].attrs)
        none = np.full((rows, rows), np.nan)
        table["restitution_covariance"] = (("impact", "other_impact"), none, {"units": "1"})
        for one in self.series:
            places = np.flatnonzero((table.series == one.number) & (table.flag != DOUBLED))
            for name in names:
                table[name].values[places] = one.data[name].values
            covariance = one.data.restitution_covariance.values
            table.restitution_covariance.values[np.ix_(places, places)] = covariance
        known = {name: value for name, value in self.setting.model_dump().items() if value is not None}
        table.attrs |= known | {"doubtful": int(self.setting.doubtful)}
        table.attrs["gravity_uncertainty"] = self.setting.gravity_error
        return table

    def csv(self) -> str:
        """Write a line for each impact; `flight.read` reads the times of a single series back."""
        data = self.dataset()
        data = data.isel(impact=np.flatnonzero(data.flag != DOUBLED))
        data["flag"] = ("impact", [FLAGS[flag] for flag in data.flag.values])
        columns = {name: name for name in ("series", "flag")}
        if len(self.recordings) > 1:
            data["file"] = ("impact", [self.named(self.recordings[number]) for number in data.file.values])
            columns = {"file": "file"} | columns
        columns |= {name: f"{name.replace('_', ' ')} ({unit})" for name, unit in _UNITS.items()}
        table = data[list(columns)].to_dataframe().rename(columns=columns)
        return str(table.to_csv(index=False, float_format="%.9g", lineterminator="\n"))


def paths_of(file: Any) -> list[Path]:
    """Take the name of a file, or several."""
    if isinstance(file, list | tuple) and file:
        return [path_from(f"file[{number}]", one) for number, one in enumerate(file)]
    return [path_from("file", file)]


def analyse(file: Path | Sequence[Path], setting: Setting) -> Analysis:
    """Listen to recordings of one ball, or read tables of times, and fit what is heard.

    Raises
    ------
    ValueError
        If no series of impacts is heard, or the drop does not go with the first flight.
    OSError
        If a file cannot be read.
    """
    paths = paths_of(file)
    checked(setting)
    found = [_heard(path, setting) for path in paths]
    number = 0
    for heard, _ in found:
        heard["series"] = heard.series + number
        number = int(heard.series.max()) + 1
    recordings = tuple(
        _recording(path, heard, told, setting) for path, (heard, told) in zip(paths, found, strict=True)
    )
    several = [
        (one, each.path.parent)
        for each in recordings
        for one in each.series
        if one.coefficients >= _FEWEST_FOR_SCATTER and one.fits
    ]
    together = _together(several, setting) if len(several) > 1 else None
    if together is None:
        recordings = tuple(
            one._replace(series=tuple(replace(s, shape=shape([s.data], s.fits, setting)) for s in one.series))
            for one in recordings
        )
    return Analysis(setting, recordings, together)


def _heard(file: Path, setting: Setting) -> tuple[xr.Dataset, Separation]:
    """Return the impacts of a file, and what is known of the errors of their times."""
    if file.suffix.lower() in _TABLES:
        heard, told = flight.read(file, uncertainty=setting.time_uncertainty), KNOWN
        if not heard.uncertainty.fillna(0.0).any():  # where the coefficients show errors, these are put in
            told = separation([measured_of(_coefficients(heard, setting, first=True))])
            errors = np.where(np.isnan(heard.time.values), np.nan, told.timing)
            heard = heard.assign(uncertainty=("impact", errors, heard.uncertainty.attrs))
        heard["series"] = xr.zeros_like(heard.flag, dtype=np.int64)
        return heard, told
    if setting.time_uncertainty is not None:
        text = ": a recording, in which errors of times are found, not given"
        raise ParameterError(Problem(str(file), text))
    return impacts(file), KNOWN


def heard_in(heard: xr.Dataset) -> bool:
    """Tell times that were heard in a recording from those of a table."""
    return "rate" in heard.attrs


def _recording(path: Path, heard: xr.Dataset, told: Separation, setting: Setting) -> Recording:
    """Evaluate the series of a file that have three good impacts; if none has, the first says why not."""
    flags = (GOOD, DOUBTFUL) if setting.doubtful else (GOOD,)
    good = heard.series.values[np.isin(heard.flag.values, flags)]
    numbers = [int(one) for one in np.unique(good) if np.count_nonzero(good == one) > 2] or [
        int(heard.series[0])
    ]
    return Recording(
        path, heard, tuple(_series(heard, one, setting, told, first=one == numbers[0]) for one in numbers)
    )


def _series(heard: xr.Dataset, number: int, setting: Setting, told: Separation, *, first: bool) -> Series:
    rows = heard.isel(impact=np.flatnonzero(heard.series == number))
    data = _coefficients(rows, setting, first=first)
    if first:
        _check_drop(data, setting)
    known = int(np.isfinite(data.restitution).sum())
    timed = bool(data.uncertainty.fillna(0.0).any())
    fits = _fitted(data, told.scatter) if timed and known >= 3 else ()
    if known >= _FEWEST_FOR_SCATTER and not any(fit.p_value > _EXPLAINED for fit in fits):
        fits = _fitted(data, "fit")
    if not any(fit.law == "constant" for fit in fits):
        fits = ()
    return Series(number, rows, data, fits, None, told.words)


def _together(found: list[tuple[Series, Path]], setting: Setting) -> Series:
    """Combine drops: one fit with a scatter between them and between tables, one posterior of one ball."""
    several, folders = [one for one, _ in found], [folder for _, folder in found]
    tables = len(set(folders))
    parts = [one.data for one in several]
    data = xr.concat(
        [one.drop_dims("other_impact") for one in parts], "impact", combine_attrs="drop_conflicts"
    )
    fits = _fitted(parts, "fit", folders)
    heard = xr.concat([one.heard for one in several], "impact", combine_attrs="override")
    of_all = shape(parts, fits, setting) if tables == 1 else None
    return Series(0, heard, data, fits, of_all, drops=len(several), tables=tables)


def _coefficients(rows: xr.Dataset, setting: Setting, *, first: bool) -> xr.Dataset:
    return flight.restitution(
        rows,
        gravity=setting.gravity,
        gravity_uncertainty=setting.gravity_uncertainty,
        clock_uncertainty=setting.clock_uncertainty,
        # The drop is that of the first series of a file; another one made the others.
        drop_height=setting.drop if first else None,
        drop_height_uncertainty=setting.drop_uncertainty,
        drag=setting.drag,
        contact_time=setting.contact,
        doubtful=setting.doubtful,
    )


def _fitted(
    data: xr.Dataset | list[xr.Dataset],
    scatter: float | Literal["fit"],
    groups: Sequence[Path] | None = None,
) -> tuple[flight.LawFit, ...]:
    """Fit all laws that the number and errors of the coefficients allow; the best comes first."""
    fits = []
    for law in LAWS:
        try:
            fits.append(flight.fit(data, law, scatter=scatter, groups=groups))
        except TooLargeError:
            raise
        except ParameterError:  # too few coefficients for this one
            continue
    return tuple(sorted(fits, key=lambda fit: fit.aic))


def _check_drop(first: xr.Dataset, setting: Setting) -> None:
    """Refuse a drop that the first flight contradicts."""
    if setting.drop is None:
        return
    ratio = float(first.restitution[0])
    interval = float(first.time[1] - first.time[0])
    height = setting.gravity * interval**2 / 8.0
    if ratio > 1.05:
        text = (
            f" = {setting.drop:g} m: the first flight heard, {interval:.3f} s, is {height:.3g} m high; "
            "the drop is wrong, or the sample rate of the file, or an earlier impact was not heard"
        )
        raise ParameterError(Problem("drop", text))
    # From a drop in cm the first ε is a tenth of the next one.
    later = float(np.nanmedian(first.restitution.values[1:])) if first.sizes["impact"] > 3 else math.nan
    if ratio < _FIRST * later:
        meant = f"{setting.drop:g} cm are {setting.drop / 100:g}"
        allowed = f"in m: the first flight rises by {height:.3g}; {meant}"
        raise ParameterError(wrong("drop", setting.drop, allowed))


def _lossy(file: Path) -> list[str]:
    kind = file.suffix.lower()
    if kind not in _LOSSY + _OFTEN_LOSSY:
        return []
    but = ", unless it is Apple Lossless" if kind in _OFTEN_LOSSY else ""
    return [f"{kind} compresses with loss, which moves onsets{but}; record in WAV or FLAC where you can."]


def _warnings(analysis: Analysis) -> list[str]:
    setting, several = analysis.setting, len(analysis.series) > 1
    found = [
        f"{_named(one, len(analysis.answers) > 1)}{one.shape.disagreement}"
        for one in analysis.answers
        if one.shape and one.shape.disagreement
    ]
    for heard in (one.heard for one in analysis.recordings):
        share = float(heard.attrs.get("clipped_share", 0.0))
        if share > _CLIPPED:
            found.append(
                f"{100 * share:.0f} % of the loud samples are clipped: "
                "loudness is lost, times are not; record with less gain."
            )
    if setting.mass is not None and setting.wall is None:
        density = setting.mass / from_roundness(setting.diameter, 0.0, density=1.0).mass
        if density < _LIGHT:
            found.append(
                f"The mean density of the ball is {digits(density)} kg/m³: if it is hollow, give the "
                "thickness of its wall; taken for a full ball, it seems rounder than it is."
            )
    for heard in (one.heard for one in analysis.recordings):
        others = int(heard.attrs.get("other_ball_impacts", 0))
        if others:
            found.append(
                f"A second ball: {others} sounds between the impacts follow one another like those of "
                "another ball, and enter no fit; record one ball at a time."
            )
    for one in analysis.series:
        flags = one.heard.flag.values
        name = _named(one, several)
        left_out = "doubtful" if setting.doubtful else "doubtful, which no fit takes unless asked"
        for code, what in ((1, left_out), (2, "missed"), (3, "doubled")):
            number = int(np.count_nonzero(flags == code))
            if number:
                found.append(f"{name}{number} impact{'s' * (number > 1)} {what}.")
        over = int(np.count_nonzero(one.data.restitution.values > 1.0))
        if over:
            words = "above 1: a non-spherical body, or wrong times"
            found.append(f"{name}{over} coefficient{'s' * (over > 1)} {words}.")
        if analysis.together is not None and not (one.fits and one.coefficients >= _FEWEST_FOR_SCATTER):
            found.append(f"{name}{one.coefficients} coefficients, too few to be combined with the others.")
    return found + [text for one in analysis.recordings for text in _lossy(one.path)]


def spread(value: float, error: float) -> str:
    """Write a scatter with its error, or what it is below where it may be none."""
    return with_error(value, error) if value > error else f"less than {digits(value + 2.0 * error)}"


def _named(one: Series, several: bool) -> str:
    return f"Series {one.number}: " if several else ""
