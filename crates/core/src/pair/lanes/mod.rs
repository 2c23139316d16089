//! Encounters without friction of bodies whose flights are known in closed form: one in each lane of a vector.
//!
//! Bodies of balls on an axis, such as dumbbells, and spheroids are in `axial.rs`, other bodies of balls in `clump.rs`. A unit impulse along **n** on a ball at **p**
//! changes the angular momentum by **p** × **n**, so that K_nn is the sum of 1/m + (**p** × **n**)·J⁻¹(**p** × **n**) of both (10). What takes more (contacts that
//! may last or accumulate, bodies that only rotation moves, a search that does not end soon) is rare, and left to [`Following`](super::encounter::Following).

mod axial;
mod clump;

pub(super) use axial::AxialBody;
pub(super) use clump::ClumpBody;

use super::encounter::{Chance, End, Ending, Hit, OnHit, Outcome, UNRESOLVED, within};
use super::partner::{Approach, FreeBody, Partner};
use crate::contact::{BallGaps, INVISIBLE};
use crate::law::{Frictionless, Law, Rule};
use crate::math::{UNITS, Vector, Vectors};
use crate::simd::{Lanewise, Level, Mask, Pack};
use pulp::{Simd, WithSimd};

/// Looks along a flight after which the search is left to others.
const MOST_LOOKS: f64 = 200.0;
/// The most lanes of a vector.
const MOST_LANES: usize = 8;

/// Two bodies, and a law without friction.
pub(super) struct LanePair<'a, 'b, B> {
    bodies: [&'a Partner; 2],
    law: &'a Law<'b>,
    shapes: [B; 2],
    surfaces: Surfaces,
    /// The largest distance of a ball from the centre of mass, of both.
    furthest: [f64; 2],
    reach: f64,
}

/// The surfaces that can touch.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Surfaces {
    /// Balls about the centres.
    Spheres,
    /// Balls.
    Balls,
    /// One ball or spheroid each.
    Spheroids,
}

/// A ball of a body.
pub(super) struct LaneBall {
    /// Its place; on an axis along z.
    place: Vector,
    /// The distance from the centre of mass.
    distance: f64,
    radius: f64,
}

/// A kind of bodies that are followed in lanes.
pub(super) trait LaneBody: Sized {
    /// One in each lane.
    type Flight<S: Simd>: LaneFlight<S, Body = Self>;

    /// The body, if it is of this kind.
    fn new(body: &Partner) -> Option<Self>;
    /// Its balls, if it consists of them.
    fn balls(&self) -> &[LaneBall];
    /// The surfaces of two of them that can touch.
    fn surfaces(bodies: [&Partner; 2], shapes: &[Self; 2]) -> Option<Surfaces>;
}

/// One body in each lane, during a flight.
pub(super) trait LaneFlight<S: Simd>: Sized {
    type Body: LaneBody<Flight<S> = Self>;
    /// A place of the body.
    type Place: Lanewise<S>;
    /// The body at a time.
    type Pose;
    /// Bodies whose encounters have ended.
    type Ended;
    /// Flights that have ended in fewer lanes than these wait for others, since those of all lanes begin in the time of one.
    const FEW: u32;

    fn none(simd: S) -> Self;
    /// Puts a body into a lane.
    fn put(&mut self, lane: usize, body: &Self::Body, state: &FreeBody);
    /// Begins a flight in some lanes; returns those in which it is known.
    fn begin(&mut self, body: &Self::Body, fresh: Mask<S>) -> Mask<S>;
    /// The largest acceleration of a point, per distance from the centre of mass.
    fn bend(&self) -> Pack<S>;
    /// Turns the bodies of some lanes for a time.
    fn turn(&mut self, lanes: Mask<S>, time: Pack<S>);
    /// The bodies at a time.
    fn pose(&mut self, body: &Self::Body, time: Pack<S>) -> Self::Pose;
    /// A place and its velocity, with those of the ball of this number added with a sign.
    fn moved(
        &self,
        pose: &Self::Pose,
        ball: (usize, &LaneBall),
        sign: f64,
        from: [Vectors<S>; 2],
    ) -> [Vectors<S>; 2];

