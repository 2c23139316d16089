//! Exact event-driven bouncing of aspherical bodies on a plane.
//!
//! Source of the model: A. Glielmo, N. Gunkelmann and T. Pöschel, *Coefficient of restitution of aspherical
//! particles*, Phys. Rev. E **90**, 052204 (2014). Equation numbers in this crate are that paper's.
//!
//! # Units
//! Inside the core lengths are measured in the sphere radius R (of the larger sphere; the longer semi-axis of a spheroid), times in √(R/g) and masses in the body's mass m.
//! Gravity is then 1 and a run depends on L/R, the release height over R, the law and nothing else; [`Scales`]
//! converts. Only [`Shape`]s, [`Solid`] and [`Scales`] know SI units.
//!
//! # Notation
//! | paper | here |
//! |---|---|
//! | n (plane normal), z | `z`, upward |
//! | r_G, v_G | [`State::height`], [`State::velocity`] |
//! | ω | [`State::spin`], derived from the precession vector **Λ**/J_xx, [`State::precession`] |
//! | Â(t)·(0, 0, 1) | [`State::axis`], from sphere 2 to sphere 1 |
//! | L/2, J_xx, J_zz | [`Body::half_separation`], [`Body::transverse`], [`Body::axial`] |
//! | r_c, v_c | `arm`, `slip` in [`collision`] |
//! | ε^n, ε^t | [`Normal`], [`TangentialRestitution`] |
//!
//! # From the equation to the code
//! | equation | file |
//! |---|---|
//! | (1), (12) | `trajectory.rs` |
//! | (2) | `contact.rs` |
//! | (3)–(5) | `flight.rs` |
//! | (6)–(8), (11) | `collision/mod.rs` |
//! | (9), (10) | `collision/tangential.rs` |
//! | (18) | `release.rs` |
//! | (A1)–(A8) | `body/dumbbell.rs` |
#![forbid(unsafe_code)]

mod body;
pub mod collision;
mod contact;
pub mod distribution;
pub mod elementary;
mod ensemble;
mod error;
mod flight;
mod lanes;
mod level;
mod plan;
mod random;
mod records;
mod release;
mod scales;
mod spatial;
mod spin;
mod state;
pub mod statistics;
mod trajectory;
mod vector;

pub use body::{
    Ball, Body, Dumbbell, Ellipsoid, Hull, LoadedSphere, Pair, Shape, Solid, Spherocylinder,
    Spheroid,
};
pub use collision::{
    ChatterjeeRuina, Coulomb, Frictionless, Hypothesis, Law, Normal, Plastic, Tabulated,
    TangentialRestitution, Viscoelastic,
};
pub use contact::{Departure, Landing, NoConvergence, first_contact};
pub use ensemble::{Means, Monitor, Run, default_threads};
pub use error::Error;
pub use flight::{Attitude, Flight};
pub use level::Level;
pub use records::Records;
pub use release::Orientation;
pub use scales::Scales;
pub use spin::{About, Spin};
pub use state::{Sphere, State};
pub use trajectory::{COLLAPSE_RUN, Impact, Limits, StopReason, bounce};
pub use vector::Vector;
