//! What the plane and gravity do not tell apart, the engine must not either: planar motions, mirror images, exchanged
//! spheres, rotations about the normal, units.

use crate::common::*;
use crate::scalar::*;
use proptest::prelude::*;
use restitution_core::{
    Dumbbell, FlightEnd, Orientation, Run, SingleImpact as Impact, Sphere, State, Vector, collide,
};
use std::f64::consts::PI;

/// Both trajectories, impact by impact, after `image` has been applied to the first: equal to the last bit.
fn are_images(
    (body, law, release): (
        restitution_core::Body,
        restitution_core::Law<'static>,
        State,
    ),
    image: impl Fn(&State) -> State,
    spheres: impl Fn(Sphere) -> Sphere,
) -> Result<(), TestCaseError> {
    let (impacts, reason) = trajectory(&body, &law, release, 60);
    let (images, other) = trajectory(&body, &law, image(&release), 60);
    prop_assert_eq!(reason, other);
    prop_assert_eq!(impacts.len(), images.len());
    for (a, b) in impacts.iter().zip(&images) {
        let expected = Impact {
            time: a.time,
            before: image(&a.before),
            after: image(&a.after),
            sphere: spheres(a.sphere),
        };
        prop_assert_eq!(&expected, b);
    }
    Ok(())
}

/// The mirror image in the y–z plane; the angular momentum is a pseudovector.
fn mirrored(state: &State) -> State {
    let Vector { x, y, z } = state.precession;
    State {
        velocity: Vector {
            x: -state.velocity.x,
            ..state.velocity
        },
        axis: Vector {
            x: -state.axis.x,
            ..state.axis
        },
        precession: Vector::new(x, -y, -z),
        ..*state
    }
}

/// The same motion, with the spheres' names exchanged.
fn renamed(state: &State) -> State {
    State {
        axis: state.axis * -1.0,
        ..*state
    }
}

/// Turned about the plane normal.
fn turned(state: &State, phi: f64) -> State {
    let (sin, cos) = phi.sin_cos();
    let turn = |v: Vector| Vector::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z);
    State {
        velocity: turn(state.velocity),
        axis: turn(state.axis),
        precession: turn(state.precession),
        ..*state
    }
}

fn exchanged(sphere: Sphere) -> Sphere {
    Sphere::BOTH[1 - sphere as usize]
}

proptest! {
    #![proptest_config(cases(1000))]

    /// Axis and velocity in the x–z plane, spin along y: all y components are exactly 0 for ever, and so are the x and z
    /// components of the spin.
    #[test]
    fn planar_motion_stays_planar(
        elongation in elongation(), (normal, tangential) in coefficients(), angle in 0.0..2.0 * PI,
        (vx, vz) in (-5.0..5.0_f64, -5.0..5.0_f64), rate in -50.0..50.0_f64, space in 0.0..20.0_f64,
    ) {
        let body = dumbbell(elongation);
        let axis = Vector::new(angle.sin(), 0.0, angle.cos());
        let height = 1.0 + body.half_separation + space;
        let velocity = Vector::new(vx, 0.0, vz);
        let release = State::with_spin(&body, height, velocity, axis, Vector::new(0.0, rate, 0.0));
        for impact in trajectory(&body, &law(normal, tangential), release, 100).0 {
            for state in [impact.before, impact.after] {
                prop_assert_eq!(state.axis.y, 0.0);
                prop_assert_eq!(state.velocity.y, 0.0);
                prop_assert_eq!((state.precession.x, state.precession.z), (0.0, 0.0));
            }
        }
    }

    /// θ → −θ in the plane, and any mirror image in space: every product only changes its sign.
    #[test]
    fn mirror_images_move_as_mirror_images(motion in motion()) {
        are_images(motion, mirrored, |sphere| sphere)?;
    }

    /// θ → π − θ with a mirror: the spheres are alike. Only where both touch at the same instant, within rounding, may a name
    /// decide which of them is hit first.
    #[test]
    fn the_spheres_are_alike(motion in motion()) {
        let (body, _, release) = &motion;
        let level = release.axis.z.abs() < 1e-9 || body.half_separation < 1e-9;
        prop_assume!(!level);
        are_images(motion, renamed, exchanged)?;
    }

    /// Turned about the normal by any angle, each flight and each impact is the same up to rounding. (Flight by flight: over
    /// many impacts the motion is chaotic.)
    #[test]
    fn no_direction_in_the_plane_is_special((body, law, release) in motion(), phi in 0.0..2.0 * PI) {
        // On the plane at release rounding decides whether there is a contact.
        prop_assume!(release.gaps(&body).iter().all(|&gap| gap > 1e-9));
        for leg in legs(&body, &law, release, 8) {
            let speed = -contact_velocity(&leg.impact.before, &body, leg.impact.sphere).z;
            let FlightEnd::Impact { time, state, sphere } = landing(turned(&leg.start, phi), &body, leg.departure) else {
                return Err(TestCaseError::fail("a rotated body must land, too"));
            };
            let rate = leg.start.precession.norm();
            let quick = leg.impact.before.velocity.norm() + 1.0 + (1.0 + body.half_separation) * rate;
            // A gap's rounding becomes one of the time when divided by the speed of approach. Contacts with both
            // spheres, or grazing, may be told apart either way.
            let late = gap_tolerance(&leg.start, &body, leg.time, energy(&leg.start, &body)) / speed;
            let other = leg.impact.before.gaps(&body)[exchanged(leg.impact.sphere) as usize];
            if speed <= 0.0 || late * quick > 1e-6 || other < quick * late {
                continue;
            }
            prop_assert_eq!(sphere, leg.impact.sphere);
            prop_assert!((time - leg.time).abs() <= 2.0 * late, "{time} {}", leg.time);
            let expected = turned(&leg.impact.before, phi);
            let allowed = 4.0 * late * quick + 16.0 * f64::EPSILON * (1.0 + rate * leg.time);
            prop_assert!((expected.axis - state.axis).norm() <= allowed);

            // The impact, from one and the same state. J_xx/J_zz weighs what Λ is rounded by.
            let (after, _) = collide(&body, &law, &expected, sphere);
            let error = (turned(&leg.impact.after, phi).velocity - after.velocity).norm();
            let allowed = 64.0 * f64::EPSILON * quick * body.transverse / body.axial;
            prop_assert!(error <= allowed, "{error:e} > {allowed:e}");
        }
    }
}

