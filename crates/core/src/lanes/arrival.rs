//! The end of the search: from the last certified step to the contact. See [`crate::contact`] for why it is the right one.

use super::contact::{Gap, Look, Search};
use super::flight::Attitude;
use super::{Mask, Pack};
use crate::contact::{INVISIBLE, LAST, NEAR, SMALL};
use pulp::Simd;

/// The next steps of the search.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Leap<S: Simd, const K: usize> {
    /// The certified one.
    step: Pack<S, K>,
    /// To the zero of an expansion, good where the contact is near.
    ahead: Pack<S, K>,
    near: Mask<S, K>,
}

/// What an expansion has left of the gap.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Residue<S: Simd, const K: usize> {
    time: Pack<S, K>,
    attitude: Attitude<S, K>,
    width: Pack<S, K>,
    rate: Pack<S, K>,
}

/// Where a pass of the search leads.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Arrival<S: Simd, const K: usize> {
    /// Time and attitude of the contact.
    pub time: Pack<S, K>,
    pub attitude: Attitude<S, K>,
    /// The lanes in which they are right, or that never land.
    pub done: Mask<S, K>,
}

impl<S: Simd, const K: usize> Search<S, K> {
    /// The next steps, from what is to be seen.
    #[inline(always)]
    pub fn leap(&self, look: &Look<S, K>) -> Leap<S, K> {
        let step = self.certified(&look.gap);
        Leap {
            step,
            ahead: self.expanded(look, step),
            near: self.is_near(&look.gap, step),
        }
    }

    /// What is left of the gap that was looked at at `time`.
    #[inline(always)]
    pub fn residue(&self, time: Pack<S, K>, look: &Look<S, K>, leap: &Leap<S, K>) -> Residue<S, K> {
        let time = time + leap.ahead;
        let attitude = look.attitude.turned(self.start.spin * leap.ahead);
        let side = look.gap.side;
        let climb = self.start.climb - time;
        Residue {
            time,
            attitude,
            width: side.mul_add(attitude.cosine, self.start.lift_at(time)), // (2)
            rate: side.mul_add(self.start.tilt_rate(attitude), climb),
        }
    }

    /// The contact, where it is near and the other sphere does not touch before.
    #[inline(always)]
    pub fn arrival(
        &self,
        look: &Look<S, K>,
        leap: &Leap<S, K>,
        residue: &Residue<S, K>,
    ) -> Arrival<S, K> {
        let side = look.gap.side;
        let square = self.start.spin * self.start.spin;
        // What is left goes in a step of third order.
        let inverse = -1.0 / residue.rate;
        let newton = residue.width * inverse;
        let curvature = side.mul_add(-square * residue.attitude.cosine, -1.0);
        let rest = newton.mul_add(0.5 * curvature * newton * inverse, newton);
        let attitude = residue.attitude.advanced(self.start.spin * rest);

        let small = newton.abs().le(SMALL * leap.step);
        let since = (leap.ahead - leap.step) + rest;
        let other = (-side).mul_add(attitude.cosine, -(side * attitude.cosine));
        let first = (0.5 * self.sway * (since * since)).le(other);
        Arrival {
            time: residue.time + rest,
            attitude,
            done: look.never | (leap.near & small & first),
        }
    }

    /// Has the lanes arrive whose step from `time` leaves nothing of the gap that can be seen.
    #[inline(always)]
    pub fn graze(
        &self,
        time: Pack<S, K>,
        look: &Look<S, K>,
        leap: &Leap<S, K>,
        arrival: &mut Arrival<S, K>,
    ) {
        let step = leap.step;
        let end = time + step;
        let late = end.mul_add(-LAST, step);
        let turned = self.start.spin.abs().mul_add(step, -LAST);
        let visible = self.bound.mul_add(step * step, -INVISIBLE);
        // Excesses, none of which may exceed 0: masks are dearer than numbers.
        let last = look.gap.rate.lt(0.0) & late.max(turned).max(visible).le(0.0) & !arrival.done;
        let there = look.attitude.turned(self.start.spin * step);
        let attitude = &mut arrival.attitude;
        arrival.time = last.select(end, arrival.time);
        attitude.sine = last.select(there.sine, attitude.sine);
        attitude.cosine = last.select(there.cosine, attitude.cosine);
        arrival.done = arrival.done | last;
    }

    /// Where the next pass looks after one at `time`; lanes that are done stay and find the same again.
    #[inline(always)]
    pub fn next(&self, time: Pack<S, K>, leap: &Leap<S, K>, arrival: &Arrival<S, K>) -> Pack<S, K> {
        arrival.done.select(time, self.skip(time + leap.step))
    }

    /// Whether the gap falls to its only zero just behind `step`.
    #[inline(always)]
    fn is_near(&self, gap: &Gap<S, K>, step: Pack<S, K>) -> Mask<S, K> {
        let turned = self.start.spin.abs().mul_add(step, -NEAR);
        let bent = self.sway.mul_add(step, -(NEAR * gap.root));
        gap.rate.lt(0.0) & turned.max(bent).le(0.0)
    }

    /// A step to the zero of the gap's fourth-order expansion, of third order behind `step`.
    #[inline(always)]
    fn expanded(&self, look: &Look<S, K>, step: Pack<S, K>) -> Pack<S, K> {
        let side = look.gap.side;
        let square = self.start.spin * self.start.spin;
        let second = side * (-square * look.attitude.cosine);
        let third = -(side * square) * self.start.tilt_rate(look.attitude);
        let fourth = -square * second;
        let slack = second + self.sway;
        let bend = (step * fourth).mul_add(1.0 / 12.0, third * (1.0 / 3.0));
        let left = 0.5 * (step * step) * step.mul_add(bend, slack);
        let speed = step.mul_add(-step.mul_add(0.5 * third, slack), look.gap.root);
        let inverse = 1.0 / speed;
        let newton = left * inverse;
        let curvature = step.mul_add(third, second - 1.0);
        step + newton.mul_add(0.5 * curvature * newton * inverse, newton)
    }
}
