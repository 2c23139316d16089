//! The impulse of an impact, (9), (10). A law is a function of the contact velocity, of the matrix K, the compliance of the contact,
//! and, where its normal coefficient scatters, of one number drawn for seed, particle and impact. It knows nothing else of the body.
//!
//! For a body of revolution K separates in the frame of **n**, of **u**, the horizontal direction of the axis, and of
//! **w** = **n** × **u**, into a 2×2 block {**n**, **u**} and a single entry for **w**. Each formula is written once, for a contact in
//! each lane and, through `compliant`, for either K; terms along **w** are omitted where all motion is in the plane of **n** and **u**.

mod axial;
mod chatterjee_ruina;
mod compliance;
mod compliant;
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
use compliant::Compliant;
pub use compliant::Components;
pub use contact::{Answer, Contact, Response};
pub use coulomb::{Coulomb, Hypothesis, MOST_FRICTION};
pub use custom::{CustomLaw, ImpulseFunction};
pub use frictionless::Frictionless;
pub use kind::{Creation, LawKind, Slip};
pub(crate) use kind::{MOST_CONTACTS, Respond};
pub use normal::*;
pub use rule::Law;
pub use tangential::TangentialRestitution;

use crate::simd::Pack;
use coulomb::Sliding;
use pulp::Simd;

/// A rule, as a law applies it.
trait ImpulseRule {
    /// The response to a contact in each lane. Without `SPACE` nothing happens along **w**.
    fn respond<S: Simd, const SPACE: bool>(
        &self,
        contact: &Contact<Pack<S, 1>, impl Compliant<S> + Sliding<S>>,
        normal: Pack<S, 1>,
    ) -> Response<Pack<S, 1>>;
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
