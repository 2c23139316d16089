//! The bounce loop, the paper's steps 1–7, for as many particles at once as there are lanes.

use super::collision::collide;
use super::contact::{Departure, Search};
use super::flight::State;
use super::{Mask, Pack};
use crate::body::Body;
use crate::collision::InPlane;
use crate::trajectory::{COLLAPSE_RUN, Limits, StopReason, UNRESOLVED};
use pulp::Simd;

/// One impact in each lane.
pub(crate) struct Impact<S: Simd, const K: usize> {
    /// Time since release.
    pub time: Pack<S, K>,
    /// The state just before.
    pub before: State<S, K>,
    /// The state just after.
    pub after: State<S, K>,
    /// ±1: the sphere that touched.
    pub sphere: Pack<S, K>,
    /// Kinetic energies before and after.
    pub energy_before: Pack<S, K>,
    pub energy_after: Pack<S, K>,
    /// The lanes in which there is an impact.
    pub active: Mask<S, K>,
}

impl<S: Simd, const K: usize> Impact<S, K> {
    /// v_G^n before the impact.
    #[inline(always)]
    pub fn impact_velocity(&self) -> Pack<S, K> {
        -self.before.climb
    }

    /// Normal velocity of the centre of mass after the impact.
    #[inline(always)]
    pub fn rebound_velocity(&self) -> Pack<S, K> {
        self.after.climb
    }

    /// The coefficient of restitution (1).
    #[inline(always)]
    pub fn restitution(&self) -> Pack<S, K> {
        self.rebound_velocity() / self.impact_velocity() // (1)
    }

    /// E_rot/E_tot before the impact (12).
    #[inline(always)]
    pub fn rotational_fraction(&self, body: &Body) -> Pack<S, K> {
        self.before.rotational_energy(body.transverse) / self.energy_before // (12)
    }

    /// Kinetic energy after the impact over that before.
    #[inline(always)]
    pub fn energy_ratio(&self) -> Pack<S, K> {
        self.energy_after / self.energy_before
    }
}

/// Takes what happens to the particles in the lanes.
pub(crate) trait Sink {
    /// From now on lane 0 holds particle `first` of the block.
    fn begin(&mut self, first: usize);
    /// Impact number `number`, counted from 0 and common to all lanes, has happened.
    fn impact<S: Simd, const K: usize>(&mut self, number: usize, impact: &Impact<S, K>);
    /// The particle in `lane` has ended after `impacts` impacts.
    fn end(&mut self, lane: usize, impacts: usize, reason: StopReason);
}

/// Particles released from rest.
pub(crate) struct Release<'a> {
    /// Height of the centres of mass above R.
    pub lift: f64,
    /// The axes (s, 0, c), at most as many as there are lanes.
    pub sines: &'a [f64],
    pub cosines: &'a [f64],
}

/// Where the contact search did not end.
#[derive(Debug)]
pub(crate) struct Stuck {
    pub lane: usize,
    pub impacts: usize,
}

/// Bounces as many particles as there are lanes. Calls `go_on` before every impact.
#[inline(always)]
pub(crate) fn bounce<S: Simd, const K: usize>(
    simd: S,
    body: &Body,
    law: &impl InPlane,
    release: Release<'_>,
    limits: Limits,
    sink: &mut impl Sink,
    go_on: impl Fn() -> bool,
) -> Result<(), Stuck> {
    let particles = release.sines.len();
    let zero: Pack<S, K> = Pack::splat(simd, 0.0);
    let mut state = State {
        lift: Pack::splat(simd, release.lift),
        glide: zero,
        climb: zero,
        sine: zero,
        cosine: Pack::splat(simd, 1.0),
        spin: zero,
    };
    state.sine.as_mut_slice()[..particles].copy_from_slice(release.sines);
    state.cosine.as_mut_slice()[..particles].copy_from_slice(release.cosines);
    let mut lanes = Lanes::new(simd, particles);
    let gap = |side: f64| state.cosine.mul_add(side, state.lift);
    let one = gap(body.half_separation).le(0.0);
    let two = gap(-body.half_separation).le(0.0);
    let mut departure = Departure {
        sphere: one.select(1.0, two.select(-1.0, zero)),
        speed: zero,
    };
    let mut clock = zero;
    let mut unresolved = zero;
    for number in 0..limits.impacts {
        if !go_on() {
            lanes.end(lanes.active, number, StopReason::Interrupted, sink);
            return Ok(());
        }
        let search = Search::new(&state, &departure, body.half_separation);
        let still = departure.speed.le(0.0);
        if still.any() {
            let rests = still & search.rests();
            lanes.end(rests, number, StopReason::Collapse, sink);
        }
        let landing = search.landing(lanes.active).map_err(|lane| Stuck {
            lane,
            impacts: number,
        })?;
        lanes.end(landing.never, number, StopReason::NeverLands, sink);
        if !lanes.active.any() {
            return Ok(());
        }
        let before = landing.state;
        let (after, speed) = collide(body, law, &before, landing.sphere);
        clock = clock + landing.time;
        let energy_after = after.kinetic_energy(body.transverse);
        sink.impact(
            number,
            &Impact {
                time: clock,
                before,
                after,
                sphere: landing.sphere,
                energy_before: before.kinetic_energy(body.transverse),
                energy_after,
                active: lanes.active,
            },
        );
        if limits.minimum_speed > 0.0 {
            let slow = (2.0 * energy_after).lt(limits.minimum_speed * limits.minimum_speed);
            lanes.end(slow, number + 1, StopReason::SpeedBelowThreshold, sink);
        }
        let low = (search.bound * (landing.time * landing.time)).lt(UNRESOLVED);
        if low.any() {
            unresolved = low.select(unresolved + 1.0, 0.0);
            let collapsed = unresolved.eq(f64::from(COLLAPSE_RUN));
            lanes.end(collapsed, number + 1, StopReason::Collapse, sink);
        } else {
            unresolved = zero;
        }
        departure = Departure {
            sphere: landing.sphere,
            speed,
        };
        state = after;
    }
    lanes.end(
        lanes.active,
        limits.impacts,
        StopReason::ImpactsReached,
        sink,
    );
    Ok(())
}

/// Which lanes still hold a particle.
struct Lanes<S: Simd, const K: usize> {
    active: Mask<S, K>,
}

impl<S: Simd, const K: usize> Lanes<S, K> {
    #[inline(always)]
    fn new(simd: S, particles: usize) -> Self {
        let mut occupied = Pack::<S, K>::splat(simd, 0.0);
        occupied.as_mut_slice()[..particles].fill(1.0);
        Self {
            active: occupied.eq(1.0),
        }
    }

    /// Ends the active lanes in `which`. Rare.
    #[inline(always)]
    fn end(&mut self, which: Mask<S, K>, impacts: usize, reason: StopReason, sink: &mut impl Sink) {
        let ending = which & self.active;
        if ending.any() {
            ending.each(|lane| sink.end(lane, impacts, reason));
            self.active = self.active & !ending;
        }
    }
}
