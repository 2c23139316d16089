"""`FluctuatingRestitution`: p(ε | v), used like a distribution of scipy.stats with the argument v."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import flag, real, reals, whole
from restitution._internal.datasets import load, save
from restitution._internal.files import HEADER, MODULE, NETCDF, path_for, path_from, write
from restitution._internal.parameters import ParameterError, Problem, renamed, wrong
from restitution._internal.resources import checked_threads
from restitution._internal.text import Text, table, value
from restitution.bodies import AnyBody
from restitution.distribution import _defaults as defaults
from restitution.distribution._check import Check, largest_distance, warn_of_distance
from restitution.distribution._ensemble import Ensemble, Impacts
from restitution.distribution._from_statistics import from_statistics
from restitution.distribution._learn import Given, checked_speeds, condition, learn
from restitution.distribution._store import sealed, unsealed
from restitution.distribution._table import Floats
from restitution.distribution._tabulated import TabulatedDistribution
from restitution.distribution.sources import header, module, released
from restitution.drop import energy
from restitution.drop.recorded import check_filled, check_successive, records
from restitution.drop.release import RandomHeight
from restitution.drop.run import Run, Surroundings, takes_run
from restitution.laws import CollisionLaw

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from restitution.figures.style import Style

_IMAGES = (".png", ".pdf", ".svg")


class FluctuatingRestitution(TabulatedDistribution):
    """The coefficient of restitution as a random number whose distribution depends on the impact velocity.

    Make it with `learn`, `from_statistics` or `load`. The methods follow the conventions of `scipy.stats`,
    and broadcast their arguments against the impact velocity v, in m/s.

    At each of some tens to hundreds of speeds, the nodes, stands a histogram with bins of equal probability
    that halve towards the tails; a sphere's is one bin, as wide as rounding. Between two nodes
    p(ε | v) = (1 - w) p_i(ε) + w p_(i+1)(ε), w linear in v, so that density, distribution function,
    quantiles, draws and moments all belong to one distribution, continuous in v. The impacts were counted at
    both nodes beside them with the same weights. The support ends at the least and the greatest ε that were
    seen; ε < 0 and ε > 1 are as probable as they were found.

    A speed outside `velocities` is refused, or taken as the nearest learned one by what `clamped` returns. So
    is one in the `gaps`, ranges of a per cent and more in which no impact was seen; what `clamped` returns
    goes on to interpolate there.

    With ``given``, p(ε | v, z) is known as well, see `learn`. A condition that no impact at that speed had is
    refused or taken as the nearest by the same rule.

    ε alone says nothing of the rotation that pays for ε > 1: `PairKernel` draws both, of two bodies or of one
    and a plane, for the kinetic theory of a gas.

    Attributes
    ----------
    data : xarray.Dataset
        The tables, how they were learned (all parameters in the attributes, with the heights of release and
        ``heights_about`` where those were spread about one), their standard errors, and
        ``ks_distance``, the Kolmogorov–Smirnov distance between each two nodes to a fresh ensemble with other
        random numbers.

    Examples
    --------
    >>> import restitution as rs
    >>> dist = rs.FluctuatingRestitution.learn(
    ...     rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98),
    ...     particles=400, velocities=(0.2, 0.6))
    >>> low, high = dist.ppf([0.05, 0.95], 0.3)
    >>> bool(low < 0.98 < high)
    True
    """

    @classmethod
    @takes_run(Surroundings)
    def learn(
        cls,
        body: AnyBody,
        law: CollisionLaw,
        *,
        particles: int = 20_000,
        impacts: int | None = None,
        release_height: npt.ArrayLike | RandomHeight | None = None,
        heights_about: float | None = None,
        minimum_speed: float | None = None,
        velocities: npt.ArrayLike | None = None,
        given: Given | None = None,
        threads: int | None = None,
        progress: bool = False,
        **run: Unpack[Surroundings],
    ) -> FluctuatingRestitution:
        """Learn p(ε | v) from an ensemble of bouncing particles.

        The ensemble is simulated in rounds, and again with other random numbers to measure how far the result
        is from impacts that it was not learned from. Memory does not grow with the number of particles.
        Orientations or spins that are given for each particle are dealt out to the heights at random; if
        nothing is random, no fresh ensemble can be drawn, and this is an error.

        Parameters
        ----------
        body, law, particles, threads, progress
            As in `restitution.simulate`.
        %(run)s
        impacts : int, optional
            The most impacts of a particle. By default, as many as it takes ninety-nine of a hundred
            particles to become slower than `minimum_speed`, 4096 at most: those that are slow early are
            unusual.
        release_height : float, array_like or RandomHeight, optional
            Height of the centre of mass at release, in m, as in `restitution.simulate` and
            `restitution.statistics`, whose impacts then have the same distribution; of an array, equal parts
            from each. From a single height the first impacts have few separate speeds, and p(ε | v) as fine
            a structure.
        heights_about : float, default 0.06
            Instead of `release_height`: from heights about this one, in m, one loss of energy to either side,
            dense in the middle and none at the ends, so that impacts of one number fade into those of the
            next. Near the speed of the first impact σ(ε) may be twice that of one height. One loss is that
            of ε_n; of a law of one's own, the mean loss of the first impacts of 64 particles.
        minimum_speed : float, optional
            As in `restitution.simulate`; by default the speed from which no learned impact velocity is
            reached.
        velocities : array_like, optional
            The least and the greatest impact velocity to learn, in m/s, or all nodes. By default from 0.04 to
            0.4 of the velocity of the first impact, in nodes as close as the number of impacts allows.
        given : {"rotational_fraction", "previous"}, optional
            Also learn p(ε | v, z) with z the rotational share of the kinetic energy before the impact
            (Eq. 12), or the quantile level, `cdf`, of the particle's previous ε at its own impact velocity:
            ``z = dist.cdf(ε, v)``, then ``ε = dist.rvs(v, given=z)`` at the next v is a Markov chain.

        Raises
        ------
        ValueError
            If a parameter is out of range, or there are too few impacts at some of the speeds.

        Warns
        -----
        DistanceWarning
            If fresh impacts are farther from the result than 0.05 in the sense of Kolmogorov and Smirnov, and
            than 3.5 times what their scatter explains, or than 0.1. docs/theory.md says what to do.
        EnergyWarning, PullWarning
            If impacts created kinetic energy, so that a gas of it may heat itself, or let the plane pull.

        Examples
        --------
        >>> import restitution as rs
        >>> body = rs.Dumbbell(radius=3e-3, separation=3e-4)
        >>> law = rs.TangentialRestitution(normal=0.98)
        >>> dist = rs.FluctuatingRestitution.learn(body, law, particles=400, velocities=(0.2, 0.6))
        >>> dist.rvs(0.3, size=3, random_state=1).shape
        (3,)
        """
        about = release_height is None
        if not about and heights_about is not None:
            allowed = "None, because release_height is given"
            raise ParameterError(wrong("heights_about", heights_about, allowed))
        if release_height is None:
            release_height = real(
                "heights_about", 0.06 if heights_about is None else heights_about, "a height in m"
            )
        heights = [release_height] if isinstance(release_height, RandomHeight) else _heights(release_height)
        arguments = run | {
            "particles": particles,
            "impacts": 1 if impacts is None else impacts,
            "minimum_speed": 0.0 if minimum_speed is None else minimum_speed,
        }
        several = not isinstance(release_height, RandomHeight) and np.ndim(release_height) > 0
        runs = list(_runs(body, law, arguments, heights, several))
        first = runs[0]
        nodes = checked_speeds(velocities, min(runs, key=lambda one: one.heights[0]))
        if minimum_speed is None:
            first = first.model_copy(update={"minimum_speed": defaults.minimum_speed(first, float(nodes[0]))})
        number = checked_threads(threads) or None
        if impacts is None:
            most = defaults.impacts(first, number)
            first = first.model_copy(update={"impacts": most})
        spread = defaults.heights(first, number) if about else tuple(one.release_height for one in runs)
        ensemble = Ensemble(
            first, spread, threads, fraction=isinstance(given, str) and given == "rotational_fraction"
        )
        found = cls(learn(ensemble, nodes, given, progress))
        if about:
            found.data.attrs["heights_about"] = first.release_height
        energy.warn(found.data, stacklevel=2)
        warn_of_distance(found.data, stacklevel=2)
        return found

    @classmethod
    def from_statistics(cls, statistics: xr.Dataset) -> FluctuatingRestitution:
        """Take p(ε | v) from counts, such as those of `restitution.statistics` or `restitution.reduce`.

        The nodes are the centres of the velocity bins, the edges those of the restitution bins, thinned to
        equal probability; what lies beyond the bins reaches to the extremes. Nothing is known then of the
        particles behind the counts, so there are no standard errors, and there was no fresh ensemble.

        Parameters
        ----------
        statistics : xarray.Dataset
            With velocity bins, and the smallest and largest restitution in each, which ``counts_only=True``
            leaves out. At both ends bins of fewer than 500 impacts are left out.

        Raises
        ------
        ValueError
            If fewer than two bins have enough impacts, or some between them have not, or counts, edges
            and extremes are not those of statistics.
        """
        return cls(from_statistics(statistics))

    @classmethod
    def load(cls, path: str | Path) -> FluctuatingRestitution:
        """Read a distribution that `save` wrote."""
        path = path_from("path", path)
        data = unsealed(load(path), str(path))
        try:
            return cls(data)
        except ValueError as error:
            raise ParameterError(Problem(str(path), f": {error}")) from error

    def save(self, path: str | Path, *, replace: bool = False) -> None:
        """Write a netCDF file, whole or not at all; an existing one only with ``replace``."""
        save(sealed(self.data), path_for("path", path, NETCDF), replace=flag("replace", replace))

    def to_c(self, path: str | Path, *, name: str = "restitution", replace: bool = False) -> None:
        """Write a C99 and C++ header with the table and ``double restitution_sample(v, u1, u2)``.

        It needs nothing but the standard library. u1 and u2 are uniform random numbers of the caller's own.
        Where the methods here refuse a speed or a condition it gives NaN; what `clamped` returns takes them
        as the nearest. With a condition there is ``restitution_sample_given(v, z, u1, u2)``, too.

        Parameters
        ----------
        path : str or Path
            Written whole or not at all; an existing file only with `replace`.
        name : str
            What all names in the header start with.
        """
        path = path_for("path", path, HEADER)
        write(path, header(self.data, name).encode("ascii"), replace=flag("replace", replace))

    def to_fortran(self, path: str | Path, *, name: str = "restitution", replace: bool = False) -> None:
        """Write a Fortran 2008 module with the table and the elemental ``restitution_sample(v, u1, u2)``.

        As `to_c`; `name` is also that of the module.
        """
        path = path_for("path", path, MODULE)
        write(path, module(self.data, name).encode("ascii"), replace=flag("replace", replace))

    def figure(self, *, style: Style | None = None) -> Figure:
        """Draw quantiles over v, densities with confidence bands, σ(ε) and the distance to fresh impacts.

        With a condition also what ε is at three values of it. `savefig` of the figure writes it to a file.

        Parameters
        ----------
        style : str, optional
            "paper", "page" or "slides", with "-dark" for a dark ground.
        """
        from restitution.distribution._figure import draw

        return draw(self, style=style)

    def distance(self, data: xr.Dataset) -> xr.Dataset:
        """Measure how far impacts are from this distribution.

        Parameters
        ----------
        data : xarray.Dataset
            Impacts as from `restitution.simulate`.

        Returns
        -------
        xarray.Dataset
            Over the intervals between the nodes: ``ks_distance``, an upper bound, by at most 1/4096, of the
            Kolmogorov–Smirnov distance of u = F(ε | v) from uniform; ``ks_scatter``, the part of it that
            is due to the scatter of these impacts, by bootstrap over particles; and ``impacts``.
        """
        velocity, restitution = records("data", data, "impact_velocity", "restitution")
        check_filled("data", velocity)
        check = Check.of(self._table, [Impacts(velocity, restitution, np.empty((0, 0)))])
        low, high = self._table.speeds[:-1], self._table.speeds[1:]
        return xr.Dataset(
            {
                "ks_distance": ("velocity", check.distances()),
                "ks_scatter": ("velocity", check.scatter()),
                "impacts": ("velocity", check.impacts()),
            },
            coords={"velocity": ("velocity", 0.5 * (low + high), {"units": "m s-1"})},
        )

    def memory(self, data: xr.Dataset, lags: int = 5) -> xr.Dataset:
        """Measure how successive impacts of a particle depend on each other, and what the condition explains.

        If ε were independent at every impact, u = F(ε | v) would be independent from impact to impact. With a
        condition that explains all of the dependence F(ε | v, z) is.

        Parameters
        ----------
        data : xarray.Dataset
            Successive impacts as from `restitution.simulate`; only those at learned speeds count.
        lags : int, default 5
            Largest number of impacts from one to the other.

        Returns
        -------
        xarray.Dataset
            Over ``distribution`` ("p(ε | v)" and, if there is a condition, "p(ε | v, z)") and ``lag``:
            the autocorrelation ``level`` of u, and ``spread`` of |u - 1/2|, which shows whether large
            deviations follow large ones; each with its standard error over particles.
        """
        names = ("impact_velocity", "restitution", "rotational_fraction")
        lags = whole("lags", lags, 1, 10_000)
        velocity, restitution, fraction = records("data", data, *names)
        check_filled("data", velocity)
        check_successive("data", data)
        low, high = self.velocities
        inside = (velocity >= low) & (velocity <= high)
        speed = np.where(inside, velocity, np.nan)
        levels = {"p(ε | v)": self._table.value("cdf", restitution, speed)}
        if self.given is not None:
            block = Impacts(velocity, restitution, fraction)
            z = condition(self.given, block, self._table)
            levels["p(ε | v, z)"] = self._conditional.value("cdf", restitution, speed, z)
        return _correlations(levels, lags)

    def summary(self) -> str:
        """Summarise in a few lines what was learned and how well; a notebook shows the text as it reads."""
        low, high = self.velocities
        lines = [
            f"Learned from {float(self.data['impacts'].sum()):.0f} impacts at {low:.4g} to {high:.4g} m/s."
        ]
        number = self.data["impacts"].to_numpy()
        lines += [
            f"It has {number.size} histograms of {number.min():.0f} to {number.max():.0f} impacts, "
            f"{self._tails}, and {self.data.sizes['edge']} edges."
        ]
        lines += [
            f"There was no impact at {start:.4g} to {end:.4g} m/s: refused there." for start, end in self.gaps
        ]
        if "release_height" in self.data.attrs:
            lines += [f"The particles were {released(self.data.attrs)}."]
        if share := self.data.attrs.get("energy_created_share", 0.0):
            lines += [
                f"{energy.percent(share)} of the impacts created kinetic energy: a gas of it may heat itself."
            ]
        if self.given is not None:
            lines += [f"It is also given {self.data['given'].attrs['long_name']}."]
        if "ks_distance" in self.data:
            lines += [f"It is at most {largest_distance(self.data)}."]
        return Text("\n".join(lines))

    def _repr_html_(self) -> str:
        attrs, (low, high) = self.data.attrs, self.velocities
        rows = [(name, str(attrs[name])) for name in ("body", "law") if name in attrs]
        rows += [("impact velocity", value((low, high), "m/s")), ("nodes", str(self.data.sizes["node"]))]
        rows += [("impacts", f"{float(self.data['impacts'].sum()):.0f}, {self._tails}")]
        if self.given is not None:
            rows += [("given", self.given)]
        if "ks_distance" in self.data:
            rows += [("largest ks_distance", value(float(self.data["ks_distance"].max())))]
        speeds = np.array([low, (low * high) ** 0.5, high])
        dist = self.clamped()
        for v, mean, std in zip(speeds, dist.mean(speeds), dist.std(speeds), strict=True):
            rows += [(f"ε at {v:.3g} m/s", f"{mean:.4g} ± {std:.2g}")]
        return table("FluctuatingRestitution", rows)

    @property
    def _tails(self) -> str:
        digit, power = f"{1.0 / float(self.data['impacts'].min()):.0e}".split("e")
        return f"tails to {digit}e{int(power)}"

    def __repr__(self) -> str:
        low, high = self.velocities
        about = f"{low:.4g}–{high:.4g} m/s, {self._table.speeds.size} nodes, {self._tails}"
        about += f", {len(self.gaps)} gaps" if len(self.gaps) else ""
        if "ks_distance" in self.data:
            about += f", ks_distance up to {float(self.data['ks_distance'].max()):.4f}"
        return f"<FluctuatingRestitution: {about}>"


def image_format(path: Path) -> str:
    """Return the format of a figure by the end of its name."""
    if path.suffix.lower() not in _IMAGES:
        raise ParameterError(wrong("figure", path.name, f"a name that ends in {', '.join(_IMAGES)}"))
    return path.suffix[1:].lower()


def image(dist: FluctuatingRestitution, suffix: str) -> bytes:
    """Draw and encode; without a date, so that the same distribution gives the same bytes."""
    dated = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}
    content = io.BytesIO()
    dist.figure().savefig(content, format=suffix, dpi=300, metadata=dated.get(suffix))
    return content.getvalue()


def _correlations(levels: dict[str, Floats], lags: int) -> xr.Dataset:
    """Correlate quantile levels, and their distances from the median, over impacts of the same particle.

    Parameters
    ----------
    levels : dict of ndarray, shape (particles, impacts)
        Quantile levels u by the name of the distribution that they belong to; NaN where there is none. Under
        that distribution they are uniform on [0, 1], so that mean and variance are known.
    lags : int
        Largest number of impacts between the two of a pair.
    """
    scaled = {  # to variance 1
        "level": [(u - 0.5) * np.sqrt(12.0) for u in levels.values()],
        "spread": [(np.abs(u - 0.5) - 0.25) * np.sqrt(48.0) for u in levels.values()],
    }
    about = {
        "level": "autocorrelation of the quantile level of restitution",
        "spread": "autocorrelation of the distance of the quantile level from the median",
    }
    dims, numbers = ("distribution", "lag"), range(1, lags + 1)
    variables: dict[str, Any] = {}
    for kind, deviations in scaled.items():
        found = np.array([[_correlation(one, lag) for lag in numbers] for one in deviations])
        variables[kind] = (dims, found[..., 0], {"long_name": about[kind]})
        text = f"standard error of {kind}, over particles"
        variables[f"{kind}_error"] = (dims, found[..., 1], {"long_name": text})
    return xr.Dataset(variables, coords={"distribution": list(levels), "lag": np.array(numbers)})


def _correlation(deviation: Floats, lag: int) -> tuple[float, float]:
    """Return the mean product of deviations of variance 1, `lag` impacts apart, and its standard error."""
    product = deviation[:, :-lag] * deviation[:, lag:]
    pairs = np.isfinite(product)
    number = pairs.sum(axis=1)
    sums = np.where(pairs, product, 0.0).sum(axis=1)
    correlation = sums.sum() / max(number.sum(), 1)
    return correlation, np.sqrt(np.sum((sums - correlation * number) ** 2)) / max(number.sum(), 1)


def _runs(
    body: AnyBody, law: CollisionLaw, arguments: dict[str, Any], heights: Sequence[Any], several: bool
) -> Iterator[Run]:
    """Make a run from each height; what is wrong with one of several is said with its place."""
    for k, height in enumerate(heights):
        place = f"[{k}]" if several else ""
        with renamed(lambda name, place=place: name + place if name == "release_height" else name):  # type: ignore[misc]
            run = Run.called("learn", body, law, arguments | {"release_height": height})
        yield run


def _heights(release_height: npt.ArrayLike) -> list[float]:
    several = "a height or several, in m, or a RandomHeight"
    heights = reals("release_height", release_height, several, unit="m", dimensions=(0, 1), finite=False)
    if heights.size == 0:
        raise ParameterError(wrong("release_height", release_height, several))
    return [float(height) for height in heights.ravel()]
