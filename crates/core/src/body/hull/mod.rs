//! What of a body can touch the plane, and how its gap to the plane follows from the axis.
//!
//! A convex body whose axis has the vertical component e_z stands on the plane when its centre of mass is h(e_z) high: its
//! support function. The gap is f = z − h. For a body of revolution the point of contact is
//! **r**_c = s**e** − ϱ**n** with s = −h′ and ϱ = h − h′e_z: it touches like a ball of radius ϱ around the point of the axis
//! at s. For a sphere on the axis both are constant, and the gap is linear in e_z.
//!
//! Heights are kept relative to a level at which a contact has few digits to lose: [`Hull::level`].

mod ball;
mod balls;
mod ellipsoid;
mod pair;

pub use ball::Single;
pub use ellipsoid::Ellipsoid;
pub use pair::{EqualPair, Pair};

use crate::simd::{Mask, Pack, one};
use pulp::{Scalar, Simd};

/// One of the two spheres of a hull; of a smooth hull one of its halves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sphere {
    /// The one to which the axis points.
    One,
    /// The other one.
    Two,
}

impl Sphere {
    /// Both, in order.
    pub const BOTH: [Self; 2] = [Self::One, Self::Two];

    /// The other one.
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

/// A sphere around a point of the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its place on the axis: signed distance s from the centre of mass.
    pub offset: f64,
    /// Its radius ϱ.
    pub radius: f64,
}

/// The part of a hull whose gap is evaluated, in each lane.
#[derive(Clone, Copy)]
pub(crate) struct Part<S: Simd, const K: usize> {
    /// Whether it is sphere 1; of no meaning where only one part can touch.
    pub one: Mask<S, K>,
    /// The lever s of a sphere; of no meaning for a smooth hull, where it depends on the tilt.
    pub lever: Pack<S, K>,
}

/// How the vertical component of the axis, e_z, moves at a moment. It turns as c + A cos Ωt, so that every second derivative
/// is −Ω² times the last.
#[derive(Clone, Copy)]
pub(crate) struct Swing<S: Simd, const K: usize> {
    /// e_z.
    pub tilt: Pack<S, K>,
    /// de_z/dt.
    pub rate: Pack<S, K>,
    /// d²e_z/dt².
    pub acceleration: Pack<S, K>,
    /// Ω².
    pub square: Pack<S, K>,
}

/// What can touch the plane. The search for a contact, the landing and the impact know of a hull what stands here, and
/// nothing else.
pub(crate) trait Hull: Copy {
    /// Whether either of two parts may touch first.
    const TWO: bool;

    /// Height of the centre of mass at which lift is 0.
    fn level(&self) -> f64;

    /// How much faster than e_z itself its support function may vary: an axis that turns by much less than the inverse of this
    /// leaves h close to its Taylor expansion. At least 1.
    fn sharpness(&self) -> f64;

    /// Lift above which nothing can touch while |e_z| ≤ `reach`.
    fn ceiling<S: Simd, const K: usize>(&self, reach: Pack<S, K>) -> Pack<S, K>;

    /// A bound on |d²h/dt²|/Ω² where e_z turns as c + A cos Ωt: what rotation can contribute to the acceleration of a gap.
    /// `amplitude` is A, `reach` is |c| + A.
    fn sway<S: Simd, const K: usize>(&self, amplitude: Pack<S, K>, reach: Pack<S, K>)
    -> Pack<S, K>;

    /// Sphere 1 or 2; the whole hull if there is only one part.
    fn part<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Part<S, K>;

    /// The part whose gap may close first. `bound` is M, the curvature of both lower bounds.
    fn nearer<S: Simd, const K: usize>(
        &self,
        lift: Pack<S, K>,
        climb: Pack<S, K>,
        swing: &Swing<S, K>,
        bound: Pack<S, K>,
    ) -> Part<S, K>;

    /// The gap of a part, (2).
    fn gap<S: Simd, const K: usize>(
        &self,
        part: &Part<S, K>,
        tilt: Pack<S, K>,
        lift: Pack<S, K>,
    ) -> Pack<S, K>;

    /// Lift at which a part touches.
    fn lift<S: Simd, const K: usize>(&self, part: &Part<S, K>, tilt: Pack<S, K>) -> Pack<S, K>;

