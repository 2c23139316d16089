//! The product beside the oracle, impact by impact, as far as rounding lets them be compared.

use super::impact::Rule;
use super::random::Random;
use super::{Impact, Noise, Particle, Release, World};
use crate::common::Records;
use restitution_core::{Monitor, Orientation, Resources, Run, Spin, Vector};

/// Relative size of the noise: 32 units in the last place. Far above what either side rounds in one stage of an impact, so that it is the noise
/// that spreads the copies, and small enough to follow ten or twenty impacts.
const NOISE: f64 = 32.0 * f64::EPSILON;
/// Particles with noise beside each without.
const COPIES: u64 = 6;
/// What is allowed, in spreads of the copies. Each side rounds a stage by several units in the last place, a fraction of
/// the noise; that all six copies should by chance have spread less than a tenth as far as they typically do has a
/// probability below 10⁻⁶.
const FACTOR: f64 = 2.0;
/// And in units in the last place of the number itself: what its own formula rounds, behind the motion.
const OWN: f64 = 16.0 * f64::EPSILON;
/// Relative error that the product promises of the impulse of a slip that turns.
const TURNING: f64 = 1e-12;
/// Numbers are compared until they have spread by this part of themselves, or of the motion's natural unit.
const LOST: f64 = 1e-7;

pub const NAMES: [&str; 7] = [
    "time",
    "impact_velocity",
    "rebound_velocity",
    "restitution",
    "rotational_fraction",
    "energy_ratio",
    "angle",
];

/// The release of the particles of a run: all with the same velocity from the same height.
#[derive(Debug, Clone)]
pub enum Start {
    /// Polar angle, azimuth and spin of each.
    Each(Vec<(f64, f64, [f64; 3])>),
    /// As the product draws them, and says in its records.
    Drawn(usize, Orientation<'static>, Spin<'static>),
}

/// A run for both sides.
#[derive(Debug, Clone)]
pub struct Case {
    pub world: World,
    pub height: f64,
    pub velocity: [f64; 3],
    pub start: Start,
    pub impacts: usize,
    pub seed: u64,
}

/// What a comparison has seen.
#[derive(Debug, Clone, Copy, Default)]
pub struct Seen {
    pub impacts: u64,
    pub ends: u64,
    /// The largest error in units of what was allowed.
    pub worst: f64,
}

impl Seen {
    pub fn and(self, other: Self) -> Self {
        Self {
            impacts: self.impacts + other.impacts,
            ends: self.ends + other.ends,
            worst: self.worst.max(other.worst),
        }
    }
}

