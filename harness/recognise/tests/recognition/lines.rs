//! How well the grid is found: its nodes against the truth.

use calibench_model::PixelPoint;
use calibench_recognise::{Classifier, LineFound, Recognition};

use crate::campaign::{Setting, Shot, paper_tilts, shots};
use crate::recogniser;

/// Squares of errors of nodes, px^2: of the adjusted grid, and of lines that are adjusted one by one.
#[derive(Default)]
struct Errors {
    grid: Vec<f64>,
    single: Vec<f64>,
}

impl Errors {
    fn add(&mut self, shot: &Shot, found: &Recognition) {
        for ([column, row], truth) in &shot.nodes {
            let place = [*column as f64, *row as f64];
            let at = found.grid.image(place).expect("a node in the image");
            self.grid.push(at.distance(*truth).powi(2));
            let line = |family: usize, index: usize| found.lines.iter().find(|l| l.family == family && l.index == index as i64);
            if let (Some(a), Some(b)) = (line(0, *column), line(1, *row)) {
                let at = meet(found, a, b);
                self.single.push(found.grid.straight(*truth).distance(at).powi(2));
            }
        }
    }
}

/// Where two lines meet, without the bend.
fn meet(found: &Recognition, a: &LineFound, b: &LineFound) -> PixelPoint {
    let [p, q] = a.ends.map(|end| found.grid.straight(end));
    let [r, s] = b.ends.map(|end| found.grid.straight(end));
    let (u, v) = ((q.x - p.x, q.y - p.y), (s.x - r.x, s.y - r.y));
    let t = ((r.x - p.x) * v.1 - (r.y - p.y) * v.0) / (u.0 * v.1 - u.1 * v.0);
    PixelPoint::new(p.x + t * u.0, p.y + t * u.1)
}

fn rms(squares: &[f64]) -> f64 {
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// The paper has lines to 0.1 px.
#[test]
fn nodes_are_found_within_a_tenth_of_a_pixel() {
    for ((blur, decibel), most) in [((0.6, 46.0), 0.1), ((0.6, 26.0), 0.1), ((1.0, 26.0), 0.15)] {
        let setting = Setting::paper(2101, blur, decibel);
        let field = setting.testfield();
        let recogniser = recogniser(&field, Classifier::Modern);
        let mut errors = Errors::default();
        for shot in shots(&setting, &field, &paper_tilts(), &[0.0, 90.0]) {
            errors.add(&shot, &recogniser.recognise(&shot.image).expect("the field"));
        }
        let (grid, single) = (rms(&errors.grid), rms(&errors.single));
        let farthest = errors.grid.iter().fold(0.0, |most: f64, square| most.max(*square)).sqrt();
        println!(
            "blur {blur} px, {decibel} dB: {} nodes, rms 2D {grid:.3} px, farthest {farthest:.3} px; of single lines {}, {single:.3} px",
            errors.grid.len(),
            errors.single.len()
        );
        assert!(errors.grid.len() > 300 && errors.single.len() * 10 > errors.grid.len() * 9);
        assert!(grid < most && single < most, "{grid} {single}");
    }
}
