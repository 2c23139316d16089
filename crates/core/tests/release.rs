//! Particles let go with spin and velocity, over a plane that may be inclined.

use crate::common::*;
use crate::scalar::Observed;
use restitution_core::{
    About, AnyBody, Frictionless, Law, Level, Limits, LoadedSphere, Monitor, Orientation, Plastic,
    Resources, Run, Scales, SingleImpact, Spheroid, Spin, State, StopReason, Vector, trajectory,
};

const TUMBLING: Spin<'_> = Spin::Random {
    low: 10.0,
    high: 90.0,
    about: About::Across,
};

/// Everything at once: random spin, a throw upwards and sideways, an incline.
fn thrown<'a>(body: AnyBody<'a>, law: Law<'a>) -> Run<'a> {
    Run {
        body,
        particles: 200,
        impacts: 20,
        orientation: Orientation::Isotropic,
        spin: Spin::Random {
            low: 0.0,
            high: 300.0,
            about: About::Isotropic,
        },
        release_velocity: Vector::new(0.3, -0.2, 0.4),
        incline: 0.3,
        ..paper(0.0, law)
    }
}

fn bodies() -> [AnyBody<'static>; 4] {
    [
        paper(2.0, law(1.0, 1.0)).body,
        paper(0.0, law(1.0, 1.0)).body,
        LoadedSphere::new(3e-3, 2500.0, 1e-4, 2e-3).unwrap().into(),
        Spheroid::new(3e-3, 5e-3, 2500.0).unwrap().into(),
    ]
}

/// The state that a particle of a run is released with, from what the records say of it.
fn released(run: &Run<'_>, records: &Records, particle: usize) -> State {
    let scales = Scales::new(run.body.unit(), run.gravity * run.incline.cos()).unwrap();
    let angle = records.release_angle[particle];
    let azimuth = records.release_azimuth[particle];
    let [x, y, z] = records.release_spin[particle];
    let level = Vector::new(azimuth.cos(), azimuth.sin(), 0.0) * angle.sin();
    State::with_spin(
        &run.body.revolution().unwrap().scaled,
        run.release_height.middle() / scales.length,
        run.release_velocity / scales.speed,
        Vector::new(level.x, level.y, angle.cos()),
        Vector::new(x, y, z) * scales.time,
    )
}

/// The records say how each particle was released: from there a particle by itself has the same first impact. The angles in them are
/// good to a rounding or two, of up to 300 rad/s times 0.2 s of turning and a lever of a few R.
#[test]
fn the_records_tell_the_release() {
    for body in bodies() {
        let run = thrown(body, law(0.6, 0.3));
        let records = simulate(&run);
        let scales = Scales::new(body.unit(), run.gravity * run.incline.cos()).unwrap();
        let limits = Limits {
            impacts: 1,
            minimum_speed: 0.0,
            settled: 0.0,
        };
        for particle in 0..run.particles {
            let i = particle * run.impacts;
            let release = released(&run, &records, particle);
            let slope = run.incline.tan();
            let mut first = None;
            trajectory(
                &body.revolution().unwrap().scaled,
                &run.law,
                slope,
                release,
                limits,
                |impact: &SingleImpact| {
                    first = Some(*impact);
                    true
                },
            )
            .unwrap();
            let first = first.unwrap();
            let time = first.time * scales.time;
            assert!((records.time[i] / time - 1.0).abs() < 1e-11);
            let fall = first.impact_velocity() * scales.speed;
            assert!((records.impact_velocity[i] - fall).abs() < 1e-11);
            let ratio = first.energy_ratio(&body.revolution().unwrap().scaled);
            assert!((records.energy_ratio[i] / ratio - 1.0).abs() < 1e-9);
        }
    }
}

