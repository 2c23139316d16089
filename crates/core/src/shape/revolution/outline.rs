//! The outline of a body of revolution, from which it is drawn.

use std::f64::consts::{FRAC_PI_2, PI};

/// An arc of an ellipse whose centre is on the axis: the points `centre` + `along` cos t on the axis and `across` sin t beside it, t
/// from `from` to `to` within [0, π].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// Position of the centre on the axis, from the centre of mass, in m.
    pub centre: f64,
    /// Semi-axis along the axis, in m.
    pub along: f64,
    /// Semi-axis across the axis, in m.
    pub across: f64,
    /// The first t, in rad.
    pub from: f64,
    /// The last t, in rad.
    pub to: f64,
}

impl Arc {
    /// A whole ellipse of revolution, in two halves.
    pub(super) fn halves(centre: f64, along: f64, across: f64) -> [Self; 2] {
        [(0.0, FRAC_PI_2), (FRAC_PI_2, PI)].map(|(from, to)| Self {
            centre,
            along,
            across,
            from,
            to,
        })
    }

    /// The caps of two spheres with these centres and radii; the first ends at the first of `angles` from the axis, the second begins
    /// at the second.
    pub(super) fn caps(centres: [f64; 2], radii: [f64; 2], angles: [f64; 2]) -> [Self; 2] {
        let cap = |i: usize, from, to| Self {
            centre: centres[i],
            along: radii[i],
            across: radii[i],
            from,
            to,
        };
        [cap(0, 0.0, angles[0]), cap(1, angles[1], PI)]
    }
}
