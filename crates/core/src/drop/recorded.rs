//! The recorded variables of an impact and of a particle, in SI units.

use super::{Height, Impact, Plan, Pose, StopReason};
use crate::law::{Law, Normal};
use crate::record::{Columns, When, variables};
use crate::shape::AnyBody;
use crate::simd::elementary::{angle, angle_in_lanes};
use pulp::Simd;

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

    /// The variables of a particle that are recorded in a run.
    pub(super) fn of_particles(plan: &Plan<'_>) -> Self {
        let axis = matches!(plan.run.body, AnyBody::Revolution(_));
        Self::chosen(PER_PARTICLE, |about| match about.when {
            When::HeightVaries => matches!(plan.run.release_height, Height::Random { .. }),
            When::InSpace => !plan.at_rest,
            When::InSpaceOfAxis => !plan.at_rest && axis,
            when => is_usual(when, axis),
        })
    }
}

/// A particle of this number, at its release.
pub(super) struct AtRelease(pub usize);

variables! {
    /// The variables of a particle; [`Variable::when`] says in which runs each is recorded.
    PER_PARTICLE: [] AtRelease, Plan<'_>;

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
        plan.attitude(particle.0).parts()
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
        spin.parts()
    };
}

variables! {
    /// The variables of an impact.
    PER_IMPACT: [S: Simd, P: Pose<S>] Impact<S, P>, Plan<'_>;

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
    } = |impact, plan| plan.law.normal.apart(impact.approach, None);

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
    } = |impact, plan| impact.pose.velocities()[0] * plan.scales.speed;

    velocity_after: [f64; 3] {
        text: "velocity of the centre of mass after the impact",
        unit: Some("m s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.velocities()[1] * plan.scales.speed;

    angular_velocity_before: [f64; 3] {
        text: "angular velocity before the impact",
        unit: Some("rad s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.spin_before() * (1.0 / plan.scales.time);

    angular_velocity_after: [f64; 3] {
        text: "angular velocity after the impact",
        unit: Some("rad s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.spin_after() * (1.0 / plan.scales.time);
}
