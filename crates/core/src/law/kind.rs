//! The entry of a law in the table, and what the bounce loop asks of it.

use super::{Contact, CustomLaw, Response, Rule};
use crate::describe::Kind;
use crate::simd::Pack;
use pulp::Simd;

/// A law in the table of laws.
#[derive(Debug, Clone, Copy)]
pub struct LawKind {
    /// Its description, whose parameters come after the normal coefficient, which all laws have.
    pub kind: Kind<Rule>,
    /// The possibility that it creates kinetic energy.
    pub creates_energy: Creation,
    /// Slip in an impact from rest within the friction cone, and beyond it; none where that has no closed form.
    pub from_rest: Option<[Slip; 2]>,
}

/// The possibility that a law creates kinetic energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Creation {
    /// It cannot.
    Never,
    /// It can.
    Possible,
    /// It can where the parameter has this value.
    Where(&'static str, &'static str),
}

/// Slip during an impact from rest, before which the contact does not slip. Each is a closed form of the first impact,
/// in `analytic/_impulse.py` of the Python package.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slip {
    /// It slips freely, for nothing acts along the plane.
    Free,
    /// It sticks.
    Stuck,
    /// It slips with friction at its limit, μ times the normal force.
    Sliding,
    /// The tangential impulse is (1 + e_t) times that of a sticking plastic impact.
    Part,
}

/// Largest number of vectors of contacts that a law is given at once.
pub(crate) const MOST_CONTACTS: usize = 6;

/// A law in the form that the bounce loop uses: it answers all contacts at once, so that those that take long can share the lanes.
pub(crate) trait Respond {
    /// Returns whether ε_n scatters.
    fn scatters(&self) -> bool;

    /// Answers up to [`MOST_CONTACTS`] vectors of contacts; `chances` has a uniform number in (0, 1) for each if ε_n scatters. Without
    /// `SPACE` no contact velocity has a component along **w**.
    fn respond_all<S: Simd, const SPACE: bool>(
        &self,
        contacts: &[Contact<Pack<S>>],
        chances: &[Pack<S>],
        responses: &mut [Response<Pack<S>>],
    );

    /// The law of one's own that is to be asked instead, if this is one.
    #[inline(always)]
    fn custom(&self) -> Option<CustomLaw<'_>> {
        None
    }
}
