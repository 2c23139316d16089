//! What bodies, laws and materials say of their parameters is what their constructors take: every value inside, and none outside.

use restitution_core::describe::{Allowed, Argument, Interval, Kind, Parameter};
use restitution_core::law::Creation;
use restitution_core::{Arc, BODIES, BodyKind, Error, Hypothesis, LAWS, MATERIALS, Solid};
use std::f64::consts::PI;

/// Numbers at the ends that are inside, and next to them outside.
fn ends(interval: Interval) -> (Vec<f64>, Vec<f64>) {
    let Interval { low, high, closed } = interval;
    let (mut inside, mut outside) = (vec![], vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY]);
    if closed && low.is_finite() {
        inside.push(low);
        outside.push(low.next_down());
    } else {
        outside.push(low);
    }
    if high.is_finite() {
        inside.push(high);
        outside.push(high.next_up());
    }
    (inside, outside)
}

/// What a number may be, as an argument of this parameter.
fn given(about: &Parameter, number: f64) -> Argument<'static> {
    match about.example {
        Argument::Numbers([_, rest @ ..]) => {
            Argument::Numbers(Vec::leak([&[number], rest].concat()))
        }
        _ => Argument::Number(number),
    }
}

/// The example of every parameter that is not usually left out.
fn examples(parameters: &[Parameter]) -> Vec<Argument<'static>> {
    let usual = |about: &Parameter| {
        if about.is_optional() {
            Argument::Absent
        } else {
            about.example
        }
    };
    parameters.iter().map(usual).collect()
}

fn refused(error: Option<Error>, name: &str) {
    match error {
        Some(Error::Parameter { name: found, .. }) => assert_eq!(found, name),
        other => panic!("{name}: {other:?}"),
    }
}

