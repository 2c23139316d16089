//! Many encounters, on all cores: each depends on the seed and its number alone.

use super::encounter::{Following, FreeBody, Hit, Outcome, PairState, Trouble, narrowest};
use super::{Partner, sample::Encounters};
use crate::Error;
use crate::contact::Between;
use crate::law::Law;
use crate::math::Vector;
use crate::random::of_impact;
use crate::simd::Level;
use crate::simd::elementary::angle;
use crate::threads::{Monitor, Resources};
use pulp::{Simd, WithSimd};
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Encounters that a thread follows before it takes others.
const BLOCK: usize = 256;
/// Bodies that overlap by more than this part of the sum of their reaches are refused.
const OVERLAP: f64 = 1e-9;

/// A recorded variable: its name, its description, its unit, and the number of its components, for each of both bodies or by itself.
pub type PairVariable = (&'static str, &'static str, &'static str, usize, bool);

/// The variables of an encounter, in the order of a row.
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

/// Recorded encounters, row by row, and their contacts one after the other.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PairTable {
    /// Rows of [`ENCOUNTER`].
    pub encounters: Vec<f64>,
    /// Rows of [`HIT`].
    pub hits: Vec<f64>,
}

/// An encounter that was followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encountered {
    /// The bodies before.
    pub before: [PairState; 2],
    /// The end.
    pub outcome: Outcome,
    /// The first contact, if there was one.
    pub first: Option<Hit>,
}

impl Encounters<'_> {
    /// Follows all encounters, drawn or given; with `contacts` each contact is recorded, too.
    ///
    /// # Errors
    /// As [`Encounters::check`], for given bodies that overlap, and if an encounter cannot be followed.
    pub fn record(
        &self,
        law: &Law<'_>,
        given: Option<&[[PairState; 2]]>,
        contacts: bool,
        resources: Resources,
        monitor: &Monitor,
    ) -> Result<PairTable, Error> {
        let tables = self.blocks(
            law,
            given,
            resources,
            monitor,
            |found, hits, table: &mut PairTable| {
                self.write(found, &mut table.encounters);
                if contacts {
                    for hit in hits {
                        let ([n, p, i], [before, after]) = (
                            [hit.normal, hit.point, hit.impulse].map(Vector::parts),
                            hit.speeds,
                        );
                        table.hits.push(hit.time);
                        table
                            .hits
                            .extend(n.into_iter().chain(p).chain(i).chain([before, after]));
                    }
                }
            },
        )?;
        let mut all = PairTable::default();
        all.encounters
            .reserve_exact(tables.iter().map(|table| table.encounters.len()).sum());
        all.hits
            .reserve_exact(tables.iter().map(|table| table.hits.len()).sum());
        for table in tables {
            all.encounters.extend(table.encounters);
            all.hits.extend(table.hits);
        }
        Ok(all)
    }

    /// Follows all encounters in blocks, each of which is summed up by itself, in their order.
    pub(super) fn blocks<T: Default + Send>(
        &self,
        law: &Law<'_>,
        given: Option<&[[PairState; 2]]>,
        resources: Resources,
        monitor: &Monitor,
        add: impl Fn(&Encountered, &[Hit], &mut T) + Sync,
    ) -> Result<Vec<T>, Error> {
        if given.is_none() {
            self.check()?;
        }
        let (count, next) = (self.count.div_ceil(BLOCK), AtomicUsize::new(0));
        let done = Mutex::new(Vec::new());
        let work = |_| {
            let mut between =
                vec![Between::default(); self.bodies[0].pieces.len() * self.bodies[1].pieces.len()];
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= count || monitor.is_cancelled() {
                    return Ok(());
                }
                let rows = number * BLOCK..self.count.min((number + 1) * BLOCK);
                let size = rows.len() as u64;
                let mut sum = T::default();
                let block = EncounterBlock {
                    encounters: self,
                    law,
                    given,
                    rows,
                    between: &mut between,
                    add: &add,
                    sum: &mut sum,
                };
                Level::run_scalar(block)?;
                done.lock()
                    .expect("nobody panics who holds it")
                    .push((number, sum));
                monitor.add_finished(size);
            }
        };
        let ended: Result<Vec<()>, Error> =
            resources.each_thread(count, work)?.into_iter().collect();
        ended?;
        let mut done = done.into_inner().expect("nobody panics who holds it");
        done.sort_by_key(|&(number, _)| number);
        Ok(done.into_iter().map(|(_, sum)| sum).collect())
    }

    /// A row of [`ENCOUNTER`].
    #[inline(always)]
    fn write(&self, found: &Encountered, row: &mut Vec<f64>) {
        let Encountered {
            before,
            outcome,
            first,
        } = found;
        let after = &outcome.states;
        let [one, two] = self.bodies;
        let relative = |states: &[PairState; 2]| states[0].velocity - states[1].velocity;
        let (u, later) = (relative(before), relative(after));
        let sizes = u.norm() * later.norm();
        let (sine, cosine) = (u.cross(later).norm() / sizes, u.dot(later) / sizes);
        let of = |states: &[PairState; 2]| {
            let [first, second] = states;
            let translation = [
                one.translational_energy(first.velocity),
                two.translational_energy(second.velocity),
            ];
            let rotation = [
                one.rotational_energy(first.attitude, first.spin),
                two.rotational_energy(second.attitude, second.spin),
            ];
            [translation, rotation]
        };
        let [translation, rotation] = of(before);
        let [translation_after, rotation_after] = of(after);
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
        row.extend_from_slice(&[
            outcome.contacts as f64,
            f64::from(outcome.ending as u8),
            outcome.time,
            outcome.steps as f64,
            deflection,
            speed,
            centre,
        ]);
        row.extend_from_slice(&coefficients);
        let energies = [translation, translation_after, rotation, rotation_after];
        row.extend_from_slice(energies.as_flattened());
        let [a, b] = before;
        let [c, d] = after;
        let vectors = [
            [a.velocity, b.velocity, c.velocity, d.velocity],
            [a.spin, b.spin, c.spin, d.spin],
            [a.position, b.position, c.position, d.position],
        ];
        for [a, b, c, d] in vectors {
            row.extend_from_slice([a.parts(), b.parts(), c.parts(), d.parts()].as_flattened());
        }
        for state in [a, b, c, d] {
            row.extend_from_slice(&state.attitude.parts());
        }
    }
}

