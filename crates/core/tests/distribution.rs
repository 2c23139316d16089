//! Tables of p(ε | v): the functions belong to one distribution, and no schedule shows in the draws.

use crate::common::cases;
use proptest::prelude::*;
use restitution_core::distribution::{At, Broadcast, Curve, Layout, Mixture, Nodes, values};
use restitution_core::{Error, Level, Monitor, Resources};

/// Histograms at increasing speeds, each with as many conditions as it has entries in `conditions`.
#[derive(Debug, Clone)]
struct Table {
    speeds: Vec<f64>,
    first: Vec<i64>,
    conditions: Vec<f64>,
    start: Vec<i64>,
    edges: Vec<f64>,
    cumulative: Vec<f64>,
}

impl Table {
    fn nodes(&self) -> Result<Nodes, Error> {
        let (speeds, first) = (self.speeds.clone(), self.first.clone());
        Nodes::new(speeds, first, self.conditions.clone())
    }

    fn mixture(&self) -> Result<Mixture, Error> {
        Mixture::new(Layout {
            nodes: self.nodes()?,
            start: self.start.clone(),
            edges: self.edges.clone(),
            cumulative: self.cumulative.clone(),
        })
    }

    fn ask(&self, what: Curve, x: &[f64], v: f64, z: f64) -> Vec<f64> {
        let mixture = self.mixture().unwrap();
        let mut out = vec![0.0; x.len()];
        let (v, z) = ([v], [z]);
        let at = at(&v, &z, x.len());
        let x = Broadcast::new(x, "x", x.len()).unwrap();
        let monitor = Monitor::default();
        mixture
            .evaluate(what, x, at, &mut out, on(1), &monitor)
            .unwrap();
        out
    }

    fn draw(&self, v: &[f64], z: &[f64], size: usize, threads: usize) -> Vec<f64> {
        let mixture = self.mixture().unwrap();
        let mut out = vec![0.0; size];
        let monitor = Monitor::default();
        mixture
            .rvs(at(v, z, size), 7, &mut out, on(threads), &monitor)
            .unwrap();
        out
    }
}

fn at<'a>(v: &'a [f64], z: &'a [f64], size: usize) -> At<'a> {
    At {
        speed: Broadcast::new(v, "v", size).unwrap(),
        condition: Broadcast::new(z, "given", size).unwrap(),
    }
}

fn on(threads: usize) -> Resources {
    Resources {
        threads,
        level: Level::best(),
    }
}

/// Increasing numbers from steps > 0.
fn rising(start: f64, steps: &[f64]) -> Vec<f64> {
    let mut at = start;
    let rest = steps.iter().map(|step| {
        at += step;
        at
    });
    std::iter::once(start).chain(rest).collect()
}

/// Any table: two to four nodes of one to three conditions, one to six bins, some of them empty.
fn table() -> impl Strategy<Value = Table> {
    let step = || 0.01..2.0_f64;
    let share = || prop_oneof![1 => Just(0.0), 4 => 0.01..1.0_f64];
    let histogram = (
        -2.0..2.0_f64,
        prop::collection::vec((step(), share()), 1..6),
        step(),
    );
    let node = prop::collection::vec((step(), histogram), 1..4);
    (0.1..1.0_f64, prop::collection::vec((step(), node), 2..5)).prop_map(|(start, nodes)| {
        let mut table = Table {
            speeds: rising(
                start,
                &nodes[1..].iter().map(|(step, _)| *step).collect::<Vec<_>>(),
            ),
            first: vec![0],
            conditions: vec![],
            start: vec![0],
            edges: vec![],
            cumulative: vec![],
        };
        for (_, node) in nodes {
            let steps: Vec<_> = node[1..].iter().map(|(step, _)| *step).collect();
            table.conditions.extend(rising(0.0, &steps));
            table.first.push(table.conditions.len() as i64);
            for (_, (low, bins, last)) in node {
                let widths: Vec<_> = bins.iter().map(|bin| bin.0).chain([last]).collect();
                table.edges.extend(rising(low, &widths));
                table.start.push(table.edges.len() as i64);
                let shares: Vec<_> = bins.iter().map(|bin| bin.1).chain([0.5]).collect();
                let total: f64 = shares.iter().sum();
                let below = rising(0.0, &shares);
                let count = below.len();
                table
                    .cumulative
                    .extend(below[..count - 1].iter().map(|x| x / total));
                table.cumulative.push(1.0);
            }
        }
        table
    })
}

