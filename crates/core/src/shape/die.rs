//! Dice: the five Platonic solids.

use super::cuboid::corners;
use super::rigid::homogeneous;
use super::{BodyKind, Form, check_length};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Kind, Parameter};
use crate::math::{UNITS, Vector};

/// Its entry in the table of bodies.
pub(super) const DIE: BodyKind = BodyKind::Rigid(Kind {
    name: "Die",
    text: "die with equal faces",
    parameters: homogeneous![
        Parameter::new(
            "faces",
            "number of faces",
            None,
            Allowed::Choice(&[4, 6, 8, 12, 20]),
            Argument::Whole(6),
        ),
        Parameter::length("edge", "length of an edge", 6e-3),
    ],
    make: solid,
});

const GOLDEN: f64 = 1.618_033_988_749_895;

/// (0, ±x, ±y) and what follows by shifting the axes round.
fn cyclic(x: f64, y: f64) -> impl Iterator<Item = Vector> {
    let signs = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
    (0..3).flat_map(move |shift| {
        signs.map(|[a, b]| {
            let mut place = [0.0, a * x, b * y];
            place.rotate_right(shift);
            Vector::from(place)
        })
    })
}

/// Vertices about the centre, and triangles of them.
fn solid(given: &[Argument<'_>]) -> Result<Form, Error> {
    let cube = corners([2.0; 3]);
    let (centre, [x, y, z]) = (Vector::default(), UNITS);
    let (edge, points, triangles): (f64, Vec<Vector>, &str) = match given.whole(0) {
        4 => (
            8.0_f64.sqrt(),
            cube.into_iter().filter(|p| p.x * p.y * p.z > 0.0).collect(),
            "120 320 310 312",
        ),
        6 => (2.0, cube, "620 640 540 510 564 567 320 310 362 367 351 357"),
        8 => (
            2.0_f64.sqrt(),
            vec![centre - x, centre - y, centre - z, z, y, x],
            "210 215 310 315 425 420 435 430",
        ),
        12 => (
            2.0 / GOLDEN,
            cube.into_iter()
                .chain(cyclic(1.0 / GOLDEN, GOLDEN))
                .collect(),
            "i59 i1g i19 20c 208 2a8 e1g e0c e0g e3h e2c e2h 408 40g 4ig 4a8 46d 46a f4i fi5 f4d b19 be1 be3 b59 bf7 bf5 j2a j6a j2h j6d jfd \
             jf7 j3h jb7 jb3",
        ),
        20 => (
            2.0,
            cyclic(1.0, GOLDEN).collect(),
            "084 694 684 b75 a05 a75 a08 204 294 205 2b9 2b5 3b9 369 3b7 1a8 168 1a7 136 137",
        ),
        other => {
            let allowed = "4, 6, 8, 12 or 20";
            return Err(Error::parameter("faces", other as usize, allowed));
        }
    };
    check_length("edge", given.number(1))?;
    let scale = given.number(1) / edge;
    let digit = |letter: char| letter.to_digit(36).unwrap_or_default() as usize;
    let corners = |word: &str| {
        let mut letters = word.chars().map(digit);
        [(); 3].map(|()| letters.next().unwrap_or_default())
    };
    Ok(Form::Faces(
        points.into_iter().map(|point| point * scale).collect(),
        triangles.split_whitespace().map(corners).collect(),
    ))
}
