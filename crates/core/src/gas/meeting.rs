//! Which candidates of a gas come within reach of each other, and on which lines: many at once, one in each lane.

use super::row::bound;
use super::{LINE, TOGETHER};
use crate::math::{Vector, Vectors};
use crate::pair::{Follower, approach};
use crate::random::of_candidates;
use crate::simd::elementary::sincos_in_lanes;
use crate::simd::{LANES, Lanewise, Pack};
use pulp::{Simd, WithSimd};
use std::f64::consts::TAU;

/// Two particles that may meet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub pair: [usize; 2],
    /// The number that decides whether they do.
    pub chance: f64,
    /// Its number among the candidates of all batches.
    pub number: u64,
    pub time: f64,
}

impl Candidate {
    /// The number with which its encounter draws: that of the next candidate, which itself takes only the draw 0.
    #[inline(always)]
    pub fn draws(&self) -> u64 {
        self.number + 1
    }
}

/// Two particles that come within reach of each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct MeetingLine {
    pub candidate: Candidate,
    /// Their relative speed.
    pub speed: f64,
    /// The direction from the second to the first.
    pub apart: Vector,
}

/// Candidates of the same two kinds, no two of which share a particle.
pub(super) struct Candidates<'a, 'b, 'c> {
    pub candidates: &'a [Candidate],
    pub velocities: &'a mut [Vector],
    pub bounds: &'a mut [u16],
    /// The majorant of u, and the cross-section of these two kinds over the largest.
    pub fastest: f64,
    pub section: f64,
    pub seed: u64,
    pub follower: &'a Follower<'b, 'c>,
    /// Receives those that meet; smooth balls touch at once instead.
    pub meetings: &'a mut Vec<MeetingLine>,
}

/// The numbers of those that have touched, and of those that were faster than the majorant.
#[derive(Debug, Default)]
pub(super) struct Decided {
    pub touched: usize,
    pub beyond: usize,
}

impl WithSimd for Candidates<'_, '_, '_> {
    type Output = Decided;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Decided {
        let zero = Pack::splat(simd, 0.0);
        let mut both = [Vectors::none(simd); 2];
        let (mut chances, mut squares, mut turns) = (zero, zero, zero);
        let (mut numbers, mut draws) = ([0; LANES], [(0.0, 0.0); TOGETHER]);
        let mut counters = [0; TOGETHER];
        for (counter, candidate) in counters.iter_mut().zip(self.candidates) {
            *counter = candidate.draws();
        }
        let draws = &mut draws[..self.candidates.len()];
        of_candidates(self.seed, counters.iter().copied(), LINE, draws);
        let smooth = self.follower.smooth_balls();
        let mut decided = Decided::default();
        let width = Pack::<S>::WIDTH;
        for (some, draws) in self.candidates.chunks(width).zip(draws.chunks(width)) {
            for (lane, (candidate, &(square, turn))) in some.iter().zip(draws).enumerate() {
                let [i, j] = candidate.pair;
                both[0].put(lane, self.velocities[i]);
                both[1].put(lane, self.velocities[j]);
                chances.as_mut_slice()[lane] = candidate.chance;
                squares.as_mut_slice()[lane] = square;
                turns.as_mut_slice()[lane] = turn;
                numbers[lane] = candidate.number;
            }
            let u = both[0] - both[1];
            let speed = u.norm();
            let share = speed / Pack::splat(simd, self.fastest) * self.section;
            let meet = chances.lt(share);
            let beyond = Pack::splat(simd, 1.0).lt(share);
            let direction = u / speed;
            let around = sincos_in_lanes(TAU * turns);
            let apart = approach(direction, direction.across(), squares.sqrt(), around);
            if smooth {
                let after = self.follower.touch(both, apart, (self.seed, &numbers));
                for (i, after) in after.into_iter().enumerate() {
                    let after = both[i].or(meet, after);
                    let squares = after.dot(after);
                    for (lane, candidate) in some.iter().enumerate() {
                        self.velocities[candidate.pair[i]] = after.lane(lane);
                        self.bounds[candidate.pair[i]] =
                            bound(squares.as_slice()[lane], self.fastest);
                    }
                }
            }
            for (lane, &candidate) in some.iter().enumerate() {
                decided.beyond += usize::from(beyond.get(lane));
                if smooth {
                    decided.touched += usize::from(meet.get(lane));
                } else if meet.get(lane) {
                    let (speed, apart) = (speed.as_slice()[lane], apart.lane(lane));
                    self.meetings.push(MeetingLine {
                        candidate,
                        speed,
                        apart,
                    });
                }
            }
        }
        decided
    }
}
