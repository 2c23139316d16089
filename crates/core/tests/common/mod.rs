//! What the tests share: every call of the engine's interface, random motions, and the gaps worked out in another way.
#![allow(dead_code, reason = "each test file uses its own part")]

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use restitution_core::collision::collide;
use restitution_core::{
    Body, ChatterjeeRuina, Coulomb, Departure, Dumbbell, Flight, Frictionless, Hypothesis, Impact,
    Landing, Law, Level, Limits, Means, Monitor, Normal, Orientation, Plastic, Records, Run, Shape,
    Sphere, Spin, State, StopReason, Tabulated, TangentialRestitution, Vector, Viscoelastic,
    bounce, first_contact,
};
use std::f64::consts::PI;

/// The same cases in every run of the tests.
pub fn cases(cases: u32) -> Config {
    Config {
        cases,
        rng_seed: RngSeed::Fixed(20_141_120),
        failure_persistence: None,
        ..Config::default()
    }
}

/// The dumbbell of the given L/R in the core's units.
pub fn dumbbell(elongation: f64) -> Body {
    Dumbbell::new(1.0, elongation, 1.0).unwrap().scaled()
}

pub fn law(normal: f64, tangential: f64) -> Law<'static> {
    TangentialRestitution::new(normal, tangential)
        .unwrap()
        .into()
}

/// A state at rest, as the paper lets go of its particles.
pub fn at_rest(body: &Body, height: f64, angle: f64) -> State {
    let axis = Vector::new(angle.sin(), 0.0, angle.cos());
    State::with_spin(body, height, Vector::default(), axis, Vector::default())
}

/// The same state at another height.
pub fn at_height(state: &State, height: f64) -> State {
    State {
        lift: height - 1.0,
        ..*state
    }
}

/// Height of the centre of mass above R.
pub fn lift(state: &State) -> f64 {
    state.lift
}

/// Kinetic and potential energy.
pub fn energy(state: &State, body: &Body) -> f64 {
    state.kinetic_energy(body) + state.lift
}

/// The first contact of a flight, which must be found.
pub fn landing(state: State, body: &Body, departure: Departure) -> Landing {
    first_contact(&Flight::new(state, 0.0), body, departure).unwrap()
}

/// The whole trajectory, and why it ended.
pub fn trajectory(
    body: &Body,
    law: &Law<'_>,
    release: State,
    impacts: usize,
) -> (Vec<Impact>, StopReason) {
    let mut all = Vec::new();
    let limits = Limits {
        impacts,
        minimum_speed: 0.0,
    };
    let reason = bounce(body, law, 0.0, release, limits, |impact| {
        all.push(*impact);
        true
    });
    (all, reason.unwrap())
}

/// A flight with its landing, as the bounce loop goes through them.
#[derive(Debug)]
pub struct Leg {
    pub start: State,
    pub departure: Departure,
    pub time: f64,
    pub impact: Impact,
}

/// The first flights of a trajectory.
pub fn legs(body: &Body, law: &Law<'_>, release: State, most: usize) -> Vec<Leg> {
    let mut start = release;
    let mut departure = Departure::Free;
    let mut legs = Vec::new();
    while legs.len() < most {
        let Landing::Impact {
            time,
            state: before,
            sphere,
        } = landing(start, body, departure)
        else {
            break;
        };
        let (after, speed) = collide(body, law, &before, sphere);
        legs.push(Leg {
            start,
            departure,
            time,
            impact: Impact {
                time,
                before,
                after,
                sphere,
            },
        });
        departure = Departure::Touching { sphere, speed };
        start = after;
    }
    legs
}

