//! The shape of a bent board, as a map of heights.

use calibench_adjust::Status;
use calibench_calibrate::{Board, Calibration};

use super::super::board::adjusted;
use crate::field::rgb;
use crate::levels::contour;
use crate::plain;
use crate::plot::{Axis, Figure, Plot, Said};
use crate::ticks::linear;

/// Places along either side.
const PLACES: usize = 41;
/// Width of the map, px of a drawing.
const WIDTH: f64 = 760.0;

/// The map, if a bend was adjusted.
pub(super) fn figure(calibration: &Calibration<'_>) -> Option<Figure> {
    let (board, coefficients, sigmas) = adjusted(calibration)?;
    let [half_u, half_v] = board.half;
    // Middles of cells; rows go up, as v does.
    let at = |i: f64| 2.0 * (i + 0.5) / PLACES as f64 - 1.0;
    let lift = |k: usize| Board::lift(coefficients, [at((k % PLACES) as f64), at((k / PLACES) as f64)]);
    let lowest = (0..PLACES * PLACES).map(lift).fold(f64::INFINITY, f64::min);
    let heights: Vec<f64> = (0..PLACES * PLACES).map(|k| lift(k) - lowest).collect();
    let highest = heights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let axis = |name: &str, index: usize| {
        Axis::linear(
            &format!("{name} = {}, from the middle, object units", direction(board, index)),
            [-board.half[index], board.half[index]],
        )
    };
    let height = (WIDTH * half_v / half_u).clamp(120.0, 1000.0);
    let mut plot = Plot::new("board", "Shape of the board", axis("u", 0), axis("v", 1), height);
    plot.series(7, None, &["u", "v", "height"]);
    for (k, height) in heights.iter().enumerate() {
        let (u, v) = (at((k % PLACES) as f64), at((k / PLACES) as f64));
        let part = 1.0 / PLACES as f64;
        let corners = [-part, part].map(|side| ((u + side) * half_u, (v + side) * half_v));
        plot.cell(corners, Some(rgb(height / highest)), &Said::of([u * half_u, v * half_v, *height].map(plain)));
    }
    let levels = linear(0.0, highest);
    for level in levels.iter().filter(|level| **level > 0.0) {
        let pieces = contour(&heights, (PLACES, PLACES), *level).into_iter();
        plot.contour(pieces.map(|ends| ends.map(|(column, row)| (at(column) * half_u, at(row) * half_v))).collect());
    }
    let fixed = calibration.prepared.network.points.iter().filter(|point| point.coordinates == [Status::Fixed; 3]);
    plot.dots(fixed.map(|point| board.place(&point.position)).map(|[u, v]| (u * half_u, v * half_v)).collect());
    plot.shades("height", &levels.iter().map(|level| (level / highest, plain(*level))).collect::<Vec<_>>());
    let sigma = sigmas.iter().copied().fold(0.0, f64::max);
    Some(Figure {
        name: "board".into(),
        caption: "Height of the board over its lowest place, towards the camera, object units: what the control file does not say. Dots are control points."
            .into(),
        remark: format!("{} from the lowest to the highest place; standard deviation of a coefficient {} at most", plain(highest), plain(sigma)),
        plot,
    })
}

/// The object's axis along which one of the board's lies, or what it is made of.
fn direction(board: &Board, axis: usize) -> String {
    let axis = board.axes[axis];
    let along = ["X", "Y", "Z"].into_iter().zip(axis.iter()).find(|(_, part)| part.abs() > 1.0 - 1e-6);
    along.map_or_else(
        || format!("({:.2}, {:.2}, {:.2})", axis.x, axis.y, axis.z),
        |(name, part)| if *part < 0.0 { format!("-{name}") } else { name.to_owned() },
    )
}
