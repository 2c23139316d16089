//! Motions with a solution on paper.

use crate::common::*;
use crate::scalar::*;
use proptest::prelude::*;
use restitution_core::{Orientation, Run, Solid};
use std::f64::consts::{FRAC_PI_2, PI};

/// Half an ulp of 1.
const ROUNDING: f64 = 0.5 * f64::EPSILON;

/// ε of the first impact from rest (17), with J_xx and m from the body in SI units. The contact is with the lower sphere,
/// so that the cosine counts by its magnitude.
fn first_restitution(body: &Solid, separation: f64, normal: f64, angle: f64) -> f64 {
    let (r, l, c) = (body.unit, separation, angle.cos().abs());
    let j = body.transverse_inertia / body.mass;
    let common = 4.0 * j + 4.0 * l * r * c + 4.0 * r * r;
    -1.0 + (1.0 + normal) * (common + l * l * c * c) / (common + l * l) // (17)
}

proptest! {
    #![proptest_config(cases(300))]

    /// A sphere has one coefficient of restitution, whatever its tangential law: nothing makes it spin. The impulse
    /// (1 + ε)|v| is the result of at most seven roundings, v + P and the quotient (1) add two that are ε/2 ulp each.
    #[test]
    fn a_sphere_rebounds_with_the_normal_coefficient(
        (normal, tangential) in coefficients(), angle in 0.0..PI, height in 1.0..100.0_f64,
    ) {
        let body = dumbbell(0.0);
        let release = at_rest(&body, 1.0 + height, angle);
        for impact in trajectory(&body, &law(normal, tangential), release, 50).0 {
            // Impacts too low to be resolved come from rounding itself.
            if impact.impact_velocity() < 1e-5 {
                break;
            }
            let allowed = (7.0 * (1.0 + normal) + 2.0 * normal) * ROUNDING;
            prop_assert!((impact.restitution() - normal).abs() <= allowed);
            prop_assert_eq!(impact.rotational_fraction(&body), 0.0);
        }
    }

    /// The bouncing ball: t₁ = √(2d/g), and each flight ε times the one before. Every impact carries the relative error
    /// of its ε on to all later flights.
    #[test]
    fn a_sphere_bounces_at_geometric_times(normal in 0.3..=1.0_f64, drop in 0.01..10.0_f64) {
        let run = Run {
            particles: 1,
            impacts: 12,
            release_height: (3e-3 + drop).into(),
            ..paper(0.0, law(normal, 1.0))
        };
        let records = simulate(&run);
        let first = (2.0 * (run.release_height.middle() - 3e-3) / run.gravity).sqrt();
        let (mut time, mut flight) = (first, 2.0 * first);
        for i in 0..run.impacts {
            let allowed = (16.0 + 16.0 * i as f64 / normal) * ROUNDING;
            prop_assert!((records.time[i] - time).abs() <= allowed * time);
            flight *= normal;
            time += flight;
        }
    }

    /// Released on end, a dumbbell of any length falls like a sphere: the plane pushes through its centre of mass.
    #[test]
    fn upright_the_dumbbell_is_a_sphere(
        elongation in elongation(), normal in 0.1..=1.0_f64, tangential in -1.0..=1.0_f64, drop in 0.1..30.0_f64,
    ) {
        let body = dumbbell(elongation);
        let sphere = dumbbell(0.0);
        let law = law(normal, tangential);
        let release = at_rest(&body, 1.0 + body.half_separation + drop, 0.0);
        let (long, _) = trajectory(&body, &law, release, 8);
        let (round, _) = trajectory(&sphere, &law, at_rest(&sphere, 1.0 + drop, 0.0), 8);
        for (i, (a, b)) in long.iter().zip(&round).enumerate() {
            // The drop as the sphere knows it was rounded at the height of the longer body, too.
            let height = 1.0 + body.half_separation + drop;
            let allowed = 32.0 * (i as f64 + 1.0) / normal * (height / drop) * ROUNDING;
            prop_assert!((a.time - b.time).abs() <= allowed * b.time);
            prop_assert!((a.restitution() - normal).abs() <= 16.0 * ROUNDING);
        }
    }

    /// (17) for any length, also beyond touching spheres, where the paper stops; ε_t does not matter, as nothing slips. The
    /// energy follows: ΔE = P·(v_c + v_c′)/2 with P_n = (1 + ε)v gives 1 − (1 − ε_n)(1 + ε).
    #[test]
    fn the_first_impact_obeys_equation_17(
        elongation in elongation(), (normal, tangential) in coefficients(), angle in 0.0..PI, gravity in 0.1..100.0_f64,
    ) {
        let angles = [angle];
        let run = Run {
            particles: 1,
            impacts: 1,
            gravity,
            orientation: Orientation::Given(&angles),
            ..paper(elongation, law(normal, tangential))
        };
        let records = simulate(&run);
        let separation = elongation * 3e-3;
        let expected = first_restitution(run.body.revolution().unwrap(), separation, normal, angle);
        prop_assert!((records.restitution[0] - expected).abs() <= 32.0 * ROUNDING);
        let ratio = 1.0 - (1.0 - normal) * (1.0 + expected);
        prop_assert!((records.energy_ratio[0] - ratio).abs() <= 64.0 * ROUNDING);
        let drop = run.release_height.middle() - 3e-3 - 0.5 * separation * angle.cos().abs();
        let speed = (2.0 * gravity * drop).sqrt();
        // The fall is a difference of heights: its rounding weighs 0.06/drop.
        let allowed = 16.0 * (0.06 / drop) * ROUNDING;
        prop_assert!((records.impact_velocity[0] - speed).abs() <= allowed * speed);
        prop_assert!((records.time[0] - speed / gravity).abs() <= allowed * speed / gravity);
        prop_assert_eq!(records.rotational_fraction[0], 0.0);
        prop_assert_eq!(records.contact[0], if angle < FRAC_PI_2 { 2 } else { 1 });
    }
}

