//! How far to go on: to the next event, as far as one can tell from here, and back where that was too far.

use super::hodograph::reach;
use super::near::Near;
use super::series::parabola;
use super::{Course, Goal, Rates};
use crate::law::Hypothesis;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Guess of x up to which the series are asked.
const NEAR: f64 = 3.0;
/// Length over which v_c^n may have an extremum between its ends, times R.
const SHORT: f64 = 1.0 / 1_048_576.0; // 2⁻²⁰

/// The way to the next event if the velocity is linear in p and A(1 + y)² exponential in θ; backwards where that is behind.
pub(super) struct Way<S: Simd, const K: usize> {
    /// In p and in θ.
    pub impulse: Pack<S, K>,
    pub length: Pack<S, K>,
    /// v_c^n rises, or falls towards an end of the restitution.
    leads: Mask<S, K>,
    /// > 0 unless the slip would have vanished before.
    pub fourth: Pack<S, K>,
}

/// How far the next event is, in θ; infinitely far if there is none.
#[inline(always)]
pub(super) fn guess<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    goal: &Goal<S, K>,
    at: &Course<S, K>,
) -> Pack<S, K> {
    let way = way(rates, goal, at);
    let zero = Pack::splat(at.v.simd(), 0.0);
    let ahead = way.leads & zero.le(way.impulse) & zero.lt(way.fourth);
    ahead.select(way.length, f64::INFINITY)
}

/// The way to the next event.
#[inline(always)]
pub(super) fn way<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    goal: &Goal<S, K>,
    at: &Course<S, K>,
) -> Way<S, K> {
    let whole = 1.0 + at.y;
    let stiff = rates.slope(at.y) / whole;
    let zero = Pack::splat(at.v.simd(), 0.0);
    let missing = goal.missing(at);
    let restitution = match goal.hypothesis {
        Hypothesis::Newton => missing / stiff,
        Hypothesis::Poisson => missing,
        Hypothesis::Stronge => parabola(at.v, 0.5 * stiff, missing),
    };
    // In a jam v_c^n falls to 0, perhaps before that.
    let falls = zero.le(at.v) & stiff.lt(0.0);
    let rest = -at.v / stiff;
    let soon = match goal.hypothesis {
        Hypothesis::Newton => rest,
        _ => rest.min(restitution),
    };
    let p = at.compressing.select(rest, falls.select(soon, restitution));
    let gamma = rates.minus.mul_add(at.y, rates.plus);
    let growth = -(4.0 * at.y * gamma) / whole - rates.kappa.mul_add(at.y, rates.decay);
    let share = p / (at.slip * whole);
    let fourth = growth.mul_add(share, 1.0);
    let q = fourth.max(0.0).sqrt().sqrt();
    // ln(1 + t) = 8(q − 1)/(q + 1), nearly, with q⁴ = 1 + t.
    let theta = 8.0 * share / ((q + 1.0) * (q + 1.0) * q.mul_add(q, 1.0));
    Way {
        impulse: p,
        length: theta,
        leads: zero.lt(stiff) | !at.compressing,
        fourth,
    }
}

/// How far it is certain, in θ, that v_c^n has no extremum, or all but none.
#[inline(always)]
fn crest<S: Simd, const K: usize>(rates: &Rates<S, K>, at: &Course<S, K>) -> Pack<S, K> {
    let zero = Pack::splat(at.y.simd(), 0.0);
    let (now, jam) = (rates.slope(at.y), rates.nu * rates.friction);
    // There y = c, and y₀ − y = (ρ₊ + ρ₋y₀)ζ/(1 + ρ₋ζ).
    let c = (jam - rates.nn) / (jam + rates.nn);
    let zeta = now / (rates.nn + jam) / rates.minus.mul_add(c, rates.plus);
    let certain = reach(rates.plus, at.y, zeta).max(SHORT / rates.pace(at.y));
    (zero.lt(at.y) & zero.lt(c) & zero.lt(zeta)).select(certain, f64::INFINITY)
}

