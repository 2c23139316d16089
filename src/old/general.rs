//! Coulomb friction for any K: the slip is followed from the first touch to the end of the restitution.
//!
//! In the principal axes of the tangential block, K_t = diag(k₁, k₂) with k₁ ≥ k₂ and κ = (K_nx, K_ny), a slip **s** = ρ**d**,
//! **d** = (cos φ, sin φ), obeys d**s**/dp = κ − μK_t**d**. With dp = ρ dθ
//!
//! dφ/dθ = h(φ) = −κ₁ sin φ + κ₂ cos φ + μ(k₁ − k₂) sin φ cos φ, d ln ρ/dθ = r(φ) = κ·**d** − μ **d**ᵀK_t**d**:
//!
//! θ goes on for ever, and nothing is singular where the slip nearly vanishes. A zero of h is a ray that the slip does not leave; there
//! dh/dφ = −r − μk_⊥, k_⊥ = **d**_⊥ᵀK_t**d**_⊥, so that every ray along which a slip grows (r > 0) attracts. Along a ray everything is a
//! straight line in p. Elsewhere a step is a power series in θ ([`SlipSeries`]), and the way to where a slip comes to rest, a power series in
//! tan(δ/2), δ the angle to the ray that it comes in along ([`RayToRest`]). A slip at rest stays if |K_t⁻¹κ| ≤ μ; otherwise it leaves along
//! the only ray that grows ([`PrincipalFrame::leaving`]).
//!
//! The normal velocity, dv_n/dp = K_nn − μκ·**d**, can fall (a jam) where μ|κ| > K_nn. A step is therefore cut where dv_n/dp changes
//! its sign, so that v_n is monotone in every piece of the path, and a contact that approaches again during the restitution is
//! compressed again. There is no jam where the slip grows or sticks, because K is positive definite, so that each one ends.

use crate::old::{Coulomb, Hypothesis, Sliding};
use crate::old::{Compliance, Components, Contact, Frictionless, Response};
use crate::simd::{Pack, elementary, one};
use pulp::Scalar;

/// Powers of a series.
const TERMS: usize = 24;
/// Logarithm of what a step may lose, relative to the slip: 2⁻⁵⁷.
const LOST: f64 = -39.5;
/// Longest step, in units of the largest rate.
const LONGEST: f64 = 8.0;
/// Largest error of an impulse, relative to the impulse so far.
const TINY: f64 = 0.125 * f64::EPSILON;
/// Largest tan(δ/2) from which the way to the rest is summed, and the most powers of it.
const NEAR: f64 = 0.35;
const MOST_POWERS: usize = 72;
/// Pieces of a path after which the slip is taken to have vanished; the most seen in millions of impacts is 349.
const MOST_PIECES: usize = 2000;

impl Sliding<Scalar> for Compliance {
    fn slide(
        &self,
        rule: &Coulomb,
        velocity: Components<Pack<Scalar, 1>>,
        restitution: Pack<Scalar, 1>,
    ) -> Response<Pack<Scalar, 1>> {
        if rule.friction == 0.0 {
            let contact = Contact {
                velocity,
                compliance: *self,
            };
            return Frictionless.respond::<_, true>(&contact, restitution);
        }
        let velocity = velocity.in_axes();
        let approach = velocity.z.abs();
        let size = approach + velocity.x.abs() + velocity.y.abs();
        if size == 0.0 {
            return Response::none(Scalar::new());
        }
        // Powers of two, so that nothing is rounded here.
        let (speed_unit, response_unit) = (power_of_two(size), power_of_two(self.normal()));
        let frame = PrincipalFrame::new(self, 1.0 / response_unit, rule.friction);
        let unit = 1.0 / speed_unit;
        let mut path = OngoingImpact {
            frame: &frame,
            restitution: restitution.as_slice()[0],
            hypothesis: rule.hypothesis,
            approach: approach * unit,
            slip: frame.inward([velocity.x * unit, velocity.y * unit]),
            speed: -approach * unit,
            normal: 0.0,
            friction: [0.0; 2],
            compressing: true,
            began: 0.0,
            work: 0.0,
            owed: 0.0,
            rest_is_beyond: false,
        };
        path.follow();
        let scale = speed_unit / response_unit;
        let [along, across] = frame.outward(path.friction);
        Response {
            impulse: Components {
                normal: path.normal,
                along,
                across,
            }
            .map(|component| one(component * scale)),
            separation_speed: one(path.speed.max(0.0) * speed_unit),
        }
    }
}

