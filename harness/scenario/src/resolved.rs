//! What a scenario says once its sweep is resolved, to the letter and without what its results do not depend on.

use std::fmt::Write as _;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::{Subject, study_tables};

/// Keys of the top level on which no result of a method depends: words, the list of methods, how many trials there are, when it is checked.
const ASIDE: [&str; 7] = ["why", "source", "notes", "method", "nightly", "trials", "sweep"];

/// A scenario, or a cell of its sweep, as text: equal texts give equal results under one seed, from one code. Comments, order of keys and ways to write a number have no part
/// in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Resolved {
    /// All on which points depend: everything but what is made of them.
    pub points: String,
    /// What is made of them.
    pub adjusted: String,
}

impl Resolved {
    /// That of the table of a file.
    pub(crate) fn of(root: &DeTable<'_>) -> Self {
        // What is made of points is not how they come about.
        let adjusted = |key: &str| study_tables::keys().any(|other| other == key);
        let points = |key: &str| !ASIDE.contains(&key) && !adjusted(key);
        Self { points: text_of(root, points), adjusted: text_of(root, adjusted) }
    }

    /// With the camera and the corners of a board that were read from files, if they were.
    pub(crate) fn with_files_of(mut self, subject: &Subject) -> Self {
        if let Subject::Views(views) = subject {
            if views.camera_file.is_some() {
                _ = writeln!(self.points, "camera {:?}", views.camera);
            }
            if views.corner_file.is_some() {
                _ = writeln!(self.points, "board {:?} {:?}", views.field.targets, views.field.plates.first().map(|plate| plate.bend));
            }
        }
        self
    }

    /// With another scenario that was read for it.
    pub(crate) fn with_scenario(mut self, other: &Self) -> Self {
        _ = writeln!(self.points, "scenario\n{}{}", other.points, other.adjusted);
        self
    }
}

/// What the keys of a file that are `wanted` say, in one order.
pub(crate) fn text_of(root: &DeTable<'_>, wanted: impl Fn(&str) -> bool) -> String {
    let mut keys: Vec<(&str, &DeValue<'_>)> = root.iter().map(|(key, value)| (&**key.get_ref(), value.get_ref())).collect();
    keys.sort_unstable_by_key(|(key, _)| *key);
    let mut text = String::new();
    for (key, value) in keys.into_iter().filter(|(key, _)| wanted(key)) {
        _ = write!(text, "{key:?}=");
        write_value(value, &mut text);
        text.push('\n');
    }
    text
}

fn write_value(value: &DeValue<'_>, text: &mut String) {
    match value {
        DeValue::String(string) => _ = write!(text, "{string:?}"),
        DeValue::Boolean(boolean) => _ = write!(text, "{boolean}"),
        DeValue::Datetime(datetime) => _ = write!(text, "{datetime}"),
        // 7 and 7.0 are one number wherever both may stand.
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(number) => _ = write!(text, "{number}"),
            Err(_) => _ = write!(text, "{}:{}", integer.radix(), integer.as_str()),
        },
        DeValue::Float(float) => match float.as_str().parse::<f64>() {
            Ok(number) => _ = write!(text, "{number}"),
            Err(_) => text.push_str(float.as_str()),
        },
        DeValue::Array(list) => {
            text.push('[');
            for element in list {
                write_value(element.get_ref(), text);
                text.push(',');
            }
            text.push(']');
        }
        DeValue::Table(table) => {
            let mut keys: Vec<(&str, &Spanned<DeValue<'_>>)> = table.iter().map(|(key, value)| (&**key.get_ref(), value)).collect();
            keys.sort_unstable_by_key(|(key, _)| *key);
            text.push('{');
            for (key, value) in keys {
                _ = write!(text, "{key:?}=");
                write_value(value.get_ref(), text);
                text.push(',');
            }
            text.push('}');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolved(text: &str) -> Resolved {
        Resolved::of(DeTable::parse(text).unwrap().get_ref())
    }

    #[test]
    fn what_says_the_same_is_the_same() {
        let one = resolved("why = \"a\"\nseed = 7\ntrials = 3\n[optics]\nblur = 0.7\nfill = [1, 2]\n[[method]]\nname = \"pixel\"\n");
        let same = resolved(
            "# words\nseed = 0x7\ntrials = 30\nwhy = \"\"\"b\"\"\"\noptics.fill = [\n  1.0, +2, # two\n]\noptics.blur = 7e-1\n[[method]]\nname = \"lsm\"\n",
        );
        assert_eq!(one, same);
        assert!(one.points.contains("\"seed\"=7") && one.adjusted.is_empty(), "{}", one.points);
    }

    #[test]
    fn whatever_else_differs_is_told_apart() {
        let text = "seed = 7\nshade = \"a\"\non = true\nlist = [1, 2]\ntable = { a = 1, b = 2 }\n[[station]]\nname = \"x\"\n";
        let one = resolved(text);
        for (old, new) in [
            ("7", "8"),
            ("\"a\"", "\"b\""),
            ("true", "false"),
            ("[1, 2]", "[2, 1]"),
            ("[1, 2]", "[1, 2, 2]"),
            ("[1, 2]", "[12]"),
            ("[1, 2]", "[[1], 2]"),
            ("b = 2", "c = 2"),
            ("b = 2", "b = \"2\""),
            ("b = 2", "b = 2.0000000000000004"),
            ("\"x\"", "\"y\""),
            ("[[station]]\n", "[[station]]\nroll = 0\n"),
        ] {
            assert_ne!(one, resolved(&text.replacen(old, new, 1)), "{old} {new}");
        }
    }

    #[test]
    fn what_is_made_of_points_stands_apart() {
        let text = |sets: &str| format!("seed = 1\n[calibration]\nsets = {sets}\n[[block]]\nname = \"b\"\n");
        let [one, other] = [text("[\"c\"]"), text("[\"c,k1\"]")].map(|text| resolved(&text));
        assert!(one.points == other.points && one.adjusted != other.adjusted);
    }
}
