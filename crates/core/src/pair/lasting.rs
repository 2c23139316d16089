//! A lasting contact of two bodies without friction.
//!
//! Where contacts accumulate, rotation presses the bodies together, and they slide on each other. With a₀ the acceleration of the gap in free flight, the
//! normal force that keeps it closed is N = −a₀/K_nn; the bodies part when a₀ turns positive. a₀ is the derivative of the rate of the gap in free flight, from
//! five rates, and the motion under N is integrated by the method of Runge and Kutta, both of fourth order and with steps that leave errors of about 10⁻⁹.

use super::partner::{FreeBody, Partner, flight};
use crate::contact::{Between, PairSearch};
use crate::math::{Quaternion, Vector};

/// Steps in the time in which the fastest point moves as far as the bodies reach, and most such times.
const STEPS: f64 = 256.0;
const LONGEST: f64 = 64.0;
/// That between two rates, in the same unit.
const APART: f64 = 1e-3;
/// The speed at which the bodies part, beside that of the fastest point.
const PARTING: f64 = 1e-9;
/// The gap between the bodies, or the overlap of other parts, beside their reach, that ends it as one that cannot be followed.
const OPEN: f64 = 1e-6;

/// Positions, velocities, attitudes and spins of both bodies, or their rates of change.
type Numbers = [f64; 26];

/// Two bodies that touch with two of their parts.
pub(super) struct Lasting<'a> {
    pub bodies: [&'a Partner; 2],
    pub search: &'a PairSearch<'a>,
    pub parts: [usize; 2],
    pub between: &'a Between,
}

/// Where two bodies touch: the normal, the place from both centres, the rate of the gap, and K_nn.
struct Touching {
    normal: Vector,
    arms: [Vector; 2],
    rate: f64,
    compliance: f64,
}

