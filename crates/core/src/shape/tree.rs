//! The balls of a body in a tree, so that one that is looked for costs what those near it cost.
//!
//! The balls lie in one array in the order of the tree's leaves. Node i of level d holds those from (iN) >> d to ((i + 1)N) >> d; its halves
//! are nodes 2i and 2i + 1 of the next level, divided at the median of the longest side of what it holds. Of its balls, **p** and r, a node
//! knows what bounds gap and rate of each of them: with **c** their middle, **u** = **c**/|**c**|, **p** − **c** = a**u** + **b**, **b** ⊥ **u**,
//! and the cosine −**n**·**u** > 0
//!
//! r − **n**·(**p** − **c**) = cos a + r − **n**·**b** ≤ cos max(a + r) + (1 − cos) max r + sin max|**b**|,
//!
//! a disc that is as thin as the surface where the balls lie on one; and r − **n**·(**p** − **c**) ≤ max r + max|**p** − **c**| for every **n**.

use crate::Error;
use crate::math::Vector;
use crate::memory::filled;
use std::ops::Range;

/// Most balls of a leaf.
const LEAF: usize = 8;
/// Most levels of a tree.
const DEEPEST: usize = 32;
/// The enlargement of a node's bounds, which are rounded to single precision.
const ROUNDED: f64 = 1e-6;
/// Largest error of a sine where the cosine is off by 2⁻²³.
const SINE: f64 = 5e-4;

/// A ball or vertex of a body, in units of R and the principal axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    /// Its centre.
    pub place: Vector,
    pub radius: f64,
    /// No less than the distance of its centre from the centre of mass.
    pub reach: f32,
    /// Its number among those that the body was given.
    pub number: u32,
}

/// Bounds on the gaps of the balls of a node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Node {
    /// **c** and |**c**|.
    middle: [f32; 3],
    far: f32,
    /// The largest |**p** − **c**|, a + r, |**b**| and r.
    spread: f32,
    top: f32,
    side: f32,
    radius: f32,
}

/// The two halves of a node, in one line of the cache.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
struct Halves([Node; 2]);

/// The balls of a body.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Balls {
    points: Vec<Point>,
    /// Those of node i of level d have the number 2ᵈ − 1 + i.
    halves: Vec<Halves>,
    depth: usize,
}

/// Bounds for all balls of a node: their gaps and rates are no less than these, their |**p**| no more.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Least {
    pub gap: f64,
    pub rate: f64,
    pub reach: f64,
}

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

impl Point {
    pub fn new(place: Vector, radius: f64, number: usize) -> Self {
        Self {
            place,
            radius,
            reach: above(length(place)),
            number: number as u32,
        }
    }

    /// Gap and rate.
    #[inline(always)]
    pub fn opening(&self, at: &Instant) -> (f64, f64) {
        let (n, p, w) = (at.up, self.place, at.turning);
        (
            at.height + (n.x * p.x + n.y * p.y + n.z * p.z) - self.radius,
            at.rate + (w.x * p.x + w.y * p.y + w.z * p.z),
        )
    }
}

fn length(v: Vector) -> f64 {
    (v.x * v.x + v.y * v.y + v.z * v.z).sqrt()
}

/// A number in single precision that is larger by more than what is rounded where it is used.
fn above(x: f64) -> f32 {
    (x + ROUNDED * x.abs() + 1e-14) as f32
}

impl Node {
    fn new(points: &[Point]) -> Self {
        let [low, high] = sides(points);
        let middle = [0, 1, 2].map(|i| (0.5 * (low[i] + high[i])) as f32);
        let [x, y, z] = middle.map(f64::from);
        let c = Vector::new(x, y, z);
        let far = length(c);
        let u = if far > 0.0 { c / far } else { c };
        let (mut spread, mut top) = (0.0_f64, f64::NEG_INFINITY);
        let (mut side, mut radius) = (0.0_f64, 0.0_f64);
        for point in points {
            let from = point.place - c;
            let along = from.x * u.x + from.y * u.y + from.z * u.z;
            spread = spread.max(length(from));
            top = top.max(along + point.radius);
            side = side.max(length(from - u * along));
            radius = radius.max(point.radius);
        }
        Self {
            middle,
            far: far as f32,
            spread: above(spread),
            top: above(top),
            side: above(side),
            radius: above(radius),
        }
    }

    /// The bounds for its balls, where |**n**′| is `turning`.
    #[inline(always)]
    fn least(&self, at: &Instant, turning: f64) -> Least {
        let (x, y, z) = (
            f64::from(self.middle[0]),
            f64::from(self.middle[1]),
            f64::from(self.middle[2]),
        );
        let (far, spread) = (f64::from(self.far), f64::from(self.spread));
        let (n, w) = (at.up, at.turning);
        let across = n.x * x + n.y * y + n.z * z;
        let mut below = spread + f64::from(self.radius);
        if across < 0.0 {
            let cosine = (-across / far).min(1.0);
            let sine = (1.0 - cosine * cosine).sqrt() + SINE;
            let disc = cosine * f64::from(self.top)
                + (1.0 - cosine) * f64::from(self.radius)
                + sine * f64::from(self.side);
            below = below.min(disc);
        }
        Least {
            gap: at.height + across - below,
            rate: at.rate + (w.x * x + w.y * y + w.z * z) - turning * spread,
            reach: far + spread,
        }
    }
}

