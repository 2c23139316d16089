//! A run, in SI units, and the initial conditions of its particles.

mod block;
mod lanes;
mod plan;
mod recorded;
mod release;
mod rigid;
mod stop;
mod table;

pub(crate) use block::{BLOCK, bounce_block, even, share};
#[cfg(feature = "one-lane")]
pub use lanes::one_lane::{
    FlightEnd, FlightStart, NoConvergence, SingleImpact, collide, first_contact, trajectory,
};
pub(crate) use lanes::{Impact, ImpactSink, Meanwhile, PLACES, Pose, of_group};
pub use plan::Scales;
pub(crate) use plan::{JoinedRuns, Plan};
pub use recorded::{PER_IMPACT, PER_PARTICLE};
pub use release::{About, Height, Orientation, Spin};
pub use stop::{COLLAPSE_RUN, Limits, StopReason};
pub use table::Records;
pub(crate) use table::Table;

use crate::law::{Law, TangentialRestitution};
use crate::math::Vector;
use crate::shape::{AnyBody, Dumbbell};
use crate::simd::elementary::sincos;
use crate::{Error, Value};

/// A run, in SI units.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    /// The body.
    pub body: AnyBody<'a>,
    /// The collision law.
    pub law: Law<'a>,
    /// Number of particles.
    pub particles: usize,
    /// Largest number of impacts of a particle.
    pub impacts: usize,
    /// Distribution of the height of the centre of mass over the plane at release, along the plane normal, in m.
    pub release_height: Height,
    /// Acceleration of gravity, in m/s².
    pub gravity: f64,
    /// Distribution of the symmetry axis, or of the attitude, at release.
    pub orientation: Orientation<'a>,
    /// Distribution of the angular velocity at release, in rad/s.
    pub spin: Spin<'a>,
    /// Velocity of the centre of mass at release, in m/s.
    pub release_velocity: Vector,
    /// Inclination α of the plane in [0, π/2) rad, descending along x: in its frame gravity is g(sin α, 0, −cos α).
    pub incline: f64,
    /// Value of √(2 E_kin/m) after an impact, in m/s, below which a particle stops; with 0 none does.
    pub minimum_speed: f64,
    /// Energy over m g, in m, below which a particle stops because no pass out of a potential well of its body is so low; with 0 none
    /// does. Horizontal motion does not count under a frictionless law. Only for a rigid body of any shape.
    pub settled: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl Default for Run<'_> {
    /// One impact of each of 1000 dumbbells of the paper's Fig. 2, from 6 cm, under its law.
    fn default() -> Self {
        let body = Dumbbell::new(3e-3, 3e-4, 2500.0);
        let law = TangentialRestitution::new(1.0).and_then(|tangential| Law::new(0.98, tangential));
        Self {
            body: body.expect("sizes are allowed").into(),
            law: law.expect("coefficients are allowed"),
            particles: 1000,
            impacts: 1,
            release_height: 0.06.into(),
            gravity: 9.81,
            orientation: Orientation::UniformAngle,
            spin: Spin::NONE,
            release_velocity: Vector::default(),
            incline: 0.0,
            minimum_speed: 0.0,
            settled: 0.0,
            seed: 0,
        }
    }
}

impl Run<'_> {
    /// The origin about which moments of ε are summed: ε_n at the normal speed of the first impact; for random heights, of a release
    /// from the middle one.
    pub fn origin(&self) -> f64 {
        let drop = self.release_height.middle() - self.body.unit();
        let gained = 2.0 * self.gravity * sincos(self.incline).1 * drop.max(0.0);
        let start = self.release_velocity.z;
        self.law.normal.at(start.mul_add(start, gained).sqrt())
    }

    /// Refuses orientations and spins that refer to an axis, or to none, where the body is of the other kind.
    fn check_directions(&self) -> Result<(), Error> {
        let allowed = match self.body {
            AnyBody::Revolution(_) => match self.orientation {
                Orientation::Attitudes(_) => "angles, for a body of revolution",
                _ => return Ok(()),
            },
            AnyBody::Rigid(_) => match self.orientation {
                Orientation::Isotropic | Orientation::Attitudes(_) => {
                    return self.spin.check_without_axis();
                }
                _ => "'isotropic' or quaternions, for a rigid body of any shape",
            },
        };
        let given = match self.orientation {
            Orientation::UniformAngle => "uniform-angle",
            Orientation::Attitudes(_) => "quaternions",
            _ => "angles",
        };
        Err(Error::Parameter {
            name: "orientation",
            value: Value::Name(given.into()),
            allowed: allowed.into(),
        })
    }

    /// Returns whether all particles are released at rest over a level plane. All directions in the plane are then equivalent, unless a
    /// law of one's own distinguishes them, and each particle remains in the vertical plane of its axis.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.spin.is_none()
            && self.release_velocity == Vector::default()
            && self.incline == 0.0
            && self.law.custom.is_none()
    }

    /// Returns whether another run differs in nothing but its seed, the number of its particles and how they are released, and moves in the
    /// same way.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.body == other.body
            && self.law == other.law
            && self.impacts == other.impacts
            && self.gravity == other.gravity
            && self.incline == other.incline
            && self.minimum_speed == other.minimum_speed
            && self.settled == other.settled
            && self.is_at_rest() == other.is_at_rest()
    }
}
