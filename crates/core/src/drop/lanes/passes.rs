//! Passes of the contact search.

use super::collision::Dimension;
use super::group::Group;
use super::impact::Meanwhile;
use super::interleaved::{Idle, work_up};
use super::particles::Lost;
use crate::shape::Hull;
use crate::simd::Pack;
use crate::simd::elementary::sincos_in_lanes;
use pulp::{Simd, WithSimd};

/// Vectors whose sines and cosines are computed side by side, with the registers to themselves.
const WIDE: usize = 6;

/// Largest share of the lanes that sit out the impacts of the others: a further pass for fewer would take longer than the impacts
/// that they miss.
const SHARE: f64 = 0.4;

/// A pass of the search.
#[inline(always)]
pub(super) fn pass<S: Simd, T: Dimension>(
    groups: &mut [Group<S, T>],
    hull: &impl Hull,
    sink: &mut impl Meanwhile,
) {
    turn(groups, sink);
    for (i, group) in groups.iter_mut().enumerate() {
        group.evaluate(hull);
        work_up::<S>(sink, i, 3);
    }
    for (i, group) in groups.iter_mut().enumerate() {
        group.propose(hull);
        work_up::<S>(sink, i, 4);
    }
    for (i, group) in groups.iter_mut().enumerate() {
        group.predict(hull);
        work_up::<S>(sink, i, 5);
    }
    for (i, group) in groups.iter_mut().enumerate() {
        group.locate(hull);
        work_up::<S>(sink, i, 6);
    }
}

/// Computes sine and cosine of the angle turned through at the evaluation of each group.
#[inline(always)]
fn turn<S: Simd, T: Dimension>(groups: &mut [Group<S, T>], sink: &mut impl Meanwhile) {
    for (first, chunk) in groups.chunks_mut(WIDE).enumerate() {
        let mut angle = Pack::<S, WIDE>::splat(chunk[0].time.simd(), 0.0);
        for (i, group) in chunk.iter().enumerate() {
            angle.set_part(i, &group.angle());
        }
        let (sin, cos) = sincos_in_lanes(angle);
        for (i, group) in chunk.iter_mut().enumerate() {
            group.turned = (sin.part(i), cos.part(i));
            work_up::<S>(sink, WIDE * first + i, 2);
        }
    }
}

/// Decides which lanes are done, and continues with passes of all groups, stage by stage as in the first one, until few lanes wait.
/// Compiled separately: inlined, it would use up the registers of every bounce loop.
pub(super) struct SearchOn<'a, S: Simd, T: Dimension, H> {
    pub groups: &'a mut [Group<S, T>],
    pub hull: &'a H,
}

impl<S: Simd, T: Dimension, H: Hull> WithSimd for SearchOn<'_, S, T, H> {
    type Output = Result<(), Lost>;

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
    let lanes = groups.len() * Pack::<S>::WIDTH;
    behind.as_slice().iter().sum::<f64>() <= SHARE * lanes as f64
}
