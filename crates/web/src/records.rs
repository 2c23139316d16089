//! The impacts of some particles of a run, in SI units.

use restitution_core::{Error, Level, Monitor, Resources, Run};

/// Eight columns of shape (count, impacts): time, impact velocity, rebound velocity, restitution, rotational fraction, energy
/// ratio, angle, contact; NaN, or 0 in the last, where there was no impact. Then three numbers per particle: number of impacts,
/// stop reason, and angle at release.
pub fn simulate(run: &Run<'_>, first: usize, count: usize) -> Result<Vec<f64>, Error> {
    let resources = Resources {
        threads: 1,
        level: Level::best(),
    };
    let records = run.simulate_part(first..first + count, resources, &Monitor::default())?;
    let mut table = Vec::with_capacity(8 * records.time.len() + 3 * count);
    for column in [
        &records.time,
        &records.impact_velocity,
        &records.rebound_velocity,
        &records.restitution,
        &records.rotational_fraction,
        &records.energy_ratio,
        &records.angle,
    ] {
        table.extend_from_slice(column);
    }
    table.extend(records.contact.iter().map(|&sphere| f64::from(sphere)));
    table.extend(records.impacts.iter().map(|&impacts| impacts as f64));
    table.extend(records.stop_reason.iter().map(|&reason| f64::from(reason)));
    table.extend_from_slice(&records.release_angle);
    Ok(table)
}
