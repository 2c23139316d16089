"""Bad input is refused at once, with its name, its value and what is allowed; and nothing is half-written."""

import math
import pickle
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import restitution as rs
from reference.command import invoke
from restitution._cli import BAD_INPUT
from restitution._toml import read

POSITIVE = "must be a finite number > 0"
NOT_NEGATIVE = "must be a finite number >= 0"
COUNT = "must be a whole number in [1, 2**40)"
SEED = "must be a whole number in [0, 2**64)"
BODIES = "a Dumbbell, LoadedSphere, Spherocylinder or Spheroid"
SHAPES = '"dumbbell" or "loaded-sphere" or "spherocylinder" or "spheroid"'
THREADS = "must be a whole number in [1, 1024] or None"
ORIENTATION = "must be 'uniform-angle', 'isotropic' or a 1-D array of angles in rad, one per particle"
LAW_TYPES = '"tangential-restitution" or "frictionless" or "coulomb" or "chatterjee-ruina"'
SPIN = "must be None, (ωx, ωy, ωz) in rad/s, an array of them, one per particle, or a RandomSpin"
VELOCITY = "must be None or (vx, vy, vz), finite, in m/s"
ANGLE = "must be a finite angle in rad, at most 2**20 either way"

NOT_FINITE = (math.nan, math.inf, -math.inf)
NO_NUMBERS = (True, np.True_, None, "0.5", b"1", 1j, [1.0], np.array([1.0, 2.0, 3.0]))
NO_WHOLE_NUMBERS = (*NO_NUMBERS, 2.0, 2.5, np.float64(3), math.nan, math.inf)


def whole(name: str, values: tuple[Any, ...], allowed: str) -> list[tuple[str, Any, str]]:
    """Cases of an argument that must be a whole number."""
    return [(name, value, allowed) for value in (*values, *NO_WHOLE_NUMBERS)]


def real(name: str, values: tuple[float, ...], allowed: str) -> list[tuple[str, Any, str]]:
    """Cases of an argument that must be a real number."""
    return [(name, value, allowed) for value in (*values, *NO_NUMBERS, *NOT_FINITE)]


BODY = [
    *real("radius", (0, -3e-3, np.float64(-1), -5e-324, 10**400), POSITIVE),
    *real("separation", (-1e-9,), NOT_NEGATIVE),
    *real("density", (0.0, -1), POSITIVE),
]
LAW = [
    *real("normal", (-0.01, 1.0000001, 2), "must be a real number in [0, 1]"),
    *real("tangential", (-1.01, 1.01), "must be a real number in [-1, 1]"),
]
RUN = [
    *whole("particles", (0, -1, 2**40, 10**15, 10**30, 10**5000, np.int64(0)), COUNT),
    *whole("impacts", (0, -1, 2**40, 10**15), COUNT),
    *whole("seed", (-1, 2**64, -(2**64), np.int64(-1)), SEED),
    *real("release_height", (0, -0.06), POSITIVE),
    *real("gravity", (0, -9.81), POSITIVE),
    *real("minimum_speed", (-1e-9,), NOT_NEGATIVE),
    ("release_height", 3.1e-3, "must be at least 0.00315 m, or a part of the body"),
    ("orientation", "upright", ORIENTATION),
    ("orientation", None, ORIENTATION),
    ("orientation", 0.3, ORIENTATION),
    ("orientation", [[0.1, 0.2, 0.3]], ORIENTATION),
    ("orientation", [[0.1], [0.1, 0.2]], ORIENTATION),
    ("orientation", ["0.1", "0.2"], ORIENTATION),
    ("orientation", [True, False], ORIENTATION),
    ("orientation", [0.1, 1j], ORIENTATION),
    ("orientation", np.zeros((40, 40)), ORIENTATION),
    ("orientation", np.zeros((40, 2, 1)), ORIENTATION),
    *real("incline", (-0.1, math.pi / 2, 90), "must be a real number in [0, π/2)"),
    *(
        ("spin", value, SPIN)
        for value in (1.0, "fast", True, [1, 2], [1, 2, "3"], np.zeros((4, 2)), [[1, 2]])
    ),
    *(("release_velocity", value, VELOCITY) for value in (1.0, "up", [1, 2], [1, 2, None], [[1, 2, 3]])),
    *(("release_velocity", [0, 0, value], VELOCITY) for value in NOT_FINITE),
]
THREADS_CASES = [
    ("threads", value, THREADS) for value in (0, -1, 1025, 10**30, 1.5, True, "2", [1], math.nan)
]


def message(call: Callable[[], object]) -> str:
    """What the ValueError of a call says."""
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - the callers look at the message
        call()
    # Errors cross process borders when runs are spread over workers.
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)
    return str(caught.value)


