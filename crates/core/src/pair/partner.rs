//! A body as encounters see it, and its state.

use crate::Error;
use crate::contact::PairFlight;
use crate::law::Compliance;
use crate::math::{Quaternion, Symmetric, Vector};
use crate::motion::{BodyPose, FlightRotation, Rotation};
use crate::shape::{AnyBody, Piece, PieceKind, Top};

/// A body of an encounter, or a plane at rest, the body of infinite mass. Units are coherent, such as SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Partner {
    pub(crate) inverse_mass: f64,
    pub(crate) top: Top,
    /// The reciprocals of the principal moments.
    pub(crate) inverse_moments: [f64; 3],
    /// The largest distance of a part from the centre of mass; 0 of a plane.
    pub(crate) reach: f64,
    /// The rotation from the principal axes to those that the body was given in.
    pub(crate) axes: Quaternion,
    pub(crate) pieces: Vec<Piece>,
    /// The principal axis about which it is a body of revolution, if that precesses.
    pub(crate) axis: Option<usize>,
    ball: bool,
}

impl Partner {
    /// A body in SI units; `name` is that of its parameter.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a body whose surface is not known part by part.
    pub fn new(name: &'static str, body: AnyBody<'_>) -> Result<Self, Error> {
        let (moments, axes) = match body {
            AnyBody::Revolution(solid) => {
                let (across, along) = (solid.transverse_inertia, solid.axial_inertia);
                ([across, across, along], Quaternion::IDENTITY)
            }
            AnyBody::Rigid(rigid) => (rigid.principal_moments(), rigid.axes),
        };
        let top = Top::new(moments)?;
        let pieces = body.pieces(name)?;
        let round = |&axis: &usize| {
            top.precesses(axis) && pieces.iter().all(|piece| piece.is_round_about(axis))
        };
        let axis = (0..3).rev().find(round);
        let pieces: Vec<Piece> = match axis {
            Some(axis) => pieces.into_iter().map(|piece| piece.about(axis)).collect(),
            None => pieces,
        };
        let ball = |piece: &Piece| match piece.kind {
            PieceKind::Ball(place, _) => place == Vector::default(),
            _ => false,
        };
        let reach = |piece: &Piece| piece.reach + piece.ball;
        Ok(Self {
            inverse_mass: 1.0 / body.mass(),
            inverse_moments: top.moments().map(|moment| 1.0 / moment),
            reach: pieces.iter().map(reach).fold(0.0, f64::max),
            axis,
            ball: pieces.iter().all(ball),
            top,
            axes,
            pieces,
        })
    }

    /// The plane z = 0, below a body.
    pub fn plane() -> Self {
        Self {
            inverse_mass: 0.0,
            top: Top::new([1.0; 3]).expect("equal moments"),
            inverse_moments: [0.0; 3],
            reach: 0.0,
            axes: Quaternion::IDENTITY,
            pieces: vec![Piece::plane()],
            axis: None,
            ball: false,
        }
    }

    /// True for a plane.
    #[inline(always)]
    pub fn is_plane(&self) -> bool {
        self.inverse_mass == 0.0
    }

    /// True for a ball about the centre of mass.
    #[inline(always)]
    pub(crate) fn is_ball(&self) -> bool {
        self.ball
    }

    /// Mass; infinite of a plane.
    #[inline(always)]
    pub fn mass(&self) -> f64 {
        1.0 / self.inverse_mass
    }

    /// The principal moments of inertia.
    #[inline(always)]
    pub fn moments(&self) -> [f64; 3] {
        self.top.moments()
    }

    /// The rotation from the principal axes to those that the body was given in.
    pub fn axes(&self) -> Quaternion {
        self.axes
    }

    /// The largest distance of a part from the centre of mass; 0 of a plane.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// A body after a time of free flight.
    pub fn later(&self, state: &PairState, time: f64) -> PairState {
        let mut free = FreeBody::new(self, state);
        free.position = free.velocity.mul_add(time, free.position);
        free.turn(self, time);
        free.state(self)
    }

    /// A body after an impulse at a point, both in the axes of space.
    pub fn struck(&self, state: &PairState, point: Vector, impulse: Vector) -> PairState {
        let mut free = FreeBody::new(self, state);
        free.push(self, point - state.position, impulse, 1.0);
        free.state(self)
    }

    /// The kinetic energy of the centre of mass.
    #[inline(always)]
    pub fn translational_energy(&self, velocity: Vector) -> f64 {
        if self.is_plane() {
            return 0.0;
        }
        0.5 * self.mass() * velocity.dot(velocity)
    }

