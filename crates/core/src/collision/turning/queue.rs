//! Contacts that take more than one step, out of many vectors: they wait in a queue for a lane, so that no lane is idle while others
//! are under way. Those whose direction hardly turns any more go on in lanes of their own, where all take the same steps.

use super::lanes::Lanes;
use crate::collision::{Hypothesis, Late};
use crate::simd::Pack;
use pulp::{Simd, WithSimd};

/// The lanes that have not had their turn.
pub(super) struct Waiting {
    vector: usize,
    lane: usize,
}

impl Waiting {
    /// The next one: vector and lane.
    #[inline(always)]
    pub fn next<S: Simd>(&mut self, late: &[Late<S>]) -> Option<(usize, usize)> {
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
        let mut waiting = Waiting { vector: 0, lane: 0 };
        let mut turning = Lanes::new(late, friction, hypothesis);
        let mut straight = turning;
        loop {
            turning.begin(&mut waiting, late);
            if turning.is_empty() {
                break;
            }
            turning.impacts.stop();
            turning.end(late);
            turning.hand_over(&mut straight, late);
            if !turning.is_empty() {
                turning.impacts.advance();
                turning.end(late);
            }
        }
        straight.finish(late);
    }
}
