//! Exact event-driven bouncing of aspherical bodies on a plane.
//!
//! Source of the model: A. Glielmo, N. Gunkelmann and T. Pöschel, *Coefficient of restitution of aspherical
//! particles*, Phys. Rev. E **90**, 052204 (2014). Equation numbers in this crate are that paper's.
//!
//! # Units
//! Inside the core lengths are measured in the sphere radius R (of the larger sphere; the longer semi-axis of a spheroid),
//! times in √(R/g) and masses in the body's mass m. Gravity is then 1, and the motion of a dumbbell that is released from
//! rest depends on L/R, on the release height over R and on the law alone. SI units occur in the public parameters
//! ([`Shape`]s, [`Solid`], [`Law`], [`Run`]) and in the recorded tables; [`Scales`] converts.
//!
//! # Notation
//! | paper | here |
//! |---|---|
//! | n (plane normal), z | `z`, upward |
//! | r_G, v_G | [`State::height`], [`State::velocity`] |
//! | ω | derived from the precession vector **Λ**/J_xx, [`State::precession`] |
//! | Â(t)·(0, 0, 1) | [`State::axis`], from sphere 2 to sphere 1 |
//! | L/2, J_xx, J_zz | [`Body::half_separation`], [`Body::transverse`], [`Body::axial`] |
//! | r_c, v_c | `arm`, `slip` in [`law`] |
//! | ε_n, ε_t | [`Normal`], [`TangentialRestitution`] |
//!
//! # From the equation to the code
//! | equation | file |
//! |---|---|
//! | (1), (12) | `drop/lanes/impact.rs` |
//! | (2) | `shape/revolution/hull/`, `contact/` |
//! | (3)–(5) | `motion/` |
//! | (6)–(8), (11) | `drop/lanes/collision.rs` |
//! | (9), (10) | `law/tangential.rs` |
//! | (18) | `drop/release/orientation.rs` |
//! | (A1)–(A8) | `shape/revolution/dumbbell.rs` |
//!
//! The first impact in closed form, (13)–(22), is in the Python package, `analytic/`.
#![forbid(unsafe_code)]

mod contact;
pub mod describe;
pub mod distribution;
mod drop;
mod error;
pub mod gas;
pub mod law;
mod math;
mod memory;
mod motion;
pub mod pair;
mod random;
mod record;
mod shape;
mod simd;
mod simulate;
pub mod statistics;
mod threads;

pub use drop::{
    About, COLLAPSE_RUN, Height, Limits, Orientation, PER_IMPACT, PER_PARTICLE, Records, Run,
    Scales, Spin, StopReason,
};
#[cfg(feature = "one-lane")]
pub use drop::{
    FlightEnd, FlightStart, NoConvergence, SingleImpact, collide, first_contact, trajectory,
};
pub use error::{Error, Fault, Raised, Value};
pub use law::*;
pub use math::{Quaternion, Symmetric, Vector};
pub use memory::{collected, copied};
pub use motion::{Rotation, SpinBounds, State};
pub use record::{Columns, Element, Elements, Values, Variable, When};
pub use shape::*;
pub use simd::{Level, elementary};
pub use simulate::simulate_series;
pub use threads::{Monitor, Resources, STACK, default_threads};

/// Runs the example of the page.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;
