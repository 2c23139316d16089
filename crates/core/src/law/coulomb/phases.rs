//! The phases of an impact with Coulomb friction, whatever its slip does: compression, restitution, and in a jam once more of either.
//!
//! A contact that approaches again before its restitution is over is compressed again. The restitution ends where the normal force has
//! returned ε_n² of the most work that it had taken so far, or where p is 1 + ε_n times that at the end of the last compression. Newton's
//! hypothesis knows no compression: the impact is over where v_n is first ε_n times the speed of approach.

use super::Hypothesis;

/// An impact, as far as it has come.
pub(super) struct ImpactSoFar {
    pub restitution: f64,
    pub hypothesis: Hypothesis,
    /// The speed of approach.
    pub approach: f64,
    /// v_n.
    pub speed: f64,
    /// p, and the tangential impulse.
    pub normal: f64,
    pub friction: [f64; 2],
    /// True if the contact is being compressed, or has Newton's hypothesis to fulfil.
    pub compressing: bool,
    /// p at the beginning of this compression or restitution, and the work ∫v_n dp until then and since.
    began: f64,
    balance: f64,
    work: f64,
    /// The most work that the contact has taken so far.
    taken: f64,
    /// The amount that this restitution has to give: impulse under Poisson's, work under Stronge's hypothesis.
    owed: f64,
}

/// The sums over a part of the path.
pub(super) struct Gain {
    pub normal: f64,
    pub friction: [f64; 2],
    pub speed: f64,
    pub work: f64,
}

impl ImpactSoFar {
    /// A contact that arrives with this speed.
    pub fn new(hypothesis: Hypothesis, restitution: f64, approach: f64) -> Self {
        Self {
            restitution,
            hypothesis,
            approach,
            speed: -approach,
            normal: 0.0,
            friction: [0.0; 2],
            compressing: true,
            began: 0.0,
            balance: 0.0,
            work: 0.0,
            taken: 0.0,
            owed: 0.0,
        }
    }

    /// The impulse, or under Stronge's hypothesis the work, that the restitution has still to give.
    pub fn missing(&self) -> f64 {
        match self.hypothesis {
            Hypothesis::Stronge => self.owed - self.work,
            _ => self.owed - (self.normal - self.began),
        }
    }

    /// The impulse until the present phase is over, and until the impact is, if dv_n/dp stays what it is; infinite if they then never are.
    pub fn left(&self, stiffness: f64) -> [f64; 2] {
        if self.compressing {
            if stiffness <= 0.0 {
                return [f64::INFINITY; 2];
            }
            let left = (self.wanted_speed() - self.speed) / stiffness;
            let more = match self.hypothesis {
                Hypothesis::Newton => 0.0,
                _ => self.restitution * (self.normal + left),
            };
            return [left, left + more];
        }
        let mut left = self.missing();
        if self.hypothesis == Hypothesis::Stronge {
            let square = self.speed * self.speed + 2.0 * stiffness * left;
            left = if square < 0.0 {
                f64::INFINITY
            } else {
                2.0 * left / (self.speed + square.sqrt())
            };
        }
        [left; 2]
    }

    /// Returns whether the restitution has to give only a small part of this.
    pub fn is_almost_over(&self, gain: &Gain) -> bool {
        let whole = match self.hypothesis {
            Hypothesis::Stronge => gain.work,
            _ => gain.normal,
        };
        !self.compressing && self.missing() < 0.1 * whole
    }

    pub fn add(&mut self, gain: &Gain) {
        self.normal += gain.normal;
        for i in 0..2 {
            self.friction[i] += gain.friction[i];
        }
        self.speed += gain.speed;
        self.work += gain.work;
    }

    /// v_n at which the compression, or under Newton's hypothesis the impact, is over.
    pub fn wanted_speed(&self) -> f64 {
        if self.hypothesis == Hypothesis::Newton {
            self.restitution * self.approach
        } else {
            0.0
        }
    }

    /// The present phase has come to its end; whether that is the end of the impact.
    pub fn reached(&mut self) -> bool {
        if !self.compressing {
            return true;
        }
        self.speed = self.wanted_speed();
        if self.hypothesis == Hypothesis::Newton {
            return true;
        }
        self.turn_over();
        let e = self.restitution;
        self.taken = self.taken.max(-self.balance);
        self.owed = match self.hypothesis {
            Hypothesis::Stronge => e * e * self.taken - (self.taken + self.balance),
            _ => e * self.normal,
        };
        self.owed <= 0.0
    }

    /// The contact approaches again before the restitution is over; never the end of the impact.
    pub fn pressed_again(&mut self) -> bool {
        self.speed = 0.0;
        self.turn_over();
        false
    }

    fn turn_over(&mut self) {
        self.compressing = !self.compressing;
        self.began = self.normal;
        self.balance += self.work;
        self.work = 0.0;
    }

    /// Returns whether the end of the present phase, or a new compression, lies at or before a place that is so far away along a piece on
    /// which v_n is monotone.
    pub fn passes(&self, gain: &Gain) -> bool {
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
}
