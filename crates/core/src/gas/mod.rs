//! A dilute gas that cools: direct simulation Monte Carlo, in which every encounter is followed exactly.
//!
//! N particles fill a volume V = N/n without order: places are not kept, and any two of them may meet. Two with the relative velocity **u** come
//! through the sphere of radius S, the sum of their reaches, at the rate πS²u/V. So candidates are drawn, each two particles alike, at the rate of the
//! largest S and of a majorant c of u, and one is followed as an encounter with the probability S²u over that of the majorant, on a line that is
//! uniform on the disc. This is M. Kac's process, without a step of time (G. A. Bird, *Molecular Gas Dynamics* (1994), Sec. 11.1, without cells). Between
//! encounters a body turns freely for the time that has passed, or for one so long that its phase is uniform, as in the limit n → 0.
//!
//! A gas may be heated by a white noise of forces: in a time t a component of the velocity of a particle gains a normal number of variance 2Pt/3m, with P
//! the power that each particle receives (D. R. M. Williams and F. C. MacKintosh, Phys. Rev. E 54, R9 (1996)). Between encounters nothing else
//! happens to a velocity, so that this is exact if it is drawn, for the time that has passed, whenever the velocity is asked for.

mod meeting;
mod moments;
mod row;

pub use moments::{BIN, BINS, GAS_KIND, GAS_WHOLE};

use crate::law::Law;
use crate::math::{Quaternion, Vector, add_to};
use crate::pair::{
    Approach, DrawRows, Ending, Follower, FreeBody, Outcome, PairState, Partner, Trouble, failed,
    normals,
};
use crate::random::{of_candidate, of_impact};
use crate::simd::{LANES, Level};
use crate::threads::{Monitor, Resources};
use crate::{Error, memory};
use meeting::{Candidate, Candidates, MeetingLine};
use moments::{Whole, distributions, moments};
use pulp::{Simd, WithSimd};
use row::{CandidateRow, ROW, WAITS, bound};
use std::f64::consts::{PI, TAU};
use std::ops::RangeInclusive;
use std::sync::Mutex;

/// The majorant of u over twice the largest speed at the last look at all of them.
const ROOM: f64 = 1.02;
/// Its increase for velocities that noise changes until the next look: seven standard deviations of it.
const NOISE: f64 = 0.1;
const DEVIATIONS: f64 = 7.0;
/// Turns, on average, after which a phase counts as uniform.
const TURNS: f64 = 1e4;
/// The angle that is left out where a body turns by more.
const LOST: f64 = 1e9;
/// Temperatures over masses, and rates of collisions, that are followed.
const MODERATE: RangeInclusive<f64> = 1e-75..=1e75;
/// The largest T_rot/T_tr.
const FASTEST: f64 = 1e6;
/// Spins over velocities, in units of the reach, from which the search for contacts may need too many turns, from which it does, and from which those
/// of balls, which need no search, are lost in rounding.
const FAST_SPIN: f64 = 1e3;
const FASTEST_SPIN: f64 = 1e6;
const LOST_SPIN: f64 = 1e12;
/// The largest velocity, in m/s, below which all are multiplied by 2 to the power [`LIFT`], so that fourth powers remain normal numbers. Hard contacts
/// have no scale of time: nothing else changes.
const FAINT: f64 = 6.3e-61;
const LIFT: i32 = 200;
/// The part of the largest speed down to which the rounding of momenta is left alone.
const FAR: f64 = 1e-6;
/// The energy of an encounter, relative to that before, above which it is created and not rounding.
const CREATED: f64 = 1e-12;

/// The numbers of the state of a particle: velocity, ω and attitude (w, x, y, z), in the axes of space.
pub const STATE: usize = 10;

/// Bodies of one kind. SI units, or any coherent ones.
#[derive(Debug, Clone)]
pub struct Species<'a> {
    /// The body.
    pub body: &'a Partner,
    /// Their number, over all batches.
    pub particles: usize,
    /// Their first temperature of translation, in units of energy.
    pub translational: f64,
    /// Those of rotation about the principal axes.
    pub rotational: [f64; 3],
    /// For each of them, true if contacts turn it about that axis; the energy of rotation is that about these.
    pub turned: [bool; 3],
}

/// The rotation between two encounters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// As far as it does in the time between them.
    Time,
    /// So far that its phase is uniform.
    Uniform,
}

