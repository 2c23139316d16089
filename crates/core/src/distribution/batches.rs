//! Impacts that are counted in batches of particles, whose scatter gives the uncertainty of the counts.

use crate::{Error, Monitor, Resources};
use std::ops::Range;
use std::sync::Mutex;

/// The most impacts of a particle that are counted between two checks for a cancellation.
pub(super) const STRIDE: usize = 1 << 10;

/// Impacts of some particles, a row each: row-major tables of shape (particle, impact), with NaN where there was no impact.
#[derive(Debug, Clone, Copy)]
pub struct Impacts<'a> {
    velocity: &'a [f64],
    restitution: &'a [f64],
    condition: Option<&'a [f64]>,
    /// Number of impacts in a row.
    columns: usize,
    /// Number of the first particle: particle i belongs to batch i modulo the number of batches.
    first: usize,
}

impl<'a> Impacts<'a> {
    /// Impact velocities in m/s, ε and, if there are any, conditions, with `columns` impacts of a particle; the first row is that of
    /// the particle `first`.
    ///
    /// # Errors
    /// [`Error::Parameter`] if the tables do not have the same number of whole rows.
    pub fn new(
        velocity: &'a [f64],
        restitution: &'a [f64],
        condition: Option<&'a [f64]>,
        columns: usize,
        first: usize,
    ) -> Result<Self, Error> {
        let size = velocity.len();
        let allowed = "as many as impact velocities";
        let number = restitution.len();
        Error::unless(number == size, "restitution", number, allowed)?;
        let number = condition.map_or(size, <[f64]>::len);
        Error::unless(number == size, "condition", number, allowed)?;
        let whole = columns > 0 && size.is_multiple_of(columns);
        let allowed = "a divisor of the number of impact velocities";
        Error::unless(whole, "columns", columns, allowed)?;
        Ok(Self {
            velocity,
            restitution,
            condition,
            columns,
            first,
        })
    }

    /// v, ε and z of the impact in a cell of the table; z is 0 where there are no conditions.
    #[inline]
    pub(super) fn at(&self, cell: usize) -> (f64, f64, f64) {
        let z = self.condition.map_or(0.0, |condition| condition[cell]);
        (self.velocity[cell], self.restitution[cell], z)
    }

    /// Calls `count` for every batch with the cells of its impacts, in their order. Each batch is counted on one thread, so that
    /// sums of rounded numbers do not depend on the number of threads. What a thread has of its `own` is given back at its end.
    pub(super) fn count_in<B: Send, T>(
        &self,
        batches: &mut [B],
        (resources, monitor): (Resources, &Monitor),
        own: impl Fn() -> Result<T, Error> + Sync,
        give: impl Fn(T) + Sync,
        count: impl Fn(&mut B, &mut T, Range<usize>) + Sync,
    ) -> Result<(), Error> {
        let number = batches.len();
        let rows = self.velocity.len() / self.columns;
        let queue = Mutex::new(batches.iter_mut().enumerate());
        let ended = resources.each_thread(number, |_| {
            let mut mine = own()?;
            while !monitor.is_cancelled() {
                let next = queue.lock().expect("nobody panics who holds it").next();
                let Some((place, batch)) = next else { break };
                let row = (place + number - self.first % number) % number;
                for row in (row..rows).step_by(number) {
                    let end = (row + 1) * self.columns;
                    for start in (row * self.columns..end).step_by(STRIDE) {
                        if !monitor.is_cancelled() {
                            count(batch, &mut mine, start..end.min(start + STRIDE));
                        }
                    }
                }
            }
            give(mine);
            Ok(())
        })?;
        ended.into_iter().collect()
    }
}
