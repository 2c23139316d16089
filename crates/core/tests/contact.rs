//! No contact is missed and none invented: every flight is looked at between its ends in another way.

use crate::common::*;
use crate::scalar::*;
use proptest::prelude::*;
use restitution_core::{Body, FlightEnd, FlightStart, Sphere, State, StopReason, Vector};

/// The smallest gap under a sphere within a flight: sampled, and refined around every local minimum.
fn deepest(start: &State, body: &Body, time: f64, sphere: Sphere, samples: usize) -> f64 {
    let at = |i: usize| time * i as f64 / samples as f64;
    let gaps: Vec<f64> = (0..=samples)
        .map(|i| gap(start, body, at(i), sphere))
        .collect();
    let mut deepest = f64::INFINITY;
    for i in 1..samples {
        deepest = deepest.min(gaps[i]);
        if gaps[i] <= gaps[i - 1] && gaps[i] <= gaps[i + 1] {
            let (mut low, mut high) = (at(i - 1), at(i + 1));
            for _ in 0..40 {
                let third = (high - low) / 3.0;
                let (a, b) = (
                    gap(start, body, low + third, sphere),
                    gap(start, body, high - third, sphere),
                );
                deepest = deepest.min(a).min(b);
                if a < b { high -= third } else { low += third }
            }
        }
    }
    deepest
}

