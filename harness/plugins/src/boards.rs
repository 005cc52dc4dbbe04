//! What a plug-in that finds boards answers: points by name.

use std::collections::{HashMap, HashSet};

use calibench_diagnostics::nearest;
use calibench_measure::{BoardPointFound, Sought};
use calibench_model::{PixelPoint, Rejection};

use crate::answer::{Answer, Fault};

/// The points of a board in an answer, where the centre of the first pixel is (0, 0); those without a position are left out.
///
/// # Errors
/// Positions without names, names that the board does not have or that stand twice.
pub fn points_of(answer: &Answer, sought: &Sought, from_corner: bool) -> Result<Vec<BoardPointFound>, Fault> {
    let malformed = |message: String| Fault::new(Rejection::Malformed, message);
    let Answer { points, names, .. } = answer;
    if names.len() != points.len() {
        return Err(malformed(format!(
            "expected `names`, one for each position, as in {{\"names\": [\"{}\"], \"xy\": [[1.5, 2.5]]}}",
            sought.layout.points[0].id
        )));
    }
    let known: HashMap<&str, usize> = sought.layout.points.iter().enumerate().map(|(index, point)| (point.id.as_str(), index)).collect();
    let (mut seen, mut found) = (HashSet::new(), Vec::new());
    let half = if from_corner { 0.5 } else { 0.0 };
    for (name, point) in names.iter().zip(points) {
        let Some(&index) = known.get(name.as_str()) else {
            let near = nearest(name, sought.layout.points.iter().map(|point| point.id.as_str()))
                .map_or_else(String::new, |near| format!(", did you mean `{near}`?"));
            return Err(malformed(format!("the board `{}` has no point `{name}`{near}", sought.board)));
        };
        if !seen.insert(index) {
            return Err(malformed(format!("the point `{name}` stands twice; expected each once")));
        }
        if let Ok(measured) = point {
            found.push(BoardPointFound { index, position: PixelPoint::new(measured.position.x - half, measured.position.y - half) });
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::read;

    fn points(line: &str, from_corner: bool) -> Result<Vec<(usize, f64, f64)>, Fault> {
        let sought = Sought::new("charuco:4x3:30:21:DICT_4X4_50".parse().unwrap()).unwrap();
        let found = points_of(&read(line, 1, None, 100).unwrap(), &sought, from_corner)?;
        Ok(found.into_iter().map(|point| (point.index, point.position.x, point.position.y)).collect())
    }

    #[test]
    fn points_are_found_by_name_from_either_origin() {
        let line = r#"{"image": 1, "names": ["r2c1", "r1c3", "r1c1"], "xy": [[10, 20], null, [5.5, 6.5]]}"#;
        assert_eq!(points(line, false), Ok(vec![(3, 10.0, 20.0), (0, 5.5, 6.5)]));
        assert_eq!(points(line, true), Ok(vec![(3, 9.5, 19.5), (0, 5.0, 6.0)]));
        assert_eq!(points(r#"{"image": 1, "xy": [], "names": []}"#, false), Ok(Vec::new()));
    }

    #[test]
    fn names_that_do_not_fit_are_named() {
        for (line, expected) in [
            (r#"{"image": 1, "xy": [[10, 20]]}"#, "expected `names`"),
            (r#"{"image": 1, "names": ["r9c9"], "xy": [[10, 20]]}"#, "has no point `r9c9`"),
            (r#"{"image": 1, "names": ["r1c1", "r1c1"], "xy": [[10, 20], [11, 20]]}"#, "stands twice"),
        ] {
            let fault = points(line, false).unwrap_err();
            assert!(fault.rejection == Rejection::Malformed && fault.message.contains(expected), "{fault:?}");
        }
    }
}
