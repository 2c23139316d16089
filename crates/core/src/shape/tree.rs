//! The balls of a body in a tree, so that one that is looked for costs what those near it cost.
//!
//! The balls lie in one array in the order of the tree's leaves, behind the few that are much larger than the others, as a sphere is below its
//! asperities: a node that had one would reach far beyond all else that it holds. Of the others, node i of level d holds those from iN/4ᵈ to
//! (i + 1)N/4ᵈ; its quarters are nodes 4i to 4i + 3 of the next level: halves of halves, each divided at the median of the longest side of what
//! it holds. Of its balls, **p** and r, a node knows what bounds gap and rate of each of them: with **c** their middle, **u** = **c**/c,
//! **p** − **c** = a**u** + **b**, **b** ⊥ **u**, and α < π/2 the angle from **u** to −**n**,
//!
//! r − **n**·(**p** − **c**) = a cos α + r − **n**·**b** ≤ (a + r) cos α + r(1 − cos α) + b sin α.
//!
//! With the largest a + r, r and b this is the bound of a disc. Balls on a curved surface lie in the paraboloid a + r + b²/2c ≤ t about the same
//! axis, which is as thin as the surface: (a + r) cos α + b sin α ≤ (t − b²/2c) cos α + b sin α, which is largest at b = c tan α or at the
//! largest b. A node has the bound that is lower. And r − **n**·(**p** − **c**) ≤ max r + max|**p** − **c**| for every **n**.

use super::surface::NormalMotion;
use crate::Error;
use crate::math::Vector;
use crate::memory::filled;
use crate::simd::Pack;
use crate::threads::go_on;
#[cfg(test)]
use evaluations::Evaluation;
use pulp::Scalar;

/// Most balls of a leaf.
const LEAF: usize = 16;
/// Balls are in front of the tree, and asked one by one, if they are more than so many times as large as all but [`LEAF`].
const LARGE: f64 = 4.0;
/// Most levels of a tree.
const DEEPEST: usize = 16;
/// Where so many nodes wait the search goes depth first.
const CROWDED: usize = 32;
/// The enlargement of a node's bounds, which are rounded to single precision, and the largest error of its cosine.
const ROUNDED: f64 = 1e-6;
const COSINE: f64 = 2e-7;

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

/// Bounds of the gaps of the balls of the four quarters of a node, side by side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
struct Quarters {
    /// **c** and c, the latter negative for a paraboloid.
    middle: [[f32; 4]; 3],
    far: [f32; 4],
    /// The largest |**p** − **c**|, b and r.
    spread: [f32; 4],
    side: [f32; 4],
    radius: [f32; 4],
    /// The largest a + r, or t.
    top: [f32; 4],
}

/// The balls of a body.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BallTree {
    points: Vec<Point>,
    /// The number of those in front of the tree.
    large: usize,
    /// Those of node i of level d have the number (4ᵈ − 1)/3 + i.
    quarters: Vec<Quarters>,
    depth: usize,
}

/// Bounds for all balls of a node: their gaps and rates are no less than these, their |**p**| no more.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Least {
    pub gap: f64,
    pub rate: f64,
    pub reach: f64,
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
    pub fn opening(&self, at: &NormalMotion) -> (f64, f64) {
        let (n, p, w) = (at.up, self.place, at.turning);
        (
            at.height + (n.x * p.x + n.y * p.y + n.z * p.z) - self.radius,
            at.rate + (w.x * p.x + w.y * p.y + w.z * p.z),
        )
    }

    /// f″.
    #[inline(always)]
    pub fn acceleration(&self, at: &NormalMotion) -> f64 {
        at.acceleration + self.place.dot(at.bending)
    }
}

fn length(v: Vector) -> f64 {
    (v.x * v.x + v.y * v.y + v.z * v.z).sqrt()
}

/// A number in single precision that is larger by more than what is rounded where it is used.
fn above(x: f64) -> f32 {
    (x + ROUNDED * x.abs() + 1e-14) as f32
}

