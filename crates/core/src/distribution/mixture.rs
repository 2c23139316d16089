//! The distribution as a table: mixtures of the histograms of neighbouring nodes, with bins of any width.

use super::guide::Guide;
use super::nodes::{Nodes, Parts, divides, range};
use super::{Broadcast, in_blocks};
use crate::{Error, Monitor, Resources};

/// The table, in ragged arrays.
#[derive(Debug)]
pub struct Layout {
    /// The places of its components.
    pub nodes: Nodes,
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
    /// One to the edges of each component.
    guides: Vec<Guide>,
}

impl Mixture {
    /// The distribution with this table.
    ///
    /// # Errors
    /// [`Error::Parameter`] if the table is inconsistent or its values are not increasing, and [`Error::Memory`].
    pub fn new(layout: Layout) -> Result<Self, Error> {
        let Layout {
            nodes,
            start,
            edges,
            cumulative,
        } = &layout;
        let components = 0..nodes.components();
        let sound = divides(start, components.len(), edges, 2)
            && cumulative.len() == edges.len()
            && components.clone().all(|component| {
                let below = &cumulative[range(start, component)];
                below.is_sorted() && below[0] == 0.0 && below[below.len() - 1] == 1.0
            });
        let allowed =
            "edges and cumulative probabilities that increase, from 0 to 1, for each node";
        Error::unless(sound, "table", nodes.number(), allowed)?;
        let guides = components.map(|component| Guide::new(&edges[range(start, component)]));
        Ok(Self {
            guides: guides.collect::<Result<_, _>>()?,
            layout,
        })
    }

    /// Edges of a component, and the probability below each.
    pub(super) fn histogram(&self, component: usize) -> (&[f64], &[f64]) {
        let range = range(&self.layout.start, component);
        (
            &self.layout.edges[range.clone()],
            &self.layout.cumulative[range],
        )
    }

    /// Returns whether a bin is narrower than `point`.
    pub(super) fn has_points(&self, point: f64) -> bool {
        let components = 0..self.layout.nodes.components();
        let mut edges = components.map(|component| self.histogram(component).0);
        edges.any(|edges| edges.windows(2).any(|pair| pair[1] - pair[0] < point))
    }

    /// The bin of a component that x lies in, with lo ≤ x < hi.
    fn bin(&self, component: usize, x: f64) -> Option<usize> {
        let edges = self.histogram(component).0;
        let above = self.guides[component].reached(edges, x);
        (0 < above && above < edges.len()).then(|| above - 1)
    }

    /// The distribution function at x of a mixture of these parts.
    pub(super) fn below(&self, parts: &Parts, x: f64) -> f64 {
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
        if !(0.0..=1.0).contains(&q) {
            return f64::NAN;
        }
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

    /// A function of the distribution at each `x`.
    ///
    /// # Errors
    /// [`Error::Threads`].
    pub fn evaluate(
        &self,
        curve: Curve,
        x: Broadcast,
        at: At,
        out: &mut [f64],
        resources: Resources,
        monitor: &Monitor,
    ) -> Result<(), Error> {
        let value = match curve {
            Curve::Cdf => Self::below,
            Curve::Pdf => Self::density,
            Curve::Ppf => Self::quantile,
        };
        let nodes = &self.layout.nodes;
        in_blocks(out, resources, monitor, |first, block| {
            for (i, out) in block.iter_mut().enumerate() {
                let (x, v, z) = (
                    x.at(first + i),
                    at.speed.at(first + i),
                    at.condition.at(first + i),
                );
                *out = if x.is_nan() || v.is_nan() || z.is_nan() {
                    f64::NAN
                } else {
                    value(self, &nodes.parts(nodes.around(v), z), x)
                };
            }
        })
    }
}

/// A function of the distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Curve {
    /// Cumulative distribution function.
    Cdf,
    /// Probability density; bins are half-open, lo ≤ x < hi.
    Pdf,
    /// Quantile of a probability; NaN unless it is in [0, 1].
    Ppf,
}

impl Curve {
    /// The function with this name.
    ///
    /// # Errors
    /// [`Error::Parameter`] for an unknown name.
    pub fn named(name: &str) -> Result<Self, Error> {
        let all = [("cdf", Self::Cdf), ("pdf", Self::Pdf), ("ppf", Self::Ppf)];
        Error::chosen("what", name, &all)
    }
}

/// The conditions under which the distribution is evaluated.
#[derive(Debug, Clone, Copy)]
pub struct At<'a> {
    /// Impact velocity, in m/s.
    pub speed: Broadcast<'a>,
    /// Condition; ignored where the nodes have one component.
    pub condition: Broadcast<'a>,
}
