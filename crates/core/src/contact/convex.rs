//! The first contact of convex surfaces: the first root of the bound that the supports of their parts make.

use super::certify::{SHORTEST, TOUCHING, before};
use super::plane::{BackwardBound, Departure, GapExpansion, Step, first_root};
use crate::motion::SpinBounds;
#[cfg(test)]
use crate::shape::evaluations::{self, Evaluation};
use crate::shape::{Convex, ConvexSurface, NormalMotion, Support};

/// Bounds M on −f″.
#[derive(Clone, Copy)]
pub(super) struct CurvatureBounds {
    /// For so long the first of them holds.
    near: f64,
    first: f64,
    whole: f64,
}

impl CurvatureBounds {
    /// That which holds for a time.
    #[inline(always)]
    fn up_to(&self, time: f64) -> f64 {
        if time <= self.near {
            self.first
        } else {
            self.whole
        }
    }
}

impl<S: ConvexSurface> Convex<S> {
    /// As [`crate::shape::BallTree`]'s.
    pub(crate) fn looks_back(&self) -> bool {
        S::LOOKS_BACK
    }

    /// Of the points of a part.
    #[inline(always)]
    fn bounds(&self, part: usize, at: &NormalMotion, turn: &SpinBounds) -> CurvatureBounds {
        let (gravity, reach) = (-at.acceleration, self.surface.reach(part));
        CurvatureBounds {
            near: self.inner * turn.radian,
            first: gravity + turn.across * reach,
            whole: gravity + turn.whole * reach,
        }
    }

    /// As [`crate::shape::BallTree`]'s.
    #[inline(always)]
    pub(crate) fn step(
        &self,
        at: &NormalMotion,
        turn: &SpinBounds,
        departure: Option<Departure>,
        _: Option<(usize, f64)>,
        most: f64,
    ) -> Step {
        #[cfg(test)]
        evaluations::add(Evaluation::Support);
        let mut moved = NormalMotion::default();
        let own = self.own(at, &mut moved);
        let mut first = Step::NEVER;
        // Not a closure, which would not be compiled for the SIMD level of its caller.
        for part in 0..self.surface.parts() {
            let bounds = self.bounds(part, at, turn);
            let support = self.surface.along(part, own);
            let now = support.opening(own);
            let (width, rate) = match departure {
                Some(left) if left.part == part && support.is_flat() => (0.0, now.1),
                Some(left) if left.part == part => (0.0, left.speed),
                _ => now,
            };
            let length = convex_root(&support, (width.max(0.0), rate, bounds), most);
            first = first.or(Step {
                length,
                part,
                width,
                rate,
                closes: rate < 0.0 && length < most,
                bound: bounds.up_to(length),
                only_until: f64::INFINITY,
            });
        }
        first
    }

    /// As [`crate::shape::BallTree`]'s.
    #[inline(always)]
    pub(crate) fn backward(
        &self,
        part: usize,
        at: &NormalMotion,
        turn: &SpinBounds,
        since: f64,
    ) -> BackwardBound {
        #[cfg(test)]
        evaluations::add(Evaluation::Support);
        let mut moved = NormalMotion::default();
        let own = self.own(at, &mut moved);
        let bound = self.bounds(part, at, turn).up_to(since);
        let support = self.surface.along(part, own);
        let (width, rate) = support.opening(own);
        let before = before(since, width, rate, bound) - support.beyond_tangent(-since);
        let gap = GapExpansion {
            width,
            rate,
            acceleration: own.acceleration - support.second(),
        };
        BackwardBound::new(gap, before, since)
    }

    /// As [`crate::shape::BallTree`]'s.
    #[inline(always)]
    pub(crate) fn acceleration(&self, part: usize, at: &NormalMotion) -> f64 {
        let mut moved = NormalMotion::default();
        let own = self.own(at, &mut moved);
        own.acceleration - self.surface.along(part, own).second()
    }

    /// As [`crate::shape::BallTree`]'s.
    pub(crate) fn another_touches(&self, departure: Departure, at: &NormalMotion) -> bool {
        let mut moved = NormalMotion::default();
        let own = self.own(at, &mut moved);
        let opening = |part: usize| self.surface.along(part, own).opening(own);
        let still = opening(departure.part).1;
        (0..self.surface.parts()).any(|part| {
            let (width, rate) = opening(part);
            part != departure.part && width <= TOUCHING && rate < still
        })
    }
}

impl Step {
    /// That of no part.
    const NEVER: Self = Self {
        length: f64::INFINITY,
        part: 0,
        width: f64::INFINITY,
        rate: 0.0,
        closes: false,
        bound: 1.0,
        only_until: f64::INFINITY,
    };

    /// The shorter one, of the first part of both if they are equal.
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        let (mut first, later) = if other.length < self.length {
            (other, self)
        } else {
            (self, other)
        };
        first.only_until = first.only_until.min(later.length);
        first
    }
}

/// A time no later than `most` and the first root of width + rate s − (h(s) − h(0) − s h′(0)) − Ms²/2: this is concave, so that its chord from 0
/// to a place behind the root ends in front of it. Without h the root is behind it.
#[inline(always)]
fn convex_root(
    support: &impl Support,
    (width, rate, bounds): (f64, f64, CurvatureBounds),
    most: f64,
) -> f64 {
    let mut bound = bounds.first;
    let mut after = first_root(width, rate, bound);
    if after.min(most) > bounds.near {
        bound = bounds.whole;
        after = first_root(width, rate, bound);
    }
    let after = after.min(most);
    let parabola = |s: f64| before(-s, width, rate, bound);
    #[cfg(test)]
    evaluations::add(Evaluation::Support);
    let beyond = support.beyond_tangent(after);
    let found = parabola(after) - beyond;
    if beyond <= 0.0 || found >= 0.0 {
        return after;
    }
    // Where the gap is 0 at the beginning and opens, a point between it and the root.
    let mut near = (0.0, width);
    let mut inside = 0.5 * after;
    while near.1 <= 0.0 && rate > 0.0 {
        #[cfg(test)]
        evaluations::add(Evaluation::Support);
        let found = parabola(inside) - support.beyond_tangent(inside);
        if found > 0.0 {
            near = (inside, found);
        }
        inside *= 0.5;
        if bound * inside <= SHORTEST {
            return SHORTEST / bound;
        }
    }
    let chord = near.0 + (after - near.0) * near.1 / (near.1 - found);
    if rate < 0.0 {
        chord
    } else {
        chord.max(SHORTEST / bound)
    }
}
