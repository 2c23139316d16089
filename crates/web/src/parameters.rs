//! The parameters of a run as a row of numbers, in SI units, written by the page.

use crate::rigid;
use restitution_core::describe::{Allowed, Argument, Kind, Parameter};
use restitution_core::{
    AnyBody, BODIES, BodyKind, Error, LAWS, Law, Orientation, Rigid, Run, Solid, Spin, Vector,
};
use std::rc::Rc;

/// The number of these parameters that the page asks for: those before the ones that are usually left out.
pub const fn asked(parameters: &[Parameter]) -> usize {
    let mut count = 0;
    while count < parameters.len() && !parameters[count].is_optional() {
        count += 1;
    }
    count
}

/// Places for the parameters of a body, and of a law beside its normal coefficient: as many as one has.
pub const OF_BODY: usize = {
    let (mut most, mut i) = (0, 0);
    while i < BODIES.len() {
        if let BodyKind::Revolution(kind) = &BODIES[i] {
            let count = asked(kind.parameters);
            most = if count > most { count } else { most };
        }
        i += 1;
    }
    most
};
pub const OF_LAW: usize = {
    let (mut most, mut i) = (0, 0);
    while i < LAWS.len() {
        let count = asked(LAWS[i].kind.parameters);
        most = if count > most { count } else { most };
        i += 1;
    }
    most
};

/// Number of parameters: body and law with theirs, the normal coefficient, and sixteen of the run.
pub const COUNT: usize = 1 + OF_BODY + 1 + 1 + OF_LAW + 16;

/// The parameters, in the order of `web/src/engine/layout.ts`: the number of the body in the table of bodies, its parameters in their
/// order, and the same of the law; a name is given as its number. Places that are not needed may hold anything. The arguments of a rigid body
/// are behind them.
pub struct Parameters<'a> {
    row: &'a [f64],
    rigid: Option<Rc<Rigid>>,
}

/// The numbers that are not read yet.
struct Row<'a>(&'a [f64]);

impl<'a> Row<'a> {
    /// The next N of them.
    fn next<const N: usize>(&mut self) -> &'a [f64; N] {
        let (next, rest) = self
            .0
            .split_first_chunk()
            .expect("the row has COUNT numbers");
        self.0 = rest;
        next
    }

    fn number(&mut self) -> f64 {
        self.next::<1>()[0]
    }

    fn vector(&mut self) -> Vector {
        let &[x, y, z] = self.next();
        Vector::new(x, y, z)
    }
}

/// The entry of a table that a number names; the last one for all that are too large.
pub fn chosen<T>(table: &[T], number: f64) -> &T {
    &table[(number as usize).min(table.len() - 1)]
}

/// Makes a body or a law from numbers.
fn make<T>(kind: &Kind<T>, numbers: &[f64]) -> Result<T, Error> {
    let (shown, left_out) = kind.parameters.split_at(asked(kind.parameters));
    let given = shown
        .iter()
        .zip(numbers)
        .map(|(about, &number)| match about.allowed {
            Allowed::Name(names) => Argument::Name(chosen::<&'static str>(names, number)),
            _ => Argument::Number(number),
        });
    let arguments: Vec<_> = given
        .chain(left_out.iter().map(|_| Argument::Absent))
        .collect();
    (kind.make)(&arguments)
}

impl<'a> Parameters<'a> {
    /// The parameters at the beginning of these numbers, and the body behind them, if there is one.
    pub fn read(numbers: &'a [f64]) -> Result<Self, Error> {
        let (row, behind) = numbers.split_at(COUNT);
        let made = (!behind.is_empty()).then(|| rigid::body(behind));
        let rigid = made.transpose()?;
        Ok(Self { row, rigid })
    }

    /// The run, if the parameters of body and law are valid. The others are checked when the run starts.
    pub fn run(&self) -> Result<Run<'_>, Error> {
        let mut row = Row(self.row);
        let solid = body(&mut row);
        Ok(Run {
            body: match (&self.rigid, solid) {
                (Some(body), _) => AnyBody::Rigid(body),
                (None, solid) => solid.expect("a rigid body is behind")?.into(),
            },
            law: law(&mut row)?,
            particles: row.number() as usize,
            impacts: row.number() as usize,
            release_height: row.number().into(),
            gravity: row.number(),
            orientation: {
                let (kind, angle) = (row.number() as u32, row.next::<1>());
                match kind {
                    0 => Orientation::UniformAngle,
                    1 => Orientation::Isotropic,
                    _ => Orientation::Given(angle),
                }
            },
            spin: Spin::Fixed(row.vector()),
            release_velocity: row.vector(),
            incline: row.number(),
            minimum_speed: row.number(),
            settled: 0.0,
            // Two halves, because a double holds integers of 53 bits only.
            seed: (row.number() as u64) << 32 | row.number() as u64,
        })
    }
}

/// The body of revolution, if it is one; a rigid body is behind the parameters.
fn body(row: &mut Row<'_>) -> Option<Result<Solid, Error>> {
    let (kind, numbers) = (chosen(BODIES, row.number()), row.next::<OF_BODY>());
    match kind {
        BodyKind::Revolution(kind) => Some(make(kind, numbers)),
        BodyKind::Rigid(..) => None,
    }
}

fn law(row: &mut Row<'_>) -> Result<Law<'static>, Error> {
    let kind = &chosen(LAWS, row.number()).kind;
    let normal = row.number();
    Law::new(normal, make(kind, row.next::<OF_LAW>())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every number of the row is read.
    #[test]
    fn rows_are_read_to_the_end() {
        let mut row = [1.0; COUNT];
        row[COUNT - 1] = 7.0;
        row[COUNT - 2] = 3.0;
        let parameters = Parameters::read(&row).unwrap();
        assert_eq!(parameters.run().unwrap().seed, 3 << 32 | 7);
    }
}
