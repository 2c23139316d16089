//! The product beside the oracle: random runs of every body under every law from every release, and the statistics of long ones.

use crate::common::all_bits;
use crate::oracle::cases::{RULES, SHAPES, case};
use crate::oracle::compare::{Case, Seen, Start};
use crate::oracle::impact::Rule;
use crate::oracle::normal::Restitution;
use crate::oracle::random::Random;
use crate::oracle::solid::Shape;
use crate::oracle::{Noise, Particle, World};
use restitution_core::statistics::{Axis, Bins, By};
use restitution_core::{Level, Monitor, Orientation, Resources, Spin};
use std::time::{Duration, Instant};

/// Rounds through all bodies and laws where no time is given.
const ROUNDS: u64 = 2;

fn resources(level: Level, threads: usize) -> Resources {
    Resources { threads, level }
}

fn kinds() -> impl Iterator<Item = (usize, usize, bool)> {
    let shapes = (0..SHAPES).flat_map(|shape| (0..RULES).map(move |law| (shape, law)));
    shapes.flat_map(|(shape, law)| [true, false].map(|planar| (shape, law, planar)))
}

/// Impact by impact, within the growth of rounding, and the same bits from every level on any number of threads. `make fuzz` goes on
/// for ten minutes, or as long as `RESTITUTION_FUZZ_SECONDS` says.
#[test]
fn every_impact_is_the_oracles() {
    let seconds = std::env::var("RESTITUTION_FUZZ_SECONDS").ok();
    let seconds = seconds.map(|text| {
        let number = text.parse();
        number.expect("RESTITUTION_FUZZ_SECONDS is a number")
    });
    let start = Instant::now();
    let mut total = Seen::default();
    let mut round = 0;
    let more = |round: u64| match seconds {
        Some(seconds) => start.elapsed() < Duration::from_secs_f64(seconds),
        None => round < ROUNDS,
    };
    while more(round) {
        for (shape, law, planar) in kinds() {
            let seed = ((round * 100 + shape as u64) * 100 + law as u64) * 2 + u64::from(planar);
            let case = case(&mut Random(seed), shape, law, planar);
            let records = case.records(resources(Level::Scalar, 1));
            for level in Level::available() {
                let other = case.records(resources(level, 2));
                assert!(
                    all_bits(&records) == all_bits(&other),
                    "{level:?}: {case:#?}"
                );
            }
            match case.compare(&records) {
                Ok(seen) => total = total.and(seen),
                Err(why) => panic!("round {round}, shape {shape}, law {law}: {why}\n{case:#?}"),
            }
        }
        round += 1;
    }
    println!("{round} rounds, {total:?}, {:.1?}", start.elapsed());
    assert!(total.impacts > 2000 * round && total.ends > 0);
}

/// A dumbbell of L = 2R that loses much, so that many impacts can be compared one by one.
fn lossy(start: Start, impacts: usize) -> Case {
    Case {
        world: World {
            shape: Shape::Dumbbell {
                radius: [3e-3; 2],
                separation: 6e-3,
                density: [2500.0; 2],
            },
            rule: Rule::Tangential { tangential: 0.5 },
            normal: Restitution::Constant(0.6),
            gravity: 9.81,
            incline: 0.0,
            minimum_speed: 0.0,
        },
        height: 0.06,
        velocity: [0.0; 3],
        start,
        impacts,
        seed: 7,
    }
}

