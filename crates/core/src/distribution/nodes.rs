//! Places of the components of a distribution, and the weight of each at an impact, for evaluation and for counting alike.

use super::guide::Guide;
use crate::Error;
use std::ops::Range;

/// Speeds and conditions of the components. A node is an impact velocity; it has one component, or one for each of its conditions.
#[derive(Debug)]
pub struct Nodes {
    speeds: Vec<f64>,
    guide: Guide,
    first: Vec<i64>,
    conditions: Vec<f64>,
}

/// The components with nonzero weight: those of up to two conditions at each of two nodes.
pub(super) struct Parts {
    list: [(usize, f64); 4],
    length: usize,
}

impl Parts {
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> {
        self.list[..self.length].iter().copied()
    }
}

/// Of two or more increasing points, `reached` of which are not above x: the left neighbour of x, and the weight of the right one.
#[inline]
fn between(points: &[f64], reached: usize, x: f64) -> (usize, f64) {
    let left = reached.clamp(1, points.len() - 1) - 1;
    let weight = (x - points[left]) / (points[left + 1] - points[left]);
    (left, weight.clamp(0.0, 1.0))
}

/// Returns whether numbers increase strictly.
fn rises(x: &[f64]) -> bool {
    x.windows(2).all(|pair| pair[0] < pair[1])
}

/// Returns whether `start` divides numbers into as many ranges as are wanted, of `least` numbers or more that increase strictly.
pub(super) fn divides(start: &[i64], wanted: usize, numbers: &[f64], least: i64) -> bool {
    start.len() == wanted + 1
        && start[0] == 0
        && start[wanted] == numbers.len() as i64
        && start.windows(2).all(|pair| pair[1] - pair[0] >= least)
        && (0..wanted).all(|i| rises(&numbers[range(start, i)]))
}

/// Range number `i` of those that begin at `start`, whose last element is the end of the last one.
#[inline]
pub(super) fn range(start: &[i64], i: usize) -> Range<usize> {
    start[i] as usize..start[i + 1] as usize
}

impl Nodes {
    /// Nodes at impact velocities in m/s that increase. The first component of each is given, and finally the number of components;
    /// the conditions of the components increase within a node.
    ///
    /// # Errors
    /// [`Error::Parameter`] for fewer than two nodes, one without a component, or what does not increase, and
    /// [`Error::Memory`].
    pub fn new(speeds: Vec<f64>, first: Vec<i64>, conditions: Vec<f64>) -> Result<Self, Error> {
        let sound =
            speeds.len() >= 2 && rises(&speeds) && divides(&first, speeds.len(), &conditions, 1);
        let allowed = "speeds that increase, and one condition or more for each, which increase";
        Error::unless(sound, "nodes", speeds.len(), allowed)?;
        Ok(Self {
            guide: Guide::new(&speeds)?,
            speeds,
            first,
            conditions,
        })
    }

    /// Number of nodes.
    pub(super) fn number(&self) -> usize {
        self.speeds.len()
    }

    /// Number of components of all nodes.
    pub(super) fn components(&self) -> usize {
        self.conditions.len()
    }

    /// The node below v, and the weight of the one above. Beyond the first or last node, that one alone has a weight.
    #[inline]
    pub(super) fn around(&self, v: f64) -> (usize, f64) {
        between(&self.speeds, self.guide.reached(&self.speeds, v), v)
    }

    /// The component of a node below z, and the weight of the one above.
    #[inline]
    pub(super) fn given(&self, node: usize, z: f64) -> (usize, f64) {
        let components = range(&self.first, node);
        let conditions = &self.conditions[components.clone()];
        if conditions.len() == 1 {
            return (components.start, 0.0);
        }
        let reached = conditions.partition_point(|&condition| condition <= z);
        let (below, weight) = between(conditions, reached, z);
        (components.start + below, weight)
    }

    /// Returns whether an impact counts: from the first node up to, not including, the last, with ε and z.
    #[inline]
    pub(super) fn counts(&self, (v, e, z): (f64, f64, f64)) -> bool {
        let inside = v >= self.speeds[0] && v < self.speeds[self.speeds.len() - 1];
        inside && e.is_finite() && z.is_finite()
    }

    /// The components around z at the nodes `around` v, with their weights, which add up to 1: linear interpolation between the
    /// nodes, and for each of them between the conditions.
    #[inline]
    pub(super) fn parts(&self, (left, right_share): (usize, f64), z: f64) -> Parts {
        let mut parts = Parts {
            list: [(0, 0.0); 4],
            length: 0,
        };
        for (node, share) in [(left, 1.0 - right_share), (left + 1, right_share)] {
            let (below, above_share) = self.given(node, z);
            for (component, part) in [(below, 1.0 - above_share), (below + 1, above_share)] {
                if share * part > 0.0 {
                    parts.list[parts.length] = (component, share * part);
                    parts.length += 1;
                }
            }
        }
        parts
    }
}
