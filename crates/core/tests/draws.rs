//! What particles are released with, beside the distributions that are promised: 20 000 draws of each.

use crate::common::*;
use restitution_core::{About, Height, Orientation, Run, Spin, Vector};
use std::f64::consts::{PI, TAU};

const DRAWS: u64 = 20_000;
const SEED: u64 = 2014;

/// Kolmogorov and Smirnov: the largest distance of the distribution of numbers from the uniform one in [0, 1] exceeds 2.7/√n with
/// probability 2 exp(−2·2.7²) = 10⁻⁶.
fn assert_uniform(numbers: impl Iterator<Item = f64>) {
    let mut all: Vec<f64> = numbers.collect();
    all.sort_by(f64::total_cmp);
    let n = all.len() as f64;
    assert!(all.iter().all(|x| (0.0..=1.0).contains(x)));
    let distances = all.iter().enumerate().map(|(i, x)| {
        let (below, up_to) = (i as f64 / n, (i + 1) as f64 / n);
        (x - below).abs().max((x - up_to).abs())
    });
    let largest = distances.fold(0.0, f64::max);
    assert!(largest < 2.7 / n.sqrt(), "{largest}");
}

/// Each uniform in [0, 1], and independent: then so is their sum modulo 1, and that of one and twice the other.
fn assert_independent(numbers: &[(f64, f64)]) {
    assert_uniform(numbers.iter().map(|x| x.0));
    assert_uniform(numbers.iter().map(|x| x.1));
    assert_uniform(numbers.iter().map(|x| (x.0 + x.1) % 1.0));
    assert_uniform(numbers.iter().map(|x| (2.0 * x.0 + x.1) % 1.0));
}

/// An angle in units of a turn, in [0, 1].
fn turns(y: f64, x: f64) -> f64 {
    y.atan2(x) / TAU + 0.5
}

/// Of two independent Gaussian numbers of variance 1, (a² + b²)/2 is exponential and the direction uniform, and vice versa.
fn assert_gaussian(pairs: impl Iterator<Item = (f64, f64)>) {
    let numbers: Vec<_> = pairs
        .map(|(a, b)| ((-0.5 * (a * a + b * b)).exp(), turns(b, a)))
        .collect();
    assert_independent(&numbers);
}

#[test]
fn heights_have_a_raised_cosine() {
    let (lowest, highest) = (0.02, 0.05);
    let height = Height::Random { lowest, highest };
    assert_uniform((0..DRAWS).map(|i| {
        let s = (height.draw(SEED, i) - lowest) / (highest - lowest);
        s - (TAU * s).sin() / TAU // the integral of 1 − cos 2πs
    }));
    assert_eq!(Height::Fixed(0.3).draw(SEED, 7), 0.3);
    assert_eq!(height.lowest(), lowest);
    assert!((height.middle() - 0.035).abs() < 1e-17);
}

/// A sphere let go at rest reaches the plane with √(2g(h − R)), h in m as it was drawn.
#[test]
fn a_sphere_falls_from_the_height_that_is_drawn() {
    let (lowest, highest) = (0.02, 0.05);
    let run = Run {
        release_height: Height::Random { lowest, highest },
        ..paper(0.0, law(0.9, 1.0))
    };
    let records = simulate(&run);
    for i in 0..run.particles {
        let height = run.release_height.draw(run.seed, i as u64);
        assert_eq!(records.release_height[i], height);
        let drop = height - run.body.unit();
        let speed = (2.0 * run.gravity * drop).sqrt();
        assert!((records.impact_velocity[i * run.impacts] / speed - 1.0).abs() < 1e-14);
    }
}

#[test]
fn axes_have_their_distribution() {
    let azimuth = |o: &Orientation<'_>, i| o.azimuth(SEED, i) / TAU;
    let both = |o: Orientation<'_>, first: fn(f64, f64) -> f64| {
        let draws = (0..DRAWS).map(|i| {
            let (sine, cosine) = o.draw(SEED, i);
            assert!((sine * sine + cosine * cosine - 1.0).abs() < 1e-15 && sine >= 0.0);
            (first(sine, cosine), azimuth(&o, i))
        });
        assert_independent(&draws.collect::<Vec<_>>());
    };
    both(Orientation::UniformAngle, |sine, cosine| {
        sine.atan2(cosine) / PI
    });
    both(Orientation::Isotropic, |_, cosine| 0.5 * (1.0 + cosine));
    let angles = [0.3, 1.1];
    assert_eq!(Orientation::Given(&angles).draw(SEED, 1).1, 1.1_f64.cos());
    let given = Orientation::Given(&angles);
    assert_ne!(given.azimuth(SEED, 0), given.azimuth(SEED, 1));
    let rows = [[0.3, 2.0], [1.1, 4.0]];
    let directions = Orientation::Directions(&rows);
    assert_eq!(directions.draw(SEED, 1).1, 1.1_f64.cos());
    assert_eq!(directions.azimuth(SEED, 1), 4.0);
}

/// The axis of particle i, as sines and cosines of its two angles, and itself with two directions across it.
type Angles = ((f64, f64), (f64, f64));

fn axis(i: u64) -> (Angles, [Vector; 3]) {
    let (polar, azimuth) = (0.1 + 1.3 * i as f64, 2.0 * i as f64);
    let (sine, cosine) = polar.sin_cos();
    let (y, x) = azimuth.sin_cos();
    let along = Vector::new(sine * x, sine * y, cosine);
    let level = Vector::new(-y, x, 0.0);
    (((sine, cosine), (y, x)), [along, level, along.cross(level)])
}

