//! Statistics that merge exactly: integer counts and integer sums, which do not depend on the order of addition.

mod axis;
mod cells;
mod counter;
mod counts;
mod moments;
mod narrow;
mod places;
mod recent;
mod rows;
mod tally;
mod words;

pub use axis::Axis;
pub(crate) use counter::Counter;
pub(crate) use counts::Counts;
pub use moments::{Moments, Sums};
pub use rows::{CREATES_ENERGY, Gains, Rows};
pub(crate) use tally::UNSPOILT;
pub use tally::{Bins, By, Grid, Tally};

/// A sink that counts the impacts that it receives in the grids of a [`Tally`], which is shared with others.
pub(crate) trait Tallying: crate::drop::Sink {
    /// What else is summed of the impacts, all of which are then in the grids.
    fn finish(self) -> Rows;
}
