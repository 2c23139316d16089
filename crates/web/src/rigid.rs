//! A rigid body as a row of numbers, written by `web/src/rigid.ts` behind the parameters: its number in the table of bodies, and its
//! arguments, in SI units.

use crate::parameters::chosen;
use restitution_core::describe::{Allowed, Argument, Parameter};
use restitution_core::{BODIES, BodyKind, Error, Form, Quaternion, Rigid, RigidBall, Top, Vector};
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

/// The number of a kind of the table, and its arguments: a number each, that of a name for a name; numbers in a row by themselves, and a table
/// after the number of its entries. What is usually left out is so here.
fn make(numbers: &[f64]) -> Result<Rigid, Error> {
    let (&number, mut rest) = numbers.split_first().expect("a kind");
    let BodyKind::Rigid(kind) = chosen(BODIES, number) else {
        unreachable!("a rigid body behind the parameters");
    };
    kind.body(&arguments(kind.parameters, &mut rest))
}

/// True if the page asks for it: for nothing that is usually left out, and bodies are homogeneous.
pub fn is_asked(about: &Parameter) -> bool {
    !about.is_optional() && about.unit != Some("kg m2")
}

/// The arguments of a kind with these parameters at the beginning of some numbers.
fn arguments<'a>(parameters: &[Parameter], numbers: &mut &'a [f64]) -> Vec<Argument<'a>> {
    let mut take = |count: usize| {
        let (taken, rest) = numbers.split_at(count);
        *numbers = rest;
        taken
    };
    let argument = |about: &Parameter| match about.allowed {
        _ if !is_asked(about) => about.default.unwrap_or(Argument::Absent),
        Allowed::Several(names, _) => Argument::Numbers(take(names.len())),
        Allowed::Rows(..) => {
            let count = take(1)[0] as usize;
            Argument::Numbers(take(count))
        }
        Allowed::Choice(numbers) => Argument::Whole(*chosen(numbers, take(1)[0])),
        Allowed::Name(names) => Argument::Name(chosen::<&'static str>(names, take(1)[0])),
        _ => Argument::Number(take(1)[0]),
    };
    parameters.iter().map(argument).collect()
}

/// The drawing of a body behind the parameters: three times the number of points and their places, and the numbers of triangles; or
/// minus twice the number of points (z, r) of a profile, and these; or nothing, where it is its balls or points that lie farthest.
pub fn drawing(numbers: &[f64]) -> Result<Vec<f64>, Error> {
    let (&number, mut rest) = numbers.split_first().expect("a kind");
    let BodyKind::Rigid(kind) = chosen(BODIES, number) else {
        return Ok(Vec::new());
    };
    Ok(match (kind.make)(&arguments(kind.parameters, &mut rest))? {
        Form::Faces(points, triangles) | Form::Mesh(points, triangles) => {
            let mut row = vec![3.0 * points.len() as f64];
            row.extend(points.into_iter().flat_map(Vector::parts));
            row.extend(triangles.into_flattened().into_iter().map(|i| i as f64));
            row
        }
        Form::Profile(points) => {
            let mut row = vec![-2.0 * points.len() as f64];
            row.extend(points.into_flattened());
            row
        }
        Form::Body(_) => Vec::new(),
    })
}

/// The principal moments over mR², the rotation from the principal axes, the centre of mass, R, and the balls or vertices that can touch,
/// each centre and radius, in the order of their numbers.
pub fn outline(body: &Rigid) -> Result<Vec<f64>, Error> {
    let mut row = body.top.moments().to_vec();
    row.extend(body.axes.parts());
    row.extend(body.inertia.centre.parts());
    row.push(body.unit);
    for RigidBall { centre, radius } in body.balls()? {
        row.extend(centre.parts());
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
        row.extend(farthest.unwrap_or_default().parts());
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
    attitude.parts().into_iter().chain(spin.parts()).collect()
}

/// The vector with these x, y and z.
pub fn vector(&[x, y, z]: &[f64; 3]) -> Vector {
    Vector::new(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers as the page writes them.
    fn row(name: &str, arguments: &[f64]) -> Vec<f64> {
        let number = BODIES
            .iter()
            .position(|kind| kind.about().0 == name)
            .unwrap();
        [&[number as f64], arguments].concat()
    }

    const BALLS: [f64; 10] = [8.0, 0.0, 0.0, 1e-3, 2e-3, 0.0, 0.0, -1e-3, 3e-3, 2500.0];

    /// Balls come out as they went in; the body is made once; a tetrahedron has the centre of mass of its corners, as hull and as mesh, and
    /// four faces.
    #[test]
    fn bodies_are_those_of_their_numbers() {
        let numbers = row("Clump", &BALLS);
        let clump = body(&numbers).unwrap();
        assert!(Rc::ptr_eq(&clump, &body(&numbers).unwrap()));
        for (found, given) in outline(&clump).unwrap()[11..].iter().zip(&BALLS[1..9]) {
            assert!((found - given).abs() < 1e-18, "{found} for {given}");
        }
        let corners = [
            12.0, 0.0, 0.0, 0.0, 4e-3, 0.0, 0.0, 0.0, 4e-3, 0.0, 0.0, 0.0, 4e-3,
        ];
        let faces = [
            12.0, 0.0, 2.0, 1.0, 0.0, 1.0, 3.0, 0.0, 3.0, 2.0, 1.0, 2.0, 3.0,
        ];
        let hull = row("ConvexPolyhedron", &[&corners[..], &[2500.0]].concat());
        let mesh = row("Mesh", &[&corners[..], &faces, &[2500.0]].concat());
        for numbers in [hull, mesh] {
            let centre = body(&numbers).unwrap().inertia.centre;
            assert!((centre - Vector::new(1e-3, 1e-3, 1e-3)).norm() < 1e-18);
            let drawn = drawing(&numbers).unwrap();
            assert_eq!((drawn[0], drawn.len()), (12.0, 25));
        }
    }

    /// Where a body lies farthest, it has the support of that direction; a ring is one.
    #[test]
    fn the_farthest_place_has_the_support() {
        let bodies = [
            row("Clump", &BALLS),
            row("Superellipsoid", &[4e-3, 3e-3, 2e-3, 3.0, 5.0, 2500.0]),
            row("Ring", &[4e-3, 2e-3, 1e-3, 2500.0]),
            row("Egg", &[6e-3, 4.6e-3, 2.1e-3, 1.5e-3, 2500.0]),
        ];
        for numbers in bodies {
            let body = body(&numbers).unwrap();
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
        assert!(body(&row("Ring", &[4e-3, 4e-3, 1e-3, 2500.0])).is_err());
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