    /// Makes it that of a ball in some lanes.
    fn choose(place: &mut Self::Place, lanes: Mask<S>, ball: &LaneBall);
    /// A vector with that to a place now added with a sign.
    fn reached(&self, place: Self::Place, sign: f64, from: Vectors<S>) -> Vectors<S>;
    /// **p** × **n**.
    fn arm(&self, place: Self::Place, normal: Vectors<S>) -> Vectors<S>;
    /// K_nn with that of this body.
    fn compliance(&self, body: &Self::Body, arm: Vectors<S>, from: Pack<S>) -> Pack<S>;
    /// The velocity along **n** of the place with this arm, from that of the centre of mass.
    fn speed(&self, arm: Vectors<S>) -> Pack<S>;
    /// Changes the angular momentum by an impulse along **n**.
    fn push(&mut self, body: &Self::Body, arm: Vectors<S>, impulse: Pack<S>); // (11)

    /// Looks at the bodies in some lanes.
    #[inline(always)]
    fn look(
        all: &mut Encountering<S, Self>,
        pair: &LanePair<'_, '_, Self::Body>,
        _: Mask<S>,
    ) -> NearestParts<S> {
        all.look(pair)
    }

    /// Where they touch in some lanes, with balls of these numbers.
    #[inline(always)]
    fn meet(
        all: &mut Encountering<S, Self>,
        pair: &LanePair<'_, '_, Self::Body>,
        _: Mask<S>,
        balls: Pack<S>,
    ) -> LaneContact<S, Self::Place> {
        all.meet(pair, balls)
    }

    fn ended(simd: S) -> Self::Ended;
    /// Adds those of a lane.
    fn add(
        ended: &mut Self::Ended,
        all: &Encountering<S, Self>,
        lane: usize,
        job: usize,
        run: &mut LaneEncounters<'_, '_, '_, Self::Body>,
    );
    /// Finds how all of them are turned, if that has not been done.
    fn find(ended: &mut Self::Ended, pair: &LanePair<'_, '_, Self::Body>, ends: &mut [Option<End>]);
}

/// Encounters that are followed in lanes.
pub(super) struct LaneEncounters<'a, 'b, 'c, B> {
    pair: &'c LanePair<'a, 'b, B>,
    approaches: &'c [Approach],
    chance: Chance<'c>,
    hit: Option<OnHit<'c>>,
    ends: &'c mut [Option<End>],
}

impl<'a, 'b, B: LaneBody> LanePair<'a, 'b, B> {
    /// The pair, if it is one, and the law is one without friction.
    pub fn new(bodies: [&'a Partner; 2], law: &'a Law<'b>) -> Option<Self> {
        if law.custom.is_some() || !matches!(law.rule, Rule::Frictionless(_)) {
            return None;
        }
        let [one, two] = bodies;
        let shapes = [B::new(one)?, B::new(two)?];
        let furthest = |shape: &B| {
            let distances = shape.balls().iter().map(|ball| ball.distance);
            distances.fold(0.0, f64::max)
        };
        Some(Self {
            bodies,
            law,
            surfaces: B::surfaces(bodies, &shapes)?,
            furthest: [furthest(&shapes[0]), furthest(&shapes[1])],
            shapes,
            reach: one.reach + two.reach,
        })
    }

    /// Follows some encounters; `chance` and `hit` are those of [`Follower::follow`](super::Follower::follow), and the ends of what is left to others remain none.
    #[inline(always)]
    pub fn follow<'c>(
        &'c self,
        level: Level,
        approaches: &'c [Approach],
        chance: Chance<'c>,
        hit: Option<OnHit<'c>>,
        ends: &'c mut [Option<End>],
    ) {
        level.run(LaneEncounters {
            pair: self,
            approaches,
            chance,
            hit,
            ends,
        });
    }

    /// True for two balls about their centres.
    #[inline(always)]
    pub fn is_of_spheres(&self) -> bool {
        self.surfaces == Surfaces::Spheres
    }
}

/// The lanes that are true, as bits: what [`Mask::each`] would call for each is not compiled for the vectors unless it is small.
#[inline(always)]
fn bits<S: Simd>(mask: Mask<S>) -> u32 {
    let lanes = mask.select(1.0, 0.0);
    let mut bits = 0;
    for (lane, &number) in lanes.as_slice().iter().enumerate() {
        bits |= u32::from(number == 1.0) << lane;
    }
    bits
}

