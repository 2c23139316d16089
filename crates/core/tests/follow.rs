//! One particle of a run, followed by itself.

use crate::common::*;
use crate::scalar::Observed;
use restitution_core::{
    About, AnyBody, Followed, LoadedSphere, Orientation, Run, Sphere, Spheroid, Spin, Vector,
};

fn bodies() -> [AnyBody<'static>; 3] {
    [
        paper(2.0, law(1.0, 1.0)).body,
        LoadedSphere::new(3e-3, 2500.0, 1e-4, 2e-3).unwrap().into(),
        Spheroid::new(3e-3, 5e-3, 2500.0).unwrap().into(),
    ]
}

/// The axis in the x–z plane, which spin or velocity may leave.
const IN_THE_PLANE: [[f64; 2]; 9] = [[1.0, 0.0]; 9];

/// At rest, or with one of spin, throw and incline.
fn releases(body: AnyBody<'static>) -> [Run<'static>; 7] {
    let rest = Run {
        body,
        particles: 9,
        impacts: 12,
        orientation: Orientation::Isotropic,
        ..paper(0.0, law(0.6, 0.3))
    };
    let spin = |about| Spin::Random {
        low: 10.0,
        high: 90.0,
        about,
    };
    let thrown = |velocity| Run {
        release_velocity: velocity,
        ..rest
    };
    [
        rest,
        Run {
            spin: spin(About::Isotropic),
            ..rest
        },
        Run {
            orientation: Orientation::Directions(&IN_THE_PLANE),
            spin: spin(About::Across),
            ..rest
        },
        Run {
            orientation: Orientation::Directions(&IN_THE_PLANE),
            ..thrown(Vector::new(0.0, 0.2, 0.4))
        },
        thrown(Vector::new(0.0, 0.2, 0.4)),
        thrown(Vector::new(0.0, 0.0, -0.4)),
        Run {
            incline: 0.3,
            ..rest
        },
    ]
}

/// Its impacts are those that the particle has in the run, and it ends as there, to the last bit: it moves in a plane exactly
/// where the run does.
#[test]
fn a_followed_particle_has_the_impacts_of_its_run() {
    for run in bodies().into_iter().flat_map(releases) {
        let records = simulate(&run);
        for particle in 0..run.particles {
            let followed = Followed::new(&run, particle).unwrap();
            let scales = &followed.scales;
            let first = particle * run.impacts;
            let mut number = 0;
            let reason = followed.bounce(|impact| {
                let i = first + number;
                number += 1;
                assert_eq!(records.time[i], scales.time * impact.time);
                let fall = scales.speed * impact.impact_velocity();
                assert_eq!(records.impact_velocity[i], fall);
                assert_eq!(records.restitution[i], impact.restitution());
                let touched = if impact.sphere == Sphere::One { 1 } else { 2 };
                assert_eq!(records.contact[i], touched);
                true
            });
            assert_eq!(records.impacts[particle], number as i64);
            assert_eq!(records.stop_reason[particle], reason.unwrap() as i8);
        }
    }
}

/// There is no particle beyond those of the run.
#[test]
fn a_particle_that_the_run_has_not_is_refused() {
    let run = paper(1.0, law(0.6, 0.3));
    assert!(Followed::new(&run, run.particles - 1).is_ok());
    assert!(Followed::new(&run, run.particles).is_err());
}
