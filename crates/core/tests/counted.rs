//! Impacts counted for a learned distribution: as a plain sum over impacts has them, whatever the threads.

use crate::common::cases;
use proptest::prelude::*;
use restitution_core::distribution::{
    At, Broadcast, COARSE, Counter, Curve, FINE, Impacts, Layout, Levels, Mixture, Nodes,
};
use restitution_core::{Error, Level, Monitor, Resources};

const BATCHES: usize = 3;
const SPEEDS: [f64; 4] = [0.1, 0.2, 0.25, 0.7];
/// Two conditions at the second node, three at the third.
const FIRST: [i64; 5] = [0, 1, 3, 6, 7];
const CONDITIONS: [f64; 7] = [0.0, 0.2, 0.6, 0.1, 0.5, 0.9, 0.4];

fn on(threads: usize) -> Resources {
    Resources {
        threads,
        level: Level::best(),
    }
}

fn nodes() -> Nodes {
    Nodes::new(SPEEDS.to_vec(), FIRST.to_vec(), CONDITIONS.to_vec()).unwrap()
}

/// Particles with as many impacts each, some of which never happened, lie outside, or lie on a node.
fn some_impacts() -> impl Strategy<Value = (usize, Vec<(f64, f64, f64)>)> {
    let value = |range| prop_oneof![8 => range, 1 => Just(f64::NAN)];
    let speed = prop_oneof![8 => 0.05..0.8, 1 => Just(0.2), 1 => Just(0.7), 1 => Just(f64::NAN)];
    let impact = (speed, value(-1.0..2.0), value(-0.2..1.2));
    (1..20_usize, 1..40_usize).prop_flat_map(move |(columns, rows)| {
        let impacts = proptest::collection::vec(impact.clone(), columns * rows);
        (Just(columns), impacts)
    })
}

/// The neighbours of x with their weights; beyond the ends, the last one alone.
fn neighbours(points: &[f64], x: f64) -> Vec<(usize, f64)> {
    let last = points.len() - 1;
    if x <= points[0] {
        return vec![(0, 1.0)];
    }
    if x >= points[last] {
        return vec![(last, 1.0)];
    }
    let above = (0..=last).find(|&i| points[i] > x).unwrap();
    let share = (x - points[above - 1]) / (points[above] - points[above - 1]);
    vec![(above - 1, 1.0 - share), (above, share)]
}

/// The components at which an impact counts, and its weights there.
fn components(v: f64, z: f64) -> Vec<(usize, f64)> {
    let mut found = Vec::new();
    for (node, share) in neighbours(&SPEEDS, v) {
        let (start, end) = (FIRST[node] as usize, FIRST[node + 1] as usize);
        for (place, part) in neighbours(&CONDITIONS[start..end], z) {
            found.push((start + place, share * part));
        }
    }
    found
}

fn columns(impacts: &[(f64, f64, f64)]) -> [Vec<f64>; 3] {
    [
        impacts.iter().map(|impact| impact.0).collect(),
        impacts.iter().map(|impact| impact.1).collect(),
        impacts.iter().map(|impact| impact.2).collect(),
    ]
}