/// A frictionless elastic impact keeps the horizontal velocity, the angular momentum about the normal and the kinetic energy,
/// and a flight down the incline adds slope × time to the velocity. Rounding adds up over the impacts.
#[test]
fn what_a_frictionless_plane_conserves() {
    let law = Law::new(1.0, Frictionless).unwrap();
    for body in bodies() {
        let run = thrown(body, law);
        let records = simulate(&run);
        let slope = 0.4;
        for particle in 0..run.particles {
            let release = released(&run, &records, particle);
            let body = body.revolution().unwrap().scaled;
            let limits = Limits {
                impacts: run.impacts,
                minimum_speed: 0.0,
                settled: 0.0,
            };
            let (mut left, mut since, mut way) = (release, 0.0, 0.0);
            trajectory(
                &body,
                &run.law,
                slope,
                release,
                limits,
                |impact: &SingleImpact| {
                    let flight = impact.time - since;
                    let SingleImpact { before, after, .. } = *impact;
                    let small = 1e-13 * (1.0 + left.kinetic_energy(&body));
                    let gained = slope * flight;
                    assert!((before.velocity.x - left.velocity.x - gained).abs() <= small);
                    assert_eq!(before.velocity.y, left.velocity.y);
                    assert_eq!(after.velocity.x, before.velocity.x);
                    assert_eq!(after.velocity.y, before.velocity.y);
                    assert!((after.precession.z - release.precession.z).abs() <= small);
                    way = 0.5 * gained * flight + left.velocity.x * flight;
                    let fallen = left.height - before.height + slope * way;
                    let energy = left.kinetic_energy(&body) + fallen;
                    assert!((before.kinetic_energy(&body) - energy).abs() <= 10.0 * small);
                    let ratio = impact.energy_ratio(&body);
                    assert!((ratio - 1.0).abs() <= 1e-12, "{ratio}");
                    (left, since) = (after, impact.time);
                    true
                },
            )
            .unwrap();
        }
    }
}

fn same(a: &Records, b: &Records) -> bool {
    let bits = |records: &Records| {
        let numbers = columns(records).map(|(_, column)| {
            let bits = column.iter().map(|x| x.to_bits());
            bits.collect::<Vec<_>>()
        });
        (
            numbers,
            records.release_spin.clone(),
            records.release_azimuth.clone(),
        )
    };
    bits(a) == bits(b)
}

/// The schedule is not seen, and neither are the vector instructions.
#[test]
fn the_same_bits_on_any_number_of_threads() {
    for body in bodies() {
        let run = thrown(body, law(0.6, 0.3));
        let one = simulate_on(&run, 1, &Monitor::default());
        for (threads, level) in [(2, Level::best()), (3, Level::Scalar)] {
            let resources = Resources { threads, level };
            let other = Records::from(run.simulate(resources, &Monitor::default()).unwrap());
            assert!(same(&one, &other));
        }
    }
}

/// A spin of zero is none: the run goes through the lanes, and no azimuth is told.
#[test]
fn zero_is_at_rest() {
    let run = paper(0.5, law(0.9, 0.5));
    let expected = simulate(&run);
    let zeros = vec![[0.0; 3]; run.particles];
    let about = About::Horizontal;
    let (low, high) = (0.0, 0.0);
    for spin in [Spin::Given(&zeros), Spin::Random { low, high, about }] {
        let found = simulate(&Run { spin, ..run });
        assert!(same(&expected, &found));
        assert!(found.release_azimuth.is_empty() && found.release_spin.is_empty());
    }
    // From rest the azimuth is of no consequence.
    let angles = expected.release_angle.clone();
    let rows: Vec<_> = angles.iter().map(|&angle| [angle, 2.0]).collect();
    let orientation = Orientation::Given(&angles);
    let given = simulate(&Run { orientation, ..run });
    let orientation = Orientation::Directions(&rows);
    assert!(same(&given, &simulate(&Run { orientation, ..run })));
}

/// Motion in space has the numbers of planar motion in the limit of no spin: 10⁻³⁰⁰ rad/s changes none of them in the first
/// flights but by the rounding of an axis that is not in the x–z plane.
#[test]
fn hardly_any_spin() {
    let run = Run {
        impacts: 3,
        ..paper(1.5, law(0.9, 0.5))
    };
    let spin = Spin::Fixed(Vector::new(0.0, 0.0, 1e-300));
    let (rest, spun) = (simulate(&run), simulate(&Run { spin, ..run }));
    assert_eq!(spun.release_spin.len(), run.particles);
    for (a, b) in rest.impact_velocity.iter().zip(&spun.impact_velocity) {
        assert!((a - b).abs() < 1e-11, "{a} {b}");
    }
}

