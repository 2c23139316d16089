//! The bits of a million impacts, written down: the same at every SIMD level, on any number of threads, in any portions, and
//! on every machine.
//!
//! The digests are in `digests.txt` beside this file. A change that alters a bit of a result on purpose has to write them
//! anew, with `RESTITUTION_WRITE_DIGESTS=1 cargo test -p restitution-core --test digest`; the difference then shows in review.
//! Where nobody meant to alter a result, a failure here is a defect: on one machine, of the change; on another, of the promise.

mod common;

use common::*;
use restitution_core::statistics::{Axis, Bins, By, Grid, Tally};
use restitution_core::{
    About, ChatterjeeRuina, Coulomb, Dumbbell, Frictionless, Hypothesis, Law, Level, LoadedSphere,
    Means, Monitor, Normal, Orientation, Plastic, Records, Rule, Run, Solid, Spherocylinder,
    Spheroid, Spin, Tabulated, TangentialRestitution, Vector, Viscoelastic,
};
use std::collections::BTreeMap;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/digests.txt");
const HEADER: &str = "\
# Digests (FNV-1a, 64 bits) of the runs in digest.rs. Every machine must find them.
# Written by: RESTITUTION_WRITE_DIGESTS=1 cargo test -p restitution-core --test digest
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

    fn tally(&mut self, tally: &Tally, rows: usize) {
        let grids: [&Grid; 2] = [&tally.restitution, &tally.fraction];
        for count in grids.into_iter().flat_map(Grid::counts).chain(&tally.stops) {
            self.word(*count);
        }
        for row in 0..rows {
            let m = tally.moments(row).unwrap();
            let numbers = [
                m.mean,
                m.variance,
                m.skewness,
                m.kurtosis,
                m.minimum,
                m.maximum,
                tally.mean_fraction(row).unwrap(),
            ];
            numbers.into_iter().for_each(|x| self.number(x));
        }
    }
}

/// What the paper's Fig. 2 is drawn from: R = 10 mm, dropped so that a sphere of that radius arrives with 1 m/s.
fn figure_2() -> Run<'static> {
    let radius = 10e-3;
    Run {
        body: Dumbbell::new(radius, 0.1 * radius, 2500.0).unwrap().into(),
        release_height: (radius + 1.0 / (2.0 * 9.81)).into(),
        particles: 700,
        impacts: 500,
        seed: 1,
        ..paper(0.1, law(0.98, 1.0))
    }
}

fn glass() -> Normal<'static> {
    Viscoelastic::new(6e10, 0.22, 1e-6, 2500.0, 3e-3)
        .unwrap()
        .into()
}

fn measured() -> Normal<'static> {
    const SPEEDS: [f64; 4] = [0.05, 0.2, 0.5, 1.0];
    const VALUES: [f64; 4] = [0.98, 0.95, 0.93, 0.88];
    Tabulated::new(&SPEEDS, &VALUES).unwrap().into()
}

