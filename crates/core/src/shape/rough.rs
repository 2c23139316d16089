//! Rough bodies: asperities, small balls, on the surface of a body of balls.

use super::pieces::Extent;
use super::rigid::{Inertia, Rigid, RigidBall};
use super::{BodyKind, Form, Matter, check_length};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::math::{Quaternion, Vector};
use crate::random::of_asperity;
use crate::simd::elementary::{exp_in_lanes, ln, sincos};
use crate::simd::one;
use std::f64::consts::TAU;

/// Heights of the tops of asperities above the surface, in m. None that is given is above twice the radius of the asperities, which would then
/// not touch the surface; of a distribution the mean is not, or the least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Heights<'a> {
    /// All alike.
    Equal(f64),
    /// One each.
    Given(&'a [f64]),
    /// With the density exp(−h/m)/m, m the mean.
    Exponential(f64),
    /// Normal with this mean and this deviation, where it is not negative.
    Normal(f64, f64),
    /// With a density ∝ h to the power −γ from the least to the most: γ, least, most.
    Power(f64, f64, f64),
}

/// The asperities of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roughness<'a> {
    /// Number of asperities.
    pub asperities: usize,
    /// Their radius, in m.
    pub radius: f64,
    /// Their heights.
    pub heights: Heights<'a>,
    /// Seed of their places and heights.
    pub seed: u64,
}

/// The entry of a rough sphere in the table of bodies. Its heights may be one for each asperity, or a distribution.
pub(super) const ROUGH_SPHERE: BodyKind = BodyKind::Rigid(Kind {
    name: "RoughSphere",
    text: "sphere with small balls on its surface",
    parameters: &[
        Parameter::length("radius", "radius of the sphere", 3e-3),
        Parameter::new(
            "asperities",
            "number of asperities",
            Some("1"),
            Allowed::Whole(Interval::from(1.0, 2_147_483_647.0)),
            Argument::Whole(1000),
        ),
        Parameter::length("asperity_radius", "radius of the asperities", 3e-5).up_to(f64::INFINITY),
        Parameter::distance(
            "heights",
            "heights of the tops of the asperities above the sphere",
            3e-5,
        )
        .optional(),
        Parameter::density("density"),
        Parameter::new(
            "seed",
            "seed of the asperities",
            Some("1"),
            Allowed::Whole(Interval::NOT_NEGATIVE),
            Argument::Whole(1),
        )
        .or(Argument::Whole(1))
        .linked("asperity_seed"),
    ],
    make: |given| {
        check_length("radius", given.number(0))?;
        let sphere = [RigidBall {
            centre: Vector::default(),
            radius: given.number(0),
        }];
        let inertia = Rigid::clump(&sphere, given.number(4), Matter::Sum)?.inertia;
        let roughness = Roughness {
            asperities: given.whole(1) as usize,
            radius: given.number(2),
            heights: Heights::of(given.get(3), given.number(2))?,
            seed: given.whole(5),
        };
        Rigid::rough(&sphere, false, inertia, &roughness).map(Form::from)
    },
});

impl<'a> Heights<'a> {
    /// Those that an argument gives; all alike if it is left out.
    ///
    /// # Errors
    /// If there is no such distribution.
    pub fn of(given: Option<&Argument<'a>>, alike: f64) -> Result<Self, Error> {
        Ok(match given {
            Some(Argument::Absent) => Self::Equal(alike),
            Some(Argument::Numbers(each)) => Self::Given(each),
            Some(&Argument::Drawn(name, numbers)) => match (name, numbers) {
                ("exponential", &[mean]) => Self::Exponential(mean),
                ("normal", &[mean, deviation]) => Self::Normal(mean, deviation),
                ("power", &[exponent, least, most]) => Self::Power(exponent, least, most),
                _ => {
                    let allowed = "exponential, normal or power, with its numbers";
                    return Err(Error::parameter("heights", name, allowed));
                }
            },
            other => Self::Equal(other.map_or(f64::NAN, |&given| [given].number(0))),
        })
    }
}

/// Draws of an asperity until it has a place on the surface and a height.
const DRAWS: u32 = 100_000;

