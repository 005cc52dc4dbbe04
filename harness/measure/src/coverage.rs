//! Which targets have a method, and which methods have targets.

use calibench_model::TargetKind;
use thiserror::Error;

use crate::registry::Configured;

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
