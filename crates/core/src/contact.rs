//! WHEN: the first contact of either sphere with the plane, (2), which nothing can make it miss.
//!
//! The gap f under either sphere obeys f″ ≥ −M throughout a flight, M = 1 + (L/2)AΩ². A step to the first zero of
//! the lower bound f + f′τ − Mτ²/2 can therefore not pass a contact. Stepping both spheres by the smaller of their steps
//! converges quadratically to the first contact. While the centre of mass is higher than the spheres can reach,
//! the step goes to where it comes back down.

use crate::body::Body;
use crate::flight::{Flight, Phase};
use crate::sincos::RANGE;
use crate::state::{Sphere, State};

/// How a flight starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Departure {
    /// Away from the plane.
    Free,
    /// With one sphere on the plane, its lowest point leaving at `speed` ≥ 0.
    Touching {
        /// The sphere on the plane.
        sphere: Sphere,
        /// Normal speed of the point of contact.
        speed: f64,
    },
}

/// How a flight ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Landing {
    /// A sphere meets the plane.
    Impact {
        /// Flight time.
        time: f64,
        /// The state just before the impact.
        state: State,
        /// The sphere that touches.
        sphere: Sphere,
    },
    /// The sphere on the plane does not leave it: no relative motion, and gravity holds it down.
    Resting,
    /// No contact within the flight times in which the axis can be followed (its phase exceeds [`RANGE`]).
    Never,
}

/// The search did not end. It always should; the caller reports which particle this was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoConvergence;

/// A contact is accepted when the last step is this small a part of the flight time...
const LAST_STEP: f64 = 1.0 / 134_217_728.0; // 2⁻²⁷
/// ...and so small that neither what the gap bends in it, Mτ²/2, nor the phase to second order, (Ωτ)²/2, can be seen.
const LAST_BEND: f64 = 1.0 / 4_503_599_627_370_496.0; // 2⁻⁵²
/// Two or three dozen steps are the most that grazing contacts need; this is far beyond.
const MOST_STEPS: u32 = 10_000;

/// First contact of `flight` after its start.
pub fn first_contact(
    flight: &Flight,
    body: &Body,
    departure: Departure,
) -> Result<Landing, NoConvergence> {
    let search = Search::new(flight, body, departure);
    let start = flight.start();
    // The lower sphere is on the plane at the latest when the centre of mass has come down to R.
    let latest = time_to_fall_to(1.0, start.height, start.velocity.z);
    let followed = flight.rate * latest <= RANGE; // false for NaN too
    if !followed {
        return Ok(Landing::Never);
    }
    let Some(mut time) = search.first_step(departure) else {
        return Ok(Landing::Resting);
    };
    for _ in 0..MOST_STEPS {
        let phase = flight.phase(time);
        let step = search.step(time, phase);
        let next = time + step.length;
        if step.approaching
            && step.length <= LAST_STEP * next
            && search.stiffness * step.length * step.length <= LAST_BEND
        {
            let phase = phase.advanced(flight.rate * step.length);
            let state = flight.state(next, phase, |axis| {
                1.0 - step.sphere.sign() * body.half_separation * axis.z // (2)
            });
            return Ok(Landing::Impact {
                time: next,
                state,
                sphere: step.sphere,
            });
        }
        time = next;
    }
    Err(NoConvergence)
}

struct Search<'a> {
    flight: &'a Flight,
    half_separation: f64,
    /// Gaps at the start.
    gaps: [f64; 2],
    /// M, the bound on −f″.
    bound: f64,
    /// M + Ω².
    stiffness: f64,
    /// The longest step in which no gap bends visibly.
    blink: f64,
    /// Above this height of the centre of mass neither sphere can touch.
    clear: f64,
}

/// A step that no contact can come before.
#[derive(Clone, Copy)]
struct Step {
    length: f64,
    /// The sphere that limits it.
    sphere: Sphere,
    /// Whether that sphere is on its way to the plane.
    approaching: bool,
}

impl<'a> Search<'a> {
    fn new(flight: &'a Flight, body: &Body, departure: Departure) -> Self {
        let half_separation = body.half_separation;
        let bound = flight.bound(body);
        let stiffness = flight.rate.mul_add(flight.rate, bound);
        let mut gaps = flight.start().gaps(body);
        if let Departure::Touching { sphere, .. } = departure {
            gaps[sphere as usize] = 0.0; // exactly, whatever rounding says
        }
        Self {
            flight,
            half_separation,
            gaps,
            bound,
            stiffness,
            blink: (LAST_BEND / stiffness).sqrt(),
            clear: half_separation.mul_add(flight.reach(), 1.0),
        }
    }

    /// Time of the first evaluation: 0, or before either sphere can be back. `None` if the sphere on the plane stays there.
    fn first_step(&self, departure: Departure) -> Option<f64> {
        let Departure::Touching { sphere, speed } = departure else {
            return Some(0.0);
        };
        if speed > 0.0 {
            let other = Sphere::BOTH[1 - sphere as usize];
            let rate = self.rate_of_gap(0.0, self.flight.phase(0.0), other);
            let other = self.certified(self.gaps[other as usize], rate);
            return Some((2.0 * speed / self.bound).min(other));
        }
        // No separation speed, as after a perfectly plastic impact: only its own rotation can lift the sphere, f″ > 0.
        let acceleration = (sphere.sign() * self.half_separation)
            .mul_add(self.flight.initial_tilt_acceleration(), -1.0);
        (acceleration > 0.0).then_some(self.blink)
    }

    /// The largest step that is safe for both spheres.
    fn step(&self, time: f64, phase: Phase) -> Step {
        let rise = self.flight.rise(time);
        let tilt = self.half_separation * self.flight.tilt(phase);
        let [one, two] = Sphere::BOTH.map(|sphere| {
            let gap = self.gaps[sphere as usize] + sphere.sign().mul_add(tilt, rise);
            let rate = self.rate_of_gap(time, phase, sphere);
            Step {
                length: self.certified(gap, rate),
                sphere,
                approaching: rate < 0.0,
            }
        });
        let nearer = if one.length <= two.length { one } else { two };
        let height = self.flight.height(time);
        if height >= self.clear {
            let down = time_to_fall_to(self.clear, height, self.flight.climb(time));
            if down > nearer.length {
                return Step {
                    length: down,
                    approaching: false,
                    ..nearer
                };
            }
        }
        nearer
    }

    /// f′ under `sphere`.
    fn rate_of_gap(&self, time: f64, phase: Phase, sphere: Sphere) -> f64 {
        (sphere.sign() * self.half_separation)
            .mul_add(self.flight.tilt_rate(phase), self.flight.climb(time))
    }

    /// First zero τ ≥ 0 of gap + rate τ − Mτ²/2: no contact can come earlier. An overlap, which is rounding, counts as a
    /// gap of 0. A sphere that is not approaching is left alone for at least a blink, so that every step makes progress.
    fn certified(&self, gap: f64, rate: f64) -> f64 {
        let gap = gap.max(0.0);
        let root = rate.mul_add(rate, 2.0 * self.bound * gap).sqrt();
        // Of the two forms of the same root the one that does not subtract.
        if rate < 0.0 {
            2.0 * gap / (root - rate)
        } else {
            ((rate + root) / self.bound).max(self.blink)
        }
    }
}

/// Time until a point thrown up at `climb` from `height` comes down to the lower `level`.
fn time_to_fall_to(level: f64, height: f64, climb: f64) -> f64 {
    let drop = (height - level).max(0.0);
    climb + climb.mul_add(climb, 2.0 * drop).sqrt()
}
