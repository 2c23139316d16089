//! Impacts are handed to the sink, and particles end.

use super::{Group, Unconverged};
use crate::contact::MOST_STEPS;
use crate::drop::lanes::collision::Dimension;
use crate::drop::lanes::impact::{Impact, Sink};
use crate::drop::stop::{COLLAPSE_RUN, Limits, StopReason, UNRESOLVED};
use crate::motion::SymmetricState;
use crate::shape::Body;
use crate::simd::{Mask, Pack};
use pulp::{Simd, WithSimd};

impl<S: Simd, T: Dimension> Group<S, T> {
    /// Hands the impact to the sink, and ends the particles for which it was the last; returns whether any has ended since the last
    /// impact.
    #[inline(always)]
    pub fn report(
        &mut self,
        number: usize,
        body: &Body,
        limits: Limits,
        sink: &mut impl Sink,
    ) -> bool {
        let mut ended = self.has_ended;
        if ended {
            self.close(sink);
        }
        let landing = self.landing();
        let before = self.before();
        let after = before.with_motion(self.after);
        let clock = self.clock + self.located.time;
        let energy_after = after.kinetic_energy(body);
        let impact = Impact {
            particle: self.particle,
            number: self.impacts(),
            time: clock,
            fall: -before.vz(),
            rise: after.vz(),
            rotation: before.rotational_energy(body),
            energy_before: before.kinetic_energy(body),
            energy_after,
            sine: before.sine(),
            cosine: before.cos_tilt(),
            sphere: self.search.last_contact.sphere,
            approach: self.approach,
            before: before.in_space(),
            after: after.in_space(),
            active: landing,
        };
        sink.impact(number, &impact);
        self.clock = landing.select(clock, self.clock);
        self.rounds += 1.0;
        if self.is_behind {
            self.idle = self.idle + self.behind();
        }
        if limits.minimum_speed > 0.0 {
            let slow = (2.0 * energy_after).lt(limits.minimum_speed * limits.minimum_speed);
            self.end(slow & landing, StopReason::SpeedBelowThreshold);
        }
        let low =
            (self.search.curvature_bound * (self.located.time * self.located.time)).lt(UNRESOLVED);
        if low.any() {
            let unresolved = low.select(self.unresolved + 1.0, 0.0);
            self.unresolved = landing.select(unresolved, self.unresolved);
            let collapsed = self.unresolved.eq(f64::from(COLLAPSE_RUN));
            self.end(collapsed, StopReason::Collapse);
        } else {
            self.unresolved = self.waiting.select(self.unresolved, 0.0);
        }
        if self.rounds >= self.due {
            let simd = self.clock.simd();
            simd.vectorize(Due {
                group: self,
                most: limits.impacts as f64,
            });
        }
        if self.has_ended {
            self.close(sink);
            ended = true;
        }
        ended
    }

    /// Ends the particles that have reached the largest number of impacts, and determines when the next one may.
    #[inline(always)]
    fn end_those_with_all_impacts(&mut self, most: f64) {
        self.end(self.impacts().eq(most), StopReason::ImpactsReached);
        let idle = self.active.select(self.idle, f64::INFINITY);
        self.due = most
            + idle
                .as_slice()
                .iter()
                .copied()
                .fold(f64::INFINITY, f64::min);
    }

    /// The number of impacts of each particle.
    #[inline(always)]
    fn impacts(&self) -> Pack<S, 1> {
        self.rounds - self.idle
    }

    /// Ends the active lanes in `which`.
    #[inline(always)]
    pub fn end(&mut self, which: Mask<S, 1>, reason: StopReason) {
        let ending = which & self.active;
        if ending.any() {
            ending.each(|lane| self.reasons[lane] = reason);
            self.active = self.active & !ending;
            self.ended = self.ended | ending;
            self.has_ended = true;
        }
    }

    /// Hands number of impacts and stop reason of the particles that have stopped to the sink.
    #[cold]
    pub fn close(&mut self, sink: &mut impl Sink) {
        self.ended.each(|lane| {
            let (particle, impacts) = self.trajectory(lane);
            sink.end(particle, impacts, self.reasons[lane]);
        });
        self.ended = self.ended & !self.ended;
        self.has_ended = false;
    }

    /// The particle in a lane, and the number of its impacts.
    fn trajectory(&self, lane: usize) -> (usize, usize) {
        let [particle, impacts] =
            [self.particle, self.impacts()].map(|count| count.as_slice()[lane] as usize);
        (particle, impacts)
    }

    /// An error if the search of some particle takes too many passes.
    #[inline(always)]
    pub fn converged(&self) -> Result<(), Unconverged> {
        let lost = !self.passes.lt(f64::from(MOST_STEPS));
        if lost.any() {
            let mut converged = Ok(());
            lost.each(|lane| {
                let (particle, impacts) = self.trajectory(lane);
                converged = Err(Unconverged { particle, impacts });
            });
            return converged;
        }
        Ok(())
    }
}

/// [`Group::end_those_with_all_impacts`], compiled separately for each SIMD level, because it is rare.
struct Due<'a, S: Simd, T: Dimension> {
    group: &'a mut Group<S, T>,
    most: f64,
}

impl<S: Simd, T: Dimension> WithSimd for Due<'_, S, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) {
        self.group.end_those_with_all_impacts(self.most);
    }
}
