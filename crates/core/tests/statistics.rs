//! Sums without rounding: histograms merged in any order, of any portions of a run, have the same bits.

use crate::common::*;
use crate::histograms::*;
use proptest::prelude::*;
use restitution_core::statistics::{Bins, By, Histogram};
use restitution_core::{
    Error, Law, Level, Monitor, Orientation, Resources, Run, Spheroid, Spin, Vector,
};
use std::collections::BTreeSet;
use std::sync::LazyLock;

/// Histograms of bodies of all kinds, with the same bins and origin: ε from ordinary to 2³³ and undefined.
static PIECES: LazyLock<Vec<Histogram>> = LazyLock::new(|| {
    let bins = Edges::coarse().bins(By::Number(ROWS));
    let angles = nearly_level();
    let extreme = nearly_at_rest(2.0, 0.0, &angles);
    let pieces = (0..11).map(|seed| {
        let run = Run {
            particles: 5 + seed,
            impacts: ROWS,
            seed: seed as u64,
            ..paper(0.35 * seed as f64, extreme.law)
        };
        statistics(&run, &bins, Level::best(), 1)
    });
    pieces
        .chain([statistics(&extreme, &bins, Level::best(), 1)])
        .collect()
});

/// An empty histogram that goes with [`PIECES`].
fn nothing(law: &Law<'_>) -> Histogram {
    Histogram::new(&Edges::coarse().bins(By::Number(ROWS)), law.normal.at(1.0)).unwrap()
}

/// The pieces cover what merging has to cope with: sums beyond 128 bits, and impacts without a place.
#[test]
fn the_pieces_are_as_different_as_they_should_be() {
    let extreme = PIECES.last().unwrap();
    let largest = |histogram: &Histogram| {
        let largest = |row| {
            histogram
                .rows
                .moments(row)
                .map_or(0.0, |m| m.maximum.max(-m.minimum))
        };
        (0..ROWS).map(largest).fold(0.0, f64::max)
    };
    assert!(largest(&PIECES[0]) < 1.0 && largest(extreme) > 1e9);
    let columns = extreme.restitution.columns();
    let undefined = |histogram: &Histogram| {
        let last = histogram
            .restitution
            .counts()
            .iter()
            .skip(columns - 1)
            .step_by(columns);
        last.sum::<u64>()
    };
    assert!(undefined(extreme) > 0);
    let gains = |histogram: &Histogram| {
        histogram
            .rows
            .gains
            .iter()
            .map(|row| row.count)
            .sum::<u64>()
    };
    let creating = PIECES.iter().filter(|piece| gains(piece) > 0).count();
    assert!(0 < creating && creating < PIECES.len());
}

/// Grids add up place by place where they are full, too.
#[test]
fn full_grids_merge() {
    let bins = Bins {
        by: By::Velocity(axis(&[0.0, 1e3])),
        restitution: axis(&edges(0.9, 1.06, 1400)),
        fraction: None,
    };
    let part = |seed| {
        let run = Run {
            particles: 4000,
            impacts: 400,
            orientation: Orientation::Isotropic,
            seed,
            ..paper(0.1, law(0.98, 1.0))
        };
        let resources = Resources {
            threads: 1,
            level: Level::best(),
        };
        run.statistics(&bins, resources, &Monitor::default())
            .unwrap()
    };
    let (first, second) = (part(1), part(2));
    let full = |counts: &[u64]| {
        counts
            .chunks(512)
            .any(|part| part.iter().all(|&count| count > 0))
    };
    assert!(full(second.restitution.counts()));
    let mut total = first.clone();
    total.merge(&second);
    let each = first.restitution.counts().iter();
    let sums: Vec<_> = each
        .zip(second.restitution.counts())
        .map(|(a, b)| a + b)
        .collect();
    assert_eq!(total.restitution.counts(), sums);
    assert_eq!(total.restitution.columns(), 1403);
    let counts = total.restitution.into_counts();
    assert!(counts.iter().map(|&count| count as u64).eq(sums));
}

/// What goes to NumPy is what was counted, in grids of several parts too, some of them empty, and so is a copy.
#[test]
fn copies_and_counts_are_what_was_counted() {
    let fine = Edges::coarse().bins(By::Number(ROWS));
    for histogram in PIECES.iter().chain([&Histogram::new(&fine, 0.98).unwrap()]) {
        let copy = histogram.copied().unwrap();
        assert_eq!(&copy, histogram);
        for (copied, grid) in [
            (copy.restitution, &histogram.restitution),
            (copy.fraction, &histogram.fraction),
        ] {
            let counts = copied.into_counts();
            let counts = counts.iter().map(|&count| count as u64);
            assert!(counts.eq(grid.counts().iter().copied()));
        }
    }
}

