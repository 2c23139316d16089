"""The machinery of papers, by a paper made up for it: one run, one figure, one claim, one misprint.

The report is one file that needs no other, holds all that was judged and drawn, and no foreign text as HTML.
"""

import re
from base64 import b64decode
from dataclasses import dataclass, replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
import xarray as xr
from matplotlib.figure import Figure

import restitution as rs
from restitution import figures as fg
from restitution.figures.report import Section, prose
from restitution.papers import redraw as machinery
from restitution.papers.claims import Claims, Finding, Measurement, verdict
from restitution.papers.figures import Caption, PaperFigure, recorded
from restitution.papers.paper import Check, Misprint, Paper
from restitution.papers.report import measured
from restitution.papers.runs import Runner, Runs
from restitution.papers.settings import Settings, chosen, stated

VOID = {"meta", "img", "br", "hr", "link", "input"}
NASTY = '<script>alert("ε") & co</script>'
DOI = "10.1000/made.up"


@dataclass(frozen=True)
class Few(Settings):
    """All that the made-up paper states, and what it does not."""

    normal: float = stated(0.9, "1", "normal restitution")
    height: float = chosen(0.1, "m", NASTY)


@dataclass(frozen=True, eq=False)
class One(Runs):
    """Its run."""

    main: xr.Dataset


