//! When and why a trajectory ends.

/// Why a trajectory ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopReason {
    /// The number of impacts asked for was reached.
    ImpactsReached,
    /// √(2 E_kin/m) after an impact fell below the threshold asked for.
    SpeedBelowThreshold,
    /// Impacts accumulate: [`COLLAPSE_RUN`] flights in a row too low to be resolved, or a contact that is never left. The
    /// body may still rock or roll; what it does in lasting contact the model of instantaneous impacts cannot say.
    Collapse,
    /// The next landing is beyond what can be followed: the axis would turn by more than
    /// [`crate::elementary::RANGE`] rad.
    NeverLands,
    /// The run was cancelled.
    Interrupted,
}

impl StopReason {
    /// The names of all, in the order of their numbers.
    pub const NAMES: [&'static str; 5] = [
        "impacts_reached",
        "speed_below_threshold",
        "collapse",
        "never_lands",
        "interrupted",
    ];
}

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most impacts.
    pub impacts: usize,
    /// Stop below this √(2 E_kin/m), in √(gR); 0 never does.
    pub minimum_speed: f64,
}

/// A flight counts as unresolved when no gap can have exceeded 2⁻⁴³ R in it: M T²/8 < 2⁻⁴³, M ≥ |f″|.
pub(super) const UNRESOLVED: f64 = 8.0 / 8_796_093_022_208.0;
/// This many unresolved flights in a row are a collapse.
pub const COLLAPSE_RUN: u32 = 16;
