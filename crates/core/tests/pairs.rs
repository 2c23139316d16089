//! Encounters of two bodies in free flight.

use rand_philox::philox4x32_10;
use restitution_core::pair::{
    Encounters, Ending, Hit, Meeting, PairState, PairTable, Partner, Trouble, encounter,
};
use restitution_core::{
    AnyBody, Coulomb, Dumbbell, Fault, Frictionless, Hypothesis, ImpulseFunction, Law, Level,
    LoadedSphere, Material, Matter, Monitor, Quaternion, Resources, Rigid, RigidBall, Scattered,
    Spheroid, TangentialRestitution, Vector, Viscoelastic,
};

/// Of mass 1 and R = 1.
fn dumbbell(separation: f64) -> Partner {
    use restitution_core::Shape;
    let mass = Dumbbell::new(1.0, separation, 1.0).unwrap().solid().mass;
    let body = Dumbbell::new(1.0, separation, 1.0 / mass).unwrap();
    Partner::new("body", AnyBody::from(body)).unwrap()
}

/// A spheroid with these semi-axes across and along its axis, and mass 1.
fn spheroid([across, along]: [f64; 2]) -> Partner {
    use restitution_core::Shape;
    let mass = Spheroid::new(across, along, 1.0).unwrap().solid().mass;
    let body = Spheroid::new(across, along, 1.0 / mass).unwrap();
    Partner::new("body", AnyBody::from(body)).unwrap()
}

fn of_balls(balls: &[[f64; 4]]) -> Partner {
    let ball = |&[x, y, z, radius]: &[f64; 4]| RigidBall {
        centre: Vector::new(x, y, z),
        radius,
    };
    let balls: Vec<_> = balls.iter().map(ball).collect();
    let body = Rigid::clump(&balls, 0.1, Matter::Sum).unwrap();
    Partner::new("body", AnyBody::from(&body)).unwrap()
}

/// Four balls, without any symmetry.
fn clump() -> Partner {
    of_balls(&[
        [0.6, 0.6, 0.6, 0.8],
        [0.6, -0.6, -0.6, 0.8],
        [-0.6, 0.6, -0.6, 0.7],
        [-0.6, -0.6, 0.6, 0.5],
    ])
}

/// Balls at the corners of a tetrahedron, whose moments of inertia are equal.
fn tetrahedron() -> Partner {
    of_balls(&[
        [0.6, 0.6, 0.6, 0.7],
        [0.6, -0.6, -0.6, 0.7],
        [-0.6, 0.6, -0.6, 0.7],
        [-0.6, -0.6, 0.6, 0.7],
    ])
}

/// Balls at the corners of a square; two moments of inertia are equal.
fn square() -> Partner {
    of_balls(&[
        [0.8, 0.0, 0.0, 0.6],
        [-0.8, 0.0, 0.0, 0.6],
        [0.0, 0.8, 0.0, 0.6],
        [0.0, -0.8, 0.0, 0.6],
    ])
}

/// A law of one's own whose impulse is no number.
struct NoNumber;

impl ImpulseFunction for NoNumber {
    fn name(&self) -> &'static str {
        "NoNumber"
    }

    fn may_pull(&self) -> bool {
        true
    }

    fn impulse(&self, _: [[f64; 3]; 3], _: Vector) -> Result<Vector, Fault> {
        Ok(Vector::new(0.0, 0.0, f64::NAN))
    }
}

/// Two of each kind of convex part: an ellipsoid, a spherocylinder, a box and a cylinder.
fn convex() -> [Partner; 4] {
    use restitution_core::{Spherocylinder, Spheroid};
    let of = |body: AnyBody<'_>| Partner::new("body", body).unwrap();
    let corner = |i: usize| {
        let side = |axis: usize, half: f64| if i >> axis & 1 == 1 { half } else { -half };
        Vector::new(side(0, 1.0), side(1, 0.8), side(2, 0.6))
    };
    let corners: Vec<_> = (0..8).map(corner).collect();
    let faces = restitution_core::convex_hull(&corners).unwrap();
    let outline = [[1.0, 0.0], [1.0, 0.7], [-1.0, 0.7], [-1.0, 0.0]];
    [
        of(Spheroid::new(1.0, 2.0, 0.1).unwrap().into()),
        of(Spherocylinder::new(0.5, 2.0, 0.4).unwrap().into()),
        of(AnyBody::from(
            &Rigid::polyhedron(&corners, &faces, 0.1).unwrap(),
        )),
        of(AnyBody::from(&Rigid::revolution(&outline, 0.2).unwrap())),
    ]
}