    /// The lever s = −h′.
    fn lever<S: Simd, const K: usize>(&self, part: &Part<S, K>, tilt: Pack<S, K>) -> Pack<S, K>;

    /// The radius ϱ = h − h′e_z.
    fn radius<S: Simd, const K: usize>(&self, part: &Part<S, K>, tilt: Pack<S, K>) -> Pack<S, K>;

    /// −d²h/dt² + `addend`.
    fn bend<S: Simd, const K: usize>(
        &self,
        part: &Part<S, K>,
        swing: &Swing<S, K>,
        addend: f64,
    ) -> Pack<S, K>;

    /// −d²h/dt², −d³h/dt³ and −d⁴h/dt⁴.
    fn bends<S: Simd, const K: usize>(
        &self,
        part: &Part<S, K>,
        swing: &Swing<S, K>,
    ) -> [Pack<S, K>; 3];

    /// The name under which a contact is known, ±1 for sphere 1 or 2; of a smooth hull the half that touches, 1 on the side to
    /// which the axis points.
    fn name<S: Simd, const K: usize>(&self, part: &Part<S, K>, tilt: Pack<S, K>) -> Pack<S, K>;
}

/// The hull of a body, one of those that there are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// Two equal spheres with the centre of mass between them.
    EqualPair(EqualPair),
    /// Two spheres, neither of which contains the other.
    Pair(Pair),
    /// One sphere, whose centre need not be the centre of mass.
    Single(Single),
    /// An ellipsoid of revolution around the centre of mass.
    Ellipsoid(Ellipsoid),
}

/// Does the same for whatever hull a [`Surface`] has.
macro_rules! with_hull {
    ($surface:expr, $hull:ident => $result:expr) => {
        match $surface {
            $crate::body::Surface::EqualPair($hull) => $result,
            $crate::body::Surface::Pair($hull) => $result,
            $crate::body::Surface::Single($hull) => $result,
            $crate::body::Surface::Ellipsoid($hull) => $result,
        }
    };
}
pub(crate) use with_hull;

impl Surface {
    /// Height of the centre of mass at which lift is 0.
    pub fn level(&self) -> f64 {
        with_hull!(self, hull => hull.level())
    }

    /// The support function h: height of the centre of mass when the body stands on the plane.
    pub fn support(&self, tilt: f64) -> f64 {
        let [one, two] = Sphere::BOTH.map(|sphere| self.lift(sphere, tilt));
        self.level() + one.max(two)
    }

    /// The largest value of the support function.
    pub fn farthest(&self) -> f64 {
        with_hull!(self, hull => hull.level() + hull.ceiling(one(1.0)).as_slice()[0])
    }

    /// The gap of a sphere, (2), at this e_z and lift; of the whole body if there is only one part that can touch.
    pub fn gap(&self, sphere: Sphere, tilt: f64, lift: f64) -> f64 {
        with_hull!(self, hull => hull.gap(&named(hull, sphere), one(tilt), one(lift)).as_slice()[0])
    }

    /// Lift at which a sphere touches.
    pub fn lift(&self, sphere: Sphere, tilt: f64) -> f64 {
        with_hull!(self, hull => hull.lift(&named(hull, sphere), one(tilt)).as_slice()[0])
    }

    /// The lever s of the point of contact.
    pub fn lever(&self, sphere: Sphere, tilt: f64) -> f64 {
        with_hull!(self, hull => hull.lever(&named(hull, sphere), one(tilt)).as_slice()[0])
    }

    /// The name under which a contact is known.
    pub fn name(&self, sphere: Sphere, tilt: f64) -> Sphere {
        with_hull!(self, hull => Sphere::of(hull.name(&named(hull, sphere), one(tilt)).as_slice()[0]))
    }

    /// The bound on |d²h/dt²|/Ω² where e_z turns with this amplitude, up to this |e_z|.
    pub fn sway(&self, amplitude: f64, reach: f64) -> f64 {
        with_hull!(self, hull => hull.sway(one(amplitude), one(reach)).as_slice()[0])
    }
}

fn named(hull: &impl Hull, sphere: Sphere) -> Part<Scalar, 1> {
    hull.part(Mask::splat(Scalar::new(), sphere == Sphere::One))
}
