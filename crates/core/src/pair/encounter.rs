//! One encounter: the approach, contacts until the bodies part, and the way out.
//!
//! An encounter begins where it is given, and ends where the centres are farther apart than the bodies reach and move away from each other. A contact
//! that is not left, or contacts that accumulate, end it as a collapse.

use super::Partner;
use crate::contact::{Between, PairDeparture, PairFlight, PairSearch, PairTouch};
use crate::law::{Compliance, Law};
use crate::math::{Quaternion, Symmetric, Vector};
use crate::motion::{BodyPose, Rotation, Turn};
use crate::simd::Level;
use crate::{COLLAPSE_RUN, Fault};
use pulp::{Simd, WithSimd};

/// M T² over the sum of the reaches below which a flight of duration T counts as unresolved.
const UNRESOLVED: f64 = 8.0 / 8_796_093_022_208.0;

/// Position and motion of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairState {
    /// The centre of mass.
    pub position: Vector,
    /// Its velocity.
    pub velocity: Vector,
    /// The rotation from the axes that the body was given in to those of space.
    pub attitude: Quaternion,
    /// ω in the axes of space.
    pub spin: Vector,
}

/// The end of an encounter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// Without a contact.
    Missed,
    /// The bodies have parted.
    Parted,
    /// Contacts accumulate, or last.
    Collapse,
}

impl Ending {
    /// The names, in the order of the numbers.
    pub const NAMES: [&'static str; 3] = ["missed", "parted", "collapse"];
}

/// A contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
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
pub struct Outcome {
    /// The bodies then.
    pub states: [PairState; 2],
    /// The time since the beginning.
    pub time: f64,
    /// Number of contacts.
    pub contacts: u64,
    /// The reason.
    pub ending: Ending,
    /// Number of times at which the bodies were looked at.
    pub steps: u64,
}

/// Why an encounter cannot be followed.
#[derive(Debug, Clone, PartialEq)]
pub enum Trouble {
    /// The search does not converge.
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
    Level::run_scalar(Following {
        bodies,
        law,
        states,
        chance: &chance,
        hit: &mut hit,
        between: &mut between,
    })
}

/// The width of the narrowest gap between two bodies, negative if they overlap.
pub fn narrowest(bodies: [&Partner; 2], states: &[PairState; 2]) -> f64 {
    let search = PairSearch {
        pieces: bodies.map(|body| &body.pieces[..]),
        size: bodies[0].reach + bodies[1].reach,
    };
    let turning = std::array::from_fn(|i| FreeBody::new(bodies[i], &states[i]));
    let apart = states[0].position - states[1].position;
    search.narrowest(&mut flight(bodies, apart, Vector::default(), &turning))
}

/// An encounter; it has no packs.
pub(crate) struct Following<'a, 'b> {
    pub bodies: [&'a Partner; 2],
    pub law: &'a Law<'b>,
    pub states: [PairState; 2],
    pub chance: &'a dyn Fn(u64) -> f64,
    pub hit: &'a mut dyn FnMut(&Hit),
    /// Room for what is known of each two parts.
    pub between: &'a mut [Between],
}

impl WithSimd for Following<'_, '_> {
    type Output = Result<Outcome, Trouble>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        self.follow()
    }
}

/// A body in flight: attitude of the principal axes, and ω in them.
#[derive(Clone, Copy)]
struct FreeBody {
    attitude: Quaternion,
    spin: Vector,
}

impl FreeBody {
    #[inline(always)]
    fn new(body: &Partner, state: &PairState) -> Self {
        let attitude = state.attitude * body.axes;
        let spin = attitude.inverse().rotate(state.spin);
        Self { attitude, spin }
    }

    #[inline(always)]
    fn state(&self, body: &Partner, position: Vector, velocity: Vector) -> PairState {
        PairState {
            position,
            velocity,
            attitude: self.attitude * body.axes.inverse(),
            spin: self.attitude.rotate(self.spin),
        }
    }