/// Inner edges: one, many of which most are close together, and some between.
fn edges() -> (Vec<i64>, Vec<f64>) {
    let (mut start, mut edges) = (vec![0], Vec::new());
    for component in 0..CONDITIONS.len() {
        let number = [1, 200, 2, 7, 31, 3, 64][component];
        for k in 0..number {
            let x = (f64::from(k) + 0.5) / f64::from(number) * 2.0 - 1.0;
            edges.push(0.5 + 1e-3 * x + 1.2 * x.powi(9));
        }
        start.push(edges.len() as i64);
    }
    (start, edges)
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn counts_are_sums_over_impacts((columns_each, impacts) in some_impacts(), first in 0..7_usize) {
        let (start, edges) = edges();
        let [v, e, z] = columns(&impacts);
        let mut counters = [1, 2].map(|threads| {
            let mut counter = Counter::new(nodes(), start.clone(), edges.clone(), BATCHES).unwrap();
            let half = v.len() / columns_each / 2 * columns_each;
            for (cells, first) in [(0..half, first), (half..v.len(), first + half / columns_each)] {
                let [v, e, z] = [&v, &e, &z].map(|values| &values[cells.clone()]);
                let impacts = Impacts::new(v, e, Some(z), columns_each, first).unwrap();
                counter.add(&impacts, on(threads), &Monitor::default()).unwrap();
            }
            counter.counts().unwrap()
        });
        let counts = &mut counters[0];
        let bins = edges.len() + CONDITIONS.len();
        for (cell, &(v, e, z)) in impacts.iter().enumerate() {
            if !((0.1..0.7).contains(&v) && e.is_finite() && z.is_finite()) {
                continue;
            }
            let batch = (first + cell / columns_each) % BATCHES;
            let above = SPEEDS.iter().position(|&node| node > v).unwrap();
            for node in [above - 1, above] {
                prop_assert!(counts.seen[node] <= z && z <= counts.seen[SPEEDS.len() + node]);
            }
            for (component, weight) in components(v, z) {
                let range = start[component] as usize..start[component + 1] as usize;
                let bin = edges[range.clone()].iter().filter(|&&edge| edge <= e).count();
                counts.count[batch * bins + range.start + component + bin] -= weight;
                let inner = &edges[range];
                let x = e - inner[inner.len() / 2];
                for (power, moment) in [1.0, x, x * x].into_iter().enumerate() {
                    let place = (power * BATCHES + batch) * CONDITIONS.len() + component;
                    counts.powers[place] -= weight * moment;
                }
                if weight > 1e-12 {
                    prop_assert!(counts.lowest[component] <= e && e <= counts.highest[component]);
                }
            }
        }
        // What is left is rounding, of up to 800 sums of numbers up to 4.
        prop_assert!(counts.count.iter().all(|left| left.abs() < 1e-12));
        prop_assert!(counts.powers.iter().all(|left| left.abs() < 1e-11));
    }

    #[test]
    fn levels_are_those_of_the_distribution((columns_each, impacts) in some_impacts(), first in 0..7_usize) {
        let mixture = Mixture::new(Layout {
            nodes: Nodes::new(SPEEDS.to_vec(), vec![0, 1, 2, 3, 4], vec![0.0; 4]).unwrap(),
            start: vec![0, 3, 5, 9, 11],
            edges: vec![-0.5, 0.1, 1.0, 0.0, 1.5, -0.9, 0.4, 0.41, 0.8, 0.2, 0.9],
            cumulative: vec![0.0, 0.9, 1.0, 0.0, 1.0, 0.0, 0.1, 0.9, 1.0, 0.0, 1.0],
        }).unwrap();
        let [v, e, _] = columns(&impacts);
        let table = Impacts::new(&v, &e, None, columns_each, first).unwrap();
        let found = [1, 2].map(|threads| {
            let mut levels = Levels::new(SPEEDS.len(), BATCHES).unwrap();
            levels.add(&mixture, 1e-9, &table, on(threads), &Monitor::default()).unwrap();
            assert!(levels.coarse(3).is_err() && levels.fine(3).is_err());
            let fine = [0, 1, 2].map(|interval| levels.fine(interval).unwrap());
            let coarse = [0, 1, 2].map(|interval| levels.coarse(interval).unwrap().collect::<Vec<_>>());
            (fine.concat(), coarse.concat())
        });
        prop_assert_eq!(&found[0], &found[1]);
        let (fine, coarse) = &found[0];
        let mut expected = vec![0; 3 * FINE];
        let mut by_batch = vec![0; BATCHES * 3 * COARSE];
        for (cell, (&v, &e)) in v.iter().zip(&e).enumerate() {
            if !((0.1..0.7).contains(&v) && e.is_finite()) {
                continue;
            }
            let (mut u, x, v_alone) = ([0.0], [e], [v]);
            let at = At {
                speed: Broadcast::new(&v_alone, "v", 1).unwrap(),
                condition: Broadcast::new(&[0.0], "z", 1).unwrap(),
            };
            let x = Broadcast::new(&x, "x", 1).unwrap();
            mixture.evaluate(Curve::Cdf, x, at, &mut u, on(1), &Monitor::default()).unwrap();
            let interval = SPEEDS.iter().position(|&node| node > v).unwrap() - 1;
            let share = |parts: usize| ((u[0] * parts as f64).floor() as usize).min(parts - 1);
            expected[interval * FINE + share(FINE)] += 1;
            let batch = (first + cell / columns_each) % BATCHES;
            by_batch[(interval * BATCHES + batch) * COARSE + share(COARSE)] += 1;
        }
        prop_assert_eq!(fine, &expected);
        prop_assert_eq!(coarse, &by_batch);
    }
}

