//! The laws for any K: beside the oracle, in closed form where there is one, and beside the law of bodies of revolution.

use crate::contacts;
use crate::contacts::{HYPOTHESES, chatterjee_ruina, coulomb, frictionless};
use crate::oracle::algebra::{
    Matrix, Vector as Array, apply, cross, dot, minus, norm, plus, solve, times,
};
use crate::oracle::impact::{Contact, Rule, response};
use crate::oracle::normal::Restitution;
use crate::oracle::random::Random;
use restitution_core::law::{Compliance, Response};
use restitution_core::{Hypothesis, Law, Symmetric, Vector};

fn symmetric(k: &Matrix) -> Symmetric {
    Symmetric {
        xx: k[0][0],
        yy: k[1][1],
        zz: k[2][2],
        xy: k[0][1],
        xz: k[0][2],
        yz: k[1][2],
    }
}

fn compliance(k: &Matrix) -> Compliance {
    Compliance::new(symmetric(k)).unwrap()
}

fn vector([x, y, z]: Array) -> Vector {
    Vector::new(x, y, z)
}

fn array(v: Vector) -> Array {
    [v.x, v.y, v.z]
}

fn answer(law: &Law, contact: &Contact) -> Response {
    law.answer(&compliance(&contact.response), vector(contact.velocity))
        .unwrap()
}

/// Three orthogonal axes, as rows.
fn axes(random: &mut Random) -> Matrix {
    let z = random.direction();
    let other = random.direction();
    let x = minus(other, times(dot(other, z), z));
    let x = times(1.0 / norm(x), x);
    [x, cross(z, x), z]
}

/// The matrix with these eigenvalues along these axes.
fn with_axes(axes: &Matrix, values: Array) -> Matrix {
    let entry = |i: usize, j: usize| (0..3).map(|k| axes[k][i] * values[k] * axes[k][j]).sum();
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}

fn inverse(m: &Matrix) -> Matrix {
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|unit| solve(m, unit));
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| 0.5 * (columns[j][i] + columns[i][j])))
}

fn trace(m: &Matrix) -> f64 {
    m[0][0] + m[1][1] + m[2][2]
}

/// By how much rounding in K can count, no less than the ratio of its largest to its smallest eigenvalue.
fn condition(k: &Matrix) -> f64 {
    trace(k) * trace(&inverse(k))
}

const KINDS: usize = 8;

/// K of an ellipsoid on a plane, as thick as is said.
fn ellipsoid(random: &mut Random, semi_axes: Array) -> Matrix {
    let axes = axes(random);
    let square = semi_axes.map(|a| a * a);
    let moments = [0, 1, 2].map(|i| (square[(i + 1) % 3] + square[(i + 2) % 3]) / 5.0);
    let down = [0, 1, 2].map(|k| -square[k] * axes[k][2]);
    let height = (0..3).map(|k| -down[k] * axes[k][2]).sum::<f64>().sqrt();
    let arm = [0, 1, 2].map(|i| (0..3).map(|k| axes[k][i] * down[k]).sum::<f64>() / height);
    response(random.magnitude(-3.0, 3.0), &with_axes(&axes, moments), arm)
}

fn matrix(random: &mut Random, kind: usize) -> Matrix {
    let thin = |random: &mut Random| random.magnitude(-2.0, -1.0);
    match kind {
        // Ellipsoids, plates, needles.
        0 => {
            let semi_axes = [0; 3].map(|_| random.between(0.1, 1.0));
            ellipsoid(random, semi_axes)
        }
        1 => {
            let semi_axes = [1.0, random.between(0.3, 1.0), thin(random)];
            ellipsoid(random, semi_axes)
        }
        2 => {
            let semi_axes = [1.0, thin(random), thin(random)];
            ellipsoid(random, semi_axes)
        }
        // Two bodies.
        3 => {
            let mut one = || {
                let semi_axes = [0; 3].map(|_| random.between(0.1, 1.0));
                ellipsoid(random, semi_axes)
            };
            let (a, b) = (one(), one());
            [0, 1, 2].map(|i| plus(a[i], b[i]))
        }
        // Nearly isotropic along the plane, coupled to the normal as much as may be.
        4 => {
            let size = random.magnitude(-7.0, -1.0);
            let mut part = || size * random.between(-1.0, 1.0);
            let (xx, yy, xy) = (1.0 + part(), 1.0 + part(), part());
            let (angle, much) = (random.between(0.0, 6.3), random.between(0.0, 0.9));
            let (x, y) = (much * angle.cos(), much * angle.sin());
            [[xx, xy, x], [xy, yy, y], [x, y, 1.0 + random.uniform()]]
        }
        // In the plane of the normal and of one axis.
        5 => {
            let (xx, zz, yy) = (
                random.uniform() + 0.1,
                random.uniform() + 0.1,
                random.uniform() + 0.1,
            );
            let xz = random.between(-0.98, 0.98) * (xx * zz).sqrt();
            [[xx, 0.0, xz], [0.0, yy, 0.0], [xz, 0.0, zz]]
        }
        // Any, also nearly singular.
        6 => {
            let axes = axes(random);
            with_axes(&axes, [0; 3].map(|_| random.magnitude(-4.0, 0.0)))
        }
        _ => {
            let axes = axes(random);
            with_axes(&axes, [0; 3].map(|_| random.between(0.05, 1.0)))
        }
    }
}

