//! MOTION: the free flight between two impacts, (3)–(5).
//!
//! The centre of mass follows a parabola (5). The axis of a body of revolution turns at a constant rate about the fixed
//! angular momentum **Λ**. The paper's (3) turns it about **ω**, which is the same only while **ω** is perpendicular to the
//! axis; in general **ω** itself precesses, but the axis moves as in (3) with **Λ**/J_xx in the place of **ω**.
//!
//! A body turns in a vertical plane ([`PlanarStates`]), to which every release from rest leads, or in any way
//! ([`SpatialFlight`]). The search for a contact sees no difference, for in both the vertical component of the axis is
//! e_z = c + A cos(Ωt + φ): one sine and cosine serve it.

mod planar;
mod spatial;
mod state;
mod vector;

pub(crate) use planar::{Motion as PlanarMotion, States as PlanarStates};
pub(crate) use spatial::{
    Motion as SpatialMotion, Motions as SpatialFlight, States as SpatialStates, Vectors,
};
pub use state::State;
pub use vector::Vector;

use crate::body::{Body, Swing};
use crate::simd::Pack;
use crate::simd::elementary::moderate_sincos_in_lanes;
use pulp::Simd;

/// A point of the unit circle that goes round as the body turns: the axis itself in the plane, in space the angle turned
/// through since the start of the flight.
#[derive(Clone, Copy)]
pub(crate) struct Attitude<S: Simd, const K: usize> {
    pub sine: Pack<S, K>,
    pub cosine: Pack<S, K>,
}

impl<S: Simd, const K: usize> Attitude<S, K> {
    /// Before anything is known of it.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = Pack::splat(simd, 0.0);
        Self {
            sine: zero,
            cosine: zero,
        }
    }

    /// The attitude after another turn through an angle with this sine and cosine (3).
    #[inline(always)]
    pub fn after(self, sin: Pack<S, K>, cos: Pack<S, K>) -> Self {
        Self {
            sine: self.sine.mul_add(cos, self.cosine * sin), // (3)
            cosine: self.cosine.mul_add(cos, -(self.sine * sin)), // (3)
        }
    }

    /// The attitude a moderate `angle` later: exact in double precision for angles up to 0.15.
    #[inline(always)]
    pub fn turned(self, angle: Pack<S, K>) -> Self {
        let (sin, cos) = moderate_sincos_in_lanes(angle);
        self.after(sin, cos)
    }

    /// The attitude a small `angle` later: exact in double precision for angles up to 2⁻¹⁸.
    #[inline(always)]
    pub fn advanced(self, angle: Pack<S, K>) -> Self {
        self.after(angle, (angle * angle).mul_add(-0.5, 1.0))
    }
}

/// Position and motion, in each lane. The horizontal position is left out: the plane looks the same everywhere.
pub(crate) trait States<S: Simd, const K: usize>: Copy {
    /// What an impact changes: velocity and angular momentum.
    type Motion: Copy;

    /// A body at rest and upright, this high above the hull's level, in every lane.
    fn resting(simd: S, lift: f64) -> Self;
    /// Puts a particle into a lane.
    fn put(&mut self, lane: usize, start: &State);
    /// Height of the centre of mass above the hull's level.
    fn lift(&self) -> Pack<S, K>;
    /// Vertical velocity of the centre of mass.
    fn climb(&self) -> Pack<S, K>;
    /// Sine, ≥ 0 or of either sign, of the angle between the axis and the plane normal.
    fn sine(&self) -> Pack<S, K>;
    /// Its cosine, e_z.
    fn tilt(&self) -> Pack<S, K>;
    /// The motion.
    fn motion(&self) -> Self::Motion;
    /// The same place with another motion.
    fn moving(self, motion: Self::Motion) -> Self;
    /// The same in space.
    fn in_space(&self) -> SpatialStates<S, K>;
    /// Kinetic energy of the rotation, in m g R.
    fn rotational_energy(&self, body: &Body) -> Pack<S, K>;
    /// Kinetic energy, in m g R.
    fn kinetic_energy(&self, body: &Body) -> Pack<S, K>;
}

/// A flight that starts from a [`States`] at time 0.
pub(crate) trait Flight<S: Simd, const K: usize>: Copy {
    /// Position and motion.
    type State: States<S, K>;

    /// The flight that follows from `start`, over a plane that falls along x with this slope, tan α.
    fn new(start: Self::State, slope: f64) -> Self;
    /// Where it starts.
    fn start(&self) -> &Self::State;
    /// Rate Ω of the rotation, up to its sign.
    fn rate(&self) -> Pack<S, K>;
    /// Ω².
    fn square(&self) -> Pack<S, K>;
    /// A bound on the amplitude A of e_z.
    fn amplitude(&self) -> Pack<S, K>;
    /// A bound on |e_z|, |c| + A, for any flight time.
    fn reach(&self) -> Pack<S, K>;
    /// The attitude when the body has turned through Ωt, of which sine and cosine are given.
    fn attitude(&self, turned: (Pack<S, K>, Pack<S, K>)) -> Attitude<S, K>;
    /// How e_z moves at an attitude (3).
    fn swing(&self, attitude: Attitude<S, K>) -> Swing<S, K>;
    /// The same at the start.
    fn beginning(&self) -> Swing<S, K>;
    /// Starts anew from where it starts, with another motion.
    fn depart(&mut self, motion: <Self::State as States<S, K>>::Motion, slope: f64);
    /// The state at `time`. Its lift is that of the start: where the body lands, the hull gives it more exactly.
    fn state(&self, time: Pack<S, K>, attitude: Attitude<S, K>) -> Self::State;
    /// Ends here: the place of the start is taken by the `state` at the end, with the lift at which the body touches.
    fn end(&mut self, state: Self::State, lift: Pack<S, K>);

    /// Height of the centre of mass above the hull's level at `time` (5).
    #[inline(always)]
    fn lift_at(&self, time: Pack<S, K>) -> Pack<S, K> {
        time.mul_add(
            time.mul_add(-0.5, self.start().climb()),
            self.start().lift(),
        ) // (5)
    }

    /// Its vertical velocity at `time`.
    #[inline(always)]
    fn climb_at(&self, time: Pack<S, K>) -> Pack<S, K> {
        self.start().climb() - time // (5)
    }
}
