//! The schedule must not show in the result.

mod common;

use common::*;
use restitution_core::{Monitor, Records, Run};

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