/// A gas, and how long it is followed.
#[derive(Debug, Clone)]
pub struct Gas<'a> {
    /// The kinds of bodies.
    pub kinds: Vec<Species<'a>>,
    /// Particles per volume.
    pub density: f64,
    /// The rotation between encounters.
    pub phase: Phase,
    /// Gases that do not know of each other, over which the particles are spread.
    pub batches: usize,
    /// Encounters with contact, of a particle, after which it ends.
    pub collisions: f64,
    /// The mean power that a particle receives from a noise of forces.
    pub heating: f64,
    /// The state of every particle at the beginning, instead of Maxwellians: of batch after batch, and in each of kind after kind.
    pub given: Option<&'a [[f64; STATE]]>,
    /// True if the states at the end are kept.
    pub keep: bool,
    /// True if distributions are counted at each look.
    pub distributions: bool,
    /// Looks at the gas after the first.
    pub samples: usize,
    /// The seed.
    pub seed: u64,
}

/// The rotation of a particle: attitude of the principal axes and ω in them, and the time up to which it has turned. It is one line of the caches.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct ParticleRotation {
    attitude: Quaternion,
    spin: Vector,
    time: f64,
}

impl Gas<'_> {
    /// Numbers of a look: [`GAS_WHOLE`], and of each kind [`GAS_KIND`] and, if they are asked for, the counts of v and of the rotation in [`BINS`] bins.
    pub fn width(&self) -> usize {
        let counted = if self.distributions { 2 * BINS } else { 0 };
        GAS_WHOLE.len() + self.kinds.len() * (GAS_KIND.len() + counted)
    }

    /// Numbers of `store` in [`Self::cool`], of each batch.
    pub fn stored(&self) -> usize {
        let heated = if self.heating > 0.0 { 1 } else { 0 };
        NUMBERS + (self.samples + 1) * self.width() + self.each() * (ROTATION + 3 + heated)
    }

    /// Follows all batches. Returns [`Self::width`] numbers of every look at each batch, and if they are kept
    /// the states of all particles at the end, in the order of `given`; without meaning after a run that was cancelled. Where there is a `store`, of
    /// [`Self::stored`] numbers for each batch, all zero at first, a batch goes on from what it left there when it was cancelled, to the same bits.
    ///
    /// # Errors
    /// [`Error::Parameter`], and if an encounter cannot be followed.
    pub fn cool(
        &self,
        law: &Law<'_>,
        resources: Resources,
        monitor: &Monitor,
        store: Option<&mut [f64]>,
    ) -> Result<(Vec<f64>, Vec<[f64; STATE]>), Error> {
        self.check()?;
        let size = (self.samples + 1) * self.width();
        let each = self.each();
        let kept = if self.keep { each * self.batches } else { 0 };
        let mut rows = memory::zeros("looks at a gas", size * self.batches)?;
        let mut states = memory::filled("states of a gas", [0.0; STATE], kept)?;
        // Each batch writes into its own part of each.
        let mut stores = store.map(|all| all.chunks_mut(self.stored()));
        let mut kept = states.chunks_mut(each);
        let batches = rows.chunks_mut(size).map(|rows| {
            let store = stores.as_mut().and_then(Iterator::next);
            (rows, store, kept.next().unwrap_or_default())
        });
        let queue = Mutex::new(batches.enumerate());
        let work = |_| {
            while !monitor.is_cancelled() {
                let next = queue.lock().expect("nobody panics who holds it").next();
                let Some((number, (rows, store, kept))) = next else {
                    break;
                };
                let gas = Level::run_scalar(FollowedGas {
                    gas: self,
                    number,
                    store,
                    law,
                    level: resources.level,
                    monitor,
                })?;
                rows[..gas.rows.len()].copy_from_slice(&gas.rows);
                for (i, state) in kept.iter_mut().enumerate() {
                    *state = joined(gas.free(i, Vector::default()).state(gas.kind(i).body));
                }
            }
            Ok(())
        };
        let ended = resources.each_thread(self.batches, work)?;
        ended.into_iter().collect::<Result<(), Error>>()?;
        Ok((rows, states))
    }

    /// Particles of a batch.
    fn each(&self) -> usize {
        let each = |kind: &Species<'_>| kind.particles / self.batches;
        self.kinds.iter().map(each).sum()
    }

    /// The largest reach.
    fn reach(&self) -> f64 {
        let all = self.kinds.iter().map(|kind| kind.body.reach);
        all.fold(0.0, f64::max)
    }

    /// The variance that a component of the velocity gains in a time, over the time.
    fn noise(&self, inverse_mass: f64) -> f64 {
        2.0 / 3.0 * self.heating * inverse_mass
    }

    fn check(&self) -> Result<(), Error> {
        let holds = self.collisions.is_finite() && self.collisions > 0.0;
        Error::unless(holds, "collisions", self.collisions, "finite and > 0")?;
        let each = self.each() as f64;
        let holds = each <= f64::from(u32::MAX);
        let allowed = "less than 2³² for each of the batches";
        Error::unless(holds, "particles", each, allowed)?;
        for kind in &self.kinds {
            let power = self.heating * kind.body.inverse_mass;
            let some = "0, or such that velocities neither overflow nor underflow (W)";
            let holds = power == 0.0 || MODERATE.contains(&power);
            Error::unless(holds, "heating", self.heating, some)?;
            let each = kind.particles / self.batches;
            let least = "at least 2 for each of the batches";
            Error::unless(each >= 2, "particles", kind.particles as f64, least)?;
            let (t, inverse) = (kind.translational, kind.body.inverse_mass);
            let warm = "> 0, and such that (T/m)² neither overflows nor underflows (J)";
            let holds = MODERATE.contains(&(t * inverse));
            Error::unless(holds, "translational_temperature", t, warm)?;
            for turning in kind.rotational {
                let warm = "in [0, 10⁶ T_tr], beyond which an encounter takes too many turns (J)";
                let holds = (0.0..=FASTEST * t).contains(&turning);
                Error::unless(holds, "rotational_temperature", turning, warm)?;
            }
            let across = kind.body.reach * kind.body.reach;
            let rate = self.density * across * (t * inverse).sqrt();
            let some =
                "such that the times between collisions neither overflow nor underflow (1/m³)";
            let holds = MODERATE.contains(&rate);
            Error::unless(holds, "number_density", self.density, some)?;
        }
        Ok(())
    }
}

