//! Bodies that are not full: hollow ones, and those of given moments of inertia.

use super::{Body, Shape, Solid, check_length};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Parameter};

/// The parameters with which that of every shape end.
pub(super) const WALL: Parameter = Parameter::length(
    "wall",
    "thickness of the wall of a hollow body: the shape less itself drawn in by it",
    4e-4,
)
.optional();
pub(super) const INERTIA: Parameter = Parameter::new(
    "inertia",
    "moments of inertia across and about the axis, or one for both, instead of those of the matter",
    Some("kg m2"),
    Allowed::Pair(Interval::POSITIVE),
    Argument::Pair([1.2e-9, 1.0e-9]),
)
.optional();

/// Thinnest wall over the longest radius: mass and inertia are differences, and lose as many digits as it has zeros.
const THINNEST: f64 = 1e-6;

/// The body that the last two arguments make of a shape, [`WALL`] at this place and [`INERTIA`] after it.
pub(super) fn made<S: Shape>(
    shape: S,
    given: &[Argument<'_>],
    place: usize,
) -> Result<Solid, Error> {
    let [is_full, has_its_own] = [place, place + 1].map(|place| given.is_absent(place));
    let inertia = given.pair(place + 1);
    Error::unless(
        is_full || has_its_own,
        "inertia",
        inertia[0],
        "left out where there is a wall",
    )?;
    let body = if is_full {
        shape.into()
    } else {
        shape.hollow(given.number(place))?.into()
    };
    if has_its_own {
        Ok(body)
    } else {
        with_inertia(body, inertia)
    }
}

/// The wall, unless it is too thin for a body of this longest radius, or thicker than its thickest, in m, which `allowed` names; none if
/// it leaves nothing inside.
pub(super) fn checked(
    wall: f64,
    unit: f64,
    (thickest, allowed): (f64, &'static str),
) -> Result<Option<f64>, Error> {
    check_length("wall", wall)?;
    let thick = wall >= THINNEST * unit * (1.0 - 4.0 * f64::EPSILON);
    let least = "at least 1e-6 of the longest radius (m)";
    Error::unless(thick, "wall", wall, least)?;
    let within = wall <= thickest * (1.0 + 4.0 * f64::EPSILON);
    Error::unless(within, "wall", wall, allowed)?;
    Ok((wall < thickest).then_some(wall))
}

/// The value of a function of L/R for a shape of two equal caps in units of R, less that for the shape drawn in by the wall,
/// `power` being that of the length.
pub(super) fn of_wall(
    factor: fn(f64) -> f64,
    power: i32,
    elongation: f64,
    wall: Option<f64>,
) -> f64 {
    let whole = factor(elongation);
    wall.map_or(whole, |wall| {
        let inside = 1.0 - wall;
        whole - inside.powi(power) * factor(elongation / inside)
    })
}

/// See [`Solid::with_inertia`].
pub(super) fn with_inertia(body: Solid, moments: [f64; 2]) -> Result<Solid, Error> {
    for moment in moments {
        let positive = moment.is_finite() && moment > 0.0;
        Error::unless(positive, "inertia", moment, "finite and > 0 (kg m^2)")?;
    }
    let [transverse, axial] = moments;
    let rounding = 1.0 + 4.0 * f64::EPSILON;
    Error::unless(
        axial <= 2.0 * transverse * rounding,
        "inertia",
        axial,
        "about the axis at most twice that across it (kg m^2)",
    )?;
    // The sum of all three is twice ∫r² dm about the centre of mass.
    let most = 2.0 * body.mass * body.farthest().powi(2);
    Error::unless(
        2.0 * transverse + axial <= most * rounding,
        "inertia",
        transverse,
        "so small that the matter, of this mass, is within the surface (kg m^2)",
    )?;
    let unit = body.mass * (body.unit * body.unit);
    Ok(Solid {
        transverse_inertia: transverse,
        axial_inertia: axial,
        scaled: Body {
            transverse: transverse / unit,
            axial: axial / unit,
            ..body.scaled
        },
        ..body
    })
}
