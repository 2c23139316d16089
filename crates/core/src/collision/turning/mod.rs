//! Coulomb friction where the slip turns: the contact slips across the plane of the axis, too. All lanes at once.
//!
//! With the slip **s** = (u, w), u taken along it, let A = (|**s**| + u)/2 and B = (|**s**| − u)/2, so that w² = 4AB, and
//! y = B/A = tan²(φ/2) with φ the direction of the slip. In θ with dp = |**s**|(1 + y) dθ the equation of the slip
//! d**s**/dp = K_nu **u** − μ K_t **s**/|**s**| reads
//!
//! dy/dθ = −2y(ρ₊ + ρ₋y), d ln A/dθ = −λ − κy, ρ± = K_nu ± μ(K_ww − K_uu), λ = μK_uu − K_nu, κ = μK_ww − ρ₋:
//!
//! 1/y is an exponential function of θ, ∫y dθ a logarithm, and A the exponential function of −∫(λ + κy) dθ. What is left are
//! quadratures of functions that are analytic next to the path ([`panel`]), and where the slip vanishes, a continued fraction
//! ([`Stop`](stop::Stop)). The ends of compression and restitution follow from power series about a point next to
//! them ([`Near`](near::Near)), and where the direction hardly turns any more, from sums of exponential functions ([`Tail`]). Wherever
//! the slip has come to rest the rest of the impact is a straight line in p.

mod hodograph;
mod lanes;
mod near;
mod nodes;
mod panel;
mod queue;
mod rates;
mod series;
mod step;
mod stop;
mod tail;
#[cfg(test)]
mod testing;

use super::Hypothesis;
use crate::simd::{Mask, Pack};
use hodograph::Hodograph;
use pulp::Simd;
pub(super) use queue::finish;
use rates::Rates;
use step::beyond;
use stop::Stop;
use tail::Tail;

/// Slip at which it counts as vanished, relative to the contact velocity; the impulse is of the order of that.
const VANISHED: f64 = 1.0 / 18_014_398_509_481_984.0; // 2⁻⁵⁴
/// Least y of a slip that comes round to be looked at from the other side.
const ROUND: f64 = 1.0 / 4.0;
/// Panels after which the slip is taken to have vanished.
const MOST_PANELS: f64 = 1000.0;

/// A contact, and what of it enters Coulomb's law.
#[derive(Clone, Copy)]
pub(crate) struct Slipping<S: Simd, const K: usize> {
    /// −v_c^n ≥ 0.
    pub speed: Pack<S, K>,
    /// v_c^u and v_c^w.
    pub along: Pack<S, K>,
    pub across: Pack<S, K>,
    pub nn: Pack<S, K>,
    pub nu: Pack<S, K>,
    pub uu: Pack<S, K>,
    pub ww: Pack<S, K>,
    /// ε_n.
    pub restitution: Pack<S, K>,
}

/// Impulse along **n**, **u** and **w**, and v_c^n after the impact.
#[derive(Clone, Copy)]
pub(crate) struct Answer<S: Simd, const K: usize> {
    pub normal: Pack<S, K>,
    pub along: Pack<S, K>,
    pub across: Pack<S, K>,
    pub separation_speed: Pack<S, K>,
}

/// Where the impacts have come to.
#[derive(Clone, Copy)]
struct Course<S: Simd, const K: usize> {
    /// Slip u and w ≥ 0, |**s**|, A, y.
    u: Pack<S, K>,
    w: Pack<S, K>,
    slip: Pack<S, K>,
    a: Pack<S, K>,
    y: Pack<S, K>,
    /// ±1: whether **u** is that of the contact.
    mirror: Pack<S, K>,
    /// v_c^n.
    v: Pack<S, K>,
    /// Impulse so far.
    normal: Pack<S, K>,
    along: Pack<S, K>,
    across: Pack<S, K>,
    /// Work of the normal force since the beginning or the last end of a compression.
    work: Pack<S, K>,
    /// Before the end of the compression, which in a jam may come more than once.
    compressing: Mask<S, K>,
    /// Impulse at its last end, and work of the normal force until then.
    compression: Pack<S, K>,
    balance: Pack<S, K>,
    /// The most work that was taken so far, and the work that the restitution is to give back.
    taken: Pack<S, K>,
    due: Pack<S, K>,
    over: Mask<S, K>,
    /// Most by which to go on: a longer step was too long.
    limit: Pack<S, K>,
}