/// One of the gases.
struct Batch<'a> {
    gas: &'a Gas<'a>,
    number: usize,
    /// By themselves: many candidates are refused for which nothing else is asked.
    velocities: Vec<Vector>,
    /// The [`bound`] of the speed of each, or [`WAITS`]. They stay in the caches, and most candidates are refused by them alone.
    bounds: Vec<u16>,
    rotations: Vec<ParticleRotation>,
    /// The time up to which each has been heated, if they are.
    heated: Vec<f64>,
    /// The number behind the last particle of each kind.
    ends: Vec<usize>,
    clock: f64,
    /// The time at which the clock was 0, and the power of two by which velocities were multiplied until then.
    past: f64,
    exponent: i32,
    whole: Whole,
    /// Candidates so far, and a row of which the next is one.
    candidates: u64,
    ahead: CandidateRow,
    /// The places in it of those that may meet, and the time at each.
    sieved: [(usize, f64); ROW],
    /// The majorant of u, and the time and the candidate until which it holds.
    fastest: f64,
    until: f64,
    upto: u64,
    /// The largest speed at which the velocity of the centre of mass is taken off again.
    slowest: f64,
    /// Looks so far.
    rows: Vec<f64>,
    /// Candidates that are not decided yet, for each two kinds, and their number.
    waiting: Vec<Waiting>,
    waits: usize,
}

/// Candidates of two kinds that are decided and followed together, those of them that meet, and from where.
#[derive(Default)]
struct Waiting {
    candidates: Vec<Candidate>,
    meetings: Vec<MeetingLine>,
    approaches: Vec<Approach>,
}

/// Most candidates that wait.
const TOGETHER: usize = 128;
/// The first draws for the line of an encounter, and then for phases; for the noise on each of its bodies; and on all particles after it.
const LINE: u32 = 1;
const HEATED: [u32; 2] = [4, 6];
const ALL_HEATED: u32 = 8;

/// Particles whose random numbers are drawn at once at the beginning.
const DRAWN: usize = 256;

/// Numbers of a batch in a store beside its looks and its particles, and of the rotation of a particle.
const NUMBERS: usize = 9 + GAS_WHOLE.len() - 2;
const ROTATION: usize = 8;

impl<'a> Batch<'a> {
    /// Attitudes uniform on SO(3), velocities and ω of Maxwellians, of which the mean is taken off and whose energies are those of the temperatures.
    #[inline(always)]
    fn new(gas: &'a Gas<'a>, number: usize) -> Result<Self, Error> {
        let count = gas.each();
        let mut velocities = memory::empty("velocities of a gas", count)?;
        let mut rotations = memory::empty("rotations of a gas", count)?;
        let heated = if gas.heating > 0.0 { count } else { 0 };
        let (mut ends, mut rows) = (Vec::new(), DrawRows::new(0, 0, 0));
        for (order, kind) in gas.kinds.iter().enumerate() {
            let body = kind.body;
            let start = velocities.len();
            let each = kind.particles / gas.batches;
            ends.push(start + each);
            if let Some(given) = gas.given {
                let own = &given[number * count + start..][..each];
                for state in own {
                    let free = FreeBody::new(body, &parted(state));
                    velocities.push(free.velocity);
                    rotations.push(ParticleRotation::new(&free, 0.0));
                }
                continue;
            }
            let index = ((number * gas.kinds.len() + order) as u64) << 40;
            for i in 0..each {
                if i % DRAWN == 0 {
                    rows = DrawRows::new(gas.seed, index | i as u64, DRAWN.min(each - i));
                }
                let mut draws = rows.row(i % DRAWN);
                let attitude = draws.attitude();
                let normals = Vector::from(draws.normals());
                let thermal = (kind.translational * body.inverse_mass).sqrt();
                velocities.push(normals * thermal);
                rotations.push(ParticleRotation {
                    attitude: attitude * body.axes,
                    spin: draws.spin(body, kind.rotational),
                    time: 0.0,
                });
            }
            settle(&mut velocities[start..], &mut rotations[start..], kind);
        }
        let mut waiting = Vec::new();
        waiting.resize_with(gas.kinds.len() * gas.kinds.len(), Waiting::default);
        Ok(Self {
            gas,
            number,
            velocities,
            rotations,
            bounds: memory::zeros("speeds of a gas", count)?,
            heated: memory::zeros("times of heating", heated)?,
            ends,
            clock: 0.0,
            past: 0.0,
            exponent: 0,
            whole: Whole::default(),
            candidates: 0,
            ahead: CandidateRow::NONE,
            sieved: [(0, 0.0); ROW],
            fastest: 0.0,
            until: 0.0,
            upto: 0,
            slowest: 0.0,
            rows: memory::empty("looks at a gas", (gas.samples + 1) * gas.width())?,
            waiting,
            waits: 0,
        })
    }

