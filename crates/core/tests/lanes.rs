//! Particles side by side in SIMD lanes: those of the oracle one by one, and the same bits at every level.

use crate::common::*;
use crate::oracle::World;
use crate::oracle::cases::HYPOTHESES;
use crate::oracle::compare::{Case, Seen, Start};
use crate::oracle::impact::Rule;
use crate::oracle::normal::Restitution;
use crate::oracle::solid::Shape;
use restitution_core::{
    Coulomb, Law, Level, Monitor, Orientation, Resources, Run, Spin, StopReason,
};

/// Enough for a vector and a part of the next one at every level.
const PARTICLES: usize = 11;

fn case(elongation: f64, rule: Rule, normal: Restitution) -> Case {
    let radius = 3e-3;
    Case {
        world: World {
            shape: Shape::Dumbbell {
                radius: [radius; 2],
                separation: elongation * radius,
                density: [2500.0; 2],
            },
            rule,
            normal,
            gravity: 9.81,
            incline: 0.0,
            minimum_speed: 0.0,
        },
        height: 0.06,
        velocity: [0.0; 3],
        start: Start::Drawn(PARTICLES, Orientation::UniformAngle, Spin::NONE),
        impacts: 25,
        seed: 11,
    }
}

fn agrees(case: &Case) -> Seen {
    let resources = Resources {
        threads: 1,
        level: Level::best(),
    };
    let found = case.compare(&case.records(resources));
    found.unwrap_or_else(|why| panic!("{why}: {case:#?}"))
}

/// Every kind of motion: nearly round to separate spheres, elastic to plastic, all tangential laws.
#[test]
fn particles_in_lanes_are_the_oracles() {
    let mut seen = Seen::default();
    for elongation in [0.0, 1e-3, 0.02, 0.1, 0.5, 1.0, 2.0, 3.5] {
        for normal in [0.0, 0.4, 0.9, 0.98, 1.0] {
            for tangential in [-1.0, -0.3, 0.0, 0.7, 1.0] {
                let rule = Rule::Tangential { tangential };
                seen = seen.and(agrees(&case(
                    elongation,
                    rule,
                    Restitution::Constant(normal),
                )));
            }
        }
    }
    println!("{seen:?}");
    assert!(seen.impacts > 10_000);
}

/// The other laws, and coefficients that depend on the speed.
#[test]
fn every_law_is_the_oracles_in_lanes() {
    let normals = [
        Restitution::Constant(0.9),
        Restitution::Viscoelastic {
            young_modulus: 6e10,
            poisson_ratio: 0.2,
            dissipation: 1e-6,
            density: 2500.0,
            radius: 3e-3,
        },
        Restitution::Plastic { yield_speed: 0.05 },
        Restitution::Tabulated {
            speeds: &[0.01, 0.1, 0.3, 1.0],
            values: &[1.0, 0.95, 0.97, 0.8],
        },
    ];
    for normal in normals {
        let mut rules = vec![
            Rule::Tangential { tangential: 0.5 },
            Rule::Frictionless,
            Rule::ChatterjeeRuina {
                tangential: 0.2,
                friction: 0.3,
            },
        ];
        for hypothesis in HYPOTHESES {
            rules.extend([0.3, 1.5].map(|friction| Rule::Coulomb {
                friction,
                hypothesis,
            }));
        }
        for rule in rules {
            for elongation in [0.0, 0.1, 1.0, 3.5] {
                let seen = agrees(&case(elongation, rule, normal));
                assert!(
                    seen.impacts as usize > 4 * PARTICLES,
                    "{rule:?}, {normal:?}: {seen:?}"
                );
            }
        }
    }
}

/// The bits must not depend on the vector width, the number of threads or on what else is in the run.
#[test]
fn every_level_and_thread_count_gives_the_same_bits() {
    let run = Run {
        minimum_speed: 0.05,
        settled: 0.0,
        particles: 333,
        impacts: 200,
        ..paper(0.5, law(0.9, 0.5))
    };
    let at = |level: Level, threads: usize| {
        let resources = Resources { threads, level };
        Records::from(run.simulate(resources, &Monitor::default()).unwrap())
    };
    let reference = at(Level::Scalar, 1);
    let slow = StopReason::SpeedBelowThreshold as i8;
    assert!(reference.stop_reason.contains(&slow));
    for level in Level::available() {
        for threads in [1, 2, 7] {
            let same = all_bits(&reference) == all_bits(&at(level, threads));
            assert!(same, "{level:?}, {threads} threads");
        }
    }
}

/// Contacts whose slip turns take different numbers of steps, and wait for one another in the lanes: each has the bits that it has
/// alone, whatever its neighbours do meanwhile. With friction that jams at many attitudes compressions come more than once.
#[test]
fn turning_contacts_have_the_same_bits_in_every_lane() {
    for (hypothesis, elongation) in HYPOTHESES.into_iter().zip([3.5, 1.0, 2.0]) {
        for friction in [0.3, 1.6] {
            let law = Law::new(0.8, Coulomb::new(friction, hypothesis).unwrap()).unwrap();
            let run = Run {
                particles: 67,
                impacts: 60,
                spin: Spin::Thermal { rate: 100.0 },
                ..paper(elongation, law)
            };
            let at = |level: Level| {
                let resources = Resources { threads: 1, level };
                let records = run.simulate(resources, &Monitor::default()).unwrap();
                all_bits(&records.into())
            };
            let alone = at(Level::Scalar);
            for level in Level::available() {
                assert!(alone == at(level), "{level:?}, {hypothesis:?}, {friction}");
            }
        }
    }
}
