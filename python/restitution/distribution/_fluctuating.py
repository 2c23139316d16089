"""`FluctuatingRestitution`: p(ε | v), used like a distribution of scipy.stats with the argument v."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._dataset import check_writable, save
from restitution._parameters import ParameterError, wrong
from restitution._release import RandomSpin
from restitution._run import Run
from restitution.bodies import Body
from restitution.distribution._c import header
from restitution.distribution._check import Check
from restitution.distribution._ensemble import BATCHES, Ensemble, Impacts
from restitution.distribution._fortran import module
from restitution.distribution._from_statistics import from_statistics
from restitution.distribution._learn import Given, condition, learn
from restitution.distribution._memory import correlations
from restitution.distribution._store import require
from restitution.distribution._tabulated import TabulatedDistribution
from restitution.distribution._text import image_format, write
from restitution.laws import Law

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class FluctuatingRestitution(TabulatedDistribution):
    """The coefficient of restitution as a random number whose distribution depends on the impact velocity.

    Make it with `learn`, `from_statistics` or `load`. Methods have the names and manners of `scipy.stats`,
    and broadcast their arguments against the impact velocity v, in m/s.

    At each of some tens to hundreds of speeds, the nodes, stands a histogram with bins of equal probability
    that halve towards the tails. Between two nodes p(ε | v) = (1 - w) p_i(ε) + w p_(i+1)(ε), w linear in v,
    so that density, distribution function, quantiles, draws and moments all belong to one distribution,
    continuous in v. The impacts were counted at both nodes beside them with the same weights. The support
    ends at the least and the greatest ε that were seen; ε < 0 and ε > 1 are as probable as they were found.

    Speeds outside `velocities` are an error, or taken as the nearest learned one by what `clamped` returns.

    With ``given``, p(ε | v, z) is known as well: see `learn`.

    Attributes
    ----------
    data : xarray.Dataset
        The tables, how they were learned (all parameters in the attributes), their standard errors, and
        ``ks_distance``, the Kolmogorov–Smirnov distance between each two nodes to a fresh ensemble with other
        random numbers.
    """

    @classmethod
    def learn(
        cls,
        body: Body,
        law: Law,
        *,
        particles: int = 20_000,
        impacts: int = 1000,
        release_height: npt.ArrayLike = 0.06,
        gravity: float = 9.81,
        orientation: str = "uniform-angle",
        spin: npt.ArrayLike | RandomSpin | None = None,
        velocity: npt.ArrayLike | None = None,
        incline: float = 0.0,
        minimum_speed: float = 0.0,
        seed: int = 1,
        velocities: npt.ArrayLike | None = None,
        given: Given | None = None,
        threads: int | None = None,
        progress: bool = False,
    ) -> "FluctuatingRestitution":
        """Learn p(ε | v) from an ensemble of bouncing particles.

        The ensemble is simulated in rounds, and again with other random numbers to measure how far the result
        is from impacts that it has not seen. Memory does not grow with the number of particles.

        Parameters
        ----------
        orientation, spin
            As in `restitution.simulate`, but not one for each particle.
        body, law, particles, impacts, gravity, velocity, incline, minimum_speed, seed, threads, progress
            As in `restitution.simulate`. Take `impacts` large enough for the particles
            to become slower than the least speed: those that are slow early are unusual.
        release_height : float or array_like
            Height of the centre of mass at release, in m; several heights share the particles equally.
            Particles from one height have few separate speeds at first, and p(ε | v) has as fine a structure:
            near the release velocity √(2gh), and for nearly round bodies everywhere. Heights spread over
            two losses average over it if they differ by 0.1 % in v or less, and thin out to both ends,
            so that impacts of one number fade into those of the next: with n = 2000 ln(1/ε^n),
            ``R + (h - R) * normal ** (4 * scipy.stats.triang(0.5).ppf((np.arange(n) + 0.5) / n))``.
        velocities : array_like, optional
            The least and the greatest speed to learn, in m/s, or all nodes. From 0.04 to 0.4 of the release
            velocity unless told, in nodes that lie as close as the number of impacts allows.
        given : {"rotational_fraction", "previous"}, optional
            Also learn p(ε | v, z) with z the rotational share of the kinetic energy before the impact
            (Eq. 12), or the quantile level, `cdf`, of the particle's previous ε at its own impact velocity:
            ``z = dist.cdf(ε, v)``, then ``ε = dist.rvs(v, given=z)`` at the next v is a Markov chain.

        Raises
        ------
        ValueError
            If a parameter is out of range, speeds were hardly ever met, or ε does not spread (a sphere).

        Examples
        --------
        >>> import restitution as rs
        >>> body = rs.Dumbbell(radius=3e-3, separation=3e-4)
        >>> law = rs.TangentialRestitution(normal=0.98)
        >>> dist = rs.FluctuatingRestitution.learn(body, law, particles=400, impacts=400)
        >>> dist.rvs(0.3, size=3, random_state=1).shape
        (3,)
        """
        heights = np.atleast_1d(np.asarray(release_height))
        if heights.ndim != 1 or heights.size == 0:
            raise ParameterError(wrong("release_height", release_height, "a height or several, in m"))
        runs = [
            Run(
                body=body,
                law=law,
                particles=particles,
                impacts=impacts,
                release_height=height,
                gravity=gravity,
                orientation=orientation,
                spin=spin,
                velocity=velocity,
                incline=incline,
                minimum_speed=minimum_speed,
                seed=seed,
            )
            for height in heights
        ]
        ensemble = Ensemble(runs[0], tuple(run.release_height for run in runs), threads)
        return cls(learn(ensemble, velocities, given, progress))

    @classmethod
    def from_statistics(cls, statistics: xr.Dataset) -> "FluctuatingRestitution":
        """Take p(ε | v) from counts, such as those of `restitution.statistics` or `restitution.reduce`.

        The nodes are the centres of the velocity bins, the edges those of the restitution bins, thinned to
        equal probability; what lies beyond the bins reaches to the extremes. Nothing is known then of the
        particles behind the counts, so there are no standard errors, and there was no fresh ensemble.

        Parameters
        ----------
        statistics : xarray.Dataset
            With velocity bins. At both ends bins of fewer than 500 impacts are left out.

        Raises
        ------
        ValueError
            If fewer than two bins have enough impacts, or some between them have not.
        """
        return cls(from_statistics(statistics))

    @classmethod
    def load(cls, path: str | Path) -> "FluctuatingRestitution":
        """Read a distribution that `save` wrote."""
        return cls(xr.load_dataset(path, engine="netcdf4"))

    def save(self, path: str | Path, *, replace: bool = False) -> None:
        """Write a netCDF file, whole or not at all; an existing one only with ``replace``."""
        check_writable(Path(path), replace=replace)
        save(self.data, Path(path))

    def clamped(self) -> "FluctuatingRestitution":
        """Give the same distribution, with speeds beyond the learned ones taken as the nearest of them."""
        return FluctuatingRestitution(self.data.assign_attrs(beyond="clamp"))

    def to_c(self, path: str | Path, *, name: str = "restitution", replace: bool = False) -> None:
        """Write a C99 and C++ header with the table and ``double restitution_sample(v, u1, u2)``.

        It needs nothing but the standard library. u1 and u2 are uniform random numbers of the caller's own.
        Speeds beyond the learned ones give NaN; what `clamped` returns takes them as the nearest. With a
        condition there is ``restitution_sample_given(v, z, u1, u2)``, too.

        Parameters
        ----------
        path : str or Path
            Written whole or not at all; an existing file only with `replace`.
        name : str
            What all names in the header start with.
        """
        write(Path(path), header(self.data, name), replace=replace)

    def to_fortran(self, path: str | Path, *, name: str = "restitution", replace: bool = False) -> None:
        """Write a Fortran 2008 module with the table and the elemental ``restitution_sample(v, u1, u2)``.

        As `to_c`; `name` is also that of the module.
        """
        write(Path(path), module(self.data, name), replace=replace)

    def figure(self) -> "Figure":
        """Draw quantiles over v, densities with confidence bands, σ(ε) and the distance to fresh impacts."""
        from restitution.distribution._figure import draw

        return draw(self)

    def draw(self, path: str | Path, *, replace: bool = False) -> None:
        """Write `figure` as .png, .pdf or .svg, whole or not at all."""
        from restitution.distribution._figure import image

        write(Path(path), image(self, image_format(Path(path))), replace=replace)

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
            Kolmogorov–Smirnov distance of u = F(ε | v) from uniform; ``ks_scatter``, what the impacts' own
            scatter makes of it, by bootstrap over particles; and ``impacts``.
        """
        names = ("impact_velocity", "restitution")
        require(data, "data", names, "a result of restitution.simulate")
        check = Check(self._table)
        columns = [data[name].transpose("particle", ...).to_numpy() for name in names]
        for batch in range(BATCHES):
            check.add(batch, *(column[batch::BATCHES] for column in columns))
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

        If ε were drawn anew at every impact, u = F(ε | v) would be independent from impact to impact. With a
        condition that explains all of the dependence F(ε | v, z) is.

        Parameters
        ----------
        data : xarray.Dataset
            Impacts as from `restitution.simulate`; only those at learned speeds count.
        lags : int, default 5
            Largest number of impacts from one to the other.

        Returns
        -------
        xarray.Dataset
            Over ``distribution`` ("p(ε | v)" and, if there is a condition, "p(ε | v, z)") and ``lag``:
            the autocorrelation ``level`` of u, and ``spread`` of |u - 1/2|, which tells whether wide follows
            wide; each with its standard error over particles.
        """
        names = ("impact_velocity", "restitution", "rotational_fraction")
        require(data, "data", names, "a result of restitution.simulate")
        if isinstance(lags, bool) or not isinstance(lags, int) or lags < 1:
            raise ParameterError(wrong("lags", lags, "a whole number > 0"))
        velocity, restitution, fraction = (
            data[name].transpose("particle", "impact").to_numpy() for name in names
        )
        low, high = self.velocities
        inside = (velocity >= low) & (velocity <= high)
        speed = np.where(inside, velocity, np.nan)
        levels = {"p(ε | v)": self._table.value("cdf", restitution, speed)}
        if self.given is not None:
            block = Impacts(velocity, restitution, fraction)
            z = condition(self.given, block, self._table)
            levels["p(ε | v, z)"] = self._conditional.value("cdf", restitution, speed, z)
        return correlations(levels, lags)

    def summary(self) -> Iterator[str]:
        """Say in a few lines what was learned and how well."""
        low, high = self.velocities
        yield f"{float(self.data['impacts'].sum()):.0f} impacts at {low:.4g} to {high:.4g} m/s"
        yield f"{self.data.sizes['node']} histograms, {self.data.sizes['edge']} edges"
        if "ks_distance" in self.data:
            worst = int(np.argmax(self.data["ks_distance"].to_numpy()))
            speed, scatter = (float(self.data[name][worst]) for name in ("velocity", "ks_scatter"))
            yield (
                "Kolmogorov-Smirnov distance to fresh impacts: "
                f"{float(self.data['ks_distance'][worst]):.4f} at most, at {speed:.4g} m/s, "
                f"where their own scatter makes {scatter:.4f}"
            )

    def __repr__(self) -> str:
        low, high = self.velocities
        about = f"{low:.4g}–{high:.4g} m/s, {self._table.speeds.size} nodes"
        if "ks_distance" in self.data:
            about += f", ks_distance up to {float(self.data['ks_distance'].max()):.4f}"
        return f"<FluctuatingRestitution: {about}>"


def learn_run(
    run: Run,
    *,
    velocities: npt.ArrayLike | None = None,
    given: Given | None = None,
    threads: int | None = None,
    progress: bool = False,
) -> FluctuatingRestitution:
    """`FluctuatingRestitution.learn` for parameters that are already checked."""
    ensemble = Ensemble(run, (run.release_height,), threads)
    return FluctuatingRestitution(learn(ensemble, velocities, given, progress))
