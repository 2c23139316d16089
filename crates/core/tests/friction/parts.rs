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
    /// The impact at a slip of size `slip` that is measured in units of the contact velocity, `normal` its part along **n**.
    pub fn impacts(
        &self,
        slip: f64,
        normal: f64,
        hypothesis: Hypothesis,
    ) -> OngoingImpacts<Scalar> {
        let mut contact = Contact::none(Scalar::new());
        let (sine, cosine) = self.direction.sin_cos();
        contact.velocity = Vector::new(slip * cosine, slip * sine, -normal).in_lane();
        let rule = Coulomb::new(self.friction, hypothesis).unwrap();
        let mut impacts = OngoingImpacts::new(&contact, one(0.5), &rule);
        let response = [self.nn, self.nu, self.uu, self.ww].map(one);
        impacts.rates = Rates::new(response, self.friction);
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
    pub fn of(at: &Course<Scalar>) -> Self {
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
    fn rate(&self, k: &Rates<Scalar>) -> [f64; 5] {
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
    pub fn after(&self, k: &Rates<Scalar>, theta: f64) -> Self {
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

fn value(x: Pack<Scalar>) -> f64 {
    x.as_slice()[0]
}

/// Puts the end of the restitution where the impact has come to `there`, which is later than `at`.
fn end_at(goal: &mut Goal<Scalar>, at: &mut Course<Scalar>, there: &SlipState) {
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
    impacts.panels = one(MOST_PANELS - 1.0);
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

    fn series(terms: [f64; ORDER]) -> Polynomial<Scalar> {
        Polynomial(terms.map(one))
    }

    fn value(x: Pack<Scalar>) -> f64 {
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

    /// Whether events that are behind the end of a way of Rθ = 2 count as far.
    fn behind((rates, goal): (&Rates<Scalar>, &Goal<Scalar>), at: &Course<Scalar>, share: f64) {
        let length = 2.0 / value(rates.pace(at.y));
        let path = Hodograph::new(rates, at.y);
        let end = integrate_panel((rates, &path), goal, at, one(length));
        let back = beyond(rates, goal, at, &end, one(length));
        // Events that are up to x = 1/2 behind are left to the series.
        assert_eq!(back.any(), share < 0.75, "{share}");
    }

    #[test]
    fn a_step_far_beyond_an_event_is_repeated() {
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
            let stop: VanishingSlip<Scalar> = VanishingSlip::new(&rates, &at);
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
