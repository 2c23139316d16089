"""docs/fits.md: its tables are those of examples/fits.py, its picture is drawn from them."""

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "fits.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def script() -> ModuleType:
    """The script behind the page."""
    spec = importlib.util.spec_from_file_location("fits", ROOT / "examples" / "fits.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["fits"] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def found(script: ModuleType) -> Any:
    """What the script measures with an eighth of the particles of the page, and another seed."""
    return script.measure(500, judged=100, resamples=16, seed=2)


def cells(text: str, heading: str) -> list[list[str]]:
    """Cells of the Markdown table whose header begins so."""
    lines = text[text.index(heading) :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_the_page_has_the_numbers_of_the_script(script: ModuleType, found: Any) -> None:
    """Exponents, slopes and dependence agree with those of an independent, smaller run.

    Within six combined standard errors, of which the smaller run knows its own to 1/√30: by Student's t about
    1 in 100 000 each, 1 in 1000 for all. Scatter, distances and criteria have no stated error.
    """
    again, compared = script.tables(found), 0
    for heading in ("| flank | law |", "| v (m/s) | a |", "| v (m/s) | share returned |"):
        page, here = cells(PAGE, heading), cells(again, heading)
        assert len(page) == len(here) >= 4
        for one, other in zip(page, here, strict=True):
            assert one[0] == other[0]
            for cell, repeated in zip(one, other, strict=True):
                pair = [re.fullmatch(r"(-?[\d.]+) ± ([\d.]+)", text) for text in (cell, repeated)]
                if pair[0] is None or pair[1] is None:
                    continue
                (value, error), (next_value, next_error) = ((float(m[1]), float(m[2])) for m in pair if m)
                # Rounding of the last digit counts as an error too.
                allowed = 6 * np.hypot(error, next_error) + 2 * 10.0 ** -len(cell.split()[0].split(".")[1])
                assert abs(value - next_value) < allowed, (one[0], cell, repeated)
                compared += 1
    assert compared == 4 * 2 + 14 * 6 + 11 * 2


def test_the_form_ends_where_the_page_says(found: Any) -> None:
    """Distance to the fit around the end: 0.02 above it, 0.04 and more below it, and spheres alternate there.

    A thousand samples add 0.01 of chance, so the means over five bins are held against 0.04.
    """
    end = float(re.search(r"below (0\.\d\d) m/s\*\* the form", PAGE)[1])  # type: ignore[index]
    v, far = (found.slopes.table[name].to_numpy() for name in ("velocity", "ks_distance"))
    above, below = v > end, v < end
    assert far[above][1:6].mean() < 0.04
    assert far[below][-6:-1].mean() > 0.04
    alternation = found.dependence.alternation.to_numpy()
    error = found.dependence.alternation_error.to_numpy()
    assert abs(alternation[above][1:6].mean() - 0.5) < 5 * error[above][1:6].mean()
    assert alternation[below][-11:-1].max() > 0.55


def test_it_ends_because_particles_return(found: Any) -> None:
    """Between 0.11 and 0.25 m/s the form holds on the way down, and not for those that have returned.

    The page has 0.02 to 0.025 and 0.1 to 0.18; one eighth of the particles adds 0.01 of chance.
    """
    means = []
    for part in ("down", "returned"):
        table = found.parts[part][0].table
        means.append(float(table.ks_distance.sel(velocity=slice(0.11, 0.25)).mean()))
    assert means[0] < 0.04
    assert means[1] > 0.1


def test_the_picture_is_drawn(script: ModuleType, found: Any, tmp_path: Path) -> None:
    """Six panels with their letters, every label in place; the caption names every parameter."""
    figure = script.draw(found)
    assert len(figure.axes) == 6
    assert [axes.texts[0].get_text() for axes in figure.axes] == [
        f"({one})" for one in ("a", "b", "c", "d", "e", "f")
    ]
    assert all(axes.get_xlabel() for axes in figure.axes)
    figure.savefig(tmp_path / "fits.png")
    text = script.caption(found)
    assert all(part in text for part in ("500 particles", "ε_n = 0.98", "L/R = 0.1", "R = 3 mm", "60 mm"))
