"""Sphinx: the pages of this folder, the docstrings and the explorer as one site. `make docs` builds it."""

import os
import re
import shutil
from importlib.metadata import version as version_of
from pathlib import Path

from docutils import nodes
from PIL import Image, ImageOps
from sphinx.ext import autosummary
from sphinx.pycode import ModuleAnalyzer

HERE = Path(__file__).parent
BUILT = (
    HERE.parent / "build" / "static"
)  # what the site takes from elsewhere; nothing is loaded from other hosts
EXTRA = HERE.parent / "build" / "extra"  # the redrawn paper, in a folder of its own

project = "restitution"
author = "The restitution developers"
copyright = author
version = release = version_of("restitution")

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx_copybutton",
    "sphinx_design",
]
exclude_patterns = ["README.md"]
myst_enable_extensions = ["dollarmath", "amsmath", "deflist", "colon_fence", "attrs_block"]
myst_heading_anchors = 4
myst_dmath_double_inline = True
# the explorer, which stands beside the pages here and elsewhere in the sources
myst_url_schemes = {"http": None, "https": None, "explorer": "explorer.html#{{path}}"}

nb_execution_mode = "cache"
nb_execution_cache_path = str(HERE.parent / "build" / "notebooks")
nb_execution_raise_on_error = True
nb_execution_in_temp = True
nb_execution_timeout = 300
nb_merge_streams = True
nb_ipywidgets_js: dict[str, dict[str, str]] = {}  # no widgets, no script from elsewhere

autosummary_generate = True
# where the first sentence of a docstring does not end
autosummary.WELL_KNOWN_ABBREVIATIONS += ("Sec.", "Fig.", "Figs.", "Eq.")
autosummary.WELL_KNOWN_ABBREVIATIONS += ("J.", "Phys.", "Appl.", "Mech.", "Rev.")
CONSTANTS = ModuleAnalyzer.for_module("restitution.figures.style").find_attr_docs()
autodoc_typehints = "none"  # types and shapes are in the docstrings
autodoc_member_order = "bysource"
napoleon_use_rtype = False

# with bold Greek letters in the file itself, which it would otherwise look for elsewhere
mathjax_path = "tex-svg-full.js"
mathjax3_config = {"chtml": {"displayAlign": "left"}, "svg": {"displayAlign": "left", "displayIndent": "2em"}}

html_theme = "pydata_sphinx_theme"
html_title = f"restitution {release}"
html_extra_path = ["../python/restitution/explorer/explorer.html", str(EXTRA)]
html_static_path = ["_static", str(BUILT)]
templates_path = ["_templates"]
html_favicon = "_static/favicon.svg"
html_js_files = ["zoom.js"]
html_css_files = ["site.css"]
html_theme_options: dict[str, object] = {
    "show_prev_next": True,
    "navigation_with_keys": True,
    "navbar_end": ["explorer-link", "theme-switcher"],
    "header_links_before_dropdown": 8,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}
html_context = {"default_mode": "auto"}
html_sidebars: dict[str, list[str]] = {name: [] for name in ("index", "start", "gallery", "performance")}
html_show_sourcelink = False
html_domain_indices = False

# A site of several versions (docs/versions.py) says where it is, and which of them this one is.
if site := os.environ.get("RESTITUTION_SITE"):
    html_theme_options["switcher"] = {
        "json_url": f"{site}/versions.json",
        "version_match": os.environ["RESTITUTION_VERSION"],
    }
    html_theme_options["check_switcher"] = False
    html_theme_options["navbar_end"] = ["explorer-link", "version-switcher", "theme-switcher"]
    # The card that a link to any of its pages becomes elsewhere.
    myst_html_meta = {
        "property=og:title": "restitution: the coefficient of restitution as a distribution",
        "property=og:image": f"{site}/{os.environ['RESTITUTION_VERSION']}/_images/orbits.png",
        "name=twitter:card": "summary_large_image",
    }

# The picture on a card is a figure of one panel, or a panel of a figure, whole: its file, and its left, top,
# right and bottom as shares of the width and the height.
CARDS = {
    "theorist": ("first-impact.png", 0.505, 0.0, 1.0, 0.5),
    "experimenter": ("roundness.png", 0.0, 0.0, 1.0, 1.0),
    "dem": ("golf.png", 0.0, 0.0, 0.5, 1.0),
    "lecturer": ("impulses.png", 0.333, 0.0, 0.667, 0.5),
    "first-impact": ("first-impact.png", 0.0, 0.5, 0.5, 1.0),
    "physics": ("impact.png", 0.0, 0.0, 0.5, 1.0),
    "laws": ("laws.png", 0.265, 0.055, 0.505, 0.31),
    "energy": ("laws.png", 0.0, 0.765, 0.485, 1.0),
    "paper": ("fig2.png", 0.0, 0.0, 1.0, 1.0),
    "fits": ("fits.png", 0.668, 0.0, 1.0, 0.5),
    "theory": ("fits.png", 0.668, 0.505, 1.0, 1.0),
    "near-round": ("near_round.png", 0.0, 0.0, 0.345, 1.0),
    "real-collisions": ("real-collisions.png", 0.0, 0.5, 0.5, 1.0),
    "dice": ("dice.png", 0.0, 0.0, 0.48, 1.0),
    "rough": ("rough-bodies.png", 0.52, 0.0, 0.76, 0.48),
    "imperfections": ("imperfections.png", 0.0, 0.0, 0.455, 0.472),
    "homework": ("impulses.png", 0.667, 0.5, 1.0, 1.0),
    "gas": ("gas_of_spheres.png", 0.0, 0.115, 0.335, 1.0),
    "shapes": ("shapes.png", 0.0, 0.0, 1.0, 1.0),
    "records": ("locking.png", 0.535, 0.0, 1.0, 1.0),
    "names": ("impact.png", 0.5, 0.0, 1.0, 1.0),
    "studies": ("near_round_maps.png", 0.0, 0.0, 0.29, 0.475),
    "listening": ("clock.png", 0.0, 0.0, 1.0, 1.0),
    "roundness": ("required.png", 0.0, 0.0, 1.0, 1.0),
    "inference": ("calibration.png", 0.0, 0.0, 0.33, 1.0),
    "lab-sheet": ("lab-sheet.png", 0.0, 0.0, 1.0, 1.0),
}


