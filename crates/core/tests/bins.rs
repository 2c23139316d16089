//! Every impact in its bin, none lost, and moments that are those of the impacts.

use crate::common::*;
use crate::histograms::*;
use proptest::prelude::*;
use restitution_core::statistics::{
    Axis, Bins, By, CREATES_ENERGY, Gains, Grid, Histogram, Moments, Sums,
};
use restitution_core::{Level, Monitor, Resources, Run, StopReason};

/// What a histogram should say, worked out from the table of impacts, one at a time.
struct Expected {
    restitution: Vec<u64>,
    fraction: Vec<u64>,
    /// ε − origin in whole quanta, and the bare ε, by row.
    quanta: Vec<Vec<i128>>,
    values: Vec<Vec<f64>>,
    /// Σ E_rot/E_tot in whole quanta.
    fractions: Vec<u128>,
    gains: Vec<Gains>,
    stops: [u64; StopReason::NAMES.len()],
}

/// The multiple of 2⁻²⁴ that stands for an offset: the next one, or beyond 2 the next multiple of 2⁻²⁰.
fn quanta(offset: f64) -> i128 {
    let coarse = if offset.abs() <= 2.0 { 1.0 } else { 16.0 };
    let whole = (offset * 2.0_f64.powi(24) / coarse).round_ties_even();
    coarse as i128 * whole as i128
}

/// lo ≤ x < hi by binary search: 0 below, n + 1 above.
fn bin(edges: &[f64], x: f64) -> usize {
    edges.partition_point(|&edge| edge <= x)
}

impl Expected {
    /// `row` gives the row of an impact from its velocity and its number.
    fn new(
        records: &Records,
        run: &Run<'_>,
        rows: usize,
        edges: &Edges,
        row: impl Fn(f64, usize) -> usize,
    ) -> Self {
        let columns = [edges.restitution.len() + 2, edges.fraction.len() + 2];
        let mut expected = Self {
            restitution: vec![0; rows * columns[0]],
            fraction: vec![0; rows * columns[1]],
            quanta: vec![Vec::new(); rows],
            values: vec![Vec::new(); rows],
            fractions: vec![0; rows],
            gains: vec![Gains::default(); rows],
            stops: [0; StopReason::NAMES.len()],
        };
        for particle in 0..run.particles {
            expected.stops[records.stop_reason[particle] as usize] += 1;
            for i in 0..records.impacts[particle] as usize {
                let k = particle * run.impacts + i;
                let (value, fraction) = (records.restitution[k], records.rotational_fraction[k]);
                let row = row(records.impact_velocity[k], i);
                let ratio = records.energy_ratio[k];
                if ratio > CREATES_ENERGY {
                    expected.gains[row].count += 1;
                    expected.gains[row].largest = expected.gains[row].largest.max(ratio);
                }
                let mut sites = columns.map(|columns| columns - 1);
                if value.abs() < Sums::LARGEST && fraction <= 1.0 {
                    sites = [
                        bin(&edges.restitution, value),
                        bin(&edges.fraction, fraction),
                    ];
                    expected.quanta[row].push(quanta(value - run.origin()));
                    expected.values[row].push(value);
                    expected.fractions[row] +=
                        (fraction * 2.0_f64.powi(42)).round_ties_even() as u128;
                }
                expected.restitution[row * columns[0] + sites[0]] += 1;
                expected.fraction[row * columns[1] + sites[1]] += 1;
            }
        }
        expected
    }

    fn by_velocity(records: &Records, run: &Run<'_>, edges: &Edges) -> Self {
        let rows = edges.velocity.len() + 1;
        Self::new(records, run, rows, edges, |velocity, _| {
            bin(&edges.velocity, velocity)
        })
    }

    fn by_number(records: &Records, run: &Run<'_>, edges: &Edges) -> Self {
        Self::new(records, run, run.impacts, edges, |_, number| number)
    }

