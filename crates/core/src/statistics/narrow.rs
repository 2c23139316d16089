//! Counters of 32 bits, which are emptied before they can overflow.

/// Number of impacts after which they are emptied.
const MOST: u32 = u32::MAX - 1024;

/// The number of impacts counted since they were last emptied.
#[derive(Default)]
pub(super) struct Recently(u32);

impl Recently {
    /// Adds some impacts, fewer than 1024, and returns whether the counters must be emptied.
    #[inline(always)]
    pub fn add(&mut self, impacts: usize) -> bool {
        self.0 += impacts as u32;
        let full = self.0 > MOST;
        if full {
            self.0 = 0;
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
        let mut recently = Recently::default();
        let mut since = 0_u64;
        let mut emptied = 0;
        while emptied < 2 {
            since += 512;
            assert!(since <= u64::from(u32::MAX));
            if recently.add(512) {
                assert!(since > u64::from(MOST));
                (since, emptied) = (0, emptied + 1);
            }
        }
    }
}
