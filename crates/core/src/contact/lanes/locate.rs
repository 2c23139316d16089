//! The end of the search: from the last certified step to the contact. [`super`] explains why this is the first contact.

use super::gap::{GapEvaluation, Search};
use super::{FAR, NEAR, SMALL};
use crate::contact::certify::{INVISIBLE, LAST, before, mean_rate_before};
use crate::motion::{Attitude, Flight};
use crate::shape::Hull;
use crate::simd::{Lanewise, Mask, Pack, lanewise};
use pulp::Simd;

/// The two next steps of the search.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Steps<S: Simd> {
    /// The certified step.
    certified: Pack<S>,
    /// The step to where the contact is looked for next: at first to the zero of an expansion.
    expanded: Pack<S>,
}

/// The gap that remains at the zero of an expansion.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Prediction<S: Simd> {
    time: Pack<S>,
    attitude: Attitude<S>,
    width: Pack<S>,
    /// f′ and f″.
    rate: Pack<S>,
    curvature: Pack<S>,
}

/// The result of a pass of the search.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct LocatedContact<S: Simd> {
    /// Time and attitude of the contact.
    pub time: Pack<S>,
    pub attitude: Attitude<S>,
    /// The lanes in which the contact is located, or that never land.
    pub done: Mask<S>,
}

lanewise! {
    Steps<S> { certified, expanded }
    Prediction<S> { time, attitude, width, rate, curvature }
    LocatedContact<S> { time, attitude, done }
}

impl<S: Simd> Steps<S> {
    /// The step to the contact that was found from `time`, to predict it again from there; that of the lanes that are done stays as it
    /// is, so that they repeat the same result.
    #[inline(always)]
    pub fn on_to(self, located: &LocatedContact<S>, time: Pack<S>) -> Self {
        Self {
            expanded: located.done.select(self.expanded, located.time - time),
            ..self
        }
    }
}

impl<S: Simd, F: Flight<S>> Search<S, F> {
    /// The next steps, from the gap as evaluated.
    #[inline(always)]
    pub fn steps(&self, evaluation: &GapEvaluation<S>, hull: &impl Hull) -> Steps<S> {
        let step = self.certified(&evaluation.gap);
        Steps {
            certified: step,
            expanded: self.expanded(evaluation, step, hull),
        }
    }

    /// The gap that remains after the step ahead, from an evaluation at `time`.
    #[inline(always)]
    pub fn predict(
        &self,
        time: Pack<S>,
        evaluation: &GapEvaluation<S>,
        steps: &Steps<S>,
        hull: &impl Hull,
    ) -> Prediction<S> {
        let time = time + steps.expanded;
        let attitude = evaluation
            .attitude
            .turned(self.flight.rate() * steps.expanded);
        let part = &evaluation.gap.part;
        let (width, rate) = self.instant(time, attitude).opening(part, hull);
        Prediction {
            time,
            attitude,
            width,
            rate,
            curvature: hull.curvature(part, &self.flight.axis_motion(attitude)),
        }
    }

    /// The contact, valid where it is located and neither part can have touched before.
    #[inline(always)]
    pub fn locate<H: Hull>(
        &self,
        evaluation: &GapEvaluation<S>,
        steps: &Steps<S>,
        prediction: &Prediction<S>,
        hull: &H,
    ) -> LocatedContact<S> {
        let part = &evaluation.gap.part;
        // A step of third order closes the remaining gap.
        let inverse = -1.0 / prediction.rate;
        let newton = prediction.width * inverse;
        let rest = newton.mul_add(0.5 * prediction.curvature * newton * inverse, newton);
        let attitude = prediction.attitude.advanced(self.flight.rate() * rest);

        // A zero before the end of the step, which is certified, can only be that of the contact at the start, within its rounding.
        let beyond = mean_rate_before(steps.expanded, prediction.rate, self.curvature_bound);
        let before = steps.certified.mul_add(0.5, -steps.expanded);
        let far = FAR.min(1.0 / hull.sharpness());
        let turned = (self.flight.rate() * steps.expanded).abs() - far;
        let first = beyond.max(turned).max(before).le(0.0);
        let mut found = first & newton.abs().le(SMALL * steps.certified);
        if H::TWO {
            // If the other part had touched after `step`, its gap could have grown since by at most ½S·since².
            let since = (steps.expanded - steps.certified) + rest;
            let cos_tilt = self.flight.axis_motion(attitude).cos_tilt;
            let other = hull.gap(
                &hull.part(!part.one),
                cos_tilt,
                hull.touching_height(part, cos_tilt),
            );
            found = found & (0.5 * self.rotation_bound * (since * since)).le(other);
        }
        LocatedContact {
            time: prediction.time + rest,
            attitude,
            done: evaluation.never | found,
        }
    }

