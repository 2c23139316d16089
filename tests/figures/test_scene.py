"""Pictures and films of bodies: what is drawn is where the body is, and the drawn vectors obey mechanics."""

import math
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from PIL import Image, ImageSequence
from scipy.spatial.transform import Rotation

import restitution as rs
from restitution.bodies import Body, RigidBody
from restitution.figures.scene import _grain as grain
from restitution.figures.scene._impact import Sideview
from restitution.figures.scene._solid import contact_point, picture
from restitution.figures.scene._vectors import CONTACT, IMPULSE, ROTATION, VELOCITY
from restitution.figures.style import COLORS, ON_DARK, Style

BODIES: dict[str, Body] = {
    "dumbbell": rs.Dumbbell(radius=(3e-3, 2e-3), separation=6e-3, density=(2500, 4000)),
    "loaded": rs.LoadedSphere(radius=3e-3, load=1e-4, offset=2e-3),
    "capsule": rs.Spherocylinder(radius=2e-3, separation=5e-3),
    "prolate": rs.Spheroid(equatorial=2e-3, polar=4e-3),
    "oblate": rs.Spheroid(equatorial=4e-3, polar=2e-3),
}


def states(body: Body, **more: Any) -> xr.Dataset:
    law = rs.TangentialRestitution(normal=0.8)
    return rs.simulate(body, law, particles=3, impacts=8, record="state", seed=3, **more)


@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
@pytest.mark.parametrize("spin", [(0.0, 0.0, 0.0), (30.0, 20.0, 10.0)], ids=["planar", "in space"])
def test_the_marked_point_touches_and_obeys_the_law(body: Body, spin: tuple[float, ...]) -> None:
    """It is on the plane, and the normal velocity of this point, v + ω × r, is reversed times ε_n (Eq. 9)."""
    data = states(body, spin=spin)
    for particle in range(3):
        for one in Sideview.of(data, particle, 0, int(data["impacts"][particle]) - 1, name="impacts").impacts:
            assert abs(one.contact[1]) < 1e-11 * body.compiled.farthest() * 1e3
            arm = one.contact - one.centre
            before, after = (
                (v + np.cross(w, arm))[1] for v, w in zip(one.velocity, one.rotation, strict=True)
            )
            assert before < 0
            assert after == pytest.approx(-0.8 * before, rel=1e-9)


@pytest.mark.parametrize(("name", "tilt"), [(n, t) for n in BODIES for t in (0.0, 0.5, 1.4)])
def test_a_body_is_as_large_in_its_picture_as_it_is(name: str, tilt: float) -> None:
    """Areas of the outlines in closed form, for an axis that leans towards the reader by `tilt`."""
    body = BODIES[name]
    cover = picture(body, np.array([math.cos(tilt), 0.0, math.sin(tilt)]))[..., 3]
    side = 2.1 * body.compiled.farthest() / cover.shape[0]
    match body:
        case rs.Spheroid(equatorial=a, polar=c):
            area = math.pi * a * math.hypot(c * math.cos(tilt), a * math.sin(tilt))
        case rs.Spherocylinder(radius=r, separation=length):
            area = math.pi * r**2 + 2 * r * length * math.cos(tilt)
        case rs.LoadedSphere(radius=r):
            area = math.pi * r**2
        case rs.Dumbbell(radii=(r, s), separation=length):
            if tilt > 1.0:
                pytest.skip("one sphere hides a part of the other")
            rod = 2 * min(r, s) / 12 * (length * math.cos(tilt) - r - s)
            area = math.pi * (r**2 + s**2) + max(rod, 0.0)
    # a pixel at the edge is off by less than a tenth of its area on average
    assert cover.sum() * side**2 == pytest.approx(area, rel=0.01)


def test_the_lower_end_of_an_ellipse_is_where_calculus_puts_it() -> None:
    """The support function of a spheroid, h² = a² + (c² - a²) cos²θ, and its derivative as the lever arm."""
    body, theta = rs.Spheroid(equatorial=2e-3, polar=5e-3), 0.6
    x, down, _ = contact_point(body, np.array([math.sin(theta), math.cos(theta), 0.0]))
    h = math.sqrt(2e-3**2 + (5e-3**2 - 2e-3**2) * math.cos(theta) ** 2)
    assert down == pytest.approx(-h, rel=1e-12)
    lever = (5e-3**2 - 2e-3**2) * math.sin(theta) * math.cos(theta) / h
    assert x == pytest.approx(-lever, rel=1e-12)


