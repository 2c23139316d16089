"""p(ε | v) as it is learned, held against fresh simulations, repetitions and a known distribution."""

from functools import partial
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

import restitution as rs
from reference.ensembles import BODY, LAW, TOUCHING, heights
from restitution import _core
from restitution.distribution import FluctuatingRestitution, _ensemble, _learn, _nodes, _pilot
from restitution.distribution._check import Check
from restitution.distribution._count import Counter
from restitution.distribution._ensemble import FRESH, LEARNING, Ensemble, Impacts
from restitution.drop.run import Run

Floats = NDArray[np.float64]


@pytest.mark.parametrize(
    ("particles", "within"), [pytest.param(110_000, 0.01, marks=pytest.mark.slow), (13_750, 0.03)]
)
def test_every_speed_is_as_simulated(particles: int, within: float) -> None:
    """Nine million impacts: no interval of one per cent in v is farther than 0.01 from fresh particles.

    An eighth of them is within three times as much. Slower impacts are left to docs/theory.md: below 0.2 m/s
    p(ε | v) has lines that no node resolves. There are twice as many fresh ones: of the full number
    0.87/√100 000 = 0.003 of a typical distance is their own noise.
    """
    how: dict[str, Any] = {"impacts": 250, "seed": 1}
    released = tuple(heights(40))
    dist = FluctuatingRestitution.learn(
        BODY, LAW, particles=particles, **how, release_height=released, velocities=(0.2, 0.85)
    )
    assert 70.0 < float(dist.data.impacts.sum()) / particles < 91.0
    assert np.diff(np.log(dist.data.velocity)).max() < 1.5 * within
    # Of what is stated the fresh particles' own scatter makes the most: its like is in what was learned.
    scatter = dist.data.ks_scatter
    assert 0.8 < float((scatter / (0.87 / np.sqrt(dist.data.fresh_impacts))).median()) < 1.3
    assert float((dist.data.ks_distance / scatter).median()) < 2.0
    fresh = Ensemble(Run(body=BODY, law=LAW, particles=2 * particles, impacts=250, seed=1000), released)
    check = Check.of(dist._table, fresh.blocks(FRESH))
    assert check.impacts().min() > 0.7 * particles
    assert check.distances().max() < within
    # What the distribution states rests on as many impacts as it was learned from.
    assert float(dist.data.ks_distance.max()) < 1.2 * within


@pytest.mark.parametrize(
    ("separation", "law", "particles", "impacts"),
    [
        (1.5e-3, LAW, 7000, 200),
        (6e-3, LAW, 8000, 200),
        (1.5e-3, rs.Frictionless(normal=0.9), 25_000, 60),
    ],
)
def test_what_is_left_is_noise(
    separation: float, law: rs.TangentialRestitution | rs.Frictionless, particles: int, impacts: int
) -> None:
    """Other bodies and laws, 10⁶ impacts: what is stated is noise, √10 times that of 10⁷.

    The fresh particles are as many, and what was learned scatters by √(2/3) of what they do. A typical
    distance is 1.3 of their scatter, and 3.7 would be exceeded in one of 10⁵ intervals if the scatter were
    known exactly. `python -m benchmarks.accuracy` is the table with ten times as many.
    """
    assert isinstance(law.normal, float)
    body = rs.Dumbbell(radius=3e-3, separation=separation)
    lowest = 3e-3 + 0.5 * separation
    released = lowest + 0.06 * np.geomspace(law.normal**2, 1.0, int(1000 * np.log(1 / law.normal)) + 2)
    how: dict[str, Any] = {"particles": particles, "impacts": impacts, "release_height": released}
    dist = FluctuatingRestitution.learn(body, law, **how, seed=4)
    assert 0.8e6 < float(dist.data.impacts.sum()) < 1.2e6
    ratio = dist.data.ks_distance / dist.data.ks_scatter
    assert 1.0 < float(ratio.median()) < 1.6
    assert float(ratio.max()) < 4.0
    assert float(dist.data.ks_distance.quantile(0.95)) < 0.01 * np.sqrt(10)


