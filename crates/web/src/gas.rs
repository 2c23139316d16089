//! A small gas of bodies of the kind of a run, under its law and with its seed, followed step by step, in SI units.

use crate::pair::drawn_as;
use crate::records::here;
use restitution_core::gas::{GAS_KIND, GAS_WHOLE, Gas, Phase, STATE, Species};
use restitution_core::pair::Partner;
use restitution_core::{AnyBody, Error, Monitor, Rule, Run};

/// The gas, as `web/src/engine/layout.ts` writes it: number of particles, √(T_tr/m) and T_rot/T_tr at the beginning, side of the box over the reach
/// of a body, collisions of a particle in a step, and the number of the step.
pub const NUMBERS: usize = 6;

/// One step, from the given states if there are any: the numbers of [`drawn_as`]; at its beginning and its end the time since then, encounters with
/// contact and contacts of a particle, T_tr, and T_rot about the axes that contacts can turn, in J; and the states at the end, a row of velocity (3),
/// ω (3) and attitude (4: w, x, y, z) of each particle.
pub fn cool(run: &Run<'_>, start: &[f64; NUMBERS], states: &[f64]) -> Result<Vec<f64>, Error> {
    let &[particles, thermal, ratio, side, collisions, step] = start;
    let body = Partner::new("shape", run.body)?;
    let (mass, given) = (run.body.mass(), states.as_chunks::<STATE>().0);
    // Without friction an impulse passes through the axis of a body of revolution.
    let smooth = matches!(run.law.rule, Rule::Frictionless(_));
    let turned = [
        true,
        true,
        !(smooth && matches!(run.body, AnyBody::Revolution(_))),
    ];
    let translational = mass * (thermal * thermal);
    let box_side = side * body.reach();
    let gas = Gas {
        kinds: vec![Species {
            body: &body,
            particles: particles as usize,
            translational,
            rotational: [ratio * translational; 3],
            turned,
        }],
        density: particles / (box_side * box_side * box_side),
        phase: Phase::Time,
        batches: 1,
        collisions,
        heating: 0.0,
        given: (!given.is_empty()).then_some(given),
        keep: true,
        distributions: false,
        samples: 1,
        seed: run.seed + step as u64,
    };
    let (rows, last) = gas.cool(&run.law, here(), &Monitor::default(), None)?;
    let mut made = drawn_as(&body);
    for row in rows.chunks(GAS_WHOLE.len() + GAS_KIND.len()) {
        let (whole, kind) = row.split_at(GAS_WHOLE.len());
        let mean = |name| kind[GAS_KIND.iter().position(|x| *x == name).expect("a name")];
        let count = |name| whole[GAS_WHOLE.iter().position(|x| *x == name).expect("a name")];
        let parts = ["rotational_x", "rotational_y", "rotational_z"].map(mean);
        let own = parts.into_iter().zip(turned).filter(|&(_, turned)| turned);
        let axes = own.clone().count() as f64;
        let rotation: f64 = own.map(|(energy, _)| energy).sum();
        made.extend([
            count("time"),
            2.0 * count("collisions") / particles,
            2.0 * count("contacts") / particles,
            mass * mean("speed_squared") / 3.0,
            2.0 * rotation / axes,
        ]);
    }
    made.extend(last.into_flattened());
    Ok(made)
}