fn contact(random: &mut Random, kind: usize) -> Contact {
    let response = matrix(random, kind);
    let (size, angle) = (random.magnitude(-2.0, 1.0), random.between(0.0, 6.3));
    let slip = match random.below(12) {
        0 => 0.0,
        1 => size * 1e-6,
        _ => size,
    };
    Contact {
        response,
        velocity: [
            slip * angle.cos(),
            slip * angle.sin(),
            -random.magnitude(-0.3, 0.3),
        ],
    }
}

/// In [0, 1], with its ends.
fn coefficient(random: &mut Random) -> f64 {
    match random.below(6) {
        0 => 0.0,
        1 => 1.0,
        _ => random.uniform(),
    }
}

/// The largest of the relative distances over what rounding in K may do, and their quantiles.
#[derive(Default)]
struct Distances(Vec<(f64, f64, String)>);

impl Distances {
    fn add(
        &mut self,
        found: &Response,
        expected: Array,
        k: &Matrix,
        what: impl FnOnce() -> String,
    ) {
        let off =
            norm(minus(array(found.impulse), expected)) / norm(expected).max(f64::MIN_POSITIVE);
        let share = off / (f64::EPSILON * condition(k));
        self.0.push((share, off, what()));
    }

    /// Fails if half of the distances, or any, are larger, in units of what rounding in K may do.
    fn below(mut self, half: f64, all: f64) {
        self.0.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (middle, last) = (&self.0[self.0.len() / 2], self.0.last().unwrap());
        let mut off: Vec<f64> = self.0.iter().map(|d| d.1).collect();
        off.sort_by(f64::total_cmp);
        let at = |q: f64| off[((off.len() - 1) as f64 * q) as usize];
        println!(
            "{} impacts, relative: median {:.1e}, nine in ten {:.1e}, all but 1/1000 {:.1e}, worst {:.1e}; of the condition: median {:.1e}, worst {:.1e}",
            off.len(),
            at(0.5),
            at(0.9),
            at(0.999),
            at(1.0),
            middle.0,
            last.0
        );
        assert!(middle.0 <= half && last.0 <= all, "{middle:?}, {last:?}");
    }
}

const ROUNDS: usize = 400;

/// Thousands of contacts of every kind, with μ up to 10; the oracle integrates the same equation of motion by Gauss's collocation in p.
#[test]
fn coulomb_is_the_oracles_for_any_compliance() {
    let mut random = Random(1);
    let mut distances = Distances::default();
    for number in 0..ROUNDS * KINDS {
        let contact = contact(&mut random, number % KINDS);
        let friction = random.magnitude(-1.5, 1.0);
        let restitution = coefficient(&mut random);
        for hypothesis in HYPOTHESES {
            let rule = Rule::Coulomb {
                friction,
                hypothesis,
            };
            let law = rule.law(&Restitution::Constant(restitution));
            let expected = contact.answer(&rule, restitution);
            let found = answer(&law, &contact);
            distances.add(&found, expected.impulse, &contact.response, || {
                format!("{number} {law:?} {contact:?} {found:?} {expected:?}")
            });
        }
    }
    distances.below(1.0, 200.0);
}

