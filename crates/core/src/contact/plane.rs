//! The first contact of any body with the plane, certified: the scalar twin of `lanes/`.
//!
//! With **n**(t) the plane normal in the axes of the body, a point **p** of a ball of radius r has the gap f = z + **n**·**p** − r. In flight
//! |**n**″| ≤ cΩ², c = 1 + a/√3 ([`SpinBounds`]), because **n**′ = **n** × **ω** and so **n**″ = **n**′ × **ω** + **n** × **ω**′, the
//! acceleration of a material unit vector. So f″ ≥ −(1 + cΩ²|**p**|): the parabola of f, f′ and that bound M lies below f, and its first root
//! is a step that cannot pass a contact.
//!
//! Of a convex body h(**v**) = max **v**·**x** over its points **x**, for all vectors **v**, is convex, and h(**v** + **w**) ≤ h(**v**) + h(**w**)
//! ≤ h(**v**) + R|**w**| with R the largest |**x**|. The gap is f = z − h(−**n**), and **n**(t + s) differs from **n** + s**n**′ by no more than
//! cΩ²s²/2; hence f(t + s) ≥ z + v s − h(−**n** − s**n**′) − (1 + cΩ²R)s²/2. This lower bound is concave, too, and has one root s > 0 behind which
//! it stays negative. It holds for rims, edges and flats alike.
//!
//! Most of **n**″ is along **n**: **n**″ = −|**n**′|²**n** + **T**, |**T**| ≤ τΩ² with τ = ½ + a/√3 ([`SpinBounds`]). A point **x** of the body is g = −**n**·**x**
//! below the centre of mass, and g″ = −|**n**′|²g − **T**·**x** ≤ τΩ²R while g ≥ 0. What touches first has g = z, which is no less than the radius r of
//! any ball about the centre of mass inside of the body; as |g′| ≤ ΩR, it had g ≥ 0 in the time r/(ΩR) before. So in steps up to that, τ may
//! stand for c.
//!
//! Steps to the first root of these bounds converge quadratically to the contact. The same bounds hold backward in time, with −f′ for f′ and −**n**′
//! for **n**′, so that the search may look on behind a step: where f, f′ and f″ expect the contact, or else almost as far again. If the bound from
//! there is positive where the step ended, nothing touched in between ([`BallTree::backward`]), or an overlap began there once only, as late as the bound
//! says; if not, the search goes on at the end of the step. Where the contact is so near that the bound will be positive, the body is looked at
//! there without a step before. To where f″ expects it the search converges with the third order. It ends when what is left of the gap is below
//! the resolution. An overlap at the end of a step is rounding: one that approaches is a contact now, one that separates is none.

use super::certify::{TOUCHING, before, closing_speed, first_zero, zero};
use crate::motion::SpinBounds;
#[cfg(test)]
use crate::shape::evaluations::{self, Evaluation};
use crate::shape::{BallTree, Least, NormalMotion, Point, Pruning};

/// Far from the contact nodes of the tree are not looked into where they allow a step of this part of the length that is found.
const ENOUGH: f64 = 0.7;
/// A step is short where M changes the rate by less than this part of it: what touches after one is then nearly as late as its parabola says.
const SHORT: f64 = 0.0625;

/// A part of the body whose gap is known exactly: the one on the plane at the beginning of a flight, and the speed at which it leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Departure {
    pub part: usize,
    pub speed: f64,
}

/// The time before which no part touches, and the part that may touch then.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub length: f64,
    pub part: usize,
    /// Its gap and the rate of it.
    pub width: f64,
    pub rate: f64,
    /// True if the step leads to where it closes.
    pub closes: bool,
    /// M.
    pub bound: f64,
    /// For so long no other part touches.
    pub only_until: f64,
}

/// The gap of a part with its first two derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GapExpansion {
    pub width: f64,
    pub rate: f64,
    pub acceleration: f64,
}

/// The knowledge of the flight before a time, and the gap then.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BackwardBound {
    pub gap: GapExpansion,
    /// The part did not touch before so long ago, 0 if it does not overlap; none if it may have.
    pub clear: Option<f64>,
}

impl BackwardBound {
    /// From the lower bound of the gap so long ago. The bound is concave, so that it lies above its chord.
    #[inline(always)]
    pub fn new(gap: GapExpansion, before: f64, since: f64) -> Self {
        let clear = (before > 0.0).then(|| {
            if gap.width < 0.0 {
                since * gap.width / (gap.width - before)
            } else {
                0.0
            }
        });
        Self { gap, clear }
    }
}

