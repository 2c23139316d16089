//! What is recorded: variables with their metadata, a line each, and the columns of their values.

mod column;
mod variable;

pub use column::{Columns, Values};
pub(crate) use column::{InLanes, Slices, Stored, TableColumns, TableRows};
pub(crate) use variable::variables;
pub use variable::{Element, Elements, Variable, When};
