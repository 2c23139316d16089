//! Normal coefficients of restitution, from the papers' formulas.

use restitution_core::{Normal, Plastic, Tabulated, Viscoelastic};
use std::f64::consts::PI;

/// ε_n as a function of the speed of approach in m/s.
#[derive(Debug, Clone, Copy)]
pub enum Restitution {
    Constant(f64),
    /// P. Müller and T. Pöschel, Phys. Rev. E **84**, 021302 (2011).
    Viscoelastic {
        young_modulus: f64,
        poisson_ratio: f64,
        dissipation: f64,
        density: f64,
        radius: f64,
    },
    /// C. Thornton, J. Appl. Mech. **64**, 383 (1997).
    Plastic {
        yield_speed: f64,
    },
    Tabulated {
        speeds: &'static [f64],
        values: &'static [f64],
    },
}

impl Restitution {
    /// As the engine is given it.
    pub fn normal(&self) -> Normal<'static> {
        match *self {
            Self::Constant(value) => value.into(),
            Self::Viscoelastic {
                young_modulus,
                poisson_ratio,
                dissipation,
                density,
                radius,
            } => Viscoelastic::new(young_modulus, poisson_ratio, dissipation, density, radius)
                .unwrap()
                .into(),
            Self::Plastic { yield_speed } => Plastic::new(yield_speed).unwrap().into(),
            Self::Tabulated { speeds, values } => Tabulated::new(speeds, values).unwrap().into(),
        }
    }

    pub fn at(&self, speed: f64) -> f64 {
        match *self {
            Self::Constant(value) => value,
            Self::Viscoelastic {
                young_modulus,
                poisson_ratio,
                dissipation,
                density,
                radius,
            } => {
                let mass = 4.0 / 3.0 * PI * radius.powi(3) * density;
                let rho = 4.0 / 3.0 * radius.sqrt() * young_modulus / (1.0 - poisson_ratio.powi(2));
                let beta = 1.5 * dissipation * (rho / mass).powf(0.4);
                let x = beta.sqrt() * speed.powf(0.1); // v*
                let sum = |coefficients: &[f64]| -> f64 {
                    let term = |(i, c): (usize, &f64)| c * x.powi(i as i32);
                    coefficients.iter().enumerate().map(term).sum()
                };
                sum(&[1.0, 1.07232, 0.574198, 0.141552])
                    / sum(&[1.0, 1.07232, 1.72765, 1.37842, 1.19449, 0.467273, 0.235585])
            }
            Self::Plastic { yield_speed } if speed <= yield_speed => 1.0,
            Self::Plastic { yield_speed } => {
                let x = yield_speed / speed;
                let square = x * x;
                let ratio = x / (x + 2.0 * (1.2 - 0.2 * square).sqrt());
                ((1.2 * 3.0_f64.sqrt()) * (1.0 - square / 6.0)).sqrt() * ratio.powf(0.25)
            }
            Self::Tabulated { speeds, values } => {
                let last = speeds.len() - 1;
                if speed <= speeds[0] {
                    return values[0];
                }
                if speed >= speeds[last] {
                    return values[last];
                }
                let i = (0..last).find(|&i| speed < speeds[i + 1]).unwrap();
                let width = speeds[i + 1] - speeds[i];
                (values[i] * (speeds[i + 1] - speed) + values[i + 1] * (speed - speeds[i])) / width
            }
        }
    }
}
