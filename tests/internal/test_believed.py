"""What is read is checked first: damaged files, words in generated code, numbers that are rounding."""

import json
import math
import re
import shutil
import subprocess
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution.distribution import FluctuatingRestitution
from restitution.distribution._store import FORMAT

BINS = (np.linspace(0.7, 1.0, 4), np.linspace(-2.0, 3.0, 99))


@pytest.fixture(scope="module")
def learned() -> FluctuatingRestitution:
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    return FluctuatingRestitution.from_statistics(
        rs.reduce(rs.simulate(body, law, particles=2000, impacts=20), *BINS)
    )


def test_a_bit_that_flipped_in_a_file_is_found(learned: FluctuatingRestitution, tmp_path: Path) -> None:
    """Whatever loads has every number and attribute that was saved; else there is an error."""
    path = tmp_path / "dist.nc"
    learned.save(path)
    assert FluctuatingRestitution.load(path) == learned
    whole = path.read_bytes()
    random = np.random.default_rng(1)
    silent = 0
    for bit in random.choice(8 * len(whole), 150, replace=False):
        harmed = bytearray(whole)
        harmed[bit // 8] ^= 1 << (bit % 8)
        path.write_bytes(harmed)
        try:
            found = FluctuatingRestitution.load(path)
        except (OSError, ValueError, RuntimeError):
            continue
        assert found == learned  # a bit in a gap of the file
        silent += 1
    assert silent < 150


def test_the_format_of_a_learned_file(learned: FluctuatingRestitution, tmp_path: Path) -> None:
    """Another version, no version, numbers changed by hand: refused, with the name of the file."""
    path = tmp_path / "dist.nc"
    learned.save(path)
    data = xr.load_dataset(path, engine="netcdf4")
    assert data.attrs["format_version"] == FORMAT
    for harmed, message in (
        (data.assign_attrs(format_version=99), "is of format version 99: must be 1"),
        (data.drop_attrs(), "lacks format version or checksum"),
        (data.assign(velocity=data.velocity * (1 + 1e-15)), "is damaged"),
        (data.assign_attrs(law="Coulomb"), "is damaged"),
    ):
        harmed.to_netcdf(path, engine="netcdf4")
        with pytest.raises(ValueError, match=rf"dist\.nc: {message}"):
            FluctuatingRestitution.load(path)
    for name in ("velocity", "restitution_edge", "probability_below"):
        for bad in (math.nan, math.inf):
            values = learned.data[name].to_numpy().copy()
            values[1] = bad
            harmed = learned.data.assign({name: (learned.data[name].dims, values)})
            with pytest.raises(ValueError, match=rf"data\.{name}\[1\] = {bad}: must be finite"):
                FluctuatingRestitution(harmed)


HOSTILE = [
    "*/ int main(void) { return 1; } /*",
    "**//",
    "a\nend module\nprogram x",
    "a\r\u2028\x0b\x85 b",
    "\x00\x1b[31m",
    "??/\n",
    "/*",
    "//\\",
    "ε" * 500,
]


@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_words_of_others_in_generated_code(
    learned: FluctuatingRestitution, tmp_path: Path, text: str
) -> None:
    """An attribute, its name or the source stay inside the comment, which compilers agree about."""
    for attrs in ({"note": text}, {text or "x": "value"}, {"source": text}):
        dist = FluctuatingRestitution(learned.data.assign_attrs(attrs))
        dist.to_c(tmp_path / "dist.h", replace=True)
        dist.to_fortran(tmp_path / "dist.f90", replace=True)
        header = (tmp_path / "dist.h").read_text(encoding="ascii")
        comment, _, code = header.partition("\n */\n")
        assert comment.count("*/") == 0
        assert comment.count("/*") == 1
        assert "int main" not in code
        fortran = (tmp_path / "dist.f90").read_text(encoding="ascii").splitlines()
        start = next(i for i, line in enumerate(fortran) if line.startswith("module "))
        assert all(line.startswith("!") or not line for line in fortran[:start])
        assert all(letter.isprintable() or letter == "\n" for letter in comment)
    if shutil.which("cc"):
        (tmp_path / "main.c").write_text(
            '#include "dist.h"\nint main(void) { return 0; }\n', encoding="ascii"
        )
        words = ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-c"]
        subprocess.run([*words, "main.c", "-o", "main.o"], cwd=tmp_path, check=True)


def test_attributes_are_plain(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """They can be written as JSON, of every result, and the largest seed comes through."""
    data = rs.simulate(body, law, particles=30, impacts=30, seed=2**64 - 1, spin=rs.RandomSpin(rate=1.0))
    for found in (data, rs.reduce(data, *BINS)):
        assert json.loads(json.dumps(found.attrs))["seed"] == 2**64 - 1


def test_a_run_is_replayed_by_what_its_dataset_carries(
    body: rs.Dumbbell, law: rs.TangentialRestitution
) -> None:
    """To the bit: by law and seed in the attributes, or by the angles and spins as they were given."""
    random = np.random.default_rng(1)
    angles, spins = random.normal(0.0, 5.0, (20, 2)), random.normal(0.0, 30.0, (20, 3))
    for orientation in (angles[:, 0], angles):
        data = rs.simulate(body, law, particles=20, impacts=30, orientation=orientation, spin=spins)
        again = rs.simulate(
            body, law, particles=20, impacts=30, orientation=data.orientation, spin=data.release_spin
        )
        for name in data.data_vars:
            np.testing.assert_array_equal(data[name], again[name])
    for name in ("uniform-angle", "isotropic"):
        data = rs.simulate(body, law, particles=20, impacts=30, orientation=name, seed=7)
        words = {key: data.attrs[key] for key in ("particles", "impacts", "orientation", "seed")}
        assert data.identical(rs.simulate(body, law, **words))


def test_the_variance_of_equal_values_is_zero(law: rs.TangentialRestitution) -> None:
    """A sphere's ε are one number but for rounding: no skewness can be told, by `reduce` or `statistics`."""
    body = rs.Dumbbell(radius=3e-3, separation=0.0)
    bins = (np.linspace(0.0, 1.2, 7), np.linspace(0.0, 2.0, 5))
    reduced = rs.reduce(rs.simulate(body, law, particles=50, impacts=50), *bins)
    counted = rs.statistics(
        body, law, particles=50, impacts=50, velocity_bins=bins[0], restitution_bins=bins[1]
    )
    for found in (reduced, counted):
        some = found["number"] > 1
        assert some.any()
        assert (found["variance"].where(some, 0.0) == 0.0).all()
        assert found["skewness"].isnull().all()
        assert found["kurtosis"].isnull().all()


@pytest.mark.parametrize("height", [1e17, 1e100, 1e9])
def test_heights_beyond_the_digits_of_a_double(law: rs.TangentialRestitution, height: float) -> None:
    """They are refused as input: nothing is wrong with the program."""
    body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    with pytest.raises(ValueError, match=r"^release_height = .*: must be at most 3e\+07 m, 1e\+10 times the"):
        rs.simulate(body, law, release_height=height)
    with pytest.raises(ValueError, match=r"^release_velocity\[2\] = -.*: must be at most .* m/s in mag"):
        rs.simulate(body, law, release_velocity=[0.0, 0.0, -height])
    with pytest.raises(
        ValueError, match=r"^spin\[1\] = .*: must be at most .* rad/s in magnitude, 100000 times"
    ):
        rs.simulate(body, law, spin=[0.0, height, 0.0])
    with pytest.raises(ValueError, match=r"^spin\[1, 2\] = -.*: must be at most"):
        rs.simulate(body, law, particles=2, spin=[[0.0, 1.0, 0.0], [1.0, 2.0, -height]])
    with pytest.raises(ValueError, match=r"^spin = .*: must be at most"):
        rs.simulate(body, law, spin=rs.RandomSpin(rate=height))
    with pytest.raises(ValueError, match=r"^incline = .*: must be at most pi/2"):
        rs.simulate(body, law, incline=math.pi / 2 - 1e-12)


LAWS = (
    rs.TangentialRestitution(normal=1.0),
    rs.TangentialRestitution(normal=0.9, tangential=0.5),
    rs.Coulomb(normal=0.95, friction=0.3),
)


def test_the_check_of_records_holds_for_any_run(body: rs.Dumbbell) -> None:
    """The page's own: it knows how many digits late times and great heights have, and still finds harm."""
    page = (Path(__file__).parents[2] / "docs/records.md").read_text(encoding="utf-8")
    names: dict[str, Any] = {}
    exec(re.findall(r"^```python\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)[0], names)
    misfit = names["largest_misfit"]
    data = names["data"]
    assert misfit(data, names["body"]) < 1
    for name in ("time", "impact_velocity", "rebound_velocity"):
        factor = xr.ones_like(data[name])
        factor[3, 5] += 1e-12
        assert misfit(data.assign({name: data[name] * factor}), names["body"]) > 1
    long = rs.simulate(body, LAWS[0], particles=1, impacts=10**6)
    assert long.time.max() > 1e5
    assert misfit(long, body) < 1
    for law, separation, height, gravity in product(
        LAWS, (3e-5, 3e-3, 0.3), (3.0, 1e3, 1e6), (1e-8, 9.81, 1e3)
    ):
        slim = rs.Dumbbell(radius=3e-3, separation=separation)
        data = rs.simulate(slim, law, particles=30, impacts=200, release_height=height, gravity=gravity)
        if data.impacts.max() > 1:
            assert misfit(data, slim, gravity) < 1, (law, separation, height, gravity)