    /// The number of the kind of a particle.
    #[inline(always)]
    fn order(&self, particle: usize) -> usize {
        if self.ends.len() == 1 {
            return 0;
        }
        self.ends.partition_point(|&end| end <= particle)
    }

    #[inline(always)]
    fn kind(&self, particle: usize) -> &'a Species<'a> {
        &self.gas.kinds[self.order(particle)]
    }

    /// The number of a candidate among those of all batches.
    #[inline(always)]
    fn number(&self, candidate: u64) -> u64 {
        (self.number as u64) << 48 | candidate
    }

    /// Finds those that may meet of the next candidates: up to the end of a row or of the majorant of u, until there are so many, or until a particle has
    /// met another one before. Returns the place in the row behind the last one, the time then, and their number.
    #[inline(always)]
    fn sieve(&mut self, between: f64, most: usize) -> (usize, f64, usize) {
        let start = self.candidates as usize % ROW;
        let row = self.number(self.candidates - start as u64);
        self.ahead.draw(self.gas.seed, row, self.velocities.len());
        let end = (start as u64 + self.upto - self.candidates).min(ROW as u64) as usize;
        let always = self.gas.heating > 0.0;
        let (mut clock, mut count) = (self.clock, 0);
        for place in start..end {
            let ([i, j], _, part) = self.ahead.get(place);
            let (one, two) = (self.bounds[i], self.bounds[j]);
            if one == WAITS || two == WAITS || count == most || clock > self.until {
                return (place, clock, count);
            }
            clock += between;
            // If not, u is certainly less than this part of its majorant. Nobody could foresee which way a branch would go: with one, a collision of
            // spheres takes a tenth longer.
            let may = u32::from(one) + u32::from(two) > part || always;
            self.bounds[i] = if may { WAITS } else { one };
            self.bounds[j] = if may { WAITS } else { two };
            self.sieved[count] = (place, clock);
            count += usize::from(may);
        }
        (end, clock, count)
    }

    /// Finds the bounds of all particles.
    #[inline(always)]
    fn bound_all(&mut self) {
        let fastest = self.fastest;
        for (own, v) in self.bounds.iter_mut().zip(&self.velocities) {
            *own = bound(v.dot(*v), fastest);
        }
    }

