//! The layout of one sheet: its targets lie on it, and apart.

use calibench_model::testfield::{Outline, PlatePoint};
use calibench_model::{PixelPoint, Polygon};

use super::FieldError;
use super::outline::{bounds, polygon};
use crate::overlap::overlap;

/// How much an outline may reach over the sheet's border, as a fraction of the sheet: rounding.
const ROUNDING: f64 = 1e-12;

/// A target's outlines with the box around them.
struct Placed<'a> {
    id: &'a str,
    low: PlatePoint,
    high: PlatePoint,
    polygons: Vec<Polygon>,
}

/// Refuses targets (names and outlines) that are not wholly on the sheet `plate` of these `corners`, or that overlap.
///
/// Takes time in proportion to the targets and to the pairs whose boxes meet in u.
///
/// # Errors
/// [`FieldError::OffPlate`] for a target that reaches over the border, [`FieldError::Overlap`] for the first pair that overlaps.
pub fn check(plate: &str, corners: [PlatePoint; 2], targets: &[(&str, Vec<Outline>)]) -> Result<(), FieldError> {
    let mut placed: Vec<Placed<'_>> = targets.iter().map(|(id, outlines)| place(id, outlines)).collect();
    let slack = ROUNDING * (corners[1][0] - corners[0][0]).max(corners[1][1] - corners[0][1]);
    let outside = |t: &&Placed<'_>| (0..2).any(|i| t.low[i] < corners[0][i] - slack || t.high[i] > corners[1][i] + slack);
    if let Some(target) = placed.iter().find(outside) {
        return Err(FieldError::OffPlate { target: target.id.into(), plate: plate.into() });
    }
    placed.sort_by(|a, b| a.low[0].total_cmp(&b.low[0]));
    for (i, a) in placed.iter().enumerate() {
        let near = placed[i + 1..].iter().take_while(|b| b.low[0] <= a.high[0]);
        for b in near.filter(|b| b.low[1] <= a.high[1] && a.low[1] <= b.high[1]) {
            if let Some(at) = meet(a, b) {
                return Err(FieldError::Overlap { first: a.id.into(), second: b.id.into(), plate: plate.into(), at });
            }
        }
    }
    Ok(())
}

fn place<'a>(id: &'a str, outlines: &[Outline]) -> Placed<'a> {
    let start = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let (low, high) = outlines
        .iter()
        .map(bounds)
        .fold(start, |(low, high), [l, h]| ([low[0].min(l[0]), low[1].min(l[1])], [high[0].max(h[0]), high[1].max(h[1])]));
    Placed { id, low, high, polygons: outlines.iter().map(polygon).collect() }
}

fn meet(a: &Placed<'_>, b: &Placed<'_>) -> Option<PixelPoint> {
    a.polygons.iter().find_map(|p| b.polygons.iter().find_map(|q| overlap(p, q)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn discs(centres: &[PlatePoint]) -> Vec<(&'static str, Vec<Outline>)> {
        centres.iter().zip(["a", "b", "c"]).map(|(&centre, id)| (id, vec![Outline::disc(centre, 1.0)])).collect()
    }

    #[test]
    fn targets_are_on_the_sheet_and_apart() {
        let sheet = [[0.0, 0.0], [10.0, 10.0]];
        assert_eq!(check("p", sheet, &discs(&[[1.0, 1.0], [9.0, 9.0], [2.5, 2.5]])), Ok(()));
        let met = check("p", sheet, &discs(&[[8.0, 4.0], [2.0, 2.0], [3.3, 3.3]])).unwrap_err();
        assert!(matches!(&met, FieldError::Overlap { first, second, .. } if first == "b" && second == "c"), "{met}");
        let off = check("p", sheet, &discs(&[[1.0, 1.0], [9.5, 5.0]])).unwrap_err();
        assert_eq!(off, FieldError::OffPlate { target: "b".into(), plate: "p".into() });
    }
}