/// Every pair of these bodies, with each other and with a dumbbell and a plane: gaps along the exact rotation are not negative and are 0 at the first
/// contact, momenta and energy stay, and the points of contact approach.
#[test]
fn convex_bodies_meet() {
    let (convex, balls, plane) = (convex(), dumbbell(1.0), Partner::plane());
    let law = frictionless(1.0);
    for (i, one) in convex.iter().enumerate() {
        for two in convex[i..].iter().chain([&balls, &plane]) {
            let bodies = [one, two];
            let run = drawn(bodies, 12);
            let table = record(&run, &law, 1, Level::best());
            for states in table.states("before") {
                let (found, hits) = follow(bodies, &law, states);
                let end = hits.first().map_or(found.time, |hit| hit.time);
                for k in 0..=40 {
                    let time = end * f64::from(k) / 40.0;
                    let later: [PairState; 2] = std::array::from_fn(|i| {
                        if bodies[i].is_plane() {
                            states[i]
                        } else {
                            bodies[i].later(&states[i], time)
                        }
                    });
                    let width = restitution_core::pair::narrowest(bodies, &later);
                    assert!(width > -1e-12, "{width} at {time} of {end}");
                    assert!(k < 40 || hits.is_empty() || width < 1e-12);
                }
                assert!(hits.iter().all(|hit| hit.speeds[0] >= 0.0));
                if two.is_plane() {
                    continue;
                }
                let [was, is] = [&states, &found.states].map(|states| momenta(bodies, states));
                for (was, is) in was.into_iter().zip(is) {
                    assert!((was - is).norm() < 1e-12 * (1.0 + found.time) * (1.0 + was.norm()));
                }
                let [was, is] = [&states, &found.states].map(|states| energy(bodies, states));
                assert!((is / was - 1.0).abs() < 1e-12);
            }
        }
    }
}

fn frictionless(normal: f64) -> Law<'static> {
    Law::new(normal, Frictionless).unwrap()
}

fn drawn<'a>(bodies: [&'a Partner; 2], count: usize) -> Encounters<'a> {
    Encounters {
        bodies,
        first: 0,
        count,
        meeting: Meeting::Temperatures([1.0, 0.5]),
        impact_parameter: None,
        rotational: [1.0, 2.0],
        spin: None,
        seed: 5,
    }
}

fn record(run: &Encounters<'_>, law: &Law<'_>, threads: usize, level: Level) -> PairTable {
    let resources = Resources { threads, level };
    run.record(law, None, [true; 2], resources, &Monitor::default())
        .unwrap()
}

fn momenta(bodies: [&Partner; 2], states: &[PairState; 2]) -> [Vector; 2] {
    let mut sums = [Vector::default(); 2];
    for (body, state) in bodies.into_iter().zip(states) {
        let momentum = state.velocity * body.mass();
        sums[0] = sums[0] + momentum;
        sums[1] = sums[1] + state.position.cross(momentum) + angular_momentum(body, state);
    }
    sums
}

/// About the centre of mass, in the axes of space.
fn angular_momentum(body: &Partner, state: &PairState) -> Vector {
    let principal = state.attitude * body.axes();
    let Vector { x, y, z } = principal.inverse().rotate(state.spin);
    let [a, b, c] = body.moments();
    principal.rotate(Vector::new(a * x, b * y, c * z))
}

