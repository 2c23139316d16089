//! WHEN: the first contact, (2). See [`crate::contact`] for why it cannot be missed.

use super::flight::{Phase, State};
use super::{Mask, Pack};
use crate::contact::{INVISIBLE, LAST_BEND, LAST_STEP, MOST_STEPS, SHORTEST};
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

/// How the flights end.
#[derive(Clone, Copy)]
pub(super) struct Landing<S: Simd, const K: usize> {
    /// Flight time.
    pub time: Pack<S, K>,
    /// The state just before the impact.
    pub state: State<S, K>,
    /// ±1: the sphere that touches.
    pub sphere: Pack<S, K>,
    /// No contact while the axis can be followed.
    pub never: Mask<S, K>,
}

/// The gap under the sphere that may close first.
#[derive(Clone, Copy)]
struct Gap<S: Simd, const K: usize> {
    sphere: Pack<S, K>,
    width: Pack<S, K>,
    rate: Pack<S, K>,
    tilt: Pack<S, K>,
    tilt_rate: Pack<S, K>,
    root: Pack<S, K>,
}

/// What the search needs to know of a flight.
pub(super) struct Search<'a, S: Simd, const K: usize> {
    start: &'a State<S, K>,
    /// L/2.
    lever: f64,
    /// ω².
    square: Pack<S, K>,
    /// (L/2)ω².
    sway: Pack<S, K>,
    /// M, the bound on −f″.
    pub bound: Pack<S, K>,
    up: Pack<S, K>,
    down: Pack<S, K>,
}

impl<'a, S: Simd, const K: usize> Search<'a, S, K> {
    #[inline(always)]
    pub fn new(start: &'a State<S, K>, lever: f64) -> Self {
        let square = start.spin * start.spin;
        let sway = lever * square;
        let above = start.climb.mul_add(start.climb, 2.0 * (start.lift - lever));
        let root = above.sqrt();
        let reaches = Pack::splat(start.lift.simd(), 0.0).lt(above);
        Self {
            start,
            lever,
            square,
            sway,
            bound: 1.0 + sway,
            up: reaches.select(start.climb - root, f64::INFINITY),
            down: reaches.select(start.climb + root, f64::INFINITY),
        }
    }

    /// Lanes whose sphere on the plane stays there: no separation speed and f″ ≤ 0.
    #[inline(always)]
    pub fn rests(&self, departure: &Departure<S, K>) -> Mask<S, K> {
        let bend = -self.square * self.start.cosine;
        let held = (departure.sphere * self.lever).mul_add(bend, -1.0).le(0.0);
        let touching = !departure.sphere.eq(0.0);
        touching & departure.speed.le(0.0) & held
    }

    /// The landings of the lanes in `wanted`; what the other lanes hold means nothing. The first
    /// lane whose search does not end is the error.
    #[inline(always)]
    pub fn landing(
        &self,
        departure: &Departure<S, K>,
        wanted: Mask<S, K>,
    ) -> Result<Landing<S, K>, usize> {
        let simd = self.start.lift.simd();
        let mut time = Pack::splat(simd, 0.0);
        let mut phase = Phase::zero(simd);
        let mut gap = self.leaving(self.nearer(time, phase), departure);
        let mut step = self.certified(&gap);
        let mut never = Mask::splat(simd, false);
        let mut last = self.is_last(&gap, step, time);
        for _ in 0..MOST_STEPS {
            if !((!(last | never)) & wanted).any() {
                let step = self.landed(&gap, step);
                let time = time + step;
                let side = gap.sphere * self.lever;
                let phase = phase.advanced(self.start.spin * step);
                return Ok(Landing {
                    time,
                    state: self.start.landing(time, phase, side),
                    sphere: gap.sphere,
                    never,
                });
            }
            // Lanes that are done stay where they are and find the same step again.
            time = last.select(time, self.skip(time + step));
            let angle = self.start.spin * time;
            never = never | !angle.abs().le(RANGE);
            phase = Phase::of(angle);
            gap = self.nearer(time, phase);
            step = self.certified(&gap);
            last = last | self.is_last(&gap, step, time);
        }
        let mut stuck = None;
        ((!(last | never)) & wanted).each(|lane| {
            stuck.get_or_insert(lane);
        });
        Err(stuck.unwrap_or(0))
    }

