//! The parts of an impact, each by itself: how far a part proposes to go does not show in the impulse, only in the number of steps it
//! takes. They share contacts, and the equation of the slip integrated by itself.

use super::*;
use crate::simd::one;
use pulp::Scalar;

/// μ, K_nn, K_nu, K_uu, K_ww and the slip's direction φ.
#[derive(Clone, Copy, Debug)]
struct Case {
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
    pub fn impacts(
        &self,
        slip: f64,
        normal: f64,
        hypothesis: Hypothesis,
    ) -> OngoingImpacts<Scalar> {
        let contact = self.contact(slip, normal);
        let mut impacts = OngoingImpacts::new(&contact, self.friction, hypothesis);
        impacts.course.direction();
        impacts
    }
}

/// The slip of a contact and its normal motion, as they change with θ.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SlipState {
    pub u: f64,
    pub w: f64,
    /// v_c^n, impulse along **n** and work of the normal force.
    pub v: f64,
    pub normal: f64,
    pub work: f64,
}

impl SlipState {
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

fn value(x: Pack<Scalar, 1>) -> f64 {
    x.as_slice()[0]
}

/// Puts the end of the restitution where the impact has come to `there`, which is later than `at`.
fn end_at(goal: &mut Goal<Scalar, 1>, at: &mut Course<Scalar, 1>, there: &SlipState) {
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
    impacts.origin.panels = one(MOST_PANELS - 1.0);
    impacts.stop();
    assert!(!impacts.course.over.any());
    impacts.advance();
    assert!(!impacts.course.over.any());
    impacts.stop();
    assert!(impacts.course.over.any());
}

mod hodograph {
    use super::*;

    const FRICTION: f64 = 0.1;

    /// A slip of this size and with this y, where K_uu, K_ww and K_nu/μ are `a`, `b` and `nu`.
    fn case(a: f64, b: f64, nu: f64, y: f64) -> Case {
        Case {
            friction: FRICTION,
            nn: 1.0,
            nu: nu * FRICTION,
            uu: a,
            ww: b,
            direction: 2.0 * y.sqrt().atan(),
        }
    }

    /// The longest panel, times μ.
    fn resolved(a: f64, b: f64, nu: f64, slip: f64, y: f64) -> f64 {
        let impacts = case(a, b, nu, y).impacts(slip, 1.0 - slip, Hypothesis::Newton);
        let path = Hodograph::new(&impacts.rates, impacts.course.y);
        FRICTION * value(path.longest(&impacts.rates, &impacts.course))
    }

    fn near(x: f64, y: f64) {
        assert!((x - y).abs() < 1e-9 * y, "{x} {y}");
    }

    /// Where one of the functions alone limits it, it changes on the longest panel by as much as the rule says.
    #[test]
    fn a_panel_is_as_long_as_its_functions_are_resolved() {
        // d ln A/dθ = −λ where y = 0.
        near(resolved(1.0, 2.0, 0.3, 0.5, 0.0) * 0.7, 14.0);
        near(resolved(1.0, 2.0, 1.7, 0.5, 0.0) * 0.7, 14.0);
        near(resolved(1.0, 2.0, 0.3, 1e-7, 0.0) * 0.7, 28.0);
        // d ln y/dθ = −2ρ₊ where ρ₋ = 0: with b = 2a and K_nu = a λ = 0, too, and κ = 2a.
        near(resolved(1.0, 2.0, 1.0, 0.5, 1e-8) * 4.0, 30.0);
        near(resolved(1.0, 2.0, 1.0, 0.5, 1e-3) * 4.0, 14.0);
        near(resolved(1.0, 2.0, 1.0, 0.5, 0.1) * 4.0, 8.0);
        // d ln w/dθ = −μK_ww(1 + y) where ρ₊ = κ = 0, at a slip so small that A may change more.
        near(resolved(1.5, 1.0, 0.5, 1e-7, 1e-5) * 2.0, 32.0);
        // κy beside λ, six times, where the direction all but stays.
        let (d, y) = (0.01, 0.1);
        near(
            resolved(1.0, 1.0 - d, -d, 0.5, y) * (1.0 + d + 6.0 * y * (1.0 - d)),
            14.0,
        );
    }

