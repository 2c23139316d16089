//! The part of a body that can touch the plane, and its gap to the plane as a function of the axis.
//!
//! A convex body whose axis has the vertical component e_z touches the plane when the height of its centre of mass is h(e_z), its
//! support function. The gap is f = z − h. For a body of revolution the vector from the centre of mass to the point of contact is
//! **r**_c = s**e** − ϱ**n** (6) with s = −h′ and ϱ = h − h′e_z, where h′ = dh/de_z: it touches like a sphere of radius ϱ whose
//! centre is on the axis at s. For a sphere on the axis both are constant, and the gap is linear in e_z.
//!
//! Heights are relative to a level, [`Hull::level`], so that the rounding error at a contact is small.

mod balls;
mod ellipsoid;

pub use balls::{Balls, EqualBalls, OneBall, TwoBalls};
pub use ellipsoid::Ellipsoid;

use crate::simd::{Mask, Pack, lanewise, one};
use pulp::{Scalar, Simd};

/// The end of the body that touches: one of two spheres, or one half of a smooth hull.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sphere {
    /// The end to which the axis points.
    One,
    /// The opposite end.
    Two,
}

impl Sphere {
    /// Both ends, in order.
    pub const BOTH: [Self; 2] = [Self::One, Self::Two];

    /// The opposite end.
    pub fn other(self) -> Self {
        match self {
            Self::One => Self::Two,
            Self::Two => Self::One,
        }
    }

    /// +1 or −1: the side of a dumbbell's centre of mass on which the sphere sits.
    pub fn sign(self) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Two => -1.0,
        }
    }

    pub(crate) fn of(sign: f64) -> Self {
        if sign < 0.0 { Self::Two } else { Self::One }
    }
}

/// A sphere whose centre is on the axis, in the core's unit of length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Position of its centre on the axis: signed distance s from the centre of mass.
    pub offset: f64,
    /// Radius ϱ.
    pub radius: f64,
}

/// The part of a hull whose gap is evaluated, in each lane.
#[derive(Clone, Copy)]
pub(crate) struct HullPart<S: Simd> {
    /// True if it is sphere 1; ignored where only one part can touch.
    pub one: Mask<S>,
    /// The parameter of its gap besides e_z: the lever s of a sphere. For a smooth hull it is 1/h where [`Hull::nearer`] was asked for
    /// the part, which the derivatives there need again.
    pub own: Pack<S>,
}

lanewise! { HullPart<S> { one, own } }

/// The vertical component of the axis, e_z, and its time derivatives. Since e_z = c + A cos(Ωt + φ), each derivative from the third
/// on is −Ω² times the one two orders below.
#[derive(Clone, Copy)]
pub(crate) struct AxisMotion<S: Simd> {
    /// e_z.
    pub cos_tilt: Pack<S>,
    /// de_z/dt.
    pub rate: Pack<S>,
    /// d²e_z/dt².
    pub acceleration: Pack<S>,
    /// Ω².
    pub square: Pack<S>,
}

/// The surface that can touch the plane. The contact search, the landing and the impact use no other property of it.
pub(crate) trait Hull: Copy {
    /// True if it has two parts, either of which may touch first.
    const TWO: bool;

    /// Height of the centre of mass above the plane from which heights are counted in flight, and 0 there.
    fn level(&self) -> f64;

    /// Factor ≥ 1 by which the support function h may vary faster than e_z: while the axis turns by an angle much smaller than its
    /// inverse, the Taylor expansion of h converges quickly.
    fn sharpness(&self) -> f64;

    /// Height above which no part can touch while |e_z| ≤ `max_cos_tilt`.
    fn ceiling<S: Simd>(&self, max_cos_tilt: Pack<S>) -> Pack<S>;

    /// A bound on |d²h/dt²|/Ω² for e_z = c + A cos(Ωt + φ): the contribution of rotation to the second derivative of a gap.
    /// `amplitude` is A, `max_cos_tilt` is |c| + A.
    fn curvature_bound<S: Simd>(&self, amplitude: Pack<S>, max_cos_tilt: Pack<S>) -> Pack<S>;

    /// Sphere 1 where `one`, else sphere 2; the whole hull if it has only one part.
    fn part<S: Simd>(&self, one: Mask<S>) -> HullPart<S>;

    /// The part whose gap has the lower bound that reaches 0 first. `bound` is M: f″ ≥ −M for the gap f of either part.
    fn nearer<S: Simd>(
        &self,
        height: Pack<S>,
        vz: Pack<S>,
        axis_motion: &AxisMotion<S>,
        bound: Pack<S>,
    ) -> HullPart<S>;

    /// The gap f between a part and the plane, (2), negative where they overlap.
    fn gap<S: Simd>(&self, part: &HullPart<S>, cos_tilt: Pack<S>, height: Pack<S>) -> Pack<S>;

