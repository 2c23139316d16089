//! The recorded variables of an impact and of a particle, in SI units.

use super::{Bounces, Height, Impact, Plan, Pose, StopReason, bounce_block};
use crate::Error;
use crate::law::{Law, Normal};
use crate::math::Quaternion;
use crate::record::{Columns, Event, Process, Sink, Source, Variable, When, variables};
use crate::shape::AnyBody;
use crate::simd::elementary::{angle, angle_in_lanes};
use crate::simd::{Level, Mask, Pack};
use crate::threads::Monitor;
use pulp::Simd;
use std::ops::Range;

impl Process for Bounces {
    type Plan<'a> = Plan<'a>;
    type Row = AtRelease;
    type Reason = StopReason;
    const EVENTS: &'static [Variable] = PER_IMPACT;
    const ROWS: &'static [Variable] = PER_PARTICLE;
    const REASONS: &'static [&'static str] = &StopReason::NAMES;
    const INTERRUPTED: StopReason = StopReason::Interrupted;

    fn most(plan: &Plan<'_>) -> usize {
        plan.run.impacts
    }

    fn has(plan: &Plan<'_>, about: &Variable) -> bool {
        let axis = matches!(plan.run.body, AnyBody::Revolution(_));
        match about.when {
            When::HeightVaries => matches!(plan.run.release_height, Height::Random { .. }),
            When::InSpace => !plan.at_rest,
            When::InSpaceOfAxis => !plan.at_rest && axis,
            when => is_usual(when, axis),
        }
    }

    fn row(number: usize) -> AtRelease {
        AtRelease(number)
    }

    fn number(reason: StopReason) -> usize {
        reason as usize
    }

    fn units(plan: &Plan<'_>) -> (f64, f64) {
        (plan.scales.speed, plan.run.origin())
    }

    fn simulate(
        source: &impl Source<Of = Self>,
        rows: Range<usize>,
        level: Level,
        monitor: &Monitor,
        sink: &mut impl Sink<Self>,
    ) -> Result<(), Error> {
        bounce_block(source, rows, level, monitor, sink)
    }
}

/// Returns whether a variable is recorded of every body with, or without, an axis.
fn is_usual(when: When, axis: bool) -> bool {
    match when {
        When::HasAxis => axis,
        When::HasNoAxis => !axis,
        when => when == When::Always,
    }
}

impl Columns {
    /// The variables of an impact that are recorded of a body under a law by default, with the full state at each impact if `state`.
    pub fn usual(body: AnyBody<'_>, law: &Law<'_>, state: bool) -> Self {
        let axis = matches!(body, AnyBody::Revolution(_));
        Self::chosen(PER_IMPACT, |about| match about.when {
            When::NormalVaries => !matches!(law.normal, Normal::Constant(_)),
            When::StateAsked => state,
            When::StateAskedOfAxis => state && axis,
            When::StateAskedWithoutAxis => state && !axis,
            when => is_usual(when, axis),
        })
    }
}

impl<S: Simd, P: Pose<S, K>, const K: usize> Event<S, K> for Impact<S, P, K> {
    #[inline(always)]
    fn place(&self) -> (Pack<S, K>, Pack<S, K>) {
        (self.particle, self.number)
    }

    #[inline(always)]
    fn active(&self) -> Mask<S, K> {
        self.active
    }

    #[inline(always)]
    fn velocity(&self) -> Pack<S, K> {
        self.fall
    }

    #[inline(always)]
    fn restitution(&self) -> Pack<S, K> {
        self.rise / self.fall // (1)
    }

    #[inline(always)]
    fn rotational_fraction(&self) -> Pack<S, K> {
        self.rotation / self.energy_before // (12)
    }

    #[inline(always)]
    fn energies(&self) -> [Pack<S, K>; 2] {
        [self.energy_before, self.energy_after]
    }

    #[cfg(feature = "one-lane")]
    fn states(
        &self,
    ) -> Option<(
        Pack<S, K>,
        Pack<S, K>,
        [&crate::motion::SpatialState<S, K>; 2],
    )> {
        Some((self.time, self.part, self.pose.symmetric()?))
    }
}

/// A particle of this number, at its release.
pub(crate) struct AtRelease(usize);

