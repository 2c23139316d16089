//! The recorded variables of an encounter and of a contact, in SI units.

use super::encounter::{Ending, Hit, Outcome};
use super::partner::{Approach, FreeBody, PairState, Partner};
use crate::Error;
use crate::math::{Quaternion, Vector};
use crate::record::{Columns, TableColumns, Values, Variable, When, variables};
use crate::simd::elementary::angle;

/// An encounter that was followed.
pub(super) struct Encountered<'a> {
    before: &'a [PairState; 2],
    outcome: Outcome,
    /// Before and after, the energies of translation and of rotation of both.
    energies: [[[f64; 2]; 2]; 2],
    deflection: f64,
    /// Of the first contact, the normal speed of the points and that of the centres; and ε of the centres, of the contact and of the energy. NaN without one.
    speeds: [f64; 2],
    coefficients: [f64; 3],
}

impl<'a> Encountered<'a> {
    #[inline(always)]
    pub fn new(
        bodies: [&Partner; 2],
        before: &'a [PairState; 2],
        approach: &Approach,
        end: &Outcome<FreeBody>,
        first: Option<&Hit>,
    ) -> Self {
        let [one, two] = bodies;
        let outcome = end.given(bodies);
        let energies = [&approach.states, &end.states].map(|[a, b]| {
            let translation = [
                one.translational_energy(a.velocity),
                two.translational_energy(b.velocity),
            ];
            [
                translation,
                [a.rotational_energy(one), b.rotational_energy(two)],
            ]
        });
        let relative = |states: &[PairState; 2]| states[0].velocity - states[1].velocity;
        let (u, later) = (relative(before), relative(&outcome.states));
        let sizes = u.norm() * later.norm();
        let (sine, cosine) = (u.cross(later).norm() / sizes, u.dot(later) / sizes);
        let reduced = 1.0 / (one.inverse_mass + two.inverse_mass);
        let energy = |u: Vector, [_, [a, b]]: [[f64; 2]; 2]| 0.5 * reduced * u.dot(u) + a + b;
        let (speeds, coefficients) = match first {
            None => ([f64::NAN; 2], [f64::NAN; 3]),
            Some(hit) => {
                let along = hit.apart / hit.apart.norm();
                let closing = -hit.velocity.dot(along);
                let centres = if two.is_plane() {
                    -later.z / u.z
                } else {
                    later.dot(along) / closing
                };
                let whole = energy(later, energies[1]) / energy(u, energies[0]);
                let [towards, apart] = hit.speeds;
                ([towards, closing], [centres, apart / towards, whole.sqrt()])
            }
        };
        Self {
            before,
            outcome,
            energies,
            deflection: if sizes > 0.0 {
                angle(sine, cosine)
            } else {
                f64::NAN
            },
            speeds,
            coefficients,
        }
    }
}

/// Something of both bodies.
#[inline(always)]
fn both<T, const N: usize>([one, two]: &[T; 2], of: impl Fn(&T) -> [f64; N]) -> [[f64; N]; 2] {
    [of(one), of(two)]
}

