use super::super::Impacts;
use super::super::testing::{Case, State, end_at, value};
use super::*;
use crate::simd::one;
use pulp::Scalar;

const HYPOTHESES: [Hypothesis; 3] = [Hypothesis::Stronge, Hypothesis::Poisson, Hypothesis::Newton];

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
fn slips(share: f64, hypothesis: Hypothesis) -> Vec<Impacts<Scalar>> {
    slips_of(1.0, share, hypothesis)
}

/// Those of bodies of that mass.
fn slips_of(mass: f64, share: f64, hypothesis: Hypothesis) -> Vec<Impacts<Scalar>> {
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

fn tail(impacts: &Impacts<Scalar>) -> Tail<Scalar, 1> {
    Tail::new(&impacts.rates, impacts.course.y)
}

fn near(a: f64, b: f64, allowed: f64) {
    assert!((a - b).abs() <= allowed, "{a} {b} {allowed:e}");
}

/// Some thousand steps of Runge and Kutta's method leave some roundings of each.
fn agrees(found: &Course<Scalar, 1>, w: f64, expected: &State) {
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
        for Impacts {
            rates,
            goal,
            course: from,
            ..
        } in all
        {
            let mut tail = Tail::new(&rates, from.y);
            assert!(tail.straight.all());
            let mut sums = tail.sums(&rates, Hypothesis::Stronge);
            let start = State::of(&from);
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
                let Impacts {
                    rates,
                    mut goal,
                    mut course,
                    ..
                } = impacts;
                let start = State::of(&course);
                let way = 0.2 / value(rates.pace(course.y));
                course.v = one(value(course.v) - start.after(&rates, way).v);
                let start = State::of(&course);
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
                let mut impacts = Impacts {
                    rates,
                    goal,
                    course,
                    ..impacts
                };
                assert!(impacts.is_straight().all());
                let nowhere = !impacts.is_straight();
                tail(&impacts).pass(&rates, &goal, nowhere, &mut course);
                assert_eq!(State::of(&course), start);
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
            let leads = |change: &dyn Fn(&mut Impacts<Scalar>)| {
                let mut changed = impacts;
                change(&mut changed);
                let Impacts {
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
            let Impacts {
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
            let before = State::of(&course);
            let tail = tail(&impacts);
            let lanes = tail.leads(&rates, &goal, &course);
            assert!(lanes.all());
            tail.pass(&rates, &goal, lanes, &mut course);
            assert_eq!(State::of(&course), before);
            assert!(course.compressing.all() && !course.over.any());
        }
    }
}

/// The end of the restitution alone.
#[test]
fn a_restitution_ends_where_it_should() {
    for hypothesis in HYPOTHESES {
        for impacts in slips(0.7, hypothesis) {
            let Impacts {
                rates,
                mut goal,
                mut course,
                ..
            } = impacts;
            course.v = one(0.1);
            course.compressing = !course.compressing;
            let way = 0.3 / value(rates.pace(course.y));
            let end = State::of(&course).after(&rates, way);
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
