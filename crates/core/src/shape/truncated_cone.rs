//! Truncated cones.

use super::rigid::{CENTRE, TENSOR};
use super::{BodyKind, Form, check_length};
use crate::Error;
use crate::describe::{Arguments, Interval, Kind, Parameter};

/// Its entry in the table of bodies.
pub(super) const TRUNCATED_CONE: BodyKind = BodyKind::Rigid(Kind {
    name: "TruncatedCone",
    text: "truncated cone: a cup, a bullet, a cone",
    parameters: &[
        Parameter::length("base", "radius of the face at z = 0", 3e-3),
        Parameter::number(
            "top",
            "radius of the other face, 0 of a cone",
            "m",
            Interval::NOT_NEGATIVE,
            1.5e-3,
        ),
        Parameter::length("height", "distance of the faces", 5e-3).linked("cone_height"),
        Parameter::density("density"),
        TENSOR,
        CENTRE,
    ],
    make: |given| {
        let [base, top, height] = [0, 1, 2].map(|i| given.number(i));
        check_length("base", base)?;
        let fits = top.is_finite() && top >= 0.0;
        Error::unless(fits, "top", top, "finite and >= 0 (m)")?;
        check_length("height", height)?;
        Ok(Form::Profile(vec![[0.0, base], [height, top]]))
    },
});
