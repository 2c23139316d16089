//! Encounters of bodies that are balls on an axis, such as dumbbells, or spheroids, without friction: one in each lane of a vector.
//!
//! The axis **e** of such a body turns about **Λ** at the rate Ω = |Λ|/J, and all that a contact without friction sees of the body is its axis: a unit
//! impulse along **n** on the ball at x**e**, or on a spheroid where it is as far from the axis as such a ball, changes **Λ**/J by (x/J) **e** × **n**, so that K_nn is the sum of 1/m + (x²/J)|**e** × **n**|² of both (10). The spin about
//! the axis is constant, and is added to the attitude at the end. What takes more (contacts that may last or accumulate, bodies that only rotation moves, a search that does not end soon)
//! is rare, and left to [`Following`](super::encounter::Following).

use super::encounter::{Chance, End, Ending, Hit, OnHit, Outcome, UNRESOLVED};
use super::partner::{Approach, FreeBody, Partner};
use crate::contact::{BallGaps, INVISIBLE, RoundPart, RoundParts, TurningAxis};
use crate::law::{Frictionless, Law, Rule};
use crate::math::quaternion::{product, rotated, square};
use crate::math::{Quaternion, UNITS, Vector, Vectors};
use crate::shape::{Piece, PieceKind};
use crate::simd::elementary::sincos_in_lanes;
use crate::simd::{Mask, Pack};
use pulp::{Simd, WithSimd};

/// Looks along a flight after which the search is left to others.
const MOST_LOOKS: f64 = 200.0;
/// The most lanes of a vector.
const MOST_LANES: usize = 8;

/// Two bodies of balls on an axis, or of one ball or spheroid each, and a law without friction.
pub(super) struct AxialPair<'a, 'b> {
    bodies: [&'a Partner; 2],
    law: &'a Law<'b>,
    lines: [AxialBody; 2],
    surfaces: Surfaces,
    reach: f64,
}

/// What touches.
#[derive(Clone, Copy, PartialEq)]
enum Surfaces {
    /// Balls about the centres.
    Spheres,
    /// Balls.
    Balls,
    /// One ball or spheroid each.
    Spheroids,
}

/// A body of balls on its axis, or of one part on it.
struct AxialBody {
    /// The principal axis of this number.
    axis: usize,
    /// Their places along it and their radii.
    balls: Vec<[f64; 2]>,
    part: Option<RoundPart>,
    /// The largest distance of one from the centre of mass.
    furthest: f64,
    /// The moment of inertia across it, and that about it, over this.
    inertia: f64,
    ratio: f64,
}

/// Encounters that are followed in lanes.
pub(super) struct AxialEncounters<'a, 'b, 'c> {
    pub pair: &'c AxialPair<'a, 'b>,
    pub approaches: &'c [Approach],
    /// A uniform number in (0, 1) for a contact of one of them.
    pub chance: Chance<'c>,
    /// Receives the contacts of each, if they are asked for.
    pub hit: Option<OnHit<'c>>,
    /// The end of each; none of those that are left to others.
    pub ends: &'c mut [Option<End>],
}

impl<'a, 'b> AxialPair<'a, 'b> {
    /// The pair, if it is one, and the law is one without friction.
    pub fn new(bodies: [&'a Partner; 2], law: &'a Law<'b>) -> Option<Self> {
        if law.custom.is_some() || !matches!(law.rule, Rule::Frictionless(_)) {
            return None;
        }
        let [one, two] = bodies;
        let lines = [AxialBody::new(one)?, AxialBody::new(two)?];
        let surfaces = if one.is_ball() && two.is_ball() {
            Surfaces::Spheres
        } else if lines.iter().all(|line| !line.balls.is_empty()) {
            Surfaces::Balls
        } else if lines.iter().all(|line| line.part.is_some()) {
            Surfaces::Spheroids
        } else {
            return None;
        };
        Some(Self {
            bodies,
            law,
            lines,
            surfaces,
            reach: one.reach + two.reach,
        })
    }

    /// True for two balls about their centres.
    #[inline(always)]
    pub fn is_of_spheres(&self) -> bool {
        self.surfaces == Surfaces::Spheres
    }

    /// The two parts of spheroids.
    #[inline(always)]
    fn parts(&self) -> Option<RoundParts<'_>> {
        if self.surfaces != Surfaces::Spheroids {
            return None;
        }
        let [one, two] = &self.lines;
        Some(RoundParts {
            parts: [one.part.as_ref()?, two.part.as_ref()?],
            reach: self.reach,
        })
    }
}

