//! The recorded variables of a particle.

use super::{Records, Values, Variable, When};
use crate::drop::StopReason;

/// The variables of a particle; [`Variable::when`] says in which runs each is recorded.
pub const PER_PARTICLE: [Variable; 7] = [
    Variable {
        name: "impacts",
        text: "number of impacts",
        ..Variable::PLAIN
    },
    Variable {
        name: "stop_reason",
        text: "why the trajectory ended",
        meanings: &StopReason::NAMES,
        ..Variable::PLAIN
    },
    Variable {
        name: "release_angle",
        text: "angle between symmetry axis and plane normal at release",
        unit: Some("rad"),
        when: When::HasAxis,
        ..Variable::PLAIN
    },
    Variable {
        name: "release_attitude",
        text: "attitude at release, the rotation from the axes of the body to those of space as a quaternion",
        unit: Some("1"),
        symbol: Some("q"),
        components: &["w", "x", "y", "z"],
        when: When::HasNoAxis,
        ..Variable::PLAIN
    },
    Variable {
        name: "release_height",
        text: "height of the centre of mass over the plane at release",
        unit: Some("m"),
        when: When::HeightVaries,
        ..Variable::PLAIN
    },
    Variable {
        name: "release_azimuth",
        text: "azimuth of the symmetry axis at release, from x towards y",
        unit: Some("rad"),
        symbol: Some("φ"),
        when: When::InSpace,
        ..Variable::PLAIN
    },
    Variable {
        name: "release_spin",
        text: "angular velocity at release",
        unit: Some("rad s-1"),
        symbol: Some("ω"),
        components: &["x", "y", "z"],
        when: When::InSpace,
        ..Variable::PLAIN
    },
];

impl Records {
    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.impacts.len()
    }

    /// The recorded variables of the particles with their values, which are moved out; a vector has three numbers per particle.
    pub fn per_particle(&mut self) -> Vec<(Variable, Values)> {
        use std::mem::take;
        let axes = self.release_attitude.is_empty();
        let columns = [
            Values::Counts(take(&mut self.impacts)),
            Values::Flags(take(&mut self.stop_reason)),
            Values::Numbers(take(&mut self.release_angle)),
            Values::Numbers(take(&mut self.release_attitude).into_flattened()),
            Values::Numbers(take(&mut self.release_height)),
            Values::Numbers(take(&mut self.release_azimuth)),
            Values::Numbers(take(&mut self.release_spin).into_flattened()),
        ];
        let known = PER_PARTICLE.iter().copied().zip(columns);
        let asked = known.filter(|(about, values)| match about.when {
            When::Always => true,
            When::HasAxis => axes,
            _ => !values.is_empty(),
        });
        asked.collect()
    }
}
