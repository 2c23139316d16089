//! The bounce loop: flight to the next contact, impact, and again, for several groups of particles in alternation.

use super::advance::Advance;
use super::collision::{Collisions, Dimension};
use super::group::Group;
use super::impact::ImpactSink;
use super::interleaved::of_groups;
use super::particles::{Lost, Release};
use crate::drop::stop::{Limits, StopReason};
use crate::shape::Body;
use crate::simd::Pack;
use pulp::{Simd, WithSimd};
use std::hint::black_box;
use std::marker::PhantomData;
use std::ops::Range;

/// Simulates the `particles` of a release, as many at a time as N groups have lanes. Calls `go_on` before every impact.
///
/// `cycle` takes the groups from one impact to the next; this function passes the impacts on and ends the trajectories.
#[inline(always)]
pub(crate) fn bounce<S: Simd, T: Dimension, L: Advance<S, T>, const N: usize>(
    simd: S,
    (body, limits): (&Body, Limits),
    cycle: &L,
    (release, mut particles): (&impl Release, Range<usize>),
    sink: &mut impl ImpactSink,
    go_on: impl Fn() -> bool,
) -> Result<(), Lost> {
    let mut groups = cycle.groups::<N>(simd);
    let mut collisions = Collisions::none(simd);
    let width = Pack::<S>::WIDTH;
    let count = particles.len().div_ceil(width).min(N);
    // Of a slice that it knows to be short the compiler would write out every stage for each group, which then do not fit into the
    // instruction cache.
    let mut groups = black_box(&mut groups[..count]);
    let mut ended = true;
    sink.begin();
    loop {
        if ended {
            cycle.occupy(groups, release, &mut particles);
            let before = groups.len();
            groups = in_use(groups);
            if L::INTERLEAVED {
                sink.settle(of_groups::<S>(groups.len()..before));
            }
        }
        if groups.is_empty() {
            return Ok(());
        }
        if !go_on() {
            break;
        }
        if cycle.scatters() {
            for (chances, group) in collisions.chances.iter_mut().zip(groups.iter()) {
                *chances = group.particles.chances(release);
            }
        }
        cycle.advance(groups, &mut collisions, sink)?;
        ended = simd.vectorize(Report {
            groups,
            body,
            limits,
            cycle: PhantomData::<L>,
            sink,
        });
    }
    if L::INTERLEAVED {
        sink.settle(of_groups::<S>(0..groups.len()));
    }
    for group in groups {
        group
            .particles
            .end(group.particles.active, StopReason::Interrupted);
        group.particles.close(sink);
    }
    Ok(())
}

/// The groups that have particles, which the others make way for.
fn in_use<S: Simd, T: Dimension>(groups: &mut [Group<S, T>]) -> &mut [Group<S, T>] {
    let mut count = 0;
    for i in 0..groups.len() {
        if groups[i].particles.active.any() {
            if i > count {
                groups.swap(i, count);
            }
            count += 1;
        }
    }
    &mut groups[..count]
}

/// Hands an impact of all groups to the sink, which works the impacts up unless the stages do; returns whether some particle has ended.
/// Compiled separately, because the rare branches of the sinks would take registers from the other stages.
struct Report<'a, S: Simd, T: Dimension, L, K> {
    groups: &'a mut [Group<S, T>],
    body: &'a Body,
    limits: Limits,
    cycle: PhantomData<L>,
    sink: &'a mut K,
}

impl<S: Simd, T: Dimension, L: Advance<S, T>, K: ImpactSink> WithSimd for Report<'_, S, T, L, K> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> bool {
        let mut ended = false;
        for (i, group) in self.groups.iter_mut().enumerate() {
            ended |= group.report(i, self.body, self.limits, self.sink);
        }
        if !L::INTERLEAVED {
            self.sink.settle(of_groups::<S>(0..self.groups.len()));
        }
        ended
    }
}

#[cfg(test)]
mod tests {
    use crate::drop::{
        Impact, ImpactSink, JoinedRuns, Meanwhile, PLACES, Pose, Run, StopReason, bounce_block,
    };
    use crate::simd::{Level, Pack};
    use crate::{Dumbbell, Law, Monitor, TangentialRestitution};
    use pulp::Simd;
    use std::ops::Range;

    /// Cancels its own run after some impacts, and knows which of them were worked up.
    struct Cancelling<'a> {
        monitor: &'a Monitor,
        most: usize,
        impacts: usize,
        done: usize,
        waits: [bool; PLACES],
    }

    impl Meanwhile for Cancelling<'_> {
        const INTERLEAVED: bool = true;

        fn meanwhile(&mut self, place: usize) {
            self.done += usize::from(std::mem::take(&mut self.waits[place]));
        }
    }

    impl ImpactSink for Cancelling<'_> {
        fn impact<S: Simd, P: Pose<S>>(&mut self, group: usize, impact: &Impact<S, P>) {
            impact.active.each(|lane| {
                let place = group * Pack::<S>::WIDTH + lane;
                assert!(!self.waits[place], "an impact is lost");
                self.waits[place] = true;
                self.impacts += 1;
            });
            if self.impacts >= self.most {
                self.monitor.cancel();
            }
        }

        fn end(&mut self, _: usize, _: usize, _: StopReason) {}
    }

    /// Wherever a run is cancelled, and if it is not, every impact is worked up once: those of the last round, too.
    #[test]
    fn every_impact_is_worked_up() {
        let tangential = TangentialRestitution::new(0.3).unwrap();
        let run = Run {
            body: Dumbbell::new(3e-3, 1.5e-3, 2500.0).unwrap().into(),
            law: Law::new(0.9, tangential).unwrap(),
            particles: 100,
            impacts: 7,
            seed: 1,
            ..Run::default()
        };
        let runs = JoinedRuns::of(&run).unwrap();
        for level in Level::available() {
            for particles in [1, 5, 100] {
                for most in [1, 3, 30, 150, 400, usize::MAX] {
                    let monitor = Monitor::default();
                    let mut sink = Cancelling {
                        monitor: &monitor,
                        most,
                        impacts: 0,
                        done: 0,
                        waits: [false; PLACES],
                    };
                    let range: Range<usize> = 0..particles;
                    bounce_block(&runs, range, level, &monitor, &mut sink).unwrap();
                    assert_eq!(sink.done, sink.impacts, "{level:?}, {particles}, {most}");
                    if most == usize::MAX {
                        assert_eq!(sink.done, 7 * particles);
                    }
                }
            }
        }
    }
}