/// The largest power of two that is not larger, of a positive number.
fn power_of_two(x: f64) -> f64 {
    f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & (0x7ff << 52))
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn norm(a: [f64; 2]) -> f64 {
    dot(a, a).sqrt()
}

/// K and μ in the principal axes of K_t.
struct PrincipalFrame {
    /// Cosine and sine of the angle from x to the first axis.
    axis: [f64; 2],
    nn: f64,
    coupling: [f64; 2],
    tangential: [f64; 2],
    friction: f64,
    /// The largest rate; θ is measured in its inverse.
    rate: f64,
    /// κ, μk₁ and μk₂, and μ(k₁ − k₂), over that rate.
    drive: [f64; 2],
    brake: [f64; 2],
    spread: f64,
    /// True if dv_n/dp can be negative.
    may_jam: bool,
}

/// Rates at a direction of the slip, in units of [`PrincipalFrame::rate`].
struct SlipRates {
    /// h(φ).
    turn: f64,
    /// r(φ).
    growth: f64,
    /// μk_⊥.
    across: f64,
}

impl SlipRates {
    /// dh/dφ.
    fn turn_slope(&self) -> f64 {
        -self.growth - self.across
    }
}

impl PrincipalFrame {
    fn new(k: &Compliance, unit: f64, friction: f64) -> Self {
        let k = k.entries();
        let (xx, yy, xy) = (k.xx * unit, k.yy * unit, k.xy * unit);
        let (mut axis, mut tangential) = ([1.0, 0.0], [xx, yy]);
        if xy != 0.0 {
            // Jacobi's rotation by the smaller angle, of tangent t.
            let tau = 0.5 * (yy - xx) / xy;
            let t = 1.0_f64.copysign(tau) / (tau.abs() + (1.0 + tau * tau).sqrt());
            let cosine = 1.0 / (1.0 + t * t).sqrt();
            axis = [cosine, -t * cosine];
            tangential = [xx - t * xy, yy + t * xy];
        }
        if tangential[0] < tangential[1] {
            axis = [-axis[1], axis[0]];
            tangential = [tangential[1], tangential[0]];
        }
        let coupling = rotate(axis, [k.xz * unit, k.yz * unit]);
        let nn = k.zz * unit;
        let brake = tangential.map(|t| friction * t);
        let rate = coupling[0].abs() + coupling[1].abs() + brake[0];
        Self {
            axis,
            nn,
            coupling,
            tangential,
            friction,
            rate,
            drive: coupling.map(|c| c / rate),
            brake: brake.map(|b| b / rate),
            spread: friction * (tangential[0] - tangential[1]) / rate,
            may_jam: friction * norm(coupling) > nn,
        }
    }

    fn inward(&self, v: [f64; 2]) -> [f64; 2] {
        rotate(self.axis, v)
    }

    fn outward(&self, v: [f64; 2]) -> [f64; 2] {
        rotate([self.axis[0], -self.axis[1]], v)
    }

    fn rates(&self, d: [f64; 2]) -> SlipRates {
        let (c2, s2) = (d[0] * d[0], d[1] * d[1]);
        SlipRates {
            turn: cross(d, self.drive) + self.spread * d[0] * d[1],
            growth: dot(self.drive, d) - (self.brake[0] * c2 + self.brake[1] * s2),
            across: self.brake[0] * s2 + self.brake[1] * c2,
        }
    }

    /// dv_n/dθ from ρ and **s**, or its integral from theirs.
    fn rise(&self, [rho, x, y, _]: &[f64; 4]) -> f64 {
        self.nn / self.rate * rho - self.friction * (self.drive[0] * x + self.drive[1] * y)
    }