proptest! {
    #![proptest_config(cases(500))]

    /// F rises from 0 to 1, its quantiles invert it, and the density is its slope.
    #[test]
    fn the_functions_belong_together(table in table(), v in 0.0..6.0_f64, z in -1.0..4.0_f64, q in 0.0..1.0_f64) {
        let ends = table.ask(Curve::Ppf, &[0.0, 1.0], v, z);
        prop_assert_eq!(table.ask(Curve::Cdf, &ends, v, z), vec![0.0, 1.0]);
        let x = table.ask(Curve::Ppf, &[q], v, z)[0];
        prop_assert!(ends[0] <= x && x <= ends[1]);
        let back = table.ask(Curve::Cdf, &[x], v, z)[0];
        prop_assert!((back - q).abs() < 1e-13, "{} for {}", back, q);
        // The slope is constant between two edges; a step that crosses none of them measures it.
        let h = 1e-6;
        let nearest = table.edges.iter().map(|edge| (edge - x).abs()).fold(f64::INFINITY, f64::min);
        if nearest > h {
            let f = table.ask(Curve::Cdf, &[x - h, x + h], v, z);
            let density = table.ask(Curve::Pdf, &[x], v, z)[0];
            prop_assert!(((f[1] - f[0]) / (2.0 * h) - density).abs() < 1e-8 * (1.0 + density));
        }
    }

    /// At a node, and beyond the first and the last, that node counts alone.
    #[test]
    fn nodes_stand_for_themselves(table in table(), q in 0.0..1.0_f64) {
        let last = table.speeds.len() - 1;
        for (node, v) in [(0, 0.0), (0, table.speeds[0]), (last, table.speeds[last]), (last, 1e9)] {
            let component = table.first[node] as usize;
            let range = table.start[component] as usize..table.start[component + 1] as usize;
            let x = table.ask(Curve::Ppf, &[q], v, -1.0)[0];
            let (edges, below) = (&table.edges[range.clone()], &table.cumulative[range]);
            let bin = below.partition_point(|&p| p <= q) - 1;
            let slope = (edges[bin + 1] - edges[bin]) / (below[bin + 1] - below[bin]);
            prop_assert!((x - edges[bin] - (q - below[bin]) * slope).abs() < 1e-12 * (1.0 + x.abs()));
        }
    }

    /// 4000 draws: the Kolmogorov–Smirnov distance to F stays below 1.95/√n · 1.9, false alarm 1e-11 a case.
    #[test]
    fn draws_follow_the_distribution(table in table(), v in 0.0..6.0_f64, z in -1.0..4.0_f64) {
        let mut x = table.draw(&[v], &[z], 4000, 1);
        x.sort_by(f64::total_cmp);
        let f = table.ask(Curve::Cdf, &x, v, z);
        let distance = f.iter().enumerate().map(|(i, f)| (f - i as f64 / 4000.0).abs()).fold(0.0, f64::max);
        prop_assert!(distance < 3.7 / 4000_f64.sqrt() + 1.0 / 4000.0, "{}", distance);
    }
}

/// A fixed table for what follows.
fn example() -> Table {
    Table {
        speeds: vec![0.1, 0.3],
        first: vec![0, 1, 3],
        conditions: vec![0.0, 0.2, 0.6],
        start: vec![0, 3, 5, 8],
        edges: vec![-0.5, 0.5, 1.5, 0.7, 0.9, 0.0, 1.0, 2.0],
        cumulative: vec![0.0, 0.25, 1.0, 0.0, 1.0, 0.0, 0.5, 1.0],
    }
}

#[test]
fn threads_and_number_do_not_show_in_the_draws() {
    let speeds: Vec<_> = (0..100_000).map(|i| 0.05 + 3e-6 * f64::from(i)).collect();
    let table = example();
    let one = table.draw(&speeds, &[0.3], speeds.len(), 1);
    for threads in [2, 3, 5] {
        assert_eq!(table.draw(&speeds, &[0.3], speeds.len(), threads), one);
    }
    assert_eq!(table.draw(&speeds[..10], &[0.3], 10, 1), one[..10]);
}

/// Few draws take their quantiles by a search, many by a guide: the same ones.
#[test]
fn few_draws_are_the_first_of_many() {
    let table = example();
    for (v, z) in [(0.1, 0.3), (0.2, 0.1), (0.25, 0.5), (0.4, 0.9)] {
        let many = table.draw(&[v], &[z], 50, 1);
        for few in [1, 4, 8, 9] {
            assert_eq!(table.draw(&[v], &[z], few, 1), many[..few]);
        }
    }
}

