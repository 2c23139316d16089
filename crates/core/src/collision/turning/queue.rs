//! Contacts that take more than one step, out of many vectors: they wait in a queue for a lane, so that no lane is idle while others
//! are under way.

use super::{Course, Goal, Impacts, Rates, Slipping};
use crate::collision::{Hypothesis, Late};
use crate::simd::{LANES, Mask, Pack};
use pulp::{Simd, WithSimd};

impl<S: Simd> Slipping<S, 1> {
    /// No contact.
    #[inline(always)]
    pub(in crate::collision) fn nothing(simd: S) -> Self {
        let zero = Pack::splat(simd, 0.0);
        Self {
            speed: zero,
            along: zero,
            across: zero,
            nn: zero,
            nu: zero,
            uu: zero,
            ww: zero,
            restitution: zero,
        }
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

impl<S: Simd> Impacts<S> {
    /// Takes other impacts in the lanes of the mask.
    #[inline(always)]
    fn take(&mut self, mask: Mask<S, 1>, new: &Self) {
        self.rates = Rates::choose(mask, &new.rates, &self.rates);
        self.goal = Goal::choose(mask, &new.goal, &self.goal);
        self.course = Course::choose(mask, &new.course, &self.course);
        self.panels = mask.select(new.panels, self.panels);
        self.scale = mask.select(new.scale, self.scale);
        self.aside = mask & new.aside | !mask & self.aside;
        self.left = mask & new.left | !mask & self.left;
    }
}

/// The lanes that have not had their turn.
struct Waiting {
    vector: usize,
    lane: usize,
}

impl Waiting {
    /// The next one: vector and lane.
    #[inline(always)]
    fn next<S: Simd>(&mut self, late: &[Late<S>]) -> Option<(usize, usize)> {
        while self.vector < late.len() {
            let at = (self.vector, self.lane);
            self.lane += 1;
            if self.lane == Pack::<S, 1>::WIDTH {
                (self.vector, self.lane) = (self.vector + 1, 0);
            }
            if late[at.0].open.as_slice()[at.1] == 1.0 {
                return Some(at);
            }
        }
        None
    }
}

/// Finds the responses that are open.
#[inline(always)]
pub(crate) fn finish<S: Simd>(late: &mut [Late<S>], friction: f64, hypothesis: Hypothesis) {
    let Some(first) = late.first() else { return };
    let simd = first.open.simd();
    simd.vectorize(Finish {
        late,
        friction,
        hypothesis,
    });
}

/// [`finish`], to be compiled once.
struct Finish<'a, S: Simd> {
    late: &'a mut [Late<S>],
    friction: f64,
    hypothesis: Hypothesis,
}

impl<S: Simd> WithSimd for Finish<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: Simd>(self, _: T) {
        let Self {
            late,
            friction,
            hypothesis,
        } = self;
        let zero = Pack::splat(late[0].open.simd(), 0.0);
        let mut waiting = Waiting { vector: 0, lane: 0 };
        // Vectors and lanes from which the impacts under way have come.
        let mut places = [None; LANES];
        let mut fresh = Slipping::nothing(zero.simd());
        let mut impacts = Impacts::new(&fresh, friction, hypothesis);
        loop {
            let mut taken = zero;
            for (lane, place) in places[..Pack::<S, 1>::WIDTH].iter_mut().enumerate() {
                if place.is_some() {
                    continue;
                }
                *place = waiting.next(late);
                let Some((i, k)) = *place else { break };
                fresh.put(lane, &late[i].slipping, k);
                taken.as_mut_slice()[lane] = 1.0;
            }
            let taken = taken.eq(1.0);
            if taken.any() {
                impacts.take(taken, &Impacts::new(&fresh, friction, hypothesis));
            }
            if impacts.course.over.all() {
                return;
            }
            impacts.stop();
            if !impacts.course.over.all() {
                impacts.advance();
            }
            if !impacts.course.over.any() {
                continue;
            }
            let answer = impacts.answer();
            let over = impacts.course.over.select(1.0, 0.0);
            for (lane, place) in places.iter_mut().enumerate() {
                if let Some((i, k)) = *place
                    && over.as_slice()[lane] == 1.0
                {
                    *place = None;
                    let response = &mut late[i].response;
                    response.normal.as_mut_slice()[k] = answer.normal.as_slice()[lane];
                    response.along.as_mut_slice()[k] = answer.along.as_slice()[lane];
                    response.across.as_mut_slice()[k] = answer.across.as_slice()[lane];
                    let speed = answer.separation_speed.as_slice()[lane];
                    response.separation_speed.as_mut_slice()[k] = speed;
                }
            }
        }
    }
}