fn energy(bodies: [&Partner; 2], states: &[PairState; 2]) -> f64 {
    let of = |(body, state): (&Partner, &PairState)| {
        0.5 * body.mass() * state.velocity.dot(state.velocity)
            + body.rotational_energy(state.attitude, state.spin)
    };
    bodies.into_iter().zip(states).map(of).sum()
}

fn follow(
    bodies: [&Partner; 2],
    law: &Law<'_>,
    states: [PairState; 2],
) -> (restitution_core::pair::Outcome, Vec<Hit>) {
    let mut hits = Vec::new();
    let found = encounter(bodies, law, states, |_| 0.5, |hit| hits.push(*hit)).unwrap();
    (found, hits)
}

/// Momentum and angular momentum stay, and without losses the energy does.
#[test]
fn an_encounter_keeps_what_it_must() {
    let (one, two, three) = (dumbbell(1.0), dumbbell(0.3), clump());
    let sticky = Law::new(0.7, TangentialRestitution::new(-0.3).unwrap()).unwrap();
    for bodies in [[&one, &one], [&one, &two], [&three, &one], [&three, &three]] {
        for (law, elastic) in [(frictionless(1.0), true), (sticky, false)] {
            let run = drawn(bodies, 400);
            let table = record(&run, &law, 1, Level::best());
            let contacts = table.numbers("contacts");
            let mut touched = 0;
            for (states, number) in table.states("before").into_iter().zip(contacts) {
                let (found, hits) = follow(bodies, &law, states);
                assert_eq!(found.contacts as usize, hits.len());
                assert_eq!(found.contacts as f64, number);
                touched += usize::from(found.contacts > 0);
                let [was, is] = [&states, &found.states].map(|states| momenta(bodies, states));
                for (was, is) in was.into_iter().zip(is) {
                    assert!((was - is).norm() < 1e-12 * (1.0 + found.time) * (1.0 + was.norm()));
                }
                let [was, is] = [&states, &found.states].map(|states| energy(bodies, states));
                assert!(!elastic || (is / was - 1.0).abs() < 1e-12);
            }
            assert!(touched > 200);
        }
    }
}

/// Two spheres meet where their distance is the sum of the radii, and a sphere without friction does not turn.
#[test]
fn spheres_follow_the_closed_form() {
    let sphere = dumbbell(0.0);
    let run = drawn([&sphere; 2], 1000);
    let law = frictionless(0.6);
    let table = record(&run, &law, 1, Level::best());
    for states in table.states("before") {
        let (found, hits) = follow([&sphere; 2], &law, states);
        let [hit] = hits[..] else { panic!("{hits:?}") };
        let apart = states[0].position - states[1].position;
        let u = states[0].velocity - states[1].velocity;
        let n = apart / apart.norm();
        assert!((hit.normal - n).norm() < 1e-12);
        let later = u - n * (1.6 * u.dot(n));
        let got = found.states[0].velocity - found.states[1].velocity;
        assert!((got - later).norm() < 1e-12 * u.norm());
        for (state, was) in found.states.iter().zip(&states) {
            assert!((state.spin - was.spin).norm() < 1e-14 * was.spin.norm());
        }
    }
}

/// With ε = 1 every encounter runs backwards from its end to its beginning.
#[test]
fn time_can_run_backwards() {
    let (one, three) = (dumbbell(1.0), clump());
    let law = frictionless(1.0);
    let mut several = 0;
    for bodies in [[&one, &one], [&three, &one]] {
        let run = drawn(bodies, 600);
        let table = record(&run, &law, 1, Level::best());
        for states in table.states("before") {
            let (there, _) = follow(bodies, &law, states);
            if there.contacts == 0 || there.ending == Ending::Collapse {
                continue;
            }
            several += i32::from(there.contacts > 1);
            let turned = there.states.map(|state| PairState {
                velocity: state.velocity * -1.0,
                spin: state.spin * -1.0,
                ..state
            });
            let (back, _) = follow(bodies, &law, turned);
            assert_eq!(back.contacts, there.contacts);
            let error = [0, 1].map(|i| {
                (back.states[i].velocity + states[i].velocity).norm()
                    + (back.states[i].position - states[i].position).norm()
            });
            // A grazing contact multiplies rounding errors by its reciprocal speed.
            assert!(error[0] + error[1] < 1e-7, "{error:?}");
        }
    }
    assert!(several > 15);
}

