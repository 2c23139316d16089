//! Supports of convex hulls whose normal turns along its tangent, **n** + s**n**′, and the first root of the bound that they make.

use super::certify::{SHORTEST, TOUCHING};
use super::plane::{BackwardBound, Departure, GapExpansion, Step, first_root};
use crate::math::Vector;
use crate::motion::SpinBounds;
#[cfg(test)]
use crate::shape::evaluations::{self, Evaluation};
use crate::shape::{Band, Convex, ConvexSurface, NormalMotion, Superellipsoid};

/// A convex function h of s, the support of a part along the tangent of its normal.
pub(super) trait Support {
    /// h and h′ at s = 0.
    fn tangent(&self) -> (f64, f64);

    /// h(s) − h(0) − s h′(0) ≥ 0, without cancellation where it can be, also for s < 0.
    fn beyond_tangent(&self, s: f64) -> f64;

    /// h″ at s = 0 where the normal has its second derivative, too.
    fn second(&self) -> f64;

    /// True if a whole rim is lowest: it has no single point whose speed is that of the part.
    #[inline(always)]
    fn is_flat(&self) -> bool {
        false
    }

    /// Gap and rate.
    #[inline(always)]
    fn opening(&self, at: &NormalMotion) -> (f64, f64) {
        let (size, slope) = self.tangent();
        (at.height - size, at.rate - slope)
    }

    /// The step of a part of this number and bounds, as [`crate::shape::RigidSurface`]'s.
    #[inline(always)]
    fn step(
        &self,
        (part, bounds): (usize, CurvatureBounds),
        at: &NormalMotion,
        departure: Option<Departure>,
        most: f64,
    ) -> Step {
        let now = self.opening(at);
        let (width, rate) = match departure {
            Some(left) if left.part == part && self.is_flat() => (0.0, now.1),
            Some(left) if left.part == part => (0.0, left.speed),
            _ => now,
        };
        let length = convex_root(self, (width.max(0.0), rate, bounds), most);
        Step {
            length,
            part,
            width,
            rate,
            closes: rate < 0.0 && length < most,
            bound: bounds.up_to(length),
            only_until: f64::INFINITY,
        }
    }

    /// As [`crate::shape::RigidSurface`]'s.
    #[inline(always)]
    fn past(&self, bound: f64, at: &NormalMotion, since: f64) -> BackwardBound {
        #[cfg(test)]
        evaluations::add(Evaluation::Support);
        let (width, rate) = self.opening(at);
        let before = width - since * (rate + 0.5 * bound * since) - self.beyond_tangent(-since);
        let gap = GapExpansion {
            width,
            rate,
            acceleration: at.acceleration - self.second(),
        };
        BackwardBound::new(gap, before, since)
    }
}

/// h = |**a** + s**b**|, where **a** also has the second derivative **c**.
pub(super) struct Length {
    a: Vector,
    b: Vector,
    /// h and h′ at s = 0, where h = 0 behind it.
    size: f64,
    slope: f64,
    /// |**b**|² − h′².
    spread: f64,
    /// **a**·**c**.
    bent: f64,
}

impl Length {
    #[inline(always)]
    pub fn new([a, b, c]: [Vector; 3]) -> Self {
        let (size, across) = (a.norm(), a.cross(b));
        let (slope, spread) = if size > 0.0 {
            let part = 1.0 / size;
            (a.dot(b) * part, across.dot(across) * (part * part))
        } else {
            (b.norm(), 0.0)
        };
        Self {
            a,
            b,
            size,
            slope,
            spread,
            bent: a.dot(c),
        }
    }

    /// |A**n**| of an ellipsoid with these semi-axes.
    #[inline(always)]
    pub fn of_ellipsoid([a, b, c]: [f64; 3], at: &NormalMotion) -> Self {
        let stretched = |v: Vector| Vector::new(a * v.x, b * v.y, c * v.z);
        Self::new([at.up, at.turning, at.bending].map(stretched))
    }

    /// h(s), and what of it is beyond the tangent.
    #[inline(always)]
    fn along(&self, s: f64) -> (f64, f64) {
        let size = self.b.mul_add(s, self.a).norm();
        let tangent = s.mul_add(self.slope, self.size);
        let beyond = if tangent < 0.0 {
            size - tangent
        } else if self.spread > 0.0 {
            s * s * self.spread / (size + tangent)
        } else {
            0.0
        };
        (size, beyond)
    }
}

impl Support for Length {
    #[inline(always)]
    fn tangent(&self) -> (f64, f64) {
        (self.size, self.slope)
    }

    #[inline(always)]
    fn second(&self) -> f64 {
        (self.spread + self.bent) / self.size
    }

    #[inline(always)]
    fn beyond_tangent(&self, s: f64) -> f64 {
        self.along(s).1
    }
}

