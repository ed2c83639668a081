//! Text to data, with the file, line, column and field of what is wrong.

use ron::{Options, error::SpannedError, extensions::Extensions};
use serde::{Deserialize, Deserializer, de::DeserializeOwned};

use super::{
    FileError,
    wording::{offset, problem},
};

/// How files are read and written: `Some(x)` may be written `x`, and `Raw(particles: …)` needs no second pair of brackets.
pub(crate) fn options() -> Options {
    Options::default().with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES)
}

/// A file that says only which version it is. Read when the file as a whole cannot be: what is unknown in it may belong to
/// another version.
pub(crate) trait CurrentVersion: DeserializeOwned {
    /// Reads nothing but the version.
    type OnlyVersion: DeserializeOwned;
}

/// Reads a version, which must be 1.
pub(crate) fn version<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    match u32::deserialize(deserializer)? {
        1 => Ok(1),
        other => Err(serde::de::Error::custom(format_args!(
            "version {other} is not known to this program; it reads version: 1"
        ))),
    }
}

/// Reads `text`, the content of `file`.
pub(crate) fn parse<T: CurrentVersion>(text: &str, file: &str) -> Result<T, FileError> {
    read(text, file).map_err(|error| match read::<T::OnlyVersion>(text, file) {
        Err(version @ FileError::Value { .. }) if version.to_string().contains("is not known to this program") => {
            version
        }
        _ => error,
    })
}

/// Why a text is no data.
struct Fault {
    error: SpannedError,
    /// The path of the field.
    field: String,
}

fn read<T: DeserializeOwned>(text: &str, file: &str) -> Result<T, FileError> {
    deserialize(text).map_err(|fault| {
        let Fault { error, field } = *fault;
        // A value is where it begins; what should not be there is where the reader stopped.
        let place = if error.code == ron::Error::TrailingCharacters { error.span.end } else { error.span.start };
        let (line, column) = (place.line, place.col);
        let problem = wanted_variants::<T>(text, &error).unwrap_or_else(|| problem(text, place, &error.code));
        FileError::Value { file: file.into(), line, column, field: field_name(&field), problem }
    })
}

fn deserialize<T: DeserializeOwned>(text: &str) -> Result<T, Box<Fault>> {
    let fault = |error, field| Box::new(Fault { error, field });
    let mut deserializer =
        ron::Deserializer::from_str_with_options(text, &options()).map_err(|error| fault(error, String::new()))?;
    let value = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let field = error.path().to_string();
        fault(deserializer.span_error(error.into_inner()), field)
    })?;
    deserializer.end().map_err(|error| fault(deserializer.span_error(error), String::new()))?;
    Ok(value)
}

/// What may stand where something else than a name does: asked for by putting a name there that nothing has. Nothing where the problem is another.
fn wanted_variants<T: DeserializeOwned>(text: &str, error: &SpannedError) -> Option<String> {
    const NOBODY: &str = "NoSuchName ";
    if !matches!(error.code, ron::Error::ExpectedIdentifier | ron::Error::SuggestRawIdentifier(_)) {
        return None;
    }
    let (ahead, behind) = text.split_at(offset(text, error.span.start));
    let ron::Error::NoSuchEnumVariant { expected, .. } =
        deserialize::<T>(&[ahead, NOBODY, behind].concat()).err()?.error.code
    else {
        return None;
    };
    let names: Vec<_> = expected.iter().map(|name| format!("`{name}`")).collect();
    let (last, others) = names.split_last()?;
    let others = others.join(", ");
    Some(if others.is_empty() { format!("expected {last}") } else { format!("expected {others} or {last}") })
}

/// The path of a field as messages about bodies and parameter paths write it.
fn field_name(path: &str) -> String {
    let path = path.trim_end_matches(['?', '.']);
    let path = [
        "body.Raw.",
        "body.GardenWorm.",
        "body.Strand.",
        "body.Jelly.",
        "body.Inchworm.",
        "body.Roller.",
        "body.Composed.",
    ]
    .into_iter()
    .find_map(|kind| path.strip_prefix(kind))
    .unwrap_or(path);
    if path.is_empty() { String::new() } else { format!("{path}: ") }
}
