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
//! | r_G, v_G | [`State::lift`], [`State::velocity`] |
//! | ω | derived from the precession vector **Λ**/J_xx, [`State::precession`] |
//! | Â(t)·(0, 0, 1) | [`State::axis`], from sphere 2 to sphere 1 |
//! | L/2, J_xx, J_zz | [`Body::half_separation`], [`Body::transverse`], [`Body::axial`] |
//! | r_c, v_c | `arm`, `slip` in [`collision`] |
//! | ε_n, ε_t | [`Normal`], [`TangentialRestitution`] |
//!
//! # From the equation to the code
//! | equation | file |
//! |---|---|
//! | (1), (12) | `engine/impact.rs` |
//! | (2) | `body/hull/`, `search/` |
//! | (3)–(5) | `flight/` |
//! | (6)–(8), (11) | `engine/strike.rs` |
//! | (9), (10) | `collision/tangential.rs` |
//! | (18) | `run/orientation.rs` |
//! | (A1)–(A8) | `body/dumbbell.rs` |
//!
//! The first impact in closed form, (13)–(22), is in the Python package, `analytic/`.
#![forbid(unsafe_code)]

mod body;
pub mod collision;
mod columns;
pub mod distribution;
mod engine;
mod error;
mod flight;
mod follow;
mod memory;
mod particles;
mod random;
mod records;
mod run;
mod search;
mod simd;
mod simulate;
pub mod statistics;
mod threads;
mod variable;

pub use body::{
    Body, Dumbbell, LoadedSphere, Shape, Solid, Sphere, Spherocylinder, Spheroid, Surface,
};
pub use collision::{
    ChatterjeeRuina, Coulomb, Frictionless, Hypothesis, Law, Normal, Plastic, Points, Rule,
    Tabulated, TangentialRestitution, Viscoelastic,
};
pub use columns::{Columns, PER_IMPACT, Records};
pub use engine::{
    COLLAPSE_RUN, Departure, Landing, Limits, NoConvergence, SingleImpact, StopReason, collide,
    first_contact, trajectory,
};
pub use error::{Error, Value};
pub use flight::{State, Vector};
pub use follow::Followed;
pub use memory::{collected, copied};
pub use particles::PER_PARTICLE;
pub use run::{About, Height, Orientation, Run, Scales, Spin};
pub use simd::{Level, elementary};
pub use simulate::simulate_series;
pub use threads::{Means, Monitor, STACK, default_threads};
pub use variable::{Values, Variable, When};
