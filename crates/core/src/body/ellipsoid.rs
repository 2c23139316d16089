//! The hull of a spheroid: semi-axes a across and c along the symmetry axis, around the centre of mass.
//!
//! h² = a² + De_z² with D = c² − a². While e_z = k + A cos φ, φ = Ωt, is the vertical component of a unit vector,
//!
//! d²h/dt² = De_z e_z″/h + Da²e_z′²/h³,
//!
//! and this is at most |D|AEΩ²/h_min, where E = |k| + A ≤ 1 and h_min is the least h for |e_z| ≤ E:
//!
//! * D > 0, h_min = a: e_z e_z″ = −AΩ²(k cos φ + A cos²φ) ≤ A|k|Ω² and e_z′² ≤ A²Ω², with h ≥ a.
//! * D < 0, h_min = h(E): the second term is negative, |e_z″| ≤ AΩ², and |e_z|/h grows with |e_z|.
//!
//! It is no less than minus that either, as a test makes sure.

use super::Ball;

/// An ellipsoid of revolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// a.
    equatorial: f64,
    /// c.
    polar: f64,
    /// D = c² − a².
    excess: f64,
}

impl Ellipsoid {
    /// From the semi-axes across and along the axis of revolution.
    pub(super) fn new(equatorial: f64, polar: f64) -> Self {
        Self {
            equatorial,
            polar,
            excess: (polar - equatorial) * (polar + equatorial),
        }
    }

    /// a.
    pub(super) fn level(&self) -> f64 {
        self.equatorial
    }

    /// h.
    fn support(&self, tilt: f64) -> f64 {
        let across = self.equatorial * self.equatorial * ((1.0 - tilt) * (1.0 + tilt)).max(0.0);
        let along = self.polar * tilt;
        along.mul_add(along, across).sqrt()
    }

    /// h − a = De_z²/(h + a).
    pub(super) fn rise(&self, tilt: f64) -> f64 {
        self.excess * (tilt * tilt) / (self.equatorial + self.support(tilt))
    }

    /// The largest h − a for |e_z| ≤ `reach`.
    pub(super) fn ceiling(&self, reach: f64) -> f64 {
        self.rise(reach.min(1.0)).max(0.0)
    }

    /// s = −h′ and ϱ = h − h′e_z.
    pub(super) fn ball(&self, tilt: f64) -> Ball {
        let inverse = 1.0 / self.support(tilt);
        Ball {
            offset: -self.excess * tilt * inverse,
            radius: self.equatorial * self.equatorial * inverse,
        }
    }

    /// h″ = Da²/h³.
    pub(super) fn curvature(&self, tilt: f64) -> f64 {
        let support = self.support(tilt);
        let slender = self.equatorial / support;
        self.excess / support * (slender * slender)
    }

    /// The bound on |d²h/dt²|/Ω².
    pub(super) fn sway(&self, amplitude: f64, reach: f64) -> f64 {
        let reach = (reach * (1.0 + 4.0 * f64::EPSILON)).min(1.0);
        let least = self.support(reach).min(self.equatorial);
        self.excess.abs() * (amplitude * reach) / least
    }
}
