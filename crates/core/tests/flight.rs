//! The free flight against what mechanics conserves, and against an integrator that knows only Euler's equations.

use crate::common::*;
use crate::scalar::*;
use proptest::prelude::*;
use restitution_core::{Body, FlightEnd, FlightStart, State, Vector};

proptest! {
    #![proptest_config(cases(2000))]

    /// No torque and no horizontal force: **Λ** and the horizontal velocity keep their bits; the spin about the axis, the
    /// rotational energy and the whole energy keep their values; the axis keeps its length.
    #[test]
    fn what_a_flight_conserves((body, law, release) in motion()) {
        for leg in legs(&body, &law, release, 6) {
            let (start, end) = (&leg.start, &leg.impact.before);
            prop_assert_eq!(start.precession, end.precession);
            prop_assert_eq!((start.velocity.x, start.velocity.y), (end.velocity.x, end.velocity.y));
            prop_assert!((end.axis.norm() - 1.0).abs() <= 2.0 * f64::EPSILON);

            // e·Λ is what decides both; the spin about the axis follows with the factor J_xx/J_zz.
            let slender = body.transverse / body.axial;
            let rate = start.precession.norm();
            let spun = start.spin(&body).dot(start.axis) - end.spin(&body).dot(end.axis);
            prop_assert!(spun.abs() <= 16.0 * f64::EPSILON * slender * rate);
            let (e, f) = (start.rotational_energy(&body), end.rotational_energy(&body));
            prop_assert!((e - f).abs() <= 16.0 * f64::EPSILON * slender * body.transverse * rate * rate);

            // Height and velocity at the landing are as exact as the time: Δ(v²/2 + z) = v′ Δt.
            let (e, f) = (energy(start, &body), energy(end, &body));
            let scale = 1.0 + e + f + body.half_separation * rate * leg.time * end.velocity.z.abs().max(1.0);
            prop_assert!((e - f).abs() <= 32.0 * f64::EPSILON * slender * scale, "{:e} of {scale:e}", e - f);
        }
    }
}

proptest! {
    #![proptest_config(cases(2000))]

    /// Energy of the rotation, from the spin about the axis and across it, the whole kinetic energy, and the angle of the axis with
    /// the normal by the platform's function. The spin about the axis is a sum that may cancel, but for rounding.
    #[test]
    fn what_a_state_says_of_itself((body, _, state) in motion()) {
        let spin = state.spin(&body);
        let about = spin.dot(state.axis);
        let across = spin - state.axis * about;
        let rotation = 0.5 * (body.axial * about * about + body.transverse * across.dot(across));
        let slender = body.transverse / body.axial;
        let rounding = 16.0 * f64::EPSILON * slender * body.transverse * spin.dot(spin);
        prop_assert!((state.rotational_energy(&body) - rotation).abs() <= rounding);
        let kinetic = 0.5 * state.velocity.dot(state.velocity) + rotation;
        prop_assert!((state.kinetic_energy(&body) - kinetic).abs() <= rounding + 8.0 * f64::EPSILON * kinetic);

        let angle = state.axis.horizontal().atan2(state.axis.z);
        prop_assert!((state.angle() - angle).abs() <= 4.0 * f64::EPSILON);
    }
}

proptest! {
    #![proptest_config(cases(2000))]

    /// A state has the angular velocity that it was given, about the axis as well as across it, and with it **Λ** = Ĵ**ω**.
    #[test]
    fn a_state_has_the_spin_that_it_was_given((body, _, _) in motion(), axis in direction(), w in direction(), rate in 0.01..30.0_f64) {
        let spin = w * rate;
        let state = State::with_spin(&body, 20.0, Vector::default(), axis, spin);
        let slender = body.transverse / body.axial;
        prop_assert!((state.spin(&body) - spin).norm() <= 8.0 * f64::EPSILON * slender * rate);
        let about = spin.dot(axis);
        let momentum = (spin - axis * about) * body.transverse + axis * (body.axial * about);
        let off = (state.precession * body.transverse - momentum).norm();
        prop_assert!(off <= 8.0 * f64::EPSILON * rate * (body.transverse + body.axial), "{off:e}");
    }
}

/// The axis and the angular velocity in the laboratory frame.
#[derive(Clone, Copy)]
struct Top {
    axis: Vector,
    spin: Vector,
}

/// ė = ω × e and Euler's equation Jω̇ = −ω × Jω, where Jω = J_xx ω + (J_zz − J_xx)(ω·e)e. The torque-free ω × Jω is
/// perpendicular to the axis, so that J⁻¹ is 1/J_xx there.
fn derivative(body: &Body, top: Top) -> Top {
    let Top { axis, spin } = top;
    let momentum =
        spin * body.transverse + axis * ((body.axial - body.transverse) * spin.dot(axis));
    Top {
        axis: spin.cross(axis),
        spin: spin.cross(momentum) / -body.transverse,
    }
}

/// Classical Runge–Kutta. With steps of Ωh ≤ 1/200 the error is below ΩT (Ωh)⁴/120, which is 5e-12 for each radian turned.
fn integrate(body: &Body, start: &State, time: f64) -> Top {
    let shift = |a: Top, b: Top, h: f64| Top {
        axis: b.axis.mul_add(h, a.axis),
        spin: b.spin.mul_add(h, a.spin),
    };
    let spin = start.spin(body);
    let mut top = Top {
        axis: start.axis,
        spin,
    };
    let steps = (200.0 * spin.norm().max(start.precession.norm()) * time)
        .ceil()
        .max(1.0);
    let h = time / steps;
    for _ in 0..steps as usize {
        let a = derivative(body, top);
        let b = derivative(body, shift(top, a, 0.5 * h));
        let c = derivative(body, shift(top, b, 0.5 * h));
        let d = derivative(body, shift(top, c, h));
        for (slope, weight) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
            top = shift(top, slope, weight * h / 6.0);
        }
    }
    top
}

proptest! {
    #![proptest_config(cases(300))]

    /// The axis turns about **Λ**, not about **ω** as (3) is printed: wherever the body lands, Euler's equations bring the axis
    /// and the spin to the same place.
    #[test]
    fn the_axis_moves_as_eulers_equations_say(
        elongation in 0.0..4.0_f64, axis in direction(), w in direction(), rate in 0.01..30.0_f64, drop in 0.0..10.0_f64,
    ) {
        let body = dumbbell(elongation);
        let height = 1.0 + body.half_separation + drop;
        let start = State::with_spin(&body, height, Vector::default(), axis, w * rate);
        let FlightEnd::Impact { time, state, .. } = landing(start, &body, FlightStart::Free) else {
            panic!("a body must fall");
        };
        let top = integrate(&body, &start, time);
        // In the integrator both the axis and, for a slender body, the fast spin of ω itself turn.
        let turned = time * start.spin(&body).norm().max(start.precession.norm());
        let allowed = 1e-11 * (1.0 + turned);
        prop_assert!((top.axis - state.axis).norm() <= allowed, "{:e}", (top.axis - state.axis).norm());
        let spun = (top.spin - state.spin(&body)).norm();
        prop_assert!(spun <= allowed * (body.transverse / body.axial) * rate, "{spun:e}");
    }
}
