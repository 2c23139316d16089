//! The first contact of two bodies in free flight, certified.
//!
//! The centres of two balls differ by **y**, |**y**″| ≤ M, the sum of what bounds the acceleration of each; the gap is f = |**y**| − ϱ₁ − ϱ₂. As |**y**| is
//! convex in **y**, f(t + s) ≥ |**y** + s**y**′| − ϱ₁ − ϱ₂ − Ms²/2. With w the part of **y**′ across **y**, |**y** + s**y**′| ≥ y + y′s + w²s²/2y as long
//! as |**y** + s**y**′| ≤ y, which is up to s = −2y y′/|**y**′|²; afterwards the parabola of f, f′ and M remains.
//!
//! Other parts are parted by a plane whose normal **n** + s**n**′ turns at a constant rate. With **d** and **d**′ those or their negatives, a material point
//! **r** of a body has (**d** + s**d**′)·**r**(t + s) ≤ (**d** + s**e**)·**r** + s²(|**d**′|Ω|**r**| + |**d** + s**d**′|M|**r**|/2), **e** = **d**′ + **d** × **ω**, so that
//! what parts the bodies is at least
//!
//! F(s) = **n**·**X** + s(**n**′·**X** + **n**·**V**) − h₁(**u**₁ + s**u**₁′) − h₂(**u**₂ + s**u**₂′) − Ks²,
//!
//! with h the support functions and **u**, **u**′ the vectors ∓**n**, **e** in the axes of a body. F is concave, whatever **n** and **n**′ are: it certifies the
//! time up to its root. **n** joins the closest points: among all pairs of a corner, an edge or a face of each, that which parts them most. It must be
//! perpendicular to their edges; what freedom is left maximises **n**·**Y** − √(**n**·B₁**n**) − √(**n**·B₂**n**) by Newton's method. With **n**′ such that it stays
//! perpendicular, F′ is the rate of the gap, and steps converge quadratically.
//!
//! A ball that is a summand of a part does not turn: its support is ϱ|**d** + s**d**′|, and |**r**| is that of the rest. The surface of a body of revolution
//! turns about **Λ** at a constant rate Ω: a point that is D from that line has the velocity ΩD and an acceleration Ω²D across **Λ**, of which **n** sees the part
//! |**n** × **Λ**|/|**Λ**|.
//!
//! A plane is a body whose points do not move.

use super::certify::INVISIBLE;
use super::plane::GapExpansion;
use crate::math::Vector;
use crate::motion::{BodyFrame, BodyPose, FlightRotation, SpinBounds};
use crate::shape::{Feature, Piece, PieceKind, Round, Top};

/// Most steps of a search.
const MOST_STEPS: usize = 1 << 20;
/// The gap, over the size of a pair, that counts as none.
pub(super) const NARROW: f64 = 1e-14;
/// Most rounds of Newton's method for a normal.
pub(super) const ROUNDS: usize = 30;
/// The same between parts that are nearly flat where they touch, as superellipsoids are.
const FLAT_ROUNDS: usize = 300;
const UP: Vector = Vector::new(0.0, 0.0, 1.0);

/// Two bodies that move freely: the place and the velocity of the centre of the first relative to that of the second, and their rotations.
pub(crate) struct PairFlight {
    pub apart: Vector,
    pub velocity: Vector,
    pub turns: [FlightRotation; 2],
}

/// The parts of two bodies, and a length to which what rounding leaves is small.
pub(crate) struct PairSearch<'a> {
    pub pieces: [&'a [Piece]; 2],
    pub size: f64,
}

/// The memory of a search about two parts.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Between {
    parts: [usize; 2],
    /// They do not touch up to this time.
    clear: f64,
    /// The last normal between them.
    normal: Vector,
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

/// The gap of two balls, or of a ball and a plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BallGap {
    width: f64,
    rate: f64,
    /// From the second to the first.
    normal: Vector,
    /// The distance of their centres, and w².
    distance: f64,
    spread: f64,
    /// M.
    bound: f64,
}

