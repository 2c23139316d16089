//! The search for the first contact of any body in flight. It looks at the body at one time after the other: what is certain is how long
//! nothing touches, and the time at which it looks may be later. [`super::plane`] has the certified step, and explains why it may look ahead.

use super::MOST_STEPS;
use super::certify::{INVISIBLE, LAST};
use super::plane::{Departure, GapExpansion};
use crate::math::{Quaternion, Vector};
use crate::motion::{Rotation, SpinBounds};
#[cfg(test)]
use crate::shape::evaluations::{self, Evaluation};
use crate::shape::{NormalMotion, Rigid, each_surface, up};
use crate::simd::elementary::RANGE;
use std::ops::ControlFlow;

/// Most angle by which the search looks ahead of what is certified.
const FAR: f64 = 1.0;
/// From so far behind a step, in its length, it nearly always can be certified that nothing touched.
const BACK: f64 = 0.9;
/// Most angle of an expansion of the rotation: the fourth power of it is less than rounding.
const EXPANDED: f64 = 1.0 / 8192.0;

/// The motion of the centre of mass along the plane normal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fall {
    /// Height and its rate at the beginning.
    pub height: f64,
    pub speed: f64,
    /// The acceleration downwards.
    pub gravity: f64,
}

/// The search along a flight.
pub(crate) struct FirstContact<'a> {
    body: &'a Rigid,
    fall: Fall,
    rotation: Rotation,
    bounds: SpinBounds,
    /// The part that leaves the plane at the beginning.
    departure: Option<Departure>,
    /// Between these times the centre of mass is higher than the body reaches.
    up: f64,
    down: f64,
    /// The rotation where it was last computed, not expanded.
    known: (f64, (Quaternion, Vector)),
    /// Nothing touches up to this time.
    certain: f64,
    /// When the body is looked at.
    time: f64,
    /// The part that may be first, and the time up to which no other touches.
    near: Option<(usize, f64)>,
    looks_ahead: bool,
}

/// The body at a time.
pub(crate) struct Look {
    time: f64,
    attitude: Quaternion,
    spin: Vector,
    pub at: NormalMotion,
}

/// A contact: when, the attitude and ω in the axes of the body then, and the part that touches.
pub(crate) struct Touch {
    pub time: f64,
    pub rotation: (Quaternion, Vector),
    pub part: usize,
}

/// Why there is no contact.
pub(crate) enum NoContact {
    /// The part on the plane stays there.
    Rests,
    /// None before the body has turned by [`RANGE`].
    Never,
    Unconverged,
}

impl<'a> FirstContact<'a> {
    /// The search from an attitude and ω in the axes of the body, where a part may be leaving the plane.
    #[inline(always)]
    pub fn new(
        body: &'a Rigid,
        fall: Fall,
        (attitude, spin): (Quaternion, Vector),
        departure: Option<Departure>,
    ) -> Self {
        let Fall {
            height,
            speed,
            gravity,
        } = fall;
        let above = speed * speed + 2.0 * gravity * (height - 1.0);
        let (up, down) = if above > 0.0 {
            let root = above.sqrt();
            ((speed - root) / gravity, (speed + root) / gravity)
        } else {
            (f64::INFINITY, f64::INFINITY)
        };
        Self {
            body,
            fall,
            rotation: Rotation::new(body.top, attitude, spin),
            bounds: body.top.bounds(spin),
            departure,
            up,
            down,
            known: (0.0, (attitude, spin)),
            certain: 0.0,
            time: 0.0,
            near: departure.map(|left| (left.part, 0.0)),
            looks_ahead: each_surface!(&body.surface, surface => surface.looks_back()),
        }
    }

    /// The first contact.
    #[inline(always)]
    pub fn find(mut self) -> Result<Touch, NoContact> {
        if self.rests() {
            return Err(NoContact::Rests);
        }
        for _ in 0..MOST_STEPS {
            if self.bounds.fastest * self.time > RANGE {
                return Err(NoContact::Never);
            }
            let now = self.look(self.time);
            let found = match self.look_back(&now) {
                ControlFlow::Continue(()) => self.step(&now),
                ControlFlow::Break(found) => found,
            };
            if let Some(touch) = found {
                return Ok(touch);
            }
        }
        Err(NoContact::Unconverged)
    }

    /// M of the whole body, the largest |f″|.
    #[inline(always)]
    pub fn bound(&self) -> f64 {
        self.fall.gravity + self.bounds.whole
    }

    /// The body at a time.
    #[inline(always)]
    pub fn look(&mut self, time: f64) -> Look {
        let top = &self.body.top;
        let (attitude, spin) = if self.bounds.fastest * (time - self.known.0).abs() <= EXPANDED {
            let (attitude, spin) = self.known.1;
            top.expanded(attitude, spin, time - self.known.0)
        } else {
            #[cfg(test)]
            evaluations::add(Evaluation::Attitude);
            self.known = (time, self.rotation.at(time));
            self.known.1
        };
        let up = up(attitude);
        let turning = up.cross(spin);
        let Fall {
            height,
            speed,
            gravity,
        } = self.fall;
        let at = NormalMotion {
            height: height + time * (speed - 0.5 * gravity * time),
            rate: speed - gravity * time,
            acceleration: -gravity,
            up,
            turning,
            bending: turning.cross(spin) + up.cross(top.change(spin)),
        };
        Look {
            time,
            attitude,
            spin,
            at,
        }
    }

