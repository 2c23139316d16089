"""What is said of the package in several places is the same."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
VERSION = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]


def test_the_page_has_the_version() -> None:
    assert f'"version": "{VERSION}"' in (ROOT / "web/package.json").read_text()


def test_the_conda_recipe_asks_for_the_same() -> None:
    """Conda's matplotlib without its windows has a name of its own."""
    recipe = (ROOT / "packaging/conda/recipe.yaml").read_text()
    run = recipe.partition("  run:\n")[2].partition("\n\n")[0]
    asked = [line.removeprefix("    - ").replace(" ", "") for line in run.splitlines()]
    assert asked[0] == "python" + PROJECT["requires-python"]
    wanted = [one.lower().replace("matplotlib", "matplotlib-base") for one in PROJECT["dependencies"]]
    assert asked[1:] == wanted
    assert re.search(r'version: "(.*)"', recipe)[1] == VERSION  # type: ignore[index]
