//! Random runs, ordinary and outlandish, through every SIMD level: the same bits or none.
//!
//! Short by default; `RESTITUTION_FUZZ_SECONDS=600 cargo test --release -p restitution-core --test core -- --nocapture fuzz::` goes on
//! for ten minutes with more cases. A failure prints the smallest case of its kind that was found, with every parameter.

use crate::common::*;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestError, TestRunner};
use restitution_core::{
    Dumbbell, Law, Level, Monitor, Orientation, Resources, Run, Shape, Spin, Vector,
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
            release_height: (self.radius
                * (1.0 + body.solid().scaled.half_separation + self.above))
                .into(),
            gravity: self.gravity,
            orientation,
            minimum_speed: self.minimum_speed * (self.gravity * self.radius).sqrt(),
            settled: 0.0,
            spin: Spin::NONE,
            release_velocity: Vector::default(),
            incline: 0.0,
            seed: self.seed,
        }
    }
}

/// Exponent of the smallest sine: sines and rates of rotation are squared, and what underflows then counts as upright and as no
/// rotation.
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

/// Runs `case` at every level; returns the number of impacts compared.
fn compare(case: &Case) -> Result<u64, TestCaseError> {
    let run = case.run();
    let table = |level: Level, threads: usize| {
        let records = run.simulate(Resources { threads, level }, &Monitor::default());
        records
            .map(Records::from)
            .map_err(|error| TestCaseError::fail(format!("{}: {error}", level.name())))
    };
    let records = table(Level::Scalar, 1)?;
    let all = all_bits(&records);
    for level in Level::available() {
        prop_assert!(all_bits(&table(level, 1)?) == all, "{}", level.name());
    }
    for particle in 0..run.particles {
        let first = particle * run.impacts;
        let made = records.impacts[particle] as usize;
        let times = &records.time[first..first + made];
        // Time is finite and never runs back; in a collapse it may stand still.
        let mut last = 0.0;
        for &time in times {
            let ordered = time.is_finite() && time >= last;
            prop_assert!(ordered, "particle {particle}: {time} after {last}");
            last = time;
        }
        // Nothing is written behind the last impact.
        for number in first + made..first + run.impacts {
            prop_assert!(
                columns(&records)
                    .iter()
                    .all(|(_, column)| column[number].is_nan())
            );
            prop_assert_eq!(records.contact[number], 0);
        }
    }
    Ok(records.impacts.iter().sum::<i64>() as u64)
}

/// Every level has the same bits wherever it goes: bodies from a sphere to rods of L/R = 100, laws from plastic
/// to elastic, releases on the plane and from 10⁹ radii, and in the last bit of every impact, count and stop reason.
#[test]
fn random_runs_have_the_same_bits_at_every_level() {
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
