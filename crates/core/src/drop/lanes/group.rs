//! A group of particles, as many as a vector has lanes, and the stages from one impact to the next.

#[cfg(feature = "one-lane")]
#[path = "../../../tests/one_lane.rs"]
pub mod one_lane;

use super::collision::{Collide, ContactPoint, Dimension};
use super::impact::{Impact, ImpactSink, SymmetricPose};
use super::particles::{Lost, Particles, Release};
use crate::contact::{
    GapEvaluation, LastContact, LocatedContact, MOST_STEPS, Prediction, Search, Steps,
};
use crate::drop::stop::{Limits, StopReason};
use crate::law::{Contact, CustomLaw, Response};
use crate::motion::{Flight, SymmetricState};
use crate::shape::{Body, Hull};
use crate::simd::{Lanewise, Mask, Pack};
use pulp::Simd;
use std::ops::Range;

/// The flight of a group with planar or spatial motion T.
type FlightOf<S, T> = <T as Dimension>::Flight<S>;
/// The state of a group.
pub(crate) type StateOf<S, T> = <FlightOf<S, T> as Flight<S>>::State;
/// Velocity and angular momentum of a group, which an impact changes.
type MotionOf<S, T> = <StateOf<S, T> as SymmetricState<S>>::Motion;

/// The flights of as many particles as a vector has lanes, and the search for their contacts: a lane whose contact is not located yet
/// sits out the impacts of the others. Aligned to a cache line, so that no vector straddles two lines.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Group<S: Simd, T: Dimension> {
    /// The search along the flight. The start of the flight is later replaced by the state before the impact.
    search: Search<S, FlightOf<S, T>>,
    /// The time of the evaluation, with sine and cosine of the angle turned through by then.
    pub time: Pack<S>,
    pub turned: (Pack<S>, Pack<S>),
    /// The gap there, and the results of the stages that follow.
    evaluation: GapEvaluation<S>,
    steps: Steps<S>,
    prediction: Prediction<S>,
    located: LocatedContact<S>,
    /// The time up to which a contact is ruled out, and the lanes in which it is ruled out up to the evaluation as well.
    certain: Pack<S>,
    clear: Mask<S>,
    /// The lanes whose contact is not located by the passes so far, the number of these passes, and whether there are such lanes.
    waiting: Mask<S>,
    passes: Pack<S>,
    pub is_behind: bool,
    /// The motion after the impact.
    after: MotionOf<S, T>,
    /// Speed at which the point of contact approached the plane.
    approach: Pack<S>,
    pub particles: Particles<S>,
}

impl<S: Simd, T: Dimension> Group<S, T> {
    /// A group without particles; its lanes hold a body at rest.
    #[inline(always)]
    pub fn empty(simd: S, hull: &impl Hull) -> Self {
        let (zero, none) = (Pack::none(simd), Mask::none(simd));
        let state = StateOf::<S, T>::resting(simd, 1.0);
        let flight = FlightOf::<S, T>::new(state, 0.0);
        Self {
            search: Search::new(flight, LastContact::none(simd), hull),
            evaluation: GapEvaluation::none(simd),
            steps: Steps::none(simd),
            prediction: Prediction::none(simd),
            located: LocatedContact::none(simd),
            certain: zero,
            clear: !none,
            waiting: none,
            passes: zero,
            is_behind: false,
            time: zero,
            turned: (zero, zero),
            after: state.motion(),
            approach: zero,
            particles: Particles::none(simd),
        }
    }

    /// Puts the next particles of a release into the lanes that are free, as long as there are any.
    #[inline(always)]
    pub fn occupy(
        &mut self,
        release: &impl Release,
        particles: &mut Range<usize>,
        slope: f64,
        hull: &impl Hull,
    ) {
        let mut state = self.before().with_motion(self.after);
        let fresh = self.particles.occupy(particles, |lane, particle| {
            state.put(lane, &release.start(particle));
        });
        self.waiting = self.waiting & !fresh;
        let released = Search::released(FlightOf::<S, T>::new(state, slope), hull).last_contact;
        self.search.last_contact = self.search.last_contact.or(fresh, released);
        self.search.flight.end(state, state.height());
        self.after = state.motion();
    }

    /// The state before the impact, or at the start of the flight.
    #[inline(always)]
    fn before(&self) -> StateOf<S, T> {
        *self.search.flight.start()
    }

    /// The angle turned through at the time of the evaluation.
    #[inline(always)]
    pub fn angle(&self) -> Pack<S> {
        self.search.angle(self.time)
    }

