//! The impact of a body: the contact that a law is applied to, (6)–(8), and the motion afterwards, (11).

use super::interleaved::GROUPS;
use crate::law::{AxialCompliance, Contact, Response};
use crate::math::{Vector, Vectors};
use crate::motion::{
    Flight, PlanarMotion, PlanarState, SpatialFlight, SpatialMotion, SpatialState, SymmetricState,
};
use crate::shape::{Body, Hull, HullPart};
use crate::simd::{Lanewise, Pack, lanewise};
use pulp::Simd;

/// Planar or spatial motion.
pub(crate) trait Dimension: Copy {
    /// The flight of as many particles as there are lanes.
    type Flight<S: Simd>: Flight<S, State: Collide<S>>;
    /// True if a contact may slip across the plane of the axis.
    const SPACE: bool;
}

/// Motion in a vertical plane.
#[derive(Clone, Copy)]
pub(crate) struct Planar;

/// Motion in three dimensions.
#[derive(Clone, Copy)]
pub(crate) struct Spatial;

impl Dimension for Planar {
    type Flight<S: Simd> = PlanarState<S>;
    const SPACE: bool = false;
}

impl Dimension for Spatial {
    type Flight<S: Simd> = SpatialFlight<S>;
    const SPACE: bool = true;
}

/// The sphere that touches like the hull at the contact: its lever s and its radius ϱ.
#[derive(Clone, Copy)]
pub(crate) struct ContactPoint<S: Simd> {
    pub lever: Pack<S>,
    pub radius: Pack<S>,
}

lanewise! { ContactPoint<S> { lever, radius } }

impl<S: Simd> ContactPoint<S> {
    /// That of a part of a hull at this e_z.
    #[inline(always)]
    pub fn of(hull: &impl Hull, part: &HullPart<S>, cos_tilt: Pack<S>) -> Self {
        Self {
            lever: hull.lever(part, cos_tilt),
            radius: hull.radius(part, cos_tilt),
        }
    }
}

/// The impacts of all groups: where each body touches, what a law is asked, the numbers that a coefficient which scatters is drawn with,
/// and what the law answers.
pub(crate) struct Collisions<S: Simd> {
    pub points: [ContactPoint<S>; GROUPS],
    pub contacts: [Contact<Pack<S>>; GROUPS],
    pub chances: [Pack<S>; GROUPS],
    pub responses: [Response<Pack<S>>; GROUPS],
}

impl<S: Simd> Collisions<S> {
    /// Before the first impact.
    pub fn none(simd: S) -> Self {
        Self {
            points: [ContactPoint::none(simd); GROUPS],
            contacts: [Contact::none(simd); GROUPS],
            chances: [Pack::splat(simd, 0.5); GROUPS],
            responses: [Response::none(simd); GROUPS],
        }
    }
}

/// A state to which an impact can be applied.
pub(crate) trait Collide<S: Simd>: SymmetricState<S> {
    /// The contact of the part of the hull that touches.
    fn contact(&self, body: &Body, point: ContactPoint<S>) -> Contact<Pack<S>>;

    /// **u** along x and y.
    fn along(&self, point: ContactPoint<S>) -> [Pack<S>; 2];

    /// The motion after the impact.
    fn after(
        &self,
        body: &Body,
        point: ContactPoint<S>,
        response: &Response<Pack<S>>,
    ) -> Self::Motion;
}

/// **r**_c (6) in the plane of the axis, along x and z.
#[inline(always)]
fn planar_arm<S: Simd>(
    state: &PlanarState<S>,
    ContactPoint { lever, radius }: ContactPoint<S>,
) -> [Pack<S>; 2] {
    [state.sine * lever, state.cosine.mul_add(lever, -radius)]
}

impl<S: Simd> Collide<S> for PlanarState<S> {
    #[inline(always)]
    fn contact(&self, body: &Body, point: ContactPoint<S>) -> Contact<Pack<S>> {
        let PlanarMotion { vx, vz, spin } = self.motion;
        let [arm_x, arm_z] = planar_arm(self, point);
        let zero = Pack::splat(vx.simd(), 0.0);
        Contact {
            velocity: Vector {
                x: vx + spin * arm_z, // (7)
                y: zero,
                z: (vz - spin * arm_x).min(0.0), // (7); at a grazing contact it may have changed sign within the last step
            },
            compliance: AxialCompliance {
                inertia: body.transverse,
                arm_normal: arm_z,
                arm_along: arm_x,
                ww: zero,
            },
        }
    }

