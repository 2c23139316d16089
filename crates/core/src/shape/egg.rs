//! Eggs: two spherical caps, joined by an arc that is tangent to both.

use super::rigid::{Rigid, homogeneous};
use super::surface::{Band, Place};
use super::{BodyKind, Form};
use crate::Error;
use crate::describe::{Arguments, Kind, Parameter};
use crate::math::flat::norm;

/// Its entry in the table of bodies.
pub(super) const EGG: BodyKind = BodyKind::Rigid(Kind {
    name: "Egg",
    text: "egg of two caps, joined by an arc",
    parameters: homogeneous![
        Parameter::length("length", "length", 6e-3),
        Parameter::length("width", "width", 4.5e-3).up_to(1.0),
        Parameter::length("blunt_end", "radius of the blunt end", 2.1e-3).up_to(0.5),
        Parameter::length("tip", "radius of the tip", 1.5e-3).up_to(0.5),
    ],
    make: |given| {
        let [length, width, blunt, tip] = [0, 1, 2, 3].map(|i| given.number(i));
        Rigid::egg([length, width], [blunt, tip], given.number(4)).map(Form::from)
    },
});

impl Rigid {
    /// An egg that stands on z = 0: a cap of the radius `blunt` below, one of the radius `tip` above, joined by an arc that is tangent to both and has the
    /// distance `width`/2 from the axis at its widest (m).
    ///
    /// # Errors
    /// Unless all numbers are positive, `width` ≤ `length`, and both radii are less than half of the width, or one of them as large.
    pub fn egg(
        [length, width]: [f64; 2],
        [blunt, tip]: [f64; 2],
        density: f64,
    ) -> Result<Self, Error> {
        let half = 0.5 * width;
        for (name, value, most, allowed) in [
            ("length", length, f64::MAX, "finite and > 0 (m)"),
            ("width", width, length, "> 0 and <= length (m)"),
            ("blunt_end", blunt, half, "> 0 and <= width/2 (m)"),
            ("tip", tip, half, "> 0 and <= width/2 (m)"),
        ] {
            Error::unless(value > 0.0 && value <= most, name, value, allowed)?;
        }
        let (below, above) = (half - blunt, half - tip);
        let smaller = below.max(above) > 0.0;
        let allowed = "less than width/2, as blunt_end is not";
        Error::unless(smaller, "tip", tip, allowed)?;
        // The arc of radius ϱ, its centre at (z, width/2 − ϱ) from that of the blunt cap: z² = below (2ϱ − width/2 − blunt), (D − z)² =
        // above (2ϱ − width/2 − tip), D the distance of the caps' centres; both have one solution 0 ≤ z ≤ D.
        let distance = length - blunt - tip;
        // (above − below) z² + 2 b z = c, without cancellation.
        let b = below * distance;
        let c = below * (distance * distance + (below - above) * above);
        let root = (b * b + (above - below) * c).max(0.0).sqrt();
        let z = if below == 0.0 { 0.0 } else { c / (b + root) };
        let radius = if below > above {
            0.5 * (z * z / below + half + blunt)
        } else {
            0.5 * ((distance - z) * (distance - z) / above + half + tip)
        };
        let centre = [blunt + z, half - radius];
        // Of a sphere the arc can be all of it.
        let towards = |[a, b]: Place, pole: Place| {
            let (x, y) = (a - centre[0], b - centre[1]);
            let size = norm([x, y]);
            if size > 0.0 {
                [x / size, y / size]
            } else {
                pole
            }
        };
        let caps = [[length - tip, 0.0], [blunt, 0.0]];
        let upper = towards(caps[0], [1.0, 0.0]);
        let lower = towards(caps[1], [-1.0, 0.0]);
        let outline = [
            Band::new(caps[0], tip, [[1.0, 0.0], upper]),
            Band::new(centre, radius, [upper, lower]),
            Band::new(caps[1], blunt, [lower, [-1.0, 0.0]]),
        ];
        Self::of_outline(&outline, &outline, density)
    }
}