/// Let go on the plane and moving into it, the body meets it at once. A level one that tumbles meets it with the sphere that
/// goes down.
#[test]
fn an_impact_at_the_release() {
    let body = paper(2.0, law(1.0, 1.0)).body;
    let body = body.revolution().unwrap();
    let radius = body.unit;
    let tumble = Spin::Fixed(Vector::new(0.0, 50.0, 0.0));
    let level = [[std::f64::consts::FRAC_PI_2, 0.0]];
    let upright = [[0.0, 0.0]];
    let (down, gently) = (Vector::new(0.0, 0.0, -0.5), Vector::new(0.0, 0.0, -0.1));
    let none = Vector::default();
    for (orientation, height, spin, velocity, sphere) in [
        (&level, radius, tumble, none, 1),
        (&level, radius, tumble, gently, 1),
        (&upright, 2.0 * radius, Spin::NONE, down, 2),
        (&upright, 2.0 * radius, tumble, down, 2),
    ] {
        let run = Run {
            particles: 1,
            impacts: 2,
            orientation: Orientation::Directions(orientation),
            release_height: height.into(),
            spin,
            release_velocity: velocity,
            ..paper(2.0, Law::new(0.5, Frictionless).unwrap())
        };
        let records = simulate(&run);
        // π/2 is not level to the last bit: the sphere that comes down is 10⁻¹⁶ R up.
        assert!((0.0..1e-17).contains(&records.time[0]));
        assert_eq!(records.contact[0], sphere);
        assert!((records.impact_velocity[0] + velocity.z).abs() < 1e-16);
        // v_c^n = v_z − ω_y r_x, and K_nn = 1 + r_x²/J.
        let arm = radius * orientation[0][0].sin();
        let Spin::Fixed(spin) = spin else {
            unreachable!()
        };
        let approach = spin.y * arm - velocity.z;
        let j = body.transverse_inertia / body.mass;
        let rise = velocity.z + 1.5 * approach / (1.0 + arm * arm / j);
        assert!((records.rebound_velocity[0] - rise).abs() < 1e-13);
        assert!(records.time[1] > 0.0 || records.contact[1] != records.contact[0]);
    }
}

/// On its way up from the plane it leaves, and comes back; at rest on it, sliding or spinning like a top, it stays.
#[test]
fn from_the_plane() {
    let run = Run {
        particles: 1,
        impacts: 1,
        orientation: Orientation::Given(&[0.0]),
        ..paper(2.0, law(0.5, 1.0))
    };
    let release_height = 2.0 * run.body.unit();
    let velocity = Vector::new(0.0, 0.0, 0.7);
    let up = simulate(&Run {
        release_height: release_height.into(),
        release_velocity: velocity,
        ..run
    });
    assert!((up.time[0] / (2.0 * 0.7 / run.gravity) - 1.0).abs() < 1e-14);
    assert!((up.impact_velocity[0] - 0.7).abs() < 1e-15);
    let spin = Spin::Fixed(Vector::new(0.0, 0.0, 40.0));
    for (spin, velocity) in [
        (spin, Vector::default()),
        (Spin::NONE, Vector::new(0.3, 0.0, 0.0)),
    ] {
        let stays = simulate(&Run {
            release_height: release_height.into(),
            spin,
            release_velocity: velocity,
            ..run
        });
        assert_eq!(stays.impacts[0], 0);
        assert_eq!(stays.stop_reason[0], StopReason::Collapse as i8);
    }
}

/// An incline by α is a level plane under g cos α as long as nothing looks at what happens along it: without friction the same
/// normal motion.
#[test]
fn an_incline_weakens_gravity() {
    let frictionless = Law::new(0.8, Frictionless).unwrap();
    let run = Run {
        spin: TUMBLING,
        incline: 0.7,
        impacts: 5,
        ..paper(1.0, frictionless)
    };
    let level = Run {
        gravity: run.gravity * run.incline.cos(),
        incline: 0.0,
        ..run
    };
    let (a, b) = (simulate(&run), simulate(&level));
    for (a, b) in a.time.iter().zip(&b.time) {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
}

/// Moments of ε are summed about ε_n at the normal speed of the first impact, which is that of a sphere: it gains 2g cos α times the
/// way to the plane, whatever it is thrown with along it.
#[test]
fn the_origin_of_moments_is_the_first_restitution_of_a_sphere() {
    let fading = Law::new(Plastic::new(0.3).unwrap(), Frictionless).unwrap();
    for (velocity, incline) in [(Vector::default(), 0.0), (Vector::new(0.5, 0.2, -0.7), 0.6)] {
        let run = Run {
            particles: 1,
            impacts: 1,
            release_velocity: velocity,
            incline,
            ..paper(0.0, fading)
        };
        let records = simulate(&run);
        assert!((run.origin() - records.restitution[0]).abs() < 1e-14);
        let drop = run.release_height.middle() - run.body.unit();
        let square = velocity.z * velocity.z + 2.0 * run.gravity * incline.cos() * drop;
        assert!((records.impact_velocity[0] / square.sqrt() - 1.0).abs() < 1e-13);
    }
}
