//! The free rotation of any body.
//!
//! With equal moments ω is constant. With two equal ones, J across and J_z along the axis **e**, Euler's equations turn ω about **e** at the rate
//! −λ, λ = (1 − J_z/J)ω_z, and the attitude is q(t) = q(0) exp(**Λ**t/2J) exp(λ**e**t/2), **Λ** the angular momentum in the axes of the body at
//! the beginning. Otherwise both are [`Elliptic`] functions, or where these do not serve follow from their [`Series`].

use super::elliptic::Elliptic;
use super::series::Series;
use super::top::energy_error;
use crate::math::{Quaternion, Quaternions, UNITS, Vector, Vectors, sum};
use crate::shape::{Symmetry, Top};
use crate::simd::elementary::sincos_in_lanes;
use crate::simd::{Lanewise, Level, Mask, Pack, one};
use pulp::{Scalar, Simd, WithSimd};

/// The rotation of a body in flight; where it takes series, fastest forward in time.
#[derive(Debug, Clone)]
pub struct Rotation {
    top: Top,
    closed: Rotations<Scalar>,
    /// Series, where these do not serve. Rare, and four times as large as all else, so that it is not moved about with the others.
    series: Option<Box<Series>>,
}

/// The rotation of the same body in each lane, from its attitude and its ω at the beginning.
#[derive(Debug, Clone)]
pub(crate) struct Rotations<S: Simd> {
    attitude: Quaternions<S>,
    spin: Vectors<S>,
    way: Way<S>,
}

#[derive(Debug, Clone)]
enum Way<S: Simd> {
    /// About ω: its half, and the direction.
    Steady(Pack<S>, Vectors<S>),
    /// Half the rate and the direction of **Λ**/J, then λ about an axis.
    Precession((Pack<S>, Vectors<S>), Pack<S>, usize),
    /// But where the body does not turn.
    Elliptic(Elliptic<S>, Mask<S>),
}

impl Rotation {
    /// The rotation with this attitude and this ω, in the axes of the body, at the time 0.
    #[inline(always)]
    pub fn new(top: Top, attitude: Quaternion, spin: Vector) -> Self {
        let (closed, serves) = Rotations::new(&top, attitude.in_lane(), spin.in_lane());
        Self {
            top,
            closed,
            series: (!serves.all()).then(|| Box::new(Series::new(&top, attitude, spin))),
        }
    }

    /// The attitude, and ω in the axes of the body, at a time ≥ 0. Rounding is nearly the same in every flight of a free body and would add up: what
    /// it adds to the energy is taken off ω.
    #[inline(always)]
    pub fn at(&mut self, time: f64) -> (Quaternion, Vector) {
        let Rotations { attitude, spin, .. } = &self.closed;
        let (attitude, first) = (attitude.lane(0), spin.lane(0));
        if time == 0.0 {
            return (attitude, first);
        }
        let Some(series) = &mut self.series else {
            let (attitude, spin) = self.closed.at(one(time));
            return (attitude.lane(0), spin.lane(0));
        };
        if time < series.start() {
            **series = Series::new(&self.top, attitude, first);
        }
        let (attitude, spin) = series.at(&self.top, time);
        let lost = energy_error(self.top.moments(), first.parts(), spin.parts());
        let part = 0.5 * lost / self.top.twice_energy(spin);
        (attitude, spin + spin * part)
    }

    /// [`Rotation::new`], compiled separately for whom it would take more time to compile it in many places than to call it.
    pub(crate) fn begun(top: &Top, attitude: Quaternion, spin: Vector) -> Self {
        Level::run_scalar(Begun(top, attitude, spin))
    }

    /// [`Rotation::at`], compiled so, too.
    pub(crate) fn later(&mut self, time: f64) -> (Quaternion, Vector) {
        Level::run_scalar(Later(self, time))
    }
}

struct Begun<'a>(&'a Top, Quaternion, Vector);
struct Later<'a>(&'a mut Rotation, f64);

impl WithSimd for Begun<'_> {
    type Output = Rotation;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Rotation {
        Rotation::new(*self.0, self.1, self.2)
    }
}

impl WithSimd for Later<'_> {
    type Output = (Quaternion, Vector);

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        self.0.at(self.1)
    }
}

impl<S: Simd> Rotations<S> {
    /// Those of bodies that do not turn.
    pub fn none(simd: S) -> Self {
        let none = Vectors::none(simd);
        Self {
            attitude: Quaternions::splat(simd, Quaternion::IDENTITY),
            spin: none,
            way: Way::Steady(none.x, none),
        }
    }

