//! The binding for the browser: it takes a run as a row of numbers and returns tables of numbers. It contains no physics, no threads
//! and no unsafe block; only the functions that the page calls are exported.
//!
//! The page writes `parameters::COUNT` numbers at [`run_parameters`], calls [`simulate`], [`follow`] or [`outline`], and reads the table
//! at [`table`], of as many numbers as the call returned. A call that fails returns −1, and [`message`] says why. What bodies and laws
//! there are, and with which parameters, [`describe`] says.
#![deny(unsafe_code)]

mod catalogue;
mod parameters;
mod path;
mod records;

use parameters::Parameters;
use restitution_core::Error;
use std::cell::RefCell;
use std::sync::atomic::{AtomicU64, Ordering};

/// The parameters, as the bits of `f64`, written by the page.
static PARAMETERS: [AtomicU64; parameters::COUNT] =
    [const { AtomicU64::new(0) }; parameters::COUNT];

thread_local! {
    static TABLE: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
    static MESSAGE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Runs `work` on the parameters and keeps the table that it makes. Returns the number of its entries, or −1 after an error.
fn keep(work: impl FnOnce(&Parameters) -> Result<Vec<f64>, Error>) -> f64 {
    let numbers = std::array::from_fn(|i| f64::from_bits(PARAMETERS[i].load(Ordering::Relaxed)));
    match work(&Parameters(numbers)) {
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

/// Address of the parameters.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn run_parameters() -> *const AtomicU64 {
    PARAMETERS.as_ptr()
}

/// Simulates `count` particles of the run from number `first` on; the table is that of `records::simulate`.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn simulate(first: usize, count: usize) -> f64 {
    keep(|parameters| records::simulate(&parameters.run()?, first, count))
}

/// Follows one particle in three dimensions; the table is that of `path::follow`.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn follow(particle: usize) -> f64 {
    keep(|parameters| path::follow(&parameters.run()?, particle))
}

/// The outline of the body: two rows, of the arcs at the ends of the axis, each centre, semi-axes along and across the axis, and the
/// angles from and to which the arc goes.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn outline() -> f64 {
    keep(|parameters| {
        let arcs = parameters.run()?.body.revolution()?.outline;
        Ok(arcs
            .iter()
            .flat_map(|arc| [arc.centre, arc.along, arc.across, arc.from, arc.to])
            .collect())
    })
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
