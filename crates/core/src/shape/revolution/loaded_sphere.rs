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
            Parameter::number(
                "offset",
                "distance of the point from the centre, at most the radius",
                "m",
                Interval::NOT_NEGATIVE,
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

    /// Mass, centre and inertia of sphere and load.
    fn whole(&self) -> MassProperties {
        let sphere = |radius| MassProperties::sphere(radius, self.density);
        let whole = sphere(self.radius);
        self.wall
            .map_or(whole, |wall| whole.less(sphere(self.radius - wall)))
            .and(MassProperties::point(self.load, self.offset))
    }
}

impl Shape for LoadedSphere {
    fn unit(&self) -> f64 {
        self.radius
    }

    fn mass(&self) -> f64 {
        self.whole().mass
    }

    fn transverse_inertia(&self) -> f64 {
        self.whole().transverse
    }

    fn axial_inertia(&self) -> f64 {
        self.whole().axial
    }

    fn centre_of_mass(&self) -> f64 {
        self.whole().centre
    }

    fn outline(&self) -> [Arc; 2] {
        Arc::halves(-self.centre_of_mass(), self.radius, self.radius)
    }

    fn hollow(self, wall: f64) -> Result<Self, Error> {
        let wall = hollow::checked(wall, self.radius, (self.radius, "at most the radius (m)"))?;
        representable(Self { wall, ..self }, "radius")
    }

    fn scaled(&self) -> Body {
        let part = self.whole();
        let square = self.radius * self.radius;
        let ball = Ball {
            offset: -part.centre / self.radius,
            radius: 1.0,
        };
        Body {
            hull: Surface::OneBall(OneBall::new(ball, true)),
            half_separation: 0.0,
            transverse: part.transverse / part.mass / square,
            axial: part.axial / part.mass / square,
        }
    }
}
