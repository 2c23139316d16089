//! Particles one at a time through the three-dimensional engine, told to the same [`Sink`]s as those in lanes.

use crate::body::Body;
use crate::collision::Law;
use crate::contact::NoConvergence;
use crate::lanes::{Impact, Mask, Pack, Sink};
use crate::state::State;
use crate::trajectory::{self, Limits};
use pulp::Scalar;

/// Where the contact search did not end: after this many impacts.
#[derive(Debug)]
pub(crate) struct Stuck {
    pub impacts: usize,
}

/// Bounces one particle; to `sink` it is in lane 0. Calls `go_on` after every impact.
pub(crate) fn bounce(
    body: &Body,
    law: &Law<'_>,
    slope: f64,
    release: State,
    limits: Limits,
    sink: &mut impl Sink,
    go_on: impl Fn() -> bool,
) -> Result<(), Stuck> {
    let mut impacts = 0;
    let ended = trajectory::bounce(body, law, slope, release, limits, |impact| {
        sink.impact(impacts, 0, &in_lane(impact, body));
        impacts += 1;
        go_on()
    });
    match ended {
        Ok(reason) => {
            sink.end(0, impacts, reason);
            Ok(())
        }
        Err(NoConvergence) => Err(Stuck { impacts }),
    }
}

/// An impact as that of a single lane.
fn in_lane(impact: &trajectory::Impact, body: &Body) -> Impact<Scalar, 1> {
    let simd = Scalar::new();
    let lane = |x| Pack::splat(simd, x);
    let before = &impact.before;
    Impact {
        time: lane(impact.time),
        fall: lane(impact.impact_velocity()),
        rise: lane(impact.rebound_velocity()),
        rotation: lane(before.rotational_energy(body)),
        energy_before: lane(before.kinetic_energy(body)),
        energy_after: lane(impact.after.kinetic_energy(body)),
        sine: lane(before.axis.horizontal()),
        cosine: lane(before.axis.z),
        sphere: lane(impact.sphere.sign()),
        active: Mask::splat(simd, true),
    }
}
