"""The engine through its Python door: headline properties, its sine and cosine, files, threads, Ctrl-C."""

import math
import re
import textwrap
from contextlib import nullcontext
from pathlib import Path

import mpmath
import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import restitution as rs
from reference.command import Program
from restitution import _core
from restitution._core import sincos
from restitution.drop import simulate as simulation
from restitution.drop.run import Run

RADIUS = 3e-3
COLUMNS = (
    "time",
    "impact_velocity",
    "rebound_velocity",
    "restitution",
    "rotational_fraction",
    "energy_ratio",
    "angle",
)

elongations = st.sampled_from([0.0, 2.0]) | st.floats(0, 4)
normals = st.sampled_from([0.0, 1.0]) | st.floats(0, 1)
tangentials = st.sampled_from([-1.0, 0.0, 1.0]) | st.floats(-1, 1)


def dumbbell(elongation: float) -> rs.Dumbbell:
    return rs.Dumbbell(radius=RADIUS, separation=elongation * RADIUS)


def bounce(elongation: float, normal: float, tangential: float, **more: object) -> xr.Dataset:
    law = rs.TangentialRestitution(normal=normal, tangential=tangential)
    size: dict[str, object] = {"particles": 20, "impacts": 30}
    return rs.simulate(dumbbell(elongation), law, **(size | more))  # type: ignore[arg-type]


# --- what every run must show -------------------------------------------------------------------------------


@settings(max_examples=60)
@given(elongations, normals, tangentials, st.integers(0, 2**64 - 1))
def test_the_table_is_consistent(elongation: float, normal: float, tangential: float, seed: int) -> None:
    """Finite where an impact happened, NaN where not; ε is a quotient of velocities; time runs on."""
    data = bounce(elongation, normal, tangential, seed=seed)
    happened = np.arange(data.sizes["impact"]) < data.impacts.values[:, None]
    for name in COLUMNS:
        np.testing.assert_array_equal(np.isfinite(data[name]), happened, err_msg=name)
        assert data[name].dtype == np.float64
    np.testing.assert_array_equal(data.contact != 0, happened)
    assert (np.diff(data.time, axis=1)[happened[:, 1:]] >= 0).all()
    quotient = data.rebound_velocity / data.impact_velocity
    # Three roundings: those of the two velocities in SI units and that of this quotient.
    np.testing.assert_allclose(data.restitution, quotient, rtol=4 * 2**-53)
    for name, high in (("rotational_fraction", 1.0), ("angle", math.pi)):
        values = data[name].values[happened]
        assert ((values >= 0) & (values <= high)).all(), name


@settings(max_examples=60)
@given(elongations, normals, tangentials, st.sampled_from(["uniform-angle", "isotropic"]))
def test_the_first_impact_is_equation_17(
    elongation: float, normal: float, tangential: float, orientation: str
) -> None:
    """Nothing slips at the first impact from rest, so that (17) holds for every ε_t."""
    body = dumbbell(elongation)
    data = bounce(elongation, normal, tangential, orientation=orientation, impacts=1)
    r, length, j = body.radii[0], body.separation, body.transverse_inertia / body.mass
    c = np.abs(np.cos(data.release_angle))  # the lower sphere touches
    top = 4 * j + length**2 * c**2 + 4 * length * r * c + 4 * r**2
    expected = -1 + (1 + normal) * top / (4 * j + 4 * length * r * c + 4 * r**2 + length**2)  # (17)
    # ε is a difference of numbers up to 2 that carry a dozen roundings each.
    np.testing.assert_allclose(data.restitution[:, 0], expected, rtol=0, atol=32 * 2**-53)
    ratio = 1 - (1 - normal) * (1 + expected)  # ΔE = P·(v_c + v_c′)/2
    np.testing.assert_allclose(data.energy_ratio[:, 0], ratio, rtol=0, atol=64 * 2**-53)


@given(st.floats(0.3, 1), tangentials, st.floats(1e-3, 10))
def test_a_sphere_is_the_bouncing_ball(normal: float, tangential: float, drop: float) -> None:
    """ε = ε_n, and the impacts come after √(2d/g) and then flights that shrink by ε_n each."""
    data = bounce(0.0, normal, tangential, particles=1, impacts=8, release_height=RADIUS + drop)
    # The impulse (1 + ε)v is the result of seven roundings.
    np.testing.assert_allclose(
        data.restitution[0], normal, rtol=0, atol=(7 * (1 + normal) + 2 * normal) * 2**-53
    )
    first = math.sqrt(2 * drop / 9.81)
    flights = np.concatenate([[first], 2 * first * normal ** np.arange(1, 8)])
    # Release height less radius is rounded once more; each impact passes on its error, 16/ε half-ulps.
    allowed = (16 + 2 * RADIUS / drop + 16 * 8 / normal) * 2**-53
    np.testing.assert_allclose(data.time[0], np.cumsum(flights), rtol=allowed)


