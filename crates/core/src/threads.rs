//! Threads of a run, its progress and its cancellation. The result does not depend on them.

use crate::Error;
use crate::simd::Level;
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Threads and vector instructions of a run; the result does not depend on them.
#[derive(Debug, Clone, Copy)]
pub struct Resources {
    /// Number of threads; 0 means one for each core.
    pub threads: usize,
    /// Level of the vector instructions.
    pub level: Level,
}

impl Default for Resources {
    /// All cores, and the widest vector instructions of this processor.
    fn default() -> Self {
        Self {
            threads: 0,
            level: Level::best(),
        }
    }
}

/// Progress and cancellation of a run, shared with the thread that started it.
#[derive(Default)]
pub struct Monitor {
    cancelled: Arc<AtomicBool>,
    finished: AtomicU64,
    attend: Option<Box<Attend>>,
}

/// Handles signals and progress where the work has no thread of its own.
type Attend = dyn Fn(&Monitor) + Send + Sync;

impl Monitor {
    /// A monitor for work that has no thread of its own: `attend` is called after every few impacts.
    pub fn attended(attend: impl Fn(&Self) + Send + Sync + 'static) -> Self {
        Self {
            attend: Some(Box::new(attend)),
            ..Self::default()
        }
    }

    /// Asks the run to end; every particle stops at its next impact at the latest.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Makes a body: its long loops end with [`Error::Cancelled`] once this is cancelled.
    pub fn over<R>(&self, work: impl FnOnce() -> R) -> R {
        CANCELLED.set(Some(self.cancelled.clone()));
        let result = work();
        CANCELLED.set(None);
        result
    }

    /// Number of particles that are finished.
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

thread_local! {
    /// Of the monitor over what is being made on this thread, if there is one. Bodies are made by functions in a table, through which few would
    /// hand it on.
    static CANCELLED: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// Fails once what is being made on this thread is cancelled.
pub(crate) fn go_on() -> Result<(), Error> {
    let cancelled = |flag: &Option<Arc<AtomicBool>>| {
        flag.as_ref()
            .is_some_and(|flag| flag.load(Ordering::Relaxed))
    };
    if CANCELLED.with_borrow(cancelled) {
        return Err(Error::Cancelled);
    }
    Ok(())
}

/// Bytes of the stack of a thread that the core or the binding starts, independent of `RUST_MIN_STACK`.
///
/// Without optimisation every vector of the loop has a place of its own on the stack.
pub const STACK: usize = if cfg!(debug_assertions) {
    32 << 20
} else {
    2 << 20
};

/// The default number of threads: one for each core that the process may use. Environment variables are not read.
pub fn default_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

impl Resources {
    /// Runs `work` on every thread, with the number of threads, which is not larger than that of blocks, and returns one result for
    /// each thread. A single thread is the caller's own.
    #[cfg(feature = "threads")]
    pub(crate) fn each_thread<R: Send>(
        &self,
        blocks: usize,
        work: impl Fn(usize) -> R + Sync,
    ) -> Result<Vec<R>, Error> {
        let wanted = match self.threads {
            0 => default_threads(),
            threads => threads,
        };
        let threads = wanted.min(blocks).max(1);
        if threads == 1 {
            return Ok(vec![work(1)]);
        }
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .stack_size(STACK)
            .build()
            .map_err(|error| Error::Threads {
                asked: threads,
                problem: error.to_string(),
            })?;
        Ok(pool.broadcast(|_| work(threads)))
    }

    /// Runs `work` on the caller's thread.
    #[cfg(not(feature = "threads"))]
    pub(crate) fn each_thread<R>(
        &self,
        _blocks: usize,
        work: impl Fn(usize) -> R,
    ) -> Result<Vec<R>, Error> {
        Ok(vec![work(1)])
    }
}
