//! Pairs of a gas: two Maxwellians, and the flux of pairs through the sphere that both bodies reach.
//!
//! With **u** the velocity of the first body relative to the second, of variance s = T₁/m₁ + T₂/m₂ in each direction, pairs come through the
//! sphere of radius S, the sum of the reaches, at the rate πS²⟨u⟩ = πS²√(8s/π) for unit density. u²/2s of them has the density x e⁻ˣ, the direction is
//! isotropic, and the impact parameter uniform on the disc. On a plane they come with the flux √(T/2πm), and v_n²m/2T has the density e⁻ˣ.

use super::partner::{PairState, Partner};
use crate::Error;
use crate::math::{Quaternion, Vector, Vectors};
use crate::random::{NumberForm, formed, normal_pair, of_encounters};
use crate::simd::elementary::ln;
use crate::simd::{Pack, one as pack};
use pulp::Simd;
use std::f64::consts::{PI, TAU};

/// Three normal numbers from uniform ones in [0, 1).
#[inline(always)]
pub(crate) fn normals([first, second]: [(f64, f64); 2]) -> [f64; 3] {
    let ((x, y), (z, _)) = (normal_pair(first), normal_pair(second));
    [x, y, z]
}

/// The velocities with which two bodies meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Meeting {
    /// Those of Maxwellians with these temperatures, in units of energy.
    Temperatures([f64; 2]),
    /// This relative speed, with the centre of mass at rest.
    Speed(f64),
}

/// Encounters that are drawn at random, in SI units.
#[derive(Debug, Clone)]
pub struct Encounters<'a> {
    /// The bodies, of which the second may be a plane.
    pub bodies: [&'a Partner; 2],
    /// The number of the first encounter, on which it depends with the seed.
    pub first: u64,
    /// Number of encounters.
    pub count: usize,
    /// The velocities with which they meet.
    pub meeting: Meeting,
    /// The distance between the lines on which the centres of mass approach, if it is given.
    pub impact_parameter: Option<f64>,
    /// The temperatures of rotation, in units of energy.
    pub rotational: [f64; 2],
    /// ω of both bodies in the axes of space, if it is given.
    pub spin: Option<[Vector; 2]>,
    /// The seed.
    pub seed: u64,
}

