//! Random runs, ordinary and outlandish, through every SIMD level against the oracle: the same bits or none.
//!
//! Short by default; `RESTITUTION_FUZZ_SECONDS=600 cargo test --release -p restitution-core --test fuzz -- --nocapture` goes on
//! for ten minutes with more cases. A failure prints the smallest case of its kind that was found, with every parameter.

mod common;

use common::*;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestError, TestRunner};
use restitution_core::{
    Dumbbell, Impact, Law, Level, Limits, Means, Monitor, Orientation, Records, Run, Scales, Shape,
    Spin, Vector, bounce,
};
use std::f64::consts::{FRAC_PI_2, PI};
use std::time::{Duration, Instant};

/// Cases between two looks at the clock.
const BATCH: u32 = 64;
/// Batches where no time is asked for.
const DEFAULT_BATCHES: u64 = 8;

#[derive(Debug, Clone, PartialEq)]
enum Angles {
    Uniform(usize),
    Isotropic(usize),
    Given(Vec<f64>),
}

/// All that a run is made of.
#[derive(Debug, Clone)]
struct Case {
    /// R in m.
    radius: f64,
    /// L/R.
    elongation: f64,
    law: Law<'static>,
    gravity: f64,
    /// Height above that of an upright body on the plane, in R.
    above: f64,
    angles: Angles,
    /// In √(gR).
    minimum_speed: f64,
    impacts: usize,
    seed: u64,
}

impl Case {
    fn run(&self) -> Run<'_> {
        let body = Dumbbell::new(self.radius, self.elongation * self.radius, 2500.0).unwrap();
        let (particles, orientation) = match &self.angles {
            Angles::Uniform(particles) => (*particles, Orientation::UniformAngle),
            Angles::Isotropic(particles) => (*particles, Orientation::Isotropic),
            Angles::Given(angles) => (angles.len(), Orientation::Given(angles)),
        };
        Run {
            body: body.into(),
            law: self.law,
            particles,
            impacts: self.impacts,
            release_height: self.radius * (1.0 + body.scaled().half_separation + self.above),
            gravity: self.gravity,
            orientation,
            minimum_speed: self.minimum_speed * (self.gravity * self.radius).sqrt(),
            spin: Spin::NONE,
            velocity: Vector::default(),
            incline: 0.0,
            seed: self.seed,
        }
    }
}

/// Exponent of the smallest sine: the oracle squares sines and rates of rotation, and what underflows then counts as upright
/// and as no rotation.
const SMALLEST_SINE: f64 = -60.0;

/// Angles of every kind: upright and level and next to either, and turned many times round.
fn angle() -> impl Strategy<Value = f64> {
    let side = || prop_oneof![Just(-1.0), Just(1.0)];
    prop_oneof![
        6 => 0.0..PI,
        1 => prop::sample::select(vec![0.0, -0.0, FRAC_PI_2, PI, -FRAC_PI_2]),
        1 => magnitude(SMALLEST_SINE, -1.0),
        1 => (side(), magnitude(-17.0, -1.0)).prop_map(|(side, off)| FRAC_PI_2 + side * off),
        1 => -1_048_576.0..1_048_576.0_f64,
    ]
}

fn case() -> impl Strategy<Value = Case> {
    let radius = prop_oneof![Just(1.0), Just(3e-3), magnitude(-6.0, 3.0)];
    let elongation =
        prop_oneof![8 => elongation(), 1 => magnitude(-300.0, -15.0), 1 => magnitude(0.0, 2.0)];
    let coefficients = prop_oneof![
        3 => coefficients(),
        1 => (magnitude(-18.0, 0.0), prop_oneof![Just(1.0), -1.0..1.0_f64]),
        1 => (Just(1.0 - f64::EPSILON), -1.0..1.0_f64),
    ];
    let law = coefficients.prop_flat_map(|(normal, tangential)| {
        prop_oneof![
            Just(law(normal, tangential)),
            every_law((normal, tangential))
        ]
    });
    let above = prop_oneof![
        1 => Just(0.0), 2 => magnitude(-17.0, 0.0), 5 => magnitude(0.0, 2.0), 1 => magnitude(2.0, 9.0)
    ];
    let angles = prop_oneof![
        2 => (1..60_usize).prop_map(Angles::Uniform),
        1 => (1..60_usize).prop_map(Angles::Isotropic),
        3 => prop::collection::vec(angle(), 1..60).prop_map(Angles::Given),
    ];
    let minimum_speed = prop_oneof![3 => Just(0.0), 1 => magnitude(-6.0, 1.0)];
    let gravity = prop_oneof![1 => Just(9.81), 1 => magnitude(-3.0, 3.0)];
    (
        (radius, elongation, law, gravity, above),
        (angles, minimum_speed, 1..200_usize, any::<u64>()),
    )
        .prop_map(
            |(
                (radius, elongation, law, gravity, above),
                (angles, minimum_speed, impacts, seed),
            )| Case {
                radius,
                elongation,
                law,
                gravity,
                above,
                angles,
                minimum_speed,
                impacts,
                seed,
            },
        )
}

