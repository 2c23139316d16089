//! From one impact to the next.
//!
//! The flight to the next impact, and the impact itself, are divided into stages. Each stage is carried out for all groups
//! before the next begins: its operands are then available, and the processor executes the same stage of several groups in
//! parallel. All stages of one group in a row would be a single chain of dependent operations.

use super::collision::{Collisions, Dimension};
use super::group::Group;
use super::impact::Meanwhile;
use super::interleaved::{Idle, is_interleaved, work_up};
use super::particles::{Lost, Release};
use super::passes::{SearchOn, pass};
use crate::law::{Law, Respond, Response};
use crate::shape::{Body, Hull, Surface, with_hull};
use crate::simd::Lanewise;
use pulp::{Simd, WithSimd};
use std::ops::Range;
use std::slice::{from_mut, from_ref};

/// The motion of groups of particles from one impact to the next.
pub(crate) trait Advance<S: Simd, T: Dimension> {
    /// True if the work of the sink is interleaved with that of [`Advance::advance`].
    const INTERLEAVED: bool;

    /// Returns whether ε_n is drawn for every impact.
    fn scatters(&self) -> bool;

    /// Groups without particles.
    fn groups<const N: usize>(&self, simd: S) -> [Group<S, T>; N];

    /// Puts particles of a release into the lanes that are free, as long as there are any.
    fn occupy(
        &self,
        groups: &mut [Group<S, T>],
        release: &impl Release,
        particles: &mut Range<usize>,
    );

    /// Moves all groups on until enough lanes have a contact, and through its impact.
    fn advance(
        &self,
        groups: &mut [Group<S, T>],
        collisions: &mut Collisions<S>,
        sink: &mut impl Meanwhile,
    ) -> Result<(), Lost>;
}

/// Hull and law inlined in the bounce loop, and the work of the sink interleaved with the stages; used for the most common runs.
pub(crate) struct Inlined<'a, H, L> {
    pub body: &'a Body,
    pub hull: &'a H,
    pub law: &'a L,
    /// tan α.
    pub slope: f64,
}

/// Every hull and law, compiled once for all sinks.
pub(crate) struct General<'a, 'b> {
    pub body: &'a Body,
    pub law: &'a Law<'b>,
    /// tan α.
    pub slope: f64,
}

impl<S: Simd, T: Dimension, H: Hull, L: Respond> Advance<S, T> for Inlined<'_, H, L> {
    const INTERLEAVED: bool = is_interleaved::<S>();

    #[inline(always)]
    fn scatters(&self) -> bool {
        self.law.scatters()
    }

    #[inline(always)]
    fn groups<const N: usize>(&self, simd: S) -> [Group<S, T>; N] {
        [Group::empty(simd, self.hull); N]
    }

    #[inline(always)]
    fn occupy(
        &self,
        groups: &mut [Group<S, T>],
        release: &impl Release,
        particles: &mut Range<usize>,
    ) {
        let simd = groups[0].particles.active.simd();
        simd.vectorize(Occupy {
            groups,
            release,
            particles,
            slope: self.slope,
            hull: self.hull,
        });
    }

    #[inline(always)]
    fn advance(
        &self,
        groups: &mut [Group<S, T>],
        collisions: &mut Collisions<S>,
        sink: &mut impl Meanwhile,
    ) -> Result<(), Lost> {
        for (i, group) in groups.iter_mut().enumerate() {
            group.start(self.slope, self.hull);
            work_up::<S>(sink, i, 0);
        }
        find(groups, self.hull, sink)?;
        self.collide(groups, collisions, sink)
    }
}

