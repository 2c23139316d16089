//! What the tests of statistics share: bins, and runs whose coefficients have every size.

use crate::common::*;
use proptest::prelude::*;
use restitution_core::statistics::{Axis, Bins, By, Histogram, Moments};
use restitution_core::{Level, Monitor, Orientation, Resources, Run};
use std::f64::consts::FRAC_PI_2;

pub const ROWS: usize = 40;

pub fn axis(edges: &[f64]) -> Axis {
    Axis::new("edges", edges).unwrap()
}

pub fn edges(low: f64, high: f64, bins: usize) -> Vec<f64> {
    let width = (high - low) / bins as f64;
    (0..=bins).map(|i| low + width * i as f64).collect()
}

/// Edges of the three axes.
#[derive(Debug, Clone)]
pub struct Edges {
    pub velocity: Vec<f64>,
    pub restitution: Vec<f64>,
    pub fraction: Vec<f64>,
}

impl Edges {
    /// Bins that leave impacts on every side.
    pub fn coarse() -> Self {
        Self {
            velocity: edges(0.1, 0.9, 8),
            restitution: edges(0.0, 1.5, 20),
            fraction: edges(0.05, 0.6, 10),
        }
    }

    pub fn by_velocity(&self) -> Bins {
        self.bins(By::Velocity(axis(&self.velocity)))
    }

    pub fn bins(&self, by: By) -> Bins {
        Bins {
            by,
            restitution: axis(&self.restitution),
            fraction: Some(axis(&self.fraction)),
        }
    }
}

/// A histogram, after a look at the one with counts alone: they must be the same counts.
pub fn statistics(run: &Run<'_>, bins: &Bins, level: Level, threads: usize) -> Histogram {
    let histogram = |bins: &Bins| {
        run.statistics(bins, Resources { threads, level }, &Monitor::default())
            .unwrap()
    };
    let found = histogram(bins);
    let counts = histogram(&Bins {
        fraction: None,
        ..bins.clone()
    });
    assert_eq!(counts.restitution, found.restitution);
    assert_eq!(counts.rows.gains, found.rows.gains);
    assert_eq!(counts.rows.stops, found.rows.stops);
    assert!(counts.fraction.counts().is_empty() && counts.rows.moments(0).is_none());
    found
}

pub fn level() -> impl Strategy<Value = Level> {
    prop::sample::select(Level::available().collect::<Vec<_>>())
}

/// Every number of a row of a histogram, as bits.
pub fn bits(histogram: &Histogram, rows: usize) -> Vec<u64> {
    let moments = |row| {
        let m: Moments = histogram.rows.moments(row).unwrap();
        let extremes = [
            m.minimum,
            m.maximum,
            histogram.rows.mean_fraction(row).unwrap(),
        ];
        [m.mean, m.variance, m.skewness, m.kurtosis]
            .into_iter()
            .chain(extremes)
    };
    (0..rows).flat_map(moments).map(f64::to_bits).collect()
}

/// A run whose coefficients are as large as they come: a level body, let go so that both spheres come down together. After
/// the first of the two impacts the centre of mass is nearly at rest, for ε_n = (L/2)²/(J_xx + R²) entirely; the second
/// impact then has ε → ∞. `off` is the departure from that ε_n, `angles` those from level.
pub fn nearly_at_rest(elongation: f64, off: f64, angles: &[f64]) -> Run<'_> {
    let body = dumbbell(elongation);
    let normal = body.half_separation.powi(2) / (body.transverse + 1.0) + off;
    Run {
        particles: angles.len(),
        impacts: ROWS,
        orientation: Orientation::Given(angles),
        ..paper(elongation, law(normal.clamp(0.0, 1.0), 1.0))
    }
}

/// Angles at less and less from level.
pub fn nearly_level() -> Vec<f64> {
    (0..24)
        .map(|i| FRAC_PI_2 + [1.0, -1.0][i % 2] * 0.1_f64.powi(i as i32 / 2 + 5))
        .collect()
}
