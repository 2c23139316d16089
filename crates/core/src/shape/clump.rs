//! Clumps: unions of balls.

use super::rigid::{CENTRE, Rigid, RigidBall, TENSOR, VolumeMoments};
use super::{BodyKind, Form, check_density};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::math::{GAUSS, Symmetric, Vector};
use crate::simd::elementary::{angle, sincos};
use std::f64::consts::PI;

/// The matter of a clump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Matter {
    /// That of the union of the balls.
    Union,
    /// That of all balls, counted twice where they overlap, as some DEM codes do.
    Sum,
}

/// Its entry in the table of bodies. Its inertia may be a tensor, too.
pub(super) const CLUMP: BodyKind = BodyKind::Rigid(Kind {
    name: "Clump",
    text: "spheres fixed to each other",
    parameters: &[
        Parameter::new(
            "spheres",
            "centre and radius of each sphere",
            Some("m"),
            Allowed::Rows(&["x", "y", "z", "r"], 1, Interval::POSITIVE),
            Argument::Numbers(&[
                0.0, 2e-3, 0.0, 2e-3, -1.7e-3, -1e-3, 0.0, 2e-3, 1.7e-3, -1e-3, 0.0, 2e-3,
            ]),
        ),
        Parameter::density("density"),
        Parameter {
            text: "matter of the union of the spheres or of each by itself, or the tensor of inertia",
            allowed: Allowed::Name(&["union", "sum"]),
            default: Some(Argument::Name("union")),
            example: Argument::Name("union"),
            ..TENSOR
        },
        CENTRE,
    ],
    make: |given| {
        let ball = |&[x, y, z, radius]: &[f64; 4]| RigidBall {
            centre: Vector::new(x, y, z),
            radius,
        };
        let balls: Vec<_> = given.numbers(0).as_chunks().0.iter().map(ball).collect();
        let matter = match (given.name(2), given.numbers(2).is_empty()) {
            ("sum", _) => Matter::Sum,
            ("union", _) | (_, false) => Matter::Union,
            (other, _) => Error::chosen("inertia", other, &[("union", Matter::Union)])?,
        };
        Rigid::clump(&balls, given.number(1), matter).map(Form::from)
    },
});

impl Rigid {
    /// The union of balls with these centres and radii, in m.
    ///
    /// # Errors
    /// Without balls, or unless all numbers are finite and radii and density positive.
    pub fn clump(balls: &[RigidBall], density: f64, matter: Matter) -> Result<Self, Error> {
        check_density(density)?;
        check(balls)?;
        let moments = match matter {
            Matter::Union => union(balls).0,
            Matter::Sum => balls
                .iter()
                .map(whole)
                .fold(VolumeMoments::default(), VolumeMoments::and),
        };
        Self::of_balls(moments.inertia(density), "spheres", balls.iter().copied())
    }
}

pub(super) fn check(balls: &[RigidBall]) -> Result<(), Error> {
    Error::unless(!balls.is_empty(), "spheres", balls.len(), "one or more")?;
    for RigidBall { centre, radius } in balls {
        // Sizes in m whose fifth power is a number.
        let allowed = "rows (x, y, z, radius) in m, one or more, |x| to 1e+60, radius >= 1e-60";
        for x in [centre.x, centre.y, centre.z] {
            Error::unless(x.abs() <= 1e60, "spheres", x, allowed)?;
        }
        let positive = (1e-60..=1e60).contains(radius);
        Error::unless(positive, "spheres", *radius, allowed)?;
    }
    Ok(())
}

/// A whole ball.
fn whole(ball: &RigidBall) -> VolumeMoments {
    let r = ball.radius;
    let volume = 4.0 / 3.0 * PI * (r * r * r);
    let second = 0.2 * volume * (r * r);
    VolumeMoments::about(volume, ball.centre, Symmetric::diagonal([second; 3]))
}

/// Largest difference between an interval and its halves, relative to the volume of the balls.
const EXACT: f64 = 1e-15;
/// Largest number of halvings.
const DEPTH: u32 = 48;

/// A part of the sphere of a ball that may lie in another ball: there **n**·`apart` > `from`, **n** the direction from its centre.
struct Cap {
    apart: Vector,
    from: f64,
    /// The horizontal part of `apart`, and its azimuth.
    level: f64,
    azimuth: f64,
}

