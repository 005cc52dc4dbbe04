//! The targets of a coded field as approximate positions.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use calibench_model::{Image, PointRow, Start, Testfield};
use calibench_recognise::{NotRecognised, Reason, Recogniser, Recognition};
use rayon::prelude::*;

use crate::names::{names, once};
use crate::{PhotographsError, Reader};

/// What was recognised of a field in a photograph.
#[derive(Clone, Debug, PartialEq)]
pub struct Coded {
    /// Its targets, with kind and affine map, in the field's order.
    pub rows: Vec<PointRow>,
    /// Whole squares that were identified.
    pub squares: usize,
    /// What was not recognised of them.
    pub lost: Lost,
}

/// How often something in whole squares was not recognised, by the name of the reason.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lost {
    /// Targets that the field lists.
    pub targets: BTreeMap<&'static str, usize>,
    /// Squares of which none was recognised.
    pub squares: BTreeMap<&'static str, usize>,
}

impl Lost {
    fn of(found: &Recognition) -> Self {
        let mut lost = Self::default();
        for rejected in &found.rejected {
            let of = match (rejected.target, rejected.reason) {
                (Some(_), _) => &mut lost.targets,
                (None, Reason::Contradicts | Reason::Outside) => &mut lost.squares,
                // Targets that are not listed; squares whose targets speak for themselves.
                (None, _) => continue,
            };
            *of.entry(rejected.reason.name()).or_default() += 1;
        }
        lost
    }

    /// Whether nothing was lost.
    pub fn is_empty(&self) -> bool {
        self.targets.is_empty() && self.squares.is_empty()
    }
}

impl fmt::Display for Lost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        for (of, [one, more]) in [(&self.targets, ["target", "targets"]), (&self.squares, ["square", "squares"])] {
            let count: usize = of.values().sum();
            if count > 0 {
                let reasons: Vec<String> = of.iter().map(|(reason, count)| format!("{reason} {count}")).collect();
                parts.push(format!("{count} {} rejected ({})", if count == 1 { one } else { more }, reasons.join(", ")));
            }
        }
        f.write_str(&parts.join(", "))
    }
}

/// The targets of `field`, which `recogniser` knows, in photographs, or why they do not show it; `step` is called after each, on any thread.
///
/// # Errors
/// A photograph that cannot be read, or that is given twice.
pub fn recognise_coded(
    reader: &Reader,
    field: &Testfield,
    recogniser: &Recogniser,
    step: &(dyn Fn() + Sync),
) -> Result<Vec<Result<Coded, NotRecognised>>, PhotographsError> {
    let photos = reader.photos();
    once(photos)?;
    let one = |(path, name): (&PathBuf, &String)| {
        let image = reader.read(path)?;
        let found = coded_of(field, recogniser, &image, name);
        step();
        Ok(found)
    };
    photos.par_iter().zip(&names(photos)).map(one).collect()
}

/// The targets of `field` in the photograph `name`.
///
/// # Errors
/// Why it does not show the field.
pub fn coded_of(field: &Testfield, recogniser: &Recogniser, image: &Image, name: &str) -> Result<Coded, NotRecognised> {
    let found = recogniser.recognise(image)?;
    let row = |recognised: &calibench_recognise::Recognised| PointRow {
        image: name.to_owned(),
        target: field.targets[recognised.target].id.clone(),
        start: Start { kind: Some(recognised.kind), affine: Some(recognised.affine), ..Start::at(recognised.position) },
    };
    let squares = found.squares.iter().filter(|square| square.place.is_some()).count();
    Ok(Coded { rows: found.targets.iter().map(row).collect(), squares, lost: Lost::of(&found) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_lost_is_told_by_reason() {
        let mut lost = Lost::default();
        assert!(lost.is_empty());
        lost.targets.extend([("missing", 2), ("unlike", 1)]);
        lost.squares.insert("outside", 1);
        assert_eq!(lost.to_string(), "3 targets rejected (missing 2, unlike 1), 1 square rejected (outside 1)");
    }
}
