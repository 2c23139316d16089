//! The record of a gas: counts since the beginning, and moments of each kind of bodies.

use super::Species;
use crate::math::{Vector, add_to};
use crate::pair::{FreeBody, PairState};

/// Columns of a look at a gas, in SI units: pairs within reach of each other, encounters with contact, their contacts, those that ended as a collapse and
/// those that created energy, and how much; looks at pairs; candidates faster than the majorant; the power of two by which velocities are too large.
pub const GAS_WHOLE: [&str; 10] = [
    "time",
    "attempts",
    "collisions",
    "contacts",
    "collapses",
    "creating",
    "created_energy",
    "steps",
    "beyond",
    "exponent",
];

/// Columns of a kind of bodies, means in SI units: ⟨v²⟩, ⟨v⁴⟩, the energies of rotation about the principal axes, ⟨E_rot²⟩, ⟨v² E_rot⟩, ⟨cos²⟩ of the angles
/// of v with ω and with the third axis of the body, and ⟨**v**⟩.
pub const GAS_KIND: [&str; 12] = [
    "speed_squared",
    "speed_fourth",
    "rotational_x",
    "rotational_y",
    "rotational_z",
    "rotational_squared",
    "mixed",
    "cos2_velocity_spin",
    "cos2_velocity_axis",
    "momentum_x",
    "momentum_y",
    "momentum_z",
];

/// Bins of a distribution, and the width of one.
pub const BINS: usize = 120;
/// See [`BINS`].
pub const BIN: f64 = 0.05;

/// Counts since the beginning.
#[derive(Debug, Default)]
pub struct Whole {
    pub attempts: f64,
    pub collisions: f64,
    pub contacts: f64,
    pub collapses: f64,
    pub creating: f64,
    pub created: f64,
    pub steps: f64,
    pub beyond: f64,
}

impl Whole {
    /// All of them, in the order of [`GAS_WHOLE`].
    pub fn counts(&mut self) -> [&mut f64; GAS_WHOLE.len() - 2] {
        [
            &mut self.attempts,
            &mut self.collisions,
            &mut self.contacts,
            &mut self.collapses,
            &mut self.creating,
            &mut self.created,
            &mut self.steps,
            &mut self.beyond,
        ]
    }
}

/// [`GAS_KIND`] of one body.
#[inline(always)]
pub fn moments(kind: &Species<'_>, state: &FreeBody) -> [f64; GAS_KIND.len()] {
    let velocity = state.velocity;
    let ([x, y, z], turning) = rotation(kind, state);
    let square = velocity.dot(velocity);
    let cosine = |other: Vector| {
        let size = square * other.dot(other);
        let along = velocity.dot(other);
        if size > 0.0 {
            along * along / size
        } else {
            0.0
        }
    };
    let PairState { attitude, spin, .. } = state.state(kind.body);
    let axis = attitude.rotate(Vector::new(0.0, 0.0, 1.0));
    [
        square,
        square * square,
        x,
        y,
        z,
        turning * turning,
        square * turning,
        cosine(spin),
        cosine(axis),
        velocity.x,
        velocity.y,
        velocity.z,
    ]
}

/// The energies of rotation about the principal axes, and their sum over those about which contacts turn the body.
#[inline(always)]
fn rotation(kind: &Species<'_>, state: &FreeBody) -> ([f64; 3], f64) {
    let (moments, own) = (kind.body.moments(), state.spin.parts());
    let energy = |i: usize| 0.5 * moments[i] * own[i] * own[i];
    let each = [energy(0), energy(1), energy(2)];
    let turned = |i: usize| if kind.turned[i] { each[i] } else { 0.0 };
    (each, turned(0) + turned(1) + turned(2))
}

/// The bodies of a kind, each of which is asked for twice, in bins of v over its root mean square, and of (E_rot/⟨E_rot⟩)^(1/2), E_rot about the
/// axes that contacts turn.
pub fn distributions(
    kind: &Species<'_>,
    count: usize,
    state: impl Fn(usize) -> FreeBody,
) -> [[f64; BINS]; 2] {
    let squares = |i: usize| {
        let state = state(i);
        let velocity = state.velocity;
        [velocity.dot(velocity), rotation(kind, &state).1]
    };
    let mut sums = [0.0; 2];
    for both in (0..count).map(squares) {
        add_to(&mut sums, both);
    }
    let mut bins = [[0.0; BINS]; 2];
    for both in (0..count).map(squares) {
        for ((square, sum), bins) in both.into_iter().zip(sums).zip(&mut bins) {
            let place = (square * count as f64 / sum).sqrt() / BIN;
            if let Some(bin) = bins.get_mut(place as usize) {
                *bin += 1.0;
            }
        }
    }
    bins
}
