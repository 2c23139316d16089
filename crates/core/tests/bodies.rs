//! Every shape: no contact missed and none invented, the balances at an impact, and the limits in which shapes coincide.

use crate::common::*;
use crate::scalar::*;
use proptest::prelude::*;
use restitution_core::collide;
use restitution_core::{
    Body, Dumbbell, FlightEnd, Law, LoadedSphere, Shape, Solid, Sphere, Spherocylinder, Spheroid,
    State, Surface, Vector,
};

/// A shape with what the tests know of its outside by themselves.
#[derive(Debug, Clone)]
struct Case {
    body: Body,
    outside: Outside,
}

#[derive(Debug, Clone)]
enum Outside {
    /// Offset from the centre of mass, and radius.
    Balls(Vec<(f64, f64)>),
    /// Equatorial and polar semi-axis.
    Spheroid(f64, f64),
}

impl Case {
    /// Height of the lowest point above the plane where the axis is `axis` and the centre of mass at `height`.
    fn clearance(&self, height: f64, axis: Vector) -> f64 {
        match &self.outside {
            Outside::Balls(balls) => balls
                .iter()
                .map(|&(offset, radius)| height + offset * axis.z - radius)
                .fold(f64::INFINITY, f64::min),
            Outside::Spheroid(a, c) => height - (a * axis.horizontal()).hypot(c * axis.z),
        }
    }

    /// From the centre of mass to the lowest point; of `sphere` where there are two.
    fn arm(&self, axis: Vector, sphere: Sphere) -> Vector {
        match &self.outside {
            Outside::Balls(balls) => {
                let (offset, radius) = balls[(sphere as usize).min(balls.len() - 1)];
                axis * offset - Vector::new(0.0, 0.0, radius)
            }
            // The point whose normal is down, from the matrix a² + (c² − a²)ee, whose quadratic form is h².
            Outside::Spheroid(a, c) => {
                let down = Vector::new(0.0, 0.0, -1.0);
                let point = down * (a * a) + axis * ((c * c - a * a) * axis.dot(down));
                point / point.dot(down).sqrt()
            }
        }
    }

    /// The largest distance of a point from the centre of mass, or how fast heights change with e_z at most.
    fn size(&self) -> f64 {
        match &self.outside {
            Outside::Balls(balls) => balls.iter().map(|b| b.0.abs() + b.1).fold(0.0, f64::max),
            Outside::Spheroid(a, c) => (a / c).max(1.0),
        }
    }

    /// Velocity of the point of contact, (7), (8).
    fn contact_velocity(&self, state: &State, sphere: Sphere) -> Vector {
        state.velocity + state.spin(&self.body).cross(self.arm(state.axis, sphere))
    }

    /// The lowest point at a time of a flight: the parabola, and the axis turned about **Λ** by Rodrigues' formula.
    fn flying(&self, start: &State, time: f64) -> f64 {
        let rate = start.precession.norm();
        let axis = if rate == 0.0 {
            start.axis
        } else {
            let about = start.precession / rate;
            let (sin, cos) = (rate * time).sin_cos();
            start.axis * cos
                + about.cross(start.axis) * sin
                + about * (about.dot(start.axis) * (1.0 - cos))
        };
        let height = start.height + self.body.hull.level() + time * (start.velocity.z - 0.5 * time);
        self.clearance(height, axis)
    }

    /// Sixteen roundings of the largest terms of [`Case::flying`] and of the engine's own.
    fn tolerance(&self, start: &State, time: f64, fastest: f64) -> f64 {
        let path = start.velocity.z.abs() * time + time * time + start.height.abs();
        let turning = self.size() * (1.0 + start.precession.norm() * time);
        16.0 * f64::EPSILON * (1.0 + turning + path + fastest)
    }
}

