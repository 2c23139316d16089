//! A contact as a law sees it: a velocity and a compliance; and the impulse that a law answers with.

use super::{AxialCompliance, Components};
use crate::math::Vector;
use crate::simd::{Mask, Pack, one};
use pulp::{Scalar, Simd};

/// A contact, in the core's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact<T = f64, K = AxialCompliance<T>> {
    /// Velocity **v**_c of the point of contact (7), (8); `normal` ≤ 0.
    pub velocity: Components<T>,
    /// The matrix K (10).
    pub compliance: K,
}

/// The answer of a law to a contact, in the core's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response<T = f64> {
    /// Impulse **P** on the particle (10).
    pub impulse: Components<T>,
    /// Normal velocity of the point of contact after the impact, ≥ 0.
    pub separation_speed: T,
}

/// The answer of a law for any compliance, in the units of compliance and velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// Impulse **P** on the body (10).
    pub impulse: Vector,
    /// Normal velocity of the point of contact after the impact, ≥ 0.
    pub separation_speed: f64,
}

impl Contact {
    /// The contact in a single lane.
    #[inline(always)]
    pub(crate) fn in_lane(&self) -> Contact<Pack<Scalar, 1>> {
        Contact {
            velocity: self.velocity.map(one),
            compliance: self.compliance.in_lane(),
        }
    }
}

impl<S: Simd> Contact<Pack<S, 1>> {
    /// The contact in a lane.
    pub(crate) fn lane(&self, lane: usize) -> Contact {
        let at = |pack: Pack<S, 1>| pack.as_slice()[lane];
        let k = &self.compliance;
        Contact {
            velocity: self.velocity.map(at),
            compliance: AxialCompliance {
                inertia: k.inertia,
                arm_normal: at(k.arm_normal),
                arm_along: at(k.arm_along),
                ww: at(k.ww),
            },
        }
    }

    /// Puts a contact of the same body into a lane.
    #[inline(always)]
    pub(super) fn put(&mut self, lane: usize, contact: &Contact) {
        let (own, k) = (&mut self.velocity, &mut self.compliance);
        let (velocity, other) = (contact.velocity, contact.compliance);
        k.inertia = other.inertia;
        for (to, from) in [
            (&mut own.normal, velocity.normal),
            (&mut own.along, velocity.along),
            (&mut own.across, velocity.across),
            (&mut k.arm_normal, other.arm_normal),
            (&mut k.arm_along, other.arm_along),
            (&mut k.ww, other.ww),
        ] {
            to.as_mut_slice()[lane] = from;
        }
    }

    /// No contact.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = Pack::splat(simd, 0.0);
        Self {
            velocity: Components {
                normal: zero,
                along: zero,
                across: zero,
            },
            compliance: AxialCompliance {
                inertia: 1.0,
                arm_normal: zero,
                arm_along: zero,
                ww: zero,
            },
        }
    }
}

impl<S: Simd, K> Contact<Pack<S, 1>, K> {
    /// The speed of approach, −v_c^n ≥ 0.
    #[inline(always)]
    pub fn approach_speed(&self) -> Pack<S, 1> {
        self.velocity.normal.abs()
    }
}

impl<S: Simd> Response<Pack<S, 1>> {
    /// The answer to no contact.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = Pack::splat(simd, 0.0);
        Self {
            impulse: Components {
                normal: zero,
                along: zero,
                across: zero,
            },
            separation_speed: zero,
        }
    }

    /// The same answers, but those of `other` in the lanes of the mask.
    #[inline(always)]
    pub(super) fn or(self, mask: Mask<S, 1>, other: &Self) -> Self {
        let (own, others) = (self.impulse, other.impulse);
        Self {
            impulse: Components {
                normal: mask.select(others.normal, own.normal),
                along: mask.select(others.along, own.along),
                across: mask.select(others.across, own.across),
            },
            separation_speed: mask.select(other.separation_speed, self.separation_speed),
        }
    }

    /// Puts an answer into a lane.
    #[inline(always)]
    pub(crate) fn put(&mut self, lane: usize, answer: &Response) {
        let own = &mut self.impulse;
        for (to, from) in [
            (&mut own.normal, answer.impulse.normal),
            (&mut own.along, answer.impulse.along),
            (&mut own.across, answer.impulse.across),
            (&mut self.separation_speed, answer.separation_speed),
        ] {
            to.as_mut_slice()[lane] = from;
        }
    }

    /// The answer in a lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Response {
        Response {
            impulse: self.impulse.map(|component| component.as_slice()[lane]),
            separation_speed: self.separation_speed.as_slice()[lane],
        }
    }
}