/// The same distribution at two nodes, at 1 m/s and at 2 m/s.
fn alike(edges: &[f64], cumulative: &[f64]) -> Mixture {
    let each = edges.len() as i64;
    Mixture::new(Layout {
        nodes: Nodes::new(vec![1.0, 2.0], vec![0, 1, 2], vec![0.0; 2]).unwrap(),
        start: vec![0, each, 2 * each],
        edges: edges.repeat(2),
        cumulative: cumulative.repeat(2),
    })
    .unwrap()
}

/// The levels of impacts at 1 m/s with these ε, a row of as many in each batch: all of them, and batch by batch.
fn levels(mixture: &Mixture, point: f64, e: &[f64]) -> (Vec<u64>, Vec<u64>) {
    let mut levels = Levels::new(2, BATCHES).unwrap();
    let v = vec![1.0; e.len()];
    let impacts = Impacts::new(&v, e, None, e.len() / BATCHES, 0).unwrap();
    levels
        .add(mixture, point, &impacts, on(1), &Monitor::default())
        .unwrap();
    (levels.fine(0).unwrap(), levels.coarse(0).unwrap().collect())
}

/// Half of all impacts have one ε, but for rounding; a quarter lies below it: their levels are uniform from ¼ to ¾, and each batch has
/// random numbers of its own. χ² of 128 cells is 127 ± 16; six of these are allowed.
#[test]
fn the_levels_of_a_point_mass_are_spread_evenly() {
    let mixture = alike(&[0.0, 0.5, 0.5 + 1e-10, 1.0], &[0.0, 0.25, 0.75, 1.0]);
    let each = 128 * 100;
    let e: Vec<_> = (0..BATCHES * each)
        .map(|i| 0.5 + 1e-10 * (i as f64 * 0.618_034).fract())
        .collect();
    let (fine, coarse) = levels(&mixture, 1e-9, &e);
    let inside = FINE / 4..3 * FINE / 4;
    assert_eq!(fine[inside].iter().sum::<u64>(), e.len() as u64);
    let batches: Vec<_> = coarse.chunks(COARSE).collect();
    for batch in &batches {
        let cells = &batch[COARSE / 4..3 * COARSE / 4];
        let squares = cells.iter().map(|&n| (n as f64 - 100.0).powi(2) / 100.0);
        assert!((squares.sum::<f64>() - 127.0).abs() < 6.0 * 16.0);
    }
    assert!(batches[0] != batches[1] && batches[1] != batches[2] && batches[2] != batches[0]);
}

/// An impact at the lower end of one of the parts in which levels are counted. The levels on either side of it are apart by 3/8, 4/8 or 5/8
/// of a part: up to half of one they are not spread; beyond it they are if any bin is narrower than a point, so that half of the impacts,
/// to within five standard errors, are in the part below.
#[test]
fn levels_that_are_all_but_equal_are_not_spread() {
    let point = 2.0_f64.powi(-10);
    for (eighths, narrowest, spread) in [
        (3.0, 0.25, false),
        (4.0, 0.25, false),
        (5.0, 0.25, true),
        (5.0, 1.0, false),
    ] {
        let share = eighths / 64.0;
        let edges = [0.0, 1.0, 1.0 + narrowest * point, 2.0];
        let mixture = alike(&edges, &[0.0, share, 0.5, 1.0]);
        let (fine, _) = levels(&mixture, point, &[0.5; 1200]);
        let part = (0.5 * share * FINE as f64) as usize;
        let (below, above) = (fine[part - 1], fine[part]);
        assert_eq!(below + above, 1200);
        if spread {
            assert!((below as f64 - 600.0).abs() < 5.0 * 300.0_f64.sqrt());
        } else {
            assert_eq!(below, 0);
        }
    }
}