/// Goes through the events that are near, and says how far the next one is, in θ: infinitely far if there is none.
#[inline(always)]
pub(super) fn events<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    goal: &Goal<S, K>,
    at: &mut Course<S, K>,
) -> Pack<S, K> {
    let far = guess(rates, goal, at);
    let crest = crest(rates, at);
    let near = (at.is_late(goal) | (far * rates.pace(at.y)).le(NEAR)) & !at.over;
    if !near.any() {
        return far.min(crest);
    }
    let wanted = Near::new(rates, at).pass(rates, goal, near, crest, at);
    near.select(wanted, far).min(crest)
}

/// Which lanes have gone too far on the way from `at` to `end`, and how far they should have gone.
#[inline(always)]
pub(super) fn beyond<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    goal: &Goal<S, K>,
    at: &Course<S, K>,
    end: &Course<S, K>,
    length: Pack<S, K>,
) -> (Mask<S, K>, Pack<S, K>) {
    let zero = Pack::splat(at.v.simd(), 0.0);
    let y = end.w * end.w / (4.0 * end.a * end.a);
    let slip = end.a * (1.0 + y);
    let inverse = 1.0 / rates.pace(y);
    let (before, after) = (rates.slope(at.y), rates.slope(y));
    // v_c^n = 0: what was missing, how far it is beyond, and both slopes.
    let sign = at.compressing.select(1.0, zero - 1.0);
    let rests = Beyond {
        value: -sign * at.v,
        off: sign * end.v,
        early: sign * at.slip * before * length,
        late: sign * slip * after * inverse,
    };
    // The end of the restitution.
    let (early, late) = match goal.hypothesis {
        Hypothesis::Newton => (at.slip * before, slip * after),
        Hypothesis::Poisson => (at.slip * (1.0 + at.y), slip * (1.0 + y)),
        Hypothesis::Stronge => (at.v * at.slip * (1.0 + at.y), end.v * slip * (1.0 + y)),
    };
    let ends = Beyond {
        value: goal.missing(at),
        off: -goal.missing(end),
        early: early * length,
        late: late * inverse,
    };
    let forward = zero.lt(length);
    let (at_rest, at_end) = (
        rests.is_far() & forward,
        ends.is_far() & forward & !at.compressing,
    );
    let rest = at_rest.select(rests.share(), 1.0);
    let share = at_end.select(ends.share(), 1.0).min(rest);
    (at_rest | at_end, share.max(1.0 / 64.0).min(0.9) * length)
}

/// An event that is behind the end of a way.
struct Beyond<S: Simd, const K: usize> {
    value: Pack<S, K>,
    off: Pack<S, K>,
    early: Pack<S, K>,
    late: Pack<S, K>,
}

impl<S: Simd, const K: usize> Beyond<S, K> {
    /// Whether it is too far behind for the series.
    #[inline(always)]
    fn is_far(&self) -> Mask<S, K> {
        Pack::splat(self.off.simd(), 0.0).lt(self.off) & !self.off.le(0.5 * self.late)
    }

    /// At which share of the way it is, on a parabola.
    #[inline(always)]
    fn share(&self) -> Pack<S, K> {
        parabola(self.early, self.off + self.value - self.early, self.value)
    }
}

#[cfg(test)]
mod tests {
    use super::super::hodograph::Hodograph;
    use super::super::testing::{Case, State, end_at, value};
    use super::*;
    use crate::law::coulomb::turning::panel;
    use crate::simd::one;

    const HYPOTHESES: [Hypothesis; 3] =
        [Hypothesis::Stronge, Hypothesis::Poisson, Hypothesis::Newton];

    /// Slips that turn either way; v_c^n is linear in p where K_nu = 0, and falls in the last, a jam.
    const CASES: [Case; 5] = [
        case(0.7, 1.5, 0.0, 2.0, 1.3, 0.8),
        case(0.7, 1.5, 0.0, 2.0, 3.1, 1.5),
        case(0.3, 1.5, 0.6, 2.0, 1.3, 0.9),
        case(0.4, 1.7, -0.5, 1.3, 2.9, 1.2),
        case(1.9, 1.1, 0.9, 1.4, 1.2, 0.2),
    ];

