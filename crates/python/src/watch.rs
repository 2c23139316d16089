//! Long computations: the GIL is released, Ctrl-C is handled, progress is reported, and panics become exceptions.

use crate::errors::python_error;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use restitution_core::{Error, Monitor, STACK};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// Time between checks for signals and reports of progress.
const TICK: Duration = Duration::from_millis(50);

/// Runs `work` on a thread of its own, or on this one if the system starts none; `progress`, if any, is called with the number of
/// finished particles. Returns the result of `work`, and the `KeyboardInterrupt` that made it stop early, if any.
pub fn run<T: Send>(
    py: Python<'_>,
    progress: Option<Bound<'_, PyAny>>,
    work: impl FnOnce(&Monitor) -> Result<T, Error> + Send,
) -> PyResult<(T, Option<PyErr>)> {
    let monitor = Monitor::default();
    let progress = progress.map(Bound::unbind);
    let work = Mutex::new(Some(work));
    let taken = || {
        let mut work = work.lock().expect("nobody panics who holds it");
        work.take().expect("it is taken once")
    };
    py.detach(|| {
        thread::scope(|scope| {
            let (sender, receiver) = channel();
            let monitor = &monitor;
            let spawned = thread::Builder::new()
                .stack_size(STACK)
                .spawn_scoped(scope, || {
                    let sender = sender; // dropped with this thread, whatever happens
                    let result = taken()(monitor);
                    // The receiver outlives this thread; there is nobody to report a failure to.
                    let _ = sender.send(());
                    result
                });
            let Ok(worker) = spawned else {
                return run_here(progress, taken());
            };
            let mut interrupt = None;
            loop {
                let ended = receiver.recv_timeout(TICK) != Err(RecvTimeoutError::Timeout);
                if let Err(error) = attend(monitor, progress.as_ref()) {
                    monitor.cancel();
                    interrupt.get_or_insert(error);
                }
                if ended {
                    break;
                }
            }
            ended(worker.join(), interrupt)
        })
    })
}

/// Runs `work` on this thread, handling signals and progress between impacts.
fn run_here<T>(
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Monitor) -> Result<T, Error>,
) -> PyResult<(T, Option<PyErr>)> {
    let interrupt = Arc::new(Mutex::new((Instant::now(), None)));
    let state = interrupt.clone();
    let monitor = Monitor::attended(move |monitor| {
        let mut state = state.lock().expect("nobody panics who holds it");
        if state.0.elapsed() > TICK {
            if let Err(error) = attend(monitor, progress.as_ref()) {
                monitor.cancel();
                state.1.get_or_insert(error);
            }
            state.0 = Instant::now();
        }
    });
    let result = catch_unwind(AssertUnwindSafe(|| work(&monitor)));
    let interrupt = interrupt.lock().ok().and_then(|mut state| state.1.take());
    ended(result, interrupt)
}

/// The result of work that has ended, perhaps because of a signal.
fn ended<T>(
    result: thread::Result<Result<T, Error>>,
    interrupt: Option<PyErr>,
) -> PyResult<(T, Option<PyErr>)> {
    let result = result.map_err(|panic| {
        let message = panic
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| panic.downcast_ref::<&str>().copied())
            .unwrap_or("no message");
        PyRuntimeError::new_err(format!("the core panicked: {message}"))
    })?;
    let from_keyboard =
        |error: &PyErr| Python::attach(|py| error.is_instance_of::<PyKeyboardInterrupt>(py));
    match (result, interrupt) {
        (Err(_), Some(error)) => Err(error),
        (_, Some(error)) if !from_keyboard(&error) => Err(error),
        (result, interrupt) => Ok((result.map_err(python_error)?, interrupt)),
    }
}

fn attend(monitor: &Monitor, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    Python::attach(|py| {
        py.check_signals()?;
        if let Some(progress) = progress {
            progress.call1(py, (monitor.finished(),))?;
        }
        Ok(())
    })
}
