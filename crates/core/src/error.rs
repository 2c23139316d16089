//! Errors: a parameter outside its range, missing memory or threads, or numerical trouble in one particle.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// Every error of the core. The fields hold name, value and allowed range, so that a binding can word the message itself.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// A parameter is outside the range that it is defined on.
    #[error("{name} = {value}: must be {allowed}")]
    Parameter {
        /// Name of the parameter.
        name: &'static str,
        /// The value given.
        value: Value,
        /// The values that are allowed.
        allowed: String,
    },
    /// Each parameter is in its range, but a quantity derived from all of them overflows or underflows.
    #[error("{name} = {value}: must be {allowed}")]
    Magnitude {
        /// Name of the parameter that sets the scale.
        name: &'static str,
        /// Its value.
        value: Value,
        /// The values that are allowed.
        allowed: &'static str,
    },
    /// A SIMD level that does not exist, or that this machine does not have.
    #[error("RESTITUTION_SIMD = {name}: {problem}; must be one of {allowed}")]
    Level {
        /// The name given.
        name: String,
        /// The values that are allowed.
        allowed: String,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// The operating system refused to start threads.
    #[error("threads = {asked}: the system gives no more threads ({problem}); one needs none")]
    Threads {
        /// The number that was asked for.
        asked: usize,
        /// The system's message.
        problem: String,
    },
    /// The memory could not be allocated.
    #[error("{what}: {:.3} GB more are needed, which this process cannot have", *bytes as f64 / 1e9)]
    Memory {
        /// The parameters that the size follows from.
        what: &'static str,
        /// The size, in bytes.
        bytes: usize,
    },
    /// A law of one's own failed, or gave an impulse that is impossible.
    #[error("particle {particle} (seed {seed}), impact {impact}: {law} {fault}")]
    Law {
        /// Its name.
        law: String,
        /// Index of the particle.
        particle: u64,
        /// Seed of the run.
        seed: u64,
        /// Number of the impact, counted from 0.
        impact: u64,
        /// The reason.
        fault: Fault,
    },
    /// The work was cancelled before it had a result.
    #[error("cancelled")]
    Cancelled,
    /// The contact search of one particle, or the friction at the contact that it found, did not converge.
    #[error(
        "particle {particle} (seed {seed}): the contact search, or the friction of the impact, did not converge in flight {flight}; \
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

/// The value of a parameter that was refused.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A real number.
    Number(f64),
    /// A number of objects, such as particles.
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

impl From<&str> for Value {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}

impl Error {
    /// The error of a parameter outside its range.
    pub(crate) fn parameter(
        name: &'static str,
        value: impl Into<Value>,
        allowed: impl Into<String>,
    ) -> Self {
        Self::Parameter {
            name,
            value: value.into(),
            allowed: allowed.into(),
        }
    }

    /// The error for `length` values that could not be allocated.
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
            Err(Self::parameter(name, value, allowed))
        }
    }

    /// `Ok` if a value is finite and > 0, else the parameter error.
    pub(crate) fn unless_positive(
        name: &'static str,
        value: f64,
        allowed: &'static str,
    ) -> Result<(), Self> {
        Self::unless(value.is_finite() && value > 0.0, name, value, allowed)
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

    /// The entry of `known` that has the name `value`, else an error that lists all names.
    pub(crate) fn chosen<T: Copy>(
        name: &'static str,
        value: &str,
        known: &[(&'static str, T)],
    ) -> Result<T, Self> {
        let found = known.iter().find(|(name, _)| *name == value);
        found.map(|&(_, chosen)| chosen).ok_or_else(|| {
            let names: Vec<_> = known.iter().map(|(name, _)| format!("'{name}'")).collect();
            Self::parameter(name, value, names.join(" or "))
        })
    }
}

/// An error of an [`crate::ImpulseFunction`], handed through to whoever started the run.
#[derive(Clone)]
pub struct Raised(pub Arc<dyn Any + Send + Sync>);

impl fmt::Debug for Raised {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Raised")
    }
}

impl PartialEq for Raised {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Why an impulse is refused; impulses in N s, velocities in m/s.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// The function failed.
    Raised(Raised),
    /// The value of the function, here as text, is not three numbers.
    NoVector(String),
    /// The impulse is not finite.
    NotFinite([f64; 3]),
    /// The impulse has a negative normal component.
    Pulls([f64; 3]),
    /// The contact still approaches the plane afterwards, at this speed.
    Approaches([f64; 3], f64),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let triple = |[x, y, z]: &[f64; 3]| format!("({x:?}, {y:?}, {z:?})");
        match self {
            Self::Raised(_) => f.write_str("raised an exception"),
            Self::NoVector(given) => {
                write!(f, "gave {given}: must be three numbers, the impulse in N s")
            }
            Self::NotFinite(p) => write!(f, "gave {} N s: must be finite", triple(p)),
            Self::Pulls(p) => write!(
                f,
                "gave {} N s, which pulls: the component along z must be >= 0",
                triple(p)
            ),
            Self::Approaches(p, speed) => write!(
                f,
                "gave {} N s, after which the contact still approaches the plane at {speed:?} m/s: must leave it or stay",
                triple(p)
            ),
        }
    }
}
