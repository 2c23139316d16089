//! What of a body can touch the plane, and how its gap to the plane follows from the axis.
//!
//! A convex body whose axis has the vertical component e_z stands on the plane when its centre of mass is h(e_z) high: its
//! support function. The gap is f = z − h. For a body of revolution the point of contact is
//! **r**_c = s**e** − ϱ**n** with s = −h′ and ϱ = h − h′e_z: it touches like a [`Ball`] of radius ϱ around the point of the axis
//! at s. For a sphere on the axis both are constant, and the gap is linear in e_z.
//!
//! Heights are kept relative to a level at which a contact has few digits to lose: [`Hull::level`].

use super::Ellipsoid;
use crate::state::Sphere;

/// A sphere around a point of the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its place on the axis: signed distance s from the centre of mass.
    pub offset: f64,
    /// Its radius ϱ.
    pub radius: f64,
}

/// What can touch the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hull {
    /// Two spheres, neither of which contains the other.
    Pair(Pair),
    /// One sphere, under its name.
    Single(Ball, Sphere),
    /// An ellipsoid of revolution around the centre of mass.
    Ellipsoid(Ellipsoid),
}

/// Spheres 1 and 2, whose centres are on the axis. Both touch the plane at once when e_z is `tilt`: at that height of the
/// centre of mass, `level`, lift is 0, and the gaps are lift + s(e_z − tilt).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    balls: [Ball; 2],
    /// ℓ = (ϱ₁ − ϱ₂)/(s₁ − s₂), in (−1, 1).
    tilt: f64,
    level: f64,
}

impl Pair {
    /// Equal spheres of radius 1 at ±`half_separation`.
    pub(super) fn equal(half_separation: f64) -> Self {
        let ball = |offset| Ball {
            offset,
            radius: 1.0,
        };
        Self {
            balls: [ball(half_separation), ball(-half_separation)],
            tilt: 0.0,
            level: 1.0,
        }
    }

    /// The lever s of a sphere.
    pub fn lever(&self, sphere: Sphere) -> f64 {
        self.balls[sphere as usize].offset
    }

    /// e_z less that at which both spheres touch: negative where sphere 1 is the lower one.
    pub fn lean(&self, tilt: f64) -> f64 {
        tilt - self.tilt
    }
}

impl Hull {
    /// Two spheres whose centres are `separation` apart, or the one that contains the other.
    pub(super) fn of_balls(balls: [Ball; 2], separation: f64) -> Self {
        let [one, two] = balls;
        let difference = one.radius - two.radius;
        if difference >= separation {
            Self::Single(one, Sphere::One)
        } else if -difference >= separation {
            Self::Single(two, Sphere::Two)
        } else {
            let tilt = difference / separation;
            Self::Pair(Pair {
                balls,
                tilt,
                level: one.offset.mul_add(-tilt, one.radius),
            })
        }
    }

    /// Height of the centre of mass at which lift is 0.
    pub fn level(&self) -> f64 {
        match self {
            Self::Pair(pair) => pair.level,
            Self::Single(ball, _) => ball.radius,
            Self::Ellipsoid(ellipsoid) => ellipsoid.level(),
        }
    }

    /// The gap of a sphere, (2); of the whole body if there is only one part that can touch.
    pub fn gap(&self, sphere: Sphere, tilt: f64, lift: f64) -> f64 {
        match self {
            Self::Pair(pair) => pair.lever(sphere).mul_add(pair.lean(tilt), lift), // (2)
            Self::Single(ball, _) => ball.offset.mul_add(tilt, lift),
            Self::Ellipsoid(ellipsoid) => lift - ellipsoid.rise(tilt),
        }
    }

    /// Lift at which a sphere touches.
    pub fn lift(&self, sphere: Sphere, tilt: f64) -> f64 {
        match self {
            Self::Pair(pair) => -(pair.lever(sphere) * pair.lean(tilt)), // (2)
            Self::Single(ball, _) => -(ball.offset * tilt),
            Self::Ellipsoid(ellipsoid) => ellipsoid.rise(tilt),
        }
    }

    /// The support function h: height of the centre of mass when the body stands on the plane.
    pub fn support(&self, tilt: f64) -> f64 {
        let [one, two] = Sphere::BOTH.map(|sphere| self.lift(sphere, tilt));
        self.level() + one.max(two)
    }

    /// Lift above which nothing can touch while |e_z| ≤ `reach`.
    pub fn ceiling(&self, reach: f64) -> f64 {
        match self {
            Self::Pair(pair) => {
                let [one, two] = pair
                    .balls
                    .map(|ball| ball.offset.abs() * reach + ball.offset * pair.tilt);
                one.max(two)
            }
            Self::Single(ball, _) => ball.offset.abs() * reach,
            Self::Ellipsoid(ellipsoid) => ellipsoid.ceiling(reach),
        }
    }

    /// The ball that the contact is like: its point is **r**_c = s**e** − ϱ**n** (6).
    pub fn ball(&self, sphere: Sphere, tilt: f64) -> Ball {
        match self {
            Self::Pair(pair) => pair.balls[sphere as usize],
            Self::Single(ball, _) => *ball,
            Self::Ellipsoid(ellipsoid) => ellipsoid.ball(tilt),
        }
    }

    /// h″ = d²h/de_z².
    pub fn curvature(&self, tilt: f64) -> f64 {
        match self {
            Self::Pair(_) | Self::Single(..) => 0.0,
            Self::Ellipsoid(ellipsoid) => ellipsoid.curvature(tilt),
        }
    }

    /// A bound on |d²h/dt²|/Ω² where e_z turns as c + A cos Ωt: what rotation can contribute to the acceleration of a gap.
    /// `amplitude` is A, `reach` is |c| + A.
    pub fn sway(&self, amplitude: f64, reach: f64) -> f64 {
        match self {
            Self::Pair(pair) => {
                let [one, two] = pair.balls.map(|ball| ball.offset.abs());
                one.max(two) * amplitude
            }
            Self::Single(ball, _) => ball.offset.abs() * amplitude,
            Self::Ellipsoid(ellipsoid) => ellipsoid.sway(amplitude, reach),
        }
    }

    /// Whether the gaps are linear in e_z.
    pub fn is_of_balls(&self) -> bool {
        !matches!(self, Self::Ellipsoid(_))
    }

    /// Whether both names mean the same part of the body.
    pub fn is_one(&self, a: Sphere, b: Sphere) -> bool {
        a == b || !matches!(self, Self::Pair(_))
    }

    /// The name under which a contact is known: the sphere; of an ellipsoid the half that touches, 1 on the side to which the
    /// axis points.
    pub fn name(&self, sphere: Sphere, tilt: f64) -> Sphere {
        match self {
            Self::Pair(_) => sphere,
            Self::Single(_, name) => *name,
            Self::Ellipsoid(_) if tilt < 0.0 => Sphere::One,
            Self::Ellipsoid(_) => Sphere::Two,
        }
    }

    /// Whether the hull is that of two equal spheres with the centre of mass between them.
    pub fn is_equal_pair(&self) -> bool {
        let Self::Pair(Pair { balls, .. }) = self else {
            return false;
        };
        balls[0].radius == balls[1].radius && balls[0].offset == -balls[1].offset
    }
}
