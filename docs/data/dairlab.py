"""Impacts that DAIR Lab published, as ellipse.csv and cube.csv: `python docs/data/dairlab.py IMPACTS TOSSES`.

IMPACTS is a clone of github.com/DAIRLab/ImpactModeling at f6c2889, TOSSES one of
github.com/DAIRLab/contact-nets at c3dc21c; their licence is LICENSE-DAIRLab.txt. SI units; z is the
normal of the plane. `r` leads from the centre of mass to the contact; `v` and `w` are the
velocity of the centre of mass and the spin before the impact, `V` and `W` those afterwards. What has no
column is 0.
"""

import io
import pickle
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat
from scipy.spatial.transform import Rotation

Floats = NDArray[np.float64]
HERE = Path(__file__).parent
HALF, STEP, GRAVITY = 0.0524, 1 / 148, 9.81
"""Half an edge of the cube in m, and what is between two frames in s."""
RISE, BEFORE, AFTER = 0.25, 4, 3
"""An impact is where the vertical velocity rises by as much, in m/s, from one frame to the next; so many
frames before and after it make a line."""
STRAIGHT, TURNING, ALONE = 2e-4, 2e-3, 2e-2
"""How far from these lines a frame may be (m, rad), and how much higher the second vertex is at least (m)."""


def ellipse(clone: Path) -> tuple[str, Floats]:
    """Read the 2000 impacts of an ellipse; `flagged` are those on which the authors set a flag.

    x runs the other way than the file's: in the file's axes an impact to the right would make the ellipse
    turn the wrong way, and what is left of the balance of angular momentum is seven times as large.
    """
    path = clone / "AP Poisson" / "AP Poisson Ellipse" / "ellipse_uniform.mat"
    each = loadmat(path)["bounce_array"][0]
    s = np.array([one["states"][0] for one in each])
    flagged = [one["flags"].any() for one in each]
    arm = np.array([(one["n"][0, 2], -one["d"][0, 2]) for one in each])
    columns = [*arm.T, -s[:, 3], s[:, 4], -s[:, 5], -s[:, 9], s[:, 10], -s[:, 11], flagged]
    return "rx,rz,vx,vz,wy,Vx,Vz,Wy,flagged", np.stack(columns, axis=1)


class _Tensors(pickle.Unpickler):
    """Of a file of torch what says where the numbers are."""

    def find_class(self, module: str, name: str) -> Any:
        return (
            (lambda *tensor: tensor[:4]) if name == "_rebuild_tensor_v2" else dict if name[0] == "O" else name
        )

    def persistent_load(self, key: Any) -> Any:
        return key


def toss(data: bytes) -> Floats:
    """Read a tensor (frames, columns) in the format of torch before 1.6."""
    file = io.BytesIO(data)
    for _ in range(3):  # magic number, protocol, machine
        pickle.load(file)
    storage, offset, shape, stride = _Tensors(file).load()
    pickle.load(file)  # keys of the storages: there is one
    kind = np.dtype({"FloatStorage": "f4", "DoubleStorage": "f8"}[storage[1]])
    values = np.frombuffer(data, kind, offset=file.tell() + 8)[offset:]
    strides = [step * kind.itemsize for step in stride]
    return np.lib.stride_tricks.as_strided(values, shape, strides).astype(float).reshape(-1, shape[-1])


def _line(x: Floats, turned: Rotation, frames: NDArray[np.int64], at: float) -> tuple[Any, ...]:
    """Fit the flight in some frames: attitude, velocity and spin at a time, and the farthest off it."""
    time = (frames - at) * STEP
    place = x[frames] + np.outer(time**2, (0, 0, GRAVITY / 2))
    angle = (turned[frames] * turned[frames[0]].inv()).as_rotvec()
    fits = [np.polyfit(time, values, 1) for values in (place, angle)]
    off = [np.abs(v - np.outer(time, f[0]) - f[1]).max() for v, f in zip((place, angle), fits, strict=True)]
    return Rotation.from_rotvec(fits[1][1]) * turned[frames[0]], fits[0][0], fits[1][0], off


def cube(clone: Path) -> tuple[str, Floats]:
    """Find the first impact of each toss of a cube, where one vertex strikes and the flights are smooth.

    Its centre of mass is not its centre: the offset, constant in the body, is fitted together with the
    moment of inertia to the balance of angular momentum about the contact, in which no law appears.
    """
    vertices = HALF * np.array(np.meshgrid(*3 * [(-1, 1)])).reshape(3, 8).T
    rows, attitudes = [], []
    for number in range(570):
        frames = toss((clone / "data" / "tosses_processed" / f"{number}.pt").read_bytes())
        x, turned = HALF * frames[:, :3], Rotation.from_quat(frames[:, [4, 5, 6, 3]])
        first = int(np.argmax(np.diff(HALF * frames[:, 9]) > RISE))
        if first <= BEFORE or first + AFTER + 2 > len(frames):
            continue
        known = np.arange(first - BEFORE, first), np.arange(first + 1, first + 1 + AFTER)
        (attitude, v, w, off), (_, v1, w1, off1) = (_line(x, turned, part, first - 0.5) for part in known)
        corners = attitude.apply(vertices)
        low = np.argsort(corners[:, 2])
        gap = corners[low[1], 2] - corners[low[0], 2]
        if max(off[0], off1[0]) < STRAIGHT and max(off[1], off1[1]) < TURNING and gap > ALONE:
            rows.append((corners[low[0]], v, w, v1, w1))
            attitudes.append(attitude.as_matrix())
    r, v, w, v1, w1 = np.array(rows).transpose(1, 0, 2)
    axes, kick, turn = np.array(attitudes), v1 - v, w1 - w
    # k Δω = (r − c) × (Δv + Δω × c), to first order in c.
    terms = [turn, *(np.cross(c, kick) - np.cross(r, np.cross(turn, c)) for c in axes.transpose(2, 0, 1))]
    matrix, torque = np.stack([term.ravel() for term in terms], axis=1), np.cross(r, kick).ravel()
    weight = np.ones(torque.size)
    for _ in range(50):  # to the least sum of absolute values
        found = np.linalg.lstsq(matrix * weight[:, None], torque * weight, rcond=None)[0]
        weight = 1 / np.sqrt(np.maximum(np.abs(matrix @ found - torque), 1e-5))
    share = np.abs(matrix @ found - torque).mean() / np.abs(torque).mean()
    print(f"cube: {len(rows)} impacts, centre of mass at {1e3 * found[1:]} mm, {share:.0%} of torque left")
    c = axes @ found[1:]
    moved = [r - c, v + np.cross(w, c), w, v1 + np.cross(w1, c), w1]
    return ",".join(a + b for a in "rvwVW" for b in "xyz"), np.concatenate(moved, axis=1)


if __name__ == "__main__":
    for name, (header, table) in {
        "ellipse": ellipse(Path(sys.argv[1])),
        "cube": cube(Path(sys.argv[2])),
    }.items():
        np.savetxt(HERE / f"{name}.csv", table, fmt="%.4g", delimiter=",", header=header, comments="")