    fn along(&self, _: ContactPoint<S>) -> [Pack<S>; 2] {
        [1.0, 0.0].map(|part| Pack::splat(self.sine.simd(), part))
    }

    #[inline(always)]
    fn after(
        &self,
        body: &Body,
        point: ContactPoint<S>,
        response: &Response<Pack<S>>,
    ) -> PlanarMotion<S> {
        let PlanarMotion { vx, vz, spin } = self.motion;
        let [arm_x, arm_z] = planar_arm(self, point);
        let impulse = &response.impulse;
        let torque = arm_z.mul_add(impulse.x, -(arm_x * impulse.z));
        PlanarMotion {
            vx: vx + impulse.x,                                // (11)
            vz: vz + impulse.z,                                // (11)
            spin: torque.mul_add(1.0 / body.transverse, spin), // (11)
        }
    }
}

/// Sine of the angle between axis and normal below which its square underflows. The axis then has no horizontal direction, and any
/// **u** will do.
const UPRIGHT: f64 = 1e-150;

/// The frame of a contact in space.
struct ContactFrame<S: Simd> {
    /// **r**_c (6).
    arm: Vectors<S>,
    sine: Pack<S>,
    /// **u** along x and y.
    along_x: Pack<S>,
    along_y: Pack<S>,
}

impl<S: Simd> ContactFrame<S> {
    #[inline(always)]
    fn new(state: &SpatialState<S>, ContactPoint { lever, radius }: ContactPoint<S>) -> Self {
        let axis = state.axis;
        let sine = state.sine();
        let upright = sine.le(UPRIGHT);
        let inverse = 1.0 / sine.max(UPRIGHT);
        Self {
            arm: Vectors {
                x: axis.x * lever,
                y: axis.y * lever,
                z: axis.z.mul_add(lever, -radius),
            },
            sine,
            along_x: upright.select(1.0, axis.x * inverse),
            along_y: upright.select(0.0, axis.y * inverse),
        }
    }
}

impl<S: Simd> Collide<S> for SpatialState<S> {
    #[inline(always)]
    fn contact(&self, body: &Body, point: ContactPoint<S>) -> Contact<Pack<S>> {
        let velocity = self.motion.velocity;
        let ContactPoint { lever, radius } = point;
        let ContactFrame {
            arm,
            sine,
            along_x,
            along_y,
        } = ContactFrame::new(self, point);
        let turning = self.spin(body).cross(arm);
        let (x, y) = (velocity.x + turning.x, velocity.y + turning.y); // v_c (7)

        // Components of r_c × w perpendicular to the axis and along it, which give K_ww.
        let (twist, roll) = (radius * self.axis.z - lever, radius * sine);
        let ww = (twist * twist).mul_add(
            1.0 / body.transverse,
            (roll * roll).mul_add(1.0 / body.axial, 1.0),
        );
        Contact {
            velocity: Vector {
                x: x.mul_add(along_x, y * along_y),
                y: y.mul_add(along_x, -(x * along_y)),
                z: (velocity.z + turning.z).min(0.0), // (7); as in the plane
            },
            compliance: AxialCompliance {
                inertia: body.transverse,
                arm_normal: arm.z,
                arm_along: lever * sine,
                ww,
            },
        }
    }

    fn along(&self, point: ContactPoint<S>) -> [Pack<S>; 2] {
        let ContactFrame {
            along_x, along_y, ..
        } = ContactFrame::new(self, point);
        [along_x, along_y]
    }

    #[inline(always)]
    fn after(
        &self,
        body: &Body,
        point: ContactPoint<S>,
        response: &Response<Pack<S>>,
    ) -> SpatialMotion<S> {
        let SpatialMotion {
            velocity,
            precession,
        } = self.motion;
        let ContactFrame {
            arm,
            along_x,
            along_y,
            ..
        } = ContactFrame::new(self, point);
        let [along, across, normal] = response.impulse.parts();
        let impulse = Vectors {
            x: along.mul_add(along_x, -(across * along_y)),
            y: along.mul_add(along_y, across * along_x),
            z: normal,
        };
        SpatialMotion {
            velocity: Vectors {
                x: velocity.x + impulse.x,
                y: velocity.y + impulse.y,
                z: velocity.z + impulse.z,
            }, // (11)
            precession: arm
                .cross(impulse)
                .mul_add(1.0 / body.transverse, precession), // (11)
        }
    }
}
