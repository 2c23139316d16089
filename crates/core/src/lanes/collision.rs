//! WHAT: the change of motion at an impact, (6)–(11), in a vertical plane.

use super::Pack;
use super::flight::State;
use crate::body::Body;
use crate::collision::{InPlane, Plane};
use pulp::Simd;

/// The state after the impact of `sphere` (±1), and the speed at which the point of contact leaves the plane.
#[inline(always)]
pub(super) fn collide<S: Simd, const K: usize>(
    body: &Body,
    law: &impl InPlane,
    before: &State<S, K>,
    sphere: Pack<S, K>,
) -> (State<S, K>, Pack<S, K>) {
    let j = body.transverse;
    let side = sphere * body.half_separation;
    let arm_x = before.sine * side; // r_c (6)
    let arm_z = before.cosine.mul_add(side, -1.0); // r_c (6)
    let rebound = law.in_plane(&Plane {
        slip_normal: (before.climb - before.spin * arm_x).min(0.0), // v_c (7)
        slip_along: before.glide + before.spin * arm_z,             // v_c (7)
        inertia: j,
        arm_normal: arm_z,
        arm_along: arm_x,
    });
    let torque = arm_z.mul_add(rebound.along, -(arm_x * rebound.normal));
    let after = State {
        glide: before.glide + rebound.along,        // (11)
        climb: before.climb + rebound.normal,       // (11)
        spin: torque.mul_add(1.0 / j, before.spin), // (11)
        ..*before
    };
    (after, rebound.separation_speed)
}
