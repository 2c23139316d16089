//! The bounce loop for bodies of any shape, one particle at a time.

use super::lanes::{Impact, ImpactSink, Lost, Pose};
use super::stop::{COLLAPSE_RUN, Limits, StopReason, UNRESOLVED};
use crate::Fault;
use crate::contact::{Departure, Gap, INVISIBLE, LAST, MOST_STEPS};
use crate::law::{Compliance, Law, Respond, Rule};
use crate::math::{Quaternion, Symmetric, Vector, Vectors};
use crate::motion::Rotation;
#[cfg(test)]
use crate::shape::evaluations::{self, Evaluation};
use crate::shape::{Instant, Rigid, up};
use crate::simd::elementary::RANGE;
use crate::simd::{Mask, Pack, one};
use pulp::{Scalar, Simd, WithSimd};

/// Most angle by which the search looks on behind what is certified.
const FAR: f64 = 1.0;
/// From so far behind a step, in its length, it nearly always can be certified that nothing touched.
const BACK: f64 = 0.9;
/// Most angle of an expansion of the rotation: the fourth power of it is less than rounding.
const SOON: f64 = 1.0 / 8192.0;

/// Position and motion of a particle, in the core's units. The horizontal position is omitted, because the motion does not depend on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RigidState {
    /// Height and velocity of the centre of mass.
    pub height: f64,
    pub velocity: Vector,
    /// The rotation from the principal axes to those of space.
    pub attitude: Quaternion,
    /// Angular velocity in the principal axes.
    pub spin: Vector,
}

/// A body, its law and the plane that it bounces on.
pub(super) struct Bouncing<'a> {
    pub body: &'a Rigid,
    pub law: &'a Law<'a>,
    /// tan α.
    pub slope: f64,
    pub limits: Limits,
}

/// A flight and the impact that ends it, compiled for each SIMD level.
struct Flight<'a, 'b> {
    bouncing: &'a Bouncing<'b>,
    start: &'a RigidState,
    departure: Option<Departure>,
    chance: Option<f64>,
}

impl WithSimd for Flight<'_, '_> {
    type Output = Result<(Contact, Bounce), NoImpact>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let contact = self.bouncing.first_contact(self.start, self.departure)?;
        match self.bouncing.collide(&contact, self.chance) {
            Ok(bounce) => Ok((contact, bounce)),
            Err(fault) => Err(NoImpact::Fault(fault)),
        }
    }
}

/// A contact: the flight time to it, the state then, and the part that touches.
struct Contact {
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
        let (mut state, mut departure) = (start, None);
        let (mut clock, mut impacts, mut unresolved) = (0.0, 0, 0);
        let reason = loop {
            if !go_on() {
                break StopReason::Interrupted;
            }
            let flight = Flight {
                bouncing: self,
                start: &state,
                departure,
                chance: self.law.scatters().then(|| chance(impacts as u64)),
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
            let slowest = self.limits.minimum_speed;
            if slowest > 0.0 && 2.0 * self.energies(&state).1 < slowest * slowest {
                break StopReason::SpeedBelowThreshold;
            } else if self.level(&state) < self.limits.settled {
                break StopReason::Settled;
            } else if unresolved == COLLAPSE_RUN {
                break StopReason::Collapse;
            } else if impacts == self.limits.impacts {
                break StopReason::ImpactsReached;
            }
        };
        sink.end(particle, impacts, reason);
        Ok(())
    }