/// Gaps that are sampled densely, along the exact rotation, are never negative before a contact, and are 0 there.
#[test]
fn nothing_touches_before_the_first_contact() {
    let (one, three) = (dumbbell(2.0), clump());
    let law = frictionless(0.9);
    for bodies in [[&one, &one], [&three, &three]] {
        let run = drawn(bodies, 100);
        let table = record(&run, &law, 1, Level::best());
        for states in table.states("before") {
            let (found, hits) = follow(bodies, &law, states);
            let end = hits.first().map_or(found.time, |hit| hit.time);
            for k in 0..=200 {
                let time = end * f64::from(k) / 200.0;
                let later: [PairState; 2] =
                    std::array::from_fn(|i| bodies[i].later(&states[i], time));
                let width = restitution_core::pair::narrowest(bodies, &later);
                assert!(width > -1e-12, "{width} at {time} of {end}");
                assert!(k < 200 || hits.is_empty() || width < 1e-12);
            }
        }
    }
}

/// Neither threads nor vectors show.
#[test]
fn any_number_of_threads_gives_the_same_encounters() {
    let (one, two, three) = (dumbbell(1.0), dumbbell(0.1), clump());
    for (bodies, spin) in [
        ([&three, &one], 1.0),
        ([&three, &three], 1.0),
        ([&three, &three], 0.0),
        ([&one, &two], 1.0),
    ] {
        let mut run = drawn(bodies, 600);
        run.rotational[0] *= spin;
        let law = frictionless(0.8);
        let first = record(&run, &law, 1, Level::Scalar);
        for (threads, level) in Level::available().enumerate() {
            let again = record(&run, &law, threads + 1, level);
            // As texts, in which NaN is NaN and -0 is not 0.
            assert!(format!("{first:?}") == format!("{again:?}"));
        }
    }
}

/// Of a body on a plane the impulse is that of the plane, and its attitude uniform: each falls on it once at least.
#[test]
fn a_plane_is_hit_by_everything() {
    let (one, plane) = (dumbbell(1.0), Partner::plane());
    let run = drawn([&one, &plane], 1000);
    let table = record(&run, &frictionless(0.9), 1, Level::best());
    assert!(
        table
            .numbers("contacts")
            .iter()
            .all(|&number| number >= 1.0)
    );
    for hit in &table.hits {
        assert_eq!(hit.normal.parts(), [0.0, 0.0, 1.0]);
        assert!(hit.point.z.abs() < 1e-12 && hit.impulse.z > 0.0);
        assert!((hit.speeds[1] / hit.speeds[0] - 0.9).abs() < 1e-12);
    }
}

/// A law of one's own whose impulse is no number, and friction at a slip so fast that its size overflows: no state of NaN goes on.
#[test]
fn an_impulse_that_is_no_number_ends_an_encounter() {
    let (ball, plane) = (dumbbell(0.0), Partner::plane());
    let friction = Coulomb::new(0.3, Hypothesis::Stronge).unwrap();
    let at = |z: f64, speed: f64| PairState {
        position: Vector::new(0.0, 0.0, z),
        velocity: Vector::new(speed, 0.0, -speed),
        attitude: Quaternion::IDENTITY,
        spin: Vector::default(),
    };
    let end = |law: &Law<'_>, speed: f64| {
        let states = [at(2.0, speed), at(0.0, 0.0)];
        encounter([&ball, &plane], law, states, |_| 0.5, |_| ())
    };
    let sound = Law::new(0.9, friction).unwrap();
    assert_eq!(end(&sound, 1.0).unwrap().contacts, 1);
    assert_eq!(end(&sound, 1e308), Err(Trouble::Unconverged));
    let own = end(&Law::custom(&NoNumber), 1.0);
    assert!(matches!(own, Err(Trouble::Fault(Fault::NotFinite(_)))));
}

