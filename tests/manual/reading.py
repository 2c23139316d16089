"""Every kind of file that is read: right ones, and what must hold when they are harmed."""

import contextlib
import shutil
import traceback
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import openpyxl
import xarray as xr
import xlwt

import restitution as rs
from manual.damage import BINARY, TEXT, Harm, harm_store, harmed
from reference import measuring
from reference.calls import folder, good
from reference.command import SMALL, invoke
from reference.commands import RUN, STUDY, same
from reference.harmed import harms
from restitution import flight, study
from restitution.distribution._store import sealed
from restitution.drop import toml as _toml
from restitution.experiment import listen
from restitution.experiment.listen import Setting
from restitution.study._results import study_in


@dataclass(frozen=True)
class Kind:
    """A kind of file.

    Attributes
    ----------
    name : str
        Of a file that is harmed.
    make : callable
        Write one that is harmed to a path.
    read : callable
        Read it.
    """

    name: str
    make: Callable[[Path, Random], None]
    read: Callable[[Path], Any]


def _text(name: str, whole: str, read: Callable[[Path], Any]) -> Kind:
    return _of_bytes(name, lambda: whole.encode(), TEXT, read)


def _of_bytes(
    name: str, whole: Callable[[], bytes], kinds: tuple[Harm, ...], read: Callable[[Path], Any]
) -> Kind:
    return Kind(name, lambda path, draw: _write(path, harmed(whole(), draw, kinds)), read)


def _write(path: Path, content: bytes) -> None:
    path.write_bytes(content)


class Told(Exception):
    """An error of ours came, which names the file."""


def told(read: Callable[[Path], Any], path: Path) -> None:
    """Read a file; an error that names it is what should come."""
    try:
        read(path)
    except (ValueError, OSError) as error:
        where = str(getattr(error, "filename", None) or error)
        if path.name not in where:
            raise AssertionError(f"names no file: {error!r}") from error
        raise Told from error


TIMES = [0.512, 0.912, 1.29, 1.649]
CSV = '"Event time (s)","Interval (s)"\n' + "".join(f"{time:.9E},NaN\n" for time in TIMES)


@cache
def _sheet(suffix: str) -> bytes:
    path = folder() / f"times{suffix}"
    if suffix == ".zip":
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("All.csv", CSV)
    elif suffix == ".xlsx":
        book = openpyxl.Workbook()
        for row in [["time (s)"], *[[time] for time in TIMES]]:
            book.active.append(row)
        book.save(path)
    else:
        old = xlwt.Workbook()
        sheet = old.add_sheet("times")
        for i, value in enumerate(["time (s)", *TIMES]):
            sheet.write(i, 0, value)
        old.save(path)
    return path.read_bytes()


@cache
def _recording(suffix: str) -> bytes:
    import soundfile

    path = folder() / f"short{suffix}"
    soundfile.write(path, measuring.samples(), 8000)
    return path.read_bytes()


def _hear(path: Path) -> None:
    listen.analyse(path, Setting(diameter=0.02))


def _learned(path: Path) -> None:
    """What loads is what was saved, or could have been."""
    found = rs.FluctuatingRestitution.load(path)
    low, high = found.velocities
    if not (0.0 <= found.cdf(0.8, 0.5 * (low + high)) <= 1.0 and np.isfinite(found.mean(low))):
        raise AssertionError("what was loaded is no distribution")


def _harmed_learned(path: Path, draw: Random) -> None:
    """The bytes, or the content under a checksum that is right."""
    data = good()[draw.choice(("dist", "given"))].data
    _netcdf(path, draw, data, sealed)


def _harmed_run(path: Path, draw: Random) -> None:
    _netcdf(path, draw, draw.choice((good()["data"], good()["found"])), lambda harmed: harmed)


def _netcdf(path: Path, draw: Random, data: xr.Dataset, close: Callable[[xr.Dataset], xr.Dataset]) -> None:
    inside = draw.random() < 0.6
    if inside:
        try:
            _, harm = draw.choice(list(harms(data, tuple(map(str, data.attrs)))))
            close(harm(data)).to_netcdf(path, engine="netcdf4")
        except (ValueError, TypeError, RuntimeError):  # netCDF has no such thing
            inside = False
    if not inside:
        close(data).to_netcdf(path, engine="netcdf4")
        _write(path, harmed(path.read_bytes(), draw, BINARY))


def _fit(path: Path) -> None:
    """The command, in a line of words."""
    done = invoke("fit", path, "--velocity", 0.5, 0.9, "--resamples", 3)
    if done.exit_code == 0:
        return
    if not isinstance(done.exception, SystemExit) or "Traceback" in done.stderr:
        raise AssertionError(repr(done.exception)) from done.exception
    # Of what is in the file it speaks as the call does, to which it is an argument.
    raise ValueError(done.stderr.replace("samples", str(path)).replace("statistics", str(path)))


def _harmed_store(path: Path, draw: Random) -> None:
    shutil.copytree(measuring.store(), path)
    harm_store(path, draw)


@cache
def _results() -> xr.Dataset:
    return study.open_store(measuring.store()).load()


def _learn(path: Path) -> None:
    study.learned(path, normal=0.9)


def _merge(path: Path) -> None:
    study.merge(path, [], threads=1)


def _store(path: Path) -> None:
    """All that reads a store; a study that goes on has the bits of one that was never disturbed."""
    whole = _results()
    for call in (study.status, study.open_store, _learn, _merge):
        with contextlib.suppress(Told):
            told(call, path)
    rs.sweep(study_in(measuring.store()), path, threads=1)
    found = study.open_store(path).load()
    assert same(found.drop_attrs(), whole.drop_attrs()), "goes on with other results"


KINDS: dict[str, Kind] = {
    "run": _text("run.toml", SMALL, lambda path: _toml.read(path)),
    "comparison": _text("compare.toml", RUN.replace("PARTICLES", "7"), lambda path: _toml.read_all(path)),
    "study": _text("study.toml", STUDY.replace("PARTICLES", "7"), lambda path: study.study_of(path)),
    "times": _text("times.csv", CSV, flight.read),
    **{
        f"times{suffix}": _of_bytes(f"times{suffix}", partial(_sheet, suffix), BINARY, flight.read)
        for suffix in (".zip", ".xlsx", ".xls")
    },
    **{
        f"sound{suffix}": _of_bytes(f"ball{suffix}", partial(_recording, suffix), BINARY, _hear)
        for suffix in (".wav", ".flac", ".ogg")
    },
    "learned": Kind("dist.nc", _harmed_learned, _learned),
    "fit": Kind("run.nc", _harmed_run, _fit),
    "store": Kind("study.zarr", _harmed_store, _store),
}


def trial(kind: str, seed: int, place: Path) -> str | None:
    """Harm a file of a kind and read it; say what breaks the contract, if anything does."""
    path = place / KINDS[kind].name
    KINDS[kind].make(path, Random(f"{kind} {seed}"))
    try:
        told(KINDS[kind].read, path)
    except Told:
        return None
    except Exception as error:
        return "".join(traceback.format_exception(error)[-4:])
    return None
