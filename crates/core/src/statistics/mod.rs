//! Statistics that merge exactly: integer counts and integer sums, which do not depend on the order of addition.

mod axis;
mod cells;
mod counter;
mod counts;
mod moments;
mod narrow;
mod places;
mod recent;
mod tally;
mod words;

pub use axis::Axis;
pub(crate) use counter::Counter;
pub(crate) use counts::Counts;
pub use moments::{Moments, Sums};
pub use tally::{Bins, By, CREATES_ENERGY, Gains, Grid, Tally};

/// A sink that makes a [`Tally`] of the impacts that it receives.
pub(crate) trait Tallying: crate::engine::Sink {
    /// The tally of all impacts received.
    fn finish(self) -> Tally;
}
