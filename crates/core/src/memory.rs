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

/// All values of an iterator that knows how many there are; `what` is for the error.
///
/// # Errors
/// [`Error::Memory`].
pub fn collected<T>(
    what: &'static str,
    values: impl ExactSizeIterator<Item = T>,
) -> Result<Vec<T>, Error> {
    let mut vector = empty(what, values.len())?;
    vector.extend(values);
    Ok(vector)
}

/// A copy of `values`; `what` is for the error.
///
/// # Errors
/// [`Error::Memory`].
pub fn copied<T: Copy>(what: &'static str, values: &[T]) -> Result<Vec<T>, Error> {
    collected(what, values.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// There is room for all values before the first is written, or an error that says how much was asked for.
    #[test]
    fn there_is_room_or_an_error() {
        let (what, bytes) = ("numbers", usize::MAX);
        assert_eq!(
            empty::<u64>(what, bytes),
            Err(Error::Memory { what, bytes })
        );
        let room = empty::<u64>(what, 1000).unwrap();
        assert!(room.is_empty() && room.capacity() >= 1000);
        assert_eq!(filled(what, 7, 3), Ok(vec![7; 3]));
        assert_eq!(copied(what, &[1, 2]), Ok(vec![1, 2]));
        assert_eq!(
            collected(what, std::iter::repeat_n(0_u8, bytes)),
            Err(Error::Memory { what, bytes })
        );
        assert_eq!(zeros::<u64>(what, 3), Ok(vec![0; 3]));
    }
}
