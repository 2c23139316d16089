//! Random draws from the table by composition: first a node and a condition, then a quantile of that histogram.

use super::mixture::place;
use super::{At, Mixture, in_blocks};
use crate::random::pair;
use crate::{Error, Means, Monitor};

/// A histogram with a guide table for its inverse distribution function.
struct Inverse<'a> {
    edges: &'a [f64],
    cumulative: &'a [f64],
    /// The last bin that starts at or below each of equally spaced probabilities; empty for few draws.
    guide: Vec<u32>,
}

impl<'a> Inverse<'a> {
    fn new((edges, cumulative): (&'a [f64], &'a [f64]), many: bool) -> Self {
        let steps = if many {
            edges.len().next_power_of_two()
        } else {
            0
        };
        let bin = |step| {
            let q = step as f64 / steps as f64;
            cumulative.partition_point(|&below| below <= q) as u32 - 1
        };
        Self {
            edges,
            cumulative,
            guide: (0..steps).map(bin).collect(),
        }
    }

    /// The quantile of u in [0, 1).
    #[inline]
    fn quantile(&self, u: f64) -> f64 {
        let bin = if self.guide.is_empty() {
            self.cumulative.partition_point(|&below| below <= u) - 1
        } else {
            let mut bin = self.guide[(u * self.guide.len() as f64) as usize] as usize;
            while self.cumulative[bin + 1] <= u {
                bin += 1;
            }
            bin
        };
        let slope = (self.edges[bin + 1] - self.edges[bin])
            / (self.cumulative[bin + 1] - self.cumulative[bin]);
        self.edges[bin] + (u - self.cumulative[bin]) * slope
    }
}

/// Chooses the right one of two neighbours with probability `weight`, else the left one, and returns a rescaled `u`, again uniform on
/// [0, 1).
#[inline]
fn choose(u: f64, (left, weight): (usize, f64)) -> (usize, f64) {
    if u < weight {
        (left + 1, u / weight)
    } else {
        (left, (u - weight) / (1.0 - weight))
    }
}

impl Mixture {
    /// Draws a restitution for each element of `out`. Draw i of a seed is the same however many there are and whatever the
    /// threads: it rests on two uniform numbers, u₁ for node and condition, u₂ for the quantile.
    pub fn rvs(
        &self,
        at: At,
        seed: u64,
        out: &mut [f64],
        means: Means,
        monitor: &Monitor,
    ) -> Result<(), Error> {
        let layout = &self.layout;
        // Guide tables cost a search for every edge, which does not pay for few draws.
        let many = out.len() > layout.edges.len();
        let components = if many { layout.conditions.len() } else { 0 };
        let inverses: Vec<_> = (0..components)
            .map(|component| Inverse::new(self.histogram(component), true))
            .collect();
        in_blocks(out, means, monitor, |first, block| {
            let (mut speed, mut site) = (f64::NAN, (0, 0.0));
            for (i, out) in block.iter_mut().enumerate() {
                let v = at.speed.at(first + i);
                if v != speed {
                    (speed, site) = (v, place(&layout.speeds, v));
                }
                let (u1, u2) = pair(seed, (first + i) as u64);
                let (node, rest) = choose(u1, site);
                let components = self.components(node);
                let z = at.condition.at(first + i);
                let condition = place(&layout.conditions[components.clone()], z);
                let component = components.start + choose(rest, condition).0;
                *out = if v.is_nan() || z.is_nan() {
                    f64::NAN
                } else if many {
                    inverses[component].quantile(u2)
                } else {
                    Inverse::new(self.histogram(component), false).quantile(u2)
                };
            }
        })
    }
}
