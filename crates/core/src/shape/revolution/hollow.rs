//! Bodies that are not full: hollow ones, and those of given moments of inertia.

use super::{Arc, Body, EqualBalls, Shape, Solid, Surface, check_length, seen};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Parameter};
use std::f64::consts::PI;

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
    let allowed = "left out where there is a wall";
    let holds = is_full || has_its_own;
    Error::unless(holds, "inertia", inertia[0], allowed)?;
    let body = if is_full {
        shape.into()
    } else {
        shape.hollow(given.number(place))?.into()
    };
    if has_its_own {
        Ok(body)
    } else {
        body.with_inertia(inertia)
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

/// A body with two equal caps of radius R on the axis, their centres L apart, less itself drawn in by the wall. `factors` are m/(πρR³), J_xx/(πρR⁵)
/// and J_zz/(πρR⁵) of the whole shape, as functions of L/R.
pub(super) fn of_equal_caps(
    [radius, separation, density]: [f64; 3],
    wall: Option<f64>,
    factors: [fn(f64) -> f64; 3],
    outline: [Arc; 2],
) -> Solid {
    let elongation = separation / radius;
    let inside = wall.map(|wall| 1.0 - wall / radius);
    let [mass, transverse, axial] = [0, 1, 2].map(|i| {
        let (factor, power) = (factors[i], [3, 5, 5][i]);
        let whole = factor(elongation);
        inside.map_or(whole, |inside| {
            whole - inside.powi(power) * factor(elongation / inside)
        })
    });
    let half_separation = 0.5 * seen(elongation);
    Solid {
        unit: radius,
        mass: density * radius.powi(3) * PI * mass,
        transverse_inertia: density * radius.powi(5) * PI * transverse,
        axial_inertia: density * radius.powi(5) * PI * axial,
        centre_of_mass: 0.0,
        is_filled: false,
        outline,
        scaled: Body {
            hull: Surface::EqualBalls(EqualBalls::new(half_separation)),
            half_separation,
            transverse: transverse / mass,
            axial: axial / mass,
        },
    }
}

impl Solid {
    /// The body with these moments of inertia across and about its axis, in kg m², instead of those of its matter.
    ///
    /// # Errors
    /// Unless matter within the hull can have them: both positive, the second at most twice the first.
    pub fn with_inertia(self, moments: [f64; 2]) -> Result<Self, Error> {
        for moment in moments {
            let positive = moment.is_finite() && moment > 0.0;
            Error::unless(positive, "inertia", moment, "finite and > 0 (kg m^2)")?;
        }
        let [transverse, axial] = moments;
        let rounding = 1.0 + 4.0 * f64::EPSILON;
        let allowed = "about the axis at most twice that across it (kg m^2)";
        let holds = axial <= 2.0 * transverse * rounding;
        Error::unless(holds, "inertia", axial, allowed)?;
        // The sum of all three is twice ∫r² dm about the centre of mass.
        let most = 2.0 * self.mass * self.farthest().powi(2);
        let allowed = "so small that the matter, of this mass, is within the surface (kg m^2)";
        let holds = 2.0 * transverse + axial <= most * rounding;
        Error::unless(holds, "inertia", transverse, allowed)?;
        let unit = self.mass * (self.unit * self.unit);
        Ok(Self {
            transverse_inertia: transverse,
            axial_inertia: axial,
            scaled: Body {
                transverse: transverse / unit,
                axial: axial / unit,
                ..self.scaled
            },
            ..self
        })
    }
}
