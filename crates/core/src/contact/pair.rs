//! The first contact of two bodies in free flight, certified.
//!
//! The centres of two balls differ by **y**, |**y**″| ≤ M, the sum of what bounds the acceleration of each; the gap is f = |**y**| − ϱ₁ − ϱ₂. As |**y**| is
//! convex in **y**, f(t + s) ≥ |**y** + s**y**′| − ϱ₁ − ϱ₂ − Ms²/2. With w the part of **y**′ across **y**, |**y** + s**y**′| ≥ y + y′s + w²s²/2y as long
//! as |**y** + s**y**′| ≤ y, which is up to s = −2y y′/|**y**′|²; afterwards the parabola of f, f′ and M remains. Both are certified steps, which converge
//! quadratically to a contact. A plane is a body whose points do not move; its gap to a ball is that of [`super::plane`].

use super::certify::INVISIBLE;
use super::plane::GapExpansion;
use crate::math::Vector;
use crate::motion::{Pose, Turn};
use crate::shape::{Piece, Top};

/// Most steps of a search.
const MOST_STEPS: usize = 1 << 20;

/// Two bodies that move freely: the place and the velocity of the centre of the first relative to that of the second, and their rotations.
pub(crate) struct PairFlight {
    pub apart: Vector,
    pub velocity: Vector,
    pub turns: [Turn; 2],
    /// What bounds the acceleration of a point of each, per distance from its centre of mass.
    pub bounds: [f64; 2],
}

/// The parts of two bodies, and a length to which what rounding leaves is small.
pub(crate) struct PairSearch<'a> {
    pub pieces: [&'a [Piece]; 2],
    pub size: f64,
}

/// Two parts that leave each other, and their speed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairDeparture {
    pub parts: [usize; 2],
    pub speed: f64,
}

/// The first contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairTouch {
    pub time: f64,
    pub parts: [usize; 2],
    /// M T², with M the bound on |f″| and T the flight time.
    pub size: f64,
}

/// The gap of two parts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairGap {
    pub width: f64,
    pub rate: f64,
    /// From the second to the first.
    pub normal: Vector,
    /// The distance of their centres, and w².
    distance: f64,
    spread: f64,
    /// M.
    bound: f64,
}

impl PairGap {
    /// A time before which it does not close, and which is when it closes where this is soon.
    #[inline(always)]
    fn step(&self, shortest: f64) -> f64 {
        let width = self.width.max(0.0);
        let root = |bound: f64| {
            let acceleration = -bound;
            let (rate, square) = (self.rate, self.rate * self.rate + 2.0 * bound * width);
            if square < 0.0 || bound <= 0.0 && rate >= 0.0 {
                return f64::INFINITY;
            }
            GapExpansion {
                width,
                rate,
                acceleration,
            }
            .closes()
        };
        let mut step = root(self.bound);
        if self.rate < 0.0 {
            let until = -2.0 * self.distance * self.rate / (self.rate * self.rate + self.spread);
            step = step.max(until.min(root(self.bound - self.spread / self.distance)));
            step
        } else {
            step.max((shortest / self.bound).sqrt())
        }
    }
}

