//! The gaps of two bodies of revolution, one pair in each lane of a vector: balls on their axes, or one spheroid each, as [`super::pair`] has them for numbers.
//!
//! The axis **e** of each turns about **Λ**. A spheroid about x**e** has B = β²I + γ**ee**, so that of a normal only c = **n**·**e** is seen: with
//! h = √(β² + γc²), its support is xc + h, and where it touches, it is as a ball about (x ± γc/h)**e** would be. With **P** = **Λ**/J and **n** constant, what parts
//! the bodies is at least
//!
//! F(s) = f + s **n**·**Y**′ − Σ [√(β²(1 + q²s²) + γ(c + c′s)²) − h − ϱ(√(1 + q²s²) − 1)] − Ks², q = |**n** × **P**|, c′ = **n**·**e**′,
//!
//! where **Y** joins the centres of the parts and K is half the sum of q|**P**|D, D the largest distance of a point without the ball ϱ from **Λ**.

use super::certify::{INVISIBLE, zero as zero_of};
use super::pair::{NARROW, ROUNDS};
use crate::math::{UNITS, Vectors};
use crate::shape::{Piece, PieceKind, Round};
use crate::simd::{Lanewise, Mask, Pack};
use pulp::Simd;

/// The gap of two balls in each lane.
#[derive(Clone, Copy)]
pub(crate) struct BallGaps<S: Simd> {
    pub width: Pack<S>,
    pub rate: Pack<S>,
    /// w² over the distance of the centres, by which f bends at least.
    pub bent: Pack<S>,
    /// M.
    pub bound: Pack<S>,
    distance: Pack<S>,
    spread: Pack<S>,
}

/// A ball or a spheroid on the axis of a body, with x, β² and γ.
pub(crate) struct RoundPart {
    place: f64,
    square: f64,
    excess: f64,
    /// ϱ.
    ball: f64,
    /// [`Piece::extents`].
    extents: [f64; 3],
}

/// The axis of a body in each lane, and how it turns.
#[derive(Clone, Copy)]
pub(crate) struct TurningAxis<S: Simd> {
    /// **e** and **e**′.
    pub axis: Vectors<S>,
    pub change: Vectors<S>,
    /// **P**, and its length.
    pub turn: Vectors<S>,
    pub rate: Pack<S>,
    /// D.
    pub swing: Pack<S>,
}

/// Two bodies of one [`RoundPart`] each, and their reach.
pub(crate) struct RoundParts<'a> {
    pub parts: [&'a RoundPart; 2],
    pub reach: f64,
}

/// The result of a look at two of them: a certified step, the rate of the gap, a bound on |f″|.
pub(crate) struct RoundStep<S: Simd> {
    pub clear: Pack<S>,
    pub rate: Pack<S>,
    pub bound: Pack<S>,
}

/// Where two of them touch a plane that parts them: the places on the axes about which both are balls, and the radius of the first.
pub(crate) struct RoundContact<S: Simd> {
    pub places: [Pack<S>; 2],
    pub radius: Pack<S>,
}

/// c, h, 1/h and γc/h of both, and the gap along a normal.
struct RoundWidth<S: Simd> {
    heights: [Pack<S>; 2],
    sizes: [Pack<S>; 2],
    inverse: [Pack<S>; 2],
    shifts: [Pack<S>; 2],
    width: Pack<S>,
}

impl<S: Simd> BallGaps<S> {
    /// The gaps of balls whose centres differ by **y**, which changes at a rate and has a bounded acceleration, and the sum of their radii.
    #[inline(always)]
    pub fn new(y: Vectors<S>, change: Vectors<S>, radii: f64, bound: Pack<S>) -> Self {
        let distance = y.dot(y).sqrt();
        let part = 1.0 / distance;
        let rate = y.dot(change) * part;
        let spread = (change.dot(change) - rate * rate).max(0.0);
        Self {
            width: distance - radii,
            rate,
            bent: spread * part,
            bound,
            distance,
            spread,
        }
    }

