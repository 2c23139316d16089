//! A law of one's own: a function that is asked for the impulse of one contact at a time.

use super::{AxialCompliance, Compliance, Compliant, Contact, Response};
use crate::Fault;
use crate::math::flat::{rotate, rotate_back};
use crate::math::{Symmetric, Vector};
use crate::simd::one;
use std::fmt;

/// The impulse of a contact in SI units.
pub trait ImpulseFunction: Sync {
    /// Its name in errors.
    fn name(&self) -> &str;

    /// True if an impulse that pulls counts as given; otherwise it ends the run.
    fn may_pull(&self) -> bool;

    /// The impulse in N s on the body, for K in 1/kg and the velocity of the point of contact in m/s. The z axis is the plane normal, x
    /// descends the slope.
    ///
    /// # Errors
    /// [`Fault::Raised`] or [`Fault::NoVector`], which end the run.
    fn impulse(&self, compliance: [[f64; 3]; 3], velocity: Vector) -> Result<Vector, Fault>;
}

/// Share of the largest term by which a sum of a few may be wrong because of rounding, also in the function's own arithmetic.
const ROUNDING: f64 = 1.0 / 1_099_511_627_776.0; // 2⁻⁴⁰

/// A law that asks an [`ImpulseFunction`], with the units in which contacts are given.
#[derive(Clone, Copy)]
pub struct CustomLaw<'a> {
    function: &'a dyn ImpulseFunction,
    /// The units of mass and speed, in kg and m/s.
    mass: f64,
    speed: f64,
}

impl fmt::Debug for CustomLaw<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("CustomLaw")
    }
}

/// The same function.
impl PartialEq for CustomLaw<'_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::addr_eq(self.function, other.function)
            && (self.mass, self.speed) == (other.mass, other.speed)
    }
}

impl<'a> CustomLaw<'a> {
    /// The law of a function, for contacts in SI units.
    pub fn new(function: &'a dyn ImpulseFunction) -> Self {
        Self {
            function,
            mass: 1.0,
            speed: 1.0,
        }
    }

    /// Its name in errors.
    pub(crate) fn name(&self) -> &'a str {
        self.function.name()
    }

    /// The same for contacts in multiples of other units, in m/s and kg.
    pub(super) fn scaled(&self, speed: f64, mass: f64) -> Self {
        Self {
            speed: self.speed * speed,
            mass: self.mass * mass,
            ..*self
        }
    }

    /// The impulse of a contact with velocity **v**_c, in the frame whose z axis is the normal, z ≤ 0.
    pub(super) fn answer(
        &self,
        compliance: &Compliance,
        velocity: Vector,
    ) -> Result<Response, Fault> {
        let k = compliance.entries();
        let in_units = k.rows().map(|row| row.map(|entry| entry / self.mass));
        let given = self.function.impulse(in_units, velocity * self.speed)?;
        let impulse = given / (self.mass * self.speed);
        if !impulse.norm().is_finite() {
            return Err(Fault::NotFinite(given.parts()));
        }
        let terms = [
            velocity.z,
            k.xz * impulse.x,
            k.yz * impulse.y,
            k.zz * impulse.z,
        ];
        let rounding = ROUNDING
            * terms
                .iter()
                .fold(0.0_f64, |most, term| most.max(term.abs()));
        if terms[3] < -rounding && !self.function.may_pull() {
            return Err(Fault::Pulls(given.parts()));
        }
        let separation: f64 = terms.iter().sum();
        if separation < -rounding {
            return Err(Fault::Approaches(given.parts(), -separation * self.speed));
        }
        Ok(Response {
            impulse,
            separation_speed: separation.max(0.0),
        })
    }

    /// The answer to a contact of a body of revolution whose **u** has these components along x and y.
    pub(crate) fn respond(&self, contact: &Contact, u: [f64; 2]) -> Result<Response, Fault> {
        let mut velocity = contact.velocity;
        [velocity.x, velocity.y] = rotate_back(u, [velocity.x, velocity.y]);
        let mut answer = self.answer(&contact.compliance.turned(u), velocity)?;
        let impulse = &mut answer.impulse;
        [impulse.x, impulse.y] = rotate(u, [impulse.x, impulse.y]);
        Ok(answer)
    }
}

impl AxialCompliance {
    /// The full matrix, where **u** has these components along x and y.
    fn turned(&self, [x, y]: [f64; 2]) -> Compliance {
        let k = self.map(one);
        let [nn, uu, nu, ww] = [k.nn(), k.uu(), k.nu(), k.ww].map(|entry| entry.as_slice()[0]);
        Compliance(Symmetric {
            xx: uu * x * x + ww * y * y,
            yy: uu * y * y + ww * x * x,
            zz: nn,
            xy: (uu - ww) * x * y,
            xz: nu * x,
            yz: nu * y,
        })
    }
}