impl Rigid {
    /// Balls (m) with a given inertia, and asperities that lie uniformly on the free surface of their union. With `barrel` the surface of the
    /// cylinder between two balls of the same radius belongs to it. The balls come first; asperity i does not depend on the number of them.
    ///
    /// # Errors
    /// [`Error::Parameter`] for an asperity larger than the smallest ball, heights below 0 or larger than that, and balls without a free surface;
    /// [`Error::Memory`].
    pub fn rough(
        balls: &[RigidBall],
        barrel: bool,
        inertia: Inertia,
        roughness: &Roughness<'_>,
    ) -> Result<Self, Error> {
        super::clump::check(balls)?;
        let radii = balls.iter().map(|ball| ball.radius);
        roughness.check(radii.fold(f64::INFINITY, f64::min))?;
        let surface = FreeSurface::new(balls, barrel);
        let free = surface.draw(roughness.seed, 0).is_some();
        let allowed = "such that no other covers all of one";
        Error::unless(free, "spheres", balls.len(), allowed)?;
        let all = balls.len() + roughness.asperities;
        let parts = (0..all).map(|i| match balls.get(i) {
            Some(ball) => *ball,
            None => roughness.asperity(&surface, i - balls.len()),
        });
        let extent = if barrel { Extent::Other } else { Extent::Balls };
        Self::of_balls(inertia, "asperities", extent, parts)
    }
}

impl Roughness<'_> {
    fn check(&self, smallest: f64) -> Result<(), Error> {
        let allowed = "one or more";
        Error::unless(self.asperities > 0, "asperities", self.asperities, allowed)?;
        let fits = self.radius > 0.0 && self.radius <= smallest;
        let allowed = "> 0, and no larger than the smallest sphere of the body (m)";
        Error::unless(fits, "asperity_radius", self.radius, allowed)?;
        let allowed = "finite, >= 0, and no larger than the smallest sphere of the body, nor than twice asperity_radius: \
             a higher one would float (m)";
        let within = |height: f64| {
            let stands = (0.0..=smallest.min(2.0 * self.radius)).contains(&height);
            Error::unless(stands, "heights", height, allowed)
        };
        match self.heights {
            Heights::Equal(height) => within(height),
            Heights::Given(heights) => {
                let allowed = "one for each of the asperities";
                let count = heights.len();
                Error::unless(count == self.asperities, "heights", count, allowed)?;
                heights.iter().try_for_each(|&height| within(height))
            }
            Heights::Exponential(mean) => within(mean),
            Heights::Normal(mean, deviation) => {
                within(mean)?;
                let allowed =
                    "finite, >= 0, and no larger than the smallest sphere of the body (m)";
                let holds = (0.0..=smallest).contains(&deviation);
                Error::unless(holds, "heights", deviation, allowed)
            }
            Heights::Power(exponent, least, most) => {
                let allowed = "with a finite exponent and 0 < least <= most (m)";
                let holds = exponent.is_finite() && 0.0 < least && least <= most;
                Error::unless(holds, "heights", least, allowed)?;
                let allowed = "no larger than the smallest sphere of the body (m)";
                Error::unless(most <= smallest, "heights", most, allowed)?;
                within(least)
            }
        }
    }

    /// The ball that is asperity `i`.
    fn asperity(&self, surface: &FreeSurface<'_>, i: usize) -> RigidBall {
        let (place, normal) = surface.draw(self.seed, i as u64).unwrap_or_default();
        RigidBall {
            centre: place + normal * (self.height(i) - self.radius),
            radius: self.radius,
        }
    }

    /// Height of the top of asperity `i` above the surface.
    fn height(&self, i: usize) -> f64 {
        let draw = |number: u32| of_asperity(self.seed, i as u64, 3 * number);
        match self.heights {
            Heights::Equal(height) => height,
            Heights::Given(heights) => heights[i],
            Heights::Exponential(mean) => -mean * ln(1.0 - draw(0).0),
            // Box and Muller's, until one is not negative.
            Heights::Normal(mean, deviation) => (0..DRAWS)
                .map(|number| {
                    let (u, v) = draw(number);
                    let size = (-2.0 * ln(1.0 - u)).sqrt();
                    mean + deviation * size * sincos(TAU * v).1
                })
                .find(|&height| height >= 0.0)
                .unwrap_or(0.0),
            Heights::Power(exponent, least, most) => {
                let (power, range) = (1.0 - exponent, ln(most / least));
                let exp = |x: f64| exp_in_lanes(one(x)).as_slice()[0];
                let u = draw(0).0;
                // The inverse of (xᵖ − 1)/(Xᵖ − 1), with x = h/least up to X, and p = 1 − γ.
                let logarithm = if (power * range).abs() < 1e-9 {
                    u * range
                } else {
                    ln(1.0 + u * (exp(power * range) - 1.0)) / power
                };
                least * exp(logarithm)
            }
        }
    }
}