/// The support of a band in the direction −**n**.
pub(super) struct BandSupport<'a> {
    band: &'a Band,
    /// Its parts along the axis, −n_z with its derivatives, and across it.
    along: [f64; 3],
    across: Length,
    /// |**n**|.
    whole: Length,
    weights: [f64; 3],
    size: f64,
    slope: f64,
}

impl<'a> BandSupport<'a> {
    #[inline(always)]
    pub fn new(band: &'a Band, at: &NormalMotion) -> Self {
        let normal = [at.up, at.turning, at.bending];
        let along = normal.map(|v| -v.z);
        let across = Length::new(normal.map(|v| Vector::new(v.x, v.y, 0.0)));
        let weights = band.weights(along[0], across.size);
        let [z, r, radius] = weights;
        Self {
            band,
            size: z * along[0] + r * across.size + radius,
            slope: z * along[1] + r * across.slope,
            along,
            across,
            whole: Length::new(normal),
            weights,
        }
    }
}

impl Support for BandSupport<'_> {
    #[inline(always)]
    fn tangent(&self) -> (f64, f64) {
        (self.size, self.slope)
    }

    #[inline(always)]
    fn is_flat(&self) -> bool {
        self.across.size == 0.0 && self.weights[1] != 0.0
    }

    #[inline(always)]
    fn second(&self) -> f64 {
        if self.is_flat() {
            return f64::INFINITY;
        }
        let [z, r, radius] = self.weights;
        let across = if r == 0.0 {
            0.0
        } else {
            r * self.across.second()
        };
        z * self.along[2] + across + radius * self.whole.second()
    }

    #[inline(always)]
    fn beyond_tangent(&self, s: f64) -> f64 {
        let along = s.mul_add(self.along[1], self.along[0]);
        let (across, across_beyond) = self.across.along(s);
        let (whole, whole_beyond) = self.whole.along(s);
        let weights = self.band.weights(along, across);
        let [z, r, radius] = weights;
        if weights == self.weights {
            r * across_beyond + radius * whole_beyond
        } else {
            z * along + r * across + radius * whole - s.mul_add(self.slope, self.size)
        }
    }
}

/// The support of a superellipsoid.
pub(super) struct SuperellipsoidSupport<'a> {
    body: &'a Superellipsoid,
    at: &'a NormalMotion,
    size: f64,
    slope: f64,
}

impl<'a> SuperellipsoidSupport<'a> {
    #[inline(always)]
    pub fn new(body: &'a Superellipsoid, at: &'a NormalMotion) -> Self {
        let (size, place) = body.farthest(at.up);
        Self {
            body,
            at,
            size,
            slope: place.dot(at.turning),
        }
    }
}

impl Support for SuperellipsoidSupport<'_> {
    #[inline(always)]
    fn tangent(&self) -> (f64, f64) {
        (self.size, self.slope)
    }

    #[inline(always)]
    fn second(&self) -> f64 {
        self.body.bent(self.at.up, self.at.turning, self.at.bending)
    }

    #[inline(always)]
    fn beyond_tangent(&self, s: f64) -> f64 {
        let moved = self.at.turning.mul_add(s, self.at.up);
        self.body.support(moved) - s.mul_add(self.slope, self.size)
    }
}

/// Bounds M on −f″.
#[derive(Clone, Copy)]
pub(super) struct CurvatureBounds {
    /// For so long the first of them holds.
    near: f64,
    first: f64,
    whole: f64,
}

impl CurvatureBounds {
    /// Of points up to `reach` from the centre of mass, with a ball of radius `inner` about it inside of the body.
    #[inline(always)]
    fn new(gravity: f64, turn: &SpinBounds, reach: f64, inner: f64) -> Self {
        Self {
            near: inner * turn.radian,
            first: gravity + turn.across * reach,
            whole: gravity + turn.whole * reach,
        }
    }

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

impl Convex {
    /// As [`crate::shape::RigidSurface`]'s.
    #[inline(always)]
    pub(super) fn step(
        &self,
        at: &NormalMotion,
        turn: &SpinBounds,
        departure: Option<Departure>,
        most: f64,
    ) -> Step {
        #[cfg(test)]
        evaluations::add(Evaluation::Support);
        let mut moved = NormalMotion::default();
        let own = self.own(at, &mut moved);
        let bounds = |reach: f64| CurvatureBounds::new(-at.acceleration, turn, reach, self.inner);
        self.surface.step(own, bounds, departure, most)
    }

    /// As [`crate::shape::RigidSurface`]'s.
    #[inline(always)]
    pub(super) fn past(
        &self,
        part: usize,
        at: &NormalMotion,
        turn: &SpinBounds,
        since: f64,
    ) -> BackwardBound {
        let mut moved = NormalMotion::default();
        let bound = |reach: f64| {
            CurvatureBounds::new(-at.acceleration, turn, reach, self.inner).up_to(since)
        };
        self.surface
            .past(part, self.own(at, &mut moved), bound, since)
    }

