//! Many particles, on all cores, each alone: the result cannot depend on the schedule.

use crate::Error;
use crate::body::{Body, Dumbbell};
use crate::collision::Law;
use crate::records::{Records, Row};
use crate::release::Orientation;
use crate::scales::Scales;
use crate::trajectory::{Limits, bounce};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// A run, in SI units.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a, L> {
    /// The body.
    pub body: Dumbbell,
    /// The collision law.
    pub law: L,
    /// Number of particles.
    pub particles: usize,
    /// Most impacts of a particle.
    pub impacts: usize,
    /// Height of the centre of mass at release, in m.
    pub release_height: f64,
    /// Acceleration of gravity, in m/s².
    pub gravity: f64,
    /// Law of the angle at release.
    pub orientation: Orientation<'a>,
    /// A particle ends when √(2 E_kin/m) falls below this after an impact, in m/s; 0 never does.
    pub minimum_speed: f64,
    /// Seed of the random numbers.
    pub seed: u64,
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

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

impl<L: Law> Run<'_, L> {
    /// Runs every particle on `threads` threads (0: one a core).
    pub fn simulate(&self, threads: usize, monitor: &Monitor) -> Result<Records, Error> {
        let scales = Scales::new(self.body.radius(), self.gravity)?;
        let body = self.body.scaled();
        self.check(&body, &scales)?;
        let mut records = Records::new(self.particles, self.impacts);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| Error::Threads(error.to_string()))?;
        pool.install(|| {
            records.rows().enumerate().try_for_each(|(particle, row)| {
                self.fill(&body, &scales, particle as u64, row, monitor)
            })
        })?;
        Ok(records)
    }

    fn check(&self, body: &Body, scales: &Scales) -> Result<(), Error> {
        Error::unless(self.particles > 0, "particles", 0.0, "> 0")?;
        Error::unless(self.impacts > 0, "impacts", 0.0, "> 0")?;
        let speed = self.minimum_speed;
        let allowed = "finite and >= 0 (m/s)";
        Error::unless(
            speed.is_finite() && speed >= 0.0,
            "minimum_speed",
            speed,
            allowed,
        )?;
        let height = self.release_height / scales.length;
        let clear = |cosine: f64| height >= body.half_separation.mul_add(cosine.abs(), 1.0);
        let all_clear = match self.orientation {
            Orientation::Given(angles) => {
                Error::unless(
                    angles.len() == self.particles,
                    "number of angles",
                    angles.len() as f64,
                    "the number of particles",
                )?;
                for &angle in angles {
                    let reduced = angle.abs() <= crate::sincos::RANGE;
                    Error::unless(reduced, "angle", angle, "finite, |angle| <= 2^20 (rad)")?;
                }
                (0..self.particles as u64)
                    .all(|i| clear(self.orientation.release(height, self.seed, i).axis.z))
            }
            Orientation::UniformAngle | Orientation::Isotropic => clear(1.0),
        };
        Error::unless(
            height.is_finite() && all_clear,
            "release_height",
            self.release_height,
            "finite and high enough that no sphere is below the plane at release (R + L/2 for random angles)",
        )
    }

    fn fill(
        &self,
        body: &Body,
        scales: &Scales,
        particle: u64,
        mut row: Row<'_>,
        monitor: &Monitor,
    ) -> Result<(), Error> {
        if monitor.is_cancelled() {
            return Ok(());
        }
        let height = self.release_height / scales.length;
        let release = self.orientation.release(height, self.seed, particle);
        let limits = Limits {
            impacts: self.impacts,
            minimum_speed: self.minimum_speed / scales.speed,
        };
        let mut count = 0;
        let reason = bounce(body, &self.law, release, limits, |impact| {
            row.set(count, impact, body, scales);
            count += 1;
            !monitor.is_cancelled()
        })
        .map_err(|_| Error::Numerical {
            particle,
            seed: self.seed,
            flight: count as u64,
        })?;
        row.finish(count, reason, release.angle());
        monitor.finished.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }
}