    fn agrees(&self, histogram: &Histogram, origin: f64) -> Result<(), TestCaseError> {
        prop_assert_eq!(histogram.restitution.counts(), &self.restitution[..]);
        prop_assert_eq!(histogram.fraction.counts(), &self.fraction[..]);
        prop_assert_eq!(&histogram.rows.gains, &self.gains);
        prop_assert_eq!(&histogram.rows.stops, &self.stops);
        for (row, values) in self.values.iter().enumerate() {
            let number = values.len();
            prop_assert_eq!(histogram.rows.number(row), number as u64);
            let found = histogram.rows.moments(row).unwrap();
            let mean_fraction = histogram.rows.mean_fraction(row).unwrap();
            if number == 0 {
                prop_assert!(mean_fraction.is_nan());
                prop_assert!(
                    bits(histogram, row + 1)[7 * row..]
                        .iter()
                        .all(|&x| f64::from_bits(x).is_nan())
                );
                continue;
            }
            let n = number as f64;
            let fraction = self.fractions[row] as f64 / 2.0_f64.powi(42) / n;
            prop_assert_eq!(mean_fraction.to_bits(), fraction.to_bits());
            prop_assert_eq!(
                found.minimum,
                values.iter().copied().fold(f64::INFINITY, f64::min)
            );
            prop_assert_eq!(
                found.maximum,
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            );
            agree(&found, &self.quanta[row], origin)?;
        }
        Ok(())
    }
}

/// Compensated sum (Neumaier).
fn sum(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0_f64, 0.0);
    for x in values {
        let next = sum + x;
        lost += if sum.abs() >= x.abs() {
            (sum - next) + x
        } else {
            (x - next) + sum
        };
        sum = next;
    }
    sum + lost
}

/// The moments of `quanta` in two passes: the mean from an exact sum, then powers of the deviations, which cancel
/// nowhere. The engine subtracts moments about the origin, whose rounding shows by as much as the moments about the origin
/// are larger: three ulp of each term are allowed here, and no more.
fn agree(found: &Moments, quanta: &[i128], origin: f64) -> Result<(), TestCaseError> {
    let n = quanta.len() as f64;
    let unit = 2.0_f64.powi(-24);
    let mean = unit * (quanta.iter().sum::<i128>() as f64 / n);
    let rounding = 4.0 * f64::EPSILON;
    prop_assert!((found.mean - (origin + mean)).abs() <= rounding * (origin.abs() + mean.abs()));

    let offsets = || quanta.iter().map(|&q| unit * q as f64);
    let central = |k| sum(offsets().map(|x| (x - mean).powi(k))) / n;
    let about_origin = |k| sum(offsets().map(|x| x.abs().powi(k))) / n;
    // Sums of the coefficients in the formulas: 1 + 1, 1 + 3 + 2, 1 + 4 + 6 + 3.
    let allowed = |k, terms: f64| 3.0 * f64::EPSILON * terms * about_origin(k);
    let variance = central(2);
    prop_assert!(
        (found.variance - variance).abs() <= allowed(2, 2.0),
        "variance {} instead of {variance}",
        found.variance
    );
    // Shape is a matter of the deviations: where rounding is not beneath them, there is nothing to compare.
    if allowed(2, 2.0) < 1e-3 * variance {
        let third = found.skewness * found.variance.powf(1.5);
        prop_assert!(
            (third - central(3)).abs() <= allowed(3, 6.0),
            "third moment {third} instead of {}",
            central(3)
        );
        let fourth = found.kurtosis * found.variance * found.variance;
        prop_assert!(
            (fourth - central(4)).abs() <= allowed(4, 14.0),
            "fourth moment {fourth} instead of {}",
            central(4)
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(200))]

    /// Every impact of the table is in the bin in which a binary search puts it, none is lost, and the moments are those of the
    /// rounded values.
    #[test]
    fn it_counts_and_sums_what_simulate_records(
        elongation in elongation(), (normal, tangential) in coefficients(), particles in 1..100_usize, impacts in 1..60_usize,
        seed in any::<u64>(), level in level(),
    ) {
        let run = Run { particles, impacts, seed, ..paper(elongation, law(normal, tangential)) };
        counts_and_sums_what_simulate_records(&run, level)?;
    }

    /// And so it does where ε is anything up to 2³³, beyond, and infinite.
    #[test]
    fn it_counts_and_sums_coefficients_of_every_size(
        elongation in 0.5..3.0_f64, off in prop_oneof![Just(0.0), magnitude(-16.0, -1.0)], level in level(),
    ) {
        let angles = nearly_level();
        counts_and_sums_what_simulate_records(&nearly_at_rest(elongation, off, &angles), level)?;
    }

    /// Bins are lo ≤ x < hi with the very edges that were given. An impact is picked, and bins of all widths are laid so that
    /// one edge of each axis is just its value, or the number above or below. Edges may be off from uniform by what rounding
    /// makes of them, and more.
    #[test]
    fn the_edges_themselves_decide(
        elongation in 0.05..3.0_f64, pick in any::<prop::sample::Index>(), ulps in [-1..=1_i8, -1..=1_i8, -1..=1_i8],
        widths in [magnitude(-6.0, 0.0), magnitude(-6.0, 0.0), magnitude(-6.0, 0.0)], below in 0..20_usize,
        jitter in prop::collection::vec(-3e-8..3e-8_f64, 21), level in level(),
    ) {
        let run = Run { particles: 40, impacts: 30, ..paper(elongation, law(0.9, 0.5)) };
        let records = Records::from(run.simulate(Resources { threads: 1, level }, &Monitor::default()).unwrap());
        let i = pick.index(run.particles) * run.impacts;
        let i = i + pick.index(records.impacts[i / run.impacts] as usize);
        let around = |axis: usize, value: f64| -> Vec<f64> {
            let edge = match ulps[axis] {
                -1 => value.next_down(),
                1 => value.next_up(),
                _ => value,
            };
            let place = |k: usize| k as f64 - below as f64 + if k == below { 0.0 } else { jitter[k] };
            let width = widths[axis] * value.abs().max(1.0);
            (0..=20).map(|k| width.mul_add(place(k), edge)).collect()
        };
        let edges = Edges {
            velocity: around(0, records.impact_velocity[i]),
            restitution: around(1, records.restitution[i]),
            fraction: around(2, records.rotational_fraction[i]),
        };
        let histogram = statistics(&run, &edges.by_velocity(), level, 1);
        Expected::by_velocity(&records, &run, &edges).agrees(&histogram, run.origin())?;
    }
}

