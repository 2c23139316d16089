"""Exported samplers, compiled without a warning, give the bits of the package."""

import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

import restitution as rs
from restitution.distribution import FluctuatingRestitution

Floats = NDArray[np.float64]

WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O2", "-ffp-contract=off"]
COMPILERS = {
    "C99": ("cc", ["-std=c99"], "c"),
    "C17": ("cc", ["-std=c17", "-Wconversion"], "c"),
    "C++11": ("c++", ["-std=c++11"], "cpp"),
    "C++20": ("c++", ["-std=c++20", "-Wconversion"], "cpp"),
    "Fortran 2008": ("gfortran", ["-std=f2008"], "f90"),
}

C_MAIN = """
#include "{name}.h"
#include <stdio.h>

int main(void)
{{
    double v, z, u1, u2;
    while (scanf("%lf %lf %lf %lf", &v, &z, &u1, &u2) == 4) {{
        printf("%.17g\\n", {call});
    }}
    return 0;
}}
"""

FORTRAN_MAIN = """
program main
  use {name}
  implicit none
  double precision :: v, z, u1, u2
  integer :: status
  do
    read (*, *, iostat=status) v, z, u1, u2
    if (status /= 0) exit
    print '(es25.17e3)', {call}
  end do
end program main
"""


@pytest.fixture(scope="module")
def plain() -> FluctuatingRestitution:
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    how: dict[str, Any] = {"particles": 4000, "impacts": 60, "velocities": (0.1, 0.5), "seed": 1}
    return FluctuatingRestitution.learn(body, law, **how, given="rotational_fraction")


def compiled(dist: FluctuatingRestitution, language: str, call: str, folder: Path, name: str) -> Path:
    """Export, and compile a program that reads v, z, u1, u2 and prints the restitution of each line."""
    compiler, flags, suffix = COMPILERS[language]
    if shutil.which(compiler) is None:
        pytest.skip(f"there is no {compiler} on this machine")
    main, program = folder / f"main.{suffix}", folder / "program"
    if suffix == "f90":
        dist.to_fortran(folder / f"{name}.f90", name=name)
        main.write_text(FORTRAN_MAIN.format(name=name, call=call), encoding="ascii")
        sources = [f"{name}.f90", main.name]
    else:
        dist.to_c(folder / f"{name}.h", name=name)
        main.write_text(C_MAIN.format(name=name, call=call), encoding="ascii")
        sources = [main.name]
    command = [compiler, *flags, *WARNINGS, *sources, "-o", program.name, *(["-lm"] if suffix == "c" else [])]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return program


def ask(program: Path, table: Floats) -> Floats:
    """Send lines of v, z, u1, u2 and read the restitutions."""
    lines = "\n".join(" ".join(repr(float(x)) for x in row) for row in table)
    done = subprocess.run([program], input=lines, capture_output=True, text=True, check=True)
    return np.array([float(line) for line in done.stdout.split()])


def chosen(points: Floats, x: float, u: float) -> tuple[int, float]:
    """One of two neighbours, and what is left of u."""
    left = int(np.clip(np.searchsorted(points, x, side="right") - 1, 0, points.size - 2))
    weight = min(max((x - points[left]) / (points[left + 1] - points[left]), 0.0), 1.0)
    return (left + 1, u / weight) if u < weight else (left, (u - weight) / (1.0 - weight))


@pytest.mark.parametrize("language", COMPILERS)
def test_it_is_the_quantile_of_the_chosen_node(
    plain: FluctuatingRestitution, language: str, tmp_path: Path
) -> None:
    """u1 chooses a node beside v, u2 is the probability there: `ppf` of that node, bit by bit."""
    name = "restitution"
    program = compiled(plain, language, f"{name}_sample(v, u1, u2)", tmp_path, name)
    rng = np.random.default_rng(1)
    low, high = plain.velocities
    table = np.stack([rng.uniform(low, high, 4000), *rng.random((3, 4000))], axis=1)
    nodes = plain.data.velocity.to_numpy()
    table[:4, 0] = low, high, nodes[3], nodes[4]
    table[4:6, 3] = 0.0, np.nextafter(1.0, 0.0)
    expected = [plain.ppf(u2, nodes[chosen(nodes, v, u1)[0]]) for v, _, u1, u2 in table]
    np.testing.assert_array_equal(ask(program, table), expected)


@pytest.mark.parametrize("language", ["C99", "C++11", "Fortran 2008"])
def test_the_condition_is_exported_too(plain: FluctuatingRestitution, language: str, tmp_path: Path) -> None:
    """What u1 leaves over chooses the condition; speeds are clamped, the name has a word of the template."""
    name = "MY_NAME"
    dist = plain.clamped()
    program = compiled(dist, language, f"{name}_sample_given(v, z, u1, u2)", tmp_path, name)
    rng = np.random.default_rng(2)
    table = np.stack([rng.uniform(0.0, 0.6, 4000), rng.random(4000) ** 3, *rng.random((2, 4000))], axis=1)
    nodes, groups = dist.data.velocity.to_numpy(), dist.data.given_components.to_numpy()
    first = np.concatenate([[0], np.cumsum(groups)])
    conditions = dist.data.given.to_numpy()
    expected = []
    for v, z, u1, u2 in table:
        node, rest = chosen(nodes, v, u1)
        own = conditions[first[node] : first[node + 1]]
        expected.append(dist.ppf(u2, nodes[node], given=own[chosen(own, z, rest)[0]]))
    np.testing.assert_array_equal(ask(program, table), expected)


