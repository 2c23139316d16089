//! A group of particles, as many as a vector has lanes, and the stages from one impact to the next.

use super::end::{COLLAPSE_RUN, Limits, StopReason, UNRESOLVED};
use super::impact::{Impact, Sink};
use super::strike::{Strike, Touch, Turn};
use crate::body::{Body, Hull};
use crate::collision::{Contacts, Respond, Responses};
use crate::flight::{Flight, State, States};
use crate::search::{Arrival, Departure, Leap, Look, Residue, Search};
use crate::simd::{Mask, Pack};
use pulp::Simd;
use std::ops::Range;

/// The flight of a group with planar or spatial motion T.
type FlightOf<S, T> = <T as Turn>::Flight<S, 1>;
/// The state of a group.
pub(crate) type StateOf<S, T> = <FlightOf<S, T> as Flight<S, 1>>::State;
/// Velocity and angular momentum of a group, which an impact changes.
type MotionOf<S, T> = <StateOf<S, T> as States<S, 1>>::Motion;

/// Number of groups that alternate: enough to keep the arithmetic units busy, few enough for the first-level cache.
pub(crate) const GROUPS: usize = 12;

/// Largest number of lanes of a vector.
const LANES: usize = 8;

/// The initial conditions of particles.
pub(crate) trait Release {
    /// The state of a particle at its release.
    fn start(&self, particle: usize) -> State;
}

/// The particle whose contact search did not converge.
#[derive(Debug)]
pub(crate) struct Stuck {
    pub lane: usize,
    pub impacts: usize,
}

/// A contact that was located, in each lane.
pub(crate) struct Found<S: Simd, T: Turn> {
    /// Flight time.
    pub time: Pack<S, 1>,
    /// The state just before the impact.
    pub state: StateOf<S, T>,
    /// +1 or −1: sphere 1 or 2 touches.
    pub sphere: Pack<S, 1>,
}

/// As many particles as a vector has lanes. Aligned to a cache line, so that no vector straddles two lines.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Group<S: Simd, T: Turn> {
    /// The search along the flight. The start of the flight is later replaced by the state before the impact.
    search: Search<S, FlightOf<S, T>, 1>,
    /// The time of the evaluation, with sine and cosine of the angle turned through by then.
    pub time: Pack<S, 1>,
    pub turned: (Pack<S, 1>, Pack<S, 1>),
    /// The gap there, and the results of the stages that follow.
    look: Look<S, 1>,
    leap: Leap<S, 1>,
    residue: Residue<S, 1>,
    arrival: Arrival<S, 1>,
    /// The time up to which a contact is ruled out, and the lanes in which it is ruled out up to the evaluation as well.
    certain: Pack<S, 1>,
    clear: Mask<S, 1>,
    /// The motion after the impact.
    after: MotionOf<S, T>,
    /// Speed at which the point of contact approached the plane.
    approach: Pack<S, 1>,
    /// Time since release.
    clock: Pack<S, 1>,
    /// Unresolved flights in a row.
    unresolved: Pack<S, 1>,
    /// The lanes whose particle has not stopped.
    pub active: Mask<S, 1>,
    /// Number of the particle in lane 0, and number of particles.
    first: usize,
    particles: usize,
    /// Number of impacts and stop reason of the particles that have stopped.
    ends: [(usize, StopReason); LANES],
}

impl<S: Simd, T: Turn> Group<S, T> {
    /// A group without particles; its lanes hold a body at rest.
    #[inline(always)]
    pub fn empty(simd: S, hull: &impl Hull) -> Self {
        let zero = Pack::splat(simd, 0.0);
        let state = StateOf::<S, T>::resting(simd, 1.0);
        let departure = Departure {
            sphere: zero,
            speed: zero,
        };
        let part = hull.part(Mask::splat(simd, false));
        Self {
            search: Search::new(FlightOf::<S, T>::new(state, 0.0), departure, hull),
            look: Look::nothing(part),
            leap: Leap::none(simd),
            residue: Residue::none(simd),
            arrival: Arrival::none(simd),
            certain: zero,
            clear: Mask::splat(simd, true),
            time: zero,
            turned: (zero, zero),
            after: state.motion(),
            approach: zero,
            clock: zero,
            unresolved: zero,
            active: Mask::splat(simd, false),
            first: 0,
            particles: 0,
            ends: [(0, StopReason::Interrupted); LANES],
        }
    }

