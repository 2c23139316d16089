//! Volume, centre and second moments of the union of balls.

use super::rigid::{RigidBall, VolumeMoments};
use crate::Error;
use crate::math::{Symmetric, Vector, add_to, gauss};
use crate::simd::elementary::{angle, sincos};
use crate::threads::go_on;
use std::f64::consts::PI;

/// Those of all balls, each by itself.
pub(super) fn sum(balls: &[RigidBall]) -> VolumeMoments {
    let each = balls.iter().map(ball);
    each.fold(VolumeMoments::default(), VolumeMoments::and)
}

/// A whole ball.
fn ball(ball: &RigidBall) -> VolumeMoments {
    let r = ball.radius;
    let volume = 4.0 / 3.0 * PI * (r * r * r);
    let second = 0.2 * volume * (r * r);
    VolumeMoments::about(volume, ball.centre, Symmetric::diagonal([second; 3]))
}

/// Largest difference between an interval and its halves, relative to the volume of the balls.
const EXACT: f64 = 1e-15;
/// Largest number of halvings.
const DEPTH: u32 = 48;
/// The depth below the edge of a cap, on the sphere of radius 1, from which a point counts as covered where it is asked which ends of arcs are
/// free: a few more cost little, and the places where edges nearly touch are known to the root of rounding.
const CLOSE: f64 = 1e-7;

/// A part of the sphere of a ball that may lie in another ball: there **n**·`apart` > `from`, **n** the direction from its centre.
struct Cap {
    apart: Vector,
    distance: f64,
    from: f64,
    /// The horizontal part of `apart`, and its azimuth.
    level: f64,
    azimuth: f64,
}

