//! Bodies that are balls at any places.

use super::{Encountering, LaneBall, LaneBody, LaneEncounters, LaneFlight, LanePair, Surfaces};
use crate::math::{Quaternion, Quaternions, Vectors};
use crate::motion::Rotations;
use crate::pair::encounter::End;
use crate::pair::partner::{FreeBody, Partner};
use crate::shape::{PieceKind, Top};
use crate::simd::{Lanewise, Mask, Pack};
use pulp::{Simd, WithSimd};

/// A body of balls.
pub(in crate::pair) struct ClumpBody {
    balls: Vec<LaneBall>,
    top: Top,
    inverse_moments: [f64; 3],
}

impl LaneBody for ClumpBody {
    type Flight<S: Simd> = ClumpFlight<S>;

    fn new(body: &Partner) -> Option<Self> {
        let mut balls = Vec::new();
        for piece in &body.pieces {
            let PieceKind::Ball(place, radius) = piece.kind else {
                return None;
            };
            balls.push(LaneBall {
                place,
                distance: place.norm(),
                radius,
            });
        }
        Some(Self {
            balls,
            top: body.top,
            inverse_moments: body.inverse_moments,
        })
    }

    #[inline(always)]
    fn balls(&self) -> &[LaneBall] {
        &self.balls
    }

    fn surfaces(_: [&Partner; 2], shapes: &[Self; 2]) -> Option<Surfaces> {
        let pairs = shapes[0].balls.len() * shapes[1].balls.len();
        (pairs <= MOST_PAIRS).then_some(Surfaces::Balls)
    }
}

/// More pairs of balls are followed faster one encounter after the other, where few of them are looked at.
const MOST_PAIRS: usize = 1000;

/// One body in each lane.
pub(in crate::pair) struct ClumpFlight<S: Simd> {
    /// At the beginning, and ω in the principal axes.
    attitude: Quaternions<S>,
    spin: Vectors<S>,
    rotations: Rotations<S>,
    bend: Pack<S>,
    /// The places and the velocities of the balls at the last look.
    moved: Vec<[Vectors<S>; 2]>,
}

impl<S: Simd> LaneFlight<S> for ClumpFlight<S> {
    type Body = ClumpBody;
    /// In the principal axes.
    type Place = Vectors<S>;
    type Pose = ();
    type Ended = ();
    const FEW: u32 = (Pack::<S>::WIDTH as u32).div_ceil(3);

    fn none(simd: S) -> Self {
        Self {
            attitude: Quaternions::splat(simd, Quaternion::IDENTITY),
            spin: Vectors::none(simd),
            rotations: Rotations::none(simd),
            bend: Pack::splat(simd, 0.0),
            moved: Vec::new(),
        }
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, _: &ClumpBody, state: &FreeBody) {
        self.attitude.put(lane, state.attitude);
        self.spin.put(lane, state.spin);
    }

    #[inline(always)]
    fn begin(&mut self, body: &ClumpBody, _: Mask<S>) -> Mask<S> {
        let simd = self.bend.simd();
        simd.vectorize(Begin(self, body))
    }

    #[inline(always)]
    fn bend(&self) -> Pack<S> {
        self.bend
    }

    #[inline(always)]
    fn turn(&mut self, lanes: Mask<S>, time: Pack<S>) {
        let (attitude, spin) = time.simd().vectorize(RotationsAt(&self.rotations, time));
        self.attitude = self.attitude.or(lanes, attitude);
        self.spin = self.spin.or(lanes, spin);
    }

    #[inline(always)]
    fn pose(&mut self, body: &ClumpBody, time: Pack<S>) {
        let (attitude, spin) = time.simd().vectorize(RotationsAt(&self.rotations, time));
        let spin = attitude.rotate(spin);
        self.moved.clear();
        for ball in &body.balls {
            let place = attitude.rotate(Vectors::splat(time.simd(), ball.place));
            self.moved.push([place, spin.cross(place)]);
        }
    }

    #[inline(always)]
    fn moved(
        &self,
        (): &(),
        (number, _): (usize, &LaneBall),
        sign: f64,
        [y, velocity]: [Vectors<S>; 2],
    ) -> [Vectors<S>; 2] {
        let [place, change] = self.moved[number];
        [place.mul_add(sign, y), change.mul_add(sign, velocity)]
    }

    #[inline(always)]
    fn choose(place: &mut Vectors<S>, lanes: Mask<S>, ball: &LaneBall) {
        *place = place.or(lanes, Vectors::splat(lanes.simd(), ball.place));
    }

    #[inline(always)]
    fn reached(&self, place: Vectors<S>, sign: f64, from: Vectors<S>) -> Vectors<S> {
        self.attitude.rotate(place).mul_add(sign, from)
    }

    #[inline(always)]
    fn arm(&self, place: Vectors<S>, normal: Vectors<S>) -> Vectors<S> {
        place.cross(self.attitude.inverse().rotate(normal))
    }

    #[inline(always)]
    fn compliance(&self, body: &ClumpBody, arm: Vectors<S>, from: Pack<S>) -> Pack<S> {
        arm.dot(body.changed(arm)) + from
    }

    #[inline(always)]
    fn speed(&self, arm: Vectors<S>) -> Pack<S> {
        self.spin.dot(arm)
    }

    #[inline(always)]
    fn push(&mut self, body: &ClumpBody, arm: Vectors<S>, impulse: Pack<S>) {
        self.spin = body.changed(arm).mul_add(impulse, self.spin);
    }

    fn ended(_: S) {}

    #[inline(always)]
    fn add(
        (): &mut (),
        all: &Encountering<S, Self>,
        lane: usize,
        job: usize,
        run: &mut LaneEncounters<'_, '_, '_, ClumpBody>,
    ) {
        if let Some(Ok(end)) = &mut run.ends[job] {
            for (state, body) in end.states.iter_mut().zip(&all.bodies) {
                state.attitude = body.attitude.lane(lane);
                state.spin = body.spin.lane(lane);
            }
        }
    }

    #[inline(always)]
    fn find((): &mut (), _: &LanePair<'_, '_, ClumpBody>, _: &mut [Option<End>]) {}
}

/// [`ClumpFlight::begin`], and [`Rotations::at`]: compiled separately, because they are long, and wanted in several places.
struct Begin<'a, S: Simd>(&'a mut ClumpFlight<S>, &'a ClumpBody);
struct RotationsAt<'a, S: Simd>(&'a Rotations<S>, Pack<S>);

impl<S: Simd> WithSimd for Begin<'_, S> {
    type Output = Mask<S>;

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> Mask<S> {
        let Self(flight, ClumpBody { top, .. }) = self;
        let (rotations, known) = Rotations::new(top, flight.attitude, flight.spin);
        flight.rotations = rotations;
        flight.bend = top.largest_acceleration(flight.spin);
        known
    }
}

impl<S: Simd> WithSimd for RotationsAt<'_, S> {
    type Output = (Quaternions<S>, Vectors<S>);

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> Self::Output {
        let Self(rotations, time) = self;
        rotations.at(time)
    }
}

impl ClumpBody {
    /// J⁻¹ times a vector.
    #[inline(always)]
    fn changed<S: Simd>(&self, arm: Vectors<S>) -> Vectors<S> {
        let [a, b, c] = self.inverse_moments;
        Vectors::new(a * arm.x, b * arm.y, c * arm.z)
    }
}
