//! Random runs: every body, law, material and release, with the corners of their ranges.

use super::World;
use super::compare::{Case, Start};
use super::impact::Rule;
use super::normal::Restitution;
use super::random::Random;
use super::solid::Shape;
use restitution_core::{About, Hypothesis, Orientation, Spin};
use std::f64::consts::PI;

const SPEEDS: [f64; 5] = [0.0, 1e-3, 0.1, 1.0, 30.0];
const VALUES: [f64; 5] = [1.0, 0.9, 0.97, 0.6, 0.3];

/// L/R from a sphere over touching spheres to separate ones, and tiny.
fn elongation(random: &mut Random) -> f64 {
    match random.below(10) {
        0 => 0.0,
        1 => 2.0,
        2 => random.magnitude(-12.0, -1.0),
        3 => 0.1,
        _ => random.between(0.0, 4.0),
    }
}

pub fn shape(random: &mut Random, kind: usize) -> Shape {
    let radius = match random.below(3) {
        0 => 1.0,
        1 => 3e-3,
        _ => random.magnitude(-5.0, 2.0),
    };
    let density = 2500.0;
    let separation = radius * elongation(random);
    match kind {
        0 => Shape::Dumbbell {
            radius: [radius; 2],
            separation,
            density: [density; 2],
        },
        1 => Shape::Dumbbell {
            radius: if random.chance(0.2) {
                [radius; 2]
            } else if random.chance(0.5) {
                [radius, radius * random.between(0.05, 1.0)]
            } else {
                [radius * random.between(0.05, 1.0), radius]
            },
            separation,
            density: [density, density * random.magnitude(-1.0, 1.0)],
        },
        2 => Shape::LoadedSphere {
            radius,
            density,
            load: density * radius.powi(3) * random.magnitude(-2.0, 2.0),
            offset: radius * random.between(0.0, 1.0),
        },
        3 => Shape::Spherocylinder {
            radius,
            separation,
            density,
        },
        4 => Shape::Spheroid {
            equatorial: radius,
            polar: radius * (1.0 + random.magnitude(-6.0, 1.0)),
            density,
        },
        _ => Shape::Spheroid {
            equatorial: radius,
            polar: radius / (1.0 + random.magnitude(-6.0, 1.0)),
            density,
        },
    }
}

pub fn normal(random: &mut Random) -> Restitution {
    match random.below(10) {
        0 => Restitution::Constant(random.one(&[0.0, 1.0])),
        1 => Restitution::Viscoelastic {
            young_modulus: 6e10,
            poisson_ratio: 0.2,
            dissipation: random.magnitude(-8.0, -4.0),
            density: 2500.0,
            radius: 3e-3,
        },
        2 => Restitution::Plastic {
            yield_speed: random.magnitude(-4.0, 1.0),
        },
        3 => Restitution::Tabulated {
            speeds: &SPEEDS,
            values: &VALUES,
        },
        _ => Restitution::Constant(random.between(0.0, 1.0)),
    }
}

pub const HYPOTHESES: [Hypothesis; 3] =
    [Hypothesis::Stronge, Hypothesis::Poisson, Hypothesis::Newton];

pub fn rule(random: &mut Random, kind: usize) -> Rule {
    let friction = match random.below(10) {
        0 => 0.0,
        1 => random.magnitude(-6.0, 6.0),
        _ => random.between(0.0, 1.5),
    };
    let tangential = match random.below(6) {
        0 => random.one(&[-1.0, 0.0, 1.0]),
        _ => random.between(-1.0, 1.0),
    };
    match kind {
        0 => Rule::Tangential { tangential },
        1 => Rule::Frictionless,
        2 => Rule::ChatterjeeRuina {
            tangential,
            friction,
        },
        _ => Rule::Coulomb {
            friction,
            hypothesis: HYPOTHESES[(kind - 3) % 3],
        },
    }
}

/// Kinds of shapes and of laws.
pub const SHAPES: usize = 6;
pub const RULES: usize = 6;

fn orientation(random: &mut Random) -> Orientation<'static> {
    random.one(&[Orientation::UniformAngle, Orientation::Isotropic])
}

/// Particles let go at rest.
fn at_rest(random: &mut Random, particles: usize) -> Start {
    if random.chance(0.3) {
        return Start::Drawn(particles, orientation(random), Spin::NONE);
    }
    let angle = |random: &mut Random| match random.below(8) {
        0 => random.magnitude(-12.0, -1.0),
        1 => 0.5 * PI + random.one(&[-1.0, 1.0]) * random.magnitude(-12.0, -1.0),
        2 => random.between(-100.0, 100.0),
        _ => random.between(0.0, PI),
    };
    Start::Each(
        (0..particles)
            .map(|_| (angle(random), 0.0, [0.0; 3]))
            .collect(),
    )
}

/// Particles that spin; rates in units of `rate`.
fn spinning(random: &mut Random, particles: usize, rate: f64) -> Start {
    if random.chance(0.3) {
        let about = random.one(&[About::Isotropic, About::Horizontal, About::Across]);
        let high = rate * random.magnitude(-2.0, 1.5);
        let low = high * random.between(0.0, 1.0);
        let spin = Spin::Random { low, high, about };
        return Start::Drawn(particles, orientation(random), spin);
    }
    let particle = |random: &mut Random| {
        let (angle, azimuth) = (random.between(0.0, PI), random.between(0.0, 2.0 * PI));
        let axis = [
            angle.sin() * azimuth.cos(),
            angle.sin() * azimuth.sin(),
            angle.cos(),
        ];
        let about = if random.chance(0.2) {
            axis
        } else {
            random.direction()
        };
        let size = rate
            * match random.below(5) {
                0 => 0.0,
                1 => random.magnitude(-6.0, 2.5),
                _ => random.magnitude(-1.0, 1.5),
            };
        (angle, azimuth, about.map(|x| size * x))
    };
    Start::Each((0..particles).map(|_| particle(random)).collect())
}

/// A run of this shape and this law.
pub fn case(random: &mut Random, kind: usize, law: usize, planar: bool) -> Case {
    let shape = shape(random, kind);
    let size = shape.size();
    let gravity = if random.chance(0.5) {
        9.81
    } else {
        random.magnitude(-2.0, 2.0)
    };
    let speed = (gravity * size).sqrt();
    let particles = 4;
    let above = match random.below(6) {
        0 => random.magnitude(-4.0, 0.0),
        1 => random.magnitude(1.5, 2.5),
        _ => random.magnitude(0.0, 1.5),
    };
    let (start, velocity, incline) = if planar {
        (at_rest(random, particles), [0.0; 3], 0.0)
    } else {
        let fast = speed * random.magnitude(-1.0, 1.3);
        let velocity = if random.chance(0.3) {
            [0.0; 3]
        } else {
            random.direction().map(|x| fast * x)
        };
        let incline = if random.chance(0.6) {
            0.0
        } else {
            random.between(0.0, 1.4)
        };
        (spinning(random, particles, speed / size), velocity, incline)
    };
    Case {
        world: World {
            shape,
            rule: rule(random, law),
            normal: normal(random),
            gravity,
            incline,
            minimum_speed: if random.chance(0.7) {
                0.0
            } else {
                speed * random.magnitude(-2.0, 0.5)
            },
        },
        height: shape.solid().farthest() + size * above,
        velocity,
        start,
        impacts: 1 + random.below(30),
        seed: random.bits(),
    }
}
