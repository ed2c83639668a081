//! Where in a text a field is whose value is good by itself but fits nothing else.

use core::fmt;

use serde::{
    Deserializer,
    de::{DeserializeSeed, Error, IgnoredAny, MapAccess, SeqAccess, Visitor},
};

use super::parse::options;

/// The line, counted from 1, of the field at `path`, such as `creatures[1].road`; where there is no such field, that of the innermost one around it. Nothing where
/// not even the first part of the path is there. Kinds such as `Raw` in `body: Raw(…)` are no part of a path.
pub(crate) fn line_of(text: &str, path: &str) -> Option<usize> {
    let parts: Vec<_> = parts(path).collect();
    (1..=parts.len()).rev().find_map(|depth| line(text, &parts[..depth]))
}

fn parts(path: &str) -> impl Iterator<Item = &str> {
    path.split(['.', '[', ']']).filter(|part| !part.is_empty())
}

/// Reads up to a value and stops there with an error, of which only the place is wanted.
fn line(text: &str, parts: &[&str]) -> Option<usize> {
    let mut deserializer = ron::Deserializer::from_str_with_options(text, &options()).ok()?;
    let error = Walk(parts).deserialize(&mut deserializer).err()?;
    (error.to_string() == FOUND).then(|| deserializer.span_error(error).span.end.line)
}

/// What no file can make a reader say.
const FOUND: &str = "\u{1}found";

#[derive(Clone, Copy)]
struct Walk<'a>(&'a [&'a str]);

impl<'de> DeserializeSeed<'de> for Walk<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        if self.0.is_empty() {
            return Err(D::Error::custom(FOUND));
        }
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Walk<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("something with parts")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let Some((first, rest)) = self.0.split_first() else { return Ok(()) };
        while let Some(Name(name)) = map.next_key()? {
            if name == *first {
                return map.next_value_seed(Walk(rest));
            }
            if parts(&name).eq(self.0.iter().copied()) {
                return map.next_value_seed(Walk(&[]));
            }
            map.next_value::<IgnoredAny>()?;
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<(), A::Error> {
        let Some((first, rest)) = self.0.split_first() else { return Ok(()) };
        let Ok(index) = first.parse::<usize>() else { return Ok(()) };
        for _ in 0..index {
            if seq.next_element::<IgnoredAny>()?.is_none() {
                return Ok(());
            }
        }
        seq.next_element_seed(Walk(rest)).map(|_| ())
    }
}

/// The name of a field, or the key of a map.
struct Name(String);

impl<'de> serde::Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read;
        impl Visitor<'_> for Read {
            type Value = Name;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a name")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Name, E> {
                Ok(Name(name.to_owned()))
            }
        }
        deserializer.deserialize_str(Read)
    }
}