@settings(max_examples=30)
@given(elongations, normals, tangentials, st.integers(2, 8))
def test_threads_do_not_show(elongation: float, normal: float, tangential: float, threads: int) -> None:
    """One seed, the same bits on one thread or many; and the first particles do not know of the others."""
    one = bounce(elongation, normal, tangential, particles=100, threads=1)
    xr.testing.assert_identical(one, bounce(elongation, normal, tangential, particles=100, threads=threads))
    some = bounce(elongation, normal, tangential, particles=37)
    for name in (*COLUMNS, "contact", "impacts", "stop_reason", "release_angle"):
        np.testing.assert_array_equal(some[name], one[name][:37], err_msg=name)


@given(
    st.floats(0.01, 3), st.floats(0, 1), st.lists(st.floats(0, math.pi / 2 - 1e-3), min_size=1, max_size=5)
)
def test_mirrored_releases_move_as_mirror_images(
    elongation: float, normal: float, angles: list[float]
) -> None:
    """θ → −θ is a mirror image: every number of every impact is the same to the last bit."""
    theta = np.array(angles)
    here = bounce(elongation, normal, 0.5, particles=theta.size, orientation=theta)
    there = bounce(elongation, normal, 0.5, particles=theta.size, orientation=-theta)
    given = ["release_angle", "orientation"]
    xr.testing.assert_equal(here.drop_vars(given), there.drop_vars(given))


# --- sine and cosine ----------------------------------------------------------------------------------------

# Of all doubles next to a multiple of π/2 these are where the error is the largest part of the value.
NEAREST = [
    float.fromhex(x) for x in ("0x1.39c6fd67805a7p+19", "0x1.a9adcc7f96cf0p+19", "0x1.93c05c9ed3cbcp+19")
]
NEAREST += [
    float.fromhex(x) for x in ("0x1.23d98d86bd573p+19", "0x1.edb9bbd6273d1p+19", "0x1.921fb54442d18p+0")
]
# Of 230 000 arguments of all magnitudes these two had the largest error of the sine and of the cosine in ulp.
ROUGHEST = [float.fromhex("0x1.00d53ca9a1108p+17"), float.fromhex("0x1.b5067d6340a1cp+19")]
TINY = [0.0, 5e-324, 1e-310, 2.2250738585072014e-308, 1e-200, 1e-17, 2**-28, 2**-27]


def arguments() -> npt.NDArray[np.float64]:
    random = np.random.default_rng(2014)
    multiples = random.integers(1, 667_544, 1000) * (math.pi / 2)
    return np.concatenate(
        [
            [*NEAREST, *ROUGHEST, *TINY, 2.0**20],
            random.uniform(0, 2**20, 2000),
            random.uniform(0, 10, 2000),
            10 ** random.uniform(-300, 6, 1000),
            *(np.nextafter(multiples, limit) for limit in (0.0, math.inf)),
            multiples,
        ]
    )


def test_sine_and_cosine_against_many_digits() -> None:
    """Within 1.5 ulp and 10⁻²⁷ of the exact value.

    Two doubles fall short of π/2 by 1.5·10⁻³³, which next to kπ/2, k ≤ 667 544, is seen k times. Elsewhere
    the worst of three million arguments of all magnitudes has an error of 1.48 ulp.
    """
    with mpmath.workprec(200):
        for x in map(float, arguments()):
            found = sincos(x)
            assert sincos(-x) == (-found[0], found[1])
            for value, function in zip(found, (mpmath.sin, mpmath.cos), strict=True):
                exact = function(mpmath.mpf(x))
                error = float(abs(mpmath.mpf(value) - exact))
                assert error <= 1.5 * math.ulp(float(exact)) + 1e-27, f"{function} of {x.hex()}: {error}"


@pytest.mark.parametrize("x", TINY)
def test_sine_of_little_is_little(x: float) -> None:
    """Up to 2⁻²⁷ sin x is x and cos x is 1 to the last bit, down to the least double."""
    assert sincos(x) == (x, 1.0)


# --- files --------------------------------------------------------------------------------------------------