/// Integrals over the union of balls.
///
/// By Gauss's theorem with a field along z they are integrals over the free surface of each sphere. On a circle of latitude, at the height
/// μ on the sphere of radius 1, the integrals of 1, x, y, x², xy, y² over its free arcs are known. Between the heights where the free parts
/// of the edges of caps have an end, a highest or a lowest point, the same caps bound the same arcs, and the integrals are analytic but for
/// roots at the ends, which the substitution μ ∝ sin(πs/2) removes, so that Gauss's quadrature converges exponentially; intervals are halved
/// until the halves agree with the whole. Balls without a free edge, which lie in the others, cost a search for what covers each edge.
///
/// # Errors
/// [`Error::Cancelled`].
pub(super) fn union(balls: &[RigidBall]) -> Result<VolumeMoments, Error> {
    let all = sum(balls);
    let origin = all.first / all.content;
    let mut sums = [0.0; 10];
    for (i, own) in balls.iter().enumerate() {
        go_on()?;
        let Some(caps) = caps(balls, i) else { continue };
        let surface = CappedSphere {
            place: own.centre - origin,
            radius: own.radius,
            caps,
        };
        let scale = EXACT * all.content;
        for ends in surface.heights().windows(2) {
            surface.integrate([ends[0], ends[1]], scale, &mut sums);
        }
    }
    let [content, x, y, z, xx, yy, zz, xy, xz, yz] = sums;
    let second = Symmetric::from_rows([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
    // Moved back to where the balls are.
    let centre = Vector::new(x, y, z) / content;
    let own = VolumeMoments::about(-content, centre, second).second;
    Ok(VolumeMoments::about(content, centre + origin, own))
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
            azimuth(apart.x / level, apart.y / level)
        } else {
            0.0
        };
        caps.push(Cap {
            apart,
            distance,
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
    /// The heights μ from −1 to 1 between which the same caps bound the free arcs; none if nothing of the sphere is free.
    fn heights(&self) -> Vec<f64> {
        let mut heights = Vec::new();
        let mut order: Vec<_> = (0..self.caps.len()).collect();
        for (j, cap) in self.caps.iter().enumerate() {
            let edge = Edge::new(cap);
            let free = edge.free(&self.caps, j, &mut order);
            if free.is_empty() {
                continue;
            }
            let is_free = |angle: f64| free.iter().any(|&[a, b]| a <= angle && angle <= b);
            let square = cap.apart.dot(cap.apart);
            let root = (square - cap.from * cap.from).max(0.0).sqrt();
            for (sign, angle) in [(-1.0, PI), (1.0, 0.0)] {
                if is_free(angle) {
                    heights.push((cap.from * cap.apart.z + sign * root * cap.level) / square);
                }
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
                        if is_free(edge.angle(foot + across * (sign * rest.sqrt()))) {
                            heights.push(foot.z + sign * rest.sqrt() * across.z);
                        }
                    }
                }
            }
        }
        if self.caps.is_empty() || !heights.is_empty() {
            heights.extend([-1.0, 1.0]);
        }
        heights.retain(|height| (-1.0..=1.0).contains(height));
        heights.sort_by(f64::total_cmp);
        heights
    }

    /// Adds the integrals over an interval of heights.
    fn integrate(&self, [low, high]: [f64; 2], scale: f64, sums: &mut [f64; 10]) {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let arcs = self.arcs(middle);
        if high - low <= f64::EPSILON || arcs.as_ref().is_some_and(Vec::is_empty) {
            return;
        }
        let part = Zone {
            sphere: self,
            middle,
            half,
            arcs,
        };
        let whole = part.integral([-1.0, 1.0]);
        part.halved(([-1.0, 1.0], DEPTH), whole, scale, sums);
    }

    /// The free arcs of a circle of latitude, if any cap covers a part of it.
    fn arcs(&self, height: f64) -> Option<Vec<FreeArc>> {
        let level = (1.0 - height * height).max(0.0).sqrt();
        let mut covered = Vec::new();
        for (number, cap) in self.caps.iter().enumerate() {
            let (from, most) = (cap.from - height * cap.apart.z, level * cap.level);
            if from <= -most {
                return Some(Vec::new());
            }
            if from < most {
                let width = cap.width(height, level);
                let begin = turned(cap.azimuth - width);
                covered.push((begin, begin + 2.0 * width, number));
            }
        }
        covered.sort_by(|one, other| one.0.total_cmp(&other.0));
        let &(_, end, mut last) = covered.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let mut at = end - 2.0 * PI;
        let mut arcs = Vec::new();
        for (begin, end, number) in covered {
            if begin > at {
                let ends = [last, number];
                let [from, to] = self.ends(ends, height, level);
                let turns = ((begin - at - (to - from)) / (2.0 * PI)).round();
                arcs.push(FreeArc { ends, turns });
            }
            if end > at {
                (at, last) = (end, number);
            }
        }
        Some(arcs)
    }

    /// The azimuths where the first of two caps ends, and where the second begins, up to turns.
    fn ends(&self, [last, next]: [usize; 2], height: f64, level: f64) -> [f64; 2] {
        let (last, next) = (&self.caps[last], &self.caps[next]);
        [
            last.azimuth + last.width(height, level),
            next.azimuth - next.width(height, level),
        ]
    }
}

impl Cap {
    /// Half the arc of the circle at this height, whose radius is `level`, that lies in the cap.
    fn width(&self, height: f64, level: f64) -> f64 {
        let cosine = ((self.from - height * self.apart.z) / (level * self.level)).clamp(-1.0, 1.0);
        angle(((1.0 - cosine) * (1.0 + cosine)).sqrt(), cosine)
    }
}

/// An angle between −2π and 2π as one from −π to π.
fn turned(angle: f64) -> f64 {
    if angle > PI {
        angle - 2.0 * PI
    } else if angle < -PI {
        angle + 2.0 * PI
    } else {
        angle
    }
}

/// The edge of a cap: a circle on the sphere of radius 1, from its highest point on.
struct Edge {
    centre: Vector,
    /// The radii to its highest point, and to the point a quarter behind.
    axes: [Vector; 2],
    radius: f64,
}

impl Edge {
    fn new(cap: &Cap) -> Self {
        let a = cap.apart;
        let square = a.dot(a);
        let radius = (1.0 - cap.from * cap.from / square).max(0.0).sqrt();
        let norm = square.sqrt();
        let first = if cap.level > 0.0 {
            let (across, along) = (a.z / (norm * cap.level), cap.level / norm);
            Vector::new(-a.x * across, -a.y * across, along)
        } else {
            Vector::new(1.0, 0.0, 0.0)
        };
        Self {
            centre: a * (cap.from / square),
            axes: [first * radius, a.cross(first) * (radius / norm)],
            radius,
        }
    }

    /// The angle from the highest point, from −π to π, of a point of the edge.
    fn angle(&self, point: Vector) -> f64 {
        let [x, y] = self.axes.map(|axis| axis.dot(point));
        let square = self.radius * self.radius;
        azimuth(x / square, y / square)
    }

    /// The arcs of the edge of cap `own` that no other covers by more than [`CLOSE`], from −π to π; `order` is that in which the others are asked,
    /// those that covered the rest of an edge first.
    fn free(&self, caps: &[Cap], own: usize, order: &mut [usize]) -> Vec<[f64; 2]> {
        let mut free = vec![[-PI, PI]];
        for place in 0..order.len() {
            let (number, cap) = (order[place], &caps[order[place]]);
            let [x, y] = self.axes.map(|axis| product(axis, cap.apart));
            let reach = (x * x + y * y).sqrt();
            let from = cap.from + CLOSE * cap.distance - product(self.centre, cap.apart);
            if number == own || from >= reach {
                continue;
            }
            if from <= -reach {
                free.clear();
            } else {
                let (middle, cosine) = (azimuth(x / reach, y / reach), from / reach);
                let width = angle(((1.0 - cosine) * (1.0 + cosine)).sqrt(), cosine);
                for turn in [-2.0 * PI, 0.0, 2.0 * PI] {
                    let (begin, end) = (middle - width + turn, middle + width + turn);
                    let apart = |&[a, b]: &[f64; 2]| [[a, b.min(begin)], [a.max(end), b]];
                    if begin < PI && end > -PI {
                        free = free.iter().flat_map(apart).filter(|[a, b]| a < b).collect();
                    }
                }
            }
            if free.is_empty() {
                order[..=place].rotate_right(1);
                break;
            }
        }
        free
    }
}

/// The angle from −π to π whose cosine and sine these are.
fn azimuth(cosine: f64, sine: f64) -> f64 {
    angle(sine.abs(), cosine).copysign(sine)
}

/// The scalar product where speed counts more than the last bit.
fn product(a: Vector, b: Vector) -> f64 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// A free arc of circles of latitude: from the end of one cap to the beginning of another, and the turns from the azimuth of the
/// one to that of the other.
struct FreeArc {
    ends: [usize; 2],
    turns: f64,
}

/// The part of a sphere between two heights, where the same arcs are free, or the whole circle.
struct Zone<'a> {
    sphere: &'a CappedSphere,
    middle: f64,
    half: f64,
    arcs: Option<Vec<FreeArc>>,
}