proptest! {
    #![proptest_config(cases(1000))]

    /// Between two impacts neither sphere is below the plane; at an impact the sphere that is said to touch does, and moves
    /// towards the plane; the other is not below it. Depth ≤ 10⁻¹² R is promised for what the engine reports. What the test
    /// works out itself is rounded by 16 ulp of its terms: more than 10⁻¹² only if |Ωt| L/2 or v² exceed 300.
    #[test]
    fn no_contact_is_missed_and_none_invented((body, law, release) in motion()) {
        let mut fastest = 0.0_f64;
        for leg in legs(&body, &law, release, 12) {
            let (start, impact) = (&leg.start, &leg.impact);
            fastest = fastest.max(energy(start, &body));
            let allowed = gap_tolerance(start, &body, leg.time, fastest);
            for sphere in Sphere::BOTH {
                let gap = deepest(start, &body, leg.time, sphere, 1000);
                prop_assert!(gap >= -allowed, "{gap:e} in {leg:?}");
            }
            let there = gap(start, &body, leg.time, impact.sphere);
            prop_assert!(there.abs() <= allowed, "{there:e} at the contact of {leg:?}");
            let gaps = impact.before.gaps(&body);
            prop_assert!(gaps[impact.sphere as usize].abs() <= 1e-12);
            prop_assert!(gaps[1 - impact.sphere as usize] >= -allowed.max(1e-12));
            let approach = contact_velocity(&impact.before, &body, impact.sphere).z;
            let speed = impact.before.velocity.norm() + impact.before.spin(&body).norm() * (1.0 + body.half_separation);
            prop_assert!(approach <= 16.0 * f64::EPSILON * speed, "{approach:e} in {leg:?}");
        }
    }

    /// A sphere that has just been hit leaves, and cannot be back before its gap, which falls no faster than M, has closed
    /// again: the impact that started a flight is not found a second time.
    #[test]
    fn no_impact_is_found_twice((body, law, release) in motion()) {
        for leg in legs(&body, &law, release, 12) {
            let FlightStart::Contact { sphere, speed } = leg.departure else { continue };
            if leg.impact.sphere == sphere {
                let rate = leg.start.precession.norm();
                let bound = 1.0 + body.half_separation * rate * rate;
                prop_assert!(leg.time >= 2.0 * speed / bound * (1.0 - 1e-12), "{leg:?}");
            }
        }
    }

    /// A spinning body comes down so that its first dip to the plane just misses it or just touches it. Slightly higher: no
    /// event in that dip. Slightly lower: the event is there, as early as the depth says.
    #[test]
    fn grazing_contacts_are_told_apart(
        elongation in 0.5..4.0_f64, rate in 3.0..100.0_f64, phase in 0.0..std::f64::consts::TAU, depth in magnitude(-13.0, -3.0),
    ) {
        let body = dumbbell(elongation);
        let axis = Vector::new(phase.sin(), 0.0, phase.cos());
        let spin = Vector::new(0.0, rate, 0.0);
        let start = State::with_spin(&body, 1.0, Vector::default(), axis, spin);
        // Sphere 1 is lowest when its angle Ωt + phase is an odd multiple of π; there are two dips in a turn, one a sphere.
        let turn = std::f64::consts::PI;
        let ahead = turn - phase.rem_euclid(turn);
        let sphere = if phase < turn { Sphere::One } else { Sphere::Two };
        let (mut low, mut high) = ((ahead - 0.5) / rate, (ahead + 0.5) / rate);
        prop_assume!(low > 0.0);
        // Where the sphere is lowest: f′ = 0 by bisection of the exact derivative.
        let slope = |t: f64| -t - body.half_separation * rate * (rate * t + phase).sin() * sphere.sign();
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 { low = middle } else { high = middle }
        }
        let (bottom, clearance) = (low, gap(&start, &body, low, sphere));
        let allowed = gap_tolerance(&start, &body, bottom, 1.0);
        prop_assume!(depth > 4.0 * allowed && bottom * bottom < 0.1);

        // The release must be clear of the plane for the dip to be the first contact.
        let lifted = |by: f64| at_height(&start, 1.0 + lift(&start) - clearance + by);
        prop_assume!(lifted(-depth).gaps(&body).iter().all(|&gap| gap > 0.0));
        let window = 1.0 / rate;

        let FlightEnd::Impact { time, .. } = landing(lifted(depth), &body, FlightStart::Free) else {
            panic!("it falls");
        };
        prop_assert!(time > bottom + 0.1 * window || (time - bottom).abs() > window, "hit at {time}, bottom {bottom}");
        let FlightEnd::Impact { time, sphere: touched, state } = landing(lifted(-depth), &body, FlightStart::Free) else {
            panic!("it falls");
        };
        prop_assert_eq!(touched, sphere);
        // f ≈ f″(t − t₀)²/2 − depth, f″ = (L/2)Ω²|cos| − 1 up to a few per cent within this window.
        let bend = body.half_separation * rate * rate - 1.0;
        let early = (2.0 * depth / bend).sqrt();
        prop_assert!((bottom - time - early).abs() <= 0.5 * early, "{} instead of {early}", bottom - time);
        prop_assert!(contact_velocity(&state, &body, touched).z < 0.0);
    }

    /// With its axis exactly level both spheres come down together; the other sphere then hits at the same instant unless
    /// the first impact has made it leave. A plastic impact leaves the first one where it is, and still the other hits.
    #[test]
    fn simultaneous_contacts_are_both_seen(
        elongation in 0.01..4.0_f64, (normal, tangential) in coefficients(), speed in 0.1..20.0_f64, phi in 0.0..std::f64::consts::TAU,
    ) {
        let body = dumbbell(elongation);
        let axis = Vector::new(phi.cos(), phi.sin(), 0.0);
        let velocity = Vector::new(0.3, -0.2, -speed);
        let start = State::with_spin(&body, 1.0, velocity, axis, Vector::default());
        let law = law(normal, tangential);
        let legs = legs(&body, &law, start, 2);
        prop_assert_eq!(legs[0].time, 0.0);
        let other = Sphere::BOTH[1 - legs[0].impact.sphere as usize];
        let approach = contact_velocity(&legs[0].impact.after, &body, other).z;
        prop_assume!(approach.abs() > 1e-12);
        if approach < 0.0 {
            prop_assert_eq!(legs.len(), 2, "the other sphere moves on into the plane at {}", approach);
            prop_assert_eq!(legs[1].time, 0.0);
            prop_assert_eq!(legs[1].impact.sphere, other);
        } else if let Some(next) = legs.get(1) {
            prop_assert!(next.time > 0.0);
        }
    }

    /// A spinning body that is nearly level when it comes down: both spheres arrive at nearly the same time, and neither is in
    /// the plane when the other is said to touch first, nor was it on the last way, at any distance from its end.
    #[test]
    fn the_other_sphere_is_not_overlooked(
        elongation in 0.01..4.0_f64, rate in magnitude(-2.0, 2.0), beyond in magnitude(-3.0, 2.0), lean in magnitude(-15.0, -0.5),
        sides in (any::<bool>(), any::<bool>()),
    ) {
        let body = dumbbell(elongation);
        let drop = body.half_separation * (1.0 + beyond); // so that no attitude reaches the plane
        let sign = |side: bool| if side { 1.0 } else { -1.0 };
        let (rate, lean) = (sign(sides.0) * rate, sign(sides.1) * lean);
        // Where the axis would be level but for `lean`, the centre of mass is at R.
        let angle = 0.5 * std::f64::consts::PI + lean - rate * (2.0 * drop).sqrt();
        let axis = Vector::new(angle.sin(), 0.0, angle.cos());
        let start = State::with_spin(&body, 1.0 + drop, Vector::default(), axis, Vector::new(0.0, rate, 0.0));
        let FlightEnd::Impact { time, .. } = landing(start, &body, FlightStart::Free) else {
            panic!("it falls");
        };
        let allowed = gap_tolerance(&start, &body, time, 1.0 + drop);
        for sphere in Sphere::BOTH {
            for step in 0..400 {
                let before = gap(&start, &body, time * (1.0 - 0.5_f64.powf(0.1 * f64::from(step))), sphere);
                prop_assert!(before >= -allowed, "{before:e} under {sphere:?}, {step} before {time}");
            }
            prop_assert!(gap(&start, &body, time, sphere) >= -allowed);
        }
    }

    /// A sphere that comes out of the plane again before the other one arrives: its gap has a minimum below 0 a moment before the other
    /// gap closes, and is open then. It touched first, and nothing is in the plane up to then.
    #[test]
    fn a_sphere_that_has_come_out_again_is_not_overlooked(
        elongation in 0.5..4.0_f64, rate in magnitude(1.0, 3.0), (upward, apart) in (0.2..0.95_f64, 0.3..1.2_f64),
        (before, late, depth) in (magnitude(-2.5, -0.5), magnitude(-2.5, -0.5), 0.02..0.9_f64),
    ) {
        let body = dumbbell(elongation);
        let half = body.half_separation;
        let time = before / rate;
        let since = late * time;
        // At the minimum of the gap under sphere 2 the axis is all but level.
        let outward = (1.0 - upward * upward).sqrt();
        let pole = Vector::new(outward, 0.0, upward);
        let level = Vector::new(-apart.cos(), -apart.sin(), 0.0);
        let bend = -1.0 - half * rate * rate * level.dot(pole) * pole.z;
        let falls = rate * pole.cross(level).z;
        prop_assume!(bend > 0.0 && falls < -0.1 * rate);
        let below = depth * 0.5 * bend * since * since;
        let tilt = (-2.0 * half * falls * since + below) / (2.0 * half);
        prop_assume!(tilt < 0.1);
        let axis = level * (1.0 - tilt * tilt).sqrt() + Vector::new(0.0, 0.0, tilt);
        let climb = half * rate * pole.cross(axis).z;
        let (sin, cos) = (-rate * time).sin_cos();
        let earlier = axis * cos + pole.cross(axis) * sin + pole * (pole.dot(axis) * (1.0 - cos));
        let start = State {
            height: half * tilt - below - (climb + 0.5 * time) * time,
            velocity: Vector::new(0.0, 0.0, climb + time),
            axis: earlier,
            precession: pole * rate,
        };
        prop_assume!(Sphere::BOTH.iter().all(|&sphere| gap(&start, &body, 0.0, sphere) > 0.0));
        let FlightEnd::Impact { time: end, .. } = landing(start, &body, FlightStart::Free) else {
            panic!("it falls");
        };
        let allowed = gap_tolerance(&start, &body, end, energy(&start, &body));
        for sphere in Sphere::BOTH {
            let deepest = deepest(&start, &body, end, sphere, 4000);
            prop_assert!(deepest >= -allowed, "{deepest:e} under {sphere:?}, {below:e}");
        }
    }

    /// Let go on the plane while spinning: the lower sphere, if it starts down into the plane, hits at once.
    #[test]
    fn a_contact_at_release_is_hit_at_once_if_it_approaches((body, law, free) in motion()) {
        let sphere = if free.axis.z < 0.0 { Sphere::One } else { Sphere::Two };
        let mut before = at_height(&free, 1.0 + body.half_separation * free.axis.z.abs());
        if contact_velocity(&before, &body, sphere).z > 0.0 {
            before.velocity = before.velocity * -1.0;
            before.precession = before.precession * -1.0;
        }
        let velocity = contact_velocity(&before, &body, sphere).z;
        let gap = gap_tolerance(&before, &body, 0.0, 0.0);
        // A sphere that rotates upwards again may graze: its way down must be longer than what rounding leaves open.
        let rate = before.precession.norm();
        let bound = 1.0 + body.half_separation * rate * rate;
        prop_assume!(velocity * velocity > 4.0 * bound * gap);
        let first = &legs(&body, &law, before, 1)[0];
        prop_assert!(first.time <= 2.0 * gap / -velocity, "{first:?}");
    }
}