/// An ensemble like the paper's: radius 3 mm, dropped from 60 mm.
pub fn paper(elongation: f64, law: Law<'_>) -> Run<'_> {
    let radius = 3e-3;
    Run {
        body: Dumbbell::new(radius, elongation * radius, 2500.0)
            .unwrap()
            .into(),
        law,
        particles: 100,
        impacts: 100,
        release_height: 0.06,
        gravity: 9.81,
        orientation: Orientation::UniformAngle,
        minimum_speed: 0.0,
        spin: Spin::NONE,
        velocity: Vector::default(),
        incline: 0.0,
        seed: 2014,
    }
}

pub fn simulate(run: &Run<'_>) -> Records {
    simulate_on(run, 0, &Monitor::default())
}

pub fn simulate_on(run: &Run<'_>, threads: usize, monitor: &Monitor) -> Records {
    let level = Level::best();
    run.simulate(Means { threads, level }, monitor).unwrap()
}

pub fn error_of(run: &Run<'_>) -> restitution_core::Error {
    let means = Means {
        threads: 1,
        level: Level::Scalar,
    };
    run.simulate(means, &Monitor::default()).unwrap_err()
}

/// The columns of doubles, with their names.
pub fn columns(records: &Records) -> [(&'static str, &[f64]); 7] {
    [
        ("time", &records.time),
        ("impact_velocity", &records.impact_velocity),
        ("rebound_velocity", &records.rebound_velocity),
        ("restitution", &records.restitution),
        ("rotational_fraction", &records.rotational_fraction),
        ("energy_ratio", &records.energy_ratio),
        ("angle", &records.angle),
    ]
}

/// The gap under a sphere a time after `start`: the parabola, and the axis turned about **Λ** by Rodrigues' formula with
/// the platform's sine and cosine.
pub fn gap(start: &State, body: &Body, time: f64, sphere: Sphere) -> f64 {
    let side = sphere.sign() * body.half_separation;
    let rate = start.precession.norm();
    let tilt = if rate == 0.0 {
        start.axis.z
    } else {
        let about = start.precession / rate;
        let (sin, cos) = (rate * time).sin_cos();
        let along = about.dot(start.axis) * about.z;
        start.axis.z * cos + about.cross(start.axis).z * sin + along * (1.0 - cos)
    };
    (start.lift + side * tilt) + time * (start.velocity.z - 0.5 * time)
}

/// What sixteen roundings of the largest term of [`gap`] amount to, the rounding of the time included: the engine's and
/// the test's own. `fastest` is the largest energy so far: an earlier landing was as inexact as that.
pub fn gap_tolerance(start: &State, body: &Body, time: f64, fastest: f64) -> f64 {
    let turning = body.half_separation * start.precession.norm() * time;
    let path = start.velocity.z.abs() * time + time * time + start.lift.abs();
    16.0 * f64::EPSILON * (1.0 + body.half_separation + path + turning + fastest)
}

/// Velocity of the point of contact, (7), (8).
pub fn contact_velocity(state: &State, body: &Body, sphere: Sphere) -> Vector {
    state.velocity + state.spin(body).cross(arm(state, body, sphere))
}

/// From the centre of mass to the point of contact, (6).
pub fn arm(state: &State, body: &Body, sphere: Sphere) -> Vector {
    state.axis * (sphere.sign() * body.half_separation) - Vector::new(0.0, 0.0, 1.0)
}

/// Directions, uniform on the sphere, with the corners of the program among them: upright, level and nearly so.
pub fn direction() -> impl Strategy<Value = Vector> {
    let uniform = (-1.0..1.0_f64, 0.0..2.0 * PI).prop_map(|(z, phi)| {
        let r = (1.0 - z * z).sqrt();
        Vector::new(r * phi.cos(), r * phi.sin(), z)
    });
    let nearly_level = (-18.0..-2.0_f64, any::<bool>()).prop_map(|(exponent, up)| {
        let z = if up { 1.0 } else { -1.0 } * 10.0_f64.powf(exponent);
        let v = Vector::new(0.6, 0.8, z);
        v / v.norm()
    });
    prop_oneof![
        6 => uniform,
        1 => Just(Vector::new(0.0, 0.0, 1.0)),
        1 => Just(Vector::new(0.0, 0.0, -1.0)),
        1 => Just(Vector::new(1.0, 0.0, 0.0)),
        2 => nearly_level,
    ]
}

/// Numbers of every magnitude between two powers of ten.
pub fn magnitude(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|exponent| 10.0_f64.powf(exponent))
}

/// L/R from a sphere over touching spheres to separate ones, and tiny.
pub fn elongation() -> impl Strategy<Value = f64> {
    prop_oneof![
        1 => Just(0.0),
        1 => Just(2.0),
        2 => magnitude(-15.0, -1.0),
        6 => 0.0..4.0_f64,
    ]
}

/// ε^n and ε^t, with the ends of their ranges.
pub fn coefficients() -> impl Strategy<Value = (f64, f64)> {
    let normal = prop_oneof![1 => Just(1.0), 1 => Just(0.0), 6 => 0.0..1.0_f64];
    let tangential = prop_oneof![
        1 => Just(1.0), 1 => Just(-1.0), 1 => Just(0.0), 5 => -1.0..1.0_f64
    ];
    (normal, tangential)
}

/// Every kind of normal coefficient, the constant one given. Speeds are in m/s and in √(gR) alike.
pub fn normal(constant: f64) -> impl Strategy<Value = Normal<'static>> {
    const SPEEDS: [f64; 5] = [0.0, 1e-3, 0.1, 1.0, 30.0];
    const VALUES: [f64; 5] = [1.0, 0.9, 0.97, 0.6, 0.0];
    let table = Tabulated::new(&SPEEDS, &VALUES).unwrap();
    prop_oneof![
        4 => Just(Normal::from(constant)),
        1 => magnitude(-8.0, -2.0).prop_map(|dissipation| {
            Viscoelastic::new(6e10, 0.2, dissipation, 2500.0, 3e-3).unwrap().into()
        }),
        1 => magnitude(-4.0, 1.0).prop_map(|speed| Plastic::new(speed).unwrap().into()),
        1 => Just(table.into()),
    ]
}

