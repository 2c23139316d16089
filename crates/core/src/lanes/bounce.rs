//! The bounce loop, the paper's steps 1–7, for as many particles at once as there are lanes.

use super::arrival::{Arrival, Leap, Residue};
use super::collision::collide;
use super::contact::{Departure, Look, Search};
use super::flight::State;
use super::sink::{Impact, Sink};
use super::{Mask, Pack};
use crate::body::Body;
use crate::collision::InPlane;
use crate::contact::MOST_STEPS;
use crate::elementary::sincos_in_lanes;
use crate::trajectory::{COLLAPSE_RUN, Limits, StopReason, UNRESOLVED};
use pulp::Simd;

/// Particles released from rest.
pub(crate) struct Release<'a> {
    /// Height of the centres of mass above R.
    pub lift: f64,
    /// The axes (s, 0, c).
    pub sines: &'a [f64],
    pub cosines: &'a [f64],
}

/// Where the contact search did not end.
#[derive(Debug)]
pub(crate) struct Stuck {
    pub lane: usize,
    pub impacts: usize,
}

/// As many particles as a vector has lanes. Aligned, and with it the stack, to a line of the cache, which a vector must not
/// straddle.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Group<S: Simd> {
    /// The search from the start of the flight, which gives way to the state before the impact.
    search: Search<S, 1>,
    /// Where the search looks, and sine and cosine there.
    time: Pack<S, 1>,
    turned: (Pack<S, 1>, Pack<S, 1>),
    /// What it sees there, and where that leads.
    look: Look<S, 1>,
    leap: Leap<S, 1>,
    residue: Residue<S, 1>,
    arrival: Arrival<S, 1>,
    /// What an impact changes: v_x, v_z and ω after it.
    glide: Pack<S, 1>,
    climb: Pack<S, 1>,
    spin: Pack<S, 1>,
    /// Time since release.
    clock: Pack<S, 1>,
    /// Unresolved flights in a row.
    unresolved: Pack<S, 1>,
    /// Which lanes hold a particle still.
    active: Mask<S, 1>,
    /// Number of lane 0.
    first: usize,
}

/// Bounces the particles of a release, at most as many as N groups hold. Calls `go_on` before every impact.
///
/// An impact is cut into stages, and each goes through all groups before the next begins. What a stage needs is then long
/// known when its turn comes, and the same stage of several groups is under way at once, as many as the processor can
/// look ahead; one stage after another for one group would be a single chain, with the arithmetic units waiting most of the time.
/// Sines and cosines are computed for W vectors side by side, with nothing else in the registers. The stages have the multipliers busy,
/// and the sink counts in between.
#[inline(always)]
pub(crate) fn bounce<S: Simd, const W: usize, const N: usize>(
    simd: S,
    body: &Body,
    law: &impl InPlane,
    release: Release<'_>,
    limits: Limits,
    sink: &mut impl Sink,
    go_on: impl Fn() -> bool,
) -> Result<(), Stuck> {
    let mut groups = [Group::<S>::empty(simd, body, release.lift); N];
    let occupied = release.sines.len().div_ceil(Pack::<S, 1>::WIDTH);
    let groups = &mut groups[..occupied];
    for (i, group) in groups.iter_mut().enumerate() {
        group.occupy(body, &release, i * Pack::<S, 1>::WIDTH);
    }
    for number in 0..limits.impacts {
        if !go_on() {
            for group in groups {
                group.end(group.active, number, StopReason::Interrupted, sink);
            }
            return Ok(());
        }
        for group in groups.iter_mut() {
            group.depart(number, sink);
            sink.meanwhile();
        }
        turn::<S, W>(groups, sink);
        for group in groups.iter_mut() {
            group.look = group.search.look(group.time, group.turned);
            sink.meanwhile();
        }
        for group in groups.iter_mut() {
            group.leap = group.search.leap(&group.look);
            sink.meanwhile();
        }
        for group in groups.iter_mut() {
            group.residue = group.search.residue(group.time, &group.look, &group.leap);
            sink.meanwhile();
        }
        for group in groups.iter_mut() {
            group.arrival = group
                .search
                .arrival(&group.look, &group.leap, &group.residue);
            sink.meanwhile();
        }
        for group in groups.iter_mut() {
            group.search_on(number)?;
            group.end(group.look.never, number, StopReason::NeverLands, sink);
        }
        for group in groups.iter_mut() {
            group.collide(body, law);
            sink.meanwhile();
        }
        let mut active = false;
        for group in groups.iter_mut() {
            group.tell(body, limits, number, sink);
            active |= group.active.any();
        }
        for group in groups.iter_mut() {
            group.start(body);
            sink.meanwhile();
        }
        if !active {
            return Ok(());
        }
    }
    for group in groups {
        group.end(
            group.active,
            limits.impacts,
            StopReason::ImpactsReached,
            sink,
        );
    }
    Ok(())
}