    /// The rotations with these attitudes and these ω, and the lanes in which they are known for all times.
    #[inline(always)]
    pub fn new(top: &Top, attitude: Quaternions<S>, spin: Vectors<S>) -> (Self, Mask<S>) {
        let rests = spin.dot(spin).eq(0.0);
        let mut serves = Mask::splat(rests.simd(), true);
        let way = match top.symmetry {
            Symmetry::Asymmetric if !rests.all() => {
                // What does not turn has no such functions.
                let [low, ..] = top.order;
                let turning = spin.or(rests, Vectors::splat(rests.simd(), ANY + UNITS[low]));
                let elliptic;
                (elliptic, serves) = Elliptic::new(top, attitude, turning);
                Way::Elliptic(elliptic, rests)
            }
            Symmetry::About(axis) if !rests.all() => {
                let moments = top.moments();
                let across = moments[(axis + 1) % 3];
                let [a, b, c] = moments;
                let momentum = Vectors::new(
                    a / across * spin.x,
                    b / across * spin.y,
                    c / across * spin.z,
                );
                let own = (1.0 - moments[axis] / across) * spin.parts()[axis];
                Way::Precession(half_and_direction(momentum), own, axis)
            }
            _ => {
                let (half, direction) = half_and_direction(spin);
                Way::Steady(half, direction)
            }
        };
        let rotations = Self {
            attitude,
            spin,
            way,
        };
        (rotations, serves)
    }

    /// The attitudes, and ω in the axes of the body, at a time.
    #[inline(always)]
    pub fn at(&self, time: Pack<S>) -> (Quaternions<S>, Vectors<S>) {
        match &self.way {
            Way::Steady(half, direction) => {
                let turn = about(*direction, *half * time);
                (self.attitude.turned(turn), self.spin)
            }
            Way::Precession((half, direction), own, axis) => {
                let precessed = self.attitude * about(*direction, *half * time);
                let (sine, cosine) = sincos_in_lanes(0.5 * *own * time);
                let along = Vectors::splat(time.simd(), UNITS[*axis]);
                let turn = Quaternions::of(cosine, along * sine);
                (precessed.turned(turn), self.back(*axis, sine, cosine))
            }
            Way::Elliptic(elliptic, rests) => {
                let (attitude, spin) = elliptic.at(time);
                if !rests.any() {
                    return (attitude, spin);
                }
                let still = Quaternions::splat(time.simd(), Quaternion::IDENTITY);
                let attitude = attitude.or(*rests, self.attitude.turned(still));
                (attitude, spin.or(*rests, self.spin))
            }
        }
    }

    /// ω at the beginning turned back about the axis of symmetry, by the sine and the cosine of half the angle, with the length that it had.
    #[inline(always)]
    fn back(&self, axis: usize, sine: Pack<S>, cosine: Pack<S>) -> Vectors<S> {
        let mut spin = self.spin.parts();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let [a, b] = [spin[i], spin[j]];
        let (less, across) = (-2.0 * sine * sine, 2.0 * sine * cosine);
        // As in [`Quaternion::turned`].
        let (x, dx) = sum(a, less * a + across * b);
        let (y, dy) = sum(b, less * b - across * a);
        // Squares, and what they lose by rounding.
        let [(aa, da), (bb, db), (xx, ex), (yy, ey)] = [square(a), square(b), square(x), square(y)];
        let lost = ((aa - xx) + (bb - yy)) + ((da - ex) + (db - ey)) - 2.0 * (x * dx + y * dy);
        let part = 0.5 * lost / (xx + yy).max(f64::MIN_POSITIVE);
        (spin[i], spin[j]) = (x + (dx + part * x), y + (dy + part * y));
        let [x, y, z] = spin;
        Vectors::new(x, y, z)
    }
}

impl Top {
    /// The attitude of the principal axes, and ω in the axes of space, of a free body after a time; both are given at its beginning.
    #[inline(always)]
    pub fn turned(&self, attitude: Quaternion, spin: Vector, time: f64) -> (Quaternion, Vector) {
        let spin = attitude.inverse().rotate(spin);
        let (attitude, spin) = Rotation::begun(self, attitude, spin).later(time);
        (attitude, attitude.rotate(spin))
    }
}

/// With as much again or more along an axis, an ω for which [`Elliptic`] functions serve.
const ANY: Vector = Vector::new(0.1, 0.1, 0.1);

/// A square, and what it has lost by rounding.
#[inline(always)]
fn square<S: Simd>(v: Pack<S>) -> (Pack<S>, Pack<S>) {
    let square = v * v;
    (square, v.mul_add(v, -square))
}

/// Half the length of a vector, and its direction; none of no vector.
#[inline(always)]
fn half_and_direction<S: Simd>(v: Vectors<S>) -> (Pack<S>, Vectors<S>) {
    let length = (v.x * v.x + v.y * v.y + v.z * v.z).sqrt();
    let divisor = length.le(0.0).select(1.0, length);
    (0.5 * length, v / divisor)
}

/// The rotation about a direction by twice this angle.
#[inline(always)]
fn about<S: Simd>(direction: Vectors<S>, half: Pack<S>) -> Quaternions<S> {
    let (sine, cosine) = sincos_in_lanes(half);
    Quaternions::of(cosine, direction * sine)
}
