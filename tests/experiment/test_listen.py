"""`restitution listen`: the page, what stands beside it, and what it says to recordings that tell nothing."""

import math
import re
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
import soundfile
import xarray as xr
from typer.testing import CliRunner

import restitution as rs
from benchmarks.recording import PLATE, recording
from reference.bouncing import impact_times
from restitution._internal.parameters import ParameterError, Problem
from restitution.cli import app
from restitution.experiment.listen import Setting, analyse, write

RATE = 44100


@pytest.fixture(scope="module")
def ball(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A ball with ε = 0.9 that comes to its first impact with 2 m/s."""
    times = impact_times(lambda _: 0.9, 2.0, 16)
    speeds = np.array([2.0 * 0.9**i for i in range(16)])
    samples, _ = recording(times, speeds, PLATE, noise=-45.0)
    path = tmp_path_factory.mktemp("listen") / "ball.wav"
    soundfile.write(path, 0.9 * samples, RATE)
    return path


@pytest.fixture(scope="module", autouse=True)
def few_particles() -> Iterator[None]:
    """Simulate few, of few shapes: what is asked here is not how well the shape is known."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("restitution.experiment.listen._shape._PARTICLES", 100)
        for name in ("_SHAPES", "_SCATTERS"):
            patch.setattr(f"restitution.experiment.inference._posterior.{name}", 2)
        yield


@pytest.fixture(scope="module")
def short(ball: Path) -> Path:
    """Its first six impacts, too few for a shape, which takes long."""
    samples, _ = soundfile.read(ball)
    return written(ball.with_name("short.wav"), samples[: int(2.0 * RATE)])


def listen(*arguments: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["listen", *map(str, arguments)])
    return result.exit_code, result.output


class Page(HTMLParser):
    """Collects what a page refers to and says."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.sources: list[str] = []
        self.words = ""
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.sources += [value or "" for name, value in attrs if name in ("src", "href")]

    def handle_data(self, data: str) -> None:
        self.words += data


@pytest.fixture(scope="module")
def report(ball: Path) -> tuple[Path, str]:
    out = ball.parent / "report.html"
    height = 2.0**2 / (2.0 * 9.81)
    code, said = listen(ball, "--diameter", 0.02, "--drop", height, "--drop-error", 1e-3, "--out", out)
    assert code == 0, said
    return out, said


def test_the_sentence_has_the_coefficient_with_its_error(report: tuple[Path, str]) -> None:
    _, said = report
    match = re.search(r"From the sound of 16 impacts .* is (0\.\d+) ± (0\.\d+)", said)
    assert match is not None, said
    assert abs(float(match[1]) - 0.9) < 4.0 * float(match[2]) < 4e-3


def test_the_page_needs_nothing_else_and_shows_everything(report: tuple[Path, str]) -> None:
    page = Page(report[0].read_text(encoding="utf-8"))
    assert len([source for source in page.sources if source.startswith("data:image/png")]) == 5
    assert all(source.startswith("data:") or source == "#top" for source in page.sources)
    laws = ("constant", "power law", "viscoelastic", "plastic")
    [line] = re.findall(r"ε\s=\s0\.\d+\s±\s0\.\d+\s*The mean between .*", page.words)  # the answer first
    assert page.words.index(line) < page.words.index("From the sound of 16 impacts")
    assert "A sphere explains the times; out of round by less than" in line
    for words in ("ball.wav", "44100 Hz", "20 mm", *laws, "Shape of the ball", "Error budget"):
        assert words in page.words


def test_beside_it_stand_all_numbers(report: tuple[Path, str]) -> None:
    out, _ = report
    data = xr.load_dataset(out.with_suffix(".nc"))
    assert data.sizes["impact"] == 16
    assert data.attrs["diameter"] == 0.02
    known = np.isfinite(data.restitution.values)
    assert known.sum() == 15
    errors = np.sqrt(np.diag(data.restitution_covariance.values))[known]
    assert errors == pytest.approx(data.restitution_error.values[known], rel=1e-12)
    again = rs.flight.read(out.with_suffix(".csv"))
    assert again.time.values == pytest.approx(data.time.values, abs=1e-8)
    assert again.uncertainty.values == pytest.approx(data.uncertainty.values, rel=1e-6)


def test_nothing_is_replaced_unless_asked(ball: Path, report: tuple[Path, str]) -> None:
    code, said = listen(ball, "--diameter", 0.02, "--out", report[0])
    assert code == 1
    assert "exists already" in said


def test_mass_accounts_for_drag(short: Path, tmp_path: Path) -> None:
    """And pictures need no LaTeX, whatever the user's own settings of matplotlib ask for."""
    with mpl.rc_context({"text.usetex": True}):
        code, said = listen(short, "--diameter", 0.04, "--mass", 2.7e-3, "--out", tmp_path / "a.html")
    assert code == 0
    assert "air drag is accounted for" in said
    assert "quadratic, terminal velocity 8.8" in (tmp_path / "a.html").read_text(encoding="utf-8")


def written(path: Path, samples: np.ndarray, rate: int = RATE) -> Path:
    soundfile.write(path, samples, rate)
    return path


def silence(folder: Path) -> Path:
    return written(folder / "a.wav", np.zeros(RATE))


def one_impact(folder: Path) -> Path:
    rng = np.random.default_rng(1)
    samples = 1e-3 * rng.standard_normal(RATE)
    samples[20000:20400] += 0.5 * rng.standard_normal(400) * np.exp(-np.arange(400) / 60)
    return written(folder / "a.wav", samples)


def clipped_throughout(folder: Path) -> Path:
    noise = 50.0 * np.random.default_rng(1).standard_normal(RATE)
    return written(folder / "a.wav", np.clip(noise, -1.0, 1.0))


def no_sound(folder: Path) -> Path:
    path = folder / "a.wav"
    path.write_text("no sound", encoding="utf-8")
    return path


def slow_rate(folder: Path) -> Path:
    return written(folder / "a.wav", np.random.default_rng(1).standard_normal(3000) / 10, 500)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (silence, "a.wav: silence; every sample has the same value"),
        (one_impact, "a.wav: one impact is heard, at 0.45 s; at least three are needed"),
        (clipped_throughout, "a.wav: clipped throughout"),
        (no_sound, "a.wav: not a sound file that can be read (WAV, FLAC, OGG, MP3, AIFF)"),
        (slow_rate, "a.wav: 500 samples per second; must be at least 2000"),
    ],
)
def test_a_recording_that_tells_nothing_is_told_why(tmp_path: Path, make: object, message: str) -> None:
    file = make(tmp_path)  # type: ignore[operator]
    code, said = listen(file, "--diameter", 0.02, "--out", tmp_path / "report.html")
    assert code == 2
    assert message in said
    assert not list(tmp_path.glob("report*"))


