//! The table of bodies, laws and materials as JSON.

use crate::rigid::is_asked;
use restitution_core::describe::{Allowed, Argument, Interval, Kind, Parameter};
use restitution_core::law::Creation;
use restitution_core::{BODIES, BodyKind, LAWS, MATERIALS};

/// Objects with the keys `bodies`, `laws` and `materials`; each entry has `name`, `text` and `parameters`, a body `rigid`, a law `creates_energy`.
pub fn json() -> String {
    let laws = LAWS.iter().map(|law| {
        let creates = match law.creates_energy {
            Creation::Never => "false".to_owned(),
            Creation::Possible => "true".to_owned(),
            Creation::Where(parameter, value) => list([text(parameter), text(value)]),
        };
        kind(&law.kind, &format!(",\"creates_energy\":{creates}"))
    });
    let bodies = BODIES.iter().map(|body| match body {
        BodyKind::Revolution(about) => kind(about, ",\"rigid\":false"),
        BodyKind::Rigid(about) => kind(about, ",\"rigid\":true"),
    });
    format!(
        "{{\"bodies\":{},\"laws\":{},\"materials\":{}}}",
        list(bodies),
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
            about
                .parameters
                .iter()
                .filter(|about| is_asked(about))
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
        Allowed::Whole(allowed) => interval("whole", allowed),
        Allowed::Choice(numbers) => {
            let names = numbers.iter().map(|number| text(&number.to_string()));
            format!("\"type\":\"choice\",\"names\":{}", list(names))
        }
        Allowed::Several(names, allowed) => {
            let parts = list(
                names
                    .iter()
                    .map(|[link, about]| list([text(link), text(about)])),
            );
            format!("{},\"parts\":{parts}", interval("several", allowed))
        }
        Allowed::Rows(columns, least, allowed) => {
            let columns = list(columns.iter().map(|name| text(name)));
            format!(
                "{},\"columns\":{columns},\"least\":{least}",
                interval("rows", allowed)
            )
        }
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
        "{{\"name\":{},\"link\":{},\"beside\":{},\"text\":{},\"unit\":{},{allowed},\"example\":{example}{default}}}",
        text(about.name),
        text(about.link),
        number(about.beside),
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
        Argument::Whole(value) => value.to_string(),
        Argument::Drawn(..) | Argument::Absent => "null".to_owned(),
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
