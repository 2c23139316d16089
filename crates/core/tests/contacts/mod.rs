//! What the tests of the laws share: random contacts, with the corners of the laws among them, and the energy of an impulse.

use restitution_core::law::{AxialCompliance, Contact, Response};
use restitution_core::{ChatterjeeRuina, Coulomb, Frictionless, Hypothesis, Law, Vector};

pub const HYPOTHESES: [Hypothesis; 3] =
    [Hypothesis::Stronge, Hypothesis::Poisson, Hypothesis::Newton];

/// Numbers in [0, 1) from a counter (SplitMix64), fast enough for ten million contacts.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Either sign, and every magnitude between two powers of ten.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        let sign = if self.uniform() < 0.5 { -1.0 } else { 1.0 };
        sign * 10.0_f64.powf(self.between(low, high))
    }

    /// A coefficient in [0, 1], with its ends.
    pub fn coefficient(&mut self) -> f64 {
        match self.uniform() {
            x if x < 0.1 => 0.0,
            x if x < 0.2 => 1.0,
            _ => self.uniform(),
        }
    }

    /// μ from none to what never slips.
    pub fn friction(&mut self) -> f64 {
        match self.uniform() {
            x if x < 0.05 => 0.0,
            x if x < 0.8 => self.between(0.0, 2.0),
            _ => self.magnitude(-6.0, 6.0).abs(),
        }
    }

    /// A contact in the plane of the axis: from spheres to slender rods, hit from every side, fast and slow.
    pub fn planar(&mut self) -> Contact {
        let inertia = self.magnitude(-1.0, 1.5).abs();
        let slip = match self.uniform() {
            x if x < 0.05 => 0.0,
            x if x < 0.8 => self.between(-2.0, 2.0),
            _ => self.magnitude(-8.0, 2.0),
        };
        let normal = match self.uniform() {
            x if x < 0.05 => 0.0,
            x if x < 0.9 => self.between(0.0, 2.0),
            _ => self.magnitude(-8.0, 2.0).abs(),
        };
        // The farther away the mass is, the larger is J_xx: |r_c|² ≲ 4 J_xx/m in every body of revolution that we know.
        let reach = 2.0 * inertia.sqrt();
        Contact {
            velocity: Vector::new(slip, 0.0, -normal),
            compliance: AxialCompliance {
                inertia,
                arm_normal: -self.between(0.0, 1.0) * reach,
                arm_along: if self.uniform() < 0.05 {
                    0.0
                } else {
                    self.between(-reach, reach)
                },
                ww: 1.0 + self.between(0.0, 4.0),
            },
        }
    }

    /// One that slips across it, too.
    pub fn spatial(&mut self) -> Contact {
        let mut contact = self.planar();
        contact.velocity.y = if self.uniform() < 0.8 {
            self.between(-2.0, 2.0)
        } else {
            self.magnitude(-8.0, 2.0)
        };
        contact
    }
}

pub fn coulomb(normal: f64, friction: f64, hypothesis: Hypothesis) -> Law<'static> {
    Law::new(normal, Coulomb::new(friction, hypothesis).unwrap()).unwrap()
}

pub fn frictionless(normal: f64) -> Law<'static> {
    Law::new(normal, Frictionless).unwrap()
}

pub fn chatterjee_ruina(normal: f64, tangential: f64, friction: f64) -> Law<'static> {
    let rule = ChatterjeeRuina::new(tangential, friction).unwrap();
    Law::new(normal, rule).unwrap()
}

/// Contact velocity after the impact.
pub fn after(contact: &Contact, response: &Response) -> Vector {
    contact.velocity + contact.compliance.change(response.impulse)
}

pub fn tangential(v: Vector) -> f64 {
    v.x.hypot(v.y)
}

/// What an impulse and the velocities it makes are rounded to, over its own size: K enlarges both.
pub fn rounding(contact: &Contact, response: &Response) -> f64 {
    let impulse = response.impulse.norm();
    let square = contact.compliance.arm_normal.powi(2) + contact.compliance.arm_along.powi(2);
    let largest = 1.0 + square / contact.compliance.inertia + contact.compliance.ww;
    f64::EPSILON * (contact.velocity.norm() + largest * impulse)
}

/// The work of the impulse, P·(v_c + v_c′)/2.
pub fn gain(contact: &Contact, response: &Response) -> f64 {
    0.5 * response
        .impulse
        .dot(contact.velocity + after(contact, response))
}

/// Both responses, to within their roundings times `factor`.
pub fn agree(contact: &Contact, a: &Response, b: &Response, factor: f64) -> bool {
    let allowed = factor * rounding(contact, a).max(rounding(contact, b));
    (a.impulse - b.impulse).norm() <= allowed
        && (a.separation_speed - b.separation_speed).abs() <= allowed
}
