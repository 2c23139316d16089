//! What the search sees of a flight at a moment, and how far it can safely step from there.

use super::{SHORTEST, TOUCHING};
use crate::body::{Hull, Part, Swing};
use crate::flight::{Attitude, Flight, States};
use crate::simd::elementary::RANGE;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// What the last impact left behind.
#[derive(Clone, Copy)]
pub(crate) struct Departure<S: Simd, const K: usize> {
    /// ±1: sphere 1 or 2 is on the plane; 0: no part of the body is.
    pub sphere: Pack<S, K>,
    /// The normal speed at which its lowest point leaves.
    pub speed: Pack<S, K>,
}

/// Where a flight is at one time.
#[derive(Clone, Copy)]
pub(super) struct Moment<S: Simd, const K: usize> {
    time: Pack<S, K>,
    lift: Pack<S, K>,
    climb: Pack<S, K>,
    swing: Swing<S, K>,
}

impl<S: Simd, const K: usize> Moment<S, K> {
    /// The gap f under a part of the hull (2), negative where they overlap, and f′.
    #[inline(always)]
    pub(super) fn opening(&self, part: &Part<S, K>, hull: &impl Hull) -> (Pack<S, K>, Pack<S, K>) {
        let Swing { tilt, rate, .. } = self.swing;
        (
            hull.gap(part, tilt, self.lift), // (2)
            hull.lever(part, tilt).mul_add(rate, self.climb),
        )
    }
}

/// The gap under a part of the hull.
#[derive(Clone, Copy)]
pub(crate) struct Gap<S: Simd, const K: usize> {
    pub part: Part<S, K>,
    /// f ≥ 0; an overlap, which is rounding, counts as 0.
    pub width: Pack<S, K>,
    /// f′.
    pub rate: Pack<S, K>,
    /// √(f′² + 2Mf): the speed of approach at the zero of the lower bound.
    pub root: Pack<S, K>,
}

/// What a pass of the search sees: the gap that may close first.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Look<S: Simd, const K: usize> {
    pub attitude: Attitude<S, K>,
    /// The gap.
    pub gap: Gap<S, K>,
    /// The lanes that never land while the axis can be followed.
    pub never: Mask<S, K>,
}

impl<S: Simd, const K: usize> Look<S, K> {
    /// Before the first evaluation.
    #[inline(always)]
    pub fn nothing(part: Part<S, K>) -> Self {
        let simd = part.lever.simd();
        let zero = Pack::splat(simd, 0.0);
        Self {
            attitude: Attitude::none(simd),
            gap: Gap {
                part,
                width: zero,
                rate: zero,
                root: zero,
            },
            never: Mask::splat(simd, false),
        }
    }
}

/// What the search needs to know of a flight.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Search<S: Simd, F, const K: usize> {
    pub flight: F,
    /// How the flight starts.
    pub departure: Departure<S, K>,
    /// What the rotation can contribute to f″: (L/2)AΩ² for a dumbbell.
    pub sway: Pack<S, K>,
    /// M, the bound on −f″.
    pub bound: Pack<S, K>,
    /// From `up` to `down` the centre of mass is higher than the hull can reach.
    up: Pack<S, K>,
    down: Pack<S, K>,
}

impl<S: Simd, F: Flight<S, K>, const K: usize> Search<S, F, K> {
    /// Of a flight that starts so.
    #[inline(always)]
    pub fn new(flight: F, departure: Departure<S, K>, hull: &impl Hull) -> Self {
        let zero = Pack::splat(flight.rate().simd(), 0.0);
        let mut search = Self {
            flight,
            departure,
            sway: zero,
            bound: zero,
            up: zero,
            down: zero,
        };
        search.survey(hull);
        search
    }

    /// Goes on to the flight that starts where the last has ended.
    #[inline(always)]
    pub fn depart(
        &mut self,
        motion: <F::State as States<S, K>>::Motion,
        slope: f64,
        hull: &impl Hull,
    ) {
        self.flight.depart(motion, slope);
        self.survey(hull);
    }