/// Every law with every kind of normal coefficient, the constant one and the tangential one given.
pub fn every_law((normal, tangential): (f64, f64)) -> impl Strategy<Value = Law<'static>> {
    let friction = prop_oneof![1 => Just(0.0), 6 => 0.0..1.5_f64, 2 => magnitude(-6.0, 6.0)];
    let hypothesis = prop::sample::select(vec![
        Hypothesis::Stronge,
        Hypothesis::Poisson,
        Hypothesis::Newton,
    ]);
    (self::normal(normal), friction, hypothesis, 0..7).prop_map(
        move |(normal, friction, hypothesis, kind)| match kind {
            0 | 1 => TangentialRestitution::new(normal, tangential)
                .unwrap()
                .into(),
            2 => Frictionless::new(normal).unwrap().into(),
            3 => ChatterjeeRuina::new(normal, tangential, friction)
                .unwrap()
                .into(),
            _ => Coulomb::new(normal, friction, hypothesis).unwrap().into(),
        },
    )
}

/// A body, a law and a free state above the plane: every spin, also about the symmetry axis, up to a rate of 10³ √(g/R).
pub fn motion() -> impl Strategy<Value = (Body, Law<'static>, State)> {
    let velocity = (
        direction(),
        prop_oneof![1 => Just(0.0), 4 => magnitude(-6.0, 1.3)],
    );
    let spin = (
        direction(),
        prop_oneof![1 => Just(0.0), 4 => magnitude(-6.0, 3.0)],
    );
    let space = prop_oneof![1 => Just(0.0), 2 => magnitude(-14.0, 0.0), 3 => 0.0..40.0_f64];
    (
        elongation(),
        coefficients().prop_flat_map(every_law),
        direction(),
        velocity,
        spin,
        space,
        any::<bool>(),
    )
        .prop_map(
            |(elongation, law, axis, (v, speed), (w, rate), space, axial)| {
                let body = dumbbell(elongation);
                let height = 1.0 + body.half_separation * axis.z.abs() + space;
                let w = if axial { axis } else { w };
                let state = State::with_spin(&body, height, v * speed, axis, w * rate);
                (body, law, state)
            },
        )
}

/// A contact that is about to be hit: sphere, and the state with its point of contact approaching the plane.
pub fn approach() -> impl Strategy<Value = (Body, Law<'static>, State, Sphere)> {
    (motion(), any::<bool>()).prop_filter_map("not approaching", |((body, law, state), one)| {
        let sphere = if one { Sphere::One } else { Sphere::Two };
        let side = sphere.sign() * body.half_separation;
        let state = at_height(&state, 1.0 - side * state.axis.z);
        let approaching = contact_velocity(&state, &body, sphere).z < 0.0;
        approaching.then_some((body, law, state, sphere))
    })
}
