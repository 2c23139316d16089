//! Statistics that merge exactly: integer counts and integer sums, so that no order of adding can change them.

mod axis;
mod moments;
mod tally;

pub use axis::Axis;
pub use moments::{Moments, Sums};
pub(crate) use tally::Counter;
pub use tally::{Bins, By, CREATES_ENERGY, Gains, Grid, Tally};