def check(text: str, name: str, value: object, allowed: str) -> None:
    """One line: the name, the value unless it is too long for a line, and what is allowed."""
    start = f"{name} = "
    assert text.startswith(start)
    given, _, rest = text.removeprefix(start).partition(": ")
    assert rest.startswith(allowed)
    plain = value.item() if isinstance(value, np.generic) else value
    if (isinstance(plain, int) and abs(plain) >= 2**256) or (
        isinstance(plain, np.ndarray) and plain.size > 6
    ):
        assert len(given) < 40
    else:
        assert given == repr(plain)
    assert "\n" not in text
    assert len(text) < 240


def identify(case: object) -> str:
    """Short names for the cases, also of numbers with thousands of digits."""
    return f"{case.bit_length()}bits" if isinstance(case, int) and abs(case) > 2**70 else str(case)[:24]


@pytest.mark.parametrize(("name", "value", "allowed"), BODY, ids=identify)
def test_body(name: str, value: Any, allowed: str) -> None:
    check(
        message(lambda: rs.Dumbbell(**{"radius": 1.0, "separation": 0.1} | {name: value})),
        name,
        value,
        allowed,
    )


@pytest.mark.parametrize(("name", "value", "allowed"), LAW, ids=identify)
def test_law(name: str, value: Any, allowed: str) -> None:
    check(message(lambda: rs.TangentialRestitution(**{"normal": 0.5} | {name: value})), name, value, allowed)


@pytest.mark.parametrize(("name", "value", "allowed"), [*RUN, *THREADS_CASES], ids=identify)
def test_simulate(
    body: rs.Dumbbell, law: rs.TangentialRestitution, name: str, value: Any, allowed: str
) -> None:
    check(message(lambda: rs.simulate(body, law, **{name: value})), name, value, allowed)


@pytest.mark.parametrize(("name", "value", "allowed"), [*RUN, *THREADS_CASES], ids=identify)
def test_statistics_refuses_what_simulate_refuses(
    body: rs.Dumbbell, law: rs.TangentialRestitution, name: str, value: Any, allowed: str
) -> None:
    bins: Any = {"velocity_bins": [0.0, 1.0], "restitution_bins": [0.0, 1.0]}
    check(message(lambda: rs.statistics(body, law, **bins, **{name: value})), name, value, allowed)


