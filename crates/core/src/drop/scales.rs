//! Conversion between SI units and the core's: lengths in R, times in √(R/g).

use crate::Error;

/// The units of length, time and speed of a run, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// R, in m.
    pub length: f64,
    /// √(R/g), in s.
    pub time: f64,
    /// √(gR), in m/s.
    pub speed: f64,
}

impl Scales {
    /// The scales for a sphere radius (m) and an acceleration of gravity normal to the plane (m/s²).
    ///
    /// # Errors
    /// Unless gravity is finite and > 0, and if R/g or gR overflows or underflows.
    pub fn new(radius: f64, gravity: f64) -> Result<Self, Error> {
        let allowed = "finite and > 0 (m/s^2)";
        let positive = gravity.is_finite() && gravity > 0.0;
        Error::unless(positive, "gravity", gravity, allowed)?;
        // A subnormal number has few digits, and its root is normal again.
        let (time_squared, speed_squared) = (radius / gravity, radius * gravity);
        let representable = time_squared.is_normal() && speed_squared.is_normal();
        Error::unless(
            representable,
            "gravity",
            gravity,
            "such that R/g and gR neither overflow nor underflow",
        )?;
        Ok(Self {
            length: radius,
            time: time_squared.sqrt(),
            speed: speed_squared.sqrt(),
        })
    }
}