proptest! {
    #![proptest_config(cases(200))]

    /// Any pieces, put together in any order and any nesting, make the same histogram: counts, sums and extremes are compared,
    /// and then the bits of what is computed from them.
    #[test]
    fn merging_is_associative_and_commutative_to_the_bit(
        pieces in prop::collection::vec(0..12_usize, 1..16), picks in prop::collection::vec(any::<[u16; 2]>(), 16),
    ) {
        let mut one_by_one = PIECES[pieces[0]].clone();
        for &piece in &pieces[1..] {
            one_by_one.merge(&PIECES[piece]);
        }
        let mut heap: Vec<Histogram> = pieces.iter().map(|&piece| PIECES[piece].clone()).collect();
        for [into, from] in picks {
            if heap.len() > 1 {
                let from = heap.swap_remove(usize::from(from) % heap.len());
                let into = usize::from(into) % heap.len();
                heap[into].merge(&from);
            }
        }
        prop_assert_eq!(heap.len(), 1);
        prop_assert_eq!(&heap[0], &one_by_one);
        prop_assert_eq!(bits(&heap[0], ROWS), bits(&one_by_one, ROWS));
    }

    /// A histogram of nothing changes nothing, from either side.
    #[test]
    fn an_empty_histogram_is_neutral(piece in 0..12_usize) {
        let nothing = nothing(&nearly_at_rest(2.0, 0.0, &[0.0]).law);
        let piece = &PIECES[piece];
        let (mut before, mut after) = (nothing.clone(), piece.clone());
        before.merge(piece);
        after.merge(&nothing);
        prop_assert_eq!(&before, piece);
        prop_assert_eq!(&after, piece);
    }
}

proptest! {
    #![proptest_config(cases(50))]

    /// A run cut into any portions of its particles, each on another level and number of threads, merged in the order in
    /// which they are given or backwards: the histogram of the whole run.
    #[test]
    fn a_run_in_portions_is_the_run(
        elongation in elongation(), (normal, tangential) in coefficients(), angles in prop::collection::vec(0.0..3.1_f64, 1..150),
        cuts in prop::collection::vec(0.0..1.0_f64, 0..6), backwards in any::<bool>(), level in level(), threads in 1..4_usize,
    ) {
        let run = |angles| Run {
            particles: <[f64]>::len(angles),
            impacts: ROWS,
            orientation: Orientation::Given(angles),
            ..paper(elongation, law(normal, tangential))
        };
        let bins = Edges::coarse().by_velocity();
        let whole = statistics(&run(&angles), &bins, Level::Scalar, 1);
        let mut cuts: Vec<usize> = cuts.iter().map(|cut| (cut * angles.len() as f64) as usize).collect();
        cuts.extend([0, angles.len()]);
        cuts.sort_unstable();
        cuts.dedup();
        let mut portions: Vec<&[f64]> = cuts.windows(2).map(|cut| &angles[cut[0]..cut[1]]).collect();
        if backwards {
            portions.reverse();
        }
        let mut total = Histogram::new(&bins, normal).unwrap();
        for portion in portions {
            total.merge(&statistics(&run(portion), &bins, level, threads));
        }
        prop_assert_eq!(&total, &whole);
        prop_assert_eq!(bits(&total, bins.rows()), bits(&whole, bins.rows()));
    }
}

proptest! {
    #![proptest_config(cases(30))]

    /// Parts of a run with random releases that are counted apart, written down as whole numbers, read back and merged in any
    /// order: the histogram of the whole run. Words of other bins and of sums about another origin are refused.
    #[test]
    fn parts_that_were_written_down_are_the_run(
        elongation in elongation(), seed in any::<u64>(), cut in 1..199_usize, second in 1..199_usize, level in level(),
    ) {
        let run = Run { particles: 200, impacts: ROWS, seed, ..paper(elongation, law(0.9, 1.0)) };
        let bins = Edges::coarse().by_velocity();
        let whole = statistics(&run, &bins, level, 2);
        let (low, high) = (cut.min(second), cut.max(second));
        let mut total = Histogram::new(&bins, run.origin()).unwrap();
        for part in [high..200, 0..low, low..high] {
            if !part.is_empty() {
                let resources = Resources { threads: 1, level };
                let histogram = run.statistics_of_part(part, &bins, resources, &Monitor::default()).unwrap();
                let words = histogram.to_words().unwrap();
                prop_assert_eq!(&Histogram::from_words(&bins, run.origin(), &words).unwrap(), &histogram);
                prop_assert!(Histogram::from_words(&bins, run.origin(), &words[1..]).is_err());
                prop_assert!(Histogram::from_words(&bins, 0.5, &words).is_err());
                total.merge(&histogram);
            }
        }
        prop_assert_eq!(&total, &whole);
    }
}

