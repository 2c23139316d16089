//! Further passes of the contact search.

use super::advance::pass;
use super::collision::Dimension;
use super::group::{Group, Unconverged};
use super::interleaved::Idle;
use crate::shape::Hull;
use crate::simd::Pack;
use pulp::{Simd, WithSimd};

/// Largest share of the lanes that sit out the impacts of the others: a further pass for fewer would take longer than the impacts
/// that they miss.
const SHARE: f64 = 0.4;

/// Decides which lanes are done, and continues with passes of all groups, stage by stage as in the first one, until few lanes wait.
/// Compiled separately: inlined, it would use up the registers of every bounce loop.
pub(super) struct SearchOn<'a, S: Simd, T: Dimension, H> {
    pub groups: &'a mut [Group<S, T>],
    pub hull: &'a H,
}

impl<S: Simd, T: Dimension, H: Hull> WithSimd for SearchOn<'_, S, T, H> {
    type Output = Result<(), Unconverged>;

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> Self::Output {
        let Self { groups, hull } = self;
        loop {
            for group in groups.iter_mut() {
                if group.takes_another_pass() {
                    group.predict_again(hull);
                }
            }
            for group in groups.iter_mut() {
                group.clear(hull);
            }
            for group in groups.iter_mut() {
                group.accept_grazing();
            }
            for group in groups.iter_mut() {
                if group.takes_another_pass() {
                    group.go_on(hull);
                    group.converged()?;
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
fn are_few_behind<S: Simd, T: Dimension>(groups: &[Group<S, T>]) -> bool {
    let mut behind = groups[0].behind();
    for group in &groups[1..] {
        behind = behind + group.behind();
    }
    let lanes = groups.len() * Pack::<S, 1>::WIDTH;
    behind.as_slice().iter().sum::<f64>() <= SHARE * lanes as f64
}
