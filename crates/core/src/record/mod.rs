//! The records of a run: the variables of an impact and of a particle, a row each, and the table of all impacts.

mod columns;
mod particles;
mod table;
mod variable;

pub use columns::{Columns, PER_IMPACT, Records};
pub use particles::PER_PARTICLE;
pub(crate) use table::Table;
pub use variable::{Values, Variable, When};
