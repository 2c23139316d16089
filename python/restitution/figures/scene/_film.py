"""Films of a bouncing body, in slow motion around its impacts."""

from __future__ import annotations

import io
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.animation import FFMpegWriter
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

from restitution._internal.arrays import FARTHEST, FloatArray, whole
from restitution._internal.files import FILM, path_for, whole_file
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.drop.recorded import pull
from restitution.drop.trajectory import trajectory
from restitution.figures.scene import _solid as solid
from restitution.figures.scene import _vectors as draw
from restitution.figures.scene._impact import Impact, Sideview
from restitution.figures.style import COLUMN, Style, colors, ink, panels, points, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_DURATION = 60
"""Of a picture, in ms; in GIF whole hundredths of a second."""
RATE = 1000 / _DURATION
"""Pictures per second."""
_HIGHEST = 3.2
"""Beyond so many reaches of the body above the plane a flight is not shown."""
_FLIGHT, _NEAR, _STILL = 1.1, 1.0, 1.6
"""Seconds of a film for a flight, for the slow motion on either side of an impact, and for the impact."""
_CLOSE = 0.3
"""Of a reach: how far the body moves in the slow motion on either side."""
_PIXELS_PER_INCH = 200
"""Twice those of a screen, for fine ones: a notebook shows films at half their size."""
_SWATCH = 40
"""Pixels of a side of the squares from which a palette takes the colours of a style."""
_HEIGHT = 3.0
"""Of a picture in a journal, in inches."""


@dataclass(frozen=True)
class Frame:
    """Contents of one picture of a film."""

    time: float  # s since release
    slowed: float  # film time over time; infinite while the film stands still
    impact: int | None  # index of the impact that the picture stands still at
    before: int  # how many of the film's impacts have happened