    /// Determines the time of the first evaluation of the flights that begin, and ends the particles that rest.
    #[inline(always)]
    pub fn begin_search(&mut self, hull: &impl Hull) {
        let still = self.search.last_contact.speed.le(0.0);
        if still.any() {
            let rests = still & self.search.rests(hull);
            self.particles.end(rests, StopReason::Collapse);
        }
        let first = self.search.first_evaluation(hull);
        if self.is_behind {
            self.time = self.waiting.select(self.time, first);
            self.certain = self.waiting.select(self.certain, first);
        } else {
            self.time = first;
        }
    }

    #[inline(always)]
    pub fn evaluate(&mut self, hull: &impl Hull) {
        self.evaluation = self.search.evaluate(self.time, self.turned, hull);
    }

    #[inline(always)]
    pub fn propose(&mut self, hull: &impl Hull) {
        self.steps = self.search.steps(&self.evaluation, hull);
    }

    #[inline(always)]
    pub fn predict(&mut self, hull: &impl Hull) {
        self.prediction = self
            .search
            .predict(self.time, &self.evaluation, &self.steps, hull);
    }

    #[inline(always)]
    pub fn locate(&mut self, hull: &impl Hull) {
        self.located = self
            .search
            .locate(&self.evaluation, &self.steps, &self.prediction, hull);
    }

    /// Predicts the contact again, from where it was found, in the lanes in which it is not located yet.
    #[inline(always)]
    pub fn predict_again(&mut self, hull: &impl Hull) {
        self.steps = self.steps.on_to(&self.located, self.time);
        self.predict(hull);
        self.locate(hull);
    }

    /// Returns whether the contact of some particle was not located before this pass, or is not by this one: rare after the first pass,
    /// except for spinning smooth hulls.
    #[inline(always)]
    pub fn takes_another_pass(&self) -> bool {
        self.is_behind || (self.particles.active & !self.located.done).any()
    }

    /// 1 in each lane that waits, otherwise 0.
    #[inline(always)]
    pub fn behind(&self) -> Pack<S> {
        self.waiting.select(1.0, 0.0)
    }

    /// The lanes that have an impact.
    #[inline(always)]
    fn landing(&self) -> Mask<S> {
        self.particles.active & !self.waiting
    }

    /// Ends the particles that never land.
    #[inline(always)]
    pub fn end_those_that_never_land(&mut self) {
        self.particles
            .end(self.evaluation.never, StopReason::NeverLands);
    }

    /// Ends the search in the lanes whose certified step leaves a gap below the resolution.
    #[inline(always)]
    pub fn accept_grazing(&mut self) {
        if !self.takes_another_pass() {
            return;
        }
        let Self {
            time,
            evaluation,
            steps,
            clear,
            located,
            ..
        } = self;
        self.search
            .accept_grazing(*time, evaluation, steps, *clear, located);
    }

    /// Determines the lanes that go on, and the time of their next evaluation. The others keep theirs and repeat the same result.
    #[inline(always)]
    pub fn go_on(&mut self, hull: &impl Hull) {
        let (clear, done) = (self.clear, self.located.done);
        let certain = self.search.certain(self.time, &self.steps);
        let certain = clear.select(certain, self.certain);
        let aim = self
            .search
            .aim(certain, &self.steps, &self.prediction, &self.located, hull);
        let next = clear.select(aim, certain);
        self.time = done.select(self.time, next);
        self.certain = done.select(self.time, certain);
        self.passes = self.waiting.select(self.passes, 0.0) + 1.0;
        self.waiting = self.particles.active & !done;
        self.is_behind = self.waiting.any();
    }

    /// Determines the lanes in which no contact can have been missed before the evaluation. The others are not done.
    #[inline(always)]
    pub fn clear(&mut self, hull: &impl Hull) {
        if self.is_behind {
            self.clear = self
                .search
                .is_clear(self.certain, self.time, &self.evaluation, hull);
            self.located.done = self.located.done & self.clear;
        } else {
            self.clear = Mask::splat(self.time.simd(), true);
        }
    }

    /// Replaces the start of the flight by the state at the contact; returns the sphere that touches like the hull there.
    #[inline(always)]
    pub fn land(&mut self, hull: &impl Hull) -> ContactPoint<S> {
        let LocatedContact { time, attitude, .. } = self.located;
        let state = self.search.flight.state(time, attitude);
        let (part, cos_tilt) = (&self.evaluation.gap.part, state.cos_tilt());
        let (sphere, height) = (
            hull.name(part, cos_tilt),
            hull.touching_height(part, cos_tilt),
        ); // (2)
        let point = ContactPoint::of(hull, part, cos_tilt);
        let last_contact = &mut self.search.last_contact;
        if self.is_behind {
            let before = self.search.flight.start();
            let (state, height) = (
                state.or(self.waiting, *before),
                self.waiting.select(before.height(), height),
            );
            self.search.flight.end(state, height);
            last_contact.sphere = self.waiting.select(last_contact.sphere, sphere);
            point.or(self.waiting, ContactPoint::none(self.time.simd()))
        } else {
            self.search.flight.end(state, height);
            last_contact.sphere = sphere;
            point
        }
    }

