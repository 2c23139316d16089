"""`restitution.simulate`, including the Dataset it returns."""

from functools import partial

import restitution as rs
from benchmarks.work import Array, Peer, Records, Work


def run(work: Work, angles: Array, threads: int) -> Records:
    data = rs.simulate(
        rs.Dumbbell(radius=work.radius, separation=work.separation),
        rs.TangentialRestitution(normal=work.normal, tangential=work.tangential),
        particles=angles.size,
        impacts=work.impacts,
        release_height=work.release_height,
        gravity=work.gravity,
        orientation=angles,
        threads=threads,
    )
    return {str(name): data[name].values for name in data if data[name].dims == ("particle", "impact")}


def rows() -> list[Peer[Records]]:
    return [Peer(f"simulate, {n} thread{'s' * (n > 1)}", partial(run, threads=n)) for n in (1, 2)]