variables! {
    /// The variables of a particle; [`Variable::when`] says in which runs each is recorded.
    PER_PARTICLE: Bounces, [] AtRelease;

    impacts: i64 { text: "number of impacts" } = |_, _| 0_i64;

    stop_reason: i8 {
        text: "why the trajectory ended",
        meanings: &StopReason::NAMES
    } = |_, _| StopReason::Interrupted as i8;

    release_angle: f64 {
        text: "angle between symmetry axis and plane normal at release",
        unit: Some("rad"),
        when: When::HasAxis
    } = |particle, plan| {
        let (sine, cosine) = plan.release(particle.0);
        angle(sine, cosine)
    };

    release_attitude: [f64; 4] {
        text: "attitude at release, the rotation from the axes of the body to those of space as a quaternion",
        unit: Some("1"),
        symbol: Some("q"),
        when: When::HasNoAxis
    } = |particle, plan| {
        let Quaternion { w, x, y, z } = plan.attitude(particle.0);
        [w, x, y, z]
    };

    release_height: f64 {
        text: "height of the centre of mass over the plane at release",
        unit: Some("m"),
        when: When::HeightVaries
    } = |particle, plan| plan.release_height(particle.0);

    release_azimuth: f64 {
        text: "azimuth of the symmetry axis at release, from x towards y",
        unit: Some("rad"),
        symbol: Some("φ"),
        when: When::InSpaceOfAxis
    } = |particle, plan| plan.run.orientation.azimuth(plan.run.seed, particle.0 as u64);

    release_spin: [f64; 3] {
        text: "angular velocity at release",
        unit: Some("rad s-1"),
        symbol: Some("ω"),
        when: When::InSpace
    } = |particle, plan| {
        let spin = match plan.run.body {
            AnyBody::Revolution(solid) => plan.spinning(&solid.scaled, particle.0).1,
            AnyBody::Rigid(body) => plan.spin(body, particle.0),
        };
        [spin.x, spin.y, spin.z]
    };
}

variables! {
    /// The variables of an impact.
    PER_IMPACT: Bounces, [S: Simd, P: Pose<S, K>, const K: usize] Impact<S, P, K>;

    time: f64 { text: "time since release", unit: Some("s") } = |impact, plan| impact.time * plan.scales.time;

    impact_velocity: f64 {
        text: "normal velocity of the centre of mass towards the plane, before the impact",
        unit: Some("m s-1"),
        symbol: Some("v_G^n")
    } = |impact, plan| impact.fall * plan.scales.speed;

    rebound_velocity: f64 {
        text: "normal velocity of the centre of mass away from the plane, after the impact",
        unit: Some("m s-1")
    } = |impact, plan| impact.rise * plan.scales.speed;

    restitution: f64 {
        text: "coefficient of restitution: rebound velocity over impact velocity (Eq. 1)",
        unit: Some("1"),
        symbol: Some("ε")
    } = |impact, _plan| impact.restitution();

    microscopic: f64 {
        text: "normal coefficient of the law at the speed at which the contact approaches the plane",
        unit: Some("1"),
        symbol: Some("ε_n"),
        when: When::NormalVaries
    } = |impact, plan| plan.law.normal.apart(impact.approach);

    rotational_fraction: f64 {
        text: "rotational over total kinetic energy, before the impact (Eq. 12)",
        unit: Some("1"),
        symbol: Some("E_rot/E_tot")
    } = |impact, _plan| impact.rotational_fraction();

    energy_ratio: f64 {
        text: "total kinetic energy after over before the impact",
        unit: Some("1")
    } = |impact, _plan| impact.energy_ratio();

    angle: f64 {
        text: "angle between symmetry axis and plane normal at the impact",
        unit: Some("rad"),
        symbol: Some("θ"),
        when: When::HasAxis
    } = |impact, _plan| {
        let (sine, cosine) = impact.pose.tilt();
        angle_in_lanes(sine, cosine)
    };

    contact: i8 {
        text: "sphere or half that touched; the axis points to 1",
        meanings: &["none", "sphere_1", "sphere_2"],
        when: When::HasAxis
    } = |impact, _plan| impact.part;

    part: i32 {
        name: "contact",
        text: "number of the sphere, vertex or arc that touched, from 1; 0: no impact",
        when: When::HasNoAxis
    } = |impact, _plan| impact.part;

    height: f64 {
        text: "height of the centre of mass over the plane at the impact",
        unit: Some("m"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.height() * plan.scales.length;

    axis: [f64; 3] {
        text: "unit vector of the symmetry axis at the impact, from sphere 2 to sphere 1",
        unit: Some("1"),
        symbol: Some("e"),
        when: When::StateAskedOfAxis
    } = |impact, _plan| impact.pose.axis();

    attitude: [f64; 4] {
        text: "attitude at the impact, the rotation from the axes of the body to those of space as a quaternion",
        unit: Some("1"),
        symbol: Some("q"),
        when: When::StateAskedWithoutAxis
    } = |impact, _plan| impact.pose.attitude();

    velocity_before: [f64; 3] {
        text: "velocity of the centre of mass before the impact",
        unit: Some("m s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.velocities()[0].times(plan.scales.speed);

    velocity_after: [f64; 3] {
        text: "velocity of the centre of mass after the impact",
        unit: Some("m s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.velocities()[1].times(plan.scales.speed);

    angular_velocity_before: [f64; 3] {
        text: "angular velocity before the impact",
        unit: Some("rad s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.spin_before().times(1.0 / plan.scales.time);

    angular_velocity_after: [f64; 3] {
        text: "angular velocity after the impact",
        unit: Some("rad s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.spin_after().times(1.0 / plan.scales.time);
}
