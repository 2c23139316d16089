//! Further passes of the contact search, for the groups that need them.

use super::group::{GROUPS, Group, Stuck};
use super::strike::Turn;
use crate::body::Hull;
use crate::search::MOST_STEPS;
use crate::simd::elementary::sincos_in_lanes;
use pulp::{Simd, WithSimd};

/// Repeats the passes until every contact is located, for all groups together, stage by stage as in the first pass. Compiled
/// separately: inlined, it would use up the registers of every bounce loop.
pub(super) struct SearchOn<'a, S: Simd, T: Turn, H> {
    pub groups: &'a mut [Group<S, T>],
    pub hull: &'a H,
    pub number: usize,
}

/// Numbers of the groups whose contacts are not all located.
struct Waiting {
    numbers: [u8; GROUPS],
    count: usize,
}

impl Waiting {
    /// The waiting ones among all groups.
    #[inline(always)]
    fn new<S: Simd, T: Turn>(groups: &[Group<S, T>]) -> Self {
        let mut all = Self {
            numbers: std::array::from_fn(|i| i as u8),
            count: groups.len(),
        };
        all.retain(groups);
        all
    }

    /// Drops the groups that no longer wait.
    #[inline(always)]
    fn retain<S: Simd, T: Turn>(&mut self, groups: &[Group<S, T>]) {
        let mut count = 0;
        for i in 0..self.count {
            let number = self.numbers[i];
            self.numbers[count] = number;
            count += usize::from(groups[usize::from(number)].is_waiting());
        }
        self.count = count;
    }

    #[inline(always)]
    fn each(&self) -> impl Iterator<Item = usize> {
        self.numbers[..self.count].iter().map(|&i| usize::from(i))
    }
}

impl<S: Simd, T: Turn, H: Hull> WithSimd for SearchOn<'_, S, T, H> {
    type Output = Result<(), Stuck>;

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> Self::Output {
        let Self {
            groups,
            hull,
            number,
        } = self;
        let mut waiting = Waiting::new(groups);
        for _ in 0..MOST_STEPS {
            for i in waiting.each() {
                groups[i].graze();
            }
            waiting.retain(groups);
            for i in waiting.each() {
                groups[i].go_on(hull);
            }
            for i in waiting.each() {
                groups[i].turned = sincos_in_lanes(groups[i].angle());
            }
            for i in waiting.each() {
                groups[i].look(hull);
            }
            for i in waiting.each() {
                groups[i].leap(hull);
            }
            for i in waiting.each() {
                groups[i].residue(hull);
            }
            for i in waiting.each() {
                groups[i].arrive(hull);
                groups[i].clear(hull);
            }
            waiting.retain(groups);
            if waiting.count == 0 {
                return Ok(());
            }
        }
        Err(groups[usize::from(waiting.numbers[0])].stuck(number))
    }
}
