//! Two bodies in free flight: encounters, followed exactly, in coherent units.

mod axial;
mod encounter;
mod follow;
mod lasting;
mod partner;
mod run;
mod sample;

pub(crate) use encounter::{Approach, FreeBody};
pub use encounter::{Ending, Hit, Outcome, PairState, Trouble, encounter, narrowest};
pub(crate) use follow::Follower;
pub use partner::Partner;
pub(crate) use run::failed;
pub use run::{ENCOUNTER, HIT, PairTable, PairVariable};
pub(crate) use sample::{DrawRows, approach, normals};
pub use sample::{Encounters, Meeting};
