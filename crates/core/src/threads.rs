//! On how many threads a run is computed, and what can be seen and done from outside meanwhile. The result does not depend on it.

use crate::Error;
use crate::simd::Level;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// How to compute a run; the result does not depend on it.
#[derive(Debug, Clone, Copy)]
pub struct Means {
    /// Number of threads; 0 means one a core.
    pub threads: usize,
    /// The vector instructions.
    pub level: Level,
}

/// Seen and touched from outside while a run is under way.
#[derive(Default)]
pub struct Monitor {
    cancelled: AtomicBool,
    finished: AtomicU64,
    attend: Option<Box<Attend>>,
}

/// What handles signals and progress where the work has no thread of its own.
type Attend = dyn Fn(&Monitor) + Send + Sync;

impl Monitor {
    /// One for work that has no thread of its own: `attend` is called after every few impacts.
    pub fn attended(attend: impl Fn(&Self) + Send + Sync + 'static) -> Self {
        Self {
            attend: Some(Box::new(attend)),
            ..Self::default()
        }
    }

    /// Asks the run to end; every particle stops within an impact.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Number of particles that are done.
    pub fn finished(&self) -> u64 {
        self.finished.load(Ordering::Relaxed)
    }

    pub(crate) fn add_finished(&self, particles: u64) {
        self.finished.fetch_add(particles, Ordering::Relaxed);
    }

    #[inline(always)]
    pub(crate) fn is_cancelled(&self) -> bool {
        if let Some(attend) = &self.attend {
            attend(self);
        }
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Number of threads where none is asked for: one for each core that the process may use, whatever its environment says.
pub fn default_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

impl Means {
    /// Has every thread do the same `work`, on no more threads than there are blocks of it; the results, thread by thread.
    /// One thread is the caller's own.
    #[cfg(feature = "threads")]
    pub(crate) fn each_thread<R: Send>(
        &self,
        blocks: usize,
        work: impl Fn() -> R + Sync,
    ) -> Result<Vec<R>, Error> {
        let wanted = match self.threads {
            0 => default_threads(),
            threads => threads,
        };
        let threads = wanted.min(blocks).max(1);
        if threads == 1 {
            return Ok(vec![work()]);
        }
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| Error::Threads {
                asked: threads,
                problem: error.to_string(),
            })?;
        Ok(pool.broadcast(|_| work()))
    }

    /// Does `work` on the one thread that there is.
    #[cfg(not(feature = "threads"))]
    pub(crate) fn each_thread<R>(
        &self,
        _blocks: usize,
        work: impl Fn() -> R,
    ) -> Result<Vec<R>, Error> {
        Ok(vec![work()])
    }
}
