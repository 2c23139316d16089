//! WHEN: the first contact of a body with the plane (2), found for certain.
//!
//! The gap f under either part of a hull obeys f″ ≥ −M throughout a flight, M = 1 + (L/2)AΩ² for a dumbbell, or another bound for
//! another hull. A step to the first zero of the lower bound f + f′τ − Mτ²/2 can therefore not pass a contact; such steps converge
//! quadratically to the first one. While the centre of mass is higher than the hull can reach, the step goes to where it comes
//! back down. When a step turns the axis and bends the gap by little, f falls to its only zero just behind it; an expansion of f
//! from before the step and another at the zero of the first locate it to double precision. Whether the other part can have
//! touched on that last way, which no lower bound covers, is checked afterwards. At a grazing contact certified steps go on until
//! nothing of the gap can be left.
//!
//! All lanes take the same step at the same time and wait for the slowest search; few need a second pass. A further pass looks just
//! before the contact to which the expansions of the last one lead. Whether none was passed on the way is checked there: f″ ≥ −M
//! bounds the gap backwards as it does forwards. Where that is not enough, the pass is made again from where the last step ended.

mod arrival;
mod gap;

pub(crate) use arrival::{Arrival, Leap, Residue};
pub(crate) use gap::{Departure, Look, Search};

/// A contact is near if the step turns the axis by at most this angle, over the sharpness of the hull, and the gap bends away
/// from its tangent by at most about this part of it.
const NEAR: f64 = 0.125;
/// Beyond this angle the expansions say nothing of where the contact may be.
const FAR: f64 = 0.5;
/// It is located if the correction at the zero of the expansion is at most this part of the step, 2⁻¹⁸. Relative to the step the
/// next correction is twice the cube of that.
const SMALL: f64 = 1.0 / 262_144.0;
/// At a grazing contact the last step is at most this part of the flight time, turns the axis by at most this angle, 2⁻¹¹...
const LAST: f64 = 1.0 / 2048.0;
/// ...and leaves no more of the gap than this, which cannot be seen: 2⁻⁵² R.
const INVISIBLE: f64 = 1.0 / 4_503_599_627_370_496.0;
/// A part that is not approaching is left alone at least until its gap may have bent by that: 2⁻²⁶/M.
const SHORTEST: f64 = 1.0 / 67_108_864.0;
/// Gaps up to this may be rounding: 2⁻⁴⁸ R.
const TOUCHING: f64 = 1.0 / 281_474_976_710_656.0;
/// Two or three dozen steps are the most that grazing contacts need, and fast spins a few hundred; this is far beyond.
pub(crate) const MOST_STEPS: u32 = 1_000_000;