def _cards() -> None:
    """Cut the pictures of the cards out of the figures, and out of those for the dark."""
    folder = BUILT.parent / "cards"
    folder.mkdir(exist_ok=True)
    for name, (figure, *edges) in CARDS.items():
        for path in {HERE / "images" / figure, _dark(HERE / "images" / figure)}:
            with Image.open(path) as drawn:
                whole = drawn.convert("RGB")
            part = whole.crop([share * whole.size[k % 2] for k, share in enumerate(edges)])
            part = ImageOps.pad(part, (640, 336), color=whole.getpixel((0, 0)))
            part.save(folder / f"{name}{'-dark' * path.stem.endswith('-dark')}.png")


def _dark(path: Path) -> Path:
    """Return the figure for a dark ground that stands beside one, or the same where there is none."""
    dark = path.with_stem(f"{path.stem}-dark")
    return dark if dark.exists() else path


BUILT.mkdir(parents=True, exist_ok=True)
EXTRA.mkdir(parents=True, exist_ok=True)
_cards()
shutil.copy(HERE.parent / "web" / "node_modules" / "mathjax" / "es5" / "tex-svg-full.js", BUILT)


def _as_written(app: object, what: str, name: str, thing: object, options: object, lines: list[str]) -> None:
    """Give a constant its own text, not that of its class; |x| is a magnitude, not a substitution."""
    if what == "data" and name.startswith("restitution.figures."):
        lines[:] = CONSTANTS["", name.rpartition(".")[2]]
    lines[:] = [
        line if line.lstrip().startswith((">>>", "...")) else line.replace("|", r"\|") for line in lines
    ]


PAGES_ABOVE = {
    "changelog": ["CHANGELOG.md"],
    "contributing": ["CONTRIBUTING.md", "ARCHITECTURE.md", "SECURITY.md", "CODE_OF_CONDUCT.md"],
}


def _as_on_the_site(app: object, name: str, source: list[str]) -> None:
    """Show pages of the folder above, whose links are from there, and the explorer where the site has it."""
    text = source[0]
    if files := PAGES_ABOVE.get(name):
        text = "\n".join((HERE.parent / file).read_text(encoding="utf-8") for file in files)
        text = text.replace("](docs/", "](")
        for here, there in PAGES_ABOVE.items():
            for file in there:
                text = text.replace(f"]({file})", f"]({here}.md)")
        if len(files) > 1:  # parts of one page
            text = "# Development\n\n" + re.sub("^#", "##", text, flags=re.MULTILINE)
    source[0] = re.sub(r"\]\(../python/restitution/explorer/explorer\.html#?", "](explorer:", text)


def _without_folders(app: object, tree: nodes.document) -> None:
    """Show a warning of a cell as it is, without the file that the cell was run from."""
    for block in tree.findall(nodes.literal_block):
        if found := re.match(r"/\S*ipykernel\S*:\d+: ", block.astext()):
            block.rawsource = block.astext()[found.end() :]
            block.children = [nodes.Text(block.rawsource)]


def _for_both_grounds(app: object, tree: nodes.document) -> None:
    """Show a figure that has one for the dark on a light ground only, and that one on a dark ground."""
    for image in list(tree.findall(nodes.image)):
        dark = _dark(HERE / image["uri"])
        if dark != HERE / image["uri"]:
            other = image.deepcopy()
            other["uri"] = image["uri"].replace(f"{dark.stem.removesuffix('-dark')}.", f"{dark.stem}.")
            other["classes"].append("only-dark")
            image["classes"].append("only-light")
            image.parent.insert(image.parent.index(image) + 1, other)


def _explorer_leads_back(app: object, error: Exception | None) -> None:
    """Give the explorer, which may stand anywhere, a link to the pages beside it."""
    page = Path(app.outdir) / "explorer.html"  # type: ignore[attr-defined]
    if error is None and page.exists():
        back = '<a href="index.html">Documentation</a>'
        page.write_text(page.read_text(encoding="utf-8").replace("<!--SITE-->", back, 1), encoding="utf-8")


def setup(app: object) -> None:
    """Let Sphinx know."""
    app.connect("build-finished", _explorer_leads_back)  # type: ignore[attr-defined]
    app.connect("source-read", _as_on_the_site)  # type: ignore[attr-defined]
    app.connect("doctree-read", _without_folders)  # type: ignore[attr-defined]
    app.connect("doctree-read", _for_both_grounds, 100)  # type: ignore[attr-defined] # before images are collected
    app.connect("autodoc-process-docstring", _as_written)  # type: ignore[attr-defined]