/// The hot loop adds to narrow integers that are emptied every 2¹⁹ impacts. A run on one thread that is longer than that is
/// the sum of shorter ones that are not emptied on the way.
#[test]
fn long_runs_are_emptied_in_time() {
    let angles: Vec<f64> = (0..1600).map(|i| 1.9e-3 * f64::from(i)).collect();
    let run = |angles| Run {
        particles: <[f64]>::len(angles),
        impacts: 400,
        orientation: Orientation::Given(angles),
        ..paper(0.1, law(0.98, 1.0))
    };
    let bins = Edges::coarse().by_velocity();
    let whole = statistics(&run(&angles), &bins, Level::best(), 1);
    assert!(whole.restitution.counts().iter().sum::<u64>() > 1 << 19);
    let mut total = Histogram::new(&bins, 0.98).unwrap();
    for portion in angles.chunks(400) {
        total.merge(&statistics(&run(portion), &bins, Level::best(), 1));
    }
    assert_eq!(total, whole);
}

/// A lane takes the next particle where its own has ended, and sits out the impacts of the others while its search goes on. Of particles
/// that live for different times every impact and every end is counted once: as many have an impact of some number as have a recorded
/// one.
#[test]
fn every_impact_and_every_end_is_counted_once() {
    for (aspect, thrown) in [(2.0, false), (2.0, true), (0.5, true)] {
        let mut run = Run {
            body: Spheroid::new(3e-3, aspect * 3e-3, 2500.0).unwrap().into(),
            particles: 1300,
            impacts: 40,
            minimum_speed: 0.4,
            settled: 0.0,
            ..paper(0.0, law(0.9, 0.5))
        };
        if thrown {
            run.release_velocity = Vector::new(0.3, 0.1, -0.2);
            run.spin = Spin::Fixed(Vector::new(300.0, -200.0, 100.0));
            run.incline = 0.05;
        }
        let records = simulate(&run);
        let lives: BTreeSet<i64> = records.impacts.iter().copied().collect();
        assert!(lives.len() > 10 && lives.contains(&40), "{lives:?}");
        let bins = Edges::coarse().bins(By::Number(run.impacts));
        for level in Level::available() {
            for threads in [1, 2] {
                let histogram = statistics(&run, &bins, level, threads);
                let columns = histogram.restitution.columns();
                for (number, counts) in histogram.restitution.counts().chunks(columns).enumerate() {
                    let reached = |&&impacts: &&i64| impacts > number as i64;
                    let expected = records.impacts.iter().filter(reached).count();
                    assert_eq!(
                        counts.iter().sum::<u64>(),
                        expected as u64,
                        "{number} {level:?}"
                    );
                }
                for (reason, &count) in histogram.rows.stops.iter().enumerate() {
                    let ended = |&&stop: &&i8| stop as usize == reason;
                    let expected = records.stop_reason.iter().filter(ended).count();
                    assert_eq!(count, expected as u64, "{reason} {level:?}");
                }
            }
        }
    }
}

/// More sites than 32 bits can number are refused before any memory is taken for them.
#[test]
fn sites_that_have_no_number_are_refused() {
    let bins = Bins {
        by: By::Number(1 << 30),
        restitution: axis(&[0.0, 1.0]), // four columns: the bin, one on either side, one for what has no place
        fraction: None,
    };
    let run = Run {
        particles: 1,
        impacts: 1,
        ..paper(0.1, law(0.98, 1.0))
    };
    let resources = Resources {
        threads: 1,
        level: Level::best(),
    };
    let refused = run.statistics(&bins, resources, &Monitor::default());
    assert!(matches!(refused, Err(Error::Parameter { .. })));
}

/// Rows of a histogram that is read have the numbers of impacts with a defined ε that they had, where others have none.
#[test]
fn a_histogram_that_is_read_is_the_one_that_was_written() {
    let extreme = nearly_at_rest(2.0, 0.0, &[]);
    let bins = Edges::coarse().bins(By::Number(ROWS));
    for histogram in PIECES.iter() {
        let words = histogram.to_words().unwrap();
        assert_eq!(
            &Histogram::from_words(&bins, extreme.origin(), &words).unwrap(),
            histogram
        );
    }
}

/// What was written down is what is read, whatever the words are: sums of E_rot/E_tot beyond 2⁶⁴ quanta have a second one.
#[test]
fn every_word_of_a_histogram_is_kept() {
    let bins = Edges::coarse().bins(By::Number(ROWS));
    let empty = Histogram::new(&bins, 0.98).unwrap().to_words().unwrap();
    let number = |i: usize| (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let words: Vec<u64> = (0..empty.len())
        .map(|i| if i == 0 { empty[0] } else { number(i) })
        .collect();
    let histogram = Histogram::from_words(&bins, 0.98, &words).unwrap();
    assert_eq!(histogram.to_words().unwrap(), words);
}
