//! The laws for a contact whose matrix K may be any: of bodies without an axis of symmetry, of two bodies, of rough surfaces. One
//! contact at a time, in the frame whose z axis is the normal.

use super::{Compliance, Law, Rule};
use crate::math::Vector;

/// Impulse on the body, and what is left of the velocity along the normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// The impulse **P**.
    pub impulse: Vector,
    /// Normal velocity of the point of contact after the impact, ≥ 0.
    pub separation_speed: f64,
}

impl Law<'_> {
    /// The impulse of a contact with any compliance that arrives with this velocity, z ≤ 0.
    pub fn answer(&self, compliance: &Compliance, velocity: Vector) -> Answer {
        let approach = (-velocity.z).max(0.0);
        let restitution = self.normal.at(approach);
        let rebound = restitution * approach;
        let frictionless = Vector::new(0.0, 0.0, (approach + rebound) / compliance.normal());
        let impulse = match &self.rule {
            Rule::Frictionless(_) => frictionless,
            Rule::TangentialRestitution(rule) => {
                let kept = rule.tangential - 1.0;
                let change = Vector::new(kept * velocity.x, kept * velocity.y, approach + rebound);
                compliance.impulse(change)
            }
            Rule::ChatterjeeRuina(rule) => {
                // P_II − P_I leaves the normal velocity alone and stops the slip that P_I leaves behind.
                let k = compliance.entries();
                let plastic = approach / k.zz;
                let left = Vector::new(
                    velocity.x + k.xz * plastic,
                    velocity.y + k.yz * plastic,
                    0.0,
                );
                let stop = compliance.impulse(left * -1.0);
                let most = rule.friction * frictionless.z;
                let excess = length(stop.x, stop.y) - rule.friction * stop.z;
                let wanted = 1.0 + rule.tangential;
                let share = if most < excess * wanted {
                    most / excess
                } else {
                    wanted
                };
                frictionless + stop * share
            }
            Rule::Coulomb(rule) if rule.friction() == 0.0 => frictionless,
            Rule::Coulomb(rule) => return rule.answer(compliance, velocity, restitution),
        };
        Answer {
            impulse,
            separation_speed: rebound,
        }
    }
}

/// √(a² + b²), also where the squares would underflow.
fn length(a: f64, b: f64) -> f64 {
    let (a, b) = (a.abs(), b.abs());
    let (most, least) = (a.max(b), a.min(b));
    if least == 0.0 {
        return most;
    }
    let ratio = least / most;
    most * (1.0 + ratio * ratio).sqrt()
}