def test_bins_are_placed_from_every_height(monkeypatch: pytest.MonkeyPatch) -> None:
    """A very lossy, nearly round body in many rounds: every bin holds about the share that it was made for.

    From each height of release such a body has narrow bands of ε, and a round of the simulation has particles
    from a few of the heights only. Rounds and the part that places the bins are as much smaller here as the
    ensemble is than one of 10⁶ particles. The part has thirty impacts or more for each bin, so that the
    share scatters by 0.18 of itself, and the limit is more than four times that.
    """
    monkeypatch.setattr(_ensemble, "_IMPACTS_PER_ROUND", 12_000)
    monkeypatch.setattr(_pilot, "IMPACTS", 6000)
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.4)
    run = Run(body=body, law=law, particles=24_000, impacts=20, minimum_speed=0.1, seed=1)
    heights = 6e-3 + 0.054 * np.geomspace(0.4, 2.5, 300)
    ensemble, nodes = Ensemble(run, tuple(heights.tolist())), np.geomspace(0.2, 0.4, 8)
    pilot = _pilot.Pilot.of(ensemble, nodes[0], nodes[-1])
    scale = pilot.scale
    assert scale > 2.5
    samples = [
        _pilot.Sample(blocks, nodes, lambda _: None) for blocks in (pilot.blocks(), ensemble.blocks(LEARNING))
    ]
    few, every = (list(_learn._at_nodes(sample, nodes, [np.zeros(1)] * 8)) for sample in samples)
    for (some, where), (restitution, _) in zip(few, every, strict=True):
        edges = np.concatenate([[-np.inf], _nodes.bins(some, scale, where), [np.inf]])
        shares = np.histogram(restitution, edges)[0] / restitution.size
        number = 2.0 * (scale * some.size) ** (1 / 3)
        assert some.size / number > 30
        assert shares.max() * number < 1.8


def test_both_tails_are_there() -> None:
    """Touching spheres: ε < 0 and ε > 1 are as frequent as in a fresh run, within five standard errors."""
    dist = FluctuatingRestitution.learn(TOUCHING, LAW, particles=8000, impacts=100, velocities=(0.3, 0.6))
    low, high = dist.support(np.array([0.31, 0.45, 0.6]))
    assert np.all(low < -0.3)
    assert np.all(high > 1.5)
    data = rs.simulate(TOUCHING, LAW, particles=8000, impacts=100, seed=9)
    v, e = data.impact_velocity.to_numpy(), data.restitution.to_numpy()
    inside = (v >= 0.3) & (v < 0.6)
    for below, edge in ((True, 0.0), (False, 1.0), (True, -0.2), (False, 1.5)):
        learned = np.where(inside, dist.cdf(edge, np.where(inside, v, 0.4)), 0.0)
        learned = learned if below else np.where(inside, 1.0 - learned, 0.0)
        seen = np.where(inside & ((e < edge) if below else (e > edge)), 1.0, 0.0)
        difference = (seen - learned).sum(axis=1)  # of each particle: its impacts are correlated
        # The learned one scatters as much as the fresh one.
        error = np.sqrt(2 * difference.size) * difference.std()
        assert abs(difference.sum()) < 5 * error
        assert seen.sum() > 100