/// Takes the first lane off.
#[inline(always)]
fn take(bits: &mut u32) -> Option<usize> {
    let first = bits.trailing_zeros();
    *bits &= bits.wrapping_sub(1);
    (first < u32::BITS).then_some(first as usize)
}

/// The encounters in the lanes.
pub(super) struct Encountering<S: Simd, F> {
    /// Place and velocity of the first bodies relative to the second, at the beginning of the flight.
    apart: Vectors<S>,
    velocity: Vectors<S>,
    bodies: [F; 2],
    /// Those in which a flight is not known.
    unknown: Mask<S>,
    /// Since the flight began: the time of the next look, and that at which they are out of reach; 0 if they are from the beginning, infinite if only
    /// their rotation moves them.
    time: Pack<S>,
    until: Pack<S>,
    /// The two balls that leave each other, counted from 1, or 0, and their speed.
    left: Pack<S>,
    left_speed: Pack<S>,
    /// The last normal between spheroids, or none.
    normal: Vectors<S>,
    /// A time in which no gap changes visibly if its rate is 0.
    shortest: Pack<S>,
    looks: Pack<S>,
    /// Since the encounter was given.
    clock: Pack<S>,
    contacts: Pack<S>,
    steps: Pack<S>,
    /// The impulses on the first body, and their sum with the time of each as a factor.
    impulse: Vectors<S>,
    moment: Vectors<S>,
}

/// The result of a look: the time up to which nothing touches, and of the two balls that may touch then their number from 1 on, rate and bound of the gap.
pub(super) struct NearestParts<S: Simd> {
    clear: Pack<S>,
    balls: Pack<S>,
    rate: Pack<S>,
    bound: Pack<S>,
}

/// The normal of a contact, the places of the balls that touch, and the radius of the first.
pub(super) type LaneContact<S, P> = (Vectors<S>, [P; 2], Pack<S>);

impl<S: Simd, F: LaneFlight<S>> Encountering<S, F> {
    #[inline(always)]
    fn none(simd: S) -> Self {
        let (zero, still) = (Pack::none(simd), Vectors::none(simd));
        Self {
            apart: Vectors::splat(simd, UNITS[2]),
            velocity: still,
            bodies: [F::none(simd), F::none(simd)],
            unknown: Mask::splat(simd, false),
            time: zero,
            until: zero,
            left: zero,
            left_speed: zero,
            normal: still,
            shortest: zero,
            looks: zero,
            clock: zero,
            contacts: zero,
            steps: zero,
            impulse: still,
            moment: still,
        }
    }

    /// Puts an encounter into a lane.
    #[inline(always)]
    fn put(&mut self, lane: usize, pair: &LanePair<'_, '_, F::Body>, states: &[FreeBody; 2]) {
        let [one, two] = states;
        self.apart.put(lane, one.position - two.position);
        self.velocity.put(lane, one.velocity - two.velocity);
        self.bodies[0].put(lane, &pair.shapes[0], one);
        self.bodies[1].put(lane, &pair.shapes[1], two);
        for pack in [
            &mut self.left,
            &mut self.clock,
            &mut self.contacts,
            &mut self.steps,
        ] {
            pack.as_mut_slice()[lane] = 0.0;
        }
        self.normal.put(lane, Vector::default());
        self.impulse.put(lane, Vector::default());
        self.moment.put(lane, Vector::default());
    }

    /// Begins flights in some lanes.
    #[inline(always)]
    fn begin(&mut self, pair: &LanePair<'_, '_, F::Body>, fresh: Mask<S>) {
        let simd = self.time.simd();
        let zero = Pack::splat(simd, 0.0);
        let reach = pair.reach;
        let (enters, until) = within(self.apart, self.velocity, reach);
        self.time = fresh.select(enters, self.time);
        self.until = fresh.select(until, self.until);
        self.looks = fresh.select(0.0, self.looks);
        let mut most = zero;
        for i in 0..2 {
            let body = &mut self.bodies[i];
            self.unknown = self.unknown | (fresh & !body.begin(&pair.shapes[i], fresh));
            most = body.bend().mul_add(pair.furthest[i], most);
        }
        if pair.surfaces == Surfaces::Spheres {
            // They touch where they come into reach of each other, and that once.
            let met = zero.lt(self.contacts) | !self.apart.dot(self.velocity).lt(0.0);
            self.time = fresh.select(met.select(f64::INFINITY, self.time), self.time);
            return;
        }
        let turns = zero.lt(most);
        let shortest = (INVISIBLE * reach / turns.select(most, 1.0)).sqrt();
        self.shortest = fresh.select(turns.select(shortest, 0.0), self.shortest);
    }

