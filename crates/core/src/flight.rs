//! MOTION: the free flight between two impacts, (3)–(5).
//!
//! The centre of mass follows a parabola (5). The axis of a body of revolution turns at a constant rate about the fixed
//! angular momentum. The paper's (3) turns it about **ω**, which is the same only while **ω** is perpendicular to the
//! axis; in general **ω** itself precesses, but the axis moves as in (3) with **Λ**/J_xx in the place of **ω**.

use crate::body::Body;
use crate::sincos::sincos;
use crate::state::State;
use crate::vector::Vector;

/// Rates whose square underflows count as no rotation.
const SLOWEST: f64 = 1e-150;

/// A flight that starts from a [`State`] at time 0.
#[derive(Debug, Clone, Copy)]
pub struct Flight {
    start: State,
    /// Rate of rotation of the axis, |**Λ**|/J_xx.
    pub rate: f64,
    /// The axis is `constant + cosine cos φ + sine sin φ`, φ = rate · t (3).
    constant: Vector,
    cosine: Vector,
    sine: Vector,
    /// Bound A on the amplitude of e_z(t), exactly 1 in planar motion.
    pub amplitude: f64,
}

/// Sine and cosine of the phase φ.
#[derive(Debug, Clone, Copy)]
pub struct Phase {
    sin: f64,
    cos: f64,
}

impl Phase {
    /// The phase `angle` later, to first order in it: exact in double precision below an angle of 2⁻²⁶.
    pub fn advanced(self, angle: f64) -> Self {
        Self {
            sin: self.cos.mul_add(angle, self.sin),
            cos: self.sin.mul_add(-angle, self.cos),
        }
    }
}

impl Flight {
    /// The flight that follows from `start`.
    pub fn new(start: State) -> Self {
        let rate = start.precession.norm();
        // Slower than this nothing turns in any time; every direction then serves, and this one is in planar motion's plane.
        let about = if rate > SLOWEST {
            start.precession / rate
        } else {
            Vector::new(0.0, 1.0, 0.0)
        };
        let constant = about * about.dot(start.axis);
        Self {
            start,
            rate,
            constant,
            cosine: start.axis - constant,
            sine: about.cross(start.axis),
            // The axis circles about `about` on a circle of radius ≤ 1, seen from the side at this angle.
            amplitude: about.horizontal(),
        }
    }

    /// Where the flight starts.
    pub fn start(&self) -> &State {
        &self.start
    }

    /// Sine and cosine of the phase at `time`.
    pub fn phase(&self, time: f64) -> Phase {
        let (sin, cos) = sincos(self.rate * time);
        Phase { sin, cos }
    }

    /// Height of the centre of mass at `time` above where it started (5).
    pub fn rise(&self, time: f64) -> f64 {
        time * time.mul_add(-0.5, self.start.velocity.z)
    }

    /// Height of the centre of mass at `time` (5).
    pub fn height(&self, time: f64) -> f64 {
        self.start.height + self.rise(time)
    }

    /// Vertical velocity of the centre of mass at `time`.
    pub fn climb(&self, time: f64) -> f64 {
        self.start.velocity.z - time
    }

    /// e_z(t) − e_z(0), (3).
    pub fn tilt(&self, phase: Phase) -> f64 {
        self.cosine.z.mul_add(phase.cos, phase.sin * self.sine.z) - self.cosine.z
    }

    /// de_z/dt.
    pub fn tilt_rate(&self, phase: Phase) -> f64 {
        self.rate * self.sine.z.mul_add(phase.cos, -(phase.sin * self.cosine.z))
    }

    /// d²e_z/dt² at the start.
    pub fn initial_tilt_acceleration(&self) -> f64 {
        -self.rate * self.rate * self.cosine.z
    }

    /// M: no gap under a sphere of `body` has f″ < −M at any time of the flight.
    pub fn bound(&self, body: &Body) -> f64 {
        (body.half_separation * self.amplitude).mul_add(self.rate * self.rate, 1.0)
    }

    /// Largest |e_z| that the axis can reach in any flight time.
    pub fn reach(&self) -> f64 {
        self.constant.z.abs() + self.amplitude
    }

    /// The state at `time`, with the vertical position given by the caller (who knows that a sphere touches the plane).
    pub fn state(&self, time: f64, phase: Phase, height: impl Fn(Vector) -> f64) -> State {
        let axis = self
            .cosine
            .mul_add(phase.cos, self.sine.mul_add(phase.sin, self.constant));
        // One Newton step to unit length; rounding would otherwise accumulate over the impacts.
        let axis = axis * axis.dot(axis).mul_add(-0.5, 1.5);
        State {
            height: height(axis),
            velocity: Vector {
                z: self.climb(time),
                ..self.start.velocity
            },
            axis,
            precession: self.start.precession,
        }
    }
}
