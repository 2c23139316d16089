//! How particles are let go: laws by name, or arrays.

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use restitution_core::{About, Orientation, Spin, Vector};

/// The name of a law, an array of angles θ, or one of rows (θ, φ).
#[derive(FromPyObject)]
pub enum Axes<'py> {
    Name(String),
    Angles(PyReadonlyArray1<'py, f64>),
    Directions(PyReadonlyArray2<'py, f64>),
}

impl Axes<'_> {
    pub fn law(&self) -> PyResult<Orientation<'_>> {
        Ok(match self {
            Self::Name(name) if name == "isotropic" => Orientation::Isotropic,
            Self::Name(_) => Orientation::UniformAngle,
            Self::Angles(angles) => Orientation::Given(angles.as_slice()?),
            Self::Directions(rows) => Orientation::Directions(rows.as_slice()?.as_chunks().0),
        })
    }
}

/// One angular velocity, an array of them, or the parameters of a random one; in rad/s.
#[derive(FromPyObject)]
pub enum Spins<'py> {
    Fixed([f64; 3]),
    Given(PyReadonlyArray2<'py, f64>),
    #[pyo3(from_item_all)]
    Random {
        low: f64,
        high: f64,
        axis: String,
    },
}

impl Spins<'_> {
    pub fn law(&self) -> PyResult<Spin<'_>> {
        Ok(match self {
            Self::Fixed([x, y, z]) => Spin::Fixed(Vector::new(*x, *y, *z)),
            Self::Given(rows) => Spin::Given(rows.as_slice()?.as_chunks().0),
            Self::Random { low, high, axis } => Spin::Random {
                low: *low,
                high: *high,
                about: match axis.as_str() {
                    "across" => About::Across,
                    "horizontal" => About::Horizontal,
                    _ => About::Isotropic,
                },
            },
        })
    }
}
