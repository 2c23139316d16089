//! Clumps: unions of balls.

use super::pieces::Extent;
use super::rigid::{CENTRE, Rigid, RigidBall, TENSOR};
use super::union::{sum, union};
use super::{BodyKind, Form, check_density};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::math::Vector;

/// The matter of a clump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Matter {
    /// That of the union of the balls.
    Union,
    /// That of all balls, counted twice where they overlap, as some DEM codes do.
    Sum,
}

/// Its entry in the table of bodies. Its inertia may be a tensor, too.
pub(super) const CLUMP: BodyKind = BodyKind::Rigid(Kind {
    name: "Clump",
    text: "spheres fixed to each other",
    parameters: &[
        Parameter::new(
            "spheres",
            "centre and radius of each sphere",
            Some("m"),
            Allowed::Rows(&["x", "y", "z", "r"], 1, Interval::POSITIVE),
            Argument::Numbers(&[
                0.0, 2e-3, 0.0, 2e-3, -1.7e-3, -1e-3, 0.0, 2e-3, 1.7e-3, -1e-3, 0.0, 2e-3,
            ]),
        ),
        Parameter::density("density"),
        Parameter {
            text: "matter of the union of the spheres or of each by itself, or the tensor of inertia",
            allowed: Allowed::Name(&["union", "sum"]),
            default: Some(Argument::Name("union")),
            example: Argument::Name("union"),
            ..TENSOR
        },
        CENTRE,
    ],
    make: |given| {
        let ball = |&[x, y, z, radius]: &[f64; 4]| RigidBall {
            centre: Vector::new(x, y, z),
            radius,
        };
        let balls: Vec<_> = given.numbers(0).as_chunks().0.iter().map(ball).collect();
        let matter = match (given.name(2), given.numbers(2).is_empty()) {
            ("sum", _) => Matter::Sum,
            ("union", _) | (_, false) => Matter::Union,
            (other, _) => Error::chosen("inertia", other, &[("union", Matter::Union)])?,
        };
        Rigid::clump(&balls, given.number(1), matter).map(Form::from)
    },
});

impl Rigid {
    /// The union of balls with these centres and radii, in m.
    ///
    /// # Errors
    /// Without balls, or unless all numbers are finite and radii and density positive.
    pub fn clump(balls: &[RigidBall], density: f64, matter: Matter) -> Result<Self, Error> {
        check_density(density)?;
        check(balls)?;
        let moments = match matter {
            Matter::Union => union(balls)?,
            Matter::Sum => sum(balls),
        };
        let parts = balls.iter().copied();
        Self::of_balls(moments.inertia(density), "spheres", Extent::Balls, parts)
    }
}

pub(super) fn check(balls: &[RigidBall]) -> Result<(), Error> {
    Error::unless(!balls.is_empty(), "spheres", balls.len(), "one or more")?;
    for RigidBall { centre, radius } in balls {
        // Sizes in m whose fifth power is a number.
        let allowed = "rows (x, y, z, radius) in m, one or more, |x| to 1e+60, radius >= 1e-60";
        for x in [centre.x, centre.y, centre.z] {
            Error::unless(x.abs() <= 1e60, "spheres", x, allowed)?;
        }
        let positive = (1e-60..=1e60).contains(radius);
        Error::unless(positive, "spheres", *radius, allowed)?;
    }
    Ok(())
}
