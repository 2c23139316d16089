//! Rings.

use super::rigid::homogeneous;
use super::{BodyKind, Form, check_length};
use crate::Error;
use crate::describe::{Arguments, Kind, Parameter};

/// Its entry in the table of bodies.
pub(super) const RING: BodyKind = BodyKind::Rigid(Kind {
    name: "Ring",
    text: "ring, washer or tube",
    parameters: homogeneous![
        Parameter::length("outer", "outer radius", 4e-3),
        Parameter::length("inner", "inner radius", 2.4e-3).up_to(0.99),
        Parameter::length("height", "height of the ring", 2e-3).linked("ring_height"),
    ],
    make: |given| {
        let [outer, inner, height] = [0, 1, 2].map(|i| given.number(i));
        for (name, length) in [("outer", outer), ("inner", inner), ("height", height)] {
            check_length(name, length)?;
        }
        Error::unless(inner < outer, "inner", inner, "less than outer (m)")?;
        let half = 0.5 * height;
        let first = [-half, inner];
        let corners = [first, [-half, outer], [half, outer], [half, inner], first];
        Ok(Form::Profile(corners.into()))
    },
});