    /// dv_n/dp.
    fn stiffness(&self, d: [f64; 2]) -> f64 {
        self.nn - self.friction * dot(self.coupling, d)
    }

    /// The path of a slip along this ray.
    fn sliding(&self, d: [f64; 2]) -> Line {
        let pull = d.map(|x| -self.friction * x);
        Line {
            pull,
            stiffness: self.stiffness(d),
            drift: [0, 1].map(|i| self.coupling[i] + self.tangential[i] * pull[i]),
        }
    }

    /// The path from where the slip is at rest.
    fn resting(&self) -> Line {
        let hold = [0, 1].map(|i| -self.coupling[i] / self.tangential[i]);
        if norm(hold) <= self.friction {
            Line {
                pull: hold,
                stiffness: self.nn + dot(self.coupling, hold),
                drift: [0.0; 2],
            }
        } else {
            self.sliding(self.leaving())
        }
    }

    /// The ray along which a slip at rest starts. κ − μK_t**d** = λ**d** with λ > 0 means **d** = (μK_t + λ)⁻¹κ, whose length falls with
    /// λ, from |K_t⁻¹κ|/μ > 1 to 0, and is 1 once. The inverse of the length is concave, so that Newton's steps from λ = 0 stay on the
    /// near side.
    fn leaving(&self) -> [f64; 2] {
        let mut lambda = 0.0;
        let mut d = [0.0; 2];
        for _ in 0..60 {
            d = [0, 1].map(|i| self.drive[i] / (self.brake[i] + lambda));
            let square = dot(d, d);
            let slope: f64 = (0..2).map(|i| d[i] * d[i] / (self.brake[i] + lambda)).sum();
            let step = square * (square.sqrt() - 1.0) / slope;
            lambda += step;
            if step <= f64::EPSILON * lambda {
                break;
            }
        }
        let size = norm(d);
        d.map(|x| x / size)
    }

    /// The zero of h next to a direction, by Newton's method, if there is one.
    fn ray(&self, mut d: [f64; 2]) -> Option<[f64; 2]> {
        for _ in 0..8 {
            let rates = self.rates(d);
            let delta = (-rates.turn / rates.turn_slope()).clamp(-0.5, 0.5);
            let turned = [d[0] - delta * d[1], d[1] + delta * d[0]];
            let size = norm(turned);
            d = turned.map(|x| x / size);
            if delta.abs() < 1e-9 {
                return Some(d);
            }
        }
        None
    }
}

/// The components of v in axes of which the first is turned to this direction.
fn rotate(axis: [f64; 2], v: [f64; 2]) -> [f64; 2] {
    [dot(axis, v), cross(axis, v)]
}

/// A part of the path on which nothing changes its rate in p: friction, v_n, and the slip.
struct Line {
    pull: [f64; 2],
    stiffness: f64,
    drift: [f64; 2],
}

/// An impact under way.
struct OngoingImpact<'a> {
    frame: &'a PrincipalFrame,
    restitution: f64,
    hypothesis: Hypothesis,
    approach: f64,
    slip: [f64; 2],
    /// v_n.
    speed: f64,
    /// p, and the tangential impulse.
    normal: f64,
    friction: [f64; 2],
    /// True if the contact is being compressed, or has Newton's hypothesis to fulfil.
    compressing: bool,
    /// p at the beginning of this compression or restitution, and ∫v_n dp since.
    began: f64,
    work: f64,
    /// The part of the restitution that is still to come: impulse under Poisson's, work under Stronge's hypothesis.
    owed: f64,
    /// The impact is over, or changes from compression to restitution or back, before the slip comes to rest.
    rest_is_beyond: bool,
}

/// A part of the path.
struct Gain {
    normal: f64,
    friction: [f64; 2],
    speed: f64,
    work: f64,
}

