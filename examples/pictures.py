"""Pictures and films of bodies and impacts: `python examples/pictures.py OUT` writes them into a folder."""

import io
import math
import sys
from itertools import chain
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

import restitution as rs
from restitution import _core
from restitution.bodies import AnyBody
from restitution.figures.style import Style

IMPACT, GAIN, NEGATIVE = (79, 7), (391, 4), (24, (9, 10))
"""Particle and impacts: of the drawing, and of the films, one with ε > 1, one with ε < 0 and the next."""


def drops() -> xr.Dataset:
    """Drop dumbbells of two touching spheres; friction takes energy from every impact."""
    body, law = rs.Dumbbell(radius=3e-3, separation=6e-3), rs.Coulomb(normal=0.9, friction=0.3)
    return rs.simulate(body, law, particles=400, impacts=12, record="state", seed=1)


def scatter() -> xr.Dataset:
    """Count a hundred million impacts of the paper's Fig. 2."""
    return rs.statistics(
        rs.Dumbbell(radius=3e-3, separation=3e-4),
        rs.TangentialRestitution(normal=0.98),
        particles=250_000,
        impacts=400,
        velocity_bins=350,
        velocity_range=(0.05, 1.1),
        restitution_bins=240,
        restitution_range=(0.4, 1.6),
    )


def orbits() -> Image.Image:
    """Draw 56 million impacts of slow dumbbells: a line is an orbit, locked to the bounces."""
    velocity, restitution = (0.03, 0.38), (0.6, 1.4)
    found = rs.statistics(
        rs.Dumbbell(radius=3e-3, separation=3e-4),
        rs.TangentialRestitution(normal=0.98),
        particles=60_000,
        impacts=1000,
        velocity_bins=1400,
        velocity_range=velocity,
        restitution_bins=800,
        restitution_range=restitution,
    )
    count = found["restitution_count"].to_numpy().T
    figure = Figure(figsize=(14.0, 8.0), dpi=100)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    # What is dimmer than two impacts in a pixel is the noise of counting.
    shown = np.log(np.maximum(count, 2) / 2) / math.log(160)
    extent = (*velocity, *restitution)
    axes.imshow(shown**1.25, cmap="inferno", vmin=0, vmax=1, origin="lower", extent=extent, aspect="auto")
    words = {"color": "white", "fontfamily": "DejaVu Sans", "fontsize": 19}
    axes.text(0.192, 1.06, "half a turn in each bounce", **words)
    axes.text(0.1, 1.195, "half a turn in two bounces: one gains speed,", **words)
    axes.text(0.112, 0.8, "the other loses it", **words)
    axes.text(0.371, 0.945, "as a sphere", ha="right", **words)
    words |= {"color": "#9a9a9a", "fontsize": 15}
    for v in (0.1, 0.2, 0.3):
        axes.text(v, 0.612, f"{v:g} m/s", ha="center", **words)
    for epsilon in (0.8, 1.2):
        axes.text(0.376, epsilon, rf"$\varepsilon$ = {epsilon:g}", ha="right", va="center", **words)
    content = io.BytesIO()
    figure.savefig(content)
    return Image.open(content).convert("RGB").quantize(48, dither=Image.Dither.NONE)


def shapes(style: str) -> Image.Image:
    """Put bodies side by side: two dumbbells, a loaded sphere, a spherocylinder and two spheroids."""
    bodies = (
        rs.Dumbbell(radius=3e-3, separation=3e-3),
        rs.Dumbbell(radius=(3e-3, 2e-3), separation=4e-3, density=(2500.0, 7800.0)),
        rs.LoadedSphere(radius=4e-3, density=1200.0, load=5e-4, offset=2.5e-3),
        rs.Spherocylinder(radius=2.5e-3, separation=5e-3),
        rs.Spheroid(equatorial=2.5e-3, polar=5e-3),
        rs.Spheroid(equatorial=4.5e-3, polar=2.5e-3),
    )
    drawn = []
    for body in bodies:
        content = io.BytesIO()
        rs.figures.body(body, math.radians(55.0), style=style).savefig(content, dpi=150)
        drawn.append(Image.open(content).convert("RGB"))
    return _side_by_side(drawn)


