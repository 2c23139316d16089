//! Contacts that take more than one step, out of many vectors: they wait in a queue for a lane, so that no lane is idle while others
//! are under way.

use super::{Course, Goal, OngoingImpacts, Rates};
use crate::law::{Contact, Coulomb, Response};
use crate::simd::{LANES, Mask, Pack};
use pulp::Simd;

/// Vector and lane from which the contact in each lane has come; none where there is no contact.
type Places = [Option<(usize, usize)>; LANES];

impl<S: Simd> OngoingImpacts<S> {
    /// Takes others in the lanes of the mask.
    #[inline(always)]
    fn take(&mut self, mask: Mask<S, 1>, others: &Self) {
        *self = Self {
            rates: Rates::choose(mask, &others.rates, &self.rates),
            goal: Goal::choose(mask, &others.goal, &self.goal),
            course: Course::choose(mask, &others.course, &self.course),
            panels: mask.select(others.panels, self.panels),
        };
    }

    /// Answers the contacts that are over, and frees their lanes.
    #[inline(always)]
    fn end(&self, places: &mut Places, responses: &mut [Response<Pack<S, 1>>]) {
        if !self.course.over.any() {
            return;
        }
        let answer = self.answer();
        let over = self.course.over.select(1.0, 0.0);
        for (lane, place) in places.iter_mut().enumerate() {
            if let Some((i, k)) = *place
                && over.as_slice()[lane] == 1.0
            {
                *place = None;
                responses[i].put(k, &answer.lane(lane));
            }
        }
    }
}

/// Finds the responses that are open: `open` is 1 in their lanes.
#[inline(always)]
pub(super) fn finish<S: Simd>(
    rule: &Coulomb,
    contacts: &[Contact<Pack<S, 1>>],
    restitution: &[Pack<S, 1>],
    open: &[Pack<S, 1>],
    responses: &mut [Response<Pack<S, 1>>],
) {
    let width = Pack::<S, 1>::WIDTH;
    let mut waiting = (0..contacts.len() * width)
        .map(|j| (j / width, j % width))
        .filter(|&(i, k)| open[i].as_slice()[k] == 1.0);
    let none = Pack::splat(open[0].simd(), 0.0);
    let nothing = Contact::none(none.simd());
    let mut impacts = OngoingImpacts::new(&nothing, none, rule);
    let mut places: Places = [None; LANES];
    loop {
        let (mut contact, mut coefficient, mut taken) = (nothing, none, none);
        for (lane, place) in places[..width].iter_mut().enumerate() {
            if place.is_some() {
                continue;
            }
            *place = waiting.next();
            let Some((i, k)) = *place else { break };
            contact.put(lane, &contacts[i].lane(k));
            coefficient.as_mut_slice()[lane] = restitution[i].as_slice()[k];
            taken.as_mut_slice()[lane] = 1.0;
        }
        let taken = taken.eq(1.0);
        if taken.any() {
            let new = OngoingImpacts::new(&contact, coefficient, rule);
            impacts.take(taken, &new);
        }
        if impacts.course.over.all() {
            break;
        }
        impacts.stop();
        impacts.end(&mut places, responses);
        if !impacts.course.over.all() {
            impacts.advance();
            impacts.end(&mut places, responses);
        }
    }
}