/// Next to where two rays merge, κ = μ(k₁ − k₂)(cos³φ, −sin³φ), the slip hardly turns any more, and comes to rest meanwhile.
#[test]
fn rays_that_merge_are_the_oracles() {
    let mut random = Random(4);
    let mut distances = Distances::default();
    for number in 0..300 {
        let first = random.between(0.5, 1.0);
        let second = first * random.between(0.05, 0.95);
        let (friction, angle) = (random.between(0.1, 1.5), random.between(0.0, 6.3));
        let off = random.one(&[-1.0, 1.0]) * random.magnitude(-12.0, -2.0);
        let size = friction * (first - second) * (1.0 + off);
        let (x, y) = (size * angle.cos().powi(3), -size * angle.sin().powi(3));
        let normal = x * x / first + y * y / second + random.between(0.1, 1.0);
        let turned = angle + random.one(&[-1.0, 1.0]) * random.magnitude(-8.0, -1.0);
        let slip = random.between(0.3, 3.0);
        let contact = Contact {
            response: [[first, 0.0, x], [0.0, second, y], [x, y, normal]],
            velocity: [slip * turned.cos(), slip * turned.sin(), -1.0],
        };
        for hypothesis in HYPOTHESES {
            let rule = Rule::Coulomb {
                friction,
                hypothesis,
            };
            let law = rule.law(&Restitution::Constant(0.9));
            let expected = contact.answer(&rule, 0.9);
            let found = answer(&law, &contact);
            distances.add(&found, expected.impulse, &contact.response, || {
                format!("{number} {law:?} {contact:?} {found:?} {expected:?}")
            });
        }
    }
    distances.below(1.0, 200.0);
}

#[test]
fn the_algebraic_laws_are_the_oracles() {
    let mut random = Random(2);
    let mut distances = Distances::default();
    for number in 0..20 * ROUNDS * KINDS {
        let contact = contact(&mut random, number % KINDS);
        let tangential = random.between(-1.0, 1.0);
        let friction = random.magnitude(-1.5, 1.0);
        let restitution = random.uniform();
        for rule in [
            Rule::Frictionless,
            Rule::Tangential { tangential },
            Rule::ChatterjeeRuina {
                tangential,
                friction,
            },
        ] {
            let law = rule.law(&Restitution::Constant(restitution));
            let expected = contact.answer(&rule, restitution);
            let found = answer(&law, &contact);
            assert_eq!(found.separation_speed, expected.separation);
            distances.add(&found, expected.impulse, &contact.response, || {
                format!("{number} {law:?} {contact:?} {found:?} {expected:?}")
            });
        }
    }
    distances.below(1.0, 20.0);
}

/// In the frame of a body of revolution, z along the normal and x along the horizontal direction of its axis, it is the law in lanes.
#[test]
fn axial_compliances_have_the_law_of_bodies_of_revolution() {
    let mut random = contacts::Random::new(3);
    let mut worst: f64 = 0.0;
    for _ in 0..20_000 {
        let axial = random.spatial();
        let (n, u, j) = (
            axial.compliance.arm_normal,
            axial.compliance.arm_along,
            axial.compliance.inertia,
        );
        let contact = Contact {
            response: [
                [1.0 + n * n / j, 0.0, -n * u / j],
                [0.0, axial.compliance.ww, 0.0],
                [-n * u / j, 0.0, 1.0 + u * u / j],
            ],
            velocity: axial.velocity.parts(),
        };
        let (restitution, friction) = (random.coefficient(), random.friction().min(10.0));
        let tangential = random.between(-1.0, 1.0);
        let mut rules = vec![
            Rule::Frictionless,
            Rule::Tangential { tangential },
            Rule::ChatterjeeRuina {
                tangential,
                friction,
            },
        ];
        rules.extend(HYPOTHESES.map(|hypothesis| Rule::Coulomb {
            friction,
            hypothesis,
        }));
        for rule in rules {
            let law = rule.law(&Restitution::Constant(restitution));
            let expected = law.respond(&axial);
            let found = answer(&law, &contact);
            let off = (found.impulse - expected.impulse).norm();
            let allowed = contacts::rounding(&axial, &expected);
            worst = worst.max(off / allowed);
            assert!(
                off <= 64.0 * allowed,
                "{rule:?} {axial:?} {found:?} {expected:?}"
            );
        }
    }
    println!("worst {worst:.1} of rounding");
}