/// Balls and spheroids without friction, which are followed in lanes, end as those that are followed one by one: dumbbells of any aspect ratio, a sphere
/// whose centre of mass is not at its centre, spheres, long and flat spheroids, clumps with three, two or one moment of inertia; with coefficients that depend on
/// the speed or scatter, where contacts accumulate, and where the bodies do not turn at first.
#[test]
fn lanes_follow_what_one_by_one_follows() {
    let loaded = LoadedSphere::new(0.7, 0.3, 0.4, 0.3).unwrap();
    let loaded = Partner::new("body", AnyBody::from(loaded)).unwrap();
    let bodies = [
        dumbbell(0.0),
        dumbbell(0.1),
        dumbbell(1.0),
        dumbbell(4.0),
        loaded,
        spheroid([1.0, 2.0]),
        spheroid([1.5, 0.5]),
        clump(),
        square(),
        tetrahedron(),
    ];
    let material = Viscoelastic::new(1e6, 0.3, 1e-3, 1e3, 0.01).unwrap();
    let scattered = Material::Scattered(Scattered::new(0.8.into(), 0.1).unwrap());
    let laws = [
        frictionless(1.0),
        frictionless(0.0),
        Law::new(material, Frictionless).unwrap(),
        Law::of(&scattered, Frictionless.into()),
    ];
    for (i, one) in bodies.iter().enumerate() {
        for two in &bodies[i..] {
            for (number, law) in laws.iter().enumerate() {
                let mut run = drawn([one, two], 150);
                if number == 2 {
                    run.rotational = [0.0; 2];
                }
                let table = record(&run, law, 1, Level::best());
                let mut hits = table.hits.iter();
                let [contacts, endings, durations] =
                    ["contacts", "ending", "duration"].map(|name| table.numbers(name));
                let (before, after) = (table.states("before"), table.states("after"));
                for (number, after) in after.iter().enumerate() {
                    // A uniform number in (0, 1) with 53 random bits, of counter (encounter, contact, 2).
                    let chance = |contact: u64| {
                        let counter = [number as u32, 0, contact as u32, 2];
                        let [low, high, ..] = philox4x32_10(counter, [run.seed as u32, 0]);
                        let bits = u64::from(high) << 21 | u64::from(low) >> 11;
                        (bits as f64 + 0.5) * 2.0_f64.powi(-53)
                    };
                    let mut own = Vec::new();
                    let add = |hit: &Hit| {
                        own.truncate(hit.number as usize);
                        own.push(*hit);
                    };
                    let found = encounter([one, two], law, before[number], chance, add).unwrap();
                    assert_eq!(contacts[number], found.contacts as f64);
                    assert_eq!(endings[number], f64::from(found.ending as u8));
                    // What a search leaves grows with each contact that follows.
                    let allowed = 1e-11 * 4.0_f64.powi(found.contacts as i32);
                    let near = |a: f64, b: f64| {
                        assert!((a - b).abs() < allowed * (1.0 + b.abs()), "{a} {b}");
                    };
                    let near_to = |a: Vector, b: Vector| {
                        (0..3).for_each(|k| near(a.parts()[k], b.parts()[k]));
                    };
                    near(durations[number], found.time);
                    for hit in &own[..found.contacts as usize] {
                        let recorded = hits.next().unwrap();
                        near(recorded.time, hit.time);
                        near_to(recorded.normal, hit.normal);
                        near_to(recorded.point, hit.point);
                        near_to(recorded.impulse, hit.impulse);
                        (0..2).for_each(|k| near(recorded.speeds[k], hit.speeds[k]));
                    }
                    for (recorded, state) in after.iter().zip(&found.states) {
                        near_to(recorded.velocity, state.velocity);
                        near_to(recorded.spin, state.spin);
                        near_to(recorded.position, state.position);
                        let (a, b) = (recorded.attitude.parts(), state.attitude.parts());
                        let along: f64 = (0..4).map(|k| a[k] * b[k]).sum();
                        near(along.abs(), 1.0);
                    }
                }
            }
        }
    }
}
