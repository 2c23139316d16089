"""Times of impacts from files as phyphox, Audacity, Tracker and spreadsheets write them."""

import zipfile
from pathlib import Path

import numpy as np
import openpyxl
import pytest
import xlwt

import restitution as rs

TIMES = [0.512, 0.912, 1.29, 1.649]


def phyphox_number(value: float, comma: bool) -> str:
    """phyphox writes 5.120000000E-1, with nine decimals, and the comma where the user wants it."""
    digits, power = f"{value:.9e}".split("e")
    text = f"{digits}E{int(power)}"
    return text.replace(".", ",") if comma else text


def stopwatch(separator: str, comma: bool) -> str:
    lines = [f'"Event time (s)"{separator}"Interval (s)"']
    for i, time in enumerate(TIMES):
        interval = phyphox_number(TIMES[i + 1] - time, comma) if i + 1 < len(TIMES) else "NaN"
        lines.append(f"{phyphox_number(time, comma)}{separator}{interval}")
    return "\n".join(lines) + "\n"


def written(folder: Path, name: str, text: str, encoding: str = "utf-8") -> Path:
    path = folder / name
    path.write_text(text, encoding=encoding)
    return path


@pytest.mark.parametrize(
    ("separator", "comma"), [(",", False), ("\t", False), (";", False), ("\t", True), (";", True)]
)
def test_phyphox_text_in_its_five_kinds(tmp_path: Path, separator: str, comma: bool) -> None:
    data = rs.flight.read(written(tmp_path, "Acoustic Stopwatch.csv", stopwatch(separator, comma)))
    assert data.time.values == pytest.approx(TIMES, abs=1e-9)
    assert data.attrs["source"].startswith("phyphox file Acoustic Stopwatch.csv")


def test_phyphox_collision_is_one_row_that_ends_with_zeros(tmp_path: Path) -> None:
    names = [f'"Bounce {i} (s)","Height {i} (m)"' + (f',"Energy {i}"' if i else "") for i in range(6)]
    values = [f"{TIMES[i] if i < 4 else 0.0:.9E},2.0E-1" + (",9.0E-1" if i else "") for i in range(6)]
    data = rs.flight.read(written(tmp_path, "Energy.csv", ",".join(names) + "\n" + ",".join(values) + "\n"))
    assert data.time.values == pytest.approx(TIMES, abs=1e-9)


def test_phyphox_archive(tmp_path: Path) -> None:
    path = tmp_path / "Acoustic Stopwatch 2026-01-01.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("Simple.csv", '"Start (s)","Stop (s)","Difference (s)"\n5.1E-1,NaN,NaN\n')
        archive.writestr("All.csv", stopwatch(",", False))
        archive.writestr("meta/device.csv", '"property","value"\n"version","1.1"\n')
        archive.writestr("meta/time.csv", '"event","experiment time"\n"START",0.0\n')
    assert rs.flight.read(path).time.values == pytest.approx(TIMES, abs=1e-9)


