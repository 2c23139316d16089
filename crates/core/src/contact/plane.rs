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
use super::convex::{BandSupport, Length, convex_root};
use crate::math::Vector;
use crate::shape::{Band, Point, Skin};

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
pub(super) fn first_root(width: f64, rate: f64, bound: f64) -> f64 {
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
                let support = Length::of_ellipsoid(*axes, at);
                let (width, rate) = match departure {
                    Some(left) => (0.0, left.speed),
                    None => (at.height - support.size, at.rate - support.slope),
                };
                Step {
                    length: convex_root(&support, width.max(0.0), rate, bound),
                    part: 0,
                    closes: rate < 0.0,
                    bound,
                }
            }
            Self::Bands(bands) => {
                let mut first = Step::never();
                for (part, band) in bands.iter().enumerate() {
                    let support = BandSupport::new(band, at);
                    let (width, rate) = match departure {
                        // Flat on its rim a body has no single point there, whose speed that is.
                        Some(left) if left.part == part && !support.is_flat() => (0.0, left.speed),
                        Some(left) if left.part == part => (0.0, at.rate - support.slope),
                        _ => (at.height - support.size, at.rate - support.slope),
                    };
                    let bound = 1.0 + turn * band.reach;
                    let length = convex_root(&support, width.max(0.0), rate, bound);
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
        }
    }

    /// The point of a part that is nearest to the plane, from the centre of mass, in the axes of the body; of several the one that
    /// comes down first, while **n** changes with **n**′.
    pub(crate) fn nearest(&self, part: usize, up: Vector, turning: Vector) -> Vector {
        match self {
            Self::Points(points) => points[part].place - up * points[part].radius,
            Self::Ellipsoid([a, b, c]) => {
                let stretched = Vector::new(a * up.x, b * up.y, c * up.z);
                let size = -1.0 / stretched.norm();
                Vector::new(a * stretched.x, b * stretched.y, c * stretched.z) * size
            }
            Self::Bands(bands) => bands[part].farthest(up * -1.0, turning * -1.0),
        }
    }

    /// f″ of a part, with **n**″, but for gravity.
    pub(crate) fn curvature(&self, part: usize, at: &Instant, bending: Vector) -> f64 {
        match self {
            Self::Points(points) => points[part].place.dot(bending),
            Self::Ellipsoid(axes) => {
                let [x, y, z] = axes.map(|axis| axis * axis);
                let bent = Vector::new(x * at.up.x, y * at.up.y, z * at.up.z).dot(bending);
                -Length::of_ellipsoid(*axes, at).bent(bent)
            }
            Self::Bands(bands) => BandSupport::new(&bands[part], at).curvature(at, bending),
        }
    }

    /// Whether some part but one overlaps, or touches within rounding, and approaches faster than that one.
    pub(crate) fn another_touches(&self, departure: Departure, at: &Instant) -> bool {
        let touches = |(width, rate): (f64, f64), still: f64| width <= TOUCHING && rate < still;
        match self {
            Self::Points(points) => {
                let still = at.opening(&points[departure.part]).1;
                points.iter().enumerate().any(|(part, point)| {
                    part != departure.part && touches(at.opening(point), still)
                })
            }
            Self::Ellipsoid(_) => false,
            Self::Bands(bands) => {
                let opening = |band: &Band| {
                    let support = BandSupport::new(band, at);
                    (at.height - support.size, at.rate - support.slope)
                };
                let still = opening(&bands[departure.part]).1;
                bands
                    .iter()
                    .enumerate()
                    .any(|(part, band)| part != departure.part && touches(opening(band), still))
            }
        }
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
