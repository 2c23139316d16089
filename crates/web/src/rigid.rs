//! A body without an axis as a row of numbers, written by `web/src/rigid.ts` behind the parameters: its kind, its density, and what that
//! kind needs, in SI units.

use restitution_core::{Error, Heights, Matter, Rigid, RigidBall, Roughness, Top, Vector};
use restitution_core::{Inertia, Quaternion};
use std::cell::RefCell;
use std::rc::Rc;

thread_local! {
    /// The body that was made last, and its numbers: a run comes in many portions.
    static LAST: RefCell<Option<(Vec<f64>, Rc<Rigid>)>> = const { RefCell::new(None) };
}

/// The body of these numbers.
pub fn body(numbers: &[f64]) -> Result<Rc<Rigid>, Error> {
    let kept = LAST.with_borrow(|last| {
        let same = last.as_ref().filter(|(of, _)| of == numbers);
        same.map(|(_, body)| Rc::clone(body))
    });
    if let Some(body) = kept {
        return Ok(body);
    }
    let made = Rc::new(make(numbers)?);
    LAST.set(Some((numbers.to_vec(), Rc::clone(&made))));
    Ok(made)
}

fn make(numbers: &[f64]) -> Result<Rigid, Error> {
    let (&[kind, density], rest) = numbers.split_first_chunk().expect("kind and density");
    match kind as u32 {
        0 => {
            let (counts, rest) = rest.split_first_chunk::<3>().expect("three counts");
            let [points, triangles, hull] = counts.map(|count| count as usize);
            let (points, rest) = rest.split_at(3 * points);
            let (triangles, rest) = rest.split_at(3 * triangles);
            let points: Vec<_> = points.as_chunks().0.iter().map(vector).collect();
            let corners = triangles.as_chunks::<3>().0.iter();
            let triangles: Vec<_> = corners.map(|row| row.map(|i| i as usize)).collect();
            if hull == 0 {
                return Rigid::polyhedron(&points, &triangles, density);
            }
            let hull: Vec<_> = rest[..hull].iter().map(|&i| i as usize).collect();
            Rigid::mesh(&points, &triangles, &hull, density)
        }
        1 => {
            let balls = rest.as_chunks().0.iter();
            let balls: Vec<_> = balls.map(|&[x, y, z, r]| ball([x, y, z], r)).collect();
            Rigid::clump(&balls, density, Matter::Union)
        }
        2 => Rigid::ellipsoid(*rest.first_chunk().expect("three semi-axes"), density),
        3 => {
            let &[radius, count, asperity, seed] = rest.first_chunk().expect("four numbers");
            let sphere = [ball([0.0; 3], radius)];
            let inertia: Inertia = Rigid::clump(&sphere, density, Matter::Sum)?.inertia;
            let roughness = Roughness {
                asperities: count as usize,
                radius: asperity,
                heights: Heights::Equal(asperity),
                seed: seed as u64,
            };
            Rigid::rough(&sphere, false, inertia, &roughness)
        }
        4 => {
            let &[a, b, c, n1, n2] = rest.first_chunk().expect("semi-axes and exponents");
            Rigid::superellipsoid([a, b, c], [n1, n2], density)
        }
        5 => {
            let &[outer, inner, height] = rest.first_chunk().expect("three lengths");
            if inner >= outer {
                return Err(Error::Parameter {
                    name: "inner",
                    value: inner.into(),
                    allowed: format!("less than outer = {outer:?} (m)"),
                });
            }
            let half = 0.5 * height;
            let first = [-half, inner];
            let corners = [first, [-half, outer], [half, outer], [half, inner], first];
            Rigid::revolution(&corners, density)
        }
        6 => {
            let &[length, width, blunt_end, tip] = rest.first_chunk().expect("four lengths");
            Rigid::egg([length, width], [blunt_end, tip], density)
        }
        _ => Rigid::revolution(rest.as_chunks().0, density),
    }
}

fn ball(centre: [f64; 3], radius: f64) -> RigidBall {
    let centre = vector(&centre);
    RigidBall { centre, radius }
}

/// The principal moments over mR², the rotation from the principal axes, the centre of mass, R, and the balls or vertices that can touch,
/// each centre and radius, in the order of their numbers.
pub fn outline(body: &Rigid) -> Result<Vec<f64>, Error> {
    let mut row = body.top.moments().to_vec();
    row.extend(quaternion(body.axes));
    row.extend(components(body.inertia.centre));
    row.push(body.unit);
    for RigidBall { centre, radius } in body.balls()? {
        row.extend(components(centre));
        row.push(radius);
    }
    Ok(row)
}

