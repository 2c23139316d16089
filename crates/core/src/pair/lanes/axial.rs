//! Bodies that are balls on an axis, such as dumbbells, or spheroids.
//!
//! The axis **e** of such a body turns about **Λ** at the rate Ω = |Λ|/J, and all that a contact without friction sees of the body is its axis: a unit
//! impulse along **n** on the ball at x**e**, or on a spheroid where it is as far from the axis as such a ball, changes **Λ**/J by (x/J) **e** × **n**. The spin about
//! the axis is constant, and is added to the attitude at the end.

use super::{
    Encountering, LaneBall, LaneBody, LaneContact, LaneEncounters, LaneFlight, LanePair,
    MOST_LANES, NearestParts, Surfaces,
};
use crate::contact::{RoundPart, RoundParts, TurningAxis};
use crate::math::{Quaternion, Quaternions, UNITS, Vectors};
use crate::pair::encounter::End;
use crate::pair::partner::{FreeBody, Partner};
use crate::shape::{Piece, PieceKind};
use crate::simd::elementary::sincos_in_lanes;
use crate::simd::{Lanewise, Mask, Pack};
use pulp::Simd;

/// A body of balls on its axis, or of one part on it.
pub(in crate::pair) struct AxialBody {
    /// The principal axis of this number.
    axis: usize,
    balls: Vec<LaneBall>,
    part: Option<RoundPart>,
    /// The reciprocal of the moment of inertia across it, and that about it, over that across.
    inverse: f64,
    ratio: f64,
}

impl AxialBody {
    /// The two parts of spheroids.
    #[inline(always)]
    fn parts<'a>(pair: &'a LanePair<'_, '_, Self>) -> Option<RoundParts<'a>> {
        if pair.surfaces != Surfaces::Spheroids {
            return None;
        }
        let [one, two] = &pair.shapes;
        Some(RoundParts {
            parts: [one.part.as_ref()?, two.part.as_ref()?],
            reach: pair.reach,
        })
    }
}

impl LaneBody for AxialBody {
    type Flight<S: Simd> = AxialFlight<S>;

    fn new(body: &Partner) -> Option<Self> {
        let axis = body.axis?;
        let ball = |piece: &Piece| match piece.kind {
            PieceKind::Ball(place, radius) => Some(LaneBall {
                place: UNITS[2] * place.parts()[axis],
                distance: place.parts()[axis].abs(),
                radius,
            }),
            _ => None,
        };
        let moments = body.top.moments();
        let inertia = moments[(axis + 1) % 3];
        let balls: Option<Vec<LaneBall>> = body.pieces.iter().map(ball).collect();
        // A dumbbell may be two balls in one place.
        let (first, others) = body.pieces.split_first()?;
        let alone = others.iter().all(|piece| piece == first);
        let part = alone.then(|| RoundPart::new(first, axis)).flatten();
        Some(Self {
            axis,
            balls: balls.unwrap_or_default(),
            part,
            inverse: 1.0 / inertia,
            ratio: moments[axis] / inertia,
        })
    }

    #[inline(always)]
    fn balls(&self) -> &[LaneBall] {
        &self.balls
    }

    fn surfaces([one, two]: [&Partner; 2], shapes: &[Self; 2]) -> Option<Surfaces> {
        if one.is_ball() && two.is_ball() {
            Some(Surfaces::Spheres)
        } else if shapes.iter().all(|shape| !shape.balls.is_empty()) {
            Some(Surfaces::Balls)
        } else if shapes.iter().all(|shape| shape.part.is_some()) {
            Some(Surfaces::Spheroids)
        } else {
            None
        }
    }
}

