//! A run, or several side by side, checked and in the core's units: lengths in R, times in √(R/g), ready for the bounce loop.

use super::{Height, Limits, Orientation, Run};
use crate::Error;
use crate::law::Law;
use crate::math::{Quaternion, Vector};
use crate::motion::State;
use crate::shape::{AnyBody, Body, Rigid, Solid};
use crate::simd::elementary::sincos;
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

/// The units of length, time and speed of a run, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// R, in m.
    pub length: f64,
    /// √(R/g), in s.
    pub time: f64,
    /// √(gR), in m/s.
    pub speed: f64,
}

impl Scales {
    /// The scales for a sphere radius (m) and an acceleration of gravity normal to the plane (m/s²).
    ///
    /// # Errors
    /// Unless gravity is finite and > 0, and if R/g or gR overflows or underflows.
    pub fn new(radius: f64, gravity: f64) -> Result<Self, Error> {
        Error::unless_positive("gravity", gravity, "finite and > 0 (m/s^2)")?;
        // A subnormal number has few digits, and its root is normal again.
        let (time_squared, speed_squared) = (radius / gravity, radius * gravity);
        let representable = time_squared.is_normal() && speed_squared.is_normal();
        Error::unless(
            representable,
            "gravity",
            gravity,
            "such that R/g and gR neither overflow nor underflow",
        )?;
        Ok(Self {
            length: radius,
            time: time_squared.sqrt(),
            speed: speed_squared.sqrt(),
        })
    }
}

/// A run that has been checked, in the core's units.
pub(crate) struct Plan<'a> {
    pub run: &'a Run<'a>,
    pub law: Law<'a>,
    pub scales: Scales,
    /// Height of the centre of mass at release.
    height: Height,
    /// Velocity of the centre of mass at release.
    velocity: Vector,
    /// tan α.
    pub slope: f64,
    /// [`Run::is_at_rest`].
    pub at_rest: bool,
}

/// Position and motion of a particle, in the core's units. The horizontal position is omitted, because the motion does not depend on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RigidState {
    /// Height and velocity of the centre of mass.
    pub height: f64,
    pub velocity: Vector,
    /// The rotation from the principal axes to those of space.
    pub attitude: Quaternion,
    /// Angular velocity in the principal axes.
    pub spin: Vector,
}

/// Largest magnitude of a component of spin or velocity, in the core's units, so that squares do not overflow.
const FASTEST: f64 = 1e100;

impl<'a> Plan<'a> {
    pub fn new(run: &'a Run<'a>) -> Result<Self, Error> {
        Error::unless(run.particles > 0, "particles", 0.0, "> 0")?;
        Error::unless(run.impacts > 0, "impacts", 0.0, "> 0")?;
        let speed = run.minimum_speed;
        let holds = speed.is_finite() && speed >= 0.0;
        Error::unless(holds, "minimum_speed", speed, "finite and >= 0 (m/s)")?;
        run.orientation.check(run.particles)?;
        run.check_directions()?;
        let incline = run.incline;
        let holds = (0.0..FRAC_PI_2).contains(&incline);
        Error::unless(holds, "incline", incline, "in [0, pi/2) (rad)")?;
        let (sine, cosine) = sincos(incline);
        let scales = Scales::new(run.body.unit(), run.gravity * cosine)?;
        run.spin.check(run.particles, FASTEST / scales.time)?;
        let velocity = run.release_velocity;
        for component in velocity.parts() {
            let allowed = "finite, at most 1e100 sqrt(gR) (m/s) either way";
            let holds = component.abs() <= FASTEST * scales.speed;
            Error::unless(holds, "release_velocity", component, allowed)?;
        }
        let plan = Self {
            run,
            law: run.law.scaled(scales.speed, run.body.mass()),
            scales,
            height: run.release_height.scaled(scales.length),
            velocity: velocity / scales.speed,
            slope: sine / cosine,
            at_rest: run.is_at_rest() && run.body.revolution().is_ok(),
        };
        run.release_height.check()?;
        Error::unless(
            plan.is_clear() && plan.height.lowest().is_finite(),
            "release_height",
            run.release_height.lowest(),
            "finite and high enough that no part is below the plane at release",
        )?;
        Ok(plan)
    }

    /// Returns whether no part is below the plane at release.
    fn is_clear(&self) -> bool {
        let run = self.run;
        let lowest = run.release_height.lowest();
        let (high, given) = match run.body {
            AnyBody::Revolution(solid) => (solid.farthest(), self.height.lowest()),
            AnyBody::Rigid(body) => (body.unit, lowest),
        };
        let random = matches!(
            run.orientation,
            Orientation::UniformAngle | Orientation::Isotropic
        );
        let clear = |particle| match run.body {
            AnyBody::Revolution(solid) => {
                let (_, cosine) = self.release(particle);
                Solid::clears(given, solid.scaled.hull.support(cosine))
            }
            AnyBody::Rigid(body) => Solid::clears(given, body.lowest(self.attitude(particle))),
        };
        Solid::clears(lowest, high) || !random && (0..run.particles).all(clear)
    }

    /// Sine and cosine of the angle at release.
    #[inline(always)]
    pub fn release(&self, particle: usize) -> (f64, f64) {
        self.run.orientation.draw(self.run.seed, particle as u64)
    }

    /// Height of the centre of mass at release.
    #[inline(always)]
    fn height(&self, particle: usize) -> f64 {
        self.height.draw(self.run.seed, particle as u64)
    }