/// Impulse along the plane and the normal in the plane of both, where everything is a straight line in p until the slip stops and after.
fn planar(k: [f64; 3], slip: f64, speed: f64, e: f64, mu: f64, hypothesis: Hypothesis) -> [f64; 2] {
    let [xx, xz, zz] = k;
    let sign = if slip < 0.0 { -1.0 } else { 1.0 };
    let ahead = sign * xz;
    let stop = if slip == 0.0 {
        0.0
    } else if mu * xx > ahead {
        slip.abs() / (mu * xx - ahead)
    } else {
        f64::INFINITY
    };
    let first = zz - mu * ahead;
    let pull = (-xz / xx).clamp(-mu, mu);
    let second = zz + xz * pull;
    // v_n and its integral as functions of p.
    let turn = if stop.is_finite() {
        -speed + first * stop
    } else {
        0.0
    };
    let work_at_stop = if stop.is_finite() {
        stop * 0.5 * (turn - speed)
    } else {
        0.0
    };
    let work = |p: f64| {
        if p <= stop {
            p * (-speed + 0.5 * first * p)
        } else {
            work_at_stop + (p - stop) * (turn + 0.5 * second * (p - stop))
        }
    };
    let at_speed = |v: f64| {
        let p = (v + speed) / first;
        if first > 0.0 && p <= stop {
            p
        } else {
            stop + (v - turn) / second
        }
    };
    let compressed = at_speed(0.0);
    let normal = match hypothesis {
        Hypothesis::Newton => at_speed(e * speed),
        Hypothesis::Poisson => (1.0 + e) * compressed,
        Hypothesis::Stronge => {
            let wanted = (1.0 - e * e) * work(compressed);
            // The larger root of a quadratic equation, in the part that it lies in.
            if stop > compressed && work(stop.min(1e300)) >= wanted || stop.is_infinite() {
                (speed + (speed * speed + 2.0 * first * wanted).max(0.0).sqrt()) / first
            } else {
                let left = wanted - work_at_stop;
                stop + (-turn + (turn * turn + 2.0 * second * left).max(0.0).sqrt()) / second
            }
        }
    };
    let slipping = normal.min(stop);
    [-sign * mu * slipping + pull * (normal - slipping), normal]
}

/// Slip in a plane of symmetry of K, with closed forms for all hypotheses.
#[test]
fn planar_slip_has_its_closed_form() {
    let mut random = Random(4);
    let mut distances = Distances::default();
    for number in 0..100 * ROUNDS {
        let mut response = matrix(&mut random, 5);
        let slip = random.between(-2.0, 2.0);
        let speed = random.between(0.1, 1.0);
        let (e, mu) = (random.between(0.1, 1.0), random.magnitude(-1.5, 1.0));
        let k = [response[0][0], response[0][2], response[2][2]];
        let mut velocity = [slip, 0.0, -speed];
        let swapped = random.chance(0.5);
        if swapped {
            // The same in the plane of y and z.
            let [x, y, z] = response;
            response = [[y[1], 0.0, 0.0], [0.0, x[0], x[2]], [0.0, z[0], z[2]]];
            velocity = [0.0, slip, -speed];
        }
        for hypothesis in HYPOTHESES {
            let [along, normal] = planar(k, slip, speed, e, mu, hypothesis);
            let expected = if swapped {
                [0.0, along, normal]
            } else {
                [along, 0.0, normal]
            };
            let contact = Contact { response, velocity };
            let found = answer(&coulomb(e, mu, hypothesis), &contact);
            let across = if swapped {
                found.impulse.x
            } else {
                found.impulse.y
            };
            assert_eq!(across, 0.0, "{contact:?}");
            distances.add(&found, expected, &response, || {
                format!("{number} {hypothesis:?} {e} {mu} {contact:?} {found:?} {expected:?}")
            });
        }
    }
    distances.below(0.5, 100.0);
}

/// A tangential block that is a multiple of the unit matrix. With a = |κ|, b = μk and φ the angle from κ to the slip, tan(φ/2) falls as
/// exp(−aθ) and ρ sin φ as exp(−bθ), so that p, v_n and the work are sums of exponential functions of θ.
struct Isotropic {
    /// ρ = A exp(−(a + b)θ) + B exp((a − b)θ), and ρ cos φ is the second less the first.
    amplitudes: [f64; 2],
    rates: [f64; 2],
    nn: f64,
    /// μa.
    jam: f64,
    speed: f64,
}