    /// Height at which a part touches.
    fn touching_height<S: Simd>(&self, part: &HullPart<S>, cos_tilt: Pack<S>) -> Pack<S>;

    /// The lever s = −dh/de_z.
    fn lever<S: Simd>(&self, part: &HullPart<S>, cos_tilt: Pack<S>) -> Pack<S>;

    /// The radius ϱ = h − e_z dh/de_z of the sphere that touches like this part.
    fn radius<S: Simd>(&self, part: &HullPart<S>, cos_tilt: Pack<S>) -> Pack<S>;

    /// d²f/dt² = −1 − d²h/dt² of the gap f in free fall.
    fn curvature<S: Simd>(&self, part: &HullPart<S>, axis_motion: &AxisMotion<S>) -> Pack<S>;

    /// −d²h/dt², −d³h/dt³ and −d⁴h/dt⁴ where [`Hull::nearer`] was asked for the part.
    fn derivatives<S: Simd>(&self, part: &HullPart<S>, axis_motion: &AxisMotion<S>)
    -> [Pack<S>; 3];

    /// The end that a contact is recorded under, +1 or −1 for sphere 1 or 2; for a smooth hull, +1 if the half touches to which
    /// the axis points.
    fn name<S: Simd>(&self, part: &HullPart<S>, cos_tilt: Pack<S>) -> Pack<S>;
}

/// The hull of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// Two equal spheres with the centre of mass between them.
    EqualBalls(EqualBalls),
    /// Two spheres, neither of which contains the other.
    TwoBalls(TwoBalls),
    /// One sphere, whose centre need not be the centre of mass.
    OneBall(OneBall),
    /// An ellipsoid of revolution centred at the centre of mass.
    Ellipsoid(Ellipsoid),
}

/// Evaluates an expression with the hull of a [`Surface`], whichever it is.
macro_rules! with_hull {
    ($surface:expr, $hull:ident => $result:expr) => {
        match $surface {
            $crate::shape::Surface::EqualBalls($hull) => $result,
            $crate::shape::Surface::TwoBalls($hull) => $result,
            $crate::shape::Surface::OneBall($hull) => $result,
            $crate::shape::Surface::Ellipsoid($hull) => $result,
        }
    };
}
pub(crate) use with_hull;

impl Surface {
    /// Height of the centre of mass above the plane from which heights are counted in flight, and 0 there.
    pub fn level(&self) -> f64 {
        with_hull!(self, hull => hull.level())
    }

    /// The support function h: height of the centre of mass when the body touches the plane, at e_z = `cos_tilt`.
    pub fn support(&self, cos_tilt: f64) -> f64 {
        let [one, two] = Sphere::BOTH.map(|sphere| self.touching_height(sphere, cos_tilt));
        self.level() + one.max(two)
    }

    /// The largest value of the support function.
    pub fn farthest(&self) -> f64 {
        with_hull!(self, hull => hull.level() + hull.ceiling(one(1.0)).as_slice()[0])
    }

    /// The gap between a sphere and the plane, (2), at this e_z and height; that of the whole body if only one part can touch.
    pub fn gap(&self, sphere: Sphere, cos_tilt: f64, height: f64) -> f64 {
        with_hull!(self, hull => hull.gap(&named(hull, sphere), one(cos_tilt), one(height)).as_slice()[0])
    }

    /// Height at which a sphere touches.
    pub fn touching_height(&self, sphere: Sphere, cos_tilt: f64) -> f64 {
        with_hull!(self, hull => hull.touching_height(&named(hull, sphere), one(cos_tilt)).as_slice()[0])
    }

    /// The lever s of the point of contact.
    pub fn lever(&self, sphere: Sphere, cos_tilt: f64) -> f64 {
        with_hull!(self, hull => hull.lever(&named(hull, sphere), one(cos_tilt)).as_slice()[0])
    }

    /// The end that a contact is recorded under.
    pub fn name(&self, sphere: Sphere, cos_tilt: f64) -> Sphere {
        with_hull!(self, hull => Sphere::of(hull.name(&named(hull, sphere), one(cos_tilt)).as_slice()[0]))
    }

    /// The bound on |d²h/dt²|/Ω² for this amplitude A of e_z and this largest |e_z|.
    pub fn curvature_bound(&self, amplitude: f64, max_cos_tilt: f64) -> f64 {
        with_hull!(self, hull => hull.curvature_bound(one(amplitude), one(max_cos_tilt)).as_slice()[0])
    }
}

fn named(hull: &impl Hull, sphere: Sphere) -> HullPart<Scalar> {
    hull.part(Mask::splat(Scalar::new(), sphere == Sphere::One))
}

#[cfg(test)]
mod derivatives;
