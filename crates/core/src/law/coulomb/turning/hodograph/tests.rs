use super::super::Hypothesis;
use super::super::testing::{Case, State, value};
use super::*;
use crate::simd::one;

const FRICTION: f64 = 0.1;

/// A slip of this size and with this y, where K_uu, K_ww and K_nu/μ are `a`, `b` and `nu`.
fn case(a: f64, b: f64, nu: f64, y: f64) -> Case {
    Case {
        friction: FRICTION,
        nn: 1.0,
        nu: nu * FRICTION,
        uu: a,
        ww: b,
        direction: 2.0 * y.sqrt().atan(),
    }
}

/// The longest panel, times μ.
fn resolved(a: f64, b: f64, nu: f64, slip: f64, y: f64) -> f64 {
    let impacts = case(a, b, nu, y).impacts(slip, 1.0 - slip, Hypothesis::Newton);
    let path = Hodograph::new(&impacts.rates, impacts.course.y);
    FRICTION * value(path.longest(&impacts.rates, &impacts.course))
}

fn near(x: f64, y: f64) {
    assert!((x - y).abs() < 1e-9 * y, "{x} {y}");
}

/// Where one of the functions alone limits it, it changes on the longest panel by as much as the rule says.
#[test]
fn a_panel_is_as_long_as_its_functions_are_resolved() {
    // d ln A/dθ = −λ where y = 0.
    near(resolved(1.0, 2.0, 0.3, 0.5, 0.0) * 0.7, 14.0);
    near(resolved(1.0, 2.0, 1.7, 0.5, 0.0) * 0.7, 14.0);
    near(resolved(1.0, 2.0, 0.3, 1e-7, 0.0) * 0.7, 28.0);
    // d ln y/dθ = −2ρ₊ where ρ₋ = 0: with b = 2a and K_nu = a λ = 0, too, and κ = 2a.
    near(resolved(1.0, 2.0, 1.0, 0.5, 1e-8) * 4.0, 30.0);
    near(resolved(1.0, 2.0, 1.0, 0.5, 1e-3) * 4.0, 14.0);
    near(resolved(1.0, 2.0, 1.0, 0.5, 0.1) * 4.0, 8.0);
    // d ln w/dθ = −μK_ww(1 + y) where ρ₊ = κ = 0, at a slip so small that A may change more.
    near(resolved(1.5, 1.0, 0.5, 1e-7, 1e-5) * 2.0, 32.0);
    // κy beside λ, six times, where the direction all but stays.
    let (d, y) = (0.01, 0.1);
    near(
        resolved(1.0, 1.0 - d, -d, 0.5, y) * (1.0 + d + 6.0 * y * (1.0 - d)),
        14.0,
    );
}

/// Poles on the path behind the start and ahead of it, and beside it, from both fixed points: their distances from the ends of what
/// counts as resolved are 1.6 times its length, but for the bound of the logarithm, at most a third less for |ln E| < 7.
#[test]
fn a_panel_keeps_away_from_the_poles() {
    let mut met = [0; 4];
    for (a, b, nu) in [
        (1.0, 1.3, 0.1),
        (1.0, 1.3, 0.5),
        (1.3, 1.0, 0.1),
        (1.3, 1.0, 0.5),
        (1.0, 1.3, -0.1),
        (1.0, 1.3, -0.5),
        (1.3, 1.0, -0.1),
        (1.3, 1.0, -0.5),
    ] {
        for y in [0.01, 0.2, 0.45, 0.55, 0.9, 3.0] {
            let case = case(a, b, nu, y);
            let impacts = case.impacts(0.5, 0.5, Hypothesis::Newton);
            let path = Hodograph::new(&impacts.rates, impacts.course.y);
            let length = value(path.resolved());
            let (plus, minus) = (value(impacts.rates.plus), value(impacts.rates.minus));
            let ratio: f64 = 1.0 + plus / (minus * y);
            if ratio.abs() < 1e-9 {
                continue; // y = y*
            }
            let real = -ratio.abs().ln() / (2.0 * plus);
            let beside = if ratio < 0.0 { PI / (2.0 * plus) } else { 0.0 };
            let sum = (real - length).hypot(beside) + real.hypot(beside);
            let share = sum / (1.6 * length);
            assert!((0.999..1.5).contains(&share), "{share} {ratio} {case:?}");
            met[usize::from(ratio < 0.0) + 2 * usize::from(real > 0.0)] += 1;
        }
    }
    assert!(met.iter().all(|&times| times > 0), "{met:?}");
}