impl Isotropic {
    fn grown(rate: f64, theta: f64) -> f64 {
        if rate == 0.0 {
            theta
        } else {
            (rate * theta).exp_m1() / rate
        }
    }

    fn normal(&self, theta: f64) -> f64 {
        (0..2)
            .map(|i| self.amplitudes[i] * Self::grown(self.rates[i], theta))
            .sum()
    }

    /// dv_n/dθ = Σ c_i exp(r_iθ).
    fn rise(&self, i: usize) -> f64 {
        self.amplitudes[i]
            * if i == 0 {
                self.nn + self.jam
            } else {
                self.nn - self.jam
            }
    }

    fn velocity(&self, theta: f64) -> f64 {
        -self.speed
            + (0..2)
                .map(|i| self.rise(i) * Self::grown(self.rates[i], theta))
                .sum::<f64>()
    }

    /// ∫v_nρ dθ, term by term.
    fn work(&self, theta: f64) -> f64 {
        let mut sum = -self.speed * self.normal(theta);
        for i in 0..2 {
            for j in 0..2 {
                let both = Self::grown(self.rates[i] + self.rates[j], theta);
                let factor = self.rise(i) * self.amplitudes[j] / self.rates[i];
                sum += factor * (both - Self::grown(self.rates[j], theta));
            }
        }
        sum
    }
}

