//! What is recorded of a run: variables with their metadata, and the columns of their values.

mod column;
mod variable;

pub use column::{Columns, Values};
pub(crate) use column::{InLanes, ROOM, Slices, Stored, TableColumns, TableRows};
pub use variable::{Element, Elements, Variable, When};