    /// Finds out what bounds the gap.
    #[inline(always)]
    fn survey(&mut self, hull: &impl Hull) {
        let flight = &self.flight;
        let start = flight.start();
        let (lift, climb) = (start.lift(), start.climb());
        let reach = flight.reach();
        let sway = hull.sway(flight.amplitude(), reach) * flight.square();
        let above = climb.mul_add(climb, 2.0 * (lift - hull.ceiling(reach)));
        let root = above.sqrt();
        let reaches = !above.le(0.0);
        self.sway = sway;
        self.bound = 1.0 + sway;
        self.up = reaches.select(climb - root, f64::INFINITY);
        self.down = reaches.select(climb + root, f64::INFINITY);
    }

    /// The departure of a release: a part may be on the plane, at rest or on its way up. One that is on its way down meets the
    /// plane at once, and is left to the search.
    #[inline(always)]
    pub fn released(flight: F, hull: &impl Hull) -> Self {
        let simd = flight.rate().simd();
        let zero = Pack::splat(simd, 0.0);
        let free = Departure {
            sphere: zero,
            speed: zero,
        };
        let mut search = Self::new(flight, free, hull);
        let moment = search.beginning();
        for first in [false, true] {
            let gap = search.gap(&moment, hull.part(Mask::splat(simd, first)), hull);
            let width = hull.gap(&gap.part, moment.swing.tilt, moment.lift);
            let on = width.le(0.0) & zero.le(gap.rate);
            let departure = &mut search.departure;
            let sphere = if first { 1.0 } else { -1.0 };
            departure.sphere = on.select(sphere, departure.sphere);
            departure.speed = on.select(gap.rate, departure.speed);
        }
        search
    }

    /// Lanes whose part on the plane, left with no speed, stays there: f″ ≤ 0, and the other is not coming down on it too.
    #[inline(always)]
    pub fn rests<H: Hull>(&self, hull: &H) -> Mask<S, K> {
        let moment = self.beginning();
        let on = self.departure.sphere;
        let part = hull.part(!on.lt(0.0));
        let held = !on.eq(0.0) & hull.bend(&part, &moment.swing, -1.0).le(0.0);
        if H::TWO {
            let other = self.gap(&moment, hull.part(on.lt(0.0)), hull);
            held & !(other.rate.lt(0.0) & other.width.le(TOUCHING))
        } else {
            held
        }
    }

    /// Where the first pass looks. Both parts count: the one on the plane is just leaving it.
    #[inline(always)]
    pub fn departed<H: Hull>(&self, hull: &H) -> Pack<S, K> {
        let moment = self.beginning();
        let on = self.departure.sphere;
        let step = if on.eq(0.0).any() {
            let all = Mask::splat(on.simd(), true);
            let one = self.exact(&moment, self.gap(&moment, hull.part(all), hull), hull);
            if H::TWO {
                let two = self.exact(&moment, self.gap(&moment, hull.part(!all), hull), hull);
                self.certified(&one).min(self.certified(&two))
            } else {
                self.certified(&one)
            }
        } else {
            // The root of a gap that is zero is its rate.
            let leaves = (2.0 * self.departure.speed).max(SHORTEST) / self.bound;
            if H::TWO {
                let other = self.gap(&moment, hull.part(on.lt(0.0)), hull);
                self.certified(&other).min(leaves)
            } else {
                leaves
            }
        };
        // A contact at the start itself is seen again in the first pass.
        step.eq(0.0).select(0.0, self.skip(step))
    }

    /// What the body has turned through at `time`: φ = Ωt.
    #[inline(always)]
    pub fn angle(&self, time: Pack<S, K>) -> Pack<S, K> {
        self.flight.rate() * time
    }

    /// What is to be seen at `time`, with sine and cosine of the angle there.
    #[inline(always)]
    pub fn look<H: Hull>(
        &self,
        time: Pack<S, K>,
        turned: (Pack<S, K>, Pack<S, K>),
        hull: &H,
    ) -> Look<S, K> {
        let never = !self.angle(time).abs().le(RANGE);
        let attitude = self.flight.attitude(turned);
        let moment = self.moment(time, attitude);
        let part = hull.nearer(moment.lift, moment.climb, &moment.swing, self.bound);
        let mut gap = self.gap(&moment, part, hull);
        // Does it touch and not approach, or is this the start? One comparison, because masks are dearer than numbers.
        let leaving = (gap.width - TOUCHING).max(-gap.rate);
        if leaving.min(time).le(0.0).any() {
            gap = self.careful(&moment, gap, hull);
        }
        Look {
            attitude,
            gap,
            never,
        }
    }

