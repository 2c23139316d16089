//! Solids of revolution with any profile.

use super::check_density;
use super::convex::{Convex, ConvexSurface};
use super::rigid::{Inertia, Rigid, Skin};
use crate::Error;
use crate::math::{GAUSS, Symmetric, Vector};
use crate::simd::elementary::{angle, sincos};
use std::f64::consts::PI;

/// A point (z, r) of a half-plane through the axis.
type Place = [f64; 2];

/// The surface that an arc of the profile makes as it turns about the axis, in units of R from the centre of mass: a band of a torus, the rim
/// of an edge or face where its radius is 0, a cap where its centre is on the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Band {
    /// The centre of the arc; its r is negative where the arc is wider than the body.
    pub centre: Place,
    pub radius: f64,
    /// Unit vectors from the centre to the ends of the arc, that nearer to the pole at +z first.
    pub ends: [Place; 2],
    /// The largest distance of a point of it from the centre of mass.
    pub reach: f64,
}

/// The length of a vector with these components. That of the platform's library has another last bit on another platform.
fn norm(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// Of what the support of a band is the sum, for a direction **u**: of z u_z, r |u_⊥| and ϱ|**u**|.
pub(crate) type Weights = [f64; 3];

impl Band {
    fn new(centre: Place, radius: f64, ends: [Place; 2]) -> Self {
        let mut band = Self {
            centre,
            radius,
            ends,
            reach: 0.0,
        };
        let [z, r] = centre;
        let distance = norm(z, r);
        // The farthest point of the arc is on the line through the centre of mass and its centre, or an end.
        band.reach = if distance > 0.0 {
            let [a, b, c] = band.weights(z / distance, r / distance);
            (a * z + b * r) / distance + c
        } else {
            radius
        };
        for [a, b] in ends {
            band.reach = band.reach.max(norm(z + radius * a, r + radius * b));
        }
        band
    }

    /// The same in units of `part` of the present one, in a body whose centre of mass is this far from the present one.
    pub fn scaled(self, part: f64, shift: f64) -> Self {
        Self {
            centre: self.centre.map(|x| x / part),
            radius: self.radius / part,
            ends: self.ends,
            reach: (self.reach + shift) / part,
        }
    }

    /// The weights of the support in a direction (u_z, |u_⊥|): those of the whole torus where the arc has that normal, else those of the
    /// rim at the nearer end.
    #[inline]
    pub fn weights(&self, along: f64, across: f64) -> Weights {
        let [z, r] = self.centre;
        if self.radius == 0.0 {
            return [z, r, 0.0];
        }
        let beyond = |[a, b]: Place| along * b - across * a;
        let end = match self.ends.map(beyond) {
            [first, _] if first > 0.0 => self.ends[0],
            [_, last] if last < 0.0 => self.ends[1],
            _ => return [z, r, self.radius],
        };
        [z + self.radius * end[0], r + self.radius * end[1], 0.0]
    }

    /// h = max **u**·**x** over its points, for a unit vector **u**.
    pub fn support(&self, u: Vector) -> f64 {
        let across = u.horizontal();
        let [a, b, c] = self.weights(u.z, across);
        a * u.z + b * across + c
    }

    /// The point that lies farthest in the direction of a unit vector **u**; along the axis, where all of a rim does, the one towards
    /// `tie`, or the centre of the rim.
    pub fn farthest(&self, u: Vector, tie: Vector) -> Vector {
        let across = u.horizontal();
        let [a, b, c] = self.weights(u.z, across);
        let (side, size) = if across > 0.0 {
            (u, across)
        } else {
            (tie, tie.horizontal().max(f64::MIN_POSITIVE))
        };
        let out = b / size;
        Vector::new(out * side.x, out * side.y, a) + u * c
    }
}

/// An arc of an outline, in m: its centre, its radius, and the directions from its centre to its beginning and its end.
#[derive(Debug, Clone, Copy)]
struct Arc {
    centre: Place,
    radius: f64,
    ends: [Place; 2],
}

impl Arc {
    fn point(centre: Place) -> Self {
        Self {
            centre,
            radius: 0.0,
            ends: [[1.0, 0.0], [-1.0, 0.0]],
        }
    }

    fn end(&self, number: usize) -> Place {
        let [a, b] = self.ends[number];
        [
            self.radius.mul_add(a, self.centre[0]),
            self.radius.mul_add(b, self.centre[1]),
        ]
    }
}

/// The integrals of r²/2, z r²/2, z² r²/2 and r⁴/4 over z.
type Sums = [f64; 4];

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
        let outline: Vec<_> = profile.iter().copied().map(Arc::point).collect();
        Self::of_outline(&outline, &hull(profile), density)
    }

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
        Error::unless(
            smaller,
            "tip",
            tip,
            "less than width/2, as blunt_end is not",
        )?;
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
            let size = norm(x, y);
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
            Arc {
                centre: caps[0],
                radius: tip,
                ends: [[1.0, 0.0], upper],
            },
            Arc {
                centre,
                radius,
                ends: [upper, lower],
            },
            Arc {
                centre: caps[1],
                radius: blunt,
                ends: [lower, [-1.0, 0.0]],
            },
        ];
        Self::of_outline(&outline, &outline, density)
    }

    /// Returns the rims of a solid of revolution that can touch, (z, r) in m, in the order of their numbers.
    pub fn rims(&self) -> Vec<[f64; 2]> {
        let Skin::Convex(Convex {
            surface: ConvexSurface::Bands(bands),
            frame,
            ..
        }) = &self.skin
        else {
            return Vec::new();
        };
        // The distance of the bands' origin from that of the axes is the same in both.
        let origin = match frame {
            Some(frame) => self.axes.rotate(frame.place(Vector::default())) * self.unit,
            None => Vector::default(),
        };
        let place = |band: &Band| {
            let [z, r] = band.centre.map(|x| self.unit * x);
            [self.inertia.centre.z + origin.z + z, r]
        };
        bands.iter().map(place).collect()
    }

    /// The solid that an outline makes, of which only these arcs can touch.
    fn of_outline(outline: &[Arc], touching: &[Arc], density: f64) -> Result<Self, Error> {
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
        let band = |scale: f64| {
            move |arc: &Arc| {
                let [z, r] = arc.centre;
                Band::new(
                    [(z - centre) / scale, r / scale],
                    arc.radius / scale,
                    arc.ends,
                )
            }
        };
        let unit = touching.iter().map(|arc| band(1.0)(arc).reach);
        let unit = unit.fold(0.0, f64::max);
        let bands = touching.iter().map(band(unit)).collect();
        let surface = Convex::new(ConvexSurface::Bands(bands));
        Self::new(inertia, unit, |_| Ok(Skin::Convex(surface)))
    }
}

