"""Clumps from files of other codes, which are written here in their formats, and what is said of bad ones."""

from pathlib import Path

import numpy as np
import pytest

import restitution as rs
from restitution.drop.toml import read

SPHERES = np.array([(0.0, -0.41, 0.0, 0.8), (-0.33, 0.19, 0.05, 0.8), (0.29, 0.19, -1.5e-2, 0.75)])
LIGGGHTS = """# multisphere template of three spheres

0.00 -0.41 0 0.8
-0.33 0.19 & # a row goes on
   0.05 0.8 1   # with a type
2.9E-1\t0.19 -1.5e-2 0.75
"""
CLUMP = """  0.000000, -0.410000, -0.000000,  0.800000
 -0.330000,  0.190000,  0.050000,  0.800000
  0.290000,  0.190000, -0.015000,  0.750000
"""
MERCURY = "0 -0.41 0 0.8\r\n-0.33 0.19 0.05 0.8\r\n0.29 0.19 -0.015 0.75\r\n"
ENGINE = """x,y,z,r
0.00,-0.41,0,0.8
-0.33,0.19,0.05,0.8
0.29,0.19,-0.015,0.75
# volume = 4.25
"""
RENAMED = '"r";"Z";"Y";"X";"family"\n0.8;0;-0.41;0;1\n0.8;0.05;0.19;-0.33;1\n.75;-.015;.19;.29;2\n'
LAMMPS = """three spheres, of which this is the title

3 atoms  # in it
4.25 mass

Coords

1 0.00 -0.41 0
3 0.29 0.19 -0.015
2 -0.33 0.19 0.05

Types

1 stone
2 1
3 1

Diameters

1 1.6
2 1.6
3 1.5
"""


SCRIPT = """# an input script of LIGGGHTS
fix pts1 all particletemplate/multisphere 15485867 atom_type 1 density constant 2500 nspheres 3 &
    ntry 100000 spheres 0 -0.41 0 0.8 -0.33 0.19 0.05 0.8 &
    0.29 0.19 -0.015 0.75 type 1
fix pdd1 all particledistribution/discrete 15485867 1 pts1 1.0
"""


def written(folder: Path, text: str | bytes) -> Path:
    path = folder / "clump.txt"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


@pytest.mark.parametrize(
    ("text", "format"),
    [
        (LIGGGHTS, "rows"),
        (CLUMP, "rows"),
        (MERCURY, "rows"),
        ("\ufeff" + ENGINE, "csv"),
        (RENAMED, "csv"),
        (LAMMPS, "lammps"),
        (SCRIPT, "liggghts"),
    ],
)
def test_the_same_spheres_in_every_format(tmp_path: Path, text: str, format: str) -> None:
    """Found out or told; as if they had been typed."""
    path = written(tmp_path, text)
    expected = rs.Clump(spheres=1e-3 * SPHERES, density=1000.0)
    for given in (None, format):
        body = rs.Clump.from_file(path, given, scale=1e-3, density=1000.0)  # type: ignore[arg-type]
        assert body == expected
    assert body.mass == expected.mass


@pytest.mark.filterwarnings("ignore:.*lengths are in m")
def test_what_is_written_is_read_again_bit_by_bit(tmp_path: Path) -> None:
    spheres = np.random.default_rng(5).normal(size=(7, 4)) * (1e-3, 1e-4, 1.0, 0.0) + (0, 0, 0, 1 / 3)
    body, path = rs.Clump(spheres=spheres), tmp_path / "clump.csv"
    body.to_csv(path)
    assert path.read_text().startswith("x,y,z,r\n")
    assert rs.Clump.from_file(path) == body
    with pytest.raises(FileExistsError):
        body.to_csv(path)
    body.to_csv(path, replace=True)


