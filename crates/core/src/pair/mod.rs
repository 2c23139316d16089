//! Two bodies in free flight: encounters, followed exactly, in coherent units.

mod encounter;
mod partner;
mod run;
mod sample;

pub use encounter::{Ending, Hit, Outcome, PairState, Trouble, encounter, narrowest};
pub use partner::Partner;
pub use run::{ENCOUNTER, Encountered, HIT, PairTable, PairVariable};
pub use sample::{Encounters, Meeting};
