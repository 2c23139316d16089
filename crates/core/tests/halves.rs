//! Bodies that are the same both ways: where their centre of mass is, and which half of them touched.

use crate::common::*;
use restitution_core::{Orientation, Run, Shape, Spherocylinder, Spheroid};
use std::f64::consts::PI;

/// In the middle, by symmetry: none of them says so itself.
#[test]
fn the_centre_of_mass_of_a_symmetric_body_is_in_the_middle() {
    assert_eq!(
        Spheroid::new(2.0, 3.0, 1.0).unwrap().solid().centre_of_mass,
        0.0
    );
    assert_eq!(
        Spherocylinder::new(2.0, 3.0, 1.0)
            .unwrap()
            .solid()
            .centre_of_mass,
        0.0
    );
}

/// The axis points to half 1. Let go at rest it keeps its direction, so that the half it points away from is the lower one and
/// touches first.
#[test]
fn the_half_of_a_spheroid_that_touches_is_the_lower_one() {
    let angles = [0.3, PI - 0.3, 1.2, PI - 1.2];
    for (equatorial, polar) in [(2e-2, 3e-2), (3e-2, 2e-2)] {
        let run = Run {
            body: Spheroid::new(equatorial, polar, 2500.0).unwrap().into(),
            particles: angles.len(),
            impacts: 1,
            release_height: 0.1.into(),
            orientation: Orientation::Given(&angles),
            ..paper(0.5, law(0.9, 1.0))
        };
        assert_eq!(simulate(&run).contact, [2, 1, 2, 1]);
    }
}
