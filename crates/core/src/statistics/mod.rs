//! Statistics that merge exactly: integer counts and integer sums, so that no order of adding can change them.

mod axis;
mod counter;
mod moments;
mod recent;
mod tally;

pub use axis::Axis;
pub(crate) use counter::Counter;
pub use moments::{Moments, Sums};
pub use tally::{Bins, By, CREATES_ENERGY, Gains, Grid, Tally};
