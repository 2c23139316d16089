//! The binding for the browser: it takes a run as a row of numbers and returns tables of numbers. It contains no physics, no threads
//! and no unsafe block; only the functions that the page calls are exported.
//!
//! The page writes numbers at [`parameters`], calls [`simulate`], [`follow`], [`meet`], [`survey`], [`cool`], [`outline`], [`farthest`] or [`turn`], and
//! reads the table at [`table`], of as many numbers as the call returned. A call that fails returns −1, and [`message`] says why. What bodies of revolution and laws
//! there are, and with which parameters, [`describe`] says.
#![deny(unsafe_code)]

mod catalogue;
mod gas;
mod pair;
mod parameters;
mod path;
mod records;
mod rigid;

use parameters::Parameters;
use restitution_core::gas::STATE;
use restitution_core::{AnyBody, Error, Run};
use std::cell::RefCell;
use std::sync::atomic::{AtomicU64, Ordering};

thread_local! {
    /// The numbers that the page writes, as the bits of `f64`.
    static PARAMETERS: RefCell<Vec<AtomicU64>> = const { RefCell::new(Vec::new()) };
    static TABLE: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
    static MESSAGE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// The numbers that the page has written.
fn given() -> Vec<f64> {
    let number = |bits: &AtomicU64| f64::from_bits(bits.load(Ordering::Relaxed));
    PARAMETERS.with_borrow(|all| all.iter().map(number).collect())
}

/// Keeps a table. Returns the number of its entries, or −1 after an error.
fn keep(made: Result<Vec<f64>, Error>) -> f64 {
    match made {
        Ok(table) => {
            let count = table.len() as f64;
            TABLE.set(table);
            count
        }
        Err(error) => {
            MESSAGE.set(error.to_string());
            -1.0
        }
    }
}

/// Runs `work` on the parameters of a run and keeps the table that it makes.
fn of_run(work: impl FnOnce(&Parameters<'_>) -> Result<Vec<f64>, Error>) -> f64 {
    keep(Parameters::read(&given()).and_then(|parameters| work(&parameters)))
}

/// Runs `work` on the run and the numbers behind its parameters, and keeps the table that it makes.
fn of_run_before<const N: usize>(
    given: &[f64],
    work: impl FnOnce(&Run<'_>, &[f64; N]) -> Result<Vec<f64>, Error>,
) -> f64 {
    let (run, behind) = given
        .split_last_chunk()
        .expect("numbers behind the parameters");
    keep(Parameters::read(run).and_then(|parameters| work(&parameters.run()?, behind)))
}

/// Address of the place for `count` numbers: `parameters::COUNT` of them, and behind these a body of any shape.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn parameters(count: usize) -> *const AtomicU64 {
    PARAMETERS.with_borrow_mut(|all| {
        all.resize_with(count, AtomicU64::default);
        all.as_ptr()
    })
}

/// Simulates `count` particles of the run from number `first` on; the table is that of `records::simulate`.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn simulate(first: usize, count: usize) -> f64 {
    of_run(|parameters| records::simulate(&parameters.run()?, first, count))
}

/// Follows one particle in three dimensions; the table is that of `path::follow`, for a body of any shape that of
/// `path::follow_rigid`.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn follow(particle: usize) -> f64 {
    of_run(|parameters| path::follow(&parameters.run()?, particle))
}

/// Follows one encounter of two such bodies; behind the parameters are `pair::NUMBERS` numbers. The table is that of `pair::meet`.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn meet(number: usize) -> f64 {
    of_run_before(&given(), |run, pairs| pair::meet(run, pairs, number))
}

/// Follows `count` of them from number `first` on; the table is that of `pair::survey`.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn survey(first: usize, count: usize) -> f64 {
    of_run_before(&given(), |run, pairs| {
        pair::survey(run, pairs, first, count)
    })
}

/// Follows a gas of such bodies; behind the parameters are `gas::NUMBERS` numbers, and behind these the states of as many particles as it
/// has, or of none. The table is that of `gas::cool`.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn cool(states: usize) -> f64 {
    let given = given();
    let (rest, states) = given.split_at(given.len() - states * STATE);
    of_run_before(rest, |run, start| gas::cool(run, start, states))
}

/// The outline of a body of revolution: two rows, of the arcs at the ends of the axis, each centre, semi-axes along and across the axis,
/// and the angles from and to which the arc goes. Of a body of any shape the table is that of `rigid::outline`.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn outline() -> f64 {
    of_run(|parameters| match parameters.run()?.body {
        AnyBody::Rigid(body) => rigid::outline(body),
        AnyBody::Revolution(solid) => Ok(solid
            .outline
            .iter()
            .flat_map(|arc| [arc.centre, arc.along, arc.across, arc.from, arc.to])
            .collect()),
    })
}

/// The table of `rigid::drawing`.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn drawing() -> f64 {
    keep(rigid::drawing(&given()[parameters::COUNT..]))
}

/// The table of `rigid::farthest` of a body of any shape, for `count` directions, which are behind it.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn farthest(count: usize) -> f64 {
    let given = given();
    let (run, directions) = given.split_at(given.len() - 3 * count);
    keep(
        Parameters::read(run).and_then(|parameters| match parameters.run()?.body {
            AnyBody::Rigid(body) => rigid::farthest(body, directions),
            AnyBody::Revolution(_) => Ok(Vec::new()),
        }),
    )
}

/// The free rotation of a body of any shape, of the fifteen numbers that `rigid::turned` takes.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn turn() -> f64 {
    let given = given();
    keep(Ok(rigid::turned(
        given.first_chunk().expect("fifteen numbers"),
    )))
}

/// Address of the table that the last call made.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn table() -> *const f64 {
    TABLE.with_borrow(Vec::as_ptr)
}

/// Writes the table of bodies, laws and materials, as JSON, where [`message`] is.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn describe() {
    MESSAGE.set(catalogue::json());
}

/// Address of the error message of the last call that failed, or of what [`describe`] wrote, in UTF-8.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn message() -> *const u8 {
    MESSAGE.with_borrow(|text| text.as_ptr())
}

/// Length of that message in bytes.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn message_length() -> usize {
    MESSAGE.with_borrow(String::len)
}