    /// The gap that may close first: of the sphere that is lower, unless the axis swings through the level before.
    #[inline(always)]
    fn nearer(&self, time: Pack<S, K>, phase: Phase<S, K>) -> Gap<S, K> {
        let lift = self.start.lift_at(time);
        let climb = self.start.climb - time;
        let tilt = self.start.tilt(phase);
        let tilt_rate = self.start.tilt_rate(phase);
        let level = tilt_rate.mul_add(
            lift.mul_add(tilt_rate, -(climb * tilt)),
            -(0.5 * self.bound * (tilt * tilt)),
        );
        let zero = Pack::splat(lift.simd(), 0.0);
        let swings_over = (tilt * tilt_rate).lt(0.0) & zero.lt(level);
        let one_is_lower = tilt.lt(0.0) | (tilt.eq(0.0) & tilt_rate.lt(0.0));
        let lower = one_is_lower.select(1.0, Pack::splat(lift.simd(), -1.0));
        let sphere = swings_over.select(-lower, lower);
        let side = sphere * self.lever;
        let width = side.mul_add(tilt, lift).max(0.0); // (2)
        let rate = side.mul_add(tilt_rate, climb);
        Gap {
            sphere,
            width,
            rate,
            tilt,
            tilt_rate,
            root: self.root(width, rate),
        }
    }

    #[inline(always)]
    fn root(&self, width: Pack<S, K>, rate: Pack<S, K>) -> Pack<S, K> {
        rate.mul_add(rate, 2.0 * self.bound * width).sqrt()
    }

    /// At the start the sphere on the plane is known exactly.
    #[inline(always)]
    fn leaving(&self, gap: Gap<S, K>, departure: &Departure<S, K>) -> Gap<S, K> {
        let on = gap.sphere.eq(departure.sphere);
        let width = on.select(0.0, gap.width);
        let rate = on.select(departure.speed, gap.rate);
        Gap {
            width,
            rate,
            root: self.root(width, rate),
            ..gap
        }
    }

    /// First zero τ ≥ 0 of f + f′τ − Mτ²/2: no contact can come earlier.
    #[inline(always)]
    fn certified(&self, gap: &Gap<S, K>) -> Pack<S, K> {
        let approaching = gap.rate.lt(0.0);
        let numerator = approaching.select(2.0 * gap.width, (gap.rate + gap.root).max(SHORTEST));
        let denominator = approaching.select(gap.root - gap.rate, self.bound);
        numerator / denominator
    }

    /// Past the time that the centre of mass spends out of reach.
    #[inline(always)]
    fn skip(&self, time: Pack<S, K>) -> Pack<S, K> {
        (self.up.le(time) & time.lt(self.down)).select(self.down, time)
    }

    #[inline(always)]
    fn is_last(&self, gap: &Gap<S, K>, step: Pack<S, K>, time: Pack<S, K>) -> Mask<S, K> {
        gap.rate.lt(0.0)
            & step.le(LAST_STEP * (time + step))
            & (self.start.spin.abs() * step).le(LAST_STEP)
            & (self.is_nearly_straight(gap, step) | (self.bound * (step * step)).le(INVISIBLE))
    }

    #[inline(always)]
    fn is_nearly_straight(&self, gap: &Gap<S, K>, step: Pack<S, K>) -> Mask<S, K> {
        (self.sway * step).le(LAST_BEND * gap.root)
    }

    /// The contact after the last certified step: the gap there, to third order, over the speed there.
    #[inline(always)]
    fn landed(&self, gap: &Gap<S, K>, step: Pack<S, K>) -> Pack<S, K> {
        let side = gap.sphere * self.lever;
        let slack = side.mul_add(-self.square * gap.tilt, self.sway);
        let third = -(side * self.square) * gap.tilt_rate;
        let left = (step * step) * (third * step).mul_add(1.0 / 6.0, 0.5 * slack);
        let correction = left / slack.mul_add(-step, gap.root);
        self.is_nearly_straight(gap, step)
            .select(step + correction, step)
    }
}
