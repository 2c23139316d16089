//! The runs whose digests are written down.

use crate::common::*;
use restitution_core::{
    About, ChatterjeeRuina, Coulomb, Dumbbell, Frictionless, Hypothesis, Law, LoadedSphere, Normal,
    Orientation, Plastic, Rule, Run, Solid, Spherocylinder, Spheroid, Spin, Tabulated,
    TangentialRestitution, Vector, Viscoelastic,
};

/// What the paper's Fig. 2 is drawn from: R = 10 mm, dropped so that a sphere of that radius arrives with 1 m/s.
fn figure_2() -> Run<'static> {
    let radius = 10e-3;
    Run {
        body: Dumbbell::new(radius, 0.1 * radius, 2500.0).unwrap().into(),
        release_height: (radius + 1.0 / (2.0 * 9.81)).into(),
        particles: 700,
        impacts: 500,
        seed: 1,
        ..paper(0.1, law(0.98, 1.0))
    }
}

fn glass() -> Normal<'static> {
    Viscoelastic::new(6e10, 0.22, 1e-6, 2500.0, 3e-3)
        .unwrap()
        .into()
}

fn measured() -> Normal<'static> {
    const SPEEDS: [f64; 4] = [0.05, 0.2, 0.5, 1.0];
    const VALUES: [f64; 4] = [0.98, 0.95, 0.93, 0.88];
    Tabulated::new(&SPEEDS, &VALUES).unwrap().into()
}

/// Friction in which slip goes on, stops and turns.
fn coulomb(elongation: f64, normal: Normal<'static>, hypothesis: Hypothesis) -> Run<'static> {
    Run {
        particles: 300,
        impacts: 200,
        ..paper(
            elongation,
            Law::new(normal, Coulomb::new(0.25, hypothesis).unwrap()).unwrap(),
        )
    }
}

/// From upright to upside down.
pub fn angles() -> Vec<f64> {
    (0..450).map(|i| 0.007 * f64::from(i)).collect()
}

/// A run of each kind: by name, from nearly round to separate spheres, from plastic to elastic, with every way to be
/// released and every way to end.
pub fn jobs(angles: &[f64]) -> Vec<(&'static str, Run<'_>)> {
    vec![
        ("figure-2", figure_2()),
        (
            "nearly-round",
            Run {
                particles: 203,
                impacts: 1000,
                ..paper(1e-3, law(0.99, 0.8))
            },
        ),
        (
            "gaining-energy",
            Run {
                particles: 500,
                impacts: 300,
                orientation: Orientation::Isotropic,
                ..paper(0.5, law(0.98, 1.0))
            },
        ),
        (
            "touching-spheres",
            Run {
                particles: 1001,
                impacts: 400,
                ..paper(2.0, law(0.7, -0.4))
            },
        ),
        (
            "separate-spheres",
            Run {
                particles: 250,
                impacts: 400,
                ..paper(3.5, law(1.0, -1.0))
            },
        ),
        (
            "slow-end",
            Run {
                particles: 1500,
                impacts: 400,
                minimum_speed: 0.1,
                settled: 0.0,
                ..paper(1.0, law(0.9, 0.6))
            },
        ),
        (
            "plastic",
            Run {
                particles: 500,
                impacts: 100,
                ..paper(0.1, law(0.0, 0.5))
            },
        ),
        (
            "frictionless",
            Run {
                particles: 400,
                impacts: 200,
                ..paper(0.1, Law::new(0.98, Frictionless).unwrap())
            },
        ),
        (
            "stronge-viscoelastic",
            coulomb(0.5, glass(), Hypothesis::Stronge),
        ),
        (
            "poisson-plastic",
            coulomb(2.0, Plastic::new(0.02).unwrap().into(), Hypothesis::Poisson),
        ),
        (
            "newton-tabulated",
            coulomb(1.0, measured(), Hypothesis::Newton),
        ),
        (
            "chatterjee-ruina",
            Run {
                particles: 300,
                impacts: 200,
                ..paper(
                    0.3,
                    Law::new(0.9, ChatterjeeRuina::new(-0.3, 0.2).unwrap()).unwrap(),
                )
            },
        ),
        (
            "viscoelastic",
            Run {
                particles: 300,
                impacts: 200,
                ..paper(
                    0.1,
                    Law::new(glass(), TangentialRestitution::new(1.0).unwrap()).unwrap(),
                )
            },
        ),
        (
            "given-angles",
            Run {
                particles: angles.len(),
                impacts: 300,
                orientation: Orientation::Given(angles),
                ..paper(0.7, law(0.95, 0.2))
            },
        ),
        (
            "from-the-sky",
            Run {
                particles: 300,
                impacts: 100,
                release_height: 1e4.into(),
                ..paper(0.1, law(0.98, 1.0))
            },
        ),
    ]
}

/// Every body under every law, dropped and thrown.
pub fn kinds() -> Vec<(String, Run<'static>)> {
    let r = 3e-3;
    let bodies: [(&str, Solid); 7] = [
        ("sphere", Dumbbell::new(r, 0.0, 2500.0).unwrap().into()),
        ("dumbbell", Dumbbell::new(r, r, 2500.0).unwrap().into()),
        (
            "unequal",
            Dumbbell::unequal([r, 0.7 * r], 1.5 * r, [2500.0, 1200.0])
                .unwrap()
                .into(),
        ),
        (
            "loaded",
            LoadedSphere::new(r, 2500.0, 1e-4, 0.4 * r).unwrap().into(),
        ),
        (
            "capsule",
            Spherocylinder::new(r, 0.8 * r, 2500.0).unwrap().into(),
        ),
        ("oblate", Spheroid::new(r, 0.6 * r, 2500.0).unwrap().into()),
        ("prolate", Spheroid::new(r, 1.8 * r, 2500.0).unwrap().into()),
    ];
    let coulomb = |hypothesis| Rule::from(Coulomb::new(0.3, hypothesis).unwrap());
    let rules: [(&str, Rule); 6] = [
        ("paper", TangentialRestitution::new(0.8).unwrap().into()),
        ("frictionless", Frictionless.into()),
        ("stronge", coulomb(Hypothesis::Stronge)),
        ("poisson", coulomb(Hypothesis::Poisson)),
        ("newton", coulomb(Hypothesis::Newton)),
        ("bilinear", ChatterjeeRuina::new(-0.3, 0.2).unwrap().into()),
    ];
    let mut kinds = Vec::new();
    for (i, (body, solid)) in bodies.into_iter().enumerate() {
        for (j, (name, rule)) in rules.into_iter().enumerate() {
            let normal = if (i + j) % 3 == 0 {
                glass()
            } else {
                0.9.into()
            };
            let dropped = Run {
                body: solid.into(),
                particles: 100,
                impacts: 40,
                ..paper(0.1, Law::new(normal, rule).unwrap())
            };
            let thrown = Run {
                orientation: Orientation::Isotropic,
                spin: Spin::Random {
                    low: 5.0,
                    high: 60.0,
                    about: About::Isotropic,
                },
                release_velocity: Vector::new(0.1, -0.2, 0.3),
                incline: 0.1,
                ..dropped
            };
            kinds.push((format!("{body}-{name}-dropped"), dropped));
            kinds.push((format!("{body}-{name}-thrown"), thrown));
        }
    }
    kinds
}