    /// Looks at all balls.
    #[inline(always)]
    fn look(&mut self, pair: &LanePair<'_, '_, F::Body>) -> NearestParts<S> {
        let simd = self.time.simd();
        let infinite = Pack::splat(simd, f64::INFINITY);
        let zero = Pack::splat(simd, 0.0);
        let [one, two] = &mut self.bodies;
        let poses = [
            one.pose(&pair.shapes[0], self.time),
            two.pose(&pair.shapes[1], self.time),
        ];
        let y = self.velocity.mul_add(self.time, self.apart);
        let leaves = self.time.eq(0.0);
        let (mut first, mut number) = (
            NearestParts {
                clear: infinite,
                balls: zero,
                rate: zero,
                bound: zero,
            },
            0.0,
        );
        for (i, ball) in pair.shapes[0].balls().iter().enumerate() {
            let from = one.moved(&poses[0], (i, ball), 1.0, [y, self.velocity]);
            let bend = one.bend() * ball.distance;
            for (j, other) in pair.shapes[1].balls().iter().enumerate() {
                number += 1.0;
                let left = leaves & self.left.eq(number);
                let bound = two.bend().mul_add(other.distance, bend);
                let [y, change] = two.moved(&poses[1], (j, other), -1.0, from);
                let mut gap = BallGaps::new(y, change, ball.radius + other.radius, bound);
                gap.width = left.select(0.0, gap.width);
                gap.rate = left.select(self.left_speed, gap.rate);
                let step = gap.step(self.shortest);
                let nearer = step.lt(first.clear);
                first = NearestParts {
                    clear: nearer.select(step, first.clear),
                    balls: nearer.select(number, first.balls),
                    rate: nearer.select(gap.rate, first.rate),
                    bound: nearer.select(gap.bound + gap.bent, first.bound),
                };
            }
        }
        first
    }

    /// Moves the bodies of some lanes for a time.
    #[inline(always)]
    fn pass(&mut self, lanes: Mask<S>, time: Pack<S>) {
        self.apart = self
            .apart
            .or(lanes, self.velocity.mul_add(time, self.apart));
        self.clock = lanes.select(self.clock + time, self.clock);
        for body in &mut self.bodies {
            body.turn(lanes, time);
        }
    }

    /// Where balls of these numbers touch.
    #[inline(always)]
    fn meet(&self, pair: &LanePair<'_, '_, F::Body>, balls: Pack<S>) -> LaneContact<S, F::Place> {
        let simd = balls.simd();
        let nowhere = F::Place::none(simd);
        let (mut places, mut radius) = ([nowhere; 2], Pack::splat(simd, 0.0));
        let mut number = 0.0;
        for ball in pair.shapes[0].balls() {
            for other in pair.shapes[1].balls() {
                number += 1.0;
                let these = balls.eq(number);
                F::choose(&mut places[0], these, ball);
                F::choose(&mut places[1], these, other);
                radius = these.select(ball.radius, radius);
            }
        }
        let [one, two] = &self.bodies;
        let y = two.reached(places[1], -1.0, one.reached(places[0], 1.0, self.apart));
        (y * (1.0 / y.dot(y).sqrt()), places, radius)
    }

    /// The centre of a body of a lane now.
    #[inline(always)]
    fn place(
        &self,
        lane: usize,
        i: usize,
        pair: &LanePair<'_, '_, F::Body>,
        from: &Approach,
    ) -> Vector {
        let (state, clock) = (&from.states[i], self.clock.as_slice()[lane]);
        let pushed = self.impulse.lane(lane) * clock - self.moment.lane(lane);
        let part = [1.0, -1.0][i] * pair.bodies[i].inverse_mass;
        pushed.mul_add(part, state.velocity.mul_add(clock, state.position))
    }

