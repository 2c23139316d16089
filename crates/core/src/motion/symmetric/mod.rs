//! The free flight between two impacts, (3)–(5).
//!
//! The centre of mass follows a parabola (5). The axis of a body of revolution turns at a constant rate about the fixed
//! angular momentum **Λ**. The paper's (3) turns it about **ω**, which is the same only while **ω** is perpendicular to the
//! axis; in general **ω** itself precesses, but the axis moves as in (3) with **Λ**/J_xx in the place of **ω**.
//!
//! The motion is planar ([`PlanarState`]) after every release from rest over a level plane, otherwise spatial
//! ([`SpatialFlight`]). The contact search is the same for both, because the vertical component of the axis is always
//! e_z = c + A cos(Ωt + φ): it needs one sine and one cosine.

mod planar;
mod spatial;
mod state;

pub(crate) use planar::{PlanarMotion, PlanarState};
pub(crate) use spatial::SpatialFlight;
pub use state::State;
pub(crate) use state::{SpatialMotion, SpatialState};

use crate::shape::{AxisMotion, Body};
use crate::simd::elementary::moderate_sincos_in_lanes;
use crate::simd::{Lanewise, Pack, lanewise};
use pulp::Simd;

/// Sine and cosine of the angle that describes the rotation: in planar motion that between the axis and the plane normal, in space
/// the angle Ωt turned through since the start of the flight.
#[derive(Clone, Copy)]
pub(crate) struct Attitude<S: Simd> {
    pub sine: Pack<S>,
    pub cosine: Pack<S>,
}

lanewise! {
    Attitude<S> { sine, cosine }
    PlanarMotion<S> { vx, vz, spin }
    PlanarState<S> { height, sine, cosine, motion }
    SpatialMotion<S> { velocity, precession }
    SpatialState<S> { height, axis, motion }
}

impl<S: Simd> Attitude<S> {
    /// The attitude after a further rotation by the angle with this sine and cosine (3).
    #[inline(always)]
    pub fn after(self, sin: Pack<S>, cos: Pack<S>) -> Self {
        Self {
            sine: self.sine.mul_add(cos, self.cosine * sin), // (3)
            cosine: self.cosine.mul_add(cos, -(self.sine * sin)), // (3)
        }
    }

    /// The attitude after a further rotation by a moderate `angle`: accurate to double precision for angles up to ½.
    #[inline(always)]
    pub fn turned(self, angle: Pack<S>) -> Self {
        let (sin, cos) = moderate_sincos_in_lanes(angle);
        self.after(sin, cos)
    }

    /// The attitude after a further rotation by a small `angle`: accurate to double precision for angles up to 2⁻¹⁸.
    #[inline(always)]
    pub fn advanced(self, angle: Pack<S>) -> Self {
        self.after(angle, (angle * angle).mul_add(-0.5, 1.0))
    }
}

/// Position and motion in each lane. The horizontal position is omitted, because the motion does not depend on it.
pub(crate) trait SymmetricState<S: Simd>: Lanewise<S> {
    /// Velocity and angular momentum, which an impact changes.
    type Motion: Copy;

    /// A body at rest with a vertical axis, this high above the hull's level, in every lane.
    fn resting(simd: S, height: f64) -> Self;
    /// Puts the state of a particle into a lane.
    fn put(&mut self, lane: usize, start: &State);
    /// Height of the centre of mass above the hull's level.
    fn height(&self) -> Pack<S>;
    /// Vertical velocity of the centre of mass.
    fn vz(&self) -> Pack<S>;
    /// Sine of the angle between the axis and the plane normal: signed in planar motion, ≥ 0 in space.
    fn sine(&self) -> Pack<S>;
    /// Cosine of that angle, e_z.
    fn cos_tilt(&self) -> Pack<S>;
    /// Velocity and angular momentum.
    fn motion(&self) -> Self::Motion;
    /// The same position with another motion.
    fn with_motion(self, motion: Self::Motion) -> Self;
    /// The same state with three-dimensional vectors.
    fn in_space(&self) -> SpatialState<S>;
    /// Kinetic energy of the rotation, in m g R.
    fn rotational_energy(&self, body: &Body) -> Pack<S>;
    /// Kinetic energy, in m g R.
    fn kinetic_energy(&self, body: &Body) -> Pack<S>;
}

/// A flight that starts from a [`SymmetricState`] at time 0.
pub(crate) trait Flight<S: Simd>: Copy {
    /// Position and motion.
    type State: SymmetricState<S>;

    /// The flight from `start`, over a plane that descends along x with this slope, tan α.
    fn new(start: Self::State, slope: f64) -> Self;
    /// The state at its start.
    fn start(&self) -> &Self::State;
    /// Angular velocity Ω of the axis, up to its sign.
    fn rate(&self) -> Pack<S>;
    /// Ω², and bounds for any flight time: on the amplitude A of e_z, and on |e_z|, |c| + A.
    fn bounds(&self) -> [Pack<S>; 3];
    /// The attitude after a rotation by Ωt, of which sine and cosine are given.
    fn attitude(&self, turned: (Pack<S>, Pack<S>)) -> Attitude<S>;
    /// e_z and its time derivatives at an attitude (3).
    fn axis_motion(&self, attitude: Attitude<S>) -> AxisMotion<S>;
    /// e_z and its time derivatives at the start.
    fn axis_motion_at_start(&self) -> AxisMotion<S>;
    /// The state at `time`. Its height is left at that of the start, because at a contact the hull gives it more accurately.
    fn state(&self, time: Pack<S>, attitude: Attitude<S>) -> Self::State;
    /// Ends the flight: `state`, with the `height` at which the body touches, replaces the start.
    fn end(&mut self, state: Self::State, height: Pack<S>);

    /// Replaces the flight by one that starts at the same position with another motion.
    #[inline(always)]
    fn depart(&mut self, motion: <Self::State as SymmetricState<S>>::Motion, slope: f64) {
        *self = Self::new(self.start().with_motion(motion), slope);
    }

    /// Height of the centre of mass above the hull's level at `time` (5).
    #[inline(always)]
    fn height_at(&self, time: Pack<S>) -> Pack<S> {
        let start = self.start();
        time.mul_add(time.mul_add(-0.5, start.vz()), start.height()) // (5)
    }

    /// Its vertical velocity at `time`.
    #[inline(always)]
    fn vz_at(&self, time: Pack<S>) -> Pack<S> {
        self.start().vz() - time // (5)
    }
}
