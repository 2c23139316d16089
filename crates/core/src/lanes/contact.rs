//! WHEN: the first contact, (2). See [`crate::contact`] for why it cannot be missed.

use super::flight::{Attitude, State};
use super::{Mask, Pack};
use crate::contact::{SHORTEST, TOUCHING};
use crate::elementary::RANGE;
use pulp::Simd;

/// What the last impact left behind.
#[derive(Clone, Copy)]
pub(super) struct Departure<S: Simd, const K: usize> {
    /// ±1: sphere 1 or 2 is on the plane; 0: neither.
    pub sphere: Pack<S, K>,
    /// The normal speed at which its lowest point leaves.
    pub speed: Pack<S, K>,
}

/// Where the flights are.
#[derive(Clone, Copy)]
struct Moment<S: Simd, const K: usize> {
    time: Pack<S, K>,
    lift: Pack<S, K>,
    climb: Pack<S, K>,
    tilt: Pack<S, K>,
    tilt_rate: Pack<S, K>,
}

/// The gap under a sphere.
#[derive(Clone, Copy)]
pub(super) struct Gap<S: Simd, const K: usize> {
    /// Whether it is sphere 1.
    pub one: Mask<S, K>,
    /// ±L/2.
    pub side: Pack<S, K>,
    pub width: Pack<S, K>,
    pub rate: Pack<S, K>,
    pub root: Pack<S, K>,
}

/// What a pass of the search sees: the gap that may close first.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Look<S: Simd, const K: usize> {
    pub attitude: Attitude<S, K>,
    /// The gap.
    pub gap: Gap<S, K>,
    /// The lanes that never land while the axis can be followed.
    pub never: Mask<S, K>,
}

/// What the search needs to know of a flight.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Search<S: Simd, const K: usize> {
    /// The state at the start.
    pub start: State<S, K>,
    /// How the flight starts.
    pub departure: Departure<S, K>,
    /// L/2.
    lever: f64,
    /// (L/2)ω².
    pub sway: Pack<S, K>,
    /// M, the bound on −f″.
    pub bound: Pack<S, K>,
    up: Pack<S, K>,
    down: Pack<S, K>,
}

impl<S: Simd, const K: usize> Search<S, K> {
    /// Of a flight from `start`.
    #[inline(always)]
    pub fn new(start: State<S, K>, departure: Departure<S, K>, lever: f64) -> Self {
        let sway = lever * (start.spin * start.spin);
        let above = start.climb.mul_add(start.climb, 2.0 * (start.lift - lever));
        let root = above.sqrt();
        let reaches = !above.le(0.0);
        Self {
            start,
            departure,
            lever,
            sway,
            bound: 1.0 + sway,
            up: reaches.select(start.climb - root, f64::INFINITY),
            down: reaches.select(start.climb + root, f64::INFINITY),
        }
    }

    /// Lanes whose sphere on the plane, left with no speed, stays there: f″ ≤ 0, and the other is not coming down on it too.
    #[inline(always)]
    pub fn rests(&self) -> Mask<S, K> {
        let moment = self.beginning();
        let on = self.departure.sphere;
        let bend = -(self.start.spin * self.start.spin) * moment.tilt;
        let held = (on * self.lever).mul_add(bend, -1.0).le(0.0);
        let other = self.gap(&moment, on.lt(0.0));
        let both = other.rate.lt(0.0) & other.width.le(TOUCHING);
        !on.eq(0.0) & held & !both
    }

    /// Where the first pass looks. Both spheres count: the one on the plane is just leaving it.
    #[inline(always)]
    pub fn departed(&self) -> Pack<S, K> {
        let moment = self.beginning();
        let on = self.departure.sphere;
        let step = if on.eq(0.0).any() {
            let all = Mask::splat(on.simd(), true);
            let one = self.exact(&moment, self.gap(&moment, all));
            let two = self.exact(&moment, self.gap(&moment, !all));
            self.certified(&one).min(self.certified(&two))
        } else {
            // The root of a gap that is zero is its rate.
            let leaves = (2.0 * self.departure.speed).max(SHORTEST) / self.bound;
            let other = self.gap(&moment, on.lt(0.0));
            self.certified(&other).min(leaves)
        };
        // A contact at the start itself is seen again in the first pass.
        step.eq(0.0).select(0.0, self.skip(step))
    }

