//! Initial conditions of the particles: distributions by name, or arrays.

use crate::errors::{python_error, unless};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use restitution_core::{About, Height, Orientation, Spin, Vector};

/// The name of a distribution, an array of angles θ, or one of rows (θ, φ) in rad or of quaternions (w, x, y, z).
#[derive(FromPyObject)]
pub enum Axes<'py> {
    Name(String),
    Angles(PyReadonlyArray1<'py, f64>),
    Rows(PyReadonlyArray2<'py, f64>),
}

impl Axes<'_> {
    pub fn law(&self) -> PyResult<Orientation<'_>> {
        Ok(match self {
            Self::Name(name) => Orientation::named(name).map_err(python_error)?,
            Self::Angles(angles) => Orientation::Given(angles.as_slice()?),
            Self::Rows(rows) => {
                let columns = rows.shape()[1];
                unless(
                    columns == 2 || columns == 4,
                    "columns of orientation",
                    columns,
                    "2, for θ and φ, or 4, for w, x, y and z",
                )?;
                if columns == 2 {
                    Orientation::Directions(rows.as_slice()?.as_chunks().0)
                } else {
                    Orientation::Attitudes(rows.as_slice()?.as_chunks().0)
                }
            }
        })
    }
}

/// One height, or the smallest and the largest of random ones; in m.
#[derive(FromPyObject)]
pub enum Heights {
    Fixed(f64),
    #[pyo3(from_item_all)]
    Random {
        lowest: f64,
        highest: f64,
    },
}

impl Heights {
    pub fn law(&self) -> Height {
        match *self {
            Self::Fixed(height) => Height::Fixed(height),
            Self::Random { lowest, highest } => Height::Random { lowest, highest },
        }
    }
}

/// One angular velocity, one for each particle, or the parameters of a random one; in rad/s.
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
    #[pyo3(from_item_all)]
    Thermal {
        thermal: f64,
    },
}

impl Spins<'_> {
    pub fn law(&self) -> PyResult<Spin<'_>> {
        Ok(match self {
            Self::Fixed([x, y, z]) => Spin::Fixed(Vector::new(*x, *y, *z)),
            Self::Given(rows) => {
                let columns = rows.shape()[1];
                unless(
                    columns == 3,
                    "columns of spin",
                    columns,
                    "3, for x, y and z",
                )?;
                Spin::Given(rows.as_slice()?.as_chunks().0)
            }
            Self::Random { low, high, axis } => Spin::Random {
                low: *low,
                high: *high,
                about: About::named(axis).map_err(python_error)?,
            },
            Self::Thermal { thermal } => Spin::Thermal { rate: *thermal },
        })
    }
}