    /// The first contact of the flight from a state, in which a part may be leaving the plane.
    #[inline(always)]
    fn first_contact(
        &self,
        start: &RigidState,
        departure: Option<Departure>,
    ) -> Result<Contact, NoImpact> {
        let body = self.body;
        let mut rotation = Rotation::new(body.top, start.attitude, start.spin);
        let turn = &body.top.bounds(start.spin);
        let fastest = turn.fastest;
        if let Some(left) = departure.filter(|left| left.speed <= 0.0)
            && self.rests(start, left)
        {
            return Err(NoImpact::Ends(StopReason::Collapse));
        }
        // While the centre of mass is higher than the body reaches, nothing touches.
        let above = start.velocity.z * start.velocity.z + 2.0 * (start.height - 1.0);
        let root = above.max(0.0).sqrt();
        let (up_at, down_at) = (start.velocity.z - root, start.velocity.z + root);
        let skip = |time: f64| {
            if above > 0.0 && up_at <= time {
                time.max(down_at)
            } else {
                time
            }
        };
        // The rotation where it was last computed, not expanded.
        let mut known = (0.0, (start.attitude, start.spin));
        // Nothing touches up to `certain`; `time`, at which the body is looked at, may be later. `near` is the part that may be first, and the time
        // up to which no other touches.
        let (mut certain, mut time) = (0.0, 0.0);
        let mut near = departure.map(|left| (left.part, 0.0));
        let looks_back = body.skin.looks_back();
        let mut looks_on = looks_back;
        for _ in 0..MOST_STEPS {
            if fastest * time > RANGE {
                return Err(NoImpact::Ends(StopReason::NeverLands));
            }
            let (attitude, spin) = if fastest * (time - known.0).abs() <= SOON {
                let (attitude, spin) = known.1;
                body.top.expanded(attitude, spin, time - known.0)
            } else {
                #[cfg(test)]
                evaluations::add(Evaluation::Attitude);
                known = (time, rotation.at(time));
                known.1
            };
            let from = time;
            let at = self.instant(start, from, attitude, spin);
            let within =
                |later: f64, alone: f64| later <= alone && fastest * (later - from).abs() <= FAR;
            let contact = |gap: Gap, certain: f64, alone: f64| {
                let contact = from + gap.certainly_closes(certain - from, turn.whole)?;
                within(contact, alone).then_some(contact)
            };
            if let Some((part, alone)) = near.filter(|_| certain < time) {
                let past = body.skin.past(part, &at, turn, time - certain);
                let Some(ago) = past.clear else {
                    (time, looks_on) = (certain, false);
                    continue;
                };
                certain = time - ago;
                let ahead = past.gap.closes();
                let end = time + ahead;
                if (1.0 + turn.whole) * ahead * ahead <= INVISIBLE
                    && (ahead < 0.0 || past.gap.rate < 0.0 && ahead <= LAST * end)
                    && end <= alone
                {
                    let then = body.top.expanded(attitude, spin, ahead);
                    return Ok(self.land(start, end, part, then, turn.whole));
                }
                // Nothing more is to be known here where the contact is, or if there was one since `certain`.
                if let Some(contact) = contact(past.gap, certain, alone) {
                    time = contact;
                    continue;
                } else if ago > 0.0 {
                    time = certain;
                    continue;
                }
            }
            let left = departure.filter(|_| time == 0.0);
            let clear = if above > 0.0 && time < up_at {
                up_at - time
            } else {
                f64::INFINITY
            };
            let beside = near.map(|(part, alone)| (part, alone - time));
            let step = body.skin.step(&at, turn, left, beside, clear);
            let end = time + step.length;
            let square = step.length * step.length;
            if step.closes && step.bound * square <= INVISIBLE && step.length <= LAST * end {
                // The body turns by as little, but where all of it is near its centre of mass.
                let then = if turn.whole * square <= INVISIBLE {
                    body.top.expanded(attitude, spin, step.length)
                } else {
                    rotation.at(end)
                };
                return Ok(self.land(start, end, step.part, then, turn.whole));
            }
            certain = skip(end.max(time * (1.0 + f64::EPSILON)));
            let alone = time + step.alone;
            near = Some((step.part, alone));
            time = certain;
            if !std::mem::replace(&mut looks_on, looks_back) || alone <= certain {
                continue;
            }
            let gap = Gap {
                width: step.width,
                rate: step.rate,
                acceleration: body.skin.acceleration(step.part, &at),
            };
            // Or else almost as far behind `certain` as that is from here.
            let further = certain + BACK * (certain - from);
            let expected = from + gap.closes();
            let soon = certain < expected && expected < further;
            if let Some(contact) = contact(gap, certain, alone) {
                time = contact;
            } else if !soon && within(further, alone) {
                time = further;
            }
        }
        Err(NoImpact::Unconverged)
    }

    /// The body at a time of the flight from `start`.
    #[inline(always)]
    fn instant(
        &self,
        start: &RigidState,
        time: f64,
        attitude: Quaternion,
        spin: Vector,
    ) -> Instant {
        let up = up(attitude);
        let turning = up.cross(spin);
        let speed = start.velocity.z;
        Instant {
            height: start.height + time * (speed - 0.5 * time),
            rate: speed - time,
            acceleration: -1.0,
            up,
            turning,
            bending: turning.cross(spin) + up.cross(self.body.top.change(spin)),
        }
    }

    /// The state at a contact. The height is that at which the part touches.
    #[inline(always)]
    fn land(
        &self,
        start: &RigidState,
        time: f64,
        part: usize,
        (attitude, spin): (Quaternion, Vector),
        turn: f64,
    ) -> Contact {
        let normal = up(attitude);
        let pull = Vector::new(self.slope, 0.0, -1.0);
        let arm = self.body.skin.nearest(part, normal, normal.cross(spin));
        Contact {
            time,
            state: RigidState {
                height: -normal.dot(arm),
                velocity: pull.mul_add(time, start.velocity),
                attitude,
                spin,
            },
            part,
            arm,
            size: (1.0 + turn) * time * time,
        }
    }

    /// True if the part on the plane, which has no normal speed, stays there: f″ ≤ 0, and no other part is about to touch as well.
    fn rests(&self, state: &RigidState, left: Departure) -> bool {
        let at = self.instant(state, 0.0, state.attitude, state.spin);
        let skin = &self.body.skin;
        skin.acceleration(left.part, &at) <= 0.0 && !skin.another_touches(left, &at)
    }

