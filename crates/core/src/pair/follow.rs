//! Encounters of the same two bodies, one after the other, or in the lanes of vectors where they can be.

use super::axial::{AxialEncounters, AxialPair};
use super::encounter::{Chance, End, Following, OnHit};
use super::partner::{Approach, Partner};
use crate::contact::Between;
use crate::law::Law;
use crate::simd::Level;
use std::iter::Flatten;
use std::slice::Iter;

/// Follows encounters of two bodies.
pub(crate) struct Follower<'a, 'b> {
    bodies: [&'a Partner; 2],
    law: &'a Law<'b>,
    level: Level,
    axial: Option<AxialPair<'a, 'b>>,
    between: Vec<Between>,
    ends: Vec<Option<End>>,
}

impl<'a, 'b> Follower<'a, 'b> {
    pub fn new(bodies: [&'a Partner; 2], law: &'a Law<'b>, level: Level) -> Self {
        Self {
            bodies,
            law,
            level,
            axial: AxialPair::new(bodies, law),
            between: vec![Between::default(); bodies[0].pieces.len() * bodies[1].pieces.len()],
            ends: Vec::new(),
        }
    }

    /// Follows some of them; `chance` gives a uniform number in (0, 1) for a contact of one of them where ε_n scatters, and `hit` receives their contacts, if
    /// they are asked for: a contact takes the place of others of that encounter from its number on.
    #[inline(always)]
    pub fn follow(
        &mut self,
        approaches: &[Approach],
        chance: Chance<'_>,
        mut hit: Option<OnHit<'_>>,
    ) -> Flatten<Iter<'_, Option<End>>> {
        self.ends.clear();
        self.ends.resize(approaches.len(), None);
        if let Some(pair) = &self.axial {
            self.level.run(AxialEncounters {
                pair,
                approaches,
                chance,
                hit: hit.as_mut().map(|hit| &mut **hit as _),
                ends: &mut self.ends,
            });
        }
        for (number, (approach, end)) in approaches.iter().zip(&mut self.ends).enumerate() {
            if end.is_some() {
                continue;
            }
            let Approach { mut states, passed } = *approach;
            for i in 0..2 {
                if passed[i] > 0.0 {
                    states[i].turn(self.bodies[i], passed[i]);
                }
            }
            self.between.fill(Between::default());
            *end = Some(Level::run_scalar(Following {
                bodies: self.bodies,
                law: self.law,
                states,
                chance: &|contact| chance(number, contact),
                hit: &mut |found| {
                    if let Some(hit) = &mut hit {
                        hit(number, found);
                    }
                },
                between: &mut self.between,
            }));
        }
        self.ends.iter().flatten()
    }
}
