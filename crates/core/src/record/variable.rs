//! Metadata of a recorded variable.

/// Something for each type of elements that a column can have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Elements<N, F, P, C> {
    /// Real numbers, as many in a row as the variable has components.
    Numbers(N),
    /// Numbers that stand for names.
    Flags(F),
    /// Numbers of parts of a body.
    Parts(P),
    /// Counts.
    Counts(C),
}

/// A type of elements.
pub type Element = Elements<(), (), (), ()>;

/// Metadata of a recorded variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: &'static str,
    /// The name by which it is chosen, which no other variable of the same event has.
    pub key: &'static str,
    /// Its description.
    pub text: &'static str,
    /// Its unit; "1" for a ratio, none for a count or a name.
    pub unit: Option<&'static str>,
    /// Its usual symbol.
    pub symbol: Option<&'static str>,
    /// The names that its numbers 0, 1, ... stand for; empty if they stand for themselves.
    pub meanings: &'static [&'static str],
    /// The names of its components; none of a number.
    pub components: &'static [&'static str],
    /// True if each of two bodies has a value.
    pub each: bool,
    /// The type of its elements.
    pub kind: Element,
    /// The runs in which it is recorded, unless columns are chosen by name.
    pub when: When,
}

/// The runs in which a variable is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum When {
    /// All runs.
    Always,
    /// Runs of bodies of revolution.
    HasAxis,
    /// Runs of other bodies.
    HasNoAxis,
    /// Runs whose normal coefficient depends on the speed.
    NormalVaries,
    /// Runs that record the full state at each impact.
    StateAsked,
    /// Such runs of bodies of revolution.
    StateAskedOfAxis,
    /// Such runs of other bodies.
    StateAskedWithoutAxis,
    /// Runs whose particles are released from random heights.
    HeightVaries,
    /// Runs whose particles are not released at rest over a level plane.
    InSpace,
    /// Such runs of bodies of revolution.
    InSpaceOfAxis,
}

impl Variable {
    /// A variable without metadata, to be filled in.
    pub const PLAIN: Self = Self {
        name: "",
        key: "",
        text: "",
        unit: None,
        symbol: None,
        meanings: &[],
        components: &[],
        each: false,
        kind: Elements::Numbers(()),
        when: When::Always,
    };

    /// Number of elements of a value.
    pub(crate) fn width(&self) -> usize {
        let bodies = if self.each { 2 } else { 1 };
        bodies * self.components.len().max(1)
    }

    /// Memory for a value, in bytes.
    pub fn bytes(&self) -> usize {
        let element = match self.kind {
            Elements::Flags(()) => 1,
            Elements::Parts(()) => 4,
            Elements::Numbers(()) | Elements::Counts(()) => 8,
        };
        element * self.width()
    }
}
