"""The report: one file that needs no other, all that was judged and drawn, and no foreign text as HTML."""

import re
import struct
import zlib
from base64 import b64decode
from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path

import pytest

from restitution.figures.report import prose
from restitution.papers.glielmo2014._claims import Claim, Measurement, deviations, with_error
from restitution.papers.glielmo2014._counted import impacts_counted
from restitution.papers.glielmo2014._figures import FIGURES
from restitution.papers.glielmo2014._misprints import MISPRINTS
from restitution.papers.glielmo2014._report import write_report
from restitution.papers.glielmo2014._report._measured import measured
from restitution.papers.glielmo2014._runs import Runs, simulate_all
from restitution.papers.glielmo2014._settings import Settings

VOID = {"meta", "img", "br", "hr", "link", "input"}
NASTY = '<script>alert("ε") & co</script>'
SMALL = Settings(
    least_impacts=1000,
    impacts_per_particle=60,
    mean_impacts=50,
    bead_impacts_per_particle=60,
    sensitivity_impacts_per_particle=60,
    secondary_particles=30,
    first_particles=30,
)


@dataclass(frozen=True)
class Drawn:
    """A figure as the report needs it."""

    name: str
    title: str
    png: Path
    caption: str
    shows: str = "A grey square."
    stop: int = 2


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

    def handle_data(self, data: str) -> None:
        if "style" not in self.open:
            self.visible += data

    def of(self, attribute: str) -> list[str]:
        """All values of an attribute."""
        return [str(attrs[attribute]) for _, attrs in self.tags if attribute in attrs]


def claim(key: str, quote: str, verdict: str = "holds") -> Claim:
    numbers = (Measurement("σ", 0.0327, 0.0012, at="0.4 m/s"), Measurement("count", 1234567.0))
    return Claim(key, quote, "Sec. III", numbers, verdict, f"Rule of {key}.", f"Because of {key}.")  # type: ignore[arg-type]


CLAIMS = [
    claim("first", "ε may exceed unity"),
    claim("second", NASTY, "holds in part"),
    claim("third", "E_rot/E_tot grows", "fails"),
    claim("fourth", "and more"),
]


