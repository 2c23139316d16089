//! The free rotation of any body.
//!
//! With equal moments ω is constant. With two equal ones, J across and J_z along the axis **e**, Euler's equations turn ω about **e** at the rate
//! −λ, λ = (1 − J_z/J)ω_z, and the attitude is q(t) = q(0) exp(**Λ**t/2J) exp(λ**e**t/2), **Λ** the angular momentum in the axes of the body at
//! the beginning. Otherwise both are [`Elliptic`] functions, or where these do not serve follow from their [`Series`].

use super::elliptic::Elliptic;
use super::series::Series;
use super::top::energy_error;
use crate::math::{Quaternion, Vector, sum};
use crate::shape::{Symmetry, Top};
use crate::simd::elementary::sincos;

/// The rotation of a body in flight; where it takes series, fastest forward in time.
#[derive(Debug, Clone)]
pub struct Rotation {
    top: Top,
    /// The attitude, and ω in the axes of the body, at the beginning.
    attitude: Quaternion,
    spin: Vector,
    way: Way,
}

#[derive(Debug, Clone)]
#[expect(
    clippy::large_enum_variant,
    reason = "one lives at a time, on the stack"
)]
enum Way {
    /// About ω: its half, and the direction.
    Steady(f64, Vector),
    /// Half the rate and the direction of **Λ**/J, then λ about an axis.
    Precession((f64, Vector), f64, usize),
    Elliptic(Elliptic),
    /// Rare, and four times as large as all else, so that it is not moved about with the others.
    Series(Box<Series>),
}

impl Rotation {
    /// The rotation with this attitude and this ω, in the axes of the body, at the time 0.
    #[inline(always)]
    pub fn new(top: Top, attitude: Quaternion, spin: Vector) -> Self {
        let rests = spin == Vector::default();
        let way = match top.symmetry() {
            Symmetry::Asymmetric if !rests => match Elliptic::new(&top, attitude, spin) {
                Some(elliptic) => Way::Elliptic(elliptic),
                None => Way::Series(Box::new(Series::new(&top, attitude, spin))),
            },
            Symmetry::About(axis) if !rests => {
                let moments = top.moments();
                let across = moments[(axis + 1) % 3];
                let spin = spin.parts();
                let [a, b, c] = moments;
                let [x, y, z] = [
                    a / across * spin[0],
                    b / across * spin[1],
                    c / across * spin[2],
                ];
                let own = (1.0 - moments[axis] / across) * spin[axis];
                Way::Precession(half_and_direction(Vector::new(x, y, z)), own, axis)
            }
            _ => {
                let (half, direction) = half_and_direction(spin);
                Way::Steady(half, direction)
            }
        };
        Self {
            top,
            attitude,
            spin,
            way,
        }
    }

    /// The attitude, and ω in the axes of the body, at a time ≥ 0. Rounding is nearly the same in every flight of a free body and would add up: what
    /// it adds to the energy is taken off ω.
    #[inline(always)]
    pub fn at(&mut self, time: f64) -> (Quaternion, Vector) {
        if time == 0.0 {
            return (self.attitude, self.spin);
        }
        match &mut self.way {
            Way::Steady(half, direction) => {
                let turn = about(*direction, *half * time);
                (self.attitude.turned(turn), self.spin)
            }
            Way::Precession((half, direction), own, axis) => {
                let precessed = self.attitude * about(*direction, *half * time);
                let (sine, cosine) = sincos(0.5 * *own * time);
                let axis = *axis;
                let mut along = [0.0; 3];
                along[axis] = sine;
                let [x, y, z] = along;
                let turn = Quaternion::new(cosine, x, y, z);
                (precessed.turned(turn), self.back(axis, sine, cosine))
            }
            Way::Elliptic(elliptic) => elliptic.at(time),
            Way::Series(series) => {
                if time < series.start() {
                    **series = Series::new(&self.top, self.attitude, self.spin);
                }
                let (attitude, spin) = series.at(&self.top, time);
                let lost = energy_error(self.top.moments(), self.spin.parts(), spin.parts());
                let part = 0.5 * lost / self.top.twice_energy(spin);
                (attitude, spin + spin * part)
            }
        }
    }

    /// ω at the beginning turned back about the axis of symmetry, by the sine and the cosine of half the angle, with the length that it had.
    #[inline(always)]
    fn back(&self, axis: usize, sine: f64, cosine: f64) -> Vector {
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
        Vector::new(spin[0], spin[1], spin[2])
    }

    /// The attitude at a time.
    pub fn attitude(&mut self, time: f64) -> Quaternion {
        self.at(time).0
    }

    /// ω in the axes of the body, at a time.
    pub fn spin(&mut self, time: f64) -> Vector {
        self.at(time).1
    }
}

impl Top {
    /// The attitude of the principal axes, and ω in the axes of space, of a free body after a time; both are given at its beginning.
    #[inline(always)]
    pub fn turned(&self, attitude: Quaternion, spin: Vector, time: f64) -> (Quaternion, Vector) {
        let spin = attitude.inverse().rotate(spin);
        let (attitude, spin) = Rotation::new(*self, attitude, spin).at(time);
        (attitude, attitude.rotate(spin))
    }
}

/// A square, and what it has lost by rounding.
#[inline(always)]
fn square(v: f64) -> (f64, f64) {
    let square = v * v;
    (square, v.mul_add(v, -square))
}

/// Half the length of a vector, and its direction; none of no vector.
#[inline(always)]
fn half_and_direction(v: Vector) -> (f64, Vector) {
    let length = (v.x * v.x + v.y * v.y + v.z * v.z).sqrt();
    if length > 0.0 {
        (0.5 * length, v / length)
    } else {
        (0.0, v)
    }
}

/// The rotation about a direction by twice this angle.
#[inline(always)]
fn about(direction: Vector, half: f64) -> Quaternion {
    let (sine, cosine) = sincos(half);
    Quaternion::new(
        cosine,
        sine * direction.x,
        sine * direction.y,
        sine * direction.z,
    )
}
