//! Allocations whose size the caller chooses: a failure is returned as an error and never aborts the process.

use crate::Error;
use bytemuck_alloc::Zeroable;
use bytemuck_alloc::allocation::try_zeroed_vec;

/// A vector of zeros; the system provides pages only when they are written to. `what` is for the error.
pub(crate) fn zeros<T: Zeroable>(what: &'static str, length: usize) -> Result<Vec<T>, Error> {
    try_zeroed_vec(length).map_err(|()| Error::out_of_memory::<T>(what, length))
}

/// A vector of `length` copies of `value`.
pub(crate) fn filled<T: Clone>(
    what: &'static str,
    value: T,
    length: usize,
) -> Result<Vec<T>, Error> {
    let mut vector = empty(what, length)?;
    vector.resize(length, value);
    Ok(vector)
}

/// An empty vector with room for `length` values.
pub(crate) fn empty<T>(what: &'static str, length: usize) -> Result<Vec<T>, Error> {
    let mut vector = Vec::new();
    match vector.try_reserve_exact(length) {
        Ok(()) => Ok(vector),
        Err(_) => Err(Error::out_of_memory::<T>(what, length)),
    }
}