impl<H: Hull, L: Respond> Inlined<'_, H, L> {
    /// Moves the bodies to their contacts, and applies the law.
    #[inline(always)]
    fn collide<S: Simd, T: Dimension>(
        &self,
        groups: &mut [Group<S, T>],
        collisions: &mut Collisions<S>,
        sink: &mut impl Meanwhile,
    ) -> Result<(), Lost> {
        let Self {
            body, hull, law, ..
        } = *self;
        let Collisions {
            points,
            contacts,
            chances,
            responses,
        } = collisions;
        if T::SPACE {
            let count = groups.len();
            let (contacts, responses) = (&mut contacts[..count], &mut responses[..count]);
            for (i, group) in groups.iter_mut().enumerate() {
                points[i] = group.land(hull);
                contacts[i] = group.contact(body, points[i]);
            }
            if let Some(law) = law.custom() {
                for (i, group) in groups.iter().enumerate() {
                    responses[i] = group.ask(law, points[i], &contacts[i])?;
                }
            } else {
                law.respond_all::<S, true>(contacts, chances, responses);
            }
            for (i, group) in groups.iter_mut().enumerate() {
                group.leave(body, points[i], &contacts[i], &responses[i]);
                work_up::<S>(sink, i, 7);
            }
        } else {
            // In the plane no law takes long, and one contact after the other stays in the registers.
            for (i, group) in groups.iter_mut().enumerate() {
                let point = group.land(hull);
                let contact = group.contact(body, point);
                let mut response = Response::none(contact.velocity.z.simd());
                law.respond_all::<S, false>(
                    from_ref(&contact),
                    from_ref(&chances[i]),
                    from_mut(&mut response),
                );
                group.leave(body, point, &contact, &response);
                work_up::<S>(sink, i, 7);
            }
        }
        Ok(())
    }
}

/// Searches for the next contact of all groups until few of their lanes still wait for one.
#[inline(always)]
pub(crate) fn find<S: Simd, T: Dimension>(
    groups: &mut [Group<S, T>],
    hull: &impl Hull,
    sink: &mut impl Meanwhile,
) -> Result<(), Lost> {
    for (i, group) in groups.iter_mut().enumerate() {
        group.begin_search(hull);
        work_up::<S>(sink, i, 1);
    }
    pass(groups, hull, sink);
    if groups.iter().any(Group::takes_another_pass) {
        let simd = groups[0].particles.active.simd();
        simd.vectorize(SearchOn {
            groups: &mut *groups,
            hull,
        })?;
    }
    for group in groups.iter_mut() {
        group.end_those_that_never_land();
    }
    Ok(())
}

impl<'a, 'b> General<'a, 'b> {
    fn with<H>(&self, hull: &'a H) -> Inlined<'a, H, Law<'b>> {
        let Self { body, law, slope } = *self;
        Inlined {
            body,
            hull,
            law,
            slope,
        }
    }

    fn surface(&self) -> &'a Surface {
        &self.body.hull
    }
}

impl<S: Simd, T: Dimension> Advance<S, T> for General<'_, '_> {
    const INTERLEAVED: bool = false;

    #[inline(always)]
    fn scatters(&self) -> bool {
        self.law.scatters()
    }

    #[inline(always)]
    fn groups<const N: usize>(&self, simd: S) -> [Group<S, T>; N] {
        with_hull!(self.surface(), hull => self.with(hull).groups(simd))
    }

    #[inline(always)]
    fn occupy(
        &self,
        groups: &mut [Group<S, T>],
        release: &impl Release,
        particles: &mut Range<usize>,
    ) {
        with_hull!(self.surface(), hull => self.with(hull).occupy(groups, release, particles));
    }

    #[inline(always)]
    fn advance(
        &self,
        groups: &mut [Group<S, T>],
        collisions: &mut Collisions<S>,
        _: &mut impl Meanwhile,
    ) -> Result<(), Lost> {
        let simd = groups[0].particles.active.simd();
        with_hull!(self.surface(), hull => simd.vectorize(AdvanceApart {
            cycle: self.with(hull),
            groups,
            collisions,
        }))
    }
}

/// [`Advance::occupy`], compiled separately for each SIMD level.
struct Occupy<'a, S: Simd, T: Dimension, H, R> {
    groups: &'a mut [Group<S, T>],
    release: &'a R,
    particles: &'a mut Range<usize>,
    slope: f64,
    hull: &'a H,
}

impl<S: Simd, T: Dimension, H: Hull, R: Release> WithSimd for Occupy<'_, S, T, H, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) {
        for group in self.groups {
            if !group.particles.active.all() {
                group.occupy(self.release, self.particles, self.slope, self.hull);
            }
        }
    }
}

/// [`Advance::advance`], compiled separately for each SIMD level.
struct AdvanceApart<'a, S: Simd, T: Dimension, L> {
    cycle: L,
    groups: &'a mut [Group<S, T>],
    collisions: &'a mut Collisions<S>,
}

impl<S: Simd, T: Dimension, L: Advance<S, T>> WithSimd for AdvanceApart<'_, S, T, L> {
    type Output = Result<(), Lost>;

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> Self::Output {
        self.cycle.advance(self.groups, self.collisions, &mut Idle)
    }
}