    /// The end of the encounter in a lane, with attitudes and spins as they were before it.
    #[inline(always)]
    fn end(
        &self,
        lane: usize,
        pair: &LanePair<'_, '_, F::Body>,
        from: &Approach,
    ) -> Outcome<FreeBody> {
        let (clock, contacts) = (self.clock.as_slice()[lane], self.contacts.as_slice()[lane]);
        let mut states = from.states;
        for (i, state) in states.iter_mut().enumerate() {
            let part = [1.0, -1.0][i] * pair.bodies[i].inverse_mass;
            state.position = self.place(lane, i, pair, from);
            state.velocity = self.impulse.lane(lane).mul_add(part, state.velocity);
        }
        Outcome {
            states,
            time: clock,
            contacts: contacts as u64,
            ending: if contacts > 0.0 {
                Ending::Parted
            } else {
                Ending::Missed
            },
            steps: self.steps.as_slice()[lane] as u64,
        }
    }

    /// Turns the bodies of some lanes for the times that have passed before.
    #[inline(always)]
    fn turn_before(
        &mut self,
        run: &LaneEncounters<'_, '_, '_, F::Body>,
        jobs: &[usize; MOST_LANES],
        fresh: Mask<S>,
    ) {
        for (i, body) in self.bodies.iter_mut().enumerate() {
            let mut passed = Pack::splat(self.time.simd(), 0.0);
            let mut lanes = bits(fresh);
            while let Some(lane) = take(&mut lanes) {
                passed.as_mut_slice()[lane] = run.approaches[jobs[lane]].passed[i];
            }
            self.unknown = self.unknown | (fresh & !body.begin(&run.pair.shapes[i], fresh));
            body.turn(fresh, passed);
        }
    }
}

impl<B: LaneBody> LaneEncounters<'_, '_, '_, B> {
    /// The contacts in some lanes, of the balls of these numbers; returns the lanes in which the balls leave each other.
    #[inline(always)]
    fn collide<S: Simd>(
        &mut self,
        all: &mut Encountering<S, B::Flight<S>>,
        jobs: &[usize; MOST_LANES],
        touched: Mask<S>,
        balls: Pack<S>,
    ) -> Mask<S> {
        let pair = self.pair;
        let zero = Pack::splat(balls.simd(), 0.0);
        let (normal, places, radius) = B::Flight::meet(all, pair, touched, balls);
        let [one, two] = &all.bodies;
        let arms = [one.arm(places[0], normal), two.arm(places[1], normal)];
        let free = pair.bodies[0].inverse_mass + pair.bodies[1].inverse_mass;
        let compliance = one.compliance(&pair.shapes[0], arms[0], zero + free);
        let compliance = two.compliance(&pair.shapes[1], arms[1], compliance);
        let turning = one.speed(arms[0]) - two.speed(arms[1]);
        let speed = (-(normal.dot(all.velocity) + turning)).max(0.0);
        let mut chances = None;
        if pair.law.deviation > 0.0 {
            let chances = chances.insert(zero + 0.5);
            let mut lanes = bits(touched);
            while let Some(lane) = take(&mut lanes) {
                let contact = all.contacts.as_slice()[lane] as u64;
                chances.as_mut_slice()[lane] = (self.chance)(jobs[lane], contact);
            }
        }
        let coefficient = pair.law.coefficient(speed, chances);
        let size = Frictionless::impulse(coefficient, speed, compliance);
        let size = touched.select(size, 0.0);
        let apart = coefficient * speed;
        if let Some(hit) = &mut self.hit {
            let from = Vectors::none(zero.simd());
            let firsts = one.reached(places[0], 1.0, from) - normal * radius;
            let mut lanes = bits(touched);
            while let Some(lane) = take(&mut lanes) {
                let at = |pack: &Pack<S>| pack.as_slice()[lane];
                let (job, normal) = (jobs[lane], normal.lane(lane));
                let centre = all.place(lane, 0, pair, &self.approaches[job]);
                hit(
                    job,
                    &Hit {
                        number: at(&all.contacts) as u64,
                        time: at(&all.clock),
                        normal,
                        point: centre + firsts.lane(lane),
                        impulse: normal * at(&size),
                        apart: all.apart.lane(lane),
                        velocity: all.velocity.lane(lane),
                        speeds: [at(&speed), at(&apart)],
                    },
                );
            }
        }
        let impulse = normal * size;
        all.impulse = normal.mul_add(size, all.impulse);
        all.moment = impulse.mul_add(all.clock, all.moment);
        all.velocity = impulse.mul_add(free, all.velocity);
        all.bodies[0].push(&pair.shapes[0], arms[0], size);
        all.bodies[1].push(&pair.shapes[1], arms[1], -size);
        all.contacts = touched.select(all.contacts + 1.0, all.contacts);
        all.left = touched.select(balls, all.left);
        all.left_speed = touched.select(apart, all.left_speed);
        zero.lt(apart)
    }
}

