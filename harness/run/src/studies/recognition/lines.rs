//! How far the lines of a grid that was found lie from the true ones.

use std::collections::BTreeMap;

use calibench_model::PixelPoint;
use calibench_recognise::{GridFound, LineFound, Recognition as Found};
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;

/// Lines by classifier and group of images.
#[derive(Clone, Debug, Default)]
pub struct Lines(BTreeMap<(usize, String), Errors>);

/// Distances across, between lines and the true places of the nodes on them.
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    lines: usize,
    nodes: usize,
    /// Their sum of squares, px^2.
    squares: f64,
    /// The root mean square of the line of which it is largest, px.
    most: f64,
}

impl Lines {
    /// Adds the lines of an image, each along its found part; one without a node there says nothing.
    pub fn image(&mut self, (which, images): (usize, &str), found: Option<&Found>, nodes: &[([usize; 2], PixelPoint)]) {
        let Some(found) = found else { return };
        let all = self.0.entry((which, images.to_owned())).or_default();
        for line in &found.lines {
            let own = nodes.iter().filter(|(node, _)| i64::try_from(node[line.family]) == Ok(line.index));
            let squares: Vec<f64> = own.filter_map(|(_, at)| across(&found.grid, line, *at)).map(|across| across * across).collect();
            let sum: f64 = squares.iter().sum();
            if !squares.is_empty() {
                all.lines += 1;
                all.nodes += squares.len();
                all.squares += sum;
                all.most = all.most.max((sum / squares.len() as f64).sqrt());
            }
        }
    }

    /// Adds those of others.
    pub fn join(&mut self, other: Self) {
        for (of, errors) in other.0 {
            let all = self.0.entry(of).or_default();
            all.lines += errors.lines;
            all.nodes += errors.nodes;
            all.squares += errors.squares;
            all.most = all.most.max(errors.most);
        }
    }

    /// The figures of a trial.
    pub fn figures(&self, classifiers: &[String]) -> Vec<Figure> {
        let mut figures = Vec::new();
        for (which, classifier) in classifiers.iter().enumerate() {
            let mut most: Option<f64> = None;
            for ((_, images), errors) in self.0.iter().filter(|((of, _), errors)| *of == which && errors.nodes > 0) {
                let of = [classifier.as_str(), images.as_str()];
                figures.push(Figure::plain(Quantity::Lines.of(&of), errors.lines as f64, ""));
                figures.push(Figure::plain(Quantity::LineError.of(&of), (errors.squares / errors.nodes as f64).sqrt(), "px"));
                figures.push(Figure::plain(Quantity::LineErrorMost.of(&of), errors.most, "px"));
                most = Some(most.unwrap_or(0.0).max(errors.most));
            }
            figures.extend(most.map(|most| Figure::plain(Quantity::LineErrorMostOfAll.of(&[classifier]), most, "px")));
        }
        figures
    }
}

/// How far a place (px) lies to a side of `line`, px; `None` beyond the ends of its found part.
fn across(grid: &GridFound, line: &LineFound, at: PixelPoint) -> Option<f64> {
    let ([from, to], at) = (line.ends.map(|end| grid.straight(end)), grid.straight(at));
    let (ux, uy) = (to.x - from.x, to.y - from.y);
    let (dx, dy) = (at.x - from.x, at.y - from.y);
    let length = ux.hypot(uy);
    let along = (ux * dx + uy * dy) / length;
    (length > 0.0 && (0.0..=length).contains(&along)).then(|| (ux * dy - uy * dx) / length)
}

#[cfg(test)]
mod tests {
    use calibench_records::results::find;

    use super::*;

    fn line(index: i64, x: f64) -> LineFound {
        let ends = [PixelPoint::new(x, 10.0), PixelPoint::new(x, 100.0)];
        LineFound { family: 0, index, ends, sigma: 0.01, rms: 0.1, points: 90 }
    }

    fn found(lines: Vec<LineFound>) -> Found {
        let grid = GridFound {
            homography: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            bend: 0.0,
            middle: PixelPoint::new(60.0, 60.0),
            reach: 100.0,
            rms: 0.0,
            blur: 0.6,
            reduced: 1,
        };
        Found { targets: Vec::new(), squares: Vec::new(), lines, rejected: Vec::new(), grid }
    }

    /// Upright lines 0.3 and 0.1 px beside nodes at 20 and 80 px, 0.5 px beside one that the found part does not reach; one that nothing is known of.
    #[test]
    fn lines_are_held_against_the_nodes_on_them() {
        let node = |column: usize, row: usize, x: f64, y: f64| ([column, row], PixelPoint::new(x, y));
        let nodes =
            [node(1, 0, 30.0, 20.0), node(1, 1, 30.0, 80.0), node(1, 2, 30.2, 140.0), node(2, 0, 70.0, 20.0), node(2, 1, 70.0, 80.0)];
        let mut lines = Lines::default();
        lines.image((0, "a"), Some(&found(vec![line(1, 30.3), line(3, 90.0)])), &nodes);
        lines.image((0, "b"), None, &nodes);
        let mut other = Lines::default();
        other.image((0, "a"), Some(&found(vec![line(2, 69.9)])), &nodes);
        lines.join(other);
        let figures = lines.figures(&["modern".to_owned(), "contours".to_owned()]);
        let of = |quantity: Quantity, parts: &[&str]| find(&figures, quantity.of(parts)).map(|figure| figure.value);
        let close = |found: Option<f64>, expected: f64| assert!((found.unwrap() - expected).abs() < 1e-12, "{found:?}");
        close(of(Quantity::Lines, &["modern", "a"]), 2.0);
        close(of(Quantity::LineError, &["modern", "a"]), 0.05_f64.sqrt());
        close(of(Quantity::LineErrorMost, &["modern", "a"]), 0.3);
        close(of(Quantity::LineErrorMostOfAll, &["modern"]), 0.3);
        assert_eq!((of(Quantity::Lines, &["modern", "b"]), of(Quantity::LineErrorMostOfAll, &["contours"])), (None, None));
    }
}
