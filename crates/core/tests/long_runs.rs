//! A million impacts.

use crate::common::*;
use crate::scalar::*;
use restitution_core::{Body, Limits, Orientation, Run, State, StopReason, Vector};

/// A particle let go at rest, 20 R high.
fn released(orientation: Orientation<'_>, body: &Body, seed: u64, particle: u64) -> State {
    let (sine, cosine) = orientation.draw(seed, particle);
    let (rest, axis) = (Vector::default(), Vector::new(sine, 0.0, cosine));
    State::with_spin(body, 20.0, rest, axis, rest)
}

/// Elastic, plastic, rough, slippery; nearly round, long: a million impacts altogether, of which none is below the plane,
/// none before the one before, and none anything but a number.
#[test]
fn a_million_impacts_are_in_order_and_above_the_plane() {
    let mut total = 0;
    let mut deepest = 0.0_f64;
    let mut particle = 0;
    while total < 1_000_000 {
        for elongation in [0.02, 0.1, 0.5, 1.0, 2.0, 3.7] {
            for (normal, tangential) in [
                (0.98, 1.0),
                (0.9, 0.5),
                (0.999, -0.9),
                (1.0, 1.0),
                (0.7, 0.0),
            ] {
                let body = dumbbell(elongation);
                particle += 1;
                let release = released(Orientation::Isotropic, &body, 5, particle);
                let mut last = 0.0;
                let limits = Limits {
                    impacts: 2000,
                    minimum_speed: 1e-4,
                    settled: 0.0,
                };
                let reason = restitution_core::trajectory(
                    &body,
                    &law(normal, tangential),
                    0.0,
                    release,
                    limits,
                    |impact| {
                        assert!(impact.time >= last, "{} after {last}", impact.time);
                        last = impact.time;
                        let gaps = impact.before.gaps(&body);
                        deepest = deepest.max(-gaps[0]).max(-gaps[1]);
                        assert!(gaps[impact.sphere as usize].abs() <= 1e-12);
                        let numbers = [
                            impact.rotational_fraction(&body),
                            impact.energy_ratio(&body),
                            impact.restitution(),
                            impact.before.angle(),
                        ];
                        assert!(numbers.iter().all(|x| x.is_finite()), "{impact:?}");
                        assert!((0.0..=1.0).contains(&numbers[0]));
                        total += 1;
                        true
                    },
                );
                assert_ne!(reason, Ok(StopReason::Interrupted));
            }
        }
    }
    assert!(deepest <= 1e-12, "{deepest:e}");
}

/// Where the law cannot do work — spheres, or ε_t = −ε_n for any body — a hundred thousand impacts never gain energy, from one
/// impact to the next: what is lost in the impact is not given back in the flight.
#[test]
fn energy_never_grows_where_it_cannot() {
    for (elongation, normal, tangential) in [
        (0.0, 1.0, 1.0),
        (0.0, 0.95, -1.0),
        (0.1, 0.98, -0.98),
        (0.5, 1.0, -1.0),
        (2.0, 0.99, -0.99),
        (3.0, 0.9, -0.9),
    ] {
        let body = dumbbell(elongation);
        for particle in 0..10 {
            let release = released(Orientation::UniformAngle, &body, 3, particle);
            let mut held = energy(&release, &body);
            let limits = Limits {
                impacts: 2000,
                minimum_speed: 1e-4,
                settled: 0.0,
            };
            restitution_core::trajectory(
                &body,
                &law(normal, tangential),
                0.0,
                release,
                limits,
                |impact| {
                    // Rounding: that of the height, of v²/2 and of the sum.
                    let allowed = 16.0 * f64::EPSILON * (1.0 + held);
                    let now = energy(&impact.after, &body);
                    assert!(now <= held + allowed, "{:e} gained", now - held);
                    held = now;
                    true
                },
            )
            .unwrap();
        }
    }
}

/// With ε_n = 1 and ε_t = −1 the contact velocity is reversed and no energy lost: the whole energy is the same after
/// ten thousand impacts, up to roundings. They do not quite average out: about a sixth of an ulp an impact is gained at
/// L/R = 3, however closely the contact is located (the last step at most 2⁻¹¹ or 2⁻¹⁶ of the flight time).
#[test]
fn reversal_conserves_energy() {
    for elongation in [0.1, 1.0, 3.0] {
        let body = dumbbell(elongation);
        let release = released(Orientation::UniformAngle, &body, 3, 1);
        let start = energy(&release, &body);
        let limits = Limits {
            impacts: 10_000,
            minimum_speed: 0.0,
            settled: 0.0,
        };
        let mut end = 0.0;
        restitution_core::trajectory(&body, &law(1.0, -1.0), 0.0, release, limits, |impact| {
            end = energy(&impact.after, &body);
            true
        })
        .unwrap();
        // Half an ulp an impact.
        assert!(
            (end - start).abs() <= 0.5 * 10_000.0 * f64::EPSILON * start,
            "{:e}",
            end / start - 1.0
        );
    }
}

/// The paper's law makes energy out of nothing, the more the longer the body; the record shows it.
#[test]
fn gains_of_the_papers_law_are_recorded() {
    let share = |elongation: f64| {
        let run = Run {
            particles: 200,
            ..paper(elongation, law(0.98, 1.0))
        };
        let records = simulate(&run);
        let (gains, all) = records
            .energy_ratio
            .iter()
            .filter(|x| !x.is_nan())
            .fold((0, 0), |(g, n), &x| {
                (g + usize::from(x > 1.0 + 1e-12), n + 1)
            });
        f64::from(gains as u32) / f64::from(all as u32)
    };
    assert_eq!(share(0.0), 0.0);
    let (short, long) = (share(0.5), share(2.0));
    assert!(short > 0.01 && long > short, "{short} {long}");
}