def test_a_wrong_sample_rate_contradicts_the_drop(ball: Path, tmp_path: Path) -> None:
    """Samples taken at 44.1 kHz in a file that says 22.05 kHz: flights last twice as long."""
    samples, _ = soundfile.read(ball)
    slow = written(tmp_path / "slow.wav", samples, 22050)
    code, said = listen(slow, "--diameter", 0.02, "--drop", 0.204, "--out", tmp_path / "a.html")
    assert code == 2
    assert "drop = 0.204 m: the first flight heard, 0.734 s, is 0.661 m high; the drop is wrong, or" in said


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--diameter", -1.0, "--out", "a.html"), "diameter = -1.0: must be a finite number > 0 (m)"),
        (("--diameter", 0.02, "--out", "a.pdf"), "out = 'a.pdf': must be a file that ends with .html"),
    ],
)
def test_errors_name_what_is_wrong(ball: Path, arguments: tuple[object, ...], message: str) -> None:
    code, said = listen(ball, *arguments)
    assert code == 2
    assert message in said


def test_clipping_is_told(tmp_path: Path) -> None:
    times = impact_times(lambda _: 0.9, 2.0, 6)
    speeds = np.array([2.0 * 0.9**i for i in range(6)])
    samples, _ = recording(times, speeds, PLATE, noise=-45.0, clipping=0.7)
    warnings = analyse(written(tmp_path / "a.wav", samples), Setting(diameter=0.02)).warnings
    said = "of the loud samples are clipped: loudness is lost, times are not"
    assert any(said in warning for warning in warnings)


def test_a_lossy_file_says_that_it_is(tmp_path: Path, short: Path) -> None:
    samples, _ = soundfile.read(short)
    analysis = analyse(written(tmp_path / "a.ogg", samples), Setting(diameter=0.02))
    assert any(".ogg compresses with loss" in warning for warning in analysis.warnings)


def typed(path: Path, times: np.ndarray) -> Path:
    path.write_text("# a marble\ntime (ms)\n" + "".join(f"{1e3 * t:.4f}\n" for t in times), encoding="utf-8")
    return path