/// What ends the restitution.
#[derive(Clone, Copy)]
struct Goal<S: Simd, const K: usize> {
    hypothesis: Hypothesis,
    restitution: Pack<S, K>,
    /// |v_c^n| before the impact.
    approach: Pack<S, K>,
    /// ε_n|v_c^n|, Newton's goal.
    rebound: Pack<S, K>,
}

impl<S: Simd, const K: usize> Goal<S, K> {
    /// What is missing of the restitution: < 0 once it is over.
    #[inline(always)]
    fn missing(&self, at: &Course<S, K>) -> Pack<S, K> {
        match self.hypothesis {
            Hypothesis::Newton => self.rebound - at.v,
            Hypothesis::Poisson => {
                self.restitution.mul_add(at.compression, at.compression) - at.normal
            }
            Hypothesis::Stronge => at.due - at.work,
        }
    }
}

impl<S: Simd, const K: usize> Course<S, K> {
    /// Lane by lane one or the other.
    #[inline(always)]
    fn choose(mask: Mask<S, K>, a: &Self, b: &Self) -> Self {
        Self {
            u: mask.select(a.u, b.u),
            w: mask.select(a.w, b.w),
            slip: mask.select(a.slip, b.slip),
            a: mask.select(a.a, b.a),
            y: mask.select(a.y, b.y),
            mirror: mask.select(a.mirror, b.mirror),
            v: mask.select(a.v, b.v),
            normal: mask.select(a.normal, b.normal),
            along: mask.select(a.along, b.along),
            across: mask.select(a.across, b.across),
            work: mask.select(a.work, b.work),
            compressing: mask & a.compressing | !mask & b.compressing,
            compression: mask.select(a.compression, b.compression),
            balance: mask.select(a.balance, b.balance),
            taken: mask.select(a.taken, b.taken),
            due: mask.select(a.due, b.due),
            over: mask & a.over | !mask & b.over,
            limit: mask.select(a.limit, b.limit),
        }
    }

    /// |**s**|, A and y from u and w.
    #[inline(always)]
    fn direction(&mut self) {
        self.slip = self.u.mul_add(self.u, self.w * self.w).sqrt();
        let sum = self.slip + self.u.abs();
        let tangent = self.w / sum;
        let square = sum.eq(0.0).select(0.0, tangent * tangent);
        let back = self.u.lt(0.0);
        self.a = 0.5 * sum * back.select(square, 1.0);
        self.y = back.select(1.0 / square, square);
        self.w = self.w.le(self.slip * VANISHED).select(0.0, self.w);
    }

    /// Turns **u** round in the lanes of the mask.
    #[inline(always)]
    fn turn_round(&mut self, mask: Mask<S, K>, rates: &mut Rates<S, K>) {
        self.u = mask.select(-self.u, self.u);
        self.along = mask.select(-self.along, self.along);
        self.mirror = mask.select(-self.mirror, self.mirror);
        rates.turn(mask.select(-rates.nu, rates.nu));
    }

    /// Whether it has gone beyond the next event.
    #[inline(always)]
    fn is_late(&self, goal: &Goal<S, K>) -> Mask<S, K> {
        let zero = Pack::splat(self.v.simd(), 0.0);
        let done = self.v.lt(0.0) | goal.missing(self).le(0.0);
        self.compressing & zero.le(self.v) | !self.compressing & done
    }

    /// Ends the compression, of the lanes in the mask, where v_c^n = 0.
    #[inline(always)]
    fn turn_back(&mut self, mask: Mask<S, K>, goal: &Goal<S, K>) {
        // The balance begins anew, so that a little restitution is not lost in a large compression.
        let balance = self.balance + self.work;
        let taken = self.taken.max(-balance);
        let e = goal.restitution;
        let due = (e * e).mul_add(taken, -(taken + balance));
        self.balance = mask.select(balance, self.balance);
        self.taken = mask.select(taken, self.taken);
        self.due = mask.select(due, self.due);
        self.work = mask.select(0.0, self.work);
        self.v = mask.select(0.0, self.v);
        self.compression = mask.select(self.normal, self.compression);
        self.compressing = self.compressing & !mask;
    }

