//! One encounter: the approach, contacts until the bodies part, and the way out.
//!
//! An encounter begins where it is given, and ends where the centres are farther apart than the bodies reach and move away from each other. Contacts that
//! accumulate, or one that is not left, are a lasting contact: without friction it is followed ([`Lasting`]), else it ends the encounter as a collapse.

use super::lasting::Lasting;
use super::partner::{FreeBody, PairState, Partner, flight};
use crate::contact::{Between, PairDeparture, PairSearch, PairTouch};
use crate::law::{Law, Rule};
use crate::math::{Quaternion, Vector, Vectors};
use crate::simd::{Level, Pack};
use crate::{COLLAPSE_RUN, Fault};
use pulp::{Simd, WithSimd};

/// M T² over the sum of the reaches below which a flight of duration T counts as unresolved.
pub(super) const UNRESOLVED: f64 = 8.0 / 8_796_093_022_208.0;

/// Lasting contacts of an encounter after which it is given up.
const MOST_LASTING: u64 = 8;

/// The end of an encounter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// Without a contact.
    Missed,
    /// The bodies have parted.
    Parted,
    /// Contacts accumulate, or last.
    Collapse,
    /// The bodies have parted after at least one lasting contact.
    Lasted,
}

impl Ending {
    /// The names, in the order of the numbers.
    pub const NAMES: [&'static str; 4] = ["missed", "parted", "collapse", "lasted"];
}

/// A contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Its number; one that is found later takes the place of another with the same, which was one of those that accumulated to a lasting contact.
    pub number: u64,
    /// The time since the beginning.
    pub time: f64,
    /// The unit vector from the second body to the first.
    pub normal: Vector,
    /// Where it is.
    pub point: Vector,
    /// The impulse on the first body.
    pub impulse: Vector,
    /// The centre of the first body from that of the second.
    pub apart: Vector,
    /// Its velocity relative to that, before.
    pub velocity: Vector,
    /// The normal speeds of the points of contact, towards each other before, and from each other after.
    pub speeds: [f64; 2],
}

/// The end of an encounter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome<T = PairState> {
    /// The bodies then.
    pub states: [T; 2],
    /// The time since the beginning.
    pub time: f64,
    /// Number of contacts, without those that accumulated to a lasting one.
    pub contacts: u64,
    /// The reason.
    pub ending: Ending,
    /// Number of times at which the bodies were looked at.
    pub steps: u64,
}

/// Why an encounter cannot be followed.
#[derive(Debug, Clone, PartialEq)]
pub enum Trouble {
    /// The search, or the friction of an impact, does not converge.
    Unconverged,
    /// A law of one's own failed.
    Fault(Fault),
}

/// The encounter of two bodies, of which the second may be a plane; `chance` gives a uniform number in (0, 1) for a contact where ε_n scatters, and
/// `hit` receives each contact. In coherent units, those of the law.
///
/// # Errors
/// [`Trouble`].
pub fn encounter(
    bodies: [&Partner; 2],
    law: &Law<'_>,
    states: [PairState; 2],
    chance: impl Fn(u64) -> f64,
    mut hit: impl FnMut(&Hit),
) -> Result<Outcome, Trouble> {
    let mut between = vec![Between::default(); bodies[0].pieces.len() * bodies[1].pieces.len()];
    let outcome = Level::run_scalar(Following {
        bodies,
        law,
        states: FreeBody::both(bodies, &states),
        chance: &chance,
        hit: &mut hit,
        between: &mut between,
    });
    Ok(outcome?.given(bodies))
}

/// The width of the narrowest gap between two bodies, negative if they overlap.
pub fn narrowest(bodies: [&Partner; 2], states: &[PairState; 2]) -> f64 {
    let search = PairSearch {
        pieces: bodies.map(|body| &body.pieces[..]),
        size: bodies[0].reach + bodies[1].reach,
    };
    let mut states = FreeBody::both(bodies, states);
    for state in &mut states {
        state.velocity = Vector::default();
    }
    search.narrowest(&mut flight(bodies, &states))
}

/// The end of an encounter, or why it cannot be followed.
pub(crate) type End = Result<Outcome<FreeBody>, Trouble>;

/// Gives a uniform number in (0, 1) for a contact of one of some encounters.
pub(super) type Chance<'a> = &'a dyn Fn(usize, u64) -> f64;
/// Receives a contact of one of them.
pub(super) type OnHit<'a> = &'a mut dyn FnMut(usize, &Hit);

