//! The bits of a million impacts, written down: the same at every SIMD level, on any number of threads, in any portions, and
//! on every machine.
//!
//! The digests are in `digests.txt` beside this file. A change that alters a bit of a result on purpose has to write them
//! anew, with `RESTITUTION_WRITE_DIGESTS=1 cargo test -p restitution-core --test core digest::`; the difference then shows in review.
//! Where nobody meant to alter a result, a failure here is a defect: on one machine, of the change; on another, of the promise.

use crate::common::*;
use crate::digested::{angles, jobs, kinds};
use restitution_core::statistics::{Axis, Bins, By, Grid, Histogram};
use restitution_core::{Level, Monitor, Orientation, Resources, Run};
use std::collections::BTreeMap;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/digests.txt");
const HEADER: &str = "\
# Digests (FNV-1a, 64 bits) of the runs in digested/mod.rs. Every machine must find them.
# Written by: RESTITUTION_WRITE_DIGESTS=1 cargo test -p restitution-core --test core digest::
# To be written anew only with a change that is meant to alter the bits of a result.
";

/// FNV-1a, 64 bits.
struct Digest(u64);

impl Digest {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn word(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// The bits of a number; all NaN are one, for machines make them with different signs.
    fn number(&mut self, x: f64) {
        self.word(if x.is_nan() { f64::NAN } else { x }.to_bits());
    }

    /// Particle after particle, so that tables may come in portions.
    fn records(&mut self, records: &Records, impacts: usize) {
        for particle in 0..records.impacts.len() {
            let row = particle * impacts..(particle + 1) * impacts;
            for (_, column) in columns(records) {
                column[row.clone()].iter().for_each(|&x| self.number(x));
            }
            for &contact in &records.contact[row] {
                self.word(contact as u64);
            }
            self.word(records.impacts[particle] as u64);
            self.word(records.stop_reason[particle] as u64);
            self.number(records.release_angle[particle]);
        }
    }

    fn histogram(&mut self, histogram: &Histogram, rows: usize) {
        let grids: [&Grid; 2] = [&histogram.restitution, &histogram.fraction];
        // Bodies of revolution do not settle: the last reason counts nobody.
        let (settled, stops) = histogram.rows.stops.split_last().unwrap();
        assert_eq!(*settled, 0);
        for count in grids.into_iter().flat_map(Grid::counts).chain(stops) {
            self.word(*count);
        }
        for row in 0..rows {
            let m = histogram.rows.moments(row).unwrap();
            let numbers = [
                m.mean,
                m.variance,
                m.skewness,
                m.kurtosis,
                m.minimum,
                m.maximum,
                histogram.rows.mean_fraction(row).unwrap(),
            ];
            numbers.into_iter().for_each(|x| self.number(x));
        }
    }
}

/// lo, lo + width, ...
fn edges(low: f64, width: f64, bins: usize) -> Axis {
    let edges: Vec<f64> = (0..=bins).map(|i| low + width * i as f64).collect();
    Axis::new("edges", &edges).unwrap()
}

fn bins(by: By) -> Bins {
    Bins {
        by,
        restitution: edges(-1.0, 0.01, 300),
        fraction: Some(edges(0.0, 0.02, 50)),
    }
}

/// Digest of the table, and its number of impacts.
fn simulate(run: &Run<'_>, resources: Resources) -> (u64, i64) {
    let mut digest = Digest::new();
    let records = Records::from(run.simulate(resources, &Monitor::default()).unwrap());
    digest.records(&records, run.impacts);
    (digest.0, records.impacts.iter().sum())
}

/// Digest of the statistics by velocity and by number.
fn statistics(run: &Run<'_>, resources: Resources) -> u64 {
    let mut digest = Digest::new();
    for by in [By::Velocity(edges(0.0, 0.01, 120)), By::Number(run.impacts)] {
        let bins = bins(by);
        let histogram = run
            .statistics(&bins, resources, &Monitor::default())
            .unwrap();
        digest.histogram(&histogram, bins.rows());
    }
    digest.0
}

fn best(threads: usize) -> Resources {
    let level = Level::best();
    Resources { threads, level }
}

fn every_level(threads: usize) -> impl Iterator<Item = Resources> {
    Level::available().map(move |level| Resources { threads, level })
}

/// The digests that are written down, by name.
fn written() -> BTreeMap<String, u64> {
    let text = std::fs::read_to_string(FILE).unwrap_or_default();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .filter_map(|line| {
            let (name, digest) = line.split_once(' ')?;
            Some((name.to_owned(), u64::from_str_radix(digest, 16).ok()?))
        })
        .collect()
}

/// Compares with what is written down, or writes it. Not before everything agrees on this machine.
fn agrees_with_the_file(found: &BTreeMap<String, u64>) {
    if std::env::var_os("RESTITUTION_WRITE_DIGESTS").is_some() {
        let lines: String = found
            .iter()
            .map(|(name, digest)| format!("{name} {digest:016x}\n"))
            .collect();
        std::fs::write(FILE, HEADER.to_owned() + &lines).unwrap();
        return;
    }
    let written = written();
    let differ: Vec<_> = found
        .iter()
        .filter(|(name, digest)| written.get(*name) != Some(digest))
        .map(|(name, _)| name.as_str())
        .collect();
    assert!(
        differ.is_empty() && written.len() == found.len(),
        "{} levels and threads agree with each other, but not with {FILE}: {differ:?}. If the change was meant to alter \
         results, RESTITUTION_WRITE_DIGESTS=1 writes the file anew; if not, this is a defect.",
        Level::available().count()
    );
}

/// A million impacts, tables and statistics: one digest a run, the same from every level and schedule, and the one in the
/// file.
#[test]
fn the_bits_are_those_that_are_written_down() {
    let angles = angles();
    let mut found = BTreeMap::new();
    let mut impacts = 0;
    let jobs = jobs(&angles).into_iter();
    let jobs = jobs.map(|(name, run)| (name.to_owned(), run));
    for (name, run) in jobs.chain(kinds()) {
        let one = Resources {
            threads: 1,
            level: Level::Scalar,
        };
        let (table, count) = simulate(&run, one);
        let histogram = statistics(&run, one);
        for resources in every_level(3).chain([best(1)]) {
            assert_eq!(
                simulate(&run, resources).0,
                table,
                "{name} table with {resources:?}"
            );
            assert_eq!(
                statistics(&run, resources),
                histogram,
                "{name} statistics with {resources:?}"
            );
        }
        found.insert(format!("{name}/table"), table);
        found.insert(format!("{name}/statistics"), histogram);
        impacts += count;
    }
    assert!(impacts > 1_000_000, "{impacts} impacts");
    agrees_with_the_file(&found);
}

/// A run in portions, one after the other: the tables put together and the histograms merged have the digests of the whole.
#[test]
fn portions_have_the_digests_of_the_whole() {
    let angles = angles();
    let jobs = jobs(&angles);
    let (_, whole) = jobs
        .iter()
        .find(|(name, _)| *name == "given-angles")
        .unwrap();
    let bins = bins(By::Velocity(edges(0.0, 0.01, 120)));
    let digests = |portion: usize, resources: Resources| {
        let (mut table, mut statistics) = (Digest::new(), Digest::new());
        let mut total = Histogram::new(&bins, whole.origin()).unwrap();
        for angles in angles.chunks(portion) {
            let run = Run {
                particles: angles.len(),
                orientation: Orientation::Given(angles),
                ..*whole
            };
            let monitor = Monitor::default();
            let records = run.simulate(resources, &monitor).unwrap().into();
            table.records(&records, run.impacts);
            total.merge(&run.statistics(&bins, resources, &monitor).unwrap());
        }
        statistics.histogram(&total, bins.rows());
        (table.0, statistics.0)
    };
    let expected = digests(angles.len(), best(1));
    for portion in [1, 7, 96, 97, 449] {
        assert_eq!(digests(portion, best(2)), expected, "{portion} at a time");
    }
    for resources in every_level(1) {
        assert_eq!(digests(60, resources), expected, "{resources:?}");
    }
}
