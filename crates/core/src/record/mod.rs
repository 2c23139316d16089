//! The records of a run: the variables of its events and rows, a line each, the table of all events, and the trait of what receives them.

mod column;
mod event;
mod table;
mod variable;

pub use column::{Columns, Values};
pub(crate) use column::{InLanes, Slices, Stored};
pub(crate) use event::{Described, Event, Meanwhile, Process, Sink, Source, variables};
pub use table::Records;
pub(crate) use table::Table;
pub use variable::{Element, Elements, Variable, When};
