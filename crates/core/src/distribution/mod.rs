//! A learned distribution p(ε | v): evaluated, inverted and drawn from, on all cores.

mod draw;
mod mixture;

pub use mixture::{At, Layout, Mixture};

use crate::{Error, Means, Monitor};
use std::sync::Mutex;

/// Values that a thread takes at a time; no more than these are computed by the caller's own.
pub const BLOCK: usize = 1 << 14;

/// One value for all, or a value for each.
#[derive(Debug, Clone, Copy)]
pub struct Values<'a>(&'a [f64]);

impl<'a> Values<'a> {
    /// A slice of one value, or of `length` values.
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

/// Room for so many values.
pub fn values(size: usize) -> Result<Vec<f64>, Error> {
    crate::memory::zeros("size", size)
}

/// Fills `out` block by block, with `fill(first, block)`; whatever the threads, the same.
fn in_blocks(
    out: &mut [f64],
    means: Means,
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
    means.each_thread(number, || {
        loop {
            let next = blocks.lock().expect("nobody panics who holds it").next();
            let Some(block) = next else { break };
            fill(block);
        }
    })?;
    Ok(())
}
