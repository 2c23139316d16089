//! One particle at a time: the engine over a single lane, with scalars as arguments and results, for a single flight, a single
//! impact, or the states of a trajectory from any state. It is a part of the core, of which it takes private parts, that only its tests
//! compile.

use super::Group;
use crate::contact::LastContact;
use crate::drop::lanes::advance::{General, find};
use crate::drop::lanes::bounce::bounce;
use crate::drop::lanes::collision::{Collide, ContactPoint, Planar, Spatial};
use crate::drop::lanes::group::Release;
use crate::drop::lanes::interleaved::Idle;
use crate::drop::{Impact, ImpactSink, Limits, Meanwhile, Pose, StopReason};
use crate::law::{Law, Respond, Response};
use crate::math::Vector;
use crate::motion::{SpatialState, State, SymmetricState};
use crate::random::of_impact;
use crate::shape::{Body, Hull, Sphere, with_hull};
use crate::simd::{Lanewise, one};
use pulp::{Scalar, Simd};
use std::cell::Cell;

/// The start of a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlightStart {
    /// A release; a part of the body may be on the plane, at rest or moving up.
    Free,
    /// An impact: a part of the body is on the plane, and its point of contact leaves at `speed` ≥ 0.
    Contact {
        /// The sphere on the plane.
        sphere: Sphere,
        /// Normal speed of the point of contact, in √(gR).
        speed: f64,
    },
}

/// The end of a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlightEnd {
    /// The body touches the plane.
    Impact {
        /// Flight time, in √(R/g).
        time: f64,
        /// The state just before the impact.
        state: State,
        /// The sphere that touches.
        sphere: Sphere,
    },
    /// The sphere on the plane does not leave it: its point of contact has no normal velocity and is not accelerated upwards.
    Resting,
    /// No contact before the axis has turned by [`crate::elementary::RANGE`] rad.
    Never,
}

/// The contact search did not converge, which is a defect of the program, or a law of one's own gave no impulse that is possible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoConvergence;

/// One impact of one particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingleImpact {
    /// Time since release, in √(R/g).
    pub time: f64,
    /// The state just before the impact.
    pub before: State,
    /// The state just after the impact.
    pub after: State,
    /// The sphere that touched.
    pub sphere: Sphere,
}

/// First contact of the flight from `start`, over a plane that descends along x with this slope, tan α. Times are in √(R/g), lengths
/// in R.
///
/// # Errors
/// [`NoConvergence`] if the search does not converge.
pub fn first_contact(
    start: &State,
    slope: f64,
    body: &Body,
    departure: FlightStart,
) -> Result<FlightEnd, NoConvergence> {
    with_hull!(&body.hull, hull => {
        let simd = Scalar::new();
        let mut groups = [Group::<Scalar, Spatial>::empty(simd, hull)];
        groups[0].occupy(&Lone(*start), &mut (0..1), slope, hull);
        if let FlightStart::Contact { sphere, speed } = departure {
            groups[0].search.last_contact = LastContact {
                sphere: one(sphere.sign()),
                speed: one(speed),
            };
        }
        groups[0].start(slope, hull);
        find::<Scalar, Spatial>(&mut groups, hull, &mut Idle).map_err(|_| NoConvergence)?;
        let [mut group] = groups;
        group.land(hull);
        Ok(if group.particles.active.any() {
            FlightEnd::Impact {
                time: group.located.time.as_slice()[0],
                state: state(&group.before()),
                sphere: Sphere::of(group.search.last_contact.sphere.as_slice()[0]),
            }
        } else if group.particles.reasons[0] == StopReason::NeverLands {
            FlightEnd::Never
        } else {
            FlightEnd::Resting
        })
    })
}

/// The state after the impact of `sphere`, and the speed, in √(gR), at which the point of contact leaves the plane. A law that
/// depends on the speed must be scaled to √(gR) ([`Law::scaled`]); ε_n is that where it does not scatter.
pub fn collide(body: &Body, law: &Law<'_>, before: &State, sphere: Sphere) -> (State, f64) {
    with_hull!(&body.hull, hull => {
        let state = before.in_lane();
        let part = hull.part(one(sphere.sign()).eq(1.0));
        let point = ContactPoint::of(hull, &part, state.axis.z);
        let mut response = [Response::none(Scalar::new())];
        let steady = Law { deviation: 0.0, ..*law };
        steady.respond_all::<_, true>(&[state.contact(body, point)], &[], &mut response);
        let after = state.with_motion(state.after(body, point, &response[0]));
        (self::state(&after), response[0].separation_speed.as_slice()[0])
    })
}

/// Simulates a particle until a limit is reached; `record` is called with every impact and returns whether to continue. The plane
/// descends along x with the given slope, tan α. The impacts have the same bits as in a run, because a release from rest is treated
/// as planar motion here as well. Where ε_n scatters, it is drawn as for particle 0 of seed 0.
///
/// # Errors
/// [`NoConvergence`] if a contact search does not converge.
pub fn trajectory(
    body: &Body,
    law: &Law<'_>,
    slope: f64,
    start: State,
    limits: Limits,
    mut record: impl FnMut(&SingleImpact) -> bool,
) -> Result<StopReason, NoConvergence> {
    if limits.impacts == 0 {
        return Ok(StopReason::ImpactsReached);
    }
    let go_on = Cell::new(true);
    let mut reporter = Reporter {
        record: &mut record,
        go_on: &go_on,
        ended: StopReason::Interrupted,
    };
    let (simd, job) = (Scalar::new(), (body, limits));
    let cycle = General { body, law, slope };
    let release = (&Lone(start), 0..1);
    let rest = Vector::default();
    let at_rest = start.velocity == rest && start.precession == rest && start.axis.y == 0.0;
    if at_rest && slope == 0.0 && law.custom.is_none() {
        bounce::<_, Planar, _, 1>(simd, job, &cycle, release, &mut reporter, || go_on.get())
    } else {
        bounce::<_, Spatial, _, 1>(simd, job, &cycle, release, &mut reporter, || go_on.get())
    }
    .map_err(|_| NoConvergence)?;
    Ok(reporter.ended)
}

/// The state in the only lane.
fn state<S: Simd>(lanes: &SpatialState<S>) -> State {
    State {
        height: lanes.height.as_slice()[0],
        velocity: lanes.motion.velocity.lane(0),
        axis: lanes.axis.lane(0),
        precession: lanes.motion.precession.lane(0),
    }
}

/// The release of a single particle.
struct Lone(State);

impl Release for Lone {
    fn start(&self, _: usize) -> State {
        self.0
    }

    fn chance(&self, particle: usize, impact: usize) -> f64 {
        of_impact(0, particle as u64, impact as u64)
    }
}

/// The sink that hands the impacts to `record`.
struct Reporter<'a> {
    record: &'a mut dyn FnMut(&SingleImpact) -> bool,
    go_on: &'a Cell<bool>,
    ended: StopReason,
}

impl Meanwhile for Reporter<'_> {}

impl ImpactSink for Reporter<'_> {
    fn impact<S: Simd, P: Pose<S>>(&mut self, _: usize, impact: &Impact<S, P>) {
        let (true, Some([before, after])) = (impact.active.any(), impact.pose.symmetric()) else {
            return;
        };
        self.go_on.set((self.record)(&SingleImpact {
            time: impact.time.as_slice()[0],
            before: state(before),
            after: state(after),
            sphere: Sphere::BOTH[impact.part.as_slice()[0] as usize - 1],
        }));
    }

    fn end(&mut self, _: usize, _: usize, reason: StopReason) {
        self.ended = reason;
    }
}
