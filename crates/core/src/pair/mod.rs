//! Two bodies in free flight: encounters, followed exactly, in coherent units.

mod encounter;
mod follow;
mod lanes;
mod lasting;
mod partner;
mod recorded;
mod run;
mod sample;

pub use encounter::{Ending, Hit, Outcome, Trouble, encounter, narrowest};
pub(crate) use follow::Follower;
pub(crate) use partner::{Approach, FreeBody};
pub use partner::{PairState, Partner};
pub use recorded::{PER_CONTACT, PER_ENCOUNTER, PairTable};
pub(crate) use run::failed;
pub(crate) use sample::{DrawRows, approach, normals};
pub use sample::{Encounters, Meeting};