variables! {
    /// The variables of an encounter; those whose [`Variable::when`] asks for the state need it to be asked for.
    PER_ENCOUNTER: ['a] Encountered<'a>, ();

    contacts: i64 { text: "number of contacts" } = |found, _| found.outcome.contacts as i64;

    ending: i8 {
        text: "how the encounter ended",
        meanings: &Ending::NAMES
    } = |found, _| found.outcome.ending as i8;

    duration: f64 { text: "time from the beginning to the end", unit: Some("s") } = |found, _| found.outcome.time;

    steps: f64 { text: "times at which the search looked at the bodies" } = |found, _| found.outcome.steps as f64;

    deflection: f64 {
        text: "angle between the relative velocities before and after",
        unit: Some("rad")
    } = |found, _| found.deflection;

    contact_speed: f64 {
        text: "normal speed of the points of the first contact before it, towards each other",
        unit: Some("m s-1")
    } = |found, _| found.speeds[0];

    centre_speed: f64 {
        text: "speed of the centres of mass along their line before the first contact, towards each other",
        unit: Some("m s-1")
    } = |found, _| found.speeds[1];

    restitution_centres: f64 {
        text: "-(u'.k)/(u.k), u the relative velocity of the centres before the first contact and after the encounter, k their line at the first contact",
        unit: Some("1")
    } = |found, _| found.coefficients[0];

    restitution_contact: f64 {
        text: "-(v'.n)/(v.n), v the relative velocity of the points of the first contact before and after it, n its normal",
        unit: Some("1")
    } = |found, _| found.coefficients[1];

    restitution_energy: f64 {
        text: "(E'/E)^(1/2), E the kinetic energy before and after, in the frame of the centre of mass",
        unit: Some("1")
    } = |found, _| found.coefficients[2];

    translational_energy_before: [[f64; 1]; 2] {
        text: "kinetic energy of the centre of mass of each body before",
        unit: Some("J")
    } = |found, _| both(&found.energies[0][0], |&energy| [energy]);

    translational_energy_after: [[f64; 1]; 2] {
        text: "kinetic energy of the centre of mass of each body after",
        unit: Some("J")
    } = |found, _| both(&found.energies[1][0], |&energy| [energy]);

    rotational_energy_before: [[f64; 1]; 2] {
        text: "kinetic energy of the rotation of each body before",
        unit: Some("J")
    } = |found, _| both(&found.energies[0][1], |&energy| [energy]);

    rotational_energy_after: [[f64; 1]; 2] {
        text: "kinetic energy of the rotation of each body after",
        unit: Some("J")
    } = |found, _| both(&found.energies[1][1], |&energy| [energy]);

    velocity_before: [[f64; 3]; 2] {
        text: "velocity of the centre of mass of each body before",
        unit: Some("m s-1")
    } = |found, _| both(found.before, |body| body.velocity.parts());

    velocity_after: [[f64; 3]; 2] {
        text: "velocity of the centre of mass of each body after",
        unit: Some("m s-1")
    } = |found, _| both(&found.outcome.states, |body| body.velocity.parts());

    angular_velocity_before: [[f64; 3]; 2] {
        text: "angular velocity of each body before",
        unit: Some("rad s-1")
    } = |found, _| both(found.before, |body| body.spin.parts());

    angular_velocity_after: [[f64; 3]; 2] {
        text: "angular velocity of each body after",
        unit: Some("rad s-1")
    } = |found, _| both(&found.outcome.states, |body| body.spin.parts());

    position_before: [[f64; 3]; 2] {
        text: "centre of mass of each body before",
        unit: Some("m"),
        when: When::StateAsked
    } = |found, _| both(found.before, |body| body.position.parts());

    position_after: [[f64; 3]; 2] {
        text: "centre of mass of each body after",
        unit: Some("m"),
        when: When::StateAsked
    } = |found, _| both(&found.outcome.states, |body| body.position.parts());

    attitude_before: [[f64; 4]; 2] {
        text: "rotation from the axes of each body to those of space before",
        unit: Some("1"),
        when: When::StateAsked
    } = |found, _| both(found.before, |body| body.attitude.parts());

    attitude_after: [[f64; 4]; 2] {
        text: "rotation from the axes of each body to those of space after",
        unit: Some("1"),
        when: When::StateAsked
    } = |found, _| both(&found.outcome.states, |body| body.attitude.parts());
}

variables! {
    /// The variables of a contact.
    PER_CONTACT: [] Hit, ();

    time: f64 { text: "time since the beginning of the encounter", unit: Some("s") } = |hit, _| hit.time;

    normal: [f64; 3] { text: "unit vector from the second body to the first", unit: Some("1") } = |hit, _| hit.normal.parts();

    point: [f64; 3] { text: "point of contact", unit: Some("m") } = |hit, _| hit.point.parts();

    impulse: [f64; 3] { text: "impulse on the first body", unit: Some("N s") } = |hit, _| hit.impulse.parts();

    approach_speed: f64 {
        text: "normal speed of the points of contact before, towards each other",
        unit: Some("m s-1")
    } = |hit, _| hit.speeds[0];

    separation_speed: f64 {
        text: "normal speed of the points of contact after, from each other",
        unit: Some("m s-1")
    } = |hit, _| hit.speeds[1];
}

/// Recorded encounters, and their contacts one after the other, if these were asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct PairTable {
    pub(super) encounters: TableColumns,
    /// The contacts.
    pub hits: Vec<Hit>,
}

impl PairTable {
    /// A copy of the values of a variable of the encounters as numbers; none if it was not recorded.
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        self.encounters.numbers(name).unwrap_or_default()
    }

    /// The states `"before"` or `"after"` each encounter, if they were recorded.
    pub fn states(&self, when: &str) -> Vec<[PairState; 2]> {
        let numbers = |name| self.numbers(&format!("{name}_{when}"));
        let columns = ["position", "velocity", "angular_velocity"]
            .map(|name| numbers(name).as_chunks::<3>().0.to_vec());
        let attitudes = numbers("attitude");
        let state = |i: usize, &[w, x, y, z]: &[f64; 4]| {
            let [position, velocity, spin] = [0, 1, 2].map(|k| Vector::from(columns[k][i]));
            PairState {
                position,
                velocity,
                attitude: Quaternion::new(w, x, y, z),
                spin,
            }
        };
        let pairs = attitudes.as_chunks().0.as_chunks::<2>().0.iter();
        pairs
            .enumerate()
            .map(|(i, [one, two])| [state(2 * i, one), state(2 * i + 1, two)])
            .collect()
    }

    /// The recorded variables of the encounters with their values, which are moved out.
    pub fn per_encounter(&mut self) -> Vec<(Variable, Values)> {
        self.encounters.take()
    }

    /// The variables of the contacts of these encounters.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn per_contact(&self) -> Result<Vec<(Variable, Values)>, Error> {
        let all = Columns::chosen(PER_CONTACT, |_| true);
        let mut table = TableColumns::new("contacts", PER_CONTACT, &all, self.hits.len(), 1)?;
        let mut rows = table.rows();
        for (row, hit) in self.hits.iter().enumerate() {
            hit.write(&(), &mut rows.columns, &[(0, row)]);
        }
        Ok(table.take())
    }
}