    /// True if the part on the plane, which has no normal speed, stays there: f″ ≤ 0, and no other part is about to touch as well.
    #[inline(always)]
    fn rests(&mut self) -> bool {
        let Some(left) = self.departure.filter(|left| left.speed <= 0.0) else {
            return false;
        };
        let at = self.look(0.0).at;
        let surface = &self.body.surface;
        each_surface!(surface, surface => {
            surface.acceleration(left.part, &at) <= 0.0 && !surface.another_touches(left, &at)
        })
    }

    /// From a look ahead of what is certain: a contact, or that the body is to be looked at elsewhere, or that nothing touched up to now.
    #[inline(always)]
    fn look_back(&mut self, now: &Look) -> ControlFlow<Option<Touch>> {
        let Some((part, only_until)) = self.near.filter(|_| self.certain < now.time) else {
            return ControlFlow::Continue(());
        };
        let since = now.time - self.certain;
        let backward = each_surface!(&self.body.surface, surface => {
            surface.backward(part, &now.at, &self.bounds, since)
        });
        let Some(ago) = backward.clear else {
            (self.time, self.looks_ahead) = (self.certain, false);
            return ControlFlow::Break(None);
        };
        self.certain = now.time - ago;
        let ahead = backward.gap.closes();
        let end = now.time + ahead;
        if self.bound() * ahead * ahead <= INVISIBLE
            && (ahead < 0.0 || backward.gap.rate < 0.0 && ahead <= LAST * end)
            && end <= only_until
        {
            let rotation = self.body.top.expanded(now.attitude, now.spin, ahead);
            return ControlFlow::Break(Some(Touch {
                time: end,
                rotation,
                part,
            }));
        }
        // Nothing more is to be known here where the contact is, or if there was one since `certain`.
        self.time = match self.expected(now, &backward.gap, only_until) {
            Some(contact) => contact,
            None if ago > 0.0 => self.certain,
            None => return ControlFlow::Continue(()),
        };
        ControlFlow::Break(None)
    }

    /// The certified step from a time up to which nothing touched: to a contact, or to where the body is looked at next.
    #[inline(always)]
    fn step(&mut self, now: &Look) -> Option<Touch> {
        let (from, surface) = (now.time, &self.body.surface);
        let left = self.departure.filter(|_| from == 0.0);
        let clear = if from < self.up {
            self.up - from
        } else {
            f64::INFINITY
        };
        let beside = self
            .near
            .map(|(part, only_until)| (part, only_until - from));
        let step = each_surface!(surface, surface => {
            surface.step(&now.at, &self.bounds, left, beside, clear)
        });
        let end = from + step.length;
        let square = step.length * step.length;
        if step.closes && step.bound * square <= INVISIBLE && step.length <= LAST * end {
            // The body turns by as little, but where all of it is near its centre of mass.
            let rotation = if self.bounds.whole * square <= INVISIBLE {
                self.body.top.expanded(now.attitude, now.spin, step.length)
            } else {
                self.rotation.at(end)
            };
            return Some(Touch {
                time: end,
                rotation,
                part: step.part,
            });
        }
        let after = end.max(from * (1.0 + f64::EPSILON));
        self.certain = if self.up <= after {
            after.max(self.down)
        } else {
            after
        };
        self.time = self.certain;
        let only_until = from + step.only_until;
        self.near = Some((step.part, only_until));
        let looks_back = each_surface!(surface, surface => surface.looks_back());
        let looks_ahead = std::mem::replace(&mut self.looks_ahead, looks_back);
        if !looks_ahead || only_until <= self.certain {
            return None;
        }
        let gap = GapExpansion {
            width: step.width,
            rate: step.rate,
            acceleration: each_surface!(surface, surface => surface.acceleration(step.part, &now.at)),
        };
        // Or else almost as far behind `certain` as that is from here.
        let further = self.certain + BACK * (self.certain - from);
        let expected = from + gap.closes();
        let before = self.certain < expected && expected < further;
        if let Some(contact) = self.expected(now, &gap, only_until) {
            self.time = contact;
        } else if !before && self.within(now, further, only_until) {
            self.time = further;
        }
        None
    }

    /// When a gap closes, if a look from there will certify the time since `certain`.
    #[inline(always)]
    fn expected(&self, now: &Look, gap: &GapExpansion, only_until: f64) -> Option<f64> {
        let contact = now.time + gap.certainly_closes(self.certain - now.time, self.bound())?;
        self.within(now, contact, only_until).then_some(contact)
    }

    /// True if the body may be looked at later with one part alone.
    #[inline(always)]
    fn within(&self, now: &Look, later: f64, only_until: f64) -> bool {
        later <= only_until && self.bounds.fastest * (later - now.time).abs() <= FAR
    }
}
