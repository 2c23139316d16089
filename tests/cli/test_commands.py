"""The commands beside `simulate`: what they write is what the calls return, and they say how they ended."""

import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer
import xarray as xr

import restitution as rs
from reference.command import SMALL, invoke, load
from restitution.cli import BAD_INPUT, FAILED, WARNED, app
from restitution.cli._template import TEMPLATE
from restitution.drop.toml import read, read_all

BODY = rs.Dumbbell(radius=2e-3, separation=3e-3, density=7800)
LAW = rs.TangentialRestitution(normal=0.9, tangential=0.95)
RUN: dict[str, Any] = {
    "particles": 40,
    "impacts": 11,
    "release_height": 0.05,
    "gravity": 1.62,
    "orientation": "isotropic",
    "minimum_speed": 0.1,
    "seed": 3,
}
BINS = """
[statistics]
velocity_bins = 4
velocity_range = [0.0, 0.4]
restitution_bins = [0.0, 0.5, 1.0, 1.5]
"""
EDGES: dict[str, Any] = {"velocity_bins": np.linspace(0.0, 0.4, 5), "restitution_bins": [0.0, 0.5, 1.0, 1.5]}


@pytest.fixture
def study(tmp_path: Path) -> Path:
    path = tmp_path / "study.toml"
    text = SMALL.replace("particles = 7", "particles = 40").replace("18446744073709551615", "3")
    path.write_text(text + BINS, encoding="utf-8")
    return path


def test_statistics_are_those_of_the_call(study: Path) -> None:
    """Bins from the file or from options; a number of them with a range is what numpy.histogram takes."""
    out = study.with_name("counts.nc")
    result = invoke("statistics", study, "-o", out)
    assert (result.exit_code, result.stderr) == (0, "")
    with pytest.warns(rs.EnergyWarning):
        expected = rs.statistics(BODY, LAW, **RUN, **EDGES)
    xr.testing.assert_identical(load(out), expected)
    assert f"The rows hold {int(expected.number.sum())} impacts" in result.stdout
    again = invoke("statistics", study, "-o", out)
    assert (again.exit_code, again.stderr) == (
        FAILED,
        f"error: {out}: exists already; --overwrite replaces it\n",
    )
    options = ("--velocity-bins", 2, "--overwrite", "--quiet")
    result = invoke("statistics", study, "-o", out, *options)
    assert (result.exit_code, result.stdout) == (0, "")
    assert load(out).velocity.to_numpy() == pytest.approx([0.1, 0.3])


@pytest.mark.parametrize("command", ["statistics", "compare"])
def test_missing_bins_are_an_error_of_one_line(study: Path, command: str) -> None:
    """A file made for `simulate` has no bins: the error says where they belong."""
    bare = study.with_name("bare.toml")
    bare.write_text(study.read_text(encoding="utf-8").replace(BINS, ""), encoding="utf-8")
    out = study.with_name("counts.nc")
    result = invoke(command, bare, "-o", out, "--velocity-bins", 4)
    assert result.exit_code == BAD_INPUT
    assert result.stderr == (
        f"error: {bare}: restitution_bins: missing; must be in a table [statistics], "
        "as restitution template prints it, or given as --restitution-bins with a range\n"
    )
    assert not out.exists()


def test_states_are_recorded_for_who_asks(study: Path) -> None:
    """Record what `rs.trajectory` needs; another word is refused with the two that are known."""
    out = study.with_name("state.nc")
    assert invoke("simulate", study, "--out", out, "--record", "state").exit_code == 0
    data = load(out)
    last = float(data.time[0].max())
    np.testing.assert_allclose(
        rs.trajectory(data, 0, last).position[0], data.position[0, int(data.impacts[0]) - 1], rtol=1e-9
    )
    refused = invoke("simulate", study, "--out", study.with_name("other.nc"), "--record", "all")
    assert refused.exit_code == BAD_INPUT
    assert "record = 'all': must be 'impacts' or 'state'" in refused.stderr


def test_random_heights_and_uneven_bins_of_a_file(study: Path) -> None:
    """In every command that drops particles and counts."""
    text = study.read_text(encoding="utf-8")
    text = re.sub(r"release_height = .*", "release_height = {lowest = 0.04, highest = 0.06}", text)
    text = text.replace("velocity_bins = 4", "velocity_bins = [0.0, 0.1, 0.15, 0.4]")
    study.write_text(text.replace("velocity_range = [0.0, 0.4]\n", ""), encoding="utf-8")
    out = study.with_name("counts.nc")
    assert invoke("statistics", study, "--out", out).exit_code == 0
    edges = EDGES | {"velocity_bins": [0.0, 0.1, 0.15, 0.4]}
    run = RUN | {"release_height": rs.RandomHeight(lowest=0.04, highest=0.06)}
    expected = rs.statistics(BODY, LAW, **run, **edges)
    np.testing.assert_array_equal(load(out).restitution_count, expected.restitution_count)


