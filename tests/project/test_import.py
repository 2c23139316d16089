"""The package as a user meets it: its names, what an import costs, and examples that run as printed."""

import ast
import contextlib
import doctest
import importlib
import inspect
import io
import pkgutil
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import restitution as rs
from reference.command import invoke
from restitution import _core
from restitution.drop.toml import read
from restitution.study import study_of

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
MODULES = ["restitution", *(m.name for m in pkgutil.walk_packages(rs.__path__, "restitution."))]


def test_public_names() -> None:
    """Every public name is there, says what it is, and is listed; others are not found."""
    assert sorted(rs.__all__) == rs.__all__
    assert {*rs.__all__, "__version__"} == set(dir(rs))
    for name in rs.__all__:
        assert inspect.getdoc(getattr(rs, name))
    with pytest.raises(AttributeError, match="has no attribute 'simulat'; did you mean simulate"):
        _ = rs.simulat


def test_errors_are_of_the_expected_kinds() -> None:
    """What `except ValueError`, `except RuntimeError` and `except KeyboardInterrupt` catch."""
    assert issubclass(rs.NumericalError, RuntimeError)
    assert issubclass(rs.SimulationInterrupted, KeyboardInterrupt)
    with pytest.raises(ValueError, match="radius"):
        rs.Dumbbell(radius=0, separation=0)


@pytest.mark.parametrize("statement", ["import restitution", "import restitution.cli", "help"])
def test_heavy_packages_are_imported_when_needed(statement: str) -> None:
    """An import, and help on the command line, must not wait for what they do not use."""
    show_help = "import sys; sys.argv = ['restitution', 'simulate', '--help']\n"
    show_help += "from restitution.cli import main\ntry: main()\nexcept SystemExit: pass"
    program = (
        show_help if statement == "help" else statement
    ) + "\nimport sys\nprint(*sys.modules, file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = done.stderr.split()
    assert "restitution" in loaded
    heavy = {"scipy", "xarray", "pandas", "matplotlib", "netCDF4", "tqdm", "numba", "sympy"}
    assert heavy.isdisjoint(loaded)