/// At rest on the plane, on one sphere or on both: nothing moves, and no impact is made up. (Bodies that a double can put
/// onto the plane to the last bit.)
#[test]
fn a_body_released_at_rest_on_the_plane_stays_there() {
    let upright = Vector::new(0.0, 0.0, 1.0);
    let level = Vector::new(0.6, -0.8, 0.0);
    let tilted = Vector::new(0.28, 0.0, 0.96);
    for (elongation, axis, height) in [
        (0.0, tilted, 1.0),
        (1.0, upright, 1.5),
        (3.0, upright * -1.0, 2.5),
        (0.1, level, 1.0),
        (3.0, level, 1.0),
    ] {
        let body = dumbbell(elongation);
        let rest = Vector::default();
        let release = State::with_spin(&body, height, rest, axis, rest);
        assert!(release.gaps(&body).contains(&0.0));
        let (impacts, reason) = trajectory(&body, &law(0.9, 1.0), release, 100);
        assert_eq!(reason, StopReason::Collapse);
        assert!(
            impacts.is_empty(),
            "{} impacts of L/R = {elongation} with axis {axis:?}",
            impacts.len()
        );
    }
}

/// Let go with both spheres on the plane up to rounding, but turning: the one that goes down hits at once, whichever of them
/// rounding has put below the other, or below the plane.
#[test]
fn a_level_body_that_turns_into_the_plane_is_hit_at_once() {
    for elongation in [0.1, 1.0, 3.0] {
        let body = dumbbell(elongation);
        for tilt in [0.0, 1e-17, -1e-17, 6e-17, -6e-17, 3e-16, -3e-16] {
            for rate in [1.0, -1.0, 30.0] {
                let axis = Vector::new(1.0, 0.0, tilt);
                let spin = Vector::new(0.0, rate, 0.0);
                let start = State::with_spin(&body, 1.0, Vector::default(), axis, spin);
                let FlightEnd::Impact { time, sphere, .. } =
                    landing(start, &body, FlightStart::Free)
                else {
                    panic!("it hits");
                };
                // Spin along y takes the axis, which points along x, down.
                let down = if rate > 0.0 { Sphere::One } else { Sphere::Two };
                assert_eq!(sphere, down, "tilt {tilt:e}, rate {rate}, after {time:e}");
                assert!(time < 1e-14);
            }
        }
    }
}

