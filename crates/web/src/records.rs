//! The impacts of some particles of a run, in SI units.

use restitution_core::{Columns, Error, Level, Monitor, Records, Resources, Run};

/// Eight columns of shape (count, impacts): time, impact velocity, rebound velocity, restitution, rotational fraction, energy
/// ratio, angle, contact; NaN, or 0 in the last, where there was no impact; the angle of a rigid body is NaN, and its contact the part. Then three numbers per particle: number of impacts,
/// stop reason, and angle at release.
pub fn simulate(run: &Run<'_>, first: usize, count: usize) -> Result<Vec<f64>, Error> {
    let records = alone(
        run,
        first,
        count,
        &Columns::usual(run.body, &run.law, false),
    )?;
    let names = [
        "time",
        "impact_velocity",
        "rebound_velocity",
        "restitution",
        "rotational_fraction",
        "energy_ratio",
        "angle",
        "contact",
        "impacts",
        "stop_reason",
        "release_angle",
    ];
    let impacts = records.numbers("time").len();
    let column = |name: &str| {
        let cells = if name == "release_angle" {
            count
        } else {
            impacts
        };
        let values = records.numbers(name);
        // A rigid body has no angle.
        if values.is_empty() {
            vec![f64::NAN; cells]
        } else {
            values
        }
    };
    Ok(names.into_iter().flat_map(column).collect())
}

/// The records of some particles, in this thread.
pub fn alone(
    run: &Run<'_>,
    first: usize,
    count: usize,
    columns: &Columns,
) -> Result<Records, Error> {
    let part = first..first + count;
    run.simulate_columns(part, columns, here(), &Monitor::default())
}

/// This thread.
pub fn here() -> Resources {
    Resources {
        threads: 1,
        level: Level::best(),
    }
}