impl Quarters {
    /// Bounds the balls of quarter k.
    fn bound(&mut self, k: usize, points: &[Point]) {
        let [low, high] = sides(points);
        let middle = [0, 1, 2].map(|i| (0.5 * (low[i] + high[i])) as f32);
        let c = Vector::from(middle.map(f64::from));
        let far = length(c);
        let u = if far > 0.0 { c / far } else { c };
        let far = far as f32;
        let bulge = |side: f64| 0.5 * side * side / f64::from(far);
        let (mut spread, mut side, mut radius) = (0.0_f64, 0.0_f64, 0.0_f64);
        let (mut top, mut crown) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        for point in points {
            let from = point.place - c;
            let along = from.x * u.x + from.y * u.y + from.z * u.z;
            let across = length(from - u * along);
            spread = spread.max(length(from));
            side = side.max(across);
            radius = radius.max(point.radius);
            top = top.max(along + point.radius);
            crown = crown.max(along + point.radius + bulge(across));
        }
        let curved = crown < top + 0.5 * bulge(side);
        for (to, from) in self.middle.iter_mut().zip(middle) {
            to[k] = from;
        }
        self.far[k] = if curved { -far } else { far };
        self.spread[k] = above(spread);
        self.side[k] = above(side);
        self.radius[k] = above(radius);
        self.top[k] = above(if curved { crown } else { top });
    }

    /// The bounds for the balls of each, as of [`Least`], where |**n**′| is `turning`.
    #[inline(always)]
    fn least(&self, at: &NormalMotion, turning: f64) -> [Four; 3] {
        let (n, w) = (at.up, at.turning);
        let [x, y, z] = [0, 1, 2].map(|i| four(&self.middle[i]));
        let signed = four(&self.far);
        let (far, spread, radius) = (signed.abs(), four(&self.spread), four(&self.radius));
        let (side, top) = (four(&self.side), four(&self.top));
        let across = n.x * x + n.y * y + n.z * z;
        let inverse = 1.0 / far;
        let cosine = (-across * inverse).min(1.0);
        let (a, b, c) = (n.y * z - n.z * y, n.z * x - n.x * z, n.x * y - n.y * x);
        let sine = (a * a + b * b + c * c).sqrt() * inverse;
        let disc = cosine * top + sine * side;
        let within = cosine * top + (0.5 + ROUNDED) * far * sine * sine / cosine;
        let beyond = disc - cosine * (0.5 * side * side * inverse);
        let cap = (sine * far).lt(side * cosine).select(within, beyond);
        let surface = signed.lt(0.0).select(cap, disc);
        let lower = surface + ((1.0 + COSINE) - cosine) * radius;
        let round = spread + radius;
        let below = across.lt(0.0).select(round.min(lower), round);
        [
            across - below + at.height,
            w.x * x + w.y * y + w.z * z - turning * spread + at.rate,
            far + spread,
        ]
    }
}

/// Four numbers side by side.
type Four = Pack<Scalar, 4>;

#[inline(always)]
fn four(numbers: &[f32; 4]) -> Four {
    let mut all = Pack::splat(Scalar::new(), 0.0);
    for (to, from) in all.as_mut_slice().iter_mut().zip(numbers) {
        *to = f64::from(*from);
    }
    all
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
    let end = |i: usize| ((i as u64 * balls as u64) >> (2 * level)) as usize;
    (end(i), end(i + 1))
}

/// The number of the first node of a level.
#[inline(always)]
fn first(level: usize) -> usize {
    ((1 << (2 * level)) - 1) / 3
}

/// Puts the large in front, and returns how many there are.
fn large_first(points: &mut [Point]) -> usize {
    if points.len() <= LEAF {
        return 0;
    }
    let order = |one: &Point, other: &Point| {
        let sizes = other.radius.total_cmp(&one.radius);
        sizes.then(one.number.cmp(&other.number))
    };
    let (larger, next, _) = points.select_nth_unstable_by(LEAF, order);
    larger.sort_unstable_by(order);
    larger.partition_point(|point| point.radius > LARGE * next.radius)
}