/// 2σθ is at least 8 tanh(x/8) where x = −ln(1 − t) is what it should be: undone, 1 − e^{−x} is t.
#[test]
fn a_way_is_bounded_by_a_hyperbolic_tangent() {
    for sigma in [0.3, -0.3, 7.0, -7.0] {
        for distance in [0.2, -0.2, 3.0, -3.0] {
            for t in [1e-6, 0.3, 0.9, 0.99999, -1e-6, -0.5, -20.0, -1e5] {
                if t * sigma < 0.0 {
                    continue; // ζ has the sign of D
                }
                let zeta = t * distance / sigma;
                let theta = value(reach(one(sigma), one(distance), one(zeta)));
                let way = 8.0 * (0.25 * sigma * theta).atanh();
                assert!(
                    (-(-way).exp_m1() - t).abs() < 1e-13 * t.abs().max(1.0) * way.abs().max(1.0),
                    "{t} {way}"
                );
            }
            let zeta = distance / sigma;
            for beyond in [1.0, 1.1, 1e9] {
                let theta = reach(one(sigma), one(distance), one(beyond * zeta));
                assert_eq!(value(theta), f64::INFINITY);
            }
        }
    }
}

/// As far as the series of artanh goes, |s| ≤ 0.45, and y has grown by no more than 8 as if its growth were exponential; where the way
/// to there is bounded by a hyperbolic tangent, that undone.
#[test]
fn a_panel_ends_where_the_series_does() {
    let mut met = [0; 4];
    for (a, b, nu) in [
        (1.0, 1.3, 0.1),
        (1.0, 1.3, -0.5),
        (1.3, 1.0, 0.5),
        (1.3, 1.0, -0.1),
        (1.0, 3.0, 0.5),
        (3.0, 1.0, -1.9),
        (3.0, 1.0, 0.5),
        (1.0, 3.0, -0.5),
    ] {
        for y in [0.01, 0.2, 0.45, 0.55, 0.9, 3.0] {
            let case = case(a, b, nu, y);
            let impacts = case.impacts(0.5, 0.5, Hypothesis::Newton);
            let path = Hodograph::new(&impacts.rates, impacts.course.y);
            let (sigma, distance) = (value(path.sigma), value(path.distance));
            let used = |theta: f64| {
                let zeta = -distance * (-2.0 * sigma * theta).exp_m1() / sigma;
                let q = value(path.minus) * zeta;
                [
                    q / (2.0 + q) / 0.45,
                    q / (2.0 + q) / -0.45,
                    -sigma * zeta / 8.0,
                ]
            };
            let end = value(path.steep());
            let way = if end.is_finite() {
                4.0 * (0.25 * sigma * end).atanh() / sigma
            } else {
                20.0 / sigma.abs()
            };
            let most = used(way).into_iter().fold(0.0, f64::max);
            if end.is_finite() {
                assert!((most - 1.0).abs() < 1e-12, "{most} {case:?}");
                met[used(way).iter().position(|&share| share == most).unwrap()] += 1;
            } else {
                assert!(most < 1.0, "{most} {case:?}");
                met[3] += 1;
            }
        }
    }
    assert!(met.iter().all(|&times| times > 0), "{met:?}");
}

/// Where the hodograph is followed as far as it is resolved, or nearly, it is what the equation of the slip gives, next to either
/// fixed point and on either side of it, but for the error of a thousand steps of Runge and Kutta's method where A changes by e¹⁴; and
/// y grows by 8 at most.
#[test]
fn the_hodograph_is_that_of_the_equation_of_the_slip() {
    for (a, b, nu) in [
        (1.0, 3.0, 0.5),
        (3.0, 1.0, 0.5),
        (1.0, 3.0, -0.5),
        (3.0, 1.0, -0.5),
    ] {
        for y in [0.01, 0.3, 0.45, 0.55, 0.6, 0.62, 0.9] {
            let case = case(a, b, nu, y);
            let impacts = case.impacts(0.5, 0.5, Hypothesis::Newton);
            let (rates, at) = (impacts.rates, impacts.course);
            let path = Hodograph::new(&rates, at.y);
            let theta = path.longest(&rates, &at);
            let there = State::of(&at).after(&rates, value(theta));
            let point = path.at(theta);
            let found = value(at.y - point.lost);
            assert!((found - there.y()).abs() < 1e-9, "{found} {case:?}");
            assert!(found - y < 8.0 + 1e-12, "{found} {case:?}");
            let size = value(at.a) * value(point.growth).exp();
            let a = 0.5 * (there.u.hypot(there.w) + there.u);
            assert!((size - a).abs() < 1e-7 * a, "{size} {a} {case:?}");
        }
    }
}