/// A plane between two parts, from the second to the first: **n** and **n**′, the part that it leaves between them, and where they touch it.
struct Parting<'a> {
    normal: Vector,
    turning: Vector,
    width: f64,
    features: [Option<&'a Feature>; 2],
}

/// The axes of both bodies.
type Frames = [BodyFrame; 2];

impl BallGap {
    /// A time before which it does not close, and which is when it closes where this is soon.
    #[inline(always)]
    fn step(&self, shortest: f64) -> f64 {
        let width = self.width.max(0.0);
        let root = |bound: f64| root(width, self.rate, bound);
        if self.rate >= 0.0 {
            return root(self.bound).max((shortest / self.bound).sqrt());
        }
        let until = -2.0 * self.distance * self.rate / (self.rate * self.rate + self.spread);
        let bent = root(self.bound - self.spread / self.distance);
        if bent <= until {
            bent
        } else {
            root(self.bound).max(until)
        }
    }
}

/// The first root ≥ 0 of width + rate s − bound s²/2; infinite if there is none.
#[inline(always)]
fn root(width: f64, rate: f64, bound: f64) -> f64 {
    let acceleration = -bound;
    if rate * rate + 2.0 * bound * width < 0.0 || bound <= 0.0 && rate >= 0.0 {
        return f64::INFINITY;
    }
    GapExpansion {
        width,
        rate,
        acceleration,
    }
    .closes()
}

impl<'a> PairSearch<'a> {
    #[inline(always)]
    fn parts(&self, parts: [usize; 2]) -> [&'a Piece; 2] {
        let [first, second] = self.pieces;
        [&first[parts[0]], &second[parts[1]]]
    }

    /// The gap of two parts, if one is a ball and the other one, too, or a plane.
    #[inline(always)]
    fn balls(
        &self,
        flight: &PairFlight,
        parts: [usize; 2],
        (time, poses): (f64, &[BodyPose; 2]),
    ) -> Option<BallGap> {
        let [first, second] = self.parts(parts);
        let PieceKind::Ball(place, radius) = first.kind else {
            return None;
        };
        let apart = flight.velocity.mul_add(time, flight.apart);
        let [a, va] = poses[0].moves(place);
        let bound = flight.turns[0].bound() * first.reach;
        match second.kind {
            PieceKind::Ball(other, size) => {
                let [b, vb] = poses[1].moves(other);
                let (y, change) = (apart + a - b, flight.velocity + va - vb);
                let distance = y.norm();
                let normal = y / distance;
                let rate = normal.dot(change);
                Some(BallGap {
                    width: distance - (radius + size),
                    rate,
                    normal,
                    distance,
                    spread: (change.dot(change) - rate * rate).max(0.0),
                    bound: bound + flight.turns[1].bound() * second.reach,
                })
            }
            PieceKind::Plane => Some(BallGap {
                width: apart.z + a.z - radius,
                rate: flight.velocity.z + va.z,
                normal: UP,
                distance: f64::INFINITY,
                spread: 0.0,
                bound,
            }),
            PieceKind::Convex => None,
        }
    }

    /// True if two balls that touch and do not part are pressed together.
    #[inline(always)]
    pub fn rests(&self, tops: [&Top; 2], flight: &mut PairFlight, left: &PairDeparture) -> bool {
        if left.speed > 0.0 {
            return false;
        }
        let poses = poses(flight, 0.0);
        let Some(gap) = self.balls(flight, left.parts, (0.0, &poses)) else {
            return false;
        };
        let pieces = self.parts(left.parts);
        let along = [0, 1].map(|i| match pieces[i].kind {
            PieceKind::Ball(place, _) => gap.normal.dot(poses[i].bends(tops[i], place)),
            _ => 0.0,
        });
        gap.spread / gap.distance + along[0] - along[1] <= 0.0
    }

