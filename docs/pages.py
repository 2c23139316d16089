"""Tables and figures of the pages: `python docs/pages.py energy` makes those of docs/energy.md anew.

What is made stands in its page between comments, one with the command and one with a stamp, each table in its
own place:

    <!-- python docs/pages.py energy -->
    ...
    <!-- stamp 0123456789ab -->

The stamp is a digest of the tables, of the figures, of the size of the run, and of what the same code
prints in a small run. `tests/project/test_pages.py` makes the small runs again: where the code, the engine,
a table or a figure has changed since, the page is stale, and the test says which command sets it right.
Results do not depend on the machine, so neither does the stamp.
"""

import argparse
import hashlib
import re
import sys
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import Any

import matplotlib

from restitution.figures.style import SITE

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs" / "images"
_BLOCK = "<!-- python docs/pages.py {name} -->\n(.*?)<!-- stamp (.*?) -->"


def _script(name: str) -> Any:
    """Import a script of examples/, or a module of benchmarks/."""
    for folder in (ROOT / "examples", ROOT):
        if str(folder) not in sys.path:
            sys.path.insert(0, str(folder))
    return import_module(name)


def _draw(script: Any, found: Any, images: Path | None, name: str) -> None:
    """Draw the figure of a script, where there is a folder for it, for every ground of the site."""
    if images is not None:
        for style in SITE:
            script.draw(found, style=style).savefig(images / f"{name}{style[4:]}.png", dpi=200)


def energy(impacts: int, images: Path | None) -> str:
    """Make the table and the figure of `restitution laws`."""
    from restitution.figures import laws

    data = laws.measure(impacts, 1)
    _draw(laws, data, images, "laws")
    return laws.table(data)


def fits(particles: int, images: Path | None) -> str:
    """Make the tables of examples/fits.py of other ensembles and of other bodies."""
    script = _script("fits")
    return f"{script.catalogue(particles)}\n\n{script.repeat(particles, 14 if images else 2)}"


def locking(particles: int, images: Path | None) -> str:
    """Make the table and the figure of examples/locking.py."""
    script = _script("locking")
    if images is not None:
        script.draw(images / "locking.png")
        return str(script.table(particles))
    return str(script.table(particles, seeds=2))


def imperfections(particles: int, images: Path | None) -> str:
    """Make the table and the figure of examples/imperfections.py."""
    script = _script("imperfections")
    found = script.measure(particles, 12 if images else 2)
    _draw(script, found, images, "imperfections")
    return str(script.table(found))


def _parameters(what: str, table: list[dict[str, Any]]) -> str:
    """Tell what the core's table says of the parameters of every body, law or material."""
    rows = [f"| {what} | | parameter | | unit | allowed | default |", "|---|---|---|---|---|---|---|"]
    for entry in table:
        head = f"`{entry['name']}` | {entry['text']}"
        for about in entry["parameters"] or [None]:
            rows.append(f"| {head} | {_cells(about) if about else ' | | | |'} |")
            head = " | "
    return "\n".join(rows)


def _cells(about: dict[str, Any]) -> str:
    if about["type"] in ("name", "choice"):
        allowed = ", ".join(f"`{name}`" for name in about["names"])
    else:
        template = import_module("restitution.cli._template")
        allowed = template.allowed(about).replace(">=", "≥").removeprefix("in ")
    unit = {None: "", "1": "", "kg m-3": "kg/m³", "m s-1": "m/s", "kg m2": "kg m²"}.get(
        about["unit"], about["unit"]
    )
    return f"`{about['name']}` | {about['text']} | {unit} | {allowed} | {about.get('default', '')}"


def names(size: int, images: Path | None) -> str:
    """List the bodies, laws and materials of the core's table."""
    core = import_module("restitution._core")
    rows = [f"| `{one['name']}` | {one['text']} |" for one in (*core.BODIES, *core.LAWS, *core.MATERIALS)]
    return "\n".join(["| name | what |", "|---|---|", *rows])


def api(size: int, images: Path | None) -> str:
    """Make the directives from which the pages of bodies, and of laws and materials, are made."""
    core = import_module("restitution._core")
    tables = (core.BODIES, (*core.LAWS, *core.MATERIALS))
    lists = (["   " + one["name"] for one in table] for table in tables)
    return "\n\n".join("\n".join([_DIRECTIVE, *sorted(names), "```"]) for names in lists)


_DIRECTIVE = """```{eval-rst}
.. currentmodule:: restitution

.. autosummary::
   :toctree: generated
"""


def golf(drops: int, images: Path | None) -> str:
    """Make the table of the bodies' parameters, and the table and the figure of examples/golf.py."""
    script, core = _script("golf"), import_module("restitution._core")
    if images is not None:
        script.draw(images / "golf.png")
    return f"{_parameters('body', core.BODIES)}\n\n{script.table()}"


def laws(contacts: int, images: Path | None) -> str:
    """Make the tables of the parameters of laws and materials, and that of benchmarks/impulse.py."""
    core = import_module("restitution._core")
    impulse = _script("benchmarks.impulse").table()
    return "\n\n".join([_parameters("law", core.LAWS), impulse, _parameters("material", core.MATERIALS)])