/// The first zero of a function that rises through it, by bisection.
fn zero(function: impl Fn(f64) -> f64, mut low: f64) -> Option<f64> {
    let mut high = low + 0.01;
    while function(high) < 0.0 {
        high = low + 2.0 * (high - low);
        if high > 1e3 {
            return None;
        }
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if function(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(high)
}

/// Slip that turns over an isotropic block and is not over before the end of the impact. Without coupling it does not turn.
#[test]
fn isotropic_blocks_have_their_closed_form() {
    let mut random = Random(5);
    let mut distances = Distances::default();
    let mut straight = 0;
    while distances.0.len() < 20 * ROUNDS {
        let (k, nn) = (random.between(0.5, 2.0), random.between(0.5, 2.0));
        let coupling = if random.chance(0.1) {
            0.0
        } else {
            random.between(0.1, 0.9) * (k * nn).sqrt()
        };
        let mu = random
            .magnitude(-1.0, 0.0)
            .min(0.99 * nn / (coupling + 1e-9)); // v_n is monotone
        let (rho, phi) = (random.between(0.1, 3.0), random.between(0.2, 2.9));
        let e = random.between(0.2, 1.0);
        let (a, b) = (coupling, mu * k);
        if (a - b).abs() < 0.05 {
            continue; // the closed form loses digits
        }
        let half = 0.5 * phi;
        let form = Isotropic {
            amplitudes: [rho * half.sin().powi(2), rho * half.cos().powi(2)],
            rates: [-(a + b), a - b],
            nn,
            jam: mu * a,
            speed: 1.0,
        };
        let Some(compressed) = zero(|t| form.velocity(t), 0.0) else {
            continue;
        };
        for hypothesis in HYPOTHESES {
            let end = match hypothesis {
                Hypothesis::Newton => zero(|t| form.velocity(t) - e, 0.0),
                Hypothesis::Poisson => {
                    let wanted = (1.0 + e) * form.normal(compressed);
                    zero(|t| form.normal(t) - wanted, 0.0)
                }
                Hypothesis::Stronge => {
                    let wanted = (1.0 - e * e) * form.work(compressed);
                    zero(|t| form.work(t) - wanted, compressed)
                }
            };
            let Some(end) = end else { continue };
            // P_t from K_t P_t = s − s₀ − κp.
            let normal = form.normal(end);
            let parts = [0, 1].map(|i| form.amplitudes[i] * (form.rates[i] * end).exp());
            let along = (parts[1] - parts[0] - rho * phi.cos() - a * normal) / k;
            let across = (rho * phi.sin() * (-b * end).exp_m1()) / k;
            let turned = random.between(0.0, 6.3);
            let (c, s) = (turned.cos(), turned.sin());
            let turn = |[x, y]: [f64; 2]| [c * x - s * y, s * x + c * y];
            let [vx, vy] = turn([rho * phi.cos(), rho * phi.sin()]);
            let [x, y] = turn([a, 0.0]);
            let response = [[k, 0.0, x], [0.0, k, y], [x, y, nn]];
            let contact = Contact {
                response,
                velocity: [vx, vy, -1.0],
            };
            let found = answer(&coulomb(e, mu, hypothesis), &contact);
            let [px, py] = turn([along, across]);
            straight += usize::from(coupling == 0.0);
            if coupling == 0.0 {
                let (p, v) = (found.impulse, contact.velocity);
                assert!((p.x * v[1] - p.y * v[0]).abs() <= 1e-15 * p.z * rho);
            }
            distances.add(&found, [px, py, normal], &response, || {
                format!("{hypothesis:?} {e} {mu} {contact:?} {found:?} {px} {py} {normal}")
            });
        }
    }
    assert!(straight > 100);
    distances.below(0.5, 50.0);
}

/// The work of an impulse, **P**·(**v** + **v**′)/2, is the gain of the kinetic energy, which has the scale **v**·K⁻¹**v**/2.
#[test]
fn energy_never_grows_but_under_the_laws_that_can() {
    let mut random = Random(6);
    let mut worst: f64 = 0.0;
    for number in 0..100 * ROUNDS * KINDS {
        let contact = contact(&mut random, number % KINDS);
        let friction = random.magnitude(-2.0, 1.0);
        let restitution = coefficient(&mut random);
        let mut laws = vec![
            frictionless(restitution),
            chatterjee_ruina(restitution, random.between(-1.0, 1.0), friction),
        ];
        laws.extend(HYPOTHESES.map(|hypothesis| coulomb(restitution, friction, hypothesis)));
        let law = laws[number / KINDS % 4]; // not under Newton's hypothesis, the last
        let found = answer(&law, &contact);
        let impulse = array(found.impulse);
        let change = apply(&contact.response, impulse);
        let gain = dot(impulse, plus(contact.velocity, times(0.5, change)));
        let energy = 0.5 * dot(contact.velocity, solve(&contact.response, contact.velocity));
        let allowed = f64::EPSILON * condition(&contact.response) * energy;
        worst = worst.max(gain / allowed);
        assert!(
            gain <= 8.0 * allowed,
            "{law:?} {contact:?} {found:?} {gain:e}"
        );
        assert!(
            found.separation_speed >= 0.0 && found.impulse.z >= 0.0,
            "{law:?} {contact:?}"
        );
        let push = friction * found.impulse.z;
        assert!(
            impulse[0].hypot(impulse[1]) <= push * (1.0 + 1e-12),
            "{law:?} {contact:?} {found:?}"
        );
    }
    println!("largest gain {worst:.1e} of rounding");
}

/// v_n after the impact is what the law says, and Newton's coefficient that of his hypothesis.
#[test]
fn the_separation_speed_is_that_of_the_impulse() {
    let mut random = Random(7);
    for number in 0..10 * ROUNDS * KINDS {
        let contact = contact(&mut random, number % KINDS);
        let (e, mu) = (coefficient(&mut random), random.magnitude(-2.0, 1.0));
        for hypothesis in HYPOTHESES {
            let found = answer(&coulomb(e, mu, hypothesis), &contact);
            let impulse = array(found.impulse);
            let left = contact.velocity[2] + apply(&contact.response, impulse)[2];
            let scale = norm(contact.velocity) + trace(&contact.response) * norm(impulse);
            let allowed = 64.0 * f64::EPSILON * scale;
            assert!(
                (left - found.separation_speed).abs() <= allowed,
                "{contact:?} {found:?} {left}"
            );
            if hypothesis == Hypothesis::Newton || e == 0.0 {
                assert_eq!(found.separation_speed, e * -contact.velocity[2]);
            }
        }
    }
}

/// A contact that only touches takes no impulse unless friction presses it together; then it takes that of the limit.
#[test]
fn grazing_contacts_are_limits() {
    let mut random = Random(8);
    let mut jams = 0;
    for number in 0..10 * ROUNDS * KINDS {
        let mut contact = contact(&mut random, number % KINDS);
        contact.velocity[2] = 0.0;
        let (e, mu) = (random.uniform(), random.magnitude(-1.0, 1.0));
        for hypothesis in HYPOTHESES {
            let law = coulomb(e, mu, hypothesis);
            let found = answer(&law, &contact);
            let mut close = contact;
            close.velocity[2] = -1e-9 * norm(contact.velocity);
            let limit = answer(&law, &close);
            let off = norm(minus(array(found.impulse), array(limit.impulse)));
            // Next to the onset of a jam the limit is not close yet.
            let [x, y, _] = contact.velocity;
            let [kx, ky, kz] = contact.response[2];
            let onset = kz - mu * (kx * x + ky * y) / x.hypot(y);
            if onset.abs() < 1e-2 * kz {
                continue;
            }
            let bound = 1e-6 * condition(&contact.response) * norm(contact.velocity)
                / trace(&contact.response);
            assert!(off <= bound, "{law:?} {contact:?} {found:?} {limit:?}");
            jams += usize::from(found.impulse.z > 0.0);
        }
    }
    assert!(jams > 100);
}

/// The impulse turns with the axes about the normal, and has the units of velocity over compliance.
#[test]
fn neither_axes_nor_units_matter() {
    let mut random = Random(10);
    let mut distances = Distances::default();
    for number in 0..10 * ROUNDS * KINDS {
        let contact = contact(&mut random, number % KINDS);
        let (e, mu) = (coefficient(&mut random), random.magnitude(-6.0, 2.0));
        let law = coulomb(e, mu, HYPOTHESES[number / KINDS % 3]);
        let (c, s) = random.between(0.0, 6.3).sin_cos();
        let axes = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]];
        let [size, speed] = [0; 2].map(|_| random.magnitude(-40.0, 40.0));
        let turned = axes.map(|row| apply(&contact.response, row));
        let response = [0, 1, 2].map(|i| [0, 1, 2].map(|j| size * dot(turned[i], axes[j])));
        let other = Contact {
            response,
            velocity: times(speed, apply(&axes, contact.velocity)),
        };
        let [found, expected] = [&other, &contact].map(|contact| answer(&law, contact));
        let expected = apply(&axes, array(expected.impulse));
        let expected = times(speed / size, expected);
        distances.add(&found, expected, &contact.response, || {
            format!("{law:?} {contact:?} {other:?} {found:?} {expected:?}")
        });
    }
    distances.below(0.5, 100.0);
}