impl Case {
    /// Hands the run to `f`.
    pub fn with_run<T>(&self, f: impl FnOnce(&Run<'_>) -> T) -> T {
        let World {
            shape,
            rule,
            normal,
            gravity,
            incline,
            minimum_speed,
        } = &self.world;
        let [x, y, z] = self.velocity;
        let (angles, directions, spins): (Vec<_>, Vec<_>, Vec<_>);
        let (particles, orientation, spin) = match &self.start {
            Start::Drawn(particles, orientation, spin) => (*particles, *orientation, *spin),
            Start::Each(list)
                if list
                    .iter()
                    .all(|&(_, azimuth, spin)| azimuth == 0.0 && spin == [0.0; 3]) =>
            {
                angles = list.iter().map(|&(angle, ..)| angle).collect::<Vec<_>>();
                (list.len(), Orientation::Given(&angles), Spin::NONE)
            }
            Start::Each(list) => {
                directions = list
                    .iter()
                    .map(|&(angle, azimuth, _)| [angle, azimuth])
                    .collect::<Vec<_>>();
                spins = list.iter().map(|&(.., spin)| spin).collect::<Vec<_>>();
                (
                    list.len(),
                    Orientation::Directions(&directions),
                    Spin::Given(&spins),
                )
            }
        };
        f(&Run {
            body: shape.solid().into(),
            law: rule.law(normal),
            particles,
            impacts: self.impacts,
            release_height: self.height.into(),
            gravity: *gravity,
            orientation,
            spin,
            release_velocity: Vector::new(x, y, z),
            incline: *incline,
            minimum_speed: *minimum_speed,
            settled: 0.0,
            seed: self.seed,
        })
    }

    /// The product's records.
    pub fn records(&self, resources: Resources) -> Records {
        self.with_run(|run| run.simulate(resources, &Monitor::default()))
            .unwrap_or_else(|error| panic!("{error}: {self:#?}"))
            .into()
    }

    /// How a particle is released, where that is not given as the product recorded it.
    pub fn release(&self, records: &Records, particle: usize) -> Release {
        let (angle, azimuth, spin) = match &self.start {
            Start::Each(list) => {
                let (angle, mut azimuth, spin) = list[particle];
                // Angles alone leave the azimuth to be drawn where anything depends on it.
                if let Some(&drawn) = records.release_azimuth.get(particle) {
                    let same = drawn == azimuth || azimuth == 0.0;
                    assert!(same, "particle {particle}: azimuth {drawn}, not {azimuth}");
                    azimuth = drawn;
                }
                (angle, azimuth, spin)
            }
            Start::Drawn(..) => (
                records.release_angle[particle],
                records
                    .release_azimuth
                    .get(particle)
                    .copied()
                    .unwrap_or(0.0),
                records
                    .release_spin
                    .get(particle)
                    .copied()
                    .unwrap_or([0.0; 3]),
            ),
        };
        Release {
            height: self.height,
            velocity: self.velocity,
            angle,
            azimuth,
            spin,
        }
    }

    /// Holds the records to the oracle.
    pub fn compare(&self, records: &Records) -> Result<Seen, String> {
        let mut seen = Seen::default();
        for particle in 0..records.particles() {
            let found = self
                .follow(records, particle)
                .map_err(|why| format!("particle {particle}: {why}"))?;
            seen = seen.and(found);
        }
        Ok(seen)
    }

    fn follow(&self, records: &Records, particle: usize) -> Result<Seen, String> {
        let body = self.world.shape.body();
        let release = self.release(records, particle);
        let mut clean = Particle::new(&self.world, &body, &release, Noise::none());
        let turning = matches!(self.world.rule, Rule::Coulomb { .. }) && !self.is_planar();
        let impulse = if turning { TURNING } else { NOISE };
        let mut copies: Vec<_> = (1..=COPIES)
            .map(|copy| {
                let noise = Noise {
                    size: NOISE,
                    impulse,
                    random: Random(copy + 1000 * particle as u64),
                };
                Particle::new(&self.world, &body, &release, noise)
            })
            .collect();
        let scale = self.scale();
        let mut seen = Seen::default();
        for i in 0..=self.impacts {
            let number = particle * self.impacts + i;
            let made = records.impacts[particle] as usize;
            if i == self.impacts {
                let reason = clean.ended();
                return if made == i {
                    Ok(seen)
                } else {
                    Err(format!("{made} impacts, not {i} and {reason:?}"))
                };
            }
            let right = clean.next();
            let others: Vec<_> = copies.iter_mut().map(Particle::next).collect();
            let impact = match right {
                Err(reason) => {
                    let same =
                        |other: &Result<Impact, _>| matches!(other, Err(other) if *other == reason);
                    if !others.iter().all(same) {
                        return Ok(seen);
                    }
                    let end = (made, records.stop_reason[particle]);
                    if end != (i, reason as i8) {
                        return Err(format!(
                            "ended as {end:?}, not {:?} ({reason:?})",
                            (i, reason as i8)
                        ));
                    }
                    seen.ends += 1;
                    return Ok(seen);
                }
                Ok(impact) => impact,
            };
            let mut spread = [0.0_f64; 7];
            for other in &others {
                let Ok(other) = other else { return Ok(seen) };
                let same = other.contact == impact.contact || body.is_ball();
                // Where the noise can open or close a gap, more than the copies show may come of it.
                if !same || !other.resolved || !impact.resolved {
                    return Ok(seen);
                }
                for (most, (a, b)) in spread
                    .iter_mut()
                    .zip(other.columns.iter().zip(impact.columns))
                {
                    *most = most.max((a - b).abs());
                }
            }
            let known = (0..7).all(|c| spread[c] <= LOST * (impact.columns[c].abs() + scale[c]));
            if !known {
                return Ok(seen); // also where a restitution is not a number
            }
            let named = made > i && (records.contact[number] == impact.contact || body.is_ball());
            if !named {
                let contact = if made > i { records.contact[number] } else { 0 };
                return Err(format!(
                    "impact {i} is with {contact}, not {}: {impact:?} within {spread:?}",
                    impact.contact
                ));
            }
            for (c, (name, value)) in NAMES.iter().zip(row(records, number)).enumerate() {
                let error = (value - impact.columns[c]).abs();
                let allowed = FACTOR * spread[c] + own(c, impact.columns[c]);
                // A number in which nothing has been rounded yet has no error.
                let share = if error == 0.0 { 0.0 } else { error / allowed };
                if share > 1.0 || share.is_nan() {
                    return Err(format!(
                        "{name} of impact {i} is {value:?}, not {:?}: off by {error:e}, {share:.3} of what is allowed",
                        impact.columns[c]
                    ));
                }
                seen.worst = seen.worst.max(share);
            }
            seen.impacts += 1;
        }
        unreachable!()
    }

    /// True if every particle stays in the vertical plane of its axis.
    fn is_planar(&self) -> bool {
        let spins = match &self.start {
            Start::Each(list) => list.iter().any(|&(.., spin)| spin != [0.0; 3]),
            Start::Drawn(.., spin) => *spin != Spin::NONE,
        };
        !spins && self.velocity == [0.0; 3] && self.world.incline == 0.0
    }

    /// Natural units of the columns.
    fn scale(&self) -> [f64; 7] {
        let (size, gravity) = (self.world.shape.size(), self.world.gravity);
        let speed = (size * gravity).sqrt();
        [(size / gravity).sqrt(), speed, speed, 1.0, 1.0, 1.0, 1.0]
    }
}

/// What the formula of a number rounds by itself. The rotational fraction is the square of a spin, and that a difference of
/// numbers of the size of √E.
fn own(column: usize, value: f64) -> f64 {
    let direct = OWN * value.abs();
    if NAMES[column] == "rotational_fraction" {
        direct + OWN * (value.abs().sqrt() + OWN)
    } else {
        direct
    }
}

/// The numbers of an impact as they are recorded.
pub fn row(records: &Records, number: usize) -> [f64; 7] {
    [
        records.time[number],
        records.impact_velocity[number],
        records.rebound_velocity[number],
        records.restitution[number],
        records.rotational_fraction[number],
        records.energy_ratio[number],
        records.angle[number],
    ]
}