fn counts_and_sums_what_simulate_records(run: &Run<'_>, level: Level) -> Result<(), TestCaseError> {
    let records = Records::from(
        run.simulate(Resources { threads: 1, level }, &Monitor::default())
            .unwrap(),
    );
    let edges = Edges::coarse();
    let origin = run.origin();
    let by_velocity = statistics(run, &edges.by_velocity(), level, 2);
    Expected::by_velocity(&records, run, &edges).agrees(&by_velocity, origin)?;
    let by_number = statistics(run, &edges.bins(By::Number(run.impacts)), level, 2);
    Expected::by_number(&records, run, &edges).agrees(&by_number, origin)?;

    let impacts = records.impacts.iter().sum::<i64>() as u64;
    let total = |grid: &Grid| grid.counts().iter().sum::<u64>();
    for histogram in [&by_velocity, &by_number] {
        prop_assert_eq!(total(&histogram.restitution), impacts);
        prop_assert_eq!(total(&histogram.fraction), impacts);
        prop_assert_eq!(
            histogram.rows.stops.iter().sum::<u64>(),
            run.particles as u64
        );
    }
    Ok(())
}

/// Widths that grow from one end to the other, on any of the three axes beside uniform ones on the others: every impact is where a
/// binary search puts it.
#[test]
fn bins_of_different_widths_hold_what_is_between_their_edges() {
    let run = Run {
        particles: 60,
        impacts: 25,
        ..paper(0.7, law(0.9, 0.5))
    };
    let records = simulate(&run);
    let uniform = Edges::coarse();
    let uneven = |edges: &[f64]| -> Vec<f64> {
        let (low, high) = (edges[0], edges[edges.len() - 1]);
        let share = |k: usize| k as f64 / (edges.len() - 1) as f64;
        (0..edges.len())
            .map(|k| (high - low).mul_add(share(k).powi(2), low))
            .collect()
    };
    for which in 0..8 {
        let mut edges = uniform.clone();
        let axes = [
            &mut edges.velocity,
            &mut edges.restitution,
            &mut edges.fraction,
        ];
        for (k, axis) in axes.into_iter().enumerate() {
            if which >> k & 1 == 1 {
                *axis = uneven(axis);
            }
        }
        for level in Level::available() {
            let by_velocity = Expected::by_velocity(&records, &run, &edges);
            let by_number = Expected::by_number(&records, &run, &edges);
            for (expected, by) in [
                (by_velocity, By::Velocity(axis(&edges.velocity))),
                (by_number, By::Number(run.impacts)),
            ] {
                let histogram = statistics(&run, &edges.bins(by), level, 1);
                expected.agrees(&histogram, run.origin()).unwrap();
            }
        }
    }
}

