//! WHEN: the first contact of either sphere with the plane, (2), which nothing can make it miss.
//!
//! The gap f under either sphere obeys f″ ≥ −M throughout a flight, M = 1 + (L/2)AΩ², or another bound for another hull. A step to the first zero of the
//! lower bound f + f′τ − Mτ²/2 can therefore not pass a contact; such steps converge quadratically to the first one.
//! While the centre of mass is higher than the spheres can reach, the step goes to where it comes back down. When a step
//! turns the axis and bends the gap by little, f falls to its only zero just behind it; an expansion of f from before the step and
//! another at the zero of the first locate it to double precision. Whether the other sphere can have touched on that last
//! way, which no lower bound covers, is checked afterwards. Smooth hulls go on with certified steps until nothing of the gap
//! can be left.

use crate::body::{Body, Hull};
use crate::elementary::RANGE;
use crate::flight::{Attitude, Flight};
use crate::state::{Sphere, State};

/// How a flight starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Departure {
    /// Away from the plane.
    Free,
    /// With one sphere on the plane, its lowest point leaving at `speed` ≥ 0.
    Touching {
        /// The sphere on the plane.
        sphere: Sphere,
        /// Normal speed of the point of contact.
        speed: f64,
    },
}

impl Departure {
    /// Of a release: a sphere may be on the plane, at rest or on its way up. One that is on its way down meets the plane at
    /// once, and is left to the search.
    pub fn of_release(body: &Body, state: State) -> Self {
        let flight = Flight::new(state, 0.0); // the start alone matters, not where it falls to
        let tilt_rate = flight.tilt_rate(flight.attitude(0.0));
        let gaps = state.gaps(body);
        let on_the_plane = Sphere::BOTH.into_iter().find_map(|sphere| {
            let side = body.hull.ball(sphere, state.axis.z).offset;
            let speed = side.mul_add(tilt_rate, state.velocity.z);
            (gaps[sphere as usize] <= 0.0 && speed >= 0.0).then_some((sphere, speed))
        });
        on_the_plane.map_or(Self::Free, |(sphere, speed)| Self::Touching {
            sphere,
            speed,
        })
    }
}

/// How a flight ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Landing {
    /// A sphere meets the plane.
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
    /// No contact within the flight times in which the axis can be followed (its angle exceeds [`RANGE`]).
    Never,
}

/// The search did not end. It always should; the caller reports which particle this was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoConvergence;

/// A contact is near if the step turns the axis by at most this angle, and the gap bends away from its tangent by at most
/// about this part of it.
pub(crate) const NEAR: f64 = 0.125;
/// It is located if the correction at the zero of the expansion is at most this part of the step, 2⁻¹⁸. Relative to the step the
/// next correction is twice the cube of that.
pub(crate) const SMALL: f64 = 1.0 / 262_144.0;
/// At a grazing contact and for a smooth hull the last step is at most this part of the flight time, turns the axis by at most
/// this angle, 2⁻¹¹...
pub(crate) const LAST: f64 = 1.0 / 2048.0;
/// ...and leaves no more of the gap than this, which cannot be seen: 2⁻⁵² R.
pub(crate) const INVISIBLE: f64 = 1.0 / 4_503_599_627_370_496.0;
/// A sphere that is not approaching is left alone at least until its gap may have bent by that: 2⁻²⁶/M.
pub(crate) const SHORTEST: f64 = 1.0 / 67_108_864.0;
/// Gaps up to this may be rounding: 2⁻⁴⁸ R.
pub(crate) const TOUCHING: f64 = 1.0 / 281_474_976_710_656.0;
/// Two or three dozen steps are the most that grazing contacts need, and fast spins a few hundred; this is far beyond.
pub(crate) const MOST_STEPS: u32 = 1_000_000;

/// First contact of `flight` after its start.
pub fn first_contact(
    flight: &Flight,
    body: &Body,
    departure: Departure,
) -> Result<Landing, NoConvergence> {
    let search = Search::new(flight, body, departure);
    if search.rests() {
        return Ok(Landing::Resting);
    }
    let mut time = search.departed();
    for _ in 0..MOST_STEPS {
        let angle = flight.rate * time;
        let followed = angle <= RANGE; // false for NaN too
        if !followed {
            return Ok(Landing::Never);
        }
        let moment = Moment::of(flight, time, flight.attitude(angle));
        let gap = search.nearer(&moment);
        let step = search.certified(&gap);
        if let Some((time, attitude)) = search
            .arrival(&moment, &gap, step)
            .or_else(|| search.grazing(&moment, &gap, step))
        {
            let state = flight.landing(time, attitude, body, gap.sphere);
            return Ok(Landing::Impact {
                time,
                state,
                sphere: body.hull.name(gap.sphere, state.axis.z),
            });
        }
        time = search.skip(time + step);
    }
    Err(NoConvergence)
}

