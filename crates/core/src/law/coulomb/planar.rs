//! Slip along a line: the contact velocity is piecewise linear in the normal impulse.

use super::{Coulomb, Hypothesis, Sliding};
use crate::law::{AxialCompliance, Compliant, Response};
use crate::math::{Vector, Vectors};
use crate::simd::Pack;
use pulp::Simd;

/// The contact velocity as a function of the normal impulse p: piecewise linear, with a kink at `stop`.
struct PiecewiseLinear<S: Simd> {
    /// Impulse p_s at which the slip velocity vanishes; infinite if it never does.
    stop: Pack<S>,
    /// dv_c^n/dp before and after p_s. The first may be negative (jamming): the contact then sticks before it separates.
    first: Pack<S>,
    second: Pack<S>,
    /// dP_u/dp before and after p_s.
    first_friction: Pack<S>,
    second_friction: Pack<S>,
}

impl<S: Simd> Sliding<S> for AxialCompliance<Pack<S>> {
    #[inline(always)]
    fn slide(
        &self,
        rule: &Coulomb,
        velocity: Vectors<S>,
        restitution: Pack<S>,
    ) -> Response<Pack<S>> {
        let path = PiecewiseLinear::new(self, velocity.x, rule.friction);
        let (normal, separation_speed) = path.end(velocity.z.abs(), restitution, rule.hypothesis);
        Response {
            impulse: Vector::new(path.friction(normal), normal * 0.0, normal),
            separation_speed,
        }
    }
}

impl<S: Simd> PiecewiseLinear<S> {
    #[inline(always)]
    fn new(k: &AxialCompliance<Pack<S>>, along: Pack<S>, friction: f64) -> Self {
        let slip = along.abs();
        let zero = Pack::splat(slip.simd(), 0.0);
        let (nn, uu) = (k.nn(), k.uu());
        let coupling = k.nu();

        let backward = along.lt(0.0);
        let ahead = backward.select(-coupling, coupling); // K_nu, with u in the direction of the slip velocity
        let braking = uu.mul_add(friction, -ahead); // −d|slip|/dp
        let stop = zero.lt(braking).select(slip / braking, f64::INFINITY);
        let sticks = coupling.abs().le(uu * friction);
        Self {
            stop: slip.eq(0.0).select(0.0, stop),
            first: ahead.mul_add(-friction, nn),
            second: sticks.select(k.sticking(), coupling.abs().mul_add(-friction, nn)),
            first_friction: backward.select(friction, -friction),
            second_friction: (-coupling / uu).max(-friction).min(friction),
        }
    }

    /// Normal impulse and normal velocity at the end of the impact.
    #[inline(always)]
    fn end(
        &self,
        speed: Pack<S>,
        restitution: Pack<S>,
        hypothesis: Hypothesis,
    ) -> (Pack<S>, Pack<S>) {
        let rebound = restitution * speed;
        let turn = self.stop.mul_add(self.first, -speed); // normal velocity at p_s
        let early = turn.le(0.0); // the slip velocity vanishes during the compression
        let depth = -turn;
        // One quotient, one root at a time for both cases: of these there are few, and they take longest.
        let last = early.select(depth, speed) / early.select(self.second, self.first);
        let compression = early.select(self.stop + last, last);

        // Where the contact slips to the end of the impact, all three hypotheses give v_c^n′ = −ε_n v_c^n.
        let plain = !early & rebound.le(turn);
        let steady = restitution.mul_add(compression, compression);
        let (impulse, separation) = match hypothesis {
            Hypothesis::Newton => {
                let start = early.select(compression, self.stop);
                let gain = early.select(rebound, rebound - turn);
                (start + gain / self.second, rebound)
            }
            Hypothesis::Poisson => (
                steady,
                early.select(
                    self.second * (restitution * compression),
                    (steady - self.stop).mul_add(self.second, turn),
                ),
            ),
            Hypothesis::Stronge => {
                // Twice the work done against the normal force in the compression: the area of two trapezia.
                let work = self.stop.mul_add(speed + depth, depth * last);
                // Twice the work that is still to be returned after p_s, times dv_c^n/dp before p_s.
                let left = (rebound - turn) * (rebound + turn);
                let late = turn.mul_add(turn, self.second / self.first * left);
                let root = early.select(self.second * work, late).sqrt();
                let separation = early.select(restitution * root, root);
                let gain = early.select(separation, left)
                    / early.select(self.second, self.first * (separation + turn));
                (early.select(compression, self.stop) + gain, separation)
            }
        };
        (
            plain.select(steady, impulse),
            plain.select(rebound, separation),
        )
    }

    /// Tangential impulse P_u at a normal impulse p.
    #[inline(always)]
    fn friction(&self, normal: Pack<S>) -> Pack<S> {
        let slipping = normal.min(self.stop);
        slipping.mul_add(
            self.first_friction,
            (normal - slipping) * self.second_friction,
        )
    }
}