/// A dumbbell of any two spheres, from nearly alike to one within the other, of any two densities.
fn unequal() -> impl Strategy<Value = Case> {
    let alike = prop_oneof![1 => Just(1.0), 1 => 0.999..1.001_f64, 4 => magnitude(-1.5, 1.5)];
    let distance = prop_oneof![1 => Just(0.0), 1 => magnitude(-6.0, -1.0), 4 => 0.0..3.0_f64];
    (alike, magnitude(-2.0, 2.0), distance).prop_map(|(two, density, distance)| {
        let separation = distance * (1.0_f64 + two);
        let solid = Dumbbell::unequal([1.0, two], separation, [1.0, density])
            .unwrap()
            .solid();
        let body = solid.scaled;
        // Of the two centres one is known from the hull, whatever it is; the other one is L away.
        let [one, two, l] = [1.0, two, separation].map(|x| x / solid.unit);
        let engulfed = two > one && two - one >= l;
        let s = body.hull.lever(Sphere::One, 0.0) + if engulfed { l } else { 0.0 };
        let outside = Outside::Balls(vec![(s, one), (s - l, two)]);
        Case { body, outside }
    })
}

fn loaded() -> impl Strategy<Value = Case> {
    let load = prop_oneof![1 => Just(0.0), 4 => magnitude(-3.0, 3.0)];
    (load, 0.0..1.0_f64).prop_map(|(load, offset)| {
        let body = LoadedSphere::new(1.0, 0.75 / std::f64::consts::PI, load, offset).unwrap();
        // The sphere weighs 1.
        let centre = -load * offset / (1.0 + load);
        Case {
            body: body.solid().scaled,
            outside: Outside::Balls(vec![(centre, 1.0)]),
        }
    })
}

fn spherocylinder() -> impl Strategy<Value = Case> {
    elongation().prop_map(|l| Case {
        body: Spherocylinder::new(1.0, l, 1.0).unwrap().solid().scaled,
        outside: Outside::Balls(vec![(0.5 * l, 1.0), (-0.5 * l, 1.0)]),
    })
}

/// Needles and discs, and what is nearly round.
fn spheroid() -> impl Strategy<Value = Case> {
    let aspect = prop_oneof![
        1 => Just(1.0), 1 => 0.999_999..1.000_001_f64, 4 => magnitude(-1.0, 1.0), 2 => magnitude(-3.0, 3.0)
    ];
    aspect.prop_map(|c| Case {
        body: Spheroid::new(1.0, c, 1.0).unwrap().solid().scaled,
        outside: Outside::Spheroid(1.0_f64.min(1.0 / c), 1.0_f64.min(c)),
    })
}

fn shape() -> impl Strategy<Value = Case> {
    prop_oneof![3 => unequal(), 1 => loaded(), 1 => spherocylinder(), 3 => spheroid()]
}

/// A shape, a law and a state above the plane, with any spin.
fn motion_of(
    shape: impl Strategy<Value = Case>,
) -> impl Strategy<Value = (Case, Law<'static>, State)> {
    let velocity = (
        direction(),
        prop_oneof![1 => Just(0.0), 4 => magnitude(-6.0, 1.3)],
    );
    let spin = (
        direction(),
        prop_oneof![1 => Just(0.0), 4 => magnitude(-6.0, 2.0)],
    );
    let space = prop_oneof![1 => Just(0.0), 2 => magnitude(-14.0, 0.0), 3 => 0.0..40.0_f64];
    (shape, coefficients(), direction(), velocity, spin, space).prop_map(
        |(case, (normal, tangential), axis, (v, speed), (w, rate), space)| {
            let height = case.body.hull.support(axis.z) + space;
            // The rim moves at `rate`, so that needles and discs do not make a million turns a flight.
            let rate = rate / case.size();
            let state = State::with_spin(&case.body, height, v * speed, axis, w * rate);
            (case, law(normal, tangential), state)
        },
    )
}

