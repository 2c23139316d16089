//! The derivatives and bounds of each hull's support function h, compared with differences in e_z and in time.

use super::{
    AxisMotion, Ball, Ellipsoid, EqualBalls, Hull, OneBall, Sphere, Surface, TwoBalls, named,
};
use crate::simd::one;
use pulp::Scalar;

/// Every kind of hull: pairs with the larger sphere on either side, and spheroids that are long, flat and round.
fn surfaces() -> [Surface; 8] {
    let ball = |offset, radius| Ball { offset, radius };
    [
        Surface::EqualBalls(EqualBalls::new(0.7)),
        Surface::TwoBalls(TwoBalls::new([ball(0.3, 1.0), ball(-0.6, 0.5)], 0.9)),
        Surface::TwoBalls(TwoBalls::new([ball(1.1, 0.4), ball(-0.2, 1.0)], 1.3)),
        Surface::OneBall(OneBall::new(ball(-0.4, 1.0), true)),
        Surface::OneBall(OneBall::new(ball(0.6, 1.0), false)),
        Surface::Ellipsoid(Ellipsoid::new(0.6, 1.0)),
        Surface::Ellipsoid(Ellipsoid::new(1.0, 0.7)),
        Surface::Ellipsoid(Ellipsoid::new(1.0, 1.0)),
    ]
}

/// e_z = c + A cos(Ωt + φ), as in a flight.
struct Oscillation {
    middle: f64,
    amplitude: f64,
    rate: f64,
    phase: f64,
}

fn oscillations() -> [Oscillation; 3] {
    [
        [0.2, 0.6, 1.3, 0.4],
        [-0.5, 0.3, -0.8, 2.0],
        [0.0, 0.9, 2.1, -1.1],
    ]
    .map(|[middle, amplitude, rate, phase]| Oscillation {
        middle,
        amplitude,
        rate,
        phase,
    })
}

impl Oscillation {
    fn cos_tilt(&self, time: f64) -> f64 {
        self.middle + self.amplitude * self.rate.mul_add(time, self.phase).cos()
    }

    /// At time 0.
    fn axis_motion(&self) -> AxisMotion<Scalar> {
        let (sin, cos) = self.phase.sin_cos();
        AxisMotion {
            cos_tilt: one(self.cos_tilt(0.0)),
            rate: one(-self.amplitude * self.rate * sin),
            acceleration: one(-self.amplitude * self.rate * self.rate * cos),
            square: one(self.rate * self.rate),
        }
    }
}

/// The first to fourth derivative at 0, from differences over δ and 2δ: wrong by terms of order δ⁴ and δ², and by rounding over δ⁴.
fn derivatives(f: impl Fn(f64) -> f64) -> [f64; 4] {
    let step = 0.01;
    let even = |x: f64| 0.5 * (f(x) + f(-x)) - f(0.0);
    let odd = |x: f64| 0.5 * (f(x) - f(-x));
    let (a, b) = (even(step), even(2.0 * step));
    let (u, v) = (odd(step), odd(2.0 * step));
    [
        (8.0 * u - v) / (6.0 * step),
        (16.0 * a - b) / (6.0 * step * step),
        (v - 2.0 * u) / step.powi(3),
        2.0 * (b - 4.0 * a) / step.powi(4),
    ]
}

fn close(found: f64, expected: f64, digits: i32) {
    let room = 10.0_f64.powi(-digits) * (1.0 + expected.abs());
    assert!(
        (found - expected).abs() < room,
        "{found} instead of {expected}"
    );
}

/// The gap above a part is the height minus h; s = −dh/de_z; and the derivatives in time, from which a step to the contact is
/// proposed, are those of h.
#[test]
fn derivatives_are_those_of_the_support_function() {
    for (surface, axis) in surfaces()
        .iter()
        .flat_map(|s| oscillations().map(|n| (s, n)))
    {
        for sphere in Sphere::BOTH {
            let height = |cos_tilt| surface.touching_height(sphere, cos_tilt);
            let here = axis.cos_tilt(0.0);
            close(surface.gap(sphere, here, 0.3), 0.3 - height(here), 14);
            let slope = derivatives(|step| height(here + step))[0];
            close(surface.lever(sphere, here), -slope, 7);
            let [_, second, third, fourth] = derivatives(|time| height(axis.cos_tilt(time)));
            with_hull!(surface, hull => {
                let axis_motion = axis.axis_motion();
                let part = match surface {
                    Surface::Ellipsoid(_) => hull.nearer(one(0.3), one(0.0), &axis_motion, one(1.0)),
                    _ => named(hull, sphere),
                };
                let [a, b, c] = hull.derivatives(&part, &axis_motion).map(|pack| pack.as_slice()[0]);
                close(a, -second, 6);
                close(b, -third, 3);
                close(c, -fourth, 2);
                close(hull.curvature(&part, &axis_motion).as_slice()[0], -1.0 - second, 6);
                let radius = hull.radius(&part, one(here)).as_slice()[0];
                close(radius, hull.level() + height(here) - here * slope, 7);
            });
        }
    }
}

/// No part reaches above the ceiling, and some part reaches it; the curvature of h stays within its bound.
#[test]
fn bounds_hold() {
    for surface in surfaces() {
        for axis in oscillations() {
            let max_cos_tilt = axis.middle.abs() + axis.amplitude;
            let heights =
                |cos_tilt| Sphere::BOTH.map(|sphere| surface.touching_height(sphere, cos_tilt));
            let all = (-100..=100).flat_map(|i| heights(max_cos_tilt * f64::from(i) / 100.0));
            let ceiling =
                with_hull!(surface, hull => hull.ceiling(one(max_cos_tilt)).as_slice()[0]);
            close(ceiling, all.fold(f64::NEG_INFINITY, f64::max), 14);
            let bound =
                surface.curvature_bound(axis.amplitude, max_cos_tilt) * axis.rate * axis.rate;
            for (sphere, i) in Sphere::BOTH
                .iter()
                .flat_map(|s| (0..100).map(move |i| (s, i)))
            {
                let later = f64::from(i) / axis.rate / 15.0;
                let height = |time| surface.touching_height(*sphere, axis.cos_tilt(later + time));
                assert!(derivatives(height)[1].abs() <= bound + 1e-6);
            }
        }
    }
}