    #[inline(always)]
    fn pose(&self) -> BodyPose {
        BodyPose::Any(self.attitude, self.spin)
    }

    /// The velocity of a point relative to the centre of mass.
    #[inline(always)]
    fn moves(&self, arm: Vector) -> Vector {
        self.attitude.rotate(self.spin).cross(arm)
    }

    /// K of the body at a point, in axes to which `back` turns those of space.
    #[inline(always)]
    fn compliance(&self, body: &Partner, back: Quaternion, arm: Vector) -> Compliance {
        let inverse = Symmetric::turned(body.inverse_moments, back * self.attitude);
        Compliance::of_body(1.0 / body.inverse_mass, &inverse, back.rotate(arm))
    }

    #[inline(always)]
    fn turn(&self, body: &Partner) -> (Turn, [f64; 2]) {
        Turn::new(&body.top, body.axis, self.attitude, self.spin)
    }
}

impl Following<'_, '_> {
    #[inline(always)]
    fn follow(mut self) -> Result<Outcome, Trouble> {
        let bodies = self.bodies;
        let reach = bodies[0].reach + bodies[1].reach;
        let search = PairSearch {
            pieces: bodies.map(|body| &body.pieces[..]),
            size: reach,
        };
        let [one, two] = &self.states;
        let mut turning = [FreeBody::new(bodies[0], one), FreeBody::new(bodies[1], two)];
        let mut velocities = [one.velocity, two.velocity];
        let mut places = [one.position, two.position];
        let (mut departure, mut unresolved) = (None, 0);
        let (mut clock, mut contacts, mut steps) = (0.0, 0, 0);
        let ending = loop {
            let (apart, velocity) = (places[0] - places[1], velocities[0] - velocities[1]);
            let (enters, leaves) = self.within(apart, velocity, reach);
            let mut flight = flight(bodies, apart, velocity, &turning);
            if contacts == 0 && leaves <= 0.0 {
                break Ending::Missed;
            }
            let tops = [&bodies[0].top, &bodies[1].top];
            if departure.is_some_and(|left| search.rests(tops, &mut flight, &left)) {
                break Ending::Collapse;
            }
            let found = search.first(
                &mut flight,
                departure,
                [enters, leaves],
                self.between,
                &mut steps,
            );
            let found = found.map_err(|()| Trouble::Unconverged)?;
            let time = found.map_or(if leaves < f64::INFINITY { leaves } else { 0.0 }, |touch| {
                touch.time
            });
            clock += time;
            for i in 0..2 {
                places[i] = velocities[i].mul_add(time, places[i]);
                let FreeBody { attitude, spin } = turning[i];
                if !bodies[i].is_plane() {
                    let (attitude, spin) = Rotation::new(bodies[i].top, attitude, spin).at(time);
                    turning[i] = FreeBody { attitude, spin };
                }
            }
            let Some(touch) = found else {
                break if contacts == 0 {
                    Ending::Missed
                } else {
                    Ending::Parted
                };
            };
            let speed = self.collide(
                &search,
                clock,
                contacts,
                &touch,
                &places,
                &mut velocities,
                &mut turning,
            )?;
            let parts = touch.parts;
            departure = Some(PairDeparture { parts, speed });
            contacts += 1;
            unresolved = if touch.size < UNRESOLVED * reach && contacts > 1 {
                unresolved + 1
            } else {
                0
            };
            if unresolved == COLLAPSE_RUN {
                break Ending::Collapse;
            }
        };
        let [one, two] = turning;
        Ok(Outcome {
            states: [
                one.state(bodies[0], places[0], velocities[0]),
                two.state(bodies[1], places[1], velocities[1]),
            ],
            time: clock,
            contacts,
            ending,
            steps,
        })
    }