def picture(path: Path, width: int, height: int) -> bytes:
    """Write a small grey PNG by the format's definition; return its bytes."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    rows = b"".join(b"\0" + bytes(width) for _ in range(height))
    content = (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(rows))
        + chunk(b"IEND", b"")
    )
    path.write_bytes(content)
    return content


@pytest.fixture(scope="module")
def runs() -> Runs:
    return simulate_all(SMALL, 1000, seed=5, progress=False)


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> list[Drawn]:
    folder = tmp_path_factory.mktemp("figures")
    found = [
        Drawn("figure-2", "Fig. 2", folder / "2.png", "Caption of the second, v_G^n."),
        Drawn("figure-3", NASTY, folder / "3.png", NASTY, stop=4),
    ]
    for figure in found:
        picture(figure.png, 20, 10)
    return found


@pytest.fixture(scope="module")
def source(runs: Runs, drawn: list[Drawn], tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("report") / "report.html"
    write_report(path, drawn, CLAIMS, runs, SMALL, explorer="explorer.html")
    return path.read_text(encoding="utf-8")


def test_it_needs_no_other_file(source: str) -> None:
    """No script, no style sheet, embedded pictures; links elsewhere are DOIs and the page beside it."""
    page = Page(source)
    assert not {"script", "link", "iframe", "object", "form"} & {tag for tag, _ in page.tags}
    elsewhere = {target for target in page.of("href") if not target.startswith("#")}
    live = {"explorer.html#stop=2", "explorer.html#stop=4"}
    assert elsewhere == {"https://doi.org/10.1103/PhysRevE.90.052204", *live}
    assert all(picture.startswith("data:image/png;base64,") for picture in page.of("src"))
    assert "http" not in source.replace("https://doi.org/", "")
    assert not re.search(r"url\(|@import", source)


def test_without_the_explorer_nothing_leads_to_it(runs: Runs, drawn: list[Drawn], tmp_path: Path) -> None:
    """A package from a checkout where that page was not built still makes the report."""
    write_report(tmp_path / "report.html", drawn, CLAIMS, runs, SMALL)
    assert "explorer" not in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_every_figure_leads_to_the_stop_that_shows_it() -> None:
    """The stops of the tour name the figures of the paper that they are about."""
    tour = (Path(__file__).parents[2] / "web/src/tour.ts").read_text(encoding="utf-8")
    titles = re.findall(r'^    title: "(.*)",$', tour, re.MULTILINE)
    for figure in FIGURES:
        number = re.match(r"Fig\. (\d)", figure.title)
        assert number is not None
        title = titles[figure.stop - 1]
        assert re.match(rf"Figs?\..*\b{number[1]}\b.*:", title), (figure.title, title)


def test_it_is_well_formed(source: str) -> None:
    """Tags close in order, every anchor exists once, and each picture and table can be read aloud."""
    assert source.startswith("<!DOCTYPE html>")
    page = Page(source)
    anchors = page.of("id")
    assert len(set(anchors)) == len(anchors)
    assert {target[1:] for target in page.of("href") if target.startswith("#")} <= set(anchors)
    assert page.of("alt") == ["A grey square."] * len(page.of("src"))
    tags = [tag for tag, _ in page.tags]
    assert tags.count("caption") == tags.count("table") == tags.count("details") + 1  # the claims stay open
    assert tags.count("section") == source.count('<a href="#top">Back to the top</a>')
    assert [attrs for tag, attrs in page.tags if tag == "html"] == [{"lang": "en"}]
    assert "width=device-width" in source


def test_every_claim_is_there_with_its_verdict_rule_and_numbers(source: str) -> None:
    text = " ".join(Page(source).visible.split())
    for one in CLAIMS:
        assert text.count(one.why) == 2  # in the table and with its numbers
        assert one.rule in text
    assert text.count("0.0327 ± 0.0012") == len(CLAIMS)
    assert text.count("1 234 567") == len(CLAIMS)
    assert "2 hold 1 holds in part 1 fails" in text


def test_every_figure_is_there_whole(source: str, drawn: list[Drawn]) -> None:
    embedded = [b64decode(picture.partition(",")[2]) for picture in Page(source).of("src")]
    assert embedded == [figure.png.read_bytes() for figure in drawn]
    assert "Caption of the second" in source


def test_every_misprint_is_there_with_its_three_numbers(source: str) -> None:
    text = " ".join(Page(source).visible.split())
    for one in MISPRINTS:
        assert f"Eq. {one.equation}" in text
        assert all(f"{abs(round(value, 12)):.6g}" in text for value in one.check())


def test_foreign_text_stays_text(source: str) -> None:
    """A quote, a title and a caption that look like HTML are shown as they are."""
    assert "<script" not in source
    assert Page(source).visible.count('alert("ε") & co') == 4  # quoted twice, as title, as caption


def test_numbers_come_from_the_runs(source: str, runs: Runs) -> None:
    """σ(ε) for each radius, every seed, all parameters, and the command that would make the report again."""
    text = " ".join(Page(source).visible.split())
    for pair in runs.by_radius.values():
        sigma = deviations(pair[SMALL.elongation], SMALL)
        assert with_error(sigma.value[-1], sigma.error[-1]) in text
    for seed in runs.seeds().values():
        assert str(seed) in text
    for row in SMALL.rows():
        assert row.unit in text
    assert "restitution paper --out paper --impacts 1000 --seed 5" in text
    counted = f"{impacts_counted(runs.counted.lattice):,}".replace(",", " ")
    assert f"with {counted} impacts behind Fig. 2" in text
    assert "main, counted" in text
    assert str(runs.main.attrs["version"]) in text


def test_the_stated_command_takes_as_many_particles(runs: Runs, source: str) -> None:
    stated = re.search(r"--impacts (\d+)", source)
    assert stated is not None
    assert simulate_all(SMALL, int(stated[1]), seed=5, progress=False).main.sizes == runs.main.sizes


def test_a_figure_that_is_no_png_is_refused(runs: Runs, tmp_path: Path) -> None:
    wrong = tmp_path / "figure.png"
    wrong.write_bytes(b"GIF89a")
    with pytest.raises(ValueError, match=r"figure\.png.*not a PNG"):
        write_report(tmp_path / "report.html", [Drawn("a", "b", wrong, "c")], [], runs, SMALL)


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
