//! The correlation matrix of the interior orientation.

use super::super::limits::CORRELATED;
use super::OfCamera;
use crate::plot::{Axis, Figure, Plot, Said, around};

/// Height and width of the matrix, px of a drawing.
const SIDE: f64 = 520.0;

/// A cell for each pair of a camera's parameters: blue for negative, orange for positive correlation. `None` for less than a pair.
pub(super) fn figure(of: &OfCamera<'_, '_>) -> Option<Figure> {
    let all = of.calibration.covariances.correlations();
    let parameters = of.calibration.covariances.parameters.iter().enumerate().filter(|(_, (owner, _))| *owner == of.camera);
    let (places, names): (Vec<usize>, Vec<String>) = parameters.map(|(place, (_, name))| (place, (*name).to_owned())).unzip();
    if names.len() < 2 {
        return None;
    }
    let down: Vec<String> = names.iter().rev().cloned().collect();
    let [x, y] = [names.clone(), down].map(|names| Axis::named("", names));
    let mut plot = Plot::new(&of.name("correlations"), "Correlations of the interior orientation", x, y, SIDE);
    plot.series(1, None, &["parameters", "correlation"]);
    let cells = || (0..names.len()).flat_map(|i| (0..names.len()).map(move |j| (i, j)));
    let middle = |(i, j): (usize, usize)| (j as f64, (names.len() - 1 - i) as f64);
    for (i, j) in cells() {
        let rho = all[(places[i], places[j])];
        let (x, y) = middle((i, j));
        let said = Said::of([format!("{}, {}", names[i], names[j]), format!("{rho:.4}")]);
        plot.cell([(x - 0.5, y - 0.5), (x + 0.5, y + 0.5)], Some(tint(rho)), &said);
        plot.note((x, y), &format!("{rho:.2}"), true);
    }
    plot.series(7, None, &[""]);
    for (x, y) in cells().filter(|(i, j)| i != j && all[(places[*i], places[*j])].abs() > CORRELATED).map(middle) {
        plot.line(&around((x, y)), &Said::default());
    }
    let caption = "Correlations of the interior orientation, blue negative, orange positive, framed where |rho| exceeds 0.9.";
    Some(of.figure("correlations", (caption, String::new()), plot))
}

/// White for none; full colours stay light enough for black digits.
fn tint(value: f64) -> [u8; 3] {
    let full = if value < 0.0 { [86.0, 180.0, 233.0] } else { [230.0, 159.0, 0.0] };
    full.map(|channel: f64| (255.0 + (channel - 255.0) * value.abs().min(1.0)).round() as u8)
}
