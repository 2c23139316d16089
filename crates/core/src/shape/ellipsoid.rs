//! Ellipsoids.

use super::pieces::Extent;
use super::rigid::{Inertia, Rigid, homogeneous};
use super::surface::{Convex, EllipsoidSurface};
use super::{BodyKind, Form, check_density};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::math::{Symmetric, Vector};

/// Semi-axes along x, y and z.
pub(super) const SEMI_AXES: Parameter = Parameter::new(
    "semi_axes",
    "semi-axes along x, y and z of the body",
    Some("m"),
    Allowed::Several(
        &[
            ["axis_x", "semi-axis along x of the body"],
            ["axis_y", "semi-axis along y of the body"],
            ["axis_z", "semi-axis along z of the body"],
        ],
        Interval::POSITIVE,
    ),
    Argument::Numbers(&[4e-3, 3e-3, 2e-3]),
);

const ALLOWED: &str = "three finite numbers > 0 in m, the largest at most 1000 times the smallest";

/// Its entry in the table of bodies.
pub(super) const ELLIPSOID: BodyKind = BodyKind::Rigid(Kind {
    name: "Ellipsoid",
    text: "ellipsoid with three semi-axes",
    parameters: homogeneous![SEMI_AXES],
    make: |given| Rigid::ellipsoid(given.several(0), given.number(1)).map(Form::from),
});

impl Rigid {
    /// A homogeneous ellipsoid with these semi-axes (m) along its own axes.
    ///
    /// # Errors
    /// Unless they and the density are positive, and the largest is at most 1000 times the smallest.
    pub fn ellipsoid(semi_axes: [f64; 3], density: f64) -> Result<Self, Error> {
        Self::check_semi_axes(semi_axes)?;
        check_density(density)?;
        let [a, b, c] = semi_axes;
        let mass = density * (4.0 / 3.0 * std::f64::consts::PI) * a * b * c;
        let fifth = mass / 5.0;
        let inertia = Inertia {
            mass,
            centre: Vector::default(),
            tensor: Symmetric::diagonal([
                fifth * (b * b + c * c),
                fifth * (c * c + a * a),
                fifth * (a * a + b * b),
            ]),
        };
        let unit = a.max(b).max(c);
        let surface = Convex::new(EllipsoidSurface(semi_axes.map(|axis| axis / unit)));
        Self::new(inertia, unit, Extent::Hull, |_| Ok(surface.into()))
    }

    /// Refuses semi-axes that are no positive numbers, or differ by more than 1000 times.
    pub(super) fn check_semi_axes(semi_axes: [f64; 3]) -> Result<(), Error> {
        for axis in semi_axes {
            let positive = axis.is_finite() && axis > 0.0;
            Error::unless(positive, "semi_axes", axis, ALLOWED)?;
        }
        let [a, b, c] = semi_axes;
        let (most, least) = (a.max(b).max(c), a.min(b).min(c));
        let holds = most <= 1000.0 * least * (1.0 + 4.0 * f64::EPSILON);
        Error::unless(holds, "semi_axes", least, ALLOWED)
    }
}