@pytest.mark.parametrize("suffix", ["xls", "xlsx"])
def test_phyphox_spreadsheets(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"Acoustic Stopwatch.{suffix}"
    rows: list[list[str | float]] = [["Event time (s)", "Interval (s)"]]
    rows += [[time, TIMES[i + 1] - time if i + 1 < len(TIMES) else "NaN"] for i, time in enumerate(TIMES)]
    device: list[list[str | float]] = [["property", "value"], ["version", "1.1"]]
    if suffix == "xls":
        old = xlwt.Workbook()
        for name, table in (("Metadata Device", device), ("All", rows)):
            sheet = old.add_sheet(name)
            for i, row in enumerate(table):
                for j, value in enumerate(row):
                    sheet.write(i, j, value)
        old.save(str(path))
    else:
        new = openpyxl.Workbook()
        for name, table in (("Metadata Device", device), ("All", rows)):
            page = new.create_sheet(name)
            for row in table:
                page.append(row)
        new.save(path)
    assert rs.flight.read(path).time.values == pytest.approx(TIMES, rel=1e-12)


def test_a_spreadsheet_names_sheet_line_and_column(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    assert book.active is not None
    book.active.title = "All"
    for row in (["Event time (s)"], [0.1], ["later"]):
        book.active.append(row)
    book.save(tmp_path / "a.xlsx")
    with pytest.raises(ValueError, match=r"^\S+/a.xlsx, sheet 'All', line 3, column 1: 'later': must be"):
        rs.flight.read(tmp_path / "a.xlsx")


def test_audacity_points_regions_and_frequencies(tmp_path: Path) -> None:
    text = "0.512000\t0.512000\tfirst\n\\\t100.0\t8000.0\n"
    text += "0.911000\t0.913000\t\n1.290000\t1.290000\tthird, with comma\n"
    data = rs.flight.read(written(tmp_path, "Labels 1.txt", text), uncertainty=1e-3)
    assert data.time.values == pytest.approx([0.512, 0.912, 1.29], rel=1e-12)
    assert data.uncertainty.values == pytest.approx([1e-3, 2e-3 / np.sqrt(12.0), 1e-3], rel=1e-9)
    assert data.attrs["source"].startswith("audacity")


def test_tracker_finds_impacts_between_the_frames(tmp_path: Path) -> None:
    """A ball filmed at 120 frames/s, with 0.5 mm of noise: times are right to a small part of a frame."""
    gravity, ratio, frame = 9.81, 0.9, 1.0 / 120.0
    start, speed = 0.203, 2.0
    true = start + np.concatenate([[0.0], np.cumsum(2.0 * speed * ratio ** np.arange(1, 6) / gravity)])
    t = np.arange(0.0, true[-1], frame)
    flight = np.searchsorted(true, t, side="right")
    begin, up = true[np.maximum(flight - 1, 0)], speed * ratio**flight
    y = np.where(
        flight == 0,
        speed * (start - t) - 0.5 * gravity * (start - t) ** 2,
        up * (t - begin) - 0.5 * gravity * (t - begin) ** 2,
    )
    noise = np.random.default_rng(1).normal(0.0, 5e-4, t.size)
    lines = ["\tmass A\t\t", "t\tx\ty"] + [
        f"{a:.9E}\t1.0E-3\t{b:.9E}" for a, b in zip(t, y + noise, strict=True)
    ]
    data = rs.flight.read(written(tmp_path, "tracker.txt", "\n".join(lines) + "\n"))
    assert data.sizes["impact"] == 5
    pulls = (data.time.values - true[:5]) / data.uncertainty.values
    assert np.abs(pulls).max() < 4.0
    assert data.uncertainty.values.max() < frame / 20.0
    assert data.attrs["source"].startswith("tracker")


def test_plain_tables(tmp_path: Path) -> None:
    for name, text in (
        ("a.csv", "time (ms),uncertainty (us)\n512,100\n912,100\n1290,100\n1649,100\n"),
        ("b.csv", "t;uncertainty\n0,512;0,0001\n0,912;0,0001\n1,29;0,0001\n1,649;0,0001\n"),
        ("c.txt", "0.512 1e-4\n0.912 1e-4\n\n1.29 1e-4\n1.649 1e-4\n"),
    ):
        data = rs.flight.read(written(tmp_path, name, text))
        assert data.time.values == pytest.approx(TIMES, rel=1e-12), name
        assert data.uncertainty.values == pytest.approx(1e-4, rel=1e-12), name


def test_a_table_that_does_not_tell_its_unit(tmp_path: Path) -> None:
    path = written(tmp_path, "a.csv", "time,sound\n512,-22\n912,20\n1290,3\n1649,1\n")
    data = rs.flight.read(path, unit="ms", uncertainty=5e-4)
    assert data.time.values == pytest.approx(TIMES, rel=1e-12)
    assert (data.uncertainty == 5e-4).all()


def test_an_empty_cell_is_a_missed_impact(tmp_path: Path) -> None:
    data = rs.flight.read(written(tmp_path, "a.csv", "time,note\n0.512,\n,lost\n1.29,\n"))
    assert data.flag.values.tolist() == [0, 2, 0]
    assert np.isnan(data.time.values).tolist() == [False, True, False]


def test_a_byte_order_mark_and_utf_16_are_read(tmp_path: Path) -> None:
    for encoding in ("utf-8-sig", "utf-16"):
        data = rs.flight.read(written(tmp_path, f"{encoding}.csv", "time\n0.1\n0.2\n", encoding))
        assert data.time.values.tolist() == [0.1, 0.2]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time,v\n0.1,1\nabc,1\n", "a.csv, line 3, column 1: 'abc': must be a number (s)"),
        (
            "v,time\n1,0.1\n1,0.2\n1,0.2\n",
            "a.csv, line 4, column 2: 0.2 s: must be later than the impact before it",
        ),
        (
            "time,uncertainty\n0.1,1e-4\n0.2,-1\n",
            "a.csv, line 3, column 1: an uncertainty of -1 s: must be finite",
        ),
        ("time (h)\n1\n2\n", "a.csv, line 1, column 1: 'time (h)': the unit of a time must be s, ms or us"),
        (
            "height,speed\n1,2\n",
            "a.csv: no times of impacts; must have a column 'time' or 't'; its first line is: hei",
        ),
        ("time\n1\n", "a.csv: 1 times of impacts; must have at least two"),
        ("\n\n", "a.csv: empty; must be a table with times of impacts"),
        (
            "t\ty\n0\t1\n0.1\t2\n",
            "a.csv, line 1, column 2: 0 impacts with at least 3 frames before and after",
        ),
    ],
)
def test_errors_name_the_place(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(ValueError) as error:  # noqa: PT011  # the text is compared
        rs.flight.read(written(tmp_path, "a.csv", text))
    assert str(error.value).startswith(f"{tmp_path}/{message}")


def test_what_is_no_table_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.bin"
    path.write_bytes(bytes(range(256)) * 4)
    with pytest.raises(ValueError, match=r"^\S+/a.bin: not a text file"):
        rs.flight.read(path)
    for name, content in (
        ("b.xlsx", b"PK\x03\x04 broken"),
        ("c.xls", b"\xd0\xcf\x11\xe0 broken"),
        ("d.xls", bytes.fromhex("d0cf11e0a1b11ae1") + bytes(600)),
    ):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ValueError, match=rf"^{tmp_path}/{name}: .*damaged"):
            rs.flight.read(tmp_path / name)
    assert capsys.readouterr() == ("", "")


def test_lines_that_begin_with_a_hash_are_comments(tmp_path: Path) -> None:
    """Skip them in any place and with any content."""
    file = tmp_path / "times.csv"
    file.write_text(
        "# drop 1, a plate; steel\ntime (s), uncertainty (s)\n0.1, 1e-4\n# lunch\n0.5, 1e-4\n0.88, 1e-4\n"
    )
    assert rs.flight.read(file).time.values.tolist() == [0.1, 0.5, 0.88]
    file.write_text("# typed by hand\n0.1\n0.5\n0.88\n")
    assert rs.flight.read(file).time.values.tolist() == [0.1, 0.5, 0.88]
