//! Coulomb friction where the slip turns: the contact slips across the plane of the axis, too. All lanes at once.
//!
//! With the slip **s** = (u, w), u taken along it, let A = (|**s**| + u)/2 and B = (|**s**| − u)/2, so that w² = 4AB, and
//! y = B/A = tan²(φ/2) with φ the direction of the slip. In θ with dp = |**s**|(1 + y) dθ the equation of the slip
//! d**s**/dp = K_nu **u** − μ K_t **s**/|**s**| reads
//!
//! dy/dθ = −2y(ρ₊ + ρ₋y), d ln A/dθ = −λ − κy, ρ± = K_nu ± μ(K_ww − K_uu), λ = μK_uu − K_nu, κ = μK_ww − ρ₋:
//!
//! 1/y is an exponential function of θ, and A is one of ∫(λ + κy) dθ. What is left are quadratures of functions that are
//! analytic next to the path ([`Panel`](panel::Panel)), and where the slip vanishes in a given direction, a power series
//! ([`Stop`](stop::Stop)). Wherever the slip has come to rest the rest of the impact is a straight line in p.

mod nodes;
mod panel;
mod polynomial;
mod stop;
mod values;
mod within;

use super::Hypothesis;
use crate::simd::{Mask, Pack};
use panel::Panel;
use pulp::Simd;
use stop::Stop;

/// Slip at which it counts as vanished, relative to the contact velocity; the impulse is of the order of that.
const VANISHED: f64 = 1.0 / 18_014_398_509_481_984.0; // 2⁻⁵⁴
/// Panels after which the slip is taken to have vanished.
const MOST_PANELS: usize = 1000;

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

/// K in the plane of **n** and the direction **u** along which the slip is positive, times μ where friction is.
#[derive(Clone, Copy)]
struct Rates<S: Simd, const K: usize> {
    friction: f64,
    nn: Pack<S, K>,
    nu: Pack<S, K>,
    uu: Pack<S, K>,
    ww: Pack<S, K>,
    /// K_nn − K_nu²/K_uu.
    sticking: Pack<S, K>,
    /// μK_ww.
    brake: Pack<S, K>,
    /// ρ₊, ρ₋, λ, κ.
    plus: Pack<S, K>,
    minus: Pack<S, K>,
    decay: Pack<S, K>,
    kappa: Pack<S, K>,
}

impl<S: Simd, const K: usize> Rates<S, K> {
    #[inline(always)]
    fn new(contact: &Slipping<S, K>, friction: f64) -> Self {
        let Slipping { nn, nu, uu, ww, .. } = *contact;
        let square = nu * nu;
        let lost = nu.mul_add(nu, -square);
        let determinant = nn.mul_add(uu, -square) - lost;
        let mut rates = Self {
            friction,
            nn,
            nu,
            uu,
            ww,
            sticking: determinant / uu,
            brake: ww * friction,
            plus: nu,
            minus: nu,
            decay: nu,
            kappa: nu,
        };
        rates.turn(nu);
        rates
    }

    /// Takes **u** so that this is K_nu.
    #[inline(always)]
    fn turn(&mut self, nu: Pack<S, K>) {
        let (a, b) = (self.uu * self.friction, self.brake);
        self.nu = nu;
        self.plus = nu + (b - a);
        self.minus = nu - (b - a);
        self.decay = a - nu;
        self.kappa = b - self.minus;
    }

    /// dv_c^n/dp times 1 + y.
    #[inline(always)]
    fn slope(&self, y: Pack<S, K>) -> Pack<S, K> {
        let jam = self.nu * self.friction;
        (self.nn + jam).mul_add(y, self.nn - jam)
    }
}

/// Where the impacts have come to.
#[derive(Clone, Copy)]
struct Course<S: Simd, const K: usize> {
    /// Slip u ≥ 0 and w ≥ 0, |**s**|, A, y.
    u: Pack<S, K>,
    w: Pack<S, K>,
    slip: Pack<S, K>,
    a: Pack<S, K>,
    y: Pack<S, K>,
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
    /// Whether something happens on the panel that was tried.
    careful: Mask<S, K>,
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
            careful: mask & a.careful | !mask & b.careful,
        }
    }

    /// |**s**|, A and y from u and w.
    #[inline(always)]
    fn direction(&mut self) {
        self.slip = self.u.mul_add(self.u, self.w * self.w).sqrt();
        let sum = self.slip + self.u;
        let tangent = self.w / sum;
        self.a = 0.5 * sum;
        self.y = sum.eq(0.0).select(0.0, tangent * tangent);
        self.w = self.w.le(self.slip * VANISHED).select(0.0, self.w);
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

/// The impulse of contacts that slip in any direction, μ > 0.
#[inline(always)]
pub(crate) fn turning<S: Simd, const K: usize>(
    contact: &Slipping<S, K>,
    friction: f64,
    hypothesis: Hypothesis,
) -> Answer<S, K> {
    let simd = contact.speed.simd();
    let zero = Pack::splat(simd, 0.0);
    let (along, across) = (contact.along, contact.across);
    let size = contact.speed + (along.abs() + across.abs());
    let scale = size.eq(0.0).select(1.0, size);
    let unit = 1.0 / scale;

    // Lanes without a particle may hold anything, and no end.
    let responses = contact.nn + (contact.uu + contact.ww);
    let strikes = zero.le(contact.speed) & (size + responses).lt(f64::INFINITY) & !across.eq(0.0);

    let mut rates = Rates::new(contact, friction);
    let goal = Goal {
        hypothesis,
        restitution: contact.restitution,
        approach: contact.speed * unit,
        rebound: contact.restitution * contact.speed * unit,
    };
    let mut course = Course {
        u: along * unit,
        w: across.abs() * unit,
        slip: zero,
        a: zero,
        y: zero,
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
        careful: Mask::splat(simd, false),
    };
    // By symmetry such a slip does not turn.
    let aside = along.eq(0.0) & contact.nu.eq(0.0);
    let mut mirror = Pack::splat(simd, 1.0);
    for number in 0..=MOST_PANELS {
        // **u** along the slip, or the way that K_nu drives it.
        let back = course.u.lt(0.0) | course.u.eq(0.0) & rates.nu.lt(0.0);
        course.u = course.u.abs();
        course.along = back.select(-course.along, course.along);
        mirror = back.select(-mirror, mirror);
        rates.turn(back.select(-rates.nu, rates.nu));
        course.direction();

        let vanished = course.slip.le(VANISHED) | Mask::splat(simd, number == MOST_PANELS);
        let stop = Stop::new(&rates, &course);
        let candidates = (stop.reached | vanished) & !course.over;
        if candidates.any() {
            let mut stopped = course;
            let stops = stop.pass(&rates, &goal, &mut stopped) | vanished;
            let last = stops & candidates;
            let mut end = Course::choose(vanished, &course, &stopped);
            end.finish(&rates, &goal);
            end.over = Mask::splat(simd, true);
            course = Course::choose(last, &end, &course);
        }
        if course.over.all() {
            break;
        }
        let panel = Panel::new(&rates, &course, &goal);
        let next = panel.pass(&rates, &goal, &course);
        course = Course::choose(course.over, &course, &next);
    }
    Answer {
        normal: course.normal * scale,
        along: aside.select(0.0, course.along * mirror * scale),
        across: across.lt(0.0).select(-course.across, course.across) * scale,
        separation_speed: course.v.max(0.0) * scale,
    }
}
