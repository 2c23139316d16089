//! Boxes.

use super::rigid::homogeneous;
use super::{BodyKind, Form, check_length};
use crate::describe::{Arguments, Kind, Parameter};
use crate::math::Vector;

/// Its entry in the table of bodies.
pub(super) const BOX: BodyKind = BodyKind::Rigid(Kind {
    name: "Box",
    text: "cuboid",
    parameters: homogeneous![
        Parameter::length("a", "edge along x of the body", 8e-3).linked("edge_x"),
        Parameter::length("b", "edge along y of the body", 6e-3).linked("edge_y"),
        Parameter::length("c", "edge along z of the body", 4e-3).linked("edge_z"),
    ],
    make: |given| {
        let edges = [0, 1, 2].map(|i| given.number(i));
        for (name, edge) in ["a", "b", "c"].into_iter().zip(edges) {
            check_length(name, edge)?;
        }
        Ok(Form::Faces(corners(edges), FACES.to_vec()))
    },
});

/// The corners about the centre of a box with these edges.
pub(super) fn corners(edges: [f64; 3]) -> Vec<Vector> {
    let side = |corner: usize, axis: usize| {
        let half = 0.5 * edges[axis];
        if corner & (4 >> axis) == 0 {
            -half
        } else {
            half
        }
    };
    (0..8)
        .map(|i| Vector::new(side(i, 0), side(i, 1), side(i, 2)))
        .collect()
}

/// Two triangles each.
#[rustfmt::skip]
const FACES: [[usize; 3]; 12] = [
    [0, 1, 3], [0, 3, 2], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 3, 7], [1, 7, 5],
];
