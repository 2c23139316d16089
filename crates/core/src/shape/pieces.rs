//! The parts with which a body touches another body: on a plane only its convex hull can.

use super::revolution::Ball;
use super::{AnyBody, Rigid, RigidSurface, Solid};
use crate::Error;
use crate::Value;
use crate::math::Vector;

/// A part of a body, in m and the principal axes, from the centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Piece {
    Ball(BallPiece),
    /// Fixed in space, with the normal z.
    Plane,
}

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BallPiece {
    pub place: Vector,
    pub radius: f64,
    /// The distance of its centre from the centre of mass.
    pub reach: f64,
}

impl BallPiece {
    fn new(place: Vector, radius: f64) -> Self {
        Self {
            place,
            radius,
            reach: place.norm(),
        }
    }
}

/// The matter between the parts that touch a plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extent {
    /// The body is made of balls.
    Balls,
    /// It is its convex hull.
    Hull,
    /// Neither.
    Other,
}

impl AnyBody<'_> {
    /// The parts with which it touches another body; `name` is for the error.
    pub(crate) fn pieces(&self, name: &'static str) -> Result<Vec<Piece>, Error> {
        let found = match self {
            Self::Revolution(solid) => of_solid(solid),
            Self::Rigid(body) => of_rigid(body),
        };
        found.ok_or_else(|| Error::Parameter {
            name,
            value: Value::Name("this body".into()),
            allowed:
                "a body made of balls (Dumbbell, LoadedSphere, Clump, or these with asperities)"
                    .into(),
        })
    }
}

fn of_solid(solid: &Solid) -> Option<Vec<Piece>> {
    let balls = solid.scaled.hull.balls()?;
    if solid.is_filled && balls.len() > 1 {
        return None;
    }
    let piece = |Ball { offset, radius }: Ball| {
        let place = Vector::new(0.0, 0.0, solid.unit * offset);
        Piece::Ball(BallPiece::new(place, solid.unit * radius))
    };
    Some(balls.into_iter().map(piece).collect())
}

fn of_rigid(body: &Rigid) -> Option<Vec<Piece>> {
    match (&body.skin, body.extent) {
        (RigidSurface::Points(balls), Extent::Balls) => {
            let piece = |point: &super::Point| {
                Piece::Ball(BallPiece::new(
                    point.place * body.unit,
                    point.radius * body.unit,
                ))
            };
            Some(balls.points().iter().map(piece).collect())
        }
        _ => None,
    }
}