impl OngoingImpact<'_> {
    fn follow(&mut self) {
        let frame = self.frame;
        if self.approach == 0.0 {
            let rho = norm(self.slip);
            if frame.stiffness(self.slip.map(|x| x / rho)) >= 0.0 {
                return; // it touches, and is not pressed together
            }
        }
        for piece in 0.. {
            if piece == MOST_PIECES {
                self.slip = [0.0; 2];
            }
            if self.piece() {
                return;
            }
        }
    }

    /// The next piece; whether the impact is over.
    fn piece(&mut self) -> bool {
        let frame = self.frame;
        let rho = norm(self.slip);
        // No impact has less impulse than this.
        let least = self.approach / (frame.nn + frame.friction * norm(frame.coupling));
        // μρ over a rate, compared with this, is an impulse along the plane that does not count.
        let tiny = TINY * self.normal.max(least) * frame.rate;
        let push = frame.friction * rho;
        if push <= tiny * frame.brake[1] {
            self.slip = [0.0; 2];
            let rest = frame.resting();
            return self.straight(&rest, f64::INFINITY);
        }
        let d = self.slip.map(|x| x / rho);
        let rates = frame.rates(d);
        let slope = rates.turn_slope();
        let mut ray = None;
        if slope < 0.0 {
            let off = (rates.turn / slope).abs();
            if off <= TINY || push * off <= tiny * rates.across {
                ray = frame.ray(d);
            }
        } else if push * rates.turn.abs() <= -tiny * rates.growth * rates.across {
            ray = Some(d);
        }
        if let Some(d) = ray {
            let growth = frame.rates(d).growth;
            let most = if growth < 0.0 {
                rho / (-growth * frame.rate)
            } else {
                f64::INFINITY
            };
            return self.straight(&frame.sliding(d), most);
        }
        if !self.rest_is_beyond && slope < 0.0 && rates.growth < 0.0 && self.stop(rho, d, &rates) {
            return false;
        }
        self.curved(rho)
    }

    /// A piece with the same friction per impulse all the way, at most until the slip stops after the impulse `most`.
    fn straight(&mut self, line: &Line, most: f64) -> bool {
        let Line { pull, drift, .. } = *line;
        let mut stiffness = line.stiffness;
        if most == f64::INFINITY {
            // What sticks, or slips faster, does not jam, but for rounding.
            stiffness = stiffness.max(f64::EPSILON * self.frame.nn);
        }
        let speed = self.speed;
        let until = |wanted: f64| (wanted - speed) / stiffness;
        let mut length = f64::INFINITY;
        if self.compressing {
            if stiffness > 0.0 {
                length = until(self.wanted_speed());
            }
        } else {
            length = match self.hypothesis {
                Hypothesis::Stronge => {
                    let left = self.owed - self.work;
                    let square = speed * speed + 2.0 * stiffness * left;
                    if square < 0.0 {
                        f64::INFINITY
                    } else {
                        2.0 * left / (speed + square.sqrt())
                    }
                }
                _ => self.owed - (self.normal - self.began),
            };
        }
        let length = length.max(0.0);
        let back = if !self.compressing && stiffness < 0.0 {
            until(0.0)
        } else {
            f64::INFINITY
        };
        let event = length.min(back);
        let p = event.min(most);
        self.add(&Gain {
            normal: p,
            friction: pull.map(|x| x * p),
            speed: stiffness * p,
            work: p * (speed + 0.5 * stiffness * p),
        });
        if most < event {
            self.slip = [0.0; 2];
            return false;
        }
        for (slip, drift) in self.slip.iter_mut().zip(drift) {
            *slip += drift * p;
        }
        if length <= back {
            self.reached()
        } else {
            self.pressed_again()
        }
    }

    fn add(&mut self, gain: &Gain) {
        self.normal += gain.normal;
        for i in 0..2 {
            self.friction[i] += gain.friction[i];
        }
        self.speed += gain.speed;
        self.work += gain.work;
    }

    /// v_n at which the compression, or under Newton's hypothesis the impact, is over.
    fn wanted_speed(&self) -> f64 {
        if self.hypothesis == Hypothesis::Newton {
            self.restitution * self.approach
        } else {
            0.0
        }
    }

    /// The present phase has come to its end; whether that is the end of the impact.
    fn reached(&mut self) -> bool {
        if !self.compressing {
            return true;
        }
        self.speed = self.wanted_speed();
        if self.hypothesis == Hypothesis::Newton {
            return true;
        }
        let e = self.restitution;
        self.owed += match self.hypothesis {
            Hypothesis::Stronge => e * e * -self.work,
            _ => e * (self.normal - self.began),
        };
        self.turn_over();
        self.owed <= 0.0
    }

    /// The contact approaches again before the restitution is over; never the end of the impact.
    fn pressed_again(&mut self) -> bool {
        self.speed = 0.0;
        self.owed -= match self.hypothesis {
            Hypothesis::Stronge => self.work,
            _ => self.normal - self.began,
        };
        self.turn_over();
        false
    }

    fn turn_over(&mut self) {
        self.compressing = !self.compressing;
        self.began = self.normal;
        self.work = 0.0;
        self.rest_is_beyond = false;
    }

    /// Returns whether the end of the present phase, or a new compression, lies at or before a place that is so far away along a piece on
    /// which v_n is monotone.
    fn passes(&self, gain: &Gain) -> bool {
        let speed = self.speed + gain.speed;
        if self.compressing {
            return speed >= self.wanted_speed();
        }
        speed < 0.0
            || match self.hypothesis {
                Hypothesis::Stronge => self.work + gain.work >= self.owed,
                _ => self.normal + gain.normal - self.began >= self.owed,
            }
    }

    /// Goes on to where the slip comes to rest, if its direction is next to the ray that it comes in along, v_n is monotone until then, and
    /// nothing else happens before.
    fn stop(&mut self, rho: f64, d: [f64; 2], rates: &SlipRates) -> bool {
        let frame = self.frame;
        if rates.turn.abs() > 2.0 * NEAR * rates.turn_slope().abs() {
            return false;
        }
        let Some(ray) = frame.ray(d) else {
            return false;
        };
        let tangent = cross(ray, d) / (1.0 + dot(ray, d));
        if tangent.abs() > NEAR {
            return false;
        }
        if frame.may_jam {
            let (here, there) = (frame.stiffness(d), frame.stiffness(ray));
            let aside = cross(frame.coupling, d) * cross(frame.coupling, ray);
            if (here > 0.0) != (there > 0.0) || (here > 0.0 && aside <= 0.0) {
                return false;
            }
        }
        let stop = RayToRest::new(frame, ray);
        if stop.growth[0] >= 0.0 || stop.turn[0] >= 0.0 {
            return false; // the slip grows along the ray, or turns away from it
        }
        let Some(gain) = stop.gain(tangent, rho, self.speed) else {
            return false;
        };
        if self.passes(&gain) {
            self.rest_is_beyond = true;
            return false;
        }
        self.add(&gain);
        self.slip = [0.0; 2];
        true
    }

    /// A step in θ.
    fn curved(&mut self, rho: f64) -> bool {
        let frame = self.frame;
        let works = self.hypothesis == Hypothesis::Stronge;
        let series = SlipSeries::new(frame, rho, self.slip, self.speed, works);
        let mut length = series.reach();
        if frame.may_jam {
            length = series.monotone(length);
        }
        let mut sums = series.sums(length);
        let mut gain = series.gain(&sums);
        let over = self.passes(&gain);
        let mut falls = false;
        if over {
            if !self.compressing && self.speed + gain.speed < 0.0 {
                // Where it would be pressed together again, unless it is over by then.
                length = root(length, |t| {
                    let sums = series.sums(t);
                    (
                        self.speed + frame.rise(&sums.whole),
                        frame.rise(&sums.value),
                    )
                });
                gain = series.gain(&series.sums(length));
                gain.speed = -self.speed;
                falls = !self.passes(&gain);
            }
            if !falls {
                length = root(length, |t| self.lack(&series.sums(t)));
            }
            sums = series.sums(length);
            gain = series.gain(&sums);
        }
        self.slip = [sums.value[1], sums.value[2]];
        self.add(&gain);
        match (over, falls) {
            (false, _) => false,
            (true, true) => self.pressed_again(),
            (true, false) => self.reached(),
        }
    }

    /// The distance beyond the end of the present phase, with its derivative; negative before it.
    fn lack(&self, sums: &Integrals) -> (f64, f64) {
        let frame = self.frame;
        let speed = self.speed + frame.rise(&sums.whole);
        if self.compressing {
            return (speed - self.wanted_speed(), frame.rise(&sums.value));
        }
        let [normal, .., work] = sums.whole;
        let rho = sums.value[0];
        match self.hypothesis {
            Hypothesis::Stronge => (work - (self.owed - self.work) * frame.rate, speed * rho),
            _ => {
                let left = self.owed - (self.normal - self.began);
                (normal - left * frame.rate, rho)
            }
        }
    }
}