/// Bins of the number 0, which has two signs that are equal: the first impact of a body that does not spin has a rotational
/// fraction of 0, and a plastic sphere has ε = 0.
#[test]
fn minus_zero_is_zero() {
    let run = paper(0.0, law(0.0, 1.0));
    for zero in [0.0, -0.0] {
        let edges = |low: f64, high: f64| vec![low, zero, high];
        for (edges, column) in [
            (edges(-1.0, 1.0), 2),
            // The number above zero: zero is below it.
            (vec![-1.0, 5e-324, 1.0], 1),
            (vec![-1.0, -5e-324, 1.0], 2),
        ] {
            let bins = Bins {
                by: By::Number(run.impacts),
                restitution: axis(&edges),
                fraction: Some(axis(&edges)),
            };
            for level in Level::available() {
                let histogram = statistics(&run, &bins, level, 1);
                for grid in [&histogram.restitution, &histogram.fraction] {
                    assert_eq!(grid.counts()[column], run.particles as u64, "{edges:?}");
                    assert_eq!(grid.counts().iter().sum::<u64>(), run.particles as u64);
                }
            }
        }
    }
}

/// A million bins: the place of an impact among so many is rounded more, and the edges still decide.
#[test]
fn many_bins_are_as_exact_as_few() {
    let run = paper(0.5, law(0.9, 0.5));
    let records = simulate(&Run { impacts: 3, ..run });
    let run = Run { impacts: 3, ..run };
    let edges = Edges {
        velocity: Vec::new(),
        restitution: edges(-0.3, 1.9, 1 << 20),
        fraction: edges(0.0, 1.0, 1 << 20),
    };
    let histogram = statistics(&run, &edges.bins(By::Number(3)), Level::best(), 1);
    Expected::by_number(&records, &run, &edges)
        .agrees(&histogram, run.origin())
        .unwrap();
}

/// What cannot be bins is said to be none; their widths are free.
#[test]
fn edges_are_checked() {
    let good = edges(0.0, 1.0, 10);
    assert!(Axis::new("edges", &good).is_ok());
    let with = |i: usize, edge: f64| {
        let mut edges = good.clone();
        edges[i] = edge;
        Axis::new("edges", &edges)
    };
    assert!(with(3, good[3] + 5e-9).is_ok());
    assert!(with(3, good[3] + 1e-2).is_ok());
    for i in [0, 3, 10] {
        for edge in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(with(i, edge).is_err(), "{edge} at {i}");
        }
    }
    assert!(with(3, good[4]).is_err() && with(3, good[2]).is_err());
    let backwards: Vec<f64> = good.iter().rev().copied().collect();
    for edges in [
        &[][..],
        &[1.0],
        &[1.0, 1.0],
        &backwards,
        &[0.0, 5e-324],
        &[-1.7e308, 1.7e308],
    ] {
        assert!(Axis::new("edges", edges).is_err(), "{edges:?}");
    }
}