    const fn case(friction: f64, nn: f64, nu: f64, uu: f64, ww: f64, direction: f64) -> Case {
        Case {
            friction,
            nn,
            nu,
            uu,
            ww,
            direction,
        }
    }

    /// The event is x = Rθ away; the guess takes the velocity as linear in p and A(1 + y)² as exponential in θ: it is off by the order
    /// of x², and by that of x where K_nu makes the velocity another function of p.
    #[test]
    fn the_next_event_is_guessed_where_it_is() {
        for hypothesis in HYPOTHESES {
            for case in CASES {
                let impacts = case.impacts(0.8, 0.3, hypothesis);
                let (rates, mut goal, mut at) = (impacts.rates, impacts.goal, impacts.course);
                let x = 1e-3;
                let theta = x / value(rates.pace(at.y));
                let allowed = if case.nu == 0.0 { 10.0 * x } else { 10.0 } * x * theta;
                let gained = State::of(&at).after(&rates, theta).v - value(at.v);

                at.v = one(-gained);
                let jam = gained < 0.0;
                let found = value(guess(&rates, &goal, &at));
                if jam {
                    assert_eq!(found, f64::INFINITY, "{case:?}"); // v_c^n > 0 falls in no compression
                } else {
                    assert!((found - theta).abs() < allowed, "{found} {theta} {case:?}");
                }

                at.compressing = !at.compressing;
                at.v = one(3.0 * gained.abs());
                let there = State::of(&at).after(&rates, theta);
                end_at(&mut goal, &mut at, &there);
                let found = value(guess(&rates, &goal, &at));
                if jam && hypothesis == Hypothesis::Newton {
                    // Where v_c^n falls Newton's goal is not ahead, but the end of the jam, three times as far.
                    assert!((found - 3.0 * theta).abs() < 9.0 * allowed, "{case:?}");
                    continue;
                }
                assert!((found - theta).abs() < allowed, "{found} {theta} {case:?}");
                if jam {
                    // The jam ends before the restitution.
                    at.v = one(0.5 * gained.abs());
                    let found = value(guess(&rates, &goal, &at));
                    assert!((found - 0.5 * theta).abs() < allowed, "{found} {case:?}");
                }
            }
        }
    }

    /// v_c^n has an extremum where y = c: at the end of that way, which is known to second order, and not before.
    #[test]
    fn an_extremum_of_the_normal_velocity_is_not_passed() {
        for (friction, nn, nu, uu, ww) in [
            (1.9, 1.1, 0.9, 1.4, 1.2),
            (1.5, 1.1, 0.9, 1.2, 2.4),
            (2.6, 0.8, 0.7, 2.4, 1.1),
        ] {
            let c: f64 = (friction * nu - nn) / (friction * nu + nn);
            for off in [1e-3, -1e-3, 1e-13, -1e-13] {
                let direction = 2.0 * (c * (1.0 + off)).sqrt().atan();
                let case = case(friction, nn, nu, uu, ww, direction);
                let impacts = case.impacts(0.8, 0.3, Hypothesis::Newton);
                let (rates, at) = (impacts.rates, impacts.course);
                let found = value(crest(&rates, &at));
                // d ln y/dθ = −2(ρ₊ + ρ₋y).
                let turning = 2.0 * (value(rates.plus) + value(rates.minus) * c);
                if (turning > 0.0) != (off > 0.0) {
                    assert_eq!(found, f64::INFINITY, "{case:?}");
                    continue;
                }
                let theta = off / turning;
                let short = SHORT / value(rates.pace(at.y));
                if off.abs() < 1e-10 {
                    assert!((found - short).abs() < 1e-12 * short, "{found} {case:?}");
                } else {
                    assert!(
                        (found - theta).abs() < 0.01 * theta,
                        "{found} {theta} {case:?}"
                    );
                    // To the second order of the bound −ln(1 − t) ≥ 8(1 − q)/(1 + q) it is the extremum itself.
                    let start = State::of(&at);
                    let slope = |theta| {
                        let y = start.after(&rates, theta).y();
                        value(rates.slope(one(y)))
                    };
                    assert!(slope(0.99 * found) * slope(0.0) > 0.0);
                    assert!(slope(1.01 * found) * slope(0.0) < 0.0);
                }
            }
        }
    }

