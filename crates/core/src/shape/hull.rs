//! The convex hull of points: its faces, cut into triangles that do not depend on how it was found.
//!
//! C. B. Barber, D. P. Dobkin and H. Huhdanpaa, The quickhull algorithm for convex hulls, ACM Trans. Math. Softw. 22, 469 (1996).

use crate::math::Vector;
use std::collections::{HashMap, HashSet};

/// Triangles of a hull are one face if their corners are this close to its plane, and a corner is none if it makes a smaller area with its
/// neighbours, both relative to the size of the hull.
const COPLANAR: f64 = 1e-12;
const COLLINEAR: f64 = 1e-14;

/// A triangle of the hull, counter-clockwise from outside.
struct Face {
    corners: [usize; 3],
    /// The triangles beyond the edges from each corner to the next.
    beyond: [usize; 3],
    /// Across it, twice its area long.
    normal: Vector,
    /// The unit vector.
    up: Vector,
    /// Points above it that no other triangle has.
    outside: Vec<usize>,
    is_gone: bool,
}

/// The hull while points are added to it.
struct Quickhull<'a> {
    points: &'a [Vector],
    faces: Vec<Face>,
    /// The distance by which rounding alone puts a point above a face.
    tolerance: f64,
}

impl Quickhull<'_> {
    fn add(&mut self, corners: [usize; 3], beyond: [usize; 3]) -> usize {
        let [a, b, c] = corners.map(|i| self.points[i]);
        let normal = (b - a).cross(c - a);
        self.faces.push(Face {
            corners,
            beyond,
            normal,
            up: normal / normal.norm().max(f64::MIN_POSITIVE),
            outside: Vec::new(),
            is_gone: false,
        });
        self.faces.len() - 1
    }

    fn height(&self, face: usize, point: usize) -> f64 {
        let Face { corners, up, .. } = &self.faces[face];
        (self.points[point] - self.points[corners[0]]).dot(*up)
    }

    /// Gives points to those of some faces that they are highest above.
    fn give(&mut self, points: Vec<usize>, faces: &[usize]) {
        for point in points {
            let mut most = (self.tolerance, None);
            for &face in faces {
                let height = self.height(face, point);
                if height > most.0 {
                    most = (height, Some(face));
                }
            }
            if let Some(face) = most.1 {
                self.faces[face].outside.push(point);
            }
        }
    }

    /// The tetrahedron of points far apart; none if all lie in a plane.
    fn first(&mut self) -> Option<()> {
        let count = self.points.len();
        let farthest = |distance: &dyn Fn(Vector) -> f64| {
            (0..count).max_by(|&i, &j| {
                let [i, j] = [i, j].map(|i| distance(self.points[i]));
                i.total_cmp(&j)
            })
        };
        let axes: [fn(Vector) -> f64; 3] = [|p| p.x, |p| p.y, |p| p.z];
        let ends = axes.map(|axis| Some([farthest(&axis)?, farthest(&|p| -axis(p))?]));
        let (mut a, mut b) = (0, 0);
        for [i, j] in ends.into_iter().flatten() {
            let apart = |i: usize, j: usize| (self.points[i] - self.points[j]).norm();
            if apart(i, j) > apart(a, b) {
                (a, b) = (i, j);
            }
        }
        let from = self.points[a];
        let along = self.points[b] - from;
        let c = farthest(&|p| (p - from).cross(along).norm())?;
        let across = along.cross(self.points[c] - from);
        let up = across / across.norm().max(f64::MIN_POSITIVE);
        let d = farthest(&|p| (p - from).dot(up).abs())?;
        let height = (self.points[d] - from).dot(up);
        if height.abs() <= self.tolerance || across.norm() <= self.tolerance {
            return None;
        }
        let (b, c) = if height < 0.0 { (b, c) } else { (c, b) };
        self.add([a, b, c], [1, 2, 3]);
        self.add([d, b, a], [2, 0, 3]);
        self.add([d, c, b], [3, 0, 1]);
        self.add([d, a, c], [1, 0, 2]);
        self.give((0..count).collect(), &[0, 1, 2, 3]);
        Some(())
    }

    /// Replaces the faces that a point sees by a cone from the point.
    fn extend(&mut self, eye: usize, seen: usize) {
        let mut horizon = Vec::new();
        let mut lost = std::mem::take(&mut self.faces[seen].outside);
        self.faces[seen].is_gone = true;
        // Faces with the edge to look over next and the number of those left: depth first, so that the horizon goes round.
        let mut stack = vec![(seen, 0, 3)];
        while let Some((face, edge, left)) = stack.pop() {
            if left == 0 {
                continue;
            }
            stack.push((face, (edge + 1) % 3, left - 1));
            let next = self.faces[face].beyond[edge];
            if self.faces[next].is_gone {
                continue;
            }
            let back = self.edge_to(next, face);
            if self.height(next, eye) > self.tolerance {
                self.faces[next].is_gone = true;
                lost.append(&mut self.faces[next].outside);
                stack.push((next, (back + 1) % 3, 2));
            } else {
                let Face { corners, .. } = self.faces[face];
                horizon.push(([corners[edge], corners[(edge + 1) % 3]], next, back));
            }
        }
        let first = self.faces.len();
        let count = horizon.len();
        for (k, ([from, to], next, back)) in horizon.into_iter().enumerate() {
            let (after, before) = ((k + 1) % count, (k + count - 1) % count);
            let face = self.add([from, to, eye], [next, first + after, first + before]);
            self.faces[next].beyond[back] = face;
        }
        let new: Vec<_> = (first..self.faces.len()).collect();
        lost.retain(|&point| point != eye);
        self.give(lost, &new);
    }

    fn edge_to(&self, face: usize, other: usize) -> usize {
        let beyond = self.faces[face].beyond.iter();
        beyond.clone().position(|&next| next == other).unwrap_or(0)
    }
}