def test_a_typed_table_gives_page_and_sentence(tmp_path: Path) -> None:
    """The errors of its times, which it does not give, are fitted; nothing is drawn of a sound."""
    times = 0.3 + impact_times(lambda _: 0.9, 2.0, 16) + np.random.default_rng(1).normal(0.0, 1e-4, 16)
    file, out = typed(tmp_path / "times.csv", times), tmp_path / "report.html"
    code, said = listen(file, "--diameter", 0.02, "--out", out)
    assert code == 0, said
    match = re.search(r"From the times of 16 impacts .* is (0\.\d+) ± (0\.\d+)", said)
    assert match is not None, said
    assert abs(float(match[1]) - 0.9) < 4.0 * float(match[2]) < 4e-3
    match = re.search(r"came without an uncertainty; their standard error, .*, is (\d+) ± (\d+) µs", said)
    assert match is not None, said
    assert abs(float(match[1]) - 100.0) < 3.0 * float(match[2]) < 100.0
    page = Page(out.read_text(encoding="utf-8"))
    assert "came without an uncertainty" in page.words
    assert "sample rate" not in page.words
    data = xr.load_dataset(out.with_suffix(".nc"))
    assert data.time.values == pytest.approx(times, abs=1e-7)
    assert data.uncertainty.values == pytest.approx(1e-6 * float(match[1]), abs=1e-6)


def test_a_table_has_the_error_that_is_given(tmp_path: Path) -> None:
    file = typed(tmp_path / "times.txt", impact_times(lambda _: 0.9, 2.0, 6))
    code, said = listen(file, "--diameter", 0.02, "--time-error", 1e-4, "--out", tmp_path / "a.html")
    assert code == 0, said
    assert "timed to 100 µs (standard error)" in said
    assert "without an uncertainty" not in said


def test_errors_of_times_are_found_in_a_recording(ball: Path, tmp_path: Path) -> None:
    code, said = listen(ball, "--diameter", 0.02, "--time-error", 1e-4, "--out", tmp_path / "a.html")
    assert code == 2
    assert "a recording, in which errors of times are found, not given" in said


def test_the_sentence_names_parameters_in_words() -> None:
    data = rs.flight.restitution(impact_times(lambda v: 0.9 * v**-0.02, 2.0, 12), 1e-5)
    said = str(rs.flight.fit(data, "power law"))
    assert said.startswith("power law: ε at 1 m/s = 0.900")
    assert "restitution_at" not in said