/// The records of one particle a row of angles, for bodies and heights that are multiples of the radius.
fn ensemble(radius: f64, density: f64, gravity: f64, angles: &[f64]) -> Run<'_> {
    Run {
        body: Dumbbell::new(radius, 0.5 * radius, density).unwrap().into(),
        particles: angles.len(),
        impacts: 200,
        release_height: (20.0 * radius).into(),
        gravity,
        orientation: Orientation::Given(angles),
        ..paper(0.5, law(0.9, 0.5))
    }
}

/// A run depends on L/R, the height over R and the law alone: with a radius of twice, four or 2⁻²⁰ times the size, any
/// gravity and any density, all pure numbers have the same bits, and times and speeds follow from √(R/g) and √(gR).
#[test]
fn only_ratios_matter() {
    let angles: Vec<f64> = (0..20).map(|i| 0.07 + 0.15 * f64::from(i)).collect();
    let reference = simulate(&ensemble(1.0, 1.0, 1.0, &angles));
    for (radius, density, gravity) in [
        (2.0, 1.0, 1.0),
        (4.0, 7.3, 9.81),
        (2.0_f64.powi(-20), 2500.0, 1.62),
    ] {
        let scaled = simulate(&ensemble(radius, density, gravity, &angles));
        let numbers = |r: &Records| {
            [
                &r.restitution,
                &r.rotational_fraction,
                &r.energy_ratio,
                &r.angle,
            ]
            .map(|column| column.iter().map(|x| x.to_bits()).collect::<Vec<_>>())
        };
        assert!(numbers(&reference) == numbers(&scaled));
        assert_eq!(reference.contact, scaled.contact);
        assert_eq!(reference.impacts, scaled.impacts);
        assert_eq!(reference.stop_reason, scaled.stop_reason);
        let (time, speed) = ((radius / gravity).sqrt(), (radius * gravity).sqrt());
        for (a, b) in reference
            .time
            .iter()
            .zip(&scaled.time)
            .filter(|(a, _)| !a.is_nan())
        {
            assert!((a * time - b).abs() <= f64::EPSILON * b);
        }
        for (a, b) in reference
            .impact_velocity
            .iter()
            .zip(&scaled.impact_velocity)
            .filter(|(a, _)| !a.is_nan())
        {
            assert!((a * speed - b).abs() <= f64::EPSILON * b.abs());
        }
    }
}

/// With a radius that is not a power of two the ratios are rounded, and the first impacts agree up to that.
#[test]
fn any_other_unit_agrees_up_to_rounding() {
    let angles: Vec<f64> = (0..20).map(|i| 0.07 + 0.15 * f64::from(i)).collect();
    let reference = simulate(&ensemble(1.0, 1.0, 1.0, &angles));
    let scaled = simulate(&ensemble(3e-3, 1.0, 9.81, &angles));
    for i in 0..angles.len() {
        // Each of the first few impacts multiplies an error in the angle by less than a hundred.
        for j in 0..3 {
            let k = i * 200 + j;
            let allowed = 1e-14 * 100.0_f64.powi(j as i32);
            assert!(
                (reference.restitution[k] - scaled.restitution[k]).abs() <= allowed,
                "{i} {j}"
            );
        }
    }
}
