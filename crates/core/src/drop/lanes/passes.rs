//! Further passes of the contact search.

use super::group::{Group, Stuck};
use super::leg::{Idle, pass};
use super::strike::Turn;
use crate::shape::Hull;
use crate::simd::Pack;
use pulp::{Simd, WithSimd};

/// Largest share of the lanes that sit out the impacts of the others: a further pass for fewer would take longer than the impacts
/// that they miss.
const SHARE: f64 = 0.4;

/// Decides which lanes are done, and continues with passes of all groups, stage by stage as in the first one, until few lanes wait.
/// Compiled separately: inlined, it would use up the registers of every bounce loop.
pub(super) struct SearchOn<'a, S: Simd, T: Turn, H> {
    pub groups: &'a mut [Group<S, T>],
    pub hull: &'a H,
}

impl<S: Simd, T: Turn, H: Hull> WithSimd for SearchOn<'_, S, T, H> {
    type Output = Result<(), Stuck>;

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> Self::Output {
        let Self { groups, hull } = self;
        loop {
            for group in groups.iter_mut() {
                if group.takes_another_pass() {
                    group.look_closer(hull);
                }
            }
            for group in groups.iter_mut() {
                group.clear(hull);
            }
            for group in groups.iter_mut() {
                group.graze();
            }
            for group in groups.iter_mut() {
                if group.takes_another_pass() {
                    group.go_on(hull);
                    group.stuck()?;
                }
            }
            if are_few_behind(groups) {
                return Ok(());
            }
            pass(groups, hull, &mut Idle);
        }
    }
}

#[inline(always)]
fn are_few_behind<S: Simd, T: Turn>(groups: &[Group<S, T>]) -> bool {
    let mut behind = groups[0].behind();
    for group in &groups[1..] {
        behind = behind + group.behind();
    }
    let lanes = groups.len() * Pack::<S, 1>::WIDTH;
    behind.as_slice().iter().sum::<f64>() <= SHARE * lanes as f64
}