    /// What the body has turned through at `time`: φ = ωt.
    #[inline(always)]
    pub fn angle(&self, time: Pack<S, K>) -> Pack<S, K> {
        self.start.spin * time
    }

    /// What is to be seen at `time`, with sine and cosine of the angle there.
    #[inline(always)]
    pub fn look(&self, time: Pack<S, K>, turned: (Pack<S, K>, Pack<S, K>)) -> Look<S, K> {
        let never = !self.angle(time).abs().le(RANGE);
        let attitude = self.start.attitude(turned);
        let moment = Moment {
            time,
            lift: self.start.lift_at(time),
            climb: self.start.climb - time,
            tilt: attitude.cosine,
            tilt_rate: self.start.tilt_rate(attitude),
        };
        let mut gap = self.nearer(&moment);
        // Does it touch and not approach, or is this the start? One comparison, because masks are dearer than numbers.
        let leaving = (gap.width - TOUCHING).max(-gap.rate);
        if leaving.min(time).le(0.0).any() {
            gap = self.careful(&moment, gap);
        }
        Look {
            attitude,
            gap,
            never,
        }
    }

    #[inline(always)]
    fn beginning(&self) -> Moment<S, K> {
        let State {
            lift,
            climb,
            sine,
            cosine,
            spin,
            ..
        } = self.start;
        Moment {
            time: Pack::splat(lift.simd(), 0.0),
            lift,
            climb,
            tilt: cosine,
            tilt_rate: -(spin * sine),
        }
    }

    /// The gap that may close first: of the sphere that is lower, unless the axis swings through the level before.
    #[inline(always)]
    fn nearer(&self, moment: &Moment<S, K>) -> Gap<S, K> {
        let Moment {
            lift,
            climb,
            tilt,
            tilt_rate,
            ..
        } = *moment;
        let level = tilt_rate.mul_add(
            lift.mul_add(tilt_rate, -(climb * tilt)),
            -(0.5 * self.bound * (tilt * tilt)),
        );
        let swings = Pack::splat(lift.simd(), 0.0).le(level);
        self.gap(moment, swings.select(tilt_rate, tilt).lt(0.0))
    }

    /// The gap under a sphere.
    #[inline(always)]
    fn gap(&self, moment: &Moment<S, K>, one: Mask<S, K>) -> Gap<S, K> {
        let side = one.select(self.lever, -self.lever);
        let width = side.mul_add(moment.tilt, moment.lift).max(0.0); // (2)
        let rate = side.mul_add(moment.tilt_rate, moment.climb);
        Gap {
            one,
            side,
            width,
            rate,
            root: self.root(width, rate),
        }
    }

    #[inline(always)]
    fn root(&self, width: Pack<S, K>, rate: Pack<S, K>) -> Pack<S, K> {
        rate.mul_add(rate, 2.0 * self.bound * width).sqrt()
    }

    /// The gap that may close first where `nearer` is not enough: at the start the sphere on the plane is known exactly, and a
    /// sphere that touches and leaves may come back later than the other comes down.
    #[inline(always)]
    fn careful(&self, moment: &Moment<S, K>, nearer: Gap<S, K>) -> Gap<S, K> {
        let gap = self.exact(moment, nearer);
        let other = self.exact(moment, self.gap(moment, !nearer.one));
        let leaving = gap.width.le(TOUCHING) & !gap.rate.lt(0.0);
        let swap = leaving & self.certified(&other).lt(self.certified(&gap));
        Gap {
            one: gap.one ^ swap,
            side: swap.select(other.side, gap.side),
            width: swap.select(other.width, gap.width),
            rate: swap.select(other.rate, gap.rate),
            root: swap.select(other.root, gap.root),
        }
    }

    #[inline(always)]
    fn exact(&self, moment: &Moment<S, K>, gap: Gap<S, K>) -> Gap<S, K> {
        let sphere = gap.one.select(1.0, -1.0_f64);
        let touching = sphere.eq(self.departure.sphere) & moment.time.eq(0.0);
        let width = touching.select(0.0, gap.width);
        let rate = touching.select(self.departure.speed, gap.rate);
        Gap {
            width,
            rate,
            root: self.root(width, rate),
            ..gap
        }
    }

    /// First zero τ ≥ 0 of f + f′τ − Mτ²/2: no contact can come earlier.
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
