//! A lasting contact of two bodies without friction.
//!
//! Where contacts accumulate, rotation presses the bodies together, and they slide on each other. With a₀ the acceleration of the gap in free flight, the
//! normal force that keeps it closed is N = −a₀/K_nn; the bodies part when a₀ turns positive. a₀ is the derivative of the rate of the gap in free flight, from
//! five rates, of fourth order, and the motion under N is integrated by extrapolation, in steps as short as their error asks for, to about 10⁻⁹ in all.

use super::partner::{FreeBody, Partner, flight};
use crate::contact::{Between, PairSearch};
use crate::math::{Quaternion, Vector};

/// The longest and the shortest step over the time in which the fastest point moves as far as the bodies reach, and the most such times.
const STEPS: [f64; 2] = [1.0 / 4.0, 1.0 / 2048.0];
const LONGEST: f64 = 64.0;
/// The error of a step with one extrapolation less, beside sizes and speeds of the bodies; that of the step is some hundred times smaller.
const PRECISION: f64 = 1e-9;
/// Midpoint steps of each that are extrapolated, to eighth order.
const MIDPOINTS: [u32; 4] = [2, 4, 6, 8];
/// The time between two rates, in the same unit.
const APART: f64 = 2e-4;
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
        let [longest, shortest] = STEPS.map(|step| step * unit);
        let (mut step, apart) = (longest, unit * APART);
        let scales = [self.search.size, fastest, 1.0, 1.0 / unit];
        self.part(states, 0.0);
        let (mut now, mut time) = (numbers(states), 0.0);
        let (mut change, mut presses) = self.change(&now, apart);
        while presses < 0.0 {
            let (next, other) = self.stepped(&now, &change, step, apart);
            let error = difference(&next, &other, scales);
            if error > PRECISION && step > shortest {
                step *= 0.5;
                continue;
            }
            let (later, there) = self.change(&next, apart);
            if there < 0.0 {
                (now, change, presses, time) = (next, later, there, time + step);
                if !self.is_closed(&now) || time > LONGEST * unit {
                    return None;
                }
                if error < 1e-3 * PRECISION {
                    step = longest.min(2.0 * step);
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
                let (there, _) = self.stepped(&now, &change, at, apart);
                let (_, there) = self.change(&there, apart);
                if there < 0.0 {
                    before = (at, there);
                } else {
                    after = (at, there);
                }
                if after.0 - before.0 < 1e-12 * step {
                    break;
                }
            }
            (now, _) = self.stepped(&now, &change, after.0, apart);
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

    /// The bodies a step later: midpoint steps, of which the error has even powers of their length alone, extrapolated to length 0 (W. B. Gragg, SIAM J. Numer.
    /// Anal. 2, 384 (1965)); and the same with one extrapolation less.
    fn stepped(&self, now: &Numbers, first: &Numbers, step: f64, apart: f64) -> (Numbers, Numbers) {
        let moved = |from: &Numbers, change: &Numbers, time: f64| -> Numbers {
            std::array::from_fn(|i| change[i].mul_add(time, from[i]))
        };
        let mut column = [[0.0; 26]; MIDPOINTS.len()];
        for (k, parts) in MIDPOINTS.into_iter().enumerate() {
            let part = step / f64::from(parts);
            let (mut last, mut next) = (*now, moved(now, first, part));
            for _ in 1..parts {
                let later = moved(&last, &self.change(&next, apart).0, 2.0 * part);
                (last, next) = (next, later);
            }
            column[k] = next;
            for j in (0..k).rev() {
                let ratio = f64::from(parts) / f64::from(MIDPOINTS[j]);
                let weight = 1.0 / (ratio * ratio - 1.0);
                let finer = column[j + 1];
                column[j] =
                    std::array::from_fn(|i| (finer[i] - column[j][i]).mul_add(weight, finer[i]));
            }
        }
        (column[0], column[1])
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

/// The largest difference, beside the scales of places, velocities, attitudes and spins.
fn difference(one: &Numbers, other: &Numbers, scales: [f64; 4]) -> f64 {
    let kind = |i: usize| [0, 0, 0, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3][i % 13];
    (0..26)
        .map(|i| (one[i] - other[i]).abs() / scales[kind(i)])
        .fold(0.0, f64::max)
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
            attitude: Quaternion::new(row[i + 6], row[i + 7], row[i + 8], row[i + 9]).normalized(),
            spin: v(10),
        }
    })
}
