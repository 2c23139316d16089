//! The end of the search: from the last certified step to the contact. See [`super`] for why it is the right one.

use super::gap::{Gap, Look, Search};
use super::{FAR, INVISIBLE, LAST, NEAR, SMALL};
use crate::body::{Hull, Part};
use crate::flight::{Attitude, Flight};
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// The next steps of the search.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Leap<S: Simd, const K: usize> {
    /// The certified one.
    step: Pack<S, K>,
    /// To the zero of an expansion, good where the contact is near.
    ahead: Pack<S, K>,
    near: Mask<S, K>,
}

/// What an expansion has left of the gap.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Residue<S: Simd, const K: usize> {
    time: Pack<S, K>,
    attitude: Attitude<S, K>,
    width: Pack<S, K>,
    rate: Pack<S, K>,
}

/// Where a pass of the search leads.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Arrival<S: Simd, const K: usize> {
    /// Time and attitude of the contact.
    pub time: Pack<S, K>,
    pub attitude: Attitude<S, K>,
    /// The lanes in which they are right, or that never land.
    pub done: Mask<S, K>,
}

impl<S: Simd, const K: usize> Leap<S, K> {
    /// Before the first evaluation.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = Pack::splat(simd, 0.0);
        Self {
            step: zero,
            ahead: zero,
            near: Mask::splat(simd, false),
        }
    }
}

impl<S: Simd, const K: usize> Residue<S, K> {
    /// Before the first evaluation.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = Pack::splat(simd, 0.0);
        Self {
            time: zero,
            attitude: Attitude::none(simd),
            width: zero,
            rate: zero,
        }
    }
}

impl<S: Simd, const K: usize> Arrival<S, K> {
    /// Before the first evaluation.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        Self {
            time: Pack::splat(simd, 0.0),
            attitude: Attitude::none(simd),
            done: Mask::splat(simd, false),
        }
    }
}

impl<S: Simd, F: Flight<S, K>, const K: usize> Search<S, F, K> {
    /// The next steps, from what is to be seen.
    #[inline(always)]
    pub fn leap(&self, look: &Look<S, K>, hull: &impl Hull) -> Leap<S, K> {
        let step = self.certified(&look.gap);
        Leap {
            step,
            ahead: self.expanded(look, step, hull),
            near: self.is_near(&look.gap, step, hull),
        }
    }

    /// What is left of the gap that was evaluated at `time`.
    #[inline(always)]
    pub fn residue(
        &self,
        time: Pack<S, K>,
        look: &Look<S, K>,
        leap: &Leap<S, K>,
        hull: &impl Hull,
    ) -> Residue<S, K> {
        let time = time + leap.ahead;
        let attitude = look.attitude.turned(self.flight.rate() * leap.ahead);
        let (width, rate) = self.moment(time, attitude).opening(&look.gap.part, hull);
        Residue {
            time,
            attitude,
            width,
            rate,
        }
    }

    /// The contact, where it is near and the other part does not touch before.
    #[inline(always)]
    pub fn arrival<H: Hull>(
        &self,
        look: &Look<S, K>,
        leap: &Leap<S, K>,
        residue: &Residue<S, K>,
        hull: &H,
    ) -> Arrival<S, K> {
        let part = &look.gap.part;
        // What is left goes in a step of third order.
        let inverse = -1.0 / residue.rate;
        let newton = residue.width * inverse;
        let curvature = hull.bend(part, &self.flight.swing(residue.attitude), -1.0); // f″
        let rest = newton.mul_add(0.5 * curvature * newton * inverse, newton);
        let attitude = residue.attitude.advanced(self.flight.rate() * rest);

        let mut found = leap.near & newton.abs().le(SMALL * leap.step);
        if H::TWO {
            // Where the other part touched after `step`, its gap cannot have become larger since than gravity and rotation open
            // it.
            let since = (leap.ahead - leap.step) + rest;
            let tilt = self.flight.swing(attitude).tilt;
            let other = hull.gap(&hull.part(!part.one), tilt, hull.lift(part, tilt));
            found = found & (0.5 * self.sway * (since * since)).le(other);
        }
        Arrival {
            time: residue.time + rest,
            attitude,
            done: look.never | found,
        }
    }

    /// Has the lanes arrive, of those that are `clear`, whose step from `time` leaves nothing of the gap that can be seen.
    #[inline(always)]
    pub fn graze(
        &self,
        time: Pack<S, K>,
        look: &Look<S, K>,
        leap: &Leap<S, K>,
        clear: Mask<S, K>,
        arrival: &mut Arrival<S, K>,
    ) {
        let step = leap.step;
        let end = time + step;
        let late = end.mul_add(-LAST, step);
        let turned = self.flight.rate().abs().mul_add(step, -LAST);
        let visible = self.bound.mul_add(step * step, -INVISIBLE);
        // Excesses, none of which may exceed 0: masks are dearer than numbers.
        let invisible = late.max(turned).max(visible).le(0.0);
        let last = look.gap.rate.lt(0.0) & invisible & clear & !arrival.done;
        let there = look.attitude.turned(self.flight.rate() * step);
        let attitude = &mut arrival.attitude;
        arrival.time = last.select(end, arrival.time);
        attitude.sine = last.select(there.sine, attitude.sine);
        attitude.cosine = last.select(there.cosine, attitude.cosine);
        arrival.done = arrival.done | last;
    }

