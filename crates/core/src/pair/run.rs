//! Many encounters, on all cores: each depends on the seed and its number alone.

use super::encounter::{Hit, Trouble, narrowest};
use super::follow::Follower;
use super::partner::{Approach, FreeBody, PairState, Partner};
use super::recorded::{Encountered, PER_ENCOUNTER, PairTable};
use super::sample::{DrawRows, Encounters};
use crate::Error;
use crate::law::Law;
use crate::random::of_impact;
use crate::record::{Columns, TableColumns, TableRows, When};
use crate::simd::Level;
use crate::threads::{Monitor, Resources};
use pulp::{Simd, WithSimd};
use std::ops::Range;
use std::sync::Mutex;

/// Encounters that a thread follows before it takes others.
const BLOCK: usize = 256;
/// Bodies that overlap by more than this part of the sum of their reaches are refused.
const OVERLAP: f64 = 1e-9;

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
        let chosen = Columns::chosen(PER_ENCOUNTER, |about| states || about.when == When::Always);
        let mut encounters =
            TableColumns::new("encounters", PER_ENCOUNTER, &chosen, self.count, 1)?;
        // Each block writes into its own part of each column.
        let mut rest = encounters.rows();
        let blocks = (0..self.count).step_by(BLOCK).map(|first| {
            let rows = first..self.count.min(first + BLOCK);
            (rest.split(rows.len()), rows)
        });
        let (queue, all) = (Mutex::new(blocks), Mutex::new(Vec::new()));
        let work = |_| {
            let mut follower = Follower::new(self.bodies, law, resources.level);
            let mut room = vec![Vec::new(); BLOCK];
            while !monitor.is_cancelled() {
                let next = queue.lock().expect("nobody panics who holds it").next();
                let Some((mut table, rows)) = next else { break };
                let hits = Level::run_scalar(EncounterBlock {
                    encounters: self,
                    follower: &mut follower,
                    given: given.map(|given| &given[rows.clone()]),
                    rows: rows.clone(),
                    contacts,
                    hits: &mut room,
                    table: &mut table,
                })?;
                let mut all = all.lock().expect("nobody panics who holds it");
                all.push((rows.start, hits));
                monitor.add_finished(rows.len() as u64);
            }
            Ok(())
        };
        let ended = resources.each_thread(self.count.div_ceil(BLOCK), work)?;
        ended.into_iter().collect::<Result<(), Error>>()?;
        let mut all = all.into_inner().expect("nobody panics who holds it");
        all.sort_by_key(|&(first, _)| first);
        let hits = all.into_iter().flat_map(|(_, hits)| hits).collect();
        Ok(PairTable { encounters, hits })
    }
}

/// Some encounters, which are written into their part of the table; what is done here has no packs. Returns their contacts, if they are asked for.
struct EncounterBlock<'a, 'b, 'c, 'd> {
    encounters: &'a Encounters<'a>,
    follower: &'a mut Follower<'c, 'd>,
    given: Option<&'a [[PairState; 2]]>,
    rows: Range<usize>,
    contacts: bool,
    /// Room for the contacts of each.
    hits: &'a mut [Vec<Hit>],
    table: &'a mut TableRows<'b>,
}

impl WithSimd for EncounterBlock<'_, '_, '_, '_> {
    type Output = Result<Vec<Hit>, Error>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self {
            encounters,
            follower,
            given,
            rows,
            contacts,
            hits,
            table,
        } = self;
        let Encounters { bodies, seed, .. } = *encounters;
        let size = rows.len();
        let first = encounters.first + rows.start as u64;
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
        let law = follower.law;
        let chance = |row, contact| of_impact(seed, first + row as u64, contact);
        let ends = follower.follow(&approaches, &chance, Some(&mut add));
        let mut found = Vec::new();
        for (row, end) in ends.enumerate() {
            let hits = &mut hits[row];
            let end = match end {
                Ok(end) => end,
                Err(trouble) => {
                    let trouble = trouble.clone();
                    return Err(failed(law, trouble, (seed, first + row as u64), hits.len()));
                }
            };
            hits.truncate(end.contacts as usize);
            let (before, approach) = (&before[row], &approaches[row]);
            let encountered = Encountered::new(bodies, before, approach, end, hits.first());
            encountered.write(&(), &mut table.columns, &[(0, row)]);
            if contacts {
                found.extend_from_slice(hits);
            }
        }
        Ok(found)
    }
}

fn check_apart(bodies: [&Partner; 2], states: &[PairState; 2]) -> Result<(), Error> {
    let width = narrowest(bodies, states);
    let apart = width >= -OVERLAP * (bodies[0].reach + bodies[1].reach);
    let allowed = "such that no bodies overlap; this is the narrowest gap (m)";
    Error::unless(apart, "states.position", width, allowed)
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
