//! The one door for long work: releases the GIL, lets Ctrl-C through, reports progress, turns panics into exceptions.

use crate::python_error;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use restitution_core::{Error, Monitor};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// How often signals are looked at and progress is told.
const TICK: Duration = Duration::from_millis(50);

/// Runs `work` on a thread of its own; `progress`, if any, is called with the number of finished particles. Returns what
/// `work` returned and whether Ctrl-C made it stop early.
pub fn run<T: Send>(
    py: Python<'_>,
    progress: Option<Bound<'_, PyAny>>,
    work: impl FnOnce(&Monitor) -> Result<T, Error> + Send,
) -> PyResult<(T, bool)> {
    let monitor = Monitor::default();
    let progress = progress.map(Bound::unbind);
    py.detach(|| {
        thread::scope(|scope| {
            let (sender, receiver) = channel();
            let monitor = &monitor;
            let worker = scope.spawn(move || {
                let result = work(monitor);
                // The receiver outlives this thread; a failure to send has no one to tell.
                let _ = sender.send(());
                result
            });
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
            let result = worker.join().map_err(|panic| {
                let message = panic
                    .downcast_ref::<String>()
                    .map(String::as_str)
                    .or_else(|| panic.downcast_ref::<&str>().copied())
                    .unwrap_or("no message");
                PyRuntimeError::new_err(format!("the core panicked: {message}"))
            })?;
            let result = result.map_err(python_error)?;
            match interrupt {
                None => Ok((result, false)),
                Some(error) if is_keyboard_interrupt(&error) => Ok((result, true)),
                Some(error) => Err(error),
            }
        })
    })
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

fn is_keyboard_interrupt(error: &PyErr) -> bool {
    Python::attach(|py| error.is_instance_of::<PyKeyboardInterrupt>(py))
}
