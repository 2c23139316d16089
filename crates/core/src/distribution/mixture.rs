//! The distribution as a table: mixtures of the histograms of neighbouring nodes, with bins of any width.

use super::{Values, in_blocks};
use crate::{Error, Means, Monitor};

/// The table, in ragged arrays. A node is an impact velocity; it has one component, or one for each of its conditions.
#[derive(Debug, Clone)]
pub struct Layout {
    /// Impact velocities of the nodes in m/s, increasing, at least two.
    pub speeds: Vec<f64>,
    /// Index of the first component of each node, and finally the number of components.
    pub first: Vec<i64>,
    /// Condition of each component, increasing within a node.
    pub conditions: Vec<f64>,
    /// Index of the first edge of each component, and finally the number of edges.
    pub start: Vec<i64>,
    /// Edges of the bins of ε, increasing within a component, at least two.
    pub edges: Vec<f64>,
    /// Probability below each edge: from 0 to 1 within a component.
    pub cumulative: Vec<f64>,
}

/// p(ε | v, z) = Σ w_k(v, z) p_k(ε): linear interpolation between the nodes next to v, and for each of them between the conditions
/// next to z; the weights add up to 1. Beyond the first or last node or condition, that one alone is used.
#[derive(Debug)]
pub struct Mixture {
    pub(super) layout: Layout,
}

/// The components with nonzero weight: those of up to two conditions at each of two nodes.
pub(super) struct Parts {
    list: [(usize, f64); 4],
    length: usize,
}

impl Parts {
    fn iter(&self) -> impl Iterator<Item = (usize, f64)> {
        self.list[..self.length].iter().copied()
    }
}

/// The position of `x` among increasing `points`: the index of its left neighbour, and the weight of its right neighbour.
pub(super) fn place(points: &[f64], x: f64) -> (usize, f64) {
    if points.len() == 1 {
        return (0, 0.0);
    }
    let right = points.partition_point(|&point| point <= x);
    let left = right.clamp(1, points.len() - 1) - 1;
    let weight = (x - points[left]) / (points[left + 1] - points[left]);
    (left, weight.clamp(0.0, 1.0))
}

impl Mixture {
    /// The distribution with this table.
    ///
    /// # Errors
    /// [`Error::Parameter`] if the table is inconsistent or its values are not increasing.
    pub fn new(layout: Layout) -> Result<Self, Error> {
        let rises = |x: &[f64]| x.windows(2).all(|pair| pair[0] < pair[1]);
        let ranges = |start: &[i64], size: usize, least: i64| {
            start.first() == Some(&0)
                && start.last() == Some(&(size as i64))
                && start.windows(2).all(|pair| pair[1] - pair[0] >= least)
        };
        let Layout {
            speeds,
            first,
            conditions,
            start,
            edges,
            cumulative,
        } = &layout;
        let sound = speeds.len() >= 2
            && rises(speeds)
            && first.len() == speeds.len() + 1
            && ranges(first, conditions.len(), 1)
            && first
                .windows(2)
                .all(|range| rises(&conditions[range[0] as usize..range[1] as usize]))
            && start.len() == conditions.len() + 1
            && ranges(start, edges.len(), 2)
            && cumulative.len() == edges.len()
            && start.windows(2).all(|range| {
                let range = range[0] as usize..range[1] as usize;
                let below = &cumulative[range.clone()];
                rises(&edges[range])
                    && below.windows(2).all(|pair| pair[0] <= pair[1])
                    && below[0] == 0.0
                    && below[below.len() - 1] == 1.0
            });
        let allowed =
            "edges and cumulative probabilities that increase, from 0 to 1, for each node";
        Error::unless(sound, "table", speeds.len(), allowed)?;
        Ok(Self { layout })
    }

    /// Indices of the components of a node.
    pub(super) fn components(&self, node: usize) -> std::ops::Range<usize> {
        self.layout.first[node] as usize..self.layout.first[node + 1] as usize
    }

    /// Edges of a component, and the probability below each.
    pub(super) fn histogram(&self, component: usize) -> (&[f64], &[f64]) {
        let start = &self.layout.start[component..component + 2];
        let range = start[0] as usize..start[1] as usize;
        (
            &self.layout.edges[range.clone()],
            &self.layout.cumulative[range],
        )
    }

    fn parts(&self, v: f64, z: f64) -> Parts {
        let mut parts = Parts {
            list: [(0, 0.0); 4],
            length: 0,
        };
        let (left, right_share) = place(&self.layout.speeds, v);
        for (node, share) in [(left, 1.0 - right_share), (left + 1, right_share)] {
            let components = self.components(node);
            let (below, above_share) = place(&self.layout.conditions[components.clone()], z);
            for (component, part) in [(below, 1.0 - above_share), (below + 1, above_share)] {
                if share * part > 0.0 {
                    parts.list[parts.length] = (components.start + component, share * part);
                    parts.length += 1;
                }
            }
        }
        parts
    }

