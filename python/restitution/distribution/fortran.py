"""A distribution as a Fortran module that needs nothing else."""

import xarray as xr

from restitution.distribution import _store
from restitution.distribution._table import Floats, Ints, Table
from restitution.distribution._text import about, checked_name, chunks, gaps

_FUNCTIONS = """
contains

  !> The last of increasing points that is <= x, but not the last of all.
  pure integer function NAME_below(points, x) result(low)
    real(dp), intent(in) :: points(:), x
    integer :: high, middle
    low = 1
    high = size(points)
    do while (high - low > 1)
      middle = low + (high - low) / 2
      if (points(middle) <= x) then
        low = middle
      else
        high = middle
      end if
    end do
  end function NAME_below

  !> Chooses one of two neighbouring points, in proportion to how near x is; u is uniform again afterwards.
  pure subroutine NAME_choose(points, x, u, chosen)
    real(dp), intent(in) :: points(:), x
    real(dp), intent(inout) :: u
    integer, intent(out) :: chosen
    real(dp) :: weight
    chosen = 1
    if (size(points) == 1) return
    chosen = NAME_below(points, x)
    weight = (x - points(chosen)) / (points(chosen + 1) - points(chosen))
    weight = min(max(weight, 0.0_dp), 1.0_dp)
    if (u < weight) then
      u = u / weight
      chosen = chosen + 1
    else
      u = (u - weight) / (1.0_dp - weight)
    end if
  end subroutine NAME_choose

  !> The quantile of u in a histogram.
  pure real(dp) function NAME_quantile(edges, shares, u) result(x)
    real(dp), intent(in) :: edges(:), shares(:), u
    integer :: bin
    bin = NAME_below(shares, u)
    x = edges(bin) + (u - shares(bin)) &
      * ((edges(bin + 1) - edges(bin)) / (shares(bin + 1) - shares(bin)))
  end function NAME_quantile

  !> A restitution at impact velocity v.
  elemental real(dp) function NAME_sample(v, u1, u2) result(x)
    real(dp), intent(in) :: v, u1, u2
    real(dp) :: u
    integer :: node, first, last
RANGE
    u = u1
    call NAME_choose(NAME_velocity, v, u, node)
    first = NAME_start(node) + 1
    last = NAME_start(node + 1)
    x = NAME_quantile(NAME_edge(first:last), NAME_probability_below(first:last), u2)
  end function NAME_sample
"""

_GIVEN = """
  !> A restitution at impact velocity v under condition z.
  elemental real(dp) function NAME_sample_given(v, z, u1, u2) result(x)
    real(dp), intent(in) :: v, z, u1, u2
    real(dp) :: u
    integer :: node, component, first, last
RANGE
SEEN
    u = u1
    call NAME_choose(NAME_velocity, v, u, node)
    first = NAME_given_first(node) + 1
    last = NAME_given_first(node + 1)
    call NAME_choose(NAME_given(first:last), z, u, component)
    component = first - 1 + component
    first = NAME_given_start(component) + 1
    last = NAME_given_start(component + 1)
    x = NAME_quantile(NAME_given_edge(first:last), NAME_given_probability_below(first:last), u2)
  end function NAME_sample_given
"""

_RANGE = """    if (.not. (v >= NAME_velocity(1) .and. v <= NAME_velocity(size(NAME_velocity)))) then
      x = ieee_value(v, ieee_quiet_nan)
      return
    end if"""

_GAP = """
    if (any(v >= NAME_gap_lowest .and. v < NAME_gap_highest)) then
      x = ieee_value(v, ieee_quiet_nan)
      return
    end if"""

_PER_LINE, _PER_STATEMENT = 4, 400

_SEEN = """    node = NAME_below(NAME_velocity, v)
    if (.not. (z >= minval(NAME_given_lowest(node:node + 1)) &
      .and. z <= maxval(NAME_given_highest(node:node + 1)))) then
      x = ieee_value(x, ieee_quiet_nan)
      return
    end if"""


def module(data: xr.Dataset, name: str) -> str:
    """Write the module; see `FluctuatingRestitution.to_fortran`."""
    checked_name(name)
    checked = data.attrs["beyond"] != "clamp"
    public = [f"{name}_sample"]
    lines = [f"!> {line}".rstrip() for line in about(data)]
    functions = _FUNCTIONS
    declarations = _declared(name, "", _store.table(data))
    if "given" in data.attrs:
        public.append(f"{name}_sample_given")
        functions += _GIVEN
        declarations += _declared(name, "given_", _store.table(data, "given_"))
        if checked:
            for key in ("given_lowest", "given_highest"):
                declarations += _data(f"{name}_{key}", data[key].to_numpy())
    range_ = _RANGE
    if checked and len(gaps(data)):
        for key, ends in zip(("gap_lowest", "gap_highest"), gaps(data).T, strict=True):
            declarations += _data(f"{name}_{key}", ends)
        range_ += _GAP
    lines += [f"module {name}"]
    if checked:
        lines += ["  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan"]
    lines += ["  implicit none", "  private", f"  public :: {', '.join(public)}"]
    lines += ["  integer, parameter :: dp = kind(1.0d0)", *declarations]
    functions = functions.replace("SEEN\n", f"{_SEEN}\n" if checked else "")
    functions = functions.replace("RANGE\n", f"{range_}\n" if checked else "").replace("NAME", name)
    return "\n".join(lines) + "\n" + functions + f"\nend module {name}\n"


def _declared(name: str, prefix: str, table: Table) -> list[str]:
    arrays: dict[str, Floats | Ints] = {f"{prefix}start": table.start}
    if prefix:
        arrays |= {f"{prefix}first": table.first, "given": table.conditions}
    else:
        arrays |= {"velocity": table.speeds}
    arrays |= {f"{prefix}edge": table.edges, f"{prefix}probability_below": table.cumulative}
    return [line for key, values in arrays.items() for line in _data(f"{name}_{key}", values)]


def _data(name: str, values: Floats | Ints) -> list[str]:
    """Declare an array and fill it, in statements short enough for the standard's limit of their length."""
    kind = "integer" if values.dtype.kind == "i" else "real(dp)"
    lines = [f"  {kind}, save :: {name}({values.size})"]
    first = 1
    for part in chunks(values, _PER_STATEMENT):
        rows = (", ".join(_number(value) for value in row.tolist()) for row in chunks(part, _PER_LINE))
        lines += [
            f"  data {name}({first}:{first + part.size - 1}) / &",
            "    " + ", &\n    ".join(rows) + " /",
        ]
        first += part.size
    return lines


def _number(value: float) -> str:
    return str(value) if isinstance(value, int) else f"{value:.16e}".replace("e", "d")
