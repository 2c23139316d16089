//! Mass, centre of mass and moments of inertia of solids of revolution on a common axis, and of unions of them.

use std::f64::consts::PI;

/// Mass, centre of mass and moments of inertia of a solid of revolution, in any coherent units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MassProperties {
    pub mass: f64,
    /// Position of the centre of mass on the axis.
    pub centre: f64,
    /// Moment of inertia about an axis through the centre of mass perpendicular to the symmetry axis.
    pub transverse: f64,
    /// Moment of inertia about the symmetry axis.
    pub axial: f64,
}

impl MassProperties {
    /// A point mass on the axis.
    pub fn point(mass: f64, centre: f64) -> Self {
        Self {
            mass,
            centre,
            transverse: 0.0,
            axial: 0.0,
        }
    }

    /// A homogeneous sphere centred at the origin.
    pub fn sphere(radius: f64, density: f64) -> Self {
        let mass = density * (4.0 / 3.0 * PI) * radius.powi(3);
        let inertia = 0.4 * mass * (radius * radius);
        Self {
            mass,
            centre: 0.0,
            transverse: inertia,
            axial: inertia,
        }
    }

    /// The segment of height `height` ≤ 2ϱ that a plane perpendicular to the axis cuts off the top of a homogeneous sphere of
    /// radius ϱ centred at the origin: integrals over the slices at depth t below the pole, whose squared radius is t(2ϱ − t).
    pub fn segment(radius: f64, height: f64, density: f64) -> Self {
        let x = height / radius;
        let scale = density * PI * radius.powi(3) * (x * x);
        let mass = scale * (1.0 - x / 3.0); // ∫ t(2ϱ − t)
        let depth = radius * x * (8.0 - 3.0 * x) / (4.0 * (3.0 - x)); // ∫ t²(2ϱ − t), divided by the mass
        let square = scale * (radius * radius);
        let axial = square * x * (20.0 + x * (3.0 * x - 15.0)) / 30.0; // ½∫ t²(2ϱ − t)²
        let second = square * (x * x) * (40.0 + x * (3.0 * x - 24.0)) / (240.0 * (3.0 - x)); // about its centre
        Self {
            mass,
            centre: radius - depth,
            transverse: 0.5 * axial + second,
            axial,
        }
    }

    /// The same part turned upside down, with its own origin placed at `origin`.
    pub fn upside_down(self, origin: f64) -> Self {
        Self {
            centre: origin - self.centre,
            ..self
        }
    }

    /// This part without another that lies within it.
    pub fn less(self, other: Self) -> Self {
        self.and(Self {
            mass: -other.mass,
            centre: other.centre,
            transverse: -other.transverse,
            axial: -other.axial,
        })
    }

    /// Both parts together, by the parallel axis theorem.
    pub fn and(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        let share = other.mass / mass;
        let distance = other.centre - self.centre;
        let steiner = self.mass * share * (distance * distance);
        Self {
            mass,
            centre: share.mul_add(distance, self.centre),
            transverse: self.transverse + other.transverse + steiner,
            axial: self.axial + other.axial,
        }
    }
}