impl Lasting<'_> {
    /// Moves the bodies until they part; the time that this takes and the speed at which they do, or none if it cannot be followed.
    pub fn follow(&self, states: &mut [FreeBody; 2]) -> Option<(f64, f64)> {
        let [one, two] = &*states;
        let turns = |i: usize| states[i].spin.norm() * self.bodies[i].reach;
        let fastest = (one.velocity - two.velocity).norm() + turns(0) + turns(1);
        let unit = self.search.size / fastest;
        let (step, apart) = (unit / STEPS, unit * APART);
        self.part(states, 0.0);
        let (mut now, mut time) = (numbers(states), 0.0);
        let (mut change, mut presses) = self.change(&now, apart);
        while presses < 0.0 {
            let next = self.stepped(&now, &change, step, apart);
            let (later, there) = self.change(&next, apart);
            if there < 0.0 {
                (now, change, presses, time) = (next, later, there, time + step);
                if !self.is_closed(&now) || time > LONGEST * unit {
                    return None;
                }
                continue;
            }
            // Bisection, and false position from both ends, until the end is known to rounding of a₀.
            let (mut before, mut after) = ((0.0, presses), (step, there));
            for round in 0..60 {
                let false_position =
                    before.0 + (after.0 - before.0) * before.1 / (before.1 - after.1);
                let at = if round % 3 == 2 {
                    0.5 * (before.0 + after.0)
                } else {
                    false_position
                };
                let (_, there) = self.change(&self.stepped(&now, &change, at, apart), apart);
                if there < 0.0 {
                    before = (at, there);
                } else {
                    after = (at, there);
                }
                if after.0 - before.0 < 1e-12 * step {
                    break;
                }
            }
            now = self.stepped(&now, &change, after.0, apart);
            time += after.0;
            break;
        }
        *states = bodies(&now);
        let speed = PARTING * fastest;
        self.part(states, speed);
        Some((time, speed))
    }

    /// Gives the gap a rate.
    fn part(&self, states: &mut [FreeBody; 2], rate: f64) {
        let touching = self.touching(states);
        let impulse = touching.normal * ((rate - touching.rate) / touching.compliance);
        for (i, sign) in [(0, 1.0), (1, -1.0)] {
            states[i].push(self.bodies[i], touching.arms[i], impulse, sign);
        }
    }

    fn touching(&self, states: &[FreeBody; 2]) -> Touching {
        let [one, two] = states;
        let apart = one.position - two.position;
        let poses = [one.pose(), two.pose()];
        let (normal, first) = self.search.meeting(apart, self.parts, &poses, self.between);
        let arms = [first, first + apart];
        let moves = one.velocity - two.velocity + one.moves(arms[0]) - two.moves(arms[1]);
        let along = |i: usize| {
            let [torque, change] = states[i].twist(self.bodies[i], arms[i], normal);
            self.bodies[i].inverse_mass + torque.dot(change)
        };
        Touching {
            normal,
            arms,
            rate: normal.dot(moves),
            compliance: along(0) + along(1),
        }
    }

    /// The rates of change under the force, and a₀.
    fn change(&self, now: &Numbers, apart: f64) -> (Numbers, f64) {
        let states = bodies(now);
        let touching = self.touching(&states);
        let rate = |steps: f64| {
            let mut later = states;
            for (state, body) in later.iter_mut().zip(self.bodies) {
                state.position = state.velocity.mul_add(steps * apart, state.position);
                if !body.is_plane() {
                    state.turn(body, steps * apart);
                }
            }
            self.touching(&later).rate
        };
        let sum = -25.0 * touching.rate + 48.0 * rate(1.0) - 36.0 * rate(2.0) + 16.0 * rate(3.0)
            - 3.0 * rate(4.0);
        let presses = sum / (12.0 * apart);
        let force = touching.normal * (-presses / touching.compliance);
        let mut change = [0.0; 26];
        for (i, sign) in [(0, 1.0), (1, -1.0)] {
            let (state, body) = (&states[i], self.bodies[i]);
            let mut rates = FreeBody {
                position: state.velocity,
                velocity: Vector::default(),
                attitude: state.attitude,
                spin: body.top.change(state.spin),
            };
            rates.push(body, touching.arms[i], force, sign);
            let Vector { x, y, z } = state.spin * 0.5;
            rates.attitude = state.attitude * Quaternion::new(0.0, x, y, z);
            write(&rates, &mut change[13 * i..]);
        }
        (change, presses)
    }

    /// The bodies a step later.
    fn stepped(&self, now: &Numbers, first: &Numbers, step: f64, apart: f64) -> Numbers {
        let moved = |change: &Numbers, part: f64| {
            let mut next: Numbers = std::array::from_fn(|i| change[i].mul_add(part * step, now[i]));
            for i in [6, 19] {
                let [w, x, y, z] = [next[i], next[i + 1], next[i + 2], next[i + 3]];
                let attitude = Quaternion::new(w, x, y, z).normalized();
                next[i..i + 4].copy_from_slice(&attitude.parts());
            }
            next
        };
        let (second, _) = self.change(&moved(first, 0.5), apart);
        let (third, _) = self.change(&moved(&second, 0.5), apart);
        let (fourth, _) = self.change(&moved(&third, 1.0), apart);
        let mean =
            std::array::from_fn(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0);
        moved(&mean, 1.0)
    }

    /// True if the gap is closed, and no other parts overlap.
    fn is_closed(&self, now: &Numbers) -> bool {
        let states = bodies(now);
        let width = self.search.narrowest(&mut flight(self.bodies, &states));
        width.abs() < OPEN * self.search.size
    }
}

fn write(state: &FreeBody, row: &mut [f64]) {
    row[..3].copy_from_slice(&state.position.parts());
    row[3..6].copy_from_slice(&state.velocity.parts());
    row[6..10].copy_from_slice(&state.attitude.parts());
    row[10..13].copy_from_slice(&state.spin.parts());
}

fn numbers(states: &[FreeBody; 2]) -> Numbers {
    let mut row = [0.0; 26];
    write(&states[0], &mut row[..13]);
    write(&states[1], &mut row[13..]);
    row
}

fn bodies(row: &Numbers) -> [FreeBody; 2] {
    [0, 13].map(|i| {
        let v = |at: usize| Vector::new(row[i + at], row[i + at + 1], row[i + at + 2]);
        FreeBody {
            position: v(0),
            velocity: v(3),
            attitude: Quaternion::new(row[i + 6], row[i + 7], row[i + 8], row[i + 9]),
            spin: v(10),
        }
    })
}