/// Some encounters, each of which adds to a sum; one has no packs.
struct EncounterBlock<'a, 'b, T, F> {
    encounters: &'a Encounters<'a>,
    law: &'a Law<'b>,
    given: Option<&'a [[PairState; 2]]>,
    rows: Range<usize>,
    between: &'a mut [Between],
    add: &'a F,
    sum: &'a mut T,
}

impl<T, F: Fn(&Encountered, &[Hit], &mut T)> WithSimd for EncounterBlock<'_, '_, T, F> {
    type Output = Result<(), Error>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Encounters {
            bodies,
            first,
            seed,
            ..
        } = *self.encounters;
        let mut hits = Vec::new();
        for row in self.rows {
            let number = first + row as u64;
            let before = match self.given {
                Some(given) => given[row],
                None => self.encounters.draw(number),
            };
            if self.given.is_some() {
                check_apart(bodies, &before)?;
            }
            hits.clear();
            self.between.fill(Between::default());
            let outcome = Level::run_scalar(Following {
                bodies,
                law: self.law,
                states: FreeBody::both(bodies, &before),
                chance: &|contact| of_impact(seed, number, contact),
                hit: &mut |hit: &Hit| {
                    hits.truncate(hit.number as usize);
                    hits.push(*hit);
                },
                between: &mut *self.between,
            });
            let outcome =
                outcome.map_err(|trouble| failed(self.law, trouble, (seed, number), hits.len()))?;
            let outcome = outcome.given(bodies);
            hits.truncate(outcome.contacts as usize);
            let found = Encountered {
                before,
                outcome,
                first: hits.first().copied(),
            };
            (self.add)(&found, &hits, self.sum);
        }
        Ok(())
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
