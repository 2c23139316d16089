//! What is known of a recorded variable, and how its values are kept.

use crate::flight::Vectors;
use crate::simd::Pack;
use pulp::Simd;

/// What is known of a recorded variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub text: &'static str,
    /// Its unit; "1" of a ratio, none of a count or a name.
    pub unit: Option<&'static str>,
    /// How the field writes it.
    pub symbol: Option<&'static str>,
    /// What its numbers 0, 1, ... stand for, if for names.
    pub meanings: &'static [&'static str],
    /// Whether it is a vector, with components along x, y and z.
    pub vector: bool,
    /// In which runs it is recorded, unless its columns are chosen by name.
    pub when: When,
}

/// In which runs a variable is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum When {
    /// In every one.
    Always,
    /// Where the normal coefficient depends on the speed.
    NormalVaries,
    /// Where the full state at each impact is asked for.
    StateAsked,
    /// Where the particles are released from random heights.
    HeightVaries,
    /// Where the particles are not released at rest over a level plane.
    InSpace,
}

impl Variable {
    /// One of which nothing is known, to be filled in.
    pub const PLAIN: Self = Self {
        name: "",
        text: "",
        unit: None,
        symbol: None,
        meanings: &[],
        vector: false,
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
    /// Counts.
    Counts(Vec<i64>),
}

impl Values {
    pub(crate) fn is_empty(&self) -> bool {
        match self {
            Self::Numbers(values) => values.is_empty(),
            Self::Flags(values) => values.is_empty(),
            Self::Counts(values) => values.is_empty(),
        }
    }
}

/// What a column is made of.
pub(crate) trait Stored: Copy + Default {
    /// Where there was no impact.
    const NONE: Self;
    /// [`Variable::vector`].
    const VECTOR: bool = false;
    /// What the bounce loop has of it, one value in each lane.
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

impl Stored for [f64; 3] {
    const NONE: Self = [f64::NAN; 3];
    const VECTOR: bool = true;
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
