//! Solids of revolution with any profile.

use super::pieces::Extent;
use super::rigid::{Inertia, Rigid, homogeneous};
use super::surface::{Band, Bands, Convex, Place, RigidSurface};
use super::{BodyKind, Form, check_density};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::math::{Symmetric, Vector, add_to, gauss};
use crate::simd::elementary::{angle, sincos};
use std::f64::consts::PI;

/// The entry of a body with any profile in the table of bodies.
pub(super) const REVOLUTION: BodyKind = BodyKind::Rigid(Kind {
    name: "Revolution",
    text: "solid of revolution with any profile",
    parameters: homogeneous![Parameter::new(
        "profile",
        "points of the outline from one end to the other, r the distance from the axis",
        Some("m"),
        Allowed::Rows(&["z", "r"], 2, Interval::NOT_NEGATIVE),
        Argument::Numbers(&[0.0, 3e-3, 6e-3, 0.0]),
    ),],
    make: |given| {
        let profile = given.numbers(0).as_chunks().0;
        check_outline(profile)?;
        Ok(Form::Profile(profile.to_vec()))
    },
});

/// Refuses an outline with lines that cross.
fn check_outline(profile: &[Place]) -> Result<(), Error> {
    let side = |[x, y]: Place, [p, q]: Place, [u, v]: Place| {
        let turn = (p - x) * (v - y) - (q - y) * (u - x);
        if turn == 0.0 { 0.0 } else { turn.signum() }
    };
    for (i, line) in profile.windows(2).enumerate() {
        for (j, other) in profile[..i + 1].windows(2).enumerate() {
            let ([a, b], [c, d]) = ([line[0], line[1]], [other[0], other[1]]);
            if side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
                let allowed = format!(
                    "an outline whose lines do not cross; those from the points {j} and {i} cross"
                );
                return Err(Error::parameter("profile", profile.len(), allowed));
            }
        }
    }
    Ok(())
}

/// The integrals of r²/2, z r²/2, z² r²/2 and r⁴/4 over z.
type ProfileIntegrals = [f64; 4];

impl Rigid {
    /// The solid that a polygon of points (z, r), in m, makes when it turns about the axis r = 0. The lines from its ends to the axis
    /// are part of it, unless it ends where it begins.
    ///
    /// # Errors
    /// Unless all numbers are finite, r ≥ 0, the density positive, and the polygon has an area.
    pub fn revolution(profile: &[[f64; 2]], density: f64) -> Result<Self, Error> {
        for &[z, r] in profile {
            let allowed = "points (z, r), finite, r >= 0 (m)";
            Error::unless(z.is_finite(), "profile", z, allowed)?;
            Error::unless(r.is_finite() && r >= 0.0, "profile", r, allowed)?;
        }
        let outline: Vec<_> = profile.iter().copied().map(Band::rim).collect();
        Self::of_outline(&outline, &hull(profile), density)
    }

    /// Returns the rims of a solid of revolution that can touch, (z, r) in m, in the order of their numbers.
    pub fn rims(&self) -> Vec<[f64; 2]> {
        let RigidSurface::Bands(convex) = &self.surface else {
            return Vec::new();
        };
        // The distance of the bands' origin from that of the axes is the same in both.
        let origin = self.axes.rotate(convex.place().1) * self.unit;
        let place = |band: &Band| {
            let [z, r] = band.centre.map(|x| self.unit * x);
            [self.inertia.centre.z + origin.z + z, r]
        };
        convex.surface.0.iter().map(place).collect()
    }