/// The places that lie farthest in these directions, unit vectors, from the centre of mass and in the axes that the body was given in.
pub fn farthest(body: &Rigid, directions: &[f64]) -> Result<Vec<f64>, Error> {
    let parts = body.balls()?.len().max(body.rims().len()).max(1);
    let mut row = Vec::with_capacity(directions.len());
    for direction in directions.as_chunks().0.iter().map(vector) {
        let places = (0..parts).map(|k| body.nearest(k, direction * -1.0, Vector::default()));
        let along = |place: &Vector| place.dot(direction);
        let farthest = places.max_by(|a, b| along(a).total_cmp(&along(b)));
        row.extend(components(farthest.unwrap_or_default()));
    }
    Ok(row)
}

/// Attitude and ω after a time, of a free body with these moments, axes, attitude and ω: as in [`outline`], the attitude of the axes that
/// the body was given in.
pub fn turned(given: &[f64; 15]) -> Vec<f64> {
    let &[a, b, c, p, q, r, s, w, x, y, z, along, across, up, time] = given;
    let Ok(top) = Top::new([a, b, c]) else {
        return vec![f64::NAN; 7];
    };
    let axes = Quaternion::new(p, q, r, s);
    let spin = Vector::new(along, across, up);
    let (attitude, spin) = top.turned(Quaternion::new(w, x, y, z) * axes, spin, time);
    let attitude = attitude * axes.inverse();
    quaternion(attitude)
        .into_iter()
        .chain(components(spin))
        .collect()
}

/// w, x, y and z.
pub fn quaternion(given: Quaternion) -> [f64; 4] {
    [given.w, given.x, given.y, given.z]
}

/// The vector with these x, y and z.
pub fn vector(&[x, y, z]: &[f64; 3]) -> Vector {
    Vector::new(x, y, z)
}

/// x, y and z.
pub fn components(of: Vector) -> [f64; 3] {
    [of.x, of.y, of.z]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Balls come out as they went in; the body is made once; a tetrahedron has the centre of mass of its corners, as hull and as mesh.
    #[test]
    fn bodies_are_those_of_their_numbers() {
        let numbers = [1.0, 2500.0, 0.0, 0.0, 1e-3, 2e-3, 0.0, 0.0, -1e-3, 3e-3];
        let clump = body(&numbers).unwrap();
        assert!(Rc::ptr_eq(&clump, &body(&numbers).unwrap()));
        let row = outline(&clump).unwrap();
        for (found, given) in row[11..].iter().zip(&numbers[2..]) {
            assert!((found - given).abs() < 1e-18, "{found} for {given}");
        }
        let corners = [
            0.0, 0.0, 0.0, 4e-3, 0.0, 0.0, 0.0, 4e-3, 0.0, 0.0, 0.0, 4e-3,
        ];
        let faces = [0.0, 2.0, 1.0, 0.0, 1.0, 3.0, 0.0, 3.0, 2.0, 1.0, 2.0, 3.0];
        for hull in [&[][..], &[0.0, 1.0, 2.0, 3.0]] {
            let counts = [0.0, 2500.0, 4.0, 4.0, hull.len() as f64];
            let made = body(&[&counts[..], &corners, &faces, hull].concat()).unwrap();
            let centre = made.inertia.centre;
            assert!((centre - Vector::new(1e-3, 1e-3, 1e-3)).norm() < 1e-18);
        }
    }

    /// Where a body lies farthest, it has the support of that direction; a ring is one.
    #[test]
    fn the_farthest_place_has_the_support() {
        let bodies: [&[f64]; 4] = [
            &[1.0, 2500.0, 0.0, 0.0, 1e-3, 2e-3, 0.0, 0.0, -1e-3, 3e-3],
            &[4.0, 2500.0, 4e-3, 3e-3, 2e-3, 3.0, 5.0],
            &[5.0, 2500.0, 4e-3, 2e-3, 1e-3],
            &[6.0, 2500.0, 6e-3, 4.6e-3, 2.1e-3, 1.5e-3],
        ];
        for numbers in bodies {
            let body = body(numbers).unwrap();
            for direction in [[0.6, 0.0, 0.8], [0.48, -0.64, -0.6]] {
                let place = farthest(&body, &direction).unwrap();
                let direction = vector(&direction);
                let [found, support] = [
                    vector(place.first_chunk().unwrap()).dot(direction),
                    body.support(direction),
                ];
                assert!((found - support).abs() < 1e-16, "{found} for {support}");
            }
        }
        assert!(body(&[5.0, 2500.0, 4e-3, 4e-3, 1e-3]).is_err());
    }

    /// A free body keeps its angular momentum, of which its rotation about a principal axis is a simple one.
    #[test]
    fn a_free_turn_is_that_of_the_core() {
        let given = [
            0.2, 0.3, 0.4, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.7,
        ];
        let [w, x, y, z, .., up] = turned(&given)[..] else {
            panic!("seven numbers")
        };
        let (sine, cosine) = 0.7_f64.sin_cos();
        for (found, exact) in [(w, cosine), (x, 0.0), (y, 0.0), (z, sine), (up, 2.0)] {
            assert!((found - exact).abs() < 1e-14, "{found} for {exact}");
        }
    }
}
