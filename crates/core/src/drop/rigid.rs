//! The bounce loop for bodies of any shape, one particle at a time.

use super::lanes::{Impact, ImpactSink, Lost, Pose};
use super::plan::{Plan, RigidState};
use super::stop::{COLLAPSE_RUN, StopReason, UNRESOLVED};
use crate::Fault;
use crate::contact::{Departure, Fall, FirstContact, NoContact};
use crate::law::{Compliance, Respond, Rule};
use crate::math::{Symmetric, Vector, Vectors};
use crate::shape::{Rigid, up};
use crate::simd::{Mask, Pack, one};
use pulp::{Scalar, Simd, WithSimd};

/// g, in units of itself.
const GRAVITY: f64 = 1.0;

/// A body, its law and the plane that it bounces on.
pub(super) struct Bouncing<'a> {
    pub plan: &'a Plan<'a>,
    pub body: &'a Rigid,
}

/// A flight and the impact that ends it, compiled for each SIMD level.
struct FlightAndImpact<'a, 'b> {
    bouncing: &'a Bouncing<'b>,
    start: &'a RigidState,
    departure: Option<Departure>,
    chance: Option<f64>,
}

impl WithSimd for FlightAndImpact<'_, '_> {
    type Output = Result<(Landing, Bounce), NoImpact>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let contact = self.bouncing.first_contact(self.start, self.departure)?;
        let bounce = self.bouncing.collide(&contact, self.chance)?;
        Ok((contact, bounce))
    }
}

/// A contact: the flight time to it, the state then, and the part that touches.
struct Landing {
    time: f64,
    state: RigidState,
    part: usize,
    /// Where it touches, from the centre of mass and in the principal axes.
    arm: Vector,
    /// M T², with M the bound on |f″| and T the flight time.
    size: f64,
}

/// The outcome of a flight without an impact.
enum NoImpact {
    Ends(StopReason),
    Unconverged,
    Fault(Fault),
}

/// The outcome of an impact.
struct Bounce {
    after: RigidState,
    departure: Departure,
    approach: f64,
    /// The kinetic energy that the impact adds, in m g R.
    gain: f64,
}

