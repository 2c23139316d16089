//! Cylinders.

use super::rigid::homogeneous;
use super::{BodyKind, Form, check_length};
use crate::describe::{Arguments, Kind, Parameter};

/// Its entry in the table of bodies.
pub(super) const CYLINDER: BodyKind = BodyKind::Rigid(Kind {
    name: "Cylinder",
    text: "cylinder: a coin, a tablet, a rod",
    parameters: homogeneous![
        Parameter::length("radius", "radius", 3e-3),
        Parameter::length("height", "height of the cylinder", 1.8e-3),
    ],
    make: |given| {
        let [radius, height] = [0, 1].map(|i| given.number(i));
        check_length("radius", radius)?;
        check_length("height", height)?;
        let half = 0.5 * height;
        Ok(Form::Profile(vec![[-half, radius], [half, radius]]))
    },
});