    /// Up to when a pass that looked at `time` rules out a contact.
    #[inline(always)]
    pub fn certain(&self, time: Pack<S, K>, leap: &Leap<S, K>) -> Pack<S, K> {
        // However short a step is, time goes on.
        self.skip(time + leap.step.max(f64::EPSILON * time))
    }

    /// Where the next pass looks: just before the contact to which the expansions lead, or where it is `certain` that there is
    /// none before.
    #[inline(always)]
    pub fn aim(
        &self,
        certain: Pack<S, K>,
        leap: &Leap<S, K>,
        residue: &Residue<S, K>,
        arrival: &Arrival<S, K>,
        hull: &impl Hull,
    ) -> Pack<S, K> {
        let rate = residue.rate;
        // Seen from the contact the gap opens backwards for at least 2|f′|/M.
        let beyond = (0.5 * self.bound).mul_add(arrival.time - certain, rate);
        // Half as far from the contact as is near: a pass from there ends the search, and sees more of the gap than rounding.
        let turning = self.flight.rate().abs() * hull.sharpness();
        let margin = (0.5 * NEAR) * rate / turning.mul_add(-rate, self.sway);
        let aim = (arrival.time + margin).max(certain);
        let led = (self.flight.rate() * leap.ahead).abs().le(FAR);
        (led & beyond.le(0.0) & rate.lt(0.0)).select(aim, certain)
    }

    /// Whether no part can have touched between the time up to which that is `certain` and the `time` that is looked at.
    ///
    /// Backwards, too, f″ ≥ −M: s before it was seen to be f and f′ the gap was at least f − f′s − Ms²/2, which is concave, and so
    /// positive where it is so at both ends.
    #[inline(always)]
    pub fn is_clear<H: Hull>(
        &self,
        certain: Pack<S, K>,
        time: Pack<S, K>,
        look: &Look<S, K>,
        hull: &H,
    ) -> Mask<S, K> {
        let since = time - certain;
        let part = &look.gap.part;
        let least = self.least_gap(since, time, look, part, hull);
        let least = if H::TWO {
            least.min(self.least_gap(since, time, look, &hull.part(!part.one), hull))
        } else {
            least
        };
        !certain.lt(time) | (0.0 * since).lt(least)
    }

    /// A bound on the gap of a part for as long as `since` before `time`.
    #[inline(always)]
    fn least_gap(
        &self,
        since: Pack<S, K>,
        time: Pack<S, K>,
        look: &Look<S, K>,
        part: &Part<S, K>,
        hull: &impl Hull,
    ) -> Pack<S, K> {
        let (width, rate) = self.moment(time, look.attitude).opening(part, hull);
        let fallen = since.mul_add(0.5 * self.bound, rate);
        since.mul_add(-fallen, width).min(width)
    }

    /// Whether the gap falls to its only zero just behind `step`.
    #[inline(always)]
    fn is_near(&self, gap: &Gap<S, K>, step: Pack<S, K>, hull: &impl Hull) -> Mask<S, K> {
        let turned = self
            .flight
            .rate()
            .abs()
            .mul_add(step, -NEAR / hull.sharpness());
        let bent = self.sway.mul_add(step, -(NEAR * gap.root));
        gap.rate.lt(0.0) & turned.max(bent).le(0.0)
    }

    /// A step to the zero of the gap's fourth-order expansion, of third order behind `step`.
    #[inline(always)]
    fn expanded(&self, look: &Look<S, K>, step: Pack<S, K>, hull: &impl Hull) -> Pack<S, K> {
        let swing = self.flight.swing(look.attitude);
        let [second, third, fourth] = hull.bends(&look.gap.part, &swing); // f″ without gravity, f‴, f⁗
        let slack = second + self.sway; // f″ + M, what the lower bound leaves out
        // What is left of the gap after the step, and how fast it closes there.
        let bend = (step * fourth).mul_add(1.0 / 12.0, third * (1.0 / 3.0));
        let left = 0.5 * (step * step) * step.mul_add(bend, slack);
        let speed = step.mul_add(-step.mul_add(0.5 * third, slack), look.gap.root);
        let inverse = 1.0 / speed;
        let newton = left * inverse;
        let curvature = step.mul_add(third, second - 1.0); // f″
        step + newton.mul_add(0.5 * curvature * newton * inverse, newton)
    }
}