/// The way of the slip as power series in θ about a point: ρ, **s** and v_nρ.
///
/// ρ′ = κ·**s** − μk₂ρ − μ(k₁ − k₂) s₁²/ρ and **s**′ = κρ − μK_t**s** need the product of two series, and with c = s₁/ρ a quotient.
struct SlipSeries<'a> {
    frame: &'a PrincipalFrame,
    terms: [[f64; 4]; TERMS],
}

/// Integrals over θ from the beginning of a step, and the integrands.
struct Integrals {
    whole: [f64; 4],
    value: [f64; 4],
}

/// 1/(k + 1).
const INVERSE: [f64; TERMS] = {
    let mut inverse = [0.0; TERMS];
    let mut k = 0;
    while k < TERMS {
        inverse[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    inverse
};

impl<'a> SlipSeries<'a> {
    /// The series from a slip of size ρ and a normal velocity, which counts only if work is asked for.
    fn new(frame: &'a PrincipalFrame, rho: f64, slip: [f64; 2], speed: f64, works: bool) -> Self {
        let [a, b] = frame.drive;
        let [m1, m2] = frame.brake;
        let mut terms = [[0.0; 4]; TERMS];
        let mut c = [0.0; TERMS];
        let mut pairs = [[0.0; 2]; TERMS]; // ρ and s₁
        pairs[0] = [rho, slip[0]];
        let mut y = slip[1];
        let inverse = 1.0 / rho;
        for k in 0..TERMS {
            let [r, x] = pairs[k];
            terms[k] = [r, x, y, 0.0];
            let sum = convolved(&c[..k], &pairs[1..=k]); // without the terms of c_k
            c[k] = (x - sum[0]) * inverse;
            if k + 1 < TERMS {
                let square = sum[1] + c[k] * slip[0];
                let part = INVERSE[k];
                pairs[k + 1] = [
                    (a * x + b * y - m2 * r - frame.spread * square) * part,
                    (a * r - m1 * x) * part,
                ];
                y = (b * r - m2 * y) * part;
            }
        }
        if works {
            let mut v = [0.0; TERMS];
            v[0] = speed;
            for k in 1..TERMS {
                v[k] = frame.rise(&terms[k - 1]) * INVERSE[k - 1];
            }
            for k in 0..TERMS {
                terms[k][3] = convolved(&v[..=k], &pairs[..=k])[0];
            }
        }
        Self { frame, terms }
    }

    /// The longest step in which the first neglected terms do not count.
    fn reach(&self) -> f64 {
        let mut logarithm = f64::NEG_INFINITY;
        for k in TERMS - 2..TERMS {
            let [r, x, y, _] = self.terms[k].map(f64::abs);
            let share = r.max(x).max(y) / self.terms[0][0];
            if share > f64::MIN_POSITIVE {
                logarithm = logarithm.max((elementary::ln(share) - LOST) / k as f64);
            }
        }
        let short = (-logarithm).clamp(-32.0, 3.0);
        elementary::exp_in_lanes(one(short)).as_slice()[0].min(LONGEST)
    }

    fn sums(&self, t: f64) -> Integrals {
        let (mut whole, mut value) = ([0.0; 4], [0.0; 4]);
        for (terms, part) in self.terms.iter().zip(&INVERSE).rev() {
            for i in 0..4 {
                value[i] = value[i] * t + terms[i];
                whole[i] = whole[i] * t + terms[i] * part;
            }
        }
        Integrals {
            whole: whole.map(|x| x * t),
            value,
        }
    }

    fn gain(&self, sums: &Integrals) -> Gain {
        let part = 1.0 / self.frame.rate;
        let pull = -self.frame.friction * part;
        let [normal, x, y, work] = sums.whole;
        Gain {
            normal: normal * part,
            friction: [pull * x, pull * y],
            speed: self.frame.rise(&sums.whole),
            work: work * part,
        }
    }

    /// The part of a step from its beginning on which v_n is monotone.
    fn monotone(&self, mut length: f64) -> f64 {
        let drive = self.frame.drive;
        // Where the slip passes the direction of κ, dv_n/dp has its minimum.
        let aside = |terms: &[f64; 4]| cross(drive, [terms[1], terms[2]]);
        let rise = |terms: &[f64; 4]| self.frame.rise(terms);
        let end = self.sums(length).value;
        if aside(&self.terms[0]) * aside(&end) < 0.0 && dot(drive, [end[1], end[2]]) > 0.0 {
            length = self.turning_point(length, aside);
        }
        if rise(&self.terms[0]) * rise(&self.sums(length).value) < 0.0 {
            length = self.turning_point(length, rise);
        }
        length
    }

    /// The zero of a linear function of the series within a step, or its end, if the zero is that of its beginning.
    fn turning_point(&self, length: f64, function: impl Fn(&[f64; 4]) -> f64) -> f64 {
        let zero = root(length, |t| {
            let (mut value, mut slope) = (0.0, 0.0);
            for terms in self.terms.iter().rev() {
                slope = slope * t + value;
                value = value * t + function(terms);
            }
            (value, slope)
        });
        if zero > 1e-8 * length { zero } else { length }
    }
}

/// Σ c_i p_{n−1−i}, as one sum over even and one over odd i, of which neither waits for the other.
fn convolved(c: &[f64], pairs: &[[f64; 2]]) -> [f64; 2] {
    let (mut even, mut odd) = ([0.0; 2], [0.0; 2]);
    let two = c.chunks_exact(2);
    if let [last] = two.remainder() {
        even = pairs[0].map(|p| last * p);
    }
    for (c, p) in two.zip(pairs.rchunks_exact(2)) {
        for i in 0..2 {
            even[i] += c[0] * p[1][i];
            odd[i] += c[1] * p[0][i];
        }
    }
    [even[0] + odd[0], even[1] + odd[1]]
}

/// The zero of a function that has different signs at 0 and at `high`, from its values and slopes: Newton's method within a bracket.
fn root(mut high: f64, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (start, slope) = function(0.0);
    let mut low = 0.0;
    let rising = start < 0.0;
    let mut t = -start / slope;
    if !(low < t && t < high) {
        t = high;
    }
    for _ in 0..100 {
        let (value, slope) = function(t);
        if (value < 0.0) == rising {
            low = t;
        } else {
            high = t;
        }
        let newton = t - value / slope;
        let next = if low <= newton && newton <= high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - t).abs() <= f64::EPSILON * t {
            return next;
        }
        t = next;
    }
    t
}

/// The way to the rest along a ray. With z = tan(δ/2), Q = 1 + z², α and β the components of κ along the ray and across, A and E those of
/// K_t along and across, and m = μ(A − E), dz/dθ = Y(z)/Q² and r = R(z)/Q² are polynomials but for Q. What is left, from z on, of the integral
/// of ρg over θ is ρF with RF + YF′ = −Q²g, whose power series has as radius of convergence the distance to the next complex zero of
/// h, or 1. With 2R it is that of ρ²V, for the work.
struct RayToRest<'a> {
    frame: &'a PrincipalFrame,
    ray: [f64; 2],
    growth: [f64; 6],
    turn: [f64; 6],
}