impl PairSearch<'_> {
    /// The gap of two parts of bodies in these poses.
    #[inline(always)]
    pub fn gap(
        &self,
        flight: &PairFlight,
        parts: [usize; 2],
        time: f64,
        poses: &[Pose; 2],
    ) -> PairGap {
        let apart = flight.velocity.mul_add(time, flight.apart);
        let [first, second] = [0, 1].map(|i| &self.pieces[i][parts[i]]);
        match (first, second) {
            (Piece::Ball(one), Piece::Ball(two)) => {
                let [a, va] = poses[0].moves(one.place);
                let [b, vb] = poses[1].moves(two.place);
                let (y, change) = (apart + a - b, flight.velocity + va - vb);
                let distance = y.norm();
                let normal = y / distance;
                let rate = normal.dot(change);
                PairGap {
                    width: distance - (one.radius + two.radius),
                    rate,
                    normal,
                    distance,
                    spread: (change.dot(change) - rate * rate).max(0.0),
                    bound: flight.bounds[0] * one.reach + flight.bounds[1] * two.reach,
                }
            }
            (Piece::Ball(one), Piece::Plane) => {
                let [a, va] = poses[0].moves(one.place);
                PairGap {
                    width: apart.z + a.z - one.radius,
                    rate: flight.velocity.z + va.z,
                    normal: Vector::new(0.0, 0.0, 1.0),
                    distance: f64::INFINITY,
                    spread: 0.0,
                    bound: flight.bounds[0] * one.reach,
                }
            }
            (Piece::Plane, _) => unreachable!("the plane is the second body"),
        }
    }

    /// f″ of two parts.
    #[inline(always)]
    pub fn acceleration(
        &self,
        tops: [&Top; 2],
        gap: &PairGap,
        parts: [usize; 2],
        poses: &[Pose; 2],
    ) -> f64 {
        let along = [0, 1].map(|i| match &self.pieces[i][parts[i]] {
            Piece::Ball(ball) => gap.normal.dot(poses[i].bends(tops[i], ball.place)),
            Piece::Plane => 0.0,
        });
        gap.spread / gap.distance + along[0] - along[1]
    }

    /// The narrowest gap of all parts at the beginning of a flight.
    pub fn narrowest(&self, flight: &mut PairFlight) -> f64 {
        let poses = poses(flight, 0.0);
        let mut least = f64::INFINITY;
        for i in 0..self.pieces[0].len() {
            for j in 0..self.pieces[1].len() {
                least = least.min(self.gap(flight, [i, j], 0.0, &poses).width);
            }
        }
        least
    }

    /// The first contact between two times, where two parts may be leaving each other at the beginning; an error if it does not converge. `clear` has
    /// room for a time of each two parts, up to which they do not touch, and `steps` counts.
    #[inline(always)]
    pub fn first(
        &self,
        flight: &mut PairFlight,
        departure: Option<PairDeparture>,
        [from, until]: [f64; 2],
        clear: &mut [f64],
        steps: &mut u64,
    ) -> Result<Option<PairTouch>, ()> {
        let [_, columns] = self.pieces.map(<[Piece]>::len);
        let invisible = INVISIBLE * self.size;
        clear.fill(0.0);
        let (mut time, mut last) = (from, 0);
        for _ in 0..MOST_STEPS {
            *steps += 1;
            let poses = poses(flight, time);
            let mut best = f64::INFINITY;
            let (mut found, first) = (None, last);
            // That which was the first to be near comes first, so that most others need no look.
            for turn in 0..clear.len() {
                let place = match turn {
                    0 => first,
                    _ if turn <= first => turn - 1,
                    _ => turn,
                };
                if clear[place] < best {
                    let parts = [place / columns, place % columns];
                    let mut gap = self.gap(flight, parts, time, &poses);
                    if let Some(left) = departure.filter(|left| time == 0.0 && left.parts == parts)
                    {
                        (gap.width, gap.rate) = (0.0, left.speed);
                    }
                    let step = gap.step(invisible);
                    clear[place] = time + step;
                    if clear[place] < best {
                        (best, last) = (clear[place], place);
                        let closes = gap.rate < 0.0 && gap.bound * step * step <= invisible;
                        found = closes.then_some((parts, gap.bound));
                    }
                }
            }
            if !(best < until) {
                return Ok(None);
            }
            if let Some((parts, bound)) = found {
                return Ok(Some(PairTouch {
                    time: best,
                    parts,
                    size: bound * best * best,
                }));
            }
            time = best.max(time * (1.0 + f64::EPSILON));
        }
        Err(())
    }
}

/// Both bodies at a time.
#[inline(always)]
pub(crate) fn poses(flight: &mut PairFlight, time: f64) -> [Pose; 2] {
    let [one, two] = &mut flight.turns;
    [one.at(time), two.at(time)]
}