/// An encounter; it has no packs. It is one function for all who follow encounters: inlined, it would be compiled for each of them.
pub(crate) struct Following<'a, 'b> {
    pub bodies: [&'a Partner; 2],
    pub law: &'a Law<'b>,
    pub states: [FreeBody; 2],
    pub chance: &'a dyn Fn(u64) -> f64,
    pub hit: &'a mut dyn FnMut(&Hit),
    /// Room for what is known of each two parts.
    pub between: &'a mut [Between],
}

impl WithSimd for Following<'_, '_> {
    type Output = End;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> End {
        let bodies = self.bodies;
        let reach = bodies[0].reach + bodies[1].reach;
        let search = PairSearch {
            pieces: [&bodies[0].pieces, &bodies[1].pieces],
            size: reach,
        };
        let balls = bodies[0].is_ball() && (bodies[1].is_ball() || bodies[1].is_plane());
        let mut departure: Option<PairDeparture> = None;
        let (mut unresolved, mut clock, mut contacts, mut steps) = (0, 0.0, 0, 0);
        let (mut drawn, mut lasted, mut pressed) = (0, 0, None);
        let ending = loop {
            if let Some(parts) = std::mem::take(&mut pressed) {
                let Some((time, speed)) =
                    self.lasts(&search, parts).filter(|_| lasted < MOST_LASTING)
                else {
                    break Ending::Collapse;
                };
                contacts -= unresolved;
                (clock, unresolved, lasted) = (clock + time, 0, lasted + 1);
                departure = Some(PairDeparture { parts, speed });
            }
            let (enters, leaves) = self.within(reach);
            if contacts == 0 && leaves <= 0.0 {
                break Ending::Missed;
            }
            let after = |found: &Option<PairTouch>| match found {
                Some(touch) => touch.time,
                None if leaves < f64::INFINITY => leaves,
                None => 0.0,
            };
            let (found, time);
            if balls && departure.is_none_or(|left| left.speed > 0.0) {
                // Balls touch where they come into reach of each other, and that once.
                steps += 1;
                found = (contacts == 0 && self.approach()).then_some(PairTouch {
                    time: enters,
                    parts: [0, 0],
                    size: f64::INFINITY,
                });
                time = after(&found);
                self.turn(0, time, None);
                self.turn(1, time, None);
            } else {
                let mut flight = flight(bodies, &self.states);
                let tops = [&bodies[0].top, &bodies[1].top];
                if let Some(left) = departure
                    && search.rests(tops, &mut flight, &left)
                {
                    pressed = Some(left.parts);
                    continue;
                }
                let times = [enters, leaves];
                found = search
                    .first(&mut flight, departure, times, self.between, &mut steps)
                    .map_err(|()| Trouble::Unconverged)?;
                time = after(&found);
                let [one, two] = &mut flight.turns;
                self.turn(0, time, one.rotated(time));
                self.turn(1, time, two.rotated(time));
            }
            clock += time;
            let Some(touch) = found else {
                break match (contacts, lasted) {
                    (0, _) => Ending::Missed,
                    (_, 0) => Ending::Parted,
                    _ => Ending::Lasted,
                };
            };
            let speed = self.collide(&search, clock, [contacts, drawn], &touch)?;
            drawn += 1;
            let parts = touch.parts;
            departure = Some(PairDeparture { parts, speed });
            contacts += 1;
            unresolved = if touch.size < UNRESOLVED * reach && contacts > 1 {
                unresolved + 1
            } else {
                0
            };
            if unresolved == u64::from(COLLAPSE_RUN) {
                pressed = Some(parts);
            }
        };
        Ok(Outcome {
            states: self.states,
            time: clock,
            contacts,
            ending,
            steps,
        })
    }
}

impl Outcome<FreeBody> {
    /// With the attitudes of the axes that the bodies were given in.
    #[inline(always)]
    pub fn given(self, bodies: [&Partner; 2]) -> Outcome {
        let [one, two] = &self.states;
        Outcome {
            states: [one.state(bodies[0]), two.state(bodies[1])],
            time: self.time,
            contacts: self.contacts,
            ending: self.ending,
            steps: self.steps,
        }
    }
}

impl Following<'_, '_> {
    /// A body after a time in which it turns as is known, or is found here.
    #[inline(always)]
    fn turn(&mut self, i: usize, time: f64, known: Option<(Quaternion, Vector)>) {
        let (state, body) = (&mut self.states[i], self.bodies[i]);
        state.position = state.velocity.mul_add(time, state.position);
        match known {
            _ if body.is_plane() => {}
            Some(later) => (state.attitude, state.spin) = later,
            None => state.turn(body, time),
        }
    }

    /// The place and the velocity of the first body from the second.
    #[inline(always)]
    fn relative(&self) -> (Vector, Vector) {
        let [one, two] = &self.states;
        (one.position - two.position, one.velocity - two.velocity)
    }

