//! The first contact of a body with the plane (2), certified: no earlier contact can be missed.
//!
//! The gap f of either part of a hull obeys f″ ≥ −M throughout a flight, with M = 1 + (L/2)AΩ² for a dumbbell, and another bound for
//! another hull. A step to the first zero of the lower bound f + f′τ − Mτ²/2 can therefore not pass a contact; such steps converge
//! quadratically to the first contact. While the centre of mass is higher than the hull can reach, the step goes to the time at
//! which it comes back down. An expansion of f about the start of the step, and a second one about the zero of the first, locate a
//! contact to double precision. No lower bound covers the time between the end of the step and the contact, but f″ ≥ −M also bounds
//! the gap backwards in time: a part that arrives at the speed −f′ was clear of the plane for the last 2|f′|/M. A contact which the
//! step comes that near to is the first of its part; whether the other part can have touched in between is checked as well. Where
//! the second expansion is too far from the contact, a third one is made about the zero of the second. At a grazing contact
//! certified steps are repeated until the gap is below the resolution.
//!
//! All lanes are evaluated together; those that need a further pass may sit out the impacts of the others meanwhile. A further pass evaluates the gap just
//! before the contact predicted by the expansions of the previous pass. There it checks, by the same bound backwards in time, that no
//! contact was passed. Where this check fails, the pass is repeated from the end of the last certified step.

mod gap;
mod locate;

pub(crate) use gap::{GapEvaluation, LastContact, Search};
pub(crate) use locate::{LocatedContact, Prediction, Steps};

/// A pass begins about this angle, in rad, divided by the sharpness of the hull, or this fraction of the speed of approach divided
/// by S before the contact that was predicted, whichever is nearer.
const NEAR: f64 = 0.0625;
/// Angle turned through, in rad, beyond which an expansion does not predict the contact. It does not locate one beyond this angle
/// either, nor beyond the inverse of the sharpness.
const FAR: f64 = 0.5;
/// A contact is located if the correction at the zero of the expansion is at most this fraction h of the step, 2⁻¹⁸. The next
/// correction, relative to the step τ, is then (½(f″τ/f′)² − f‴τ²/6f′)h³, which is below 2⁻⁵², or 2⁻⁵⁰ for a
/// spheroid, because Mτ ≤ 2|f′|.
const SMALL: f64 = 1.0 / 262_144.0;
/// Largest number of passes. Grazing contacts need up to two or three dozen, fast spins a few hundred.
pub(crate) const MOST_STEPS: u32 = 1_000_000;