    /// The narrowest gap of all parts at the beginning of a flight.
    pub fn narrowest(&self, flight: &mut PairFlight) -> f64 {
        let poses = poses(flight, 0.0);
        let mut least = f64::INFINITY;
        for i in 0..self.pieces[0].len() {
            for j in 0..self.pieces[1].len() {
                let width = match self.balls(flight, [i, j], (0.0, &poses)) {
                    Some(gap) => gap.width,
                    None => {
                        parting(
                            flight.apart,
                            self.parts([i, j]),
                            frames(&poses),
                            Vector::default(),
                            None,
                        )
                        .width
                    }
                };
                least = least.min(width);
            }
        }
        least
    }

    /// The normal from the second body to the first where two parts touch, and the point of contact from the centre of mass of the first.
    #[inline(always)]
    pub fn meeting(
        &self,
        apart: Vector,
        parts: [usize; 2],
        poses: &[BodyPose; 2],
        between: &Between,
    ) -> (Vector, Vector) {
        let pieces = self.parts(parts);
        if let (PieceKind::Ball(place, radius), other) = (pieces[0].kind, pieces[1].kind) {
            let [one, _] = poses[0].moves(place);
            match other {
                PieceKind::Ball(second, _) => {
                    let y = apart + one - poses[1].moves(second)[0];
                    let normal = y / y.norm();
                    return (normal, one - normal * radius);
                }
                PieceKind::Plane => return (UP, one - UP * radius),
                PieceKind::Convex => {}
            }
        }
        let frames = frames(poses);
        let found = parting(apart, pieces, frames, between.normal, None);
        (found.normal, found.place(apart, pieces, frames))
    }

