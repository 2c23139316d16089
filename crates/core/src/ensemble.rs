//! Many particles, on all cores, each alone: the result cannot depend on the schedule.

use crate::Error;
use crate::body::Solid;
use crate::collision::{InPlane, Law};
use crate::elementary::sincos;
use crate::lanes::{self, Pack, Sink};
use crate::level::Level;
use crate::plan::Plan;
use crate::records::{Records, Table};
use crate::release::Orientation;
use crate::spatial;
use crate::spin::Spin;
use crate::statistics::{Bins, By, Counter, Counts, Tally, Tallying};
use crate::vector::Vector;
use pulp::{Simd, WithSimd};
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

/// A run, in SI units.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    /// The body.
    pub body: Solid,
    /// The collision law.
    pub law: Law<'a>,
    /// Number of particles.
    pub particles: usize,
    /// Most impacts of a particle.
    pub impacts: usize,
    /// Height of the centre of mass over the plane at release, along the plane normal, in m.
    pub release_height: f64,
    /// Acceleration of gravity, in m/s².
    pub gravity: f64,
    /// Law of the symmetry axis at release.
    pub orientation: Orientation<'a>,
    /// Law of the angular velocity at release.
    pub spin: Spin<'a>,
    /// Velocity of the centre of mass at release, in m/s.
    pub velocity: Vector,
    /// Angle α in [0, π/2) by which the plane is inclined, falling along x: in its frame gravity is g(sin α, 0, −cos α).
    pub incline: f64,
    /// A particle ends when √(2 E_kin/m) falls below this after an impact, in m/s; 0 never does.
    pub minimum_speed: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// How to compute a run; the result does not depend on it.
#[derive(Debug, Clone, Copy)]
pub struct Means {
    /// Number of threads; 0 means one a core.
    pub threads: usize,
    /// The vector instructions.
    pub level: Level,
}

/// Seen and touched from outside while a run is under way.
#[derive(Debug, Default)]
pub struct Monitor {
    cancelled: AtomicBool,
    finished: AtomicU64,
}

impl Monitor {
    /// Asks the run to end; every particle stops within an impact.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Number of particles that are done.
    pub fn finished(&self) -> u64 {
        self.finished.load(Ordering::Relaxed)
    }

    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Particles in a block: enough for the threads' bookkeeping not to be seen, few enough for all threads to stay busy.
pub(crate) const BLOCK: usize = 96;

impl Run<'_> {
    /// What the sums of ε are taken about: ε^n at the normal speed that a fall from the release has on the plane.
    pub fn origin(&self) -> f64 {
        let drop = self.release_height - self.body.unit;
        let gained = 2.0 * self.gravity * sincos(self.incline).1 * drop.max(0.0);
        let start = self.velocity.z;
        self.law.normal().at(start.mul_add(start, gained).sqrt())
    }

    /// Whether all particles are let go at rest, over a level plane. All directions along the plane are then alike, and each
    /// particle stays in the vertical plane of its axis.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.spin.is_none() && self.velocity == Vector::default() && self.incline == 0.0
    }

    /// Runs every particle and keeps every impact. A run that is cancelled returns the particles that were begun.
    pub fn simulate(&self, means: Means, monitor: &Monitor) -> Result<Records, Error> {
        let plan = Plan::new(self)?;
        Error::unless(
            self.particles.checked_mul(self.impacts).is_some(),
            "particles",
            self.particles as f64,
            "such that particles × impacts can be counted",
        )?;
        let mut records = Records::new(self.particles, self.impacts);
        let started = AtomicUsize::new(0);
        let rows = Mutex::new(records.rows());
        // Blocks go in order to whichever thread is free, so that a run that is cancelled leaves a table of those begun.
        let ended = means.pool()?.broadcast(|_| {
            while !monitor.is_cancelled() {
                let mut rows = rows.lock().expect("no thread panics while it takes rows");
                let block: Vec<_> = rows.by_ref().take(BLOCK).collect();
                let first = started.fetch_add(block.len(), Ordering::Relaxed);
                drop(rows);
                if block.is_empty() {
                    break;
                }
                let particles = first..first + block.len();
                let mut table = Table::new(block, &plan, first);
                plan.bounce(particles, means.level, monitor, &mut table)?;
            }
            Ok(())
        });
        drop(rows);
        ended.into_iter().collect::<Result<(), Error>>()?;
        records.truncate(started.into_inner());
        if !plan.at_rest {
            records.add_release(&plan);
        }
        Ok(records)
    }

    /// Runs every particle and keeps the statistics of the impacts only, in memory that does not grow with the run.
    pub fn statistics(&self, bins: &Bins, means: Means, monitor: &Monitor) -> Result<Tally, Error> {
        let plan = Plan::new(self)?;
        bins.check()?;
        if let By::Number(rows) = bins.by {
            let allowed = "at most the number of rows";
            Error::unless(
                self.impacts <= rows,
                "impacts",
                self.impacts as f64,
                allowed,
            )?;
        }
        let origin = self.origin();
        let mut total = Tally::new(bins, origin);
        let tallies = match &bins.fraction {
            Some(fractions) => self.tallies(&plan, means, monitor, || {
                Counter::new(bins, fractions, &plan, origin)
            }),
            None => self.tallies(&plan, means, monitor, || Counts::new(bins, &plan, origin)),
        };
        for tally in tallies? {
            total.merge(&tally?);
        }
        Ok(total)
    }

    /// The tallies of all threads. Blocks go to whichever thread is free; the sums are whole numbers and do not mind.
    fn tallies<T: Tallying>(
        &self,
        plan: &Plan<'_>,
        means: Means,
        monitor: &Monitor,
        counter: impl Fn() -> T + Sync,
    ) -> Result<Vec<Result<Tally, Error>>, Error> {
        let next = AtomicUsize::new(0);
        Ok(means.pool()?.broadcast(|_| {
            let mut counter = counter();
            loop {
                let first = next.fetch_add(BLOCK, Ordering::Relaxed);
                if first >= self.particles || monitor.is_cancelled() {
                    return Ok(counter.finish());
                }
                let particles = first..self.particles.min(first + BLOCK);
                plan.bounce(particles, means.level, monitor, &mut counter)?;
            }
        }))
    }
}

