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

mod course;
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
use course::{Course, Goal, VANISHED};
use hodograph::Hodograph;
use pulp::Simd;
pub(super) use queue::finish;
use rates::Rates;
use step::beyond;
use stop::Stop;
use tail::Tail;

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
        // A plastic contact is not left: rounding must not end its stay.
        let plastic = self.goal.restitution.eq(0.0);
        Answer {
            normal: course.normal * scale,
            along: self.aside.select(0.0, course.along * course.mirror * scale),
            across: self.left.select(-course.across, course.across) * scale,
            separation_speed: plastic.select(0.0, course.v.max(0.0)) * scale,
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