    /// The end of the impact, where the slip has come to rest: it sticks, or slips on the way that K_nu drives it.
    #[inline(always)]
    fn finish(&mut self, rates: &Rates<S, K>, goal: &Goal<S, K>) {
        let friction = (-rates.nu / rates.uu)
            .max(-rates.friction)
            .min(rates.friction);
        let sticks = rates.nu.abs().le(rates.uu * rates.friction);
        let slope = sticks.select(
            rates.sticking,
            rates.nu.abs().mul_add(-rates.friction, rates.nn),
        );
        let inverse = 1.0 / slope;
        let start = self.normal;

        let further = self.compressing.select(-self.v * inverse, 0.0);
        self.work = (0.5 * self.v).mul_add(further, self.work);
        self.normal = self.normal + further;
        self.turn_back(self.compressing, goal);
        let missing = goal.missing(self).max(0.0);
        let (v, rest) = match goal.hypothesis {
            Hypothesis::Newton => (self.v + missing, missing * inverse),
            Hypothesis::Poisson => (slope.mul_add(missing, self.v), missing),
            Hypothesis::Stronge => {
                let twice = 2.0 * missing;
                let v = self.v.mul_add(self.v, twice * slope).sqrt();
                let sum = v + self.v;
                (v, sum.eq(0.0).select(0.0, twice / sum))
            }
        };
        self.v = v;
        self.normal = self.normal + rest;
        self.along = (self.normal - start).mul_add(friction, self.along);
    }
}

/// Impacts under way, one in each lane.
#[derive(Clone, Copy)]
struct Impacts<S: Simd> {
    rates: Rates<S, 1>,
    goal: Goal<S, 1>,
    course: Course<S, 1>,
    /// Panels so far.
    panels: Pack<S, 1>,
    /// What the velocities are measured in.
    scale: Pack<S, 1>,
    /// By symmetry such a slip does not turn.
    aside: Mask<S, 1>,
    /// On which side **w** is.
    left: Mask<S, 1>,
}

impl<S: Simd> Impacts<S> {
    #[inline(always)]
    fn new(contact: &Slipping<S, 1>, friction: f64, hypothesis: Hypothesis) -> Self {
        let simd = contact.speed.simd();
        let zero = Pack::splat(simd, 0.0);
        let (along, across) = (contact.along, contact.across);
        let size = contact.speed + (along.abs() + across.abs());
        let scale = size.eq(0.0).select(1.0, size);
        let unit = 1.0 / scale;

        // Lanes without a particle may hold anything, and no end.
        let responses = contact.nn + (contact.uu + contact.ww);
        let strikes =
            zero.le(contact.speed) & (size + responses).lt(f64::INFINITY) & !across.eq(0.0);
        let course = Course {
            u: along * unit,
            w: across.abs() * unit,
            slip: zero,
            a: zero,
            y: zero,
            mirror: zero + 1.0,
            v: -contact.speed * unit,
            normal: zero,
            along: zero,
            across: zero,
            work: zero,
            compressing: Mask::splat(simd, true),
            compression: zero,
            balance: zero,
            taken: zero,
            due: zero,
            over: !strikes,
            limit: zero + f64::INFINITY,
        };
        Self {
            rates: Rates::new(contact, friction),
            goal: Goal {
                hypothesis,
                restitution: contact.restitution,
                approach: contact.speed * unit,
                rebound: contact.restitution * contact.speed * unit,
            },
            course,
            panels: zero,
            scale,
            aside: along.eq(0.0) & contact.nu.eq(0.0),
            left: across.lt(0.0),
        }
    }

    /// Ends the impacts whose slip vanishes before anything else happens.
    #[inline(always)]
    fn stop(&mut self) {
        let Self {
            rates,
            goal,
            course,
            panels,
            ..
        } = self;
        // **u** along the slip, or the way that K_nu drives it.
        let back = course.u.lt(0.0) | course.u.eq(0.0) & rates.nu.lt(0.0);
        course.turn_round(back, rates);
        course.direction();
        // Or against it, where it comes round and is nearer to the direction to which it turns: y then falls.
        let ahead = rates.plus.lt(0.0) & (rates.minus * course.y).le(rates.plus);
        let comes = ahead & !course.y.lt(ROUND);
        if comes.any() {
            course.turn_round(comes, rates);
            course.direction();
        }

        // What is left is a straight line in p where the slip has vanished, or goes on along **u** for ever.
        let straight = course.w.le(VANISHED) & rates.decay.le(0.0) & course.y.lt(1.0);
        let straight = straight & !course.is_late(goal);
        let vanished = course.slip.le(VANISHED) | straight | !panels.lt(MOST_PANELS);
        let stop = Stop::new(rates, course);
        let candidates = (stop.reached | vanished) & !course.over;
        if candidates.any() {
            let mut stopped = *course;
            let stops = stop.pass(rates, goal, &mut stopped) | vanished;
            let last = stops & candidates;
            let mut end = Course::choose(vanished, course, &stopped);
            end.finish(rates, goal);
            end.over = Mask::splat(panels.simd(), true);
            *course = Course::choose(last, &end, course);
        }
    }

