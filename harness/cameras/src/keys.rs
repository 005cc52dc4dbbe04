//! Keys that no reader knows: within the block that describes a lens they are mistakes, elsewhere they are noted.

use super::tree::{Entry, Value, all_left_out, left_out};
use super::{CameraFileError, ReadOptions};

/// Words of keys that say which lens it is, wherever in a file they stand.
const OF_LENSES: [&str; 9] = ["model", "lens", "fisheye", "distortion", "projection", "equidistant", "omnidirectional", "skew", "xi"];

/// Whether a key outside a lens's block speaks of the lens: one of its words does.
fn is_of_lens(name: &str) -> bool {
    words(name).iter().any(|word| OF_LENSES.contains(&word.as_str()))
}

/// The words of a name: `distCoeffs_left` is dist, coeffs, left. Digits are words of their own.
pub(super) fn words(name: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut before = ' ';
    for c in name.chars() {
        let begins =
            (c.is_uppercase() && before.is_lowercase()) || c.is_ascii_digit() != before.is_ascii_digit() || !before.is_alphanumeric();
        if c.is_alphanumeric() {
            if begins {
                found.push(String::new());
            }
            if let Some(word) = found.last_mut() {
                word.extend(c.to_lowercase());
            }
        }
        before = c;
    }
    found
}

/// What is wrong with a key of a lens that no reader knows; `known` are those it knows there.
fn mistake(name: &str, known: &[&str]) -> CameraFileError {
    let known: Vec<&str> = known.iter().copied().filter(|name| !name.is_empty()).collect();
    let expected = if known.is_empty() { String::new() } else { format!("; known there are {}", known.join(", ")) };
    CameraFileError::new(format!(
        "is no key that is known of a lens, and without it the camera may be another{expected}. `calibench convert --ignore-key NAME` leaves one out"
    ))
    .of(super::number::shortened(name))
}

impl ReadOptions {
    /// The notes on keys of a lens's block that are not among `known`.
    ///
    /// # Errors
    /// The first one that the user did not say to leave out; `at` puts it in its place.
    pub(super) fn of_lens<'a, T>(
        &self,
        names: impl Iterator<Item = (&'a str, T)>,
        known: &[&str],
        at: impl Fn(T, CameraFileError) -> CameraFileError,
    ) -> Result<Vec<String>, CameraFileError> {
        let mut notes = Vec::new();
        for (name, place) in names.filter(|(name, _)| !known.contains(name)) {
            if !self.ignore.iter().any(|ignored| ignored == name) {
                return Err(at(place, mistake(name, known)));
            }
            notes.push(left_out(name));
        }
        Ok(notes)
    }

    /// The note on keys beside a lens's block that no reader knows, if there are any.
    ///
    /// # Errors
    /// The first one that speaks of the lens, if the user did not say to leave it out; `at` puts it in its place.
    pub(super) fn of_file<'a, T>(
        &self,
        names: impl Iterator<Item = (&'a str, T)>,
        at: impl Fn(T, CameraFileError) -> CameraFileError,
    ) -> Result<Vec<String>, CameraFileError> {
        let (of_lens, others): (Vec<_>, Vec<_>) = names.partition(|(name, _)| is_of_lens(name));
        let mut notes = self.of_lens(of_lens.into_iter(), &[], at)?;
        notes.extend(all_left_out(others.into_iter().map(|(name, _)| name)));
        Ok(notes)
    }
}

impl Entry {
    /// Notes on the names of a lens's block that are not among `known`.
    ///
    /// # Errors
    /// An entry without names, and a name that the user did not say to leave out.
    pub fn of_lens(&self, known: &[&str], options: &ReadOptions) -> Result<Vec<String>, CameraFileError> {
        let names = self.entries()?.iter().map(|(name, entry)| (name.as_str(), entry.line));
        options.of_lens(names, known, |line, error| error.on_line(line))
    }

    /// A note on names that are not among `known` where a file holds other things than the lens. Matrices and groups are no switches of a model.
    ///
    /// # Errors
    /// An entry without names, and a name that speaks of the lens and that the user did not say to leave out.
    pub fn of_file(&self, known: &[&str], options: &ReadOptions) -> Result<Vec<String>, CameraFileError> {
        let unknown = self.entries()?.iter().filter(|(name, _)| !known.contains(&name.as_str()));
        let (switches, others): (Vec<_>, Vec<_>) = unknown.partition(|(_, entry)| matches!(entry.value, Value::Scalar(_)));
        let switches = switches.into_iter().map(|(name, entry)| (name.as_str(), entry.line));
        let mut notes = options.of_file(switches, |line, error| error.on_line(line))?;
        notes.extend(all_left_out(others.into_iter().map(|(name, _)| name.as_str())));
        Ok(notes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_told_apart() {
        assert_eq!(words("distCoeffs_left"), ["dist", "coeffs", "left"]);
        assert_eq!(words("M1"), ["m", "1"]);
        assert_eq!(words("cam0.K"), ["cam", "0", "k"]);
        for (name, of_lens) in
            [("lens_model", true), ("isFisheye", true), ("xi", true), ("maximum", false), ("rms", false), ("aabb_scale", false)]
        {
            assert_eq!(is_of_lens(name), of_lens, "{name}");
        }
    }
}
