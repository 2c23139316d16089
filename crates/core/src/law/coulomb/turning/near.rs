//! The impact as power series about where it has come to: what happens there, and how far the next event is.
//!
//! The variable is x = Rθ with R the sum of the rates, so that the series converge for x of the order of 1. Where their last terms do
//! not count, an event is found to rounding; else the series say how far to go for it to be near.

use super::panel::arrive;
use super::series::{ORDER, Root, Series, power};
use super::step::guess;
use super::{Course, Goal, Rates};
use crate::law::Hypothesis;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Last of them at which it is found, relative to the way: the next one would be its square; and at which it is a guess.
const FOUND: f64 = 1e-8;
const GUESSED: f64 = 0.1;
/// What the terms left out may be of the impact, and of the way to an event that is a guess.
const EXACT: f64 = 1.0 / 9_007_199_254_740_992.0; // 2⁻⁵³
const ROUGH: f64 = 1.0 / 128.0;

/// The series.
pub(super) struct Near<S: Simd, const K: usize> {
    /// 1/R.
    unit: Pack<S, K>,
    /// ∫A dθ, ∫Ay dθ, ∫Ay² dθ, ∫y dθ.
    first: Series<S, K>,
    second: Series<S, K>,
    third: Series<S, K>,
    turn: Series<S, K>,
    /// Impulse along **n**, v_c^n, work of the normal force, as they change.
    impulse: Series<S, K>,
    velocity: Series<S, K>,
    work: Series<S, K>,
}

impl<S: Simd, const K: usize> Near<S, K> {
    #[inline(always)]
    pub fn new(rates: &Rates<S, K>, at: &Course<S, K>) -> Self {
        let zero = Pack::splat(at.y.simd(), 0.0);
        let unit = 1.0 / rates.pace(at.y);
        let (plus, minus) = (-2.0 * rates.plus * unit, -2.0 * rates.minus * unit);
        let (decay, kappa) = (-rates.decay * unit, -rates.kappa * unit);
        let empty = Series([zero; ORDER]);
        let mut near = Self {
            unit,
            first: empty,
            second: empty,
            third: empty,
            turn: empty,
            impulse: empty,
            velocity: empty,
            work: empty,
        };
        // y and A/R, Ay/R; dp/dx and v_c^n.
        let (mut y, mut a, mut b) = ([zero; ORDER], [zero; ORDER], [zero; ORDER]);
        let (mut p, mut v) = ([zero; ORDER], [zero; ORDER]);
        (y[0], a[0], v[0]) = (at.y, at.a * unit, at.v);
        for k in 0..ORDER {
            let (mut square, mut third, mut power) = (zero, zero, zero);
            for i in 0..=k {
                b[k] = y[k - i].mul_add(a[i], b[k]);
            }
            for i in 0..=k {
                square = y[i].mul_add(y[k - i], square);
                third = b[i].mul_add(y[k - i], third);
            }
            p[k] = a[k] + third + 2.0 * b[k];
            for i in 0..=k {
                power = v[i].mul_add(p[k - i], power);
            }
            let change = rates.velocity([a[k], b[k], third]);
            let share = 1.0 / (k + 1) as f64;
            near.first.0[k] = a[k] * share;
            near.second.0[k] = b[k] * share;
            near.third.0[k] = third * share;
            near.turn.0[k] = y[k] * unit * share;
            near.impulse.0[k] = p[k] * share;
            near.velocity.0[k] = change * share;
            near.work.0[k] = power * share;
            if k + 1 < ORDER {
                y[k + 1] = (plus * y[k] + minus * square) * share;
                a[k + 1] = (decay * a[k] + kappa * b[k]) * share;
                v[k + 1] = change * share;
            }
        }
        near
    }

    /// What the terms left out are, as a velocity.
    #[inline(always)]
    fn error(&self, rates: &Rates<S, K>, x: Pack<S, K>) -> Pack<S, K> {
        let rest = self.impulse.rest().mul_add(rates.nn, self.velocity.rest());
        power(x) * rest
    }

    /// Whether an event beyond `from` is found to rounding, of which the velocity `allowed` is left.
    #[inline(always)]
    fn exact(
        &self,
        rates: &Rates<S, K>,
        root: &Root<S, K>,
        from: Pack<S, K>,
        allowed: Pack<S, K>,
    ) -> Mask<S, K> {
        let small = root.step.abs().le((root.x - from).abs() * FOUND);
        small & self.error(rates, root.x).le(allowed)
    }