/// The least and the largest coordinates of the centres.
fn sides(points: &[Point]) -> [[f64; 3]; 2] {
    let mut sides = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for Point { place, .. } in points {
        for (i, x) in [place.x, place.y, place.z].into_iter().enumerate() {
            sides[0][i] = sides[0][i].min(x);
            sides[1][i] = sides[1][i].max(x);
        }
    }
    sides
}

/// The balls of node `i` of a level, of so many.
#[inline(always)]
fn range(balls: usize, level: usize, i: usize) -> (usize, usize) {
    ((i * balls) >> level, ((i + 1) * balls) >> level)
}

impl Balls {
    /// The balls in an order that depends on nothing but them; `what` is for the error.
    pub fn new(what: &'static str, mut points: Vec<Point>) -> Result<Self, Error> {
        let count = points.len();
        let leaves = count.div_ceil(LEAF).next_power_of_two();
        let depth = leaves.trailing_zeros() as usize;
        let mut halves = filled(what, Halves::default(), leaves - 1)?;
        for level in 0..depth {
            for i in 0..1 << level {
                let (low, high) = range(count, level, i);
                let (middle, _) = range(count, level + 1, 2 * i + 1);
                let part = &mut points[low..high];
                let [least, most] = sides(part);
                let [x, y, z] = [0, 1, 2].map(|i| most[i] - least[i]);
                let along: fn(&Point) -> f64 = if x >= y && x >= z {
                    |point| point.place.x
                } else if y >= z {
                    |point| point.place.y
                } else {
                    |point| point.place.z
                };
                part.select_nth_unstable_by(middle - low, |a, b| {
                    let order = along(a).total_cmp(&along(b));
                    order.then(a.number.cmp(&b.number))
                });
                let (first, second) = part.split_at(middle - low);
                halves[(1 << level) - 1 + i] = Halves([Node::new(first), Node::new(second)]);
            }
        }
        Ok(Self {
            points,
            halves,
            depth,
        })
    }

    /// The balls, each at its place in the tree.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The ball that costs least, of several the one that the body was given first. `exceeds` says whether every ball of a node, of which this
    /// is known, costs more than a limit, and `cost` gives that of a ball, or more than the limit if that is less. Nodes of which all balls
    /// cost more than a part `enough` of what is found need not be looked into. A ball that may be the one is asked first.
    #[inline(always)]
    pub fn cheapest(
        &self,
        at: &Instant,
        (first, enough): (Option<usize>, f64),
        exceeds: impl Fn(&Least, f64) -> bool,
        cost: impl Fn(usize, &Point, f64) -> f64,
    ) -> Cheapest {
        let mut best = Cheapest {
            cost: f64::INFINITY,
            place: 0,
            sure: f64::INFINITY,
        };
        if self.depth == 0 {
            self.ask(&mut best, 0..self.points.len(), &cost);
            return best;
        }
        if let Some(place) = first {
            self.ask(&mut best, place..place + 1, &cost);
        }
        let turning = length(at.turning);
        // Depth first, into the half that is lower.
        let all = Least {
            gap: f64::NEG_INFINITY,
            rate: f64::NEG_INFINITY,
            reach: f64::INFINITY,
        };
        let mut waiting = [(all, 0, 0); DEEPEST];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (least, level, i) = waiting[count];
            if exceeds(&least, best.cost) {
                continue;
            }
            if exceeds(&least, enough * best.cost) {
                best.sure = best.sure.min(enough * best.cost);
                continue;
            }
            if level == self.depth {
                let (low, high) = range(self.points.len(), level, i);
                self.ask(&mut best, low..high, &cost);
                continue;
            }
            let Halves([one, other]) = &self.halves[(1 << level) - 1 + i];
            let one = (one.least(at, turning), level + 1, 2 * i);
            let other = (other.least(at, turning), level + 1, 2 * i + 1);
            let lower = other.0.gap < one.0.gap;
            waiting[count] = if lower { one } else { other };
            waiting[count + 1] = if lower { other } else { one };
            count += 2;
        }
        best
    }

    #[inline(always)]
    fn ask(
        &self,
        best: &mut Cheapest,
        places: Range<usize>,
        cost: &impl Fn(usize, &Point, f64) -> f64,
    ) {
        for place in places {
            let point = &self.points[place];
            let found = cost(place, point, best.cost);
            if found < best.cost
                || (found == best.cost && point.number < self.points[best.place].number)
            {
                best.cost = found;
                best.place = place;
            }
        }
    }
}

/// The ball that costs least.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cheapest {
    pub cost: f64,
    /// Its place in the tree.
    pub place: usize,
    /// Balls that were not asked cost more than this.
    pub sure: f64,
}
