//! Metadata of a recorded variable, and the storage of its values.

use crate::math::Vectors;
use crate::simd::Pack;
use pulp::Simd;

/// Metadata of a recorded variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: &'static str,
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
}

impl Variable {
    /// A variable with a name, to be filled in.
    pub(crate) const fn named(name: &'static str, components: &'static [&'static str]) -> Self {
        Self {
            name,
            components,
            ..Self::PLAIN
        }
    }

    /// A variable without metadata, to be filled in.
    pub const PLAIN: Self = Self {
        name: "",
        text: "",
        unit: None,
        symbol: None,
        meanings: &[],
        components: &[],
        when: When::Always,
    };
}

/// The recorded values of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Real numbers; three in a row for each vector.
    Numbers(Vec<f64>),
    /// Numbers that stand for names.
    Flags(Vec<i8>),
    /// Numbers of parts of a body.
    Parts(Vec<i32>),
    /// Counts.
    Counts(Vec<i64>),
}

impl Values {
    pub(crate) fn is_empty(&self) -> bool {
        match self {
            Self::Numbers(values) => values.is_empty(),
            Self::Flags(values) => values.is_empty(),
            Self::Parts(values) => values.is_empty(),
            Self::Counts(values) => values.is_empty(),
        }
    }
}

/// A type of the elements of a column.
pub(crate) trait Stored: Copy + Default {
    /// The value where there was no impact.
    const NONE: Self;
    /// [`Variable::components`].
    const COMPONENTS: &'static [&'static str] = &[];
    /// Its form in the bounce loop, one value in each lane.
    type Lanes<S: Simd, const K: usize>;

    fn lane<S: Simd, const K: usize>(lanes: &Self::Lanes<S, K>, lane: usize) -> Self;
    fn values(column: Vec<Self>) -> Values;
}

impl Stored for f64 {
    const NONE: Self = Self::NAN;
    type Lanes<S: Simd, const K: usize> = Pack<S, K>;

    #[inline(always)]
    fn lane<S: Simd, const K: usize>(lanes: &Pack<S, K>, lane: usize) -> Self {
        lanes.as_slice()[lane]
    }

    fn values(column: Vec<Self>) -> Values {
        Values::Numbers(column)
    }
}

impl Stored for i8 {
    const NONE: Self = 0;
    type Lanes<S: Simd, const K: usize> = Pack<S, K>;

    #[inline(always)]
    fn lane<S: Simd, const K: usize>(lanes: &Pack<S, K>, lane: usize) -> Self {
        lanes.as_slice()[lane] as Self
    }

    fn values(column: Vec<Self>) -> Values {
        Values::Flags(column)
    }
}

impl Stored for i32 {
    const NONE: Self = 0;
    type Lanes<S: Simd, const K: usize> = Pack<S, K>;

    #[inline(always)]
    fn lane<S: Simd, const K: usize>(lanes: &Pack<S, K>, lane: usize) -> Self {
        lanes.as_slice()[lane] as Self
    }

    fn values(column: Vec<Self>) -> Values {
        Values::Parts(column)
    }
}

impl Stored for [f64; 4] {
    const NONE: Self = [f64::NAN; 4];
    const COMPONENTS: &'static [&'static str] = &["w", "x", "y", "z"];
    type Lanes<S: Simd, const K: usize> = [Pack<S, K>; 4];

    #[inline(always)]
    fn lane<S: Simd, const K: usize>(lanes: &Self::Lanes<S, K>, lane: usize) -> Self {
        lanes.map(|part| part.as_slice()[lane])
    }

    fn values(column: Vec<Self>) -> Values {
        Values::Numbers(column.into_flattened())
    }
}

impl Stored for [f64; 3] {
    const NONE: Self = [f64::NAN; 3];
    const COMPONENTS: &'static [&'static str] = &["x", "y", "z"];
    type Lanes<S: Simd, const K: usize> = Vectors<S, K>;

    #[inline(always)]
    fn lane<S: Simd, const K: usize>(lanes: &Vectors<S, K>, lane: usize) -> Self {
        let vector = lanes.lane(lane);
        [vector.x, vector.y, vector.z]
    }

    fn values(column: Vec<Self>) -> Values {
        Values::Numbers(column.into_flattened())
    }
}
