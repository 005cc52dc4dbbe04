//! Where the corners of a measured board are, beside their nominal places.

use calibench_calibrate::{Calibration, MeasuredCorner};

use crate::plain;
use crate::plot::{Axis, Figure, Plot, Said};

/// Width of the picture, px of a drawing.
const WIDTH: f64 = 760.0;
/// The longest line, as a share of the distance between corners.
const LONGEST: f64 = 0.8;

/// The picture, if a board was measured.
pub(super) fn figure(calibration: &Calibration<'_>) -> Option<Figure> {
    let Some(Ok(board)) = &calibration.measured_board else { return None };
    let corners = &board.corners;
    let range = |axis: usize| {
        let at = corners.iter().map(|corner| corner.nominal[axis]);
        at.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
    };
    let [[x0, x1], [y0, y1]] = [range(0), range(1)];
    let (wide, high) = ((x1 - x0).max(f64::MIN_POSITIVE), (y1 - y0).max(f64::MIN_POSITIVE));
    let step = (wide * high / corners.len() as f64).sqrt();
    let moved = |corner: &MeasuredCorner| (corner.position - corner.nominal).xy();
    let most = corners.iter().map(|corner| moved(corner).norm()).fold(0.0, f64::max);
    let factor = rounded(LONGEST * step / most.max(f64::MIN_POSITIVE));
    let axis = |name: &str, [low, high]: [f64; 2]| Axis::linear(&format!("{name}, object units"), [low - step, high + step]);
    let height = (WIDTH * (high + 2.0 * step) / (wide + 2.0 * step)).clamp(120.0, 1000.0);
    let mut plot = Plot::new("board-corners", "Corners of the board", axis("X", [x0, x1]), axis("Y", [y0, y1]), height);
    plot.series(0, None, &["corner", "X", "Y", "Z beside nominal", "sX", "sY", "sZ"]);
    for corner in corners {
        let by = corner.position - corner.nominal;
        let sigma = |axis: usize| plain(corner.covariance[(axis, axis)].max(0.0).sqrt());
        let said = [corner.name.clone(), plain(by.x), plain(by.y), plain(by.z), sigma(0), sigma(1), sigma(2)];
        let from = (corner.nominal.x, corner.nominal.y);
        plot.line(&[from, (from.0 + factor * by.x, from.1 + factor * by.y)], &Said::of(said));
    }
    plot.dots(corners.iter().map(|corner| (corner.nominal.x, corner.nominal.y)).collect());
    Some(Figure {
        name: "board-corners".into(),
        caption: format!("From its nominal place (dot) to where each corner of the board is, {} times too long.", plain(factor)),
        remark: format!("{} object units at most; standard deviation {} RMS", plain(most), plain(board.sigma.in_plane)),
        plot,
    })
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `value`.
fn rounded(value: f64) -> f64 {
    let power = 10.0_f64.powf(value.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|digit| digit * power).find(|step| *step <= value).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_read_at_a_glance() {
        assert_eq!([1.0, 1.9, 2.0, 4.99, 7.0, 314.0, 0.03].map(rounded), [1.0, 1.0, 2.0, 2.0, 5.0, 200.0, 0.02]);
    }
}
