//! The table of all impacts of a run, filled row by row from many threads.

use crate::elementary::{angle, angle_in_lanes};
use crate::lanes::{Impact, Pack, Sink};
use crate::plan::Plan;
use crate::trajectory::StopReason;
use pulp::Simd;

/// Every impact of a run, in SI units. Tables are row-major of shape (particle, impact), with NaN (0 in `contact`) where
/// there was no impact; the rest has one entry a particle.
#[derive(Debug, Clone)]
pub struct Records {
    columns: usize,
    /// Time since release, in s.
    pub time: Vec<f64>,
    /// v_G^n before the impact, in m/s.
    pub impact_velocity: Vec<f64>,
    /// Normal velocity of the centre of mass after the impact, in m/s.
    pub rebound_velocity: Vec<f64>,
    /// ε (1).
    pub restitution: Vec<f64>,
    /// E_rot/E_tot before the impact (12).
    pub rotational_fraction: Vec<f64>,
    /// Kinetic energy after the impact over that before.
    pub energy_ratio: Vec<f64>,
    /// Angle between the axis and the plane normal, in rad.
    pub angle: Vec<f64>,
    /// 1 or 2: the sphere, or the half of a spheroid, that touched; 0: no impact.
    pub contact: Vec<i8>,
    /// Number of impacts, per particle.
    pub impacts: Vec<i64>,
    /// [`StopReason`] as a number, per particle.
    pub stop_reason: Vec<i8>,
    /// θ at release in rad, per particle.
    pub release_angle: Vec<f64>,
    /// Azimuth of the axis at release in rad, per particle; of none if all were let go at rest.
    pub release_azimuth: Vec<f64>,
    /// Angular velocity at release in rad/s, likewise.
    pub release_spin: Vec<[f64; 3]>,
}

impl Records {
    /// Zeros, which cost nothing yet: the rows are written, and blanked where no impact happened, by those who fill them.
    pub(crate) fn new(particles: usize, impacts: usize) -> Self {
        let table = || vec![0.0; particles * impacts];
        Self {
            columns: impacts,
            time: table(),
            impact_velocity: table(),
            rebound_velocity: table(),
            restitution: table(),
            rotational_fraction: table(),
            energy_ratio: table(),
            angle: table(),
            contact: vec![0; particles * impacts],
            impacts: vec![0; particles],
            stop_reason: vec![StopReason::Interrupted as i8; particles],
            release_angle: vec![f64::NAN; particles],
            release_azimuth: Vec::new(),
            release_spin: Vec::new(),
        }
    }

    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.impacts.len()
    }

    /// Keeps the first particles only. Memory that nobody wrote to is never touched.
    pub(crate) fn truncate(&mut self, particles: usize) {
        let tables = [
            &mut self.time,
            &mut self.impact_velocity,
            &mut self.rebound_velocity,
            &mut self.restitution,
            &mut self.rotational_fraction,
            &mut self.energy_ratio,
            &mut self.angle,
        ];
        for table in tables {
            table.truncate(particles * self.columns);
        }
        self.contact.truncate(particles * self.columns);
        self.impacts.truncate(particles);
        self.stop_reason.truncate(particles);
        self.release_angle.truncate(particles);
    }

    /// Adds how the particles were let go, where that is more than an angle.
    pub(crate) fn add_release(&mut self, plan: &Plan<'_>) {
        for particle in 0..self.particles() {
            let (azimuth, spin) = plan.start(particle);
            self.release_azimuth.push(azimuth);
            self.release_spin.push([spin.x, spin.y, spin.z]);
        }
    }

    /// The rows, one a particle.
    pub(crate) fn rows(&mut self) -> impl Iterator<Item = Row<'_>> {
        let n = self.columns;
        let velocities = self
            .impact_velocity
            .chunks_mut(n)
            .zip(self.rebound_velocity.chunks_mut(n));
        let ratios = self
            .restitution
            .chunks_mut(n)
            .zip(self.energy_ratio.chunks_mut(n));
        let fractions = self.rotational_fraction.chunks_mut(n);
        let geometry = self.angle.chunks_mut(n).zip(self.contact.chunks_mut(n));
        let ends = self.impacts.iter_mut().zip(&mut self.stop_reason);
        self.time
            .chunks_mut(n)
            .zip(velocities)
            .zip(ratios.zip(fractions))
            .zip(geometry)
            .zip(ends.zip(&mut self.release_angle))
            .map(
                |((((time, velocities), (ratios, fraction)), geometry), (end, release_angle))| {
                    Row {
                        time,
                        impact_velocity: velocities.0,
                        rebound_velocity: velocities.1,
                        restitution: ratios.0,
                        energy_ratio: ratios.1,
                        rotational_fraction: fraction,
                        angle: geometry.0,
                        contact: geometry.1,
                        impacts: end.0,
                        stop_reason: end.1,
                        release_angle,
                    }
                },
            )
    }
}

