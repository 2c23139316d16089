//! An independent reference of the whole simulation, in plain double precision and SI units.
//!
//! Nothing of the product is used but the types of its parameters, and little of its derivation: inertia by quadrature, the flight
//! of the top by Rodrigues' formula with the platform's sine, contacts by certified steps alone, K from the full tensor of
//! inertia by elimination, and each law from its definition; Coulomb's path is integrated step by step.
//!
//! OneBall impacts of a chaotic motion can only be compared as long as rounding has not grown too far. How far it has is
//! measured: [`Noise`] makes every number of the motion that is kept from one stage of an impact to the next wrong at random, in
//! several particles beside the one that is compared.

pub mod algebra;
pub mod cases;
pub mod compare;
pub mod flight;
pub mod friction;
pub mod impact;
pub mod normal;
pub mod random;
pub mod solid;

use algebra::{Vector, cross, norm, plus, times};
use flight::{Flight, FlightEnd, Leaving, State, energies, spin};
use impact::{Answer, Contact, Rule, response};
use normal::Restitution;
use random::Random;
use restitution_core::StopReason;
use solid::{Body, Shape};

/// A body, a law and a place to bounce: all in SI units.
#[derive(Debug, Clone, Copy)]
pub struct World {
    pub shape: Shape,
    pub rule: Rule,
    pub normal: Restitution,
    pub gravity: f64,
    pub incline: f64,
    pub minimum_speed: f64,
}

/// The release of a particle.
#[derive(Debug, Clone, Copy)]
pub struct Release {
    pub height: f64,
    pub velocity: Vector,
    pub angle: f64,
    pub azimuth: f64,
    pub spin: Vector,
}

/// Relative errors of this size and either sign, at random.
#[derive(Debug, Clone)]
pub struct Noise {
    pub size: f64,
    /// That of an impulse.
    pub impulse: f64,
    pub random: Random,
}

impl Noise {
    /// None.
    pub fn none() -> Self {
        Self {
            size: 0.0,
            impulse: 0.0,
            random: Random(0),
        }
    }

    fn factor(&mut self) -> f64 {
        1.0 + self.size * self.random.between(-1.0, 1.0)
    }

    fn of(&mut self, vector: Vector) -> Vector {
        vector.map(|x| x * self.factor())
    }
}

/// What is recorded of an impact, in the order of the tables of the product.
#[derive(Debug, Clone, Copy)]
pub struct Impact {
    pub columns: [f64; 7],
    pub contact: i8,
    /// True if the gap is resolved: the flight may have opened it, and the speed of approach closes it, by more than rounding does.
    pub resolved: bool,
}

/// A particle on its way.
pub struct Particle<'a> {
    world: &'a World,
    body: Body,
    state: State,
    leaving: Leaving,
    clock: f64,
    noise: Noise,
    /// Flights in a row that are too low to be resolved.
    low: u32,
}

impl<'a> Particle<'a> {
    pub fn new(world: &'a World, body: &Body, release: &Release, mut noise: Noise) -> Self {
        let Release {
            height,
            velocity,
            angle,
            azimuth,
            spin,
        } = *release;
        let axis = [
            angle.sin() * azimuth.cos(),
            angle.sin() * azimuth.sin(),
            angle.cos(),
        ];
        let body = body.blurred(|| noise.factor());
        let inertia = body.inertia(axis);
        let state = State {
            height: height * noise.factor(),
            velocity: noise.of(velocity),
            axis: unit(noise.of(axis)),
            momentum: noise.of(algebra::apply(&inertia, spin)),
        };
        Self {
            world,
            body,
            state,
            leaving: None,
            clock: 0.0,
            noise,
            low: 0,
        }
    }

    /// The next impact, or why there is none.
    pub fn next(&mut self) -> Result<Impact, StopReason> {
        let (world, body) = (self.world, &self.body);
        if let Some(reason) = self.ended() {
            return Err(reason);
        }
        let slope = [world.incline.sin(), 0.0, -world.incline.cos()];
        let flight = Flight {
            body,
            start: self.state,
            gravity: times(world.gravity, slope),
            bumps: [0; 2].map(|_| world.shape.size() * (self.noise.factor() - 1.0)),
        };
        let (time, part) = match flight.first_contact(self.leaving) {
            FlightEnd::Contact { time, part } => (time, part),
            FlightEnd::Resting => return Err(StopReason::Collapse),
            FlightEnd::Never => return Err(StopReason::NeverLands),
        };
        self.clock += time;
        let before = blurred(&mut self.noise, flight.at(time));
        let arm = body.lowest_point(part, before.axis);
        let contact = Contact {
            response: response(body.mass, &body.inertia(before.axis), arm),
            velocity: plus(before.velocity, cross(spin(body, &before), arm)),
        };
        let restitution = world.normal.at(contact.approach());
        let Answer {
            impulse,
            separation,
        } = contact.answer(&world.rule, restitution);
        let size = self.noise.impulse;
        let impulse = impulse.map(|x| x * (1.0 + size * self.noise.random.between(-1.0, 1.0)));
        let after = blurred(
            &mut self.noise,
            State {
                height: -arm[2],
                velocity: plus(before.velocity, times(1.0 / body.mass, impulse)),
                momentum: plus(before.momentum, cross(arm, impulse)),
                ..before
            },
        );
        let bound = flight.bound();
        let visible = UNRESOLVED * world.shape.size();
        let high = bound * time * time >= 8.0 * visible;
        self.low = if high { 0 } else { self.low + 1 };
        // f ≤ v²/2M where a gap that bends by no more than M has closed to f = 0 at the speed v.
        let resolved = high && contact.approach().powi(2) >= 2.0 * bound * visible;
        self.leaving = Some((part, separation));
        self.state = after;

        let (moving, turning) = energies(body, &before);
        let (moving_after, turning_after) = energies(body, &after);
        let axis = before.axis;
        Ok(Impact {
            columns: [
                self.clock,
                -before.velocity[2],
                after.velocity[2],
                after.velocity[2] / -before.velocity[2], // (1)
                turning / (moving + turning),            // (12)
                (moving_after + turning_after) / (moving + turning),
                axis[0].hypot(axis[1]).atan2(axis[2]),
            ],
            contact: body.name(part, axis),
            resolved,
        })
    }

    /// True if nothing comes after the last impact.
    pub fn ended(&self) -> Option<StopReason> {
        self.leaving?;
        let (moving, turning) = energies(&self.body, &self.state);
        let speed = (2.0 * (moving + turning) / self.body.mass).sqrt();
        if speed < self.world.minimum_speed {
            return Some(StopReason::SpeedBelowThreshold);
        }
        (self.low == 16).then_some(StopReason::Collapse)
    }
}

fn blurred(noise: &mut Noise, state: State) -> State {
    State {
        height: state.height,
        velocity: noise.of(state.velocity),
        axis: unit(noise.of(state.axis)),
        momentum: noise.of(state.momentum),
    }
}

/// Sixteen flights in a row in which no gap can have opened by this part of the radius are a collapse. It is 16 times the noise.
const UNRESOLVED: f64 = 1.0 / 8_796_093_022_208.0;

fn unit(a: Vector) -> Vector {
    times(1.0 / norm(a), a)
}