    /// The motion after a contact; where ε_n scatters it is drawn with a uniform number.
    #[inline(always)]
    fn collide(&self, contact: &Contact, chance: Option<f64>) -> Result<Bounce, Fault> {
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
        let answer = match chance {
            Some(chance) => self.law.answer_drawn(&compliance, at_contact, chance)?,
            None => self.law.answer(&compliance, at_contact)?,
        };
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
        let moving = match (self.law.custom, self.law.rule) {
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
        contact: &Contact,
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
            part: one((self.body.skin.number(contact.part) + 1) as f64),
            approach: one(bounce.approach),
            pose: RigidPose {
                body: self.body,
                before,
                after,
            },
            active: Mask::splat(Scalar::new(), true),
        };
        sink.event(0, &impact);
        sink.settle(0..1);
    }
}

/// The pose of a body of any shape.
struct RigidPose<'a> {
    body: &'a Rigid,
    before: &'a RigidState,
    after: &'a RigidState,
}

type Lane = Pack<Scalar, 1>;

fn lane(v: Vector) -> Vectors<Scalar, 1> {
    Vectors {
        x: one(v.x),
        y: one(v.y),
        z: one(v.z),
    }
}

impl Pose<Scalar, 1> for RigidPose<'_> {
    fn height(&self) -> Lane {
        one(self.before.height)
    }

    fn tilt(&self) -> (Lane, Lane) {
        (one(f64::NAN), one(f64::NAN))
    }

    fn axis(&self) -> Vectors<Scalar, 1> {
        lane(Vector::new(f64::NAN, f64::NAN, f64::NAN))
    }

    fn attitude(&self) -> [Lane; 4] {
        let Quaternion { w, x, y, z } = self.before.attitude * self.body.axes.inverse();
        [w, x, y, z].map(one)
    }

    fn velocities(&self) -> [Vectors<Scalar, 1>; 2] {
        [self.before, self.after].map(|state| lane(state.velocity))
    }

    fn spin_before(&self) -> Vectors<Scalar, 1> {
        lane(self.before.attitude.rotate(self.before.spin))
    }

    fn spin_after(&self) -> Vectors<Scalar, 1> {
        lane(self.after.attitude.rotate(self.after.spin))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drop::{About, Orientation, Run, Spin};
    use crate::random::pair;
    use crate::shape::{AnyBody, Heights, Inertia, Matter, RigidBall, Roughness};
    use crate::{Frictionless, Level, Monitor, Resources};

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
    /// [`Past::clear`](crate::contact::Past) says so, and its second difference is f″.
    #[test]
    fn nothing_touched_where_the_past_is_clear() {
        for (name, body) in &bodies()[..7] {
            let law = Law::new(1.0, Frictionless).unwrap();
            let bouncing = Bouncing {
                body,
                law: &law,
                slope: 0.0,
                limits: Limits {
                    impacts: 1,
                    minimum_speed: 0.0,
                    settled: 0.0,
                },
            };
            let (mut clear, mut overlaps) = (0, 0);
            for i in 0..500 {
                let uniform = |number: u64| pair(7, 8 * i + number);
                let ((a, b), (c, d)) = (uniform(0), uniform(1));
                let spin = Vector::new(a - 0.5, b - 0.5, c - 0.5) * (8.0 * d);
                let ((a, b), (c, d)) = (uniform(2), uniform(3));
                let attitude = Quaternion::new(a - 0.5, b - 0.5, c - 0.5, d - 0.5).normalized();
                let ((speed, time), (since, width)) = (uniform(4), uniform(5));
                let mut rotation = Rotation::new(body.top, attitude, spin);
                let turn = &body.top.bounds(spin);
                let mut start = RigidState {
                    height: 0.0,
                    velocity: Vector::new(0.0, 0.0, -2.0 * speed),
                    attitude,
                    spin,
                };
                let mut at = |start: &RigidState, time: f64| {
                    let (attitude, spin) = rotation.at(time);
                    bouncing.instant(start, time, attitude, spin)
                };
                let now = at(&start, time);
                start.height = body.skin.support(now.up) - now.height + 0.02 * (width - 0.5);
                let now = at(&start, time);
                let part = body.skin.step(&now, turn, None, None, f64::INFINITY).part;
                let mut gap = |time: f64| {
                    let at = at(&start, time);
                    at.height + at.up.dot(body.skin.nearest(part, at.up, at.turning))
                };
                let past = body.skin.past(part, &now, turn, since);
                assert!((gap(time) - past.gap.width).abs() < 1e-14, "{name}");
                if body.skin.looks_back() {
                    let [before, here, after] = [-1e-4, 0.0, 1e-4].map(|s| gap(time + s));
                    let second = (before - 2.0 * here + after) * 1e8;
                    let error = (second - past.gap.acceleration).abs();
                    assert!(
                        error < 1e-4 * (1.0 + turn.whole * turn.whole),
                        "{name}: {error}"
                    );
                }
                if let Some(ago) = past.clear {
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
                gravity: 9.81,
                orientation: Orientation::Isotropic,
                spin: Spin::Random {
                    low: 10.0,
                    high: 90.0,
                    about: About::Isotropic,
                },
                release_velocity: Vector::default(),
                incline: 0.0,
                minimum_speed: 0.0,
                settled: 0.0,
                seed: 1,
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