def laws(style: str) -> Image.Image:
    """Put side by side what each law makes of the same oblique impact, almost in the plane of the picture."""
    each = {
        "TangentialRestitution": rs.TangentialRestitution(normal=0.9, tangential=1.0),
        "Frictionless": rs.Frictionless(normal=0.9),
        "Coulomb, Stronge": rs.Coulomb(normal=0.9, friction=0.3, hypothesis="stronge"),
        "Coulomb, Poisson": rs.Coulomb(normal=0.9, friction=0.3, hypothesis="poisson"),
        "Coulomb, Newton": rs.Coulomb(normal=0.9, friction=0.3, hypothesis="newton"),
        "ChatterjeeRuina": rs.ChatterjeeRuina(normal=0.9, tangential=0.9, friction=0.3),
    }
    body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    drawn = []
    for name, law in each.items():
        data = rs.simulate(
            body,
            law,
            particles=4000,
            impacts=1,
            release_height=2e-2,
            orientation=np.full(4000, 0.6),
            release_velocity=(0.7, 0.0, 0.0),
            record="state",
        )
        across = abs(data["axis"].sel(component="y")).where(data["axis"].sel(component="x") > 0.0)
        figure = rs.figures.impact(data, int(across.isel(impact=0).argmin()), style=style)
        after = figure.axes[1]
        after.set_title(after.get_title().replace("after", name))
        content = io.BytesIO()
        figure.savefig(content, dpi=150)
        whole = Image.open(content).convert("RGB")
        drawn.append(whole.crop((whole.width // 2, 0, whole.width, whole.height)))
    return _side_by_side(drawn)


def strip(style: Style) -> Figure:
    """Draw every kind of body: those of the table with usual values."""
    usual = {
        name: {about["name"]: about.get("default", about["example"]) for about in parameters}
        for name, parameters in ((entry["name"], entry["parameters"]) for entry in _core.BODIES)
    }
    bodies: dict[str, AnyBody] = {name: getattr(rs, name)(**values) for name, values in usual.items()}
    for name, body in (*grains().items(), *hulls().items(), *rough().items()):
        bodies.setdefault(name.partition("(")[0], body)
    figure, rows = rs.figures.panels(10.0, 2.9, rows=2, columns=-(-len(bodies) // 2))
    for axes in chain(*rows):
        axes.set_axis_off()
    for axes, (name, body) in zip(chain(*rows), bodies.items(), strict=False):
        _portrait(axes, name, body, style)
        axes.title.set_size(8.5)
    return figure


def grains() -> dict[str, AnyBody]:
    """Make bodies of many shapes."""
    stone = np.random.default_rng(2).normal(size=(24, 3)) * [3e-3, 2.5e-3, 2e-3]
    return {
        "Clump": rs.Clump(spheres=1e-3 * np.array([(0, 0, 2, 3), (2.5, 0, -1.5, 2.5), (-2, 1, -1.5, 2)])),
        "Ellipsoid": rs.Ellipsoid(semi_axes=(4e-3, 3e-3, 2e-3)),
        "Superellipsoid": rs.Superellipsoid(semi_axes=(4e-3, 3e-3, 2e-3), exponents=(5, 5)),
        "Box": rs.Box(8e-3, 6e-3, 4e-3),
        "ConvexPolyhedron": rs.ConvexPolyhedron(stone),
    }


def hulls() -> dict[str, AnyBody]:
    """Make solids of revolution and a die."""
    profile = 1e-3 * np.array([(-4, 0), (-3, 1), (0, 3), (1, 3), (3, 1), (4, 0)])
    return {
        "Cylinder": rs.Cylinder(radius=2e-3, height=6e-3),
        "Ring": rs.Ring(outer=4e-3, inner=2e-3, height=2e-3),
        "Revolution": rs.Revolution(profile=profile),
        "Egg": rs.Egg(length=7e-3, width=5e-3, blunt_end=2.3e-3, tip=1.5e-3),
        "Die": rs.Die(12, 3e-3),
    }


def rough() -> dict[str, AnyBody]:
    """Make rough bodies, and the mesh of a bracket."""
    heights = ("exponential", 1e-4)
    spherocylinder = rs.Spherocylinder(radius=2e-3, separation=4e-3)
    return {
        "Rough(Dumbbell)": rs.Rough(
            rs.Dumbbell(radius=2e-3, separation=3e-3), asperities=300, asperity_radius=2e-4
        ),
        "Rough(Spherocylinder)": rs.Rough(spherocylinder, asperities=300, asperity_radius=2e-4),
        "RoughSphere": rs.RoughSphere(radius=3e-3, asperities=1000, asperity_radius=2e-4, heights=heights),
        "Mesh": _bracket(),
    }


def _bracket() -> rs.Mesh:
    """Make an angle with two legs, which is not convex: a plane touches its hull."""
    outline = 1e-3 * np.array([(0, 0), (6, 0), (6, 2), (2, 2), (2, 5), (0, 5)])
    number = len(outline)
    corners = [(x, y, z) for z in (0.0, 3e-3) for x, y in outline]
    below = [(0, 2, 1), (0, 3, 2), (0, 4, 3), (0, 5, 4)]
    above = [tuple(number + i for i in reversed(triangle)) for triangle in below]
    around = [(i, (i + 1) % number) for i in range(number)]
    sides = [[(i, j, number + j), (i, number + j, number + i)] for i, j in around]
    return rs.Mesh(vertices=corners, triangles=[*below, *above, *(one for side in sides for one in side)])


def _with_densities(bodies: dict[str, AnyBody], style: Style) -> Figure:
    """Draw bodies, and under each the density of ε at impacts with 0.35 to 0.45 m/s."""
    figure, (above, below) = rs.figures.panels(rs.figures.PAGE, 3.4, rows=2, columns=len(bodies))
    for picture, axes, (name, body) in zip(above, below, bodies.items(), strict=True):
        _portrait(picture, name, body, style)
        data = rs.simulate(body, rs.Frictionless(normal=0.9), particles=1500, impacts=40, release_height=0.06)
        near = data.restitution.values[abs(data.impact_velocity.values - 0.4) < 0.05]
        edges = np.linspace(-0.5, 2.0, 41)
        number, _ = np.histogram(near, edges)
        axes.stairs(number / near.size / np.diff(edges), edges)
        axes.set(xlabel=r"$\varepsilon$", xlim=(edges[0], edges[-1]), ylim=(0.0, None))
    below[0].set_ylabel(r"$p(\varepsilon \mid v = 0.4$ m/s$)$")
    return figure


def _portrait(axes: Axes, name: str, body: AnyBody, style: Style) -> None:
    content = io.BytesIO()
    rs.figures.body(body, 0.5, style=style).savefig(content, dpi=300)
    axes.imshow(Image.open(content))
    axes.set_axis_off()
    axes.set_title(name)


def _side_by_side(drawn: list[Image.Image]) -> Image.Image:
    width, height = drawn[0].size
    whole = Image.new("RGB", (3 * width, 2 * height))
    for place, picture in enumerate(drawn):
        whole.paste(picture, (place % 3 * width, place // 3 * height))
    return whole


def main(folder: Path) -> None:
    """Write everything."""
    orbits().save(folder / "orbits.png", optimize=True)
    data, found = drops(), scatter()
    grounds: tuple[Style, ...] = ("page", "page-dark")
    for ground in grounds:
        shapes(ground).save(folder / f"shapes{ground.removeprefix('page')}.png")
        rs.figures.styled(strip)(style=ground).savefig(folder / f"bodies{ground[4:]}.png", dpi=200)
        drawn = rs.figures.map(found, style=ground)
        drawn.set_size_inches(5.1, 4.0)
        drawn.savefig(folder / f"fig2{ground[4:]}.png", dpi=200)
        for name, draw in (("grains", grains), ("hulls", hulls), ("rough-bodies", rough)):
            drawn = rs.figures.styled(_with_densities)(draw(), style=ground)
            rs.figures.save(drawn, folder / f"{name}{ground.removeprefix('page')}.png", title=name.title())
        laws(ground).save(folder / f"impulses{ground.removeprefix('page')}.png")
        drawn = rs.figures.impact(data, *IMPACT, style=ground)
        name = f"impact{ground.removeprefix('page')}.png"
        rs.figures.save(drawn, folder / name, title="An impact before and after")
    for name, (particle, impacts) in (("gain", GAIN), ("negative", NEGATIVE)):
        rs.figures.animate(data, particle, impacts, style="page").save(folder / f"{name}.gif")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
