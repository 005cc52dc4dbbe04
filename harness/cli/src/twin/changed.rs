//! A twin with something changed: what would be if.

use calibench_twin::Design;
use toml::{Table, Value};

use super::rendered::Studio;
use crate::failure::Failure;

/// What is asked for unless something else is.
pub const USUAL: [&str; 3] = ["light=4", "blur=0.5", "raw"];

/// Something that is changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// As it was asked for.
    pub asked: String,
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// So many times the light.
    Light(f64),
    /// So many times the blur, motions included.
    Blur(f64),
    /// No JPEG, no sharpening, no smoothing of noise.
    Raw,
    /// A key of the scenario.
    Key(Vec<String>, Value),
}

/// What can be asked for, in words.
const EXPECTED: &str = "expected light=4, blur=0.5, raw, or a key of the scenario with a value, as in optics.blur=0.5";

/// Reads `--what-if`.
pub fn change(text: &str) -> Result<Change, String> {
    let factor =
        |value: &str| value.parse::<f64>().ok().filter(|factor| (0.01..=100.0).contains(factor)).ok_or("expected a factor of 0.01 to 100");
    let kind = match text.split_once('=') {
        None if text == "raw" => Kind::Raw,
        None => return Err(EXPECTED.to_owned()),
        Some(("light", value)) => Kind::Light(factor(value)?),
        Some(("blur", value)) => Kind::Blur(factor(value)?),
        Some((key, value)) => {
            let path: Vec<String> = key.split('.').map(str::to_owned).collect();
            if path.len() != 2 || path.iter().any(String::is_empty) {
                return Err(EXPECTED.to_owned());
            }
            let parsed: Table = format!("value = {value}").parse().map_err(|_| format!("`{value}` is no value of TOML; {EXPECTED}"))?;
            Kind::Key(path, parsed.get("value").cloned().ok_or_else(|| EXPECTED.to_owned())?)
        }
    };
    Ok(Change { asked: text.to_owned(), kind })
}

impl Change {
    /// What it means, in words.
    pub fn words(&self) -> String {
        match &self.kind {
            Kind::Light(factor) => format!("{factor} times the light"),
            Kind::Blur(factor) => format!("{factor} times the blur"),
            Kind::Raw => "raw, no JPEG and no processing".into(),
            Kind::Key(..) => format!("`{}`", self.asked),
        }
    }

    /// The scenario of a twin so changed.
    pub fn text(&self, studio: &Studio<'_>, design: &Design) -> Result<String, Failure> {
        let mut design = design.clone();
        match &self.kind {
            Kind::Light(factor) => {
                // Of the same exposure with so many times the electrons: photon noise falls with their number, read noise with its square.
                design.noise.slope /= factor;
                design.noise.dark /= factor * factor;
            }
            Kind::Blur(factor) => {
                design.views.iter_mut().for_each(|view| view.blur.iter_mut().for_each(|variance| *variance *= factor * factor));
                design.corner *= factor * factor;
            }
            Kind::Raw => {
                (design.smoothing, design.halo) = (0.0, design.halo.min(0.0));
                return Ok(studio.raw().text(&design));
            }
            Kind::Key(path, value) => return self.keyed(&studio.text(&design), path, value),
        }
        Ok(studio.text(&design))
    }

    fn keyed(&self, text: &str, path: &[String], value: &Value) -> Result<String, Failure> {
        let wrong = |why: &str| Failure::input(format!("--what-if {}: {why}", self.asked));
        let mut root: Table = text.parse().map_err(|_| wrong("the twin's scenario cannot be read"))?;
        let (table, key) = (&path[0], &path[1]);
        match root.get_mut(table) {
            Some(Value::Table(section)) => drop(section.insert(key.clone(), value.clone())),
            Some(Value::Array(sections)) => {
                sections.iter_mut().filter_map(Value::as_table_mut).for_each(|section| drop(section.insert(key.clone(), value.clone())));
            }
            _ => return Err(wrong(&format!("the twin has no [{table}]; it has {}", root.keys().cloned().collect::<Vec<_>>().join(", ")))),
        }
        // Stations have a blur and a motion of their own, which would hide the one that is asked for.
        if table == "optics"
            && let Some(Value::Array(stations)) = root.get_mut("station")
        {
            stations.iter_mut().filter_map(Value::as_table_mut).for_each(|station| drop(station.remove(key)));
        }
        toml::to_string(&root).map_err(|error| wrong(&error.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_asked_for_is_read_or_said() {
        assert!(USUAL.iter().all(|text| change(text).is_ok()));
        assert_eq!(change("optics.blur=0.5").unwrap().kind, Kind::Key(vec!["optics".into(), "blur".into()], Value::Float(0.5)));
        for bad in ["", "light", "light=0", "light=x", "blur=-1", "optics=1", "optics.blur=", "a.b.c=1", "optics.blur=half"] {
            assert!(change(bad).is_err(), "{bad}");
        }
    }
}