@pytest.mark.parametrize(
    ("text", "format", "message"),
    [
        ("", None, "empty"),
        ("# nothing\n\n", None, "empty"),
        (b"solid \0\x01", None, "not a text file"),
        (b"\xff\xff", None, "not a text file"),
        ("0 0 0 1\n0 0 1\n", None, r"line 2: '0 0 1': must be x y z r"),
        ("0 0 0 1\n\n0 0 &\n1 -1\n", None, r"line 4: '0 0 1 -1': must be .* r > 0"),
        ("0 0 0 1\n0 0 1 &\n", None, r"line 2: '0 0 1': must be x y z r"),
        ("0 0 0 1\n0 nan 0 1\n", None, "line 2.* finite"),
        ("0 0 0 1 2 3\n", None, "line 1"),
        ("0 0 O 1\n", None, "line 1: '0 0 O 1'"),
        ("{'atoms': 3}\n", None, "line 1"),
        ("x,y,z,radius\n0,0,0,1\n", None, "line 1.* columns x, y, z and r"),
        ("x,y,z,r,r\n0,0,0,1,1\n", None, "line 1.* each once"),
        ("x,y,z,r\n0,0,0,1\n0,0,0\n", None, "line 3: '0 0 0': must be 4 values"),
        ("x,y,z,r\n0,0,0,0\n", None, "line 2.* r > 0"),
        ("x,y,z,r\n", None, "no spheres"),
        ("0 0 0 1\n", "csv", "line 1.* header"),
        ("0 0 0 1\n", "lammps", "no line 'N atoms'"),
        (LAMMPS.replace("Diameters", "Sizes"), None, "no section Diameters"),
        (LAMMPS.replace("3 0.29", "2 0.29"), None, "line 10: .* each ID from 1 to 3 once"),
        (LAMMPS.replace("3 0.29", "4 0.29"), None, "line 9: .* each ID from 1 to 3 once"),
        (LAMMPS.replace("2 -0.33 0.19 0.05\n", ""), None, "2 lines in the section Coords"),
        (LAMMPS.replace("2 1.6", "2 -1.6"), None, "line 21: '2 -1.6': must be ID diameter"),
        (LAMMPS.replace("3 1.5", "3 1.5 7"), None, "line 22: '3 1.5 7': must be ID diameter"),
        (LAMMPS.replace("3 atoms", "atoms 3"), None, "no line 'N atoms'"),
    ],
)
def test_other_files_are_refused_with_line_and_reason(
    tmp_path: Path, text: str | bytes, format: str | None, message: str
) -> None:
    path = written(tmp_path, text)
    with pytest.raises(ValueError, match=f"{path}.*{message}"):
        rs.Clump.from_file(path, format)  # type: ignore[arg-type]


def test_arguments_that_cannot_be_are_refused_by_name(tmp_path: Path) -> None:
    path = written(tmp_path, CLUMP)
    with pytest.raises(ValueError, match="format = 'yade': must be None, 'rows', 'csv', 'lammps'"):
        rs.Clump.from_file(path, "yade")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="scale = 0"):
        rs.Clump.from_file(path, scale=0.0)
    with pytest.raises(ValueError, match="density = -1"):
        rs.Clump.from_file(path, density=-1.0)
    with pytest.raises(ValueError, match="path = None"):
        rs.Clump.from_file(None)  # type: ignore[arg-type]
    with pytest.raises(FileNotFoundError):
        rs.Clump.from_file(tmp_path / "none")


def test_rows_of_points_and_profiles(tmp_path: Path) -> None:
    """As from a measured outline; in a file of a run as a clump is."""
    head = '[law]\ntype = "frictionless"\nnormal = 0.9\n[body]\nscale = 1e-3\nfile = "rows.csv"\n'
    rows, run = tmp_path / "rows.csv", tmp_path / "run.toml"
    rows.write_text("# z r in mm\n-2, 3.5\n-1.2, 5\n1.2, 5\n2, 3.5\n", encoding="utf-8")
    tablet = rs.Revolution(profile=1e-3 * np.array([(-2, 3.5), (-1.2, 5), (1.2, 5), (2, 3.5)]))
    run.write_text(f'{head}shape = "revolution"\n', encoding="utf-8")
    assert read(run).body == rs.Revolution.from_file(rows, scale=1e-3) == tablet
    rows.write_text("-2 3.5\n-1.2 5 1\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"rows\.csv, line 2: '-1\.2 5 1': must be z r, with spaces"):
        rs.Revolution.from_file(rows)
    rows.write_text("0 1\n1 -1\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"rows\.csv: profile\[1, 1\] = -1"):
        rs.Revolution.from_file(rows)
    rows.write_text("0 4\n12 0\n", encoding="utf-8")
    with pytest.warns(
        UserWarning, match=r"rows\.csv: lengths are in m, and the body is 12 m in size; scale=1e-3?"
    ):
        rs.Revolution.from_file(rows)
    rows.write_text("0 0 0 2\n1 0 0 2\n", encoding="utf-8")
    with pytest.warns(UserWarning, match="lengths are in m, and the body is 2 m in size"):
        rs.Clump.from_file(rows)
    corners = [(0, 0, 0), (6, 0, 0), (0, 6, 0), (0, 0, 6)]
    rows.write_text("\n".join(" ".join(map(str, corner)) for corner in corners), encoding="utf-8")
    run.write_text(f'{head}shape = "convex-polyhedron"\n', encoding="utf-8")
    assert read(run).body == rs.ConvexPolyhedron(1e-3 * np.array(corners))


def test_a_file_of_a_run_names_that_of_its_clump(tmp_path: Path) -> None:
    """Beside it, with the arguments of `from_file`; what it takes besides is refused by name."""
    stone, run = written(tmp_path, MERCURY), tmp_path / "run.toml"
    head = '[law]\ntype = "frictionless"\nnormal = 0.9\n[body]\nshape = "clump"\nfile = "clump.txt"\n'
    run.write_text(head + "scale = 1e-3\ndensity = 1e3\n", encoding="utf-8")
    assert read(run).body == rs.Clump.from_file(stone, scale=1e-3, density=1e3)
    run.write_text(head + "spheres = [[0, 0, 0, 1]]\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"body\.spheres: unknown"):
        read(run)