impl Bouncing<'_> {
    /// Follows a particle from impact to impact until it stops. `chance` gives the uniform number of an impact, for an ε_n that scatters.
    pub fn bounce<S: Simd>(
        &self,
        simd: S,
        (particle, start): (usize, RigidState),
        chance: impl Fn(u64) -> f64,
        sink: &mut impl ImpactSink,
        go_on: impl Fn() -> bool,
    ) -> Result<(), Lost> {
        let lost = |impacts, fault| Lost {
            particle,
            impacts,
            fault,
        };
        let limits = self.plan.limits();
        let (mut state, mut departure) = (start, None);
        let (mut clock, mut impacts, mut unresolved) = (0.0, 0, 0);
        let reason = loop {
            if !go_on() {
                break StopReason::Interrupted;
            }
            let flight = FlightAndImpact {
                bouncing: self,
                start: &state,
                departure,
                chance: self.plan.law.scatters().then(|| chance(impacts as u64)),
            };
            let (contact, bounce) = match simd.vectorize(flight) {
                Ok(impact) => impact,
                Err(NoImpact::Ends(reason)) => break reason,
                Err(NoImpact::Unconverged) => return Err(lost(impacts, None)),
                Err(NoImpact::Fault(fault)) => return Err(lost(impacts, Some(Box::new(fault)))),
            };
            clock += contact.time;
            self.report((particle, impacts, clock), &contact, &bounce, sink);
            (state, departure) = (bounce.after, Some(bounce.departure));
            impacts += 1;
            unresolved = if contact.size < UNRESOLVED {
                unresolved + 1
            } else {
                0
            };
            let slowest = limits.minimum_speed;
            if slowest > 0.0 && 2.0 * self.energies(&state).1 < slowest * slowest {
                break StopReason::SpeedBelowThreshold;
            } else if self.level(&state) < limits.settled {
                break StopReason::Settled;
            } else if unresolved == COLLAPSE_RUN {
                break StopReason::Collapse;
            } else if impacts == limits.impacts {
                break StopReason::ImpactsReached;
            }
        };
        sink.end(particle, impacts, reason);
        Ok(())
    }

    /// The first contact of the flight from a state, in which a part may be leaving the plane. The height is that at which the part touches.
    #[inline(always)]
    fn first_contact(
        &self,
        start: &RigidState,
        departure: Option<Departure>,
    ) -> Result<Landing, NoImpact> {
        let fall = Fall {
            height: start.height,
            speed: start.velocity.z,
            gravity: GRAVITY,
        };
        let rotation = (start.attitude, start.spin);
        let search = FirstContact::new(self.body, fall, rotation, departure);
        let bound = search.bound();
        let touch = search.find().map_err(|none| match none {
            NoContact::Rests => NoImpact::Ends(StopReason::Collapse),
            NoContact::Never => NoImpact::Ends(StopReason::NeverLands),
            NoContact::Unconverged => NoImpact::Unconverged,
        })?;
        let ((attitude, spin), time) = (touch.rotation, touch.time);
        let normal = up(attitude);
        let pull = Vector::new(self.plan.slope, 0.0, -1.0) * GRAVITY;
        let arm = self
            .body
            .surface
            .nearest(touch.part, normal, normal.cross(spin));
        Ok(Landing {
            time,
            state: RigidState {
                height: -normal.dot(arm),
                velocity: pull.mul_add(time, start.velocity),
                attitude,
                spin,
            },
            part: touch.part,
            arm,
            size: bound * time * time,
        })
    }

    /// The motion after a contact; where ε_n scatters it is drawn with a uniform number.
    #[inline(always)]
    fn collide(&self, contact: &Landing, chance: Option<f64>) -> Result<Bounce, NoImpact> {
        let RigidState {
            velocity,
            attitude,
            spin,
            ..
        } = contact.state;
        let arm = contact.arm;
        let inverse = self.body.top.moments().map(|moment| 1.0 / moment);
        let arm_in_space = attitude.rotate(arm);
        let compliance =
            Compliance::of_body(1.0, &Symmetric::turned(inverse, attitude), arm_in_space);
        let at_contact = velocity + attitude.rotate(spin.cross(arm)); // (7)
        let answer = self.plan.law.answer_drawn(&compliance, at_contact, chance);
        let answer = answer.map_err(NoImpact::Fault)?;
        if answer.impulse.z.is_nan() {
            return Err(NoImpact::Unconverged);
        }
        let impulse = answer.impulse;
        let torque = arm.cross(attitude.inverse().rotate(impulse));
        let [x, y, z] = inverse;
        let approach = (-at_contact.z).max(0.0);
        // P·(v_c + v_c′)/2. The difference of the energies has the rounding error of the spin, which is large where a moment of inertia is small.
        let met = at_contact * 2.0 + compliance.change(impulse);
        let work = impulse.z * (answer.separation_speed - approach);
        Ok(Bounce {
            after: RigidState {
                velocity: velocity + impulse,
                spin: spin + Vector::new(x * torque.x, y * torque.y, z * torque.z), // (11)
                ..contact.state
            },
            departure: Departure {
                part: contact.part,
                speed: answer.separation_speed,
            },
            approach,
            gain: 0.5 * (impulse.x * met.x + impulse.y * met.y + work),
        })
    }

    /// The energy in m g R that can lift the centre of mass: without friction the horizontal motion stays as it is.
    fn level(&self, state: &RigidState) -> f64 {
        let v = state.velocity;
        let moving = match (self.plan.law.custom, self.plan.law.rule) {
            (None, Rule::Frictionless(_)) => v.z * v.z,
            _ => v.dot(v),
        };
        state.height + 0.5 * (self.body.top.twice_energy(state.spin) + moving)
    }

    /// Kinetic energies of the rotation and of all motion, in m g R.
    fn energies(&self, state: &RigidState) -> (f64, f64) {
        let rotation = 0.5 * self.body.top.twice_energy(state.spin);
        (
            rotation,
            rotation + 0.5 * state.velocity.dot(state.velocity),
        )
    }

    /// Hands an impact to the sink.
    fn report(
        &self,
        (particle, number, clock): (usize, usize, f64),
        contact: &Landing,
        bounce: &Bounce,
        sink: &mut impl ImpactSink,
    ) {
        let (before, after) = (&contact.state, &bounce.after);
        let (rotation, energy_before) = self.energies(before);
        let impact = Impact {
            particle: one(particle as f64),
            number: one(number as f64),
            time: one(clock),
            fall: one(-before.velocity.z),
            rise: one(after.velocity.z),
            rotation: one(rotation),
            energy_before: one(energy_before),
            energy_after: one(energy_before + bounce.gain),
            part: one((self.body.surface.number(contact.part) + 1) as f64),
            approach: one(bounce.approach),
            pose: RigidPose {
                body: self.body,
                before,
                after,
            },
            active: Mask::splat(Scalar::new(), true),
        };
        sink.impact(0, &impact);
        sink.settle(0..1);
    }
}

