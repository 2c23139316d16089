//! The free rotation of any body: beside solutions with 50 digits, in closed form where there is one, what is conserved, and the bounds.

use crate::oracle::random::Random;
use restitution_core::{Quaternion, Rotation, Top, Vector};
use std::f64::consts::PI;

fn length(v: Vector) -> f64 {
    (v.x * v.x + v.y * v.y + v.z * v.z).sqrt()
}

fn distance(a: Quaternion, b: Quaternion) -> f64 {
    let one = |s: f64| {
        let parts = [a.w - s * b.w, a.x - s * b.x, a.y - s * b.y, a.z - s * b.z];
        parts.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    one(1.0).min(one(-1.0)) // both are the same rotation
}

fn attitude(random: &mut Random) -> Quaternion {
    loop {
        let [w, x, y, z] = [0; 4].map(|_| random.between(-1.0, 1.0));
        let square = w * w + x * x + y * y + z * z;
        if square < 1.0 && square > 1e-3 {
            return Quaternion::new(w, x, y, z).normalized();
        }
    }
}

/// Bodies of every kind: any, a sphere, with two equal moments, plates, needles.
fn top(random: &mut Random, kind: usize) -> Top {
    let second = match kind % 5 {
        0 => [0; 3].map(|_| random.between(0.05, 1.0)),
        1 => [1.0; 3],
        2 => [1.0, 1.0, random.magnitude(-2.0, 1.0)],
        3 => [1.0, random.between(0.2, 1.0), random.one(&[0.0, 1e-6])],
        _ => [
            1.0,
            random.magnitude(-4.0, -2.0),
            random.magnitude(-4.0, -2.0),
        ],
    };
    let [a, b, c] = second;
    let mut moments = [b + c, c + a, a + b];
    moments.rotate_left(random.below(3));
    Top::new(moments).unwrap()
}

/// About any direction of the body, near one of its axes, or on the separatrix.
fn spin(random: &mut Random, top: &Top) -> Vector {
    let [x, y, z] = match random.below(4) {
        0 => {
            let mut direction = random.direction().map(|x| 1e-6 * x);
            direction[random.below(3)] += 1.0;
            direction
        }
        1 => {
            // 2E = Λ²/J of the middle moment.
            let moments = top.moments();
            let mut order = [0, 1, 2];
            order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
            let [least, middle, most] = order;
            let [a, b, c] = order.map(|i| moments[i]);
            let mut spin = [0.0; 3];
            spin[least] = (c * (c - b)).max(0.0).sqrt();
            spin[most] = (a * (b - a)).max(0.0).sqrt();
            spin[middle] = random.between(-1.0, 1.0);
            spin
        }
        _ => random.direction(),
    };
    Vector::new(x, y, z)
}

/// Attitudes after up to ten radians of needles, plates, spheres and others, also on the separatrix, beside rotation matrices by Taylor series
/// with 50 digits (`asymmetric/reference.py`). What is rounded grows along the separatrix as a small distance from it does, which the
/// reference gives as well.
#[test]
fn attitudes_are_those_of_the_reference() {
    let mut worst: f64 = 0.0;
    for line in include_str!("asymmetric/reference.txt").lines() {
        let x: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
        let top = Top::new([x[0], x[1], x[2]]).unwrap();
        let spin = Vector::new(x[3], x[4], x[5]);
        let found = Rotation::new(top, Quaternion::IDENTITY, spin).at(x[6]).0;
        let expected = Quaternion::new(x[7], x[8], x[9], x[10]);
        let off = distance(found, expected);
        // Some two roundings a radian.
        let allowed = 2.0 * f64::EPSILON * x[11] * (1.0 + length(spin) * x[6]);
        worst = worst.max(off / allowed);
        assert!(off <= allowed, "{line}: {found:?}, off by {off:e}");
    }
    println!("worst {worst:.2} of what rounding may do");
}

/// Over ten thousand flights of a few radians after each other, each with its rounding, some 10⁻¹⁶ to any side. Of 12,000 other tops like these 4 were
/// further off, up to 1.2·10⁻¹³, and 5 in energy, up to 2.3·10⁻¹³: most of them with ω within 10⁻⁶ of an axis, where its largest component is rounded the same
/// way in flight after flight.
#[test]
fn energy_and_angular_momentum_are_kept() {
    let mut random = Random(1);
    let mut worst = [0.0_f64; 2];
    for number in 0..100 {
        let top = top(&mut random, number);
        let mut attitude = attitude(&mut random);
        let mut spin = spin(&mut random, &top);
        let momentum = top.momentum(attitude, spin);
        let energy = top.twice_energy(spin);
        let time = random.between(0.5, 4.0) / top.largest_spin(spin).sqrt();
        for _ in 0..10_000 {
            let mut rotation = Rotation::new(top, attitude, spin);
            (attitude, spin) = rotation.at(time);
        }
        let lost = length(top.momentum(attitude, spin) - momentum) / length(momentum);
        let off = [lost, (top.twice_energy(spin) / energy - 1.0).abs()];
        worst = [worst[0].max(off[0]), worst[1].max(off[1])];
        assert!(
            off[0] <= 1e-13 && off[1] <= 1e-13,
            "{top:?} {spin:?}: {off:?}"
        );
    }
    println!("worst {worst:?}");
}

/// A body with two equal moments: ω turns about the axis of symmetry, and the axis about Λ, both at constant rates.
#[test]
fn a_symmetric_top_precesses() {
    let mut random = Random(2);
    let mut worst: f64 = 0.0;
    for _ in 0..500 {
        let (across, along) = (1.0, random.between(0.01, 2.0));
        let top = Top::new([across, across, along]).unwrap();
        let start = attitude(&mut random);
        let [x, y, z] = random.direction();
        let momentum = top.momentum(start, Vector::new(x, y, z));
        let time = random.between(0.0, 10.0);
        let found = Rotation::new(top, start, Vector::new(x, y, z)).at(time).0;
        // q(t) = exp(Λt/2J) q(0) exp(ω_z(1 − J_z/J)t k/2).
        let half = 0.5 * length(momentum) / across * time;
        let part = half.sin() / length(momentum);
        let precession = Quaternion::new(
            half.cos(),
            part * momentum.x,
            part * momentum.y,
            part * momentum.z,
        );
        let half = 0.5 * z * (1.0 - along / across) * time;
        let expected = precession * start * Quaternion::new(half.cos(), 0.0, 0.0, half.sin());
        let off = distance(found, expected) / (1.0 + time);
        worst = worst.max(off);
        assert!(off <= 4.0 * f64::EPSILON, "{off:e}");
    }
    println!("worst {worst:.1e} a radian");
}

/// Backwards it returns; asked once or often, it is the same motion.
#[test]
fn a_rotation_goes_back() {
    let mut random = Random(3);
    for number in 0..500 {
        let top = top(&mut random, number);
        let start = attitude(&mut random);
        let spin = spin(&mut random, &top);
        let time = random.between(0.0, 6.0) / top.largest_spin(spin).sqrt();
        let mut rotation = Rotation::new(top, start, spin);
        let (there, Vector { x, y, z }) = rotation.at(time);
        let mut again = Rotation::new(top, start, spin);
        for part in 1..20 {
            again.at(time * f64::from(part) / 20.0);
        }
        assert_eq!(again.at(time).0, there);
        let back = Rotation::new(top, there, Vector::new(-x, -y, -z))
            .at(time)
            .0;
        let off = distance(back, start);
        assert!(off <= 1e-12, "{top:?} {spin:?} {time} {off:e}"); // on the separatrix e⁶ times rounding
    }
}

#[test]
fn a_body_at_rest_stays() {
    let top = Top::new([1.0, 2.0, 2.5]).unwrap();
    let start = Quaternion::new(0.5, 0.5, 0.5, 0.5);
    let mut rotation = Rotation::new(top, start, Vector::new(0.0, 0.0, 0.0));
    let (attitude, spin) = rotation.at(1e9);
    assert_eq!(attitude, start);
    assert_eq!(length(spin), 0.0);
}

/// |ω| never exceeds its bound and comes close to it, and the acceleration of points by second differences never exceeds theirs, nor its part
/// that is not along the normal the smaller one.
#[test]
fn spins_and_accelerations_stay_within_their_bounds() {
    let mut random = Random(4);
    let (mut closest, mut hardest, mut aside): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for number in 0..400 {
        let top = top(&mut random, number);
        let start = attitude(&mut random);
        let spin = spin(&mut random, &top);
        let turn = top.bounds(spin);
        let (largest, bound) = (turn.fastest, turn.whole);
        let mut rotation = Rotation::new(top, start, spin);
        let [x, y, z] = random.direction();
        let step = 1e-3 / largest;
        let mut heights = [0.0; 3];
        let mut turned = [0.0; 2];
        for i in 0..4000 {
            let (attitude, spin) = rotation.at(f64::from(i) * step);
            let size = length(spin) / largest;
            closest = closest.max(size);
            assert!(size <= 1.0 + 1e-12, "{top:?} {spin:?} {size}");
            heights.rotate_left(1);
            heights[2] = attitude.rotate(Vector::new(x, y, z)).z;
            // |n′|²
            turned.rotate_left(1);
            turned[1] = length(spin).powi(2) - attitude.rotate(spin).z.powi(2);
            if i >= 2 {
                let second = (heights[2] - 2.0 * heights[1] + heights[0]) / (step * step);
                hardest = hardest.max(second.abs() / bound);
                assert!(
                    second.abs() <= bound * (1.0 + 1e-8),
                    "{top:?} {spin:?} {second} {bound}"
                );
                let across = (second + turned[0] * heights[1]).abs();
                aside = aside.max(across / turn.across);
                assert!(
                    across <= turn.across * (1.0 + 1e-6),
                    "{top:?} {spin:?} {across} {turn:?}"
                );
            }
        }
    }
    println!("|ω| up to {closest} of its bound, accelerations up to {hardest} and {aside}");
    assert!(closest > 1.0 - 1e-6 && hardest > 0.9 && aside > 0.9);
}

#[test]
fn impossible_moments_are_refused() {
    for moments in [
        [1.0, 1.0, 2.1],
        [3.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
        [f64::NAN, 1.0, 1.0],
        [f64::INFINITY, f64::INFINITY, 1.0],
    ] {
        let error = Top::new(moments).unwrap_err().to_string();
        assert!(
            error.contains("inertia") && error.contains("sum"),
            "{error}"
        );
    }
    assert!(Top::new([0.3, 0.7, 1.0]).is_ok());
}

/// Rotations follow each other as matrices do, and back.
#[test]
fn quaternions_rotate() {
    let quarter = Quaternion::new((PI / 4.0).cos(), 0.0, 0.0, (PI / 4.0).sin());
    let turned = quarter.rotate(Vector::new(1.0, 0.0, 0.5));
    assert!(length(turned - Vector::new(0.0, 1.0, 0.5)) < 1e-15);
    let mut random = Random(5);
    for _ in 0..1000 {
        let (a, b) = (attitude(&mut random), attitude(&mut random));
        let [x, y, z] = random.direction();
        let v = Vector::new(x, y, z);
        assert!(length((a * b).rotate(v) - a.rotate(b.rotate(v))) < 2e-15);
        assert!(length(a.inverse().rotate(a.rotate(v)) - v) < 2e-15);
        assert!((length(a.rotate(v)) - 1.0).abs() < 2e-15);
    }
}