    /// The solid that an outline makes, of which only these arcs can touch.
    pub(super) fn of_outline(
        outline: &[Band],
        touching: &[Band],
        density: f64,
    ) -> Result<Self, Error> {
        check_density(density)?;
        let from_origin = sums(outline, 0.0);
        let centre = from_origin[1] / from_origin[0];
        let [content, _, second, fourth] = sums(outline, centre);
        let solid = content != 0.0 && centre.is_finite();
        Error::unless(solid, "profile", outline.len(), "around an area")?;
        let mass = 2.0 * PI * density * content.abs();
        let axial = 2.0 * PI * density * fourth.abs();
        let transverse = 0.5 * axial + 2.0 * PI * density * second.abs();
        let inertia = Inertia {
            mass,
            centre: Vector::new(0.0, 0.0, centre),
            tensor: Symmetric::diagonal([transverse, transverse, axial]),
        };
        let band = |arc: &Band, scale: f64| {
            let [z, r] = arc.centre;
            let place = [(z - centre) / scale, r / scale];
            Band::new(place, arc.radius / scale, arc.ends)
        };
        let reaches = touching.iter().map(|arc| band(arc, 1.0).reach);
        let unit = reaches.fold(0.0, f64::max);
        let bands = touching.iter().map(|arc| band(arc, unit)).collect();
        let surface = Convex::new(Bands(bands));
        let within = sums(touching, centre)[0].abs() - content.abs();
        let concave = within > 1e-12 * content.abs();
        let extent = if concave { Extent::Other } else { Extent::Hull };
        Self::new(inertia, unit, extent, |_| Ok(surface.into()))
    }
}

/// The points of the convex hull of a profile and its mirror image that are not on the other side, from the pole at +z.
fn hull(profile: &[Place]) -> Vec<Band> {
    let mut points = profile.to_vec();
    points.sort_by(|a, b| b[0].total_cmp(&a[0]).then(b[1].total_cmp(&a[1])));
    let mut chain: Vec<Place> = Vec::new();
    for point in points {
        while let [.., first, last] = chain[..] {
            let turn = (last[0] - first[0]) * (point[1] - first[1])
                - (last[1] - first[1]) * (point[0] - first[0]);
            if turn > 0.0 {
                break;
            }
            chain.pop();
        }
        if chain.last().is_none_or(|last| last[0] > point[0]) {
            chain.push(point);
        }
    }
    chain.into_iter().map(Band::rim).collect()
}

/// Those of the solid that an outline makes, with z from `origin`.
fn sums(outline: &[Band], origin: f64) -> ProfileIntegrals {
    let mut sums = [0.0; 4];
    for (arc, next) in outline.iter().zip(outline.iter().skip(1)) {
        add_to(&mut sums, line(arc.end(1), next.end(0), origin));
    }
    for arc in outline.iter().filter(|arc| arc.radius > 0.0) {
        let [from, to] = arc.ends.map(|[cosine, sine]| angle(sine, cosine));
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        // Polynomials in the sine and cosine of degree 6 at most, over half a turn at most: exact.
        for (node, weight) in gauss() {
            let (sine, cosine) = sincos(middle + half * node);
            let z = arc.centre[0] - origin + arc.radius * cosine;
            let r = arc.centre[1] + arc.radius * sine;
            let (square, dz) = (r * r, -arc.radius * sine * half * weight);
            let disc = 0.5 * square * dz;
            add_to(
                &mut sums,
                [disc, z * disc, z * z * disc, 0.5 * square * disc],
            );
        }
    }
    sums
}

/// Those of a frustum.
fn line([z, a]: Place, [end, b]: Place, origin: f64) -> ProfileIntegrals {
    let (z, dz) = (z - origin, end - z);
    let (aa, ab, bb) = (a * a, a * b, b * b);
    let zeroth = (aa + ab + bb) / 3.0;
    let first = (aa + 2.0 * ab + 3.0 * bb) / 12.0;
    let second = (aa + 3.0 * ab + 6.0 * bb) / 30.0;
    let fourth = (aa * aa + aa * ab + aa * bb + ab * bb + bb * bb) / 5.0;
    [
        0.5 * zeroth,
        0.5 * (z * zeroth + dz * first),
        0.5 * (z * (z * zeroth + 2.0 * dz * first) + dz * dz * second),
        0.25 * fourth,
    ]
    .map(|mean| dz * mean)
}
