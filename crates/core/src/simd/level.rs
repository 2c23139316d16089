//! The level of vector instructions: detected at run time, or given.

use crate::Error;
#[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
use pulp::Scalar;
use pulp::{Simd, WithSimd};

/// A SIMD level. All of them give the same bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// One double at a time, on any machine except WebAssembly with vectors.
    Scalar,
    /// Two doubles at a time, on WebAssembly.
    Simd128,
    /// Two doubles at a time, on AArch64.
    Neon,
    /// Four doubles at a time, with fused multiply-add.
    Avx2,
    /// Eight doubles at a time.
    Avx512,
}

impl Level {
    /// All levels, slowest first.
    pub const ALL: [Self; 5] = [
        Self::Scalar,
        Self::Simd128,
        Self::Neon,
        Self::Avx2,
        Self::Avx512,
    ];

    /// The fastest level of this machine.
    pub fn best() -> Self {
        Self::available()
            .next_back()
            .expect("there is always a level")
    }

    /// `scalar`, `simd128`, `neon`, `avx2` or `avx512`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Simd128 => "simd128",
            Self::Neon => "neon",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The level with this name.
    ///
    /// # Errors
    /// [`Error::Level`] for an unknown name, or a level that this machine does not have.
    pub fn named(name: &str) -> Result<Self, Error> {
        let known = Self::ALL.into_iter().find(|level| level.name() == name);
        let (problem, allowed) = match known {
            Some(level) if level.is_available() => return Ok(level),
            Some(_) => ("this machine lacks it", Self::available().collect()),
            None => ("no such SIMD level", Self::ALL.to_vec()),
        };
        let names: Vec<_> = allowed.into_iter().map(Self::name).collect();
        Err(Error::Level {
            name: name.to_owned(),
            allowed: names.join(", "),
            problem,
        })
    }

    /// The levels of this machine, slowest first.
    pub fn available() -> impl DoubleEndedIterator<Item = Self> {
        Self::ALL.into_iter().filter(|level| level.is_available())
    }

    /// Returns whether this machine has the level.
    pub fn is_available(self) -> bool {
        struct Nothing;
        impl WithSimd for Nothing {
            type Output = ();
            fn with_simd<S: Simd>(self, _: S) {}
        }
        self.try_run(Nothing).is_some()
    }

    /// Runs `work` compiled for this level; the level must be available.
    pub(crate) fn run<W: WithSimd>(self, work: W) -> W::Output {
        self.try_run(work)
            .expect("the level was checked when it was chosen")
    }

    /// Runs what has no packs: with fused multiply-add where this machine has it, but not compiled for the widest registers as well,
    /// which it does not use.
    pub(crate) fn run_scalar<W: WithSimd>(work: W) -> W::Output {
        #[cfg(not(target_arch = "x86_64"))]
        return Self::best().run(work);
        #[cfg(target_arch = "x86_64")]
        match pulp::x86::V3::try_new() {
            Some(simd) => Simd::vectorize(simd, work),
            None => Simd::vectorize(Scalar::new(), work),
        }
    }

    /// The same at this level, or at the one below the widest.
    pub(crate) fn run_scalar_at<W: WithSimd>(self, work: W) -> W::Output {
        #[cfg(not(target_arch = "x86_64"))]
        return self.run(work);
        #[cfg(target_arch = "x86_64")]
        match self {
            Self::Scalar => Simd::vectorize(Scalar::new(), work),
            _ => Self::run_scalar(work),
        }
    }

    fn try_run<W: WithSimd>(self, work: W) -> Option<W::Output> {
        match self {
            // On WebAssembly with vectors it would double the size of the module.
            #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
            Self::Scalar => Some(Simd::vectorize(Scalar::new(), work)),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Self::Simd128 => pulp::wasm::Simd128::try_new().map(|simd| Simd::vectorize(simd, work)),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => pulp::aarch64::Neon::try_new().map(|simd| Simd::vectorize(simd, work)),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => pulp::x86::V3::try_new().map(|simd| Simd::vectorize(simd, work)),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => pulp::x86::V4::try_new().map(|simd| Simd::vectorize(simd, work)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By its name every level of this machine is found, and of the others it is said which there are.
    #[test]
    fn levels_have_names() {
        let names = ["scalar", "simd128", "neon", "avx2", "avx512"];
        assert_eq!(Level::ALL.map(Level::name), names);
        let here: Vec<_> = Level::available().map(Level::name).collect();
        for (level, name) in Level::ALL.into_iter().zip(names) {
            let expected = if here.contains(&name) {
                Ok(level)
            } else {
                Err(Error::Level {
                    name: name.into(),
                    allowed: here.join(", "),
                    problem: "this machine lacks it",
                })
            };
            assert_eq!(Level::named(name), expected);
        }
        let unknown = Error::Level {
            name: "Scalar".into(),
            allowed: "scalar, simd128, neon, avx2, avx512".into(),
            problem: "no such SIMD level",
        };
        assert_eq!(Level::named("Scalar"), Err(unknown));
    }
}
