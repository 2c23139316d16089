"""Make the reference of the dumbbell problem: `python -m benchmarks.engines.reference [FOLDER]`.

The problem and the files are described in reference/README.md, which stands beside them.
"""

import csv
import sys
import warnings
from pathlib import Path

import numpy as np
import xarray as xr

import restitution as rs
from benchmarks.engines.problem import Floats

VERSION = "1.0"
FOLDER = Path(__file__).parent / "reference"
BODY = rs.Dumbbell(radius=0.01, separation=0.01, density=2500.0)
LAW = rs.Frictionless(normal=0.9)
HEIGHT, GRAVITY = 0.06, 9.81
ANGLES = (np.arange(45) + 0.5) * np.pi / 90
"""Of the axis to the vertical at release: first impacts. Trajectories take every third."""
IMPACTS = 8
PARTICLES, BATCHES = 100_000, 20
SECONDS, IMPACTS_OF_STATISTICS = 1.2, 400
"""Of statistics: time after the release, and impacts that nobody has in it."""
EDGES = np.linspace(0.2, 1.0, 9)


def first_impacts() -> xr.Dataset:
    """Give ε of the first impact, and the spin after it."""
    data = simulated(ANGLES, 1)
    epsilon = data["restitution"].values[:, 0]
    speed = data["impact_velocity"].values[:, 0]
    # The impulse m(1 + ε)v acts at the arm of the contact; the body did not turn before.
    arm = 0.5 * BODY.separation * np.sin(ANGLES)
    spin = BODY.mass * (1 + epsilon) * speed * arm / BODY.transverse_inertia
    variables = {
        "impact_velocity": (speed, "m s-1", "speed of the centre of mass before the impact"),
        "restitution": (epsilon, "1", "its speed after the impact over that before"),
        "spin_after": (spin, "rad s-1", "angular speed after the impact"),
    }
    return xr.Dataset(
        {
            name: ("angle", values, {"units": unit, "long_name": text})
            for name, (values, unit, text) in variables.items()
        },
        {"angle": ("angle", ANGLES, {"units": "rad", "long_name": "axis to the vertical at release"})},
    )


def trajectories() -> xr.Dataset:
    """Give the first impacts of some particles: later ones amplify every rounding."""
    angles = ANGLES[::3]
    data = simulated(angles, IMPACTS)
    names = {"time": "s", "impact_velocity": "m s-1", "restitution": "1", "angle": "rad"}
    found = {
        f"trajectory_{name}": (("release_angle", "impact"), data[name].values, {"units": unit})
        for name, unit in names.items()
    }
    return xr.Dataset(found, {"release_angle": angles, "impact": np.arange(1, IMPACTS + 1)})


def statistics(batches: int = BATCHES, seed: int = 2014) -> xr.Dataset:
    """Give mean and standard deviation of ε by impact velocity in the first `SECONDS`, θ uniform in [0, π).

    Errors are over the batches, which share no body: impacts of one are not independent.
    """
    sums = np.zeros((batches, 3, EDGES.size - 1))
    for batch in range(batches):
        data = rs.simulate(
            BODY,
            LAW,
            particles=PARTICLES // BATCHES,
            impacts=IMPACTS_OF_STATISTICS,
            release_height=HEIGHT,
            gravity=GRAVITY,
            seed=seed + batch,
        )
        last = np.nanmax(data["time"].values, axis=1)
        ended = data["impacts"].values < IMPACTS_OF_STATISTICS
        assert np.all(ended | (last > SECONDS)), "more impacts are needed to fill the time"
        inside = data["time"].values < SECONDS
        v, epsilon = data["impact_velocity"].values[inside], data["restitution"].values[inside]
        for power in range(3):
            sums[batch, power] = np.histogram(v, EDGES, weights=epsilon**power)[0]
    total = sums.sum(axis=0)
    mean, std = _moments(total)
    left = np.array([_moments(total - one) for one in sums])
    errors = np.sqrt((batches - 1) / batches * np.sum((left - left.mean(axis=0)) ** 2, axis=0))
    variables = {
        "number": (total[0], "impacts"),
        "mean_restitution": (mean, "mean of restitution"),
        "mean_restitution_error": (errors[0], "its standard error"),
        "std_restitution": (std, "standard deviation of restitution"),
        "std_restitution_error": (errors[1], "its standard error"),
    }
    return xr.Dataset(
        {name: ("velocity", values, {"long_name": text}) for name, (values, text) in variables.items()},
        {"velocity": ("velocity", 0.5 * (EDGES[1:] + EDGES[:-1]), {"units": "m s-1"})},
    )


def _moments(sums: Floats) -> tuple[Floats, Floats]:
    number, first, second = sums
    return first / number, np.sqrt(second / number - (first / number) ** 2)


def simulated(angles: Floats, impacts: int) -> xr.Dataset:
    """Drop bodies at these angles."""
    return rs.simulate(
        BODY,
        LAW,
        particles=angles.size,
        impacts=impacts,
        release_height=HEIGHT,
        gravity=GRAVITY,
        orientation=angles,
    )


def make(folder: Path) -> None:
    """Write the netCDF file and the three CSV files."""
    folder.mkdir(parents=True, exist_ok=True)
    parts = {"first_impacts": first_impacts(), "trajectories": trajectories(), "statistics": statistics()}
    whole = xr.merge(parts.values(), combine_attrs="drop")
    whole.attrs = {
        "title": "A dumbbell bouncing on a frictionless plane: reference solution",
        "version": VERSION,
        "Conventions": "CF-1.11",
        "radius": BODY.radii[0],
        "separation": BODY.separation,
        "mass": BODY.mass,
        "transverse_inertia": BODY.transverse_inertia,
        "axial_inertia": BODY.axial_inertia,
        "normal": 0.9,
        "release_height": HEIGHT,
        "gravity": GRAVITY,
    }
    whole.to_netcdf(folder / "dumbbell.nc")
    for name, part in parts.items():
        frame = part.to_dataframe().reset_index()
        with (folder / f"{name}.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(frame.columns)
            writer.writerows([f"{value:.15g}" for value in row] for row in frame.to_numpy())


if __name__ == "__main__":
    warnings.simplefilter("ignore", rs.EnergyWarning)
    make(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
