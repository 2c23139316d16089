//! WHAT: the change of motion at an impact, (6)–(11), in a vertical plane.

use super::Pack;
use super::flight::State;
use crate::body::Body;
use crate::collision::TangentialRestitution;
use pulp::Simd;

/// The state after the impact of `sphere` (±1), and the speed at which the point of contact leaves the plane.
#[inline(always)]
pub(super) fn collide<S: Simd, const K: usize>(
    body: &Body,
    law: &TangentialRestitution,
    before: &State<S, K>,
    sphere: Pack<S, K>,
) -> (State<S, K>, Pack<S, K>) {
    let j = body.transverse;
    let side = sphere * body.half_separation;
    let arm_x = before.sine * side; // r_c (6)
    let arm_z = before.cosine.mul_add(side, -1.0); // r_c (6)
    let slip_x = before.glide + before.spin * arm_z; // v_c (7)
    let slip_z = (before.climb - before.spin * arm_x).min(0.0); // v_c (7)

    let change_z = -(1.0 + law.normal()) * slip_z; // (9), (10)
    let change_x = (law.tangential() - 1.0) * slip_x; // (9), (10)
    let zz = arm_z.mul_add(arm_z, j);
    let inverse = 1.0 / arm_x.mul_add(arm_x, zz);
    let cross = arm_z * arm_x;
    let impulse_z = zz.mul_add(change_z, cross * change_x) * inverse; // (14)
    let impulse_x = arm_x.mul_add(arm_x, j).mul_add(change_x, cross * change_z) * inverse; // (14)

    let torque = arm_z.mul_add(impulse_x, -(arm_x * impulse_z));
    let after = State {
        glide: before.glide + impulse_x,            // (11)
        climb: before.climb + impulse_z,            // (11)
        spin: torque.mul_add(1.0 / j, before.spin), // (11)
        ..*before
    };
    (after, -law.normal() * slip_z) // (9)
}