    /// Whether what is `due` is a work that the series from here resolve.
    #[inline(always)]
    fn keeps(&self, x: Pack<S, K>, from: Pack<S, K>, due: Pack<S, K>) -> Mask<S, K> {
        (self.work.rest() * power(x)).le(due * EXACT) & self.work.at(from).abs().le(16.0 * due)
    }

    /// Whether it is found roughly.
    #[inline(always)]
    fn rough(&self, rates: &Rates<S, K>, root: &Root<S, K>, from: Pack<S, K>) -> Mask<S, K> {
        let small = root.step.abs().le((root.x - from).abs() * GUESSED);
        let pace = self.impulse.0[0].mul_add(rates.nn, self.velocity.0[0].abs());
        let way = pace * root.x.abs();
        small & self.error(rates, root.x).le(way * ROUGH)
    }

    /// Goes through the events that are near, and says how far the next one is, in θ: infinitely far if nobody knows.
    #[inline(always)]
    pub fn pass(
        &self,
        rates: &Rates<S, K>,
        goal: &Goal<S, K>,
        near: Mask<S, K>,
        crest: Pack<S, K>,
        at: &mut Course<S, K>,
    ) -> Pack<S, K> {
        let zero = Pack::splat(at.v.simd(), 0.0);
        let allowed = rates.nn.mul_add(at.normal, goal.approach) * EXACT;
        let crest = crest / self.unit;
        let rest = self.velocity.reaches(-at.v, zero, self.velocity.0[0]);
        let met = (rest.x * at.v).le(0.0) & rest.x.le(crest);
        let rests = near & at.compressing & zero.lt(rest.slope) & met;
        let ends = rests & self.exact(rates, &rest, zero, allowed);
        let from = ends.select(rest.x, 0.0);
        let mut now = *at;
        now.normal = at.normal + self.impulse.at(from);
        now.work = at.work + self.work.at(from);
        now.turn_back(ends, goal);

        let restoring = near & !now.compressing;
        let (path, value) = match goal.hypothesis {
            Hypothesis::Newton => (&self.velocity, goal.rebound - at.v),
            Hypothesis::Poisson => (
                &self.impulse,
                goal.restitution.mul_add(now.compression, now.compression) - at.normal,
            ),
            Hypothesis::Stronge => (&self.work, now.due - now.work + self.work.at(from)),
        };
        let slope = match goal.hypothesis {
            Hypothesis::Stronge => ends.select(0.0, path.0[0]),
            _ => path.0[0],
        };
        let last = path.reaches(value, from, slope.max(0.0));
        let ahead = zero.le((last.x - from) * (value - path.at(from)));
        let goes = restoring & zero.lt(last.slope) & last.x.le(crest) & ahead;
        let mut over = goes & self.exact(rates, &last, from, allowed);
        let mut end = last.x;
        if goal.hypothesis == Hypothesis::Stronge {
            let none = ends & (now.due - now.work).le(0.0); // is given back
            over = over & self.keeps(last.x, from, now.due) | none;
            end = none.select(from, end);
        }
        // In a jam the restitution may turn into another compression first.
        let falls = restoring & !ends & rest.slope.lt(0.0) & zero.le(rest.x * at.v);
        let falls = falls & rest.x.le(crest) & !(goes & last.x.lt(rest.x));
        let fallen = falls & self.exact(rates, &rest, zero, allowed);
        over = over & !falls;

        let to = over.select(end, fallen.select(rest.x, from));
        let theta = to * self.unit;
        let moments = [self.first.at(to), self.second.at(to), self.third.at(to)];
        now.normal = at.normal;
        arrive(rates, &mut now, moments, theta, self.turn.at(to));
        now.v = (ends & !over | fallen).select(0.0, at.v + self.velocity.at(to));
        now.work = (ends & !over).select(now.work, at.work + self.work.at(to));
        now.compressing = now.compressing | fallen;
        now.over = now.over | over;
        let moved = over | ends | fallen;
        *at = Course::choose(moved, &now, at);

        let rests = rests & !ends & self.rough(rates, &rest, zero);
        let falls = falls & !fallen & self.rough(rates, &rest, zero);
        let goes = goes & !over & !falls & self.rough(rates, &last, from);
        let x = (rests | falls).select(rest.x, last.x - from);
        let known = rests | falls | goes;
        known.select(x * self.unit, guess(rates, goal, at))
    }
}
