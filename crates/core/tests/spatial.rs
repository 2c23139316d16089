//! Particles that the lanes do not follow go through the three-dimensional engine to the same tables.

mod common;

use common::*;
use restitution_core::statistics::{Axis, Bins, By};
use restitution_core::{
    Dumbbell, Impact, Level, Limits, LoadedSphere, Means, Monitor, Orientation, Run, Scales, Solid,
    Spheroid, StopReason, bounce,
};

const MEANS: Means = Means {
    threads: 2,
    level: Level::Scalar,
};

fn bodies() -> [Solid; 3] {
    [
        Dumbbell::unequal([3e-3, 2e-3], 4e-3, [2500.0, 7800.0])
            .unwrap()
            .into(),
        LoadedSphere::new(3e-3, 2500.0, 1e-4, 2e-3).unwrap().into(),
        Spheroid::new(3e-3, 5e-3, 2500.0).unwrap().into(),
    ]
}

fn run(body: Solid) -> Run<'static> {
    Run {
        body,
        law: law(0.6, 0.3),
        particles: 150,
        impacts: 60,
        orientation: Orientation::Isotropic,
        minimum_speed: 0.02,
        ..paper(0.0, law(0.6, 0.3))
    }
}

/// Every number of the table is the oracle's, converted; particles that end early leave blanks.
#[test]
fn the_table_holds_what_the_oracle_says() {
    for body in bodies() {
        let run = run(body);
        let records = run.simulate(MEANS, &Monitor::default()).unwrap();
        let scales = Scales::new(body.unit, run.gravity).unwrap();
        let limits = Limits {
            impacts: run.impacts,
            minimum_speed: run.minimum_speed / scales.speed,
        };
        for particle in 0..run.particles {
            let height = run.release_height / scales.length;
            let release = run
                .orientation
                .release(&body.scaled, height, run.seed, particle as u64);
            let mut i = particle * run.impacts;
            let reason = bounce(
                &body.scaled,
                &run.law,
                0.0,
                release,
                limits,
                |impact: &Impact| {
                    let before = &impact.before;
                    let expected = [
                        impact.time * scales.time,
                        impact.impact_velocity() * scales.speed,
                        impact.rebound_velocity() * scales.speed,
                        impact.restitution(),
                        impact.rotational_fraction(&body.scaled),
                        impact.energy_ratio(&body.scaled),
                        before.angle(),
                    ];
                    for ((name, column), expected) in columns(&records).iter().zip(expected) {
                        assert_eq!(column[i], expected, "{name} of particle {particle}");
                    }
                    assert_eq!(records.contact[i], impact.sphere as i8 + 1);
                    i += 1;
                    true
                },
            );
            assert_eq!(records.stop_reason[particle], reason.unwrap() as i8);
            let impacts = i - particle * run.impacts;
            assert_eq!(records.impacts[particle], impacts as i64);
            let rest = i..(particle + 1) * run.impacts;
            assert!(records.time[rest.clone()].iter().all(|time| time.is_nan()));
            assert!(records.contact[rest].iter().all(|&contact| contact == 0));
        }
        let slow = StopReason::SpeedBelowThreshold as i8;
        assert!(records.stop_reason.contains(&slow));
    }
}

/// The statistics count the impacts that the table has.
#[test]
fn every_impact_is_counted() {
    for body in bodies() {
        let run = run(body);
        let records = run.simulate(MEANS, &Monitor::default()).unwrap();
        let axis = |edges: &[f64]| Axis::new("edges", edges).unwrap();
        let bins = Bins {
            by: By::Number(run.impacts),
            restitution: axis(&[-1.0, 0.0, 1.0]),
            fraction: Some(axis(&[0.0, 0.5, 1.0])),
        };
        let tally = run.statistics(&bins, MEANS, &Monitor::default()).unwrap();
        let counted: u64 = (0..run.impacts).map(|row| tally.number(row)).sum();
        assert_eq!(counted, records.impacts.iter().sum::<i64>() as u64);
        let stops: u64 = tally.stops.iter().sum();
        assert_eq!(stops, run.particles as u64);
    }
}

/// A run that is cancelled from the start has begun nothing.
#[test]
fn a_cancelled_run_ends() {
    let monitor = Monitor::default();
    monitor.cancel();
    let records = run(bodies()[2]).simulate(MEANS, &monitor).unwrap();
    assert_eq!(records.particles(), 0);
}