def gas(particles: int, images: Path | None) -> str:
    """Make the tables and figures of `restitution gas-figures`, and its claims with their verdicts."""
    gases, prose = (
        import_module("restitution.papers.gases"),
        import_module("restitution.figures.report").prose,
    )
    paper = gases.PAPER
    settings = replace(paper.settings, share=1.0 if images else 0.02)
    found = paper.simulate(settings, particles, import_module("restitution.papers.runs").Runner(1))
    for figure, name in zip(paper.figures, GASES, strict=True):
        _draw(figure, figure.reduce(found, settings), images, name)
    tables = [(heads, rows) for _, heads, rows in gases.tables(found, settings)]
    said = [
        (f"“{claim.quote}” {claim.where}", claim.finding.why, claim.finding.verdict)
        for claim in paper.claims.judge(found, settings)
    ]
    tables.append((("statement", "here", "verdict"), said))

    def line(cells: tuple[str, ...]) -> str:
        return f"| {' | '.join(prose(cell).replace('|', '&#124;') for cell in cells)} |"

    return "\n\n".join(
        "\n".join([line(heads), "|---" * len(heads) + "|", *map(line, rows)]) for heads, rows in tables
    )


GASES = ("gas", "gas_ratios", "gas_of_spheres", "gas_friction")
"""Figures of the page of gases."""


def pairs(encounters: int, images: Path | None) -> str:
    """Make the tables and the figure of examples/pairs.py."""
    script = _script("pairs")
    found = script.measure(encounters)
    _draw(script, found, images, "pairs")
    return str(script.table(found))


def dice(particles: int, images: Path | None) -> str:
    """Make the table and the figure of examples/dice.py."""
    script = _script("dice")
    if images is not None:
        script.draw(images / "dice.png", particles)
    return str(script.table(particles, rows=None if images else 2))


def real_collisions(share: int, images: Path | None) -> str:
    """Make the tables and the figure of examples/real_collisions.py."""
    script = _script("real_collisions")
    if images is not None:
        script.draw(images / "real-collisions.png")
    return str(script.table(share))


def theory(percent: int, images: Path | None) -> str:
    """Make the table of benchmarks/accuracy.py."""
    return str(_script("benchmarks.accuracy").table(percent / 100, rows=None if images else 2))


@dataclass(frozen=True)
class Block:
    """The script of a page's tables and figures, and the size of its run for the page and for its stamp."""

    make: Callable[[int, Path | None], str]
    size: int
    small: int
    figures: tuple[str, ...] = ()


BLOCKS = {
    "api": Block(api, 0, 0),
    "dice": Block(dice, 1000, 5, ("dice.png",)),
    "energy": Block(energy, 10_000_000, 20_000, ("laws.png",)),
    "fits": Block(fits, 4000, 100),
    "gas": Block(gas, 10_000, 100, tuple(f"{name}.png" for name in GASES)),
    "imperfections": Block(imperfections, 100, 4, ("imperfections.png",)),
    "laws": Block(laws, 0, 0),
    "names": Block(names, 0, 0),
    "near-round": Block(locking, 5000, 100, ("locking.png",)),
    "pairs": Block(pairs, 200_000, 1000, ("pairs.png",)),
    "real-collisions": Block(real_collisions, 1, 15, ("real-collisions.png",)),
    "shapes": Block(golf, 0, 0, ("golf.png",)),
    "theory": Block(theory, 100, 1),
}
"""By the name of the page."""


def made(name: str) -> tuple[list[str], str]:
    """Return the tables that stand between the comments of a page, and its stamp."""
    text = (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
    found = re.findall(_BLOCK.format(name=name), text, re.DOTALL)
    if not found or len({stamp for _, stamp in found}) > 1:
        raise ValueError(f"docs/{name}.md needs <!-- python docs/pages.py {name} -->, with the same stamp")
    return [table.strip() for table, _ in found], found[0][1]


def stamp(name: str, tables: list[str]) -> str:
    """Digest a page's tables and figures, and what its code prints in a small run."""
    block = BLOCKS[name]
    digest = hashlib.sha256(repr((block.size, tables, block.make(block.small, None))).encode())
    for figure in block.figures:
        digest.update((IMAGES / figure).read_bytes())
    return digest.hexdigest()[:12]


def remake(name: str) -> None:
    """Make the tables and figures of a page, and write them into it."""
    block, page = BLOCKS[name], ROOT / "docs" / f"{name}.md"
    places = len(made(name)[0])  # before anything is computed
    tables = re.split(r"\n\n(?=\||```)", block.make(block.size, IMAGES).strip())
    if len(tables) != places:
        raise ValueError(f"docs/{name}.md has room for {places} tables, and there are {len(tables)}")
    print("\n\n".join(tables))
    current, rest = stamp(name, tables), iter(tables)

    def whole(_: re.Match[str]) -> str:
        return f"<!-- python docs/pages.py {name} -->\n\n{next(rest)}\n\n<!-- stamp {current} -->"

    text = page.read_text(encoding="utf-8")
    page.write_text(re.sub(_BLOCK.format(name=name), whole, text, flags=re.DOTALL), encoding="utf-8")


def main() -> None:
    """Make the pages that are asked for."""
    matplotlib.use("Agg")
    parser = argparse.ArgumentParser(description="Make tables and figures of docs/ anew.")
    parser.add_argument("names", nargs="*", choices=[[], *BLOCKS], metavar="NAME", help=", ".join(BLOCKS))
    warnings.simplefilter("ignore", import_module("restitution").EnergyWarning)
    for name in parser.parse_args().names or BLOCKS:
        print(name, flush=True)
        remake(name)


if __name__ == "__main__":
    main()