    /// True if the centres approach each other, or the centre the plane.
    #[inline(always)]
    fn approach(&self) -> bool {
        let (apart, velocity) = self.relative();
        if self.bodies[1].is_plane() {
            velocity.z < 0.0
        } else {
            apart.dot(velocity) < 0.0
        }
    }

    /// The times between which the bodies can touch.
    #[inline(always)]
    fn within(&self, reach: f64) -> (f64, f64) {
        let (apart, velocity) = self.relative();
        if self.bodies[1].is_plane() {
            let time = (reach - apart.z) / velocity.z;
            return if velocity.z > 0.0 {
                (0.0, time)
            } else if velocity.z < 0.0 {
                (time.max(0.0), f64::INFINITY)
            } else if apart.z > reach {
                (0.0, 0.0)
            } else {
                (0.0, f64::INFINITY)
            };
        }
        let (enters, leaves) = within(apart.in_lane(), velocity.in_lane(), reach);
        (enters.as_slice()[0], leaves.as_slice()[0])
    }

    /// Moves the bodies as long as they are pressed together, if there is no friction; returns the time and the speed at which they part.
    #[cold]
    #[inline(never)]
    fn lasts(&mut self, search: &PairSearch<'_>, parts: [usize; 2]) -> Option<(f64, f64)> {
        if self.law.custom.is_some() || !matches!(self.law.rule, Rule::Frictionless(_)) {
            return None;
        }
        let [row, column] = parts;
        let lasting = Lasting {
            bodies: self.bodies,
            search,
            parts,
            between: &self.between[row * self.bodies[1].pieces.len() + column],
        };
        lasting.follow(&mut self.states)
    }

    /// The impact of a contact, of this number, with the random numbers of that one; returns the speed at which its points leave each other.
    #[inline(always)]
    fn collide(
        &mut self,
        search: &PairSearch<'_>,
        time: f64,
        [number, drawn]: [u64; 2],
        touch: &PairTouch,
    ) -> Result<f64, Trouble> {
        let bodies = self.bodies;
        let (apart, velocity) = self.relative();
        let [one, two] = &self.states;
        let [row, column] = touch.parts;
        let between = &self.between[row * bodies[1].pieces.len() + column];
        // One point for both, so that the angular momentum stays what it is.
        let poses = [one.pose(), two.pose()];
        let (normal, first) = search.meeting(apart, touch.parts, &poses, between);
        let arms = [first, first + apart];
        let frame = Quaternion::from_z(normal);
        let back = frame.inverse();
        let compliance =
            one.compliance(bodies[0], back, arms[0]) + two.compliance(bodies[1], back, arms[1]);
        let met = back.rotate(velocity + one.moves(arms[0]) - two.moves(arms[1])); // (7)
        let chance = (self.law.deviation > 0.0).then(|| (self.chance)(drawn));
        let answer = self.law.answer_drawn(&compliance, met, chance);
        let answer = answer.map_err(Trouble::Fault)?;
        if answer.impulse.z.is_nan() {
            return Err(Trouble::Unconverged);
        }
        let impulse = frame.rotate(answer.impulse);
        (self.hit)(&Hit {
            number,
            time,
            normal,
            point: one.position + first,
            impulse,
            apart,
            velocity,
            speeds: [-met.z, answer.separation_speed],
        });
        let [one, two] = &mut self.states;
        one.push(bodies[0], arms[0], impulse, 1.0);
        two.push(bodies[1], arms[1], impulse, -1.0);
        Ok(answer.separation_speed)
    }
}

/// The times between which a point at **y** with the velocity **u** is within reach of the origin; both are 0 where it never is from now on.
#[inline(always)]
pub(super) fn within<S: Simd>(y: Vectors<S>, u: Vectors<S>, reach: f64) -> (Pack<S>, Pack<S>) {
    let (square, along) = (u.dot(u), y.dot(u));
    let zero = Pack::splat(square.simd(), 0.0);
    let beyond = y.dot(y) - reach * reach;
    let across = y.cross(u);
    let chord = square * (reach * reach) - across.dot(across);
    let root = chord.max(0.0).sqrt();
    let (parts, comes) = (zero.lt(along), along.lt(0.0));
    let leaves = parts.select(-beyond, root - along) / parts.select(along + root, square);
    let enters = comes.select(beyond / comes.select(root - along, 1.0), 0.0);
    let meets = zero.lt(chord) & zero.lt(leaves);
    let stays = square.eq(0.0) & beyond.le(0.0);
    let leaves = stays.select(f64::INFINITY, meets.select(leaves, 0.0));
    (meets.select(enters.max(0.0), 0.0), leaves)
}
