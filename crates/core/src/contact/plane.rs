//! The first contact of any body with the plane, certified: the scalar twin of `lanes/`.
//!
//! With **n**(t) the plane normal in the axes of the body, a point **p** of a ball of radius r has the gap f = z + **n**·**p** − r. In flight
//! |**n**″| ≤ cΩ², c = 1 + a/√3 ([`Top::acceleration`]), because **n**′ = **n** × **ω** and so **n**″ = **n**′ × **ω** + **n** × **ω**′, the
//! acceleration of a material unit vector. So f″ ≥ −(1 + cΩ²|**p**|): the parabola of f, f′ and that bound M lies below f, and its first root
//! is a step that cannot pass a contact.
//!
//! Of a convex body h(**v**) = max **v**·**x** over its points **x**, for all vectors **v**, is convex, and h(**v** + **w**) ≤ h(**v**) + h(**w**)
//! ≤ h(**v**) + R|**w**| with R the largest |**x**|. The gap is f = z − h(−**n**), and **n**(t + s) differs from **n** + s**n**′ by no more than
//! cΩ²s²/2; hence f(t + s) ≥ z + v s − h(−**n** − s**n**′) − (1 + cΩ²R)s²/2. This lower bound is concave, too, and has one root s > 0 behind which
//! it stays negative. It holds for rims, edges and flats alike.
//!
//! Steps to the first root of these bounds converge quadratically to the contact. The search ends when what a step leaves of the gap is below
//! the resolution. An overlap is rounding: one that approaches is a contact now, one that separates is none.

use super::certify::{SHORTEST, TOUCHING};
use crate::math::Vector;
use crate::shape::{Point, Skin};

/// Steps of Newton's method towards the root of the bound of a convex body.
const NEWTON: usize = 3;

/// A body over the plane at one time of its flight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instant {
    /// Height of the centre of mass and its rate.
    pub height: f64,
    pub rate: f64,
    /// **n** and **n**′, in the axes of the body.
    pub up: Vector,
    pub turning: Vector,
}

/// A part of the body whose gap is known exactly: the one on the plane at the beginning of a flight, and the speed at which it leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Departure {
    pub part: usize,
    pub speed: f64,
}

/// The time before which no part touches, and the part that may touch then.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub length: f64,
    pub part: usize,
    /// Whether its gap closes.
    pub closes: bool,
    /// M.
    pub bound: f64,
}

/// The first root ≥ 0 of f + f′s − Ms²/2 with f ≥ 0, in that of its two forms in which no digits cancel.
fn first_root(width: f64, rate: f64, bound: f64) -> f64 {
    let speed = rate.abs() + (rate * rate + 2.0 * bound * width).sqrt();
    if rate < 0.0 {
        2.0 * width / speed
    } else {
        speed.max(SHORTEST) / bound
    }
}

impl Skin {
    /// A step that passes no contact. `turn` is cΩ²; `departure` holds at the beginning of a flight.
    #[inline]
    pub(crate) fn step(&self, at: &Instant, turn: f64, departure: Option<Departure>) -> Step {
        match self {
            Self::Points(points) => {
                let mut first = Step::never();
                for (part, point) in points.iter().enumerate() {
                    let (width, rate) = match departure {
                        Some(left) if left.part == part => (0.0, left.speed),
                        _ => at.opening(point),
                    };
                    let bound = 1.0 + turn * point.distance;
                    let length = first_root(width.max(0.0), rate, bound);
                    if length < first.length {
                        first = Step {
                            length,
                            part,
                            closes: rate < 0.0,
                            bound,
                        };
                    }
                }
                first
            }
            Self::Ellipsoid(axes) => {
                let bound = 1.0 + turn;
                let gap = EllipsoidGap::new(*axes, at);
                let (width, rate) = match departure {
                    Some(left) => (0.0, left.speed),
                    None => (at.height - gap.support.0, gap.rate(0.0)),
                };
                Step {
                    length: gap.first_root(width.max(0.0), rate, bound),
                    part: 0,
                    closes: rate < 0.0,
                    bound,
                }
            }
        }
    }

    /// The point of a part that is nearest to the plane, from the centre of mass, in the axes of the body.
    pub(crate) fn nearest(&self, part: usize, up: Vector) -> Vector {
        match self {
            Self::Points(points) => points[part].place - up * points[part].radius,
            Self::Ellipsoid([a, b, c]) => {
                let stretched = Vector::new(a * up.x, b * up.y, c * up.z);
                let size = -1.0 / stretched.norm();
                Vector::new(a * stretched.x, b * stretched.y, c * stretched.z) * size
            }
        }
    }