    /// The kinetic energy of the rotation with ω in the axes of space.
    #[inline(always)]
    pub fn rotational_energy(&self, attitude: Quaternion, spin: Vector) -> f64 {
        if self.is_plane() {
            return 0.0;
        }
        let principal = attitude * self.axes;
        0.5 * self.top.twice_energy(principal.inverse().rotate(spin))
    }
}

/// Position and motion of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairState {
    /// The centre of mass.
    pub position: Vector,
    /// Its velocity.
    pub velocity: Vector,
    /// The rotation from the axes that the body was given in to those of space.
    pub attitude: Quaternion,
    /// ω in the axes of space.
    pub spin: Vector,
}

/// A body in flight.
#[derive(Clone, Copy)]
pub(crate) struct FreeBody {
    pub position: Vector,
    pub velocity: Vector,
    /// That of the principal axes.
    pub attitude: Quaternion,
    /// ω in the principal axes.
    pub spin: Vector,
}

impl FreeBody {
    #[inline(always)]
    pub fn new(body: &Partner, state: &PairState) -> Self {
        let attitude = state.attitude * body.axes;
        Self {
            position: state.position,
            velocity: state.velocity,
            attitude,
            spin: attitude.inverse().rotate(state.spin),
        }
    }

    #[inline(always)]
    pub fn both(bodies: [&Partner; 2], states: &[PairState; 2]) -> [Self; 2] {
        [
            Self::new(bodies[0], &states[0]),
            Self::new(bodies[1], &states[1]),
        ]
    }

    #[inline(always)]
    pub fn state(&self, body: &Partner) -> PairState {
        PairState {
            position: self.position,
            velocity: self.velocity,
            attitude: self.attitude * body.axes.inverse(),
            spin: self.attitude.rotate(self.spin),
        }
    }

    /// Its kinetic energy.
    #[inline(always)]
    pub fn energy(&self, body: &Partner) -> f64 {
        body.translational_energy(self.velocity) + self.rotational_energy(body)
    }

    /// That of its rotation.
    #[inline(always)]
    pub fn rotational_energy(&self, body: &Partner) -> f64 {
        0.5 * body.top.twice_energy(self.spin)
    }

    /// Turns it as it does in a time.
    #[inline(always)]
    pub fn turn(&mut self, body: &Partner, time: f64) {
        if time != 0.0 {
            let mut rotation = Rotation::begun(&body.top, self.attitude, self.spin);
            (self.attitude, self.spin) = rotation.later(time);
        }
    }

    #[inline(always)]
    fn rotation(&self, body: &Partner) -> FlightRotation {
        FlightRotation::new(&body.top, body.axis, self.attitude, self.spin)
    }

    #[inline(always)]
    pub(super) fn pose(&self) -> BodyPose {
        BodyPose::new(self.attitude, self.spin)
    }

    /// The velocity of a point relative to the centre of mass.
    #[inline(always)]
    pub(super) fn moves(&self, arm: Vector) -> Vector {
        self.attitude.rotate(self.spin).cross(arm)
    }

    /// K of the body at a point, in axes to which `back` turns those of space.
    #[inline(always)]
    pub(super) fn compliance(&self, body: &Partner, back: Quaternion, arm: Vector) -> Compliance {
        let inverse = Symmetric::turned(body.inverse_moments, back * self.attitude);
        Compliance::of_body(1.0 / body.inverse_mass, &inverse, back.rotate(arm))
    }

    /// The torque of an impulse at a point, and the change of ω by it, in the principal axes.
    #[inline(always)]
    pub(super) fn twist(&self, body: &Partner, arm: Vector, impulse: Vector) -> [Vector; 2] {
        let torque = self.attitude.inverse().rotate(arm.cross(impulse));
        let [x, y, z] = body.inverse_moments;
        [
            torque,
            Vector::new(x * torque.x, y * torque.y, z * torque.z), // (11)
        ]
    }

    /// The change by an impulse at a point.
    #[inline(always)]
    pub fn push(&mut self, body: &Partner, arm: Vector, impulse: Vector, sign: f64) {
        self.velocity = impulse.mul_add(sign * body.inverse_mass, self.velocity);
        let [_, change] = self.twist(body, arm, impulse);
        self.spin = change.mul_add(sign, self.spin);
    }
}

/// Two bodies that are about to meet, and the time for which each has turned freely before.
#[derive(Clone, Copy)]
pub(crate) struct Approach {
    pub states: [FreeBody; 2],
    pub passed: [f64; 2],
}

#[inline(always)]
pub(super) fn flight(bodies: [&Partner; 2], states: &[FreeBody; 2]) -> PairFlight {
    let [one, two] = states;
    PairFlight {
        apart: one.position - two.position,
        velocity: one.velocity - two.velocity,
        turns: [one.rotation(bodies[0]), two.rotation(bodies[1])],
    }
}
