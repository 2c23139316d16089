//! The gap at a time of the flight, and the step from there that cannot pass a contact.

use crate::contact::certify::{SHORTEST, TOUCHING, closing_speed, first_zero};
use crate::motion::{Attitude, Flight, SymmetricState};
use crate::shape::{AxisMotion, Hull, HullPart};
use crate::simd::elementary::RANGE;
use crate::simd::{Lanewise, Mask, Pack, lanewise};
use pulp::Simd;

/// The contact from which the flight starts.
#[derive(Clone, Copy)]
pub(crate) struct LastContact<S: Simd> {
    /// +1 or −1: sphere 1 or 2 is on the plane; 0: no part of the body is.
    pub sphere: Pack<S>,
    /// The normal speed at which the point of contact leaves the plane.
    pub speed: Pack<S>,
}

/// Height, axis and their time derivatives at one time of the flight.
#[derive(Clone, Copy)]
pub(super) struct Instant<S: Simd> {
    time: Pack<S>,
    height: Pack<S>,
    vz: Pack<S>,
    axis_motion: AxisMotion<S>,
}

impl<S: Simd> Instant<S> {
    /// The gap f under a part of the hull (2), negative where they overlap, and f′.
    #[inline(always)]
    pub(super) fn opening(&self, part: &HullPart<S>, hull: &impl Hull) -> (Pack<S>, Pack<S>) {
        let AxisMotion { cos_tilt, rate, .. } = self.axis_motion;
        (
            hull.gap(part, cos_tilt, self.height), // (2)
            hull.lever(part, cos_tilt).mul_add(rate, self.vz),
        )
    }
}

/// The gap under a part of the hull.
#[derive(Clone, Copy)]
pub(crate) struct Gap<S: Simd> {
    pub part: HullPart<S>,
    /// f ≥ 0; an overlap, which is rounding, counts as 0.
    pub width: Pack<S>,
    /// f′.
    pub rate: Pack<S>,
    /// [`closing_speed`].
    pub closing: Pack<S>,
}

/// The evaluation of a pass of the search: the gap that may close first.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct GapEvaluation<S: Simd> {
    pub attitude: Attitude<S>,
    /// The gap that may close first.
    pub gap: Gap<S>,
    /// The lanes that do not land before the angle turned through exceeds [`RANGE`].
    pub never: Mask<S>,
}

lanewise! {
    LastContact<S> { sphere, speed }
    Gap<S> { part, width, rate, closing }
    GapEvaluation<S> { attitude, gap, never }
}

/// A flight and the bounds on its gap that the search uses.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Search<S: Simd, F> {
    pub flight: F,
    /// The contact from which the flight starts.
    pub last_contact: LastContact<S>,
    /// S, the bound on the contribution of rotation to f″: (L/2)AΩ² for a dumbbell.
    pub rotation_bound: Pack<S>,
    /// M, the bound on −f″.
    pub curvature_bound: Pack<S>,
    /// From `up` to `down` the centre of mass is higher than the hull can reach.
    up: Pack<S>,
    down: Pack<S>,
}

impl<S: Simd, F: Flight<S>> Search<S, F> {
    /// The search along a flight that starts from this contact.
    #[inline(always)]
    pub fn new(flight: F, last_contact: LastContact<S>, hull: &impl Hull) -> Self {
        let zero = Pack::splat(flight.rate().simd(), 0.0);
        let mut search = Self {
            flight,
            last_contact,
            rotation_bound: zero,
            curvature_bound: zero,
            up: zero,
            down: zero,
        };
        search.compute_bounds(hull);
        search
    }

    /// Continues with the flight that starts where the last one ended.
    #[inline(always)]
    pub fn continue_with(
        &mut self,
        motion: <F::State as SymmetricState<S>>::Motion,
        slope: f64,
        hull: &impl Hull,
    ) {
        self.flight.depart(motion, slope);
        self.compute_bounds(hull);
    }