    /// The times between which the bodies can touch.
    #[inline(always)]
    fn within(&self, apart: Vector, velocity: Vector, reach: f64) -> (f64, f64) {
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
        let (square, along) = (velocity.dot(velocity), apart.dot(velocity));
        let beyond = apart.dot(apart) - reach * reach;
        let across = apart.cross(velocity);
        let chord = square * (reach * reach) - across.dot(across);
        if square == 0.0 {
            let leaves = if beyond > 0.0 { 0.0 } else { f64::INFINITY };
            return (0.0, leaves);
        }
        if chord <= 0.0 {
            return (0.0, 0.0);
        }
        let root = chord.sqrt();
        let leaves = if along > 0.0 {
            -beyond / (along + root)
        } else {
            (root - along) / square
        };
        let enters = if along < 0.0 {
            beyond / (root - along)
        } else {
            0.0
        };
        (enters.max(0.0), leaves.max(0.0))
    }

    /// The impact of a contact; returns the speed at which its points leave each other.
    #[inline(always)]
    #[expect(
        clippy::too_many_arguments,
        reason = "the state of an encounter, part by part"
    )]
    fn collide(
        &mut self,
        search: &PairSearch<'_>,
        time: f64,
        number: u64,
        touch: &PairTouch,
        places: &[Vector; 2],
        velocities: &mut [Vector; 2],
        turning: &mut [FreeBody; 2],
    ) -> Result<f64, Trouble> {
        let bodies = self.bodies;
        let apart = places[0] - places[1];
        let velocity = velocities[0] - velocities[1];
        let poses = [turning[0].pose(), turning[1].pose()];
        let [row, column] = touch.parts;
        let between = &self.between[row * bodies[1].pieces.len() + column];
        // One point for both, so that the angular momentum stays what it is.
        let (normal, first) = search.meeting(apart, touch.parts, &poses, between);
        let arms = [first, first + apart];
        let frame = frame(normal);
        let back = frame.inverse();
        let [one, two] = &*turning;
        let compliance =
            one.compliance(bodies[0], back, arms[0]) + two.compliance(bodies[1], back, arms[1]);
        let met = back.rotate(velocity + one.moves(arms[0]) - two.moves(arms[1])); // (7)
        let answer = if self.law.deviation > 0.0 {
            self.law
                .answer_drawn(&compliance, met, (self.chance)(number))
        } else {
            self.law.answer(&compliance, met)
        };
        let answer = answer.map_err(Trouble::Fault)?;
        let impulse = frame.rotate(answer.impulse);
        (self.hit)(&Hit {
            time,
            normal,
            point: places[0] + first,
            impulse,
            apart,
            velocity,
            speeds: [-met.z, answer.separation_speed],
        });
        for (i, sign) in [(0, 1.0), (1, -1.0)] {
            velocities[i] = impulse.mul_add(sign * bodies[i].inverse_mass, velocities[i]);
            let torque = turning[i].attitude.inverse().rotate(arms[i].cross(impulse));
            let [x, y, z] = bodies[i].inverse_moments;
            let change = Vector::new(x * torque.x, y * torque.y, z * torque.z); // (11)
            turning[i].spin = change.mul_add(sign, turning[i].spin);
        }
        Ok(answer.separation_speed)
    }
}

#[inline(always)]
fn flight(
    bodies: [&Partner; 2],
    apart: Vector,
    velocity: Vector,
    turning: &[FreeBody; 2],
) -> PairFlight {
    let (one, first) = turning[0].turn(bodies[0]);
    let (two, second) = turning[1].turn(bodies[1]);
    PairFlight {
        apart,
        velocity,
        turns: [one, two],
        bounds: [first, second],
    }
}

/// A rotation that takes the z axis to a unit vector.
#[inline(always)]
fn frame(normal: Vector) -> Quaternion {
    let Vector { x, y, z } = normal;
    if z < -0.5 {
        // Half a turn about the x axis first.
        return Quaternion::new(1.0 - z, y, -x, 0.0).normalized()
            * Quaternion::new(0.0, 1.0, 0.0, 0.0);
    }
    Quaternion::new(1.0 + z, -y, x, 0.0).normalized()
}