/// Every number of an impact as bits; all NaN are one.
fn bits(numbers: [f64; 7]) -> [u64; 7] {
    numbers.map(|x| if x.is_nan() { u64::MAX } else { x.to_bits() })
}

/// Runs `case` at every level and each of its particles with the oracle; returns the number of impacts compared.
fn compare(case: &Case) -> Result<u64, TestCaseError> {
    let run = case.run();
    let body = run.body.scaled;
    let scales = Scales::new(run.body.unit, run.gravity).unwrap();
    let limits = Limits {
        impacts: run.impacts,
        minimum_speed: run.minimum_speed / scales.speed,
    };
    let monitor = Monitor::default();
    let levels: Vec<Level> = Level::available().collect();
    let mut tables = Vec::new();
    for &level in &levels {
        let records = run.simulate(Means { threads: 1, level }, &monitor);
        prop_assert!(
            records.is_ok(),
            "{}: {}",
            level.name(),
            records.unwrap_err()
        );
        tables.push(records.unwrap());
    }
    let mut compared = 0;
    for particle in 0..run.particles {
        let height = run.release_height / scales.length;
        let release = run
            .orientation
            .release(&body, height, run.seed, particle as u64);
        let row = |records: &Records, i: usize| {
            let k = particle * run.impacts + i;
            (
                bits(columns(records).map(|(_, column)| column[k])),
                records.contact[k],
            )
        };
        let mut numbers = Vec::new();
        let reason = bounce(
            &body,
            &run.law.scaled(&scales),
            0.0,
            release,
            limits,
            |impact: &Impact| {
                let expected = [
                    impact.time * scales.time,
                    impact.impact_velocity() * scales.speed,
                    impact.rebound_velocity() * scales.speed,
                    impact.restitution(),
                    impact.rotational_fraction(&body),
                    impact.energy_ratio(&body),
                    impact.before.angle(),
                ];
                numbers.push((bits(expected), impact.sphere as i8 + 1));
                true
            },
        );
        prop_assert!(
            reason.is_ok(),
            "particle {particle}: the oracle did not converge"
        );
        for (level, records) in levels.iter().zip(&tables) {
            let level = level.name();
            for (i, expected) in numbers.iter().enumerate() {
                let found = row(records, i);
                prop_assert!(
                    found == *expected,
                    "{level}, particle {particle}, impact {i}: {found:x?} should be {expected:x?}"
                );
            }
            // Nothing is written behind the last impact.
            for i in numbers.len()..run.impacts {
                prop_assert_eq!(
                    row(records, i),
                    ([u64::MAX; 7], 0),
                    "{}, particle {}",
                    level,
                    particle
                );
            }
            prop_assert_eq!(records.impacts[particle] as usize, numbers.len());
            prop_assert_eq!(
                records.stop_reason[particle],
                reason.unwrap() as i8,
                "{}",
                level
            );
            prop_assert_eq!(
                records.release_angle[particle].to_bits(),
                release.angle().to_bits()
            );
            compared += numbers.len() as u64;
        }
        // Time is finite and never runs back; in a collapse it may stand still.
        let times = numbers
            .iter()
            .map(|(numbers, _)| f64::from_bits(numbers[0]));
        let mut last = 0.0;
        for time in times {
            prop_assert!(
                time.is_finite() && time >= last,
                "particle {particle}: {time} after {last}"
            );
            last = time;
        }
    }
    Ok(compared)
}

/// The lanes follow the oracle to the bit wherever it goes: bodies from a sphere to rods of L/R = 100, laws from plastic
/// to elastic, releases on the plane and from 10⁹ radii, and in the last bit of every impact, count and stop reason.
#[test]
fn random_runs_are_the_oracle_to_the_bit_at_every_level() {
    let seconds: Option<u64> = std::env::var("RESTITUTION_FUZZ_SECONDS")
        .ok()
        .map(|seconds| {
            seconds
                .parse()
                .expect("RESTITUTION_FUZZ_SECONDS is a whole number")
        });
    let start = Instant::now();
    let compared = std::cell::Cell::new(0);
    let mut batch = 0;
    let under_way = |batch| match seconds {
        Some(seconds) => start.elapsed() < Duration::from_secs(seconds),
        None => batch < DEFAULT_BATCHES,
    };
    while under_way(batch) {
        let mut runner = TestRunner::new(Config {
            rng_seed: RngSeed::Fixed(batch),
            ..cases(BATCH)
        });
        let outcome = runner.run(&case(), |case| {
            compared.set(compared.get() + compare(&case)?);
            Ok(())
        });
        if let Err(TestError::Fail(why, case)) = outcome {
            panic!("batch {batch}: {why}\n{case:#?}");
        }
        batch += 1;
    }
    let cases = batch * u64::from(BATCH);
    println!("{cases} runs, {} impacts compared", compared.get());
    assert!(compared.get() > 100_000);
}
