//! States, flights and impacts one by one, for the tests of what a run does not show, and the gaps worked out in another way.

use crate::common::*;
use proptest::prelude::*;
use restitution_core::{
    Body, FlightEnd, FlightStart, Law, Limits, SingleImpact as Impact, Sphere, State, StopReason,
    Vector, collide, first_contact,
};

/// What the paper makes of an impact.
pub trait Observed {
    fn impact_velocity(&self) -> f64;
    fn restitution(&self) -> f64;
    fn rotational_fraction(&self, body: &Body) -> f64;
    fn energy_ratio(&self, body: &Body) -> f64;
}

impl Observed for Impact {
    fn impact_velocity(&self) -> f64 {
        -self.before.velocity.z
    }

    fn restitution(&self) -> f64 {
        self.after.velocity.z / self.impact_velocity() // (1)
    }

    fn rotational_fraction(&self, body: &Body) -> f64 {
        self.before.rotational_energy(body) / self.before.kinetic_energy(body) // (12)
    }

    fn energy_ratio(&self, body: &Body) -> f64 {
        self.after.kinetic_energy(body) / self.before.kinetic_energy(body)
    }
}

/// A state at rest, as the paper lets go of its particles.
pub fn at_rest(body: &Body, height: f64, angle: f64) -> State {
    let axis = Vector::new(angle.sin(), 0.0, angle.cos());
    State::with_spin(body, height, Vector::default(), axis, Vector::default())
}

/// The same state at another height.
pub fn at_height(state: &State, height: f64) -> State {
    State {
        height: height - 1.0,
        ..*state
    }
}

/// Height of the centre of mass above R.
pub fn lift(state: &State) -> f64 {
    state.height
}

/// Kinetic and potential energy.
pub fn energy(state: &State, body: &Body) -> f64 {
    state.kinetic_energy(body) + state.height
}

/// The first contact of a flight, which must be found.
pub fn landing(state: State, body: &Body, departure: FlightStart) -> FlightEnd {
    first_contact(&state, 0.0, body, departure).unwrap()
}

/// The whole trajectory, and why it ended.
pub fn trajectory(
    body: &Body,
    law: &Law<'_>,
    release: State,
    impacts: usize,
) -> (Vec<Impact>, StopReason) {
    let mut all = Vec::new();
    let limits = Limits {
        impacts,
        minimum_speed: 0.0,
        settled: 0.0,
    };
    let reason = restitution_core::trajectory(body, law, 0.0, release, limits, |impact| {
        all.push(*impact);
        true
    });
    (all, reason.unwrap())
}

/// A flight with its landing, as the bounce loop goes through them.
#[derive(Debug)]
pub struct Leg {
    pub start: State,
    pub departure: FlightStart,
    pub time: f64,
    pub impact: Impact,
}

/// The first flights of a trajectory.
pub fn legs(body: &Body, law: &Law<'_>, release: State, most: usize) -> Vec<Leg> {
    let mut start = release;
    let mut departure = FlightStart::Free;
    let mut legs = Vec::new();
    while legs.len() < most {
        let FlightEnd::Impact {
            time,
            state: before,
            sphere,
        } = landing(start, body, departure)
        else {
            break;
        };
        let (after, speed) = collide(body, law, &before, sphere);
        legs.push(Leg {
            start,
            departure,
            time,
            impact: Impact {
                time,
                before,
                after,
                sphere,
            },
        });
        departure = FlightStart::Contact { sphere, speed };
        start = after;
    }
    legs
}

/// The gap under a sphere a time after `start`: the parabola, and the axis turned about **Λ** by Rodrigues' formula with
/// the platform's sine and cosine.
pub fn gap(start: &State, body: &Body, time: f64, sphere: Sphere) -> f64 {
    let side = sphere.sign() * body.half_separation;
    let rate = start.precession.norm();
    let tilt = if rate == 0.0 {
        start.axis.z
    } else {
        let about = start.precession / rate;
        let (sin, cos) = (rate * time).sin_cos();
        let along = about.dot(start.axis) * about.z;
        start.axis.z * cos + about.cross(start.axis).z * sin + along * (1.0 - cos)
    };
    (start.height + side * tilt) + time * (start.velocity.z - 0.5 * time)
}

/// What sixteen roundings of the largest term of [`gap`] amount to, the rounding of the time included: the engine's and
/// the test's own. `fastest` is the largest energy so far: an earlier landing was as inexact as that.
pub fn gap_tolerance(start: &State, body: &Body, time: f64, fastest: f64) -> f64 {
    let turning = body.half_separation * start.precession.norm() * time;
    let path = start.velocity.z.abs() * time + time * time + start.height.abs();
    16.0 * f64::EPSILON * (1.0 + body.half_separation + path + turning + fastest)
}

/// Velocity of the point of contact, (7), (8).
pub fn contact_velocity(state: &State, body: &Body, sphere: Sphere) -> Vector {
    state.velocity + state.spin(body).cross(arm(state, body, sphere))
}

/// From the centre of mass to the point of contact, (6).
pub fn arm(state: &State, body: &Body, sphere: Sphere) -> Vector {
    state.axis * (sphere.sign() * body.half_separation) - Vector::new(0.0, 0.0, 1.0)
}

/// A body, a law and a free state above the plane: every spin, also about the symmetry axis, up to a rate of 10³ √(g/R).
pub fn motion() -> impl Strategy<Value = (Body, Law<'static>, State)> {
    let velocity = (
        direction(),
        prop_oneof![1 => Just(0.0), 4 => magnitude(-6.0, 1.3)],
    );
    let spin = (
        direction(),
        prop_oneof![1 => Just(0.0), 4 => magnitude(-6.0, 3.0)],
    );
    let space = prop_oneof![1 => Just(0.0), 2 => magnitude(-14.0, 0.0), 3 => 0.0..40.0_f64];
    (
        elongation(),
        coefficients().prop_flat_map(every_law),
        direction(),
        velocity,
        spin,
        space,
        any::<bool>(),
    )
        .prop_map(
            |(elongation, law, axis, (v, speed), (w, rate), space, axial)| {
                let body = dumbbell(elongation);
                let height = 1.0 + body.half_separation * axis.z.abs() + space;
                let w = if axial { axis } else { w };
                let state = State::with_spin(&body, height, v * speed, axis, w * rate);
                (body, law, state)
            },
        )
}

/// A contact that is about to be hit: sphere, and the state with its point of contact approaching the plane.
pub fn approach() -> impl Strategy<Value = (Body, Law<'static>, State, Sphere)> {
    (motion(), any::<bool>()).prop_filter_map("not approaching", |((body, law, state), one)| {
        let sphere = if one { Sphere::One } else { Sphere::Two };
        let side = sphere.sign() * body.half_separation;
        let state = at_height(&state, 1.0 - side * state.axis.z);
        let approaching = contact_velocity(&state, &body, sphere).z < 0.0;
        approaching.then_some((body, law, state, sphere))
    })
}
