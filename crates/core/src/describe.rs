//! Descriptions of bodies, laws and materials: lists, forms, files and tests follow from one entry for each.

use crate::Error;

/// A body, a law or a material, and how it is made.
#[derive(Debug, Clone, Copy)]
pub struct Kind<T> {
    /// Its name, as in `Dumbbell`.
    pub name: &'static str,
    /// Its description, in one line.
    pub text: &'static str,
    /// Its parameters, in the order in which it is given them.
    pub parameters: &'static [Parameter],
    /// Makes it from its parameters, one for each.
    pub make: fn(&[Argument<'_>]) -> Result<T, Error>,
}

/// A parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its description.
    pub text: &'static str,
    /// Its unit; "1" for a ratio, none for a name.
    pub unit: Option<&'static str>,
    /// The values that it may have by itself; together they may be restricted further.
    pub allowed: Allowed,
    /// Its value unless one is given; it must be given if there is none.
    pub default: Option<Argument<'static>>,
    /// A usual value, for files that show what can be written, and for tests; those of all parameters go together.
    pub example: Argument<'static>,
    /// Its name in links and stored data, where parameters of other bodies or of the run have the same one.
    pub link: &'static str,
    /// The largest usual value of a length beside the first length of its body, in which sliders give it; infinite if they do not.
    pub beside: f64,
}

/// The values that a parameter may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Allowed {
    /// A finite number.
    Number(Interval),
    /// A finite number, or one for each of two spheres.
    Pair(Interval),
    /// Numbers in a row.
    Numbers(Interval),
    /// A whole number.
    Whole(Interval),
    /// One of these whole numbers.
    Choice(&'static [u64]),
    /// As many numbers as there are names, which are those of links, each with its description.
    Several(&'static [[&'static str; 2]], Interval),
    /// Rows of numbers: the names of the columns, the fewest rows, and the interval of the last column.
    Rows(&'static [&'static str], usize, Interval),
    /// One of these names.
    Name(&'static [&'static str]),
}

/// An interval; its upper end belongs to it unless it is infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
    /// True if the lower end belongs to it.
    pub closed: bool,
}

/// The value of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Argument<'a> {
    /// A number.
    Number(f64),
    /// A number for each of two spheres.
    Pair([f64; 2]),
    /// Numbers in a row, or row by row.
    Numbers(&'a [f64]),
    /// A whole number.
    Whole(u64),
    /// A name.
    Name(&'a str),
    /// A distribution, with its numbers.
    Drawn(&'a str, &'a [f64]),
    /// None: the parameter is left out.
    Absent,
}

impl Interval {
    /// All positive numbers.
    pub const POSITIVE: Self = Self {
        low: 0.0,
        high: f64::INFINITY,
        closed: false,
    };
    /// All numbers that are not negative.
    pub const NOT_NEGATIVE: Self = Self {
        closed: true,
        ..Self::POSITIVE
    };

    /// All numbers.
    pub const ANY: Self = Self {
        low: f64::NEG_INFINITY,
        ..Self::NOT_NEGATIVE
    };

    /// The numbers from `low` to `high`, both included.
    pub const fn from(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            closed: true,
        }
    }
}

impl Parameter {
    /// A parameter that must be given.
    pub(crate) const fn new(
        name: &'static str,
        text: &'static str,
        unit: Option<&'static str>,
        allowed: Allowed,
        example: Argument<'static>,
    ) -> Self {
        Self {
            name,
            text,
            unit,
            allowed,
            default: None,
            example,
            link: name,
            beside: 3.0,
        }
    }

    /// A number that must be given, in a unit.
    pub(crate) const fn number(
        name: &'static str,
        text: &'static str,
        unit: &'static str,
        interval: Interval,
        example: f64,
    ) -> Self {
        let (allowed, example) = (Allowed::Number(interval), Argument::Number(example));
        Self::new(name, text, Some(unit), allowed, example)
    }

    /// A positive length, in m.
    pub(crate) const fn length(name: &'static str, text: &'static str, example: f64) -> Self {
        Self::number(name, text, "m", Interval::POSITIVE, example)
    }

    /// A length that may be 0, in m.
    pub(crate) const fn distance(name: &'static str, text: &'static str, example: f64) -> Self {
        Self::number(name, text, "m", Interval::NOT_NEGATIVE, example)
    }

    /// A density that is that of glass unless one is given.
    pub(crate) const fn density(text: &'static str) -> Self {
        let glass = Argument::Number(2500.0);
        Self::number("density", text, "kg m-3", Interval::POSITIVE, 2500.0).or(glass)
    }

    /// The same under another name in links.
    pub(crate) const fn linked(self, link: &'static str) -> Self {
        Self { link, ..self }
    }

    /// The same with another end of its slider.
    pub(crate) const fn up_to(self, beside: f64) -> Self {
        Self { beside, ..self }
    }

    /// The same, which each of two spheres may have its own of.
    pub(crate) const fn of_each(self) -> Self {
        match self.allowed {
            Allowed::Number(interval) => Self {
                allowed: Allowed::Pair(interval),
                ..self
            },
            _ => self,
        }
    }

    /// The same, which is usually left out; its example is then not one that goes with those of the others.
    pub(crate) const fn optional(self) -> Self {
        Self {
            default: Some(Argument::Absent),
            ..self
        }
    }

    /// True if it is usually left out.
    pub const fn is_optional(&self) -> bool {
        matches!(self.default, Some(Argument::Absent))
    }

    /// The same with a default.
    pub(crate) const fn or(self, default: Argument<'static>) -> Self {
        Self {
            default: Some(default),
            ..self
        }
    }
}

/// Numbers, pairs and names out of arguments, in the order of the parameters.
pub(crate) trait Arguments {
    fn number(&self, place: usize) -> f64;
    fn whole(&self, place: usize) -> u64;
    fn several<const N: usize>(&self, place: usize) -> [f64; N];
    fn pair(&self, place: usize) -> [f64; 2];
    fn numbers(&self, place: usize) -> &[f64];
    fn name(&self, place: usize) -> &str;
    fn is_absent(&self, place: usize) -> bool;
}

/// An argument that is missing or of another type reads as NaN, as no numbers or as no name, which every constructor refuses.
impl Arguments for [Argument<'_>] {
    fn number(&self, place: usize) -> f64 {
        match self.get(place) {
            Some(Argument::Number(number)) => *number,
            Some(Argument::Whole(number)) => *number as f64,
            _ => f64::NAN,
        }
    }

    fn whole(&self, place: usize) -> u64 {
        match self.get(place) {
            Some(Argument::Whole(number)) => *number,
            _ => self.number(place) as u64,
        }
    }

    fn several<const N: usize>(&self, place: usize) -> [f64; N] {
        self.numbers(place).try_into().unwrap_or([f64::NAN; N])
    }

    fn pair(&self, place: usize) -> [f64; 2] {
        match self.get(place) {
            Some(Argument::Pair(pair)) => *pair,
            _ => [self.number(place); 2],
        }
    }

    fn numbers(&self, place: usize) -> &[f64] {
        match self.get(place) {
            Some(Argument::Numbers(numbers)) => numbers,
            _ => &[],
        }
    }

    fn name(&self, place: usize) -> &str {
        match self.get(place) {
            Some(Argument::Name(name)) => name,
            _ => "",
        }
    }

    fn is_absent(&self, place: usize) -> bool {
        matches!(self.get(place), Some(Argument::Absent))
    }
}
