//! The parameters of a run as a row of numbers, in SI units, written by the page.

use restitution_core::{
    ChatterjeeRuina, Coulomb, Dumbbell, Error, Frictionless, Hypothesis, Law, LoadedSphere,
    Orientation, Rule, Run, Solid, Spherocylinder, Spheroid, Spin, TangentialRestitution, Vector,
};

/// Number of parameters.
pub const COUNT: usize = 28;

/// The parameters, in the order of `web/src/engine/layout.ts`.
pub struct Parameters(pub [f64; COUNT]);

impl Parameters {
    /// The run, if the parameters of body and law are valid. The others are checked when the run starts.
    pub fn run(&self) -> Result<Run<'_>, Error> {
        let p = &self.0;
        Ok(Run {
            body: self.body()?,
            law: self.law()?,
            particles: p[10] as usize,
            impacts: p[11] as usize,
            release_height: p[12].into(),
            gravity: p[13],
            orientation: match p[14] as u32 {
                0 => Orientation::UniformAngle,
                1 => Orientation::Isotropic,
                _ => Orientation::Given(&p[15..16]),
            },
            spin: Spin::Fixed(Vector::new(p[16], p[17], p[18])),
            release_velocity: Vector::new(p[19], p[20], p[21]),
            incline: p[22],
            minimum_speed: p[23],
            // Two halves, because a double holds integers of 53 bits only.
            seed: (p[24] as u64) << 32 | p[25] as u64,
        })
    }

    fn body(&self) -> Result<Solid, Error> {
        let [shape, radius, length, density, load, offset] =
            std::array::from_fn(|i| self.0[[0, 1, 2, 3, 26, 27][i]]);
        Ok(match shape as u32 {
            0 => Dumbbell::unequal([radius; 2], length, [density; 2])?.into(),
            1 => Spherocylinder::new(radius, length, density)?.into(),
            2 => Spheroid::new(radius, length, density)?.into(),
            _ => LoadedSphere::new(radius, density, load, offset)?.into(),
        })
    }

    fn law(&self) -> Result<Law<'static>, Error> {
        let [law, normal, tangential, friction, hypothesis] =
            std::array::from_fn(|i| self.0[4 + i]);
        let rule: Rule = match law as u32 {
            0 => TangentialRestitution::new(tangential)?.into(),
            1 => Frictionless.into(),
            2 => Coulomb::new(
                friction,
                match hypothesis as u32 {
                    0 => Hypothesis::Stronge,
                    1 => Hypothesis::Poisson,
                    _ => Hypothesis::Newton,
                },
            )?
            .into(),
            _ => ChatterjeeRuina::new(tangential, friction)?.into(),
        };
        Law::new(normal, rule)
    }
}
