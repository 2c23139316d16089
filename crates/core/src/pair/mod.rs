//! Two bodies in free flight: encounters, followed exactly, in coherent units.

mod encounter;
mod lasting;
mod partner;
mod run;
mod sample;

pub use encounter::{Ending, Hit, Outcome, PairState, Trouble, encounter, narrowest};
pub(crate) use encounter::{Following, FreeBody};
pub use partner::Partner;
pub(crate) use run::failed;
pub use run::{ENCOUNTER, Encountered, HIT, PairTable, PairVariable};
pub(crate) use sample::{Draws, approach, normals};
pub use sample::{Encounters, Meeting};
