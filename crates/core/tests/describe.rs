//! What bodies, laws and materials say of their parameters is what their constructors take: every value inside, and none outside.

use restitution_core::describe::{Allowed, Argument, Interval, Kind, Parameter};
use restitution_core::law::Creation;
use restitution_core::{BODIES, Error, Hypothesis, LAWS, MATERIALS};

const SPEEDS: [f64; 2] = [1.0, 2.0];
const HALVES: [f64; 2] = [0.5, 0.5];

/// A value inside that goes with those of the other parameters.
fn usual(about: &Parameter) -> Argument<'static> {
    match about.allowed {
        Allowed::Number(_) | Allowed::Pair(_) if about.name == "poisson_ratio" => {
            Argument::Number(0.2)
        }
        Allowed::Number(_) | Allowed::Pair(_) => Argument::Number(1.0),
        Allowed::Numbers(interval) if interval.high == 1.0 => Argument::Numbers(&HALVES),
        Allowed::Numbers(_) => Argument::Numbers(&SPEEDS),
        Allowed::Name(names) => Argument::Name(names[0]),
    }
}

/// Numbers at the ends that are inside, and next to them outside.
fn ends(interval: Interval) -> (Vec<f64>, Vec<f64>) {
    let Interval { low, high, closed } = interval;
    let (mut inside, mut outside) = (vec![], vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY]);
    if closed {
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
    match about.allowed {
        Allowed::Numbers(interval) if interval.high == 1.0 => {
            Argument::Numbers(Vec::leak(vec![number, HALVES[1]]))
        }
        Allowed::Numbers(_) => Argument::Numbers(Vec::leak(vec![number, SPEEDS[1]])),
        _ => Argument::Number(number),
    }
}

fn refused<T>(made: Result<T, Error>, name: &str) {
    match made.err() {
        Some(Error::Parameter { name: found, .. }) => assert_eq!(found, name),
        other => panic!("{name}: {other:?}"),
    }
}

fn check<T>(kind: &Kind<T>) {
    let all: Vec<_> = kind.parameters.iter().map(usual).collect();
    assert!((kind.make)(&all).is_ok(), "{}", kind.name);
    for (place, about) in kind.parameters.iter().enumerate() {
        let with = |argument| {
            let mut changed = all.clone();
            changed[place] = argument;
            (kind.make)(&changed)
        };
        if let Some(default) = about.default {
            assert!(with(default).is_ok(), "{}: {}", kind.name, about.name);
        }
        match about.allowed {
            Allowed::Number(interval) | Allowed::Pair(interval) | Allowed::Numbers(interval) => {
                let (inside, outside) = ends(interval);
                for number in inside {
                    let made = with(given(about, number));
                    assert!(made.is_ok(), "{}: {} = {number}", kind.name, about.name);
                }
                for number in outside {
                    refused(with(given(about, number)), about.name);
                }
                if let Allowed::Pair(_) = about.allowed {
                    assert!(with(Argument::Pair([1.0, 0.5])).is_ok());
                    refused(with(Argument::Pair([1.0, 0.0])), about.name);
                }
            }
            Allowed::Name(names) => {
                for name in names {
                    assert!(with(Argument::Name(name)).is_ok());
                }
                refused(with(Argument::Name("none of them")), about.name);
            }
        }
    }
    // Nothing is made of too few arguments.
    if !all.is_empty() {
        assert!((kind.make)(&all[1..]).is_err() || all.len() == 1);
        assert!((kind.make)(&[]).is_err());
    }
}

#[test]
fn kinds_take_what_they_describe() {
    BODIES.iter().for_each(check);
    LAWS.iter().for_each(|law| check(&law.kind));
    MATERIALS.iter().for_each(check);
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
