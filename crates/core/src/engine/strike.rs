//! The impact of a body: the contact that a law is applied to, (6)–(8), and the motion afterwards, (11).

use crate::body::{Body, Hull, Part};
use crate::collision::{Contacts, Respond};
use crate::flight::{
    Flight, PlanarMotion, PlanarStates, SpatialFlight, SpatialMotion, SpatialStates, States,
    Vectors,
};
use crate::simd::Pack;
use pulp::Simd;

/// Planar or spatial motion.
pub(crate) trait Turn: Copy {
    /// The flight of as many particles as there are lanes.
    type Flight<S: Simd, const K: usize>: Flight<S, K, State: Strike<S, K>>;
}

/// Motion in a vertical plane.
#[derive(Clone, Copy)]
pub(crate) struct Planar;

/// Motion in three dimensions.
#[derive(Clone, Copy)]
pub(crate) struct Spatial;

impl Turn for Planar {
    type Flight<S: Simd, const K: usize> = PlanarStates<S, K>;
}

impl Turn for Spatial {
    type Flight<S: Simd, const K: usize> = SpatialFlight<S, K>;
}

/// The sphere that touches like the hull at the contact: its lever s and its radius ϱ.
#[derive(Clone, Copy)]
pub(crate) struct Touch<S: Simd, const K: usize> {
    pub lever: Pack<S, K>,
    pub radius: Pack<S, K>,
}

impl<S: Simd, const K: usize> Touch<S, K> {
    /// That of a part of a hull at this e_z.
    #[inline(always)]
    pub fn of(hull: &impl Hull, part: &Part<S, K>, tilt: Pack<S, K>) -> Self {
        Self {
            lever: hull.lever(part, tilt),
            radius: hull.radius(part, tilt),
        }
    }
}

/// The result of an impact.
pub(crate) struct Struck<M, S: Simd, const K: usize> {
    /// The motion after the impact.
    pub motion: M,
    /// Normal speeds of the point of contact: of approach before, of separation after the impact.
    pub approach: Pack<S, K>,
    pub separation: Pack<S, K>,
}

/// States to which an impact can be applied.
pub(crate) trait Strike<S: Simd, const K: usize>: States<S, K> {
    /// The impact of the part of the hull at the contact.
    fn strike(
        &self,
        body: &Body,
        law: &impl Respond,
        touch: Touch<S, K>,
    ) -> Struck<Self::Motion, S, K>;
}

impl<S: Simd, const K: usize> Strike<S, K> for PlanarStates<S, K> {
    #[inline(always)]
    fn strike(
        &self,
        body: &Body,
        law: &impl Respond,
        Touch { lever, radius }: Touch<S, K>,
    ) -> Struck<PlanarMotion<S, K>, S, K> {
        let j = body.transverse;
        let PlanarMotion { glide, climb, spin } = self.motion;
        let arm_x = self.sine * lever; // r_c (6)
        let arm_z = self.cosine.mul_add(lever, -radius); // r_c (6)
        let slip = [
            (climb - spin * arm_x).min(0.0), // v_c (7); at a grazing contact it may have changed sign within the last step
            glide + spin * arm_z,            // v_c (7)
        ];
        let contact = Contacts::in_plane(slip, j, [arm_z, arm_x]);
        let response = law.respond::<S, K, false>(&contact);
        let torque = arm_z.mul_add(response.along, -(arm_x * response.normal));
        let motion = PlanarMotion {
            glide: glide + response.along,       // (11)
            climb: climb + response.normal,      // (11)
            spin: torque.mul_add(1.0 / j, spin), // (11)
        };
        Struck {
            motion,
            approach: contact.approach_speed(),
            separation: response.separation_speed,
        }
    }
}

/// Sine of the angle between axis and normal below which its square underflows. The axis then has no horizontal direction, and any
/// **u** will do.
const UPRIGHT: f64 = 1e-150;

impl<S: Simd, const K: usize> Strike<S, K> for SpatialStates<S, K> {
    #[inline(always)]
    fn strike(
        &self,
        body: &Body,
        law: &impl Respond,
        Touch { lever, radius }: Touch<S, K>,
    ) -> Struck<SpatialMotion<S, K>, S, K> {
        let SpatialMotion {
            velocity,
            precession,
        } = self.motion;
        let axis = self.axis;
        let arm = Vectors {
            x: axis.x * lever,
            y: axis.y * lever,
            z: axis.z.mul_add(lever, -radius),
        }; // r_c (6)
        let turning = self.spin(body).cross(arm);
        let (x, y) = (velocity.x + turning.x, velocity.y + turning.y); // v_c (7)

        let sine = self.sine();
        let upright = sine.le(UPRIGHT);
        let inverse = 1.0 / sine.max(UPRIGHT);
        let along_x = upright.select(1.0, axis.x * inverse);
        let along_y = upright.select(0.0, axis.y * inverse);

        // Components of r_c × w perpendicular to the axis and along it, which give K_ww.
        let (twist, roll) = (radius * axis.z - lever, radius * sine);
        let across = (twist * twist).mul_add(
            1.0 / body.transverse,
            (roll * roll).mul_add(1.0 / body.axial, 1.0),
        );
        let slip = [
            (velocity.z + turning.z).min(0.0), // at a grazing contact it may have changed sign within the last step
            x.mul_add(along_x, y * along_y),
            y.mul_add(along_x, -(x * along_y)),
        ];
        let arms = [arm.z, lever * sine];
        let contact = Contacts::in_space(slip, body.transverse, arms, across);
        let response = law.respond::<S, K, true>(&contact);
        let impulse = Vectors {
            x: response
                .along
                .mul_add(along_x, -(response.across * along_y)),
            y: response.along.mul_add(along_y, response.across * along_x),
            z: response.normal,
        };
        let motion = SpatialMotion {
            velocity: Vectors {
                x: velocity.x + impulse.x,
                y: velocity.y + impulse.y,
                z: velocity.z + impulse.z,
            }, // (11)
            precession: arm
                .cross(impulse)
                .mul_add(1.0 / body.transverse, precession), // (11)
        };
        Struck {
            motion,
            approach: contact.approach_speed(),
            separation: response.separation_speed,
        }
    }
}
