//! The kinds of target that a method is limited to.

use std::fmt;

use calibench_model::{TargetKind, UnknownKind};
use thiserror::Error;

use crate::registry::Configured;

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

/// How methods and kinds of target do not go together.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum KindsGap {
    /// Targets that nobody measures.
    #[error("no method measures targets of the kind {}; add a method for them (`pixel` returns their start), or leave them out", .0.iter().map(|kind| format!("`{kind}`")).collect::<Vec<_>>().join(", "))]
    Unmeasured(Vec<TargetKind>),
    /// A method without targets.
    #[error("`{label}` has nothing to measure: there are only targets of the kind {}", there.iter().map(|kind| format!("`{kind}`")).collect::<Vec<_>>().join(", "))]
    Idle {
        /// The method's place among the methods.
        index: usize,
        /// The method.
        label: String,
        /// The kinds that there are.
        there: Vec<TargetKind>,
    },
    /// A kind that one operator with the same parameters is to measure twice.
    #[error("`{label}` is to measure `{kind}` twice, here and as `{earlier}`; expected each kind once")]
    Twice {
        /// The method.
        label: String,
        /// The earlier method.
        earlier: String,
        /// The kind.
        kind: TargetKind,
    },
}

/// The kinds among `targets` that none of `methods` measures, in the order of [`TargetKind::ALL`].
pub fn unmeasured(methods: &[Configured], targets: impl IntoIterator<Item = TargetKind>) -> Vec<TargetKind> {
    let there: Vec<TargetKind> = targets.into_iter().collect();
    let nobody = |kind: &TargetKind| there.contains(kind) && !methods.iter().any(|method| method.measures(Some(*kind)));
    TargetKind::ALL.into_iter().filter(nobody).collect()
}

/// Whether every method has targets of its kinds among `targets`.
///
/// # Errors
/// [`KindsGap::Idle`].
pub fn all_busy(methods: &[Configured], targets: impl IntoIterator<Item = TargetKind>) -> Result<(), KindsGap> {
    let all: Vec<TargetKind> = targets.into_iter().collect();
    let there: Vec<TargetKind> = TargetKind::ALL.into_iter().filter(|kind| all.contains(kind)).collect();
    let idle = |method: &Configured| method.kinds.is_some() && !there.iter().any(|kind| method.measures(Some(*kind)));
    match methods.iter().position(idle) {
        Some(index) => Err(KindsGap::Idle { index, label: methods[index].label.clone(), there }),
        None => Ok(()),
    }
}

/// Whether every one of the targets `here` has a method, and every method targets of its kinds among those `anywhere`: in all cells of a sweep.
///
/// # Errors
/// [`KindsGap::Idle`], [`KindsGap::Unmeasured`].
pub fn cover(methods: &[Configured], here: &[TargetKind], anywhere: &[TargetKind]) -> Result<(), KindsGap> {
    all_busy(methods, anywhere.iter().copied())?;
    let left = unmeasured(methods, here.iter().copied());
    if left.is_empty() { Ok(()) } else { Err(KindsGap::Unmeasured(left)) }
}

/// Whether no kind is measured twice by `method` and the same operator with the same parameters among `earlier`.
///
/// # Errors
/// [`KindsGap::Twice`].
pub fn distinct(earlier: &[Configured], method: &Configured) -> Result<(), KindsGap> {
    let mut same = earlier.iter().filter(|earlier| earlier.unlimited_label == method.unlimited_label);
    let kind_of = |earlier: &Configured| {
        let both = |kind: &TargetKind| earlier.measures(Some(*kind)) && method.measures(Some(*kind));
        TargetKind::ALL.into_iter().find(both).map(|kind| (earlier.label.clone(), kind))
    };
    match same.find_map(kind_of) {
        Some((earlier, kind)) => Err(KindsGap::Twice { label: method.label.clone(), earlier, kind }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Registry;
    use TargetKind::{ChessCorner, Corner, Cross, Disc, Square};

    fn configured(texts: &[&str]) -> Vec<Configured> {
        texts.iter().map(|text| Registry::builtin().parse(text).unwrap()).collect()
    }

    #[test]
    fn kinds_are_written_in_one_order() {
        assert_eq!(Kinds::parse("disc + corner").unwrap().to_string(), "corner+disc");
        assert_eq!(Kinds::parse("disc+disc"), Err(KindsError::Twice(Disc)));
        assert_eq!([Kinds::parse(" "), Kinds::new([])], [Err(KindsError::None), Err(KindsError::None)]);
        let unknown = Kinds::parse("disk").unwrap_err().to_string();
        assert_eq!(unknown, "no kind of target is called `disk`; known are corner, chess_corner, junction, cross, disc, square, triangle");
    }

    #[test]
    fn a_method_without_kinds_measures_all_and_points_of_no_kind() {
        let methods = configured(&["forstner", "disc+square=centroid"]);
        assert!(methods[0].measures(None) && methods[0].measures(Some(Disc)));
        assert_eq!([None, Some(Disc), Some(Square), Some(Cross)].map(|kind| methods[1].measures(kind)), [false, true, true, false]);
    }

    #[test]
    fn targets_without_a_method_and_methods_without_a_target_are_found() {
        let methods = configured(&["disc=parametric_circle", "chess_corner=parametric_corner"]);
        assert_eq!(unmeasured(&methods, [Square, Disc, Corner, Square]), [Corner, Square]);
        assert_eq!(cover(&methods, &[Disc, ChessCorner], &[Disc, ChessCorner]), Ok(()));
        assert_eq!(cover(&methods, &[Disc], &[Disc, ChessCorner]), Ok(()), "idle here, not everywhere");
        assert_eq!(cover(&methods, &[Disc, ChessCorner, Cross], &[Disc, ChessCorner, Cross]), Err(KindsGap::Unmeasured(vec![Cross])));
        let idle = cover(&methods, &[Disc, Disc], &[Disc, Disc]).unwrap_err();
        assert_eq!(
            idle.to_string(),
            "`parametric_corner:window=15,kinds=chess_corner` has nothing to measure: there are only targets of the kind `disc`"
        );
        assert_eq!(cover(&configured(&["forstner"]), &[Cross], &[Cross]), Ok(()));
        assert_eq!(cover(&configured(&["forstner"]), &[], &[]), Ok(()));
    }

    #[test]
    fn the_same_operator_measures_a_kind_once() {
        let methods = configured(&["corner+cross=forstner:window=15"]);
        let against = |text: &str| distinct(&methods, &configured(&[text])[0]).is_ok();
        assert!(against("disc=forstner:window=15") && against("cross=forstner:window=11") && against("cross=saddle"));
        assert!(!against("cross+disc=forstner:window=15") && !against("forstner:window=15"));
    }
}
