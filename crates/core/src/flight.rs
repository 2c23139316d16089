//! MOTION: the free flight between two impacts, (3)–(5).
//!
//! The centre of mass follows a parabola (5). The axis of a body of revolution turns at a constant rate about the fixed
//! angular momentum. The paper's (3) turns it about **ω**, which is the same only while **ω** is perpendicular to the
//! axis; in general **ω** itself precesses, but the axis moves as in (3) with **Λ**/J_xx in the place of **ω**.

use crate::body::Body;
use crate::elementary::{sincos, sincos_of_moderate};
use crate::state::{Sphere, State};
use crate::vector::Vector;

/// Rates whose square underflows count as no rotation.
const SLOWEST: f64 = 1e-150;

/// A flight that starts from a [`State`] at time 0.
#[derive(Debug, Clone, Copy)]
pub struct Flight {
    start: State,
    /// Acceleration along x: tan α where the plane is inclined by α, for the unit of acceleration is g cos α.
    slope: f64,
    /// Rate of rotation of the axis, Ω = |**Λ**|/J_xx.
    pub rate: f64,
    /// The axis is `constant + cosine cos φ + sine sin φ`, φ = Ωt (3).
    constant: Vector,
    cosine: Vector,
    sine: Vector,
    /// Bound A on the amplitude of e_z(t), exactly 1 in planar motion.
    amplitude: f64,
}

/// How far the axis has turned, (3).
#[derive(Debug, Clone, Copy)]
pub struct Attitude {
    /// The part of the axis that turns.
    turning: Vector,
    /// The same a quarter turn on.
    leading: Vector,
}

impl Attitude {
    /// The attitude after another turn through an angle with this sine and cosine.
    fn after(self, sin: f64, cos: f64) -> Self {
        Self {
            turning: self.turning.mul_add(cos, self.leading * sin), // (3)
            leading: self.leading.mul_add(cos, self.turning * -sin), // (3)
        }
    }

    /// The attitude a moderate `angle` later: exact in double precision for angles up to 0.15.
    pub fn turned(self, angle: f64) -> Self {
        let (sin, cos) = sincos_of_moderate(angle);
        self.after(sin, cos)
    }

    /// The attitude a small `angle` later: exact in double precision for angles up to 2⁻¹⁸.
    pub fn advanced(self, angle: f64) -> Self {
        self.after(angle, (angle * angle).mul_add(-0.5, 1.0))
    }
}

impl Flight {
    /// The flight that follows from `start`, over a plane that falls along x with this slope.
    pub fn new(start: State, slope: f64) -> Self {
        let rate = start.precession.norm();
        // Slower than this nothing turns in any time; every direction then serves, and this one suits planar motion.
        let about = if rate > SLOWEST {
            start.precession / rate
        } else {
            Vector::new(0.0, 1.0, 0.0)
        };
        let constant = about * about.dot(start.axis);
        let cosine = start.axis - constant;
        Self {
            start,
            slope,
            rate,
            constant,
            cosine,
            sine: about.cross(start.axis),
            // The axis circles about `about` on a circle of this radius (≤ 1, with room for rounding), seen from the side.
            amplitude: about.horizontal() * (cosine.norm() * (1.0 + 4.0 * f64::EPSILON)).min(1.0),
        }
    }

    /// Where the flight starts.
    pub fn start(&self) -> &State {
        &self.start
    }

    /// Where the axis points when it has turned through `angle` = Ωt.
    pub fn attitude(&self, angle: f64) -> Attitude {
        let (sin, cos) = sincos(angle);
        let start = Attitude {
            turning: self.cosine,
            leading: self.sine,
        };
        start.after(sin, cos)
    }

    /// Height of the centre of mass above the hull's level at `time` (5).
    pub fn lift(&self, time: f64) -> f64 {
        time.mul_add(time.mul_add(-0.5, self.start.velocity.z), self.start.lift) // (5)
    }

    /// Vertical velocity of the centre of mass at `time`.
    pub fn climb(&self, time: f64) -> f64 {
        self.start.velocity.z - time
    }

    /// e_z, the vertical component of the axis (3).
    pub fn tilt(&self, attitude: Attitude) -> f64 {
        attitude.turning.z + self.constant.z // (3)
    }

    /// de_z/dt.
    pub fn tilt_rate(&self, attitude: Attitude) -> f64 {
        self.rate * attitude.leading.z
    }

    /// d²e_z/dt² where the tilt is `tilt`.
    pub fn tilt_acceleration(&self, tilt: f64) -> f64 {
        -(self.rate * self.rate) * (tilt - self.constant.z)
    }

    /// A bound on what the rotation can contribute to the acceleration of a gap: (L/2)AΩ² for a dumbbell.
    pub fn sway(&self, body: &Body) -> f64 {
        body.hull.sway(self.amplitude, self.reach()) * (self.rate * self.rate)
    }

    /// Largest |e_z| that the axis can reach in any flight time.
    pub fn reach(&self) -> f64 {
        self.constant.z.abs() + self.amplitude
    }

    /// The state at `time`, when `sphere` touches the plane.
    pub fn landing(&self, time: f64, attitude: Attitude, body: &Body, sphere: Sphere) -> State {
        let axis = attitude.turning + self.constant; // (3)
        // One Newton step to unit length; rounding would otherwise accumulate over the impacts.
        let axis = axis * axis.dot(axis).mul_add(-0.5, 1.5);
        State {
            lift: body.hull.lift(sphere, axis.z), // (2)
            velocity: Vector {
                x: self.slope.mul_add(time, self.start.velocity.x), // (5)
                y: self.start.velocity.y,
                z: self.climb(time),
            },
            axis,
            precession: self.start.precession,
        }
    }
}
