//! Labels beside points that overlap neither each other nor the points.

use plotters::prelude::*;

use crate::axes::Axes;
use crate::canvas::Canvas;

/// Names beside points, and what else is in their way, px of the picture.
#[derive(Default)]
pub struct Names<'a> {
    /// Each with its point.
    pub named: Vec<(&'a str, (f64, f64))>,
    /// Points that no name may cover.
    pub others: Vec<(f64, f64)>,
}

impl Names<'_> {
    /// Writes them, `size` px high, where they cover neither each other nor a point, within `axes`; where no room is left a name is missing.
    pub fn write(&self, canvas: &mut Canvas, axes: &Axes, size: u32) {
        let wide = |name: &str| 0.6 * f64::from(size) * name.chars().count() as f64 + 4.0;
        let sizes: Vec<(f64, f64)> = self.named.iter().map(|(name, _)| (wide(name), f64::from(size))).collect();
        let points: Vec<(f64, f64)> = self.named.iter().map(|(_, at)| *at).chain(self.others.iter().copied()).collect();
        let [left, top, width, height] = axes.at.map(f64::from);
        let area = Box2 { x: left + 2.0, y: top + 2.0, width: width - 4.0, height: height - 4.0 };
        for ((name, at), found) in self.named.iter().zip(place(&points, &sizes, area)) {
            if let Some(found) = found {
                let near = (at.0.clamp(found.x, found.x + found.width), at.1.clamp(found.y, found.y + found.height));
                if (near.0 - at.0).hypot(near.1 - at.1) > POINT + 2.0 * STEP {
                    // It stands so far off that a line tells whose it is.
                    let ends = [*at, near].map(|(x, y)| (x.round() as i32, y.round() as i32));
                    canvas.paint(|area| {
                        area.draw(&PathElement::new(ends, RGBColor(150, 150, 150))).ok();
                    });
                }
                canvas.label(name, size, (found.x as u32 + 2, (found.y + 0.5 * found.height) as u32));
            }
        }
    }
}

/// Points of a line, close together.
pub fn along([from, to]: &[(i32, i32); 2]) -> impl Iterator<Item = (f64, f64)> + use<> {
    let ([x, y], [dx, dy]) = ([from.0, from.1].map(f64::from), [to.0 - from.0, to.1 - from.1].map(f64::from));
    let steps = (dx.hypot(dy) / 8.0).ceil() as i32;
    (0..=steps).map(move |step| f64::from(step) / f64::from(steps.max(1))).map(move |part| (x + part * dx, y + part * dy))
}

/// An upright box, px of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box2 {
    /// Left upper corner, px of the picture.
    pub x: f64,
    /// Left upper corner, px of the picture, down.
    pub y: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Box2 {
    /// Whether they share an area.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.x < other.x + other.width && other.x < self.x + self.width && self.y < other.y + other.height && other.y < self.y + self.height
    }

    fn within(&self, area: &Self) -> bool {
        self.x >= area.x && self.y >= area.y && self.x + self.width <= area.x + area.width && self.y + self.height <= area.y + area.height
    }
}

/// Half the side of the square that a point keeps free.
const POINT: f64 = 9.0;
/// Steps of the search outwards, px.
const STEP: f64 = 7.0;

/// A box of its `sizes` (width, height) for each of `points`, near it and within `area`: the nearest free place on growing rings, in the order given.
/// Points beyond the sizes keep their places free and have no box. `None` where the area has no room left.
pub fn place(points: &[(f64, f64)], sizes: &[(f64, f64)], area: Box2) -> Vec<Option<Box2>> {
    let mut taken: Vec<Box2> =
        points.iter().map(|(x, y)| Box2 { x: x - POINT, y: y - POINT, width: 2.0 * POINT, height: 2.0 * POINT }).collect();
    let mut labels = Vec::new();
    for (point, size) in points.iter().zip(sizes) {
        let found = candidates(*point, *size, area).find(|label| label.within(&area) && taken.iter().all(|other| !label.overlaps(other)));
        taken.extend(found);
        labels.push(found);
    }
    labels
}

fn candidates((x, y): (f64, f64), (width, height): (f64, f64), area: Box2) -> impl Iterator<Item = Box2> {
    let rings = ((area.width + area.height) / STEP) as usize;
    (0..rings).flat_map(move |ring| {
        let (reach, count) = (POINT + 1.0 + STEP * ring as f64, 8 + 4 * ring);
        (0..count).map(move |step| {
            let (sin, cos) = (std::f64::consts::TAU * step as f64 / count as f64).sin_cos();
            // The box touches the ring with the side that faces the point.
            let middle = (x + cos * (reach + width / 2.0), y + sin * (reach + height / 2.0));
            Box2 { x: middle.0 - width / 2.0, y: middle.1 - height / 2.0, width, height }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_crowded_points_overlap_nothing() {
        let area = Box2 { x: 0.0, y: 0.0, width: 900.0, height: 600.0 };
        // Twenty points in a heap and some far away, by a fixed sequence.
        let at = |i: usize| (400.0 + (i * 37 % 50) as f64, 300.0 + (i * 53 % 40) as f64);
        let points: Vec<(f64, f64)> = (0..20).map(at).chain([(2.0, 2.0), (898.0, 598.0)]).collect();
        let sizes: Vec<(f64, f64)> = (0..points.len()).map(|i| (90.0 + (i * 29 % 160) as f64, 18.0)).collect();
        let labels: Vec<Box2> = place(&points, &sizes, area).into_iter().map(|label| label.expect("room")).collect();
        for (i, label) in labels.iter().enumerate() {
            assert!(label.within(&area), "{label:?}");
            assert!(labels[..i].iter().all(|other| !label.overlaps(other)), "label {i}");
            assert!(
                points.iter().all(|(x, y)| !(label.x < *x && *x < label.x + label.width && label.y < *y && *y < label.y + label.height))
            );
        }
    }

    #[test]
    fn no_room_is_said() {
        let area = Box2 { x: 0.0, y: 0.0, width: 50.0, height: 30.0 };
        assert_eq!(place(&[(25.0, 15.0)], &[(60.0, 18.0)], area), [None]);
    }
}
