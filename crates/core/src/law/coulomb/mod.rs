//! Coulomb friction during the impact, with three hypotheses on when the impact ends.
//!
//! The independent variable is the accumulated normal impulse p (E. J. Routh, 1860; Y. Wang and M. T. Mason, J. Appl. Mech. **59**,
//! 635 (1992)). While the contact slips, the tangential impulse per normal impulse is μ, opposite to the slip velocity. Once the
//! slip velocity vanishes, the contact sticks if |K_nu| ≤ μ K_uu, and otherwise slips in the direction in which K_nu drives it. In
//! both cases dP_u/dp = −K_nu/K_uu, limited to ±μ. In planar motion the contact velocity is therefore linear in p on either side
//! of the impulse p_s at which the slip velocity vanishes.

mod phases;
mod planar;
mod slipping;
mod turning;

use super::{Compliant, Contact, Creation, ImpulseRule, LawKind, Response, Slip};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::math::Vectors;
use crate::simd::Pack;
use pulp::Simd;
pub(super) use turning::Turning;

/// The condition that ends the phase of restitution, after that of compression. The three hypotheses agree as long as the slip
/// velocity neither vanishes nor changes its direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hypothesis {
    /// W. J. Stronge, Proc. R. Soc. Lond. A **431**, 169 (1990): the normal force returns the fraction ε_n² of the work that was
    /// done against it in the compression. The energy cannot grow, because friction dissipates as well.
    Stronge,
    /// S. D. Poisson: the normal impulse of restitution is ε_n times that of compression. The normal force may return more work
    /// than was done against it, but no more than friction dissipates: with T the kinetic energy and **s** the slip velocity,
    /// dT/dp = v_c^n − μ|**s**| ≤ 0 at the end of the compression. Its derivative, **q**ᵀK**q** with **q** = d**P**/dp, never
    /// increases with p, so that the gain of T after that point cannot exceed the loss before it.
    Poisson,
    /// I. Newton: v_c^n′ = −ε_n v_c^n. The energy can grow where the slip stops or reverses.
    Newton,
}

impl Hypothesis {
    /// All hypotheses with their names.
    pub const NAMED: [(&'static str, Self); 3] = [
        ("stronge", Self::Stronge),
        ("poisson", Self::Poisson),
        ("newton", Self::Newton),
    ];

    /// The hypothesis with this name.
    ///
    /// # Errors
    /// [`Error::Parameter`] for an unknown name.
    pub fn named(name: &str) -> Result<Self, Error> {
        Error::chosen("hypothesis", name, &Self::NAMED)
    }
}

/// Coulomb friction with coefficient μ.
///
/// The impulse lies within the friction cone |P_t| ≤ μ P_n, and friction always dissipates. Without friction (μ = 0) the law is
/// [`super::Frictionless`] under each hypothesis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coulomb {
    friction: f64,
    hypothesis: Hypothesis,
}

impl Coulomb {
    /// Its entry in the table of laws.
    pub(crate) const KIND: LawKind = LawKind {
        kind: Kind {
            name: "Coulomb",
            text: "dry friction, with slip that may stop, turn or reverse",
            parameters: &[
                FRICTION,
                Parameter::new(
                    "hypothesis",
                    "the condition that ends the impact",
                    None,
                    Allowed::Name(&["stronge", "poisson", "newton"]),
                    Argument::Name("stronge"),
                )
                .or(Argument::Name("stronge")),
            ],
            make: |given| {
                let hypothesis = Hypothesis::named(given.name(1))?;
                Ok(Self::new(given.number(0), hypothesis)?.into())
            },
        },
        creates_energy: Creation::Where("hypothesis", "newton"),
        from_rest: Some([Slip::Stuck, Slip::Sliding]),
    };

    /// The law with the coefficient of friction μ and a hypothesis.
    ///
    /// # Errors
    /// [`Error::Parameter`] for μ outside [0, 10¹⁰⁰].
    pub fn new(friction: f64, hypothesis: Hypothesis) -> Result<Self, Error> {
        check_friction(friction)?;
        Ok(Self {
            friction,
            hypothesis,
        })
    }

    /// True if a slip in space may turn; some contacts then take much longer than others, so that [`Turning`] lets them share the lanes.
    #[inline(always)]
    pub(super) fn turns(&self) -> bool {
        self.friction > 0.0
    }
}

impl ImpulseRule for Coulomb {
    /// Where K is that of a body of revolution it does not slip along **w**.
    #[inline(always)]
    fn respond<S: Simd, const SPACE: bool>(
        &self,
        contact: &Contact<Pack<S>, impl Compliant<S> + Sliding<S>>,
        restitution: Pack<S>,
    ) -> Response<Pack<S>> {
        contact
            .compliance
            .slide(self, contact.velocity, restitution)
    }
}

/// Coulomb friction with one kind of K: where that separates, the slip follows a line; in general it turns.
pub(super) trait Sliding<S: Simd> {
    /// The response to a contact with this velocity in each lane.
    fn slide(
        &self,
        rule: &Coulomb,
        velocity: Vectors<S>,
        restitution: Pack<S>,
    ) -> Response<Pack<S>>;
}

/// Largest μ; beyond it products of μ could overflow, and every contact sticks long before.
pub const MOST_FRICTION: f64 = 1e100;

/// μ among the parameters of a law.
pub(super) const FRICTION: Parameter = Parameter::number(
    "friction",
    "coefficient of friction",
    "1",
    Interval::from(0.0, MOST_FRICTION),
    0.3,
);

pub(super) fn check_friction(friction: f64) -> Result<(), Error> {
    let holds = (0.0..=MOST_FRICTION).contains(&friction);
    Error::unless(holds, "friction", friction, "in [0, 1e100]")
}