def test_bodies_and_laws_of_a_file_are_compared(study: Path) -> None:
    text = study.read_text(encoding="utf-8")
    head, _, rest = text.partition("[run]")
    head = head.replace("[body]", "[[body]]\nname = 'dense'").replace("[law]", "[[law]]")
    more = "[[body]]\nshape = 'spheroid'\nequatorial = 2e-3\npolar = 3e-3\n"
    more += "[[law]]\ntype = 'frictionless'\nnormal = 0.9\n"
    study.write_text(head + more + "[run]" + rest, encoding="utf-8")
    out = study.with_name("compared.nc")
    result = invoke("compare", study, "-o", out)
    assert (result.exit_code, result.stderr) == (0, "")
    found = load(out)
    assert found.body.values.tolist() == ["dense", "body 2"]
    assert found.law.values.tolist() == ["law 1", "law 2"]
    with pytest.warns(rs.EnergyWarning):
        alone = rs.statistics(BODY, LAW, **RUN, **EDGES)
    here = found.sel(body="dense", law="law 1")
    np.testing.assert_array_equal(here.restitution_count, alone.restitution_count)
    assert len(result.stdout.splitlines()) == 1 + 4
    result = invoke("statistics", study, "-o", study.with_name("one.nc"))
    assert result.exit_code == BAD_INPUT
    assert "body: 2 tables; must be one, [body]" in result.stderr


def test_statistics_write_a_table(study: Path) -> None:
    """A row for each velocity bin, with its edges and the moments of the file, as CSV and as Parquet."""
    pandas = pytest.importorskip("pandas")
    for name, read_back in (("table.csv", pandas.read_csv), ("table.parquet", pandas.read_parquet)):
        if name.endswith("parquet"):
            pytest.importorskip("pyarrow")
        out, table = study.with_name(f"{name}.nc"), study.with_name(name)
        assert invoke("statistics", study, "-o", out, "--table", table).exit_code == 0
        rows, found = read_back(table), load(out)
        assert rows["velocity_from"].to_numpy() == pytest.approx([0.0, 0.1, 0.2, 0.3])
        assert rows["velocity_to"].to_numpy() == pytest.approx([0.1, 0.2, 0.3, 0.4])
        for column in ("number", "mean_restitution", "mean_restitution_error", "kurtosis", "energy_created"):
            # Before its version 3 pandas reads the last digit of a number as it pleases.
            np.testing.assert_allclose(rows[column], found[column], rtol=3e-15)
    for name in ("table", "table.xlsx"):
        refused = invoke(
            "statistics", study, "-o", study.with_name("more.nc"), "--table", study.with_name(name)
        )
        assert refused.exit_code == BAD_INPUT
        assert "error: table = " in refused.stderr
    assert not study.with_name("more.nc").exists()


def test_a_fit_prints_what_the_functions_return(tmp_path: Path) -> None:
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    data = rs.simulate(body, law, particles=200, impacts=100)
    data.to_netcdf(tmp_path / "run.nc")
    words = ("fit", tmp_path / "run.nc", "--velocity", 0.5, 0.6, "--resamples", 20, "--family")
    result = invoke(*words, "laplace")
    assert result.exit_code == 0
    found = rs.fit.bootstrap(rs.fit.laplace, data, velocity=(0.5, 0.6), resamples=20)
    for name, value in found.fit.parameters.items():
        assert f"{name} = {value:.6g} +- {found.standard_errors[name]:.2g}" in result.stdout
    assert re.search(r"The Kolmogorov-Smirnov distance is 0\.\d+, p = 0\.\d+\.", result.stdout)
    assert invoke(*words, "cauchy").stderr.startswith("error: family = 'cauchy': must be")
    table = tmp_path / "fit.tex"
    for family in ("asymmetric_laplace", "asymmetric_power", "cusp_mixture"):
        given = (family.replace("_", "-"), "--location", 0.98, "--table", table, "--overwrite")
        result = invoke(*words, *given)
        assert "location = 0.98 (given)" in result.stdout
        function = getattr(rs.fit, family)
        found = rs.fit.bootstrap(function, data, velocity=(0.5, 0.6), resamples=20, location=0.98)
        assert table.read_text(encoding="ascii") == found.to_latex()
    assert invoke(*words, "laplace", "--location", 0.9).stderr.startswith(
        "error: location = 0.9: must be for"
    )
    assert invoke(*words, "cusp-mixture").stderr.startswith("error: location: missing")
    assert invoke(*words, "laplace", "--table", tmp_path / "fit.csv").stderr.startswith("error: table = ")
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(0.0, 1.0, 11),
        "restitution_bins": np.linspace(0, 2, 201),
    }
    rs.reduce(data, **bins).to_netcdf(tmp_path / "counts.nc")
    result = invoke("fit", tmp_path / "counts.nc", "--velocity", 0.5, 0.6)
    assert "Standard errors are not known, because counts do not say which particle" in result.stdout