    /// Height of the centre of mass at release, in m.
    pub fn release_height(&self, particle: usize) -> f64 {
        self.run.release_height.draw(self.run.seed, particle as u64)
    }

    /// The attitude at release of a rigid body of any shape, from the axes that it was given in.
    pub fn attitude(&self, particle: usize) -> Quaternion {
        let (seed, number) = (self.run.seed, particle as u64);
        self.run.orientation.attitude(seed, number)
    }

    /// Its angular velocity, in rad/s.
    pub fn spin(&self, body: &Rigid, particle: usize) -> Vector {
        let (seed, number) = (self.run.seed, particle as u64);
        let principal = self.attitude(particle) * body.axes;
        let moments = body.top.moments();
        self.run
            .spin
            .draw_without_axis(seed, number, principal, moments)
    }

    /// The state of such a particle at release.
    pub fn rigid(&self, body: &Rigid, particle: usize) -> RigidState {
        let attitude = (self.attitude(particle) * body.axes).normalized();
        let spin = self.spin(body, particle) * self.scales.time;
        RigidState {
            height: self.height(particle),
            velocity: self.velocity,
            attitude,
            spin: attitude.inverse().rotate(spin),
        }
    }

    /// Azimuth at release, in rad, and angular velocity, in rad/s.
    pub fn spinning(&self, body: &Body, particle: usize) -> (f64, Vector) {
        let (seed, number) = (self.run.seed, particle as u64);
        let azimuth = self.run.orientation.azimuth(seed, number);
        let angle = self.release(particle);
        let ratio = body.transverse / body.axial;
        let axis = (angle, sincos(azimuth));
        let spin = self.run.spin.draw(seed, number, axis, ratio);
        (azimuth, spin)
    }

    /// The limits at which a particle stops.
    pub fn limits(&self) -> Limits {
        Limits {
            impacts: self.run.impacts,
            minimum_speed: self.run.minimum_speed / self.scales.speed,
            settled: self.run.settled / self.scales.length,
        }
    }

    /// Returns whether the range has particles, all of them of the run.
    pub fn check_part(&self, part: &Range<usize>) -> Result<(), Error> {
        let allowed = "at least one of the particles of the run, from the first to before the last";
        let inside = part.start < part.end && part.end <= self.run.particles;
        Error::unless(inside, "part", part.end as f64, allowed)
    }

    /// The state of a particle at release. At rest over a level plane the azimuth does not matter, and the axis is in the x–z plane.
    #[inline(always)]
    pub fn state(&self, body: &Body, particle: usize) -> State {
        let (sine, cosine) = self.release(particle);
        let height = self.height(particle);
        if self.at_rest {
            return State {
                height: height - body.hull.level(),
                velocity: Vector::default(),
                axis: Vector::new(sine, 0.0, cosine),
                precession: Vector::default(),
            };
        }
        let (azimuth, spin) = self.spinning(body, particle);
        let (y, x) = sincos(azimuth);
        let axis = Vector::new(sine * x, sine * y, cosine);
        let spin = spin * self.scales.time;
        State::with_spin(body, height, self.velocity, axis, spin)
    }
}

/// Parts of one run or of several, whose particles are numbered from part to part.
pub(crate) struct JoinedRuns<'a>(Vec<RunPart<'a>>);

/// Some particles of a run.
struct RunPart<'a> {
    plan: Plan<'a>,
    /// Number in the run of the first of them.
    first: usize,
    /// Their numbers among those of all parts.
    numbers: Range<usize>,
}

impl<'a> JoinedRuns<'a> {
    /// # Errors
    /// As [`Plan::new`], [`Plan::check_part`], and [`Error::Parameter`] if there is no run, or runs differ in more than seed, number of
    /// particles and release.
    pub fn new(runs: &'a [(Run<'a>, Range<usize>)]) -> Result<Self, Error> {
        let allowed = "one or more that differ in seed, number of particles and release alone";
        let alike = runs.windows(2).all(|two| two[0].0.is_like(&two[1].0));
        Error::unless(!runs.is_empty() && alike, "runs", runs.len(), allowed)?;
        let mut start = 0;
        let parts = runs.iter().map(|(run, part)| {
            let plan = Plan::new(run)?;
            plan.check_part(part)?;
            let numbers = start..start + part.len();
            start = numbers.end;
            Ok(RunPart {
                plan,
                first: part.start,
                numbers,
            })
        });
        Ok(Self(parts.collect::<Result<_, Error>>()?))
    }

    /// All particles of a run.
    pub fn of(run: &'a Run<'a>) -> Result<Self, Error> {
        Ok(Self(vec![RunPart {
            plan: Plan::new(run)?,
            first: 0,
            numbers: 0..run.particles,
        }]))
    }

    /// Number of all particles.
    pub fn particles(&self) -> usize {
        self.0[self.0.len() - 1].numbers.end
    }

    /// The values that are the same for all particles.
    #[inline(always)]
    pub fn plan(&self) -> &Plan<'a> {
        &self.0[0].plan
    }

    /// The run of a particle, and its number there.
    #[inline(always)]
    pub fn origin(&self, particle: usize) -> (&Plan<'a>, usize) {
        let part = self.0.partition_point(|part| part.numbers.end <= particle);
        let part = &self.0[part];
        (&part.plan, part.first + (particle - part.numbers.start))
    }
}
