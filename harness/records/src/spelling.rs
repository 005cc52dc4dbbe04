//! Settings as they were written before choices had names: files of calibench 0.2.0 and older have numbers in their place.

use serde::{Deserialize, Deserializer};

/// The choices of operators whose value was a place in a list: operator, parameter, names.
const NAMED: [(&str, &str, &[&str]); 17] = [
    ("lsm", "shape", &["start", "corner", "chess_corner", "junction", "cross", "disc", "square", "triangle"]),
    ("lsm", "sharpness", &["held", "sought"]),
    ("lsm", "neighbours", &["counted", "left_out"]),
    ("forstner", "covariance", &["scatter", "noise"]),
    ("centroid_binary", "polarity", &["border", "dark", "light"]),
    ("centroid", "polarity", &["border", "dark", "light"]),
    ("parametric_corner", "gradient", &["none", "added", "light", "both"]),
    ("parametric_corner", "curvature", &["no", "yes"]),
    ("parametric_junction", "gradient", &["none", "added", "light", "sectors"]),
    ("chess_corners", "detector", &["chess", "radon"]),
    ("chess_corners", "refiner", &["own", "saddle"]),
    ("opencv_chessboard_sb", "accuracy", &["no", "yes"]),
    ("opencv_chessboard_sb", "exhaustive", &["no", "yes"]),
    ("opencv_chessboard_sb", "normalize", &["no", "yes"]),
    ("opencv_find_chessboard", "sb", &["no", "yes"]),
    ("opencv_find_aprilgrid", "refinement", &["none", "subpix", "contour", "apriltag"]),
    ("", "corrected", &["no", "yes"]),
];

/// A method's label as it is written today.
pub fn present_label(label: &str) -> String {
    match label.split_once(':') {
        Some((operator, settings)) => format!("{operator}:{}", present_settings(operator, settings)),
        None => label.to_owned(),
    }
}

/// Settings of an operator, as `window=15,shape=2`, as they are written today.
pub fn present_settings(operator: &str, settings: &str) -> String {
    settings.split(',').map(|setting| present(operator, setting)).collect::<Vec<_>>().join(",")
}

/// Reads a label, for serde.
///
/// # Errors
/// What is no text.
pub fn label<'de, D: Deserializer<'de>>(written: D) -> Result<String, D::Error> {
    String::deserialize(written).map(|label| present_label(&label))
}

/// Reads a label that may be absent, for serde.
///
/// # Errors
/// What is no text.
pub fn optional_label<'de, D: Deserializer<'de>>(written: D) -> Result<Option<String>, D::Error> {
    Ok(Option::<String>::deserialize(written)?.map(|label| present_label(&label)))
}

fn present(operator: &str, setting: &str) -> String {
    let name = || {
        let (key, value) = setting.split_once('=')?;
        let (.., names) = NAMED
            .iter()
            .find(|(of, parameter, _)| (*of == operator || of.is_empty() && operator.starts_with("opencv_find_")) && *parameter == key)?;
        Some(format!("{key}={}", names.get(value.parse::<usize>().ok()?)?))
    };
    name().unwrap_or_else(|| setting.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_choices_become_names_and_nothing_else_changes() {
        for (old, now) in [
            ("lsm:window=15,shape=2,neighbours=0,kinds=corner", "lsm:window=15,shape=chess_corner,neighbours=counted,kinds=corner"),
            ("opencv_find_aprilgrid:refinement=1,corrected=1", "opencv_find_aprilgrid:refinement=subpix,corrected=yes"),
            ("opencv_find_charuco:corrected=1", "opencv_find_charuco:corrected=yes"),
            ("forstner:window=2", "forstner:window=2"),
            ("mine:shape=2,corrected=1", "mine:shape=2,corrected=1"),
            ("lsm:window=15,shape=disc", "lsm:window=15,shape=disc"),
            ("lsm:shape=9", "lsm:shape=9"),
            ("pixel", "pixel"),
        ] {
            assert_eq!(present_label(old), now);
        }
        assert_eq!(present_settings("lsm", ""), "");
    }
}
