//! The impact of a body: the contact that a law is applied to, (6)–(8), and the motion afterwards, (11).

use crate::law::{Contacts, Respond, Responses};
use crate::math::Vectors;
use crate::motion::{
    Flight, PlanarMotion, PlanarState, SpatialFlight, SpatialMotion, SpatialState, SymmetricState,
};
use crate::shape::{Body, Hull, HullPart};
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Planar or spatial motion.
pub(crate) trait Dimension: Copy {
    /// The flight of as many particles as there are lanes.
    type Flight<S: Simd, const K: usize>: Flight<S, K, State: Collide<S, K>>;
    /// Whether a contact may slip across the plane of the axis.
    const SPACE: bool;
}

/// Motion in a vertical plane.
#[derive(Clone, Copy)]
pub(crate) struct Planar;

/// Motion in three dimensions.
#[derive(Clone, Copy)]
pub(crate) struct Spatial;

impl Dimension for Planar {
    type Flight<S: Simd, const K: usize> = PlanarState<S, K>;
    const SPACE: bool = false;
}

impl Dimension for Spatial {
    type Flight<S: Simd, const K: usize> = SpatialFlight<S, K>;
    const SPACE: bool = true;
}

/// The sphere that touches like the hull at the contact: its lever s and its radius ϱ.
#[derive(Clone, Copy)]
pub(crate) struct ContactPoint<S: Simd, const K: usize> {
    pub lever: Pack<S, K>,
    pub radius: Pack<S, K>,
}

impl<S: Simd, const K: usize> ContactPoint<S, K> {
    /// Before the first contact.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = Pack::splat(simd, 0.0);
        Self {
            lever: zero,
            radius: zero,
        }
    }

    /// The same, but of no size in the lanes of the mask, which have no contact.
    #[inline(always)]
    pub fn but_not(self, mask: Mask<S, K>) -> Self {
        Self {
            lever: mask.select(0.0, self.lever),
            radius: mask.select(0.0, self.radius),
        }
    }

    /// That of a part of a hull at this e_z.
    #[inline(always)]
    pub fn of(hull: &impl Hull, part: &HullPart<S, K>, cos_tilt: Pack<S, K>) -> Self {
        Self {
            lever: hull.lever(part, cos_tilt),
            radius: hull.radius(part, cos_tilt),
        }
    }
}

/// The result of an impact.
pub(crate) struct Collided<M, S: Simd, const K: usize> {
    /// The motion after the impact.
    pub motion: M,
    /// Normal speeds of the point of contact: of approach before, of separation after the impact.
    pub approach: Pack<S, K>,
    pub separation: Pack<S, K>,
}

/// SymmetricState to which an impact can be applied.
pub(crate) trait Collide<S: Simd, const K: usize>: SymmetricState<S, K> {
    /// The contact of the part of the hull that touches.
    fn contact(&self, body: &Body, point: ContactPoint<S, K>) -> Contacts<S, K>;

    /// The response of a law to it.
    fn response(law: &impl Respond, contact: &Contacts<S, K>) -> Responses<S, K>;

    /// The motion after the impact.
    fn respond(
        &self,
        body: &Body,
        point: ContactPoint<S, K>,
        response: &Responses<S, K>,
    ) -> Self::Motion;

    /// The impact of the part of the hull that touches.
    #[inline(always)]
    fn collide(
        &self,
        body: &Body,
        law: &impl Respond,
        point: ContactPoint<S, K>,
    ) -> Collided<Self::Motion, S, K> {
        let contact = self.contact(body, point);
        let response = Self::response(law, &contact);
        Collided {
            motion: self.respond(body, point, &response),
            approach: contact.approach_speed(),
            separation: response.separation_speed,
        }
    }
}

/// **r**_c (6) in the plane of the axis, along x and z.
#[inline(always)]
fn planar_arm<S: Simd, const K: usize>(
    state: &PlanarState<S, K>,
    ContactPoint { lever, radius }: ContactPoint<S, K>,
) -> [Pack<S, K>; 2] {
    [state.sine * lever, state.cosine.mul_add(lever, -radius)]
}

