!> Coefficient of restitution at random, p(eps | v): restitution 0.1.0.
!>
!>   body = Dumbbell
!>   radius = 0.003
!>   separation = 0.003
!>   density = 2500.0
!>   law = TangentialRestitution
!>   normal = 0.9
!>   tangential = 1.0
!>   particles = 1000
!>   impacts = 20
!>   release_height = 0.06
!>   gravity = 9.81
!>   orientation = uniform-angle
!>   spin = (0.0, 0.0, 0.0)
!>   release_velocity = (0.0, 0.0, 0.0)
!>   incline = 0.0
!>   minimum_speed = 0.0
!>   seed = 1
!>   all_impacts = 20000
!>   energy_created_impacts = 2370
!>   energy_created_share = 0.1185
!>   largest_energy_ratio = 1.8618219008095425
!>   standard_errors = none: counts do not say which particle an impact belongs to
!>
!> v is the normal impact velocity in m/s, from 0.75 to 0.8500000000000001; others give NaN.
!> u1 and u2 are independent uniform random numbers in [0, 1) of yours.
module dist
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  implicit none
  private
  public :: dist_sample
  integer, parameter :: dp = kind(1.0d0)
  integer, save :: dist_start(3)
  data dist_start(1:3) / &
    0, 23, 42 /
  real(dp), save :: dist_velocity(2)
  data dist_velocity(1:2) / &
    7.5000000000000000d-01, 8.5000000000000009d-01 /
  real(dp), save :: dist_edge(42)
  data dist_edge(1:42) / &
    1.5989517370381648d-01, 1.5999999999999992d-01, 1.9999999999999996d-01, 2.8000000000000003d-01, &
    3.6000000000000010d-01, 4.0000000000000013d-01, 4.7999999999999998d-01, 5.6000000000000005d-01, &
    6.4000000000000012d-01, 6.7999999999999994d-01, 7.1999999999999997d-01, 7.6000000000000001d-01, &
    8.0000000000000004d-01, 8.4000000000000008d-01, 8.8000000000000012d-01, 9.1999999999999993d-01, &
    9.5999999999999996d-01, 1.0000000000000000d+00, 1.0400000000000000d+00, 1.0800000000000001d+00, &
    1.1600000000000001d+00, 1.2400000000000002d+00, 1.2571582961641352d+00, 2.6899911109249086d-01, &
    2.8000000000000003d-01, 3.2000000000000006d-01, 3.6000000000000010d-01, 4.0000000000000013d-01, &
    4.7999999999999998d-01, 5.6000000000000005d-01, 6.4000000000000012d-01, 6.7999999999999994d-01, &
    7.1999999999999997d-01, 7.6000000000000001d-01, 8.0000000000000004d-01, 8.4000000000000008d-01, &
    8.8000000000000012d-01, 9.1999999999999993d-01, 9.5999999999999996d-01, 1.0000000000000000d+00, &
    1.0400000000000000d+00, 1.0575479305832520d+00 /
  real(dp), save :: dist_probability_below(42)
  data dist_probability_below(1:42) / &
    0.0000000000000000d+00, 7.3313782991202346d-04, 6.5982404692082114d-03, 1.3196480938416423d-02, &
    3.5190615835777130d-02, 5.4985337243401759d-02, 9.5307917888563048d-02, 1.3929618768328444d-01, &
    1.9794721407624633d-01, 2.3826979472140764d-01, 2.8005865102639294d-01, 3.2771260997067447d-01, &
    3.6510263929618769d-01, 4.3255131964809385d-01, 5.1173020527859236d-01, 6.2756598240469208d-01, &
    7.1554252199413493d-01, 7.7785923753665687d-01, 8.1891495601173026d-01, 8.6950146627565983d-01, &
    9.3181818181818177d-01, 9.6627565982404695d-01, 1.0000000000000000d+00, 0.0000000000000000d+00, &
    2.3668639053254438d-03, 3.5502958579881655d-03, 8.2840236686390536d-03, 1.4201183431952662d-02, &
    5.6804733727810648d-02, 1.1597633136094675d-01, 1.9289940828402366d-01, 2.4852071005917159d-01, &
    3.0532544378698223d-01, 3.6686390532544377d-01, 4.2485207100591715d-01, 5.0769230769230766d-01, &
    5.9289940828402365d-01, 7.5621301775147931d-01, 8.6153846153846159d-01, 9.4674556213017746d-01, &
    9.7514792899408287d-01, 1.0000000000000000d+00 /

contains

  !> The last of increasing points that is <= x, but not the last of all.
  pure integer function dist_below(points, x) result(low)
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
  end function dist_below

  !> Chooses one of two neighbouring points, in proportion to how near x is; u is uniform again afterwards.
  pure subroutine dist_choose(points, x, u, chosen)
    real(dp), intent(in) :: points(:), x
    real(dp), intent(inout) :: u
    integer, intent(out) :: chosen
    real(dp) :: weight
    chosen = 1
    if (size(points) == 1) return
    chosen = dist_below(points, x)
    weight = (x - points(chosen)) / (points(chosen + 1) - points(chosen))
    weight = min(max(weight, 0.0_dp), 1.0_dp)
    if (u < weight) then
      u = u / weight
      chosen = chosen + 1
    else
      u = (u - weight) / (1.0_dp - weight)
    end if
  end subroutine dist_choose

  !> The quantile of u in a histogram.
  pure real(dp) function dist_quantile(edges, shares, u) result(x)
    real(dp), intent(in) :: edges(:), shares(:), u
    integer :: bin
    bin = dist_below(shares, u)
    x = edges(bin) + (u - shares(bin)) &
      * ((edges(bin + 1) - edges(bin)) / (shares(bin + 1) - shares(bin)))
  end function dist_quantile

  !> A restitution at impact velocity v.
  elemental real(dp) function dist_sample(v, u1, u2) result(x)
    real(dp), intent(in) :: v, u1, u2
    real(dp) :: u
    integer :: node, first, last
    if (.not. (v >= dist_velocity(1) .and. v <= dist_velocity(size(dist_velocity)))) then
      x = ieee_value(v, ieee_quiet_nan)
      return
    end if
    u = u1
    call dist_choose(dist_velocity, v, u, node)
    first = dist_start(node) + 1
    last = dist_start(node + 1)
    x = dist_quantile(dist_edge(first:last), dist_probability_below(first:last), u2)
  end function dist_sample

end module dist