def simulate(s: Few, impacts: int, runner: Runner) -> One:
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=s.normal)
    main = runner.record("main", body, law, particles=impacts // 10, impacts=10, release_height=s.height)
    return One(runner.seed, impacts, main)


def draw(drawn: xr.Dataset) -> Figure:
    figure, [[axes]] = fg.panels(fg.COLUMN, 2.0)
    axes.plot(drawn["impact_velocity"].to_numpy().ravel(), drawn["restitution"].to_numpy().ravel(), ".")
    return figure


CLAIMS: Claims[One, Few] = Claims()


@CLAIMS.add("below-one", NASTY, "Sec. I")
def below_one(runs: One, settings: Few) -> Finding:
    mean = float(runs.main["restitution"].mean())
    numbers = (Measurement("mean ε", mean, 0.0012, at="0.4 m/s"), Measurement("count", 1234567.0))
    return Finding(numbers, verdict(mean < 1, mean < 2), "Holds if the mean is below 1.", "It is below.")


FIGURE: PaperFigure[One, Few] = PaperFigure(
    "figure-1",
    NASTY,
    NASTY,
    "Points.",
    lambda runs, s: runs.main.assign_attrs(recorded(runs.main)),
    draw,
    lambda drawn, s: Caption(f"ε against v_G^n. {NASTY}", [f"ε_n = {s.normal:g}"], [f"h = {s.height:g} m"]),
    stop=2,
)
PAPER = Paper(
    title="A made-up paper, redrawn",
    reference=f"A. Nobody, DOI {DOI}",
    command="restitution made-up --out made-up",
    settings=Few(),
    least=100,
    usual=200,
    number=1,
    simulate=simulate,
    about=lambda runs: "One figure.",
    columns={"height (mm)": lambda run: f"{1e3 * run['release_height']:g}"},
    figures=[FIGURE],
    claims=CLAIMS,
    misprints=[Misprint("1", "caveat", "a", "b", "By algebra.", "one", lambda: Check(3.0, 1.0, 1.0))],
    sections=lambda runs, settings: [
        Section("own", "Of its own", ["<p>Only here, as Eq. 1 of “Of its own”.</p>"])
    ],
)


class Page(HTMLParser):
    """Tags in order, attributes, and visible text; fails where a tag is not closed by its own."""

    def __init__(self, source: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.visible = ""
        self.feed(source)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag
        self.visible += " " if tag in ("td", "th") else ""

    def handle_data(self, data: str) -> None:
        if "style" not in self.open:
            self.visible += data

    def of(self, attribute: str) -> list[str]:
        """All values of an attribute."""
        return [str(attrs[attribute]) for _, attrs in self.tags if attribute in attrs]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the machinery makes of the paper, with a page in place of the explorer."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(machinery, "page", lambda: "the explorer")
        out = tmp_path_factory.mktemp("made-up")
        return machinery.redraw(PAPER, out, 200, seed=5, progress=False).parent


@pytest.fixture(scope="module")
def source(folder: Path) -> str:
    return (folder / "report.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def text(source: str) -> str:
    return " ".join(Page(source).visible.split())


def test_a_paper_gives_only_what_is_its_own(folder: Path, text: str) -> None:
    """Figure with data and caption, claim with numbers, misprint, settings, run, command and reference."""
    files = [f"figure-1.{kind}" for kind in ("nc", "pdf", "png", "txt")]
    assert sorted(file.name for file in folder.iterdir()) == ["explorer.html", *files, "report.html"]
    caption = (folder / "figure-1.txt").read_text(encoding="utf-8").strip()
    with xr.open_dataset(folder / "figure-1.nc") as data:
        assert data.attrs["caption"] == caption
        assert "Stated in the paper: ε_n = 0.9. Our choice: h = 0.1 m. Run: 20 particles, each" in caption
        assert f"seed {data.attrs['seeds']}; restitution {rs.__version__}." in caption
        assert text.count(str(data.attrs["seeds"])) == 2  # of the run, and in the caption
    assert "recorded, for" not in caption  # all impacts are
    for words in (
        "Parameters and run Stated in the paper: ε",
        *("One figure. Each of the 1 quantitative claims", "1 holds 0 hold in part 0 fail", "Only here, as"),
        *(
            "± 0.0012",
            "1 234 567",
            "Rule: Holds if the mean is below 1.",
            "What to see: Points.",
            "Eq. 1",
            "By algebra.",
        ),
        *("normal restitution 0.9 paper", "0.1 m ours", "main 100 20", "version " + rs.__version__),
        "restitution made-up --out made-up --impacts 200 --seed 5",
    ):
        assert words in text, words
    assert text.count("It is below.") == 2  # in the table and with its numbers


def test_the_report_needs_no_other_file(source: str, folder: Path) -> None:
    """No script, no style sheet, the picture embedded; links elsewhere are the DOI and the page beside it."""
    page = Page(source)
    assert not {"script", "link", "iframe", "object", "form"} & {tag for tag, _ in page.tags}
    assert '<a href="#own">Eq. 1 of “Of its own”</a>' in source
    elsewhere = {target for target in page.of("href") if not target.startswith("#")}
    assert elsewhere == {f"https://doi.org/{DOI}", "explorer.html#stop=2"}
    embedded = [b64decode(picture.removeprefix("data:image/png;base64,")) for picture in page.of("src")]
    assert embedded == [(folder / "figure-1.png").read_bytes()]
    assert "http" not in source.replace("https://doi.org/", "")
    assert not re.search(r"url\(|@import", source)


def test_it_is_well_formed(source: str) -> None:
    """Tags close in order, every anchor exists once, and each picture and table can be read aloud."""
    assert source.startswith("<!DOCTYPE html>")
    page = Page(source)
    anchors = page.of("id")
    assert len(set(anchors)) == len(anchors)
    assert {target[1:] for target in page.of("href") if target.startswith("#")} <= set(anchors)
    assert page.of("alt") == [f"{NASTY}. Points."]
    tags = [tag for tag, _ in page.tags]
    assert tags.count("caption") == tags.count("table")
    assert (
        tags.count("details") == tags.count("table") - 1 + 1
    )  # but the claims; the parameters of the figure
    assert tags.count("section") == source.count('<a href="#top">Back to the top</a>')
    assert [attrs for tag, attrs in page.tags if tag == "html"] == [{"lang": "en"}]
    assert "width=device-width" in source


def test_foreign_text_stays_text(source: str) -> None:
    """A quote, a title, a caption and a setting that look like HTML are shown as they are."""
    assert "<script" not in source
    assert Page(source).visible.count('alert("ε") & co') == 5  # quoted twice


def test_what_cannot_be_is_refused_before_the_work(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    cases: list[tuple[dict[str, Any], str]] = [
        ({"impacts": 99}, r"impacts = 99: must be a whole number in \[100, "),
        ({"impacts": 100, "seed": -1}, "seed = -1: "),
        ({"impacts": 100, "out": tmp_path / "file"}, "out cannot be written to"),
    ]
    for given, wrong in cases:
        usual: dict[str, Any] = {"out": tmp_path / "new", "progress": False}
        with pytest.raises((ValueError, OSError), match=wrong):
            machinery.redraw(PAPER, **(usual | given))
    assert [file.name for file in tmp_path.iterdir()] == ["file"]


def test_a_run_that_fails_leaves_nothing(tmp_path: Path) -> None:
    def fail(settings: Few, impacts: int, runner: Runner) -> One:
        raise RuntimeError

    with pytest.raises(RuntimeError):
        machinery.redraw(replace(PAPER, simulate=fail), tmp_path / "new", 100, progress=False)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("plain", "marked"),
    [
        ("E_rot/E_tot", "E<sub>rot</sub>/E<sub>tot</sub>"),
        ("v_G^n", "v<sub>G</sub><sup>n</sup>"),
        ("p_ε(s)", "p<sub>ε</sub>(s)"),
        ("[Âr]_z", "[Âr]<sub>z</sub>"),
        ("exp(−|x|^k)", "exp(−\u2060|x|<sup>k</sup>)"),
        ("from -0.5 to 2-5", "from −0.5 to 2-5"),
        ("a < b & c", "a &lt; b &amp; c"),
        ("speed_below_threshold", "speed_below_threshold"),
        ("at 0.4 m/s, 0.10 ± 0.02 %", "at 0.4\u00a0m/s, 0.10\u00a0±\u00a00.02\u00a0%"),
        ("ε > 1 in 1 041 915", "ε\u00a0&gt;\u00a01 in 1\u202f041\u202f915"),
        ("Sec. III, Fig. 2", "Sec.\u00a0III, Fig.\u00a02"),
        ("exp[−(x)]", "exp[−\u2060(x)]"),
        ("DOI 10.1103/X.9.", '<a href="https://doi.org/10.1103/X.9">doi:10.1103/X.9</a>.'),
    ],
)
def test_formulas(plain: str, marked: str) -> None:
    assert prose(plain) == marked


def test_numbers_under_the_same_conditions_share_a_table() -> None:
    """Two quantities at two speeds make one table of two rows; a number without condition stands alone."""
    speeds = ("0.1 m/s", "0.2 m/s")
    numbers = [Measurement(name, 1.0, 0.1, "J", at) for name in ("a", "b") for at in speeds]
    page = Page(measured([*numbers, Measurement("c", 7.0)]))
    tags = [tag for tag, _ in page.tags]
    assert tags.count("table") == 2
    assert tags.count("tr") == 3 + 1
    assert " ".join(page.visible.split()).count("1.00 ± 0.10") == 4
    assert "a (J)" in page.visible


def test_many_conditions_go_down() -> None:
    page = Page(measured([Measurement("σ", float(k), at=f"impact {k}") for k in range(9)]))
    assert [tag for tag, _ in page.tags].count("tr") == 10
