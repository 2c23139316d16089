//! The share of impacts in which a dumbbell leaves the plane faster than it came.

use restitution_core::{Dumbbell, Monitor, Resources, Run};

fn main() -> Result<(), restitution_core::Error> {
    let run = Run {
        body: Dumbbell::new(3e-3, 3e-4, 2500.0)?.into(),
        impacts: 100,
        ..Run::default()
    };
    let records = run.simulate(Resources::default(), &Monitor::default())?;
    let restitution = records.numbers("restitution");
    let above = restitution.iter().filter(|&&e| e > 1.0).count();
    println!(
        "{above} of {} impacts have a restitution above 1",
        records.numbers("impacts").iter().sum::<f64>()
    );
    Ok(())
}
