//! Solids within closed surfaces of triangles.

use super::pieces::Extent;
use super::polyhedron::{check, faces, solid, vertex};
use super::rigid::{Rigid, homogeneous, vectors};
use super::{BodyKind, Form};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::math::Vector;
use std::collections::BTreeMap;

/// Its entry in the table of bodies.
pub(super) const MESH: BodyKind = BodyKind::Rigid(Kind {
    name: "Mesh",
    text: "solid within triangles, whose hull touches",
    parameters: homogeneous![
        Parameter::new(
            "vertices",
            "corners of the triangles",
            Some("m"),
            Allowed::Rows(&["x", "y", "z"], 4, Interval::ANY),
            Argument::Numbers(&[
                0.0, 0.0, 0.0, 8e-3, 0.0, 0.0, 0.0, 6e-3, 0.0, 0.0, 0.0, 5e-3,
            ]),
        ),
        Parameter::new(
            "triangles",
            "numbers of three vertices, from 0, counter-clockwise from outside",
            None,
            Allowed::Rows(&["a", "b", "c"], 1, Interval::NOT_NEGATIVE),
            Argument::Numbers(&[0.0, 2.0, 1.0, 0.0, 1.0, 3.0, 0.0, 3.0, 2.0, 1.0, 2.0, 3.0]),
        ),
    ],
    make: |given| {
        let rows = given.numbers(1).as_chunks::<3>().0.iter();
        let triangles = rows.map(|row| row.map(|x| x as usize)).collect();
        Ok(Form::Mesh(vectors(given.numbers(0)), triangles))
    },
});

impl Rigid {
    /// The homogeneous solid within closed surfaces of triangles of points (m), each seen counter-clockwise from outside. The vertices of its
    /// convex hull can touch.
    ///
    /// # Errors
    /// As [`Rigid::polyhedron`]; and unless every edge is that of as many triangles in one direction as in the other, and the volume positive.
    pub fn mesh(points: &[Vector], triangles: &[[usize; 3]], density: f64) -> Result<Self, Error> {
        let refused = |allowed: String| Error::parameter("triangles", triangles.len(), allowed);
        check("vertices", points, triangles)?;
        if let Some(problem) = open_edge(points, triangles) {
            return Err(refused(problem));
        }
        let inertia = solid(points, triangles, |volume| volume, density).map_err(|error| {
            let allowed = "counter-clockwise as seen from outside, so that they enclose a volume; \
                           triangles[:, ::-1], or trimesh.repair.fix_inversion of a file, turns them round";
            match error {
                Error::Parameter { name: "points", .. } => refused(allowed.to_owned()),
                other => other,
            }
        })?;
        let mut corners = faces("vertices", points)?.into_flattened();
        corners.sort_unstable();
        corners.dedup();
        let vertices = corners.iter().map(|&i| vertex(&points[i]));
        Self::of_balls(inertia, "points", Extent::Other, vertices)
    }
}

/// Says where a surface ends, or turns its inside out.
fn open_edge(points: &[Vector], triangles: &[[usize; 3]]) -> Option<String> {
    let mut edges: BTreeMap<[usize; 2], (i64, Vec<usize>)> = BTreeMap::new();
    for (number, &[a, b, c]) in triangles.iter().enumerate() {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            if from != to {
                let (balance, of) = edges.entry([from.min(to), from.max(to)]).or_default();
                *balance += if from < to { 1 } else { -1 };
                of.push(number);
            }
        }
    }
    edges.retain(|_, (balance, _)| *balance != 0);
    let is_odd = |of: &[usize]| of.len() % 2 == 1;
    let odd = edges.values().filter(|(_, of)| is_odd(of)).count();
    let (ends, (_, of)) = edges.iter().find(|(_, (_, of))| odd == 0 || is_odd(of))?;
    let [a, b] = ends.map(|i| {
        let Vector { x, y, z } = points[i];
        format!("{i} ({x:?}, {y:?}, {z:?})")
    });
    let (what, count, problem) = match (odd, of.len()) {
        (0, _) => {
            let of: Vec<_> = of.iter().map(usize::to_string).collect();
            let problem = format!("has one direction in the triangles {}", of.join(" and "));
            ("oriented", edges.len(), problem)
        }
        (_, 1) => ("closed", odd, "is that of one triangle".to_owned()),
        (_, several) => ("closed", odd, format!("is that of {several} triangles")),
    };
    Some(format!(
        "a surface with each edge in one direction as often as in the other; not {what} at {count} edges, of which the first, between \
         the vertices {a} and {b}, {problem}"
    ))
}
