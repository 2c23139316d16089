//! Every trajectory says why it ended, and the table says as much as happened and no more.

use crate::common::*;
use crate::scalar::*;
use restitution_core::{
    About, COLLAPSE_RUN, ChatterjeeRuina, Coulomb, Hypothesis, Law, Limits, Monitor, Orientation,
    Run, SingleImpact as Impact, Spin, State, StopReason, Vector,
};

/// What happened is finite, what did not is NaN or 0, and each particle's count tells where one ends and the other begins.
fn is_consistent(run: &Run<'_>, records: &Records) {
    for particle in 0..records.particles() {
        let count = records.impacts[particle] as usize;
        assert!(count <= run.impacts);
        for i in 0..run.impacts {
            let k = particle * run.impacts + i;
            for (name, column) in columns(records) {
                assert_eq!(
                    column[k].is_finite(),
                    i < count,
                    "{name} of impact {i} of {count}"
                );
                assert_eq!(column[k].is_nan(), i >= count);
            }
            assert_eq!(matches!(records.contact[k], 1 | 2), i < count);
            assert_eq!(records.contact[k] == 0, i >= count);
        }
        let reached = records.stop_reason[particle] == StopReason::ImpactsReached as i8;
        assert!(!reached || count == run.impacts);
    }
}

fn all_stopped_for(records: &Records, reason: StopReason) -> bool {
    records.stop_reason.iter().all(|&r| r == reason as i8)
}

/// Nothing else stops a nearly elastic, nearly round body early.
#[test]
fn the_number_of_impacts_is_reached() {
    let run = paper(0.1, law(0.98, 1.0));
    let records = simulate(&run);
    assert!(all_stopped_for(&records, StopReason::ImpactsReached));
    is_consistent(&run, &records);
}

/// The first impact sets it spinning, and the next flight takes so long that the axis would turn by more than 2²⁰ rad.
#[test]
fn a_body_from_too_high_never_lands() {
    let run = Run {
        release_height: 3e6.into(),
        ..paper(0.1, law(0.98, 1.0))
    };
    let records = simulate(&run);
    assert!(all_stopped_for(&records, StopReason::NeverLands));
    assert!(records.impacts.iter().all(|&count| count >= 1));
    is_consistent(&run, &records);
}

/// And so does one that spins fast enough before the first.
#[test]
fn a_body_that_spins_too_fast_never_lands() {
    let body = dumbbell(1.0);
    let level = Vector::new(1.0, 0.0, 0.0);
    let spin = Vector::new(0.0, 1e6, 0.0);
    let release = State::with_spin(&body, 20.0, Vector::default(), level, spin);
    let (impacts, reason) = trajectory(&body, &law(0.9, 1.0), release, 10);
    assert_eq!((impacts.len(), reason), (0, StopReason::NeverLands));
}

/// No impact is asked for, and none is told.
#[test]
fn a_trajectory_without_impacts_ends() {
    let body = dumbbell(1.0);
    let release = at_rest(&body, 20.0, 0.3);
    let (impacts, reason) = trajectory(&body, &law(0.9, 1.0), release, 0);
    assert_eq!((impacts.len(), reason), (0, StopReason::ImpactsReached));
}

/// A perfectly plastic sphere is hit once and stays, however it spins and flies, on a slope as on a floor: the two balls of a
/// dumbbell of no length are at the same place, and one cannot touch once more where the other rests.
#[test]
fn a_plastic_sphere_collapses_after_one_impact() {
    let spin = Spin::Random {
        low: 1.0,
        high: 1000.0,
        about: About::Isotropic,
    };
    let friction = 1.2; // enough for every slip to stop
    let coulomb = Hypothesis::NAMED.map(|(_, hypothesis)| {
        let rule = Coulomb::new(friction, hypothesis).unwrap();
        Law::new(0.0, rule).unwrap()
    });
    let chatterjee_ruina = Law::new(0.0, ChatterjeeRuina::new(0.3, friction).unwrap()).unwrap();
    let laws = [law(0.0, 1.0), law(0.0, 0.3), chatterjee_ruina];
    for law in laws.into_iter().chain(coulomb) {
        for (spin, incline) in [(Spin::NONE, 0.0), (spin, 0.0), (spin, 0.5)] {
            let run = Run {
                spin,
                incline,
                release_velocity: Vector::new(0.3 * incline, 0.2 * incline, 0.0),
                ..paper(0.0, law)
            };
            let records = simulate(&run);
            let most = records.impacts.iter().max();
            assert!(all_stopped_for(&records, StopReason::Collapse), "{law:?}");
            assert!(
                records.impacts.iter().all(|&count| count == 1),
                "{law:?}, {spin:?}, {incline}: up to {most:?}"
            );
            is_consistent(&run, &records);
        }
    }
}

