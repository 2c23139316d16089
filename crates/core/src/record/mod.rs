//! Records: variables with their metadata, a line each, and the columns of their values.

mod column;
mod variable;
mod variables;

pub use column::{Columns, Values};
pub(crate) use column::{InLanes, Slices, Stored, TableColumns, TableRows};
pub use variable::{Element, Elements, Variable, When};
pub(crate) use variables::variables;