    /// Computes the bounds on the gap.
    #[inline(always)]
    fn compute_bounds(&mut self, hull: &impl Hull) {
        let flight = &self.flight;
        let start = flight.start();
        let (height, vz) = (start.height(), start.vz());
        let [square, amplitude, max_cos_tilt] = flight.bounds();
        let rotation_bound = hull.curvature_bound(amplitude, max_cos_tilt) * square;
        let above = vz.mul_add(vz, 2.0 * (height - hull.ceiling(max_cos_tilt)));
        let root = above.sqrt();
        let reaches = !above.le(0.0);
        self.rotation_bound = rotation_bound;
        self.curvature_bound = 1.0 + rotation_bound;
        self.up = reaches.select(vz - root, f64::INFINITY);
        self.down = reaches.select(vz + root, f64::INFINITY);
    }

    /// The search along a flight from a release: a part may be on the plane, at rest or moving up. A part on the plane that moves
    /// down is left to the search, which finds its contact at time 0.
    #[inline(always)]
    pub fn released(flight: F, hull: &impl Hull) -> Self {
        let simd = flight.rate().simd();
        let mut search = Self::new(flight, LastContact::none(simd), hull);
        let instant = search.beginning();
        for first in [false, true] {
            let gap = search.gap(&instant, hull.part(Mask::splat(simd, first)), hull);
            let width = hull.gap(&gap.part, instant.axis_motion.cos_tilt, instant.height);
            let on = width.le(0.0) & (-gap.rate).le(0.0);
            let sphere = Pack::splat(simd, if first { 1.0 } else { -1.0 });
            let speed = gap.rate;
            search.last_contact = search.last_contact.or(on, LastContact { sphere, speed });
        }
        search
    }

    /// Lanes whose part on the plane has no normal speed and stays there: f″ ≤ 0, and the other part is not about to touch as well.
    ///
    /// The speed at which the other part approaches is taken relative to the part at rest: what rounding makes of the speed of that
    /// one is in both, and is all that there is where the two parts touch at the same place.
    #[inline(always)]
    pub fn rests<H: Hull>(&self, hull: &H) -> Mask<S> {
        let instant = self.beginning();
        let on = self.last_contact.sphere;
        let part = hull.part(!on.lt(0.0));
        let held = !on.eq(0.0) & hull.curvature(&part, &instant.axis_motion).le(0.0);
        if H::TWO {
            let (_, still) = instant.opening(&part, hull);
            let other = self.gap(&instant, hull.part(on.lt(0.0)), hull);
            held & !(other.rate.lt(still) & other.width.le(TOUCHING))
        } else {
            held
        }
    }

    /// The time of the first evaluation, certified for both parts, of which one may be leaving the plane.
    #[inline(always)]
    pub fn first_evaluation<H: Hull>(&self, hull: &H) -> Pack<S> {
        let instant = self.beginning();
        let on = self.last_contact.sphere;
        let step = if on.eq(0.0).any() {
            let all = Mask::splat(on.simd(), true);
            let one = self.exact(&instant, self.gap(&instant, hull.part(all), hull), hull);
            if H::TWO {
                let two = self.exact(&instant, self.gap(&instant, hull.part(!all), hull), hull);
                self.certified(&one).min(self.certified(&two))
            } else {
                self.certified(&one)
            }
        } else {
            // For a gap of 0, √(f′² + 2Mf) is f′.
            let leaves = (2.0 * self.last_contact.speed).max(SHORTEST) / self.curvature_bound;
            if H::TWO {
                let other = self.gap(&instant, hull.part(on.lt(0.0)), hull);
                self.certified(&other).min(leaves)
            } else {
                leaves
            }
        };
        // The first pass evaluates a contact at the start itself again.
        step.eq(0.0).select(0.0, self.skip(step))
    }

    /// The angle that the body has turned through at `time`, Ωt.
    #[inline(always)]
    pub fn angle(&self, time: Pack<S>) -> Pack<S> {
        self.flight.rate() * time
    }

