//! From one impact to the next.
//!
//! A leg, the flight to the next impact and the impact itself, is divided into stages. Each stage is carried out for all groups
//! before the next begins: its operands are then available, and the processor executes the same stage of several groups in
//! parallel. All stages of one group in a row would be a single chain of dependent operations.

use super::gradual::Collide;
use super::group::{Group, Release, Stuck};
use super::impact::Meanwhile;
use super::passes::SearchOn;
use super::strike::Turn;
use crate::law::{Law, Respond};
use crate::shape::{Body, Hull, Surface, with_hull};
use crate::simd::Pack;
use crate::simd::elementary::sincos_in_lanes;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Vectors whose sines and cosines are computed side by side, with nothing else in the registers.
const WIDE: usize = 6;

/// The motion of groups of particles from one impact to the next.
pub(crate) trait Legs<S: Simd, T: Turn> {
    /// Whether the work of the sink is interleaved with that of [`Legs::fly`].
    const TOGETHER: bool;

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
    fn fly(&self, groups: &mut [Group<S, T>], sink: &mut impl Meanwhile) -> Result<(), Stuck>;
}

/// Legs with hull and law inlined in the bounce loop, and the work of the sink interleaved with the stages; used for the most common
/// runs.
pub(crate) struct Together<'a, H, L> {
    body: &'a Body,
    hull: &'a H,
    law: &'a L,
    slope: f64,
}

impl<'a, H, L> Together<'a, H, L> {
    /// Legs over a plane that descends along x with this slope, tan α.
    pub fn new(body: &'a Body, hull: &'a H, law: &'a L, slope: f64) -> Self {
        Self {
            body,
            hull,
            law,
            slope,
        }
    }
}

/// Legs for every hull and law, compiled once for all sinks.
pub(crate) struct Apart<'a, 'b> {
    pub body: &'a Body,
    pub law: &'a Law<'b>,
    /// tan α, α the inclination of the plane.
    pub slope: f64,
}

impl<S: Simd, T: Turn, H: Hull, L: Respond> Legs<S, T> for Together<'_, H, L> {
    const TOGETHER: bool = true;

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
        let simd = groups[0].active.simd();
        simd.vectorize(Occupy {
            groups,
            release,
            particles,
            slope: self.slope,
            hull: self.hull,
        });
    }

    #[inline(always)]
    fn fly(&self, groups: &mut [Group<S, T>], sink: &mut impl Meanwhile) -> Result<(), Stuck> {
        let Self {
            body, hull, law, ..
        } = *self;
        for (i, group) in groups.iter_mut().enumerate() {
            group.start(self.slope, hull);
            work_up::<S>(sink, i, 0);
        }
        find::<S, T>(groups, hull, sink)?;
        if T::SPACE
            && let Some(law) = law.takes_long()
        {
            let simd = groups[0].active.simd();
            simd.vectorize(Collide {
                groups: &mut *groups,
                body,
                hull,
                law,
            });
            for i in 0..groups.len() {
                work_up::<S>(sink, i, 7);
            }
            return Ok(());
        }
        for (i, group) in groups.iter_mut().enumerate() {
            let touch = group.land(hull);
            group.collide(body, law, touch);
            work_up::<S>(sink, i, 7);
        }
        Ok(())
    }
}

/// Works up the impact of a lane of a group, if there is such a lane: eight stages have one lane each.
#[inline(always)]
fn work_up<S: Simd>(sink: &mut impl Meanwhile, group: usize, lane: usize) {
    if lane < Pack::<S, 1>::WIDTH {
        sink.meanwhile(group * Pack::<S, 1>::WIDTH + lane);
    }
}

/// Searches for the next contact of all groups until few of their lanes still wait for one.
#[inline(always)]
pub(crate) fn find<S: Simd, T: Turn>(
    groups: &mut [Group<S, T>],
    hull: &impl Hull,
    sink: &mut impl Meanwhile,
) -> Result<(), Stuck> {
    for (i, group) in groups.iter_mut().enumerate() {
        group.depart(hull);
        work_up::<S>(sink, i, 1);
    }
    pass(groups, hull, sink);
    if groups.iter().any(Group::takes_another_pass) {
        let simd = groups[0].active.simd();
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

/// A pass of the search.
#[inline(always)]
pub(super) fn pass<S: Simd, T: Turn>(
    groups: &mut [Group<S, T>],
    hull: &impl Hull,
    sink: &mut impl Meanwhile,
) {
    turn(groups, sink);
    for (i, group) in groups.iter_mut().enumerate() {
        group.look(hull);
        work_up::<S>(sink, i, 3);
    }
    for (i, group) in groups.iter_mut().enumerate() {
        group.leap(hull);
        work_up::<S>(sink, i, 4);
    }
    for (i, group) in groups.iter_mut().enumerate() {
        group.residue(hull);
        work_up::<S>(sink, i, 5);
    }
    for (i, group) in groups.iter_mut().enumerate() {
        group.arrive(hull);
        work_up::<S>(sink, i, 6);
    }
}

/// Computes sine and cosine of the angle turned through at the evaluation of each group.
#[inline(always)]
fn turn<S: Simd, T: Turn>(groups: &mut [Group<S, T>], sink: &mut impl Meanwhile) {
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

impl<'a, 'b> Apart<'a, 'b> {
    fn with<H>(&self, hull: &'a H) -> Together<'a, H, Law<'b>> {
        Together::new(self.body, hull, self.law, self.slope)
    }

    fn surface(&self) -> &'a Surface {
        &self.body.hull
    }
}

impl<S: Simd, T: Turn> Legs<S, T> for Apart<'_, '_> {
    const TOGETHER: bool = false;

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
    fn fly(&self, groups: &mut [Group<S, T>], _: &mut impl Meanwhile) -> Result<(), Stuck> {
        let simd = groups[0].active.simd();
        with_hull!(self.surface(), hull => simd.vectorize(Fly {
            legs: self.with(hull),
            groups,
        }))
    }
}

/// [`Legs::occupy`], compiled separately for each SIMD level.
struct Occupy<'a, S: Simd, T: Turn, H, R> {
    groups: &'a mut [Group<S, T>],
    release: &'a R,
    particles: &'a mut Range<usize>,
    slope: f64,
    hull: &'a H,
}

impl<S: Simd, T: Turn, H: Hull, R: Release> WithSimd for Occupy<'_, S, T, H, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) {
        for group in self.groups {
            if !group.active.all() {
                group.occupy(self.release, self.particles, self.slope, self.hull);
            }
        }
    }
}

/// [`Legs::fly`], compiled separately for each SIMD level.
struct Fly<'a, S: Simd, T: Turn, L> {
    legs: L,
    groups: &'a mut [Group<S, T>],
}

impl<S: Simd, T: Turn, L: Legs<S, T>> WithSimd for Fly<'_, S, T, L> {
    type Output = Result<(), Stuck>;

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> Self::Output {
        self.legs.fly(self.groups, &mut Idle)
    }
}

/// No work to interleave.
pub(crate) struct Idle;

impl Meanwhile for Idle {
    #[inline(always)]
    fn meanwhile(&mut self, _: usize) {}
}
