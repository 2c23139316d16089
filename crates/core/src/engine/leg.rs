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
use crate::body::{Body, Hull, Surface, with_hull};
use crate::collision::{Law, Respond};
use crate::simd::Pack;
use crate::simd::elementary::sincos_in_lanes;
use pulp::{Simd, WithSimd};
use std::marker::PhantomData;
use std::ops::Range;

/// Vectors whose sines and cosines are computed side by side, with nothing else in the registers.
const WIDE: usize = 6;

/// The motion of groups of particles from one impact to the next.
pub(crate) trait Legs<S: Simd, T: Turn> {
    /// The groups with the particles of a release.
    fn groups<const N: usize>(
        &self,
        simd: S,
        release: &impl Release,
        particles: Range<usize>,
    ) -> [Group<S, T>; N];

    /// Moves all groups through their flight to impact `number` and through that impact.
    fn fly(
        &self,
        simd: S,
        groups: &mut [Group<S, T>],
        number: usize,
        sink: &mut impl Meanwhile,
    ) -> Result<(), Stuck>;
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
    #[inline(always)]
    fn groups<const N: usize>(
        &self,
        simd: S,
        release: &impl Release,
        particles: Range<usize>,
    ) -> [Group<S, T>; N] {
        let mut groups = [Group::empty(simd, self.hull); N];
        let width = Pack::<S, 1>::WIDTH;
        for (group, first) in groups.iter_mut().zip(particles.clone().step_by(width)) {
            let count = width.min(particles.end - first);
            let place = first - particles.start;
            group.occupy(place, first..first + count, release, self.slope, self.hull);
        }
        groups
    }

    #[inline(always)]
    fn fly(
        &self,
        _: S,
        groups: &mut [Group<S, T>],
        number: usize,
        sink: &mut impl Meanwhile,
    ) -> Result<(), Stuck> {
        let Self {
            body, hull, law, ..
        } = *self;
        if number > 0 {
            for group in groups.iter_mut() {
                group.start(self.slope, hull);
                sink.meanwhile();
            }
        }
        find::<S, T>(groups, hull, number, sink)?;
        if T::SPACE
            && let Some(law) = law.takes_long()
        {
            let simd = groups[0].active.simd();
            simd.vectorize(Collide {
                groups,
                body,
                hull,
                law,
            });
            return Ok(());
        }
        for group in groups.iter_mut() {
            group.land(hull);
            group.collide(body, hull, law);
            sink.meanwhile();
        }
        Ok(())
    }
}

/// Locates the next contact of all groups.
#[inline(always)]
pub(super) fn find<S: Simd, T: Turn>(
    groups: &mut [Group<S, T>],
    hull: &impl Hull,
    number: usize,
    sink: &mut impl Meanwhile,
) -> Result<(), Stuck> {
    for group in groups.iter_mut() {
        group.depart(number, hull);
        sink.meanwhile();
    }
    turn(groups, sink);
    for group in groups.iter_mut() {
        group.look(hull);
        sink.meanwhile();
    }
    for group in groups.iter_mut() {
        group.leap(hull);
        sink.meanwhile();
    }
    for group in groups.iter_mut() {
        group.residue(hull);
        sink.meanwhile();
    }
    for group in groups.iter_mut() {
        group.arrive(hull);
        sink.meanwhile();
    }
    if groups.iter().any(Group::is_waiting) {
        let simd = groups[0].active.simd();
        simd.vectorize(SearchOn {
            groups: &mut *groups,
            hull,
            number,
        })?;
    }
    for group in groups.iter_mut() {
        group.end_those_that_never_land(number);
    }
    Ok(())
}

/// Computes sine and cosine of the angle turned through at the first evaluation of each group.
#[inline(always)]
fn turn<S: Simd, T: Turn>(groups: &mut [Group<S, T>], sink: &mut impl Meanwhile) {
    let mut chunks = groups.chunks_exact_mut(WIDE);
    for chunk in &mut chunks {
        let mut angle = Pack::<S, WIDE>::splat(chunk[0].time.simd(), 0.0);
        for (i, group) in chunk.iter().enumerate() {
            angle.set_part(i, &group.angle());
        }
        let (sin, cos) = sincos_in_lanes(angle);
        for (i, group) in chunk.iter_mut().enumerate() {
            group.turned = (sin.part(i), cos.part(i));
            sink.meanwhile();
        }
    }
    for group in chunks.into_remainder() {
        group.turned = sincos_in_lanes(group.angle());
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
    #[inline(always)]
    fn groups<const N: usize>(
        &self,
        simd: S,
        release: &impl Release,
        particles: Range<usize>,
    ) -> [Group<S, T>; N] {
        with_hull!(self.surface(), hull => simd.vectorize(Occupy {
            legs: self.with(hull),
            release,
            particles,
            simd,
            turn: PhantomData,
        }))
    }

    #[inline(always)]
    fn fly(
        &self,
        simd: S,
        groups: &mut [Group<S, T>],
        number: usize,
        _: &mut impl Meanwhile,
    ) -> Result<(), Stuck> {
        with_hull!(self.surface(), hull => simd.vectorize(Fly {
            legs: self.with(hull),
            groups,
            number,
        }))
    }
}

/// [`Legs::groups`], compiled separately for each SIMD level.
struct Occupy<'a, S: Simd, T: Turn, L, R, const N: usize> {
    legs: L,
    release: &'a R,
    particles: Range<usize>,
    simd: S,
    turn: PhantomData<[Group<S, T>; N]>,
}

impl<S: Simd, T: Turn, L: Legs<S, T>, R: Release, const N: usize> WithSimd
    for Occupy<'_, S, T, L, R, N>
{
    type Output = [Group<S, T>; N];

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> Self::Output {
        self.legs.groups(self.simd, self.release, self.particles)
    }
}

/// [`Legs::fly`], compiled separately for each SIMD level.
struct Fly<'a, S: Simd, T: Turn, L> {
    legs: L,
    groups: &'a mut [Group<S, T>],
    number: usize,
}

impl<S: Simd, T: Turn, L: Legs<S, T>> WithSimd for Fly<'_, S, T, L> {
    type Output = Result<(), Stuck>;

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> Self::Output {
        let simd = self.groups[0].active.simd();
        self.legs.fly(simd, self.groups, self.number, &mut Idle)
    }
}

/// No work to interleave.
pub(super) struct Idle;

impl Meanwhile for Idle {
    #[inline(always)]
    fn meanwhile(&mut self) {}
}
