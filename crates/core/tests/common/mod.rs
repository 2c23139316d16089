//! What the tests share: runs, and random parameters.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use restitution_core::{
    Body, ChatterjeeRuina, Coulomb, Dumbbell, Frictionless, Hypothesis, Law, Level, Monitor,
    Normal, Plastic, Resources, Rule, Run, Shape, Tabulated, TangentialRestitution, Values, Vector,
    Viscoelastic,
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
    Dumbbell::new(1.0, elongation, 1.0).unwrap().solid().scaled
}

pub fn law(normal: f64, tangential: f64) -> Law<'static> {
    Law::new(normal, TangentialRestitution::new(tangential).unwrap()).unwrap()
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
        seed: 2014,
        ..Run::default()
    }
}

/// Values of a variable, of their type in the tests.
trait Of: Sized {
    fn of(values: Values) -> Vec<Self>;
}

macro_rules! of {
    ($($kind:ty: $of:ident),*) => {$(
        impl Of for $kind {
            fn of(values: Values) -> Vec<Self> {
                let Values::$of(values) = values else { panic!("{values:?}") };
                values
            }
        }
    )*};
}

of! { f64: Numbers, i8: Flags, i32: Parts, i64: Counts }

impl<const N: usize> Of for [f64; N] {
    fn of(values: Values) -> Vec<Self> {
        f64::of(values).as_chunks().0.to_vec()
    }
}

macro_rules! records {
    ($($name:ident: $kind:ty),* $(,)?) => {
        /// The records of a run by name; a variable that was not recorded is empty.
        #[derive(Debug, Clone, Default)]
        pub struct Records {
            pub reached: usize,
            pub particle: Vec<i64>,
            $(pub $name: Vec<$kind>,)*
        }

        impl From<restitution_core::Records> for Records {
            fn from(mut given: restitution_core::Records) -> Self {
                let mut found = Self {
                    reached: given.reached,
                    particle: given.particle.clone(),
                    ..Self::default()
                };
                for (about, values) in given.per_impact().into_iter().chain(given.per_particle()) {
                    match about.key {
                        $(stringify!($name) => found.$name = Of::of(values),)*
                        _ => {}
                    }
                }
                found
            }
        }
    };
}

records! {
    time: f64,
    impact_velocity: f64,
    rebound_velocity: f64,
    restitution: f64,
    rotational_fraction: f64,
    energy_ratio: f64,
    angle: f64,
    contact: i8,
    part: i32,
    height: f64,
    axis: [f64; 3],
    attitude: [f64; 4],
    velocity_before: [f64; 3],
    velocity_after: [f64; 3],
    impacts: i64,
    stop_reason: i8,
    release_angle: f64,
    release_height: f64,
    release_azimuth: f64,
    release_spin: [f64; 3],
}

impl Records {
    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.impacts.len()
    }
}

pub fn simulate(run: &Run<'_>) -> Records {
    simulate_on(run, 0, &Monitor::default())
}

pub fn simulate_on(run: &Run<'_>, threads: usize, monitor: &Monitor) -> Records {
    let level = Level::best();
    let records = run.simulate(Resources { threads, level }, monitor);
    records.unwrap().into()
}

pub fn error_of(run: &Run<'_>) -> restitution_core::Error {
    let resources = Resources {
        threads: 1,
        level: Level::Scalar,
    };
    run.simulate(resources, &Monitor::default()).unwrap_err()
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

/// ε_n and ε_t, with the ends of their ranges.
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
        move |(normal, friction, hypothesis, kind)| {
            let rule: Rule = match kind {
                0 | 1 => TangentialRestitution::new(tangential).unwrap().into(),
                2 => Frictionless.into(),
                3 => ChatterjeeRuina::new(tangential, friction).unwrap().into(),
                _ => Coulomb::new(friction, hypothesis).unwrap().into(),
            };
            Law::new(normal, rule).unwrap()
        },
    )
}

/// Every number of the records as bits, impact by impact and release by release; all that are none are one.
pub fn all_bits(records: &Records) -> impl PartialEq + use<> {
    let word = |x: f64| if x.is_nan() { u64::MAX } else { x.to_bits() };
    let words = |column: &[f64]| column.iter().map(|&x| word(x)).collect::<Vec<_>>();
    (
        columns(records).map(|(_, column)| words(column)),
        [&records.contact, &records.stop_reason].map(Clone::clone),
        records.impacts.clone(),
        [&records.release_angle, &records.release_azimuth].map(|column| words(column)),
        words(records.release_spin.as_flattened()),
    )
}