/// The gap under one sphere, at one time.
#[derive(Clone, Copy)]
struct Gap {
    sphere: Sphere,
    /// f ≥ 0; an overlap, which is rounding, counts as 0.
    width: f64,
    /// f′.
    rate: f64,
    /// √(f′² + 2Mf): the speed of approach at the zero of the lower bound.
    root: f64,
}

/// Where a flight is at one time.
#[derive(Clone, Copy)]
struct Moment {
    time: f64,
    lift: f64,
    climb: f64,
    attitude: Attitude,
    /// e_z and its rate.
    tilt: f64,
    tilt_rate: f64,
}

impl Moment {
    fn of(flight: &Flight, time: f64, attitude: Attitude) -> Self {
        Self {
            time,
            lift: flight.lift(time),
            climb: flight.climb(time),
            attitude,
            tilt: flight.tilt(attitude),
            tilt_rate: flight.tilt_rate(attitude),
        }
    }
}

/// What a flight's search for a contact needs to know of it.
struct Search<'a> {
    flight: &'a Flight,
    hull: &'a Hull,
    departure: Departure,
    /// What the rotation can contribute to f″: (L/2)AΩ² for a dumbbell.
    sway: f64,
    /// M, the bound on −f″.
    bound: f64,
    /// From `up` to `down` the centre of mass is higher than the spheres can reach.
    up: f64,
    down: f64,
}

impl<'a> Search<'a> {
    fn new(flight: &'a Flight, body: &'a Body, departure: Departure) -> Self {
        let start = flight.start();
        let climb = start.velocity.z;
        let sway = flight.sway(body);
        let ceiling = body.hull.ceiling(flight.reach());
        let square = climb.mul_add(climb, 2.0 * (start.lift - ceiling));
        let (up, down) = if square > 0.0 {
            (climb - square.sqrt(), climb + square.sqrt())
        } else {
            (f64::INFINITY, f64::INFINITY)
        };
        Self {
            flight,
            hull: &body.hull,
            departure,
            sway,
            bound: 1.0 + sway,
            up,
            down,
        }
    }

    /// Whether the sphere on the plane stays there: no separation speed, as after a perfectly plastic impact, and no
    /// rotation that lifts it, f″ ≤ 0. If the other sphere touches too and is coming down, its impact comes first.
    fn rests(&self) -> bool {
        let Departure::Touching { sphere, speed } = self.departure else {
            return false;
        };
        let moment = Moment::of(self.flight, 0.0, self.flight.attitude(0.0));
        let other = self.gap(&moment, sphere.other());
        speed <= 0.0
            && self.bend(&moment, sphere, -1.0) <= 0.0
            && !(other.rate < 0.0 && other.width <= TOUCHING)
    }

    /// The first step. Both spheres are looked at: the one on the plane is just leaving it.
    fn departed(&self) -> f64 {
        let moment = Moment::of(self.flight, 0.0, self.flight.attitude(0.0));
        let [one, two] = Sphere::BOTH.map(|sphere| self.certified(&self.gap(&moment, sphere)));
        let step = one.min(two);
        if step == 0.0 {
            0.0 // a contact at the start itself, which the first pass will see
        } else {
            self.skip(step)
        }
    }

    /// The gap that may close first. Both lower bounds have the same curvature, so that they cross only when the axis,
    /// turning at its present rate, is level: up to then it is the lower sphere's that counts, afterwards the other's.
    fn nearer(&self, moment: &Moment) -> Gap {
        let Hull::Pair(pair) = self.hull else {
            return self.gap(moment, Sphere::One); // there is no other
        };
        let Moment {
            lift,
            climb,
            tilt,
            tilt_rate,
            ..
        } = *moment;
        let tilt = pair.lean(tilt);
        // lift + climb t − Mt²/2 at t = −tilt/tilt_rate, times tilt_rate²: both gaps there.
        let level = tilt_rate.mul_add(
            lift.mul_add(tilt_rate, -(climb * tilt)),
            -(0.5 * self.bound * (tilt * tilt)),
        );
        // Is the axis level with both spheres in the air, the one that is going down is or will be the lower one.
        let decides = if level >= 0.0 { tilt_rate } else { tilt };
        let sphere = if decides < 0.0 {
            Sphere::One
        } else {
            Sphere::Two
        };
        let gap = self.gap(moment, sphere);
        // A sphere that touches and leaves has its zero behind it, and may come back later than the other comes down.
        if gap.rate >= 0.0 && gap.width <= TOUCHING {
            let other = self.gap(moment, sphere.other());
            if self.certified(&other) < self.certified(&gap) {
                return other;
            }
        }
        gap
    }

    /// The gap under `sphere`.
    fn gap(&self, moment: &Moment, sphere: Sphere) -> Gap {
        let (width, rate) = match self.departure {
            // At the start the sphere on the plane is known exactly.
            Departure::Touching { sphere: on, speed }
                if moment.time == 0.0 && self.hull.is_one(on, sphere) =>
            {
                (0.0, speed)
            }
            _ => (
                self.hull.gap(sphere, moment.tilt, moment.lift).max(0.0), // (2)
                self.lever(moment, sphere)
                    .mul_add(moment.tilt_rate, moment.climb),
            ),
        };
        let root = rate.mul_add(rate, 2.0 * self.bound * width).sqrt();
        Gap {
            sphere,
            width,
            rate,
            root,
        }
    }