def test_the_version_is_the_same_everywhere() -> None:
    cargo = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    assert rs.__version__ == cargo["workspace"]["package"]["version"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {rs.__version__}\n" in citation
    assert f"## [{rs.__version__}]" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def test_the_stub_describes_the_core() -> None:
    """Names, parameters and their kinds: what `mypy.stubtest` compares, in a hundredth of its time."""
    stub = ast.parse((ROOT / "python/restitution/_core.pyi").read_text(encoding="utf-8"))
    functions = {node.name: node.args for node in stub.body if isinstance(node, ast.FunctionDef)}
    classes = {node.name: node.bases for node in stub.body if isinstance(node, ast.ClassDef)}
    values = [ast.unparse(node.target) for node in stub.body if isinstance(node, ast.AnnAssign)]
    constants = {name for name in values if not name.startswith("_")}  # the others are names of types
    public = {name for name in vars(_core) if not name.startswith("_")}
    assert public == {*functions, *classes, *constants}
    for name, arguments in functions.items():
        parameters = inspect.signature(getattr(_core, name)).parameters.values()
        keywords = [p.name for p in parameters if p.kind is p.KEYWORD_ONLY]
        assert keywords == [argument.arg for argument in arguments.kwonlyargs]
        others = [p.name for p in parameters if p.kind is not p.KEYWORD_ONLY]
        assert others == [argument.arg for argument in arguments.args]
    for name, bases in classes.items():
        expected = [ast.unparse(base) for base in bases] or ["object"]
        assert [base.__name__ for base in getattr(_core, name).__bases__] == expected


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings(name: str) -> None:
    """They are run, and give what they say they give."""
    result = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert result.failed == 0


@pytest.fixture(autouse=True)
def coarse_posteriors(monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    """Few shapes and scatters in posteriors, but where a page tells their numbers."""
    if "inference.md" not in request.node.name:
        for name in ("_SHAPES", "_SCATTERS"):
            monkeypatch.setattr(f"restitution.experiment.inference._posterior.{name}", 2)


def public_names(module: ModuleType, prefix: str = "") -> Iterator[tuple[str, Any, ModuleType]]:
    """Every public name of the package with what it stands for, and the module that it is a name of."""
    for name in module.__all__:
        value = getattr(module, name)
        if inspect.ismodule(value):
            yield from public_names(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value, module


def test_every_public_name_has_an_example() -> None:
    """In its docstring or that of a method; a constant, which has none, in that of its module."""
    lacking = []
    for name, value, module in public_names(rs):
        constant = not callable(value)
        finder = doctest.DocTestFinder(recurse=not constant, exclude_empty=True)
        tests = finder.find(module if constant else value, name, module=False, globs={})
        examples = [example.source for test in tests for example in test.examples]
        wanted = name.split(".")[-1] if constant else ""
        if not any(wanted in source for source in examples):
            lacking.append(name)
        if value in (rs.NumericalError, rs.build_info):  # in the compiled module `testmod` finds neither
            for test in tests:
                assert doctest.DocTestRunner().run(test).failed == 0, name
    assert not lacking


def blocks(page: Path, language: str) -> list[str]:
    """The code blocks of a page that are in a language; those of Python may be cells of a notebook."""
    kinds = r"(?:python|\{code-cell\})" if language == "python" else language
    block = rf"^```{kinds}\n(?::\w+: .*\n)*(.*?)^```$"  # a cell may begin with options
    return re.findall(block, page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


def promised(code: str) -> Iterator[str]:
    """What the comments behind the print statements of a block say is printed."""
    for line in code.splitlines():
        if found := re.match(r"\s*print\(.*\)  # (.*)", line):
            yield found[1]


SLOW = {"inference.md"}


@pytest.mark.parametrize(
    "page", [pytest.param(p, id=p.name, marks=[pytest.mark.slow] * (p.name in SLOW)) for p in PAGES]
)
def test_code_in_the_pages(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The blocks of a page run from top to bottom as one program, and print what their comments say."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    names: dict[str, Any] = {"__name__": "__main__"}
    for number, code in enumerate(blocks(page, "python"), start=1):
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            exec(compile(code, f"{page.name}, block {number}", "exec"), names)
        expected = list(promised(code))
        assert [line for line in output.getvalue().splitlines() if line in expected] == expected
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_runs_in_the_pages(page: Path, tmp_path: Path) -> None:
    """Every TOML block is a valid file of parameters, of a study, or of pairs, which are followed."""
    for number, text in enumerate(blocks(page, "toml")):
        path = tmp_path / f"{number}.toml"
        path.write_text(text, encoding="utf-8")
        if "[pair]" in text:
            assert invoke("pair", path, "--out", tmp_path / "pairs.nc").exit_code == 0
            continue
        run = study_of(path).base if "[sweep]" in text else read(path)
        assert run.particles > 0


def test_the_numbers_of_the_first_page() -> None:
    """README says in its text what its code prints, and of its film what the run gives."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    (printed,) = re.findall(r"^print\(.*\)  # (.*)", text, re.MULTILINE)
    deviation, above = printed.split()
    assert f"standard deviation of {deviation} at 0.2 m/s" in text
    assert f"exceeds 1 in {100 * float(above):.0f} % of these impacts" in text
    body, law = (
        rs.Dumbbell(radius=3e-3, separation=3e-4),
        rs.TangentialRestitution(normal=0.98, tangential=1.0),
    )
    for seed in (2, 3):
        data = rs.simulate(body, law, particles=1000, impacts=400, seed=seed)
        near = data.restitution.where(abs(data.impact_velocity - 0.2) < 0.01)
        assert 0.0615 <= float(near.std()) < 0.0675
    sys.path.insert(0, str(ROOT / "examples"))
    pictures = importlib.import_module("pictures")
    data = pictures.drops()
    assert data.attrs["energy_created_impacts"] == 0
    particle, impact = pictures.GAIN
    assert f"{float(data.restitution[particle, impact]):.2f} times as fast as it came" in text
    particle, (first, _) = pictures.NEGATIVE
    assert float(data.restitution[particle, first]) < 0


def test_links_in_the_pages() -> None:
    """Links to files of the project lead to files; hosts are named only for DOIs."""
    for page in (*PAGES, *ROOT.glob("*.md")):
        for target in re.findall(r"\]\(([^)#]+)", page.read_text(encoding="utf-8")):
            if target.startswith("http"):
                assert target.startswith("https://doi.org/"), (page.name, target)
            else:
                assert (page.parent / target).exists(), (page.name, target)


def test_the_map_of_the_source_is_complete() -> None:
    """ARCHITECTURE.md names every file of the core and of the package, and none that is not there."""
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    for folder in ("crates/core/src", "python/restitution"):
        section = text.split(f"### `{folder}`")[1].split("\n###")[0]
        rows = [line.split("|")[1] for line in section.splitlines() if line.startswith("| `")]
        named = {name.rstrip("/") for row in rows for name in re.findall("`(.*?)`", row)}
        ignored = {"__pycache__", "py.typed"}
        there = {path.name for path in (ROOT / folder).iterdir() if path.suffix != ".so"}
        assert named == there - ignored


def test_every_figure_is_in_the_gallery() -> None:
    gallery = (ROOT / "docs/gallery.md").read_text(encoding="utf-8")
    drawn = {f"images/{path.name}" for path in (ROOT / "docs/images").iterdir() if "-dark" not in path.name}
    assert drawn == set(re.findall(r"\]\((images/[^)]*)\)", gallery))
