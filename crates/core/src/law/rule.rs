//! The choice of a law.

use super::{
    Answer, Compliance, Components, Contact, CustomLaw, Frictionless, ImpulseFunction, Material,
    Normal, Response, Rule, normal::scattered, tangential::Steady,
};
use crate::Error;
use crate::Fault;
use crate::describe::Kind;
use crate::math::Vector;
use crate::simd::{Pack, one};
use pulp::{Scalar, Simd, WithSimd};

/// A collision law: a normal coefficient, which may borrow a table and may scatter, and a rule for the impulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law<'a> {
    /// The normal coefficient ε_n.
    pub normal: Normal<'a>,
    /// The standard deviation with which ε_n scatters before truncation to [0, 1]; 0 if it does not.
    pub deviation: f64,
    /// The impulse that follows from a contact and ε_n.
    pub rule: Rule,
    /// A law of one's own, which takes the place of coefficient and rule.
    pub custom: Option<CustomLaw<'a>>,
}

/// A law in the table of laws.
#[derive(Debug, Clone, Copy)]
pub struct LawKind {
    /// Its description, whose parameters come after the normal coefficient, which all laws have.
    pub kind: Kind<Rule>,
    /// The possibility that it creates kinetic energy.
    pub creates_energy: Creation,
    /// Slip in an impact from rest within the friction cone, and beyond it; none where that has no closed form.
    pub from_rest: Option<[Slip; 2]>,
}

/// The possibility that a law creates kinetic energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Creation {
    /// It cannot.
    Never,
    /// It can.
    Possible,
    /// It can where the parameter has this value.
    Where(&'static str, &'static str),
}

/// Slip during an impact from rest, before which the contact does not slip. Each is a closed form of the first impact,
/// in `analytic/_impulse.py` of the Python package.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slip {
    /// It slips freely, for nothing acts along the plane.
    Free,
    /// It sticks.
    Stuck,
    /// It slips with friction at its limit, μ times the normal force.
    Sliding,
    /// The tangential impulse is (1 + e_t) times that of a sticking plastic impact.
    Part,
}

