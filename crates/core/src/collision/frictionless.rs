//! The law without friction: P ∥ **n**.

use super::{Contacts, Normal, Responses};
use crate::Error;
use pulp::Simd;

/// An impulse along the plane normal alone: P_n = (1 + ε_n)|v_c^n|/K_nn, so that v_c^n′ = −ε_n v_c^n.
///
/// It conserves the horizontal velocity of the centre of mass and the angular momentum about **n**. The energy falls by
/// (1 − ε_n²)(v_c^n)²/(2 K_nn): it cannot grow. The hypotheses of Newton, Poisson and Stronge are one here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frictionless<'a> {
    pub(super) normal: Normal<'a>,
}

impl<'a> Frictionless<'a> {
    /// ε_n in [0, 1] or a function of the normal contact speed.
    pub fn new(normal: impl Into<Normal<'a>>) -> Result<Self, Error> {
        Ok(Self {
            normal: normal.into().checked()?,
        })
    }

    #[inline(always)]
    pub(super) fn respond<S: Simd, const K: usize, const SPACE: bool>(
        &self,
        contact: &Contacts<S, K>,
    ) -> Responses<S, K> {
        let speed = contact.approach_speed();
        let restitution = self.normal.in_lanes(speed);
        Responses {
            normal: restitution.mul_add(speed, speed) / contact.normal_response(),
            along: speed * 0.0,
            across: speed * 0.0,
            separation_speed: restitution * speed,
        }
    }
}
