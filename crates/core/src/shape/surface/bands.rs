//! Surfaces of convex bodies of revolution: bands about the third axis.

use super::support::{Length, NormalMotion, Support};
use super::{Convex, ConvexSurface, Piece, RigidSurface};
use crate::math::flat::norm;
use crate::math::{Quaternion, Vector};

/// A point (z, r) of a half-plane through the axis.
pub(crate) type Place = [f64; 2];

/// An arc of a profile, and the surface that it makes as it turns about the axis: a band of a torus, the rim of an edge or face where its radius
/// is 0, a cap where its centre is on the axis. Of a body in units of R from the centre of mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Band {
    /// The centre of the arc; its r is negative where the arc is wider than the body.
    pub centre: Place,
    pub radius: f64,
    /// Unit vectors from the centre to the ends of the arc, that nearer to the pole at +z first.
    pub ends: [Place; 2],
    /// The largest distance of a point of it from the centre of mass.
    pub reach: f64,
}

/// Of what the support of a band is the sum, for a direction **u**: of z u_z, r |u_⊥| and ϱ|**u**|.
type Weights = [f64; 3];

impl Band {
    pub fn new(centre: Place, radius: f64, ends: [Place; 2]) -> Self {
        let mut band = Self {
            centre,
            radius,
            ends,
            reach: 0.0,
        };
        let [z, r] = centre;
        let distance = norm([z, r]);
        // The farthest point of the arc is on the line through the centre of mass and its centre, or an end.
        band.reach = if distance > 0.0 {
            let [a, b, c] = band.weights(z / distance, r / distance);
            (a * z + b * r) / distance + c
        } else {
            radius
        };
        for [a, b] in ends {
            band.reach = band.reach.max(norm([z + radius * a, r + radius * b]));
        }
        band
    }

    /// A corner of the profile.
    pub fn rim(place: Place) -> Self {
        Self::new(place, 0.0, [[1.0, 0.0], [-1.0, 0.0]])
    }

    /// The first or the last point of the arc.
    pub fn end(&self, number: usize) -> Place {
        let [a, b] = self.ends[number];
        [
            self.radius.mul_add(a, self.centre[0]),
            self.radius.mul_add(b, self.centre[1]),
        ]
    }

    /// The same in units of `part` of the present one, in a body whose centre of mass is this far from the present one.
    pub fn scaled(self, part: f64, shift: f64) -> Self {
        Self {
            centre: self.centre.map(|x| x / part),
            radius: self.radius / part,
            ends: self.ends,
            reach: (self.reach + shift) / part,
        }
    }

    /// The weights of the support in a direction (u_z, |u_⊥|): those of the whole torus where the arc has that normal, else those of the
    /// rim at the nearer end.
    #[inline]
    fn weights(&self, along: f64, across: f64) -> Weights {
        let [z, r] = self.centre;
        if self.radius == 0.0 {
            return [z, r, 0.0];
        }
        let beyond = |[a, b]: Place| along * b - across * a;
        let end = match self.ends.map(beyond) {
            [first, _] if first > 0.0 => self.ends[0],
            [_, last] if last < 0.0 => self.ends[1],
            _ => return [z, r, self.radius],
        };
        [z + self.radius * end[0], r + self.radius * end[1], 0.0]
    }

    /// h = max **u**·**x** over its points, for a unit vector **u**.
    pub fn support(&self, u: Vector) -> f64 {
        let across = u.horizontal();
        let [a, b, c] = self.weights(u.z, across);
        a * u.z + b * across + c
    }

    /// The point that lies farthest in the direction of a unit vector **u**; along the axis, where all of a rim does, the one towards
    /// `tie`, or the centre of the rim.
    pub fn farthest(&self, u: Vector, tie: Vector) -> Vector {
        let across = u.horizontal();
        let [a, b, c] = self.weights(u.z, across);
        let (side, size) = if across > 0.0 {
            (u, across)
        } else {
            (tie, tie.horizontal().max(f64::MIN_POSITIVE))
        };
        let out = b / size;
        Vector::new(out * side.x, out * side.y, a) + u * c
    }
}

/// Bands about the third axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bands(pub Vec<Band>);

impl ConvexSurface for Bands {
    type Along<'a> = BandSupport<'a>;

    const OF: fn(Convex<Self>) -> RigidSurface = RigidSurface::Bands;

    #[inline(always)]
    fn parts(&self) -> usize {
        self.0.len()
    }

    #[inline(always)]
    fn reach(&self, part: usize) -> f64 {
        self.0[part].reach
    }

    fn inner(&self) -> f64 {
        0.0
    }

    fn support(&self, up: Vector) -> f64 {
        let each = self.0.iter().map(|band| band.support(up * -1.0));
        each.fold(f64::NEG_INFINITY, f64::max)
    }

    #[inline(always)]
    fn nearest(&self, part: usize, up: Vector, turning: Vector) -> Vector {
        self.0[part].farthest(up * -1.0, turning * -1.0)
    }

    #[inline(always)]
    fn along<'a>(&'a self, part: usize, at: &'a NormalMotion) -> BandSupport<'a> {
        let band = &self.0[part];
        let normal = [at.up, at.turning, at.bending];
        let along = normal.map(|v| -v.z);
        let across = Length::new(normal.map(|v| Vector::new(v.x, v.y, 0.0)));
        let weights = band.weights(along[0], across.size);
        let [z, r, radius] = weights;
        BandSupport {
            band,
            size: z * along[0] + r * across.size + radius,
            slope: z * along[1] + r * across.slope,
            along,
            across,
            whole: Length::new(normal),
            weights,
        }
    }

    fn scaled(&self, part: f64, shift: f64) -> Self {
        Self(self.0.iter().map(|band| band.scaled(part, shift)).collect())
    }

    /// Of a cylinder.
    fn piece(&self, axes: Quaternion, centre: Vector, unit: f64) -> Option<Piece> {
        let [one, two] = self.0[..] else {
            return None;
        };
        let cylinder = one.radius == 0.0 && two.radius == 0.0 && one.centre[1] == two.centre[1];
        let end = |z: f64| (centre + axes.rotate(Vector::new(0.0, 0.0, z))) * unit;
        let ends = [two, one].map(|band| end(band.centre[0]));
        cylinder.then(|| Piece::rod(ends, one.centre[1] * unit, true))
    }
}

/// The support of a band in the direction −**n**.
pub(crate) struct BandSupport<'a> {
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
