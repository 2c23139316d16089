//! Contacts that take more than one step, out of many vectors: they wait in a queue for a lane, so that no lane is idle while others
//! are under way. Those whose direction hardly turns any more go on in lanes of their own, where all take the same steps.

use super::lanes::Lanes;
use crate::law::{Hypothesis, Late};
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

#[cfg(test)]
mod tests {
    use super::super::testing::{Case, value};
    use super::*;
    use crate::simd::one;
    use pulp::Scalar;

    /// Two contacts with this angle between the slip and the direction that attracts it.
    fn contacts(direction: f64) -> (Vec<Late<Scalar>>, f64) {
        let case = Case {
            friction: 0.3,
            nn: 1.5,
            nu: 0.2,
            uu: 1.3,
            ww: 2.1,
            direction,
        };
        let nothing = Late::nothing(Scalar::new());
        let late = Late {
            open: one(1.0),
            slipping: case.contact(0.8, 0.3),
            ..nothing
        };
        (vec![late; 2], case.friction)
    }

    /// A contact whose direction hardly turns goes to the other lanes and leaves its own; these begin when they are needed for another
    /// one, or nothing else is left.
    #[test]
    fn straight_contacts_wait_for_one_another() {
        let hypothesis = Hypothesis::Poisson;
        let (mut late, friction) = contacts(0.01);
        let (mut both, _) = contacts(0.01);
        let answers = |late: &[Late<Scalar>]| [0, 1].map(|i| value(late[i].response.normal));
        let mut waiting = Waiting { vector: 0, lane: 0 };
        let mut turning = Lanes::new(&late, friction, hypothesis);
        let mut straight = turning;
        for answered in [false, true] {
            turning.begin(&mut waiting, &late);
            turning.impacts.stop();
            turning.hand_over(&mut straight, &mut late);
            assert!(turning.is_empty() && !straight.is_empty());
            assert_eq!(answers(&late).map(|normal| normal > 0.0), [answered, false]);
        }
        straight.finish(&mut late);
        assert!(straight.is_empty());
        let [one, other] = answers(&late);
        assert_eq!(one, other);
        finish(&mut both, friction, hypothesis);
        assert_eq!(answers(&both), [one, one]);
    }

    #[test]
    fn turning_contacts_are_not_handed_over() {
        let (mut late, friction) = contacts(1.0);
        let mut waiting = Waiting { vector: 0, lane: 0 };
        let mut turning = Lanes::new(&late, friction, Hypothesis::Poisson);
        let mut straight = turning;
        turning.begin(&mut waiting, &late);
        turning.impacts.stop();
        turning.hand_over(&mut straight, &mut late);
        assert!(!turning.is_empty() && straight.is_empty());
    }
}
