//! A sphere with a point mass inside: it is round, but its centre of mass is not its centre.

use super::{
    Arc, Ball, Body, INERTIA, OneBall, Shape, Solid, Surface, WALL, check_density, check_distance,
    check_length, hollow, made, representable,
};
use crate::Error;
use crate::describe::{Arguments, Interval, Kind, Parameter};
use crate::shape::mass::MassProperties;

/// A homogeneous sphere with a point mass on its axis, in SI units. The axis points from the centre to the load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadedSphere {
    radius: f64,
    density: f64,
    load: f64,
    offset: f64,
    wall: Option<f64>,
}

impl LoadedSphere {
    /// Its entry in the table of bodies.
    pub(crate) const KIND: Kind<Solid> = Kind {
        name: "LoadedSphere",
        text: "a sphere with a point mass inside",
        parameters: &[
            Parameter::length("radius", "radius of the sphere", 3e-3),
            Parameter::density("density of the sphere"),
            Parameter::number(
                "load",
                "mass of the point",
                "kg",
                Interval::NOT_NEGATIVE,
                1e-4,
            ),
            Parameter::distance(
                "offset",
                "distance of the point from the centre, at most the radius",
                2e-3,
            ),
            WALL,
            INERTIA,
        ],
        make: |given| {
            let [radius, density, load, offset] = std::array::from_fn(|i| given.number(i));
            made(Self::new(radius, density, load, offset)?, given, 4)
        },
    };

    /// A sphere of `radius` (m) and `density` (kg/m³) with a point mass `load` (kg) at the distance `offset` (m) from its centre.
    ///
    /// # Errors
    /// Unless `radius` and `density` are positive, `load` is not negative and `offset` is in [0, `radius`]; and if mass or
    /// inertia overflows or underflows.
    pub fn new(radius: f64, density: f64, load: f64, offset: f64) -> Result<Self, Error> {
        check_length("radius", radius)?;
        check_density(density)?;
        let weighs = load.is_finite() && load >= 0.0;
        Error::unless(weighs, "load", load, "finite and >= 0 (kg)")?;
        check_distance("offset", offset)?;
        Error::unless(offset <= radius, "offset", offset, "at most the radius (m)")?;
        let body = Self {
            radius,
            density,
            load,
            offset,
            wall: None,
        };
        representable(body, "radius")
    }
}

impl Shape for LoadedSphere {
    fn solid(&self) -> Solid {
        let sphere = |radius| MassProperties::sphere(radius, self.density);
        let whole = sphere(self.radius);
        let part = self
            .wall
            .map_or(whole, |wall| whole.less(sphere(self.radius - wall)))
            .and(MassProperties::point(self.load, self.offset));
        let square = self.radius * self.radius;
        let ball = Ball {
            offset: -part.centre / self.radius,
            radius: 1.0,
        };
        Solid {
            unit: self.radius,
            mass: part.mass,
            transverse_inertia: part.transverse,
            axial_inertia: part.axial,
            centre_of_mass: part.centre,
            is_filled: false,
            outline: Arc::halves(-part.centre, self.radius, self.radius),
            scaled: Body {
                hull: Surface::OneBall(OneBall::new(ball, true)),
                half_separation: 0.0,
                transverse: part.transverse / part.mass / square,
                axial: part.axial / part.mass / square,
            },
        }
    }

    fn hollow(self, wall: f64) -> Result<Self, Error> {
        let wall = hollow::checked(wall, self.radius, (self.radius, "at most the radius (m)"))?;
        representable(Self { wall, ..self }, "radius")
    }
}