impl GapExpansion {
    /// When it will be 0, or was if it is negative, by f + f′s + f″s²/2; no number if it never is.
    #[inline(always)]
    pub fn closes(&self) -> f64 {
        let (width, rate, bound) = (self.width, self.rate, -self.acceleration);
        let speed = rate.abs() + closing_speed(width, rate, bound);
        zero(width, rate, speed, speed, bound)
    }

    /// When it will be 0, or was, if that is after `certain` and so near to it that a look from there will certify the time between: M times that
    /// is less than the speed of the contact.
    #[inline(always)]
    pub fn certainly_closes(&self, certain: f64, bound: f64) -> Option<f64> {
        let ahead = self.closes();
        let speed = -(self.rate + self.acceleration * ahead);
        (certain < ahead && (ahead - certain) * bound <= speed).then_some(ahead)
    }
}

/// [`first_zero`] of f ≥ 0, f′ and M.
#[inline(always)]
pub(super) fn first_root(width: f64, rate: f64, bound: f64) -> f64 {
    first_zero(width, rate, closing_speed(width, rate, bound), bound)
}

impl BallTree {
    /// A step that passes no contact, no longer than `most` > 0. `departure` holds at the beginning of a flight; `near` is a part
    /// that may be the first, and no other touches for so long.
    #[inline(always)]
    pub(crate) fn step(
        &self,
        at: &NormalMotion,
        turn: &SpinBounds,
        departure: Option<Departure>,
        near: Option<(usize, f64)>,
        most: f64,
    ) -> Step {
        let opening = |part: usize, point: &Point| match departure {
            Some(left) if left.part == part => (0.0, left.speed),
            _ => point.opening(at),
        };
        let bound = |reach: f64| turn.whole * reach - at.acceleration;
        // The parabola of the least gap, the least rate and the largest M of a node lies below those of all its self.
        let exceeds = |least: &Least, limit: f64| {
            before(-limit, least.gap.max(0.0), least.rate, bound(least.reach)) > 0.0
        };
        let cost = |part: usize, point: &Point, limit: f64| {
            let (width, rate) = opening(part, point);
            let (width, bound) = (width.max(0.0), bound(f64::from(point.reach)));
            if before(-limit, width, rate, bound) > 0.0 {
                f64::INFINITY
            } else {
                first_root(width, rate, bound)
            }
        };
        let found = |part: usize, root: f64, only_until: f64| {
            let point = &self.points()[part];
            let (width, rate) = opening(part, point);
            Step {
                length: root.min(only_until),
                part,
                width,
                rate,
                closes: root <= only_until && rate < 0.0,
                bound: bound(f64::from(point.reach)),
                only_until,
            }
        };
        if let Some((part, only_until)) = near {
            #[cfg(test)]
            evaluations::add(Evaluation::Gap);
            let root = cost(part, &self.points()[part], f64::INFINITY);
            if root < only_until {
                return found(part, root, only_until);
            }
        }
        let effort = Pruning {
            most,
            enough: ENOUGH,
            short: SHORT * at.rate.abs() / bound(1.0),
        };
        let first = self.cheapest(at, near.map(|near| near.0), effort, exceeds, cost);
        found(first.place, first.cost, first.others)
    }

    /// False where f″ and the bound backward take longer than the steps that they save.
    pub(crate) fn looks_back(&self) -> bool {
        true
    }

    /// When in the time `since` before this one a part can have touched.
    #[inline(always)]
    pub(crate) fn backward(
        &self,
        part: usize,
        at: &NormalMotion,
        turn: &SpinBounds,
        since: f64,
    ) -> BackwardBound {
        #[cfg(test)]
        evaluations::add(Evaluation::Gap);
        let point = &self.points()[part];
        let (width, rate) = point.opening(at);
        let bound = turn.whole * f64::from(point.reach) - at.acceleration;
        let before = before(since, width, rate, bound);
        let gap = GapExpansion {
            width,
            rate,
            acceleration: point.acceleration(at),
        };
        BackwardBound::new(gap, before, since)
    }

    /// f″ of a part.
    #[inline(always)]
    pub(crate) fn acceleration(&self, part: usize, at: &NormalMotion) -> f64 {
        self.points()[part].acceleration(at)
    }

