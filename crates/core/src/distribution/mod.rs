//! A learned distribution p(ε | v): counted, evaluated, inverted and drawn from, on all cores.

mod batches;
mod counter;
mod draw;
mod guide;
mod levels;
mod mixture;
mod nodes;

pub use batches::Impacts;
pub use counter::{Counter, Counts};
pub use levels::{COARSE, FINE, Levels};
pub use mixture::{At, Curve, Layout, Mixture};
pub use nodes::Nodes;

use crate::{Error, Monitor, Resources};
use std::sync::Mutex;

/// Number of values that a thread computes at a time; up to this many are computed on the caller's thread.
pub const BLOCK: usize = 1 << 14;

/// One value for all elements, or one for each.
#[derive(Debug, Clone, Copy)]
pub struct Broadcast<'a>(&'a [f64]);

impl<'a> Broadcast<'a> {
    /// From a slice of one value, or of `length` values; `name` is for the error.
    ///
    /// # Errors
    /// [`Error::Parameter`] for any other number of values.
    pub fn new(values: &'a [f64], name: &'static str, length: usize) -> Result<Self, Error> {
        let allowed = "one value, or as many as are asked for";
        let size = values.len();
        Error::unless(size == 1 || size == length, name, size, allowed)?;
        Ok(Self(values))
    }

    fn at(&self, index: usize) -> f64 {
        self.0[if self.0.len() == 1 { 0 } else { index }]
    }
}

/// A vector of `size` zeros, or [`Error::Memory`].
pub fn values(size: usize) -> Result<Vec<f64>, Error> {
    crate::memory::zeros("size", size)
}

/// Fills `out` block by block with `fill(first, block)`. The result does not depend on the number of threads.
fn in_blocks(
    out: &mut [f64],
    resources: Resources,
    monitor: &Monitor,
    fill: impl Fn(usize, &mut [f64]) + Sync,
) -> Result<(), Error> {
    let fill = |(number, block): (usize, &mut [f64])| {
        if !monitor.is_cancelled() {
            fill(number * BLOCK, block);
        }
    };
    if out.len() <= BLOCK {
        fill((0, out));
        return Ok(());
    }
    let number = out.len().div_ceil(BLOCK);
    let blocks = Mutex::new(out.chunks_mut(BLOCK).enumerate());
    resources.each_thread(number, |_| {
        loop {
            let next = blocks.lock().expect("nobody panics who holds it").next();
            let Some(block) = next else { break };
            fill(block);
        }
    })?;
    Ok(())
}