    /// Poles on the path behind the start and ahead of it, and beside it, from both fixed points: their distances from the ends of what
    /// counts as resolved are 1.6 times its length, but for the bound of the logarithm, at most a third less for |ln E| < 7.
    #[test]
    fn a_panel_keeps_away_from_the_poles() {
        let mut met = [0; 4];
        for (a, b, nu) in [
            (1.0, 1.3, 0.1),
            (1.0, 1.3, 0.5),
            (1.3, 1.0, 0.1),
            (1.3, 1.0, 0.5),
            (1.0, 1.3, -0.1),
            (1.0, 1.3, -0.5),
            (1.3, 1.0, -0.1),
            (1.3, 1.0, -0.5),
        ] {
            for y in [0.01, 0.2, 0.45, 0.55, 0.9, 3.0] {
                let case = case(a, b, nu, y);
                let impacts = case.impacts(0.5, 0.5, Hypothesis::Newton);
                let path = Hodograph::new(&impacts.rates, impacts.course.y);
                let length = value(path.resolved());
                let (plus, minus) = (value(impacts.rates.plus), value(impacts.rates.minus));
                let ratio: f64 = 1.0 + plus / (minus * y);
                if ratio.abs() < 1e-9 {
                    continue; // y = y*
                }
                let real = -ratio.abs().ln() / (2.0 * plus);
                let beside = if ratio < 0.0 { PI / (2.0 * plus) } else { 0.0 };
                let sum = (real - length).hypot(beside) + real.hypot(beside);
                let share = sum / (1.6 * length);
                assert!((0.999..1.5).contains(&share), "{share} {ratio} {case:?}");
                met[usize::from(ratio < 0.0) + 2 * usize::from(real > 0.0)] += 1;
            }
        }
        assert!(met.iter().all(|&times| times > 0), "{met:?}");
    }

    /// 2σθ is at least 8 tanh(x/8) where x = −ln(1 − t) is what it should be: undone, 1 − e^{−x} is t.
    #[test]
    fn a_way_is_bounded_by_a_hyperbolic_tangent() {
        for sigma in [0.3, -0.3, 7.0, -7.0] {
            for distance in [0.2, -0.2, 3.0, -3.0] {
                for t in [1e-6, 0.3, 0.9, 0.99999, -1e-6, -0.5, -20.0, -1e5] {
                    if t * sigma < 0.0 {
                        continue; // ζ has the sign of D
                    }
                    let zeta = t * distance / sigma;
                    let theta = value(reach(one(sigma), one(distance), one(zeta)));
                    let way = 8.0 * (0.25 * sigma * theta).atanh();
                    assert!(
                        (-(-way).exp_m1() - t).abs()
                            < 1e-13 * t.abs().max(1.0) * way.abs().max(1.0),
                        "{t} {way}"
                    );
                }
                let zeta = distance / sigma;
                for beyond in [1.0, 1.1, 1e9] {
                    let theta = reach(one(sigma), one(distance), one(beyond * zeta));
                    assert_eq!(value(theta), f64::INFINITY);
                }
            }
        }
    }

    /// As far as the series of artanh goes, |s| ≤ 0.45, and y has grown by no more than 8 as if its growth were exponential; where the way
    /// to there is bounded by a hyperbolic tangent, that undone.
    #[test]
    fn a_panel_ends_where_the_series_does() {
        let mut met = [0; 4];
        for (a, b, nu) in [
            (1.0, 1.3, 0.1),
            (1.0, 1.3, -0.5),
            (1.3, 1.0, 0.5),
            (1.3, 1.0, -0.1),
            (1.0, 3.0, 0.5),
            (3.0, 1.0, -1.9),
            (3.0, 1.0, 0.5),
            (1.0, 3.0, -0.5),
        ] {
            for y in [0.01, 0.2, 0.45, 0.55, 0.9, 3.0] {
                let case = case(a, b, nu, y);
                let impacts = case.impacts(0.5, 0.5, Hypothesis::Newton);
                let path = Hodograph::new(&impacts.rates, impacts.course.y);
                let (sigma, distance) = (value(path.sigma), value(path.distance));
                let used = |theta: f64| {
                    let zeta = -distance * (-2.0 * sigma * theta).exp_m1() / sigma;
                    let q = value(path.minus) * zeta;
                    [
                        q / (2.0 + q) / 0.45,
                        q / (2.0 + q) / -0.45,
                        -sigma * zeta / 8.0,
                    ]
                };
                let end = value(path.steep());
                let way = if end.is_finite() {
                    4.0 * (0.25 * sigma * end).atanh() / sigma
                } else {
                    20.0 / sigma.abs()
                };
                let most = used(way).into_iter().fold(0.0, f64::max);
                if end.is_finite() {
                    assert!((most - 1.0).abs() < 1e-12, "{most} {case:?}");
                    met[used(way).iter().position(|&share| share == most).unwrap()] += 1;
                } else {
                    assert!(most < 1.0, "{most} {case:?}");
                    met[3] += 1;
                }
            }
        }
        assert!(met.iter().all(|&times| times > 0), "{met:?}");
    }