/// The pose of a body of any shape.
struct RigidPose<'a> {
    body: &'a Rigid,
    before: &'a RigidState,
    after: &'a RigidState,
}

type Lane = Pack<Scalar>;

impl Pose<Scalar> for RigidPose<'_> {
    fn height(&self) -> Lane {
        one(self.before.height)
    }

    fn tilt(&self) -> (Lane, Lane) {
        (one(f64::NAN), one(f64::NAN))
    }

    fn axis(&self) -> Vectors<Scalar> {
        Vector::new(f64::NAN, f64::NAN, f64::NAN).in_lane()
    }

    fn attitude(&self) -> [Lane; 4] {
        let attitude = self.before.attitude * self.body.axes.inverse();
        attitude.parts().map(one)
    }

    fn velocities(&self) -> [Vectors<Scalar>; 2] {
        [self.before, self.after].map(|state| state.velocity.in_lane())
    }

    fn spin_before(&self) -> Vectors<Scalar> {
        self.before.attitude.rotate(self.before.spin).in_lane()
    }

    fn spin_after(&self) -> Vectors<Scalar> {
        self.after.attitude.rotate(self.after.spin).in_lane()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drop::{About, Orientation, Run, Spin};
    use crate::math::Quaternion;
    use crate::random::pair;
    use crate::shape::{AnyBody, Heights, Inertia, Matter, RigidBall, Roughness};
    use crate::shape::{each_surface, evaluations};
    use crate::{Frictionless, Law, Level, Monitor, Resources};

    /// Of R = 10 mm, as in `benchmarks/bodies.py`.
    fn bodies() -> Vec<(&'static str, Rigid)> {
        let ball = |[x, y, z, radius]: [f64; 4]| RigidBall {
            centre: Vector::new(x, y, z),
            radius,
        };
        let clump = |balls: &[RigidBall]| Rigid::clump(balls, 2500.0, Matter::Sum).unwrap();
        let corners = [
            [5e-3, 5e-3, 5e-3, 5e-3],
            [5e-3, -5e-3, -5e-3, 5e-3],
            [-5e-3, 5e-3, -5e-3, 6e-3],
            [-5e-3, -5e-3, 5e-3, 4e-3],
        ];
        let within = |i: u64| {
            let ((x, y), (z, u)) = (pair(1, 2 * i), pair(1, 2 * i + 1));
            let place = Vector::new(2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * z - 1.0);
            let place = place * (3e-3 * (1.0 + u) / place.norm());
            ball([place.x, place.y, place.z, 4e-3])
        };
        let many = |count: u64| clump(&(0..count).map(within).collect::<Vec<_>>());
        let rough = |asperities: usize| {
            let roughness = Roughness {
                asperities,
                radius: 1e-5,
                heights: Heights::Equal(1e-5),
                seed: 1,
            };
            let inertia = Inertia {
                mass: 1.0,
                centre: Vector::default(),
                tensor: Symmetric::diagonal([4e-5; 3]),
            };
            Rigid::rough(&[ball([0.0, 0.0, 0.0, 1e-2])], false, inertia, &roughness).unwrap()
        };
        let corner = |i: usize| {
            let [x, y, z] = [0, 1, 2].map(|axis| 1e-2 * ((i >> axis & 1) as f64 - 0.5));
            Vector::new(x, y, z)
        };
        let vertices: Vec<_> = (0..8).map(corner).collect();
        let sides = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let halves = sides
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let die = Rigid::polyhedron(&vertices, &halves.collect::<Vec<_>>(), 2500.0);
        vec![
            ("die", die.unwrap()),
            ("clump of 4 spheres", clump(&corners.map(ball))),
            ("clump of 16 spheres", many(16)),
            ("clump of 1000 spheres", many(1000)),
            (
                "triaxial ellipsoid",
                Rigid::ellipsoid([1e-2, 8e-3, 6e-3], 2500.0).unwrap(),
            ),
            (
                "superellipsoid",
                Rigid::superellipsoid([1e-2, 8e-3, 6e-3], [4.0, 3.0], 2500.0).unwrap(),
            ),
            ("sphere with 10² asperities", rough(100)),
            ("sphere with 10⁴ asperities", rough(10_000)),
            ("sphere with 10⁶ asperities", rough(1_000_000)),
        ]
    }

    /// From a time at which a part has just touched or is about to, its gap is followed back along the exact rotation: it is positive where
    /// the bound backward says so, and its second difference is f″.
    #[test]
    fn nothing_touched_where_the_past_is_clear() {
        for (name, body) in &bodies()[..7] {
            let (mut clear, mut overlaps) = (0, 0);
            for i in 0..500 {
                let uniform = |number: u64| pair(7, 8 * i + number);
                let ((a, b), (c, d)) = (uniform(0), uniform(1));
                let spin = Vector::new(a - 0.5, b - 0.5, c - 0.5) * (8.0 * d);
                let ((a, b), (c, d)) = (uniform(2), uniform(3));
                let attitude = Quaternion::new(a - 0.5, b - 0.5, c - 0.5, d - 0.5).normalized();
                let ((speed, time), (since, width)) = (uniform(4), uniform(5));
                let turn = &body.top.bounds(spin);
                let from = |height: f64| {
                    let fall = Fall {
                        height,
                        speed: -2.0 * speed,
                        gravity: GRAVITY,
                    };
                    FirstContact::new(body, fall, (attitude, spin), None)
                };
                let now = from(0.0).look(time).at;
                let low = body.surface.support(now.up) - now.height + 0.02 * (width - 0.5);
                let mut flight = from(low);
                let now = flight.look(time).at;
                let part = each_surface!(&body.surface, surface => {
                    surface.step(&now, turn, None, None, f64::INFINITY).part
                });
                let mut gap = |time: f64| {
                    let at = flight.look(time).at;
                    at.height + at.up.dot(body.surface.nearest(part, at.up, at.turning))
                };
                let (backward, looks_back) = each_surface!(&body.surface, surface => {
                    (surface.backward(part, &now, turn, since), surface.looks_back())
                });
                assert!((gap(time) - backward.gap.width).abs() < 1e-14, "{name}");
                if looks_back {
                    let [before, here, after] = [-1e-4, 0.0, 1e-4].map(|s| gap(time + s));
                    let second = (before - 2.0 * here + after) * 1e8;
                    let error = (second - backward.gap.acceleration).abs();
                    assert!(
                        error < 1e-4 * (1.0 + turn.whole * turn.whole),
                        "{name}: {error}"
                    );
                }
                if let Some(ago) = backward.clear {
                    clear += 1;
                    overlaps += i32::from(ago > 0.0);
                    for k in 0..=20 {
                        let back = since + (ago - since) * f64::from(k) / 20.0;
                        assert!(gap(time - back) > -1e-14, "{name}: {back} before");
                    }
                }
            }
            assert!(clear > 50 && overlaps > 10, "{name}: {clear}, {overlaps}");
        }
    }

    /// `docs/shapes.md` has a row for each body: how often an impact needs the attitude of the body, the gap of a sphere or vertex or the support
    /// function, and the bounds of four nodes of the tree.
    #[test]
    fn the_page_says_what_an_impact_evaluates() {
        // The crate by itself is without the page.
        let Ok(page) = std::fs::read_to_string("../../docs/shapes.md") else {
            return;
        };
        let mut missing = String::new();
        for (name, body) in bodies() {
            let run = Run {
                body: AnyBody::Rigid(&body),
                law: Law::new(0.98, Frictionless).unwrap(),
                particles: 50,
                impacts: 200,
                release_height: 0.08.into(),
                orientation: Orientation::Isotropic,
                spin: Spin::Random {
                    low: 10.0,
                    high: 90.0,
                    about: About::Isotropic,
                },
                seed: 1,
                ..Run::default()
            };
            let resources = Resources {
                threads: 1,
                level: Level::best(),
            };
            evaluations::taken();
            run.simulate(resources, &Monitor::default()).unwrap();
            let impacts = (run.particles * run.impacts) as f64;
            let [attitudes, gaps, quarters, supports] =
                evaluations::taken().map(|count| count as f64 / impacts);
            let row = format!(
                "| {name} | {attitudes:.1} | {:.1} | {quarters:.1} |",
                gaps + supports
            );
            if !page.contains(&row) {
                missing += &format!("{row}\n");
            }
        }
        assert!(missing.is_empty(), "docs/shapes.md lacks\n{missing}");
    }
}