/// The part of [`Records`] that belongs to one particle.
pub(crate) struct Row<'a> {
    time: &'a mut [f64],
    impact_velocity: &'a mut [f64],
    rebound_velocity: &'a mut [f64],
    restitution: &'a mut [f64],
    rotational_fraction: &'a mut [f64],
    energy_ratio: &'a mut [f64],
    angle: &'a mut [f64],
    contact: &'a mut [i8],
    impacts: &'a mut i64,
    stop_reason: &'a mut i8,
    release_angle: &'a mut f64,
}

impl Row<'_> {
    /// Marks the impacts from number `first` on as never happened.
    pub(crate) fn blank(&mut self, first: usize) {
        let numbers = [
            &mut self.time,
            &mut self.impact_velocity,
            &mut self.rebound_velocity,
            &mut self.restitution,
            &mut self.rotational_fraction,
            &mut self.energy_ratio,
            &mut self.angle,
        ];
        for column in numbers {
            column[first..].fill(f64::NAN);
        }
    }
}

/// Takes the impacts of a block of particles into its rows.
pub(crate) struct Table<'a> {
    rows: Vec<Row<'a>>,
    plan: &'a Plan<'a>,
    /// The row of the particle in lane 0.
    first: usize,
}

impl<'a> Table<'a> {
    /// The rows of the particles from `particle` on.
    pub fn new(mut rows: Vec<Row<'a>>, plan: &'a Plan<'a>, particle: usize) -> Self {
        for (i, row) in rows.iter_mut().enumerate() {
            let (sine, cosine) = plan.release(particle + i);
            *row.release_angle = angle(sine, cosine);
        }
        Self {
            rows,
            plan,
            first: 0,
        }
    }
}

impl Sink for Table<'_> {
    fn begin(&mut self, first: usize) {
        self.first = first;
    }

    #[inline(always)]
    fn impact<S: Simd, const K: usize>(
        &mut self,
        number: usize,
        first: usize,
        impact: &Impact<S, K>,
    ) {
        let scales = &self.plan.scales;
        let time = impact.time * scales.time;
        let impact_velocity = impact.fall * scales.speed;
        let rebound_velocity = impact.rise * scales.speed;
        let restitution = impact.restitution();
        let fraction = impact.rotational_fraction();
        let energy_ratio = impact.energy_ratio();
        let angle = angle_in_lanes(impact.sine, impact.cosine);
        let sphere = impact.sphere.lt(0.0).select(2.0, 1.0_f64);
        let active = impact.active.select(1.0, 0.0_f64);
        for (lane, row) in self.rows[self.first + first..]
            .iter_mut()
            .enumerate()
            .take(Pack::<S, K>::WIDTH)
        {
            if active.as_slice()[lane] == 0.0 {
                continue;
            }
            row.time[number] = time.as_slice()[lane];
            row.impact_velocity[number] = impact_velocity.as_slice()[lane];
            row.rebound_velocity[number] = rebound_velocity.as_slice()[lane];
            row.restitution[number] = restitution.as_slice()[lane];
            row.rotational_fraction[number] = fraction.as_slice()[lane];
            row.energy_ratio[number] = energy_ratio.as_slice()[lane];
            row.angle[number] = angle.as_slice()[lane];
            row.contact[number] = sphere.as_slice()[lane] as i8;
        }
    }

    fn meanwhile(&mut self) {}

    fn end(&mut self, lane: usize, impacts: usize, reason: StopReason) {
        let row = &mut self.rows[self.first + lane];
        row.blank(impacts);
        *row.impacts = impacts as i64;
        *row.stop_reason = reason as i8;
    }
}