    #[inline(always)]
    pub(super) fn nearest(&self, part: usize, up: Vector, turning: Vector) -> Vector {
        let [own, tie] = match self.frame {
            Some(frame) => [up, turning].map(|v| frame.axes.rotate(v)),
            None => [up, turning],
        };
        let place = self.surface.nearest(part, own, tie);
        self.frame.map_or(place, |frame| frame.place(place))
    }

    #[inline(always)]
    pub(super) fn acceleration(&self, part: usize, at: &NormalMotion) -> f64 {
        let mut moved = NormalMotion::default();
        let own = self.own(at, &mut moved);
        own.acceleration - self.surface.second(part, own)
    }

    pub(super) fn another_touches(&self, departure: Departure, at: &NormalMotion) -> bool {
        let ConvexSurface::Bands(bands) = &self.surface else {
            return false;
        };
        let mut moved = NormalMotion::default();
        let own = self.own(at, &mut moved);
        let opening = |band: &Band| BandSupport::new(band, own).opening(own);
        let still = opening(&bands[departure.part]).1;
        bands.iter().enumerate().any(|(part, band)| {
            let (width, rate) = opening(band);
            part != departure.part && width <= TOUCHING && rate < still
        })
    }
}

impl ConvexSurface {
    #[inline(always)]
    fn step(
        &self,
        at: &NormalMotion,
        bounds: impl Fn(f64) -> CurvatureBounds,
        departure: Option<Departure>,
        most: f64,
    ) -> Step {
        match self {
            Self::Ellipsoid(axes) => {
                Length::of_ellipsoid(*axes, at).step((0, bounds(1.0)), at, departure, most)
            }
            Self::Superellipsoid(body) => {
                SuperellipsoidSupport::new(body, at).step((0, bounds(1.0)), at, departure, most)
            }
            Self::Bands(bands) => {
                let each = |(part, band): (usize, &Band)| {
                    let bounds = bounds(band.reach);
                    BandSupport::new(band, at).step((part, bounds), at, departure, most)
                };
                bands
                    .iter()
                    .enumerate()
                    .map(each)
                    .fold(Step::NEVER, Step::or)
            }
        }
    }

    #[inline(always)]
    fn past(
        &self,
        part: usize,
        at: &NormalMotion,
        bound: impl Fn(f64) -> f64,
        since: f64,
    ) -> BackwardBound {
        match self {
            Self::Ellipsoid(axes) => Length::of_ellipsoid(*axes, at).past(bound(1.0), at, since),
            Self::Superellipsoid(body) => {
                SuperellipsoidSupport::new(body, at).past(bound(1.0), at, since)
            }
            Self::Bands(bands) => {
                let band = &bands[part];
                BandSupport::new(band, at).past(bound(band.reach), at, since)
            }
        }
    }

    #[inline(always)]
    fn nearest(&self, part: usize, up: Vector, turning: Vector) -> Vector {
        match self {
            Self::Ellipsoid([a, b, c]) => {
                let stretched = Vector::new(a * up.x, b * up.y, c * up.z);
                let size = -1.0 / stretched.norm();
                Vector::new(a * stretched.x, b * stretched.y, c * stretched.z) * size
            }
            Self::Superellipsoid(body) => body.farthest(up * -1.0).1,
            Self::Bands(bands) => bands[part].farthest(up * -1.0, turning * -1.0),
        }
    }

    /// h″ of a part.
    #[inline(always)]
    fn second(&self, part: usize, at: &NormalMotion) -> f64 {
        match self {
            Self::Ellipsoid(axes) => Length::of_ellipsoid(*axes, at).second(),
            Self::Superellipsoid(body) => SuperellipsoidSupport::new(body, at).second(),
            Self::Bands(bands) => BandSupport::new(&bands[part], at).second(),
        }
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
fn convex_root<S: Support + ?Sized>(
    support: &S,
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
    let parabola = |s: f64| width + s * (rate - 0.5 * bound * s);
    #[cfg(test)]
    evaluations::add(Evaluation::Support);
    let beyond = support.beyond_tangent(after);
    let found = parabola(after) - beyond;
    if beyond <= 0.0 || found >= 0.0 {
        return after;
    }
    // Where the gap is 0 at the beginning and opens, a point between it and the root.
    let mut before = (0.0, width);
    let mut inside = 0.5 * after;
    while before.1 <= 0.0 && rate > 0.0 {
        #[cfg(test)]
        evaluations::add(Evaluation::Support);
        let found = parabola(inside) - support.beyond_tangent(inside);
        if found > 0.0 {
            before = (inside, found);
        }
        inside *= 0.5;
        if bound * inside <= SHORTEST {
            return SHORTEST / bound;
        }
    }
    let chord = before.0 + (after - before.0) * before.1 / (before.1 - found);
    if rate < 0.0 {
        chord
    } else {
        chord.max(SHORTEST / bound)
    }
}
