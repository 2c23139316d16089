//! Many encounters, on all cores: each depends on the seed and its number alone.

use super::encounter::{Hit, Outcome, Trouble, narrowest};
use super::follow::Follower;
use super::partner::{Approach, FreeBody, PairState, Partner};
use super::sample::{DrawRows, Encounters};
use crate::law::Law;
use crate::math::Vector;
use crate::random::of_impact;
use crate::simd::Level;
use crate::simd::elementary::angle;
use crate::threads::{Monitor, Resources};
use crate::{Error, memory};
use pulp::{Simd, WithSimd};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Encounters that a thread follows before it takes others.
const BLOCK: usize = 256;
/// Bodies that overlap by more than this part of the sum of their reaches are refused.
const OVERLAP: f64 = 1e-9;

/// A recorded variable: its name, its description, its unit, and the number of its components, for each of both bodies or by itself.
pub type PairVariable = (&'static str, &'static str, &'static str, usize, bool);

/// The variables of an encounter; those of the states are the last.
pub const ENCOUNTER: &[PairVariable] = &[
    ("contacts", "number of contacts", "", 1, false),
    ("ending", "how the encounter ended", "", 1, false),
    (
        "duration",
        "time from the beginning to the end",
        "s",
        1,
        false,
    ),
    (
        "steps",
        "times at which the search looked at the bodies",
        "",
        1,
        false,
    ),
    (
        "deflection",
        "angle between the relative velocities before and after",
        "rad",
        1,
        false,
    ),
    (
        "contact_speed",
        "normal speed of the points of the first contact before it, towards each other",
        "m s-1",
        1,
        false,
    ),
    (
        "centre_speed",
        "speed of the centres of mass along their line before the first contact, towards each other",
        "m s-1",
        1,
        false,
    ),
    (
        "restitution_centres",
        "-(u'.k)/(u.k), u the relative velocity of the centres before the first contact and after the encounter, k their line at the first contact",
        "1",
        1,
        false,
    ),
    (
        "restitution_contact",
        "-(v'.n)/(v.n), v the relative velocity of the points of the first contact before and after it, n its normal",
        "1",
        1,
        false,
    ),
    (
        "restitution_energy",
        "(E'/E)^(1/2), E the kinetic energy before and after, in the frame of the centre of mass",
        "1",
        1,
        false,
    ),
    (
        "translational_energy_before",
        "kinetic energy of the centre of mass of each body before",
        "J",
        1,
        true,
    ),
    (
        "translational_energy_after",
        "kinetic energy of the centre of mass of each body after",
        "J",
        1,
        true,
    ),
    (
        "rotational_energy_before",
        "kinetic energy of the rotation of each body before",
        "J",
        1,
        true,
    ),
    (
        "rotational_energy_after",
        "kinetic energy of the rotation of each body after",
        "J",
        1,
        true,
    ),
    (
        "velocity_before",
        "velocity of the centre of mass of each body before",
        "m s-1",
        3,
        true,
    ),
    (
        "velocity_after",
        "velocity of the centre of mass of each body after",
        "m s-1",
        3,
        true,
    ),
    (
        "angular_velocity_before",
        "angular velocity of each body before",
        "rad s-1",
        3,
        true,
    ),
    (
        "angular_velocity_after",
        "angular velocity of each body after",
        "rad s-1",
        3,
        true,
    ),
    (
        "position_before",
        "centre of mass of each body before",
        "m",
        3,
        true,
    ),
    (
        "position_after",
        "centre of mass of each body after",
        "m",
        3,
        true,
    ),
    (
        "attitude_before",
        "rotation from the axes of each body to those of space before",
        "1",
        4,
        true,
    ),
    (
        "attitude_after",
        "rotation from the axes of each body to those of space after",
        "1",
        4,
        true,
    ),
];

/// The variables of a contact.
pub const HIT: &[PairVariable] = &[
    (
        "time",
        "time since the beginning of the encounter",
        "s",
        1,
        false,
    ),
    (
        "normal",
        "unit vector from the second body to the first",
        "1",
        3,
        false,
    ),
    ("point", "point of contact", "m", 3, false),
    ("impulse", "impulse on the first body", "N s", 3, false),
    (
        "approach_speed",
        "normal speed of the points of contact before, towards each other",
        "m s-1",
        1,
        false,
    ),
    (
        "separation_speed",
        "normal speed of the points of contact after, from each other",
        "m s-1",
        1,
        false,
    ),
];

/// The numbers of all of [`ENCOUNTER`].
const ALL_NUMBERS: usize = {
    let (mut sum, mut i) = (0, 0);
    while i < ENCOUNTER.len() {
        sum += width(&ENCOUNTER[i]);
        i += 1;
    }
    sum
};
/// The variables of [`ENCOUNTER`] that come before those that only states need.
const WITHOUT_STATES: usize = 18;

/// Recorded encounters, variable by variable, and their contacts one after the other.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PairTable {
    /// Each of [`ENCOUNTER`], for all encounters.
    pub encounters: Vec<Vec<f64>>,
    /// Rows of [`HIT`].
    pub hits: Vec<f64>,
}

