//! The impacts of some particles of a run, in SI units.

use restitution_core::{AnyBody, Columns, Error, Level, Monitor, Records, Resources, Run};

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
    let mut table = Vec::with_capacity(8 * records.time.len() + 3 * count);
    for column in [
        &records.time,
        &records.impact_velocity,
        &records.rebound_velocity,
        &records.restitution,
        &records.rotational_fraction,
        &records.energy_ratio,
    ] {
        table.extend_from_slice(column);
    }
    if let AnyBody::Rigid(_) = run.body {
        table.resize(table.len() + records.part.len(), f64::NAN);
        table.extend(records.part.iter().map(|&part| f64::from(part)));
    } else {
        table.extend_from_slice(&records.angle);
        table.extend(records.contact.iter().map(|&sphere| f64::from(sphere)));
    }
    table.extend(records.impacts.iter().map(|&impacts| impacts as f64));
    table.extend(records.stop_reason.iter().map(|&reason| f64::from(reason)));
    table.extend_from_slice(&records.release_angle);
    Ok(table)
}

/// The records of some particles, in this thread.
pub fn alone(
    run: &Run<'_>,
    first: usize,
    count: usize,
    columns: &Columns,
) -> Result<Records, Error> {
    let resources = Resources {
        threads: 1,
        level: Level::best(),
    };
    run.simulate_columns(
        first..first + count,
        columns,
        resources,
        &Monitor::default(),
    )
}
