//! The SIMD engine against the oracle, the three-dimensional scalar engine: the same bits, at every level.

use restitution_core::{
    ChatterjeeRuina, Coulomb, Dumbbell, Frictionless, Hypothesis, Impact, Law, Level, Limits,
    Means, Monitor, Normal, Orientation, Plastic, Records, Run, Scales, Spin, StopReason,
    Tabulated, TangentialRestitution, Vector, Viscoelastic, bounce,
};

fn run(elongation: f64, law: Law<'_>, particles: usize, impacts: usize) -> Run<'_> {
    let radius = 3e-3;
    Run {
        body: Dumbbell::new(radius, elongation * radius, 2500.0)
            .unwrap()
            .into(),
        law,
        particles,
        impacts,
        release_height: 0.06,
        gravity: 9.81,
        orientation: Orientation::UniformAngle,
        minimum_speed: 0.0,
        spin: Spin::NONE,
        velocity: Vector::default(),
        incline: 0.0,
        seed: 11,
    }
}

fn at(run: &Run<'_>, level: Level, threads: usize) -> Records {
    run.simulate(Means { threads, level }, &Monitor::default())
        .unwrap()
}

fn same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|(a, b)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()))
}

/// Bounces particle after particle with the oracle and compares every number of every impact.
fn agrees_with_the_oracle(run: &Run<'_>) {
    let scales = Scales::new(run.body.unit, run.gravity).unwrap();
    let body = run.body.scaled;
    let lanes = at(run, Level::best(), 0);
    for particle in 0..run.particles {
        let release = run.orientation.release(
            &body,
            run.release_height / scales.length,
            run.seed,
            particle as u64,
        );
        let limits = Limits {
            impacts: run.impacts,
            minimum_speed: run.minimum_speed / scales.speed,
        };
        let mut i = particle * run.impacts;
        let reason = bounce(
            &body,
            &run.law.scaled(&scales),
            0.0,
            release,
            limits,
            |impact: &Impact| {
                let expected = [
                    impact.time * scales.time,
                    impact.impact_velocity() * scales.speed,
                    impact.rebound_velocity() * scales.speed,
                    impact.restitution(),
                    impact.rotational_fraction(&body),
                    impact.energy_ratio(&body),
                    impact.before.angle(),
                ];
                let found = [
                    lanes.time[i],
                    lanes.impact_velocity[i],
                    lanes.rebound_velocity[i],
                    lanes.restitution[i],
                    lanes.rotational_fraction[i],
                    lanes.energy_ratio[i],
                    lanes.angle[i],
                ];
                assert!(
                    same(&expected, &found),
                    "particle {particle}, impact {}: {expected:?} {found:?}",
                    i - particle * run.impacts
                );
                assert_eq!(lanes.contact[i], impact.sphere as i8 + 1);
                i += 1;
                true
            },
        )
        .unwrap();
        assert_eq!(lanes.impacts[particle] as usize, i - particle * run.impacts);
        assert_eq!(lanes.stop_reason[particle], reason as i8);
    }
}

/// Every kind of motion: nearly round to separate spheres, elastic to plastic, all tangential laws.
#[test]
fn the_lanes_are_the_oracle_to_the_bit() {
    for elongation in [0.0, 1e-3, 0.02, 0.1, 0.5, 1.0, 2.0, 3.5] {
        for normal in [0.0, 0.4, 0.9, 0.98, 1.0] {
            for tangential in [-1.0, -0.3, 0.0, 0.7, 1.0] {
                let law = TangentialRestitution::new(normal, tangential)
                    .unwrap()
                    .into();
                agrees_with_the_oracle(&run(elongation, law, 70, 120));
            }
        }
    }
}

/// The other laws, and coefficients that depend on the speed.
#[test]
fn every_law_is_the_same_in_lanes() {
    let glass = Viscoelastic::new(6e10, 0.2, 1e-6, 2500.0, 3e-3).unwrap();
    let (speeds, values) = ([0.01, 0.1, 0.3, 1.0], [1.0, 0.95, 0.97, 0.8]);
    let normals = [
        Normal::from(0.9),
        glass.into(),
        Plastic::new(0.05).unwrap().into(),
        Tabulated::new(&speeds, &values).unwrap().into(),
    ];
    for normal in normals {
        let mut laws: Vec<Law<'_>> = vec![
            TangentialRestitution::new(normal, 0.5).unwrap().into(),
            Frictionless::new(normal).unwrap().into(),
            ChatterjeeRuina::new(normal, 0.2, 0.3).unwrap().into(),
        ];
        for hypothesis in [Hypothesis::Stronge, Hypothesis::Poisson, Hypothesis::Newton] {
            laws.push(Coulomb::new(normal, 0.3, hypothesis).unwrap().into());
            laws.push(Coulomb::new(normal, 1.5, hypothesis).unwrap().into());
        }
        for law in laws {
            for elongation in [0.0, 0.1, 1.0, 3.5] {
                agrees_with_the_oracle(&run(elongation, law, 70, 120));
            }
        }
    }
}

/// The bits must not depend on the vector width, the number of threads or on what else is in the run.
#[test]
fn every_level_and_thread_count_gives_the_same_bits() {
    let law = TangentialRestitution::new(0.9, 0.5).unwrap().into();
    let run = Run {
        minimum_speed: 0.05,
        ..run(0.5, law, 333, 200)
    };
    let reference = at(&run, Level::Scalar, 1);
    assert!(
        reference
            .stop_reason
            .contains(&(StopReason::SpeedBelowThreshold as i8))
    );
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        for threads in [1, 2, 7] {
            let other = at(&run, level, threads);
            assert!(
                same(&reference.time, &other.time),
                "{level:?}, {threads} threads"
            );
            assert!(same(&reference.restitution, &other.restitution));
            assert!(same(&reference.angle, &other.angle));
            assert_eq!(reference.contact, other.contact);
            assert_eq!(reference.impacts, other.impacts);
            assert_eq!(reference.stop_reason, other.stop_reason);
        }
    }
}