/// One body in each lane.
pub(in crate::pair) struct AxialFlight<S: Simd> {
    /// **e** at its beginning, and **Λ**/J.
    axis: Vectors<S>,
    precession: Vectors<S>,
    /// The rotation of **e** since the encounter was given.
    turned: Quaternions<S>,
    /// Of **e** the part along **Λ**, that across, and **Λ** × **e**/|Λ|; Ω, and |**e**″|.
    motion: [Vectors<S>; 3],
    rate: Pack<S>,
    bend: Pack<S>,
    /// Of a spheroid the largest distance of its points from **Λ**.
    swing: Pack<S>,
}

impl<S: Simd> AxialFlight<S> {
    /// **e** and **e**′ at a time, of which sine and cosine of the angle are given.
    #[inline(always)]
    fn at(&self, (sine, cosine): (Pack<S>, Pack<S>)) -> [Vectors<S>; 2] {
        let [along, second, third] = self.motion;
        let axis = third.mul_add(sine, second.mul_add(cosine, along));
        let change = third * cosine - second * sine;
        [axis, change * self.rate]
    }

    /// The same with what turns it.
    #[inline(always)]
    fn turning(&self, time: Pack<S>) -> TurningAxis<S> {
        let [axis, change] = self.at(sincos_in_lanes(self.rate * time));
        TurningAxis {
            axis,
            change,
            turn: self.precession,
            rate: self.rate,
            swing: self.swing,
        }
    }
}

impl<S: Simd> LaneFlight<S> for AxialFlight<S> {
    type Body = AxialBody;
    /// The height on the axis.
    type Place = Pack<S>;
    /// **e** and **e**′.
    type Pose = [Vectors<S>; 2];
    type Ended = EndedRotations<S>;
    const FEW: u32 = 1;

    #[inline(always)]
    fn none(simd: S) -> Self {
        let (zero, still) = (Pack::none(simd), Vectors::none(simd));
        Self {
            axis: Vectors::splat(simd, UNITS[2]),
            precession: still,
            turned: Quaternions::splat(simd, Quaternion::IDENTITY),
            motion: [still; 3],
            rate: zero,
            bend: zero,
            swing: zero,
        }
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, body: &AxialBody, state: &FreeBody) {
        let mut spin = state.spin.parts();
        spin[body.axis] *= body.ratio;
        self.axis.put(lane, state.attitude.rotate(UNITS[body.axis]));
        self.precession
            .put(lane, state.attitude.rotate(spin.into()));
        self.turned.put(lane, Quaternion::IDENTITY);
    }

    #[inline(always)]
    fn begin(&mut self, body: &AxialBody, fresh: Mask<S>) -> Mask<S> {
        let square = self.precession.dot(self.precession);
        let rate = square.sqrt();
        let turns = Pack::splat(rate.simd(), 0.0).lt(rate);
        let about = self.precession * (1.0 / turns.select(rate, 1.0));
        let about = self.axis.or(turns, about);
        let third = about.cross(self.axis);
        let second = third.cross(about);
        let cosine = about.dot(self.axis);
        // What does not turn stays as long as it is: its projection on itself would be longer in each flight.
        let along = self.axis.or(turns, about * cosine);
        let [one, two, three] = self.motion;
        self.motion = [
            one.or(fresh, along),
            two.or(fresh, second),
            three.or(fresh, third),
        ];
        self.rate = fresh.select(rate, self.rate);
        let sine = third.dot(third).sqrt();
        self.bend = fresh.select(square * sine, self.bend);
        if let Some(part) = &body.part {
            self.swing = fresh.select(part.swing(sine, cosine), self.swing);
        }
        Mask::splat(rate.simd(), true)
    }

    #[inline(always)]
    fn bend(&self) -> Pack<S> {
        self.bend
    }

    #[inline(always)]
    fn turn(&mut self, lanes: Mask<S>, time: Pack<S>) {
        let half = sincos_in_lanes(0.5 * self.rate * time);
        let (s, c) = half;
        let [axis, _] = self.at((2.0 * s * c, c * c - s * s));
        // Of length 1: about Λ, or with the angle 0.
        let still = Pack::splat(time.simd(), 0.0).lt(self.rate);
        let about = self.precession * (1.0 / still.select(self.rate, 1.0));
        let later = then(self.turned, about, half);
        self.axis = self.axis.or(lanes, axis);
        self.turned = self.turned.or(lanes, later);
    }