    /// The bin of a component that x lies in, with lo ≤ x < hi.
    fn bin(&self, component: usize, x: f64) -> Option<usize> {
        let edges = self.histogram(component).0;
        let above = edges.partition_point(|&edge| edge <= x);
        (0 < above && above < edges.len()).then(|| above - 1)
    }

    fn below(&self, parts: &Parts, x: f64) -> f64 {
        let below = |component| {
            let (edges, cumulative) = self.histogram(component);
            match self.bin(component, x) {
                Some(bin) => {
                    let slope =
                        (cumulative[bin + 1] - cumulative[bin]) / (edges[bin + 1] - edges[bin]);
                    cumulative[bin] + (x - edges[bin]) * slope
                }
                None if x < edges[0] => 0.0,
                None => 1.0,
            }
        };
        let (mut sum, mut certain) = (0.0, true);
        for (component, weight) in parts.iter() {
            let below = below(component);
            sum += weight * below;
            certain &= below == 1.0;
        }
        if certain { 1.0 } else { sum.min(1.0) } // the weights add up to 1 only up to rounding
    }

    fn density(&self, parts: &Parts, x: f64) -> f64 {
        let density = |component| {
            let (edges, cumulative) = self.histogram(component);
            self.bin(component, x).map_or(0.0, |bin| {
                (cumulative[bin + 1] - cumulative[bin]) / (edges[bin + 1] - edges[bin])
            })
        };
        let sum = parts
            .iter()
            .map(|(component, weight)| weight * density(component));
        sum.sum()
    }

    /// The smallest ε at which the distribution function reaches q. It is linear between neighbouring edges of all parts, which a
    /// binary search in each part finds.
    fn quantile(&self, parts: &Parts, q: f64) -> f64 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (component, _) in parts.iter() {
            let edges = self.histogram(component).0;
            low = low.min(edges[0]);
            high = high.max(edges[edges.len() - 1]);
        }
        if q <= 0.0 {
            return low;
        }
        for (component, _) in parts.iter() {
            let edges = self.histogram(component).0;
            let reached = edges.partition_point(|&edge| self.below(parts, edge) < q);
            if reached > 0 {
                low = low.max(edges[reached - 1]);
            }
            if reached < edges.len() {
                high = high.min(edges[reached]);
            }
        }
        let (start, end) = (self.below(parts, low), self.below(parts, high));
        if q < end {
            (low + (q - start) * ((high - low) / (end - start))).min(high)
        } else {
            high // exactly there, or beyond it by rounding
        }
    }

    /// Cumulative distribution function at each `x`.
    pub fn cdf(
        &self,
        x: Values,
        at: At,
        out: &mut [f64],
        means: Means,
        monitor: &Monitor,
    ) -> Result<(), Error> {
        self.each(x, at, out, means, monitor, Self::below)
    }

    /// Probability density at each `x`; bins are half-open, lo ≤ x < hi.
    pub fn pdf(
        &self,
        x: Values,
        at: At,
        out: &mut [f64],
        means: Means,
        monitor: &Monitor,
    ) -> Result<(), Error> {
        self.each(x, at, out, means, monitor, Self::density)
    }

    /// Quantile for each probability `q`; NaN unless 0 ≤ q ≤ 1.
    pub fn ppf(
        &self,
        q: Values,
        at: At,
        out: &mut [f64],
        means: Means,
        monitor: &Monitor,
    ) -> Result<(), Error> {
        self.each(q, at, out, means, monitor, |mixture, parts, q| {
            if (0.0..=1.0).contains(&q) {
                mixture.quantile(parts, q)
            } else {
                f64::NAN
            }
        })
    }

    fn each(
        &self,
        x: Values,
        at: At,
        out: &mut [f64],
        means: Means,
        monitor: &Monitor,
        value: impl Fn(&Self, &Parts, f64) -> f64 + Sync,
    ) -> Result<(), Error> {
        in_blocks(out, means, monitor, |first, block| {
            for (i, out) in block.iter_mut().enumerate() {
                let (x, v, z) = (
                    x.at(first + i),
                    at.speed.at(first + i),
                    at.condition.at(first + i),
                );
                *out = if x.is_nan() || v.is_nan() || z.is_nan() {
                    f64::NAN
                } else {
                    value(self, &self.parts(v, z), x)
                };
            }
        })
    }
}

/// The conditions under which the distribution is evaluated.
#[derive(Debug, Clone, Copy)]
pub struct At<'a> {
    /// Impact velocity, in m/s.
    pub speed: Values<'a>,
    /// Condition; ignored where the nodes have one component.
    pub condition: Values<'a>,
}