/// The faces of the convex hull of points as triangles of their numbers, each and all in ascending order: fans from the first corner of each
/// face. None if the points lie in a plane, or are no numbers.
pub fn triangles(points: &[Vector]) -> Option<Vec<[usize; 3]>> {
    let from = *points.first()?;
    let extent = |axis: fn(&Vector) -> f64| {
        let along = || points.iter().map(axis);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    let size = extent(|p| p.x).max(extent(|p| p.y)).max(extent(|p| p.z));
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let places: Vec<_> = points.iter().map(|&point| (point - from) / size).collect();
    let mut hull = Quickhull {
        points: &places,
        faces: Vec::new(),
        tolerance: 16.0 * f64::EPSILON,
    };
    hull.first()?;
    let mut face = 0;
    while face < hull.faces.len() {
        let one = &hull.faces[face];
        if one.is_gone || one.outside.is_empty() {
            face += 1;
            continue;
        }
        let height = |&i: &usize| hull.height(face, i);
        let highest = one.outside.iter().copied();
        let eye = highest.max_by(|i, j| height(i).total_cmp(&height(j)))?;
        hull.extend(eye, face);
    }
    // Of points at the same place the first counts.
    let mut numbers = HashMap::new();
    let bits = |p: Vector| [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits());
    for (number, &place) in places.iter().enumerate() {
        numbers.entry(bits(place)).or_insert(number);
    }
    let area = |&face: &usize| hull.faces[face].normal.norm();
    let left = (0..hull.faces.len()).filter(|&face| !hull.faces[face].is_gone);
    let mut order: Vec<_> = left.clone().filter(|face| area(face) > 0.0).collect();
    order.sort_by(|i, j| area(j).total_cmp(&area(i)));
    let mut free: HashSet<_> = left.collect();
    let mut found = Vec::new();
    for seed in order {
        if !free.remove(&seed) {
            continue;
        }
        let up = hull.faces[seed].up;
        let flat = |face: usize| {
            let face = &hull.faces[face];
            let within = |&i: &usize| hull.height(seed, i).abs() < COPLANAR;
            face.corners.iter().all(within) && face.normal.dot(up) > -COPLANAR
        };
        let mut one = vec![seed];
        let mut at = 0;
        while at < one.len() {
            for next in hull.faces[one[at]].beyond {
                if free.contains(&next) && flat(next) {
                    free.remove(&next);
                    one.push(next);
                }
            }
            at += 1;
        }
        let corners = |&face: &usize| hull.faces[face].corners.map(|i| numbers[&bits(places[i])]);
        let one: Vec<_> = one.iter().map(corners).collect();
        found.extend(fan(&places, up, &one));
    }
    found.sort_unstable();
    Some(found)
}

/// A face, given as any triangles of it, cut anew.
fn fan(places: &[Vector], up: Vector, face: &[[usize; 3]]) -> Vec<[usize; 3]> {
    let sorted = |mut corners: [usize; 3]| {
        corners.sort_unstable();
        corners
    };
    let edges: HashSet<_> = face
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .collect();
    let open = edges.iter().filter(|&&[a, b]| !edges.contains(&[b, a]));
    let after: HashMap<_, _> = open.map(|&[a, b]| (a, b)).collect();
    let Some(&least) = after.keys().min().filter(|_| face.len() > 1) else {
        // Or a needle so thin that all of it is one face.
        return face.iter().copied().map(sorted).collect();
    };
    let mut around = vec![least];
    while let Some(&next) = after.get(&around[around.len() - 1]) {
        if around.len() == after.len() {
            break;
        }
        around.push(next);
    }
    let count = around.len();
    let place = |k: usize| places[around[k % count]];
    let turn = |k: usize| {
        let side = place(k) - place(k + count - 1);
        side.cross(place(k + 1) - place(k)).dot(up)
    };
    let mut kept: Vec<_> = (0..count)
        .filter(|&k| turn(k) > COLLINEAR)
        .map(|k| around[k])
        .collect();
    let Some(first) = (0..kept.len()).min_by_key(|&k| kept[k]) else {
        return Vec::new();
    };
    kept.rotate_left(first);
    kept[1..]
        .windows(2)
        .map(|edge| sorted([kept[0], edge[0], edge[1]]))
        .collect()
}
