//! What is wrong with a text, in words that say what would be right: the reader itself only says what it missed.

use ron::error::{Error, Position};

use super::library::{CREATURE, ROAD, SCENE};

/// What is wrong at `place` of a text, where the reader stopped with `error`, and what would be right.
pub(super) fn problem(text: &str, place: Position, error: &Error) -> String {
    let (before, behind) = text.split_at(offset(text, place));
    match error {
        Error::MissingStructField { field, .. } => format!("the field `{field}` is missing; it has no default"),
        Error::DuplicateStructField { field, .. } => format!("the field `{field}` is given twice; give it once"),
        Error::ExpectedDifferentStructName { expected, found } => other_struct(expected, found, behind),
        Error::ExpectedFloat => refused(behind, "a number, such as 1.5"),
        Error::ExpectedInteger | Error::InvalidIntegerDigit { .. } => refused(behind, "a whole number, such as 3"),
        Error::IntegerOutOfBounds => out_of_bounds(before, behind),
        Error::ExpectedBoolean => refused(behind, "true or false"),
        Error::ExpectedString => refused(behind, "a text in quotes, such as \"worm\""),
        Error::ExpectedStringEnd => "a text begins here and does not end; close it with a quote".into(),
        Error::ExpectedArray => refused(behind, "a list in square brackets, such as [0, 1]"),
        Error::ExpectedMap => refused(behind, "a map in curly brackets, such as {\"worm.springs.stiffness\": 2}"),
        Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_) => no_brackets(behind),
        Error::ExpectedIdentifier | Error::SuggestRawIdentifier(_) => no_name(before, behind),
        Error::ExpectedMapColon => "a name and its value have a colon between them, such as `mass: 1`".into(),
        Error::ExpectedComma => no_comma(before, behind),
        Error::ExpectedStructLikeEnd => surplus(before, behind),
        Error::ExpectedDifferentLength { expected, found } => {
            // "a tuple of size 3"
            let wanted = expected.rsplit(' ').next().and_then(|size| size.parse::<usize>().ok());
            wanted.map_or_else(|| error.to_string(), |wanted| format!("{}; here {}", give(wanted), are(*found)))
        }
        Error::TrailingCharacters => "all brackets are closed before this, and nothing may follow; take it away".into(),
        Error::Eof => UNCLOSED.into(),
        other => other.to_string(),
    }
}

const UNCLOSED: &str = "the file ends here, and a bracket is still open; close it";

/// Where in a text, in bytes, a place is.
pub(super) fn offset(text: &str, place: Position) -> usize {
    let before: usize = text.split_inclusive('\n').take(place.line - 1).map(str::len).sum();
    let column = text[before..].char_indices().nth(place.col - 1).map(|(column, _)| column);
    column.map_or(text.len(), |column| before + column)
}

/// That something else stands in the text than what belongs there.
fn refused(behind: &str, right: &str) -> String {
    match word(behind) {
        "" => UNCLOSED.into(),
        word => format!("`{word}` is not allowed; give {right}"),
    }
}

/// The first word, number, text in quotes or sign.
fn word(text: &str) -> &str {
    let text = text.trim_start();
    let end = match text.strip_prefix('"') {
        Some(quoted) => quoted.find('"').map(|end| end + 2),
        None => text.find(|c: char| c.is_whitespace() || ",;:()[]{}".contains(c)),
    };
    match end {
        // A sign by itself.
        Some(0) => &text[..1],
        Some(end) => &text[..end],
        None => text,
    }
}

/// The number at the end of a text.
fn number_before(text: &str) -> &str {
    &text[text.trim_end_matches(|c: char| c.is_ascii_digit() || "+-._".contains(c)).len()..]
}

/// Something else than an opening bracket, or its name.
fn no_brackets(behind: &str) -> String {
    let found = word(behind);
    let field =
        found.starts_with(char::is_alphabetic) && behind.trim_start()[found.len()..].trim_start().starts_with(':');
    if field {
        // The next field, where a list or brackets still go on.
        return format!("a bracket before `{found}` is still open; close it");
    }
    refused(behind, "what belongs here in round brackets: ( … )")
}

/// Brackets of another name.
fn other_struct(expected: &str, found: &str, behind: &str) -> String {
    let kind = |name: &str| {
        let opens = |opening: &str| opening.strip_prefix(name).is_some_and(|rest| rest.starts_with('('));
        [CREATURE, SCENE, ROAD].into_iter().find(|kind| opens(kind.opening))
    };
    match (kind(expected), kind(found)) {
        (Some(expected), Some(found)) => format!(
            "holds a {}, where a {} is looked for; the name of a {} file ends in {}",
            found.what, expected.what, found.what, found.suffix
        ),
        (Some(expected), None) => {
            format!("`{found}` is not allowed; a {} file begins like `{}`", expected.what, expected.opening)
        }
        _ => no_brackets(behind),
    }
}

/// A whole number that is negative, or too large for the field.
fn out_of_bounds(before: &str, behind: &str) -> String {
    let number = word(behind);
    if before.ends_with('-') || number.starts_with('-') {
        return format!("-{} is not allowed; give a whole number, 0 or more", number.trim_start_matches('-'));
    }
    // Indices and counts have 32 bits, seeds 64.
    match number.parse::<u64>() {
        Ok(_) => format!("{number} is too large; give a whole number from 0 to {}", u32::MAX),
        Err(_) => format!("{number} is too large; give a smaller whole number"),
    }
}

/// Something else than the name of a field.
fn no_name(before: &str, behind: &str) -> String {
    let is_digit = |c: char| c.is_ascii_digit();
    let found = word(behind);
    let number = before.trim_end().strip_suffix(',').map(number_before).unwrap_or_default();
    if found.starts_with(is_digit) && number.ends_with(is_digit) && !number.contains('.') {
        return format!("`{number},{found}` is no number; write decimals with a point, not a comma: {number}.{found}");
    }
    refused(behind, "the name of a field, without quotes")
}

/// Where a list or brackets go on without a comma.
fn no_comma(before: &str, behind: &str) -> String {
    let (number, found) = (number_before(before), word(behind));
    if found.is_empty() {
        UNCLOSED.into()
    } else if !number.is_empty() && found.starts_with('.') {
        // Whole numbers are read up to their point.
        format!("{number}{found} is no whole number; give one without a point")
    } else {
        format!("a comma or a closing bracket belongs here, and not `{found}`")
    }
}

/// More in brackets than belongs there.
fn surplus(before: &str, behind: &str) -> String {
    let (mut depth, mut values, mut inside) = (0, 0, before);
    for (at, c) in before.char_indices().rev() {
        match c {
            ')' | ']' | '}' => depth += 1,
            '(' | '[' | '{' if depth == 0 => {
                inside = &before[at..];
                break;
            }
            '(' | '[' | '{' => depth -= 1,
            ',' if depth == 0 => values += 1,
            _ => {}
        }
    }
    let found = word(behind);
    if found.is_empty() {
        return UNCLOSED.into();
    }
    if !inside.trim_end().ends_with(',') {
        return no_comma(before, behind);
    }
    let text = [inside, found].concat();
    let close = text.as_bytes().windows(3).any(|w| w[0].is_ascii_digit() && w[1] == b',' && w[2].is_ascii_digit());
    let hint = if close { " (decimals are written with a point, not a comma)" } else { "" };
    format!("{}; here is one more, `{found}`{hint}", give(values))
}

fn give(values: usize) -> String {
    if values == 1 { "give 1 value".into() } else { format!("give {values} values") }
}

fn are(values: usize) -> String {
    if values == 1 { "is 1".into() } else { format!("are {values}") }
}