/// On the plane but on its way up: a sphere is back after 2v.
#[test]
fn a_body_thrown_up_from_the_plane_flies() {
    for elongation in [0.0, 1.0, 3.0] {
        let body = dumbbell(elongation);
        for speed in [1e-6, 1.0, 30.0] {
            let rest = at_rest(&body, 1.0 + body.half_separation, 0.0);
            let start = State {
                velocity: Vector::new(0.0, 0.0, speed),
                ..rest
            };
            let FlightEnd::Impact { time, .. } = landing(start, &body, FlightStart::Free) else {
                panic!("it comes back");
            };
            assert!(
                (time - 2.0 * speed).abs() <= 8.0 * f64::EPSILON * (1.0 + speed).powi(2) / speed
            );
        }
    }
}

/// A sphere whose point of contact is left without speed stays, unless the rotation pulls it up faster than the body falls,
/// (L/2)Ω² > 1: upright, the centre of mass then falls from rest, and the gaps are (L/2)(1 ∓ cos Ωt) − t²/2.
#[test]
fn a_contact_without_speed_is_left_if_the_rotation_lifts_it() {
    for elongation in [0.3, 1.0, 3.5] {
        let body = dumbbell(elongation);
        let half = body.half_separation;
        for (sphere, pull) in Sphere::BOTH
            .map(|one| [0.5, 0.9, 1.1, 1.5, 20.0].map(|x| (one, x)))
            .concat()
        {
            let axis = Vector::new(0.0, 0.0, -sphere.sign());
            let rate = (pull / half).sqrt();
            let spin = Vector::new(0.0, rate, 0.0);
            let start = State::with_spin(&body, 1.0 + half, Vector::default(), axis, spin);
            let found = landing(start, &body, FlightStart::Contact { sphere, speed: 0.0 });
            if pull < 1.0 {
                assert_eq!(found, FlightEnd::Resting, "{sphere:?}, {pull}");
                continue;
            }
            let FlightEnd::Impact {
                time, sphere: next, ..
            } = found
            else {
                panic!("{found:?} instead of a flight, {sphere:?}, {pull}");
            };
            let least = |t: f64| half * (1.0 - (rate * t).cos().abs()) - 0.5 * t * t;
            let mut late = 1e-3 / rate;
            while least(late) > 0.0 {
                late += 1e-3 / rate;
            }
            let mut early = late - 1e-3 / rate;
            for _ in 0..60 {
                let middle = 0.5 * (early + late);
                if least(middle) > 0.0 {
                    early = middle
                } else {
                    late = middle
                }
            }
            assert!(
                (time - late).abs() < 1e-12 * late,
                "{time} instead of {late}"
            );
            let same = (rate * late).cos() > 0.0;
            assert_eq!(next == sphere, same, "{sphere:?}, {pull}");
        }
    }
}