#[test]
fn threads_do_not_show() {
    let (start, edges) = edges();
    let value = |i: usize, step: f64| (i as f64 * step).fract();
    let v: Vec<_> = (0..60_000)
        .map(|i| 0.05 + 0.8 * value(i, 0.618_034))
        .collect();
    let e: Vec<_> = (0..60_000)
        .map(|i| 2.0 * value(i, 0.754_878) - 0.5)
        .collect();
    let z: Vec<_> = (0..60_000).map(|i| value(i, 0.569_840)).collect();
    let counted = |threads| {
        let mut counter = Counter::new(nodes(), start.clone(), edges.clone(), 16).unwrap();
        let impacts = Impacts::new(&v, &e, Some(&z), 300, 5).unwrap();
        counter
            .add(&impacts, on(threads), &Monitor::default())
            .unwrap();
        let counts = counter.counts().unwrap();
        (counts.count, counts.powers, counts.seen)
    };
    let one = counted(1);
    assert_eq!(one, counted(2));
    assert_eq!(one, counted(5));
}

/// A long row is left where it is cancelled.
#[test]
fn a_cancelled_count_ends() {
    let (start, edges) = edges();
    let mut counter = Counter::new(nodes(), start, edges, BATCHES).unwrap();
    let monitor = Monitor::default();
    monitor.cancel();
    let (v, e) = (vec![0.3; 10_000], vec![0.5; 10_000]);
    let impacts = Impacts::new(&v, &e, None, 10_000, 0).unwrap();
    counter.add(&impacts, on(1), &monitor).unwrap();
    assert!(counter.counts().unwrap().count.iter().all(|&n| n == 0.0));
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let names = |error: Error| match error {
        Error::Parameter { name, .. } => name,
        other => panic!("{other}"),
    };
    let (start, edges) = edges();
    let new = |start: &[i64], edges: &[f64], batches| {
        Counter::new(nodes(), start.to_vec(), edges.to_vec(), batches)
    };
    assert_eq!(names(new(&start[1..], &edges, 1).unwrap_err()), "edges");
    // Ranges that begin or end elsewhere, an empty one, and one that runs backwards.
    let last = start.len() - 1;
    for (place, index) in [
        (0, 1),
        (last, start[last] - 1),
        (last, start[last] + 1),
        (2, start[1]),
        (2, start[1] - 1),
    ] {
        let mut other = start.clone();
        other[place] = index;
        assert_eq!(names(new(&other, &edges, 1).unwrap_err()), "edges");
    }
    let mut reversed = edges.clone();
    reversed.reverse();
    assert_eq!(names(new(&start, &reversed, 1).unwrap_err()), "edges");
    assert_eq!(names(new(&start, &edges, 0).unwrap_err()), "batches");
    let (two, three) = ([0.1, 0.2], [0.1, 0.2, 0.3]);
    let impacts = |v, e, z, columns| names(Impacts::new(v, e, z, columns, 0).unwrap_err());
    assert_eq!(impacts(&two, &three, None, 1), "restitution");
    assert_eq!(impacts(&two, &two, Some(&three), 1), "condition");
    assert_eq!(impacts(&three, &three, None, 2), "columns");
    assert_eq!(impacts(&three, &three, None, 0), "columns");
    assert_eq!(names(Levels::new(1, 1).unwrap_err()), "nodes");
    assert_eq!(names(Levels::new(2, 0).unwrap_err()), "batches");
    let mixture = alike(&[0.0, 1.0], &[0.0, 1.0]);
    let table = Impacts::new(&two, &two, None, 1, 0).unwrap();
    let refused = Levels::new(3, 1)
        .unwrap()
        .add(&mixture, 0.0, &table, on(1), &Monitor::default());
    assert_eq!(names(refused.unwrap_err()), "nodes");
}