def test_angles(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """An array is refused with the index and value of its first bad angle, or with its length."""

    def refused(angles: Any) -> str:
        return message(lambda: rs.simulate(body, law, particles=3, orientation=angles))

    assert refused([0.1, math.nan, 0.3]) == f"orientation[1] = nan: {ANGLE}"
    assert refused(np.array([0.1, 0.2, -np.inf])) == f"orientation[2] = -inf: {ANGLE}"
    assert refused([2.0**20 + 1, 0.2, 0.3]) == f"orientation[0] = 1048577.0: {ANGLE}"
    expected = "orientation has {} angles: must have one for each of particles = 3"
    assert refused([0.1, 0.2]) == expected.format(2)
    assert refused([]) == expected.format(0)
    assert refused([[0.1, 0.2]]) == expected.format(1)
    told = message(lambda: rs.simulate(body, law, particles=3, spin=np.zeros((7, 3))))
    assert told == "spin has 7 of them: must have one for each of particles = 3"


def test_a_tilted_body_may_start_lower(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """The height that is allowed is that of the given angles: R for a horizontal axis, not R + L/2."""
    height = 3e-3 * (1 + 1e-9)
    horizontal = np.array([math.pi / 2])
    data = rs.simulate(body, law, particles=1, impacts=1, release_height=height, orientation=horizontal)
    assert data.impacts == 1
    upright = np.array([0.0])
    text = message(lambda: rs.simulate(body, law, particles=1, release_height=height, orientation=upright))
    check(text, "release_height", height, "must be at least 0.00315 m, or a part of the body")


def test_body_and_law(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """What is no body or no law is refused, be it as much as the other of the two or their parameters."""
    no_bodies: list[Any] = [law, None, 3, "dumbbell", {"radius": 1.0, "separation": 0.1}, rs.Dumbbell]
    for wrong in no_bodies:
        for call in (rs.simulate, rs.analytic.first_impact):
            text = message(partial(call, wrong, law))
            assert text.startswith("body = ")
            assert text.endswith(f": must be {BODIES}")
    no_laws: list[Any] = [body, None, 0.98, {"normal": 0.98}]
    for wrong in no_laws:
        for call in (rs.simulate, rs.analytic.first_impact):
            text = message(partial(call, body, wrong))
            assert text.startswith("law = ")
            assert text.endswith(
                ": must be a TangentialRestitution, Frictionless, Coulomb or ChatterjeeRuina"
            )


def test_missing_and_unknown_names() -> None:
    """All that is wrong is said at once, a line each, with a guess at what was meant."""
    lines = message(lambda: rs.Dumbbell(radus=1.0, density=-1)).splitlines()  # type: ignore[call-arg]
    assert [line.partition(" (")[0] for line in lines] == [
        "radius: missing; must be a finite number > 0",
        "separation: missing; must be a finite number >= 0",
        "density = -1: must be a finite number > 0",
        "radus: unknown; did you mean radius? Dumbbell takes radius, separation, density",
    ]
    assert message(lambda: rs.TangentialRestitution(normal=1, friction=0.3)) == (  # type: ignore[call-arg]
        "friction: unknown; TangentialRestitution takes normal, tangential"
    )


def test_a_wrong_call_is_a_type_error(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    with pytest.raises(TypeError, match="'body' and 'law'"):
        rs.simulate()  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="'particle'"):
        rs.simulate(body, law, particle=10)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="positional"):
        rs.simulate(body, law, 10)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="'velocity_bins' and 'restitution_bins'"):
        rs.compare([body], [law])
    with pytest.raises(TypeError, match=r"argument: 'restitution_bins'$"):
        rs.compare([body], [law], velocity_bins=[0.0, 1.0])
    with pytest.raises(TypeError, match="'particle'"):
        rs.compare([body], [law], velocity_bins=[0.0, 1.0], restitution_bins=[0.0, 1.0], particle=10)


def test_all_ranges_that_are_wrong_are_named(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """In one error, as all parameters of a body are; a range without bins is not passed over."""
    told = r"velocity_range: missing; velocity_bins = 20 needs a range \(low, high\)\n"
    told += r"restitution_range = \(3.0, -1.0\): must be \(low, high\) with low < high"
    bins = {"velocity_bins": 20, "restitution_bins": 30, "restitution_range": (3.0, -1.0)}
    with pytest.raises(ValueError, match=f"^{told}$"):
        rs.statistics(body, law, **bins)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=f"^{told}$"):
        rs.reduce(rs.simulate(body, law, particles=2, impacts=2), **bins)  # type: ignore[arg-type]
    with pytest.raises(
        ValueError, match=r"velocity_range = \(0, 1\): must be left out: velocity_bins is None"
    ):
        rs.statistics(body, law, velocity_bins=None, velocity_range=(0, 1), restitution_bins=[0.0, 1.0])


@pytest.mark.parametrize(
    "values",
    [
        {"radius": 1e-110, "separation": 1e-111},
        {"radius": 1e200, "separation": 1e199},
        {"radius": 3e-3, "separation": 1e300},
        {"radius": 3e-3, "separation": 3e-4, "density": 1e-320},
    ],
    ids=str,
)
def test_a_body_beyond_floating_point(values: dict[str, float]) -> None:
    """Finite parameters whose mass or inertia is no normal number would give NaN later."""
    text = message(lambda: rs.Dumbbell(**values))
    assert text.startswith("radius = ")
    assert "mass and inertia" in text
    assert "neither overflow nor underflow" in text


def test_absurd_scales(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """Finite heights and gravities that overflow in the engine's units, R and √(R/g)."""
    assert message(lambda: rs.simulate(body, law, release_height=1.7e308)).startswith("release_height = 1")
    assert message(lambda: rs.simulate(body, law, spin=[0, 1e200, 0])).startswith(
        "spin = 1e+200: must be at most"
    )
    assert message(lambda: rs.simulate(body, law, release_velocity=[0, 0, 1e200])).startswith(
        "release_velocity = 1e+200: must be at most"
    )
    assert "must be such that R/g and gR" in message(lambda: rs.simulate(body, law, gravity=1e-320))


def test_a_table_that_no_memory_holds(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """Each number is allowed, their product is not."""
    text = message(lambda: rs.simulate(body, law, particles=2**39, impacts=2**39))
    assert text.startswith("particles * impacts = 3.022e+23: must be at most ")
    assert "GB" in text


# TOML

GOOD: dict[str, dict[str, str]] = {
    "body": {"shape": '"dumbbell"', "radius": "3e-3", "separation": "3e-4"},
    "law": {"type": '"tangential-restitution"', "normal": "0.98"},
    "run": {"particles": "3", "impacts": "5"},
}


def write(path: Path, tables: dict[str, dict[str, str]]) -> Path:
    """Write tables of TOML literals to a file."""
    blocks = (
        "\n".join([f"[{name}]", *(f"{k} = {v}" for k, v in keys.items())]) for name, keys in tables.items()
    )
    path.write_text("\n".join(blocks), encoding="utf-8")
    return path


def literal(value: Any) -> str | None:
    """TOML for a value, or None where TOML has none."""
    if isinstance(value, bool | str):
        return repr(value).lower() if isinstance(value, bool) else f'"{value}"'
    if (isinstance(value, int | float) and abs(value) < 2**256) or isinstance(value, float):
        return repr(value)
    if isinstance(value, list) and all(literal(item) for item in value):
        return f"[{', '.join(literal(item) or '' for item in value)}]"
    return None


IN_A_FILE = [
    (table, name, value, allowed)
    for table, cases in (("body", BODY), ("law", LAW), ("run", RUN))
    for name, value, allowed in cases
    if type(value) in (bool, int, float, str, list) and literal(value)
]


def refused(path: Path) -> list[str]:
    """What the command says of a bad file; nothing is written."""
    before = sorted(path.parent.iterdir())
    result = invoke("simulate", path, "--out", path.with_name("run.nc"))
    assert sorted(path.parent.iterdir()) == before
    assert result.exit_code == BAD_INPUT
    assert result.stdout == ""
    lines = result.stderr.splitlines()
    assert all(line.startswith(f"error: {path}: ") for line in lines)
    text = [line.removeprefix(f"error: {path}: ") for line in lines]
    assert message(lambda: read(path)) == "\n".join(f"{path}: {line}" for line in text)
    return text


@pytest.mark.parametrize(("table", "name", "value", "allowed"), IN_A_FILE, ids=identify)
def test_a_file_is_refused_for_the_same_reasons(
    tmp_path: Path, table: str, name: str, value: Any, allowed: str
) -> None:
    tables = GOOD | {table: GOOD[table] | {name: str(literal(value))}}
    [line] = refused(write(tmp_path / "run.toml", tables))
    check(line, f"{table}.{name}", value, allowed)


def test_a_file_with_much_wrong(tmp_path: Path) -> None:
    """One reading finds everything; unknown keys come with a guess and with what the table takes."""
    tables = {
        "boddy": {"a": "1"},
        "body": {"shape": '"dumbbell"', "raduis": "3e-3", "separation": "-1"},
        "law": {"type": '"friction"', "normal": "0.98"},
        "run": {"particle": "3", "body": "1", "seed": "-1"},
    }
    takes = "[run] takes particles, impacts, release_height, gravity, orientation, spin, release_velocity, "
    takes += "incline, minimum_speed, seed"
    lines = refused(write(tmp_path / "run.toml", tables))
    assert [re.sub(r" \(.*\)$", "", line) for line in lines] == [  # without units and such
        "boddy: unknown; did you mean body? the file takes body, law, run, statistics, distribution",
        "body.raduis: unknown; did you mean body.radius? [body] takes shape, radius, separation, density",
        "body.radius: missing; must be a finite number > 0",
        "body.separation = -1: must be a finite number >= 0",
        f"law.type = 'friction': must be {LAW_TYPES}",
        f"run.particle: unknown; did you mean run.particles? {takes}",
        f"run.body: unknown; {takes}",
        f"run.seed = -1: {SEED}",
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "",
            [
                f"body.shape: missing; must be {SHAPES}",
                f"law.type: missing; must be {LAW_TYPES}",
            ],
        ),
        (
            "body = 3\n[law]\ntype = 5",
            [
                "body = 3: must be a table [body]",
                f"body.shape: missing; must be {SHAPES}",
                f"law.type = 5: must be {LAW_TYPES}",
            ],
        ),
    ],
    ids=["empty", "no tables"],
)
def test_a_file_without_its_tables(tmp_path: Path, text: str, expected: list[str]) -> None:
    path = tmp_path / "run.toml"
    path.write_text(text, encoding="utf-8")
    assert refused(path) == expected


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"[body\nradius = 1", "not a TOML file: Expected ']'"),
        (b"[run]\nseed = 1\nseed = 2", "not a TOML file: Cannot overwrite a value"),
        (b"[run]\nseed = 1e", "not a TOML file: "),
        (b"# \xff", "not a TOML file: 'utf-8' codec can't decode"),
        (b"\x89HDF\r\n", "not a TOML file: "),
        (b"a = " + 5000 * b"[", "not a TOML file: lists or tables nested too deeply"),
    ],
    ids=["bracket", "twice", "number", "encoding", "netCDF", "nested"],
)
def test_a_file_that_is_not_toml(tmp_path: Path, content: bytes, expected: str) -> None:
    path = tmp_path / "run.toml"
    path.write_bytes(content)
    [line] = refused(path)
    assert line.startswith(expected)