GRAINS: dict[str, RigidBody] = {
    "two balls": rs.Clump(spheres=[(0, 0, 3e-3, 2e-3), (1e-3, 0, -3e-3, 3e-3)]),
    "ellipsoid": rs.Ellipsoid(semi_axes=(4e-3, 3e-3, 2e-3)),
    "box": rs.Box(8e-3, 6e-3, 4e-3),
    "tetrahedron": rs.ConvexPolyhedron(1e-3 * np.array([(0, 0, 0), (6, 0, 0), (0, 5, 0), (0, 0, 4)])),
    "rough": rs.RoughSphere(radius=3e-3, asperities=1, asperity_radius=1e-3, heights=1e-3),
}
UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def _lens(a: float, b: float, d: float) -> float:
    """Area that circles of the radii a > b at the distance d have in common."""
    if d <= a - b:
        return math.pi * b * b
    x, y = (d * d + a * a - b * b) / (2.0 * d), (d * d + b * b - a * a) / (2.0 * d)
    return a * a * math.acos(x / a) + b * b * math.acos(y / b) - d * math.sqrt(a * a - x * x)


@pytest.mark.parametrize("name", GRAINS)
def test_a_grain_is_as_large_as_it_is_and_touches_where_the_core_says(name: str) -> None:
    """Projected areas in closed form (of polyhedra half the sum over their faces), and the core's height."""
    body = GRAINS[name]
    turn = Rotation.from_euler("zxy", [0.4, 0.3, 0.2])
    attitude = UPRIGHT @ turn.as_matrix()
    x, y, z, w = turn.as_quat()
    height = body.compiled.lowest(np.array([[w, x, y, z]]))
    assert -grain.lowest(body, attitude)[1] == pytest.approx(height, rel=1e-12)
    cover = grain.picture(body, attitude)[..., 3]
    n = np.abs(attitude[2])  # towards the reader, in the axes of the body
    match body:
        case rs.Clump(spheres=spheres):
            area = math.pi * sum(radius**2 for *_, radius in spheres)
        case rs.Ellipsoid(semi_axes=(a, b, c)):
            area = math.pi * float(np.linalg.norm(n * [b * c, c * a, a * b]))
        case rs.Box(a=a, b=b, c=c):
            area = float(n @ [b * c, c * a, a * b])
        case rs.RoughSphere(asperity_balls=balls):
            aside = float(np.hypot(*(attitude @ balls[0, :3])[:2]))  # of circles of 3 and 1 mm
            area = math.pi * 10e-6 - _lens(3e-3, 1e-3, aside)
        case rs.ConvexPolyhedron():
            small = 0.5e-6 * np.array([5 * 4, 4 * 6, 6 * 5])  # of its faces on the planes of its axes
            area = 0.5 * float(n @ small + abs(attitude[2] @ small))
    side = 2.1 * body.compiled.farthest() / cover.shape[0]
    assert cover.sum() * side**2 == pytest.approx(area, rel=0.003)


def test_the_picture_of_a_rim_is_a_polygon_as_fine_as_the_eye() -> None:
    """A cylinder covers πR²|n_z| + 2RH√(1 − n_z²); a die is a polyhedron."""
    coin = rs.Cylinder(radius=4e-3, height=2e-3)
    turn = Rotation.from_euler("zxy", [0.4, 0.3, 0.2])
    attitude = UPRIGHT @ turn.as_matrix()
    x, y, z, w = turn.as_quat()
    height = coin.compiled.lowest(np.array([[w, x, y, z]]))
    assert -grain.lowest(coin, attitude)[1] == pytest.approx(height, rel=3e-3)
    along = abs(float(attitude[2, 2]))
    area = math.pi * 16e-6 * along + 16e-6 * math.sqrt(1.0 - along**2)
    cover = grain.picture(coin, attitude)[..., 3]
    side = 2.1 * coin.compiled.farthest() / cover.shape[0]
    assert cover.sum() * side**2 == pytest.approx(area, rel=5e-3)
    die = rs.Die(4, 5e-3)
    shown = grain.picture(rs.ConvexPolyhedron(die.vertices), attitude)
    np.testing.assert_allclose(grain.picture(die, attitude), shown, atol=1e-6)
    egg = rs.Egg(length=6e-3, width=4e-3, blunt_end=1.9e-3, tip=1.2e-3)
    height = egg.compiled.lowest(np.array([[w, x, y, z]]))
    assert -grain.lowest(egg, attitude)[1] == pytest.approx(height, rel=3e-3)