/// A lossy contact closes by infinitely many impacts in a finite time. For a sphere the clock tells when, t₁(1 + ε)/(1 − ε); a
/// longer body is left rocking on one sphere. The last flights are those in which no gap can exceed 2⁻⁴³ R, as gaps that
/// bend by at least g do within 10⁻⁶ √(R/g).
#[test]
fn lossy_bodies_collapse_in_finite_time() {
    for elongation in [0.0, 0.1, 2.0, 3.0] {
        let run = Run {
            impacts: 3000,
            ..paper(elongation, law(0.5, 0.0))
        };
        let records = simulate(&run);
        assert!(all_stopped_for(&records, StopReason::Collapse));
        is_consistent(&run, &records);
        for particle in 0..run.particles {
            let last = particle * run.impacts + records.impacts[particle] as usize - 1;
            if elongation == 0.0 {
                let end = 3.0 * records.time[particle * run.impacts];
                assert!((records.time[last] - end).abs() < 1e-6 * end);
            }
            let unresolved = COLLAPSE_RUN as usize;
            let pause = records.time[last] - records.time[last - unresolved];
            assert!(pause <= f64::from(COLLAPSE_RUN) * 1e-6 * (3e-3_f64 / 9.81).sqrt());
        }
    }
}

/// The impact after which the kinetic energy first is below m v²/2 is the last, whatever v; no other threshold applies.
#[test]
fn the_speed_threshold_is_obeyed_exactly() {
    let body = dumbbell(0.5);
    let law = law(0.9, 0.3);
    let release = at_rest(&body, 20.0, 0.7);
    let speed = |impact: &Impact| (2.0 * impact.after.kinetic_energy(&body)).sqrt();
    let (free, _) = trajectory(&body, &law, release, 200);
    for minimum_speed in [5.0, 2.0, 1.0, 0.6] {
        let mut all: Vec<Impact> = Vec::new();
        let limits = Limits {
            impacts: 200,
            minimum_speed,
            settled: 0.0,
        };
        let reason = restitution_core::trajectory(&body, &law, 0.0, release, limits, |impact| {
            all.push(*impact);
            true
        });
        assert_eq!(reason, Ok(StopReason::SpeedBelowThreshold));
        let (last, earlier) = all.split_last().unwrap();
        assert!(speed(last) < minimum_speed);
        assert!(earlier.iter().all(|impact| speed(impact) >= minimum_speed));
        // The threshold only ends the trajectory; it does not change it.
        assert_eq!(all, free[..all.len()]);
    }
}

/// The same threshold in SI units: v = v*·√(gR) ends every particle at the same impact.
#[test]
fn the_threshold_is_a_speed_in_metres_per_second() {
    let angles: Vec<f64> = (0..40).map(|i| 0.02 + 0.075 * f64::from(i)).collect();
    let run = Run {
        particles: angles.len(),
        impacts: 300,
        orientation: Orientation::Given(&angles),
        minimum_speed: 0.2,
        settled: 0.0,
        ..paper(0.5, law(0.9, 0.3))
    };
    let records = simulate(&run);
    assert!(all_stopped_for(&records, StopReason::SpeedBelowThreshold));
    is_consistent(&run, &records);
    let body = run.body.revolution().unwrap().scaled;
    let threshold = 0.2 / (9.81_f64 * 3e-3).sqrt();
    for (particle, &angle) in angles.iter().enumerate() {
        let release = at_rest(&body, run.release_height.middle() / 3e-3, angle);
        let (free, _) = trajectory(&body, &run.law, release, 300);
        let slow =
            |impact: &Impact| 2.0 * impact.after.kinetic_energy(&body) < threshold * threshold;
        let first = free.iter().position(slow).unwrap();
        // The platform's sine put this release elsewhere in the last bit; chaos needs longer than this to see it.
        assert_eq!(records.impacts[particle] as usize, first + 1);
    }
}

/// A run that is cancelled before it begins has nothing to show.
#[test]
fn a_run_cancelled_at_once_is_empty() {
    let run = paper(0.1, law(0.98, 1.0));
    let monitor = Monitor::default();
    monitor.cancel();
    let records = simulate_on(&run, 2, &monitor);
    assert_eq!(records.particles(), 0);
    is_consistent(&run, &records);
}

/// Cancelled on the way: the particles that were done are whole, and have the bits of an undisturbed run; those cut
/// short say how far they got, and the table ends with the last one that was begun.
#[test]
fn what_was_finished_before_a_cancellation_is_kept() {
    let run = Run {
        particles: 4000,
        impacts: 400,
        ..paper(0.1, law(0.98, 1.0))
    };
    let monitor = Monitor::default();
    let records = std::thread::scope(|scope| {
        let worker = scope.spawn(|| simulate_on(&run, 2, &monitor));
        while monitor.finished() < 100 && !worker.is_finished() {
            std::thread::yield_now();
        }
        monitor.cancel();
        worker.join().unwrap()
    });
    is_consistent(&run, &records);
    let done = |i: &usize| records.stop_reason[*i] != StopReason::Interrupted as i8;
    assert!((0..records.particles()).filter(done).count() >= 100);
    let undisturbed = simulate(&run);
    for particle in 0..records.particles() {
        let first = particle * run.impacts;
        for i in first..first + records.impacts[particle] as usize {
            assert_eq!(
                records.restitution[i].to_bits(),
                undisturbed.restitution[i].to_bits()
            );
        }
    }
}

/// Whoever records a trajectory may end it.
#[test]
fn the_recorder_may_stop() {
    let body = dumbbell(0.1);
    let limits = Limits {
        impacts: 100,
        minimum_speed: 0.0,
        settled: 0.0,
    };
    let mut count = 0;
    let reason = restitution_core::trajectory(
        &body,
        &law(0.98, 1.0),
        0.0,
        at_rest(&body, 20.0, 0.7),
        limits,
        |_| {
            count += 1;
            count < 7
        },
    );
    assert_eq!((count, reason), (7, Ok(StopReason::Interrupted)));
}
