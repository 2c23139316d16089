"""What a file or folder that is to be written may be called: nothing that promises another format."""

from pathlib import Path
from typing import Any

from restitution._internal.files import path_from
from restitution._internal.parameters import ParameterError, wrong

NETCDF, ZARR, HEADER, MODULE, IMAGE, FOLDER = (
    "a netCDF file, such as run.nc",
    "a Zarr store, such as study.zarr",
    "a header of C and C++, such as dist.h",
    "a Fortran source, such as dist.f90",
    "a figure, which is written as .png, .pdf or .svg",
    "a folder",
)
"""What the package writes under names that are given, in the words of an error."""

_OWN = {
    NETCDF: {".nc", ".nc3", ".nc4", ".netcdf", ".cdf", ".h5", ".hdf5"},
    ZARR: {".zarr"},
    HEADER: {".h", ".hh", ".hpp", ".hxx"},
    MODULE: {".f90", ".f95", ".f03", ".f08"},
    IMAGE: {".png", ".pdf", ".svg"},
    FOLDER: set(),
}
_OTHERS = {
    *(".c", ".cc", ".cpp", ".cxx", ".f", ".for", ".py", ".rs", ".jl", ".m", ".r", ".ipynb"),
    *(".csv", ".tsv", ".txt", ".md", ".tex", ".html", ".htm", ".json", ".toml", ".yaml", ".yml", ".xml"),
    *(".xls", ".xlsx", ".ods", ".parquet", ".feather", ".arrow", ".npy", ".npz", ".mat", ".pkl", ".pickle"),
    *(".jpg", ".jpeg", ".gif", ".tif", ".tiff", ".bmp", ".webp", ".eps", ".ps", ".mp4"),
    *(".wav", ".flac", ".ogg", ".mp3", ".aiff", ".zip", ".tar", ".gz", ".bz2", ".xz", ".7z", ".sqlite"),
}


def check_name(argument: str, path: Path, kind: str) -> None:
    """Refuse the name of another format, a folder's, and a dash, which to other programs is standard output.

    Any other name will do: what follows the last dot may be part of a number.

    Parameters
    ----------
    argument : str
        What the name is given as.
    path : Path
        The name.
    kind : str
        What is written: `NETCDF`, `ZARR`, `HEADER`, `MODULE`, `IMAGE` or `FOLDER`.

    Raises
    ------
    ParameterError
        Saying what is written.
    """
    strange = _OTHERS.union(*(own for other, own in _OWN.items() if other != kind))
    nameless = path.name in ("", "..") and kind != FOLDER
    if nameless or path.suffix.lower() in strange or path.name == "-":
        raise ParameterError(wrong(argument, str(path), f"the name of {kind}"))


def path_for(argument: str, value: Any, kind: str) -> Path:
    """Take what names a file that is to be written; errors as of `path_from` and `check_name`."""
    path = path_from(argument, value)
    check_name(argument, path, kind)
    return path