    #[inline(always)]
    fn run(&mut self, law: &Law<'_>, level: Level, monitor: &Monitor) -> Result<(), Error> {
        let gas = self.gas;
        let mut followers = Vec::new();
        for one in &gas.kinds {
            followers.extend(
                gas.kinds
                    .iter()
                    .map(|two| Follower::new([one.body, two.body], law, level)),
            );
        }
        let count = self.velocities.len();
        let each = 0.5 * count as f64 * gas.collisions / gas.samples as f64;
        let reach = gas.reach();
        let area = PI * (2.0 * reach) * (2.0 * reach);
        let pairs = count as f64 * (count - 1) as f64;
        // n/N is 1/V, and half of the ordered pairs are the pairs.
        let between = 2.0 / (gas.density / count as f64 * pairs * area);
        let turns = gas.kinds.iter().any(|kind| kind.turned != [false; 3]);
        let lightest = gas.kinds.iter().map(|kind| kind.body.inverse_mass);
        let noise = gas.noise(lightest.fold(0.0, f64::max));
        if self.rows.is_empty() {
            self.look();
        }
        let mut finished = self.whole.collisions as u64;
        monitor.add_finished(finished);
        let mut looks = self.rows.len() / gas.width();
        while looks <= gas.samples {
            if self.candidates == self.upto || self.clock > self.until {
                self.follow(&mut followers)?;
                if monitor.is_cancelled() {
                    return Ok(());
                }
                self.heat_all();
                let most = self.lift();
                (self.fastest, self.until) = (2.0 * ROOM * most, f64::INFINITY);
                if gas.heating > 0.0 {
                    self.fastest += 2.0 * NOISE * most;
                    let deviation = NOISE * most / DEVIATIONS;
                    self.until = self.clock + deviation * deviation / noise;
                }
                self.upto = self.candidates + count as u64;
                self.bound_all();
            }
            // Not more than may be followed before the next look.
            let left = (each * looks as f64 - self.whole.collisions).ceil() as usize;
            let most = TOGETHER.min(left) - self.waits;
            let row = self.candidates - self.candidates % ROW as u64;
            let (end, clock, count) = self.sieve(between / self.fastest, most);
            let mut sum = 0.0;
            for (place, time) in self.sieved.into_iter().take(count) {
                (self.candidates, self.clock) = (row + place as u64 + 1, time);
                let (pair, chance, _) = self.ahead.get(place);
                if gas.heating > 0.0 {
                    self.heat(pair[0], HEATED[0]);
                    self.heat(pair[1], HEATED[1]);
                }
                for i in pair {
                    sum += self.velocities[i].x + self.velocities[i].z; // fetches what will be asked for
                    if turns {
                        sum += self.rotations[i].time;
                    }
                }
                let kinds = self.order(pair[0]) * gas.kinds.len() + self.order(pair[1]);
                let candidate = Candidate {
                    pair,
                    chance,
                    number: self.number(self.candidates - 1),
                    time,
                };
                self.waiting[kinds].candidates.push(candidate);
            }
            std::hint::black_box(sum);
            self.waits += count;
            (self.candidates, self.clock) = (row + end as u64, clock);
            if count == most || end < ROW {
                self.follow(&mut followers)?;
            }
            while looks <= gas.samples && self.whole.collisions >= each * looks as f64 {
                self.look();
                looks += 1;
                let done = self.whole.collisions as u64;
                monitor.add_finished(done - finished);
                finished = done;
            }
        }
        Ok(())
    }

    /// Finds the largest speed. Where it has fallen far, takes off what rounding has given to the centre of mass; where it is faint, multiplies velocities, but for the spins of balls that contacts do not turn, and turns back the clock.
    #[inline(always)]
    fn lift(&mut self) -> f64 {
        let mut most = [0.0; LANES];
        for some in self.velocities.chunks(LANES) {
            for (most, v) in most.iter_mut().zip(some) {
                let square = v.dot(*v);
                *most = if square > *most { square } else { *most };
            }
        }
        let most = most.into_iter().fold(0.0, f64::max).sqrt();
        if self.slowest == 0.0 {
            self.slowest = FAR * most;
        }
        if most >= self.slowest || self.gas.heating > 0.0 {
            return most;
        }
        self.rest();
        self.slowest = FAR * most;
        if most >= FAINT {
            return most;
        }
        self.slowest *= 2f64.powi(LIFT);
        self.past = self.time();
        self.exponent += LIFT;
        let factor = 2f64.powi(LIFT);
        let mut start = 0;
        for (kind, &end) in self.gas.kinds.iter().zip(&self.ends) {
            let turns = kind.turned != [false; 3];
            let all = self.velocities[start..end].iter_mut();
            for (v, rotation) in all.zip(&mut self.rotations[start..end]) {
                *v = *v * factor;
                rotation.time = (rotation.time - self.clock) / factor;
                if turns {
                    rotation.spin = rotation.spin * factor;
                }
            }
            start = end;
        }
        self.clock = 0.0;
        most * factor
    }

    /// The time since the beginning.
    fn time(&self) -> f64 {
        self.past + self.clock * 2f64.powi(self.exponent)
    }

    /// Writes all that it goes on from.
    fn save(&mut self, store: &mut [f64]) {
        let numbers = [
            self.clock,
            self.past,
            f64::from(self.exponent),
            self.candidates as f64,
            self.fastest,
            self.until,
            self.upto as f64,
            self.slowest,
            self.rows.len() as f64,
        ];
        let particles = self.velocities.iter().zip(&self.rotations);
        let particles = particles.flat_map(|(velocity, rotation)| {
            let ([x, y, z], [a, b, c]) = (velocity.parts(), rotation.spin.parts());
            let [q, r, s, t] = rotation.attitude.parts();
            [x, y, z, a, b, c, q, r, s, t, rotation.time]
        });
        let counts = self.whole.counts().map(|count| *count);
        let all = numbers.into_iter().chain(counts);
        let rows = (self.gas.samples + 1) * self.gas.width();
        let padding = std::iter::repeat_n(0.0, rows - self.rows.len());
        let rows = self.rows.iter().copied().chain(padding);
        let all = all
            .chain(rows)
            .chain(particles)
            .chain(self.heated.iter().copied());
        for (place, number) in store.iter_mut().zip(all) {
            *place = number;
        }
    }

