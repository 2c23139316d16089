"""Recorded encounters as the collision rule of a simulation whose particles have no shape."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import FloatArray, check_each, generator, positive, reals, whole
from restitution._internal.parameters import ParameterError, Problem, shown, wrong
from restitution._internal.resources import check_size, checked_threads
from restitution.bodies import AnyBody
from restitution.laws import CollisionLaw
from restitution.pair._encounters import COLLAPSE, Columns, Pairs, Plane, described, rate_unit

_MANY = 20
"""The least encounters in a bin of v_n, and the number of neighbours in u_t from which one is drawn."""


class KernelDraw(NamedTuple):
    """Results of collisions, as `PairKernel.rvs` draws them.

    Examples
    --------
    >>> import restitution as rs
    >>> rs.pair.KernelDraw._fields
    ('velocity', 'rotational_change', 'contacts')
    """

    velocity: FloatArray
    """Relative velocity of the centres of mass after, shape (..., 3), in m/s."""
    rotational_change: FloatArray
    """Change of the rotational energy of each body, shape (..., 2), in J; 0 of a plane."""
    contacts: npt.NDArray[np.int64]
    """Contacts of the encounter, shape (...)."""


class PairKernel:
    """p(ε, change of E_rot, deflection | v_n, T_rot/T_tr) of two bodies, as encounters that are drawn again.

    Parameters
    ----------
    data : xarray.Dataset
        What `learn` found: the `data` of another kernel, or what was saved of it.

    Attributes
    ----------
    data : xarray.Dataset
        Over encounter, those with contact: ``ratio_number``, the place of its T_rot/T_tr among
        ``temperature_ratio``; ``centre_speed`` v_n and ``tangential_speed`` u_t, along and across the line of
        centres at the first contact (m/s); ``velocity_change`` of the relative velocity, along k from the
        second centre to the first, along the part of the velocity across k, and across both (m/s);
        ``rotational_energy_before`` and ``rotational_change`` of each body (J); ``contacts``; ``deflection``
        (rad); ``restitution_centres`` -(u'·k)/(u·k). Over temperature_ratio, ``encounter_rate``: encounters
        with contact of a particle at unit density, in m³/s (on a plane on unit area, in m/s). Attributes as
        those of `encounters`.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=1e-3, separation=1e-3)
    >>> kernel = rs.pair.PairKernel.learn(
    ...     body, body, rs.Frictionless(normal=0.9), translational_temperature=1e-8, encounters=10_000
    ... )
    >>> after = kernel.rvs([[0.0, 0.0, -0.1]], [[0.0, 0.0, 1.0]], temperature_ratio=1.0, random_state=1)
    >>> after.velocity.shape, after.rotational_change.shape
    ((1, 3), (1, 2))
    """

    def __init__(self, data: xr.Dataset) -> None:
        if not isinstance(data, xr.Dataset):
            raise ParameterError(wrong("data", data, "the data of a PairKernel"))
        rate = rate_unit(plane=data.attrs.get("other") == "Plane")
        wanted = {name: (("encounter", *last), unit) for name, (last, _, unit) in _KEPT.items()}
        wanted |= dict.fromkeys(("encounter_rate", "encounter_rate_error"), (("temperature_ratio",), rate))
        wanted["temperature_ratio"] = (("temperature_ratio",), "1")
        for name, (dims, unit) in wanted.items():
            if name not in data.variables:
                raise ParameterError(Problem("data", f" lacks {name}, which a PairKernel has"))
            if data[name].dims != dims or data[name].size == 0:
                text = f" has dimensions {dict(data[name].sizes)}: must be ({', '.join(dims)})"
                raise ParameterError(Problem(f"data.{name}", text))
            reals(f"data.{name}", data[name], "finite numbers", unit=unit)
        names = ("temperature_ratio", "centre_speed", "tangential_speed")
        ratios, speeds, across = (data[name].to_numpy() for name in names)
        for name, values in zip(names, (ratios, speeds, across), strict=True):
            check_each(f"data.{name}", values, values >= 0.0, ">= 0")
        for name, size in (("direction", 3), ("particle", 2)):
            if data.sizes[name] != size:
                raise ParameterError(Problem("data", f" has {data.sizes[name]} along {name}: must be {size}"))
        check_each("data.temperature_ratio", ratios, np.diff(ratios, prepend=-1.0) > 0.0, "increasing")
        which = data["ratio_number"].to_numpy()
        places = np.unique(which)
        if not np.array_equal(places, np.arange(len(ratios))):
            text = f" has {shown(places)}: must be 0 to {len(ratios) - 1}, each"
            raise ParameterError(Problem("data.ratio_number", text))
        bins = whole("data.attrs['bins']", data.attrs.get("bins"), 1, 10**6)
        self.data = data
        self._ratios = ratios
        # A place and a speed make one key: the largest speed recorded is a half, and no speed counts as 1.
        speed_key, across_key = 0.5 / (np.max(speeds) or 1.0), 0.5 / (np.max(across) or 1.0)
        self._keys = speed_key, across_key
        # Encounters by ratio and speed, and then by bin and speed across: each in one increasing array.
        rows = np.lexsort((speeds, which))
        sizes = np.bincount(which)
        counts = np.minimum(bins, np.maximum(sizes // _MANY, 1))
        parts = [np.arange(n) * size // n for n, size in zip(counts, sizes, strict=True)]
        starts = np.concatenate(
            [part + begin for part, begin in zip(parts, np.cumsum(sizes) - sizes, strict=True)]
        )
        place = np.repeat(np.arange(len(starts)), np.diff(starts, append=len(rows)))
        self._lowest = np.cumsum(counts) - counts
        self._edges = (which + speed_key * speeds)[rows[starts]]
        self._edges[self._lowest] = np.arange(len(ratios))
        self._starts = np.append(starts, len(rows))
        self._rows = rows[np.lexsort((across[rows], place))]
        self._across = place + across_key * across[self._rows]

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self.data.identical(other.data)

    def __hash__(self) -> int:
        return hash((type(self), *sorted(self.data.sizes.values())))

    @classmethod
    def learn(
        cls,
        body: AnyBody,
        other: AnyBody | Plane,
        law: CollisionLaw,
        *,
        translational_temperature: float,
        temperature_ratios: npt.ArrayLike = (0.5, 1.0, 2.0),
        encounters: int = 100_000,
        bins: int = 50,
        seed: int = 0,
        threads: int | None = None,
    ) -> PairKernel:
        """Follow encounters at several T_rot/T_tr and keep those with contact.

        Parameters
        ----------
        body, other : Dumbbell or another body that `encounters` takes
            The two bodies; `other` may be a `Plane`.
        law : Law or CustomLaw
            The collision law.
        translational_temperature : float
            T_tr of both bodies, in J.
        temperature_ratios : array_like
            T_rot/T_tr, increasing, each >= 0.
        encounters : int
            Number of encounters at each ratio, misses among them.
        bins : int
            Bins of v_n at each ratio, with equal numbers of encounters; fewer where these are below 20.
        seed, threads : int
            As those of `encounters`.

        Returns
        -------
        PairKernel
            Left out are encounters that ended as a collapse, and those whose centres part already at the
            first contact, which spheres never do; the attributes ``collapsed`` and ``receding`` have their
            shares.

        Raises
        ------
        ValueError
            For a wrong argument; the message names it, its value and what is allowed.
        """
        allowed = "increasing numbers >= 0"
        ratios = reals("temperature_ratios", temperature_ratios, allowed, dimensions=(1,))
        if ratios.size == 0:
            raise ParameterError(wrong("temperature_ratios", temperature_ratios, "at least one number >= 0"))
        rising = (ratios >= 0.0) & (np.diff(ratios, prepend=-1.0) > 0.0)
        check_each("temperature_ratios", ratios, rising, allowed)
        temperature = positive("translational_temperature", translational_temperature, "J")
        count, number = whole("encounters", encounters, 2, 2**40), checked_threads(threads)
        bins = whole("bins", bins, 1, 10**6)
        total = count * len(ratios)
        check_size("encounters", total, total, 16 * 8, "encounters")
        parts, shares, rates, lost = [], [], [], np.zeros(2)
        for place, ratio in enumerate(ratios.tolist()):
            warm = {"translational_temperature": temperature, "rotational_temperature": ratio * temperature}
            pairs = Pairs.of(body, other, law, encounters=count, seed=seed, **warm)
            met = 0
            for found, hits, flux in pairs.in_chunks(number, states=True, contacts=True):
                part, left_out = _kept(found, hits, place, plane=isinstance(other, Plane))
                rate, lost = flux, lost + left_out
                met += len(part["contacts"])
                parts.append(part)
            if met == 0:
                text = f": none of {count} at T_rot/T_tr = {ratio} has a contact: must be more"
                raise ParameterError(Problem("encounters", text))
            shares.append(met / count)
            rates.append(rate)
        share = np.array(shares)
        values, scatter = np.array(rates) * share, np.sqrt(share * (1.0 - share) / count)
        unit = rate_unit(plane=isinstance(other, Plane))
        about = {"long_name": "rate of encounters with contact", "units": unit}
        error = {"long_name": "standard error of encounter_rate", "units": unit}
        variables: dict[str, Any] = {
            "encounter_rate": ("temperature_ratio", values, about),
            "encounter_rate_error": ("temperature_ratio", np.array(rates) * scatter, error),
        }
        for name, (last, text, kind) in _KEPT.items():
            joined = np.concatenate([part[name] for part in parts])
            variables[name] = (("encounter", *last), joined, {"long_name": text, "units": kind})
        coordinates = {
            "temperature_ratio": ("temperature_ratio", ratios, {"long_name": "T_rot/T_tr", "units": "1"}),
            "direction": ["normal", "tangential", "binormal"],
        }
        attributes = described(pairs) | {"title": "Encounters with contact of two bodies in free flight"}
        attributes |= {"translational_temperature": temperature, "seed": seed, "bins": bins}
        attributes |= {"encounters": count, "collapsed": lost[0] / total, "receding": lost[1] / total}
        return cls(xr.Dataset(variables, coordinates, attributes))

    def rvs(
        self,
        velocity: npt.ArrayLike,
        direction: npt.ArrayLike,
        temperature_ratio: npt.ArrayLike = 1.0,
        *,
        random_state: int | np.random.Generator = 0,
    ) -> KernelDraw:
        """Draw what collisions of two particles do.

        For each an encounter is drawn from the twenty of the same bin of v_n = -u·k and the nearest
        T_rot/T_tr whose speeds across k are nearest, and the change of the relative velocity in it is turned
        to the given u and k, and scaled with v_n, but in the lowest bin, where rotation decides what happens.
        Give the first body the part m₂/(m₁ + m₂) of the change of u, and the second -m₁/(m₁ + m₂): momentum
        is exact. Energies are right in distribution, not in each collision: what happens depends on the spins
        of the recorded encounter, not on those of the two particles. So the energy of rotation of a particle
        that has little of it may become negative.

        Parameters
        ----------
        velocity : array_like, shape (..., 3)
            Relative velocity u of the centres, of the first less the second, in m/s.
        direction : array_like, shape (..., 3)
            Unit vector k from the second centre to the first; u·k < 0.
        temperature_ratio : array_like
            T_rot/T_tr of the gas.
        random_state : int or numpy.random.Generator
            A seed, or what to draw from.

        Returns
        -------
        KernelDraw
            The relative velocity after, the changes of both energies of rotation, scaled alike, and the
            number of contacts.

        Raises
        ------
        ValueError
            For a wrong argument; the message names it, its value and what is allowed.
        """
        u = reals(
            "velocity", velocity, "vectors of three finite numbers (m/s)", unit="m s-1", dimensions=None
        )
        k = reals("direction", direction, "unit vectors of three numbers", dimensions=None)
        ratio = reals("temperature_ratio", temperature_ratio, "numbers >= 0", dimensions=None)
        check_each("temperature_ratio", ratio, ratio >= 0.0, "numbers >= 0")
        for name, vectors in (("velocity", u), ("direction", k)):
            if vectors.ndim == 0 or vectors.shape[-1] != 3:
                raise ParameterError(Problem(name, f" has the shape {vectors.shape}: must be (..., 3)"))
        lengths = np.linalg.norm(k, axis=-1)
        if not np.all(np.abs(lengths - 1.0) < 1e-9):
            raise ParameterError(wrong("direction", direction, "unit vectors, of length 1"))
        try:
            shape = np.broadcast_shapes(u.shape[:-1], k.shape[:-1], ratio.shape)
        except ValueError:
            text = f" has the shape {k.shape}: must go with velocity, {u.shape}, and temperature_ratio"
            raise ParameterError(Problem("direction", f"{text}, {ratio.shape}")) from None
        u, k = (np.broadcast_to(vectors, (*shape, 3)) for vectors in (u, k))
        approach, tangential, across, third = _resolved(u, k)
        if not np.all(approach > 0.0):
            raise ParameterError(wrong("velocity", velocity, "towards each other: u·k < 0"))
        rng = generator("random_state", random_state)
        drawn, lowest = self._draw(approach, tangential, np.broadcast_to(ratio, shape), rng)
        names = ("centre_speed", "velocity_change", "rotational_change", "contacts")
        speed, change, turning, contacts = (self.data[name].to_numpy()[drawn] for name in names)
        scale = np.where(lowest, 1.0, approach / speed)[..., np.newaxis]
        change = scale * change
        after = u + change[..., :1] * k + change[..., 1:2] * across + change[..., 2:] * third
        return KernelDraw(after, scale**2 * turning, contacts)

    def _draw(
        self, speed: FloatArray, across: FloatArray, ratio: FloatArray, rng: np.random.Generator
    ) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.bool_]]:
        """Return the place of an encounter like each, and whether its v_n is in the lowest bin."""
        speed_key, across_key = self._keys
        nearest = np.searchsorted(0.5 * (self._ratios[1:] + self._ratios[:-1]), ratio)
        key = nearest + np.minimum(speed_key * speed, 0.6)
        place = np.searchsorted(self._edges, key, side="right") - 1
        low, high = self._starts[place], self._starts[place + 1]
        width = np.minimum(_MANY, high - low)
        rank = np.searchsorted(self._across, place + np.minimum(across_key * across, 0.6))
        first = np.clip(rank - width // 2, low, high - width)
        drawn = self._rows[first + (rng.random(speed.shape) * width).astype(np.intp)]
        return drawn, place == self._lowest[nearest]


_KEPT = {
    "ratio_number": ((), "place of T_rot/T_tr", "1"),
    "centre_speed": ((), "speed of the centres of mass along their line before the first contact", "m s-1"),
    "tangential_speed": (
        (),
        "speed of the centres of mass across their line before the first contact",
        "m s-1",
    ),
    "velocity_change": (("direction",), "change of the relative velocity", "m s-1"),
    "rotational_energy_before": (("particle",), "rotational energy of each body before", "J"),
    "rotational_change": (("particle",), "change of the rotational energy of each body", "J"),
    "contacts": ((), "number of contacts", "1"),
    "deflection": ((), "angle between the relative velocities before and after", "rad"),
    "restitution_centres": ((), "-(u'.k)/(u.k)", "1"),
}


def _resolved(u: FloatArray, k: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return -u·k, the size of the part of u across k, its direction, and that across both.

    Where that part is none, its direction is any one across k.
    """
    approach = -np.sum(u * k, axis=-1)
    across = u + approach[..., np.newaxis] * k
    tangential = np.linalg.norm(across, axis=-1)
    some = tangential > 1e-12 * np.linalg.norm(u, axis=-1)
    least = np.eye(3)[np.argmin(np.abs(k), axis=-1)]
    across = np.where(some[..., np.newaxis], across, np.cross(k, least))
    across = across - np.sum(across * k, axis=-1, keepdims=True) * k
    across = across / np.linalg.norm(across, axis=-1, keepdims=True)
    return approach, tangential, across, np.cross(k, across)