class Film:
    """A film of a body and its impacts, from `animate`: `save` writes it, and a notebook shows it.

    Attributes
    ----------
    frames : int
        How many pictures it has, one every 60 ms.
    times : ndarray, shape (frames,)
        Time since release that each of them shows, in s.

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.simulate(
    ...     rs.Dumbbell(radius=3e-3, separation=6e-3), rs.TangentialRestitution(normal=0.9), particles=1,
    ...     impacts=4, record="state")
    >>> film = rs.figures.animate(data, impacts=2)
    >>> figure = film.picture(0)
    """

    def __init__(self, view: Sideview, data: xr.Dataset, particle: int, style: Style | None) -> None:
        self._view, self._style = view, style
        self._frames = _schedule(view, data, particle)
        self.times = np.array([one.time for one in self._frames])
        self._motion = trajectory(data, int(data["particle"][particle]), self.times)
        position = self._motion["position"].to_numpy() @ view.frame.T
        if np.abs(position).max() > FARTHEST:
            text = ": the body flies too far to be drawn; must be the states and settings of a run"
            raise ParameterError(Problem("data", text))
        self._centres: FloatArray = 1e3 * position[:, :2]

    @property
    def frames(self) -> int:
        """Number of pictures of the film, one every 60 ms."""
        return len(self._frames)

    def __repr__(self) -> str:
        return f"Film({self.frames} pictures, {self.frames / RATE:.1f} s)"

    def centre(self, frame: int) -> FloatArray:
        """Return where the centre of mass is drawn in a picture: right and up, in mm."""
        return np.array(self._centres[self._number(frame)])

    def picture(self, frame: int) -> Figure:
        """Draw one of the pictures as a figure.

        Parameters
        ----------
        frame : int
            Its number.
        """
        return self._draw(self._number(frame), style=self._style)

    def _number(self, frame: int) -> int:
        return whole("frame", frame, 0, self.frames - 1)

    def save(self, name: str | Path) -> Path:
        """Write the film; a file of this name is replaced, whole or not at all.

        Parameters
        ----------
        name : str or Path
            Ends in .gif, or in .mp4, which takes the program ffmpeg.

        Returns
        -------
        Path

        Raises
        ------
        ValueError
            If the name ends otherwise.
        RuntimeError
            If ffmpeg is needed and not installed.
        """
        path = path_for("name", name, FILM)
        if path.suffix.lower() not in (".gif", ".mp4"):
            raise ParameterError(wrong("name", str(path), f"the name of {FILM}"))
        video = path.suffix.lower() == ".mp4"
        if video and not FFMpegWriter.isAvailable():
            text = (
                f"{path}: .mp4 takes the program ffmpeg, which is not installed: "
                "get it from your system's packages or ffmpeg.org, or save the film as .gif"
            )
            raise RuntimeError(text)
        with whole_file(path, replace=True) as draft:
            if video:
                self._save_mp4(draft)
            else:
                draft.write_bytes(self._gif())
        return path

    def _repr_html_(self) -> str:
        import base64

        width = round(0.5 * _PIXELS_PER_INCH * self.picture(0).get_size_inches()[0])
        content = base64.b64encode(self._gif()).decode()
        return f'<img alt="{self!r}" width="{width}" src="data:image/gif;base64,{content}">'

    def _images(self) -> list[Image.Image]:
        images: list[Image.Image] = []
        for number, one in enumerate(self._frames):
            again = number > 0 and one == self._frames[number - 1]
            images.append(images[-1] if again else self._image(number, style=self._style))
        return images

    @styled
    def _image(self, frame: int, *, style: Style | None) -> Image.Image:
        figure = self._draw(frame, style=style)
        figure.set_dpi(_PIXELS_PER_INCH)
        canvas: Any = FigureCanvasAgg(figure)
        canvas.draw()
        return Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")

    def _gif(self) -> bytes:
        images = self._images()
        still = max(k for k, one in enumerate(self._frames) if one.impact is not None)
        palette = self._palette([images[0], images[still], images[-1]], style=self._style)
        alike = [list(some) for _, some in groupby(images, key=id)]
        shown = [some[0].quantize(palette=palette, dither=Image.Dither.NONE) for some in alike]
        durations = [_DURATION * len(some) for some in alike]
        content = io.BytesIO()
        shown[0].save(
            content, "GIF", save_all=True, append_images=shown[1:], duration=durations, loop=0, optimize=True
        )
        return content.getvalue()

    @styled
    def _palette(self, chosen: list[Image.Image], *, style: Style | None) -> Image.Image:
        """Choose the colours of all pictures: from some of them, and those of the arrows."""
        chosen = [one.reduce(2) for one in chosen]
        width, height = chosen[0].size
        sheet = Image.new("RGB", (width, height * len(chosen) + _SWATCH))
        for k, one in enumerate(chosen):
            sheet.paste(one, (0, k * height))
        for k, color in enumerate(colors()):  # or those of small things would be lost
            sheet.paste(color, (k * _SWATCH, height * len(chosen), (k + 1) * _SWATCH, sheet.height))
        return sheet.quantize(96, dither=Image.Dither.NONE)

    def _save_mp4(self, path: Path) -> None:
        import subprocess

        images = self._images()
        width, height = (2 * (n // 2) for n in images[0].size)  # the codec takes even numbers
        command = [
            mpl.rcParams["animation.ffmpeg_path"],
            *("-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"),
            *("-s", f"{width}x{height}", "-r", f"{RATE:.6g}", "-i", "-"),
            *("-c:v", "libx264", "-pix_fmt", "yuv420p", "-f", "mp4", str(path)),
        ]
        content = b"".join(one.crop((0, 0, width, height)).tobytes() for one in images)
        subprocess.run(command, input=content, check=True)

    @styled
    def _draw(self, frame: int, *, style: Style | None) -> Figure:
        view, one = self._view, self._frames[frame]
        figure, [[axes]] = panels(COLUMN, _HEIGHT)
        figure.set_layout_engine("none")
        axes.set_position((0.02, 0.02, 0.96, 0.80))
        far, centre = view.reach, self._centres[frame]
        half, top = self._window()
        draw.stage(axes, centre[0], half, 0.5 * far, (-far, top))
        draw.scale_bar(axes, centre[0] - 0.95 * half, -0.75 * far, 2.0 * far)
        axes.plot(
            *self._centres[: frame + 1].T, color=ink(0.45), linewidth=points(0.8), linestyle=":", zorder=1.5
        )
        state = self._motion.isel(time=frame)
        axis = view.frame @ state["axis"].to_numpy()
        place = view.frame @ state["position"].to_numpy()
        solid.put(axes, view.body, solid.picture(view.body, axis), place)
        velocity = view.frame @ state["velocity"].to_numpy()
        rotation = float((view.frame @ state["angular_velocity"].to_numpy())[2])
        done = None
        if one.impact is None:
            draw.marks(axes, centre, None)
        else:
            hit, after = view.impacts[one.impact], one.before > one.impact
            draw.marks(axes, centre, 1e3 * hit.contact)
            velocity, rotation = hit.velocity[after], float(hit.rotation[after][2])
            done = hit if after else None
        length, angle = view.scales
        draw.turn(axes, centre, draw.ARC * far, angle * rotation, draw.ROTATION)
        draw.arrow(axes, centre, 1e3 * length * velocity[:2], draw.VELOCITY)
        if done is not None:
            draw.arrow(axes, 1e3 * done.contact[:2], 1e3 * length * done.impulse[:2], draw.IMPULSE)
        self._words(figure, one, velocity, rotation, done)
        return figure

    def _words(self, figure: Figure, one: Frame, v: FloatArray, w: float, hit: Impact | None) -> None:
        """Write the key with its values, what the impact did, and how slow the film is."""
        past = hit or (self._view.impacts[one.before - 1] if one.before else None)
        push = "" if hit is None else f"{np.linalg.norm(hit.impulse):.2f} m/s"
        keys = (
            (rf"$v$ = {np.linalg.norm(v):.2f} m/s", draw.VELOCITY, 0.03, "left"),
            (rf"$\omega$ = {abs(w):.0f} rad/s", draw.ROTATION, 0.47, "center"),
            (rf"$P/m$ = {push}" if push else "", draw.IMPULSE, 0.97, "right"),
        )
        for text, number, x, side in keys:
            figure.text(x, 0.985, text, color=colors()[number], ha=side, va="top", fontsize="medium")
        if past is not None:
            text = f"$\\varepsilon$ = {past.restitution:.2f} at $v_G^n$ = {past.speed:.2f} m/s"
            text = text.replace("= -", "= \N{MINUS SIGN}")
            figure.text(0.03, 0.915, text, ha="left", va="top", fontsize="x-large")
        slowed = float(f"{one.slowed:.2g}")
        pace = "stands still" if np.isinf(slowed) else f"slowed {slowed:.0f} times"
        figure.text(0.97, 0.035, pace, color=ink(0.65), ha="right", va="bottom", fontsize="small")

    def _window(self) -> tuple[float, float]:
        """Return how far the pictures reach to either side of the centre of mass, and up, in mm."""
        far = self._view.reach
        top = float(self._centres[:, 1].max()) + 1.4 * far
        return 0.5 * (top + far) * (COLUMN * 0.96) / (_HEIGHT * 0.80), top


@styled
def animate(
    data: xr.Dataset, particle: int = 0, impacts: int | tuple[int, int] = 0, *, style: Style | None = None
) -> Film:
    """Make a film of a body from the side, in slow motion around its impacts.

    It shows the body over the plane, the point of contact, the velocity v of the centre of mass, the angular
    velocity ω and, at an impact, the impulse per mass P/m on the scale of v, each with its value, and ε. The
    motion is that of `restitution.trajectory`: nothing is interpolated.

    Parameters
    ----------
    data : xarray.Dataset
        Impacts from `restitution.simulate` with ``record="state"``.
    particle : int
        Which one.
    impacts : int or (int, int)
        The impact, or the first and the last one, from 0 on. The film ends with the flight after it, or at
        the impact where it is the last one that was recorded.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Returns
    -------
    Film
        Its method ``save`` writes .gif, or .mp4 with the program ffmpeg; a notebook shows it.

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.simulate(
    ...     rs.Dumbbell(radius=3e-3, separation=6e-3), rs.TangentialRestitution(normal=0.9), particles=1,
    ...     impacts=4, record="state")
    >>> film = rs.figures.animate(data, particle=0, impacts=(1, 2))
    >>> path = film.save("bounce.gif")  # doctest: +SKIP
    """
    allowed = "the number of an impact, or of a first and a last one"
    try:
        ends = impacts if isinstance(impacts, tuple | list) else (impacts, impacts)
        first, last = (whole("impacts", one, 0) for one in ends)
    except ValueError:
        raise ParameterError(wrong("impacts", impacts, allowed)) from None
    return Film(Sideview.of(data, particle, first, last, name="impacts"), data, particle, style)


def _schedule(view: Sideview, data: xr.Dataset, particle: int) -> tuple[Frame, ...]:
    """Choose the time of each picture: flights fast, the neighbourhood of an impact slow, impacts at rest."""
    times, impacts = data["time"].to_numpy()[particle], view.impacts
    first = int(np.searchsorted(times, impacts[0].time, side="left"))
    begin = times[first - 1] if first else 0.0
    last = first + len(impacts)
    end = times[last] if last < times.size and np.isfinite(times[last]) else impacts[-1].time
    far = view.body.compiled.farthest()
    gravity, incline = pull("data", data)
    gravity *= np.cos(incline)
    one, other = impacts[0], impacts[-1]
    begin = max(begin, one.time - _duration(-float(one.velocity[0][1]), float(one.centre[1]), gravity, far))
    end = min(end, other.time + _duration(float(other.velocity[1][1]), float(other.centre[1]), gravity, far))
    frames: list[Frame] = []
    still = round(RATE * _STILL)
    for k, one in enumerate(impacts):
        frames += _flight(begin, one.time, impacts[k - 1] if k else None, one, k, far)
        frames += [Frame(one.time, np.inf, k, k)] * (still // 3) + [Frame(one.time, np.inf, k, k + 1)] * still
        begin = one.time
    return (*frames, *_flight(begin, end, other, None, len(impacts), far))


def _duration(speed: float, height: float, gravity: float, far: float) -> float:
    """Return the time from an impact to the top, or until the centre of mass is too high to be seen."""
    if speed <= 0.0:
        return np.inf
    room = max(_HIGHEST * far - height, 0.0)
    with np.errstate(over="ignore"):
        climbs = speed**2 - 2.0 * gravity * room
    return (speed - np.sqrt(climbs)) / gravity if climbs > 0.0 else speed / gravity


def _near(speed: float, far: float, whole_time: float) -> float:
    return min(_CLOSE * far / max(speed, 1e-300), 0.25 * whole_time)


def _pieces(begin: float, end: float, seconds: float, before: int) -> list[Frame]:
    number = max(1, round(RATE * seconds))
    times = begin + (end - begin) * np.arange(number) / number
    slowed = seconds / (end - begin) if end > begin else np.inf
    return [Frame(float(t), slowed, None, before) for t in times]


def _flight(
    begin: float, end: float, earlier: Impact | None, later: Impact | None, before: int, far: float
) -> list[Frame]:
    """Frames of a flight, slow where it begins or ends with an impact."""
    if end <= begin:
        return []
    left, close = begin, end
    if earlier is not None:
        left += _near(float(np.linalg.norm(earlier.velocity[1])), far, end - begin)
    if later is not None:
        close -= _near(float(np.linalg.norm(later.velocity[0])), far, end - begin)
    frames = [] if earlier is None else _pieces(begin, left, _NEAR, before)
    frames += _pieces(left, close, _FLIGHT, before)
    return frames if later is None else frames + _pieces(close, end, _NEAR, before)
