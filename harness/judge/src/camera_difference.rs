//! Two cameras of the same photographs beside each other: where corners were measured, and over the whole frame.

use std::sync::Arc;

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel};
use calibench_records::judgement::{Beside, Row, measure};
use nalgebra::DVector;

use super::frame::Frame;
use super::halves::{COLUMNS, mean_square, vectors};

/// Compares two cameras at the places of a grid; those that lie nearer to one of the `corners` than the grid is wide count as seen.
///
/// # Errors
/// In words.
pub(super) fn beside(first: &Camera, second: &Camera, corners: &[PixelPoint]) -> Result<Beside, String> {
    let (at, vectors) = vectors(first, second)?;
    let lengths: Vec<f64> = vectors.as_slice().chunks(2).map(|v| v[0].hypot(v[1])).collect();
    let wide = f64::from(first.size().width) / COLUMNS as f64;
    let seen: Vec<usize> = (0..at.len()).filter(|&place| corners.iter().any(|corner| corner.distance(at[place]) < wide)).collect();
    let places: Vec<PixelPoint> = seen.iter().map(|&place| at[place]).collect();
    let there = DVector::from_iterator(2 * seen.len(), seen.iter().flat_map(|&place| [vectors[2 * place], vectors[2 * place + 1]]));
    // A rotation has three parameters.
    let frame = if seen.len() > 2 { Frame::new(first, &[], &places) } else { None };
    let seen = frame.map(|frame| mean_square(first.size(), &places, &frame.without_rotation(&there)).sqrt());
    let frame = mean_square(first.size(), &at, &vectors).sqrt();
    Ok(Beside { frame, most: lengths.iter().copied().fold(0.0, f64::max), seen })
}

/// The rows of one model's camera beside those of others.
pub(super) fn rows<'c>(camera: &Camera, others: impl Iterator<Item = (&'c Arc<str>, &'c Camera)>, corners: &[PixelPoint]) -> Vec<Row> {
    let one = |(name, other): (&Arc<str>, &Camera)| match beside(camera, other, corners) {
        Err(why) => vec![Row::without(measure::BESIDE, name, "left out", &why)],
        Ok(found) => {
            let frame = Row::px(measure::BESIDE, name, found.frame).beside(found.most);
            [Some(frame), found.seen.map(|seen| Row::px(measure::BESIDE_SEEN, name, seen))].into_iter().flatten().collect()
        }
    };
    others.flat_map(one).collect()
}

#[cfg(test)]
mod tests {
    use calibench_model::camera::{ImageSize, OpenCv};
    use calibench_model::convert::{DifferenceOptions, difference};

    use super::*;

    #[test]
    fn cameras_that_agree_where_they_were_seen_may_differ_elsewhere() {
        let size = ImageSize { width: 640, height: 480 };
        let camera = |k3: f64| {
            let mut distortion = [0.0; 14];
            distortion[4] = k3;
            Camera::from(OpenCv { size, fx: 500.0, fy: 500.0, cx: 319.5, cy: 239.5, distortion, coefficients: 5 })
        };
        let middle: Vec<PixelPoint> =
            (0..25).map(|k| PixelPoint::new(270.0 + 25.0 * f64::from(k % 5), 190.0 + 25.0 * f64::from(k / 5))).collect();
        let found = beside(&camera(0.0), &camera(0.05), &middle).unwrap();
        // r^7 k3 f in the corner, where r is 0.8; in the middle within 150 px r is at most 0.3.
        assert!((found.most - 500.0 * 0.05 * 0.798_f64.powi(7)).abs() < 0.1 * found.most, "{found:?}");
        assert!(found.seen.unwrap() < 0.01 && found.frame > 0.5, "{found:?}");
        let everywhere: Vec<PixelPoint> = (0..169).map(|k| PixelPoint::new(53.0 * f64::from(k % 13), 40.0 * f64::from(k / 13))).collect();
        let found = beside(&camera(0.0), &camera(0.05), &everywhere).unwrap();
        assert!((found.seen.unwrap() - found.frame).abs() < 1e-3 * found.frame, "{found:?}");
        assert_eq!(beside(&camera(0.0), &camera(0.05), &[]).unwrap().seen, None);
        // As `diff` has it: borders count for the half of a cell.
        let options = DifferenceOptions { columns: COLUMNS, ..DifferenceOptions::default() };
        let of_diff = difference(&camera(0.0), &camera(0.05), &options).unwrap().spread.rms_px;
        assert!((found.frame / of_diff - 1.0).abs() < 1e-9, "{found:?} {of_diff}");
    }
}
