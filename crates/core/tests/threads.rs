//! The schedule must not show in the result.

use crate::common::*;
use restitution_core::{
    Columns, Error, Level, Monitor, Orientation, PER_IMPACT, Resources, Run, Spin, Vector,
    default_threads, simulate_series,
};
use std::collections::HashSet;
use std::sync::{Arc, Mutex};
use std::thread;

/// Every column of the particles from `first` to `last`, as bits.
fn bits(records: &Records, impacts: usize, particles: std::ops::Range<usize>) -> Vec<u64> {
    let mut bits = Vec::new();
    for (_, column) in columns(records) {
        let rows = &column[particles.start * impacts..particles.end * impacts];
        bits.extend(rows.iter().map(|x| x.to_bits()));
    }
    for i in particles {
        let contacts = &records.contact[i * impacts..(i + 1) * impacts];
        bits.extend(contacts.iter().map(|&x| x as u64));
        bits.push(records.impacts[i] as u64);
        bits.push(records.stop_reason[i] as u64);
        bits.push(records.release_angle[i].to_bits());
    }
    bits
}

/// A run in which trajectories end at different times, so that threads have something to steal from each other.
fn uneven() -> Run<'static> {
    Run {
        particles: 300,
        impacts: 150,
        minimum_speed: 0.3,
        settled: 0.0,
        ..paper(0.7, law(0.92, 0.4))
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let run = uneven();
    let on = |threads| {
        bits(
            &simulate_on(&run, threads, &Monitor::default()),
            150,
            0..300,
        )
    };
    let one = on(1);
    for threads in [2, 3, 7, 0] {
        assert!(one == on(threads), "{threads} threads");
    }
    assert!(one == on(1), "again");
}

/// A particle does not know how many others there are.
#[test]
fn particles_are_independent_of_their_number() {
    let all = simulate(&uneven());
    for particles in [1, 7, 64, 65, 299] {
        let some = simulate(&Run {
            particles,
            ..uneven()
        });
        assert!(
            bits(&all, 150, 0..particles) == bits(&some, 150, 0..particles),
            "{particles} particles"
        );
    }
}

/// Nor does an impact know how many more were asked for.
#[test]
fn impacts_are_independent_of_their_number() {
    let run = uneven();
    let long = simulate(&run);
    let short = simulate(&Run { impacts: 20, ..run });
    for particle in 0..run.particles {
        for ((_, long), (_, short)) in columns(&long).into_iter().zip(columns(&short)) {
            let (a, b) = (&long[particle * 150..][..20], &short[particle * 20..][..20]);
            assert!(
                a.iter()
                    .map(|x| x.to_bits())
                    .eq(b.iter().map(|x| x.to_bits()))
            );
        }
    }
}

