//! The columns of a table: the values of a variable in one type of elements, a cell for each event or row.

use super::variable::{Element, Elements, Variable};
use crate::Error;
use crate::math::Vectors;
use crate::memory::zeros;
use crate::simd::Pack;

use pulp::Simd;
use std::ops::Range;

/// The recorded values of a variable.
pub type Values = Elements<Vec<f64>, Vec<i8>, Vec<i32>, Vec<i64>>;
/// Slices of a column.
pub(crate) type Slices<'a> = Elements<&'a mut [f64], &'a mut [i8], &'a mut [i32], &'a mut [i64]>;

/// Does the same whatever the elements are.
macro_rules! each {
    ($elements:expr, $these:pat => $work:expr) => {
        match $elements {
            Elements::Numbers($these) => Elements::Numbers($work),
            Elements::Flags($these) => Elements::Flags($work),
            Elements::Parts($these) => Elements::Parts($work),
            Elements::Counts($these) => Elements::Counts($work),
        }
    };
}

/// A type of the values of a variable.
pub(crate) trait Stored: Copy {
    /// Its elements.
    const KIND: Element;
    /// [`Variable::components`].
    const COMPONENTS: &'static [&'static str] = &[];
    /// [`Variable::each`].
    const EACH: bool = false;

    /// Writes the values of some lanes into cells, pairs of a lane and a cell.
    fn put(column: &mut Slices<'_>, cells: &[(usize, usize)], value: impl Fn(usize) -> Self);
}

/// Values of a variable in lanes, or one by itself.
pub(crate) trait InLanes<T> {
    fn lane(&self, lane: usize) -> T;
}

macro_rules! stored {
    ($($number:ty: $kind:ident;)*) => {$(
        impl Stored for $number {
            const KIND: Element = Elements::$kind(());

            #[inline(always)]
            fn put(column: &mut Slices<'_>, cells: &[(usize, usize)], value: impl Fn(usize) -> Self) {
                let Elements::$kind(column) = column else { unreachable!("elements of its kind") };
                for &(lane, cell) in cells {
                    column[cell] = value(lane);
                }
            }
        }

        impl<S: Simd, const K: usize> InLanes<$number> for Pack<S, K> {
            #[inline(always)]
            fn lane(&self, lane: usize) -> $number {
                self.as_slice()[lane] as $number
            }
        }
    )*};
}

stored! {
    f64: Numbers;
    i8: Flags;
    i32: Parts;
    i64: Counts;
}

const fn components(number: usize) -> &'static [&'static str] {
    match number {
        1 => &[],
        3 => &["x", "y", "z"],
        _ => &["w", "x", "y", "z"],
    }
}

impl<const N: usize> Stored for [f64; N] {
    const KIND: Element = Elements::Numbers(());
    const COMPONENTS: &'static [&'static str] = components(N);

    #[inline(always)]
    fn put(column: &mut Slices<'_>, cells: &[(usize, usize)], value: impl Fn(usize) -> Self) {
        Stored::put(column, cells, |lane| [value(lane)]);
    }
}

/// Of one body, or of each of two.
impl<const N: usize, const BODIES: usize> Stored for [[f64; N]; BODIES] {
    const KIND: Element = Elements::Numbers(());
    const COMPONENTS: &'static [&'static str] = components(N);
    const EACH: bool = BODIES == 2;

    #[inline(always)]
    fn put(column: &mut Slices<'_>, cells: &[(usize, usize)], value: impl Fn(usize) -> Self) {
        let Elements::Numbers(column) = column else {
            unreachable!("elements of its kind")
        };
        let width = BODIES * N;
        for &(lane, cell) in cells {
            column[width * cell..][..width].copy_from_slice(value(lane).as_flattened());
        }
    }
}

impl<T: Stored> InLanes<T> for T {
    fn lane(&self, _: usize) -> T {
        *self
    }
}

impl<S: Simd, const K: usize> InLanes<[f64; 3]> for Vectors<S, K> {
    #[inline(always)]
    fn lane(&self, lane: usize) -> [f64; 3] {
        let vector = self.lane(lane);
        [vector.x, vector.y, vector.z]
    }
}

impl<S: Simd, const K: usize> InLanes<[f64; 4]> for [Pack<S, K>; 4] {
    #[inline(always)]
    fn lane(&self, lane: usize) -> [f64; 4] {
        self.map(|part| part.as_slice()[lane])
    }
}

/// Variables chosen among those of an event or of a row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Columns(pub(super) Vec<bool>);

impl Columns {
    /// The variables for which this is true.
    pub(crate) fn chosen(all: &[Variable], choose: impl Fn(&Variable) -> bool) -> Self {
        Self(all.iter().map(choose).collect())
    }