def test_the_template_is_a_run_and_all_of_its_choices_are() -> None:
    """As it stands, and with every line that is commented out put in its place."""
    assert invoke("template").stdout == TEMPLATE
    assert tomllib.loads(TEMPLATE)["law"] == {"type": "tangential-restitution", "normal": 0.98}
    known = "\n".join(re.sub(r"^# (?=[a-z_]+ = )", "", line) for line in TEMPLATE.splitlines())
    blocks = re.split(r"\n(?=#? ?\[)", known)
    for block in blocks[1:]:
        tomllib.loads("\n".join(re.sub(r"^# (?=\[)", "", line) for line in block.splitlines()))
    for field in (*rs.Coulomb.model_fields, *rs.Spheroid.model_fields, *rs.Viscoelastic.model_fields):
        assert field in TEMPLATE


def test_the_templates_numbers_are_the_defaults(tmp_path: Path) -> None:
    """Lines that are commented out in [run] and [statistics] hold without them, too."""
    lines = TEMPLATE.splitlines()
    start = lines.index("[run]")
    told = [re.sub(r"^# (?=[a-z_]+ = )", "", line) for line in lines[start:] if not line.startswith("# [")]
    stop = next(i for i, line in enumerate(told) if line.startswith("lowest"))
    rest = [line for line in told[stop:] if not line.startswith(("lowest", "highest", "rate", "axis"))]
    spelled, plain = tmp_path / "spelled.toml", tmp_path / "plain.toml"
    spelled.write_text("\n".join([*lines[:start], *told[:stop], *rest]), encoding="utf-8")
    plain.write_text(TEMPLATE, encoding="utf-8")
    run = read(plain)
    assert read(spelled) == run == type(run)(body=run.body, law=run.law)
    how: dict[str, Any] = {"particles": 20, "impacts": 20}
    one, two = (read_all(path, single=True).statistics for path in (spelled, plain))
    xr.testing.assert_identical(
        rs.statistics(run.body, run.law, **how, **one), rs.statistics(run.body, run.law, **how, **two)
    )


FEW_SPEEDS = """
[body]
shape = "dumbbell"
radius = 3e-3
separation = 6e-3

[law]
type = "tangential-restitution"
normal = 0.6

[run]
particles = 4000
impacts = 5
release_height = { lowest = 0.06, highest = 0.0601 }

[distribution]
velocities = [0.2, 0.6]
"""


def test_a_bad_distance_is_a_warning_and_a_status(tmp_path: Path) -> None:
    """Nearly one height and few impacts of a lossy body: p(ε | v) changes faster than the nodes can resolve.

    The file is written all the same, the warning names distance and speed, and the status is one of its own.
    The distance, 0.2, is four times what is warned of, and eight times its scatter.
    """
    run, out = tmp_path / "run.toml", tmp_path / "dist.nc"
    run.write_text(FEW_SPEEDS, encoding="utf-8")
    result = invoke("distribution", run, "-o", out)
    assert (result.exit_code, out.exists()) == (WARNED, True)
    assert re.match(
        r"warning: the learned distribution is up to 0\.[12]\d+ from fresh impacts .*, at 0\.", result.stderr
    )
    assert float(load(out).ks_distance.max()) > 0.1
    quiet = invoke("distribution", run, "-o", out, "--overwrite", "--quiet")
    assert (quiet.exit_code, quiet.stdout, quiet.stderr) == (WARNED, "", result.stderr)


@pytest.mark.parametrize("command", ["paper", "rough", "gas-figures", "laws"])
def test_folders_with_something_in_them_are_left_alone(command: str, tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("x", encoding="utf-8")
    result = invoke(command, "--out", tmp_path)
    assert (result.exit_code, result.stderr) == (
        FAILED,
        f"error: {tmp_path}: is not empty; --overwrite replaces it\n",
    )


def test_it_is_a_module_and_completes_itself() -> None:
    for words, expected in ((["--version"], "restitution 0."), (["--help"], "--install-completion")):
        done = subprocess.run(
            [sys.executable, "-m", "restitution", *words], capture_output=True, text=True, check=True
        )
        assert expected in done.stdout


def leaves(command: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield every command with the words that call it."""
    for name, one in getattr(command, "commands", {}).items():
        yield (*path, name), one
        yield from leaves(one, (*path, name))


def test_every_command_can_be_quiet_and_shows_flags_without_a_type() -> None:
    """All but the template, whose output is all that it does; a flag takes no value, and none is shown."""
    for words, command in leaves(typer.main.get_command(app)):
        shown = invoke(*words, "--help").stdout
        assert "bool" not in shown, words
        if words != ("template",) and not hasattr(command, "commands"):
            assert "--quiet" in shown, words