    /// The first contact between two times, where two parts may be leaving each other at the beginning; an error if it does not converge. `between` has
    /// room for each two parts, and `steps` counts.
    #[inline(always)]
    pub fn first(
        &self,
        flight: &mut PairFlight,
        departure: Option<PairDeparture>,
        [from, until]: [f64; 2],
        between: &mut [Between],
        steps: &mut u64,
    ) -> Result<Option<PairTouch>, ()> {
        let columns = self.pieces[1].len();
        let invisible = INVISIBLE * self.size;
        for row in 0..self.pieces[0].len() {
            for column in 0..columns {
                let each = &mut between[row * columns + column];
                (each.parts, each.clear) = ([row, column], 0.0);
            }
        }
        let (mut time, mut last) = (from, 0);
        for _ in 0..MOST_STEPS {
            *steps += 1;
            let poses = poses(flight, time);
            let mut best = f64::INFINITY;
            let (mut found, first) = (None, last);
            // That which was the first to be near comes first, so that most others need no look.
            for turn in 0..between.len() {
                let place = match turn {
                    0 => first,
                    _ if turn <= first => turn - 1,
                    _ => turn,
                };
                if between[place].clear < best {
                    let parts = between[place].parts;
                    let left = departure.filter(|left| time == 0.0 && left.parts == parts);
                    let (step, rate, bound) = match self.balls(flight, parts, (time, &poses)) {
                        Some(mut gap) => {
                            if let Some(left) = left {
                                (gap.width, gap.rate) = (0.0, left.speed);
                            }
                            (
                                gap.step(invisible),
                                gap.rate,
                                gap.bound + gap.spread / gap.distance,
                            )
                        }
                        None => self.convex_step(
                            flight,
                            parts,
                            (time, &poses),
                            left,
                            &mut between[place].normal,
                        ),
                    };
                    between[place].clear = time + step;
                    if between[place].clear < best {
                        (best, last) = (between[place].clear, place);
                        let closes = rate < 0.0 && bound * step * step <= invisible;
                        found = closes.then_some((parts, bound));
                    }
                }
            }
            if best.is_nan() || best >= until {
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

    /// A certified step of two convex parts, the rate of their gap, and a bound on |f″| where the gap is not closed.
    #[inline(always)]
    fn convex_step(
        &self,
        flight: &PairFlight,
        parts: [usize; 2],
        (time, poses): (f64, &[BodyPose; 2]),
        left: Option<PairDeparture>,
        normal: &mut Vector,
    ) -> (f64, f64, f64) {
        let (pieces, frames) = (self.parts(parts), frames(poses));
        let apart = flight.velocity.mul_add(time, flight.apart);
        let found = parting(apart, pieces, frames, *normal, Some(self.size));
        *normal = found.normal;
        let Parting {
            normal: n, turning, ..
        } = found;
        let speed = turning.norm();
        let most = if speed > 0.0 {
            1.0 / speed
        } else {
            f64::INFINITY
        };
        let one = swings(pieces[0], &flight.turns[0], n, speed);
        let two = swings(pieces[1], &flight.turns[1], n, speed);
        let curved = speed * (one[0] + two[0])
            + 0.5 * (one[1] + two[1])
            + (-turning.dot(flight.velocity)).max(0.0);
        let directions = [
            direction(n * -1.0, turning * -1.0, &frames[0]),
            direction(n, turning, &frames[1]),
        ];
        let across = turning.dot(apart) + n.dot(flight.velocity);
        let (mut size, mut rate) = (0.0, across);
        for (piece, (u, change)) in pieces.into_iter().zip(directions) {
            let (height, point) = piece.support(u, change);
            size += height;
            rate -= change.dot(point);
        }
        let begin = n.dot(apart) - size;
        let (width, lift) = match left {
            Some(left) => (0.0, left.speed - rate),
            None => (begin.max(0.0), 0.0),
        };
        let rate = rate + lift;
        let parted = |s: f64| {
            let normal = turning.mul_add(s, n).norm();
            let sum = height(pieces[0], directions[0], s, normal)
                + height(pieces[1], directions[1], s, normal);
            width + (s * (across + lift) - (sum - size)) - curved * s * s
        };
        let shortest = (INVISIBLE * self.size / (2.0 * curved)).sqrt();
        let mut after = root(width, rate, 2.0 * curved).min(most);
        if rate >= 0.0 {
            after = after.max(shortest);
        }
        // A chord of F ends in front of its root, because F is concave.
        let mut before = (0.0, width);
        for _ in 0..64 {
            if after <= shortest || after == f64::INFINITY {
                break;
            }
            let value = parted(after);
            if value >= -1e-16 * self.size {
                break;
            }
            if before.1 > 0.0 {
                after = before.0 + (after - before.0) * before.1 / (before.1 - value);
                break;
            }
            // From a gap of 0 that opens, to a place where it is open.
            let inside = 0.5 * after;
            let there = parted(inside);
            if there > 0.0 {
                before = (inside, there);
            } else {
                after = inside;
            }
        }
        let step = if rate >= 0.0 {
            after.max(shortest)
        } else {
            after
        };
        // The gap is above F by at most V²s²/2d, d the distance of what touches, which for corners is the gap itself.
        let bends = if width > NARROW * self.size {
            let most = flight.velocity.norm() + one[0] + two[0];
            most * most / width
        } else {
            0.0
        };
        (step, rate, 2.0 * curved + bends)
    }
}

impl Parting<'_> {
    /// The point where both touch the plane, from the centre of mass of the first.
    #[inline(always)]
    fn place(&self, apart: Vector, pieces: [&Piece; 2], frames: Frames) -> Vector {
        let point = |i: usize, sign: f64| {
            let u = frames[i].back(self.normal * sign);
            frames[i].rotate(pieces[i].support(u, Vector::default()).1)
        };
        let tied = |i: usize| self.features[i].map_or(0, |feature| feature.ties.len());
        if pieces[1].kind == PieceKind::Plane {
            return point(0, -1.0);
        }
        if tied(0) == 0 && self.features[0].is_some() {
            // On a surface that is nearly flat the normal hardly tells the place.
            let flatness = |i: usize, sign: f64| {
                let u = frames[i].back(self.normal * sign);
                let a = u.across();
                let found = pieces[i].round.support(u);
                let [p, _, q] = pieces[i].round.bends(u, [a, u.cross(a)], found);
                p + q
            };
            let other = pieces.iter().any(|piece| is_flat(&piece.round)) && tied(1) == 0;
            return if other && flatness(1, 1.0) < flatness(0, -1.0) {
                point(1, 1.0) - apart
            } else {
                point(0, -1.0)
            };
        }
        if tied(1) == 0 || tied(0) == 2 {
            return point(1, 1.0) - apart;
        }
        if tied(1) == 2 {
            return point(0, -1.0);
        }
        // Where two edges cross.
        let (one, two) = (point(0, -1.0), point(1, 1.0) - apart);
        let edge = |i: usize| {
            let tie = self.features[i].map_or(Vector::default(), |feature| feature.ties[0]);
            frames[i].rotate(tie)
        };
        let (e, f) = (edge(0), edge(1));
        let (between, normal) = (two - one, e.cross(f));
        one + e * (between.cross(f).dot(normal) / normal.dot(normal))
    }
}

impl<'a> Parting<'a> {
    /// The wider one of two gaps.
    #[inline(always)]
    fn or(self, normal: Vector, features: [Option<&'a Feature>; 2], width: f64) -> Self {
        if width > self.width {
            Self {
                normal,
                width,
                features,
                ..self
            }
        } else {
            self
        }
    }
}

/// The gap of two parts along a unit vector.
#[inline(always)]
fn width(n: Vector, apart: Vector, pieces: [&Piece; 2], frames: Frames) -> f64 {
    let first = frames[0].back(n * -1.0);
    let second = frames[1].back(n);
    n.dot(apart)
        - pieces[0].support(first, Vector::default()).0
        - pieces[1].support(second, Vector::default()).0
}

/// The plane that parts two convex parts most, from the normal that did so last; a `rough` one, as [`freely`] has it.
#[inline(always)]
fn parting<'a>(
    apart: Vector,
    pieces: [&'a Piece; 2],
    frames: Frames,
    last: Vector,
    rough: Option<f64>,
) -> Parting<'a> {
    if pieces[1].kind == PieceKind::Plane {
        return Parting {
            normal: UP,
            turning: Vector::default(),
            width: width(UP, apart, pieces, frames),
            features: [None, None],
        };
    }
    let start = if last == Vector::default() {
        apart / apart.norm()
    } else {
        last
    };
    let rounds = [
        frames[0].round(&pieces[0].round),
        frames[1].round(&pieces[1].round),
    ];
    let sharp = rounds.iter().all(Round::is_point);
    let mut best = Parting {
        normal: start,
        turning: Vector::default(),
        width: f64::NEG_INFINITY,
        features: [None, None],
    };
    for (i, sign) in [(0, -1.0), (1, 1.0)] {
        for face in &pieces[i].features {
            if let Some(normal) = face.normal {
                let mut features = [None, None];
                features[i] = Some(face);
                let normal = frames[i].rotate(normal) * sign;
                best = best.or(normal, features, width(normal, apart, pieces, frames));
            }
        }
    }
    let alone = pieces[0].corners.len() == 1 && pieces[1].corners.len() == 1;
    let [a, b] = &frames;
    for one in &pieces[0].features {
        if one.normal.is_some() {
            continue;
        }
        let corner = apart + a.rotate(one.corner);
        let first = one.ties.first().map(|&tie| a.rotate(tie));
        for two in &pieces[1].features {
            // Corners of polyhedra touch only by chance, and faces and edges part them as well.
            if two.normal.is_some() || sharp && one.ties.len() + two.ties.len() < 2 {
                continue;
            }
            let second = two.ties.first().map(|&tie| b.rotate(tie));
            let between = corner - b.rotate(two.corner);
            let (normal, known) = match (first, second) {
                (Some(e), Some(f)) => {
                    let across = e.cross(f);
                    let square = across.dot(across);
                    if square <= 1e-20 * e.dot(e) * f.dot(f) {
                        continue;
                    }
                    let side = if across.dot(apart) < 0.0 { -1.0 } else { 1.0 };
                    (across * (side / square.sqrt()), None)
                }
                (tie, other) => match freely(between, &rounds, tie.or(other), start, rough) {
                    Some((normal, width)) => (normal, alone.then_some(width)),
                    None => continue,
                },
            };
            let features = [Some(one), Some(two)];
            if let Some(width) = known {
                best = best.or(normal, features, width);
            } else if normal.dot(between) > best.width {
                // No gap is wider than what is between two points of the bodies.
                best = best.or(normal, features, width(normal, apart, pieces, frames));
            }
        }
    }
    best.turning = turning(&best, frames);
    best
}

/// A direction and its rate of change in the axes of a body that turns.
#[inline(always)]
fn direction(d: Vector, change: Vector, frame: &BodyFrame) -> (Vector, Vector) {
    (frame.back(d), frame.back(change + d.cross(frame.spin)))
}

/// The unit vector that maximises **n**·**Y** − √(**n**·B₁**n**) − √(**n**·B₂**n**), and the maximum, among those perpendicular to `tie`, if it is given. A `rough` one is
/// enough where what it leaves of the maximum is small beside that; lengths are beside `rough` then.
#[inline(always)]
fn freely(
    between: Vector,
    rounds: &[Round; 2],
    tie: Option<Vector>,
    start: Vector,
    rough: Option<f64>,
) -> Option<(Vector, f64)> {
    let mut n = match untied(start, tie) {
        Some(n) => n,
        None => untied(between, tie)?,
    };
    let mut now = RoundGap::new(n, between, rounds);
    let flat = rounds.iter().any(is_flat);
    for _ in 0..if flat { FLAT_ROUNDS } else { ROUNDS } {
        let first = tie.map_or_else(|| n.across(), |tie| tie / tie.norm());
        let second = n.cross(first);
        // Slope along both, and curvature: radii of curvature, and the gap, as n stays a unit vector.
        let mut slope = [first.dot(between), second.dot(between)];
        let (mut aa, mut ab, mut bb) = (now.width, 0.0, now.width);
        for (round, (pushed, size)) in rounds.iter().zip(now.pushed) {
            if size <= 0.0 {
                continue;
            }
            let part = 1.0 / size;
            let (a, b) = (first.dot(pushed) * part, second.dot(pushed) * part);
            slope = [slope[0] - a, slope[1] - b];
            let bends = round.bends(n, [first, second], (pushed, size));
            aa += bends[0];
            ab += bends[1];
            bb += bends[2];
        }
        let [p, q] = slope;
        let (x, y) = if tie.is_some() {
            (0.0, if bb > 0.0 { q / bb } else { q.signum() })
        } else {
            let determinant = aa * bb - ab * ab;
            if aa > 0.0 && determinant > 0.0 && determinant < f64::INFINITY {
                let part = 1.0 / determinant;
                ((bb * p - ab * q) * part, (aa * q - ab * p) * part)
            } else {
                let size = (p * p + q * q).sqrt().max(f64::MIN_POSITIVE);
                (p / size, q / size)
            }
        };
        let square = x * x + y * y;
        if square < 1e-30 {
            break;
        }
        let size = square.sqrt();
        let mut part = (0.7 / size).min(1.0);
        let step = first * x + second * y;
        // What the step should gain, and what rounding hides of that where curvature knows no bound.
        let gain = p * x + q * y;
        let hidden = 4e-15 * now.pushed[0].1.max(now.pushed[1].1);
        loop {
            let next = untied(step.mul_add(part, n), tie)?;
            let there = RoundGap::new(next, between, rounds);
            let done = if flat {
                part * gain < hidden
            } else {
                part * size < 1e-7
            };
            if done || there.width >= now.width {
                (n, now) = (next, there);
                break;
            }
            part *= 0.5;
        }
        // The error of n is about the square of the step, and that of the maximum of fourth order.
        let enough = |length: f64| length * square * square < 1e-3 * now.width;
        if size < 1e-9 && (gain < hidden || !flat) || rough.is_some_and(enough) {
            break;
        }
    }
    Some((n, now.width))
}

/// The function that [`freely`] maximises, with [`Round::support`] of both parts.
struct RoundGap {
    width: f64,
    pushed: [(Vector, f64); 2],
}

impl RoundGap {
    #[inline(always)]
    fn new(n: Vector, between: Vector, rounds: &[Round; 2]) -> Self {
        let pushed = [rounds[0].support(n), rounds[1].support(n)];
        Self {
            width: n.dot(between) - (pushed[0].1 + pushed[1].1),
            pushed,
        }
    }
}

/// True for what may be nearly flat where it touches, or nearly sharp.
fn is_flat(round: &Round) -> bool {
    matches!(round, Round::Superellipsoid(..))
}

/// The unit vector along the part of a vector that is perpendicular to a tie, if it is given.
#[inline(always)]
fn untied(v: Vector, tie: Option<Vector>) -> Option<Vector> {
    let v = match tie {
        Some(tie) => v - tie * (v.dot(tie) / tie.dot(tie)),
        None => v,
    };
    let size = v.norm();
    if size > 0.0 { Some(v / size) } else { None }
}

/// h(**u** + s**u**′), but of the ball of a part, which does not turn, where |**n** + s**n**′| is `normal`.
#[inline(always)]
fn height(piece: &Piece, (u, change): (Vector, Vector), s: f64, normal: f64) -> f64 {
    let along = change.mul_add(s, u);
    piece.support(along, Vector::default()).0 - piece.ball * (along.norm() - normal)
}

/// Bounds of the velocity of the points of a part without its ball, and of their acceleration along a normal **n** + s**n**′ with |**n**′| = `speed`.
#[inline(always)]
fn swings(piece: &Piece, turn: &FlightRotation, n: Vector, speed: f64) -> [f64; 2] {
    let longer = if speed > 0.0 { 2.0_f64.sqrt() } else { 1.0 };
    let about = match turn {
        FlightRotation::Axis(_, _, about) => about,
        FlightRotation::Any(_, SpinBounds { fastest, whole, .. }) => {
            return [fastest * piece.reach, longer * whole * piece.reach];
        }
    };
    // The acceleration is across Λ.
    let across = n.cross(about.direction).norm();
    let part = if speed > 0.0 {
        (1.0 + across).min(longer)
    } else {
        across
    };
    let velocity = about.rate * piece.swing(about.sine, about.cosine);
    [velocity, part * about.rate * velocity]
}

/// **n**′ such that **n** stays perpendicular to the edges that touch.
#[inline(always)]
fn turning(parting: &Parting<'_>, frames: Frames) -> Vector {
    let n = parting.normal;
    let mut rows = [(Vector::default(), 0.0); 2];
    let mut count = 0;
    for (feature, frame) in parting.features.iter().zip(frames) {
        for &tie in feature.iter().flat_map(|feature| &feature.ties) {
            let edge = frame.rotate(tie / tie.norm());
            rows[count] = (edge, -n.dot(frame.spin.cross(edge)));
            count += 1;
        }
    }
    let [(e, p), (f, q)] = rows;
    match count {
        0 => Vector::default(),
        1 => e * p,
        _ => {
            let along = e.dot(f);
            let determinant = 1.0 - along * along;
            if determinant < 1e-8 {
                return Vector::default();
            }
            e * ((p - along * q) / determinant) + f * ((q - along * p) / determinant)
        }
    }
}

/// The axes of both bodies.
#[inline(always)]
fn frames(poses: &[BodyPose; 2]) -> Frames {
    [poses[0].frame(), poses[1].frame()]
}

/// Both bodies at a time.
#[inline(always)]
pub(crate) fn poses(flight: &mut PairFlight, time: f64) -> [BodyPose; 2] {
    let [one, two] = &mut flight.turns;
    [one.at(time), two.at(time)]
}