    /// Ends the search in those of the `clear` lanes whose certified step from `time` leaves a gap below the resolution.
    #[inline(always)]
    pub fn accept_grazing(
        &self,
        time: Pack<S>,
        evaluation: &GapEvaluation<S>,
        steps: &Steps<S>,
        clear: Mask<S>,
        located: &mut LocatedContact<S>,
    ) {
        let step = steps.certified;
        let end = time + step;
        let late = end.mul_add(-LAST, step);
        let turned = self.flight.rate().abs().mul_add(step, -LAST);
        let visible = self.curvature_bound.mul_add(step * step, -INVISIBLE);
        // The largest excess must be ≤ 0: one comparison, because operations on masks are slower than those on numbers.
        let invisible = late.max(turned).max(visible).le(0.0);
        let last = evaluation.gap.rate.lt(0.0) & invisible & clear & !located.done;
        if !last.any() {
            return;
        }
        let there = LocatedContact {
            time: end,
            attitude: evaluation.attitude.turned(self.flight.rate() * step),
            done: last,
        };
        *located = located.or(last, there);
    }

    /// The time up to which a pass that evaluated the gap at `time` rules out a contact.
    #[inline(always)]
    pub fn certain(&self, time: Pack<S>, steps: &Steps<S>) -> Pack<S> {
        // The time must increase by at least one rounding unit, however short the step.
        self.skip(time + steps.certified.max(f64::EPSILON * time))
    }

    /// The time of the next evaluation: just before the contact that the expansions predict, or else `certain`, up to which a
    /// contact is ruled out.
    #[inline(always)]
    pub fn aim(
        &self,
        certain: Pack<S>,
        steps: &Steps<S>,
        prediction: &Prediction<S>,
        located: &LocatedContact<S>,
        hull: &impl Hull,
    ) -> Pack<S> {
        let rate = prediction.rate;
        let beyond = mean_rate_before(located.time - certain, rate, self.curvature_bound);
        // So near to the contact a pass ends the search, and the gap is larger than its rounding error.
        let turning = self.flight.rate().abs() * hull.sharpness();
        let margin = NEAR * rate / turning.mul_add(-rate, self.rotation_bound);
        let aim = (located.time + margin).max(certain);
        let led = (self.flight.rate() * steps.expanded).abs().le(FAR);
        (led & beyond.le(0.0) & rate.lt(0.0)).select(aim, certain)
    }

    /// Returns whether no part can have touched between `certain`, up to which a contact is ruled out, and the `time` of the evaluation.
    #[inline(always)]
    pub fn is_clear<H: Hull>(
        &self,
        certain: Pack<S>,
        time: Pack<S>,
        evaluation: &GapEvaluation<S>,
        hull: &H,
    ) -> Mask<S> {
        let (since, bound) = (time - certain, self.curvature_bound);
        let (width, rate) = (evaluation.gap.width, evaluation.gap.rate);
        let mut least = before(since, width, rate, bound).min(width);
        if H::TWO {
            let other = hull.part(!evaluation.gap.part.one);
            let (width, rate) = self
                .instant(time, evaluation.attitude)
                .opening(&other, hull);
            least = least.min(before(since, width, rate, bound).min(width));
        }
        !certain.lt(time) | (0.0 * since).lt(least)
    }

    /// The step to the zero of the fourth-order expansion of the gap, found by a step of third order from the end of `step`.
    #[inline(always)]
    fn expanded(&self, evaluation: &GapEvaluation<S>, step: Pack<S>, hull: &impl Hull) -> Pack<S> {
        let axis_motion = self.flight.axis_motion(evaluation.attitude);
        let [second, third, fourth] = hull.derivatives(&evaluation.gap.part, &axis_motion); // f″ without gravity, f‴, f⁗
        let slack = second + self.rotation_bound; // f″ + M, which the lower bound neglects
        // The gap after the step, and the speed at which it closes there.
        let bend = (step * fourth).mul_add(1.0 / 12.0, third * (1.0 / 3.0));
        let left = 0.5 * (step * step) * step.mul_add(bend, slack);
        let speed = step.mul_add(-step.mul_add(0.5 * third, slack), evaluation.gap.closing);
        let inverse = 1.0 / speed;
        let newton = left * inverse;
        let curvature = step.mul_add(third, second - 1.0); // f″
        step + newton.mul_add(0.5 * curvature * newton * inverse, newton)
    }
}
