//! Contacts that take more than one step, out of many vectors: they wait in a queue for a lane, so that no lane is idle while others
//! are under way.

use super::{Course, Goal, OngoingImpacts, Origin, Rates, Slipping};
use crate::law::{Contact, Hypothesis, Response};
use crate::simd::{LANES, Mask, Pack};
use pulp::Simd;

/// A vector of contacts, and the answers of which some are not known yet.
#[derive(Clone, Copy)]
pub(super) struct Pending<S: Simd> {
    pub slipping: Slipping<S, 1>,
    /// 1 in the lanes whose answer is not known, else 0.
    pub open: Pack<S, 1>,
    pub response: Response<Pack<S, 1>>,
}

impl<S: Simd> Pending<S> {
    /// No contacts.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        Self {
            slipping: Slipping::none(simd),
            open: Pack::splat(simd, 0.0),
            response: Response::none(simd),
        }
    }
}

/// The lanes that have not had their turn.
#[derive(Default)]
struct Waiting {
    vector: usize,
    lane: usize,
}

impl Waiting {
    /// The next one: vector and lane.
    #[inline(always)]
    pub fn next<S: Simd>(&mut self, pending: &[Pending<S>]) -> Option<(usize, usize)> {
        while self.vector < pending.len() {
            let at = (self.vector, self.lane);
            self.lane += 1;
            if self.lane == Pack::<S, 1>::WIDTH {
                (self.vector, self.lane) = (self.vector + 1, 0);
            }
            if pending[at.0].open.as_slice()[at.1] == 1.0 {
                return Some(at);
            }
        }
        None
    }
}

impl<S: Simd> Slipping<S, 1> {
    /// No contact.
    #[inline(always)]
    fn none(simd: S) -> Self {
        Self::new(&Contact::none(simd), Pack::splat(simd, 0.0))
    }

    /// Puts lane k of another one into a lane.
    #[inline(always)]
    fn put(&mut self, lane: usize, other: &Self, k: usize) {
        for (to, from) in [
            (&mut self.speed, other.speed),
            (&mut self.along, other.along),
            (&mut self.across, other.across),
            (&mut self.nn, other.nn),
            (&mut self.nu, other.nu),
            (&mut self.uu, other.uu),
            (&mut self.ww, other.ww),
            (&mut self.restitution, other.restitution),
        ] {
            to.as_mut_slice()[lane] = from.as_slice()[k];
        }
    }
}

impl<S: Simd> OngoingImpacts<S> {
    /// Takes others in the lanes of the mask.
    #[inline(always)]
    fn take(&mut self, mask: Mask<S, 1>, others: &Self) {
        *self = Self {
            rates: Rates::choose(mask, &others.rates, &self.rates),
            goal: Goal::choose(mask, &others.goal, &self.goal),
            course: Course::choose(mask, &others.course, &self.course),
            origin: Origin::choose(mask, &others.origin, &self.origin),
        };
    }
}

/// Contacts under way.
struct TurningLanes<S: Simd> {
    impacts: OngoingImpacts<S>,
    friction: f64,
    hypothesis: Hypothesis,
    /// Vector and lane from which each has come; of lanes without one, none.
    places: [Option<(usize, usize)>; LANES],
}

impl<S: Simd> TurningLanes<S> {
    /// No contact, of the law of those that are pending.
    #[inline(always)]
    fn new(pending: &[Pending<S>], friction: f64, hypothesis: Hypothesis) -> Self {
        let nothing = Slipping::none(pending[0].open.simd());
        Self {
            impacts: OngoingImpacts::new(&nothing, friction, hypothesis),
            friction,
            hypothesis,
            places: [None; LANES],
        }
    }

    #[inline(always)]
    fn is_empty(&self) -> bool {
        self.impacts.course.over.all()
    }

    /// Puts contacts that wait into free lanes.
    #[inline(always)]
    fn begin(&mut self, waiting: &mut Waiting, pending: &[Pending<S>]) {
        let simd = pending[0].open.simd();
        let mut fresh = Slipping::none(simd);
        let mut taken = Pack::splat(simd, 0.0);
        let mut any = false;
        for (lane, place) in self.places[..Pack::<S, 1>::WIDTH].iter_mut().enumerate() {
            if place.is_some() {
                continue;
            }
            *place = waiting.next(pending);
            let Some((i, k)) = *place else { break };
            fresh.put(lane, &pending[i].slipping, k);
            taken.as_mut_slice()[lane] = 1.0;
            any = true;
        }
        if any {
            let new = OngoingImpacts::new(&fresh, self.friction, self.hypothesis);
            self.impacts.take(taken.eq(1.0), &new);
        }
    }

    /// Answers the contacts that are over.
    #[inline(always)]
    fn end(&mut self, pending: &mut [Pending<S>]) {
        let over = self.impacts.course.over;
        if !over.any() {
            return;
        }
        let answer = self.impacts.answer();
        let over = over.select(1.0, 0.0);
        for (lane, place) in self.places.iter_mut().enumerate() {
            if let Some((i, k)) = *place
                && over.as_slice()[lane] == 1.0
            {
                *place = None;
                let response = &mut pending[i].response;
                response.put(k, &answer.lane(lane));
            }
        }
    }
}

/// Finds the responses that are open.
#[inline(always)]
pub(super) fn finish<S: Simd>(pending: &mut [Pending<S>], friction: f64, hypothesis: Hypothesis) {
    let mut waiting = Waiting::default();
    let mut turning = TurningLanes::new(pending, friction, hypothesis);
    loop {
        turning.begin(&mut waiting, pending);
        if turning.is_empty() {
            break;
        }
        turning.impacts.stop();
        turning.end(pending);
        if !turning.is_empty() {
            turning.impacts.advance();
            turning.end(pending);
        }
    }
}
