//! What an impact does: the matrix K of the contact from the full tensor of inertia, and every law from its own definition.

use super::algebra::{Matrix, NORMAL, Vector, cross, minus, norm, plus, solve, times};
use super::friction;
use super::normal::Restitution;
use restitution_core::{
    ChatterjeeRuina, Coulomb, Frictionless, Hypothesis, Law, TangentialRestitution,
};

/// A law by its parameters.
#[derive(Debug, Clone, Copy)]
pub enum Rule {
    Tangential {
        tangential: f64,
    },
    Frictionless,
    Coulomb {
        friction: f64,
        hypothesis: Hypothesis,
    },
    ChatterjeeRuina {
        tangential: f64,
        friction: f64,
    },
}

impl Rule {
    /// The law that the engine is given.
    pub fn law(&self, normal: &Restitution) -> Law<'static> {
        let rule: restitution_core::Rule = match *self {
            Self::Tangential { tangential } => {
                TangentialRestitution::new(tangential).unwrap().into()
            }
            Self::Frictionless => Frictionless.into(),
            Self::Coulomb {
                friction,
                hypothesis,
            } => Coulomb::new(friction, hypothesis).unwrap().into(),
            Self::ChatterjeeRuina {
                tangential,
                friction,
            } => ChatterjeeRuina::new(tangential, friction).unwrap().into(),
        };
        Law::new(normal.normal(), rule).unwrap()
    }
}

/// A contact: what an impulse does to its velocity, and the velocity that it arrives with.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// K, of an impulse at `arm` on a body of this mass.
    pub response: Matrix,
    pub velocity: Vector,
}

/// Impulse, and the normal velocity that it leaves behind.
#[derive(Debug, Clone, Copy)]
pub struct Answer {
    pub impulse: Vector,
    pub separation: f64,
}

/// K = I/m + [**r**]ᵀJ⁻¹[**r**], column by column: what a unit impulse in each direction does.
pub fn response(mass: f64, inertia: &Matrix, arm: Vector) -> Matrix {
    let mut matrix = [[0.0; 3]; 3];
    for column in 0..3 {
        let mut unit = [0.0; 3];
        unit[column] = 1.0;
        let spin = solve(inertia, cross(arm, unit));
        let velocity = plus(times(1.0 / mass, unit), cross(spin, arm));
        for row in 0..3 {
            matrix[row][column] = velocity[row];
        }
    }
    matrix
}

impl Contact {
    /// −v_c^n.
    pub fn approach(&self) -> f64 {
        (-self.velocity[2]).max(0.0)
    }

    /// What a law answers, with this ε_n.
    pub fn answer(&self, rule: &Rule, restitution: f64) -> Answer {
        let v = self.velocity;
        let approach = self.approach();
        let rebound = restitution * approach;
        match *rule {
            Rule::Tangential { tangential } => {
                let after = [tangential * v[0], tangential * v[1], rebound];
                Answer {
                    impulse: solve(&self.response, minus(after, [v[0], v[1], -approach])),
                    separation: rebound,
                }
            }
            Rule::Frictionless => Answer {
                impulse: times((rebound + approach) / self.response[2][2], NORMAL),
                separation: rebound,
            },
            Rule::ChatterjeeRuina {
                tangential,
                friction,
            } => Answer {
                impulse: self.chatterjee_ruina(restitution, tangential, friction),
                separation: rebound,
            },
            Rule::Coulomb {
                friction,
                hypothesis,
            } => friction::follow(self, restitution, friction, hypothesis),
        }
    }

    /// **P** = (1 + e)**P**_I + κ(**P**_II − **P**_I) with κ = 1 + e_t or, by bisection, the largest that stays in the cone.
    fn chatterjee_ruina(&self, restitution: f64, tangential: f64, friction: f64) -> Vector {
        let approach = self.approach();
        let frictionless = times(approach / self.response[2][2], NORMAL); // P_I
        let arriving = [self.velocity[0], self.velocity[1], -approach];
        let sticking = times(-1.0, solve(&self.response, arriving)); // P_II
        let impulse = |share: f64| {
            plus(
                times(1.0 + restitution, frictionless),
                times(share, minus(sticking, frictionless)),
            )
        };
        let outside = |p: Vector| norm([p[0], p[1], 0.0]) > friction * p[2];
        let (mut low, mut high) = (0.0, 1.0 + tangential);
        if !outside(impulse(high)) {
            return impulse(high);
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if outside(impulse(middle)) {
                high = middle;
            } else {
                low = middle;
            }
        }
        impulse(low)
    }
}