#[test]
fn a_compliance_is_that_of_its_bodies() {
    let mut random = Random(9);
    for _ in 0..1000 {
        let one = |random: &mut Random| {
            let axes = axes(random);
            let parts = [0; 3].map(|_| random.magnitude(-3.0, 1.0));
            let moments = [
                parts[1] + parts[2],
                parts[2] + parts[0],
                parts[0] + parts[1],
            ];
            let (mass, arm) = (random.magnitude(-3.0, 3.0), random.direction());
            let expected = response(mass, &with_axes(&axes, moments), arm);
            let inverse = symmetric(&with_axes(&axes, moments.map(|x| 1.0 / x)));
            (Compliance::of_body(mass, &inverse, vector(arm)), expected)
        };
        let ((a, expected), (b, other)) = (one(&mut random), one(&mut random));
        let sum = [0, 1, 2].map(|i| plus(expected[i], other[i]));
        let allowed = f64::EPSILON * (condition(&expected) + condition(&other));
        for (found, expected) in [(a, &expected), (a + b, &sum)] {
            let impulse = random.direction();
            let change = found.change(vector(impulse));
            let off = norm(minus(array(change), apply(expected, impulse)));
            assert!(
                off <= 16.0 * allowed * trace(expected),
                "{found:?} {expected:?}"
            );
            let back = array(found.impulse(change));
            assert!(norm(minus(back, impulse)) <= 16.0 * f64::EPSILON * condition(expected));
            assert_eq!(found.normal(), found.entries().zz);
        }
    }
}

#[test]
fn what_is_no_compliance_is_refused() {
    let good = [[2.0, 0.1, 0.2], [0.1, 1.0, 0.3], [0.2, 0.3, 1.5]];
    assert!(Compliance::new(symmetric(&good)).is_ok());
    for (i, j, value) in [
        (0, 0, 0.0),
        (2, 2, -1.0),
        (0, 1, 1.5),
        (1, 2, f64::NAN),
        (0, 0, f64::INFINITY),
    ] {
        let mut bad = good;
        bad[i][j] = value;
        let error = Compliance::new(symmetric(&bad)).unwrap_err().to_string();
        assert!(error.contains("positive definite"), "{error}");
    }
}
