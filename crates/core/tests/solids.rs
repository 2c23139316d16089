//! Every shape in SI units: mass, centre of mass and moments of inertia by integration over slices, and its outline from every side.

use restitution_core::{Dumbbell, LoadedSphere, Shape, Solid, Spherocylinder, Spheroid};
use std::f64::consts::PI;

/// Mass, position of the centre of mass, moments of inertia across and along the axis.
type Moments = [f64; 4];

/// Those of a solid of revolution about z, whose `slice` at z has this squared radius and this density: within a piece between two
/// `ends` a polynomial of second degree.
fn moments(ends: &[f64], slice: impl Fn(f64) -> (f64, f64)) -> Moments {
    // Five nodes of Gauss and Legendre integrate degree 9 exactly; the integrands have degree 4.
    let nodes = [
        (0.0, 128.0 / 225.0),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];
    let integral = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
        let pieces = ends.windows(2).flat_map(|ends| {
            let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
            nodes.map(|(x, weight)| (middle + half * x, half * weight))
        });
        let terms = pieces.map(|(z, weight)| {
            let (square, density) = slice(z);
            weight * density * PI * square * f(z, square)
        });
        terms.sum()
    };
    let mass = integral(&|_, _| 1.0);
    let centre = integral(&|z, _| z) / mass;
    // A disc has J = mr²/4 about a diameter, and mr²/2 about its axis.
    let across = integral(&|z, square| 0.25 * square + (z - centre).powi(2));
    [mass, centre, across, integral(&|_, square| 0.5 * square)]
}

/// What the body says of itself; lengths in the core's units must be those in SI units, and so must the inertia.
fn check(name: &str, body: impl Shape, expected: Moments) -> Solid {
    let solid = Solid::from(body);
    let [mass, centre, across, along] = expected;
    let unit = solid.unit;
    let near = |found: f64, expected: f64, what: &str| {
        let allowed = 1e-13 * expected.abs() + 1e-300;
        assert!(
            (found - expected).abs() <= allowed,
            "{name}: {what} {found:e}, not {expected:e}"
        );
    };
    near(solid.mass, mass, "mass");
    near(solid.transverse_inertia, across, "J_xx");
    near(solid.axial_inertia, along, "J_zz");
    near(
        solid.scaled.transverse,
        across / mass / unit.powi(2),
        "J_xx/(mR²)",
    );
    near(
        solid.scaled.axial,
        along / mass / unit.powi(2),
        "J_zz/(mR²)",
    );
    assert!(
        (solid.centre_of_mass - centre).abs() <= 1e-14 * unit,
        "{name}: {centre:e}"
    );
    solid
}

/// How far below the centre of mass the spheres at these places reach, of these radii, where the axis makes an angle with this
/// cosine with the normal.
fn reach(balls: &[(f64, f64)], cosine: f64) -> f64 {
    balls
        .iter()
        .map(|(place, radius)| radius - place * cosine)
        .fold(f64::MIN, f64::max)
}

/// From every side, and the largest of all, which spheres have on end.
fn check_outline(solid: &Solid, below: impl Fn(f64) -> f64) {
    let mut most = 0.0_f64;
    for i in -100..=100 {
        let cosine = f64::from(i) / 100.0;
        let lowest = solid.lowest(cosine);
        assert!((lowest - below(cosine)).abs() <= 1e-14 * solid.farthest());
        most = most.max(below(cosine));
    }
    assert!((solid.farthest() - most).abs() <= 1e-14 * most);
}

