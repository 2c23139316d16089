"""`restitution template`: a commented TOML file with all parameters of a run."""

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from restitution import _core
from restitution._internal.described import kebab
from restitution.cli._process import say

_NORMAL = [("normal = 0.98", "in [0, 1]; or a table [law.normal], see below")]


def _lines(
    name: str, selector: str, table: Sequence[Mapping[str, Any]], about: str, *, chosen: bool
) -> Iterator[str]:
    """Write every entry of a table of the core as a table of the file; the first one stands if `chosen`."""
    for number, entry in enumerate(table):
        mark = "" if chosen and number == 0 else "# "
        rows = [(f"[{name}]", about if number == 0 else "")]
        rows.append((f'{selector} = "{kebab(entry["name"])}"', entry["text"]))
        rows += _NORMAL if name == "law" else []
        for parameter in entry["parameters"]:
            out = "" if mark or "default" not in parameter else "# "
            text = f"{out}{parameter['name']} = {json.dumps(parameter['example'])}"
            rows.append((text, _what(parameter)))
        if entry["name"] in ("Clump", "Mesh"):
            rows.append(('# file = "stone.stl"', "instead of the tables; with scale, what its unit is in m"))
        for text, comment in rows:
            yield f"{mark + text:<34}# {comment}" if comment else mark + text
    yield ""


def interval(about: Mapping[str, Any]) -> str:
    """Write the numbers that a parameter may be: `[0, 1]` or `> 0`."""
    low, high = (f"{about[end]:g}" for end in ("low", "high"))
    if high == "inf":
        return f"{'>=' if about['closed'] else '>'} {low}"
    return f"{'[' if about['closed'] else '('}{low}, {high}]"


def allowed(about: Mapping[str, Any]) -> str:
    """Write the numbers that a parameter may be, or hold."""
    if about["type"] == "rows":
        last = f", {about['columns'][-1]} {interval(about)}" if about["low"] == 0.0 and about["unit"] else ""
        return f"{about['least']} or more rows {', '.join(about['columns'])}{last}"
    if about["low"] == float("-inf"):
        return ""
    text = interval(about)
    return text if text.startswith(">") else f"in {text}"


def _what(parameter: Mapping[str, Any]) -> str:
    unit = parameter["unit"] if parameter["unit"] not in (None, "1") else ""
    if parameter["type"] in ("name", "choice"):
        values = " or ".join(json.dumps(name) for name in parameter["names"])
    else:
        values = allowed(parameter)
    return ", ".join(filter(None, [parameter["text"], unit, values]))


_SEVERAL = 'for compare: a table [[{}]] for each, perhaps with name = "..."'
TEMPLATE = "\n".join(
    [
        "# What restitution simulate, statistics, compare and distribution read. SI units: m, kg, s, rad.",
        "# What is commented out is another choice, or a default that may be left out.",
        "",
        *_lines("body", "shape", _core.BODIES, _SEVERAL.format("body"), chosen=True),
        *_lines("law", "type", _core.LAWS, _SEVERAL.format("law"), chosen=True),
        *_lines("law.normal", "type", _core.MATERIALS, "instead of the number", chosen=False),
        """\
[run]
# particles = 1000
# impacts = 400                   # the most of each particle
# release_height = 0.06           # of the centre of mass
# gravity = 9.81
# orientation = "uniform-angle"   # or "isotropic"; or angles, one per particle: [0.1, 0.7]
# spin = [0.0, 0.0, 0.0]          # rad/s; or one per particle: [[0.0, 5.0, 0.0], ...]
# release_velocity = [0.0, 0.0, 0.0]  # m/s; z is the plane normal, x down the slope
# incline = 0.0                   # of the plane
# minimum_speed = 0.0             # a particle ends when it is slower after an impact; 0 never ends one
# seed = 1                        # in [0, 2**64)

# [run.release_height]            # instead of the number: drawn for each particle
# lowest = 0.05
# highest = 0.07
# [run.spin]                      # instead of the list: drawn for each particle
# rate = [0.0, 50.0]              # rad/s, from and to; or one number
# axis = "isotropic"              # or "horizontal", "across" the symmetry axis; or "thermal", of rms rate

[statistics]                      # for statistics and compare
velocity_bins = 120               # a number with a range, or a list of edges
velocity_range = [0.0, 1.2]       # m/s
restitution_bins = 400
restitution_range = [-1.0, 3.0]
# fraction_bins = 50              # of E_rot/E_tot
# fraction_range = [0.0, 1.0]
# counts_only = false             # true: no moments, and quicker

[distribution]                    # for distribution
# velocities = [0.04, 0.4]        # m/s, from and to
# given = "rotational_fraction"   # or "previous"
# heights_about = 0.06            # spread about this one where no release_height is given
# release_height = [0.05, 0.06]   # in equal parts from each, instead of the height of [run]
""",
    ]
)


def template() -> None:
    """Print a commented RUN.toml with all bodies, laws and options, to be edited."""
    say(TEMPLATE.removesuffix("\n"))