/// Number of threads where none is asked for: one a core.
pub fn default_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

impl Means {
    pub(crate) fn pool(&self) -> Result<rayon::ThreadPool, Error> {
        rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads)
            .build()
            .map_err(|error| Error::Threads(error.to_string()))
    }
}

impl Plan<'_> {
    /// Bounces a range of particles and tells `sink`.
    pub fn bounce(
        &self,
        particles: Range<usize>,
        level: Level,
        monitor: &Monitor,
        sink: &mut impl Sink,
    ) -> Result<(), Error> {
        let count = particles.len() as u64;
        if !self.at_rest || !self.body.hull.is_equal_pair() {
            self.bounce_in_space(particles, monitor, sink)?;
        } else if let Some(law) = self.law.steady() {
            self.bounce_under(&law, particles, level, monitor, sink)?;
        } else {
            self.bounce_under(&self.law, particles, level, monitor, sink)?;
        }
        monitor.finished.fetch_add(count, Ordering::Relaxed);
        Ok(())
    }

    /// In lanes.
    fn bounce_under(
        &self,
        law: &impl InPlane,
        particles: Range<usize>,
        level: Level,
        monitor: &Monitor,
        sink: &mut impl Sink,
    ) -> Result<(), Error> {
        level.run(Work {
            plan: self,
            law,
            particles,
            monitor,
            sink,
        })
    }

    /// As [`Plan::bounce`], for what the lanes cannot follow.
    fn bounce_in_space(
        &self,
        particles: Range<usize>,
        monitor: &Monitor,
        sink: &mut impl Sink,
    ) -> Result<(), Error> {
        for (place, particle) in particles.enumerate() {
            sink.begin(place);
            spatial::bounce(
                &self.body,
                &self.law,
                self.slope,
                self.state(particle),
                self.limits(),
                sink,
                || !monitor.is_cancelled(),
            )
            .map_err(|stuck| Error::Numerical {
                particle: particle as u64,
                seed: self.run.seed,
                flight: stuck.impacts as u64,
            })?;
        }
        Ok(())
    }
}

/// The particles of a block, to be compiled for each SIMD level.
struct Work<'a, L, T> {
    plan: &'a Plan<'a>,
    law: &'a L,
    particles: Range<usize>,
    monitor: &'a Monitor,
    sink: &'a mut T,
}

/// Vectors of particles that take turns: enough for the arithmetic units to be busy, few enough for the fastest cache.
const GROUPS: usize = 12;
/// Vectors whose sines and cosines are computed side by side.
const WIDE: usize = 6;

impl<L: InPlane, T: Sink> WithSimd for Work<'_, L, T> {
    type Output = Result<(), Error>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self {
            plan,
            law,
            particles,
            monitor,
            sink,
        } = self;
        let run = plan.run;
        let limits = plan.limits();
        let width = GROUPS * Pack::<S, 1>::WIDTH;
        let (mut sines, mut cosines) = ([0.0; BLOCK], [0.0; BLOCK]);
        for first in particles.clone().step_by(width) {
            let count = width.min(particles.end - first);
            for lane in 0..count {
                (sines[lane], cosines[lane]) = plan.release(first + lane);
            }
            sink.begin(first - particles.start);
            lanes::bounce::<S, WIDE, GROUPS>(
                simd,
                &plan.body,
                law,
                lanes::Release {
                    lift: plan.height - 1.0,
                    sines: &sines[..count],
                    cosines: &cosines[..count],
                },
                limits,
                sink,
                || !monitor.is_cancelled(),
            )
            .map_err(|stuck| Error::Numerical {
                particle: (first + stuck.lane) as u64,
                seed: run.seed,
                flight: stuck.impacts as u64,
            })?;
        }
        Ok(())
    }
}
