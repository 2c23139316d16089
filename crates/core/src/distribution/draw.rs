//! Random draws from the table by composition: first a node and a condition, then a quantile of that histogram.

use super::guide::Guide;
use super::{At, Layout, Mixture, in_blocks};
use crate::random::pair;
use crate::{Error, Monitor, Resources};

/// The quantile of u in [0, 1) of a histogram, `reached` of whose probabilities below edges are not above u.
#[inline]
fn quantile((edges, cumulative): (&[f64], &[f64]), reached: usize, u: f64) -> f64 {
    let bin = reached - 1;
    let slope = (edges[bin + 1] - edges[bin]) / (cumulative[bin + 1] - cumulative[bin]);
    edges[bin] + (u - cumulative[bin]) * slope
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
        let Layout { nodes, edges, .. } = &self.layout;
        // Guide tables cost a search for every edge, which does not pay for few draws.
        let many = out.len() > edges.len();
        let components = if many { nodes.components() } else { 0 };
        let guides: Vec<_> = (0..components)
            .map(|component| Guide::new(self.histogram(component).1))
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
                let histogram = self.histogram(component);
                let reached = match guides.get(component) {
                    Some(guide) => guide.reached(histogram.1, u2),
                    None => histogram.1.partition_point(|&below| below <= u2),
                };
                *out = if v.is_nan() || z.is_nan() {
                    f64::NAN
                } else {
                    quantile(histogram, reached, u2)
                };
            }
        })
    }
}