/// Computes sine and cosine of the angle where the groups look first, of W vectors at a time.
#[inline(always)]
fn turn<S: Simd, const W: usize>(groups: &mut [Group<S>], sink: &mut impl Sink) {
    let mut chunks = groups.chunks_exact_mut(W);
    for chunk in &mut chunks {
        let mut angle = Pack::<S, W>::splat(chunk[0].time.simd(), 0.0);
        for (i, group) in chunk.iter().enumerate() {
            angle.set_part(i, &group.search.angle(group.time));
        }
        let (sin, cos) = sincos_in_lanes(angle);
        for (i, group) in chunk.iter_mut().enumerate() {
            group.turned = (sin.part(i), cos.part(i));
            sink.meanwhile();
        }
    }
    for group in chunks.into_remainder() {
        group.turned = sincos_in_lanes(group.search.angle(group.time));
    }
}

impl<S: Simd> Group<S> {
    #[inline(always)]
    fn empty(simd: S, body: &Body, lift: f64) -> Self {
        let zero = Pack::splat(simd, 0.0);
        let state = State {
            lift: Pack::splat(simd, lift),
            glide: zero,
            climb: zero,
            sine: zero,
            cosine: Pack::splat(simd, 1.0),
            spin: zero,
        };
        let departure = Departure {
            sphere: zero,
            speed: zero,
        };
        let search = Search::new(state, departure, body.half_separation);
        let turned = (zero, Pack::splat(simd, 1.0));
        let look = search.look(zero, turned);
        let leap = search.leap(&look);
        let residue = search.residue(zero, &look, &leap);
        Self {
            search,
            look,
            leap,
            residue,
            arrival: search.arrival(&look, &leap, &residue),
            time: zero,
            turned,
            glide: zero,
            climb: zero,
            spin: zero,
            clock: zero,
            unresolved: zero,
            active: Mask::splat(simd, false),
            first: 0,
        }
    }

    /// Takes the particles of a release from number `first` on.
    #[inline(always)]
    fn occupy(&mut self, body: &Body, release: &Release<'_>, first: usize) {
        let particles = Pack::<S, 1>::WIDTH.min(release.sines.len() - first);
        let (from, to) = (first, first + particles);
        let (mut start, mut departure) = (self.search.start, self.search.departure);
        let State {
            sine, cosine, lift, ..
        } = &mut start;
        sine.as_mut_slice()[..particles].copy_from_slice(&release.sines[from..to]);
        cosine.as_mut_slice()[..particles].copy_from_slice(&release.cosines[from..to]);
        let one = cosine.mul_add(body.half_separation, *lift).le(0.0);
        let two = cosine.mul_add(-body.half_separation, *lift).le(0.0);
        departure.sphere = one.select(1.0, two.select(-1.0, 0.0 * *cosine));
        let mut occupied = 0.0 * *cosine;
        occupied.as_mut_slice()[..particles].fill(1.0);
        self.active = occupied.eq(1.0);
        self.first = first;
        self.search = Search::new(start, departure, body.half_separation);
    }

    /// Finds where the search looks first.
    #[inline(always)]
    fn depart(&mut self, number: usize, sink: &mut impl Sink) {
        let still = self.search.departure.speed.le(0.0);
        if still.any() {
            let rests = still & self.search.rests();
            self.end(rests, number, StopReason::Collapse, sink);
        }
        self.time = self.search.departed();
    }