    /// The variables of an event with these names.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a name that is not in `all`.
    pub fn named<'a>(
        all: &[Variable],
        names: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self, Error> {
        let mut columns = Self::chosen(all, |_| false);
        for name in names {
            match all.iter().position(|about| about.key == name) {
                Some(place) => columns.0[place] = true,
                None => {
                    let known: Vec<_> = all.iter().map(|about| about.key).collect();
                    let allowed = format!("one of {}", known.join(", "));
                    return Err(Error::parameter("columns", name, allowed));
                }
            }
        }
        Ok(columns)
    }

    /// Those of `all` that are chosen.
    pub fn of<'a>(&self, all: &'a [Variable]) -> impl Iterator<Item = &'a Variable> {
        let pairs = all.iter().zip(self.0.clone());
        pairs.filter(|(_, chosen)| *chosen).map(|(about, _)| about)
    }
}

/// A table: of every chosen variable a column, with as many cells in each row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TableColumns {
    all: &'static [Variable],
    per_row: usize,
    pub columns: Vec<Option<Values>>,
}

impl TableColumns {
    /// A table of zeros, whose pages are not touched yet; `what` is for the error.
    pub fn new(
        what: &'static str,
        all: &'static [Variable],
        chosen: &Columns,
        rows: usize,
        per_row: usize,
    ) -> Result<Self, Error> {
        let column = |(about, chosen): (&Variable, &bool)| {
            let size = rows * per_row * about.width();
            chosen
                .then(|| Ok(each!(about.kind, () => zeros(what, size)?)))
                .transpose()
        };
        let columns = all.iter().zip(&chosen.0).map(column);
        Ok(Self {
            all,
            per_row,
            columns: columns.collect::<Result<_, _>>()?,
        })
    }

    /// Calls `change` with every column and the number of its elements in a row.
    fn change(&mut self, mut change: impl FnMut(&mut Values, usize)) {
        for (about, column) in self.all.iter().zip(&mut self.columns) {
            if let Some(column) = column {
                change(column, about.width() * self.per_row);
            }
        }
    }

    /// Keeps the first rows, without touching memory that was not written to.
    pub fn truncate(&mut self, rows: usize) {
        self.change(|column, row| {
            each!(column, these => these.truncate(rows * row));
        });
    }

    /// Moves the first events of a row up to row `place`.
    pub fn move_up(&mut self, row: usize, place: usize, events: usize) {
        let per_row = self.per_row;
        self.change(|column, size| {
            let cells = row * size..row * size + events * (size / per_row);
            each!(column, these => these.copy_within(cells.clone(), place * size));
        });
    }

    /// A copy of the values of a variable as numbers, if it was chosen.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let mut known = self.all.iter().zip(&self.columns);
        let known =
            known.find_map(|(about, values)| values.as_ref().filter(|_| about.name == name));
        Some(match known? {
            Elements::Numbers(values) => values.clone(),
            Elements::Flags(values) => values.iter().copied().map(f64::from).collect(),
            Elements::Parts(values) => values.iter().copied().map(f64::from).collect(),
            Elements::Counts(values) => values.iter().map(|&count| count as f64).collect(),
        })
    }

    /// The chosen variables with their values, which are moved out.
    pub fn take(&mut self) -> Vec<(Variable, Values)> {
        let columns = std::mem::take(&mut self.columns);
        let found = self.all.iter().zip(columns);
        found
            .filter_map(|(about, values)| Some((*about, values?)))
            .collect()
    }

    /// All rows.
    pub fn rows(&mut self) -> TableRows<'_> {
        let columns = self.columns.iter_mut();
        TableRows {
            all: self.all,
            per_row: self.per_row,
            columns: columns
                .map(|column| Some(each!(column.as_mut()?, these => &mut these[..])))
                .collect(),
        }
    }
}

/// Rows of a table.
pub(crate) struct TableRows<'a> {
    all: &'static [Variable],
    pub per_row: usize,
    pub columns: Vec<Option<Slices<'a>>>,
}

impl<'a> TableRows<'a> {
    /// Splits off the first rows.
    pub fn split(&mut self, rows: usize) -> Self {
        let part = |(about, column): (&Variable, &mut Option<Slices<'a>>)| {
            let size = rows * self.per_row * about.width();
            Some(each!(column.as_mut()?, these => these.split_off_mut(..size)?))
        };
        Self {
            all: self.all,
            per_row: self.per_row,
            columns: self.all.iter().zip(&mut self.columns).map(part).collect(),
        }
    }

    /// Fills these cells of a row with the value for no event.
    pub fn blank(&mut self, row: usize, events: Range<usize>) {
        let start = row * self.per_row;
        for (about, column) in self.all.iter().zip(&mut self.columns) {
            if let Some(column) = column {
                let [from, to] =
                    [events.start, events.end].map(|event| (start + event) * about.width());
                match column {
                    Elements::Numbers(cells) => cells[from..to].fill(f64::NAN),
                    Elements::Flags(cells) => cells[from..to].fill(0),
                    Elements::Parts(cells) => cells[from..to].fill(0),
                    Elements::Counts(cells) => cells[from..to].fill(0),
                }
            }
        }
    }
}