def test_all_missing_options_are_said_at_once(ball: Path) -> None:
    code, said = listen(ball)
    assert code == 2
    assert "--diameter and --out: missing" in said


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"diameter": 40.0}, r"diameter = 40\.0: must be in m, below 1; 40 mm are 0\.04"),
        ({"diameter": 0.04, "mass": 2.7}, r"mass = 2\.7: must be in kg, .*; 2\.7 g are 0\.0027"),
    ],
)
def test_other_units_are_asked_back(given: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        Setting(**given)


def test_a_drop_in_centimetres_is_asked_back(tmp_path: Path) -> None:
    """The first flight after 0.3 m rises by 0.24 m, and cannot follow a drop of 30 m."""
    times = impact_times(lambda _: 0.9, float(np.sqrt(2.0 * 9.81 * 0.3)), 8)
    table = typed(tmp_path / "times.csv", times)
    with pytest.raises(ValueError, match=r"^drop = 30\.0: must be in m: the first flight rises by 0\.24"):
        analyse(table, Setting(diameter=0.04, drop=30.0, time_uncertainty=1e-4))


def test_a_table_may_have_its_page_beside_it(tmp_path: Path) -> None:
    """What would take the place of times.csv is times.out.csv; the times stay as they were."""
    table = typed(tmp_path / "times.csv", impact_times(lambda _: 0.9, 2.0, 5))
    before = table.read_bytes()
    page = tmp_path / "times.html"
    code, text = listen(table, "--diameter", 0.02, "--time-error", 1e-4, "--out", page)
    assert code == 0, text
    assert table.read_bytes() == before
    assert page.exists()
    assert "restitution" in (tmp_path / "times.out.csv").read_text(encoding="utf-8")


def test_a_law_of_the_speed_is_claimed_only_from_a_difference_of_six(tmp_path: Path) -> None:
    """And never where drag is neglected, which by itself makes ε depend on the speed."""
    speed = 2.0
    for exponent, differs in ((0.0, False), (0.03, True)):
        times = impact_times(lambda v, q=exponent: 0.9 * v**-q, speed, 5)  # type: ignore[misc]
        times += np.random.default_rng(4).normal(0.0, 2e-5, 5)
        table = typed(tmp_path / f"{exponent}.csv", times)
        for mass in (None, 1e3):
            given = Setting(diameter=0.9, mass=mass, time_uncertainty=2e-5)
            said = analyse(table, given).series[0].sentence(given)
            assert ("The law that fits best" in said) == (differs and mass is not None)
            assert ("It depends on the speed" in said) == (differs and mass is None)


def drops(folder: Path, between: float) -> list[Path]:
    """Write down times of five drops of a round ball, whose ε differs by `between` from plate to plate."""
    rng = np.random.default_rng(5)
    paths = []
    for place, off in enumerate(between * np.array([-1.5, -0.5, 0.0, 0.5, 1.5])):
        speeds = 1.5 * np.cumprod(0.92 + off + 5e-4 * rng.standard_normal(14))
        times = np.concatenate([[0.0], np.cumsum(2.0 * speeds / 9.81)]) + rng.normal(0.0, 2e-5, 15)
        paths.append(typed(folder / f"drop{place}.csv", times))
    return paths


def test_drops_in_several_files_give_one_answer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One sentence, shape and page; what differs from plate to plate is in the error of the mean."""
    asked = []

    def posterior(data: list[xr.Dataset], *_: object, **__: object) -> None:
        asked.append(len(data))
        raise ParameterError(Problem("data", ": not asked"))

    monkeypatch.setattr("restitution.experiment.listen._shape.posterior", posterior)
    errors = {}
    for between in (0.0, 0.002):
        folder = tmp_path / str(between)
        folder.mkdir()
        paths = drops(folder, between)
        code, said = listen(*paths, "--diameter", 0.006, "--time-error", 2e-5, "--out", folder / "page.html")
        assert code == 0, said
        match = re.search(r"of 75 impacts in 5 drops .* is (0\.\d+) ± (0\.\d+),.* between drops", said)
        assert match is not None, said
        errors[between] = float(match[2])
        assert abs(float(match[1]) - 0.92) < 2.0 * errors[between]
    # The standard deviation of five that differ by 0.0022 is known to four degrees of freedom.
    assert errors[0.002] == pytest.approx(0.0022 / np.sqrt(5.0) * np.sqrt(2.0), rel=0.3)
    assert errors[0.0] < 0.5 * errors[0.002]
    assert asked == [5, 5]
    page = Page((folder / "page.html").read_text(encoding="utf-8"))
    for words in ("5 drops together", "drop0.csv", "drop4.csv", "Series 4"):
        assert words in page.words
    data = xr.load_dataset(folder / "page.nc")
    assert data.sizes["impact"] == 75
    assert np.unique(data.file.values).tolist() == [0, 1, 2, 3, 4]
    assert np.isnan(data.restitution_covariance.values[5, 20])


@pytest.mark.slow
def test_a_class_has_one_number_and_what_differs_between_tables(tmp_path: Path) -> None:
    """Eight tables in folders, two drops each, plates that differ by 0.002: that is the error of the mean."""
    rng, files = np.random.default_rng(3), []
    for table in range(8):
        plate = 0.92 + 2e-3 * rng.standard_normal()
        for drop in range(2):
            steps = plate + 4e-4 * rng.standard_normal() + 4e-4 * rng.standard_normal(11)
            times = np.append(0.0, np.cumsum(0.28 * np.cumprod(steps))) + rng.normal(0.0, 2e-5, 12)
            files.append(tmp_path / f"table{table}" / f"drop{drop}.csv")
            files[-1].parent.mkdir(exist_ok=True)
            files[-1].write_text("time (s)\n" + "\n".join(f"{time:.7f}" for time in times), encoding="utf-8")
    setting = Setting(diameter=0.02, mass=0.0327, time_uncertainty=2e-5)
    found = write(files, tmp_path / "class.html", setting)
    [said] = found.sentences
    match = re.search(r"in 16 drops of balls at 8 tables, .* is (0\.\d+) ± (0\.\d+),.* between tables", said)
    assert match is not None, said
    assert float(match[1]) == pytest.approx(0.92, abs=3.0 * 2e-3 / math.sqrt(8.0))
    assert 4e-4 < float(match[2]) < 1.6e-3
    assert found.together is not None
    assert found.together.shape is None  # of balls of their own
    page = (tmp_path / "class.html").read_text(encoding="utf-8")
    assert "Tables differ by 0.00" in page
    for words in ("table0/drop0.csv", "table7/drop1.csv", "The drops by themselves"):
        assert words in page
    assert "0.000000" not in page