fn check<T>(kind: &Kind<T>, make: &dyn Fn(&[Argument<'_>]) -> Option<Error>) {
    let all: Vec<_> = examples(kind.parameters);
    assert!(make(&all).is_none(), "{}", kind.name);
    for (place, about) in kind.parameters.iter().enumerate() {
        let with = |argument| {
            let mut changed = all.clone();
            changed[place] = argument;
            make(&changed)
        };
        if let Some(default) = about.default {
            assert!(with(default).is_none(), "{}: {}", kind.name, about.name);
        }
        match about.allowed {
            Allowed::Number(interval) | Allowed::Pair(interval) | Allowed::Numbers(interval) => {
                let (inside, outside) = ends(interval);
                for number in inside {
                    let made = with(given(about, number));
                    assert!(made.is_none(), "{}: {} = {number}", kind.name, about.name);
                }
                for number in outside {
                    refused(with(given(about, number)), about.name);
                }
                if let (Allowed::Pair(_), false) = (about.allowed, about.is_optional()) {
                    assert!(with(Argument::Pair([1.0, 0.5])).is_none());
                    refused(with(Argument::Pair([1.0, 0.0])), about.name);
                }
            }
            Allowed::Choice(numbers) => {
                for &number in numbers {
                    assert!(with(Argument::Whole(number)).is_none());
                    refused(with(Argument::Whole(number + 1)), about.name);
                }
            }
            Allowed::Whole(_) if about.default.is_some() => (), // all can be
            Allowed::Whole(_) => refused(with(Argument::Whole(0)), about.name),
            Allowed::Several(_, interval) | Allowed::Rows(_, _, interval) => {
                let Argument::Numbers(example) = about.example else {
                    panic!("{}: {}", kind.name, about.name)
                };
                if about.is_optional() || about.unit.is_none() {
                    continue; // not by itself; or numbers of others
                }
                let changed = |number: f64| {
                    let [numbers @ .., _] = example else { panic!() };
                    with(Argument::Numbers(Vec::leak([numbers, &[number]].concat())))
                };
                for number in ends(interval).1 {
                    refused(changed(number), about.name);
                }
            }
            Allowed::Name(names) => {
                for name in names {
                    assert!(with(Argument::Name(name)).is_none());
                }
                refused(with(Argument::Name("none of them")), about.name);
            }
        }
    }
    // Nothing is made of too few arguments.
    if !all.is_empty() {
        assert!(make(&all[1..]).is_some() || all.len() == 1);
        assert!(make(&[]).is_some());
    }
}

#[test]
fn kinds_take_what_they_describe() {
    for body in BODIES {
        match body {
            BodyKind::Revolution(kind) => check(kind, &|given| (kind.make)(given).err()),
            BodyKind::Rigid(kind) => check(kind, &|given| kind.body(given).err()),
        }
    }
    for law in LAWS {
        check(&law.kind, &|given| (law.kind.make)(given).err());
    }
    for kind in MATERIALS {
        check(kind, &|given| (kind.make)(given).err());
    }
}

/// A law that can create energy with some value of a parameter has that parameter and that value.
#[test]
fn what_creates_energy_is_a_value_of_a_parameter() {
    for law in LAWS {
        if let Creation::Where(name, value) = law.creates_energy {
            let known = law.kind.parameters.iter().find(|about| about.name == name);
            assert!(
                matches!(known.map(|about| about.allowed), Some(Allowed::Name(names)) if names.contains(&value))
            );
        }
    }
}

/// The hypotheses of the table are all that there are, in their order.
#[test]
fn every_hypothesis_is_in_the_table() {
    let coulomb = LAWS.iter().find(|law| law.kind.name == "Coulomb").unwrap();
    let names = Hypothesis::NAMED.map(|(name, _)| name);
    assert!(matches!(coulomb.kind.parameters[1].allowed, Allowed::Name(known) if *known == names));
}

/// Bodies of the table: with the parameters of their examples, and with each number halved and doubled in turn.
fn bodies(homogeneous: bool) -> Vec<(String, Solid, f64)> {
    let mut found = vec![];
    let kinds = BODIES.iter().filter_map(|body| match body {
        BodyKind::Revolution(kind) => Some(kind),
        BodyKind::Rigid(..) => None,
    });
    for kind in kinds {
        for (place, factor) in (0..kind.parameters.len()).flat_map(|i| [(i, 0.5), (i, 2.0)]) {
            let mut arguments = examples(kind.parameters);
            if let Argument::Number(number) = &mut arguments[place] {
                *number *= factor;
            }
            let mut density = f64::NAN;
            for (about, argument) in kind.parameters.iter().zip(&mut arguments) {
                match argument {
                    Argument::Number(mass) if homogeneous && about.unit == Some("kg") => {
                        *mass = 0.0
                    }
                    Argument::Number(number) if about.name == "density" => density = *number,
                    _ => (),
                }
            }
            if let Ok(body) = (kind.make)(&arguments) {
                let name = format!("{} {arguments:?}", kind.name);
                found.push((name, body, density));
            }
        }
    }
    assert!(found.len() > 20);
    found
}

/// The points (place on the axis, distance from it) of an arc.
fn point(arc: &Arc, t: f64) -> [f64; 2] {
    [arc.centre + arc.along * t.cos(), arc.across * t.sin()]
}

/// The integrals ∫f(z, r) |dz| under the outline, by Simpson's rule in the angle of each arc and along the straight line.
fn integral(outline: &[Arc; 2], f: impl Fn(f64, f64) -> f64) -> f64 {
    const PARTS: usize = 2000;
    let simpson = |g: &dyn Fn(f64) -> f64, from: f64, to: f64| {
        let step = (to - from) / PARTS as f64;
        let weight = |k: usize| match k {
            0 | PARTS => 1.0,
            _ if k % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let sum: f64 = (0..=PARTS)
            .map(|k| weight(k) * g(from + k as f64 * step))
            .sum();
        sum * step / 3.0
    };
    let [one, two] = outline;
    let arcs = outline.iter().map(|arc| {
        let under = |t: f64| {
            let [z, r] = point(arc, t);
            f(z, r) * arc.along * t.sin()
        };
        simpson(&under, arc.from, arc.to)
    });
    let ([high, r_high], [low, r_low]) = (point(one, one.to), point(two, two.from));
    let line = |z: f64| {
        let share = if high > low {
            (z - low) / (high - low)
        } else {
            0.0
        };
        f(z, r_low + share * (r_high - r_low))
    };
    arcs.sum::<f64>() + simpson(&line, low, high)
}

/// Mass, centre of mass and both moments of inertia are the integrals over the slices of a homogeneous solid with the outline.
#[test]
fn bodies_weigh_what_their_outline_encloses() {
    for (name, body, density) in bodies(true) {
        let close = |found: f64, exact: f64, what: &str| {
            let wrong = (found / exact - 1.0).abs();
            assert!(wrong < 1e-11, "{name}: {what} {found} for {exact}");
        };
        let mass = density * PI * integral(&body.outline, |_, r| r * r);
        close(body.mass, mass, "mass");
        let moment = density * PI * integral(&body.outline, |z, r| z * r * r);
        assert!(
            moment.abs() < 1e-11 * mass * body.farthest(),
            "{name}: {moment}"
        );
        let axial = density * PI * integral(&body.outline, |_, r| 0.5 * r.powi(4));
        close(body.axial_inertia, axial, "J_zz");
        let second = density * PI * integral(&body.outline, |z, r| z * z * r * r);
        close(body.transverse_inertia, 0.5 * axial + second, "J_xx");
    }
}

/// The centre of mass is as high over the plane as the outline reaches below it, at every angle.
#[test]
fn bodies_touch_with_their_outline() {
    for (name, body, _) in bodies(false) {
        for k in 0..=200 {
            let angle = PI * f64::from(k) / 200.0;
            let (sine, cosine) = angle.sin_cos();
            let depth = body.outline.iter().map(|arc| {
                // −(z cos θ − r sin θ) is largest there, or at an end of the arc.
                let lowest = (arc.across * sine).atan2(-arc.along * cosine);
                let [z, r] = point(arc, lowest.clamp(arc.from, arc.to));
                r * sine - z * cosine
            });
            let depth = depth.fold(0.0, f64::max);
            let wrong = (body.lowest(angle.cos()) - depth).abs();
            assert!(
                wrong < 1e-14 * body.unit * 10.0,
                "{name} at {angle}: {wrong:e}"
            );
        }
    }
}