/// Friction in which slip goes on, stops and turns.
fn coulomb(elongation: f64, normal: Normal<'static>, hypothesis: Hypothesis) -> Run<'static> {
    Run {
        particles: 300,
        impacts: 200,
        ..paper(
            elongation,
            Law::new(normal, Coulomb::new(0.25, hypothesis).unwrap()).unwrap(),
        )
    }
}

/// From upright to upside down.
fn angles() -> Vec<f64> {
    (0..450).map(|i| 0.007 * f64::from(i)).collect()
}

/// A run of each kind: by name, from nearly round to separate spheres, from plastic to elastic, with every way to be
/// released and every way to end.
fn jobs(angles: &[f64]) -> Vec<(&'static str, Run<'_>)> {
    vec![
        ("figure-2", figure_2()),
        (
            "nearly-round",
            Run {
                particles: 203,
                impacts: 1000,
                ..paper(1e-3, law(0.99, 0.8))
            },
        ),
        (
            "gaining-energy",
            Run {
                particles: 500,
                impacts: 300,
                orientation: Orientation::Isotropic,
                ..paper(0.5, law(0.98, 1.0))
            },
        ),
        (
            "touching-spheres",
            Run {
                particles: 1001,
                impacts: 400,
                ..paper(2.0, law(0.7, -0.4))
            },
        ),
        (
            "separate-spheres",
            Run {
                particles: 250,
                impacts: 400,
                ..paper(3.5, law(1.0, -1.0))
            },
        ),
        (
            "slow-end",
            Run {
                particles: 1500,
                impacts: 400,
                minimum_speed: 0.1,
                ..paper(1.0, law(0.9, 0.6))
            },
        ),
        (
            "plastic",
            Run {
                particles: 500,
                impacts: 100,
                ..paper(0.1, law(0.0, 0.5))
            },
        ),
        (
            "frictionless",
            Run {
                particles: 400,
                impacts: 200,
                ..paper(0.1, Law::new(0.98, Frictionless).unwrap())
            },
        ),
        (
            "stronge-viscoelastic",
            coulomb(0.5, glass(), Hypothesis::Stronge),
        ),
        (
            "poisson-plastic",
            coulomb(2.0, Plastic::new(0.02).unwrap().into(), Hypothesis::Poisson),
        ),
        (
            "newton-tabulated",
            coulomb(1.0, measured(), Hypothesis::Newton),
        ),
        (
            "chatterjee-ruina",
            Run {
                particles: 300,
                impacts: 200,
                ..paper(
                    0.3,
                    Law::new(0.9, ChatterjeeRuina::new(-0.3, 0.2).unwrap()).unwrap(),
                )
            },
        ),
        (
            "viscoelastic",
            Run {
                particles: 300,
                impacts: 200,
                ..paper(
                    0.1,
                    Law::new(glass(), TangentialRestitution::new(1.0).unwrap()).unwrap(),
                )
            },
        ),
        (
            "given-angles",
            Run {
                particles: angles.len(),
                impacts: 300,
                orientation: Orientation::Given(angles),
                ..paper(0.7, law(0.95, 0.2))
            },
        ),
        (
            "from-the-sky",
            Run {
                particles: 300,
                impacts: 100,
                release_height: 1e4.into(),
                ..paper(0.1, law(0.98, 1.0))
            },
        ),
    ]
}

/// Every body under every law, dropped and thrown.
fn kinds() -> Vec<(String, Run<'static>)> {
    let r = 3e-3;
    let bodies: [(&str, Solid); 7] = [
        ("sphere", Dumbbell::new(r, 0.0, 2500.0).unwrap().into()),
        ("dumbbell", Dumbbell::new(r, r, 2500.0).unwrap().into()),
        (
            "unequal",
            Dumbbell::unequal([r, 0.7 * r], 1.5 * r, [2500.0, 1200.0])
                .unwrap()
                .into(),
        ),
        (
            "loaded",
            LoadedSphere::new(r, 2500.0, 1e-4, 0.4 * r).unwrap().into(),
        ),
        (
            "capsule",
            Spherocylinder::new(r, 0.8 * r, 2500.0).unwrap().into(),
        ),
        ("oblate", Spheroid::new(r, 0.6 * r, 2500.0).unwrap().into()),
        ("prolate", Spheroid::new(r, 1.8 * r, 2500.0).unwrap().into()),
    ];
    let coulomb = |hypothesis| Rule::from(Coulomb::new(0.3, hypothesis).unwrap());
    let rules: [(&str, Rule); 6] = [
        ("paper", TangentialRestitution::new(0.8).unwrap().into()),
        ("frictionless", Frictionless.into()),
        ("stronge", coulomb(Hypothesis::Stronge)),
        ("poisson", coulomb(Hypothesis::Poisson)),
        ("newton", coulomb(Hypothesis::Newton)),
        ("bilinear", ChatterjeeRuina::new(-0.3, 0.2).unwrap().into()),
    ];
    let mut kinds = Vec::new();
    for (i, (body, solid)) in bodies.into_iter().enumerate() {
        for (j, (name, rule)) in rules.into_iter().enumerate() {
            let normal = if (i + j) % 3 == 0 {
                glass()
            } else {
                0.9.into()
            };
            let dropped = Run {
                body: solid,
                particles: 100,
                impacts: 40,
                ..paper(0.1, Law::new(normal, rule).unwrap())
            };
            let thrown = Run {
                orientation: Orientation::Isotropic,
                spin: Spin::Random {
                    low: 5.0,
                    high: 60.0,
                    about: About::Isotropic,
                },
                velocity: Vector::new(0.1, -0.2, 0.3),
                incline: 0.1,
                ..dropped
            };
            kinds.push((format!("{body}-{name}-dropped"), dropped));
            kinds.push((format!("{body}-{name}-thrown"), thrown));
        }
    }
    kinds
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
fn simulate(run: &Run<'_>, means: Means) -> (u64, i64) {
    let mut digest = Digest::new();
    let records = run.simulate(means, &Monitor::default()).unwrap();
    digest.records(&records, run.impacts);
    (digest.0, records.impacts.iter().sum())
}

/// Digest of the statistics by velocity and by number.
fn statistics(run: &Run<'_>, means: Means) -> u64 {
    let mut digest = Digest::new();
    for by in [By::Velocity(edges(0.0, 0.01, 120)), By::Number(run.impacts)] {
        let bins = bins(by);
        let tally = run.statistics(&bins, means, &Monitor::default()).unwrap();
        digest.tally(&tally, bins.rows());
    }
    digest.0
}

fn best(threads: usize) -> Means {
    let level = Level::best();
    Means { threads, level }
}

fn every_level(threads: usize) -> impl Iterator<Item = Means> {
    Level::available().map(move |level| Means { threads, level })
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
        let one = Means {
            threads: 1,
            level: Level::Scalar,
        };
        let (table, count) = simulate(&run, one);
        let tally = statistics(&run, one);
        for means in every_level(3).chain([best(1)]) {
            assert_eq!(
                simulate(&run, means).0,
                table,
                "{name} table with {means:?}"
            );
            assert_eq!(
                statistics(&run, means),
                tally,
                "{name} statistics with {means:?}"
            );
        }
        found.insert(format!("{name}/table"), table);
        found.insert(format!("{name}/statistics"), tally);
        impacts += count;
    }
    assert!(impacts > 1_000_000, "{impacts} impacts");
    agrees_with_the_file(&found);
}

/// A run in portions, one after the other: the tables put together and the tallies merged have the digests of the whole.
#[test]
fn portions_have_the_digests_of_the_whole() {
    let angles = angles();
    let jobs = jobs(&angles);
    let (_, whole) = jobs
        .iter()
        .find(|(name, _)| *name == "given-angles")
        .unwrap();
    let bins = bins(By::Velocity(edges(0.0, 0.01, 120)));
    let digests = |portion: usize, means: Means| {
        let (mut table, mut statistics) = (Digest::new(), Digest::new());
        let mut total = Tally::new(&bins, whole.origin()).unwrap();
        for angles in angles.chunks(portion) {
            let run = Run {
                particles: angles.len(),
                orientation: Orientation::Given(angles),
                ..*whole
            };
            let monitor = Monitor::default();
            table.records(&run.simulate(means, &monitor).unwrap(), run.impacts);
            total.merge(&run.statistics(&bins, means, &monitor).unwrap());
        }
        statistics.tally(&total, bins.rows());
        (table.0, statistics.0)
    };
    let expected = digests(angles.len(), best(1));
    for portion in [1, 7, 96, 97, 449] {
        assert_eq!(digests(portion, best(2)), expected, "{portion} at a time");
    }
    for means in every_level(1) {
        assert_eq!(digests(60, means), expected, "{means:?}");
    }
}