impl AxialBody {
    fn new(body: &Partner) -> Option<Self> {
        let axis = body.axis?;
        let ball = |piece: &Piece| match piece.kind {
            PieceKind::Ball(place, radius) => Some([place.parts()[axis], radius]),
            _ => None,
        };
        let moments = body.top.moments();
        let inertia = moments[(axis + 1) % 3];
        let balls: Option<Vec<[f64; 2]>> = body.pieces.iter().map(ball).collect();
        let balls = balls.unwrap_or_default();
        // A dumbbell may be two balls in one place.
        let (first, others) = body.pieces.split_first()?;
        let alone = others.iter().all(|piece| piece == first);
        let part = alone.then(|| RoundPart::new(first, axis)).flatten();
        Some(Self {
            axis,
            furthest: balls.iter().map(|&[x, _]| x.abs()).fold(0.0, f64::max),
            balls,
            part,
            inertia,
            ratio: moments[axis] / inertia,
        })
    }
}

/// The lanes that are true, as bits: what [`Mask::each`] would call for each is not compiled for the vectors unless it is small.
#[inline(always)]
fn bits<S: Simd>(mask: Mask<S, 1>) -> u32 {
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

/// One body in each lane, during a flight.
struct Line<S: Simd> {
    /// **e** at its beginning, and **Λ**/J.
    axis: Vectors<S, 1>,
    precession: Vectors<S, 1>,
    /// The rotation of **e** since the encounter was given.
    turned: Turned<S>,
    /// Of **e** the part along **Λ**, that across, and **Λ** × **e**/|Λ|; Ω, and |**e**″|.
    motion: [Vectors<S, 1>; 3],
    rate: Pack<S, 1>,
    bend: Pack<S, 1>,
    /// Of a spheroid the largest distance of its points from **Λ**.
    swing: Pack<S, 1>,
}

/// A unit quaternion in each lane.
#[derive(Clone, Copy)]
struct Turned<S: Simd> {
    w: Pack<S, 1>,
    v: Vectors<S, 1>,
}

impl<S: Simd> Turned<S> {
    #[inline(always)]
    fn none(simd: S) -> Self {
        Self {
            w: Pack::splat(simd, 1.0),
            v: Vectors::splat(simd, Vector::default()),
        }
    }

    /// The same, and then turned about a unit vector by the angle of which sine and cosine of the half are given.
    #[inline(always)]
    fn then(self, about: Vectors<S, 1>, (sine, cosine): (Pack<S, 1>, Pack<S, 1>)) -> Self {
        let v = about.times(sine);
        Self {
            w: cosine * self.w - v.dot(self.v),
            v: self.v.mul_add(cosine, v.mul_add(self.w, v.cross(self.v))),
        }
    }

    #[inline(always)]
    fn parts(self) -> [Pack<S, 1>; 4] {
        [self.w, self.v.x, self.v.y, self.v.z]
    }

    #[inline(always)]
    fn of([w, x, y, z]: [Pack<S, 1>; 4]) -> Self {
        Self {
            w,
            v: Vectors { x, y, z },
        }
    }

    /// The rotation by the second and then by this.
    #[inline(always)]
    fn times(self, second: Self) -> Self {
        Self::of(product(self.parts(), second.parts()))
    }

    #[inline(always)]
    fn normalized(self) -> Self {
        let part = 1.0 / square(self.parts()).sqrt();
        Self {
            w: self.w * part,
            v: self.v.times(part),
        }
    }

    /// A vector before the rotation.
    #[inline(always)]
    fn back(self, v: Vectors<S, 1>) -> Vectors<S, 1> {
        let back = self.v.times(-1.0);
        let [x, y, z] = rotated([self.w, back.x, back.y, back.z], [v.x, v.y, v.z]);
        Vectors { x, y, z }
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, of: Quaternion) {
        self.w.as_mut_slice()[lane] = of.w;
        self.v.put(lane, Vector::new(of.x, of.y, of.z));
    }

    #[inline(always)]
    fn lane(&self, lane: usize) -> Quaternion {
        let Vector { x, y, z } = self.v.lane(lane);
        Quaternion::new(self.w.as_slice()[lane], x, y, z)
    }
}

impl<S: Simd> Line<S> {
    #[inline(always)]
    fn none(simd: S) -> Self {
        let (zero, still) = (
            Pack::splat(simd, 0.0),
            Vectors::splat(simd, Vector::default()),
        );
        Self {
            axis: Vectors::splat(simd, UNITS[2]),
            precession: still,
            turned: Turned::none(simd),
            motion: [still; 3],
            rate: zero,
            bend: zero,
            swing: zero,
        }
    }

    /// Puts a body into a lane.
    #[inline(always)]
    fn put(&mut self, lane: usize, line: &AxialBody, state: &FreeBody) {
        let mut spin = state.spin.parts();
        spin[line.axis] *= line.ratio;
        let [x, y, z] = spin;
        self.axis.put(lane, state.attitude.rotate(UNITS[line.axis]));
        self.precession
            .put(lane, state.attitude.rotate(Vector::new(x, y, z)));
        self.turned.put(lane, Quaternion::IDENTITY);
    }

    /// Begins a flight in some lanes.
    #[inline(always)]
    fn begin(&mut self, line: &AxialBody, fresh: Mask<S, 1>) {
        let square = self.precession.dot(self.precession);
        let rate = square.sqrt();
        let turns = Pack::splat(rate.simd(), 0.0).lt(rate);
        let about = self
            .axis
            .or(turns, self.precession.times(1.0 / turns.select(rate, 1.0)));
        let third = about.cross(self.axis);
        let second = third.cross(about);
        let cosine = about.dot(self.axis);
        let along = about.times(cosine);
        let [one, two, three] = self.motion;
        self.motion = [
            one.or(fresh, along),
            two.or(fresh, second),
            three.or(fresh, third),
        ];
        self.rate = fresh.select(rate, self.rate);
        let sine = third.dot(third).sqrt();
        self.bend = fresh.select(square * sine, self.bend);
        if let Some(part) = &line.part {
            self.swing = fresh.select(part.swing(sine, cosine), self.swing);
        }
    }

    /// **e** and **e**′ at a time, of which sine and cosine of the angle are given.
    #[inline(always)]
    fn at(&self, (sine, cosine): (Pack<S, 1>, Pack<S, 1>)) -> [Vectors<S, 1>; 2] {
        let [along, second, third] = self.motion;
        let axis = third.mul_add(sine, second.mul_add(cosine, along));
        let change = third.times(cosine).minus(second.times(sine));
        [axis, change.times(self.rate)]
    }

    /// The same with what turns it.
    #[inline(always)]
    fn turning(&self, time: Pack<S, 1>) -> TurningAxis<S> {
        let [axis, change] = self.at(sincos_in_lanes(self.rate * time));
        TurningAxis {
            axis,
            change,
            turn: self.precession,
            rate: self.rate,
            swing: self.swing,
        }
    }

    /// Turns the bodies of some lanes for a time.
    #[inline(always)]
    fn turn(&mut self, lanes: Mask<S, 1>, time: Pack<S, 1>) {
        let half = sincos_in_lanes(0.5 * self.rate * time);
        let (s, c) = half;
        let [axis, _] = self.at((2.0 * s * c, c * c - s * s));
        // Of length 1: about Λ, or with the angle 0.
        let still = Pack::splat(time.simd(), 0.0).lt(self.rate);
        let about = self.precession.times(1.0 / still.select(self.rate, 1.0));
        let later = self.turned.then(about, half);
        self.axis = self.axis.or(lanes, axis);
        self.turned.w = lanes.select(later.w, self.turned.w);
        self.turned.v = self.turned.v.or(lanes, later.v);
    }
}

/// The encounters in the lanes.
struct Encountering<S: Simd> {
    /// Place and velocity of the first bodies relative to the second, at the beginning of the flight.
    apart: Vectors<S, 1>,
    velocity: Vectors<S, 1>,
    lines: [Line<S>; 2],
    /// Since the flight began: the time of the next look, and that at which they are out of reach; 0 if they are from the beginning, infinite if only
    /// their rotation moves them.
    time: Pack<S, 1>,
    until: Pack<S, 1>,
    /// The two balls that leave each other, counted from 1, or 0, and their speed.
    left: Pack<S, 1>,
    left_speed: Pack<S, 1>,
    /// The last normal between spheroids, or none.
    normal: Vectors<S, 1>,
    /// A time in which no gap changes visibly if its rate is 0.
    shortest: Pack<S, 1>,
    looks: Pack<S, 1>,
    /// Since the encounter was given.
    clock: Pack<S, 1>,
    contacts: Pack<S, 1>,
    steps: Pack<S, 1>,
    /// The impulses on the first body, and their sum with the time of each as a factor.
    impulse: Vectors<S, 1>,
    moment: Vectors<S, 1>,
}

/// What a look finds: the time up to which nothing touches, and of the two balls that may touch then their number from 1 on, rate and bound of the gap.
struct NearestBalls<S: Simd> {
    clear: Pack<S, 1>,
    balls: Pack<S, 1>,
    rate: Pack<S, 1>,
    bound: Pack<S, 1>,
}

impl<S: Simd> Encountering<S> {
    #[inline(always)]
    fn none(simd: S) -> Self {
        let (zero, still) = (
            Pack::splat(simd, 0.0),
            Vectors::splat(simd, Vector::default()),
        );
        Self {
            apart: Vectors::splat(simd, UNITS[2]),
            velocity: still,
            lines: [Line::none(simd), Line::none(simd)],
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
    fn put(&mut self, lane: usize, pair: &AxialPair<'_, '_>, states: &[FreeBody; 2]) {
        let [one, two] = states;
        self.apart.put(lane, one.position - two.position);
        self.velocity.put(lane, one.velocity - two.velocity);
        self.lines[0].put(lane, &pair.lines[0], one);
        self.lines[1].put(lane, &pair.lines[1], two);
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
    fn begin(&mut self, pair: &AxialPair<'_, '_>, fresh: Mask<S, 1>) {
        let simd = self.time.simd();
        let zero = Pack::splat(simd, 0.0);
        let (y, u, reach) = (self.apart, self.velocity, pair.reach);
        let (square, along) = (u.dot(u), y.dot(u));
        let beyond = y.dot(y) - reach * reach;
        let across = y.cross(u);
        let chord = square * (reach * reach) - across.dot(across);
        let root = chord.max(0.0).sqrt();
        let (parts, comes) = (zero.lt(along), along.lt(0.0));
        let leaves = parts.select(-beyond, root - along) / parts.select(along + root, square);
        let enters = comes.select(beyond / comes.select(root - along, 1.0), 0.0);
        let meets = zero.lt(chord) & zero.lt(leaves);
        let stays = square.eq(0.0) & beyond.le(0.0);
        let until = stays.select(f64::INFINITY, meets.select(leaves, 0.0));
        self.time = fresh.select(enters.max(0.0), self.time);
        self.until = fresh.select(until, self.until);
        self.looks = fresh.select(0.0, self.looks);
        let mut most = zero;
        for i in 0..2 {
            self.lines[i].begin(&pair.lines[i], fresh);
            most = self.lines[i].bend.mul_add(pair.lines[i].furthest, most);
        }
        if pair.surfaces == Surfaces::Spheres {
            // They touch where they come into reach of each other, and that once.
            let met = zero.lt(self.contacts) | !comes;
            self.time = fresh.select(met.select(f64::INFINITY, self.time), self.time);
            return;
        }
        let turns = zero.lt(most);
        let shortest = (INVISIBLE * reach / turns.select(most, 1.0)).sqrt();
        self.shortest = fresh.select(turns.select(shortest, 0.0), self.shortest);
    }

    /// Looks at spheroids in some lanes.
    #[inline(always)]
    fn look_round(&mut self, parts: &RoundParts<'_>, active: Mask<S, 1>) -> NearestBalls<S> {
        let bodies = [
            self.lines[0].turning(self.time),
            self.lines[1].turning(self.time),
        ];
        let axes = [bodies[0].axis, bodies[1].axis];
        let apart = self.velocity.mul_add(self.time, self.apart);
        let between = parts.between(apart, axes);
        self.normal = parts.normal(self.normal(between), between, axes, active, true);
        let zero = Pack::splat(self.time.simd(), 0.0);
        let leaves = self.time.eq(0.0) & zero.lt(self.left);
        let motion = [apart, self.velocity];
        let found = parts.step(self.normal, motion, &bodies, (leaves, self.left_speed));
        NearestBalls {
            clear: found.clear,
            balls: zero + 1.0,
            rate: found.rate,
            bound: found.bound,
        }
    }

    /// The last normal, or that between the centres.
    #[inline(always)]
    fn normal(&self, between: Vectors<S, 1>) -> Vectors<S, 1> {
        let none = self.normal.dot(self.normal).eq(0.0);
        let along = between.times(1.0 / between.dot(between).sqrt());
        self.normal.or(none, along)
    }

    /// Looks at all balls.
    #[inline(always)]
    fn look(&self, pair: &AxialPair<'_, '_>) -> NearestBalls<S> {
        let simd = self.time.simd();
        let infinite = Pack::splat(simd, f64::INFINITY);
        let zero = Pack::splat(simd, 0.0);
        let [one, two] = &self.lines;
        let [e, de] = one.at(sincos_in_lanes(one.rate * self.time));
        let [f, df] = two.at(sincos_in_lanes(two.rate * self.time));
        let y = self.velocity.mul_add(self.time, self.apart);
        let leaves = self.time.eq(0.0);
        let (mut first, mut number) = (
            NearestBalls {
                clear: infinite,
                balls: zero,
                rate: zero,
                bound: zero,
            },
            0.0,
        );
        for &[x, radius] in &pair.lines[0].balls {
            let (from, change) = (e.mul_add(x, y), de.mul_add(x, self.velocity));
            let bend = one.bend * x.abs();
            for &[place, size] in &pair.lines[1].balls {
                number += 1.0;
                let left = leaves & self.left.eq(number);
                let bound = two.bend.mul_add(place.abs(), bend);
                let mut gap = BallGaps::new(
                    f.mul_add(-place, from),
                    df.mul_add(-place, change),
                    radius + size,
                    bound,
                );
                gap.width = left.select(0.0, gap.width);
                gap.rate = left.select(self.left_speed, gap.rate);
                let step = gap.step(self.shortest);
                let nearer = step.lt(first.clear);
                first = NearestBalls {
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
    fn pass(&mut self, lanes: Mask<S, 1>, time: Pack<S, 1>) {
        self.apart = self
            .apart
            .or(lanes, self.velocity.mul_add(time, self.apart));
        self.clock = lanes.select(self.clock + time, self.clock);
        for line in &mut self.lines {
            line.turn(lanes, time);
        }
    }
}

impl AxialEncounters<'_, '_, '_> {
    /// The contacts in some lanes, of the balls of these numbers; returns the lanes in which the balls leave each other.
    #[inline(always)]
    fn collide<S: Simd>(
        &mut self,
        all: &mut Encountering<S>,
        jobs: &[usize; MOST_LANES],
        touched: Mask<S, 1>,
        balls: Pack<S, 1>,
    ) -> Mask<S, 1> {
        let pair = self.pair;
        let zero = Pack::splat(balls.simd(), 0.0);
        let (normal, places, radius) = match pair.parts() {
            Some(parts) => all.meet_round(&parts, touched),
            None => all.meet(pair, balls),
        };
        let [one, two] = &all.lines;
        let arms = [
            one.axis.cross(normal).times(places[0]),
            two.axis.cross(normal).times(places[1]),
        ];
        let inverse = [1.0 / pair.lines[0].inertia, 1.0 / pair.lines[1].inertia];
        let free = pair.bodies[0].inverse_mass + pair.bodies[1].inverse_mass;
        let compliance = arms[1]
            .dot(arms[1])
            .mul_add(inverse[1], arms[0].dot(arms[0]).mul_add(inverse[0], free));
        let turning = one.precession.dot(arms[0]) - two.precession.dot(arms[1]);
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
            let mut lanes = bits(touched);
            while let Some(lane) = take(&mut lanes) {
                let at = |pack: &Pack<S, 1>| pack.as_slice()[lane];
                let (job, normal) = (jobs[lane], normal.lane(lane));
                let first = one.axis.lane(lane) * at(&places[0]) - normal * at(&radius);
                let centre = all.place(lane, 0, pair, &self.approaches[job]);
                hit(
                    job,
                    &Hit {
                        number: at(&all.contacts) as u64,
                        time: at(&all.clock),
                        normal,
                        point: centre + first,
                        impulse: normal * at(&size),
                        apart: all.apart.lane(lane),
                        velocity: all.velocity.lane(lane),
                        speeds: [at(&speed), at(&apart)],
                    },
                );
            }
        }
        let impulse = normal.times(size);
        all.impulse = normal.mul_add(size, all.impulse);
        all.moment = impulse.mul_add(all.clock, all.moment);
        all.velocity = impulse.mul_add(free, all.velocity);
        for (i, part) in [inverse[0], -inverse[1]].into_iter().enumerate() {
            let line = &mut all.lines[i];
            line.precession = arms[i].mul_add(size * part, line.precession); // (11)
        }
        all.contacts = touched.select(all.contacts + 1.0, all.contacts);
        all.left = touched.select(balls, all.left);
        all.left_speed = touched.select(apart, all.left_speed);
        zero.lt(apart)
    }
}

/// The normal of a contact, the places on the axes where the balls are that touch, and the radius of the first.
type AxialContact<S> = (Vectors<S, 1>, [Pack<S, 1>; 2], Pack<S, 1>);

impl<S: Simd> Encountering<S> {
    /// Where balls of these numbers touch.
    #[inline(always)]
    fn meet(&self, pair: &AxialPair<'_, '_>, balls: Pack<S, 1>) -> AxialContact<S> {
        let zero = Pack::splat(balls.simd(), 0.0);
        let (mut places, mut radius, mut number) = ([zero; 2], zero, 0.0);
        for &[x, size] in &pair.lines[0].balls {
            for &[place, _] in &pair.lines[1].balls {
                number += 1.0;
                let these = balls.eq(number);
                places = [these.select(x, places[0]), these.select(place, places[1])];
                radius = these.select(size, radius);
            }
        }
        let [one, two] = &self.lines;
        let y = two
            .axis
            .mul_add(-places[1], one.axis.mul_add(places[0], self.apart));
        (y.times(1.0 / y.dot(y).sqrt()), places, radius)
    }

    /// Where spheroids touch, in some lanes.
    #[inline(always)]
    fn meet_round(&mut self, parts: &RoundParts<'_>, touched: Mask<S, 1>) -> AxialContact<S> {
        let axes = [self.lines[0].axis, self.lines[1].axis];
        let between = parts.between(self.apart, axes);
        self.normal = parts.normal(self.normal, between, axes, touched, false);
        let found = parts.contact(self.normal, between, axes);
        (self.normal, found.places, found.radius)
    }

    /// The centre of a body of a lane now.
    #[inline(always)]
    fn place(&self, lane: usize, i: usize, pair: &AxialPair<'_, '_>, from: &Approach) -> Vector {
        let (state, clock) = (&from.states[i], self.clock.as_slice()[lane]);
        let pushed = self.impulse.lane(lane) * clock - self.moment.lane(lane);
        let part = [1.0, -1.0][i] * pair.bodies[i].inverse_mass;
        pushed.mul_add(part, state.velocity.mul_add(clock, state.position))
    }

    /// The end of the encounter in a lane, with attitudes and spins as they were before it.
    #[inline(always)]
    fn end(&self, lane: usize, pair: &AxialPair<'_, '_>, from: &Approach) -> Outcome<FreeBody> {
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
}

/// The rotation of bodies whose encounters have ended, one in each lane: it is found for as many as there are lanes at once.
struct EndedRotations<S: Simd> {
    count: usize,
    jobs: [usize; MOST_LANES],
    bodies: [EndedRotation<S>; 2],
}

/// Of one of both bodies: its attitude at first, its rotation since then but for that about its own axis, **Λ**/J, the spin about the axis, and the time.
#[derive(Clone, Copy)]
struct EndedRotation<S: Simd> {
    attitude: Turned<S>,
    turned: Turned<S>,
    precession: Vectors<S, 1>,
    own: Pack<S, 1>,
    time: Pack<S, 1>,
}

impl<S: Simd> EndedRotations<S> {
    #[inline(always)]
    fn none(simd: S) -> Self {
        let zero = Pack::splat(simd, 0.0);
        let body = EndedRotation {
            attitude: Turned::none(simd),
            turned: Turned::none(simd),
            precession: Vectors::splat(simd, Vector::default()),
            own: zero,
            time: zero,
        };
        Self {
            count: 0,
            jobs: [0; MOST_LANES],
            bodies: [body; 2],
        }
    }

    /// Adds those of a lane.
    #[inline(always)]
    fn add(
        &mut self,
        all: &Encountering<S>,
        lane: usize,
        job: usize,
        run: &AxialEncounters<'_, '_, '_>,
    ) {
        let (to, from) = (self.count, &run.approaches[job]);
        self.jobs[to] = job;
        for i in 0..2 {
            let (body, line, state) = (&mut self.bodies[i], &all.lines[i], &from.states[i]);
            body.attitude.put(to, state.attitude);
            body.turned.put(to, line.turned.lane(lane));
            body.precession.put(to, line.precession.lane(lane));
            body.own.as_mut_slice()[to] = state.spin.parts()[run.pair.lines[i].axis];
            body.time.as_mut_slice()[to] = from.passed[i] + all.clock.as_slice()[lane];
        }
        self.count += 1;
    }

    /// Finds all of them.
    #[inline(always)]
    fn find(&mut self, pair: &AxialPair<'_, '_>, ends: &mut [Option<End>]) {
        for i in 0..2 {
            let (line, body) = (&pair.lines[i], &self.bodies[i]);
            let axis = Vectors::splat(body.own.simd(), UNITS[line.axis]);
            let (sine, cosine) = sincos_in_lanes(0.5 * body.own * (1.0 - line.ratio) * body.time);
            let roll = Turned {
                w: cosine,
                v: axis.times(sine),
            };
            let rolled = body.attitude.times(roll);
            let attitude = body.turned.times(rolled).normalized();
            let spins = attitude.back(body.precession);
            for lane in 0..self.count {
                if let Some(Ok(end)) = &mut ends[self.jobs[lane]] {
                    let mut spin = spins.lane(lane).parts();
                    spin[line.axis] = body.own.as_slice()[lane];
                    let [x, y, z] = spin;
                    end.states[i].attitude = attitude.lane(lane);
                    end.states[i].spin = Vector::new(x, y, z);
                }
            }
        }
        self.count = 0;
    }
}

impl WithSimd for AxialEncounters<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let pair = self.pair;
        let reach = pair.reach;
        let mut all = Encountering::none(simd);
        let mut rotations = EndedRotations::none(simd);
        let mut jobs = [0; MOST_LANES];
        let mut next = 0;
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
                rotations.find(pair, self.ends);
                return;
            }
            if fresh.any() {
                all.begin(pair, fresh);
            }
            let look;
            let (closes, best);
            if pair.surfaces == Surfaces::Spheres {
                let one = Pack::splat(simd, 1.0);
                look = NearestBalls {
                    clear: all.time,
                    balls: one,
                    rate: one,
                    bound: one * f64::INFINITY,
                };
                best = all.time;
                closes = Mask::splat(simd, true);
            } else {
                look = match pair.parts() {
                    Some(parts) => all.look_round(&parts, active),
                    None => all.look(pair),
                };
                best = all.time + look.clear;
                let square = look.clear * look.clear;
                closes = look.rate.lt(0.0) & (look.bound * square).le(INVISIBLE * reach);
            }
            all.looks = all.looks + 1.0;
            let zero = Pack::splat(simd, 0.0);
            let again = zero.lt(all.contacts);
            all.steps = (zero.lt(all.until) | again).select(all.steps + 1.0, all.steps);
            let within = best.lt(all.until);
            let touched = active & within & closes;
            let passed = active & !within;
            let short = (look.bound * best * best).lt(UNRESOLVED * reach);
            let endless = active & !all.until.lt(f64::INFINITY);
            let mut hard =
                (active & !(touched | passed) & Pack::splat(simd, MOST_LOOKS).lt(all.looks))
                    | (touched & short & again)
                    | endless;
            let after = best.max(all.time * (1.0 + f64::EPSILON));
            let ended = touched | passed;
            if ended.any() {
                all.pass(ended, touched.select(best, all.until));
                if touched.any() {
                    let leaves = self.collide(&mut all, &jobs, touched, look.balls);
                    hard = hard | (touched & !leaves);
                }
            }
            all.time = after;
            let mut lanes = bits(passed & !hard);
            while let Some(lane) = take(&mut lanes) {
                let job = jobs[lane];
                self.ends[job] = Some(Ok(all.end(lane, pair, &self.approaches[job])));
                rotations.add(&all, lane, job, &self);
                if rotations.count == Pack::<S, 1>::WIDTH {
                    rotations.find(pair, self.ends);
                }
            }
            active = active & !(passed | hard);
            fresh = touched & active;
        }
    }
}

impl<S: Simd> Encountering<S> {
    /// Turns the bodies of some lanes for the times that have passed before.
    #[inline(always)]
    fn turn_before(
        &mut self,
        run: &AxialEncounters<'_, '_, '_>,
        jobs: &[usize; MOST_LANES],
        fresh: Mask<S, 1>,
    ) {
        for (i, line) in self.lines.iter_mut().enumerate() {
            let mut passed = Pack::splat(self.time.simd(), 0.0);
            let mut lanes = bits(fresh);
            while let Some(lane) = take(&mut lanes) {
                passed.as_mut_slice()[lane] = run.approaches[jobs[lane]].passed[i];
            }
            line.begin(&run.pair.lines[i], fresh);
            line.turn(fresh, passed);
        }
    }
}
