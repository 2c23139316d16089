"""The explorer outside the browser: its module, its links, its server, its widget."""

import base64
import hashlib
import json
import sys
import threading
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs

import numpy as np
import pytest

import restitution as rs
from reference.command import Program
from restitution import bodies
from restitution._internal.described import kebab
from restitution.drop.run import Run
from restitution.explorer import link, page, serve
from restitution.explorer._page import MOST_IMPACTS
from restitution.explorer._widget import _run_of

ROOT = Path(__file__).parents[2]
BODY = rs.Dumbbell(radius=3e-3, separation=3e-4)
LAW = rs.TangentialRestitution(normal=0.98)
FREE: dict[str, Any] = {"orientation": "isotropic"}
ROUGH: dict[str, Any] = {"radius": 3e-3, "asperities": 10, "asperity_radius": 1e-5}
CORNERS = [(0, 0, 0), (6e-3, 0, 0), (0, 6e-3, 0), (0, 0, 6e-3)]


def test_the_module_in_the_repository_is_whole() -> None:
    # Whether it is of these sources, `make test-web` says.
    stamp = json.loads((ROOT / "web/module/restitution_web.json").read_text())
    module = (ROOT / "web/module/restitution_web.wasm").read_bytes()
    assert (stamp["module"], stamp["size"]) == (hashlib.sha256(module).hexdigest(), len(module))


def test_the_page_in_the_repository_holds_that_module() -> None:
    # Whether all of it is of these sources, `make test-web` says.
    module = (ROOT / "web/module/restitution_web.wasm").read_bytes()
    assert base64.b64encode(module).decode() in page()


def test_the_lock_file_names_no_registry() -> None:
    assert "://" not in (ROOT / "web/package-lock.json").read_text().replace('"url": "https://', "")


def values(run: Run) -> dict[str, str]:
    return {name: found[0] for name, found in parse_qs(link(run)).items()}


def test_a_link_holds_every_parameter_of_a_run() -> None:
    run = Run(
        body=rs.Spherocylinder(radius=2e-3, separation=1e-3),
        law=rs.Coulomb(normal=0.8, friction=0.25, hypothesis="poisson"),
        particles=30,
        impacts=50,
        release_height=0.05,
        gravity=1.62,
        orientation="isotropic",
        spin=(0.0, 3.0, -4.0),
        release_velocity=(0.5, 0.0, -0.1),
        incline=0.1,
        minimum_speed=0.01,
        seed=2**53 - 1,
    )
    assert values(run) == {
        "shape": "spherocylinder",
        "radius": "0.002",
        "separation": "0.001",
        "density": "2500.0",
        "law": "coulomb",
        "normal": "0.8",
        "friction": "0.25",
        "hypothesis": "poisson",
        "orientation": "isotropic",
        "spin_y": "3.0",
        "spin_z": "-4.0",
        "velocity_x": "0.5",
        "velocity_z": "-0.1",
        "impacts": "50",
        "release_height": "0.05",
        "gravity": "1.62",
        "incline": "0.1",
        "minimum_speed": "0.01",
        "particles": "30",
        "seed": "9007199254740991",
    }


@pytest.mark.parametrize("kind", bodies.KINDS)
def test_a_link_holds_every_parameter_of_any_body(kind: Any) -> None:
    body = kind.example()
    found = values(Run(body=body, law=LAW, release_height=1.0))
    assert found["shape"] == kebab(kind.__name__)
    assert {name: float(found[name]) for name in body.attributes()} == body.attributes()


BODIES: list[Any] = [
    rs.Box(a=8e-3, b=6e-3, c=4e-3),
    rs.Die(faces=20, edge=1e-2),
    rs.Ellipsoid(semi_axes=(3e-3, 2e-3, 1e-3)),
    rs.Clump(spheres=[(0, 0, 0, 1e-3), (0, 0, 1e-3, 2e-3)]),
    rs.Mesh(vertices=CORNERS, triangles=[(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]),
    rs.RoughSphere(**ROUGH, seed=7),
    rs.Superellipsoid(semi_axes=(3e-3, 2e-3, 1e-3), exponents=(4, 2)),
    rs.ConvexPolyhedron(CORNERS),
    rs.Revolution([(0, 2e-3), (5e-3, 0)]),
    rs.Cylinder(radius=3e-3, height=2e-3),
    rs.Ring(outer=3e-3, inner=2e-3, height=1e-3),
    rs.Egg(length=6e-3, width=5e-3, blunt_end=2e-3, tip=1e-3),
]


@pytest.mark.parametrize("body", BODIES, ids=lambda body: type(body).__name__)
def test_a_dataset_of_a_body_without_an_axis_is_the_link_of_its_run(body: Any) -> None:
    run = Run(body=body, law=LAW, particles=2, impacts=3, release_height=0.06, **FREE)
    assert values(_run_of(rs.simulate(body, LAW, particles=2, impacts=3, **FREE))) == values(run)
    assert values(run)["shape"] == kebab(type(body).__name__)


def test_tables_of_numbers_are_in_the_link_in_their_order() -> None:
    found = values(Run(body=BODIES[3], law=LAW, **FREE))["spheres"]
    assert np.array(found.split("_"), dtype=float).reshape(-1, 4).tolist() == [*map(list, BODIES[3].spheres)]
    vertices, triangles = values(Run(body=BODIES[4], law=LAW, **FREE))["mesh"].split("*")
    assert np.array(vertices.split("_"), dtype=float).reshape(-1, 3).tolist() == [*map(list, CORNERS)]
    assert triangles == "0_2_1_0_1_3_0_3_2_1_2_3"


def test_large_runs_are_shown_in_part() -> None:
    shown = values(Run(body=BODY, law=LAW, particles=10**6, impacts=400))
    assert int(shown["particles"]) * 400 == MOST_IMPACTS


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"body": rs.Dumbbell(radius=(3e-3, 2e-3), separation=1e-3)}, "the same for both spheres"),
        ({"body": rs.Rough(BODY, asperities=3, asperity_radius=1e-5), **FREE}, "body = Rough"),
        ({"body": rs.Clump(spheres=1001 * [(0, 0, 0, 1e-3)]), **FREE}, "body.spheres = 1001 rows"),
        ({"body": rs.Clump(spheres=[(0, 0, 0, 1e-3)], inertia="sum"), **FREE}, "body.inertia"),
        ({"body": rs.Box(1e-3, 1e-3, 1e-3, inertia=1e-12 * np.eye(3)), **FREE}, "body.inertia"),
        ({"body": rs.RoughSphere(**ROUGH, heights=1e-6), **FREE}, "body.heights"),
        ({"body": rs.RoughSphere(**ROUGH | {"asperities": 20_000}), **FREE}, "body.asperities"),
        (
            {"body": rs.Box(a=1e-3, b=2e-3, c=3e-3), "orientation": [[1, 0, 0, 0]], "particles": 1},
            "quaternions",
        ),
        ({"law": rs.Frictionless(normal=rs.Plastic(yield_speed=0.1))}, "law.normal = Plastic"),
        ({"orientation": [0.1, 0.2], "particles": 2}, "orientation = an array"),
        ({"spin": rs.RandomSpin(rate=10.0)}, "spin"),
        ({"spin": (1.0, 0.0, 0.0)}, "spin and release_velocity"),
        ({"seed": 2**60}, "seed"),
    ],
)
def test_what_the_page_cannot_show_is_named(change: dict[str, object], word: str) -> None:
    run = Run(**{"body": BODY, "law": LAW, **change})
    with pytest.raises(ValueError, match="the explorer shows this only if it is") as error:
        link(run)
    assert word in str(error.value)