/// Divides balls at the median of their longest side, so many in front of it.
fn divide(points: &mut [Point], front: usize) -> (&mut [Point], &mut [Point]) {
    let [least, most] = sides(points);
    let [x, y, z] = [0, 1, 2].map(|i| most[i] - least[i]);
    let along: fn(&Point) -> f64 = if x >= y && x >= z {
        |point| point.place.x
    } else if y >= z {
        |point| point.place.y
    } else {
        |point| point.place.z
    };
    points.select_nth_unstable_by(front, |a, b| {
        let order = along(a).total_cmp(&along(b));
        order.then(a.number.cmp(&b.number))
    });
    points.split_at_mut(front)
}

impl BallTree {
    /// The balls in an order that depends on nothing but them; `what` is for the error.
    pub fn new(what: &'static str, mut points: Vec<Point>) -> Result<Self, Error> {
        let large = large_first(&mut points);
        let tree = &mut points[large..];
        let count = tree.len();
        let mut depth = 0;
        while LEAF << (2 * depth) < count {
            depth += 1;
        }
        let mut quarters = filled(what, Quarters::default(), first(depth))?;
        for level in 0..depth {
            for i in 0..1 << (2 * level) {
                go_on()?;
                let (low, high) = range(count, level, i);
                let ends = [1, 2, 3].map(|k| range(count, level + 1, 4 * i + k).0);
                let [one, two, three] = ends.map(|end| end - low);
                let (front, back) = divide(&mut tree[low..high], two);
                let (a, b) = divide(front, one);
                let (c, d) = divide(back, three - two);
                for (k, part) in [a, b, c, d].into_iter().enumerate() {
                    quarters[first(level) + i].bound(k, part);
                }
            }
        }
        Ok(Self {
            points,
            large,
            quarters,
            depth,
        })
    }

    /// The balls, each at its place in the tree.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The ball that costs least, of several the one that the body was given first. `exceeds` says whether every ball of a node, of which this
    /// is known, costs more than a limit, and `cost` gives that of a ball, or infinity if it is more than a limit. `near` is a ball that may be
    /// the one, and is asked first.
    #[inline(always)]
    pub fn cheapest(
        &self,
        at: &NormalMotion,
        near: Option<usize>,
        effort: Pruning,
        exceeds: impl Fn(&Least, f64) -> bool,
        cost: impl Fn(usize, &Point, f64) -> f64,
    ) -> Cheapest {
        let mut best = Cheapest {
            cost: f64::INFINITY,
            place: 0,
            others: effort.most,
        };
        if self.depth == 0 {
            // Of all it is known when they can touch.
            self.ask(&mut best, 0..self.points.len(), |_| f64::INFINITY, &cost);
            return best;
        }
        let limit = |best: f64| effort.limits(best).0;
        self.ask(
            &mut best,
            near.into_iter().chain(0..self.large),
            limit,
            &cost,
        );
        let turning = length(at.turning);
        // Depth first, into the quarter that is lowest, or into one of its parent's siblings if that is lower.
        let all = Least {
            gap: f64::NEG_INFINITY,
            rate: f64::NEG_INFINITY,
            reach: f64::INFINITY,
        };
        let mut waiting = [(all, 0_u32, 0_u32); CROWDED + 3 * DEEPEST + 1];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (least, level, i) = waiting[count];
            if best.leaves_out(&least, effort, &exceeds) {
                continue;
            }
            let (deep, i) = (level as usize, i as usize);
            if deep == self.depth {
                let (low, high) = range(self.points.len() - self.large, deep, i);
                self.ask(&mut best, self.large + low..self.large + high, limit, &cost);
                continue;
            }
            #[cfg(test)]
            evaluations::add(Evaluation::Quarters);
            let nodes = self.quarters[first(deep) + i].least(at, turning);
            // The last is looked into first.
            let lower = if count < CROWDED {
                count.saturating_sub(3)
            } else {
                count
            };
            for k in 0..4 {
                let [gap, rate, reach] = nodes.each_ref().map(|four| four.as_slice()[k]);
                let node = Least { gap, rate, reach };
                if best.leaves_out(&node, effort, &exceeds) {
                    continue;
                }
                let mut place = count;
                while place > lower && waiting[place - 1].0.gap < gap {
                    waiting[place] = waiting[place - 1];
                    place -= 1;
                }
                waiting[place] = (node, level + 1, (4 * i + k) as u32);
                count += 1;
            }
        }
        best
    }

    #[inline(always)]
    fn ask(
        &self,
        best: &mut Cheapest,
        places: impl Iterator<Item = usize>,
        limit: impl Fn(f64) -> f64,
        cost: &impl Fn(usize, &Point, f64) -> f64,
    ) {
        for place in places {
            if place == best.place && best.cost < f64::INFINITY {
                continue;
            }
            #[cfg(test)]
            evaluations::add(Evaluation::Gap);
            let point = &self.points[place];
            let limit = limit(best.cost);
            let found = cost(place, point, limit);
            if found < best.cost
                || (found == best.cost && point.number < self.points[best.place].number)
            {
                best.others = best.others.min(best.cost);
                best.cost = found;
                best.place = place;
            } else {
                best.others = best.others.min(found.min(limit));
            }
        }
    }
}

