//! What a FileStorage says of the kind of its lens, under the names that people give it.

use super::number::shortened;
use super::tree::Entry;
use super::{CameraFileError, ReadOptions};

/// Yes or no.
const FISHEYE: [&str; 3] = ["fisheye_model", "is_fisheye", "fisheye"];
/// A name.
const MODEL: [&str; 8] =
    ["distortion_model", "camera_model", "lens_model", "projection_model", "distortion_type", "camera_type", "lens_type", "model"];

/// Kinds of lenses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Pinhole,
    Fisheye,
    Omnidirectional,
}

/// The keys that say it.
pub(super) fn keys() -> impl Iterator<Item = &'static str> {
    FISHEYE.into_iter().chain(MODEL)
}

/// The kind that the storage says and the user asks for, if any says it.
///
/// # Errors
/// A kind that is not known, and two that contradict each other.
pub(super) fn kind(root: &Entry, options: &ReadOptions) -> Result<Option<Kind>, CameraFileError> {
    let mut found: Option<(Kind, String)> = options.fisheye.map(|fisheye| {
        let kind = if fisheye { Kind::Fisheye } else { Kind::Pinhole };
        (kind, "the model that was asked for".to_owned())
    });
    let is_ignored = |name: &str| options.ignore.iter().any(|ignored| ignored == name);
    for (name, entry) in root.entries()?.iter().filter(|(name, _)| keys().any(|key| key == name) && !is_ignored(name)) {
        let kind =
            of(name, entry.text().map_err(|error| error.of(name.as_str()))?).map_err(|problem| entry.wrong(&problem).of(name.as_str()))?;
        match &found {
            Some((before, whose)) if *before != kind => return Err(entry.wrong(&format!("contradicts {whose}")).of(name.as_str())),
            Some(_) => {}
            None => found = Some((kind, format!("`{name}`"))),
        }
    }
    Ok(found.map(|(kind, _)| kind))
}

fn of(key: &str, text: &str) -> Result<Kind, String> {
    let plain: String = text.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_lowercase();
    if FISHEYE.contains(&key) {
        return match plain.as_str() {
            "0" | "false" | "no" => Ok(Kind::Pinhole),
            "1" | "true" | "yes" => Ok(Kind::Fisheye),
            _ => Err("expected 0 or 1".into()),
        };
    }
    match plain.as_str() {
        "pinhole" | "plumbbob" | "radtan" | "radialtangential" | "brown" | "brownconrady" | "opencv" | "perspective" | "rational"
        | "rationalpolynomial" | "standard" => Ok(Kind::Pinhole),
        "fisheye" | "equidistant" | "equi" | "kannalabrandt" | "kannalabrandt4" | "kb" | "kb4" | "opencvfisheye" => Ok(Kind::Fisheye),
        "omni" | "omnidir" | "omnidirectional" | "mei" => Ok(Kind::Omnidirectional),
        _ => Err(format!(
            "`{}` is not known; expected pinhole, plumb_bob, rational_polynomial, fisheye, equidistant or omnidirectional",
            shortened(text)
        )),
    }
}
