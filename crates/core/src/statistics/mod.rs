//! Statistics that merge exactly: integer counts and integer sums, which do not depend on the order of addition.

mod axis;
mod bins;
mod cells;
mod count_sink;
mod histogram;
mod moment_sink;
mod moments;
mod narrow;
mod places;
mod recent;
mod rows;
mod whole;
mod words;

pub use axis::Axis;
pub use bins::{Bins, By};
pub(crate) use count_sink::CountSink;
pub(crate) use histogram::UNSPOILT;
pub use histogram::{Grid, Histogram};
pub(crate) use moment_sink::MomentSink;
pub use moments::{Moments, Sums};
pub use rows::{CREATES_ENERGY, Gains, PULLS, Rows};

/// A sink that counts the impacts that it receives in the grids of a [`Histogram`], which is shared with others.
pub(crate) trait HistogramSink<P: crate::record::Process>: crate::record::Sink<P> {
    /// Returns the other sums over the impacts, all of which are then in the grids.
    fn finish(self) -> Rows;
}