    #[inline(always)]
    fn beginning(&self) -> Moment<S, K> {
        let start = self.flight.start();
        Moment {
            time: Pack::splat(start.lift().simd(), 0.0),
            lift: start.lift(),
            climb: start.climb(),
            swing: self.flight.beginning(),
        }
    }

    /// The gap under a part.
    #[inline(always)]
    fn gap(&self, moment: &Moment<S, K>, part: Part<S, K>, hull: &impl Hull) -> Gap<S, K> {
        let (width, rate) = moment.opening(&part, hull);
        let width = width.max(0.0);
        Gap {
            part,
            width,
            rate,
            root: self.root(width, rate),
        }
    }

    /// Where the flight is at `time`, with this attitude.
    #[inline(always)]
    pub(super) fn moment(&self, time: Pack<S, K>, attitude: Attitude<S, K>) -> Moment<S, K> {
        Moment {
            time,
            lift: self.flight.lift_at(time),
            climb: self.flight.climb_at(time),
            swing: self.flight.swing(attitude),
        }
    }

    #[inline(always)]
    fn root(&self, width: Pack<S, K>, rate: Pack<S, K>) -> Pack<S, K> {
        rate.mul_add(rate, 2.0 * self.bound * width).sqrt()
    }

    /// The gap that may close first where the nearer one is not enough: at the start the part on the plane is known exactly, and a
    /// part that touches and leaves may come back later than the other comes down.
    #[inline(always)]
    fn careful<H: Hull>(&self, moment: &Moment<S, K>, nearer: Gap<S, K>, hull: &H) -> Gap<S, K> {
        let gap = self.exact(moment, nearer, hull);
        if !H::TWO {
            return gap;
        }
        let other = self.gap(moment, hull.part(!gap.part.one), hull);
        let other = self.exact(moment, other, hull);
        let leaving = gap.width.le(TOUCHING) & !gap.rate.lt(0.0);
        let swap = leaving & self.certified(&other).lt(self.certified(&gap));
        Gap {
            part: Part {
                one: gap.part.one ^ swap,
                lever: swap.select(other.part.lever, gap.part.lever),
            },
            width: swap.select(other.width, gap.width),
            rate: swap.select(other.rate, gap.rate),
            root: swap.select(other.root, gap.root),
        }
    }

    #[inline(always)]
    fn exact<H: Hull>(&self, moment: &Moment<S, K>, gap: Gap<S, K>, _: &H) -> Gap<S, K> {
        let on = self.departure.sphere;
        let there = if H::TWO {
            gap.part.one.select(1.0, -1.0_f64).eq(on)
        } else {
            !on.eq(0.0)
        };
        let touching = there & moment.time.eq(0.0);
        let width = touching.select(0.0, gap.width);
        let rate = touching.select(self.departure.speed, gap.rate);
        Gap {
            width,
            rate,
            root: self.root(width, rate),
            ..gap
        }
    }

    /// First zero τ ≥ 0 of f + f′τ − Mτ²/2: no contact can come earlier. Of the two forms of the same root the one that does not
    /// subtract.
    #[inline(always)]
    pub fn certified(&self, gap: &Gap<S, K>) -> Pack<S, K> {
        let approaching = gap.rate.lt(0.0);
        let speed = gap.rate.abs() + gap.root;
        let numerator = approaching.select(2.0 * gap.width, speed.max(SHORTEST));
        let denominator = approaching.select(speed, self.bound);
        numerator / denominator
    }

    /// Past the time that the centre of mass spends out of reach.
    #[inline(always)]
    pub fn skip(&self, time: Pack<S, K>) -> Pack<S, K> {
        self.up.le(time).select(time.max(self.down), time)
    }
}
