//! A contact as a law sees it: a velocity and a compliance; and the impulse that a law answers with.

use super::AxialCompliance;
use crate::math::Vector;
use crate::simd::{Lanewise, Pack, lanewise};
use pulp::Simd;

/// A contact. The z axis of its frame is **n**; for a body of revolution x is along **u**, the horizontal direction of the symmetry axis,
/// and y along **w** = **n** × **u**.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact<T = f64, K = AxialCompliance<T>> {
    /// Velocity **v**_c of the point of contact (7), (8); z ≤ 0.
    pub velocity: Vector<T>,
    /// The matrix K (10).
    pub compliance: K,
}

/// The answer of a law to a contact, in the frame of the contact and in the units of its compliance and velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response<T = f64> {
    /// Impulse **P** on the body (10).
    pub impulse: Vector<T>,
    /// Normal velocity of the point of contact after the impact, ≥ 0.
    pub separation_speed: T,
}

impl<T: Copy> Contact<T> {
    /// The same function of every number.
    #[inline(always)]
    pub(crate) fn map<U>(&self, f: impl Fn(T) -> U) -> Contact<U> {
        Contact {
            velocity: self.velocity.map(&f),
            compliance: self.compliance.map(f),
        }
    }
}

impl<S: Simd> Contact<Pack<S>> {
    /// The contact in a lane.
    pub(crate) fn lane(&self, lane: usize) -> Contact {
        self.map(|number| number.as_slice()[lane])
    }

    /// Puts a contact of the same body into a lane.
    #[inline(always)]
    pub(super) fn put(&mut self, lane: usize, contact: &Contact) {
        let (k, other) = (&mut self.compliance, &contact.compliance);
        self.velocity.put(lane, contact.velocity);
        k.inertia = other.inertia;
        k.arm_normal.as_mut_slice()[lane] = other.arm_normal;
        k.arm_along.as_mut_slice()[lane] = other.arm_along;
        k.ww.as_mut_slice()[lane] = other.ww;
    }

    /// No contact.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = Pack::none(simd);
        Self {
            velocity: Vector::none(simd),
            compliance: AxialCompliance {
                inertia: 1.0,
                arm_normal: zero,
                arm_along: zero,
                ww: zero,
            },
        }
    }
}

impl<S: Simd, K> Contact<Pack<S>, K> {
    /// The speed of approach, −v_c^n ≥ 0.
    #[inline(always)]
    pub fn approach_speed(&self) -> Pack<S> {
        self.velocity.z.abs()
    }
}

lanewise! { Response<Pack<S>> { impulse, separation_speed } }

impl<S: Simd> Response<Pack<S>> {
    /// Puts an answer into a lane.
    #[inline(always)]
    pub(crate) fn put(&mut self, lane: usize, answer: &Response) {
        self.impulse.put(lane, answer.impulse);
        self.separation_speed.as_mut_slice()[lane] = answer.separation_speed;
    }

    /// The answer in a lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Response {
        Response {
            impulse: self.impulse.lane(lane),
            separation_speed: self.separation_speed.as_slice()[lane],
        }
    }
}