    /// The contact that a law is asked about. Of lanes that have none it does not slip along **w**, which takes long.
    #[inline(always)]
    pub fn contact(&self, body: &Body, point: ContactPoint<S>) -> Contact<Pack<S>> {
        let mut contact = self.before().contact(body, point);
        if T::SPACE {
            let across = &mut contact.velocity.y;
            *across = self.landing().select(*across, 0.0);
        }
        contact
    }

    /// Asks a law of one's own about the contact in each lane that has one.
    #[cold]
    pub fn ask(
        &self,
        law: CustomLaw<'_>,
        point: ContactPoint<S>,
        contact: &Contact<Pack<S>>,
    ) -> Result<Response<Pack<S>>, Lost> {
        let along = self.before().along(point);
        let mut response = Response::none(self.time.simd());
        let mut found = Ok(());
        self.landing().each(|lane| {
            if found.is_err() {
                return;
            }
            match law.respond(&contact.lane(lane), along.map(|part| part.as_slice()[lane])) {
                Ok(answer) => response.put(lane, &answer),
                Err(fault) => found = Err(self.particles.lost(lane, Some(Box::new(fault)))),
            }
        });
        found.map(|()| response)
    }

    /// Takes the motion after an impact.
    #[inline(always)]
    pub fn leave(
        &mut self,
        body: &Body,
        point: ContactPoint<S>,
        contact: &Contact<Pack<S>>,
        response: &Response<Pack<S>>,
    ) {
        let before = *self.search.flight.start();
        let after = before.after(body, point, response);
        let separation = response.separation_speed;
        let last_contact = &mut self.search.last_contact;
        self.approach = contact.approach_speed();
        if self.is_behind {
            self.after = before.with_motion(after).or(self.waiting, before).motion();
            last_contact.speed = self.waiting.select(last_contact.speed, separation);
        } else {
            self.after = after;
            last_contact.speed = separation;
        }
    }

    /// Starts the next flight.
    #[inline(always)]
    pub fn start(&mut self, slope: f64, hull: &impl Hull) {
        self.search.continue_with(self.after, slope, hull);
    }

    /// Hands the impact to the sink, and ends the particles for which it was the last; returns whether any has ended since the last
    /// impact.
    #[inline(always)]
    pub fn report(
        &mut self,
        number: usize,
        body: &Body,
        limits: Limits,
        sink: &mut impl ImpactSink,
    ) -> bool {
        let mut ended = self.particles.has_ended;
        if ended {
            self.particles.close(sink);
        }
        let landing = self.landing();
        let before = self.before();
        let after = before.with_motion(self.after);
        let clock = self.particles.clock + self.located.time;
        let energy_after = after.kinetic_energy(body);
        let impact = Impact {
            particle: self.particles.number,
            number: self.particles.impacts(),
            time: clock,
            fall: -before.vz(),
            rise: after.vz(),
            rotation: before.rotational_energy(body),
            energy_before: before.kinetic_energy(body),
            energy_after,
            part: self.search.last_contact.sphere.lt(0.0).select(2.0, 1.0_f64),
            approach: self.approach,
            pose: SymmetricPose {
                body,
                sine: before.sine(),
                before: before.in_space(),
                after: after.in_space(),
            },
            active: landing,
        };
        sink.impact(number, &impact);
        let waiting = self.is_behind.then(|| self.behind());
        self.particles.count(landing, clock, waiting);
        if limits.minimum_speed > 0.0 {
            let slow = (2.0 * energy_after).lt(limits.minimum_speed * limits.minimum_speed);
            self.particles
                .end(slow & landing, StopReason::SpeedBelowThreshold);
        }
        let size = self.search.curvature_bound * (self.located.time * self.located.time);
        self.particles.end_collapsed(size, landing, self.waiting);
        self.particles.end_complete(limits.impacts);
        if self.particles.has_ended {
            self.particles.close(sink);
            ended = true;
        }
        ended
    }

    /// An error if the search of some particle takes too many passes.
    #[inline(always)]
    pub fn converged(&self) -> Result<(), Lost> {
        let lost = !self.passes.lt(f64::from(MOST_STEPS));
        let mut converged = Ok(());
        if lost.any() {
            lost.each(|lane| converged = Err(self.particles.lost(lane, None)));
        }
        converged
    }
}
