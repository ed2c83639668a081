//! Numbers in files, refused while they are read, so that the message can name the line.

use serde::{Deserialize, Deserializer, de::Error};

use crate::body::Requirement;

fn read<'de, D: Deserializer<'de>>(deserializer: D, requirement: Requirement) -> Result<f64, D::Error> {
    let value = f64::deserialize(deserializer)?;
    if requirement.admits(value) {
        Ok(value)
    } else {
        Err(D::Error::custom(format_args!("{value} is not allowed; give {requirement}")))
    }
}

macro_rules! number {
    ($type:ident, $plain:ident, $optional:ident) => {
        struct $type(f64);

        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                read(deserializer, Requirement::$type).map(Self)
            }
        }

        pub(crate) fn $plain<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
            $type::deserialize(deserializer).map(|number| number.0)
        }

        #[allow(dead_code, reason = "not every requirement has an optional field")]
        pub(crate) fn $optional<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
            Ok(Option::<$type>::deserialize(deserializer)?.map(|number| number.0))
        }
    };
}

number!(Finite, finite, optional_finite);
number!(Positive, positive, optional_positive);
number!(NonNegative, non_negative, optional_non_negative);

/// Two finite numbers.
pub(crate) fn pair<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(f64, f64), D::Error> {
    let (x, z) = <(Finite, Finite)>::deserialize(deserializer)?;
    Ok((x.0, z.0))
}

/// Three finite numbers.
pub(crate) fn vector<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(f64, f64, f64), D::Error> {
    let (x, y, z) = <(Finite, Finite, Finite)>::deserialize(deserializer)?;
    Ok((x.0, y.0, z.0))
}
