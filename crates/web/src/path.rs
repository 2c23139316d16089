//! The states at the start of each flight of one particle, from which the page draws the motion in closed form.

use crate::records::alone;
use crate::rigid::{components, quaternion, vector};
use restitution_core::{
    AnyBody, Body, Columns, Error, Followed, Height, Quaternion, Rigid, Run, Scales, Sphere, State,
    Vector, elementary,
};

/// Number of columns, one row per flight: start time; height of the centre of mass; velocity (3); axis (3); Λ/J_xx (3); the component
/// of ω − Λ/J_xx along the axis, the rate at which the body rolls about its axis; rotational energy divided by the mass; the sphere
/// that touched, 0 at release.
pub const COLUMNS: usize = 14;

/// The flights, row by row; the first starts at the release. SI units.
pub fn follow(run: &Run<'_>, particle: usize) -> Result<Vec<f64>, Error> {
    if let AnyBody::Rigid(body) = run.body {
        return follow_rigid(run, body, particle);
    }
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

/// Of a body without an axis, in 19 columns: start time; place of the centre of mass, along the plane from the release (3); velocity
/// (3); attitude (4: w, x, y, z), from the axes that the body was given in; ω (3); rotational energy divided by the mass; the part that
/// touched, 0 at release; where it touched, from the centre of mass (3).
fn follow_rigid(run: &Run<'_>, body: &Rigid, particle: usize) -> Result<Vec<f64>, Error> {
    let columns = Columns::usual(run.body, &run.law, true);
    let records = alone(run, particle, 1, &columns)?;
    let height = match run.release_height {
        Height::Fixed(height) => height,
        Height::Random { .. } => records.release_height[0],
    };
    let (sine, cosine) = elementary::sincos(run.incline);
    let gravity = Vector::new(run.gravity * sine, 0.0, -run.gravity * cosine);
    let normal = Vector::new(0.0, 0.0, 1.0);
    let row = |time, place, velocity, [w, x, y, z]: [f64; 4], spin: [f64; 3], part: i32, before| {
        let spin = vector(&spin);
        let attitude = Quaternion::new(w, x, y, z);
        let within = (attitude * body.axes).inverse().rotate(spin);
        let rotation = 0.5 * body.unit * body.unit * body.top.twice_energy(within);
        let mut row = vec![time];
        row.extend(components(place));
        row.extend(components(velocity));
        row.extend(quaternion(attitude));
        row.extend(components(spin));
        row.extend([rotation, f64::from(part)]);
        let [up, turning] =
            [normal, normal.cross(vector(&before))].map(|v| attitude.inverse().rotate(v));
        let arm = match part {
            0 => Vector::default(),
            part => attitude.rotate(body.nearest(part as usize - 1, up, turning)),
        };
        row.extend(components(arm));
        row
    };
    let (mut time, mut place) = (0.0, Vector::new(0.0, 0.0, height));
    let mut velocity = run.release_velocity;
    let (attitude, spin) = (records.release_attitude[0], records.release_spin[0]);
    let mut rows = row(time, place, velocity, attitude, spin, 0, spin);
    for i in 0..records.impacts[0] as usize {
        let lasted = records.time[i] - time;
        // In flight gravity alone acts (5); the height is that of the contact.
        place = place + velocity * lasted + gravity * (0.5 * lasted * lasted);
        place.z = records.height[i];
        time = records.time[i];
        velocity = vector(&records.velocity_after[i]);
        let spins = [
            &records.angular_velocity_after,
            &records.angular_velocity_before,
        ];
        let [spin, before] = spins.map(|spins| spins[i]);
        let (attitude, part) = (records.attitude[i], records.part[i]);
        rows.extend(row(time, place, velocity, attitude, spin, part, before));
    }
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
