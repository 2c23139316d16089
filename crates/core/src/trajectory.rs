//! The bounce loop, the paper's steps 1–7, and why it ends.

use crate::body::Body;
use crate::collision::{Law, collide};
use crate::contact::{Departure, Landing, NoConvergence, first_contact};
use crate::flight::Flight;
use crate::state::{Sphere, State};

/// One impact, in the core's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Time since release.
    pub time: f64,
    /// The state just before.
    pub before: State,
    /// The state just after.
    pub after: State,
    /// The sphere that touched.
    pub sphere: Sphere,
}

impl Impact {
    /// v_G^n = −**v**_G·**n** before the impact: positive when falling.
    pub fn impact_velocity(&self) -> f64 {
        -self.before.velocity.z
    }

    /// **v**_G′·**n** after the impact: positive when rising.
    pub fn rebound_velocity(&self) -> f64 {
        self.after.velocity.z
    }

    /// The coefficient of restitution (1); infinite or NaN where the impact velocity is 0.
    pub fn restitution(&self) -> f64 {
        self.rebound_velocity() / self.impact_velocity() // (1)
    }

    /// Share of the rotation in the kinetic energy before the impact (12).
    pub fn rotational_fraction(&self, body: &Body) -> f64 {
        self.before.rotational_energy(body) / self.before.kinetic_energy(body) // (12)
    }

    /// Kinetic energy after the impact over that before.
    pub fn energy_ratio(&self, body: &Body) -> f64 {
        self.after.kinetic_energy(body) / self.before.kinetic_energy(body)
    }
}

/// Why a trajectory ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopReason {
    /// The number of impacts asked for was reached.
    ImpactsReached,
    /// √(2 E_kin/m) after an impact fell below the threshold asked for.
    SpeedBelowThreshold,
    /// Impacts accumulate: [`COLLAPSE_RUN`] flights in a row too low to be resolved, or a contact that is never left. The
    /// body may still rock or roll; what it does in lasting contact the model of instantaneous impacts cannot say.
    Collapse,
    /// The next landing is beyond what can be followed: the axis would turn by more than [`crate::elementary::RANGE`] rad.
    NeverLands,
    /// The run was cancelled.
    Interrupted,
}

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most impacts.
    pub impacts: usize,
    /// Stop below this √(2 E_kin/m), in √(gR); 0 never does.
    pub minimum_speed: f64,
}

/// A flight counts as unresolved when no gap can have exceeded 2⁻⁴³ R in it: M T²/8 < 2⁻⁴³, M ≥ |f″|.
pub(crate) const UNRESOLVED: f64 = 8.0 / 8_796_093_022_208.0;
/// This many unresolved flights in a row are a collapse.
pub const COLLAPSE_RUN: u32 = 16;

/// Bounces a particle until a limit is reached; `record` sees every impact and says whether to go on. The plane falls along
/// x with the given slope, tan α.
pub fn bounce(
    body: &Body,
    law: &Law<'_>,
    slope: f64,
    release: State,
    limits: Limits,
    mut record: impl FnMut(&Impact) -> bool,
) -> Result<StopReason, NoConvergence> {
    let mut state = release;
    let mut departure = Departure::of_release(body, release);
    let mut clock = 0.0;
    let mut unresolved = 0;
    for _ in 0..limits.impacts {
        let flight = Flight::new(state, slope);
        let (time, before, sphere) = match first_contact(&flight, body, departure)? {
            Landing::Impact {
                time,
                state,
                sphere,
            } => (time, state, sphere),
            Landing::Resting => return Ok(StopReason::Collapse),
            Landing::Never => return Ok(StopReason::NeverLands),
        };
        let (after, speed) = collide(body, law, &before, sphere);
        clock += time;
        let go_on = record(&Impact {
            time: clock,
            before,
            after,
            sphere,
        });
        if !go_on {
            return Ok(StopReason::Interrupted);
        }
        if 2.0 * after.kinetic_energy(body) < limits.minimum_speed * limits.minimum_speed {
            return Ok(StopReason::SpeedBelowThreshold);
        }
        let low = (1.0 + flight.sway(body)) * (time * time) < UNRESOLVED;
        unresolved = if low { unresolved + 1 } else { 0 };
        if unresolved == COLLAPSE_RUN {
            return Ok(StopReason::Collapse);
        }
        departure = Departure::Touching { sphere, speed };
        state = after;
    }
    Ok(StopReason::ImpactsReached)
}