# Six nodes are far apart for this law: one seed in thirty is warned of the distance between them.
# F at a node is right.
@pytest.mark.filterwarnings("ignore::restitution.DistanceWarning")
def test_the_errors_are_those_of_repetition() -> None:
    """Thirty ensembles: the scatter of F is what each states, within a half; impacts alone would say less."""
    q = np.array([0.2, 0.5, 0.9])
    how: dict[str, Any] = {"particles": 600, "impacts": 150, "velocities": np.geomspace(0.05, 0.1, 6)}
    dists = [FluctuatingRestitution.learn(BODY, LAW, **how, seed=seed) for seed in range(30)]
    node = float(dists[0].data.velocity[2])
    x = dists[0].ppf(q, node)
    found = np.array([dist.cdf(x, node) for dist in dists])
    stated = np.sqrt(np.mean([dist.cdf_error(x, node) ** 2 for dist in dists], axis=0))
    scatter = found.std(axis=0, ddof=1)
    # The standard deviation of 30 numbers has a relative error of 1/√58; the three are not independent.
    assert np.all(np.abs(stated / scatter - 1) < 4 / np.sqrt(58))
    naive = np.sqrt(q * (1 - q) / float(dists[0].data.impacts[2]))
    assert np.all(stated > 1.2 * naive)
    for moment in ("mean", "std"):
        scatter = np.std([getattr(dist, moment)(node) for dist in dists], ddof=1)
        stated = np.sqrt(np.mean([getattr(dist, f"{moment}_error")(node) ** 2 for dist in dists]))
        assert abs(stated / scatter - 1) < 4 / np.sqrt(58)
    density = np.array([dist.pdf(x, node) for dist in dists])
    stated = np.sqrt(np.mean([dist.pdf_error(x, node) ** 2 for dist in dists], axis=0))
    assert np.all(np.abs(stated / density.std(axis=0, ddof=1) - 1) < 0.6)  # bins differ from run to run


def test_a_known_distribution_is_learned() -> None:
    """Impacts drawn from a Gaussian whose width goes as 1/v: counted at nodes, it is that Gaussian again.

    Of 400 000 impacts 12 000 or more count at a node: four times 0.5/√12 000 is 0.018, and the curvature of F
    in v adds less than 0.002 at nodes 4 % apart.
    """
    rng = np.random.default_rng(1)
    v = rng.uniform(0.1, 0.2, 400_000)
    e = 0.9 + 0.02 / v * rng.normal(size=v.size)
    nodes = np.geomspace(0.1, 0.2, 18)
    edges = [0.9 + 0.02 / node * stats.norm.ppf(np.arange(1, 100) / 100) for node in nodes]
    counter = Counter(nodes, [np.zeros(1)] * nodes.size, edges)
    counter.add(Impacts(v.reshape(20, -1), e.reshape(20, -1), np.empty((0, 0))))
    assert counter.impacts().sum() == pytest.approx(v.size)
    for node, (histogram, _, error, _) in zip(nodes, counter.histograms(), strict=True):
        exact = stats.norm.cdf(histogram.edges, 0.9, 0.02 / node)
        assert np.abs(histogram.cumulative - exact)[1:-1].max() < 0.02
        assert 0.5 < error.max() / (0.5 / np.sqrt(24_000)) < 2


def test_impacts_that_are_kept_count_as_those_that_are_simulated_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of the part that places the bins all is kept, or some, or nothing: the same impacts are counted.

    Batches then have other particles, so that standard errors differ by their own scatter. If all is kept,
    no impact is simulated twice.
    """
    monkeypatch.setattr(_pilot, "IMPACTS", 30_000)
    simulated = 0
    simulate: Any = _core.simulate_series

    def counting(runs: Any, *args: Any) -> Any:
        nonlocal simulated
        simulated += sum(part[1] - part[0] for _, part in runs)
        return simulate(runs, *args)

    monkeypatch.setattr(_core, "simulate_series", counting)
    found, numbers = [], []
    for held in (0, 40_000, 1_000_000):
        monkeypatch.setattr(_pilot, "_HELD", held)
        simulated = 0
        learn = partial(FluctuatingRestitution.learn, TOUCHING, LAW, velocities=(0.3, 0.6), seed=3)
        found.append(learn(particles=2000, impacts=100).data)
        numbers.append(simulated)
    first, second, third = found
    for other in (second, third):
        np.testing.assert_array_equal(other.velocity, first.velocity)
        np.testing.assert_array_equal(other.restitution_edge, first.restitution_edge)
        np.testing.assert_allclose(other.probability_below, first.probability_below, rtol=1e-12, atol=1e-15)
    assert numbers[0] > numbers[1] > numbers[2] == 4000