/// The free surface of balls, and of the barrel between two.
struct FreeSurface<'a> {
    balls: &'a [RigidBall],
    /// Up to each ball and the barrel, the part of the area of all before any is covered.
    shares: Vec<f64>,
    barrel: Option<Barrel>,
}

/// A cylinder from one place to another.
struct Barrel {
    from: Vector,
    axis: Vector,
    length: f64,
    /// The rotation of z to the axis.
    attitude: Quaternion,
    radius: f64,
}

impl<'a> FreeSurface<'a> {
    fn new(balls: &'a [RigidBall], barrel: bool) -> Self {
        let barrel = match balls {
            [one, other] if barrel => Barrel::new(one, other),
            _ => None,
        };
        let mut shares = Vec::new();
        let mut sum = 0.0;
        for ball in balls {
            sum += 2.0 * ball.radius * ball.radius;
            shares.push(sum);
        }
        if let Some(barrel) = &barrel {
            shares.push(sum + barrel.radius * barrel.length);
        }
        let all = shares[shares.len() - 1];
        for share in &mut shares {
            *share /= all;
        }
        Self {
            balls,
            shares,
            barrel,
        }
    }

    /// A place of the free surface and its normal there: uniform on all surfaces, until it is free.
    fn draw(&self, seed: u64, asperity: u64) -> Option<(Vector, Vector)> {
        (0..DRAWS).find_map(|number| {
            let (u, v) = of_asperity(seed, asperity, 3 * number + 1);
            let part = if self.shares.len() > 1 {
                let (chosen, _) = of_asperity(seed, asperity, 3 * number + 2);
                self.shares.partition_point(|&share| share <= chosen)
            } else {
                0
            };
            let (sine, cosine) = sincos(TAU * v);
            match (self.balls.get(part), &self.barrel) {
                (Some(ball), barrel) => {
                    let z = 2.0 * u - 1.0;
                    let level = ((1.0 - z) * (1.0 + z)).sqrt();
                    let normal = Vector::new(level * cosine, level * sine, z);
                    let place = ball.centre + normal * ball.radius;
                    let covered = self.covers(part, place)
                        || barrel.as_ref().is_some_and(|barrel| barrel.covers(place));
                    (!covered).then_some((place, normal))
                }
                (None, Some(barrel)) => {
                    let normal = barrel.attitude.rotate(Vector::new(cosine, sine, 0.0));
                    let middle = barrel.from + barrel.axis * (u * barrel.length);
                    Some((middle + normal * barrel.radius, normal))
                }
                (None, None) => None,
            }
        })
    }

    /// True if a place on the sphere of a ball lies in another.
    fn covers(&self, own: usize, place: Vector) -> bool {
        let inside =
            |(i, ball): (usize, &RigidBall)| i != own && (place - ball.centre).norm() < ball.radius;
        self.balls.iter().enumerate().any(inside)
    }
}

impl Barrel {
    fn new(one: &RigidBall, other: &RigidBall) -> Option<Self> {
        let apart = other.centre - one.centre;
        let length = apart.norm();
        if length == 0.0 {
            return None;
        }
        let axis = apart / length;
        Some(Self {
            from: one.centre,
            axis,
            length,
            attitude: Quaternion::from_z(axis),
            radius: one.radius,
        })
    }

    /// True if a place on the sphere of either end lies between both ends.
    fn covers(&self, place: Vector) -> bool {
        let along = (place - self.from).dot(self.axis);
        along > 0.0 && along < self.length
    }
}