    /// Contacts that are under way and whose slip hardly changes its direction any more.
    #[inline(always)]
    fn is_straight(&self) -> Mask<S, 1> {
        let Self {
            rates,
            goal,
            course,
            ..
        } = self;
        Tail::new(rates, course.y).leads(rates, goal, course)
    }

    /// Goes through the events of those.
    #[inline(always)]
    fn follow(&mut self) {
        let Self {
            rates,
            goal,
            course,
            ..
        } = self;
        let tail = Tail::new(rates, course.y);
        let lanes = tail.leads(rates, goal, course);
        if lanes.any() {
            tail.pass(rates, goal, lanes, course);
        }
    }

    /// Goes through the events that are near, and on by a panel.
    #[inline(always)]
    fn advance(&mut self) {
        let Self {
            rates,
            goal,
            course,
            ..
        } = self;
        let wanted = step::events(rates, goal, course);
        if course.over.all() {
            return;
        }
        course.direction();
        let path = Hodograph::new(rates, course.y);
        let length = wanted.min(course.limit).min(path.longest(rates, course));
        let mut next = panel::pass((rates, &path), goal, course, length);
        let (back, limit) = beyond(rates, goal, course, &next, length);
        next.limit = Pack::splat(limit.simd(), f64::INFINITY);
        let mut again = *course;
        again.limit = limit;
        let next = Course::choose(back, &again, &next);
        *course = Course::choose(course.over, course, &next);
        self.panels = self.panels + 1.0;
    }

    /// All numbers of them.
    #[inline(always)]
    fn packs(&mut self) -> [&mut Pack<S, 1>; 31] {
        let Self {
            rates: r,
            goal: g,
            course: c,
            panels,
            scale,
            ..
        } = self;
        [
            &mut r.nn,
            &mut r.nu,
            &mut r.uu,
            &mut r.ww,
            &mut r.sticking,
            &mut r.brake,
            &mut r.plus,
            &mut r.minus,
            &mut r.decay,
            &mut r.kappa,
            &mut g.restitution,
            &mut g.approach,
            &mut g.rebound,
            &mut c.u,
            &mut c.w,
            &mut c.slip,
            &mut c.a,
            &mut c.y,
            &mut c.mirror,
            &mut c.v,
            &mut c.normal,
            &mut c.along,
            &mut c.across,
            &mut c.work,
            &mut c.compression,
            &mut c.balance,
            &mut c.taken,
            &mut c.due,
            &mut c.limit,
            panels,
            scale,
        ]
    }

    /// All that is either so or not.
    #[inline(always)]
    fn masks(&mut self) -> [&mut Mask<S, 1>; 4] {
        let course = &mut self.course;
        [
            &mut course.compressing,
            &mut course.over,
            &mut self.aside,
            &mut self.left,
        ]
    }

    /// What came of them.
    #[inline(always)]
    fn answer(&self) -> Answer<S, 1> {
        let (course, scale) = (&self.course, self.scale);
        Answer {
            normal: course.normal * scale,
            along: self.aside.select(0.0, course.along * course.mirror * scale),
            across: self.left.select(-course.across, course.across) * scale,
            separation_speed: course.v.max(0.0) * scale,
        }
    }
}

/// The impulse of contacts that slip in any direction, μ > 0, unless it takes long: the lanes in which it is not known yet.
#[inline(always)]
pub(crate) fn begin<S: Simd>(
    contact: &Slipping<S, 1>,
    friction: f64,
    hypothesis: Hypothesis,
) -> (Answer<S, 1>, Mask<S, 1>) {
    let mut impacts = Impacts::new(contact, friction, hypothesis);
    impacts.stop();
    (impacts.answer(), !impacts.course.over)
}