def test_a_dataset_survives_a_file(tmp_path: Path) -> None:
    """Values, NaN, types, names, units, flags and parameters: all are read back as they were written."""
    data = bounce(0.5, 0.5, 0.2, impacts=200, minimum_speed=0.1, seed=2**64 - 1)
    assert len(np.unique(data.stop_reason)) >= 1
    assert np.isnan(data.restitution).any()
    path = tmp_path / "run.nc"
    data.to_netcdf(path)
    with xr.open_dataset(path) as file:
        read = file.load()
    xr.testing.assert_identical(data, read)
    for name, variable in data.variables.items():
        assert read[name].dtype == variable.dtype, name
    assert read.stop_reason.dtype == read.contact.dtype == np.int8
    assert read.impacts.dtype == np.int64
    assert int(read.attrs["seed"]) == 2**64 - 1
    for flag in (read.contact, read.stop_reason):
        # The CF conventions want flags of the variable's own type.
        assert flag.attrs["flag_values"].dtype == flag.dtype
        assert len(flag.attrs["flag_meanings"].split()) == flag.attrs["flag_values"].size
        assert set(np.unique(flag)) <= set(flag.attrs["flag_values"])


def test_a_file_tells_how_to_repeat_the_run() -> None:
    """The attributes alone are enough to compute the same bits again."""
    data = bounce(0.3, 0.9, 0.7, seed=12345, release_height=0.05, gravity=1.62, minimum_speed=0.01)
    a = data.attrs
    again = rs.simulate(
        rs.Dumbbell(radius=a["radius"], separation=a["separation"], density=a["density"]),
        rs.TangentialRestitution(normal=a["normal"], tangential=a["tangential"]),
        particles=int(a["particles"]),
        impacts=int(a["impacts"]),
        release_height=a["release_height"],
        gravity=a["gravity"],
        orientation=a["orientation"],
        minimum_speed=a["minimum_speed"],
        seed=int(a["seed"]),
    )
    xr.testing.assert_identical(data, again)


# --- while it runs ------------------------------------------------------------------------------------------


def test_progress_is_shown_and_changes_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    """The bar is on standard error, and ends with all particles done."""
    quiet = bounce(0.1, 0.98, 1.0)
    assert capsys.readouterr().err == ""
    told = bounce(0.1, 0.98, 1.0, progress=True)
    out, err = capsys.readouterr()
    assert out == ""
    assert re.search(r"100%.*20/20", err)
    xr.testing.assert_identical(quiet, told)


LONG = """
    import os, signal, time
    from contextlib import contextmanager
    import numpy as np
    import xarray
    os.environ["RESTITUTION_SIMD"] = "scalar"  # the slowest, to have something to interrupt
    import restitution as rs
    from restitution.drop import simulate as simulation

    pressed = []

    def press(done):
        if done and not pressed:
            pressed.append(time.process_time())
            signal.raise_signal(signal.SIGINT)

    @contextmanager
    def press_when_begun(*_, **__):
        yield press

    simulation.progress_bar = press_when_begun
    body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    law = rs.TangentialRestitution(normal=0.9999)
    try:
        rs.simulate(body, law, particles=3000, impacts=2000, threads=1)
        print("not interrupted")
    except rs.SimulationInterrupted as stop:
        assert isinstance(stop, KeyboardInterrupt)
        seconds = time.process_time() - pressed[0]
        data = stop.data
    done = np.flatnonzero(data.stop_reason != 4)
    np.testing.assert_array_equal(np.isfinite(data.restitution).sum("impact"), data.impacts)
    whole = rs.simulate(body, law, particles=3000, impacts=20)
    xarray.testing.assert_equal(whole.restitution[done], data.restitution[done, :20])
    print("stopped", seconds, done.size)
"""


def test_ctrl_c_stops_within_a_second_and_keeps_what_was_done() -> None:
    """SIGINT when the first particles are done: those keep their bits, the others say that they were cut.

    Seconds are the processor's, for a machine may be busy with other things.
    """
    word, seconds, done = Program(textwrap.dedent(LONG)).said().split()
    assert word == "stopped"
    assert float(seconds) < 1.0
    assert 0 < int(done) < 3000


def test_an_error_in_the_progress_bar_is_not_swallowed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever shows the progress may fail; that ends the run and comes out as it is."""

    def fail(done: int) -> None:
        raise ZeroDivisionError(done)

    monkeypatch.setattr(simulation, "progress_bar", lambda *_, **__: nullcontext(fail))
    with pytest.raises(ZeroDivisionError):
        bounce(0.1, 0.98, 1.0, progress=True)


def test_a_table_that_no_machine_can_address_is_an_error() -> None:
    """Asked for behind the checks; nothing aborts, and the error says what for."""
    run = Run(body=rs.Dumbbell(radius=RADIUS, separation=RADIUS), law=rs.Frictionless(normal=0.9), impacts=1)
    with pytest.raises(
        MemoryError, match=r"^particles \* impacts: .* GB more are needed, which this process"
    ):
        _core.simulate({**run.parameters(), "particles": 2**61}, 1, None)
