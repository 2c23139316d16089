//! Memory whose size is the caller's choice: it is had, or there is an error, and never an abort.

use crate::Error;
use bytemuck_alloc::Zeroable;
use bytemuck_alloc::allocation::try_zeroed_vec;

/// Zeros, which cost nothing before they are written to. `what` is for the error.
pub(crate) fn zeros<T: Zeroable>(what: &'static str, length: usize) -> Result<Vec<T>, Error> {
    try_zeroed_vec(length).map_err(|()| Error::out_of_memory::<T>(what, length))
}

/// So many times the same value.
pub(crate) fn filled<T: Clone>(
    what: &'static str,
    value: T,
    length: usize,
) -> Result<Vec<T>, Error> {
    let mut vector = empty(what, length)?;
    vector.resize(length, value);
    Ok(vector)
}

/// Room for so many values.
pub(crate) fn empty<T>(what: &'static str, length: usize) -> Result<Vec<T>, Error> {
    let mut vector = Vec::new();
    match vector.try_reserve_exact(length) {
        Ok(()) => Ok(vector),
        Err(_) => Err(Error::out_of_memory::<T>(what, length)),
    }
}