    /// Searches on until every particle has arrived, which most groups have after the first pass.
    #[inline(always)]
    fn search_on(&mut self, number: usize) -> Result<(), Stuck> {
        let mut passes = 1;
        while (self.active & !self.arrival.done).any() {
            self.search
                .graze(self.time, &self.look, &self.leap, &mut self.arrival);
            let waiting = self.active & !self.arrival.done;
            if passes == MOST_STEPS {
                return Err(self.stuck(waiting, number));
            }
            if waiting.any() {
                self.time = self.search.next(self.time, &self.leap, &self.arrival);
                self.turned = sincos_in_lanes(self.search.angle(self.time));
                self.look = self.search.look(self.time, self.turned);
                self.leap = self.search.leap(&self.look);
                self.residue = self.search.residue(self.time, &self.look, &self.leap);
                self.arrival = self.search.arrival(&self.look, &self.leap, &self.residue);
                passes += 1;
            }
        }
        Ok(())
    }

    /// Has the impact.
    #[inline(always)]
    fn collide(&mut self, body: &Body, law: &impl InPlane) {
        let before =
            self.search
                .start
                .landing(self.arrival.time, self.arrival.attitude, self.look.gap.side);
        let sphere = self.look.gap.one.select(1.0, -1.0_f64);
        let (after, speed) = collide(body, law, &before, sphere);
        self.search.start = before;
        self.glide = after.glide;
        self.climb = after.climb;
        self.spin = after.spin;
        self.search.departure = Departure { sphere, speed };
    }

    /// Tells the sink, and whether that was the end.
    #[inline(always)]
    fn tell(&mut self, body: &Body, limits: Limits, number: usize, sink: &mut impl Sink) {
        let (before, after) = (self.search.start, self.after());
        self.clock = self.clock + self.arrival.time;
        let energy_after = after.kinetic_energy(body.transverse);
        let impact = Impact {
            time: self.clock,
            fall: -before.climb,
            rise: after.climb,
            rotation: before.rotational_energy(body.transverse),
            energy_before: before.kinetic_energy(body.transverse),
            energy_after,
            sine: before.sine,
            cosine: before.cosine,
            sphere: self.search.departure.sphere,
            active: self.active,
        };
        sink.impact(number, self.first, &impact);
        if limits.minimum_speed > 0.0 {
            let slow = (2.0 * energy_after).lt(limits.minimum_speed * limits.minimum_speed);
            self.end(slow, number + 1, StopReason::SpeedBelowThreshold, sink);
        }
        let low = (self.search.bound * (self.arrival.time * self.arrival.time)).lt(UNRESOLVED);
        if low.any() {
            self.unresolved = low.select(self.unresolved + 1.0, 0.0);
            let collapsed = self.unresolved.eq(f64::from(COLLAPSE_RUN));
            self.end(collapsed, number + 1, StopReason::Collapse, sink);
        } else {
            self.unresolved = Pack::splat(self.clock.simd(), 0.0);
        }
    }

    /// Starts the next flight.
    #[inline(always)]
    fn start(&mut self, body: &Body) {
        self.search = Search::new(self.after(), self.search.departure, body.half_separation);
    }

    /// The state after the impact.
    #[inline(always)]
    fn after(&self) -> State<S, 1> {
        State {
            glide: self.glide,
            climb: self.climb,
            spin: self.spin,
            ..self.search.start
        }
    }

    /// Ends the active lanes in `which`. Rare.
    #[inline(always)]
    fn end(&mut self, which: Mask<S, 1>, impacts: usize, reason: StopReason, sink: &mut impl Sink) {
        let ending = which & self.active;
        if ending.any() {
            ending.each(|lane| sink.end(self.first + lane, impacts, reason));
            self.active = self.active & !ending;
        }
    }

    #[cold]
    fn stuck(&self, waiting: Mask<S, 1>, impacts: usize) -> Stuck {
        let mut first = None;
        waiting.each(|lane| {
            first.get_or_insert(self.first + lane);
        });
        Stuck {
            lane: first.unwrap_or(self.first),
            impacts,
        }
    }
}