def test_a_dataset_knows_its_run() -> None:
    law = rs.Coulomb(normal=0.9, friction=0.1)
    data = rs.simulate(BODY, law, particles=3, impacts=5, spin=(0.0, 2.0, 0.0), seed=7)
    run = _run_of(data)
    assert run == Run(body=BODY, law=law, particles=3, impacts=5, spin=(0.0, 2.0, 0.0), seed=7)
    one = rs.simulate(BODY, LAW, particles=1, impacts=2, orientation=[0.75])
    assert float(values(_run_of(one))["angle"]) == pytest.approx(0.75, abs=1e-15)
    with pytest.raises(ValueError, match="data: must be a Dataset"):
        rs.explore(data.drop_attrs())
    rough = rs.Rough(BODY, asperities=3, asperity_radius=1e-5)
    rigid = rs.simulate(rough, LAW, particles=1, impacts=2, **FREE)
    with pytest.raises(ValueError, match=r"data\.body = Rough: of rough bodies the explorer shows Rough"):
        rs.explore(rigid)


def test_the_widget_carries_page_and_link(monkeypatch: pytest.MonkeyPatch) -> None:
    data = rs.simulate(BODY, LAW, particles=3, impacts=5)
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(ImportError, match=r"restitution\[notebook\]"):
        rs.explore(data)
    monkeypatch.undo()
    pytest.importorskip("anywidget")
    monkeypatch.setattr("restitution.explorer._widget.page", lambda: "<title>page</title>")
    widget = rs.explore(data, height=500)
    assert (widget.page, widget.height) == ("<title>page</title>", 500)
    assert "particles=3" in widget.fragment
    with pytest.raises(ValueError, match="height = 0"):
        rs.explore(data, height=0)


def test_the_page_is_served_to_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("restitution.explorer._server.page", lambda: "<title>π</title>")
    told: list[str] = []
    heard = threading.Event()

    def tell(address: str) -> None:
        told.append(address)
        heard.set()

    threading.Thread(
        target=serve, args=("elongation=0.2",), kwargs={"browse": False, "tell": tell}, daemon=True
    ).start()
    assert heard.wait(10)
    address, _, fragment = told[0].partition("#")
    assert (address.startswith("http://127.0.0.1:"), fragment) == (True, "elongation=0.2")
    with urllib.request.urlopen(address, timeout=10) as answer:
        assert answer.read().decode() == "<title>π</title>"
        assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
    with pytest.raises(urllib.error.HTTPError, match="404") as refused:
        urllib.request.urlopen(f"{address}other", timeout=10)
    refused.value.close()
    with pytest.raises(ValueError, match="port = -1"):
        serve(port=-1)


EARLY = """
import queue, socket, struct, threading, time, urllib.request
from restitution.explorer import serve

told = queue.Queue()
threading.Thread(target=serve, kwargs={"browse": False, "tell": told.put}, daemon=True).start()
address = told.get(timeout=30)
port = int(address.split(":")[2].strip("/"))
for asks in (b"GET / HTTP/1.0\\r\\n\\r\\n", b"GET /"):
    for _ in range(5):
        browser = socket.create_connection(("127.0.0.1", port))
        browser.sendall(asks)
        browser.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        browser.close()  # with a reset, while the page is on its way
        time.sleep(0.05)
print(len(urllib.request.urlopen(address).read()) > 1_000_000)
"""


def test_a_browser_that_closes_early() -> None:
    """Has its page later; meanwhile nothing is said."""
    assert Program(EARLY).said() == "True\n"