impl PairTable {
    /// The numbers of a variable of an encounter.
    ///
    /// # Panics
    /// If there is none with this name.
    pub fn of(&self, name: &str, encounter: usize) -> &[f64] {
        let mut variables = self.encounters.iter().zip(ENCOUNTER);
        let (column, variable) = variables
            .find(|(_, variable)| variable.0 == name)
            .expect("a recorded variable");
        let width = width(variable);
        &column[encounter * width..][..width]
    }
}

/// An encounter that was followed.
struct Encountered<'a> {
    /// The bodies before.
    before: &'a [PairState; 2],
    /// Before and after, the energies of translation and of rotation of both.
    energies: [[[f64; 2]; 2]; 2],
    /// The end.
    outcome: Outcome,
    /// The first contact, if there was one.
    first: Option<Hit>,
}

/// The number of components of a variable, of both bodies together.
pub const fn width(&(.., parts, each): &PairVariable) -> usize {
    parts * if each { 2 } else { 1 }
}

impl Encounters<'_> {
    /// Follows all encounters, drawn or given; with `states` the places and attitudes are recorded, and with `contacts` each contact, too.
    ///
    /// # Errors
    /// As [`Encounters::check`], for given bodies that overlap, for more than fits into memory, and if an encounter cannot be followed.
    pub fn record(
        &self,
        law: &Law<'_>,
        given: Option<&[[PairState; 2]]>,
        [states, contacts]: [bool; 2],
        resources: Resources,
        monitor: &Monitor,
    ) -> Result<PairTable, Error> {
        if given.is_none() {
            self.check()?;
        }
        let variables = if states {
            ENCOUNTER
        } else {
            &ENCOUNTER[..WITHOUT_STATES]
        };
        let column = |variable| memory::zeros("encounters", self.count * width(variable));
        let mut encounters: Vec<Vec<f64>> =
            variables.iter().map(column).collect::<Result<_, _>>()?;
        // Each block writes into its own part of each column.
        let count = self.count.div_ceil(BLOCK);
        let mut blocks: Vec<Vec<&mut [f64]>> = Vec::with_capacity(count);
        blocks.resize_with(count, Vec::new);
        for (column, variable) in encounters.iter_mut().zip(variables) {
            for (part, block) in column.chunks_mut(BLOCK * width(variable)).zip(&mut blocks) {
                block.push(part);
            }
        }
        let blocks: Vec<_> = blocks.into_iter().map(Mutex::new).collect();
        let (next, all) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
        let work = |_| {
            let mut follower = Follower::new(self.bodies, law, resources.level);
            let mut room = vec![Vec::new(); BLOCK];
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= count || monitor.is_cancelled() {
                    return Ok(());
                }
                let rows = number * BLOCK..self.count.min((number + 1) * BLOCK);
                let size = rows.len();
                let given = given.map(|given| &given[rows.clone()]);
                let mut columns = blocks[number].lock().expect("nobody panics who holds it");
                let hits = Level::run_scalar(EncounterBlock {
                    encounters: self,
                    follower: &mut follower,
                    law,
                    given,
                    start: rows.start,
                    contacts,
                    hits: &mut room,
                    columns: &mut columns,
                })?;
                all.lock()
                    .expect("nobody panics who holds it")
                    .push((number, hits));
                monitor.add_finished(size as u64);
            }
        };
        let ended: Result<Vec<()>, Error> =
            resources.each_thread(count, work)?.into_iter().collect();
        ended?;
        drop(blocks);
        let mut all = all.into_inner().expect("nobody panics who holds it");
        all.sort_by_key(|&(number, _)| number);
        let hits = all.into_iter().flat_map(|(_, hits)| hits).collect();
        Ok(PairTable { encounters, hits })
    }

    /// A row of [`ENCOUNTER`].
    #[inline(always)]
    fn write(&self, found: &Encountered<'_>, row: &mut [f64; ALL_NUMBERS]) {
        let Encountered {
            before,
            energies: [[translation, rotation], [translation_after, rotation_after]],
            outcome,
            first,
        } = *found;
        let after = &outcome.states;
        let [one, two] = self.bodies;
        let relative = |states: &[PairState; 2]| states[0].velocity - states[1].velocity;
        let (u, later) = (relative(before), relative(after));
        let sizes = u.norm() * later.norm();
        let (sine, cosine) = (u.cross(later).norm() / sizes, u.dot(later) / sizes);
        let reduced = 1.0 / (one.inverse_mass + two.inverse_mass);
        let energy = |u: Vector, [a, b]: [f64; 2]| 0.5 * reduced * u.dot(u) + a + b;
        let (speed, centre, coefficients) = match first {
            None => (f64::NAN, f64::NAN, [f64::NAN; 3]),
            Some(hit) => {
                let along = hit.apart / hit.apart.norm();
                let closing = -hit.velocity.dot(along);
                let centres = if two.is_plane() {
                    -later.z / u.z
                } else {
                    later.dot(along) / closing
                };
                let whole = energy(later, rotation_after) / energy(u, rotation);
                let [towards, apart] = hit.speeds;
                (towards, closing, [centres, apart / towards, whole.sqrt()])
            }
        };
        let deflection = if sizes > 0.0 {
            angle(sine, cosine)
        } else {
            f64::NAN
        };
        row[..7].copy_from_slice(&[
            outcome.contacts as f64,
            f64::from(outcome.ending as u8),
            outcome.time,
            outcome.steps as f64,
            deflection,
            speed,
            centre,
        ]);
        row[7..10].copy_from_slice(&coefficients);
        let energies = [translation, translation_after, rotation, rotation_after];
        row[10..18].copy_from_slice(energies.as_flattened());
        let [a, b] = before;
        let [c, d] = after;
        for (i, state) in [a, b, c, d].into_iter().enumerate() {
            row[18 + 3 * i..][..3].copy_from_slice(&state.velocity.parts());
            row[30 + 3 * i..][..3].copy_from_slice(&state.spin.parts());
            row[42 + 3 * i..][..3].copy_from_slice(&state.position.parts());
            row[54 + 4 * i..][..4].copy_from_slice(&state.attitude.parts());
        }
    }

    /// The energies of translation and of rotation of both bodies.
    #[inline(always)]
    fn energies(&self, [one, two]: &[FreeBody; 2]) -> [[f64; 2]; 2] {
        let [first, second] = self.bodies;
        let translation = [
            first.translational_energy(one.velocity),
            second.translational_energy(two.velocity),
        ];
        let rotation = [one.rotational_energy(first), two.rotational_energy(second)];
        [translation, rotation]
    }
}

