//! What can go wrong: a parameter outside its range, or numerical trouble in one particle.

/// Every failure of the core.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// A parameter is outside the range that it is defined on.
    #[error("{name} = {value:?}: must be {allowed}")]
    // Debug writes 1e-300 as such, not as 300 zeros
    Parameter {
        /// Name of the parameter.
        name: &'static str,
        /// The value given.
        value: f64,
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
    #[error("threads: {0}")]
    Threads(String),
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

impl Error {
    /// `Ok` if `holds`, else the parameter error.
    pub(crate) fn unless(
        holds: bool,
        name: &'static str,
        value: f64,
        allowed: &'static str,
    ) -> Result<(), Self> {
        if holds {
            Ok(())
        } else {
            Err(Self::Parameter {
                name,
                value,
                allowed,
            })
        }
    }
}
