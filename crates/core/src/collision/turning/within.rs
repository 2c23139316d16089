//! What happens on a panel: polynomials in ξ, and where on them the compression or the impact ends.

use super::panel::Panel;
use super::polynomial::{Polynomial, TERMS};
use super::{Course, Goal, Rates};
use crate::collision::Hypothesis;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// What the panel adds, as polynomials that vanish at ξ = −1.
pub(super) struct Within<S: Simd, const K: usize> {
    /// ∫A dθ, ∫Ay dθ, ∫Ay² dθ.
    pub first: Polynomial<S, K>,
    pub second: Polynomial<S, K>,
    pub third: Polynomial<S, K>,
    /// ∫y dξ.
    pub angle: Polynomial<S, K>,
    /// v_c^n.
    pub velocity: Polynomial<S, K>,
    /// Impulse along **n**; work of the normal force, under Stronge's hypothesis.
    pub impulse: Polynomial<S, K>,
    pub work: Polynomial<S, K>,
}

impl<S: Simd, const K: usize> Within<S, K> {
    /// Slope of the impulse and of the velocity at −1.
    #[inline(always)]
    fn slopes(
        panel: &Panel<S, K>,
        rates: &Rates<S, K>,
        at: &Course<S, K>,
    ) -> (Pack<S, K>, Pack<S, K>) {
        let pace = 0.5 * panel.length * at.slip;
        (pace * (1.0 + at.y), pace * rates.slope(at.y))
    }

    /// Where v_c^n stops being monotonic: while the slip turns, dv_c^n/dp changes monotonically.
    #[inline(always)]
    fn crest(&self, active: Mask<S, K>) -> Pack<S, K> {
        let mut slope = self.velocity;
        for k in 0..TERMS - 1 {
            slope.0[k] = self.velocity.0[k + 1] * (k + 1) as f64;
        }
        let zero = Pack::splat(self.angle.0[0].simd(), 0.0);
        slope.0[TERMS - 1] = zero;
        let one = zero + 1.0;
        let (before, after) = (slope.at(-one), slope.at(one));
        let turns = active
            & (before * after).lt(0.0)
            & after.abs().max(zero).mul_add(1e-9, zero).lt(before.abs());
        if !turns.any() {
            return one;
        }
        let sign = before.lt(0.0).select(1.0, -one);
        let (mut low, mut high) = (-one, one);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let below = (slope.at(middle) * sign).lt(0.0);
            low = below.select(middle, low);
            high = below.select(high, middle);
        }
        turns.select(high, one)
    }

    /// Goes to what happens on the panel, or to its end.
    #[inline(always)]
    pub fn pass(
        &self,
        panel: &Panel<S, K>,
        rates: &Rates<S, K>,
        goal: &Goal<S, K>,
        at: &Course<S, K>,
    ) -> Course<S, K> {
        let simd = at.v.simd();
        let zero = Pack::splat(simd, 0.0);
        let start = zero - 1.0;
        let mut end = self.crest(!at.over);
        let mut now = *at;
        let (pace, stiff) = Self::slopes(panel, rates, at);

        let velocity = self.velocity.about(start, stiff);
        let reached = velocity.change(end) + at.v; // v_c^n there
        let turns = at.compressing & zero.le(reached) & !at.over;
        let mut from = start;
        if turns.any() {
            let xi = velocity.reaches(-at.v, end, turns);
            from = turns.select(xi, start);
            let work = self.work.about(start, at.v * pace);
            now.normal = self.impulse.about(start, pace).change(from) + at.normal;
            now.work = turns.select(work.change(from) + at.work, at.work);
            now.turn_back(turns, goal);
            now.normal = at.normal;
        }
        // Restitution, up to the end or to where the velocity turns again.
        let restoring = !now.compressing & !at.over;
        let falls = restoring & reached.lt(0.0);
        if falls.any() {
            let down = self.velocity.negative().about(start, -stiff);
            let xi = down.reaches(at.v, end, falls);
            end = falls.select(xi, end);
        }
        let (goes, value) = match goal.hypothesis {
            Hypothesis::Newton => (velocity, goal.rebound - at.v),
            Hypothesis::Poisson => (
                self.impulse.about(start, pace),
                goal.restitution.mul_add(now.compression, now.compression) - at.normal,
            ),
            Hypothesis::Stronge => {
                let slope = turns.select(0.0, at.v * pace);
                (self.work.about(from, slope), now.due - now.work)
            }
        };
        let over = restoring & value.le(goes.change(end));
        let mut to = end;
        if over.any() {
            to = over.select(goes.reaches(value.max(0.0), end, over), end);
        }

        let (x, y, z) = (
            self.first
                .about(start, 0.5 * panel.length * at.a)
                .change(to),
            self.second
                .about(start, 0.5 * panel.length * at.a * at.y)
                .change(to),
            self.third
                .about(start, 0.5 * panel.length * at.a * at.y * at.y)
                .change(to),
        );
        let half = 0.5 * panel.length;
        let passed = [
            half * (to + 1.0),
            half * self.angle.about(start, at.y).change(to),
        ];
        panel.arrive(rates, &mut now, [x, y, z], passed);
        now.v = self.velocity.about(start, stiff).change(to) + at.v;
        now.v = falls.select((falls & !over).select(0.0, now.v), now.v);
        now.work = self
            .work
            .about(from, turns.select(0.0, at.v * pace))
            .change(to)
            + now.work;
        now.compressing = now.compressing | falls & !over;
        now.over = now.over | over;
        now
    }
}