    /// Goes on from what was written, if anything was.
    fn restore(&mut self, store: &[f64]) {
        let (numbers, rest) = store.split_at(NUMBERS);
        let &[
            clock,
            past,
            exponent,
            candidates,
            fastest,
            until,
            upto,
            slowest,
            looks,
        ] = numbers.first_chunk().expect("they are more");
        if looks == 0.0 {
            return;
        }
        (self.clock, self.past, self.exponent) = (clock, past, exponent as i32);
        self.candidates = candidates as u64;
        (self.fastest, self.until, self.upto) = (fastest, until, upto as u64);
        self.slowest = slowest;
        for (count, number) in self.whole.counts().into_iter().zip(&numbers[9..]) {
            *count = *number;
        }
        let (rows, rest) = rest.split_at((self.gas.samples + 1) * self.gas.width());
        self.rows.extend(&rows[..looks as usize]);
        let (particles, heated) = rest.split_at(self.velocities.len() * (3 + ROTATION));
        for (i, &[x, y, z, a, b, c, q, r, s, t, time]) in particles.as_chunks().0.iter().enumerate()
        {
            self.velocities[i] = Vector::new(x, y, z);
            self.rotations[i] = ParticleRotation {
                attitude: Quaternion::new(q, r, s, t),
                spin: Vector::new(a, b, c),
                time,
            };
        }
        self.heated.copy_from_slice(heated);
        self.bound_all();
    }

    /// The states of two particles that meet, and how long each has turned freely.
    #[inline(always)]
    fn approach(&self, meeting: &MeetingLine) -> Result<Approach, Error> {
        let Candidate { pair, time, .. } = meeting.candidate;
        let bodies = pair.map(|i| self.kind(i).body);
        let reach = bodies[0].reach + bodies[1].reach;
        let mut states = [
            self.free(pair[0], meeting.apart * reach),
            self.free(pair[1], Vector::default()),
        ];
        let (mut spins, mut passed, mut draw): (f64, _, _) = (0.0, [0.0; 2], LINE);
        for (i, particle) in pair.into_iter().enumerate() {
            if self.kind(particle).turned == [false; 3] {
                states[i].spin = Vector::default(); // that of a smooth ball, which nothing depends on
                continue;
            }
            let spin = states[i].spin.norm();
            spins = spins.max(spin * reach);
            passed[i] = match self.gas.phase {
                _ if spin == 0.0 => 0.0,
                Phase::Time => within(time - self.rotations[particle].time, spin),
                Phase::Uniform => {
                    draw += 1;
                    of_candidate(self.gas.seed, meeting.candidate.draws(), draw).0 * TURNS * TAU
                        / spin
                }
            };
        }
        let balls = bodies[0].is_ball() && bodies[1].is_ball();
        if spins > if balls { LOST_SPIN } else { FASTEST_SPIN } * meeting.speed {
            return Err(self.too_hot());
        }
        Ok(Approach { states, passed })
    }

    /// Decides the candidates that wait, and follows the encounters of those that meet.
    #[inline(always)]
    fn follow(&mut self, followers: &mut [Follower<'_, '_>]) -> Result<(), Error> {
        if self.waits == 0 {
            return Ok(());
        }
        let Gas { seed, kinds, .. } = self.gas;
        let (seed, reach) = (*seed, self.gas.reach());
        for (i, follower) in followers.iter_mut().enumerate() {
            let [one, two] = [i / kinds.len(), i % kinds.len()].map(|kind| kinds[kind].body.reach);
            let both = one + two;
            let mut waiting = std::mem::take(&mut self.waiting[i]);
            let Waiting {
                candidates,
                meetings,
                approaches,
            } = &mut waiting;
            let law = follower.law;
            let decided = follower.level.run(Candidates {
                candidates,
                velocities: &mut self.velocities,
                bounds: &mut self.bounds,
                fastest: self.fastest,
                section: both * both / (4.0 * reach * reach),
                seed,
                follower,
                meetings,
            });
            self.whole.beyond += decided.beyond as f64;
            // Smooth balls never create energy, and are looked at where they touch, and where they part.
            let touched = decided.touched as f64;
            self.whole.attempts += touched;
            self.whole.contacts += touched;
            self.whole.collisions += touched;
            self.whole.steps += 2.0 * touched;
            for meeting in meetings.iter() {
                approaches.push(self.approach(meeting)?);
            }
            let chance = |k: usize, contact| of_impact(seed, meetings[k].candidate.number, contact);
            let ends = follower.follow(approaches, &chance, None);
            for ((meeting, approach), end) in meetings.iter().zip(&*approaches).zip(ends) {
                let candidate = &meeting.candidate;
                match end {
                    Ok(outcome) => self.met(candidate, approach, outcome),
                    Err(trouble) => {
                        return Err(self.lost(trouble.clone(), approach, law, candidate.number));
                    }
                }
            }
            if !follower.smooth_balls() {
                for i in candidates.iter().flat_map(|candidate| candidate.pair) {
                    let v = self.velocities[i];
                    self.bounds[i] = bound(v.dot(v), self.fastest);
                }
            }
            candidates.clear();
            meetings.clear();
            approaches.clear();
            self.waiting[i] = waiting;
        }
        self.waits = 0;
        Ok(())
    }

