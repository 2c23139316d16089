//! Impacts under a law whose responses may take long: those that do are found for all groups together.

use super::collision::{ContactPoint, Dimension};
use super::group::{GROUPS, Group};
use crate::law::{Gradual, Late};
use crate::shape::{Body, Hull};
use pulp::{Simd, WithSimd};

/// The impacts of all groups. Compiled apart, for it is long.
pub(super) struct Collide<'a, S: Simd, T: Dimension, H> {
    pub groups: &'a mut [Group<S, T>],
    pub body: &'a Body,
    pub hull: &'a H,
    pub law: Gradual<'a>,
}

impl<S: Simd, T: Dimension, H: Hull> WithSimd for Collide<'_, S, T, H> {
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
        let mut waiting = [(0, ContactPoint::none(simd)); GROUPS];
        let mut late = [Late::none(simd); GROUPS];
        let mut count = 0;
        for (i, group) in groups.iter_mut().enumerate() {
            let point = group.land(hull);
            let (contact, landing) = group.contact(body, point);
            let mut answer = law.begin(&contact);
            answer.open = landing.select(answer.open, 0.0);
            if answer.open.eq(1.0).any() {
                (waiting[count], late[count]) = ((i, point), answer);
                count += 1;
            } else {
                group.respond(body, point, answer.approach(), &answer.response);
            }
        }
        if count > 0 {
            law.finish(&mut late[..count]);
            for (&(i, point), late) in waiting[..count].iter().zip(&late) {
                groups[i].respond(body, point, late.approach(), &late.response);
            }
        }
    }
}