/// Integrals over the union of balls, and a bound on their errors relative to the volume of all balls.
///
/// By Gauss's theorem with a field along z they are integrals over the free surface of each sphere. On a circle of latitude, at the height
/// μ on the sphere of radius 1, its free arcs and the integrals of 1, x, y, x², xy, y² over them are known. Between the heights where an arc
/// begins to exist or meets another one they are analytic but for roots at the ends, which the substitution μ ∝ sin(πs/2) removes, so that
/// Gauss's quadrature converges exponentially; intervals are halved until the halves agree with the whole.
pub(super) fn union(balls: &[RigidBall]) -> (VolumeMoments, f64) {
    let all = balls
        .iter()
        .map(whole)
        .fold(VolumeMoments::default(), VolumeMoments::and);
    let origin = all.first / all.content;
    let mut sums = [0.0; 10];
    let mut error = 0.0;
    for (i, own) in balls.iter().enumerate() {
        let Some(caps) = caps(balls, i) else { continue };
        let surface = CappedSphere {
            place: own.centre - origin,
            radius: own.radius,
            caps,
        };
        let scale = EXACT * all.content;
        for ends in surface.heights().windows(2) {
            error += surface.integrate([ends[0], ends[1]], scale, &mut sums);
        }
    }
    let [content, x, y, z, xx, yy, zz, xy, xz, yz] = sums;
    let second = Symmetric::from_rows([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
    let centred = VolumeMoments {
        content,
        first: Vector::new(x, y, z),
        second,
    };
    // Moved back to where the balls are.
    let centre = centred.first / content;
    let own = VolumeMoments::about(-content, centre, second).second;
    let moved = VolumeMoments::about(content, centre + origin, own);
    (moved, error / all.content)
}

/// The part of the sphere of ball `i` that other balls cover; nothing is left of it if there are none.
fn caps(balls: &[RigidBall], i: usize) -> Option<Vec<Cap>> {
    let own = balls[i];
    let mut caps = Vec::new();
    for (j, other) in balls.iter().enumerate() {
        let apart = other.centre - own.centre;
        let distance = apart.norm();
        if j == i || distance >= own.radius + other.radius {
            continue;
        }
        let same = distance == 0.0 && own.radius == other.radius;
        if other.radius >= own.radius + distance && (!same || j < i) {
            return None;
        }
        if same || own.radius >= other.radius + distance {
            continue;
        }
        let difference = (own.radius - other.radius) * (own.radius + other.radius);
        let level = apart.horizontal();
        let azimuth = if level > 0.0 {
            angle(apart.y.abs() / level, apart.x / level).copysign(apart.y)
        } else {
            0.0
        };
        caps.push(Cap {
            apart,
            from: 0.5 * (distance * distance + difference) / own.radius,
            level,
            azimuth,
        });
    }
    Some(caps)
}

/// The sphere of a ball, with what covers it.
struct CappedSphere {
    place: Vector,
    radius: f64,
    caps: Vec<Cap>,
}

impl CappedSphere {
    /// The heights μ from −1 to 1 between which all integrals over circles are analytic.
    fn heights(&self) -> Vec<f64> {
        let mut heights = vec![-1.0, 1.0];
        for (j, cap) in self.caps.iter().enumerate() {
            let square = cap.apart.dot(cap.apart);
            let root = (square - cap.from * cap.from).max(0.0).sqrt();
            for sign in [-1.0, 1.0] {
                heights.push((cap.from * cap.apart.z + sign * root * cap.level) / square);
            }
            for other in &self.caps[..j] {
                // Where the edges of two caps meet.
                let (a, b) = (cap.apart, other.apart);
                let across = a.cross(b);
                let area = across.dot(across);
                let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
                let first = (cap.from * bb - other.from * ab) / area;
                let second = (other.from * aa - cap.from * ab) / area;
                let foot = a * first + b * second;
                let rest = (1.0 - foot.dot(foot)) / area;
                if rest > 0.0 && rest.is_finite() {
                    for sign in [-1.0, 1.0] {
                        heights.push(foot.z + sign * rest.sqrt() * across.z);
                    }
                }
            }
        }
        heights.retain(|height| (-1.0..=1.0).contains(height));
        heights.sort_by(f64::total_cmp);
        heights
    }

    /// Adds the integrals over an interval of heights, and returns what they may be off by.
    fn integrate(&self, [low, high]: [f64; 2], scale: f64, sums: &mut [f64; 10]) -> f64 {
        if high - low <= f64::EPSILON {
            return 0.0;
        }
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let whole = self.gauss([middle, half], [-1.0, 1.0]);
        self.halved([middle, half], ([-1.0, 1.0], DEPTH), whole, scale, sums)
    }

    fn halved(
        &self,
        interval: [f64; 2],
        ([low, high], depth): ([f64; 2], u32),
        whole: [f64; 10],
        scale: f64,
        sums: &mut [f64; 10],
    ) -> f64 {
        let middle = 0.5 * (low + high);
        let parts = [[low, middle], [middle, high]];
        let [left, right] = parts.map(|part| self.gauss(interval, part));
        let off = (left[0] + right[0] - whole[0]).abs();
        if off <= scale || depth == 0 {
            for (sum, (left, right)) in sums.iter_mut().zip(left.iter().zip(right)) {
                *sum += left + right;
            }
            return off;
        }
        let mut error = 0.0;
        for (part, found) in parts.into_iter().zip([left, right]) {
            error += self.halved(interval, (part, depth - 1), found, scale, sums);
        }
        error
    }

    /// Gauss's quadrature in s from `low` to `high`, with μ = `middle` + `half` sin(πs/2).
    fn gauss(&self, [middle, half]: [f64; 2], [low, high]: [f64; 2]) -> [f64; 10] {
        let mut sums = [0.0; 10];
        for [node, weight] in GAUSS {
            for node in [-node, node] {
                let s = 0.5 * (low + high) + 0.5 * (high - low) * node;
                let (sine, cosine) = sincos(0.5 * PI * s);
                let measure = 0.25 * PI * (high - low) * weight * half * cosine;
                let circle = self.circle(middle + half * sine);
                for (sum, value) in sums.iter_mut().zip(circle) {
                    *sum += measure * value;
                }
            }
        }
        sums
    }

    /// The integrand at a height: a field along z, whose divergence is 1, x, y, z, x², y², z², xy, xz, yz, through the free arcs there.
    fn circle(&self, height: f64) -> [f64; 10] {
        let level = (1.0 - height * height).max(0.0).sqrt();
        let (r, rho) = (self.radius, self.radius * level);
        let Vector { x, y, z } = self.place;
        let z = z + r * height;
        // ∫dφ, and ∫ of cos φ, sin φ, cos² φ and cos φ sin φ.
        let mut arcs = [0.0; 5];
        for [from, to] in self.free(height, level) {
            let ((s1, c1), (s2, c2)) = (sincos(from), sincos(to));
            let length = to - from;
            let values = [
                length,
                s2 - s1,
                c1 - c2,
                0.5 * (length + s2 * c2 - s1 * c1),
                0.5 * (s2 - s1) * (s2 + s1),
            ];
            for (sum, value) in arcs.iter_mut().zip(values) {
                *sum += value;
            }
        }
        let [one, cosine, sine, square, product] = arcs;
        let (ix, iy) = (x * one + rho * cosine, y * one + rho * sine);
        let ixx = x * (x * one + 2.0 * rho * cosine) + rho * rho * square;
        let iyy = y * (y * one + 2.0 * rho * sine) + rho * rho * (one - square);
        let ixy = x * (y * one + rho * sine) + rho * (y * cosine + rho * product);
        let flux = r * r * height;
        [
            z * one,
            z * ix,
            z * iy,
            0.5 * z * z * one,
            z * ixx,
            z * iyy,
            z * z * z / 3.0 * one,
            z * ixy,
            0.5 * z * z * ix,
            0.5 * z * z * iy,
        ]
        .map(|field| flux * field)
    }

    /// The arcs of a circle of latitude that no cap covers.
    fn free(&self, height: f64, level: f64) -> Vec<[f64; 2]> {
        let mut covered = Vec::new();
        for cap in &self.caps {
            let (from, most) = (cap.from - height * cap.apart.z, level * cap.level);
            if from >= most {
                continue;
            }
            if from <= -most {
                return Vec::new();
            }
            let cosine = from / most;
            let width = angle(((1.0 - cosine) * (1.0 + cosine)).sqrt(), cosine);
            let (begin, end) = (cap.azimuth - width, cap.azimuth + width);
            for turn in [-2.0 * PI, 0.0, 2.0 * PI] {
                let (begin, end) = ((begin + turn).max(-PI), (end + turn).min(PI));
                if begin < end {
                    covered.push([begin, end]);
                }
            }
        }
        covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut free = Vec::new();
        let mut at = -PI;
        for [begin, end] in covered {
            if begin > at {
                free.push([at, begin]);
            }
            at = at.max(end);
        }
        if at < PI {
            free.push([at, PI]);
        }
        free
    }
}