    /// The step of [`BallGap`](super::pair::BallGap), where `shortest` is a time in which no gap changes visibly if its rate is 0.
    #[inline(always)]
    pub fn step(&self, shortest: Pack<S>) -> Pack<S> {
        let zero = self.width * 0.0;
        let (width, speed) = (self.width.max(0.0), self.rate.max(-self.rate));
        let closes = self.rate.lt(0.0);
        let (square, twice) = (speed * speed, width + width);
        let whole = speed + twice.mul_add(self.bound, square).sqrt();
        let root = zero_of(width, self.rate, whole, whole, self.bound);
        let until = (self.distance + self.distance) * speed / (square + self.spread);
        let beyond = twice.mul_add(self.bound - self.bent, square);
        let bent = twice / (speed + beyond.max(0.0).sqrt());
        // Where the parabola has no root, nothing touches while it holds.
        let within = bent.le(until) & zero.le(beyond);
        let closing = within.select(bent, root.max(until));
        closes.select(closing, root.max(shortest))
    }
}

/// F.
struct RoundBound<'a, S: Simd> {
    parts: [&'a RoundPart; 2],
    /// f and **n**·**Y**′.
    width: Pack<S>,
    across: Pack<S>,
    /// c, c′ and h.
    heights: [Pack<S>; 2],
    changes: [Pack<S>; 2],
    sizes: [Pack<S>; 2],
    /// q², and K.
    squares: [Pack<S>; 2],
    curved: Pack<S>,
}

impl RoundPart {
    /// A part of a body of revolution about the principal axis of this number, if it is one.
    pub fn new(piece: &Piece, axis: usize) -> Option<Self> {
        let [corner] = piece.corners[..] else {
            return None;
        };
        let Round::Ellipsoid(round) = piece.round else {
            return None;
        };
        let entries = [round.xx, round.yy, round.zz];
        let [along, across] = [entries[axis], entries[(axis + 1) % 3]];
        (piece.kind != PieceKind::Plane && across > 0.0).then(|| Self {
            place: corner.parts()[axis],
            square: across,
            excess: along - across,
            ball: piece.ball,
            extents: piece.extents,
        })
    }

    /// D, where **Λ** and the axis make an angle of this sine and cosine.
    #[inline(always)]
    pub fn swing<S: Simd>(&self, sine: Pack<S>, cosine: Pack<S>) -> Pack<S> {
        let [height, along, across] = self.extents;
        let [x, y] = [sine * along, cosine * across];
        let rest = x.mul_add(x, y * y).sqrt().max(across);
        sine.mul_add(height, rest)
    }

    /// √(β² s + γ c²), for the square s of a vector and its scalar product c with the axis.
    #[inline(always)]
    fn size<S: Simd>(&self, square: Pack<S>, along: Pack<S>) -> Pack<S> {
        square
            .mul_add(self.square, along * along * self.excess)
            .sqrt()
    }
}