/// Some encounters, which are written into their columns; what is done here has no packs. Returns rows of [`HIT`], if they are asked for.
struct EncounterBlock<'a, 'b, 'c, 'd> {
    encounters: &'a Encounters<'a>,
    follower: &'a mut Follower<'c, 'd>,
    law: &'a Law<'d>,
    given: Option<&'a [[PairState; 2]]>,
    start: usize,
    contacts: bool,
    /// Room for the contacts of each.
    hits: &'a mut [Vec<Hit>],
    columns: &'a mut [&'b mut [f64]],
}

impl WithSimd for EncounterBlock<'_, '_, '_, '_> {
    type Output = Result<Vec<f64>, Error>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self {
            encounters,
            follower,
            law,
            given,
            start,
            contacts,
            hits,
            columns,
        } = self;
        let Encounters { bodies, seed, .. } = *encounters;
        let size = given.map_or(columns[0].len(), <[_]>::len);
        let first = encounters.first + start as u64;
        let mut draws = DrawRows::new(seed, first, size);
        // Closures would be functions of their own, which are not compiled for fused multiply-add.
        let mut before = Vec::with_capacity(size);
        for row in 0..size {
            let states = match given {
                Some(given) => given[row],
                None => encounters.draw(draws.row(row)),
            };
            if given.is_some() {
                check_apart(bodies, &states)?;
            }
            before.push(states);
        }
        let mut approaches = Vec::with_capacity(size);
        for states in &before {
            approaches.push(Approach {
                states: FreeBody::both(bodies, states),
                passed: [0.0; 2],
            });
        }
        for hits in hits.iter_mut() {
            hits.clear();
        }
        let mut add = |row: usize, hit: &Hit| {
            hits[row].truncate(hit.number as usize);
            hits[row].push(*hit);
        };
        let chance = |row, contact| of_impact(seed, first + row as u64, contact);
        let ends = follower.follow(&approaches, &chance, Some(&mut add));
        let (mut rows, mut numbers) = (Vec::new(), [0.0; ALL_NUMBERS]);
        for (row, (end, before)) in ends.zip(&before).enumerate() {
            let hits = &mut hits[row];
            let (energies, outcome) = match end {
                Ok(outcome) => {
                    let energies = [
                        encounters.energies(&approaches[row].states),
                        encounters.energies(&outcome.states),
                    ];
                    (energies, outcome.given(bodies))
                }
                Err(trouble) => {
                    let trouble = trouble.clone();
                    return Err(failed(law, trouble, (seed, first + row as u64), hits.len()));
                }
            };
            hits.truncate(outcome.contacts as usize);
            let found = Encountered {
                before,
                energies,
                outcome,
                first: hits.first().copied(),
            };
            encounters.write(&found, &mut numbers);
            let mut rest = &numbers[..];
            for (column, variable) in columns.iter_mut().zip(ENCOUNTER) {
                let width = width(variable);
                // A copy of a number of bytes that is not known is a call.
                match width {
                    1 => column[row] = rest[0],
                    2 => column[2 * row..][..2].copy_from_slice(&rest[..2]),
                    6 => column[6 * row..][..6].copy_from_slice(&rest[..6]),
                    _ => column[width * row..][..width].copy_from_slice(&rest[..width]),
                }
                rest = &rest[width..];
            }
            for hit in hits.iter().filter(|_| contacts) {
                let ([n, p, i], [before, after]) = (
                    [hit.normal, hit.point, hit.impulse].map(Vector::parts),
                    hit.speeds,
                );
                rows.push(hit.time);
                rows.extend(n.into_iter().chain(p).chain(i).chain([before, after]));
            }
        }
        Ok(rows)
    }
}

fn check_apart(bodies: [&Partner; 2], states: &[PairState; 2]) -> Result<(), Error> {
    let width = narrowest(bodies, states);
    let apart = width >= -OVERLAP * (bodies[0].reach + bodies[1].reach);
    Error::unless(
        apart,
        "states.position",
        width,
        "such that no bodies overlap; this is the narrowest gap (m)",
    )
}

/// The error of an encounter that cannot be followed.
pub(crate) fn failed(
    law: &Law<'_>,
    trouble: Trouble,
    (seed, number): (u64, u64),
    contacts: usize,
) -> Error {
    match trouble {
        Trouble::Unconverged => Error::Numerical {
            particle: number,
            seed,
            flight: contacts as u64,
        },
        Trouble::Fault(fault) => Error::Law {
            law: law
                .custom
                .map_or_else(String::new, |law| law.name().to_owned()),
            particle: number,
            seed,
            impact: contacts as u64,
            fault,
        },
    }
}