impl<S: Simd, const K: usize> Collide<S, K> for PlanarState<S, K> {
    #[inline(always)]
    fn contact(&self, body: &Body, point: ContactPoint<S, K>) -> Contacts<S, K> {
        let PlanarMotion { vx, vz, spin } = self.motion;
        let [arm_x, arm_z] = planar_arm(self, point);
        let slip = [
            (vz - spin * arm_x).min(0.0), // v_c (7); at a grazing contact it may have changed sign within the last step
            vx + spin * arm_z,            // v_c (7)
        ];
        Contacts::in_plane(slip, body.transverse, [arm_z, arm_x])
    }

    #[inline(always)]
    fn response(law: &impl Respond, contact: &Contacts<S, K>) -> Responses<S, K> {
        law.respond::<S, K, false>(contact)
    }

    #[inline(always)]
    fn respond(
        &self,
        body: &Body,
        point: ContactPoint<S, K>,
        response: &Responses<S, K>,
    ) -> PlanarMotion<S, K> {
        let PlanarMotion { vx, vz, spin } = self.motion;
        let [arm_x, arm_z] = planar_arm(self, point);
        let torque = arm_z.mul_add(response.along, -(arm_x * response.normal));
        PlanarMotion {
            vx: vx + response.along,                           // (11)
            vz: vz + response.normal,                          // (11)
            spin: torque.mul_add(1.0 / body.transverse, spin), // (11)
        }
    }
}

/// Sine of the angle between axis and normal below which its square underflows. The axis then has no horizontal direction, and any
/// **u** will do.
const UPRIGHT: f64 = 1e-150;

/// The frame of a contact in space.
struct Frame<S: Simd, const K: usize> {
    /// **r**_c (6).
    arm: Vectors<S, K>,
    sine: Pack<S, K>,
    /// **u** along x and y.
    along_x: Pack<S, K>,
    along_y: Pack<S, K>,
}

impl<S: Simd, const K: usize> Frame<S, K> {
    #[inline(always)]
    fn new(state: &SpatialState<S, K>, ContactPoint { lever, radius }: ContactPoint<S, K>) -> Self {
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

impl<S: Simd, const K: usize> Collide<S, K> for SpatialState<S, K> {
    #[inline(always)]
    fn contact(&self, body: &Body, point: ContactPoint<S, K>) -> Contacts<S, K> {
        let velocity = self.motion.velocity;
        let ContactPoint { lever, radius } = point;
        let Frame {
            arm,
            sine,
            along_x,
            along_y,
        } = Frame::new(self, point);
        let turning = self.spin(body).cross(arm);
        let (x, y) = (velocity.x + turning.x, velocity.y + turning.y); // v_c (7)

        // Components of r_c × w perpendicular to the axis and along it, which give K_ww.
        let (twist, roll) = (radius * self.axis.z - lever, radius * sine);
        let across = (twist * twist).mul_add(
            1.0 / body.transverse,
            (roll * roll).mul_add(1.0 / body.axial, 1.0),
        );
        let slip = [
            (velocity.z + turning.z).min(0.0), // at a grazing contact it may have changed sign within the last step
            x.mul_add(along_x, y * along_y),
            y.mul_add(along_x, -(x * along_y)),
        ];
        Contacts::in_space(slip, body.transverse, [arm.z, lever * sine], across)
    }

    #[inline(always)]
    fn response(law: &impl Respond, contact: &Contacts<S, K>) -> Responses<S, K> {
        law.respond::<S, K, true>(contact)
    }

    #[inline(always)]
    fn respond(
        &self,
        body: &Body,
        point: ContactPoint<S, K>,
        response: &Responses<S, K>,
    ) -> SpatialMotion<S, K> {
        let SpatialMotion {
            velocity,
            precession,
        } = self.motion;
        let Frame {
            arm,
            along_x,
            along_y,
            ..
        } = Frame::new(self, point);
        let impulse = Vectors {
            x: response
                .along
                .mul_add(along_x, -(response.across * along_y)),
            y: response.along.mul_add(along_y, response.across * along_x),
            z: response.normal,
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
