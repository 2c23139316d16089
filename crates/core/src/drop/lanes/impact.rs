//! An impact as the bounce loop reports it, and its receivers.

use crate::drop::stop::StopReason;
use crate::math::Vectors;
use crate::motion::SpatialState;
use crate::shape::Body;
use crate::simd::{Mask, Pack};
use pulp::Simd;
use std::ops::Range;

/// One impact in each lane, in the core's units: what statistics read, and the pose.
pub(crate) struct Impact<S: Simd, P> {
    /// Number of the particle in the run.
    pub particle: Pack<S>,
    /// Number of the impact, counted from 0.
    pub number: Pack<S>,
    /// Time since release.
    pub time: Pack<S>,
    /// Normal velocity of the centre of mass before the impact, v_G^n, positive when falling, and after it, positive when rising.
    pub fall: Pack<S>,
    pub rise: Pack<S>,
    /// Kinetic energy of the rotation before the impact.
    pub rotation: Pack<S>,
    /// Total kinetic energies before and after the impact.
    pub energy_before: Pack<S>,
    pub energy_after: Pack<S>,
    /// Number of the part that touched, from 1.
    pub part: Pack<S>,
    /// Speed at which the point of contact approached the plane, −v_c^n.
    pub approach: Pack<S>,
    /// Position, attitude and motion of the body before and after the impact: a [`Pose`].
    pub pose: P,
    /// The lanes that have an impact.
    pub active: Mask<S>,
}

/// Position and attitude of bodies at an impact, and their motion before and after it. A quantity that a body does not have is NaN: the
/// axis of one without symmetry, the attitude of one of revolution.
pub(crate) trait Pose<S: Simd> {
    /// Height of the centre of mass.
    fn height(&self) -> Pack<S>;
    /// Sine, up to its sign, and cosine of the angle between the symmetry axis and the plane normal.
    fn tilt(&self) -> (Pack<S>, Pack<S>);
    /// Symmetry axis.
    fn axis(&self) -> Vectors<S>;
    /// Attitude, a quaternion (w, x, y, z).
    fn attitude(&self) -> [Pack<S>; 4];
    /// Velocities of the centre of mass before and after the impact.
    fn velocities(&self) -> [Vectors<S>; 2];
    /// Angular velocity before the impact.
    fn spin_before(&self) -> Vectors<S>;
    /// Angular velocity after the impact.
    fn spin_after(&self) -> Vectors<S>;
    /// The states before and after the impact of a body of revolution.
    #[cfg(feature = "one-lane")]
    fn symmetric(&self) -> Option<[&SpatialState<S>; 2]> {
        None
    }
}

/// The pose of a body of revolution.
pub(crate) struct SymmetricPose<'a, S: Simd> {
    pub body: &'a Body,
    pub sine: Pack<S>,
    pub before: SpatialState<S>,
    pub after: SpatialState<S>,
}

impl<S: Simd> Pose<S> for SymmetricPose<'_, S> {
    #[inline(always)]
    fn height(&self) -> Pack<S> {
        self.before.height + self.body.hull.level()
    }

    #[inline(always)]
    fn tilt(&self) -> (Pack<S>, Pack<S>) {
        (self.sine, self.before.axis.z)
    }

    #[inline(always)]
    fn axis(&self) -> Vectors<S> {
        self.before.axis
    }

    #[inline(always)]
    fn attitude(&self) -> [Pack<S>; 4] {
        [Pack::splat(self.sine.simd(), f64::NAN); 4]
    }

    #[inline(always)]
    fn velocities(&self) -> [Vectors<S>; 2] {
        [self.before.motion.velocity, self.after.motion.velocity]
    }

    #[inline(always)]
    fn spin_before(&self) -> Vectors<S> {
        self.before.spin(self.body)
    }

    #[inline(always)]
    fn spin_after(&self) -> Vectors<S> {
        self.after.spin(self.body)
    }

    #[cfg(feature = "one-lane")]
    fn symmetric(&self) -> Option<[&SpatialState<S>; 2]> {
        Some([&self.before, &self.after])
    }
}

impl<S: Simd, P> Impact<S, P> {
    /// Coefficient of restitution.
    #[inline(always)]
    pub fn restitution(&self) -> Pack<S> {
        self.rise / self.fall // (1)
    }

    /// E_rot/E_tot before the impact.
    #[inline(always)]
    pub fn rotational_fraction(&self) -> Pack<S> {
        self.rotation / self.energy_before // (12)
    }

    /// Total kinetic energy after the impact divided by that before.
    #[inline(always)]
    pub fn energy_ratio(&self) -> Pack<S> {
        self.energy_after / self.energy_before
    }
}

/// Work on impacts that wait in a queue; none by default.
pub(crate) trait Meanwhile {
    /// True if the paper's runs have a bounce loop of their own for this work.
    const INTERLEAVED: bool = false;

    /// Works up the impact at a place.
    #[inline(always)]
    fn meanwhile(&mut self, _place: usize) {}

    /// Works up the impacts at these places.
    #[inline(always)]
    fn settle(&mut self, places: Range<usize>) {
        for place in places {
            self.meanwhile(place);
        }
    }
}

/// A receiver of impacts, which records or counts them.
pub(crate) trait ImpactSink: Meanwhile {
    /// Announces a release: at no place is there an impact to be worked up.
    fn begin(&mut self) {}
    /// Receives an impact in each active lane of a group. What is left to be done with it is done before the next one of this group:
    /// meanwhile, or by [`Meanwhile::settle`].
    fn impact<S: Simd, P: Pose<S>>(&mut self, group: usize, impact: &Impact<S, P>);
    /// Receives the end of a particle after so many impacts.
    fn end(&mut self, particle: usize, impacts: usize, reason: StopReason);
}
