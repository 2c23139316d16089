"""A folder whose files appear all at once, or not at all."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def unfinished(folder: Path) -> Iterator[Path]:
    """Make a hidden folder inside `folder`, whose files move up into it when the block ends well.

    Being inside, it is on the same file system, so that moving a file is atomic. HTML files move last:
    where the report is, all that it shows is. Files that were there before stay, or are replaced.

    Raises
    ------
    OSError
        If `folder` cannot be made or written to; before the block runs.
    """
    made = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        draft = tempfile.TemporaryDirectory(prefix=".unfinished-", dir=folder)
    except OSError as error:
        raise OSError(error.errno, f"out cannot be written to: {error.strerror}", str(folder)) from None
    try:
        with draft as name:
            yield Path(name)
            for file in sorted(Path(name).iterdir(), key=lambda file: file.suffix == ".html"):
                file.replace(folder / file.name)
    except BaseException:
        with suppress(OSError):  # if something else was put there meanwhile, it stays
            for path in made:
                path.rmdir()
        raise
