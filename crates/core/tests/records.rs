//! The table of a run: it has the variables that it was asked for, and of a run that was cancelled what happened, and no more.

use crate::common::*;
use restitution_core::{
    About, Columns, Height, Level, Monitor, PER_IMPACT, PER_PARTICLE, Plastic, Resources, Rigid,
    Run, Spin, StopReason, Values, Variable, Vector, When,
};
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Everything but the state.
fn recorded() -> Columns {
    Columns::named(PER_IMPACT, ["time", "restitution", "contact"]).unwrap()
}

const ONE: Resources = Resources {
    threads: 1,
    level: Level::Scalar,
};

fn undisturbed(run: &Run<'_>, part: Range<usize>) -> Records {
    Records::from(
        run.simulate_columns(part, &recorded(), ONE, &Monitor::default())
            .unwrap(),
    )
}

/// The particles of a run that is cancelled when it asks whether to go on for the last of so many times: once for its block, and then
/// before each impact of the few particles that are in flight together.
fn cancelled(run: &Run<'_>, part: Range<usize>, times: usize) -> Records {
    let asked = AtomicUsize::new(1);
    let monitor = Monitor::attended(move |monitor| {
        if asked.fetch_add(1, Ordering::Relaxed) == times {
            monitor.cancel();
        }
    });
    Records::from(
        run.simulate_columns(part, &recorded(), ONE, &monitor)
            .unwrap(),
    )
}

/// Elastic bodies from many heights: those from the lower ones are too slow after their first impacts, the others bounce on.
fn of_two_kinds(impacts: usize) -> Run<'static> {
    Run {
        particles: 1000,
        impacts,
        release_height: Height::Random {
            lowest: 0.005,
            highest: 0.115,
        },
        minimum_speed: 1.05,
        settled: 0.0,
        ..paper(0.5, law(1.0, 1.0))
    }
}

/// A row has the first impacts of its particle, and no other up to the last column that has any.
fn is_begun(records: &Records, row: usize, (all, particle): (&Records, usize)) {
    let count = records.impacts[row] as usize;
    assert!(count <= all.impacts[particle] as usize);
    let impacts = all.reached;
    let (start, same) = (row * impacts, particle * impacts);
    for i in 0..count {
        assert_eq!(records.time[start + i], all.time[same + i]);
        assert_eq!(records.restitution[start + i], all.restitution[same + i]);
        assert_eq!(records.contact[start + i], all.contact[same + i]);
    }
    for i in start + count..start + records.reached {
        assert!(records.time[i].is_nan() && records.restitution[i].is_nan());
        assert_eq!(records.contact[i], 0);
    }
    assert_eq!(records.release_angle[row], all.release_angle[particle]);
    assert_eq!(records.release_height[row], all.release_height[particle]);
}

/// All particles of the block that was begun are in the table, whose columns end with the last impact of any.
#[test]
fn a_cancelled_run_has_all_particles_that_were_begun() {
    let run = of_two_kinds(300);
    let records = cancelled(&run, 500..700, 200);
    let all = undisturbed(&run, 500..596);
    assert!(records.particle.is_empty());
    assert_eq!(records.particles(), 96);
    let most = *records.impacts.iter().max().unwrap() as usize;
    assert!(most == records.reached && most < 200);
    for reason in [StopReason::Interrupted, StopReason::SpeedBelowThreshold] {
        let of = |&&found: &&i8| found == reason as i8;
        assert!(records.stop_reason.iter().filter(of).count() > 3);
    }
    for row in 0..96 {
        is_begun(&records, row, (&all, row));
    }
}

/// Where more than four million cells would have to be blanked, the particles that were cut short are left out: here all of a block that
/// want more than 50 000 impacts. Those that want fewer have ended after 60 000, for none of them waits for its release long.
#[test]
fn what_was_cut_short_in_long_rows_is_left_out() {
    let run = of_two_kinds(60_000);
    let records = cancelled(&run, 500..700, 60_000);
    let all = undisturbed(&run, 500..596);
    let done: Vec<_> = (0..96).filter(|&i| all.impacts[i] < 50_000).collect();
    assert!(1 < done.len() && done.len() <= done[done.len() - 1]);
    let numbers: Vec<_> = done.iter().map(|&i| 500 + i as i64).collect();
    assert_eq!(records.particle, numbers);
    assert_eq!(records.particles(), done.len());
    let most = done.iter().map(|&i| all.impacts[i] as usize).max().unwrap();
    assert_eq!(records.reached, most);
    for (row, &i) in done.iter().enumerate() {
        assert_eq!(records.stop_reason[row], all.stop_reason[i]);
        assert_eq!(records.impacts[row], all.impacts[i]);
        is_begun(&records, row, (&all, i));
    }
}