    /// Where the hodograph is followed as far as it is resolved, or nearly, it is what the equation of the slip gives, next to either
    /// fixed point and on either side of it, but for the error of a thousand steps of Runge and Kutta's method where A changes by e¹⁴; and
    /// y grows by 8 at most.
    #[test]
    fn the_hodograph_is_that_of_the_equation_of_the_slip() {
        for (a, b, nu) in [
            (1.0, 3.0, 0.5),
            (3.0, 1.0, 0.5),
            (1.0, 3.0, -0.5),
            (3.0, 1.0, -0.5),
        ] {
            for y in [0.01, 0.3, 0.45, 0.55, 0.6, 0.62, 0.9] {
                let case = case(a, b, nu, y);
                let impacts = case.impacts(0.5, 0.5, Hypothesis::Newton);
                let (rates, at) = (impacts.rates, impacts.course);
                let path = Hodograph::new(&rates, at.y);
                let theta = path.longest(&rates, &at);
                let there = SlipState::of(&at).after(&rates, value(theta));
                let point = path.at(theta);
                let found = value(at.y - point.lost);
                assert!((found - there.y()).abs() < 1e-9, "{found} {case:?}");
                assert!(found - y < 8.0 + 1e-12, "{found} {case:?}");
                let size = value(at.a) * value(point.growth).exp();
                let a = 0.5 * (there.u.hypot(there.w) + there.u);
                assert!((size - a).abs() < 1e-7 * a, "{size} {a} {case:?}");
            }
        }
    }
}

mod series {
    use super::*;

    fn series(terms: [f64; ORDER]) -> Polynomial<Scalar, 1> {
        Polynomial(terms.map(one))
    }

    fn value(x: Pack<Scalar, 1>) -> f64 {
        x.as_slice()[0]
    }

    /// Polynomials of the sixth degree, whose slopes change by a fifth up to there.
    #[test]
    fn a_polynomial_takes_its_value_where_it_does() {
        for (terms, x) in [
            ([1.0, -0.2, 0.05, 0.02, -0.01, 0.01], 0.5),
            ([1.5, 0.1, 0.1, 0.1, 0.1, 0.1], 0.5_f64),
            ([-1.2, 0.1, 0.1, 0.0, 0.1, -0.1], -0.5),
        ] {
            let target: f64 = (0..ORDER).map(|k| terms[k] * x.powi(k as i32 + 1)).sum();
            let slope: f64 = (0..ORDER)
                .map(|k| (k + 1) as f64 * terms[k] * x.powi(k as i32))
                .sum();
            let path = series(terms);
            assert!((value(path.at(one(x))) - target).abs() < 1e-15);
            let root = path.reaches(one(target), one(0.0), one(terms[0]));
            let step = value(root.step);
            assert!(step.abs() < 1e-4 && (value(root.x) - x).abs() < step * step + 1e-15);
            assert!((value(root.slope) - slope).abs() < 1e-4);
        }
    }

