//! What the tests of the parts of an impact share: contacts, and the equation of the slip integrated by itself. How far a part
//! proposes to go does not show in the impulse, only in the number of steps it takes; each is therefore tested alone, too.

use super::{Course, Goal, Impacts, Rates, Slipping};
use crate::law::Hypothesis;
use crate::simd::{Pack, one};
use pulp::Scalar;

/// μ, K_nn, K_nu, K_uu, K_ww and the slip's direction φ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    pub friction: f64,
    pub nn: f64,
    pub nu: f64,
    pub uu: f64,
    pub ww: f64,
    pub direction: f64,
}

impl Case {
    /// At a slip of size `slip` that is measured in units of the contact velocity, `normal` its part along **n**.
    pub fn contact(&self, slip: f64, normal: f64) -> Slipping<Scalar, 1> {
        Slipping {
            speed: one(normal),
            along: one(slip * self.direction.cos()),
            across: one(slip * self.direction.sin()),
            nn: one(self.nn),
            nu: one(self.nu),
            uu: one(self.uu),
            ww: one(self.ww),
            restitution: one(0.5),
        }
    }

    /// The impact of [`Self::contact`].
    pub fn impacts(&self, slip: f64, normal: f64, hypothesis: Hypothesis) -> Impacts<Scalar> {
        let contact = self.contact(slip, normal);
        let mut impacts = Impacts::new(&contact, self.friction, hypothesis);
        impacts.course.direction();
        impacts
    }
}

/// The slip of a contact and its normal motion, as they change with θ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State {
    pub u: f64,
    pub w: f64,
    /// v_c^n, impulse along **n** and work of the normal force.
    pub v: f64,
    pub normal: f64,
    pub work: f64,
}

impl State {
    pub fn of(at: &Course<Scalar, 1>) -> Self {
        Self {
            u: value(at.u),
            w: value(at.w),
            v: value(at.v),
            normal: value(at.normal),
            work: value(at.work),
        }
    }

    fn slip(&self) -> f64 {
        self.u.hypot(self.w)
    }

    /// tan²(φ/2).
    pub fn y(&self) -> f64 {
        (self.w / (self.slip() + self.u)).powi(2)
    }

    /// d/dθ by Coulomb's law, dp = |**s**|(1 + y) dθ.
    fn rate(&self, k: &Rates<Scalar, 1>) -> [f64; 5] {
        let (slip, mu, nu) = (self.slip(), k.friction, value(k.nu));
        let (along, across) = (-mu * self.u / slip, -mu * self.w / slip);
        let pace = slip * (1.0 + self.y());
        [
            pace * (nu + value(k.uu) * along),
            pace * value(k.ww) * across,
            pace * (value(k.nn) + nu * along),
            pace,
            pace * self.v,
        ]
    }

    fn moved(&self, rate: [f64; 5], theta: f64) -> Self {
        Self {
            u: self.u + rate[0] * theta,
            w: self.w + rate[1] * theta,
            v: self.v + rate[2] * theta,
            normal: self.normal + rate[3] * theta,
            work: self.work + rate[4] * theta,
        }
    }

    /// After θ, by a thousand steps of Runge and Kutta's method.
    pub fn after(&self, k: &Rates<Scalar, 1>, theta: f64) -> Self {
        let step = theta / 1000.0;
        let mut now = *self;
        for _ in 0..1000 {
            let first = now.rate(k);
            let second = now.moved(first, step / 2.0).rate(k);
            let third = now.moved(second, step / 2.0).rate(k);
            let fourth = now.moved(third, step).rate(k);
            let mean = [0, 1, 2, 3, 4]
                .map(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0);
            now = now.moved(mean, step);
        }
        now
    }
}

pub(super) fn value(x: Pack<Scalar, 1>) -> f64 {
    x.as_slice()[0]
}

/// Puts the end of the restitution where the impact has come to `there`, which is later than `at`.
pub(super) fn end_at(goal: &mut Goal<Scalar, 1>, at: &mut Course<Scalar, 1>, there: &State) {
    goal.rebound = one(there.v);
    goal.restitution = one(1.0);
    at.compression = one(0.5 * there.normal);
    at.due = one(there.work);
}

/// A slip that never vanishes within the panels that an impact may take is taken to have vanished after the last.
#[test]
fn an_impact_ends_after_the_most_panels() {
    let case = Case {
        friction: 0.1,
        nn: 2.0,
        nu: 0.3,
        uu: 1.5,
        ww: 3.0,
        direction: 1.0,
    };
    let mut impacts = case.impacts(0.99, 0.01, Hypothesis::Newton);
    impacts.goal.rebound = one(f64::MAX);
    impacts.panels = one(super::MOST_PANELS - 1.0);
    impacts.stop();
    assert!(!impacts.course.over.any());
    impacts.advance();
    assert!(!impacts.course.over.any());
    impacts.stop();
    assert!(impacts.course.over.any());
}
