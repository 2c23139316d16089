//! Encounters of the same two bodies, one after the other, or in the lanes of vectors where they can be.

use super::encounter::{Chance, End, Following, OnHit};
use super::lanes::{AxialBody, ClumpBody, LanePair};
use super::partner::{Approach, Partner};
use crate::contact::Between;
use crate::law::{Frictionless, Law};
use crate::math::Vectors;
use crate::random::of_impact;
use crate::simd::{Level, Pack};
use pulp::Simd;
use std::iter::Flatten;
use std::slice::Iter;

/// Follows encounters of two bodies.
pub(crate) struct Follower<'a, 'b> {
    bodies: [&'a Partner; 2],
    pub law: &'a Law<'b>,
    pub level: Level,
    axial: Option<LanePair<'a, 'b, AxialBody>>,
    clumps: Option<LanePair<'a, 'b, ClumpBody>>,
    between: Vec<Between>,
    ends: Vec<Option<End>>,
}

impl<'a, 'b> Follower<'a, 'b> {
    pub fn new(bodies: [&'a Partner; 2], law: &'a Law<'b>, level: Level) -> Self {
        let axial = LanePair::new(bodies, law);
        Self {
            bodies,
            law,
            level,
            clumps: match axial {
                Some(_) => None,
                None => LanePair::new(bodies, law),
            },
            axial,
            between: vec![Between::default(); bodies[0].pieces.len() * bodies[1].pieces.len()],
            ends: Vec::new(),
        }
    }

    /// True for two smooth balls, of which rotation means nothing to the other.
    #[inline(always)]
    pub fn smooth_balls(&self) -> bool {
        self.axial.as_ref().is_some_and(LanePair::is_of_spheres)
    }

    /// The velocities of smooth balls after a contact with this normal; the numbers, with a seed, are those of the encounters, where ε_n scatters.
    #[inline(always)]
    pub fn touch<S: Simd>(
        &self,
        [one, two]: [Vectors<S>; 2],
        normal: Vectors<S>,
        (seed, numbers): (u64, &[u64]),
    ) -> [Vectors<S>; 2] {
        let (first, second) = (self.bodies[0].inverse_mass, self.bodies[1].inverse_mass);
        let speed = normal.dot(two - one).max(0.0);
        let mut chances = None;
        if self.law.deviation > 0.0 {
            let chances = chances.insert(0.0 * speed + 0.5);
            for (chance, &number) in chances.as_mut_slice().iter_mut().zip(numbers) {
                *chance = of_impact(seed, number, 0);
            }
        }
        let coefficient = self.law.coefficient(speed, chances);
        let compliance = Pack::splat(speed.simd(), first + second);
        let impulse = normal * Frictionless::impulse(coefficient, speed, compliance);
        [impulse.mul_add(first, one), impulse.mul_add(-second, two)]
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
        let own = hit.as_mut().map(|hit| &mut **hit as _);
        if let Some(pair) = &self.axial {
            pair.follow(self.level, approaches, chance, own, &mut self.ends);
        } else if let Some(pair) = &self.clumps {
            pair.follow(self.level, approaches, chance, own, &mut self.ends);
        }
        for (number, (approach, end)) in approaches.iter().zip(&mut self.ends).enumerate() {
            if end.is_some() {
                continue;
            }
            let Approach { mut states, passed } = *approach;
            for i in 0..2 {
                states[i].turn(self.bodies[i], passed[i]);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Quaternion, Vector};
    use crate::pair::{PairState, encounter};
    use crate::random::of_candidate;
    use crate::{AnyBody, Dumbbell, Material, Scattered};

    /// The velocities that are known at once are those at the end of the encounter, also where the coefficient scatters.
    #[test]
    fn smooth_balls_touch_as_they_do_in_an_encounter() {
        let ball = |radius, density| {
            let ball = Dumbbell::new(radius, 0.0, density).unwrap();
            Partner::new("body", AnyBody::from(ball)).unwrap()
        };
        let bodies = [&ball(1.0, 1.0), &ball(0.5, 3.0)];
        let steady = Material::from(0.7);
        let scattered = Scattered::new(Material::from(0.7), 0.1).unwrap();
        for material in [steady, Material::Scattered(scattered)] {
            let law = Law::of(&material, Frictionless.into());
            let follower = Follower::new(bodies, &law, Level::best());
            assert!(follower.smooth_balls());
            for number in 0..200 {
                let vector = |draw| {
                    let ((x, y), (z, _)) = (
                        of_candidate(7, number, draw),
                        of_candidate(7, number, draw + 1),
                    );
                    Vector::new(x, y, z) - Vector::new(0.5, 0.5, 0.5)
                };
                let (normal, velocities) = (vector(1), [vector(3), vector(5)]);
                let u = velocities[0] - velocities[1];
                let normal = normal * (-normal.dot(u).signum() / normal.norm());
                // A time of 2 before they touch.
                let places = [normal * 1.5 - u * 2.0, Vector::default()];
                let state = |i: usize| PairState {
                    position: places[i],
                    velocity: velocities[i],
                    attitude: Quaternion::IDENTITY,
                    spin: Vector::default(),
                };
                let chance = |contact| of_impact(7, number, contact);
                let states = [state(0), state(1)];
                let end = encounter(bodies, &law, states, chance, |_| ()).unwrap();
                assert_eq!(end.contacts, 1);
                let before = velocities.map(Vector::in_lane);
                let after = follower.touch(before, normal.in_lane(), (7, &[number]));
                // Rounding moves the place where balls that graze touch.
                let grazing = u.norm() / normal.dot(u).abs();
                for (state, velocity) in end.states.iter().zip(after) {
                    assert!((state.velocity - velocity.lane(0)).norm() < 1e-14 * grazing);
                }
            }
        }
    }
}
