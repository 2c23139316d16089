//! Which vector instructions to use: found out when the program runs, or told.

use crate::Error;
use pulp::{Scalar, Simd, WithSimd};

/// A SIMD level. All of them give the same bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// One double at a time, on any machine.
    Scalar,
    /// Two doubles at a time, on AArch64.
    Neon,
    /// Four doubles at a time, with fused multiply-add.
    Avx2,
    /// Eight doubles at a time.
    Avx512,
}

impl Level {
    /// Every level, slowest first.
    pub const ALL: [Self; 4] = [Self::Scalar, Self::Neon, Self::Avx2, Self::Avx512];

    /// The fastest level of this machine.
    pub fn best() -> Self {
        Self::available()
            .next_back()
            .expect("the scalar level is always there")
    }

    /// `scalar`, `neon`, `avx2` or `avx512`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Neon => "neon",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The level of that name, if this machine has it.
    pub fn named(name: &str) -> Result<Self, Error> {
        let list = |levels: Vec<Self>| {
            levels
                .into_iter()
                .map(Self::name)
                .collect::<Vec<_>>()
                .join(", ")
        };
        let Some(level) = Self::ALL.into_iter().find(|level| level.name() == name) else {
            return Err(Error::Level {
                name: name.to_owned(),
                allowed: list(Self::ALL.to_vec()),
                problem: "no such SIMD level",
            });
        };
        if level.is_available() {
            Ok(level)
        } else {
            Err(Error::Level {
                name: name.to_owned(),
                allowed: list(Self::available().collect()),
                problem: "this machine lacks it",
            })
        }
    }

    /// The levels of this machine, slowest first.
    pub fn available() -> impl DoubleEndedIterator<Item = Self> {
        Self::ALL.into_iter().filter(|level| level.is_available())
    }

    /// Whether this machine has the level.
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

    #[cfg(target_arch = "x86_64")]
    fn try_run<W: WithSimd>(self, work: W) -> Option<W::Output> {
        use pulp::x86::{V3, V4};
        match self {
            Self::Scalar => Some(Simd::vectorize(Scalar::new(), work)),
            Self::Neon => None,
            Self::Avx2 => V3::try_new().map(|simd| Simd::vectorize(simd, work)),
            Self::Avx512 => V4::try_new().map(|simd| Simd::vectorize(simd, work)),
        }
    }

    #[cfg(target_arch = "aarch64")]
    fn try_run<W: WithSimd>(self, work: W) -> Option<W::Output> {
        use pulp::aarch64::Neon;
        match self {
            Self::Scalar => Some(Simd::vectorize(Scalar::new(), work)),
            Self::Neon => Neon::try_new().map(|simd| Simd::vectorize(simd, work)),
            Self::Avx2 | Self::Avx512 => None,
        }
    }

    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    fn try_run<W: WithSimd>(self, work: W) -> Option<W::Output> {
        (self == Self::Scalar).then(|| Simd::vectorize(Scalar::new(), work))
    }
}