    /// The lever s of the contact.
    fn lever(&self, moment: &Moment, sphere: Sphere) -> f64 {
        self.hull.ball(sphere, moment.tilt).offset
    }

    /// f″ without gravity, plus `addend`.
    fn bend(&self, moment: &Moment, sphere: Sphere, addend: f64) -> f64 {
        let acceleration = self.flight.tilt_acceleration(moment.tilt);
        let curved = self.hull.curvature(moment.tilt) * (moment.tilt_rate * moment.tilt_rate);
        self.lever(moment, sphere).mul_add(acceleration, addend) - curved
    }

    /// First zero τ ≥ 0 of f + f′τ − Mτ²/2: no contact can come earlier.
    fn certified(&self, gap: &Gap) -> f64 {
        // Of the two forms of the same root the one that does not subtract.
        if gap.rate < 0.0 {
            2.0 * gap.width / (gap.root - gap.rate)
        } else {
            (gap.rate + gap.root).max(SHORTEST) / self.bound
        }
    }

    /// Past the time that the centre of mass spends out of reach.
    fn skip(&self, time: f64) -> f64 {
        if time >= self.up {
            time.max(self.down)
        } else {
            time
        }
    }

    /// Whether the gap falls to its only zero just behind `step`.
    fn is_near(&self, gap: &Gap, step: f64) -> bool {
        self.hull.is_of_balls()
            && gap.rate < 0.0
            && self.flight.rate.mul_add(step, -NEAR) <= 0.0
            && self.sway.mul_add(step, -(NEAR * gap.root)) <= 0.0
    }

    /// Time and attitude of the contact behind `step`, if it is near and the other sphere does not touch before.
    fn arrival(&self, moment: &Moment, gap: &Gap, step: f64) -> Option<(f64, Attitude)> {
        if !self.is_near(gap, step) {
            return None;
        }
        let ahead = self.expanded(moment, gap, step);
        let attitude = moment.attitude.turned(self.flight.rate * ahead);
        let there = Moment::of(self.flight, moment.time + ahead, attitude);
        // What is left of the gap, by a step of third order.
        let width = self.hull.gap(gap.sphere, there.tilt, there.lift); // (2)
        let lever = self.lever(&there, gap.sphere);
        let inverse = -1.0 / lever.mul_add(there.tilt_rate, there.climb);
        let newton = width * inverse;
        let curvature = self.bend(&there, gap.sphere, -1.0); // f″
        let rest = newton.mul_add(0.5 * curvature * newton * inverse, newton);
        let attitude = there.attitude.advanced(self.flight.rate * rest);

        let small = newton.abs() <= SMALL * step;
        // Where the other sphere touched after `step`, its gap cannot have become larger since than gravity and rotation open it.
        let since = (ahead - step) + rest;
        let tilt = self.flight.tilt(attitude);
        let other = gap.sphere.other();
        let lift = self.hull.lift(gap.sphere, tilt);
        let first = self.hull.is_one(gap.sphere, other)
            || self.hull.gap(other, tilt, lift) >= 0.5 * self.sway * (since * since);
        (small && first).then_some((there.time + rest, attitude))
    }

    /// Time and attitude at the end of `step`, if what it leaves of the gap cannot be seen.
    fn grazing(&self, moment: &Moment, gap: &Gap, step: f64) -> Option<(f64, Attitude)> {
        let time = moment.time + step;
        let last = gap.rate < 0.0
            && (-LAST).mul_add(time, step) <= 0.0
            && self.flight.rate.mul_add(step, -LAST) <= 0.0
            && self.bound.mul_add(step * step, -INVISIBLE) <= 0.0;
        last.then(|| (time, moment.attitude.turned(self.flight.rate * step)))
    }

    /// A step to the zero of the gap's fourth-order expansion, of third order behind `step`.
    fn expanded(&self, moment: &Moment, gap: &Gap, step: f64) -> f64 {
        let side = self.lever(moment, gap.sphere);
        let square = self.flight.rate * self.flight.rate;
        let second = self.bend(moment, gap.sphere, 0.0); // f″ without gravity
        let third = -(side * square) * moment.tilt_rate; // f‴
        let fourth = -square * second; // f⁗
        let slack = second + self.sway; // f″ + M, what the lower bound leaves out
        // What is left of the gap after the step, and how fast it closes there.
        let bend = (step * fourth).mul_add(1.0 / 12.0, third * (1.0 / 3.0));
        let left = 0.5 * (step * step) * step.mul_add(bend, slack);
        let speed = step.mul_add(-step.mul_add(0.5 * third, slack), gap.root);
        let inverse = 1.0 / speed;
        let newton = left * inverse;
        let curvature = step.mul_add(third, second - 1.0); // f″
        step + newton.mul_add(0.5 * curvature * newton * inverse, newton)
    }
}
