//! What the bounce loop tells of, and to whom.

use super::StopReason;
use crate::flight::SpatialStates;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// One impact in each lane.
pub(crate) struct Impact<S: Simd, const K: usize> {
    /// Time since release.
    pub time: Pack<S, K>,
    /// v_G^n before, positive when falling, and the normal velocity of the centre of mass after, positive when rising.
    pub fall: Pack<S, K>,
    pub rise: Pack<S, K>,
    /// Kinetic energy of the rotation before.
    pub rotation: Pack<S, K>,
    /// Kinetic energies before and after.
    pub energy_before: Pack<S, K>,
    pub energy_after: Pack<S, K>,
    /// Of the angle between the axis and the plane normal, up to the sign of the sine.
    pub sine: Pack<S, K>,
    pub cosine: Pack<S, K>,
    /// ±1: the sphere that touched.
    pub sphere: Pack<S, K>,
    /// Speed at which the point of contact approached the plane, −v_c^n.
    pub approach: Pack<S, K>,
    /// The states before and after.
    pub before: SpatialStates<S, K>,
    pub after: SpatialStates<S, K>,
    /// The lanes in which there is an impact.
    pub active: Mask<S, K>,
}

impl<S: Simd, const K: usize> Impact<S, K> {
    /// The coefficient of restitution (1).
    #[inline(always)]
    pub fn restitution(&self) -> Pack<S, K> {
        self.rise / self.fall // (1)
    }

    /// E_rot/E_tot before the impact (12).
    #[inline(always)]
    pub fn rotational_fraction(&self) -> Pack<S, K> {
        self.rotation / self.energy_before // (12)
    }

    /// Kinetic energy after the impact over that before.
    #[inline(always)]
    pub fn energy_ratio(&self) -> Pack<S, K> {
        self.energy_after / self.energy_before
    }
}

/// Has something to do while other arithmetic waits for its results.
pub(crate) trait Meanwhile {
    /// Does a little of what has piled up.
    fn meanwhile(&mut self);
}

/// Takes what happens to the particles of a release.
pub(crate) trait Sink: Meanwhile {
    /// Whether bounce loops are compiled for it. What writes records waits for memory, and gains nothing from them.
    const TOGETHER: bool;

    /// From now on number 0 of the release is particle `first` of the block.
    fn begin(&mut self, first: usize);
    /// Impact `number`, counted from 0, has happened to the particles of the release from `first` on, one in each lane.
    fn impact<S: Simd, const K: usize>(
        &mut self,
        number: usize,
        first: usize,
        impact: &Impact<S, K>,
    );
    /// Particle `lane` of the release has ended after `impacts` impacts.
    fn end(&mut self, lane: usize, impacts: usize, reason: StopReason);
}