/// The limits of a search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pruning {
    /// The cost from which nothing is looked for.
    pub most: f64,
    /// Nodes are not looked into where all balls cost more than this part of the best, unless that is below `short`: then others are looked
    /// for up to [`BEYOND`] times the best, so that it is known for how long it is the only one.
    pub enough: f64,
    pub short: f64,
}

/// See [`Pruning::short`].
const BEYOND: f64 = 1.0625;

impl Pruning {
    /// The one that costs least, whatever it is.
    pub const EXACT: Self = Self {
        most: f64::INFINITY,
        enough: 1.0,
        short: f64::NEG_INFINITY,
    };

    /// The cost up to which balls are looked for, and that up to which nodes are.
    #[inline(always)]
    fn limits(self, best: f64) -> (f64, f64) {
        let (balls, nodes) = if best < self.short {
            (BEYOND * best, BEYOND * best)
        } else {
            (best, self.enough * best)
        };
        (balls.min(self.most), nodes.min(self.most))
    }
}

/// The ball that costs least.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cheapest {
    pub cost: f64,
    /// Its place in the tree.
    pub place: usize,
    /// No other costs less than this.
    pub others: f64,
}

impl Cheapest {
    /// True if the balls of a node need not be asked; then it is known what they cost at least.
    #[inline(always)]
    fn leaves_out(
        &mut self,
        node: &Least,
        effort: Pruning,
        exceeds: &impl Fn(&Least, f64) -> bool,
    ) -> bool {
        let (balls, nodes) = effort.limits(self.cost);
        let limit = if exceeds(node, balls) {
            balls
        } else if nodes < balls && exceeds(node, nodes) {
            nodes
        } else {
            return false;
        };
        self.others = self.others.min(limit);
        true
    }
}

/// Counts of what a search evaluates, for `docs/shapes.md`.
#[cfg(test)]
pub(crate) mod evaluations {
    use std::cell::Cell;

    #[derive(Clone, Copy)]
    pub(crate) enum Evaluation {
        /// Attitude and spin of the body.
        Attitude,
        /// The gap of a ball or vertex.
        Gap,
        /// The bounds of the four quarters of a node.
        Quarters,
        /// The support function of a convex surface.
        Support,
    }

    thread_local! {
        static COUNTS: [Cell<u64>; 4] = const { [const { Cell::new(0) }; 4] };
    }

    pub(crate) fn add(what: Evaluation) {
        COUNTS.with(|counts| counts[what as usize].update(|count| count + 1));
    }

    /// The counts of this thread since the last call.
    pub(crate) fn taken() -> [u64; 4] {
        COUNTS.with(|counts| counts.each_ref().map(Cell::take))
    }
}
