"""The page inside a notebook: Jupyter, marimo, VS Code, through anywidget."""

from typing import Any

import numpy as np
import xarray as xr

from restitution import bodies, laws
from restitution._internal.arrays import whole
from restitution._internal.parameters import ParameterError, renamed, wrong
from restitution.drop.run import Run
from restitution.explorer._page import NUMBERS, link, page

# In a frame of its own, the page's style and keys do not meet the notebook's. A Blob's address can carry #.
_ESM = """
export default {
  render({ model, el }) {
    const url = URL.createObjectURL(new Blob([model.get("page")], { type: "text/html" }));
    const frame = document.createElement("iframe");
    frame.title = "Restitution explorer";
    frame.style = `width: 100%; height: ${model.get("height")}px; border: 0`;
    frame.src = `${url}#${model.get("fragment")}`;
    el.append(frame);
    return () => URL.revokeObjectURL(url);
  },
};
"""


def explore(data: "xr.Dataset", *, height: int = 900) -> Any:
    """Show a run in the explorer, inside a notebook.

    The page computes the run again, in the browser, to the same bits; an angle that was given comes back from
    its sine and cosine, and may differ in its last digit.

    Parameters
    ----------
    data : xarray.Dataset
        From `restitution.simulate`: what counts is how it was made, which is in its attributes.
    height : int
        Height of the frame in pixels, > 0.

    Returns
    -------
    anywidget.AnyWidget
        Shows itself as the last value of a cell.

    Raises
    ------
    ValueError
        If `data` is not from `simulate`, or of a run that the page cannot show; the message says what of it.
    ImportError
        If anywidget is not installed: ``pip install 'restitution[notebook]'``.

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    >>> data = rs.simulate(body, rs.Frictionless(normal=0.9), particles=10, impacts=20)
    >>> rs.explore(data)  # doctest: +SKIP
    """
    fragment = link(_run_of(data))
    height = whole("height", height, 1, 100_000)
    try:
        import anywidget
        import traitlets
    except ImportError:
        raise ImportError("explore needs anywidget: pip install 'restitution[notebook]'") from None

    class Explorer(anywidget.AnyWidget):
        _esm = _ESM
        page = traitlets.Unicode().tag(sync=True)
        fragment = traitlets.Unicode().tag(sync=True)
        height = traitlets.Int().tag(sync=True)

    return Explorer(page=page(), fragment=fragment, height=height)


def _run_of(data: xr.Dataset) -> Run:
    """Make the run again from the attributes of its Dataset."""
    if not isinstance(data, xr.Dataset):
        raise ParameterError(wrong("data", data, "a Dataset from restitution.simulate"))
    attributes = dict(data.attrs)
    try:
        with renamed(lambda name: f"data.{name}"):
            body_type = getattr(bodies, str(attributes["body"]))
            if body_type is bodies.Rough:
                raise ValueError("data.body = Rough: of rough bodies the explorer shows RoughSphere only")
            law_type = getattr(laws, str(attributes["law"]))
            body = bodies.of_attributes(body_type, _tables(attributes))
            law = law_type(**{name: attributes[name] for name in law_type.model_fields})
            orientation = attributes["orientation"]
            if orientation == "given":
                if "release_angle" not in data:
                    raise ValueError("data.orientation = given: the explorer shows this of an angle only")
                orientation = data["release_angle"]
            spin = attributes["spin"]
            if isinstance(spin, str):
                text = "the explorer shows this only if it is the same for all"
                raise ValueError(f"data.spin = {spin}: {text}")
            names = (*NUMBERS, "particles", "impacts", "release_velocity", "seed")
            others = {name: attributes[name] for name in names}
            return Run(body=body, law=law, orientation=orientation, spin=spin, **others)
    except (KeyError, AttributeError) as error:
        raise ValueError(
            f"data: must be a Dataset from restitution.simulate, with the numbers of its law: {error}"
        ) from None


def _tables(attributes: dict[str, Any]) -> dict[str, Any]:
    """Give tables their rows back, and asperities their seed under the name that it has in the body."""
    found = dict(attributes)
    for name, width in (("spheres", 4), ("points", 3), ("profile", 2), ("vertices", 3), ("triangles", 3)):
        if name in found:
            found[name] = np.reshape(found[name], (-1, width))
    if np.size(found.get("inertia", "")) == 9:
        found["inertia"] = np.reshape(found["inertia"], (3, 3))
    if "asperity_seed" in found:
        found["seed"] = found["asperity_seed"]
    return found
