//! How sharp a board is in an image.

use calibench_model::{Affine, Image, PointRow, upper_median};

/// How far around a point is looked, in sizes of its target: beyond the rim of a disc, and not to the next corner of a chessboard.
const REACH: f64 = 0.75;
/// The least half side of what is looked at, px.
const LEAST: f64 = 3.0;
/// Parts of the grey values around a point that are darker than its dark and lighter than its light areas.
const TAILS: f64 = 0.05;
/// Less contrast shows no edge, as a fraction of full scale.
const FAINT: f64 = 0.02;

/// The width of the edges of a board's points, px: over how many pixels an edge goes from dark to light at its steepest; the median over the points.
///
/// Around a point it is the range of the grey values (without a twentieth at either end) over the steepest gradient (Sobel) across either axis of the target, of both
/// axes the wider: a camera that moves along one axis blurs the edges along the other alone. An ideal edge has 2 px, one with a Gaussian blur of standard deviation s
/// tends to 2.5 s. It does not depend on contrast, nor on how large the board is pictured. `None` where no point has contrast.
pub fn edge_width(image: &Image, rows: &[PointRow]) -> Option<f64> {
    upper_median(rows.iter().filter_map(|row| {
        let affine = row.start.affine?;
        at_point(image, (row.start.position.x, row.start.position.y), &affine)
    }))
}

fn at_point(image: &Image, (x, y): (f64, f64), affine: &Affine) -> Option<f64> {
    let axes = [(affine.axx, affine.ayx), (affine.axy, affine.ayy)];
    let lengths = axes.map(|(x, y)| x.hypot(y));
    let reach = (REACH * lengths[0].min(lengths[1])).max(LEAST);
    // One pixel from the rim, for the gradient.
    let range = |at: f64, side: usize| {
        let first = (at - reach).ceil().max(1.0);
        let last = (at + reach).floor().min(side as f64 - 2.0);
        (first <= last).then_some(first as usize..=last as usize)
    };
    let (columns, rows) = (range(x, image.width())?, range(y, image.height())?);
    let across = [0, 1].map(|axis| {
        let (x, y) = axes[axis];
        (-y / lengths[axis], x / lengths[axis])
    });
    let (mut steepest, mut levels) = ([0.0_f64; 2], Vec::new());
    for row in rows {
        for column in columns.clone() {
            let (gx, gy) = sobel(image, column, row);
            for (steepest, (nx, ny)) in steepest.iter_mut().zip(across) {
                *steepest = steepest.max((gx * nx + gy * ny).abs());
            }
            levels.push(image.at(column, row));
        }
    }
    let tail = (TAILS * levels.len() as f64) as usize;
    levels.sort_unstable_by(f32::total_cmp);
    let contrast = f64::from(*levels.get(levels.len() - 1 - tail)? - levels[tail]);
    (contrast > FAINT).then(|| contrast / steepest[0].min(steepest[1]))
}

/// The gradient, per px.
fn sobel(image: &Image, column: usize, row: usize) -> (f64, f64) {
    let at = |dx: usize, dy: usize| f64::from(image.at(column + dx - 1, row + dy - 1));
    let side = |k: usize| [at(k, 0), 2.0 * at(k, 1), at(k, 2)].iter().sum::<f64>();
    let end = |k: usize| [at(0, k), 2.0 * at(1, k), at(2, k)].iter().sum::<f64>();
    ((side(2) - side(0)) / 8.0, (end(2) - end(0)) / 8.0)
}

#[cfg(test)]
mod tests {
    use calibench_model::{PixelPoint, Start};

    use super::*;

    /// A step of standard deviation `blur`, from -1 to 1.
    fn step(at: f64, blur: f64) -> f64 {
        // Abramowitz and Stegun 1964, 7.1.26: to 1.5e-7.
        let x = (at / blur / 2.0_f64.sqrt()).abs();
        let t = 1.0 / (1.0 + 0.327_591_1 * x);
        let polynomial = t * (0.254_829_592 + t * (-0.284_496_736 + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))));
        (1.0 - polynomial * (-x * x).exp()).copysign(at)
    }

    /// The width of a chess corner with blurs along its two axes, turned by `turn`, px of `contrast`.
    fn width([u, v]: [f64; 2], turn: f64, contrast: f64) -> f64 {
        let (sin, cos) = turn.sin_cos();
        let image = Image::from_fn(101, 101, |x, y| {
            let (x, y) = (x as f64 - 50.0, y as f64 - 50.0);
            (0.5 + 0.5 * contrast * step(cos * x + sin * y, u) * step(cos * y - sin * x, v)) as f32
        });
        let affine = Affine { axx: 40.0 * cos, ayx: 40.0 * sin, axy: -40.0 * sin, ayy: 40.0 * cos };
        let start = Start { affine: Some(affine), ..Start::at(PixelPoint::new(50.0, 50.0)) };
        edge_width(&image, &[PointRow { image: String::new(), target: String::new(), start }]).unwrap()
    }

    #[test]
    fn an_edge_is_as_wide_as_its_blur() {
        assert!((width([1e-3, 1e-3], 0.0, 0.8) - 2.0).abs() < 1e-6);
        for blur in [2.0, 3.0, 5.0] {
            let expected = blur * (2.0 * std::f64::consts::PI).sqrt();
            let found = width([blur, blur], 0.3, 0.8);
            assert!((found / expected - 1.0).abs() < 0.1, "{blur}: {found} and {expected}");
        }
    }

    #[test]
    fn a_motion_along_one_axis_counts_whatever_the_contrast() {
        let sharp = width([1.0, 1.0], 0.3, 0.8);
        for blurs in [[4.0, 1.0], [1.0, 4.0]] {
            let (moved, faint) = (width(blurs, 0.3, 0.8), width(blurs, 0.3, 0.1));
            assert!(moved > 3.0 * sharp, "{blurs:?}: {moved} and {sharp}");
            assert!((moved - faint).abs() < 0.02 * moved, "{blurs:?}: {moved} and {faint}");
        }
    }

    #[test]
    fn without_contrast_or_inside_there_is_no_width() {
        let flat = Image::from_fn(20, 20, |_, _| 0.5);
        let affine = Some(Affine { axx: 8.0, axy: 0.0, ayx: 0.0, ayy: 8.0 });
        let at = |x: f64| PointRow {
            image: String::new(),
            target: String::new(),
            start: Start { affine, ..Start::at(PixelPoint::new(x, 9.0)) },
        };
        assert_eq!(edge_width(&flat, &[at(9.0), at(-50.0)]), None);
        assert_eq!(edge_width(&Image::from_fn(2, 2, |_, _| 0.5), &[at(0.0)]), None);
        assert_eq!(edge_width(&flat, &[]), None);
    }
}
