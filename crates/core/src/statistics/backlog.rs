//! The queue of impacts that are still to be counted.

use std::ops::Range;

/// Length of the queue.
pub(super) const LENGTH: usize = 96;
/// Number of impacts after which the narrow counters are emptied: no counter of 32 bits can overflow before.
const MOST: u32 = u32::MAX - LENGTH as u32;

/// The positions up to which a queue of [`LENGTH`] is filled and counted.
#[derive(Default)]
pub(super) struct Backlog {
    length: usize,
    counted: usize,
    /// Number of impacts counted since the narrow counters were last emptied.
    recent: u32,
}

impl Backlog {
    /// Whether there is room for `width` more.
    #[inline(always)]
    pub fn has_room(&self, width: usize) -> bool {
        self.length + width <= LENGTH
    }

    /// Reserves the next `width` positions, for which there must be room.
    #[inline(always)]
    pub fn take(&mut self, width: usize) -> Range<usize> {
        let first = self.length;
        self.length += width;
        first..self.length
    }

    /// The next position to be counted, if there is one.
    #[inline(always)]
    pub fn next(&mut self) -> Option<usize> {
        let next = self.counted;
        if next < self.length {
            self.counted += 1;
            Some(next)
        } else {
            None
        }
    }

    /// Resets the queue after all its impacts were counted, and returns whether the narrow counters must be emptied.
    #[inline(always)]
    pub fn restart(&mut self) -> bool {
        self.recent += self.length as u32;
        self.length = 0;
        self.counted = 0;
        let full = self.recent > MOST;
        if full {
            self.recent = 0;
        }
        full
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between two emptyings no counter has more impacts than it has room for, even if all are in one bin.
    #[test]
    fn narrow_counters_are_emptied_in_time() {
        let mut backlog = Backlog::default();
        let mut since = 0_u64;
        let mut emptied = 0;
        while emptied < 2 {
            backlog.take(LENGTH);
            since += LENGTH as u64;
            assert!(since <= u64::from(u32::MAX));
            if backlog.restart() {
                assert!(since > u64::from(MOST));
                (since, emptied) = (0, emptied + 1);
            }
        }
    }
}