/// Spheres that overlap a little and much, touch, are apart, or hold one another; equal or not, in outline and in density.
#[test]
fn dumbbells() {
    let radii: [[f64; 2]; 3] = [[0.03, 0.02], [0.02, 0.03], [0.03, 0.03]];
    let densities = [[2500.0, 2500.0], [1000.0, 7800.0]];
    let pairs = radii
        .iter()
        .flat_map(|r| densities.iter().map(move |d| (*r, *d)));
    for (radius, density) in pairs {
        for separation in [0.0, 0.002, 0.012, 0.03, 0.049, 0.05, 0.06, 0.11] {
            let centre = [0.5 * separation, -0.5 * separation];
            let [one, two] = radius;
            let (top, bottom) = (centre[0] + one, centre[1] - two);
            let (low, high) = (centre[1] + two, centre[0] - one);
            let (ends, cut) = if one != two && (one - two).abs() >= separation {
                let (own, cut) = if one > two {
                    (0, f64::MIN)
                } else {
                    (1, f64::MAX)
                };
                (
                    vec![centre[own] - radius[own], centre[own] + radius[own]],
                    cut,
                )
            } else if low <= high {
                (vec![bottom, low, high, top], 0.5 * (low + high))
            } else {
                // Both spheres have the same slice; two hemispheres of one sphere in the middle.
                let cut = (two * two - one * one) / (2.0 * separation.max(1e-300));
                (vec![bottom, cut, top], cut)
            };
            let slice = |z: f64| {
                let i = usize::from(z < cut);
                let square = (radius[i].powi(2) - (z - centre[i]).powi(2)).max(0.0);
                (square, density[i])
            };
            let moments = moments(&ends, slice);
            let body = Dumbbell::unequal(radius, separation, density).unwrap();
            let solid = check(
                &format!("{radius:?} {density:?} {separation}"),
                body,
                moments,
            );
            assert_eq!(solid.unit, one.max(two));
            let apart = if ends.len() == 2 {
                0.0
            } else {
                0.5 * separation
            };
            assert!((solid.scaled.half_separation - apart / solid.unit).abs() < 1e-15);
            let places = [0, 1].map(|i| (centre[i] - moments[1], radius[i]));
            check_outline(&solid, |cosine| reach(&places, cosine));
        }
    }
}

#[test]
fn spherocylinders() {
    for separation in [0.0, 0.01, 0.2] {
        let (radius, half) = (0.03_f64, 0.5 * separation);
        let slice = |z: f64| (radius.powi(2) - (z.abs() - half).max(0.0).powi(2), 2500.0);
        let moments = moments(&[-half - radius, -half, half, half + radius], slice);
        let body = Spherocylinder::new(radius, separation, 2500.0).unwrap();
        let solid = check(&format!("caps {separation} apart"), body, moments);
        assert_eq!(solid.unit, radius);
        let places = [(half, radius), (-half, radius)];
        check_outline(&solid, |cosine| reach(&places, cosine));
    }
}

#[test]
fn spheroids() {
    for (a, c) in [(0.02_f64, 0.03_f64), (0.03, 0.02), (0.02, 0.02)] {
        let slice = |z: f64| (a * a * (1.0 - z * z / (c * c)), 2500.0);
        let body = Spheroid::new(a, c, 2500.0).unwrap();
        let solid = check(&format!("{a} {c}"), body, moments(&[-c, c], slice));
        assert_eq!(solid.unit, a.max(c));
        check_outline(&solid, |cosine| {
            (a * a * (1.0 - cosine * cosine) + c * c * cosine * cosine).sqrt()
        });
    }
}

/// The load adds its own share, by Steiner's theorem.
#[test]
fn loaded_spheres() {
    let radius = 0.03_f64;
    let slice = |z: f64| (radius.powi(2) - z * z, 2500.0);
    let [ball, _, across, along] = moments(&[-radius, radius], slice);
    for (load, offset) in [(0.0, 0.01), (0.1, 0.0), (0.1, 0.01), (3.0, 0.03)] {
        let mass = ball + load;
        let centre = load * offset / mass;
        let across = across + ball * centre.powi(2) + load * (offset - centre).powi(2);
        let body = LoadedSphere::new(radius, 2500.0, load, offset).unwrap();
        let moments = [mass, centre, across, along];
        let solid = check(&format!("load {load} at {offset}"), body, moments);
        assert_eq!(solid.unit, radius);
        check_outline(&solid, |cosine| reach(&[(-centre, radius)], cosine));
    }
}

/// A body may be placed on the plane up to rounding, and not below it.
#[test]
fn a_height_clears_the_plane_from_the_lowest_on() {
    let lowest = 0.07;
    assert!(Solid::clears(0.08, lowest) && Solid::clears(lowest, lowest));
    assert!(Solid::clears(lowest * (1.0 - f64::EPSILON), lowest));
    assert!(!Solid::clears(lowest * (1.0 - 8.0 * f64::EPSILON), lowest));
}

/// Spheres whose distance no digit of the motion knows, and whose square is no number, are one sphere.
#[test]
fn spheres_that_are_hardly_apart_are_one() {
    let sphere = Dumbbell::new(1.0, 0.0, 1.0).unwrap().solid().scaled;
    for separation in [1e-80, 1e-160, 1e-300, 5e-324] {
        let near = Dumbbell::new(1.0, separation, 1.0).unwrap().solid().scaled;
        let short = Spherocylinder::new(1.0, separation, 1.0)
            .unwrap()
            .solid()
            .scaled;
        assert_eq!((near, short), (sphere, sphere));
    }
}