/// The smallest clearance within a flight: sampled, and refined around every local minimum.
fn deepest(case: &Case, start: &State, time: f64, samples: usize) -> f64 {
    let at = |i: usize| time * i as f64 / samples as f64;
    let gaps: Vec<f64> = (0..=samples).map(|i| case.flying(start, at(i))).collect();
    let mut deepest = f64::INFINITY;
    for i in 1..samples {
        deepest = deepest.min(gaps[i]);
        if gaps[i] <= gaps[i - 1] && gaps[i] <= gaps[i + 1] {
            let (mut low, mut high) = (at(i - 1), at(i + 1));
            for _ in 0..40 {
                let third = (high - low) / 3.0;
                let (a, b) = (
                    case.flying(start, low + third),
                    case.flying(start, high - third),
                );
                deepest = deepest.min(a).min(b);
                if a < b { high -= third } else { low += third }
            }
        }
    }
    deepest
}

proptest! {
    #![proptest_config(cases(1500))]

    /// Between two impacts no part of the body is below the plane, sampled more closely than its outline turns; at an impact
    /// its lowest point is on the plane, and comes down.
    #[test]
    fn no_contact_is_missed_and_none_invented((case, law, release) in motion_of(shape())) {
        let mut fastest = 0.0_f64;
        for leg in legs(&case.body, &law, release, 10) {
            let (start, impact) = (&leg.start, &leg.impact);
            fastest = fastest.max(energy(start, &case.body).abs());
            let allowed = case.tolerance(start, leg.time, fastest);
            let turns = case.size().min(30.0) * start.precession.norm() * leg.time;
            let gap = deepest(&case, start, leg.time, 400 + (4.0 * turns) as usize);
            prop_assert!(gap >= -allowed, "{gap:e}, {allowed:e} in {leg:?}");
            let there = case.flying(start, leg.time);
            prop_assert!(there.abs() <= allowed, "{there:e}, {allowed:e} at the contact of {leg:?}");
            let at = &impact.before;
            let height = at.height + case.body.hull.level();
            let depth = case.clearance(height, at.axis);
            prop_assert!(depth.abs() <= 1e-12, "{depth:e}");
            let approach = case.contact_velocity(at, impact.sphere).z;
            let speed = at.velocity.norm() + at.spin(&case.body).norm() * case.size();
            prop_assert!(approach <= 16.0 * f64::EPSILON * speed, "{approach:e} in {leg:?}");
            prop_assert!(leg.time >= 0.0);
        }
    }

    /// Momentum, angular momentum about the centre of mass, the law, and the work of the impulse, with the point of contact
    /// found in another way.
    #[test]
    fn an_impact_balances((case, (normal, tangential), free) in motion_of(shape())
        .prop_flat_map(|(case, _, state)| (Just(case), coefficients(), Just(state)))
    ) {
        let body = &case.body;
        let (law, sphere) = (law(normal, tangential), Sphere::Two);
        let mut before = State { height: body.hull.touching_height(sphere, free.axis.z), ..free };
        let arm = case.arm(before.axis, if let Surface::OneBall(_) = body.hull { body.hull.name(sphere, 0.0) } else { sphere });
        let velocity = |state: &State| state.velocity + state.spin(body).cross(arm);
        if velocity(&before).z > 0.0 {
            before.velocity = before.velocity * -1.0;
            before.precession = before.precession * -1.0;
        }
        let v = velocity(&before);
        prop_assume!(v.z < 0.0);
        let (after, speed) = collide(body, &law, &before, sphere);
        let w = velocity(&after);
        let impulse = after.velocity - before.velocity;
        let gained = (after.precession - before.precession) * body.transverse;
        let spin = before.spin(body).norm() + after.spin(body).norm();
        // What a rounding of the impulse does to the contact velocity: K, whose entries reach 1 + r_c²/J.
        let ratio = 1.0 + (arm.norm().powi(2) + body.transverse) / body.transverse.min(body.axial);
        let size = arm.norm().max(1.0) * case.size().max(1.0);
        let quick = before.velocity.norm() + after.velocity.norm() + size * spin * ratio;
        let allowed = 32.0 * f64::EPSILON * quick * size;
        prop_assert!((gained - arm.cross(impulse)).norm() <= allowed * size);
        prop_assert!((w.z + normal * v.z).abs() <= allowed, "{:e} {allowed:e}", w.z + normal * v.z);
        prop_assert!((w.x - tangential * v.x).abs() <= allowed);
        prop_assert!((w.y - tangential * v.y).abs() <= allowed);
        prop_assert!((speed + normal * v.z).abs() <= allowed && speed >= 0.0);
        let work = 0.5 * impulse.dot(v + w);
        let (e, f) = (before.kinetic_energy(body), after.kinetic_energy(body));
        prop_assert!((f - e - work).abs() <= allowed * quick, "{:e}", f - e - work);
    }

    /// Kinetic and potential energy are the same at both ends of a flight.
    #[test]
    fn a_flight_conserves_energy((case, law, release) in motion_of(shape())) {
        for leg in legs(&case.body, &law, release, 6) {
            let (e, f) = (energy(&leg.start, &case.body), energy(&leg.impact.before, &case.body));
            let scale = leg.start.kinetic_energy(&case.body) + leg.start.height.abs() + leg.time * leg.time;
            let turning = case.size() * (1.0 + leg.start.precession.norm() * leg.time);
            let allowed = 16.0 * f64::EPSILON * (scale + 1.0 + turning);
            prop_assert!((e - f).abs() <= allowed, "{:e} of {scale:e}", e - f);
        }
    }

    /// The bound on which the search of a spheroid rests: the second derivative of the support function, along the motion of
    /// a unit vector about any axis, stays within it on both sides, and in a plane comes as near as half of it.
    #[test]
    fn the_bound_of_a_spheroid_holds(
        case in spheroid(), about in direction(), axis in direction(),
    ) {
        let Outside::Spheroid(e, c) = case.outside else { unreachable!() };
        let (k, a) = (about.dot(axis) * about.z, about.horizontal() * about.cross(axis).norm());
        let reach = k.abs() + a;
        let bound = case.body.hull.curvature_bound(a, reach);
        let excess = (c - e) * (c + e);
        let mut largest = 0.0_f64;
        for i in 0..=2000 {
            let (sin, cos) = (std::f64::consts::PI * f64::from(i) / 2000.0).sin_cos();
            let tilt = (k + a * cos).clamp(-1.0, 1.0);
            let (rate, acceleration) = (-a * sin, -a * cos);
            let h = (e * e * (1.0 - tilt) * (1.0 + tilt) + c * c * tilt * tilt).sqrt();
            let second = excess * tilt * acceleration / h + excess * e * e * rate * rate / h.powi(3);
            largest = largest.max(second.abs());
        }
        // e_z is known to an ulp, h² of a disc 1/c² times worse.
        let room = 1.0 + 64.0 * f64::EPSILON * (1.0 + 1.0 / (c * c));
        prop_assert!(largest <= bound * room, "{largest:e} > {bound:e}");
        prop_assert!(about.horizontal() < 1.0 || about.dot(axis) != 0.0 || largest >= 0.5 * bound);
    }

    /// Names of spheres are conventions: with 1 and 2 exchanged and the axis turned round, the same body does the same, up to
    /// rounding, and the other number touches.
    #[test]
    fn spheres_can_change_their_names(
        two in magnitude(-0.7, 0.7), density in magnitude(-1.0, 1.0), distance in 0.01..2.0_f64, axis in direction(), space in 1.0..20.0_f64,
    ) {
        let separation = distance * (1.0 + two);
        let one = Dumbbell::unequal([1.0, two], separation, [1.0, density]).unwrap().solid().scaled;
        let other = Dumbbell::unequal([two, 1.0], separation, [density, 1.0]).unwrap().solid().scaled;
        let height = one.hull.support(axis.z) + space;
        prop_assert!((other.hull.support(-axis.z) - one.hull.support(axis.z)).abs() <= 1e-14 * height);
        let release = |body, axis| {
            State::with_spin(body, height, Vector::default(), axis, Vector::default())
        };
        let law = law(0.8, 0.3);
        let (a, _) = trajectory(&one, &law, release(&one, axis), 2);
        let (b, _) = trajectory(&other, &law, release(&other, axis * -1.0), 2);
        for (a, b) in a.iter().zip(&b) {
            // A level body, and gaps within rounding, may be hit in either order.
            prop_assume!(a.before.gaps(&one).iter().any(|&gap| gap > 1e-9));
            prop_assert!((a.time - b.time).abs() <= 1e-9 * a.time);
            prop_assert!((a.restitution() - b.restitution()).abs() <= 1e-7 * (1.0 + a.restitution().abs()));
            prop_assert_eq!(a.sphere, b.sphere.other());
        }
    }
}

