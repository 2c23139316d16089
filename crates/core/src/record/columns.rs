//! The recorded variables of an impact, a row each. A new one is a new row of [`columns!`]: storage, blanks, the choice for a
//! run, the binding and the Dataset follow from it.

use super::variable::{Stored, Values, Variable, When};
use crate::drop::Plan;
use crate::drop::{Impact, Pose, StopReason};
use crate::law::{Law, Normal};
use crate::memory::{filled, zeros};
use crate::shape::AnyBody;
use crate::simd::LANES;
use crate::simd::elementary::angle_in_lanes;
use crate::{Error, Value};
use pulp::Simd;
use std::ops::Range;

/// The parameters that the size of the table follows from.
pub(crate) const ROOM: &str = "particles * impacts";

/// A row is `name: type { metadata } = |impact, plan| value`.
macro_rules! columns {
    ($($(#[$doc:meta])* $name:ident: $kind:ty { $($about:tt)* } = |$impact:ident, $plan:ident| $value:expr;)*) => {
        /// The variables of an impact.
        pub const PER_IMPACT: &[Variable] = &[$(
            Variable { $($about)*, ..Variable::named(stringify!($name), <$kind>::COMPONENTS) }
        ),*];

        /// The variables of an impact that a run records.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub struct Columns {
            $($(#[$doc])* pub $name: bool,)*
        }

        impl Columns {
            /// No variable.
            pub const NONE: Self = Self { $($name: false),* };

            /// The variables with these names.
            ///
            /// # Errors
            /// [`Error::Parameter`] for a name that is not in [`PER_IMPACT`].
            pub fn named<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Self, Error> {
                let mut chosen = Self::NONE;
                for name in names {
                    match name {
                        $(stringify!($name) => chosen.$name = true,)*
                        _ => {
                            let known = [$(stringify!($name)),*];
                            return Err(Error::Parameter {
                                name: "columns",
                                value: Value::Name(name.to_owned()),
                                allowed: format!("one of {}", known.join(", ")),
                            });
                        }
                    }
                }
                Ok(chosen)
            }

            /// The names of the chosen variables, in the order of [`PER_IMPACT`].
            pub fn names(&self) -> Vec<&'static str> {
                let chosen = [$((self.$name, stringify!($name))),*].into_iter();
                chosen.filter(|(chosen, _)| *chosen).map(|(_, name)| name).collect()
            }

            /// The variables that are recorded of a body under a law by default, with the full state at each impact if `state`.
            pub fn usual(body: AnyBody<'_>, law: &Law<'_>, state: bool) -> Self {
                let axis = matches!(body, AnyBody::Revolution(_));
                let recorded = |about: &Variable| match about.when {
                    When::Always => true,
                    When::HasAxis => axis,
                    When::HasNoAxis => !axis,
                    When::NormalVaries => !matches!(law.normal, Normal::Constant(_)),
                    When::StateAsked => state,
                    When::StateAskedOfAxis => state && axis,
                    When::StateAskedWithoutAxis => state && !axis,
                    When::HeightVaries | When::InSpace => false,
                };
                let mut about = PER_IMPACT.iter().map(recorded);
                Self { $($name: about.next() == Some(true)),* }
            }

            /// Memory for one impact, in bytes.
            pub fn bytes(&self) -> usize {
                0 $(+ if self.$name { size_of::<$kind>() } else { 0 })*
            }
        }

        /// Every impact of a run, in SI units. Tables are row-major of shape (particle, impact), with NaN (0 in flags)
        /// where there was no impact; those that were not chosen are empty. The other fields have one entry per particle.
        #[derive(Debug, Clone)]
        pub struct Records {
            pub(crate) columns: usize,
            chosen: Columns,
            /// Number of columns that hold impacts: all, or the length of the longest row if the run was cancelled. Columns beyond
            /// it are undefined.
            pub reached: usize,
            /// Numbers of the particles of the rows, where some particles had to be left out; otherwise empty.
            pub particle: Vec<i64>,
            /// True if a row is blank where there was no impact.
            pub(crate) settled: Vec<bool>,
            $($(#[$doc])* pub $name: Vec<$kind>,)*
            /// Number of impacts, per particle.
            pub impacts: Vec<i64>,
            /// [`StopReason`] as a number, per particle.
            pub stop_reason: Vec<i8>,
            /// θ at release in rad, per particle; NaN for bodies without an axis.
            pub release_angle: Vec<f64>,
            /// Attitude at release, per particle of a body without an axis.
            pub release_attitude: Vec<[f64; 4]>,
            /// Height of the centre of mass at release in m, per particle; empty if all were released from the same height.
            pub release_height: Vec<f64>,
            /// Azimuth of the axis at release in rad, per particle; empty if all were released at rest over a level plane.
            pub release_azimuth: Vec<f64>,
            /// Angular velocity at release in rad/s, per particle; empty in the same case.
            pub release_spin: Vec<[f64; 3]>,
        }

        impl Records {
            /// A table of zeros, whose pages are not touched yet: whoever fills a row blanks its end.
            pub(crate) fn new(particles: usize, impacts: usize, chosen: &Columns) -> Result<Self, Error> {
                let size = |chosen| if chosen { particles * impacts } else { 0 };
                Ok(Self {
                    columns: impacts,
                    chosen: *chosen,
                    reached: impacts,
                    particle: Vec::new(),
                    settled: zeros(ROOM, particles)?,
                    $($name: zeros(ROOM, size(chosen.$name))?,)*
                    impacts: zeros(ROOM, particles)?,
                    stop_reason: filled(ROOM, StopReason::Interrupted as i8, particles)?,
                    release_angle: filled(ROOM, f64::NAN, particles)?,
                    release_attitude: Vec::new(),
                    release_height: Vec::new(),
                    release_azimuth: Vec::new(),
                    release_spin: Vec::new(),
                })
            }

            /// Keeps the first `particles` rows, without touching memory that was not written to.
            pub(crate) fn truncate(&mut self, particles: usize) {
                $(self.$name.truncate(particles * self.columns);)*
                self.settled.truncate(particles);
                self.impacts.truncate(particles);
                self.stop_reason.truncate(particles);
                self.release_angle.truncate(particles);
            }

            /// Moves the row of a particle up to row `place`.
            pub(crate) fn move_up(&mut self, row: usize, place: usize) {
                let (start, impacts) = (row * self.columns, self.impacts[row] as usize);
                $(if !self.$name.is_empty() {
                    self.$name.copy_within(start..start + impacts, place * self.columns);
                })*
                self.impacts[place] = self.impacts[row];
                self.stop_reason[place] = self.stop_reason[row];
                self.release_angle[place] = self.release_angle[row];
                self.settled[place] = false;
            }

            /// All rows.
            pub(crate) fn block(&mut self) -> Block<'_> {
                Block {
                    columns: self.columns,
                    $($name: &mut self.$name,)*
                    settled: &mut self.settled,
                    impacts: &mut self.impacts,
                    stop_reason: &mut self.stop_reason,
                    release_angle: &mut self.release_angle,
                }
            }

            /// The recorded variables of the impacts with their values, which are moved out.
            pub fn per_impact(&mut self) -> Vec<(Variable, Values)> {
                let columns = [$(<$kind>::values(std::mem::take(&mut self.$name))),*];
                let chosen = [$(self.chosen.$name),*];
                let all = PER_IMPACT.iter().copied().zip(columns).zip(chosen);
                all.filter(|(_, chosen)| *chosen).map(|(column, _)| column).collect()
            }
        }

        /// The rows of some particles.
        pub(crate) struct Block<'a> {
            pub columns: usize,
            $($name: &'a mut [$kind],)*
            pub settled: &'a mut [bool],
            pub impacts: &'a mut [i64],
            pub stop_reason: &'a mut [i8],
            pub release_angle: &'a mut [f64],
        }

        impl<'a> Block<'a> {
            /// Splits off the first `particles` rows, or all if there are fewer.
            pub fn split(&mut self, particles: usize) -> Block<'a> {
                let particles = particles.min(self.impacts.len());
                let cells = particles * self.columns;
                Block {
                    columns: self.columns,
                    $($name: first(&mut self.$name, cells),)*
                    settled: first(&mut self.settled, particles),
                    impacts: first(&mut self.impacts, particles),
                    stop_reason: first(&mut self.stop_reason, particles),
                    release_angle: first(&mut self.release_angle, particles),
                }
            }

            /// Writes an impact of the particle in each active lane; row 0 is that of the particle `first`.
            #[inline(always)]
            pub fn record<S: Simd, P: Pose<S, K>, const K: usize>(
                &mut self,
                first: usize,
                impact: &Impact<S, P, K>,
                plan: &Plan<'_>,
            ) {
                // Lanes and cells, of which the lanes that have no impact are left out.
                let mut cells = [(0, 0); LANES];
                let mut count = 0;
                impact.active.each(|lane| {
                    let row = impact.particle.as_slice()[lane] as usize - first;
                    cells[count] = (lane, row * self.columns + impact.number.as_slice()[lane] as usize);
                    count += 1;
                });
                $(if !self.$name.is_empty() {
                    let ($impact, $plan) = (impact, plan);
                    let values: <$kind as Stored>::Lanes<S, K> = $value;
                    for &(lane, cell) in &cells[..count] {
                        self.$name[cell] = <$kind as Stored>::lane(&values, lane);
                    }
                })*
            }

            /// Fills these cells of a row with the value for no impact.
            pub fn blank(&mut self, row: usize, impacts: Range<usize>) {
                let start = row * self.columns;
                let cells = start + impacts.start..start + impacts.end;
                $(if let Some(cells) = self.$name.get_mut(cells.clone()) {
                    cells.fill(<$kind>::NONE);
                })*
            }
        }
    };
}

columns! {
    /// Time since release, in s.
    time: f64 { text: "time since release", unit: Some("s") } = |impact, plan| impact.time * plan.scales.time;

    /// v_G^n before the impact, in m/s.
    impact_velocity: f64 {
        text: "normal velocity of the centre of mass towards the plane, before the impact",
        unit: Some("m s-1"),
        symbol: Some("v_G^n")
    } = |impact, plan| impact.fall * plan.scales.speed;

    /// Normal velocity of the centre of mass after the impact, in m/s.
    rebound_velocity: f64 {
        text: "normal velocity of the centre of mass away from the plane, after the impact",
        unit: Some("m s-1")
    } = |impact, plan| impact.rise * plan.scales.speed;

    /// ε (1).
    restitution: f64 {
        text: "coefficient of restitution: rebound velocity over impact velocity (Eq. 1)",
        unit: Some("1"),
        symbol: Some("ε")
    } = |impact, _plan| impact.restitution();

    /// ε_n at the speed of the contact.
    microscopic: f64 {
        text: "normal coefficient of the law at the speed at which the contact approaches the plane",
        unit: Some("1"),
        symbol: Some("ε_n"),
        when: When::NormalVaries
    } = |impact, plan| plan.law.normal.apart(impact.approach);

    /// E_rot/E_tot before the impact (12).
    rotational_fraction: f64 {
        text: "rotational over total kinetic energy, before the impact (Eq. 12)",
        unit: Some("1"),
        symbol: Some("E_rot/E_tot")
    } = |impact, _plan| impact.rotational_fraction();

    /// Kinetic energy after the impact over that before.
    energy_ratio: f64 {
        text: "total kinetic energy after over before the impact",
        unit: Some("1")
    } = |impact, _plan| impact.energy_ratio();

    /// Angle between the axis and the plane normal, in rad.
    angle: f64 {
        text: "angle between symmetry axis and plane normal at the impact",
        unit: Some("rad"),
        symbol: Some("θ"),
        when: When::HasAxis
    } = |impact, _plan| {
        let (sine, cosine) = impact.pose.tilt();
        angle_in_lanes(sine, cosine)
    };

    /// 1 or 2: the sphere, or the half of a spheroid, that touched; 0: no impact.
    contact: i8 {
        text: "sphere or half that touched; the axis points to 1",
        meanings: &["none", "sphere_1", "sphere_2"],
        when: When::HasAxis
    } = |impact, _plan| impact.part;

    /// Number of the ball or vertex that touched, from 1; 0: no impact.
    part: i32 {
        name: "contact",
        text: "number of the ball or vertex that touched, from 1; 0: no impact",
        when: When::HasNoAxis
    } = |impact, _plan| impact.part;

    /// Height of the centre of mass at the impact, in m.
    height: f64 {
        text: "height of the centre of mass over the plane at the impact",
        unit: Some("m"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.height() * plan.scales.length;

    /// Symmetry axis at the impact, a unit vector from sphere 2 to sphere 1.
    axis: [f64; 3] {
        text: "unit vector of the symmetry axis at the impact, from sphere 2 to sphere 1",
        unit: Some("1"),
        symbol: Some("e"),
        when: When::StateAskedOfAxis
    } = |impact, _plan| impact.pose.axis();

    /// Attitude at the impact, the rotation from the axes of the body to those of space.
    attitude: [f64; 4] {
        text: "attitude at the impact, the rotation from the axes of the body to those of space as a quaternion",
        unit: Some("1"),
        symbol: Some("q"),
        when: When::StateAskedWithoutAxis
    } = |impact, _plan| impact.pose.attitude();

    /// v_G before the impact, in m/s.
    velocity_before: [f64; 3] {
        text: "velocity of the centre of mass before the impact",
        unit: Some("m s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.velocities()[0].times(plan.scales.speed);

    /// v_G after the impact, in m/s.
    velocity_after: [f64; 3] {
        text: "velocity of the centre of mass after the impact",
        unit: Some("m s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.velocities()[1].times(plan.scales.speed);

    /// ω before the impact, in rad/s.
    angular_velocity_before: [f64; 3] {
        text: "angular velocity before the impact",
        unit: Some("rad s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.spin_before().times(1.0 / plan.scales.time);

    /// ω after the impact, in rad/s.
    angular_velocity_after: [f64; 3] {
        text: "angular velocity after the impact",
        unit: Some("rad s-1"),
        when: When::StateAsked
    } = |impact, plan| impact.pose.spin_after().times(1.0 / plan.scales.time);
}

/// Splits off the first cells of a slice; of an empty slice, none.
fn first<'a, T>(slice: &mut &'a mut [T], cells: usize) -> &'a mut [T] {
    let whole = std::mem::take(slice);
    let (first, rest) = whole.split_at_mut(cells.min(whole.len()));
    *slice = rest;
    first
}