/// Impacts that spheres in flight have had are not missing: the rows have more than four million cells, of which fewer are to be blanked.
#[test]
fn impacts_that_happened_need_not_be_blanked() {
    let run = Run {
        particles: 96,
        impacts: 60_000,
        ..paper(0.0, law(1.0, 1.0))
    };
    let records = cancelled(&run, 0..96, 43_800);
    assert!(records.particle.is_empty() && records.particles() == 96);
    let cells = 96 * records.reached;
    let had = records.impacts.iter().sum::<i64>() as usize;
    assert!(cells > 1 << 22 && cells - had < 1 << 22);
    let interrupted = |&reason: &i8| reason == StopReason::Interrupted as i8;
    assert!(records.stop_reason.iter().all(interrupted));
}

/// Rows that are blanked in several steps: of one that begins to roll at its first impact, and of one that spins too fast to be followed.
#[test]
fn long_rows_end_with_their_last_impact() {
    let impacts = 200_000;
    let run = Run {
        particles: 2,
        impacts,
        spin: Spin::Given(&[[0.0; 3], [0.0, 1e9, 0.0]]),
        ..paper(0.5, law(0.0, 1.0))
    };
    let records = undisturbed(&run, 0..2);
    assert_eq!(records.impacts[1], 0);
    assert_eq!(records.stop_reason[1], StopReason::NeverLands as i8);
    let first = records.impacts[0] as usize;
    assert!((1..100).contains(&first));
    for (i, time) in records.time.iter().enumerate() {
        assert_eq!(time.is_nan(), i >= first);
    }
    assert_eq!(records.reached, impacts);
}