/// Of a pair of concentric or engulfed spheres the larger one touches, under its own number, and its mass alone counts.
#[test]
fn an_engulfed_sphere_is_not_there() {
    for (radius, separation, name) in [
        ([1.0, 0.5], 0.5, Sphere::One),
        ([1.0, 0.5], 0.2, Sphere::One),
        ([0.5, 1.0], 0.5, Sphere::Two),
        ([0.5, 1.0], 0.0, Sphere::Two),
    ] {
        let body = Dumbbell::unequal(radius, separation, [3.0, 3.0])
            .unwrap()
            .solid();
        let sphere = Dumbbell::new(1.0, 0.0, 3.0).unwrap().solid();
        assert!((body.mass / sphere.mass - 1.0).abs() < 1e-15);
        assert!((body.transverse_inertia / sphere.transverse_inertia - 1.0).abs() < 1e-15);
        let start = at_rest(&body.scaled, 10.0 / body.unit, 0.3);
        let FlightEnd::Impact { sphere, time, .. } =
            landing(start, &body.scaled, restitution_core::FlightStart::Free)
        else {
            panic!("it falls");
        };
        assert_eq!(sphere, name);
        assert!((time - (2.0 * (10.0 - 1.0) / body.unit).sqrt()).abs() < 1e-14 * time);
    }
}

