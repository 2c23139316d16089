//! What can go wrong: a parameter outside its range, or numerical trouble in one particle.

use std::fmt;

/// Every failure of the core. Whoever words an error anew finds name, value and what is allowed in its fields.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// A parameter is outside the range that it is defined on.
    #[error("{name} = {value}: must be {allowed}")]
    Parameter {
        /// Name of the parameter.
        name: &'static str,
        /// The value given.
        value: Value,
        /// What is allowed.
        allowed: String,
    },
    /// Each parameter is in its range, but what follows from all of them is beyond floating-point numbers.
    #[error("{name} = {value}: must be {allowed}")]
    Magnitude {
        /// Name of the parameter that sets the scale.
        name: &'static str,
        /// Its value.
        value: Value,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A SIMD level that does not exist, or not here.
    #[error("RESTITUTION_SIMD = {name}: {problem}; must be one of {allowed}")]
    Level {
        /// The name given.
        name: String,
        /// What is allowed.
        allowed: String,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// The operating system gave no threads.
    #[error("threads = {asked}: the system gives no more threads ({problem}); one needs none")]
    Threads {
        /// How many were asked for.
        asked: usize,
        /// What the system says.
        problem: String,
    },
    /// The process cannot have the memory.
    #[error("{what}: {:.3} GB more are needed, which this process cannot have", *bytes as f64 / 1e9)]
    Memory {
        /// What for, in terms of the parameters.
        what: &'static str,
        /// How much was asked for.
        bytes: usize,
    },
    /// The contact search of one particle did not come to an end.
    #[error(
        "particle {particle} (seed {seed}): the contact search did not converge in flight {flight}; \
         this state is a defect of the program, please report it"
    )]
    Numerical {
        /// Index of the particle.
        particle: u64,
        /// Seed of the run.
        seed: u64,
        /// Number of impacts before the flight in question.
        flight: u64,
    },
}

/// The value of a parameter that is refused.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A real number.
    Number(f64),
    /// How many there are of something.
    Count(usize),
    /// A name.
    Name(String),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(f, "{value:?}"), // Debug writes 1e-300 as such, not as 300 zeros
            Self::Count(count) => write!(f, "{count}"),
            Self::Name(name) => write!(f, "'{name}'"),
        }
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<usize> for Value {
    fn from(count: usize) -> Self {
        Self::Count(count)
    }
}

impl Error {
    /// There is no memory for `length` values.
    pub(crate) fn out_of_memory<T>(what: &'static str, length: usize) -> Self {
        let bytes = length.saturating_mul(size_of::<T>());
        Self::Memory { what, bytes }
    }

    /// `Ok` if `holds`, else the parameter error.
    pub(crate) fn unless(
        holds: bool,
        name: &'static str,
        value: impl Into<Value>,
        allowed: &'static str,
    ) -> Result<(), Self> {
        if holds {
            Ok(())
        } else {
            Err(Self::Parameter {
                name,
                value: value.into(),
                allowed: allowed.to_owned(),
            })
        }
    }

    /// `Ok` if `holds`, else the error of parameters that are too large or small together.
    pub(crate) fn unless_beyond(
        holds: bool,
        name: &'static str,
        value: f64,
        allowed: &'static str,
    ) -> Result<(), Self> {
        if holds {
            Ok(())
        } else {
            Err(Self::Magnitude {
                name,
                value: value.into(),
                allowed,
            })
        }
    }

    /// What is called `value` in a list of names, else an error that lists them.
    pub(crate) fn chosen<T: Copy>(
        name: &'static str,
        value: &str,
        known: &[(&'static str, T)],
    ) -> Result<T, Self> {
        let found = known.iter().find(|(name, _)| *name == value);
        found.map(|&(_, chosen)| chosen).ok_or_else(|| {
            let names: Vec<_> = known.iter().map(|(name, _)| format!("'{name}'")).collect();
            Self::Parameter {
                name,
                value: Value::Name(value.to_owned()),
                allowed: names.join(" or "),
            }
        })
    }
}