    /// Where friction cannot stop v_c^n from rising it has none.
    #[test]
    fn without_a_jam_there_is_no_extremum() {
        for case in CASES {
            if case.nn > (case.friction * case.nu).abs() {
                let impacts = case.impacts(0.8, 0.3, Hypothesis::Newton);
                let found = value(crest(&impacts.rates, &impacts.course));
                assert_eq!(found, f64::INFINITY, "{case:?}");
            }
        }
    }

    /// A slip whose direction y = ½ stays and whose size all but does: v_c^n and p are nearly linear in θ, the work nearly a parabola.
    fn steady(nn: f64) -> Case {
        let (friction, uu, ww) = (0.5, 2.0, 0.1);
        let nu = friction * (ww - uu) * (0.5 - 1.0) / (0.5 + 1.0);
        case(friction, nn, nu, uu, ww, 2.0 * 0.5_f64.sqrt().atan())
    }

    /// Whether events that are behind the end of a way of Rθ = 2 count as far, and where they are said to be. The size of the slip
    /// changes by 4 % on the way, and so does a parabola of what changes with it; its third order is a few hundredths of that.
    fn behind(
        (rates, goal): (&Rates<pulp::Scalar, 1>, &Goal<pulp::Scalar, 1>),
        at: &Course<pulp::Scalar, 1>,
        share: f64,
    ) {
        let length = 2.0 / value(rates.pace(at.y));
        let path = Hodograph::new(rates, at.y);
        let end = panel::pass((rates, &path), goal, at, one(length));
        let (back, limit) = beyond(rates, goal, at, &end, one(length));
        // Events that are up to x = 1/2 behind are left to the series.
        assert_eq!(back.any(), share < 0.75, "{share}");
        if back.any() {
            let limit = value(limit) / length;
            let share = share.max(1.0 / 64.0);
            assert!((limit - share).abs() < 4e-3, "{limit} {share}");
        }
    }

    #[test]
    fn a_step_beyond_an_event_is_repeated_up_to_it() {
        for share in [0.001, 0.2, 0.45, 0.6, 0.85, 0.95] {
            for hypothesis in HYPOTHESES {
                for nn in [1.5, 0.02] {
                    let impacts = steady(nn).impacts(0.7, 0.3, hypothesis);
                    let (rates, mut goal, mut at) = (impacts.rates, impacts.goal, impacts.course);
                    let way = share * 2.0 / value(rates.pace(at.y));
                    let gained = State::of(&at).after(&rates, way).v - value(at.v);
                    assert_eq!(gained < 0.0, nn < 1.0); // a jam

                    if gained > 0.0 {
                        at.v = one(-gained);
                        behind((&rates, &goal), &at, share);
                    }
                    at.compressing = !at.compressing;
                    at.v = one(0.4);
                    let there = State::of(&at).after(&rates, way);
                    end_at(&mut goal, &mut at, &there);
                    if gained > 0.0 || hypothesis != Hypothesis::Newton {
                        behind((&rates, &goal), &at, share);
                    }
                    if gained < 0.0 {
                        // The end of a jam, before that of the restitution or with it.
                        at.v = one(-gained);
                        let there = State::of(&at).after(&rates, way);
                        end_at(&mut goal, &mut at, &there);
                        behind((&rates, &goal), &at, share);
                        goal.rebound = one(1.0);
                        at.due = one(1.0);
                        at.compression = one(1.0);
                        behind((&rates, &goal), &at, share);
                    }
                }
            }
        }
    }
}