impl<B: LaneBody> WithSimd for LaneEncounters<'_, '_, '_, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let pair = self.pair;
        let reach = pair.reach;
        let mut all = Encountering::<S, B::Flight<S>>::none(simd);
        let mut rotations = B::Flight::ended(simd);
        let mut jobs = [0; MOST_LANES];
        let mut next = 0;
        let few = B::Flight::<S>::FEW;
        let none = Mask::splat(simd, false);
        let (mut active, mut fresh) = (none, none);
        loop {
            if next < self.approaches.len() && !active.all() {
                let mut waits = false;
                let mut lanes = bits(!active);
                while next < self.approaches.len()
                    && let Some(lane) = take(&mut lanes)
                {
                    let approach = &self.approaches[next];
                    all.put(lane, pair, &approach.states);
                    jobs[lane] = next;
                    active.set(lane, true);
                    fresh.set(lane, true);
                    waits |= approach.passed[0] > 0.0 || approach.passed[1] > 0.0;
                    next += 1;
                }
                if waits {
                    all.turn_before(&self, &jobs, fresh & all.contacts.eq(0.0));
                }
            }
            if !active.any() {
                B::Flight::find(&mut rotations, pair, self.ends);
                return;
            }
            if fresh.any() {
                all.begin(pair, fresh);
            }
            let look;
            let (closes, best);
            if pair.surfaces == Surfaces::Spheres {
                let one = Pack::splat(simd, 1.0);
                look = NearestParts {
                    clear: all.time,
                    balls: one,
                    rate: one,
                    bound: one * f64::INFINITY,
                };
                best = all.time;
                closes = Mask::splat(simd, true);
            } else {
                look = B::Flight::look(&mut all, pair, active);
                best = all.time + look.clear;
                let square = look.clear * look.clear;
                closes = look.rate.lt(0.0) & (look.bound * square).le(INVISIBLE * reach);
            }
            let zero = Pack::splat(simd, 0.0);
            let again = zero.lt(all.contacts);
            let within = best.lt(all.until);
            let (mut touched, mut passed) = (active & within & closes, active & !within);
            let goes_on = active & !(touched | passed);
            let mut looked = active;
            if goes_on.any() && bits(touched | passed).count_ones() < few {
                (looked, touched, passed) = (goes_on, none, none);
            }
            all.looks = looked.select(all.looks + 1.0, all.looks);
            let counts = looked & (zero.lt(all.until) | again);
            all.steps = counts.select(all.steps + 1.0, all.steps);
            let short = (look.bound * best * best).lt(UNRESOLVED * reach);
            let endless = active & !all.until.lt(f64::INFINITY);
            let mut hard = (goes_on & Pack::splat(simd, MOST_LOOKS).lt(all.looks))
                | (touched & short & again)
                | endless
                | all.unknown;
            let after = best.max(all.time * (1.0 + f64::EPSILON));
            let ended = touched | passed;
            if ended.any() {
                all.pass(ended, touched.select(best, all.until));
                if touched.any() {
                    let leaves = self.collide(&mut all, &jobs, touched, look.balls);
                    hard = hard | (touched & !leaves);
                }
            }
            all.time = goes_on.select(after, all.time);
            let mut lanes = bits(passed & !hard);
            while let Some(lane) = take(&mut lanes) {
                let job = jobs[lane];
                self.ends[job] = Some(Ok(all.end(lane, pair, &self.approaches[job])));
                B::Flight::add(&mut rotations, &all, lane, job, &mut self);
            }
            active = active & !(passed | hard);
            all.unknown = none;
            fresh = touched & active;
        }
    }
}