    /// Puts `particles` of a release into the lanes, at most as many as there are. The sink knows them by numbers from `first` on.
    #[inline(always)]
    pub fn occupy(
        &mut self,
        first: usize,
        particles: Range<usize>,
        release: &impl Release,
        slope: f64,
        hull: &impl Hull,
    ) {
        let mut state = self.before();
        let mut occupied = 0.0 * self.clock;
        (self.first, self.particles) = (first, particles.len());
        for (lane, particle) in particles.enumerate() {
            state.put(lane, &release.start(particle));
            occupied.as_mut_slice()[lane] = 1.0;
        }
        self.active = occupied.eq(1.0);
        self.search = Search::released(FlightOf::<S, T>::new(state, slope), hull);
    }

    /// The state before the impact, or at the start of the flight.
    #[inline(always)]
    fn before(&self) -> StateOf<S, T> {
        *self.search.flight.start()
    }

    /// Replaces the departure of the release by that of an impact.
    pub fn depart_from(&mut self, departure: Departure<S, 1>) {
        self.search.departure = departure;
    }

    /// The contact of lane 0, or the stop reason if there is none.
    pub fn found(&self) -> Result<Found<S, T>, StopReason> {
        if self.active.any() {
            Ok(Found {
                time: self.arrival.time,
                state: self.before(),
                sphere: self.search.departure.sphere,
            })
        } else {
            Err(self.ends[0].1)
        }
    }

    /// The angle turned through at the time of the evaluation.
    #[inline(always)]
    pub fn angle(&self) -> Pack<S, 1> {
        self.search.angle(self.time)
    }

    /// Determines the time of the first evaluation, and ends the particles that rest.
    #[inline(always)]
    pub fn depart(&mut self, number: usize, hull: &impl Hull) {
        let still = self.search.departure.speed.le(0.0);
        if still.any() {
            let rests = still & self.search.rests(hull);
            self.end(rests, number, StopReason::Collapse);
        }
        self.time = self.search.departed(hull);
    }

    #[inline(always)]
    pub fn look(&mut self, hull: &impl Hull) {
        self.look = self.search.look(self.time, self.turned, hull);
    }

    #[inline(always)]
    pub fn leap(&mut self, hull: &impl Hull) {
        self.leap = self.search.leap(&self.look, hull);
    }

    #[inline(always)]
    pub fn residue(&mut self, hull: &impl Hull) {
        self.residue = self.search.residue(self.time, &self.look, &self.leap, hull);
    }

    #[inline(always)]
    pub fn arrive(&mut self, hull: &impl Hull) {
        self.arrival = self
            .search
            .arrival(&self.look, &self.leap, &self.residue, hull);
    }

    /// Whether the contact of some particle is not located yet: rare after the first pass, except for spinning smooth hulls.
    #[inline(always)]
    pub fn is_waiting(&self) -> bool {
        (self.active & !self.arrival.done).any()
    }

    /// Ends the particles that never land.
    #[inline(always)]
    pub fn end_those_that_never_land(&mut self, number: usize) {
        self.end(self.look.never, number, StopReason::NeverLands);
    }

    /// Ends the search in the lanes whose certified step leaves a gap below the resolution.
    #[inline(always)]
    pub fn graze(&mut self) {
        let Self {
            time,
            look,
            leap,
            clear,
            arrival,
            ..
        } = self;
        self.search.graze(*time, look, leap, *clear, arrival);
    }

    /// Determines the time of the next evaluation. Lanes that are done keep theirs and repeat the same result.
    #[inline(always)]
    pub fn go_on(&mut self, hull: &impl Hull) {
        let (clear, done) = (self.clear, self.arrival.done);
        let certain = self.search.certain(self.time, &self.leap);
        let certain = clear.select(certain, self.certain);
        let aim = self
            .search
            .aim(certain, &self.leap, &self.residue, &self.arrival, hull);
        let next = clear.select(aim, certain);
        self.time = done.select(self.time, next);
        self.certain = done.select(self.time, certain);
    }

    /// Determines the lanes in which no contact can have been missed before the evaluation. The others are not done.
    #[inline(always)]
    pub fn clear(&mut self, hull: &impl Hull) {
        self.clear = self
            .search
            .is_clear(self.certain, self.time, &self.look, hull);
        self.arrival.done = self.arrival.done & self.clear;
    }

