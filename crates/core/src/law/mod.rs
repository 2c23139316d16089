//! The impulse of an impact, (9), (10). A law is a function of the contact velocity, of the matrix K, the compliance of the contact,
//! and, where its normal coefficient scatters, of one number drawn for seed, particle and impact. It knows nothing else of the body.
//!
//! For a body of revolution K separates in the frame of **n**, of **u**, the horizontal direction of the axis, and of
//! **w** = **n** × **u**, into a 2×2 block {**n**, **u**} and a single entry for **w**. Each formula is written once, for a contact in
//! each lane and, through `Compliant`, for either K; terms along **w** are omitted where all motion is in the plane of **n** and **u**.

mod axial;
mod chatterjee_ruina;
mod compliance;
mod contact;
mod coulomb;
mod custom;
mod frictionless;
mod kind;
mod normal;
mod rule;
mod tangential;

pub use axial::AxialCompliance;
pub use chatterjee_ruina::ChatterjeeRuina;
pub use compliance::Compliance;
pub use contact::{Contact, Response};
pub use coulomb::{Coulomb, Hypothesis, MOST_FRICTION};
pub use custom::{CustomLaw, ImpulseFunction};
pub use frictionless::Frictionless;
pub use kind::{Creation, LawKind, Slip};
pub(crate) use kind::{MOST_CONTACTS, Respond};
pub use normal::*;
pub use rule::Law;
pub use tangential::TangentialRestitution;

use crate::math::Vectors;
use crate::simd::Pack;
use coulomb::Sliding;
use pulp::Simd;

/// The matrix K of the contact in each lane: that of a body of revolution, or of any body.
trait Compliant<S: Simd> {
    /// K_nn.
    fn nn(&self) -> Pack<S>;

    /// The components of the contact velocity along **u** and **w** after an impulse along **n**.
    fn pushed(&self, normal: Pack<S>, velocity: &Vectors<S>) -> [Pack<S>; 2];

    /// The impulse that changes the contact velocity by `change`: K P = Δ**v**_c (10). Without `SPACE` nothing happens along **w**.
    fn impulse<const SPACE: bool>(&self, change: Vectors<S>) -> Vectors<S>;
}

/// A rule, as a law applies it.
trait ImpulseRule {
    /// The response to a contact in each lane. Without `SPACE` nothing happens along **w**.
    fn respond<S: Simd, const SPACE: bool>(
        &self,
        contact: &Contact<Pack<S>, impl Compliant<S> + Sliding<S>>,
        normal: Pack<S>,
    ) -> Response<Pack<S>>;
}

rule::laws! {
    /// The paper's law (9).
    TangentialRestitution,
    /// An impulse along the plane normal only.
    Frictionless,
    /// Coulomb friction.
    Coulomb,
    /// The law of Chatterjee and Ruina, within the friction cone.
    ChatterjeeRuina,
}