/// A spheroid with equal axes, a sphere whose load weighs nothing or is in the middle, a cylinder of no length: spheres, with
/// the coefficient of the material and no rotation.
#[test]
fn shapes_that_are_spheres() {
    let spheres: [Solid; 4] = [
        Spheroid::new(2.0, 2.0, 3.0).unwrap().into(),
        LoadedSphere::new(2.0, 3.0, 0.0, 1.0).unwrap().into(),
        LoadedSphere::new(2.0, 3.0, 0.0, 0.0).unwrap().into(),
        Spherocylinder::new(2.0, 0.0, 3.0).unwrap().into(),
    ];
    let sphere = Solid::from(Dumbbell::new(2.0, 0.0, 3.0).unwrap());
    for body in spheres {
        assert!((body.mass / sphere.mass - 1.0).abs() < 4e-16);
        assert!((body.transverse_inertia / sphere.transverse_inertia - 1.0).abs() < 1e-15);
        assert!((body.axial_inertia / sphere.axial_inertia - 1.0).abs() < 1e-15);
        for angle in [0.0, 0.4, 1.57, 3.0] {
            let release = at_rest(&body.scaled, 9.0, angle);
            let (impacts, _) = trajectory(&body.scaled, &law(0.7, 0.2), release, 10);
            for impact in impacts {
                assert!((impact.restitution() - 0.7).abs() < 1e-15);
                assert_eq!(impact.after.rotational_energy(&body.scaled), 0.0);
            }
        }
    }
}

/// A spherocylinder and a dumbbell look alike: the same flights end at the same time. They do not weigh alike.
#[test]
fn a_spherocylinder_touches_like_a_dumbbell() {
    for elongation in [0.1, 1.0, 3.0] {
        let (a, b) = (
            dumbbell(elongation),
            Spherocylinder::new(1.0, elongation, 1.0)
                .unwrap()
                .solid()
                .scaled,
        );
        assert_eq!(a.hull, b.hull);
        assert!(elongation == 0.1 || a.transverse != b.transverse);
        for angle in [0.0, 0.5, 1.5, 3.0] {
            let departure = restitution_core::FlightStart::Free;
            let (a, b) = (
                landing(at_rest(&a, 10.0, angle), &a, departure),
                landing(at_rest(&b, 10.0, angle), &b, departure),
            );
            assert_eq!(a, b);
        }
    }
}
