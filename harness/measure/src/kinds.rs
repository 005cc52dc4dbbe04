//! The kinds of target that a method is limited to.

use std::fmt;

use calibench_model::{TargetKind, UnknownKind};
use thiserror::Error;

/// The kinds of target that a method is limited to: each once, in the order of [`TargetKind::ALL`], at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kinds(Vec<TargetKind>);

/// Kinds that limit nothing.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum KindsError {
    /// A name that no kind has.
    #[error(transparent)]
    Unknown(#[from] UnknownKind),
    /// A kind that is named twice.
    #[error("the kind `{0}` is given twice; expected each once")]
    Twice(TargetKind),
    /// No kind at all.
    #[error("no kind of target is given; expected at least one of {}", TargetKind::ALL.map(TargetKind::name).join(", "))]
    None,
}

impl Kinds {
    /// The kinds of these names.
    ///
    /// # Errors
    /// An unknown name, a kind twice, no kind.
    pub fn new<'n>(names: impl IntoIterator<Item = &'n str>) -> Result<Self, KindsError> {
        let mut kinds = Vec::new();
        for name in names {
            let kind: TargetKind = name.parse()?;
            if kinds.contains(&kind) {
                return Err(KindsError::Twice(kind));
            }
            kinds.push(kind);
        }
        kinds.sort_by_key(|kind| TargetKind::ALL.iter().position(|known| known == kind));
        if kinds.is_empty() { Err(KindsError::None) } else { Ok(Self(kinds)) }
    }

    /// The kinds in a text, as in `corner+cross`.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn parse(text: &str) -> Result<Self, KindsError> {
        if text.trim().is_empty() { Err(KindsError::None) } else { Self::new(text.split('+').map(str::trim)) }
    }

    /// The kinds.
    pub fn iter(&self) -> impl Iterator<Item = TargetKind> + '_ {
        self.0.iter().copied()
    }
}

impl fmt::Display for Kinds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.iter().map(|kind| kind.name()).collect::<Vec<_>>().join("+"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use TargetKind::Disc;

    #[test]
    fn kinds_are_written_in_one_order() {
        assert_eq!(Kinds::parse("disc + corner").unwrap().to_string(), "corner+disc");
        assert_eq!(Kinds::parse("disc+disc"), Err(KindsError::Twice(Disc)));
        assert_eq!([Kinds::parse(" "), Kinds::new([])], [Err(KindsError::None), Err(KindsError::None)]);
        let unknown = Kinds::parse("disk").unwrap_err().to_string();
        assert_eq!(unknown, "no kind of target is called `disk`; known are corner, chess_corner, junction, cross, disc, square, triangle");
    }
}
