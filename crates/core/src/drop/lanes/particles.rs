//! The particles of a group, one in each lane: which they are, how far they have come, and which have stopped.

use super::impact::ImpactSink;
use crate::Fault;
use crate::drop::stop::{COLLAPSE_RUN, StopReason, UNRESOLVED};
use crate::motion::State;
use crate::simd::{LANES, Mask, Pack};
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// The initial conditions of particles.
pub(crate) trait Release {
    /// The state of a particle of the run at its release.
    fn start(&self, particle: usize) -> State;

    /// The number in (0, 1) that ε_n is drawn with at an impact of a particle, counted from 0, where it scatters.
    fn chance(&self, particle: usize, impact: usize) -> f64;
}

/// The particle that cannot be followed: its contact search did not converge, or a law of one's own gave no impulse that is possible.
#[derive(Debug)]
pub(crate) struct Lost {
    pub particle: usize,
    pub impacts: usize,
    pub fault: Option<Box<Fault>>,
}

/// As many particles as a vector has lanes.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Particles<S: Simd> {
    /// Time since release.
    pub clock: Pack<S>,
    /// Unresolved flights in a row.
    unresolved: Pack<S>,
    /// Number of the particle in the run.
    pub number: Pack<S>,
    /// Number of rounds so far, each of which has an impact in the lanes that do not wait.
    rounds: f64,
    /// Number of rounds in which the particle of the lane had none: those before its release, and those in which it waited.
    idle: Pack<S>,
    /// The first round after which a particle may have all its impacts.
    due: f64,
    /// The lanes whose particle has not stopped.
    pub active: Mask<S>,
    /// The lanes whose particle has stopped, which the sink does not know yet, and why.
    ended: Mask<S>,
    pub has_ended: bool,
    pub reasons: [StopReason; LANES],
}

impl<S: Simd> Particles<S> {
    /// No particles.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = Pack::splat(simd, 0.0);
        Self {
            clock: zero,
            unresolved: zero,
            number: zero,
            rounds: 0.0,
            idle: zero,
            due: 0.0,
            active: Mask::splat(simd, false),
            ended: Mask::splat(simd, false),
            has_ended: false,
            reasons: [StopReason::Interrupted; LANES],
        }
    }

    /// Puts the next particles into the lanes that are free, as long as there are any; `put` is called with lane and particle. Returns
    /// the lanes that have a new one.
    #[inline(always)]
    pub fn occupy(
        &mut self,
        particles: &mut Range<usize>,
        mut put: impl FnMut(usize, usize),
    ) -> Mask<S> {
        let mut fresh = 0.0 * self.number;
        (!self.active).each(|lane| {
            if let Some(particle) = particles.next() {
                put(lane, particle);
                self.number.as_mut_slice()[lane] = particle as f64;
                fresh.as_mut_slice()[lane] = 1.0;
            }
        });
        let fresh = fresh.eq(1.0);
        self.active = self.active | fresh;
        self.clock = fresh.select(0.0, self.clock);
        self.unresolved = fresh.select(0.0, self.unresolved);
        self.idle = fresh.select(self.rounds, self.idle);
        self.due = self.rounds;
        fresh
    }

    /// Counts the round that has ended with an impact in the lanes `landing`, at this time.
    #[inline(always)]
    pub fn count(&mut self, landing: Mask<S>, clock: Pack<S>, waiting: Option<Pack<S>>) {
        self.clock = landing.select(clock, self.clock);
        self.rounds += 1.0;
        if let Some(waiting) = waiting {
            self.idle = self.idle + waiting;
        }
    }

    /// Ends the particles whose last flights were too low to be resolved; `size` is M T² of this one.
    #[inline(always)]
    pub fn end_collapsed(&mut self, size: Pack<S>, landing: Mask<S>, waiting: Mask<S>) {
        let low = size.lt(UNRESOLVED);
        if low.any() {
            let unresolved = low.select(self.unresolved + 1.0, 0.0);
            self.unresolved = landing.select(unresolved, self.unresolved);
            let collapsed = self.unresolved.eq(f64::from(COLLAPSE_RUN));
            self.end(collapsed, StopReason::Collapse);
        } else {
            self.unresolved = waiting.select(self.unresolved, 0.0);
        }
    }

    /// Ends the particles that have reached the largest number of impacts.
    #[inline(always)]
    pub fn end_complete(&mut self, most: usize) {
        if self.rounds >= self.due {
            let simd = self.clock.simd();
            simd.vectorize(Due {
                particles: self,
                most: most as f64,
            });
        }
    }

    /// The number of impacts of each particle.
    #[inline(always)]
    pub fn impacts(&self) -> Pack<S> {
        self.rounds - self.idle
    }

    /// Ends the active lanes in `which`.
    #[inline(always)]
    pub fn end(&mut self, which: Mask<S>, reason: StopReason) {
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
    pub fn close(&mut self, sink: &mut impl ImpactSink) {
        self.ended.each(|lane| {
            let (particle, impacts) = self.trajectory(lane);
            sink.end(particle, impacts, self.reasons[lane]);
        });
        self.ended = self.ended & !self.ended;
        self.has_ended = false;
    }

    /// The numbers that ε_n is drawn with at the next impacts, in the lanes that have a particle.
    #[cold]
    pub fn chances(&self, release: &impl Release) -> Pack<S> {
        let mut chances = 0.0 * self.number + 0.5;
        self.active.each(|lane| {
            let (particle, impacts) = self.trajectory(lane);
            chances.as_mut_slice()[lane] = release.chance(particle, impacts);
        });
        chances
    }

    /// The particle in a lane, and the number of its impacts.
    fn trajectory(&self, lane: usize) -> (usize, usize) {
        let [particle, impacts] =
            [self.number, self.impacts()].map(|count| count.as_slice()[lane] as usize);
        (particle, impacts)
    }

    /// The error that names the particle in a lane.
    #[cold]
    pub fn lost(&self, lane: usize, fault: Option<Box<Fault>>) -> Lost {
        let (particle, impacts) = self.trajectory(lane);
        Lost {
            particle,
            impacts,
            fault,
        }
    }
}

/// Ends the particles that have reached the largest number of impacts, and determines when the next one may. Compiled separately for each
/// SIMD level, because it is rare.
struct Due<'a, S: Simd> {
    particles: &'a mut Particles<S>,
    most: f64,
}

impl<S: Simd> WithSimd for Due<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) {
        let Self { particles, most } = self;
        let complete = particles.impacts().eq(most);
        particles.end(complete, StopReason::ImpactsReached);
        let idle = particles.active.select(particles.idle, f64::INFINITY);
        let least = idle
            .as_slice()
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min);
        particles.due = most + least;
    }
}
