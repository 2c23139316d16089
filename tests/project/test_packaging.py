"""What is said of the package in several places is the same."""

import re
import runpy
import shutil
import tomllib
from pathlib import Path
from types import SimpleNamespace

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
VERSION = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]


release = SimpleNamespace(**runpy.run_path(str(ROOT / "packaging/release.py")))  # a program


def test_all_places_name_one_version() -> None:
    assert release.wrong(ROOT, None) == []
    assert release.cited(ROOT, "version") == VERSION


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """What a release changes, in a tree that has an address."""
    changed = {*release.PLACES, "pyproject.toml", "CHANGELOG.md", "paper/paper.md"}
    changed |= {name for name, *_ in release.BEFORE}
    for name in changed:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    with (tmp_path / "CITATION.cff").open("a") as file:
        file.write("url: https://example.org/r\nrepository-code: https://example.org/code\n")
    return tmp_path


def test_a_release(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Version and date come into every place, no text speaks of the time before; a tag has to be the same."""
    release.main([VERSION], tree)
    date = release.cited(tree, "date-released")
    assert f"## [{VERSION}] - {date}\n" in (tree / "CHANGELOG.md").read_text(encoding="utf-8")
    for name, old, new in release.BEFORE:
        text = (tree / name).read_text(encoding="utf-8")
        assert (old in text, new in text) == (False, True), name
    told = release.wrong(tree, "v9.9.9")
    assert told[0] == f"tag v9.9.9, not v{VERSION}"
    assert all("ORCID" in line or "paper.md" in line for line in told[1:])  # which a person has to fill in
    with pytest.raises(SystemExit, match=r"^CHANGELOG\.md: has no section ## \[9\.9\.9\]$"):
        release.main(["9.9.9"], tree)
    assert len(release.wrong(tree, None)) == 0
    again = {name: (tree / name).read_bytes() for name in ("pyproject.toml", "packaging/conda/recipe.yaml")}
    assert b'\nRepository = "https://example.org/code"\n' in again["pyproject.toml"]
    assert b"\n  homepage: https://example.org/r\n" in again["packaging/conda/recipe.yaml"]
    release.main([VERSION], tree)
    assert {name: (tree / name).read_bytes() for name in again} == again


def test_links_on_a_package_index(tree: Path) -> None:
    """Every link of the page leads somewhere from there: to the tag of the version."""
    release.main(["--readme"], tree)
    text = (tree / "README.md").read_text(encoding="utf-8")
    links = re.findall(r'(?:\]\(|src=")([^)"]+)', text)
    assert len(links) > 30
    assert all(link.startswith("https://") for link in links)
    assert f"https://example.org/code/raw/v{VERSION}/docs/images/gain.gif" in links
    assert f"https://example.org/code/blob/v{VERSION}/docs/start.md" in links


def test_the_conda_recipe_asks_for_the_same() -> None:
    """Conda's matplotlib without its windows has a name of its own."""
    recipe = (ROOT / "packaging/conda/recipe.yaml").read_text()
    run = recipe.partition("  run:\n")[2].partition("\n\n")[0]
    asked = [line.removeprefix("    - ").replace(" ", "") for line in run.splitlines()]
    assert asked[0] == "python" + PROJECT["requires-python"]
    wanted = [one.lower().replace("matplotlib", "matplotlib-base") for one in PROJECT["dependencies"]]
    assert asked[1:] == wanted
    assert re.search(r'version: "(.*)"', recipe)[1] == VERSION  # type: ignore[index]