/// Makes the rule that is one of these laws, and the table of them.
macro_rules! laws {
    ($($(#[$text:meta])* $law:ident),* $(,)?) => {
        /// The rule by which the impulse follows from a contact and a normal coefficient.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum Rule {
            $($(#[$text])* $law($law)),*
        }

        /// Every law.
        pub const LAWS: &[LawKind] = &[$($law::KIND),*];

        impl Rule {
            /// The response to a contact in each lane.
            #[inline(always)]
            fn respond<S: Simd, const SPACE: bool>(
                &self,
                contact: &Contact<Pack<S, 1>, impl Compliant<S> + Sliding<S>>,
                normal: Pack<S, 1>,
            ) -> Response<Pack<S, 1>> {
                match self {
                    $(Self::$law(law) => law.respond::<S, SPACE>(contact, normal)),*
                }
            }
        }

        $(impl From<$law> for Rule {
            fn from(law: $law) -> Self {
                Self::$law(law)
            }
        })*
    };
}
pub(super) use laws;

impl<'a> Law<'a> {
    /// The law with ε_n, a constant in [0, 1] or a function of the normal contact speed, and a rule.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a constant ε_n outside [0, 1].
    pub fn new(normal: impl Into<Normal<'a>>, rule: impl Into<Rule>) -> Result<Self, Error> {
        Ok(Self {
            normal: normal.into().checked()?,
            deviation: 0.0,
            rule: rule.into(),
            custom: None,
        })
    }

    /// The law that asks a function.
    pub fn custom(function: &'a dyn ImpulseFunction) -> Self {
        Self {
            normal: Normal::Constant(1.0),
            deviation: 0.0,
            rule: Frictionless.into(),
            custom: Some(CustomLaw::new(function)),
        }
    }

    /// The same law for contacts in multiples of these units, in m/s and kg, instead of SI units.
    pub fn scaled(&self, speed: f64, mass: f64) -> Self {
        Self {
            normal: self.normal.scaled(speed),
            custom: self.custom.map(|law| law.scaled(speed, mass)),
            ..*self
        }
    }

    /// The law of a material with this rule.
    pub fn of(material: &'a Material, rule: Rule) -> Self {
        Self {
            normal: material.normal(),
            deviation: material.deviation(),
            rule,
            custom: None,
        }
    }

    /// The impulse of a contact, and its normal velocity after the impact, with ε_n as it is where it does not scatter. A law of one's
    /// own is not asked, but [`Law::answer`].
    pub fn respond(&self, contact: &Contact) -> Response {
        let mut found = [Response::none(Scalar::new())];
        let steady = Self {
            deviation: 0.0,
            ..*self
        };
        steady.respond_all::<_, true>(&[contact.in_lane()], &[], &mut found);
        found[0].lane(0)
    }

    /// The impulse for any compliance, of a contact that arrives with this velocity in the frame whose z axis is the normal, z ≤ 0;
    /// ε_n as in [`Self::respond`].
    ///
    /// # Errors
    /// [`Fault`] if a law of one's own gives no impulse that is possible.
    pub fn answer(&self, compliance: &Compliance, velocity: Vector) -> Result<Answer, Fault> {
        self.answer_drawn(compliance, velocity, None)
    }

    /// The same, and where ε_n scatters with a uniform number in (0, 1).
    #[inline(always)]
    pub(crate) fn answer_drawn(
        &self,
        compliance: &Compliance,
        velocity: Vector,
        chance: Option<f64>,
    ) -> Result<Answer, Fault> {
        // One that leaves only touches.
        let velocity = Vector::new(velocity.x, velocity.y, velocity.z.min(0.0));
        if let Some(law) = &self.custom {
            return law.answer(compliance, velocity);
        }
        let contact = Contact {
            velocity: Components::in_lane(velocity),
            compliance: *compliance,
        };
        let normal = one(self.normal.at(velocity.z.abs()));
        let normal = match chance {
            Some(chance) => scattered(normal, self.deviation, one(chance)),
            None => normal,
        };
        let response = self.rule.respond::<_, true>(&contact, normal);
        Ok(Answer {
            impulse: response.impulse.in_axes(),
            separation_speed: response.separation_speed.as_slice()[0],
        })
    }

    /// The law as [`Steady`], if it is the paper's with the same ε_n for all impacts.
    pub(crate) fn steady(&self) -> Option<Steady> {
        match (self.rule, self.normal) {
            (Rule::TangentialRestitution(rule), Normal::Constant(normal)) if !self.scatters() => {
                Some(Steady { normal, rule })
            }
            _ => None,
        }
    }
}

/// Largest number of vectors of contacts that a law is given at once.
pub(crate) const MOST_CONTACTS: usize = 6;

/// A law in the form that the bounce loop uses: it answers all contacts at once, so that those that take long can share the lanes.
pub(crate) trait Respond {
    /// Returns whether ε_n scatters.
    fn scatters(&self) -> bool;

    /// Answers up to [`MOST_CONTACTS`] vectors of contacts; `chances` has a uniform number in (0, 1) for each if ε_n scatters. Without
    /// `SPACE` no contact velocity has a component along **w**.
    fn respond_all<S: Simd, const SPACE: bool>(
        &self,
        contacts: &[Contact<Pack<S, 1>>],
        chances: &[Pack<S, 1>],
        responses: &mut [Response<Pack<S, 1>>],
    );

    /// The law of one's own that is to be asked instead, if this is one.
    #[inline(always)]
    fn custom(&self) -> Option<CustomLaw<'_>> {
        None
    }
}

impl Respond for Law<'_> {
    #[inline(always)]
    fn scatters(&self) -> bool {
        self.deviation > 0.0
    }

    /// Chooses the law in a function of its own: inlined, all laws together would use up the registers of the bounce loop.
    #[inline(always)]
    fn respond_all<S: Simd, const SPACE: bool>(
        &self,
        contacts: &[Contact<Pack<S, 1>>],
        chances: &[Pack<S, 1>],
        responses: &mut [Response<Pack<S, 1>>],
    ) {
        let Some(first) = contacts.first() else {
            return;
        };
        first.velocity.normal.simd().vectorize(Choice::<S, SPACE> {
            law: self,
            contacts,
            chances,
            responses,
        });
    }

    #[inline(always)]
    fn custom(&self) -> Option<CustomLaw<'_>> {
        self.custom
    }
}

/// A law and the contacts that it is applied to, compiled for each SIMD level.
struct Choice<'a, 'b, S: Simd, const SPACE: bool> {
    law: &'a Law<'b>,
    contacts: &'a [Contact<Pack<S, 1>>],
    chances: &'a [Pack<S, 1>],
    responses: &'a mut [Response<Pack<S, 1>>],
}

impl<S: Simd, const SPACE: bool> WithSimd for Choice<'_, '_, S, SPACE> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: Simd>(self, _: T) {
        let Self {
            law,
            contacts,
            chances,
            responses,
        } = self;
        let coefficient = |i: usize, contact: &Contact<Pack<S, 1>>| {
            let normal = law.normal.in_lanes(contact.approach_speed());
            if law.scatters() {
                scattered(normal, law.deviation, chances[i])
            } else {
                normal
            }
        };
        if let (true, Rule::Coulomb(rule)) = (SPACE, &law.rule)
            && rule.takes_long()
        {
            let simd = contacts[0].velocity.normal.simd();
            let mut normal = [Pack::splat(simd, 0.0); MOST_CONTACTS];
            for (i, contact) in contacts.iter().enumerate() {
                normal[i] = coefficient(i, contact);
            }
            rule.respond_in_space(contacts, &normal, responses);
            return;
        }
        for (i, (contact, response)) in contacts.iter().zip(responses).enumerate() {
            *response = law
                .rule
                .respond::<S, SPACE>(contact, coefficient(i, contact));
        }
    }
}