fn series(
    runs: &[(Run<'_>, std::ops::Range<usize>)],
    threads: usize,
    monitor: &Monitor,
) -> Result<Records, Error> {
    let level = Level::best();
    let columns = Columns::usual(runs[0].0.body, &runs[0].0.law, false);
    simulate_series(runs, &columns, Resources { threads, level }, monitor).map(Records::from)
}

/// Parts of several runs simulated as one have the bits of each run by itself, one after the other.
#[test]
fn runs_side_by_side_are_those_one_by_one() {
    for spin in [Spin::NONE, Spin::Given(&[[9.0, 1.0, 4.0]; 5])] {
        let given = Run {
            particles: 5,
            orientation: Orientation::Given(&[0.3, 1.2, 2.2, 0.1, 3.0]),
            spin,
            ..uneven()
        };
        let low = Run {
            release_height: 0.03.into(),
            seed: 7,
            particles: 5,
            spin,
            ..uneven()
        };
        let runs = [(low, 2..5), (given, 0..5), (low, 0..1)];
        for threads in [1, 2, 5] {
            let monitor = Monitor::default();
            let together = series(&runs, threads, &monitor).unwrap();
            assert_eq!(together.particles(), 9);
            assert_eq!(monitor.finished(), 9);
            let mut first = 0;
            for (run, part) in &runs {
                let alone = bits(&simulate(run), 150, part.clone());
                let rows = first..first + part.len();
                assert!(bits(&together, 150, rows) == alone, "{threads} threads");
                first += part.len();
            }
        }
    }
}

/// Many more particles than a block has are shared evenly.
#[test]
fn a_long_series_is_complete() {
    let run = Run {
        particles: 2100,
        impacts: 9,
        ..uneven()
    };
    let alone = bits(&simulate(&run), 9, 0..2100);
    for threads in [1, 2, 3] {
        let parts = [(run, 0..1), (run, 1..2000), (run, 2000..2100)];
        let together = series(&parts, threads, &Monitor::default()).unwrap();
        assert!(bits(&together, 9, 0..2100) == alone, "{threads} threads");
    }
}

/// What all particles of a series share must be the same in all runs; a part lies in its run.
#[test]
fn runs_that_differ_are_no_series() {
    let run = uneven();
    let others = [
        Run {
            gravity: 9.8,
            ..run
        },
        Run {
            impacts: 149,
            ..run
        },
        Run {
            incline: 0.1,
            ..run
        },
        Run {
            minimum_speed: 0.2,
            settled: 0.0,
            ..run
        },
        Run {
            law: law(0.92, 0.5),
            ..run
        },
        Run {
            body: paper(0.6, run.law).body,
            ..run
        },
        Run {
            release_velocity: Vector {
                x: 1.0,
                y: 0.0,
                z: 0.0,
            },
            ..run
        },
    ];
    let refused = |runs: &[(Run<'_>, std::ops::Range<usize>)]| {
        let columns = Columns::named(PER_IMPACT, []).unwrap();
        let resources = Resources {
            threads: 1,
            level: Level::Scalar,
        };
        match simulate_series(runs, &columns, resources, &Monitor::default()) {
            Err(Error::Parameter { name, .. }) => name,
            other => panic!("{other:?}"),
        }
    };
    for other in others {
        assert_eq!(refused(&[(run, 0..1), (other, 0..1)]), "runs");
    }
    assert_eq!(refused(&[]), "runs");
    assert_eq!(refused(&[(run, 0..1), (run, 3..3)]), "part");
    assert_eq!(refused(&[(run, 299..301)]), "part");
}

/// Another seed is another run.
#[test]
fn the_seed_matters() {
    let run = uneven();
    let (a, b) = (
        simulate(&run),
        simulate(&Run {
            seed: run.seed + 1,
            ..run
        }),
    );
    assert!(
        a.release_angle
            .iter()
            .zip(&b.release_angle)
            .all(|(a, b)| a != b)
    );
}

/// Every particle is told of when it is done.
#[test]
fn progress_is_told() {
    let monitor = Monitor::default();
    let run = uneven();
    simulate_on(&run, 2, &monitor);
    assert_eq!(monitor.finished(), run.particles as u64);
}

/// On how many threads besides the caller's a run asks whether to go on.
fn others(threads: usize, particles: usize) -> usize {
    let seen = Arc::new(Mutex::new(HashSet::new()));
    let told = Arc::clone(&seen);
    let monitor = Monitor::attended(move |_| {
        told.lock().unwrap().insert(thread::current().id());
    });
    let run = Run {
        particles,
        impacts: 1,
        ..uneven()
    };
    simulate_on(&run, threads, &monitor);
    let mut seen = seen.lock().unwrap();
    seen.remove(&thread::current().id());
    seen.len()
}

/// As many as were asked for, or one for each processor that the process may use, but no more than there are blocks, of 96 particles at
/// least. A single thread is the caller's own.
#[test]
fn threads_are_as_many_as_were_asked_for() {
    for (threads, particles, expected) in [
        (1, 960, 0),
        (2, 960, 2),
        (5, 960, 5),
        (5, 97, 2),
        (5, 96, 0),
    ] {
        assert_eq!(others(threads, particles), expected);
    }
    let processors = thread::available_parallelism().unwrap().get();
    assert_eq!(default_threads(), processors);
    let expected = if processors > 1 { processors } else { 0 };
    assert_eq!(others(0, 96 * processors), expected);
}