impl<'a> RayToRest<'a> {
    fn new(frame: &'a PrincipalFrame, ray: [f64; 2]) -> Self {
        let [alpha, beta] = rotate(ray, frame.drive);
        let (c2, s2) = (ray[0] * ray[0], ray[1] * ray[1]);
        let along = frame.brake[0] * c2 + frame.brake[1] * s2;
        let across = frame.brake[0] * s2 + frame.brake[1] * c2;
        let m = along - across;
        Self {
            frame,
            ray,
            growth: [
                alpha - along,
                -2.0 * beta,
                2.0 * along - 4.0 * across,
                6.0 * beta,
                -(alpha + along),
                0.0,
            ],
            turn: [
                m - alpha,
                3.0 * beta,
                -2.0 * alpha,
                2.0 * beta,
                -(alpha + m),
                -beta,
            ],
        }
    }

    /// The gain until the slip is at rest, from tan(δ/2), ρ and v_n. None if the series does not converge.
    fn gain(&self, z: f64, rho: f64, speed: f64) -> Option<Gain> {
        let frame = self.frame;
        // Q²g of the integrals of ρ, ρ cos δ and ρ sin δ.
        const SOURCES: [[f64; 3]; 5] = [
            [1.0, 1.0, 0.0],
            [0.0, 0.0, 2.0],
            [2.0, 0.0, 0.0],
            [0.0, 0.0, 2.0],
            [1.0, -1.0, 0.0],
        ];
        let [alpha, beta] = rotate(self.ray, frame.drive);
        let [nn, pull] = [frame.nn / frame.rate, frame.friction];
        // The last five coefficients of the three integrals and of that of the work, and of V.
        let mut last = [[0.0; 4]; 5];
        let mut rises = [0.0; 5];
        let mut sums = [0.0; 4];
        let mut power = 1.0;
        let mut small = 0;
        for k in 0..MOST_POWERS {
            let mut next = [0.0; 4];
            if let Some(source) = SOURCES.get(k) {
                next[..3].copy_from_slice(source);
            }
            for j in 1..=5.min(k) {
                let before = &last[(k - j) % 5];
                let turn = (k - j) as f64 * self.turn[j];
                let once = self.growth[j] + turn;
                let twice = 2.0 * self.growth[j] + turn;
                for i in 0..3 {
                    next[i] += once * before[i];
                }
                next[3] += twice * before[3];
            }
            let turn = k as f64 * self.turn[0];
            let once = -1.0 / (self.growth[0] + turn);
            for term in &mut next[..3] {
                *term *= once;
            }
            let rise = nn * next[0] - pull * (alpha * next[1] + beta * next[2]);
            next[3] += rise;
            if k >= 2 {
                next[3] += 2.0 * rises[(k - 2) % 5];
            }
            if k >= 4 {
                next[3] += rises[(k - 4) % 5];
            }
            next[3] /= -(2.0 * self.growth[0] + turn);
            rises[k % 5] = rise;
            last[k % 5] = next;
            let mut counts = false;
            for i in 0..4 {
                let term = next[i] * power;
                sums[i] += term;
                let size = if i == 3 { sums[3] } else { sums[0] };
                counts |= term.abs() > TINY * size.abs();
            }
            power *= z;
            small = if counts { 0 } else { small + 1 };
            if small == 3 {
                let [normal, along, across] = [sums[0], sums[1], sums[2]].map(|x| rho * x);
                let friction = -frame.friction / frame.rate;
                let [x, y] = rotate([self.ray[0], -self.ray[1]], [along, across]);
                let rise = nn * normal - pull * (alpha * along + beta * across);
                return Some(Gain {
                    normal: normal / frame.rate,
                    friction: [friction * x, friction * y],
                    speed: rise,
                    work: ((speed + rise) * normal - rho * rho * sums[3]) / frame.rate,
                });
            }
        }
        None
    }
}