@pytest.mark.parametrize("language", ["C99", "Fortran 2008"])
def test_draws_follow_the_distribution(plain: FluctuatingRestitution, language: str, tmp_path: Path) -> None:
    """20 000 uniform pairs at one speed: Kolmogorov–Smirnov against `cdf`, false alarm 1e-4, seed fixed."""
    program = compiled(plain, language, "restitution_sample(v, u1, u2)", tmp_path, "restitution")
    table = np.random.default_rng(3).random((20_000, 4))
    table[:, 0] = 0.2345
    draws = ask(program, table)
    assert stats.kstest(draws, lambda x: plain.cdf(x, 0.2345)).pvalue > 1e-4
    assert np.mean(draws) == pytest.approx(plain.mean(0.2345), abs=4 * plain.std(0.2345) / np.sqrt(20_000))


@pytest.fixture(scope="module")
def of_a_box() -> FluctuatingRestitution:
    how: dict[str, Any] = {"particles": 3000, "impacts": 20, "velocities": (0.2, 0.5), "seed": 2}
    box = rs.Box(a=3e-3, b=4e-3, c=5e-3)
    return FluctuatingRestitution.learn(box, rs.Coulomb(normal=0.8, friction=0.2), **how)


@pytest.mark.parametrize("language", ["C99", "Fortran 2008"])
def test_a_body_without_an_axis_is_exported_too(
    of_a_box: FluctuatingRestitution, language: str, tmp_path: Path
) -> None:
    """A box, which has its parameters in the source, and the same bits as any other."""
    dist = of_a_box
    program = compiled(dist, language, "box_sample(v, u1, u2)", tmp_path, "box")
    table = np.random.default_rng(5).random((500, 4))
    table[:, 0] = np.random.default_rng(6).uniform(*dist.velocities, 500)
    nodes = dist.data.velocity.to_numpy()
    expected = [dist.ppf(u2, nodes[chosen(nodes, v, u1)[0]]) for v, _, u1, u2 in table]
    np.testing.assert_array_equal(ask(program, table), expected)
    file = "box.f90" if language == "Fortran 2008" else "box.h"  # beside which a compiler of Fortran writes
    source = (tmp_path / file).read_text(encoding="utf-8")
    assert "Box" in source


@pytest.mark.parametrize("language", ["C99", "C++11", "Fortran 2008"])
def test_speeds_beyond_are_not_a_number_unless_clamped(
    plain: FluctuatingRestitution, language: str, tmp_path: Path
) -> None:
    table = np.array([[0.05, 0.0, 0.5, 0.5], [0.7, 0.0, 0.5, 0.5]])
    (tmp_path / "raise").mkdir()
    (tmp_path / "clamp").mkdir()
    call = "restitution_sample(v, u1, u2)"
    program = compiled(plain, language, call, tmp_path / "raise", "restitution")
    assert np.isnan(ask(program, table)).all()
    program = compiled(plain.clamped(), language, call, tmp_path / "clamp", "restitution")
    np.testing.assert_array_equal(ask(program, table), plain.ppf(0.5, list(plain.velocities)))


@pytest.mark.parametrize("language", ["C99", "C++11", "Fortran 2008"])
def test_unseen_conditions_are_not_a_number_unless_clamped(
    plain: FluctuatingRestitution, language: str, tmp_path: Path
) -> None:
    """The rule of `rvs`: what it refuses gives NaN, and what it takes does not."""
    nodes = plain.data.velocity.to_numpy()
    v = 0.5 * (nodes[7] + nodes[8])
    highest = float(plain.data.given_highest[7:9].max())
    table = np.array([[v, z, 0.5, 0.5] for z in (highest, np.nextafter(highest, 1.0), 1.0)])
    call = "restitution_sample_given(v, z, u1, u2)"
    for name, dist, seen in (("raise", plain, [1, 0, 0]), ("clamp", plain.clamped(), [1, 1, 1])):
        (tmp_path / name).mkdir()
        program = compiled(dist, language, call, tmp_path / name, "restitution")
        np.testing.assert_array_equal(np.isfinite(ask(program, table)), seen)
    plain.rvs(v, given=highest)
    with pytest.raises(ValueError, match="what was seen of rotational_fraction"):
        plain.rvs(v, given=np.nextafter(highest, 1.0))


def test_the_source_says_what_it_is(plain: FluctuatingRestitution, tmp_path: Path) -> None:
    """Parameters, range, units and accuracy are in the comment; files are whole and not replaced unasked."""
    for write, name in ((plain.to_c, "dist.h"), (plain.to_fortran, "dist.f90")):
        write(tmp_path / name)
        text = (tmp_path / name).read_text(encoding="ascii")
        for said in (
            "body = Dumbbell",
            "separation = 0.003",
            "seed = 1",
            "m/s, from 0.1 to 0.5",
            "Kolmogorov",
        ):
            assert said in text
        with pytest.raises(FileExistsError):
            write(tmp_path / name)
        write(tmp_path / name, replace=True)
    assert len(list(tmp_path.iterdir())) == 2
    plain.to_fortran(tmp_path / "long.f90", name="n" * 24)
    for name in ("dist.f90", "long.f90"):
        lines = (tmp_path / name).read_text(encoding="ascii").splitlines()
        assert max(map(len, lines)) <= 132  # the standard's limit
    with pytest.raises(ValueError, match="name = '2x': must be a letter and then"):
        plain.to_c(tmp_path / "x.h", name="2x")
    with pytest.raises(FileNotFoundError):
        plain.to_c(tmp_path / "nowhere" / "x.h")
