//! An impact as the bounce loop reports it, and its receivers.

use crate::math::Vectors;
use crate::motion::SpatialState;
use crate::record;
use crate::shape::Body;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Particles that bounce on the plane: rows of impacts.
pub(crate) struct Bounces;

/// One impact in each lane, in the core's units: what statistics read, and the pose.
pub(crate) struct Impact<S: Simd, P, const K: usize> {
    /// Number of the particle in the run.
    pub particle: Pack<S, K>,
    /// Number of the impact, counted from 0.
    pub number: Pack<S, K>,
    /// Time since release.
    pub time: Pack<S, K>,
    /// Normal velocity of the centre of mass before the impact, v_G^n, positive when falling, and after it, positive when rising.
    pub fall: Pack<S, K>,
    pub rise: Pack<S, K>,
    /// Kinetic energy of the rotation before the impact.
    pub rotation: Pack<S, K>,
    /// Total kinetic energies before and after the impact.
    pub energy_before: Pack<S, K>,
    pub energy_after: Pack<S, K>,
    /// Number of the part that touched, from 1.
    pub part: Pack<S, K>,
    /// Speed at which the point of contact approached the plane, −v_c^n.
    pub approach: Pack<S, K>,
    /// Position, attitude and motion of the body before and after the impact: a [`Pose`].
    pub pose: P,
    /// The lanes that have an impact.
    pub active: Mask<S, K>,
}

/// Position and attitude of bodies at an impact, and their motion before and after it. A quantity that a body does not have is NaN: the
/// axis of one without symmetry, the attitude of one of revolution.
pub(crate) trait Pose<S: Simd, const K: usize> {
    /// Height of the centre of mass.
    fn height(&self) -> Pack<S, K>;
    /// Sine, up to its sign, and cosine of the angle between the symmetry axis and the plane normal.
    fn tilt(&self) -> (Pack<S, K>, Pack<S, K>);
    /// Symmetry axis.
    fn axis(&self) -> Vectors<S, K>;
    /// Attitude, a quaternion (w, x, y, z).
    fn attitude(&self) -> [Pack<S, K>; 4];
    /// Velocities of the centre of mass before and after the impact.
    fn velocities(&self) -> [Vectors<S, K>; 2];
    /// Angular velocity before the impact.
    fn spin_before(&self) -> Vectors<S, K>;
    /// Angular velocity after the impact.
    fn spin_after(&self) -> Vectors<S, K>;
    /// The states before and after the impact of a body of revolution.
    #[cfg(feature = "one-lane")]
    fn symmetric(&self) -> Option<[&SpatialState<S, K>; 2]> {
        None
    }
}

/// The pose of a body of revolution.
pub(crate) struct SymmetricPose<'a, S: Simd, const K: usize> {
    pub body: &'a Body,
    pub sine: Pack<S, K>,
    pub before: SpatialState<S, K>,
    pub after: SpatialState<S, K>,
}

impl<S: Simd, const K: usize> Pose<S, K> for SymmetricPose<'_, S, K> {
    #[inline(always)]
    fn height(&self) -> Pack<S, K> {
        self.before.height + self.body.hull.level()
    }

    #[inline(always)]
    fn tilt(&self) -> (Pack<S, K>, Pack<S, K>) {
        (self.sine, self.before.axis.z)
    }

    #[inline(always)]
    fn axis(&self) -> Vectors<S, K> {
        self.before.axis
    }

    #[inline(always)]
    fn attitude(&self) -> [Pack<S, K>; 4] {
        [Pack::splat(self.sine.simd(), f64::NAN); 4]
    }

    #[inline(always)]
    fn velocities(&self) -> [Vectors<S, K>; 2] {
        [self.before.motion.velocity, self.after.motion.velocity]
    }

    #[inline(always)]
    fn spin_before(&self) -> Vectors<S, K> {
        self.before.spin(self.body)
    }

    #[inline(always)]
    fn spin_after(&self) -> Vectors<S, K> {
        self.after.spin(self.body)
    }

    #[cfg(feature = "one-lane")]
    fn symmetric(&self) -> Option<[&SpatialState<S, K>; 2]> {
        Some([&self.before, &self.after])
    }
}

/// A receiver of impacts.
pub(crate) trait ImpactSink: record::Sink<Bounces> {}

impl<K: record::Sink<Bounces>> ImpactSink for K {}
