//! Reasons for the end of a trajectory, and its limits.

/// Why a trajectory ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopReason {
    /// The number of impacts asked for was reached.
    ImpactsReached,
    /// √(2 E_kin/m) after an impact fell below [`Limits::minimum_speed`].
    SpeedBelowThreshold,
    /// Impacts accumulate (inelastic collapse): [`COLLAPSE_RUN`] flights in a row that are too low to be resolved, or a contact that
    /// is never left. The body may still rock or roll, but the model of instantaneous impacts does not describe lasting contact.
    Collapse,
    /// The axis would turn by more than [`crate::elementary::RANGE`] rad before the next impact, beyond the range of sine and cosine.
    NeverLands,
    /// The run was cancelled.
    Interrupted,
    /// The energy after an impact was below [`Limits::settled`].
    Settled,
}

impl StopReason {
    /// The names of all reasons, in the order of their numbers.
    pub const NAMES: [&'static str; 6] = [
        "impacts_reached",
        "speed_below_threshold",
        "collapse",
        "never_lands",
        "interrupted",
        "settled",
    ];
}

/// Conditions that end a trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest number of impacts.
    pub impacts: usize,
    /// Value of √(2 E_kin/m) below which a particle stops, in √(gR); with 0 none does.
    pub minimum_speed: f64,
    /// Energy in m g R, of which a frictionless law leaves out the horizontal motion, below which a rigid body of any shape stops; with 0
    /// none does.
    pub settled: f64,
}

/// M T² below which a flight of duration T counts as unresolved: no gap can then have exceeded M T²/8 = 2⁻⁴³ R, since M ≥ −f″.
pub(super) const UNRESOLVED: f64 = 8.0 / 8_796_093_022_208.0;
/// Number of unresolved flights in a row that counts as a collapse.
pub const COLLAPSE_RUN: u32 = 16;