impl Encounters<'_> {
    fn reach(&self) -> f64 {
        self.bodies[0].reach + self.bodies[1].reach
    }

    /// Refuses what cannot be drawn.
    ///
    /// # Errors
    /// [`Error::Parameter`].
    pub fn check(&self) -> Result<(), Error> {
        let finite = |x: f64| x.is_finite() && x >= 0.0;
        let warm = "finite and >= 0 (J)";
        match self.meeting {
            Meeting::Temperatures(both) => {
                for value in both {
                    Error::unless(finite(value), "translational_temperature", value, warm)?;
                }
                let moves = self.variance() > 0.0;
                let allowed = "> 0 for one of the bodies, or nothing meets (J)";
                Error::unless(moves, "translational_temperature", both[0], allowed)?;
            }
            Meeting::Speed(speed) => {
                let allowed = "finite and > 0 (m/s)";
                Error::unless(finite(speed) && speed > 0.0, "speed", speed, allowed)?;
            }
        }
        for value in self.rotational {
            Error::unless(finite(value), "rotational_temperature", value, warm)?;
        }
        if let Some(b) = self.impact_parameter {
            let allowed = "given with another body, in [0, the sum of the reaches of both] (m)";
            let holds = b >= 0.0 && b <= self.reach() && !self.bodies[1].is_plane();
            Error::unless(holds, "impact_parameter", b, allowed)?;
        }
        for spin in self.spin.iter().flatten() {
            let size = spin.norm();
            Error::unless(size.is_finite(), "spin", size, "finite (rad/s)")?;
        }
        Ok(())
    }

    /// The variance of each component of the relative velocity.
    fn variance(&self) -> f64 {
        let Meeting::Temperatures([one, two]) = self.meeting else {
            return 0.0;
        };
        one * self.bodies[0].inverse_mass + two * self.bodies[1].inverse_mass
    }

    /// The rate at which pairs enter the sphere of the sum of the reaches at unit density, in m³/s; on a plane that per area, in m/s.
    pub fn attempt_rate(&self) -> f64 {
        let reach = self.reach();
        let area = PI * reach * reach;
        match (self.meeting, self.bodies[1].is_plane()) {
            (Meeting::Temperatures(_), false) => area * (8.0 * self.variance() / PI).sqrt(),
            (Meeting::Temperatures(_), true) => (self.variance() / TAU).sqrt(),
            (Meeting::Speed(speed), false) => area * speed,
            (Meeting::Speed(speed), true) => speed,
        }
    }

    /// The bodies of an encounter, where they come through the sphere.
    #[inline(always)]
    pub(super) fn draw(&self, mut draws: Draws<'_>) -> [PairState; 2] {
        let moving = if self.bodies[1].is_plane() {
            self.onto_plane(&mut draws)
        } else {
            self.in_space(&mut draws)
        };
        let mut states = moving.map(|[position, velocity]| PairState {
            position,
            velocity,
            attitude: Quaternion::IDENTITY,
            spin: Vector::default(),
        });
        for (i, state) in states.iter_mut().enumerate() {
            if self.bodies[i].is_plane() {
                continue;
            }
            let body = self.bodies[i];
            state.attitude = draws.attitude();
            state.spin = match self.spin {
                Some(given) => given[i],
                None => {
                    let spin = draws.spin(body, [self.rotational[i]; 3]);
                    (state.attitude * body.axes).rotate(spin)
                }
            };
        }
        states
    }

    /// The place and the velocity of each of two bodies; their centre of mass is at the origin.
    #[inline(always)]
    fn in_space(&self, draws: &mut Draws<'_>) -> [[Vector; 2]; 2] {
        let [one, two] = [self.bodies[0].inverse_mass, self.bodies[1].inverse_mass];
        let reach = self.reach();
        let (height, (sine, cosine)) = draws.turn(1);
        let z = 2.0 * height - 1.0;
        let level = (1.0 - z * z).max(0.0).sqrt();
        let u = Vector::new(level * cosine, level * sine, z);
        let (square, around) = draws.turn(1);
        let b = match self.impact_parameter {
            Some(b) => b / reach,
            None => square.sqrt(),
        };
        let across = Vector::new(-sine, cosine, 0.0);
        let around = (pack(around.0), pack(around.1));
        let apart = approach(u.in_lane(), across.in_lane(), pack(b), around).lane(0) * reach;
        let whole = one + two;
        let (speed, drift, [w1, w2]) = match self.meeting {
            Meeting::Speed(speed) => (speed, Vector::default(), [one / whole, two / whole]),
            Meeting::Temperatures([t1, t2]) => {
                let (a, b) = draws.pair();
                let speed = (-2.0 * self.variance() * ln((1.0 - a) * (1.0 - b))).sqrt();
                let (s1, s2) = (t1 * one, t2 * two);
                let drift = Vector::from(draws.normals()) * (s1 * s2 / (s1 + s2)).sqrt();
                // With weights that make the rest independent of u.
                (speed, drift, [s1 / (s1 + s2), s2 / (s1 + s2)])
            }
        };
        [
            [apart * (one / whole), u.mul_add(speed * w1, drift)],
            [apart * (-two / whole), u.mul_add(-speed * w2, drift)],
        ]
    }

    /// Those of a body over a plane.
    #[inline(always)]
    fn onto_plane(&self, draws: &mut Draws<'_>) -> [[Vector; 2]; 2] {
        let velocity = match self.meeting {
            Meeting::Speed(speed) => Vector::new(0.0, 0.0, -speed),
            Meeting::Temperatures(_) => {
                let variance = self.variance();
                let (a, _) = draws.pair();
                let [x, y, _] = draws.normals();
                let part = variance.sqrt();
                Vector::new(part * x, part * y, -(-2.0 * variance * ln(1.0 - a)).sqrt())
            }
        };
        let place = Vector::new(0.0, 0.0, self.reach());
        [[place, velocity], [Vector::default(); 2]]
    }
}

