@about
module NAME
@if checked
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
@end
  implicit none
  private
  public :: NAME_sample
@if given
  public :: NAME_sample_given
@end
  integer, parameter :: dp = kind(1.0d0)
@arrays

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
@if checked
    if (.not. (v >= NAME_velocity(1) &
      .and. v <= NAME_velocity(size(NAME_velocity)))) then
      x = ieee_value(v, ieee_quiet_nan)
      return
    end if
@end
@if gaps
    if (any(v >= NAME_gap_lowest .and. v < NAME_gap_highest)) then
      x = ieee_value(v, ieee_quiet_nan)
      return
    end if
@end
    u = u1
    call NAME_choose(NAME_velocity, v, u, node)
    first = NAME_start(node) + 1
    last = NAME_start(node + 1)
    x = NAME_quantile(NAME_edge(first:last), &
      NAME_probability_below(first:last), u2)
  end function NAME_sample
@if given

  !> A restitution at impact velocity v under condition z.
  elemental real(dp) function NAME_sample_given(v, z, u1, u2) result(x)
    real(dp), intent(in) :: v, z, u1, u2
    real(dp) :: u
    integer :: node, component, first, last
@if checked
    if (.not. (v >= NAME_velocity(1) &
      .and. v <= NAME_velocity(size(NAME_velocity)))) then
      x = ieee_value(v, ieee_quiet_nan)
      return
    end if
@end
@if gaps
    if (any(v >= NAME_gap_lowest .and. v < NAME_gap_highest)) then
      x = ieee_value(v, ieee_quiet_nan)
      return
    end if
@end
@if checked
    node = NAME_below(NAME_velocity, v)
    if (.not. (z >= minval(NAME_given_lowest(node:node + 1)) &
      .and. z <= maxval(NAME_given_highest(node:node + 1)))) then
      x = ieee_value(v, ieee_quiet_nan)
      return
    end if
@end
    u = u1
    call NAME_choose(NAME_velocity, v, u, node)
    first = NAME_given_first(node) + 1
    last = NAME_given_first(node + 1)
    call NAME_choose(NAME_given(first:last), z, u, component)
    component = first - 1 + component
    first = NAME_given_start(component) + 1
    last = NAME_given_start(component + 1)
    x = NAME_quantile(NAME_given_edge(first:last), &
      NAME_given_probability_below(first:last), u2)
  end function NAME_sample_given
@end

end module NAME