impl Zone<'_> {
    fn halved(
        &self,
        ([low, high], depth): ([f64; 2], u32),
        whole: [f64; 10],
        scale: f64,
        sums: &mut [f64; 10],
    ) {
        let middle = 0.5 * (low + high);
        let parts = [[low, middle], [middle, high]];
        let [left, right] = parts.map(|part| self.integral(part));
        let off = (left[0] + right[0] - whole[0]).abs();
        if off <= scale || depth == 0 {
            add_to(sums, std::array::from_fn(|i| left[i] + right[i]));
            return;
        }
        for (part, found) in parts.into_iter().zip([left, right]) {
            self.halved((part, depth - 1), found, scale, sums);
        }
    }

    /// Gauss's quadrature in s from `low` to `high`, with μ = `middle` + `half` sin(πs/2).
    fn integral(&self, [low, high]: [f64; 2]) -> [f64; 10] {
        let mut sums = [0.0; 10];
        for (node, weight) in gauss() {
            let s = 0.5 * (low + high) + 0.5 * (high - low) * node;
            let (sine, cosine) = sincos(0.5 * PI * s);
            let measure = 0.25 * PI * (high - low) * weight * self.half * cosine;
            let circle = self.circle(self.middle + self.half * sine);
            add_to(&mut sums, circle.map(|value| measure * value));
        }
        sums
    }

    /// The integrand at a height: a field along z, whose divergence is 1, x, y, z, x², y², z², xy, xz, yz, through the free arcs there.
    fn circle(&self, height: f64) -> [f64; 10] {
        let level = (1.0 - height * height).max(0.0).sqrt();
        let (r, rho) = (self.sphere.radius, self.sphere.radius * level);
        let Vector { x, y, z } = self.sphere.place;
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
            add_to(&mut arcs, values);
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

    /// The free arcs at a height, between azimuths from −π to π.
    fn free(&self, height: f64, level: f64) -> Vec<[f64; 2]> {
        let Some(arcs) = &self.arcs else {
            return vec![[-PI, PI]];
        };
        let mut free = Vec::with_capacity(arcs.len() + 1);
        for arc in arcs {
            let [from, to] = self.sphere.ends(arc.ends, height, level);
            let length = to - from + 2.0 * PI * arc.turns;
            let (from, to) = (turned(from), turned(to));
            if length <= 0.0 {
                continue;
            }
            if to - from > length - PI {
                free.push([from, to]);
            } else {
                free.extend([[-PI, to], [from, PI]]);
            }
        }
        free.sort_by(|a, b| a[0].total_cmp(&b[0]));
        free
    }
}