    /// Just beyond an extremum two roots are close together, and Newton's steps must begin at the one that is ahead; for a
    /// parabola the first guess is the root.
    #[test]
    fn a_root_beyond_an_extremum_is_the_one_ahead() {
        let path = series([-1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        let lowest = one(0.5);
        for ahead in [1e-4, 1e-3, 0.1] {
            let target = path.at(lowest) + ahead * ahead;
            let root = path.reaches(target, lowest, one(0.0));
            assert!((value(root.x) - 0.5 - ahead).abs() < 1e-12, "{ahead}");
            assert!(value(root.step).abs() < 1e-11);
        }
    }

    #[test]
    fn what_is_left_out_grows_with_the_seventh_power() {
        let path = series([1.0, 2.0, 4.0, 8.0, -16.0, 32.0]);
        assert_eq!(value(path.rest()), 48.0);
        assert_eq!(value(power(one(2.0))), 128.0);
        assert_eq!(value(power(one(3.0))), 2187.0);
        assert_eq!(value(power(one(-2.0))), 128.0);
    }
}

mod step {
    use super::*;

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
                let gained = SlipState::of(&at).after(&rates, theta).v - value(at.v);

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
                let there = SlipState::of(&at).after(&rates, theta);
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
                    let start = SlipState::of(&at);
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
        (rates, goal): (&Rates<Scalar, 1>, &Goal<Scalar, 1>),
        at: &Course<Scalar, 1>,
        share: f64,
    ) {
        let length = 2.0 / value(rates.pace(at.y));
        let path = Hodograph::new(rates, at.y);
        let end = integrate_panel((rates, &path), goal, at, one(length));
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
                    let gained = SlipState::of(&at).after(&rates, way).v - value(at.v);
                    assert_eq!(gained < 0.0, nn < 1.0); // a jam

                    if gained > 0.0 {
                        at.v = one(-gained);
                        behind((&rates, &goal), &at, share);
                    }
                    at.compressing = !at.compressing;
                    at.v = one(0.4);
                    let there = SlipState::of(&at).after(&rates, way);
                    end_at(&mut goal, &mut at, &there);
                    if gained > 0.0 || hypothesis != Hypothesis::Newton {
                        behind((&rates, &goal), &at, share);
                    }
                    if gained < 0.0 {
                        // The end of a jam, before that of the restitution or with it.
                        at.v = one(-gained);
                        let there = SlipState::of(&at).after(&rates, way);
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

mod stop {
    use super::*;

    /// Closed as if it went on without change the fraction is closer, twice at least, than if it is cut off, beside the impulse until
    /// the slip vanishes that the equation of the slip gives; of ways on which it has not converged.
    #[test]
    fn a_fraction_that_is_closed_is_closer_than_one_that_is_cut_off() {
        for (nu, uu, ww, y) in [
            (0.5, 1.1, 3.6, 1.3_f64),
            (-0.4, 1.3, 5.0, 0.7),
            (0.2, 1.2, 3.9, 1.0),
            (0.0, 3.0, 1.2, 0.1),
            (0.1, 3.0, 1.2, 0.2),
            (0.3, 4.0, 1.2, 0.1),
        ] {
            let case = Case {
                friction: 1.0,
                nn: 2.0,
                nu,
                uu,
                ww,
                direction: 2.0 * y.sqrt().atan(),
            };
            let impacts = case.impacts(0.5, 0.5, Hypothesis::Newton);
            let (rates, at) = (impacts.rates, impacts.course);
            let stop: VanishingSlip<Scalar, 1> = VanishingSlip::new(&rates, &at);
            assert!(stop.reached.any());
            let mut there = SlipState::of(&at);
            while there.u.hypot(there.w) > 1e-12 {
                there = there.after(&rates, 2.0 / value(rates.pace(at.y)));
            }
            let off = stop.levels(1.0).map(|levels| {
                let (impulse, whole) = stop.impulse(&levels);
                (value(stop.a * stop.unit * impulse / whole) / there.normal - 1.0).abs()
            });
            assert!(off[1] < 1e-7 && off[0] < 0.5 * off[1], "{off:?} {case:?}");
        }
    }
}

mod tail {
    use super::*;

    const HYPOTHESES: [Hypothesis; 3] =
        [Hypothesis::Stronge, Hypothesis::Poisson, Hypothesis::Newton];

    /// μ, K_nn, K_nu, K_uu and K_ww: directions of slip that attract along **u** (the first four) and obliquely, where ρ₊ < 0 < ρ₋; of
    /// both kinds slips that grow, and κ of either sign.
    const RESPONSES: [[f64; 5]; 7] = [
        [0.3, 1.5, 0.2, 1.3, 2.1],
        [0.5, 1.5, 0.0, 1.3, 2.1],
        [0.3, 1.5, 0.9, 2.0, 1.3],
        [0.2, 1.5, -0.1, 1.2, 2.9],
        [0.7, 1.5, 0.0, 2.4, 1.1],
        [0.3, 1.5, 0.3, 2.9, 1.1],
        [0.6, 1.5, -0.35, 2.4, 1.1],
    ];

    /// Slips whose direction is off the attracting one by this share of what the sums may have, as far as that is possible.
    fn slips(share: f64, hypothesis: Hypothesis) -> Vec<OngoingImpacts<Scalar>> {
        slips_of(1.0, share, hypothesis)
    }

    /// Those of bodies of that mass.
    fn slips_of(mass: f64, share: f64, hypothesis: Hypothesis) -> Vec<OngoingImpacts<Scalar>> {
        let slip = |[friction, rest @ ..]: [f64; 5]| {
            let [nn, nu, uu, ww] = rest.map(|k| k / mass);
            let tilt = friction * (ww - uu);
            let (plus, minus) = (nu + tilt, nu - tilt);
            let sigma = plus.abs();
            let limit = if plus < 0.0 { -plus / minus } else { 0.0 };
            let kappa = friction * ww - minus;
            let most = (sigma * BEND / minus.abs()).min(2.0 * sigma * PULL / kappa.abs());
            // ζ = D/(1 + ρ₋D/σ).
            let zeta = share * most;
            let y: f64 = limit + zeta / (1.0 - minus * zeta / sigma);
            let case = Case {
                friction,
                nn,
                nu,
                uu,
                ww,
                direction: 2.0 * y.sqrt().atan(),
            };
            (y > 0.0).then(|| case.impacts(0.8, 0.3, hypothesis))
        };
        RESPONSES.into_iter().filter_map(slip).collect()
    }

    fn tail(impacts: &OngoingImpacts<Scalar>) -> Tail<Scalar, 1> {
        Tail::new(&impacts.rates, impacts.course.y)
    }

    fn near(a: f64, b: f64, allowed: f64) {
        assert!((a - b).abs() <= allowed, "{a} {b} {allowed:e}");
    }

    /// Some thousand steps of Runge and Kutta's method leave some roundings of each.
    fn agrees(found: &Course<Scalar, 1>, w: f64, expected: &SlipState) {
        let allowed = 1e-12;
        near(value(found.u), expected.u, allowed);
        near(w, expected.w, allowed);
        near(value(found.v), expected.v, allowed);
        near(value(found.normal), expected.normal, allowed);
        near(value(found.work), expected.work, allowed);
    }

    /// Slip, normal velocity, impulse and work are those of the equation of the slip, after a short way and a long one, and after both.
    #[test]
    fn the_sums_are_the_slip() {
        for share in [-0.999, -0.3, 0.01, 0.999] {
            let all = slips(share, Hypothesis::Stronge);
            assert_eq!(all.len(), if share < 0.0 { 3 } else { 7 });
            for OngoingImpacts {
                rates,
                goal,
                course: from,
                ..
            } in all
            {
                let mut tail = Tail::new(&rates, from.y);
                assert!(tail.straight.all());
                let mut sums = tail.sums(&rates, Hypothesis::Stronge);
                let start = SlipState::of(&from);
                let near_by = 0.05 / value(tail.sigma);
                for theta in [near_by, 10.0 * near_by, 40.0 * near_by] {
                    let found = tail.at(&rates, &goal, &sums, &from, one(theta));
                    let lost = tail.braked(&rates, from.w, one(theta));
                    let mut expected = start;
                    for _ in 0..8 {
                        expected = expected.after(&rates, theta / 8.0);
                    }
                    agrees(&found, value(from.w + lost), &expected);
                }
                let mut then = tail.at(&rates, &goal, &sums, &from, one(near_by));
                then.w = from.w + tail.braked(&rates, from.w, one(near_by));
                tail.forward(&mut sums, one(near_by));
                let found = tail.at(&rates, &goal, &sums, &then, one(near_by));
                let lost = tail.braked(&rates, then.w, one(near_by));
                let expected = start.after(&rates, 2.0 * near_by);
                agrees(&found, value(then.w + lost), &expected);
            }
        }
    }

    /// ln w falls by μK_ww(θ + ∫y dθ), and ∫D dθ = ζ₀/2wσ ln((1 − wE)/(1 − w)), here with w for the bend.
    #[test]
    fn the_slip_across_is_braked() {
        for share in [-0.999, 0.5, 0.999] {
            for impacts in slips(share, Hypothesis::Newton) {
                let tail = tail(&impacts);
                let [sigma, zeta, bend] = [tail.sigma, tail.zeta, tail.bend].map(value);
                for theta in [0.01 / sigma, 0.3 / sigma, 1.0 / sigma] {
                    let e = (-2.0 * sigma * theta).exp();
                    let mean = if bend == 0.0 {
                        1.0 - e
                    } else {
                        ((-bend * e).ln_1p() - (-bend).ln_1p()) / bend
                    };
                    let whole = (1.0 + value(tail.limit)) * theta + zeta / (2.0 * sigma) * mean;
                    let lost = tail.braked(&impacts.rates, one(1.0), one(theta));
                    near(
                        value(lost).ln_1p(),
                        -value(impacts.rates.brake) * whole,
                        1e-14,
                    );
                }
            }
        }
    }

    /// The next event is where the slip has come to when v_c^n = 0, then the end of the restitution; of bodies of any mass, and of no
    /// contact that is not asked for.
    #[test]
    fn both_events_are_found() {
        for hypothesis in HYPOTHESES {
            for (mass, share) in [(1.0, -0.9), (1024.0, 0.05), (1.0 / 1024.0, 0.9)] {
                for impacts in slips_of(mass, share, hypothesis) {
                    let OngoingImpacts {
                        rates,
                        mut goal,
                        mut course,
                        ..
                    } = impacts;
                    let start = SlipState::of(&course);
                    let way = 0.2 / value(rates.pace(course.y));
                    course.v = one(value(course.v) - start.after(&rates, way).v);
                    let start = SlipState::of(&course);
                    let (turned, end) = (start.after(&rates, way), start.after(&rates, 1.5 * way));
                    near(turned.v, 0.0, 1e-14);
                    goal.rebound = one(end.v);
                    match hypothesis {
                        Hypothesis::Newton => {}
                        Hypothesis::Poisson => {
                            goal.restitution = one(end.normal / turned.normal - 1.0);
                        }
                        Hypothesis::Stronge => {
                            let square = 1.0 - end.work / turned.work;
                            goal.restitution = one(square.sqrt());
                        }
                    }
                    let mut impacts = OngoingImpacts {
                        rates,
                        goal,
                        course,
                        ..impacts
                    };
                    assert!(impacts.is_straight().all());
                    let nowhere = !impacts.is_straight();
                    tail(&impacts).pass(&rates, &goal, nowhere, &mut course);
                    assert_eq!(SlipState::of(&course), start);
                    assert!(course.compressing.all() && !course.over.any());

                    impacts.follow();
                    let course = impacts.course;
                    assert!(course.over.all());
                    near(value(course.compression), turned.normal, 1e-13 * mass);
                    near(value(course.v), end.v, 1e-12);
                    near(value(course.normal), end.normal, 1e-12 * mass);
                    near(
                        value(course.across) * value(rates.ww),
                        end.w - start.w,
                        1e-12,
                    );
                    let along = end.v - start.v - value(rates.nn) * end.normal;
                    near(value(course.along) * value(rates.nu), along, 1e-12);
                }
            }
        }
    }

    /// Where the direction still turns, where friction may jam, beyond an event and of what is over nothing is known.
    #[test]
    fn other_contacts_are_left_as_they_are() {
        for hypothesis in HYPOTHESES {
            for impacts in slips(1.001, hypothesis) {
                assert!(!tail(&impacts).straight.any());
            }
            for impacts in slips(0.5, hypothesis) {
                let leads = |change: &dyn Fn(&mut OngoingImpacts<Scalar>)| {
                    let mut changed = impacts;
                    change(&mut changed);
                    let OngoingImpacts {
                        rates,
                        goal,
                        course,
                        ..
                    } = changed;
                    tail(&changed).leads(&rates, &goal, &course).all()
                };
                assert!(leads(&|_| ()));
                assert!(!leads(&|at| at.course.over = !at.course.over));
                assert!(!leads(&|at| at.course.v = one(0.0)));
                // Where K_nn = 0, dv_c^n/dp = −μK_nu(1 − y)/(1 + y).
                let (nu, limit) = (value(impacts.rates.nu), value(tail(&impacts).limit));
                let rises = |y: f64| nu * (y - 1.0) > 0.0;
                let both = rises(limit) && rises(value(impacts.course.y));
                assert_eq!(leads(&|at| at.rates.nn = one(0.0)), both);
                // v_c^n rises at one end of the way and falls at the other.
                let between = 0.5 * (limit + value(impacts.course.y));
                let jam = impacts.rates.friction * nu;
                let nn = jam * (1.0 - between) / (1.0 + between);
                assert!(!leads(&|at| at.rates.nn = one(nn)));
                let stronge = hypothesis == Hypothesis::Stronge;
                let slides = nu != 0.0;
                assert_eq!(
                    leads(&|at| at.goal.approach = one(1e-3)),
                    !(stronge && slides)
                );
            }
        }
    }

    /// A slip that vanishes before the next event is left to those who know how it vanishes.
    #[test]
    fn a_slip_that_vanishes_is_not_followed() {
        for hypothesis in HYPOTHESES {
            for impacts in slips(0.5, hypothesis) {
                let OngoingImpacts {
                    rates,
                    mut goal,
                    mut course,
                    ..
                } = impacts;
                if value(rates.decay) <= 0.0 {
                    continue;
                }
                course.v = one(-1e3);
                goal.approach = one(1e3);
                let before = SlipState::of(&course);
                let tail = tail(&impacts);
                let lanes = tail.leads(&rates, &goal, &course);
                assert!(lanes.all());
                tail.pass(&rates, &goal, lanes, &mut course);
                assert_eq!(SlipState::of(&course), before);
                assert!(course.compressing.all() && !course.over.any());
            }
        }
    }

    /// The end of the restitution alone.
    #[test]
    fn a_restitution_ends_where_it_should() {
        for hypothesis in HYPOTHESES {
            for impacts in slips(0.7, hypothesis) {
                let OngoingImpacts {
                    rates,
                    mut goal,
                    mut course,
                    ..
                } = impacts;
                course.v = one(0.1);
                course.compressing = !course.compressing;
                let way = 0.3 / value(rates.pace(course.y));
                let end = SlipState::of(&course).after(&rates, way);
                end_at(&mut goal, &mut course, &end);
                let tail = tail(&impacts);
                let lanes = tail.leads(&rates, &goal, &course);
                assert!(lanes.all());
                tail.pass(&rates, &goal, lanes, &mut course);
                assert!(course.over.all());
                near(value(course.v), end.v, 1e-12);
                near(value(course.normal), end.normal, 1e-12);
            }
        }
    }
}

mod queue_of_contacts {
    use super::super::queue::*;
    use super::*;

    /// Two contacts with this angle between the slip and the direction that attracts it.
    fn contacts(direction: f64) -> (Vec<Pending<Scalar>>, f64) {
        let case = Case {
            friction: 0.3,
            nn: 1.5,
            nu: 0.2,
            uu: 1.3,
            ww: 2.1,
            direction,
        };
        let nothing = Pending::none(Scalar::new());
        let pending = Pending {
            open: one(1.0),
            slipping: case.contact(0.8, 0.3),
            ..nothing
        };
        (vec![pending; 2], case.friction)
    }

    /// A contact whose direction hardly turns goes to the other lanes and leaves its own; these begin when they are needed for another
    /// one, or nothing else is left.
    #[test]
    fn straight_contacts_wait_for_one_another() {
        let hypothesis = Hypothesis::Poisson;
        let (mut pending, friction) = contacts(0.01);
        let (mut both, _) = contacts(0.01);
        let answers =
            |pending: &[Pending<Scalar>]| [0, 1].map(|i| value(pending[i].response.impulse.normal));
        let mut waiting = Waiting::default();
        let mut turning = TurningLanes::new(&pending, friction, hypothesis);
        let mut straight = turning;
        for answered in [false, true] {
            turning.begin(&mut waiting, &pending);
            turning.impacts.stop();
            turning.hand_over(&mut straight, &mut pending);
            assert!(turning.is_empty() && !straight.is_empty());
            assert_eq!(
                answers(&pending).map(|normal| normal > 0.0),
                [answered, false]
            );
        }
        straight.finish(&mut pending);
        assert!(straight.is_empty());
        let [one, other] = answers(&pending);
        assert_eq!(one, other);
        finish(&mut both, friction, hypothesis);
        assert_eq!(answers(&both), [one, one]);
    }

    #[test]
    fn turning_contacts_are_not_handed_over() {
        let (mut pending, friction) = contacts(1.0);
        let mut waiting = Waiting::default();
        let mut turning = TurningLanes::new(&pending, friction, Hypothesis::Poisson);
        let mut straight = turning;
        turning.begin(&mut waiting, &pending);
        turning.impacts.stop();
        turning.hand_over(&mut straight, &mut pending);
        assert!(!turning.is_empty() && straight.is_empty());
    }
}