    /// Evaluates, at `time`, the gap that may close first; `turned` is sine and cosine of the angle turned through.
    #[inline(always)]
    pub fn evaluate<H: Hull>(
        &self,
        time: Pack<S>,
        turned: (Pack<S>, Pack<S>),
        hull: &H,
    ) -> GapEvaluation<S> {
        let never = !self.angle(time).abs().le(RANGE);
        let attitude = self.flight.attitude(turned);
        let instant = self.instant(time, attitude);
        let part = hull.nearer(
            instant.height,
            instant.vz,
            &instant.axis_motion,
            self.curvature_bound,
        );
        let mut gap = self.gap(&instant, part, hull);
        // A part that touches but does not approach, or the start: one comparison, because operations on masks are slower.
        let leaving = (gap.width - TOUCHING).max(-gap.rate);
        if leaving.min(time).le(0.0).any() {
            gap = self.nearest_in_rare_cases(&instant, gap, hull);
        }
        GapEvaluation {
            attitude,
            gap,
            never,
        }
    }

    #[inline(always)]
    fn beginning(&self) -> Instant<S> {
        let start = self.flight.start();
        Instant {
            time: Pack::splat(start.height().simd(), 0.0),
            height: start.height(),
            vz: start.vz(),
            axis_motion: self.flight.axis_motion_at_start(),
        }
    }

    /// The gap of a part.
    #[inline(always)]
    fn gap(&self, instant: &Instant<S>, part: HullPart<S>, hull: &impl Hull) -> Gap<S> {
        let (width, rate) = instant.opening(&part, hull);
        let width = width.max(0.0);
        Gap {
            part,
            width,
            rate,
            closing: closing_speed(width, rate, self.curvature_bound),
        }
    }

    /// Height, axis and their derivatives at `time`, with this attitude.
    #[inline(always)]
    pub(super) fn instant(&self, time: Pack<S>, attitude: Attitude<S>) -> Instant<S> {
        Instant {
            time,
            height: self.flight.height_at(time),
            vz: self.flight.vz_at(time),
            axis_motion: self.flight.axis_motion(attitude),
        }
    }

    /// The gap that may close first in the cases that [`Hull::nearer`] does not decide: at the start the part on the plane is known
    /// exactly, and a part that touches and leaves may return later than the other comes down.
    #[inline(always)]
    fn nearest_in_rare_cases<H: Hull>(
        &self,
        instant: &Instant<S>,
        nearer: Gap<S>,
        hull: &H,
    ) -> Gap<S> {
        let gap = self.exact(instant, nearer, hull);
        if !H::TWO {
            return gap;
        }
        let other = self.gap(instant, hull.part(!gap.part.one), hull);
        let other = self.exact(instant, other, hull);
        let leaving = gap.width.le(TOUCHING) & !gap.rate.lt(0.0);
        let swap = leaving & self.certified(&other).lt(self.certified(&gap));
        gap.or(swap, other)
    }

    #[inline(always)]
    fn exact<H: Hull>(&self, instant: &Instant<S>, gap: Gap<S>, _: &H) -> Gap<S> {
        let on = self.last_contact.sphere;
        let there = if H::TWO {
            gap.part.one.select(1.0, -1.0_f64).eq(on)
        } else {
            !on.eq(0.0)
        };
        let touching = there & instant.time.eq(0.0);
        let width = touching.select(0.0, gap.width);
        let rate = touching.select(self.last_contact.speed, gap.rate);
        Gap {
            width,
            rate,
            closing: closing_speed(width, rate, self.curvature_bound),
            ..gap
        }
    }

    /// The time before which there is no contact of a part with this gap.
    #[inline(always)]
    pub fn certified(&self, gap: &Gap<S>) -> Pack<S> {
        first_zero(gap.width, gap.rate, gap.closing, self.curvature_bound)
    }

    /// The given time, or, if the centre of mass is then higher than the hull can reach, the time at which it comes back down.
    #[inline(always)]
    pub fn skip(&self, time: Pack<S>) -> Pack<S> {
        self.up.le(time).select(time.max(self.down), time)
    }
}
