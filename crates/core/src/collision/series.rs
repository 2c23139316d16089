//! Polynomials: the Taylor series of an impact in which the slip turns, and where on them something happens.

/// Order of the series.
pub(super) const ORDER: usize = 24;
/// Largest size of the last two terms.
const REMAINDER: f64 = 1.0 / 18_014_398_509_481_984.0; // 2⁻⁵⁴
/// Halvings of a step, at most: far more than any series needs whose terms grow as those of a power.
const MOST_HALVINGS: usize = 50;
/// Steps of the search for a crossing; ten are usual.
const MOST_STEPS: usize = 100;

/// Coefficients of t⁰, t¹, ... .
pub(super) type Series = [f64; ORDER + 1];

/// a + bt.
pub(super) fn line(a: f64, b: f64) -> Series {
    let mut series = [0.0; ORDER + 1];
    (series[0], series[1]) = (a, b);
    series
}

/// start + factor ∫ series.
pub(super) fn integral(start: f64, series: &Series, factor: f64) -> Series {
    let mut sum = line(start, 0.0);
    for n in 0..ORDER {
        sum[n + 1] = factor * series[n] / (n + 1) as f64;
    }
    sum
}

pub(super) fn value(series: &Series, t: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, &c| sum * t + c)
}

/// A step in which the last two terms are below the remainder: `longest`, or that halved often enough.
pub(super) fn step_of(series: &Series, longest: f64) -> f64 {
    let small = |step: f64| {
        let power = (1..ORDER).fold(1.0, |power, _| power * step);
        let last = (series[ORDER] * step).abs().max(series[ORDER - 1].abs());
        last * power <= REMAINDER
    };
    let mut steps = (0..MOST_HALVINGS).scan(longest, |step, _| {
        Some(std::mem::replace(step, 0.5 * *step))
    });
    steps.find(|&step| small(step)).unwrap_or(0.0)
}

/// Where a function that is monotonic between two points becomes ≥ 0, which it is at `high`: the rule of false position, in
/// the Illinois variant.
pub(super) fn crossing(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut below, mut above) = (f(low), f(high));
    if below >= 0.0 {
        return low;
    }
    let (mut nearest, mut least) = if -below < above {
        (low, -below)
    } else {
        (high, above)
    };
    let mut kept = 0; // −1 or 1: the end that stayed in the last step
    for _ in 0..MOST_STEPS {
        let middle = (high - low).mul_add(below / (below - above), low);
        if middle <= low || middle >= high || least == 0.0 {
            break;
        }
        let value = f(middle);
        if value.abs() < least {
            (nearest, least) = (middle, value.abs());
        }
        if value >= 0.0 {
            (high, above) = (middle, value);
            below *= if kept < 0 { 0.5 } else { 1.0 };
            kept = -1;
        } else {
            (low, below) = (middle, value);
            above *= if kept > 0 { 0.5 } else { 1.0 };
            kept = 1;
        }
    }
    nearest
}