/// The names of the variables of the particles of a run, each with a value for every particle.
fn of_particles(run: &Run<'_>) -> Vec<&'static str> {
    let mut records = run.simulate(ONE, &Monitor::default()).unwrap();
    let found = records.per_particle();
    for (about, values) in &found {
        let elements = match values {
            Values::Numbers(values) => values.len(),
            Values::Flags(values) => values.len(),
            Values::Parts(values) => values.len(),
            Values::Counts(values) => values.len(),
        };
        let components = about.components.len().max(1);
        assert_eq!(elements, components * run.particles, "{}", about.name);
        assert!(PER_PARTICLE.contains(about));
    }
    found.into_iter().map(|(about, _)| about.name).collect()
}

/// A quantity that is the same for all particles is not among their variables.
#[test]
fn the_variables_of_particles_are_those_that_vary() {
    let run = Run {
        particles: 5,
        impacts: 3,
        ..paper(0.5, law(0.9, 0.3))
    };
    let always = ["impacts", "stop_reason", "release_angle"];
    assert_eq!(of_particles(&run), always);
    let height = Height::Random {
        lowest: 0.05,
        highest: 0.07,
    };
    let from_heights = Run {
        release_height: height,
        ..run
    };
    let varying = [&always[..], &["release_height"]].concat();
    assert_eq!(of_particles(&from_heights), varying);
    let spinning = Run {
        spin: Spin::Random {
            low: 1.0,
            high: 2.0,
            about: About::Isotropic,
        },
        ..run
    };
    let in_space = ["release_azimuth", "release_spin"];
    let varying = [&always[..], &in_space].concat();
    assert_eq!(of_particles(&spinning), varying);
    let thrown = Run {
        release_velocity: Vector::new(0.1, 0.0, 0.0),
        ..from_heights
    };
    let varying = [&always[..], &["release_height"], &in_space].concat();
    assert_eq!(of_particles(&thrown), varying);
}

/// The axis is a unit vector, at its angle with the normal; impact and rebound velocity are those along the normal, downwards and upwards:
/// to a few roundings.
#[test]
fn the_state_is_that_of_the_impact() {
    let run = Run {
        particles: 20,
        impacts: 3,
        ..paper(0.5, law(0.9, 0.3))
    };
    let columns = Columns::usual(run.body, &run.law, true);
    let records = Records::from(
        run.simulate_columns(0..20, &columns, ONE, &Monitor::default())
            .unwrap(),
    );
    let near = |a: f64, b: f64| (a - b).abs() < 4.0 * f64::EPSILON * (1.0 + b.abs());
    for i in 0..60 {
        let [x, y, z] = records.axis[i];
        assert!(near(x.hypot(y).hypot(z), 1.0));
        assert!(near(z, records.angle[i].cos()));
        assert!(near(
            records.velocity_before[i][2],
            -records.impact_velocity[i]
        ));
        assert!(near(
            records.velocity_after[i][2],
            records.rebound_velocity[i]
        ));
    }
}

/// The chosen variables of the impacts, in the order of their list, with their values; a vector has three numbers.
#[test]
fn the_variables_of_impacts_are_those_that_were_chosen() {
    let run = Run {
        particles: 5,
        impacts: 3,
        ..paper(0.5, law(0.9, 0.3))
    };
    let chosen = Columns::named(PER_IMPACT, ["axis", "contact", "time"]).unwrap();
    let bytes: Vec<_> = chosen.of(PER_IMPACT).map(Variable::bytes).collect();
    assert_eq!(bytes, [8, 1, 3 * 8]);
    let monitor = Monitor::default();
    let mut given = run.simulate_columns(0..5, &chosen, ONE, &monitor).unwrap();
    let records = Records::from(given.clone());
    let (time, contact) = (records.time.clone(), records.contact.clone());
    let axis = records.axis.as_flattened().to_vec();
    assert_eq!((time.len(), axis.len()), (5 * 3, 5 * 3 * 3));
    let found = given.per_impact();
    assert!(found.iter().all(|(about, _)| PER_IMPACT.contains(about)));
    let found: Vec<_> = found
        .into_iter()
        .map(|(about, values)| (about.name, about.components.len(), values))
        .collect();
    let expected = [
        ("time", 0, Values::Numbers(time)),
        ("contact", 0, Values::Flags(contact)),
        ("axis", 3, Values::Numbers(axis)),
    ];
    assert_eq!(found, expected);
}

/// By default the normal coefficient is recorded if it varies, the state if it is asked for, and of a body of any shape its attitude
/// instead of that, and the number of the part that touches.
#[test]
fn the_usual_variables_follow_from_the_law() {
    let constant = law(0.9, 0.3);
    let varying = Plastic::new(1.0).unwrap();
    let tangential = restitution_core::TangentialRestitution::new(0.3).unwrap();
    let varying = restitution_core::Law::new(varying, tangential).unwrap();
    let pebble = Rigid::ellipsoid([3e-3, 2e-3, 1e-3], 2500.0).unwrap();
    let body = paper(1.0, constant).body;
    for (law, varies) in [(&constant, false), (&varying, true)] {
        for state in [false, true] {
            for (body, axis) in [(body, true), ((&pebble).into(), false)] {
                let expected = PER_IMPACT.iter().filter(|about| match about.when {
                    When::Always => true,
                    When::HasAxis => axis,
                    When::HasNoAxis => !axis,
                    When::NormalVaries => varies,
                    When::StateAsked => state,
                    When::StateAskedOfAxis => state && axis,
                    When::StateAskedWithoutAxis => state && !axis,
                    When::HeightVaries | When::InSpace | When::InSpaceOfAxis => {
                        panic!("{}", about.name)
                    }
                });
                let expected: Vec<_> = expected.map(|about| about.name).collect();
                let chosen = Columns::usual(body, law, state);
                let names: Vec<_> = chosen.of(PER_IMPACT).map(|about| about.key).collect();
                assert_eq!(names.len(), expected.len());
                assert_eq!(names.contains(&"microscopic"), varies);
                assert_eq!(names.contains(&"axis"), state && axis);
                assert_eq!(names.contains(&"attitude"), state && !axis);
                assert_eq!(names.contains(&"contact"), axis);
                assert_eq!(names.contains(&"part"), !axis);
                assert!(expected.contains(&"contact"));
            }
        }
    }
}

/// `docs/records.md` has a row for each variable, with its unit, and for each stop reason, with its number.
#[test]
fn the_page_has_every_variable_and_stop_reason() {
    let page = include_str!("../../../docs/records.md");
    let (of_impacts, _) = page.split_once("\n## Encounters").expect("its heading");
    let rows: Vec<_> = of_impacts
        .lines()
        .filter(|line| line.starts_with("| `"))
        .collect();
    for about in PER_IMPACT.iter().chain(PER_PARTICLE) {
        let unit = match about.unit {
            Some("m s-1") => "m/s",
            Some("rad s-1") => "rad/s",
            other => other.unwrap_or("number"),
        };
        let name = format!("`{}`", about.name);
        let end = format!("| {unit} |");
        let has = |row: &&&str| {
            let first = row.split('|').nth(1).expect("a cell");
            first.contains(&name) && row.ends_with(&end)
        };
        assert_eq!(rows.iter().filter(has).count(), 1, "{name}, {unit}");
    }
    for (number, name) in StopReason::NAMES.iter().enumerate() {
        assert!(
            page.contains(&format!("\n| {number} | `{name}` |")),
            "{name}"
        );
    }
}