def test_a_rough_body_shows_its_asperities() -> None:
    """The picture of a rough dumbbell is that of a clump of all its balls, about the same centre."""
    dumbbell = rs.Dumbbell(radius=3e-3, separation=4e-3)
    rough = rs.Rough(dumbbell, asperities=40, asperity_radius=4e-4)
    clump = rs.Clump(spheres=rough.compiled.balls())
    shown, alike = (grain.surfaces(body, UPRIGHT) for body in (rough, clump))
    assert len(shown) == 42
    away = UPRIGHT @ (clump.centre_of_mass - rough.centre_of_mass)
    for one, other in zip(shown, alike, strict=True):
        np.testing.assert_allclose(one.lowest, other.lowest + away, atol=1e-12)
    capsule = rs.Rough(rs.Spherocylinder(radius=2e-3, separation=5e-3), asperities=40, asperity_radius=4e-4)
    height = capsule.compiled.lowest(np.array([[1.0, 0.0, 0.0, 0.0]]))
    assert -grain.lowest(capsule, UPRIGHT)[1] == pytest.approx(height, rel=3e-2)


def arrows(figure: Figure) -> list[np.ndarray[Any, Any]]:
    """Tip minus start of every straight arrow of a figure, in its order."""
    found = []
    for axes in figure.axes:
        for patch in axes.patches:
            if isinstance(patch, FancyArrowPatch):
                path = patch._path_original  # type: ignore[attr-defined]
                if len(path.vertices) == 2:
                    found.append(path.vertices[1] - path.vertices[0])
    return found


def test_the_arrows_of_an_impact_add_up() -> None:
    """v + P/m = v', and their directions are those of the run."""
    data = states(BODIES["dumbbell"])
    figure = rs.figures.impact(data, 1, 3)
    before, after, push = arrows(figure)
    np.testing.assert_allclose(before + push, after, atol=1e-9)
    v = data["velocity_before"].to_numpy()[1, 3]
    assert before[1] / np.hypot(*before) == pytest.approx(v[2] / np.linalg.norm(v))
    titles = " ".join(axes.get_title() for axes in figure.axes)
    assert f"{float(data.restitution[1, 3]):.2f}".replace("-", "\N{MINUS SIGN}") in titles


