//! The gravitational field.

/// Gravity in the frame of the plane, in the core's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gravity {
    /// Acceleration towards the plane: 1, the core's unit, or 0 where there is no gravity.
    pub normal: f64,
    /// Acceleration along x, down the slope.
    pub along: f64,
}

impl Gravity {
    /// Gravity over a plane that descends along x with this slope, tan α.
    pub fn inclined(slope: f64) -> Self {
        Self {
            normal: 1.0,
            along: slope,
        }
    }
}