/// Two touching spheres: m = (8/3)πρR³ and, by Steiner's theorem, J_xx = (7/5)mR², J_zz = (2/5)mR²; both formulas for
/// the inertia end there, and so do the motions of bodies just shorter and just longer.
#[test]
fn shorter_and_longer_bodies_meet_in_touching_spheres() {
    let touching = dumbbell(2.0);
    assert!((touching.transverse - 1.4).abs() <= 4.0 * ROUNDING);
    assert!((touching.axial - 0.4).abs() <= 2.0 * ROUNDING);
    let impacts = |elongation| {
        let body = dumbbell(elongation);
        trajectory(&body, &law(0.4, 1.0), at_rest(&body, 20.0, 1.0), 5).0
    };
    let at_two = impacts(2.0);
    for nearby in [2.0_f64.next_down(), 2.0_f64.next_up()] {
        for (a, b) in impacts(nearby).iter().zip(&at_two) {
            assert!((a.restitution() - b.restitution()).abs() < 1e-12);
            assert!((a.time - b.time).abs() < 1e-12);
        }
    }
}

/// As L → 0 the body becomes a sphere: by (17) the first ε falls short of ε_n by (1 + ε_n)(L/R)² sin²θ/5.6 at most, and
/// the spin it leaves behind, ω ≲ v L/R, moves the following ones by a few L/R.
#[test]
fn short_bodies_tend_to_the_sphere() {
    let normal = 0.9;
    for exponent in 1..17 {
        let elongation = 10.0_f64.powi(-exponent);
        let body = dumbbell(elongation);
        let (impacts, _) = trajectory(&body, &law(normal, 1.0), at_rest(&body, 20.0, 1.1), 6);
        let first = normal - impacts[0].restitution();
        assert!(
            (-16.0 * ROUNDING..elongation * elongation / 2.8 + 16.0 * ROUNDING).contains(&first)
        );
        for impact in &impacts {
            assert!((impact.restitution() - normal).abs() < 5.0 * elongation + 16.0 * ROUNDING);
        }
    }
}

/// A level dumbbell touches down with both spheres at once. Hitting one lifts the other's contact by (1 + ε_n)c v, c =
/// (J + 1 − x²)/(J + 1 + x²) with x = L/2: where that is less than v, the other hits at the same instant, else not at all.
#[test]
fn a_level_body_hits_with_both_spheres_unless_the_first_lifts_the_second() {
    let body = dumbbell(1.0);
    let (j, x) = (body.transverse, body.half_separation);
    let lifted = (j + 1.0 - x * x) / (j + 1.0 + x * x);
    for (normal, angle) in [
        (0.1, FRAC_PI_2),
        (0.3, -FRAC_PI_2),
        (0.5, FRAC_PI_2),
        (1.0, -FRAC_PI_2),
    ] {
        let (impacts, _) = trajectory(&body, &law(normal, 1.0), at_rest(&body, 10.0, angle), 2);
        assert!((impacts[0].time - 18.0_f64.sqrt()).abs() < 1e-15);
        let together = impacts[1].time - impacts[0].time < 1e-15;
        assert_eq!(together, (1.0 + normal) * lifted < 1.0, "{normal}");
        assert!(!together || impacts[0].sphere != impacts[1].sphere);
    }
}