/// The place on the unit sphere at which a body comes in along **u**, at the distance b from the parallel through the centre; `across` is a unit vector
/// normal to **u**, from which the azimuth counts, of which sine and cosine are given.
#[inline(always)]
pub(crate) fn approach<S: Simd>(
    u: Vectors<S>,
    across: Vectors<S>,
    b: Pack<S>,
    (s, c): (Pack<S>, Pack<S>),
) -> Vectors<S> {
    let second = u.cross(across);
    let back = (1.0 - b * b).max(0.0).sqrt();
    let aside = across * (b * c) + second * (b * s);
    aside - u * back
}

/// The random numbers of successive encounters, or particles of a gas: those of a draw are computed for all of them, when the first asks for it.
pub(crate) struct DrawRows {
    seed: u64,
    first: u64,
    rows: usize,
    numbers: Vec<Vec<[f64; 3]>>,
}

impl DrawRows {
    pub fn new(seed: u64, first: u64, rows: usize) -> Self {
        Self {
            seed,
            first,
            rows,
            numbers: Vec::new(),
        }
    }

    /// Those of one of them, each of which asks for the same forms.
    #[inline(always)]
    pub fn row(&mut self, row: usize) -> Draws<'_> {
        Draws {
            all: self,
            row,
            draw: 0,
        }
    }

    #[cold]
    fn fill(&mut self, form: NumberForm) {
        let mut pairs = vec![(0.0, 0.0); self.rows];
        let draw = self.numbers.len() as u32;
        of_encounters(self.seed, self.first, draw, &mut pairs);
        self.numbers.push(formed(form, &pairs));
    }
}

/// The random numbers of an encounter.
pub(crate) struct Draws<'a> {
    all: &'a mut DrawRows,
    row: usize,
    draw: usize,
}

impl Draws<'_> {
    #[inline(always)]
    fn next(&mut self, form: NumberForm) -> [f64; 3] {
        if self.draw == self.all.numbers.len() {
            self.all.fill(form);
        }
        self.draw += 1;
        self.all.numbers[self.draw - 1][self.row]
    }

    #[inline(always)]
    fn pair(&mut self) -> (f64, f64) {
        let [first, second, _] = self.next(NumberForm::Uniform);
        (first, second)
    }

    /// A uniform number, and sine and cosine of a uniform angle, that of the number at this place of a pair.
    #[inline(always)]
    fn turn(&mut self, place: usize) -> (f64, (f64, f64)) {
        let [other, sine, cosine] = self.next(NumberForm::Turn(place));
        (other, (sine, cosine))
    }

    /// Three normal numbers.
    #[inline(always)]
    pub fn normals(&mut self) -> [f64; 3] {
        let ([x, y, _], [z, ..]) = (self.next(NumberForm::Normal), self.next(NumberForm::Normal));
        [x, y, z]
    }

    /// ω, in the principal axes, of a Maxwellian with a temperature about each of them.
    #[inline(always)]
    pub fn spin(&mut self, body: &Partner, temperatures: [f64; 3]) -> Vector {
        let normals = self.normals();
        let part = |i: usize| normals[i] * (temperatures[i] * body.inverse_moments[i]).sqrt();
        Vector::new(part(0), part(1), part(2))
    }

    /// An attitude, uniform on SO(3): K. Shoemake, *Uniform random rotations*, Graphics Gems III (1992).
    #[inline(always)]
    pub fn attitude(&mut self) -> Quaternion {
        let ((a, (s, t)), (_, (u, v))) = (self.turn(1), self.turn(0));
        let (p, q) = ((1.0 - a).sqrt(), a.sqrt());
        Quaternion::new(p * s, p * t, q * u, q * v).normalized()
    }
}
