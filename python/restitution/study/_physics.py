"""What distinguishes versions of the physics: its version, and the bits of a few short runs."""

import hashlib
from functools import cache

import numpy as np

from restitution import _core
from restitution.bodies import Body, Dumbbell, LoadedSphere, Spheroid
from restitution.drop.dataset import version_here
from restitution.drop.run import Run
from restitution.laws import ChatterjeeRuina, Coulomb, Frictionless, Law, TangentialRestitution

_BODIES: tuple[Body, ...] = (
    Dumbbell(radius=1.0, separation=0.1),
    Dumbbell(radius=1.0, separation=3.0),
    LoadedSphere(radius=1.0, density=1.0, load=2.0, offset=0.3),
    Spheroid(equatorial=1.0, polar=1.5, density=1.0),
)
_LAWS: tuple[Law, ...] = (
    TangentialRestitution(normal=0.95, tangential=0.7),
    Frictionless(normal=0.9),
    Coulomb(normal=0.9, friction=0.2),
    ChatterjeeRuina(normal=0.9, tangential=0.2, friction=0.3),
)


@cache
def fingerprint() -> dict[str, str]:
    """Give the version, and SHA-256 of what the impacts of short runs of several bodies and laws add up to.

    Takes milliseconds. Runs at rest and with spin go through both engines of the core.
    """
    edges = {
        "velocity": np.linspace(0.0, 8.0, 9),
        "restitution": np.linspace(-1.0, 3.0, 41),
        "fraction": np.linspace(0.0, 1.0, 11),
    }
    digest = hashlib.sha256()
    for body in _BODIES:
        for law in _LAWS:
            for spin in ((0.0, 0.0, 0.0), (0.3, 0.2, 0.1)):
                run = Run(
                    body=body, law=law, particles=4, impacts=12, release_height=20.0, gravity=1.0, spin=spin
                )
                tally, _ = _core.tally(run.parameters(), edges, 1, None)
                digest.update(tally.words().tobytes())
    return {"version": version_here(), "runs": digest.hexdigest()}
