//! One particle at a time: the engine over a single lane, with plain numbers outside. For whoever wants to see one flight, one
//! impact, or the states of one trajectory.

use super::bounce::bounce;
use super::end::{Limits, StopReason};
use super::group::{Found, Group, Release};
use super::impact::{Impact, Meanwhile, Sink};
use super::leg::{Apart, Idle, find};
use super::strike::{Planar, Spatial, Strike, Touch};
use crate::body::{Body, Hull, Sphere, with_hull};
use crate::collision::Law;
use crate::flight::State;
use crate::search;
use crate::simd::one;
use pulp::{Scalar, Simd};
use std::cell::Cell;

/// How a flight starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Departure {
    /// As a release does: a part of the body may be on the plane, at rest or on its way up.
    Free,
    /// With a part of the body on the plane, its lowest point leaving at `speed` ≥ 0.
    Touching {
        /// The sphere on the plane.
        sphere: Sphere,
        /// Normal speed of the point of contact.
        speed: f64,
    },
}

/// How a flight ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Landing {
    /// The body meets the plane.
    Impact {
        /// Flight time.
        time: f64,
        /// The state just before the impact.
        state: State,
        /// The sphere that touches.
        sphere: Sphere,
    },
    /// The sphere on the plane does not leave it: no relative motion, and gravity holds it down.
    Resting,
    /// No contact within the flight times in which the axis can be followed.
    Never,
}

/// The search did not end. It always should; the caller reports which particle this was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoConvergence;

/// One impact of one particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingleImpact {
    /// Time since release.
    pub time: f64,
    /// The state just before.
    pub before: State,
    /// The state just after.
    pub after: State,
    /// The sphere that touched.
    pub sphere: Sphere,
}

/// First contact of the flight that starts so, over a plane that falls along x with this slope, tan α.
pub fn first_contact(
    start: &State,
    slope: f64,
    body: &Body,
    departure: Departure,
) -> Result<Landing, NoConvergence> {
    with_hull!(&body.hull, hull => {
        let simd = Scalar::new();
        let mut groups = [Group::<Scalar, Spatial>::empty(simd, hull)];
        groups[0].occupy(0, 0..1, &Single(*start), slope, hull);
        if let Departure::Touching { sphere, speed } = departure {
            groups[0].depart_from(search::Departure {
                sphere: one(sphere.sign()),
                speed: one(speed),
            });
        }
        find::<Scalar, Spatial>(&mut groups, hull, 0, &mut Idle).map_err(|_| NoConvergence)?;
        let [mut group] = groups;
        group.land(hull);
        Ok(match group.found() {
            Ok(Found { time, state, sphere }) => Landing::Impact {
                time: time.as_slice()[0],
                state: state.lane(0),
                sphere: Sphere::of(sphere.as_slice()[0]),
            },
            Err(StopReason::NeverLands) => Landing::Never,
            Err(_) => Landing::Resting,
        })
    })
}

/// The state after the impact of `sphere`, and the speed at which the point of contact leaves the plane.
pub fn collide(body: &Body, law: &Law<'_>, before: &State, sphere: Sphere) -> (State, f64) {
    with_hull!(&body.hull, hull => {
        let state = before.in_lane();
        let part = hull.part(one(sphere.sign()).eq(1.0));
        let struck = state.strike(body, law, Touch::of(hull, &part, state.axis.z));
        let after = crate::flight::States::moving(state, struck.motion);
        (after.lane(0), struck.separation.as_slice()[0])
    })
}

/// Bounces a particle until a limit is reached; `record` sees every impact and says whether to go on. The plane falls along
/// x with the given slope, tan α. The impacts are those that the particle has in a run, to the last bit: from rest it moves in a
/// plane.
pub fn trajectory(
    body: &Body,
    law: &Law<'_>,
    slope: f64,
    start: State,
    limits: Limits,
    record: impl FnMut(&SingleImpact) -> bool,
) -> Result<StopReason, NoConvergence> {
    let go_on = Cell::new(true);
    let mut told = Told {
        record,
        go_on: &go_on,
        ended: StopReason::Interrupted,
    };
    let (simd, job) = (Scalar::new(), (body, limits));
    let legs = Apart { body, law, slope };
    let release = (&Single(start), 0..1);
    if start.is_at_rest() && slope == 0.0 {
        bounce::<_, Planar, 1>(simd, job, &legs, release, &mut told, || go_on.get())
    } else {
        bounce::<_, Spatial, 1>(simd, job, &legs, release, &mut told, || go_on.get())
    }
    .map_err(|_| NoConvergence)?;
    Ok(told.ended)
}

/// The release of a single particle.
struct Single(State);

impl Release for Single {
    fn start(&self, _: usize) -> State {
        self.0
    }
}

/// Hands the impacts on.
struct Told<'a, F> {
    record: F,
    go_on: &'a Cell<bool>,
    ended: StopReason,
}

impl<F> Meanwhile for Told<'_, F> {
    fn meanwhile(&mut self) {}
}

impl<F: FnMut(&SingleImpact) -> bool> Sink for Told<'_, F> {
    const TOGETHER: bool = false;

    fn begin(&mut self, _: usize) {}

    fn impact<S: Simd, const K: usize>(&mut self, _: usize, _: usize, impact: &Impact<S, K>) {
        if !impact.active.any() {
            return;
        }
        self.go_on.set((self.record)(&SingleImpact {
            time: impact.time.as_slice()[0],
            before: impact.before.lane(0),
            after: impact.after.lane(0),
            sphere: Sphere::of(impact.sphere.as_slice()[0]),
        }));
    }

    fn end(&mut self, _: usize, _: usize, reason: StopReason) {
        self.ended = reason;
    }
}