/// |ω| is uniform whatever the direction, and the direction is that which is asked for.
#[test]
fn random_spins_have_their_distribution() {
    let (low, high) = (3.0, 10.0);
    let draw = |about, i| {
        let (angles, frame) = axis(i);
        let spin = Spin::Random { low, high, about }.draw(SEED, i, angles, 1.7);
        let rate = spin.norm();
        ((rate - low) / (high - low), spin / rate, frame)
    };
    let isotropic = (0..DRAWS).map(|i| draw(About::Isotropic, i));
    let around = isotropic.clone().map(|(r, d, _)| (r, turns(d.y, d.x)));
    assert_independent(&around.collect::<Vec<_>>());
    let upward = isotropic.map(|(_, d, _)| (0.5 * (1.0 + d.z), turns(d.y, d.x)));
    assert_independent(&upward.collect::<Vec<_>>());
    let horizontal = (0..DRAWS).map(|i| {
        let (r, d, _) = draw(About::Horizontal, i);
        assert_eq!(d.z, 0.0);
        (r, turns(d.y, d.x))
    });
    assert_independent(&horizontal.collect::<Vec<_>>());
    let across = (0..DRAWS).map(|i| {
        let (r, d, [along, level, third]) = draw(About::Across, i);
        assert!(d.dot(along).abs() < 1e-14);
        (r, turns(d.dot(level), d.dot(third)))
    });
    assert_independent(&across.collect::<Vec<_>>());
}

/// Maxwell: Gaussian components along and across the axis, J_xx⟨ω_x²⟩ = J_zz⟨ω_z²⟩, ⟨ω²⟩ = rate².
#[test]
fn thermal_spins_have_equal_energy_in_each_direction() {
    let (rate, ratio) = (30.0_f64, 2.5_f64);
    let across = (rate * rate / (2.0 + ratio)).sqrt();
    let along = across * ratio.sqrt();
    let components: Vec<_> = (0..DRAWS)
        .map(|i| {
            let (angles, [one, two, three]) = axis(i);
            let spin = Spin::Thermal { rate }.draw(SEED, i, angles, ratio);
            [
                spin.dot(one) / along,
                spin.dot(two) / across,
                spin.dot(three) / across,
            ]
        })
        .collect();
    assert_gaussian(components.iter().map(|c| (c[0], c[1])));
    assert_gaussian(components.iter().map(|c| (c[1], c[2])));
    assert_gaussian(components.iter().map(|c| (c[2], c[0])));
}

/// The same of a run, by what its records say of axis and spin: m⟨ω²⟩ is shared out by the body's own moments of inertia.
#[test]
fn the_thermal_spin_of_a_run_knows_the_moments_of_inertia() {
    let rate = 30.0_f64;
    let angles = vec![[1.2, 0.7]; 5000];
    let run = Run {
        particles: angles.len(),
        impacts: 1,
        orientation: Orientation::Directions(&angles),
        spin: Spin::Thermal { rate },
        ..paper(2.0, law(0.9, 1.0))
    };
    let records = simulate(&run);
    let along = Vector::new(
        1.2_f64.sin() * 0.7_f64.cos(),
        1.2_f64.sin() * 0.7_f64.sin(),
        1.2_f64.cos(),
    );
    let level = Vector::new(-0.7_f64.sin(), 0.7_f64.cos(), 0.0);
    let third = along.cross(level);
    // J_xx⟨ω_x²⟩ = J_zz⟨ω_z²⟩ and 2⟨ω_x²⟩ + ⟨ω_z²⟩ = rate².
    let solid = run.body.revolution().unwrap();
    let (jxx, jzz) = (solid.transverse_inertia, solid.axial_inertia);
    let across = rate * (jzz / (2.0 * jzz + jxx)).sqrt();
    let lengthwise = across * (jxx / jzz).sqrt();
    let components: Vec<_> = records
        .release_spin
        .iter()
        .map(|&[x, y, z]| {
            let spin = Vector::new(x, y, z);
            [
                spin.dot(along) / lengthwise,
                spin.dot(level) / across,
                spin.dot(third) / across,
            ]
        })
        .collect();
    assert_gaussian(components.iter().map(|c| (c[0], c[1])));
    assert_gaussian(components.iter().map(|c| (c[1], c[2])));
}

#[test]
fn given_spins_are_those() {
    let (angles, _) = axis(1);
    let spins = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    let second = Vector::new(4.0, 5.0, 6.0);
    assert_eq!(Spin::Given(&spins).draw(SEED, 1, angles, 1.0), second);
    assert_eq!(Spin::Fixed(second).draw(SEED, 1, angles, 1.0), second);
    assert!(!Spin::Given(&spins).is_none() && !Spin::Fixed(second).is_none());
    assert!(Spin::NONE.is_none() && Spin::Given(&[[0.0; 3]; 2]).is_none());
    let about = About::Across;
    for (low, high, none) in [(0.0, 0.0, true), (0.0, 1.0, false)] {
        assert_eq!(Spin::Random { low, high, about }.is_none(), none);
    }
    assert!(Spin::Thermal { rate: 0.0 }.is_none() && !Spin::Thermal { rate: 1.0 }.is_none());
}