    /// Replaces the start of the flight by the state at the contact.
    #[inline(always)]
    pub fn land(&mut self, hull: &impl Hull) {
        let Arrival { time, attitude, .. } = self.arrival;
        let state = self.search.flight.state(time, attitude);
        let (part, tilt) = (&self.look.gap.part, state.tilt());
        self.search.departure.sphere = hull.name(part, tilt);
        self.search.flight.end(state, hull.lift(part, tilt)); // (2)
    }

    /// Applies the collision law.
    #[inline(always)]
    pub fn collide(&mut self, body: &Body, hull: &impl Hull, law: &impl Respond) {
        let touch = Touch::of(hull, &self.look.gap.part, self.before().tilt());
        let struck = self.before().strike(body, law, touch);
        self.after = struck.motion;
        self.approach = struck.approach;
        self.search.departure.speed = struck.separation;
    }

    /// The contact as a law sees it.
    #[inline(always)]
    pub fn contact(&self, body: &Body, hull: &impl Hull) -> Contacts<S, 1> {
        let touch = Touch::of(hull, &self.look.gap.part, self.before().tilt());
        self.before().contact(body, touch)
    }

    /// Applies what a law answered.
    #[inline(always)]
    pub fn respond(
        &mut self,
        body: &Body,
        hull: &impl Hull,
        approach: Pack<S, 1>,
        response: &Responses<S, 1>,
    ) {
        let touch = Touch::of(hull, &self.look.gap.part, self.before().tilt());
        self.after = self.before().respond(body, touch, response);
        self.approach = approach;
        self.search.departure.speed = response.separation_speed;
    }

    /// Hands the impact to the sink, and ends the particles for which it was the last.
    #[inline(always)]
    pub fn tell(&mut self, body: &Body, limits: Limits, number: usize, sink: &mut impl Sink) {
        let before = self.before();
        let after = before.moving(self.after);
        self.clock = self.clock + self.arrival.time;
        let energy_after = after.kinetic_energy(body);
        let impact = Impact {
            time: self.clock,
            fall: -before.climb(),
            rise: after.climb(),
            rotation: before.rotational_energy(body),
            energy_before: before.kinetic_energy(body),
            energy_after,
            sine: before.sine(),
            cosine: before.tilt(),
            sphere: self.search.departure.sphere,
            approach: self.approach,
            before: before.in_space(),
            after: after.in_space(),
            active: self.active,
        };
        sink.impact(number, self.first, &impact);
        if limits.minimum_speed > 0.0 {
            let slow = (2.0 * energy_after).lt(limits.minimum_speed * limits.minimum_speed);
            self.end(slow, number + 1, StopReason::SpeedBelowThreshold);
        }
        let low = (self.search.bound * (self.arrival.time * self.arrival.time)).lt(UNRESOLVED);
        if low.any() {
            self.unresolved = low.select(self.unresolved + 1.0, 0.0);
            let collapsed = self.unresolved.eq(f64::from(COLLAPSE_RUN));
            self.end(collapsed, number + 1, StopReason::Collapse);
        } else {
            self.unresolved = Pack::splat(self.clock.simd(), 0.0);
        }
    }

    /// Starts the next flight.
    #[inline(always)]
    pub fn start(&mut self, slope: f64, hull: &impl Hull) {
        self.search.depart(self.after, slope, hull);
    }

    /// Ends the active lanes in `which`.
    #[inline(always)]
    pub fn end(&mut self, which: Mask<S, 1>, impacts: usize, reason: StopReason) {
        let ending = which & self.active;
        if ending.any() {
            ending.each(|lane| self.ends[lane] = (impacts, reason));
            self.active = self.active & !ending;
        }
    }

    /// Hands number of impacts and stop reason of every particle to the sink.
    pub fn close(&self, sink: &mut impl Sink) {
        for (lane, &(impacts, reason)) in self.ends[..self.particles].iter().enumerate() {
            sink.end(self.first + lane, impacts, reason);
        }
    }

    /// The first particle whose contact is not located.
    #[cold]
    pub fn stuck(&self, impacts: usize) -> Stuck {
        let mut first = None;
        (self.active & !self.arrival.done).each(|lane| {
            first.get_or_insert(self.first + lane);
        });
        Stuck {
            lane: first.unwrap_or(self.first),
            impacts,
        }
    }
}
