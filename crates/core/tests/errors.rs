//! A parameter outside its range is an error that names it, and says what is allowed.

use crate::common::*;
use restitution_core::statistics::{Axis, Bins, By};
use restitution_core::{
    About, ChatterjeeRuina, Coulomb, Dumbbell, Error, Frictionless, Height, Hypothesis, Law, Level,
    LoadedSphere, Monitor, Orientation, Plastic, Resources, Run, Spherocylinder, Spheroid, Spin,
    Tabulated, TangentialRestitution, Vector, Viscoelastic,
};

/// The name of the parameter that is wrong; its value must be in the message, too.
fn culprit(error: &Error) -> &'static str {
    let (name, value, allowed) = match error {
        Error::Parameter {
            name,
            value,
            allowed,
        } => (name, value, allowed.as_str()),
        Error::Magnitude {
            name,
            value,
            allowed,
        } => (name, value, *allowed),
        _ => panic!("{error}"),
    };
    assert_eq!(
        error.to_string(),
        format!("{name} = {value}: must be {allowed}")
    );
    name
}

const NOT_POSITIVE: [f64; 6] = [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const NOT_FINITE: [f64; 4] = [-1e-300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn bodies() {
    for x in NOT_POSITIVE {
        assert_eq!(culprit(&Dumbbell::new(x, 0.1, 1.0).unwrap_err()), "radius");
        assert_eq!(culprit(&Dumbbell::new(1.0, 0.1, x).unwrap_err()), "density");
    }
    for x in NOT_FINITE {
        assert_eq!(
            culprit(&Dumbbell::new(1.0, x, 1.0).unwrap_err()),
            "separation"
        );
    }
    assert!(Dumbbell::new(1.0, 0.0, 1.0).is_ok());
    // Inertia is ~ R⁵: beyond the range of doubles, and the error says so instead of giving infinities.
    for radius in [1e-70, 1e70] {
        assert_eq!(
            culprit(&Dumbbell::new(radius, 0.0, 1.0).unwrap_err()),
            "radius"
        );
    }
}

#[test]
fn other_shapes() {
    let dumbbell = |radius, density| culprit(&Dumbbell::unequal(radius, 1.0, density).unwrap_err());
    let loaded = |[r, d, m, x]: [f64; 4]| culprit(&LoadedSphere::new(r, d, m, x).unwrap_err());
    let cylinder = |[r, l, d]: [f64; 3]| culprit(&Spherocylinder::new(r, l, d).unwrap_err());
    let spheroid = |[a, c, d]: [f64; 3]| culprit(&Spheroid::new(a, c, d).unwrap_err());
    for x in NOT_POSITIVE {
        assert_eq!(dumbbell([1.0, x], [1.0, 1.0]), "radius");
        assert_eq!(dumbbell([1.0, 2.0], [x, 1.0]), "density");
        assert_eq!(loaded([x, 1.0, 1.0, 0.0]), "radius");
        assert_eq!(loaded([1.0, x, 1.0, 0.0]), "density");
        assert_eq!(cylinder([x, 1.0, 1.0]), "radius");
        assert_eq!(cylinder([1.0, 1.0, x]), "density");
        assert_eq!(spheroid([x, 1.0, 1.0]), "equatorial");
        assert_eq!(spheroid([1.0, x, 1.0]), "polar");
        assert_eq!(spheroid([1.0, 1.0, x]), "density");
    }
    for x in NOT_FINITE {
        assert_eq!(loaded([1.0, 1.0, x, 0.0]), "load");
        assert_eq!(loaded([1.0, 1.0, 1.0, x]), "offset");
        assert_eq!(cylinder([1.0, x, 1.0]), "separation");
    }
    // A load outside its sphere; needles and discs beyond what the contact can be located on.
    assert_eq!(loaded([1.0, 1.0, 1.0, 1.0_f64.next_up()]), "offset");
    assert_eq!(spheroid([1.0, 1000.001, 1.0]), "polar");
    assert_eq!(spheroid([1.0, 0.000_999_999, 1.0]), "polar");
    assert!(Spheroid::new(3e-3, 3.0, 1.0).is_ok() && Spheroid::new(3.0, 3e-3, 1.0).is_ok());
    for size in [1e-70, 1e70] {
        assert_eq!(dumbbell([size; 2], [1.0, 2.0]), "radius");
        assert_eq!(loaded([size, 1.0, 0.0, 0.0]), "radius");
        assert_eq!(cylinder([size, 1.0, 1.0]), "radius");
        assert_eq!(spheroid([size, size, 1.0]), "equatorial");
    }
    // A load that outweighs the sphere beyond what doubles can tell leaves nothing to turn.
    assert_eq!(loaded([1.0, 1e-300, 1e300, 0.5]), "radius");
}

#[test]
fn laws() {
    for x in [-0.1, -1e-300, 1.0_f64.next_up(), f64::NAN, f64::INFINITY] {
        assert_eq!(culprit(&Law::new(x, Frictionless).unwrap_err()), "normal");
    }
    for x in [
        (-1.0_f64).next_down(),
        1.0_f64.next_up(),
        f64::NAN,
        f64::NEG_INFINITY,
    ] {
        assert_eq!(
            culprit(&TangentialRestitution::new(x).unwrap_err()),
            "tangential"
        );
    }
    for (normal, tangential) in [(0.0, -1.0), (1.0, 1.0), (-0.0, -0.0)] {
        assert!(TangentialRestitution::new(tangential).is_ok());
        assert!(Law::new(normal, Frictionless).is_ok());
    }
    for x in [-1e-300, 1e101, f64::NAN, f64::INFINITY] {
        let coulomb = Coulomb::new(x, Hypothesis::Stronge);
        assert_eq!(culprit(&coulomb.unwrap_err()), "friction");
        let bilinear = ChatterjeeRuina::new(0.0, x);
        assert_eq!(culprit(&bilinear.unwrap_err()), "friction");
    }
    assert_eq!(
        culprit(&ChatterjeeRuina::new(1.1, 0.0).unwrap_err()),
        "tangential"
    );
}

/// Parameters of materials, and those that are finite but make none that is.
#[test]
fn materials() {
    let good = [6e10, 0.2, 1e-6, 2500.0, 3e-3];
    let names = [
        "young_modulus",
        "poisson_ratio",
        "dissipation",
        "density",
        "radius",
    ];
    let viscoelastic = |[y, nu, a, rho, r]: [f64; 5]| Viscoelastic::new(y, nu, a, rho, r);
    assert!(viscoelastic(good).is_ok());
    for (i, name) in names.into_iter().enumerate() {
        for wrong in [-1.0, f64::NAN, f64::INFINITY] {
            let mut parameters = good;
            parameters[i] = wrong;
            assert_eq!(culprit(&viscoelastic(parameters).unwrap_err()), name);
        }
    }
    let stiff = viscoelastic([1e300, 0.2, 1e-6, 1e-300, 1e-3]);
    assert_eq!(culprit(&stiff.unwrap_err()), "young_modulus");
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(culprit(&Plastic::new(wrong).unwrap_err()), "yield_speed");
    }
    for speeds in [&[][..], &[0.1, 0.1], &[-0.1, 0.1], &[0.1, f64::NAN]] {
        let values = vec![0.5; speeds.len()];
        assert_eq!(culprit(&Tabulated::new(speeds, &values).unwrap_err()), "v");
    }
    for values in [&[0.5][..], &[0.5, 1.1], &[0.5, f64::NAN]] {
        let table = Tabulated::new(&[0.1, 0.2], values);
        assert_eq!(culprit(&table.unwrap_err()), "e");
    }
}

/// Names that nobody knows are refused with those that there are.
#[test]
fn names() {
    for (error, text) in [
        (
            Hypothesis::named("Newton").unwrap_err(),
            "hypothesis = 'Newton': must be 'stronge' or 'poisson' or 'newton'",
        ),
        (
            About::named("").unwrap_err(),
            "axis = '': must be 'isotropic' or 'horizontal' or 'across'",
        ),
        (
            Orientation::named("random").unwrap_err(),
            "orientation = 'random': must be 'uniform-angle' or 'isotropic'",
        ),
    ] {
        assert_eq!(error.to_string(), text);
    }
    for (name, hypothesis) in Hypothesis::NAMED {
        assert_eq!(Hypothesis::named(name).unwrap(), hypothesis);
    }
}

#[test]
fn runs() {
    let run = || paper(0.1, law(0.9, 1.0));
    let name = |run: Run<'_>| culprit(&error_of(&run));
    for gravity in NOT_POSITIVE {
        assert_eq!(name(Run { gravity, ..run() }), "gravity");
    }
    for gravity in [f64::MIN_POSITIVE * f64::EPSILON, f64::MAX] {
        assert_eq!(
            name(Run {
                gravity,
                body: Dumbbell::new(1e20, 0.0, 1.0).unwrap().into(),
                release_height: 1e21.into(),
                ..run()
            }),
            "gravity"
        );
    }
    // gR or R/g has three digits left: the motion would be off by as much.
    for gravity in [1e-270, 1e270] {
        assert_eq!(
            name(Run {
                gravity,
                body: Dumbbell::new(1e-50, 0.0, 1.0).unwrap().into(),
                release_height: 1e-49.into(),
                ..run()
            }),
            "gravity"
        );
    }
    assert_eq!(
        name(Run {
            particles: 0,
            ..run()
        }),
        "particles"
    );
    assert_eq!(
        name(Run {
            impacts: 0,
            ..run()
        }),
        "impacts"
    );
    for minimum_speed in NOT_FINITE {
        assert_eq!(
            name(Run {
                minimum_speed,
                ..run()
            }),
            "minimum_speed"
        );
    }
    // The lower sphere of a body on end must be clear of the plane.
    let lowest = 3e-3 + 1.5e-4;
    for release_height in [
        f64::NAN,
        f64::INFINITY,
        -1.0,
        0.0,
        3e-3,
        lowest * (1.0 - 1e-12),
    ] {
        assert_eq!(
            name(Run {
                release_height: release_height.into(),
                ..run()
            }),
            "release_height"
        );
    }
}

#[test]
fn angles() {
    fn run(angles: &[f64]) -> Run<'_> {
        Run {
            particles: 3,
            orientation: Orientation::Given(angles),
            ..paper(0.1, law(0.9, 1.0))
        }
    }
    for wrong in [f64::NAN, f64::INFINITY, 1_048_576.0_f64.next_up(), -1e300] {
        let angles = [0.0, wrong, 0.0];
        assert!(culprit(&error_of(&run(&angles))).contains("angle"));
    }
    assert!(culprit(&error_of(&run(&[0.0, 1.0]))).contains("angles"));
    // A tilted body may be let go from lower than one on end.
    let lying = [1.5, 1.6, 1.7];
    let release_height = 3e-3 + 2e-5;
    simulate(&Run {
        release_height: release_height.into(),
        ..run(&lying)
    });
    let one_on_end = [1.5, 0.0, 1.7];
    assert_eq!(
        culprit(&error_of(&Run {
            release_height: release_height.into(),
            ..run(&one_on_end)
        })),
        "release_height"
    );
}

