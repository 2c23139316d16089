"""`restitution laws`, and the numbers of docs/energy.md."""

import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import restitution as rs
from restitution.cli import app
from restitution.figures.laws import ELONGATIONS, LAWS, bound, coupling

PAGE = (Path(__file__).parents[2] / "docs" / "energy.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the command writes with less than a twentieth of the impacts of the page, and another seed."""
    out = tmp_path_factory.mktemp("laws")
    result = CliRunner().invoke(app, ["laws", "--out", str(out), "--impacts", "300000", "--seed", "2"])
    assert result.exit_code == 0, result.output
    assert result.output.strip() == str(out / "laws.png")
    return out


def rows(text: str, heading: str) -> list[list[str]]:
    """Cells of the Markdown table whose header begins so."""
    lines = text[text.index(heading) :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]


def estimate(cell: str) -> tuple[float, float] | None:
    """Value and standard error of a cell, or None where there is nothing."""
    match = re.fullmatch(r"([\d.]+) ± ([\d.]+)( %)?", cell)
    return (float(match[1]), float(match[2])) if match else None


def test_the_page_has_the_numbers_of_the_command(folder: Path) -> None:
    """Every share, σ(ε) and E_rot/E_tot of the page agrees with those of an independent, smaller run.

    Within six combined standard errors, which come from 16 batches each: 1 in 40 000 by Student's t for the
    smaller run alone, 1 in 500 for all 80 numbers. A share of 6 in 100 000 may not show in the smaller run.
    """
    page, found = rows(PAGE, "| L/R | law |"), rows((folder / "laws.md").read_text("utf-8"), "| L/R | law |")
    assert [row[:2] for row in page] == [row[:2] for row in found]
    assert len(page) == len(ELONGATIONS) * len(LAWS)
    compared = 0
    for one, other in zip(page, found, strict=True):
        for cell, again in ((one[k], other[k]) for k in (3, 5, 7, 8)):
            stated, measured = estimate(cell), estimate(again)
            if stated is None or measured is None:
                assert {cell, again} <= {"none"} or (stated is not None and stated[0] < 0.01)
                continue
            compared += 1
            error = np.hypot(stated[1], measured[1])
            assert abs(stated[0] - measured[0]) < 6 * error, (one[:2], cell, again)
    assert compared >= 48 + 6


def test_only_two_laws_create_energy(folder: Path) -> None:
    """The paper's on every body, Newton's hypothesis on long ones; no factor is beyond the bound."""
    with xr.open_dataset(folder / "laws.nc") as data:
        creating = (data["all_share"] > 0).transpose("law", "elongation").to_numpy()
        papers = data["all_factor"].isel(law=0)
        assert bool((papers <= data["bound"] * (1 + 1e-6)).all())
        # Long bodies come up to it.
        assert bool((papers > 1 + 0.99 * (data["bound"] - 1)).sel(elongation=[0.5, 2.0]).all())
    expected = np.zeros((len(LAWS), len(ELONGATIONS)), bool)
    expected[0] = True
    expected[list(LAWS).index("Coulomb, Newton"), 2:] = True
    np.testing.assert_array_equal(creating, expected)


def test_the_table_of_bounds() -> None:
    """κ², the range of ε_t that is safe, and λ, from the formulas, to the digits of the page."""
    normal = 0.98
    for elongation, (name, largest, safe, growth) in zip(
        ELONGATIONS, rows(PAGE, r"| $L/R$ | largest $\kappa^2$"), strict=True
    ):
        body = rs.Dumbbell(radius=1.0, separation=elongation)
        kappa2 = float(coupling(body, np.linspace(0, np.pi / 2, 20_001)).max())
        assert float(name) == elongation
        assert float(largest.strip("$").replace(r" \cdot 10^{-5}", "e-5")) == pytest.approx(kappa2, rel=1e-3)
        assert float(growth) == pytest.approx(bound(body, normal, 1.0), abs=6e-5)
        low, high = (float(x.replace("−", "-")) for x in safe.strip("[]").split(", "))
        assert max(bound(body, normal, low), bound(body, normal, high)) == 1
        assert bound(body, normal, high + 2e-4) > 1
        assert bound(body, normal, low - 2e-4 * (1 + low) - 1e-4) > 1 or low - 1e-4 < -1


def test_files_say_what_they_are(folder: Path) -> None:
    """Figure, caption, data and table lie side by side; the data hold caption, seed and standard errors."""
    assert sorted(file.name for file in folder.iterdir()) == [
        f"laws.{suffix}" for suffix in ("md", "nc", "pdf", "png", "txt")
    ]
    caption = (folder / "laws.txt").read_text("utf-8").strip()
    for part in ("ε_n = 0.98", "μ = 0.3", "e_t = 0", "R = 3 mm", "60 mm", "9.81 m/s²", "seed 2", *LAWS):
        if part not in ("ε_t = 1 (the paper's)", "Coulomb, Newton"):  # these create energy
            assert part in caption
    with xr.open_dataset(folder / "laws.nc") as data:
        assert data.attrs["caption"] == caption
        assert data.attrs["seed"] == 2
        assert list(data["law"].values) == list(LAWS)
        area = (
            data["density"].sum("site") * (data["restitution"][:, 1] - data["restitution"][:, 0])
        ).to_numpy()
        assert np.all((area > 0.99) & (area < 1 + 1e-12))
        for name in ("deviation", "mean_fraction", "total_share", "all_share", "density"):
            assert f"{name}_error" in data


@pytest.mark.parametrize(
    ("option", "value", "reason"),
    [("--impacts", "100", "impacts = 100"), ("--seed", "-1", "seed = -1"), ("--threads", "0", "threads = 0")],
)
def test_bad_input_is_refused_in_a_line(tmp_path: Path, option: str, value: str, reason: str) -> None:
    result = CliRunner().invoke(app, ["laws", "--out", str(tmp_path / "laws"), option, value])
    assert result.exit_code == 2
    assert reason in result.output
    assert not (tmp_path / "laws").exists()