/// The histogram by the number of the impact: how many impacts have which ε, and their mean, are what the oracle counts. An ε within 10⁻⁹
/// of an edge may be counted on either side of it.
#[test]
fn the_statistics_count_what_the_oracle_counts() {
    const NEAR: f64 = 1e-9;
    const QUANTUM: f64 = 1.0 / 16_777_216.0; // moments are sums of ε rounded to multiples of this
    let spin = Spin::Random {
        low: 10.0,
        high: 200.0,
        about: restitution_core::About::Isotropic,
    };
    for spin in [Spin::NONE, spin] {
        let case = lossy(Start::Drawn(400, Orientation::Isotropic, spin), 3);
        let edges: Vec<f64> = (0..=40).map(|i| -2.0 + 0.1 * f64::from(i)).collect();
        let bins = Bins {
            by: By::Number(case.impacts),
            restitution: Axis::new("edges", &edges).unwrap(),
            fraction: Some(Axis::new("edges", &[0.0, 1.0]).unwrap()),
        };
        let histogram = case.with_run(|run| {
            run.statistics(&bins, resources(Level::best(), 2), &Monitor::default())
                .unwrap()
        });
        let records = case.records(resources(Level::best(), 2));
        let body = case.world.shape.body();
        let mut found = vec![Vec::new(); case.impacts];
        for particle in 0..records.particles() {
            let release = case.release(&records, particle);
            let mut particle = Particle::new(&case.world, &body, &release, Noise::none());
            for row in &mut found {
                row.push(particle.next().unwrap().columns[3]);
            }
        }
        for (row, found) in found.iter().enumerate() {
            assert_eq!(histogram.rows.number(row), found.len() as u64);
            let mean = found.iter().sum::<f64>() / found.len() as f64;
            let counted = histogram.rows.moments(row).unwrap().mean;
            assert!(
                (counted - mean).abs() <= QUANTUM,
                "{counted} in {row}: {mean}"
            );
            let counts = &histogram.restitution.counts()[row * histogram.restitution.columns()..];
            for (bin, edges) in edges.windows(2).enumerate() {
                let within = |slack: f64| {
                    let inside = |x: &&f64| edges[0] - slack <= **x && **x < edges[1] + slack;
                    found.iter().filter(inside).count() as u64
                };
                let counted = counts[bin + 1]; // the first is of what is below
                let allowed = within(-NEAR)..=within(NEAR);
                assert!(
                    allowed.contains(&counted),
                    "{counted} in {row}, {bin}: {allowed:?}"
                );
            }
        }
    }
}

/// Long after rounding has made every trajectory another one, the ensembles are the same: ⟨ε⟩ and ⟨ε²⟩ of impacts 31 to 60, with other
/// random numbers on either side. Particles are independent, so that their own means have the standard error; five of them are a false
/// alarm in 2 million numbers.
#[test]
fn long_runs_have_the_oracles_statistics() {
    let spin = Spin::Random {
        low: 0.0,
        high: 100.0,
        about: restitution_core::About::Isotropic,
    };
    let rules = [
        Rule::Tangential { tangential: 1.0 },
        Rule::Coulomb {
            friction: 0.2,
            hypothesis: restitution_core::Hypothesis::Stronge,
        },
    ];
    let (first, last) = (30, 60);
    for (rule, spin) in rules
        .into_iter()
        .flat_map(|rule| [(rule, Spin::NONE), (rule, spin)])
    {
        let mut case = lossy(Start::Drawn(120, Orientation::Isotropic, spin), last);
        case.world.rule = rule;
        case.world.normal = Restitution::Constant(0.97);
        case.world.shape = Shape::Dumbbell {
            radius: [3e-3; 2],
            separation: 1e-3,
            density: [2500.0; 2],
        };
        let product = case.records(resources(Level::best(), 2));
        let product = product
            .restitution
            .chunks(last)
            .map(|row| row[first..].to_vec());
        let releases = Case {
            seed: 8,
            impacts: 1,
            ..case.clone()
        };
        let records = releases.records(resources(Level::best(), 2));
        let body = case.world.shape.body();
        let oracle = (0..records.particles()).map(|particle| {
            let release = releases.release(&records, particle);
            let mut particle = Particle::new(&case.world, &body, &release, Noise::none());
            let all = (0..last).map_while(|_| Some(particle.next().ok()?.columns[3]));
            all.skip(first).collect::<Vec<_>>()
        });
        let samples = [product.collect::<Vec<_>>(), oracle.collect()];
        for power in [1, 2] {
            let [a, b] = samples.each_ref().map(|sample| mean(sample, power));
            let distance = (a.0 - b.0).abs() / a.1.hypot(b.1);
            assert!(distance < 5.0, "{rule:?}, {spin:?}: {a:?}, {b:?}");
        }
    }
}

/// Mean of a power over particles, and its standard error. A particle that ended early counts as far as it came.
fn mean(sample: &[Vec<f64>], power: i32) -> (f64, f64) {
    let own = |row: &Vec<f64>| {
        let numbers: Vec<_> = row.iter().filter(|x| !x.is_nan()).collect();
        let sum: f64 = numbers.iter().map(|x| x.powi(power)).sum();
        (!numbers.is_empty()).then(|| sum / numbers.len() as f64)
    };
    let resources: Vec<f64> = sample.iter().filter_map(own).collect();
    let number = resources.len() as f64;
    let mean = resources.iter().sum::<f64>() / number;
    let variance = resources.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (number - 1.0);
    (mean, (variance / number).sqrt())
}
