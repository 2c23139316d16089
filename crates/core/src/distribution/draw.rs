//! Random draws from the table by composition: first a node and a condition, then a quantile of that histogram.

use super::guide::Guide;
use super::{At, Mixture, in_blocks};
use crate::random::pair;
use crate::{Error, Monitor, Resources};

/// A histogram, with a guide to its distribution function where there are many draws.
struct Inverse<'a> {
    edges: &'a [f64],
    cumulative: &'a [f64],
    guide: Option<Guide>,
}

impl<'a> Inverse<'a> {
    fn new((edges, cumulative): (&'a [f64], &'a [f64]), guide: Option<Guide>) -> Self {
        Self {
            edges,
            cumulative,
            guide,
        }
    }

    fn guided(histogram: (&'a [f64], &'a [f64])) -> Result<Self, Error> {
        Ok(Self::new(histogram, Some(Guide::new(histogram.1)?)))
    }

    /// The quantile of u in [0, 1).
    #[inline]
    fn quantile(&self, u: f64) -> f64 {
        let reached = match &self.guide {
            Some(guide) => guide.reached(self.cumulative, u),
            None => self.cumulative.partition_point(|&below| below <= u),
        };
        let bin = reached - 1;
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
        resources: Resources,
        monitor: &Monitor,
    ) -> Result<(), Error> {
        let (layout, nodes) = (&self.layout, &self.layout.nodes);
        // Guide tables cost a search for every edge, which does not pay for few draws.
        let many = out.len() > layout.edges.len();
        let components = if many { nodes.components() } else { 0 };
        let inverses: Vec<_> = (0..components)
            .map(|component| Inverse::guided(self.histogram(component)))
            .collect::<Result<_, Error>>()?;
        in_blocks(out, resources, monitor, |first, block| {
            let (mut speed, mut site) = (f64::NAN, (0, 0.0));
            for (i, out) in block.iter_mut().enumerate() {
                let v = at.speed.at(first + i);
                if v != speed {
                    (speed, site) = (v, nodes.around(v));
                }
                let (u1, u2) = pair(seed, (first + i) as u64);
                let (node, rest) = choose(u1, site);
                let z = at.condition.at(first + i);
                let component = choose(rest, nodes.given(node, z)).0;
                *out = if v.is_nan() || z.is_nan() {
                    f64::NAN
                } else if many {
                    inverses[component].quantile(u2)
                } else {
                    Inverse::new(self.histogram(component), None).quantile(u2)
                };
            }
        })
    }
}
