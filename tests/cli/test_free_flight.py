"""`restitution pair` and `restitution gas` give what the functions give, and name what a file has wrong."""

from pathlib import Path

import pytest
import xarray as xr

import restitution as rs
from reference.command import invoke
from reference.commands import GAS, GRAINS, PAIR

BODY, LAW = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.Frictionless(normal=0.9)


def test_pairs(tmp_path: Path) -> None:
    (tmp_path / "pair.toml").write_text(PAIR, encoding="utf-8")
    result = invoke("pair", tmp_path / "pair.toml", "--out", tmp_path / "pairs.nc")
    assert result.exit_code == 0, result.output
    expected = rs.pair.encounters(
        BODY, BODY, LAW, translational_temperature=1e-9, rotational_temperature=1e-9, encounters=2000
    )
    with xr.open_dataset(tmp_path / "pairs.nc") as found:
        xr.testing.assert_equal(found, expected)
    met = int((expected.contacts > 0).sum())
    assert f"{met} of 2000 encounters have {int(expected.contacts.sum())} contacts." in result.output


def test_a_body_and_a_plane(tmp_path: Path) -> None:
    text = GRAINS + '[other]\nshape = "plane"\n[pair]\nspeed = 1.0\nspin = [0.0, 0.0, 0.0]\nencounters = 10\n'
    (tmp_path / "pair.toml").write_text(text, encoding="utf-8")
    assert invoke("pair", tmp_path / "pair.toml", "--out", tmp_path / "pairs.nc", "--quiet").output == ""
    with xr.open_dataset(tmp_path / "pairs.nc") as found:
        assert bool((found.contacts > 0).all())


def test_the_file_of_another_body_lies_beside_the_run(tmp_path: Path) -> None:
    (tmp_path / "stone.csv").write_text("x,y,z,r\n0,0,0,3e-3\n1e-3,0,0,3e-3\n", encoding="ascii")
    text = PAIR + '\nother = { shape = "clump", file = "stone.csv" }'
    (tmp_path / "pair.toml").write_text(text, encoding="utf-8")
    result = invoke("pair", tmp_path / "pair.toml", "--out", tmp_path / "pairs.nc")
    assert result.exit_code == 0, result.output


def test_a_gas(tmp_path: Path) -> None:
    (tmp_path / "gas.toml").write_text(GAS, encoding="utf-8")
    result = invoke("gas", tmp_path / "gas.toml", "--out", tmp_path / "gas.nc", "--record", "state")
    assert result.exit_code == 0, result.output
    expected = rs.gas.cool(
        BODY, LAW, translational_temperature=1e-9, particles=400, collisions=5, record="state"
    )
    with xr.open_dataset(tmp_path / "gas.nc") as found:
        xr.testing.assert_equal(found, expected)
    warm = expected["translational_temperature"]
    assert f"T_tr is {float(warm[-1] / warm[0]):.4g} of what it was" in result.output


def test_a_mixture(tmp_path: Path) -> None:
    text = """law = { type = "frictionless", normal = 0.9 }
        [[body]]
        shape = "dumbbell"
        radius = 3e-3
        separation = 3e-3
        [[body]]
        shape = "dumbbell"
        radius = 2e-3
        separation = 0.0
        [gas]
        translational_temperature = 1e-9
        particles = [200, 100]
        collisions = 2
    """
    (tmp_path / "gas.toml").write_text(text, encoding="utf-8")
    result = invoke("gas", tmp_path / "gas.toml", "--out", tmp_path / "gas.nc")
    assert result.exit_code == 0, result.output
    with xr.open_dataset(tmp_path / "gas.nc") as found:
        assert found.sizes["species"] == 2


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("gas", GRAINS, "gas.translational_temperature: missing"),
        ("gas", GAS.replace("400", "-1"), "gas.particles = -1"),
        ("gas", GAS.replace("particles", "particle"), "gas.particle"),
        ("gas", GAS + "\n[run]\nimpacts = 3", "run"),
        ("gas", "body = []\n" + GAS.partition("\n\n")[0].partition("\nbody")[0], "law.type: missing"),
        ("pair", PAIR.replace("1e-9", "-1e-9"), "pair.translational_temperature"),
        ("pair", PAIR + '\nother = { shape = "plan" }', "other.shape"),
        ("pair", PAIR + '\nother = { shape = "ring", radius = 3e-3, wire = 1e-3 }', "other"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, name: str, text: str, told: str) -> None:
    path = tmp_path / "run.toml"
    path.write_text(text, encoding="utf-8")
    result = invoke(name, path, "--out", tmp_path / "found.nc")
    assert result.exit_code == 2, result.output
    assert f"run.toml: {told}" in result.output.replace("\n", " ")
    assert list(tmp_path.iterdir()) == [path]
