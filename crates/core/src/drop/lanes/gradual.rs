//! Impacts under a law whose responses may take long: those that do are found for all groups together.

use super::group::{GROUPS, Group};
use super::strike::{Touch, Turn};
use crate::law::{Gradual, Late};
use crate::shape::{Body, Hull};
use pulp::{Simd, WithSimd};

/// The impacts of all groups. Compiled apart, for it is long.
pub(super) struct Collide<'a, S: Simd, T: Turn, H> {
    pub groups: &'a mut [Group<S, T>],
    pub body: &'a Body,
    pub hull: &'a H,
    pub law: Gradual<'a>,
}

impl<S: Simd, T: Turn, H: Hull> WithSimd for Collide<'_, S, T, H> {
    type Output = ();

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) {
        let Self {
            groups,
            body,
            hull,
            law,
        } = self;
        let simd = groups[0].active.simd();
        let mut waiting = [(0, Touch::nothing(simd)); GROUPS];
        let mut late = [Late::nothing(simd); GROUPS];
        let mut count = 0;
        for (i, group) in groups.iter_mut().enumerate() {
            let touch = group.land(hull);
            let (contact, landing) = group.contact(body, touch);
            let mut answer = law.begin(&contact);
            answer.open = landing.select(answer.open, 0.0);
            if answer.open.eq(1.0).any() {
                (waiting[count], late[count]) = ((i, touch), answer);
                count += 1;
            } else {
                group.respond(body, touch, answer.approach(), &answer.response);
            }
        }
        if count > 0 {
            law.finish(&mut late[..count]);
            for (&(i, touch), late) in waiting[..count].iter().zip(&late) {
                groups[i].respond(body, touch, late.approach(), &late.response);
            }
        }
    }
}
