//! Normal coefficients that depend on the speed, beside an integration of the contact, the laws far from the onset, and straight lines.

use restitution_core::{Normal, Plastic, Tabulated, Viscoelastic};
use std::f64::consts::PI;

/// ε_n of m d²ξ/dt² = −ρ(ξ^{3/2} + (3/2) A ξ^{1/2} dξ/dt), until the force would attract, by Runge and Kutta's rule of fourth order. In
/// units of the speed of approach v and of the time (ρ/m)^{−2/5} v^{−1/5} only βv^{1/5} is left, β = (3/2) A (ρ/m)^{2/5}.
fn integrated(dissipation: f64) -> f64 {
    let force = |x: f64, v: f64| x.max(0.0).sqrt() * (x + dissipation * v);
    let step = 1e-3; // a contact lasts about 3
    let (mut x, mut v) = (0.0, 1.0);
    loop {
        let (a, b) = (v, -force(x, v));
        let (c, d) = (
            v + 0.5 * step * b,
            -force(x + 0.5 * step * a, v + 0.5 * step * b),
        );
        let (e, f) = (
            v + 0.5 * step * d,
            -force(x + 0.5 * step * c, v + 0.5 * step * d),
        );
        let (g, h) = (v + step * f, -force(x + step * e, v + step * f));
        x += step / 6.0 * (a + 2.0 * (c + e) + g);
        v += step / 6.0 * (b + 2.0 * (d + f) + h);
        if v < 0.0 && x + dissipation * v <= 0.0 {
            return -v;
        }
    }
}

/// The approximant is within 10⁻³ of the equation of motion, at speeds and for materials in SI units.
#[test]
fn a_viscoelastic_contact_is_integrated() {
    let (young, poisson, density, radius) = (6e7_f64, 0.3_f64, 1200.0, 4e-3_f64);
    let rho = 4.0 / 3.0 * radius.sqrt() * young / (1.0 - poisson * poisson);
    let mass = 4.0 / 3.0 * PI * radius.powi(3) * density;
    for dissipation in [1e-5, 1e-4, 1e-3] {
        let sphere = Viscoelastic::new(young, poisson, dissipation, density, radius).unwrap();
        let beta = 1.5 * dissipation * (rho / mass).powf(0.4);
        assert!((sphere.beta() / beta - 1.0).abs() < 1e-13);
        for speed in [1e-3_f64, 0.1, 3.0] {
            let expected = integrated(beta * speed.powf(0.2));
            let found = Normal::from(sphere).at(speed);
            assert!(
                (found - expected).abs() < 1e-3,
                "{found}, {expected} at {speed} m/s"
            );
        }
    }
}

/// Elastic up to the yield speed, without a step there, and falling with v^{−1/4} far beyond it, where C. Thornton's formula becomes
/// 1.442 (v_y/2.191v)^{1/4}.
#[test]
fn a_plastic_contact_yields() {
    let yields = 0.2;
    let material = Normal::from(Plastic::new(yields).unwrap());
    for speed in [0.0, 0.1, 0.2] {
        assert_eq!(material.at(speed), 1.0);
    }
    let beyond = |x: f64| material.at(x * yields);
    // d ln ε/d ln x = −(x²/6)/(1 − x²/6) + ¼(1 − x(1 − 2x/5r)/(x + 2r)) with x = v_y/v and r² = 6/5 − x²/5 is 0 at x = 1.
    assert!((0.0..1e-7).contains(&(1.0 - beyond(1.0 + 1e-4))));
    let far = (6.0 * 3.0_f64.sqrt() / 5.0).sqrt() * (0.5 / 1.2_f64.sqrt()).powf(0.25);
    for x in [1e6_f64, 1e9] {
        assert!((beyond(x) * x.powf(0.25) / far - 1.0).abs() < 1e-6);
    }
    let values: Vec<f64> = (0..200).map(|i| beyond(1.1_f64.powi(i))).collect();
    assert!(values.windows(2).all(|pair| pair[0] > pair[1]));
}

/// On the points, half way between them, a tenth of the way, and constant outside.
#[test]
fn a_table_is_interpolated() {
    let (speeds, values) = ([0.1, 0.5, 2.0], [0.9, 0.8, 0.2]);
    let table = Normal::from(Tabulated::new(&speeds, &values).unwrap());
    for (speed, value) in [
        (0.0, 0.9),
        (0.1, 0.9),
        (0.14, 0.89),
        (0.3, 0.85),
        (0.5, 0.8),
        (1.25, 0.5),
        (2.0, 0.2),
        (30.0, 0.2),
    ] {
        assert!((table.at(speed) - value).abs() < 1e-15, "{speed}");
    }
}
