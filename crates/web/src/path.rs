//! The states at the start of each flight of one particle, from which the page draws the motion in closed form.

use crate::records::alone;
use crate::rigid::vector;
use restitution_core::{
    AnyBody, Columns, Error, Height, Quaternion, Records, Rigid, Run, Solid, Vector, elementary,
};

/// The start of a flight, in SI units.
struct Start {
    time: f64,
    /// Place of the centre of mass, along the plane from the release.
    place: Vector,
    velocity: Vector,
    spin: Vector,
    /// The angular velocity before the impact.
    before: Vector,
    /// The part that touched, from 1; 0 at release.
    part: f64,
}

/// The flights, row by row; the first starts at the release. SI units. Of a body of revolution in 14 columns: start time; height of the
/// centre of mass; velocity (3); axis (3); Λ/J_xx (3); the component of ω − Λ/J_xx along the axis, the rate at which the body rolls about
/// its axis; rotational energy divided by the mass; the sphere that touched, 0 at release. Of a rigid body in 19: start time; place of the
/// centre of mass (3); velocity (3); attitude (4: w, x, y, z), from the axes that the body was given in; ω (3); rotational energy divided
/// by the mass; the part that touched, 0 at release; where it touched, from the centre of mass (3).
pub fn follow(run: &Run<'_>, particle: usize) -> Result<Vec<f64>, Error> {
    let records = alone(run, particle, 1, &Columns::usual(run.body, &run.law, true))?;
    let starts = starts(run, &records);
    Ok(match run.body {
        AnyBody::Revolution(solid) => {
            let (sine, cosine) = elementary::sincos(records.numbers("release_angle")[0]);
            let azimuth = records
                .numbers("release_azimuth")
                .first()
                .copied()
                .unwrap_or(0.0);
            let (y, x) = elementary::sincos(azimuth);
            let axes = [[sine * x, sine * y, cosine]];
            let axes = axes
                .into_iter()
                .chain(vectors(&records, "axis"))
                .map(|axis| vector(&axis));
            let rows = starts.iter().zip(axes);
            rows.flat_map(|(start, axis)| revolving(&solid, start, axis))
                .collect()
        }
        AnyBody::Rigid(body) => {
            let attitudes = [
                vectors(&records, "release_attitude"),
                vectors(&records, "attitude"),
            ]
            .concat();
            let rows = starts.iter().zip(attitudes);
            rows.flat_map(|(start, [w, x, y, z])| rigid(body, start, Quaternion::new(w, x, y, z)))
                .collect()
        }
    })
}

/// The recorded values of a vector.
fn vectors<const N: usize>(records: &Records, name: &str) -> Vec<[f64; N]> {
    records.numbers(name).as_chunks().0.to_vec()
}

fn starts(run: &Run<'_>, records: &Records) -> Vec<Start> {
    let height = match run.release_height {
        Height::Fixed(height) => height,
        Height::Random { .. } => records.numbers("release_height")[0],
    };
    let (sine, cosine) = elementary::sincos(run.incline);
    let gravity = Vector::new(run.gravity * sine, 0.0, -run.gravity * cosine);
    let spin = vectors(records, "release_spin")
        .first()
        .map(vector)
        .unwrap_or_default();
    let mut starts = vec![Start {
        time: 0.0,
        place: Vector::new(0.0, 0.0, height),
        velocity: run.release_velocity,
        spin,
        before: spin,
        part: 0.0,
    }];
    let [time, height, part] = ["time", "height", "contact"].map(|name| records.numbers(name));
    let [velocity, after, before] = [
        "velocity_after",
        "angular_velocity_after",
        "angular_velocity_before",
    ]
    .map(|name| vectors(records, name));
    for i in 0..records.numbers("impacts")[0] as usize {
        let last = &starts[i];
        let lasted = time[i] - last.time;
        // In flight gravity alone acts (5); the height is that of the contact.
        let mut place = last.place + last.velocity * lasted + gravity * (0.5 * lasted * lasted);
        place.z = height[i];
        starts.push(Start {
            time: time[i],
            place,
            velocity: vector(&velocity[i]),
            spin: vector(&after[i]),
            before: vector(&before[i]),
            part: part[i],
        });
    }
    starts
}

fn revolving(solid: &Solid, start: &Start, axis: Vector) -> Vec<f64> {
    let spin = start.spin;
    let more = solid.axial_inertia / solid.transverse_inertia - 1.0;
    let turning = axis.mul_add(more * spin.dot(axis), spin); // Λ/J_xx
    let rotation = 0.5 * solid.transverse_inertia / solid.mass * spin.dot(turning);
    let mut row = vec![start.time, start.place.z];
    row.extend(
        [start.velocity, axis, turning]
            .map(Vector::parts)
            .as_flattened(),
    );
    row.extend([(spin - turning).dot(axis), rotation, start.part]);
    row
}

fn rigid(body: &Rigid, start: &Start, attitude: Quaternion) -> Vec<f64> {
    let within = (attitude * body.axes).inverse().rotate(start.spin);
    let rotation = 0.5 * body.unit * body.unit * body.top.twice_energy(within);
    let normal = Vector::new(0.0, 0.0, 1.0);
    let [up, turning] = [normal, normal.cross(start.before)].map(|v| attitude.inverse().rotate(v));
    let arm = match start.part as usize {
        0 => Vector::default(),
        part => attitude.rotate(body.nearest(part - 1, up, turning)),
    };
    let mut row = vec![start.time];
    row.extend(
        [start.place, start.velocity]
            .map(Vector::parts)
            .as_flattened(),
    );
    row.extend(attitude.parts());
    row.extend(start.spin.parts());
    row.extend([rotation, start.part]);
    row.extend(arm.parts());
    row
}
