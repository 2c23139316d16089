//! Statistics that merge exactly: integer counts and integer sums, which do not depend on the order of addition.

mod axis;
mod bins;
mod cells;
mod histogram;
mod moments;
mod recent;
mod rows;
mod sink;
mod whole;

pub use axis::Axis;
pub use bins::{Bins, By};
pub(crate) use histogram::UNSPOILT;
pub use histogram::{Grid, Histogram};
pub use moments::{Moments, Sums};
pub use rows::{CREATES_ENERGY, Gains, PULLS, Rows};
pub(crate) use sink::HistogramSink;