def test_a_film_shows_the_body_where_it_is(tmp_path: Path) -> None:
    """Every picture has the body at its place in `trajectory`; the film stands still at the impact."""
    data = states(BODIES["dumbbell"])
    film = rs.figures.animate(data, 1, (2, 3))
    assert np.all(np.diff(film.times) >= 0)
    when = data["time"].to_numpy()[1]
    assert when[1] <= film.times[0] < when[2]
    assert film.times[-1] <= when[4]
    path = rs.trajectory(data, 1, film.times)
    for k in (0, film.frames // 2, film.frames - 1):
        (image,) = film.picture(k).axes[0].images
        left, right, low, high = image.get_extent()
        assert 0.5 * (low + high) == pytest.approx(1e3 * float(path["position"][k, 2]), rel=1e-9)
        assert 0.5 * (left + right) == pytest.approx(film.centre(k)[0], rel=1e-9)
    assert {when[2], when[3]} <= set(film.times)
    short = rs.figures.animate(data, 2, 1)
    with Image.open(short.save(tmp_path / "film.gif")) as saved:
        total = sum(one.info["duration"] for one in ImageSequence.Iterator(saved))
    assert total == 60 * short.frames


@pytest.mark.parametrize("style", [None, "slides", "page-dark", "slides-dark"])
def test_a_film_is_in_its_style(style: Style | None) -> None:
    """The ground is that of the style, all words are inside, and no colour of an arrow is lost in a GIF."""
    film = rs.figures.animate(states(BODIES["dumbbell"]), 1, 2, style=style)
    dark = style is not None and style.endswith("-dark")
    still = max(k for k, one in enumerate(film._frames) if one.impact is not None)
    figure = film.picture(still)
    for text in figure.texts:
        box = text.get_window_extent()
        assert 0.0 <= box.x0 <= box.x1 <= figure.bbox.width, text.get_text()
    image = film._image(still, style=style)
    palette = film._palette([image], style=style)
    shown = np.asarray(image.quantize(palette=palette, dither=Image.Dither.NONE).convert("RGB")).astype(int)
    ground = (20, 24, 30) if dark else (255, 255, 255)
    assert np.abs(shown[0, 0] - ground).max() <= 4
    for number in (VELOCITY, ROTATION, IMPULSE, CONTACT):
        color = np.array(to_rgb((ON_DARK if dark else COLORS)[number])) * 255
        assert np.abs(shown - color).max(axis=-1).min() <= 12, number


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="takes the program ffmpeg")
def test_an_mp4_shows_the_pictures_of_the_film(tmp_path: Path) -> None:
    """As a player decodes it: every picture in its place, with colours rounded as the codec does."""
    film = rs.figures.animate(states(BODIES["dumbbell"]), 1, 2, style="page")
    path = film.save(tmp_path / "film.mp4")
    command = ["ffmpeg", "-v", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    shown = np.frombuffer(subprocess.run(command, capture_output=True, check=True).stdout, np.uint8)
    images = film._images()
    width, height = (2 * (n // 2) for n in images[0].size)
    shown = shown.reshape(film.frames, height, width, 3)
    for number, image in enumerate(images):
        drawn = np.asarray(image)[:height, :width].astype(float)
        assert np.abs(shown[number] - drawn).mean() < 3.0, number


def test_films_say_what_they_cannot_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    data = states(BODIES["prolate"])
    film = rs.figures.animate(data, 0, 7)  # the last one: the film ends there
    assert film.times[-1] == data["time"].to_numpy()[0, 7]
    with pytest.raises(ValueError, match=r"name = '.*film.png': must be the name of a film"):
        film.save(tmp_path / "film.png")
    monkeypatch.setattr("matplotlib.animation.FFMpegWriter.isAvailable", lambda: False)
    with pytest.raises(
        RuntimeError, match=r"takes the program ffmpeg, .* ffmpeg.org, or save the film as .gif"
    ):
        film.save(tmp_path / "film.mp4")
    assert not (tmp_path / "film.mp4").exists()
    with pytest.raises(ValueError, match=r"impacts = \(1, 2, 3\): must be the number of an impact"):
        rs.figures.animate(data, 0, (1, 2, 3))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"impacts = 2: must be a whole number in \[3, 7\]"):
        rs.figures.animate(data, 0, (3, 2))
    with pytest.raises(ValueError, match=r"impacts = None: must be the number of an impact"):
        rs.figures.animate(data, 0, None)  # type: ignore[arg-type]
    for frame in (-1, film.frames):
        for method in (film.picture, film.centre):
            with pytest.raises(ValueError, match=rf"frame = {frame}: must be a whole number in \[0, "):
                method(frame)
    with pytest.raises(ValueError, match=r'record="state"'):
        rs.figures.animate(rs.simulate(BODIES["prolate"], rs.Frictionless(normal=0.9), particles=1))
    with pytest.raises(ValueError, match=r"impact = 8: must be a whole number in \[0, 7\]"):
        rs.figures.impact(data, 0, 8)


def test_a_portrait_has_its_parts() -> None:
    """The body, its axis, centre of mass and contact, and a bar of a round length."""
    axes = rs.figures.body(BODIES["oblate"], 0.4).axes[0]
    assert len(axes.images) == 1
    (label,) = (text.get_text().strip() for text in axes.texts)
    assert label in ("1 mm", "2 mm")
    bar = next(line for line in axes.lines if np.all(np.asarray(line.get_ydata()) < 0))
    assert np.ptp(np.asarray(bar.get_xdata())) == pytest.approx(float(label.split()[0]))
