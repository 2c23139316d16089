//! Bodies of revolution in both loops: in the lanes, which know their axis, and as a body of any shape, one particle at a time.

use restitution_core::{
    AnyBody, ChatterjeeRuina, Coulomb, Dumbbell, Frictionless, Hypothesis, Inertia, Law,
    LoadedSphere, Matter, Monitor, Orientation, Resources, Rigid, RigidBall, Rule, Run, Solid,
    Spherocylinder, Spheroid, Spin, Symmetric, TangentialRestitution, Vector,
};

/// The body as one of any shape, whose surface has been made without its axis; of balls there are their places on it and their radii.
fn rigid(solid: &Solid, balls: &[[f64; 2]], semi_axes: [f64; 3]) -> Rigid {
    let (across, along) = (solid.transverse_inertia, solid.axial_inertia);
    let inertia = Inertia {
        mass: solid.mass,
        centre: Vector::new(0.0, 0.0, solid.centre_of_mass),
        tensor: Symmetric::diagonal([across, across, along]),
    };
    let ball = |&[place, radius]: &[f64; 2]| RigidBall {
        centre: Vector::new(0.0, 0.0, place),
        radius,
    };
    let balls: Vec<_> = balls.iter().map(ball).collect();
    let surface = if balls.is_empty() {
        Rigid::ellipsoid(semi_axes, 1.0)
    } else {
        Rigid::clump(&balls, 1.0, Matter::Sum)
    };
    surface.unwrap().with_inertia(inertia).unwrap()
}

/// The same impacts: times, ε, energies, and sliding speeds of both, as far as rounding, which grows from impact to impact, leaves them.
#[test]
fn both_loops_have_the_same_impacts() {
    let r = 3e-3;
    let equal = Dumbbell::new(r, 0.7 * r, 2500.0).unwrap().into();
    let unequal = Dumbbell::unequal([r, 0.6 * r], r, [2500.0, 4000.0]);
    let capsule = Spherocylinder::new(r, r, 2500.0).unwrap().into();
    let loaded = LoadedSphere::new(r, 2500.0, 2e-4, 0.5 * r).unwrap().into();
    let bodies: [(Solid, Vec<[f64; 2]>, [f64; 3]); 6] = [
        (equal, vec![[0.35 * r, r], [-0.35 * r, r]], [0.0; 3]),
        (
            unequal.unwrap().into(),
            vec![[0.5 * r, r], [-0.5 * r, 0.6 * r]],
            [0.0; 3],
        ),
        (capsule, vec![[0.5 * r, r], [-0.5 * r, r]], [0.0; 3]),
        (loaded, vec![[0.0, r]], [0.0; 3]),
        (
            Spheroid::new(r, 0.4 * r, 2500.0).unwrap().into(),
            vec![],
            [r, r, 0.4 * r],
        ),
        (
            Spheroid::new(r, 2.5 * r, 2500.0).unwrap().into(),
            vec![],
            [r, r, 2.5 * r],
        ),
    ];
    let coulomb = |friction: f64| Coulomb::new(friction, Hypothesis::Stronge).unwrap();
    let rules: [Rule; 5] = [
        Frictionless.into(),
        TangentialRestitution::new(0.5).unwrap().into(),
        coulomb(0.05).into(),
        coulomb(0.5).into(),
        ChatterjeeRuina::new(0.3, 0.2).unwrap().into(),
    ];
    let mut compared = 0;
    for (solid, balls, semi_axes) in &bodies {
        let twin = rigid(solid, balls, *semi_axes);
        for rule in rules {
            let run = |body| Run {
                body,
                law: Law::new(0.9, rule).unwrap(),
                particles: 30,
                impacts: 3,
                release_height: 0.05.into(),
                orientation: Orientation::Isotropic,
                spin: Spin::Random {
                    low: 5.0,
                    high: 80.0,
                    about: restitution_core::About::Isotropic,
                },
                release_velocity: Vector::new(0.2, 0.1, 0.0),
                incline: 0.1,
                ..Run::default()
            };
            let [lanes, loop_] = [AnyBody::Revolution(*solid), AnyBody::Rigid(&twin)].map(|body| {
                run(body)
                    .simulate(Resources::default(), &Monitor::default())
                    .unwrap()
            });
            for name in [
                "time",
                "impact_velocity",
                "rebound_velocity",
                "restitution",
                "rotational_fraction",
                "energy_ratio",
            ] {
                let (one, other) = (lanes.numbers(name), loop_.numbers(name));
                assert_eq!(one.len(), other.len());
                for (i, (a, b)) in one.iter().zip(&other).enumerate() {
                    let error = (a - b).abs() / (1.0 + a.abs());
                    assert!(
                        error < 1e-9,
                        "{name} of impact {i}: {a}, {b} of {solid:?} with {rule:?}"
                    );
                    compared += 1;
                }
            }
        }
    }
    assert_eq!(compared, 6 * 5 * 90 * 6);
}
