//! The hull of a spheroid: semi-axes 1 across and c along the symmetry axis, around the centre of mass.
//!
//! h² = 1 + De_z² with D = c² − 1. While e_z = k + A cos φ, φ = Ωt, is the vertical component of a unit vector,
//!
//! d²h/dt² = De_z e_z″/h + De_z′²/h³,
//!
//! and this is at most |D|AEΩ²/h_min, where E = |k| + A ≤ 1 and h_min is the least h for |e_z| ≤ E:
//!
//! * D > 0, h_min = 1: e_z e_z″ = −AΩ²(k cos φ + A cos²φ) ≤ A|k|Ω² and e_z′² ≤ A²Ω², with h ≥ 1.
//! * D < 0, h_min = h(E): the second term is negative, |e_z″| ≤ AΩ², and |e_z|/h grows with |e_z|.
//!
//! It is no less than minus that either, as a test makes sure.

use super::Ball;

/// An ellipsoid of revolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// c².
    square: f64,
    /// D = c² − 1.
    excess: f64,
}

impl Ellipsoid {
    /// From the semi-axis c along the axis of revolution; the other one is 1.
    pub(super) fn new(polar: f64) -> Self {
        Self {
            square: polar * polar,
            excess: (polar - 1.0) * (polar + 1.0),
        }
    }

    /// h.
    fn support(&self, tilt: f64) -> f64 {
        let level = ((1.0 - tilt) * (1.0 + tilt)).max(0.0);
        (self.square * tilt).mul_add(tilt, level).sqrt()
    }

    /// h − 1 = De_z²/(h + 1).
    pub(super) fn rise(&self, tilt: f64) -> f64 {
        self.excess * (tilt * tilt) / (1.0 + self.support(tilt))
    }

    /// The largest h − 1 for |e_z| ≤ `reach`.
    pub(super) fn ceiling(&self, reach: f64) -> f64 {
        self.rise(reach.min(1.0)).max(0.0)
    }

    /// s = −h′ and ϱ = h − h′e_z.
    pub(super) fn ball(&self, tilt: f64) -> Ball {
        let inverse = 1.0 / self.support(tilt);
        Ball {
            offset: -self.excess * tilt * inverse,
            radius: inverse,
        }
    }

    /// h″ = D/h³.
    pub(super) fn curvature(&self, tilt: f64) -> f64 {
        self.excess / self.support(tilt).powi(3)
    }

    /// The bound on |d²h/dt²|/Ω².
    pub(super) fn sway(&self, amplitude: f64, reach: f64) -> f64 {
        let reach = (reach * (1.0 + 4.0 * f64::EPSILON)).min(1.0);
        let least = self.support(reach).min(1.0);
        self.excess.abs() * (amplitude * reach) / least
    }
}