    /// Applies an encounter at a time to two particles.
    #[inline(always)]
    fn met(&mut self, candidate: &Candidate, approach: &Approach, outcome: &Outcome<FreeBody>) {
        let Candidate { pair, time, .. } = *candidate;
        self.whole.attempts += 1.0;
        self.whole.steps += outcome.steps as f64;
        if outcome.contacts == 0 {
            return;
        }
        self.whole.contacts += outcome.contacts as f64;
        if outcome.ending == Ending::Collapse {
            self.whole.collapses += 1.0;
        }
        let bodies = pair.map(|i| self.kind(i).body);
        let energy = |states: &[FreeBody; 2]| {
            let [one, two] = states;
            one.energy(bodies[0]) + two.energy(bodies[1])
        };
        self.whole.collisions += 1.0;
        let (before, after) = (energy(&approach.states), energy(&outcome.states));
        if after > before * (1.0 + CREATED) {
            self.whole.creating += 1.0;
            self.whole.created += (after - before) * 2f64.powi(-2 * self.exponent);
        }
        for (i, (state, before)) in pair
            .into_iter()
            .zip(outcome.states.iter().zip(&approach.states))
        {
            self.velocities[i] = state.velocity;
            let turned = self.kind(i).turned;
            if turned != [false; 3] {
                // Rounding would turn a body about the others, too, and that would outlast all else.
                let (own, before) = (state.spin.parts(), before.spin.parts());
                let parts = std::array::from_fn(|k| if turned[k] { own[k] } else { before[k] });
                let spin = Vector::from(parts);
                self.rotations[i] = ParticleRotation::new(&FreeBody { spin, ..*state }, time);
            }
        }
    }

    /// The error of an encounter that cannot be followed.
    #[cold]
    fn lost(&self, trouble: Trouble, from: &Approach, law: &Law<'_>, number: u64) -> Error {
        let [one, two] = &from.states;
        let speed = (one.velocity - two.velocity).norm();
        let spin = one.spin.norm().max(two.spin.norm());
        match trouble {
            Trouble::Unconverged if spin * one.position.norm() > FAST_SPIN * speed => {
                self.too_hot()
            }
            trouble => failed(law, trouble, (self.gas.seed, number), 0),
        }
    }

    /// The error where rotation outruns translation.
    #[cold]
    fn too_hot(&self) -> Error {
        Error::Magnitude {
            name: "collisions",
            value: self.gas.collisions.into(),
            allowed: "so few that rotation does not become so much hotter than translation that encounters take too many turns; smooth bodies of \
                      revolution keep the spin about their axis, so that their spin_temperature is better 0",
        }
    }

    #[inline(always)]
    fn free(&self, particle: usize, position: Vector) -> FreeBody {
        let ParticleRotation { attitude, spin, .. } = self.rotations[particle];
        FreeBody {
            position,
            velocity: self.velocities[particle],
            attitude,
            spin,
        }
    }

    /// Adds what the noise has given to the velocity of a particle since it was last asked for, with two draws from this one on.
    #[inline(always)]
    fn heat(&mut self, particle: usize, draw: u32) {
        let number = self.number(self.candidates);
        let drawn = [draw, draw + 1].map(|draw| of_candidate(self.gas.seed, number, draw));
        let normals = Vector::from(normals(drawn));
        let noise = self.gas.noise(self.kind(particle).body.inverse_mass);
        let (v, heated) = (&mut self.velocities[particle], &mut self.heated[particle]);
        let deviation = (noise * (self.clock - *heated)).sqrt();
        *v = *v + normals * deviation;
        *heated = self.clock;
    }

    /// Heats all particles up to now, and takes off the velocity that this gave to their centre of mass.
    #[inline(always)]
    fn heat_all(&mut self) {
        if self.gas.heating > 0.0 {
            for i in 0..self.velocities.len() {
                self.heat(i, ALL_HEATED + 2 * i as u32);
            }
            self.rest();
        }
    }

