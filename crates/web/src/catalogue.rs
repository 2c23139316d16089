//! The table of bodies, laws and materials as JSON.

use crate::parameters::asked;
use restitution_core::describe::{Allowed, Argument, Interval, Kind, Parameter};
use restitution_core::law::Creation;
use restitution_core::{BODIES, LAWS, MATERIALS};

/// Objects with the keys `bodies`, `laws` and `materials`; each entry has `name`, `text` and `parameters`, a law `creates_energy`.
pub fn json() -> String {
    let laws = LAWS.iter().map(|law| {
        let creates = match law.creates_energy {
            Creation::Never => "false".to_owned(),
            Creation::Possible => "true".to_owned(),
            Creation::Where(parameter, value) => list([text(parameter), text(value)]),
        };
        kind(&law.kind, &format!(",\"creates_energy\":{creates}"))
    });
    format!(
        "{{\"bodies\":{},\"laws\":{},\"materials\":{}}}",
        list(BODIES.iter().map(|about| kind(about, ""))),
        list(laws),
        list(MATERIALS.iter().map(|about| kind(about, "")))
    )
}

fn kind<T>(about: &Kind<T>, more: &str) -> String {
    format!(
        "{{\"name\":{},\"text\":{},\"parameters\":{}{more}}}",
        text(about.name),
        text(about.text),
        list(
            about.parameters[..asked(about.parameters)]
                .iter()
                .map(parameter)
        )
    )
}

/// As in the binding for Python; an end that is infinite is null.
fn parameter(about: &Parameter) -> String {
    let interval = |kind: &str, Interval { low, high, closed }: Interval| {
        let (low, high) = (number(low), number(high));
        format!("\"type\":\"{kind}\",\"low\":{low},\"high\":{high},\"closed\":{closed}")
    };
    let allowed = match about.allowed {
        Allowed::Number(allowed) => interval("number", allowed),
        Allowed::Pair(allowed) => interval("pair", allowed),
        Allowed::Numbers(allowed) => interval("numbers", allowed),
        Allowed::Name(names) => {
            let names = names.iter().map(|name| text(name));
            format!("\"type\":\"name\",\"names\":{}", list(names))
        }
    };
    let default = about.default.map_or(String::new(), |default| {
        format!(",\"default\":{}", argument(default))
    });
    let example = argument(about.example);
    format!(
        "{{\"name\":{},\"text\":{},\"unit\":{},{allowed},\"example\":{example}{default}}}",
        text(about.name),
        text(about.text),
        about.unit.map_or("null".to_owned(), text)
    )
}

fn argument(given: Argument<'_>) -> String {
    match given {
        Argument::Number(value) => number(value),
        Argument::Pair(values) => list(values.map(number)),
        Argument::Numbers(values) => list(values.iter().copied().map(number)),
        Argument::Name(name) => text(name),
        Argument::Absent => "null".to_owned(),
    }
}

fn number(value: f64) -> String {
    if value.is_finite() {
        format!("{value:?}")
    } else {
        "null".to_owned()
    }
}

/// A text of the table, none of which has a character that JSON writes otherwise.
fn text(text: &str) -> String {
    format!("\"{text}\"")
}

fn list(entries: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", entries.into_iter().collect::<Vec<_>>().join(","))
}