/// Random heights and spins, on both sides of their limits: 10¹⁰⁰ √(g/R), a tenth of it for the mean of a distribution that has no end.
#[test]
fn releases() {
    let run = || paper(0.1, law(0.9, 1.0));
    let of = |run: Run<'_>| culprit(&error_of(&run));
    let lowest = 0.05;
    for highest in [0.04, f64::INFINITY, f64::NAN] {
        let release_height = Height::Random { lowest, highest };
        let run = Run {
            release_height,
            ..run()
        };
        assert_eq!(of(run), "release_height");
    }
    let most = 1e100 * (run().gravity / run().body.unit()).sqrt();
    let about = About::Isotropic;
    let fixed = |x| Spin::Fixed(Vector::new(0.0, x, 0.0));
    let random = |low, high| Spin::Random { low, high, about };
    let thermal = |rate| Spin::Thermal { rate };
    for (spin, name) in [
        (fixed(1.001 * most), "spin"),
        (fixed(-1.001 * most), "spin"),
        (fixed(f64::NAN), "spin"),
        (Spin::Given(&[[1.0; 3]; 99]), "number of spins"),
        (Spin::Given(&[[f64::NAN; 3]; 100]), "spin"),
        (random(-1.0, 1.0), "rate"),
        (random(2.0, 1.0), "rate"),
        (random(0.0, 1.001 * most), "rate"),
        (thermal(-1.0), "rate"),
        (thermal(0.1001 * most), "rate"),
        (thermal(f64::NAN), "rate"),
    ] {
        assert_eq!(of(Run { spin, ..run() }), name, "{spin:?}");
    }
    for spin in [
        fixed(0.999 * most),
        random(1.0, 0.999 * most),
        thermal(0.0999 * most),
    ] {
        simulate(&Run { spin, ..run() });
    }
    for velocity in [-1.001, 1.001, f64::NAN] {
        let most = 1e100 * (run().gravity * run().body.unit()).sqrt();
        for release_velocity in [
            Vector::new(velocity * most, 0.0, 0.0),
            Vector::new(0.0, velocity * most, 0.0),
            Vector::new(0.0, 0.0, velocity * most),
        ] {
            let run = Run {
                release_velocity,
                ..run()
            };
            assert_eq!(of(run), "release_velocity");
        }
    }
    for incline in [-1e-9, std::f64::consts::FRAC_PI_2, f64::NAN] {
        assert_eq!(of(Run { incline, ..run() }), "incline");
    }
}

#[test]
fn bins() {
    let axis = |edges: &[f64]| Axis::new("edges", edges).unwrap();
    let fine: Vec<f64> = (0..=1 << 10).map(f64::from).collect();
    let of = |rows: usize, restitution: &[f64], fraction: &[f64]| {
        let bins = Bins {
            by: By::Number(rows),
            restitution: axis(restitution),
            fraction: Some(axis(fraction)),
        };
        let resources = Resources {
            threads: 1,
            level: Level::best(),
        };
        let run = paper(0.1, law(0.9, 1.0));
        culprit(
            &run.statistics(&bins, resources, &Monitor::default())
                .unwrap_err(),
        )
    };
    let coarse = [0.0, 1.0];
    assert_eq!(of(1, &coarse, &coarse), "impacts");
    // Sites are numbered with 32 bits: four of them, or 1027, in each row.
    assert_eq!(
        of(1 << 30, &coarse, &coarse),
        "sites of the grid of restitution_bins"
    );
    assert_eq!(
        of(1 << 22, &fine, &coarse),
        "sites of the grid of restitution_bins"
    );
    assert_eq!(
        of(1 << 22, &coarse, &fine),
        "sites of the grid of fraction_bins"
    );
}