    /// f″ of a part, with **n**″, but for gravity.
    pub(crate) fn curvature(&self, part: usize, at: &Instant, bending: Vector) -> f64 {
        match self {
            Self::Points(points) => points[part].place.dot(bending),
            Self::Ellipsoid(axes) => {
                // −h″, h² = |A(n + s n′ + s² n″/2)|².
                let gap = EllipsoidGap::new(*axes, at);
                let (h, slope) = gap.support;
                let [x, y, z] = axes.map(|axis| axis * axis);
                let bent = Vector::new(x * at.up.x, y * at.up.y, z * at.up.z).dot(bending);
                -(gap.square + bent - slope * slope) / h
            }
        }
    }

    /// Whether some part but one overlaps, or touches within rounding, and approaches faster than that one.
    pub(crate) fn another_touches(&self, departure: Departure, at: &Instant) -> bool {
        let Self::Points(points) = self else {
            return false;
        };
        let still = at.opening(&points[departure.part]).1;
        points.iter().enumerate().any(|(part, point)| {
            let (width, rate) = at.opening(point);
            part != departure.part && width <= TOUCHING && rate < still
        })
    }
}

impl Step {
    fn never() -> Self {
        Self {
            length: f64::INFINITY,
            part: 0,
            closes: false,
            bound: 1.0,
        }
    }
}

impl Instant {
    /// f and f′ of a ball or vertex.
    #[inline(always)]
    fn opening(&self, point: &Point) -> (f64, f64) {
        let (n, p, w) = (self.up, point.place, self.turning);
        (
            self.height + (n.x * p.x + n.y * p.y + n.z * p.z) - point.radius,
            self.rate + (w.x * p.x + w.y * p.y + w.z * p.z),
        )
    }
}

/// The gap of an ellipsoid whose normal **n** turns along its tangent: z + v s − √(|A**n**|² + 2s A**n**·A**n**′ + s²|A**n**′|²).
struct EllipsoidGap {
    /// v.
    speed: f64,
    /// h = |A**n**| and h′.
    support: (f64, f64),
    /// |A**n**′|².
    square: f64,
}

impl EllipsoidGap {
    fn new([a, b, c]: [f64; 3], at: &Instant) -> Self {
        let stretched = |v: Vector| Vector::new(a * v.x, b * v.y, c * v.z);
        let (one, other) = (stretched(at.up), stretched(at.turning));
        let h = one.norm();
        Self {
            speed: at.rate,
            support: (h, one.dot(other) / h),
            square: other.dot(other),
        }
    }

    /// The rate at which the gap opens.
    fn rate(&self, s: f64) -> f64 {
        let (h, slope) = self.support;
        self.speed - (h * slope + s * self.square) / self.support_at(s)
    }

    fn support_at(&self, s: f64) -> f64 {
        let (h, slope) = self.support;
        (h * h + s * (2.0 * h * slope + s * self.square))
            .max(0.0)
            .sqrt()
    }

    /// A time no later than the first root of the lower bound that begins with this gap and rate. Its tangents lie above it, so that Newton's
    /// method comes from behind the root; the last chord, which lies below it, ends in front of it.
    fn first_root(&self, width: f64, rate: f64, bound: f64) -> f64 {
        let (h, slope) = self.support;
        // What the support grows by beyond its tangent, without cancellation: (h² + 2s hh′ + s²k) − (h + s h′)² = s²(k − h′²).
        let spread = (self.square - slope * slope).max(0.0);
        let bulge = |s: f64| s * s * spread / (self.support_at(s) + (h + s * slope).abs());
        let value = |s: f64| {
            let tangent = h + s * slope;
            let beyond = if tangent >= 0.0 {
                bulge(s)
            } else {
                bulge(s) - 2.0 * tangent
            };
            width + s * (rate - 0.5 * bound * s) - beyond
        };
        let mut after = first_root(width, rate, bound);
        if spread == 0.0 {
            return after;
        }
        let mut before = (0.0, width);
        for _ in 0..NEWTON {
            let found = value(after);
            if found >= 0.0 {
                return after;
            }
            let fall = self.rate(after) - self.rate(0.0) + rate - bound * after;
            let next = after - found / fall;
            if !(next > before.0 && next < after) {
                break;
            }
            after = next;
        }
        // Where the gap is 0 at the beginning and opens, a point between it and the root.
        let mut inside = 0.5 * after;
        while before.1 <= 0.0 && rate > 0.0 {
            let found = value(inside);
            if found > 0.0 {
                before = (inside, found);
            }
            inside *= 0.5;
            if bound * inside <= SHORTEST {
                return SHORTEST / bound;
            }
        }
        let found = value(after);
        if found >= 0.0 {
            return after;
        }
        let chord = before.0 + (after - before.0) * before.1 / (before.1 - found);
        if rate < 0.0 {
            chord
        } else {
            chord.max(SHORTEST / bound)
        }
    }
}
