//! Impacts counted at the components of a distribution that is learned: each is shared among them as the mixture will weight them.

use super::batches::{Impacts, STRIDE};
use super::guide::Guide;
use super::nodes::{Nodes, divides, range};
use crate::memory::{empty, filled, zeros};
use crate::{Error, Monitor, Resources};

/// The argument that determines the memory of the counts.
const ROOM: &str = "velocities";

/// Counts of the impacts in the bins of each component, and sums of their ε, batch by batch.
#[derive(Debug)]
pub struct Counter {
    nodes: Nodes,
    start: Vec<i64>,
    edges: Vec<f64>,
    /// One to the edges of each component.
    guides: Vec<Guide>,
    batches: Vec<CountedBatch>,
}

#[derive(Debug)]
struct CountedBatch {
    count: Vec<f64>,
    powers: [Vec<f64>; 3],
    lowest: Vec<f64>,
    highest: Vec<f64>,
    seen: [Vec<f64>; 2],
}

/// Sums of the weights of impacts. Bins of all components follow each other; a component has one more of them than inner edges.
#[derive(Debug)]
pub struct Counts {
    /// Σw in each bin, shape (batch, bin).
    pub count: Vec<f64>,
    /// Σw, Σwx and Σwx², x being ε above one of the edges in the middle, shape (3, batch, component).
    pub powers: Vec<f64>,
    /// Least ε of each component.
    pub lowest: Vec<f64>,
    /// Greatest ε of each component.
    pub highest: Vec<f64>,
    /// Least and greatest condition of the impacts next to each node, shape (2, node).
    pub seen: Vec<f64>,
}

impl Counter {
    /// No impacts yet. The inner edges of the bins of ε follow each other from component to component: those of each begin at
    /// `start`, whose last element is their number. The outermost bins are open.
    ///
    /// # Errors
    /// [`Error::Parameter`] for nodes or edges that do not increase, and [`Error::Memory`].
    pub fn new(
        nodes: Nodes,
        start: Vec<i64>,
        edges: Vec<f64>,
        batches: usize,
    ) -> Result<Self, Error> {
        let components = nodes.components();
        let sound = divides(&start, components, &edges, 1);
        let allowed = "increasing, one or more for each component";
        Error::unless(sound, "edges", edges.len(), allowed)?;
        Error::unless(batches > 0, "batches", batches, "> 0")?;
        let batches = (0..batches).map(|_| CountedBatch::new(&nodes, components + edges.len()));
        let batches = batches.collect::<Result<_, _>>()?;
        let guides = (0..components).map(|component| Guide::new(&edges[range(&start, component)]));
        Ok(Self {
            guides: guides.collect::<Result<_, _>>()?,
            nodes,
            start,
            edges,
            batches,
        })
    }

    /// Counts the impacts from the first node up to, not including, the last; those with ε or z that is not finite do not count.
    ///
    /// # Errors
    /// [`Error::Threads`].
    pub fn add(
        &mut self,
        impacts: &Impacts<'_>,
        resources: Resources,
        monitor: &Monitor,
    ) -> Result<(), Error> {
        let Self {
            nodes,
            start,
            edges,
            guides,
            batches,
        } = self;
        let own = || empty(ROOM, 4 * STRIDE);
        impacts.count_in(
            batches,
            (resources, monitor),
            own,
            drop,
            |batch, shares, cells| {
                for cell in cells {
                    let impact = impacts.at(cell);
                    if !nodes.counts(impact) {
                        continue;
                    }
                    let (v, e, z) = impact;
                    let around = nodes.around(v);
                    batch.see(around.0, z);
                    for (component, weight) in nodes.parts(around, z).iter() {
                        let range = range(start, component);
                        let inner = &edges[range.clone()];
                        let bin = range.start + component + guides[component].reached(inner, e);
                        batch.add(component, weight, e, inner[inner.len() / 2]);
                        shares.push((bin, weight));
                    }
                }
                // Apart from the searches, which would wait for memory that is far away.
                for (bin, weight) in shares.drain(..) {
                    batch.count[bin] += weight;
                }
            },
        )
    }

    /// Returns the counts.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn counts(&self) -> Result<Counts, Error> {
        let bins = self.nodes.components() + self.edges.len();
        let mut count = zeros(ROOM, self.batches.len() * bins)?;
        for (all, batch) in count.chunks_mut(bins).zip(&self.batches) {
            all.copy_from_slice(&batch.count);
        }
        let powers = (0..3).flat_map(|k| self.batches.iter().flat_map(move |b| &b.powers[k]));
        let over = |values: &dyn Fn(&CountedBatch) -> &[f64], choose: fn(f64, f64) -> f64| {
            let mut found = values(&self.batches[0]).to_vec();
            for batch in &self.batches[1..] {
                for (found, &value) in found.iter_mut().zip(values(batch)) {
                    *found = choose(*found, value);
                }
            }
            found
        };
        let mut seen = over(&|batch| &batch.seen[0], f64::min);
        seen.extend(over(&|batch| &batch.seen[1], f64::max));
        Ok(Counts {
            count,
            powers: powers.copied().collect(),
            lowest: over(&|batch| &batch.lowest, f64::min),
            highest: over(&|batch| &batch.highest, f64::max),
            seen,
        })
    }
}

impl CountedBatch {
    fn new(nodes: &Nodes, bins: usize) -> Result<Self, Error> {
        let (speeds, components) = (nodes.number(), nodes.components());
        let zeros = |size| zeros(ROOM, size);
        let full = |value: f64, size| filled(ROOM, value, size);
        Ok(Self {
            count: zeros(bins)?,
            powers: [zeros(components)?, zeros(components)?, zeros(components)?],
            lowest: full(f64::INFINITY, components)?,
            highest: full(f64::NEG_INFINITY, components)?,
            seen: [
                full(f64::INFINITY, speeds)?,
                full(f64::NEG_INFINITY, speeds)?,
            ],
        })
    }

    /// A condition of an impact between a node and the next one.
    #[inline]
    fn see(&mut self, left: usize, z: f64) {
        for node in [left, left + 1] {
            self.seen[0][node] = self.seen[0][node].min(z);
            self.seen[1][node] = self.seen[1][node].max(z);
        }
    }

    /// Adds ε to the sums of a component, which are those about `middle`.
    #[inline]
    fn add(&mut self, component: usize, weight: f64, e: f64, middle: f64) {
        let above = e - middle;
        self.powers[0][component] += weight;
        self.powers[1][component] += weight * above;
        self.powers[2][component] += weight * (above * above);
        self.lowest[component] = self.lowest[component].min(e);
        self.highest[component] = self.highest[component].max(e);
    }
}
