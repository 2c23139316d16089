//! Encounters of two bodies of the kind of a run, under its law and with its seed, in SI units.

use crate::records::here;
use restitution_core::pair::{Encounters, Meeting, PairState, PairTable, Partner};
use restitution_core::{Error, Monitor, Run, Vector};
use std::ops::Range;

/// The way in which they meet, as `web/src/engine/layout.ts` writes it: 0 for two Maxwellians, 1 for what is given; √(T_tr/m) and T_rot/T_tr; the relative
/// speed, the impact parameter over the sum of the reaches, and ω of each about the normal of the plane in which the centres approach.
pub const NUMBERS: usize = 7;

/// The variables of an encounter that the page shows, a number each.
const SHOWN: [&str; 8] = [
    "contacts",
    "ending",
    "duration",
    "deflection",
    "contact_speed",
    "restitution_centres",
    "restitution_contact",
    "restitution_energy",
];

/// One encounter: the variables of `SHOWN`; the numbers of [`drawn_as`]; the flights, one more
/// than the contacts, in 31 columns: start time, and of each body position (3), velocity (3), attitude (4: w, x, y, z), ω (3), energy of translation
/// and of rotation; and the contacts in 12: time, normal (3), point (3), impulse on the first body (3), normal speeds towards each other before and from
/// each other after.
pub fn meet(run: &Run<'_>, pairs: &[f64; NUMBERS], number: usize) -> Result<Vec<f64>, Error> {
    let body = Partner::new("shape", run.body)?;
    let table = follow(run, &body, pairs, number..number + 1, true)?;
    let mut made: Vec<f64> = SHOWN.map(|name| table.numbers(name)[0]).to_vec();
    made.extend(drawn_as(&body));
    let mut states = table.states("before")[0];
    let mut clock = 0.0;
    made.extend(flight(&body, clock, &states));
    for hit in &table.hits {
        for (state, sign) in states.iter_mut().zip([1.0, -1.0]) {
            let later = body.later(state, hit.time - clock);
            *state = body.struck(&later, hit.point, hit.impulse * sign);
        }
        clock = hit.time;
        made.extend(flight(&body, clock, &states));
    }
    for hit in &table.hits {
        made.push(hit.time);
        made.extend(
            [hit.normal, hit.point, hit.impulse]
                .map(Vector::parts)
                .as_flattened(),
        );
        made.extend(hit.speeds);
    }
    Ok(made)
}

/// The reach of a body, its principal moments (3) and the rotation from its principal axes (4): what the page draws it with.
pub fn drawn_as(body: &Partner) -> Vec<f64> {
    let mut row = vec![body.reach()];
    row.extend(body.moments());
    row.extend(body.axes().parts());
    row
}

/// Of some encounters the number of contacts, how each ended, and √(E'/E), row by row.
pub fn survey(
    run: &Run<'_>,
    pairs: &[f64; NUMBERS],
    first: usize,
    count: usize,
) -> Result<Vec<f64>, Error> {
    let body = Partner::new("shape", run.body)?;
    let table = follow(run, &body, pairs, first..first + count, false)?;
    let shown = ["contacts", "ending", "restitution_energy"].map(|name| table.numbers(name));
    Ok((0..count)
        .flat_map(|number| shown.each_ref().map(|column| column[number]))
        .collect())
}

fn follow(
    run: &Run<'_>,
    body: &Partner,
    &[kind, thermal, ratio, speed, offset, one, two]: &[f64; NUMBERS],
    numbers: Range<usize>,
    contacts: bool,
) -> Result<PairTable, Error> {
    let temperature = run.body.mass() * (thermal * thermal);
    let given = kind == 1.0;
    let encounters = Encounters {
        bodies: [body; 2],
        first: numbers.start as u64,
        count: numbers.len(),
        meeting: if given {
            Meeting::Speed(speed)
        } else {
            Meeting::Temperatures([temperature; 2])
        },
        impact_parameter: given.then_some(offset * 2.0 * body.reach()),
        rotational: [ratio * temperature; 2],
        spin: given.then_some([Vector::default(); 2]),
        seed: run.seed,
    };
    let record = |states: Option<&[[PairState; 2]]>, contacts| {
        encounters.record(
            &run.law,
            states,
            [true, contacts],
            here(),
            &Monitor::default(),
        )
    };
    if !given {
        return record(None, contacts);
    }
    let mut drawn = record(None, false)?.states("before");
    for states in &mut drawn {
        let [a, b] = &*states;
        let normal = (a.position - b.position).cross(a.velocity - b.velocity);
        for (state, spin) in states.iter_mut().zip([one, two]) {
            state.spin = normal * (spin / normal.norm());
        }
    }
    record(Some(&drawn), contacts)
}

fn flight(body: &Partner, start: f64, states: &[PairState; 2]) -> Vec<f64> {
    let mut row = vec![start];
    for state in states {
        row.extend(state.position.parts());
        row.extend(state.velocity.parts());
        row.extend(state.attitude.parts());
        row.extend(state.spin.parts());
        row.push(body.translational_energy(state.velocity));
        row.push(body.rotational_energy(state.attitude, state.spin));
    }
    row
}