    #[inline(always)]
    fn pose(&mut self, _: &AxialBody, time: Pack<S>) -> Self::Pose {
        self.at(sincos_in_lanes(self.rate * time))
    }

    #[inline(always)]
    fn moved(
        &self,
        &[axis, change]: &Self::Pose,
        (_, ball): (usize, &LaneBall),
        sign: f64,
        [y, velocity]: [Vectors<S>; 2],
    ) -> [Vectors<S>; 2] {
        let height = sign * ball.place.z;
        [axis.mul_add(height, y), change.mul_add(height, velocity)]
    }

    #[inline(always)]
    fn choose(place: &mut Pack<S>, lanes: Mask<S>, ball: &LaneBall) {
        *place = lanes.select(ball.place.z, *place);
    }

    #[inline(always)]
    fn reached(&self, place: Pack<S>, sign: f64, from: Vectors<S>) -> Vectors<S> {
        self.axis.mul_add(sign * place, from)
    }

    #[inline(always)]
    fn arm(&self, place: Pack<S>, normal: Vectors<S>) -> Vectors<S> {
        self.axis.cross(normal) * place
    }

    #[inline(always)]
    fn compliance(&self, body: &AxialBody, arm: Vectors<S>, from: Pack<S>) -> Pack<S> {
        arm.dot(arm).mul_add(body.inverse, from)
    }

    #[inline(always)]
    fn speed(&self, arm: Vectors<S>) -> Pack<S> {
        self.precession.dot(arm)
    }

    #[inline(always)]
    fn push(&mut self, body: &AxialBody, arm: Vectors<S>, impulse: Pack<S>) {
        self.precession = arm.mul_add(impulse * body.inverse, self.precession);
    }

    #[inline(always)]
    fn look(
        all: &mut Encountering<S, Self>,
        pair: &LanePair<'_, '_, AxialBody>,
        active: Mask<S>,
    ) -> NearestParts<S> {
        let Some(parts) = AxialBody::parts(pair) else {
            return all.look(pair);
        };
        let bodies = [
            all.bodies[0].turning(all.time),
            all.bodies[1].turning(all.time),
        ];
        let axes = [bodies[0].axis, bodies[1].axis];
        let apart = all.velocity.mul_add(all.time, all.apart);
        let between = parts.between(apart, axes);
        // The last normal, or that between the centres.
        let none = all.normal.dot(all.normal).eq(0.0);
        let along = between * (1.0 / between.dot(between).sqrt());
        let last = all.normal.or(none, along);
        all.normal = parts.normal(last, between, axes, active, true);
        let zero = Pack::splat(all.time.simd(), 0.0);
        let leaves = all.time.eq(0.0) & zero.lt(all.left);
        let motion = [apart, all.velocity];
        let found = parts.step(all.normal, motion, &bodies, (leaves, all.left_speed));
        NearestParts {
            clear: found.clear,
            balls: zero + 1.0,
            rate: found.rate,
            bound: found.bound,
        }
    }

    #[inline(always)]
    fn meet(
        all: &mut Encountering<S, Self>,
        pair: &LanePair<'_, '_, AxialBody>,
        touched: Mask<S>,
        balls: Pack<S>,
    ) -> LaneContact<S, Pack<S>> {
        let Some(parts) = AxialBody::parts(pair) else {
            return all.meet(pair, balls);
        };
        let axes = [all.bodies[0].axis, all.bodies[1].axis];
        let between = parts.between(all.apart, axes);
        all.normal = parts.normal(all.normal, between, axes, touched, false);
        let found = parts.contact(all.normal, between, axes);
        (all.normal, found.places, found.radius)
    }

