//! Bodies that are no equal dumbbells: their tables are the oracle's, and their statistics those of their tables.

use crate::common::*;
use crate::oracle::World;
use crate::oracle::compare::{Case, Start};
use crate::oracle::impact::Rule;
use crate::oracle::normal::Restitution;
use crate::oracle::solid::Shape;
use restitution_core::statistics::{Axis, Bins, By};
use restitution_core::{
    AnyBody, Dumbbell, Level, LoadedSphere, Monitor, Orientation, Resources, Run, Spheroid, Spin,
    StopReason,
};

const MEANS: Resources = Resources {
    threads: 2,
    level: Level::Scalar,
};

fn bodies() -> [AnyBody<'static>; 3] {
    [
        Dumbbell::unequal([3e-3, 2e-3], 4e-3, [2500.0, 7800.0])
            .unwrap()
            .into(),
        LoadedSphere::new(3e-3, 2500.0, 1e-4, 2e-3).unwrap().into(),
        Spheroid::new(3e-3, 5e-3, 2500.0).unwrap().into(),
    ]
}

fn run(body: AnyBody<'static>) -> Run<'static> {
    Run {
        body,
        law: law(0.6, 0.3),
        particles: 150,
        impacts: 60,
        orientation: Orientation::Isotropic,
        minimum_speed: 0.02,
        settled: 0.0,
        ..paper(0.0, law(0.6, 0.3))
    }
}

/// Every number of the table is the oracle's; particles that end early leave blanks.
#[test]
fn the_table_holds_what_the_oracle_says() {
    let radius = 3e-3;
    let shapes = [
        Shape::Dumbbell {
            radius: [radius, 2e-3],
            separation: 4e-3,
            density: [2500.0, 7800.0],
        },
        Shape::LoadedSphere {
            radius,
            density: 2500.0,
            load: 1e-4,
            offset: 2e-3,
        },
        Shape::Spheroid {
            equatorial: radius,
            polar: 5e-3,
            density: 2500.0,
        },
    ];
    for shape in shapes {
        let case = Case {
            world: World {
                shape,
                rule: Rule::Tangential { tangential: 0.3 },
                normal: Restitution::Constant(0.6),
                gravity: 9.81,
                incline: 0.0,
                minimum_speed: 0.02,
            },
            height: 0.06,
            velocity: [0.0; 3],
            start: Start::Drawn(150, Orientation::Isotropic, Spin::NONE),
            impacts: 60,
            seed: 2014,
        };
        let records = case.records(MEANS);
        let seen = case.compare(&records);
        let seen = seen.unwrap_or_else(|why| panic!("{why}: {shape:?}"));
        assert!(seen.impacts > 1000 && seen.ends > 0, "{seen:?}");
        for particle in 0..records.particles() {
            let rows = case.impacts * particle..case.impacts * (particle + 1);
            let rest = rows.skip(records.impacts[particle] as usize);
            for number in rest {
                let blank = |(_, column): &(_, &[f64])| column[number].is_nan();
                assert!(columns(&records).iter().all(blank));
                assert_eq!(records.contact[number], 0);
            }
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
        let records = Records::from(run.simulate(MEANS, &Monitor::default()).unwrap());
        let axis = |edges: &[f64]| Axis::new("edges", edges).unwrap();
        let bins = Bins {
            by: By::Number(run.impacts),
            restitution: axis(&[-1.0, 0.0, 1.0]),
            fraction: Some(axis(&[0.0, 0.5, 1.0])),
        };
        let histogram = run.statistics(&bins, MEANS, &Monitor::default()).unwrap();
        let counted: u64 = (0..run.impacts).map(|row| histogram.rows.number(row)).sum();
        assert_eq!(counted, records.impacts.iter().sum::<i64>() as u64);
        let stops: u64 = histogram.rows.stops.iter().sum();
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