    /// Takes off the velocity of the centre of mass.
    #[inline(always)]
    fn rest(&mut self) {
        let (mut momentum, mut mass) = (Vector::default(), 0.0);
        for i in 0..self.velocities.len() {
            let own = self.kind(i).body.mass();
            momentum = momentum + self.velocities[i] * own;
            mass += own;
        }
        let mean = momentum / mass;
        for v in &mut self.velocities {
            *v = *v - mean;
        }
    }

    /// Adds a row: what has happened, and the moments of each kind now.
    #[inline(always)]
    fn look(&mut self) {
        self.heat_all();
        let mut rows = std::mem::take(&mut self.rows);
        rows.push(self.time());
        rows.extend(self.whole.counts().map(|count| *count));
        rows.push(f64::from(self.exponent));
        let mut start = 0;
        for (kind, &end) in self.gas.kinds.iter().zip(&self.ends) {
            let mut sums = [0.0; GAS_KIND.len()];
            for i in start..end {
                let mut state = self.free(i, Vector::default());
                let passed = self.clock - self.rotations[i].time;
                state.turn(kind.body, within(passed, state.spin.norm()));
                self.rotations[i] = ParticleRotation::new(&state, self.clock);
                add_to(&mut sums, moments(kind, &state));
            }
            let count = end - start;
            rows.extend(sums.map(|sum| sum / count as f64));
            if self.gas.distributions {
                let own = |i: usize| self.free(start + i, Vector::default());
                rows.extend(distributions(kind, count, own).as_flattened());
            }
            start = end;
        }
        self.rows = rows;
    }
}

impl ParticleRotation {
    #[inline(always)]
    fn new(state: &FreeBody, time: f64) -> Self {
        Self {
            attitude: state.attitude,
            spin: state.spin,
            time,
        }
    }
}

/// A time, without whole turns beyond all that a time can say.
#[inline(always)]
fn within(time: f64, spin: f64) -> f64 {
    if spin * time > LOST {
        time % (LOST / spin)
    } else {
        time
    }
}

/// The state of a particle from its numbers.
fn parted(&[vx, vy, vz, a, b, c, w, x, y, z]: &[f64; STATE]) -> PairState {
    PairState {
        position: Vector::default(),
        velocity: Vector::new(vx, vy, vz),
        attitude: Quaternion::new(w, x, y, z),
        spin: Vector::new(a, b, c),
    }
}

/// The numbers of the state of a particle.
fn joined(state: PairState) -> [f64; STATE] {
    let ([vx, vy, vz], [a, b, c]) = (state.velocity.parts(), state.spin.parts());
    let [w, x, y, z] = state.attitude.parts();
    [vx, vy, vz, a, b, c, w, x, y, z]
}

/// One of the gases, which is followed from the beginning or from what is in the store, and put there; what is done here has no packs.
struct FollowedGas<'a, 'b, 'c> {
    gas: &'a Gas<'a>,
    number: usize,
    store: Option<&'b mut [f64]>,
    law: &'b Law<'c>,
    level: Level,
    monitor: &'b Monitor,
}

impl<'a> WithSimd for FollowedGas<'a, '_, '_> {
    type Output = Result<Batch<'a>, Error>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let mut batch = Batch::new(self.gas, self.number)?;
        if let Some(store) = &self.store {
            batch.restore(store);
        }
        batch.run(self.law, self.level, self.monitor)?;
        if let Some(store) = self.store {
            batch.save(store);
        }
        Ok(batch)
    }
}

/// Takes the mean velocity off, and scales velocities and the parts of ω to the energies of the temperatures.
#[inline(always)]
fn settle(velocities: &mut [Vector], rotations: &mut [ParticleRotation], kind: &Species<'_>) {
    let count = velocities.len() as f64;
    let body = kind.body;
    let mut sum = Vector::default();
    for &v in velocities.iter() {
        sum = sum + v;
    }
    let mean = sum / count;
    let mut square = 0.0;
    for v in velocities.iter_mut() {
        *v = *v - mean;
        square += v.dot(*v);
    }
    let mut turning = [0.0; 3];
    for p in rotations.iter() {
        add_to(&mut turning, p.spin.parts().map(|part| part * part));
    }
    let wanted = 3.0 * count * kind.translational * body.inverse_mass;
    let scale = (wanted / square).sqrt();
    let scales: [f64; 3] = std::array::from_fn(|i| {
        let wanted = count * kind.rotational[i] * body.inverse_moments[i];
        if turning[i] > 0.0 {
            (wanted / turning[i]).sqrt()
        } else {
            0.0
        }
    });
    for v in velocities {
        *v = *v * scale;
    }
    for p in rotations {
        let [x, y, z] = p.spin.parts();
        p.spin = Vector::new(x * scales[0], y * scales[1], z * scales[2]);
    }
}
