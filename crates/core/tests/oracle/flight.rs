//! Free flight of a symmetric top, and its first contact by certified steps alone.

use super::algebra::{NORMAL, Vector, cross, dot, minus, norm, plus, times};
use super::solid::Body;

/// A particle just after an impact, or at its release. Nothing horizontal is needed but the velocity.
#[derive(Debug, Clone, Copy)]
pub struct State {
    pub height: f64,
    pub velocity: Vector,
    pub axis: Vector,
    /// Angular momentum about the centre of mass.
    pub momentum: Vector,
}

/// The part that was hit, and the speed at which it leaves the plane.
pub type Leaving = Option<(usize, f64)>;

pub enum FlightEnd {
    Contact {
        time: f64,
        part: usize,
    },
    /// It does not leave the plane.
    Resting,
    /// The axis turns by more than 2²⁰ rad before.
    Never,
}

/// Largest angle through which the engine follows an axis.
pub const FOLLOWED: f64 = 1_048_576.0;

pub struct Flight<'a> {
    pub body: &'a Body,
    pub start: State,
    pub gravity: Vector,
    /// The height by which the plane is taken to be too high under each part, for the growth of rounding to be seen.
    pub bumps: [f64; 2],
}

impl Flight<'_> {
    /// Rate at which the axis turns about the angular momentum.
    pub fn rate(&self) -> f64 {
        norm(self.start.momentum) / self.body.transverse
    }

    /// Symmetry axis after `time`, by Rodrigues' formula.
    fn axis(&self, time: f64) -> Vector {
        let State { axis, momentum, .. } = self.start;
        let size = norm(momentum);
        if size == 0.0 {
            return axis;
        }
        let about = times(1.0 / size, momentum);
        let angle = self.rate() * time;
        let half = (0.5 * angle).sin();
        let turned = plus(
            plus(
                times(angle.cos(), axis),
                times(angle.sin(), cross(about, axis)),
            ),
            times(2.0 * half * half * dot(about, axis), about),
        );
        times(1.0 / norm(turned), turned)
    }

    pub fn at(&self, time: f64) -> State {
        let fall = plus(
            times(time, self.start.velocity),
            times(0.5 * time * time, self.gravity),
        );
        State {
            height: self.start.height + fall[2],
            velocity: plus(self.start.velocity, times(time, self.gravity)),
            axis: self.axis(time),
            momentum: self.start.momentum,
        }
    }

    /// Gap under a part and its rate: the lowest point moves with the body.
    pub fn gap(&self, time: f64, part: usize) -> (f64, f64) {
        let State {
            height,
            velocity,
            axis,
            momentum,
        } = self.at(time);
        let point = self.body.lowest_point(part, axis);
        let turning = times(1.0 / self.body.transverse, momentum); // spin about the axis moves no lowest point up or down
        let rate = velocity[2] + cross(turning, point)[2];
        (height + point[2] - self.bumps[part], rate)
    }

    /// d²f/dt² ≥ −bound.
    pub fn bound(&self) -> f64 {
        let size = norm(self.start.momentum);
        let rotation = if size == 0.0 {
            0.0
        } else {
            let about = times(1.0 / size, self.start.momentum);
            let constant = (dot(about, self.start.axis) * about[2]).abs();
            let amplitude = norm(cross(about, NORMAL)) * norm(cross(about, self.start.axis));
            let reach = (constant + amplitude).min(1.0);
            self.rate() * self.rate() * self.body.bend(amplitude.min(1.0), reach)
        };
        rotation - self.gravity[2]
    }

    /// d²f/dt² at the start under a part, by the difference of rates an instant apart where they are smooth.
    fn lift(&self, part: usize) -> f64 {
        let instant = 1e-6 / (self.rate() + 1e-300);
        let instant = instant.min(1e-6 * (self.start.height / -self.gravity[2]).sqrt());
        (self.gap(instant, part).1 - self.gap(-instant, part).1) / (2.0 * instant)
    }

    /// First contact. f ≥ f₀ + f₀′τ − Mτ²/2 is positive up to its zero, so that a step to there passes no contact; nothing else is used.
    pub fn first_contact(&self, leaving: Leaving) -> FlightEnd {
        let bound = self.bound();
        let certified = |(gap, rate): (f64, f64)| {
            let gap = gap.max(0.0);
            let root = (rate * rate + 2.0 * bound * gap).sqrt();
            if rate < 0.0 {
                2.0 * gap / (root - rate)
            } else {
                (rate + root) / bound
            }
        };
        // What shows no change of a gap: a part that neither approaches nor has left is looked at again after this.
        let instant = 2.0_f64.powi(-27) * (self.start.height / bound).sqrt();
        let mut time = 0.0;
        if let Some((part, speed)) = leaving {
            let others = (0..self.body.parts()).filter(|&other| other != part);
            let other = others
                .map(|other| certified(self.gap(0.0, other)))
                .fold(f64::INFINITY, f64::min);
            let own = if speed > 0.0 {
                2.0 * speed / bound
            } else if self.lift(part) <= 0.0 {
                let hit = (0..self.body.parts()).any(|other| {
                    let (gap, rate) = self.gap(0.0, other);
                    other != part && gap <= 0.0 && rate < 0.0
                });
                if !hit {
                    return FlightEnd::Resting;
                }
                f64::INFINITY
            } else {
                instant // f ≈ f″t²/2, f″ > 0
            };
            time = own.min(other);
        }
        for _ in 0..10_000_000 {
            if self.rate() * time > FOLLOWED {
                return FlightEnd::Never;
            }
            let (mut step, mut nearest) = (f64::INFINITY, 0);
            for part in 0..self.body.parts() {
                let (gap, rate) = self.gap(time, part);
                let own = if rate < 0.0 {
                    certified((gap, rate))
                } else {
                    certified((gap, rate)).max(instant)
                };
                if own < step {
                    (step, nearest) = (own, part);
                }
            }
            if time + step == time || step == 0.0 {
                return FlightEnd::Contact {
                    time,
                    part: nearest,
                };
            }
            time += step;
        }
        panic!("certified steps of {:?} did not end", self.start);
    }
}

/// Angular velocity: **ω** with J**ω** = **Λ**, along the axis and across it.
pub fn spin(body: &Body, state: &State) -> Vector {
    let along = dot(state.momentum, state.axis);
    let across = minus(state.momentum, times(along, state.axis));
    plus(
        times(1.0 / body.transverse, across),
        times(along / body.axial, state.axis),
    )
}

/// Kinetic energies of translation and of rotation.
pub fn energies(body: &Body, state: &State) -> (f64, f64) {
    (
        0.5 * body.mass * dot(state.velocity, state.velocity),
        0.5 * dot(spin(body, state), state.momentum),
    )
}