impl RoundParts<'_> {
    /// From the centre of the second part to that of the first, if those of the bodies are `apart`; or the rate of that, with those of the axes.
    #[inline(always)]
    pub fn between<S: Simd>(&self, apart: Vectors<S>, axes: [Vectors<S>; 2]) -> Vectors<S> {
        let [first, second] = self.parts;
        axes[1].mul_add(-second.place, axes[0].mul_add(first.place, apart))
    }

    #[inline(always)]
    fn along<S: Simd>(
        &self,
        n: Vectors<S>,
        between: Vectors<S>,
        axes: [Vectors<S>; 2],
    ) -> RoundWidth<S> {
        let one = Pack::splat(n.x.simd(), 1.0);
        let heights = [n.dot(axes[0]), n.dot(axes[1])];
        let [first, second] = self.parts;
        let sizes = [first.size(one, heights[0]), second.size(one, heights[1])];
        let inverse = [1.0 / sizes[0], 1.0 / sizes[1]];
        let shifts = [
            heights[0] * first.excess * inverse[0],
            heights[1] * second.excess * inverse[1],
        ];
        RoundWidth {
            heights,
            sizes,
            inverse,
            shifts,
            width: n.dot(between) - (sizes[0] + sizes[1]),
        }
    }

    /// The normal along which the gap is widest, by Newton's method from another one, in some lanes; a `rough` one is enough where what it leaves is small
    /// beside the gap.
    #[inline(always)]
    pub fn normal<S: Simd>(
        &self,
        start: Vectors<S>,
        between: Vectors<S>,
        axes: [Vectors<S>; 2],
        lanes: Mask<S>,
        rough: bool,
    ) -> Vectors<S> {
        let simd = start.x.simd();
        let (zero, one) = (Pack::splat(simd, 0.0), Pack::splat(simd, 1.0));
        let units = [
            Vectors::splat(simd, UNITS[0]),
            Vectors::splat(simd, UNITS[1]),
        ];
        let (mut n, mut share, mut waits) = (start, one, lanes);
        let mut now = self.along(n, between, axes);
        for _ in 0..2 * ROUNDS {
            let across = n.cross(units[1].or((n.x * n.x).lt(0.5), units[0]));
            let u = across * (1.0 / across.dot(across).sqrt());
            let v = n.cross(u);
            // Slope along both, and curvature: radii of curvature, and the gap, as n stays a unit vector.
            let mut slope = [u.dot(between), v.dot(between)];
            let [mut aa, mut ab, mut bb] = [now.width, zero, now.width];
            for (i, axis) in axes.into_iter().enumerate() {
                let (part, inverse, shift) = (self.parts[i], now.inverse[i], now.shifts[i]);
                let [a, b] = [u.dot(axis), v.dot(axis)];
                slope = [slope[0] - shift * a, slope[1] - shift * b];
                let radius = inverse * part.square;
                let bend = inverse * inverse * part.excess;
                let [bent, other] = [bend * a, bend * b];
                aa = radius.mul_add(bent.mul_add(a, one), aa);
                ab = (radius * bent).mul_add(b, ab);
                bb = radius.mul_add(other.mul_add(b, one), bb);
            }
            let [p, q] = slope;
            let determinant = aa * bb - ab * ab;
            let curved = zero.lt(aa) & zero.lt(determinant);
            let steepest = 1.0 / (p * p + q * q).sqrt().max(f64::MIN_POSITIVE);
            let inverse = 1.0 / determinant;
            let x = curved.select((bb * p - ab * q) * inverse, p * steepest);
            let y = curved.select((aa * q - ab * p) * inverse, q * steepest);
            let square = x * x + y * y;
            waits = waits & !square.lt(1e-30);
            let size = square.sqrt();
            let part = (0.7 / size).min(1.0) * share;
            let moved = v.mul_add(y * part, u.mul_add(x * part, n));
            let next = moved * (1.0 / moved.dot(moved).sqrt());
            let there = self.along(next, between, axes);
            let wider = waits & (now.width.le(there.width) | (part * size).lt(1e-7));
            n = n.or(wider, next);
            now.choose(wider, &there);
            share = wider.select(1.0, share * 0.5);
            let mut enough = size.lt(1e-9);
            if rough {
                // The error of n is about the square of the step, and that of the gap of fourth order.
                enough = enough | (square * square * self.reach).lt(now.width * 1e-3);
            }
            waits = waits & !(wider & enough);
            if !waits.any() {
                break;
            }
        }
        n
    }

    /// A certified step of bodies whose centres are `apart`, parted by a plane with this normal; the gap of those that `leave` each other is 0, and opens at a
    /// speed.
    #[inline(always)]
    pub fn step<S: Simd>(
        &self,
        n: Vectors<S>,
        [apart, velocity]: [Vectors<S>; 2],
        bodies: &[TurningAxis<S>; 2],
        (leave, speed): (Mask<S>, Pack<S>),
    ) -> RoundStep<S> {
        let simd = n.x.simd();
        let zero = Pack::splat(simd, 0.0);
        let axes = [bodies[0].axis, bodies[1].axis];
        let changes = [bodies[0].change, bodies[1].change];
        let now = self.along(n, self.between(apart, axes), axes);
        let across = n.dot(self.between(velocity, changes));
        let heights = [n.dot(changes[0]), n.dot(changes[1])];
        let rate = across - now.shifts[0] * heights[0] - now.shifts[1] * heights[1];
        let (mut squares, mut curved, mut most) = ([zero; 2], zero, velocity.dot(velocity).sqrt());
        for i in 0..2 {
            let body = &bodies[i];
            let tilt = n.cross(body.turn);
            squares[i] = tilt.dot(tilt);
            let fastest = body.rate * body.swing;
            curved = (squares[i].sqrt() * 0.5).mul_add(fastest, curved);
            most = most + fastest;
        }
        let width = leave.select(zero, now.width.max(0.0));
        let lift = leave.select(speed - rate, zero);
        let (rate, across) = (rate + lift, across + lift);
        let twice = curved + curved;
        let bound = RoundBound {
            parts: self.parts,
            width,
            across,
            heights: now.heights,
            changes: heights,
            sizes: now.sizes,
            squares,
            curved,
        };
        // The root of the parabola that touches F.
        let closes = rate.lt(0.0);
        let away = rate.max(-rate);
        let whole = away + (width + width).mul_add(twice, away * away).sqrt();
        let root = zero_of(width, rate, whole, whole, twice);
        let shortest = (INVISIBLE * self.reach / twice).sqrt();
        let mut after = closes.select(root, root.max(shortest));
        let open = zero.lt(width);
        let long = shortest.lt(after) & after.lt(f64::INFINITY);
        let value = bound.at(after);
        let mut beyond = long & value.lt(-1e-16 * self.reach);
        // A chord of F ends in front of its root, because F is concave.
        after = (beyond & open).select(after * width / (width - value), after);
        beyond = beyond & !open;
        while beyond.any() {
            // From a gap of 0 that opens, to a place where it is open.
            after = beyond.select(after * 0.5, after);
            beyond = beyond & shortest.lt(after) & bound.at(after).lt(0.0);
        }
        // The gap is above F by at most V²s²/2d, d the distance of what touches.
        let bends = Pack::splat(simd, NARROW * self.reach).lt(width);
        let bends = bends.select(most * most / width, zero);
        RoundStep {
            clear: closes.select(after, after.max(shortest)),
            rate,
            bound: twice + bends,
        }
    }

    /// Where they touch a plane with this normal.
    #[inline(always)]
    pub fn contact<S: Simd>(
        &self,
        n: Vectors<S>,
        between: Vectors<S>,
        axes: [Vectors<S>; 2],
    ) -> RoundContact<S> {
        let now = self.along(n, between, axes);
        let [first, second] = self.parts;
        RoundContact {
            places: [-now.shifts[0] + first.place, now.shifts[1] + second.place],
            radius: now.inverse[0] * first.square,
        }
    }
}

impl<S: Simd> RoundWidth<S> {
    #[inline(always)]
    fn choose(&mut self, lanes: Mask<S>, other: &Self) {
        for i in 0..2 {
            self.heights[i] = lanes.select(other.heights[i], self.heights[i]);
            self.sizes[i] = lanes.select(other.sizes[i], self.sizes[i]);
            self.inverse[i] = lanes.select(other.inverse[i], self.inverse[i]);
            self.shifts[i] = lanes.select(other.shifts[i], self.shifts[i]);
        }
        self.width = lanes.select(other.width, self.width);
    }
}

impl<S: Simd> RoundBound<'_, S> {
    #[inline(always)]
    fn at(&self, s: Pack<S>) -> Pack<S> {
        let later = s * s;
        let one = Pack::splat(s.simd(), 1.0);
        let mut rest = self.across.mul_add(s, self.width) - self.curved * later;
        for i in 0..2 {
            let part = self.parts[i];
            let square = self.squares[i].mul_add(later, one);
            let size = part.size(square, self.changes[i].mul_add(s, self.heights[i]));
            rest = rest - (size - self.sizes[i]) + (square.sqrt() - 1.0) * part.ball;
        }
        rest
    }
}