    /// True if some part but one overlaps, or touches within rounding, and approaches faster than that one.
    pub(crate) fn another_touches(&self, departure: Departure, at: &NormalMotion) -> bool {
        let still = self.points()[departure.part].opening(at).1;
        let exceeds = |least: &Least, limit: f64| least.gap > TOUCHING || least.rate > limit;
        let cost = |part: usize, point: &Point, _: f64| {
            let (gap, rate) = point.opening(at);
            if part != departure.part && gap <= TOUCHING {
                rate
            } else {
                f64::INFINITY
            }
        };
        self.cheapest(at, None, Pruning::EXACT, exceeds, cost).cost < still
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector;
    use crate::random::pair;
    use crate::shape::RigidSurface;

    fn vector(seed: u64, index: u64) -> Vector {
        let ((x, y), (z, _)) = (pair(seed, 2 * index), pair(seed, 2 * index + 1));
        Vector::new(2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * z - 1.0)
    }

    /// Balls in a cube or on a sphere, near and far from each other, as many as are in one leaf or in a tree of ten levels, some among balls that
    /// are much larger.
    fn balls(seed: u64, count: u64) -> BallTree {
        let point = |i: u64| {
            let mut place = vector(seed, i) * 0.5;
            if seed.is_multiple_of(2) {
                place = place * (0.9 / place.norm());
            }
            let large = seed.is_multiple_of(5) && i.is_multiple_of(500);
            let (place, size) = if large {
                (place * 0.4, 0.6)
            } else {
                (place, 0.1)
            };
            Point::new(place, size * pair(seed, i + 100_000).0, i as usize)
        };
        BallTree::new("spheres", (0..count).map(point).collect()).unwrap()
    }

    /// Steps are no longer than those of the exhaustive search, and no shorter than the part that is enough; one that is taken for a contact
    /// is the same. None is longer than what is asked for, and no other ball touches while one is alone. The lowest ball is the lowest, and what
    /// touches beside a departing one is found.
    #[test]
    fn the_tree_finds_what_asking_every_ball_finds() {
        let (mut exact, mut alone) = (0, 0);
        for count in [1, 2, 8, 9, 16, 17, 100, 1000, 5000] {
            for seed in 0..40 {
                let balls = balls(seed, count);
                let up = vector(seed, 1_000_000);
                let up = up / up.norm();
                let lowest = |point: &Point| point.radius - up.dot(point.place);
                let support = balls
                    .points()
                    .iter()
                    .map(lowest)
                    .fold(f64::NEG_INFINITY, f64::max);
                let surface = RigidSurface::Balls(balls.clone());
                assert!((surface.support(up) - support).abs() <= 1e-15);
                for (height, rate) in [
                    (0.0, -1.0),
                    (1e-9, -0.3),
                    (1e-3, -2.0),
                    (0.2, 0.5),
                    (0.0, 0.2),
                ] {
                    let at = NormalMotion {
                        height: support + height,
                        rate,
                        acceleration: -1.0,
                        up,
                        turning: up.cross(vector(seed, 1_000_001)),
                        ..NormalMotion::default()
                    };
                    let turn = &SpinBounds::new(0.5, 2.0 * pair(seed, 7).0);
                    let length = |point: &Point| {
                        let (width, rate) = point.opening(&at);
                        let bound = 1.0 + turn.whole * f64::from(point.reach);
                        first_root(width.max(0.0), rate, bound)
                    };
                    let least = balls
                        .points()
                        .iter()
                        .map(length)
                        .fold(f64::INFINITY, f64::min);
                    let near = (seed % 3 == 0).then_some((0, 0.0));
                    let step = balls.step(&at, turn, None, near, f64::INFINITY);
                    assert!(step.length <= least && step.length >= ENOUGH * least);
                    let others = balls.points().iter().enumerate();
                    let others = others.filter(|&(part, _)| part != step.part);
                    assert!(
                        others
                            .clone()
                            .all(|(_, point)| length(point) >= step.only_until)
                    );
                    let cut = balls.step(&at, turn, None, near, 0.25 * least);
                    assert!(cut.length == 0.25 * least && (!cut.closes || least == 0.0));
                    if step.only_until > step.length {
                        let same = balls.step(
                            &at,
                            turn,
                            None,
                            Some((step.part, step.only_until)),
                            f64::INFINITY,
                        );
                        assert_eq!(
                            (same.part, same.length, same.closes),
                            (step.part, step.length, step.closes)
                        );
                        alone += 1;
                    }
                    if step.closes && step.length < 1e-6 {
                        assert_eq!(step.length, least);
                        exact += 1;
                    }
                    let left = Departure {
                        part: step.part,
                        speed: 0.0,
                    };
                    let still = balls.points()[step.part].opening(&at).1;
                    let touches = balls.points().iter().enumerate().any(|(part, point)| {
                        let (width, rate) = point.opening(&at);
                        part != step.part && width <= TOUCHING && rate < still
                    });
                    assert_eq!(balls.another_touches(left, &at), touches);
                }
            }
        }
        assert!(exact > 400 && alone > 400);
    }
}
