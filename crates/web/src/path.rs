//! The states at the start of each flight of one particle, from which the page draws the motion in closed form.

use restitution_core::{Body, Error, Followed, Run, Scales, Sphere, State};

/// Number of columns, one row per flight: start time; height of the centre of mass; velocity (3); axis (3); Λ/J_xx (3); the component
/// of ω − Λ/J_xx along the axis, the rate at which the body rolls about its axis; rotational energy divided by the mass; the sphere
/// that touched, 0 at release.
pub const COLUMNS: usize = 14;

/// The flights, row by row; the first starts at the release. SI units.
pub fn follow(run: &Run<'_>, particle: usize) -> Result<Vec<f64>, Error> {
    let followed = Followed::new(run, particle)?;
    let scales = &followed.scales;
    let body = &run.body.revolution()?.scaled;
    let mut rows = row(body, scales, 0.0, &followed.release, 0.0).to_vec();
    followed.bounce(|impact| {
        let sphere = match impact.sphere {
            Sphere::One => 1.0,
            Sphere::Two => 2.0,
        };
        rows.extend(row(body, scales, impact.time, &impact.after, sphere));
        true
    })?;
    Ok(rows)
}

fn row(body: &Body, scales: &Scales, time: f64, state: &State, sphere: f64) -> [f64; COLUMNS] {
    let (velocity, axis, turning) = (state.velocity, state.axis, state.precession);
    let roll = (state.spin(body) - turning).dot(axis);
    [
        time * scales.time,
        (state.height + body.hull.level()) * scales.length,
        velocity.x * scales.speed,
        velocity.y * scales.speed,
        velocity.z * scales.speed,
        axis.x,
        axis.y,
        axis.z,
        turning.x / scales.time,
        turning.y / scales.time,
        turning.z / scales.time,
        roll / scales.time,
        state.rotational_energy(body) * scales.speed * scales.speed,
        sphere,
    ]
}