def _kept(each: Columns, hits: Columns, place: int, *, plane: bool) -> tuple[dict[str, Any], tuple[int, int]]:
    """Return what is kept of encounters with contact, and the numbers of those that collapsed or recede."""
    times = hits["time"]
    contacts = each["contacts"]
    starts = np.cumsum(contacts) - contacts
    collapsed = each["ending"] == COLLAPSE
    good = (contacts > 0) & ~collapsed
    of_both = {name: each[name][good] for name in ("velocity_before", "velocity_after", "position_before")}
    u, after, apart = (values[:, 0] - values[:, 1] for values in of_both.values())
    if plane:
        k = np.broadcast_to([0.0, 0.0, 1.0], u.shape)
    else:
        line = apart + times[starts[good], np.newaxis] * u
        k = line / np.linalg.norm(line, axis=-1, keepdims=True)
    change = after - u
    approach, tangential, *axes = _resolved(u, k)
    parts = np.stack([np.sum(change * axis, axis=-1) for axis in (k, *axes)], axis=-1)
    energies = [each[f"rotational_energy_{when}"][good] for when in ("before", "after")]
    found = {
        "ratio_number": np.full(len(u), place),
        "centre_speed": approach,
        "tangential_speed": tangential,
        "velocity_change": parts,
        "rotational_energy_before": energies[0],
        "rotational_change": energies[1] - energies[0],
        "contacts": contacts[good],
        "deflection": each["deflection"][good],
        "restitution_centres": each["restitution_centres"][good],
    }
    # A body that turns may hit another that its centre moves away from.
    towards = approach > 0.0
    lost = (int(np.count_nonzero(collapsed)), int(np.count_nonzero(~towards)))
    return {name: values[towards] for name, values in found.items()}, lost