/// The points of the convex hull of a profile and its mirror image that are not on the other side, from the pole at +z.
fn hull(profile: &[Place]) -> Vec<Arc> {
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
    chain.into_iter().map(Arc::point).collect()
}

/// Those of the solid that an outline makes, with z from `origin`.
fn sums(outline: &[Arc], origin: f64) -> Sums {
    let mut sums = [0.0; 4];
    let mut add = |parts: Sums| {
        for (sum, part) in sums.iter_mut().zip(parts) {
            *sum += part;
        }
    };
    for (arc, next) in outline.iter().zip(outline.iter().skip(1)) {
        add(line(arc.end(1), next.end(0), origin));
    }
    for arc in outline.iter().filter(|arc| arc.radius > 0.0) {
        let [from, to] = arc.ends.map(|[cosine, sine]| angle(sine, cosine));
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        // Polynomials in the sine and cosine of degree 6 at most, over half a turn at most: exact.
        for [node, weight] in GAUSS {
            for node in [-node, node] {
                let (sine, cosine) = sincos(middle + half * node);
                let z = arc.centre[0] - origin + arc.radius * cosine;
                let r = arc.centre[1] + arc.radius * sine;
                let (square, dz) = (r * r, -arc.radius * sine * half * weight);
                let disc = 0.5 * square * dz;
                add([disc, z * disc, z * z * disc, 0.5 * square * disc]);
            }
        }
    }
    sums
}

/// Those of a frustum.
fn line([z, a]: Place, [end, b]: Place, origin: f64) -> Sums {
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