/// Enough for many blocks; each is computed as if it were alone, from the arguments at its place.
#[test]
fn every_element_has_its_own_arguments() {
    let table = example();
    let size = 70_000;
    let of = |low: f64, high: f64, period: usize| -> Vec<f64> {
        let share = |i: usize| (i % period) as f64 / period as f64;
        (0..size).map(|i| low + (high - low) * share(i)).collect()
    };
    let (x, v, z) = (of(0.01, 0.99, 997), of(0.05, 0.35, 1009), of(0.1, 0.7, 31));
    let mixture = table.mixture().unwrap();
    let monitor = Monitor::default();
    let values = Broadcast::new(&x, "x", size).unwrap();
    let mut out = [(); 3].map(|()| vec![0.0; size]);
    let curves = [Curve::Cdf, Curve::Pdf, Curve::Ppf];
    for (out, curve) in out.iter_mut().zip(curves) {
        let at = at(&v, &z, size);
        let done = mixture.evaluate(curve, values, at, out, on(2), &monitor);
        done.unwrap();
    }
    for i in (0..size).step_by(487) {
        for (out, what) in out.iter().zip(curves) {
            assert_eq!(out[i], table.ask(what, &x[i..=i], v[i], z[i])[0], "{i}");
        }
    }

    let draws = table.draw(&v, &z, size, 2);
    for k in 0..5 {
        let alone = table.draw(&v[k..=k], &z, size, 1);
        let same = |i: usize| i % 1009 == k;
        assert!((0..size).filter(|&i| same(i)).all(|i| draws[i] == alone[i]));
        let alone = table.draw(&v, &z[k..=k], size, 1);
        let same = |i: usize| i % 31 == k;
        assert!((0..size).filter(|&i| same(i)).all(|i| draws[i] == alone[i]));
    }
}

/// In an empty bin F does not rise: its quantile is where that level is reached first.
#[test]
fn a_quantile_is_the_least_number() {
    let mut table = example();
    table.edges[5..].copy_from_slice(&[0.0, 1.0, 2.0]);
    table.start = vec![0, 5, 7, 10];
    table.edges.splice(0..3, [-0.5, 0.5, 1.0, 1.5, 2.0]);
    table.cumulative.splice(0..3, [0.0, 0.25, 0.25, 0.75, 1.0]);
    let quantiles = table.ask(Curve::Ppf, &[0.0, 0.25, 0.5, 0.75, 1.0], 0.1, 0.0);
    assert_eq!(quantiles, [-0.5, 0.5, 1.25, 1.5, 2.0]);
}

#[test]
fn values_are_zeros_to_be_filled() {
    for size in [0, 1, 3] {
        assert_eq!(values(size).unwrap(), vec![0.0; size]);
    }
}

#[test]
fn what_is_not_a_number_gives_none() {
    let table = example();
    assert!(table.draw(&[f64::NAN], &[0.0], 1, 1)[0].is_nan());
    assert!(
        table
            .ask(Curve::Ppf, &[-0.1, 1.1, f64::NAN], 0.2, 0.3)
            .iter()
            .all(|x| x.is_nan())
    );
    for what in [Curve::Cdf, Curve::Pdf, Curve::Ppf] {
        for (x, v, z) in [
            (f64::NAN, 0.2, 0.3),
            (0.5, f64::NAN, 0.3),
            (0.5, 0.2, f64::NAN),
        ] {
            assert!(table.ask(what, &[x], v, z)[0].is_nan());
        }
    }
}

#[test]
fn tables_that_are_no_distributions_are_refused() {
    let spoil: [fn(&mut Table); 6] = [
        |table| table.speeds[1] = 0.1,
        |table| table.first[1] = 0,
        |table| table.conditions[2] = 0.2,
        |table| table.start[1] = 1,
        |table| table.edges[1] = -0.5,
        |table| table.cumulative[2] = 0.9,
    ];
    for spoil in spoil {
        let mut table = example();
        spoil(&mut table);
        let refused = table.mixture().unwrap_err();
        assert!(matches!(
            refused,
            Error::Parameter {
                name: "nodes" | "table",
                ..
            }
        ));
    }
    assert!(Broadcast::new(&[1.0, 2.0], "v", 3).is_err());
}

/// Ctrl-C leaves what was not begun as it was.
#[test]
fn cancelled_draws_end() {
    let table = example();
    let monitor = Monitor::default();
    monitor.cancel();
    let mut out = vec![-7.0; 100];
    let mixture = table.mixture().unwrap();
    mixture
        .rvs(at(&[0.2], &[0.3], 100), 1, &mut out, on(2), &monitor)
        .unwrap();
    assert!(out.iter().all(|&x| x == -7.0));
}
