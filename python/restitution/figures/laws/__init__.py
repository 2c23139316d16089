"""`restitution laws`: one figure of what the collision law does to the result."""

from pathlib import Path

from restitution._internal.arrays import flag
from restitution._internal.files import FOLDER, check_folder, path_for, whole_folder
from restitution.figures.laws._draw import draw
from restitution.figures.laws._measure import ELONGATIONS, LAWS, bound, coupling, growth, measure
from restitution.figures.laws._words import caption, table
from restitution.figures.report import save_with_data

__all__ = ["ELONGATIONS", "LAWS", "bound", "coupling", "draw", "growth", "measure", "table", "write"]

TITLE = "What the collision law does to the coefficient of restitution"


def write(
    out: Path,
    *,
    impacts: int,
    seed: int,
    threads: int | None = None,
    progress: bool = False,
    overwrite: bool = False,
) -> tuple[Path, str]:
    """Measure, and write ``laws.png``, ``.pdf``, ``.nc``, ``.txt`` (the caption) and ``.md`` (the table).

    The folder `out` gets all files or none; one that cannot be written to, or that holds anything and is not
    to be overwritten, is refused before the work begins. Give the PNG, and the table.
    """
    out, overwrite = path_for("out", out, FOLDER), flag("overwrite", overwrite)
    names = [f"laws.{kind}" for kind in ("png", "pdf", "nc", "txt", "md")]
    check_folder(out, replace=overwrite)
    with whole_folder(out, replace=overwrite, names=names) as folder:
        data = measure(impacts, seed, threads=threads, progress=progress)
        rows = table(data)
        save_with_data(draw(data), data, folder / "laws", TITLE, caption(data))
        (folder / "laws.md").write_text(rows, encoding="utf-8")
    return out / "laws.png", rows
