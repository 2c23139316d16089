//! Truncated cones.

use super::rigid::homogeneous;
use super::{BodyKind, Form, check_distance, check_length};
use crate::describe::{Arguments, Kind, Parameter};

/// Its entry in the table of bodies.
pub(super) const TRUNCATED_CONE: BodyKind = BodyKind::Rigid(Kind {
    name: "TruncatedCone",
    text: "truncated cone: a cup, a bullet, a cone",
    parameters: homogeneous![
        Parameter::length("base", "radius of the face at z = 0", 3e-3),
        Parameter::distance("top", "radius of the other face, 0 of a cone", 1.5e-3),
        Parameter::length("height", "distance of the faces", 5e-3).linked("cone_height"),
    ],
    make: |given| {
        let [base, top, height] = [0, 1, 2].map(|i| given.number(i));
        check_length("base", base)?;
        check_distance("top", top)?;
        check_length("height", height)?;
        Ok(Form::Profile(vec![[0.0, base], [height, top]]))
    },
});