    fn ended(simd: S) -> EndedRotations<S> {
        let zero = Pack::splat(simd, 0.0);
        let body = EndedRotation {
            attitude: Quaternions::splat(simd, Quaternion::IDENTITY),
            turned: Quaternions::splat(simd, Quaternion::IDENTITY),
            precession: Vectors::none(simd),
            own: zero,
            time: zero,
        };
        EndedRotations {
            count: 0,
            jobs: [0; MOST_LANES],
            bodies: [body; 2],
        }
    }

    #[inline(always)]
    fn add(
        ended: &mut EndedRotations<S>,
        all: &Encountering<S, Self>,
        lane: usize,
        job: usize,
        run: &mut LaneEncounters<'_, '_, '_, AxialBody>,
    ) {
        let (to, from) = (ended.count, &run.approaches[job]);
        ended.jobs[to] = job;
        for i in 0..2 {
            let (body, flight, state) = (&mut ended.bodies[i], &all.bodies[i], &from.states[i]);
            body.attitude.put(to, state.attitude);
            body.turned.put(to, flight.turned.lane(lane));
            body.precession.put(to, flight.precession.lane(lane));
            body.own.as_mut_slice()[to] = state.spin.parts()[run.pair.shapes[i].axis];
            body.time.as_mut_slice()[to] = from.passed[i] + all.clock.as_slice()[lane];
        }
        ended.count += 1;
        if ended.count == Pack::<S>::WIDTH {
            Self::find(ended, run.pair, run.ends);
        }
    }

    #[inline(always)]
    fn find(
        ended: &mut EndedRotations<S>,
        pair: &LanePair<'_, '_, AxialBody>,
        ends: &mut [Option<End>],
    ) {
        for i in 0..2 {
            let (shape, body) = (&pair.shapes[i], &ended.bodies[i]);
            let axis = Vectors::splat(body.own.simd(), UNITS[shape.axis]);
            let (sine, cosine) = sincos_in_lanes(0.5 * body.own * (1.0 - shape.ratio) * body.time);
            let rolled = body.attitude * Quaternions::of(cosine, axis * sine);
            let attitude = (body.turned * rolled).normalized();
            let spins = attitude.inverse().rotate(body.precession);
            for lane in 0..ended.count {
                if let Some(Ok(end)) = &mut ends[ended.jobs[lane]] {
                    let mut spin = spins.lane(lane).parts();
                    spin[shape.axis] = body.own.as_slice()[lane];
                    end.states[i].attitude = attitude.lane(lane);
                    end.states[i].spin = spin.into();
                }
            }
        }
        ended.count = 0;
    }
}

/// A rotation, and then one about a unit vector by the angle of which sine and cosine of the half are given.
#[inline(always)]
fn then<S: Simd>(
    turned: Quaternions<S>,
    about: Vectors<S>,
    (sine, cosine): (Pack<S>, Pack<S>),
) -> Quaternions<S> {
    let (v, own) = (about * sine, turned.vector());
    Quaternions::of(
        cosine * turned.w - v.dot(own),
        own.mul_add(cosine, v.mul_add(turned.w, v.cross(own))),
    )
}

/// The rotation of bodies whose encounters have ended, one in each lane: it is found for as many as there are lanes at once.
pub(in crate::pair) struct EndedRotations<S: Simd> {
    count: usize,
    jobs: [usize; MOST_LANES],
    bodies: [EndedRotation<S>; 2],
}

/// Of one of both bodies: its attitude at first, its rotation since then but for that about its own axis, **Λ**/J, the spin about the axis, and the time.
#[derive(Clone, Copy)]
struct EndedRotation<S: Simd> {
    attitude: Quaternions<S>,
    turned: Quaternions<S>,
    precession: Vectors<S>,
    own: Pack<S>,
    time: Pack<S>,
}
