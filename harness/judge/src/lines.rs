//! Straight lines: the rows and columns of a board, undistorted.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, Ray};

use super::material::Material;

/// How far the undistorted rows and columns of the board in a view are from straight: `sqrt(sum d^2 / sum (n - 2))`, d the distance from the best line
/// through the n corners of a row or column, px of a camera of the same principal distance without distortion. The standard deviation of a coordinate if
/// the camera is right; and how many corners it comes from. No pose takes part in it.
///
/// # Errors
/// In words: a corner without a ray before the camera, no line of three corners.
///
/// Source: Brown 1971 (plumb lines).
pub fn straightness(material: &Material, operator: usize, view: usize, camera: &Camera, chosen: &[bool]) -> Result<(f64, usize), String> {
    let on_axis = camera.derivatives(Ray::from_tangent(0.0, 0.0)).map_err(|_| "the camera does not picture its axis".to_owned())?;
    let [x, y] = on_axis.by_ray;
    let focal = (x[0] * y[1] - x[1] * y[0]).abs().sqrt();
    let corners = &material.operators[operator].at[view];
    let mut flat: Vec<Option<[f64; 2]>> = vec![None; corners.len()];
    for (corner, at) in corners.iter().enumerate().filter(|(corner, _)| chosen[*corner]) {
        if let Some(at) = at {
            flat[corner] = Some(undistorted(camera, *at, focal).ok_or("a corner has no ray before the camera")?);
        }
    }
    let (mut squares, mut freedom, mut count) = (0.0, 0, 0);
    for line in material.field.lines() {
        let points: Vec<[f64; 2]> = line.into_iter().filter_map(|corner| flat[corner]).collect();
        if points.len() > 2 {
            squares += off_line(&points);
            freedom += points.len() - 2;
            count += points.len();
        }
    }
    if freedom == 0 { Err("no row or column has three corners".into()) } else { Ok(((squares / freedom as f64).sqrt(), count)) }
}

fn undistorted(camera: &Camera, at: PixelPoint, focal: f64) -> Option<[f64; 2]> {
    let (x, y) = camera.unproject(at).ok()?.tangent()?;
    Some([focal * x, focal * y])
}

/// The sum of the squared distances of points from the line closest to them: the smaller eigenvalue of their scatter matrix.
fn off_line(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mean = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / n);
    let scatter = |a: usize, b: usize| points.iter().map(|point| (point[a] - mean[a]) * (point[b] - mean[b])).sum::<f64>();
    let (xx, xy, yy) = (scatter(0, 0), scatter(0, 1), scatter(1, 1));
    // The normal of the line, then the distances themselves: the eigenvalue as a difference of large numbers would lose what is small.
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let (sine, cosine) = angle.sin_cos();
    points.iter().map(|point| (-sine * (point[0] - mean[0]) + cosine * (point[1] - mean[1])).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_from_a_line_is_what_geometry_says() {
        // Four corners of a square of side 2 a little longer in x: the best line is y = 0, each point 1 off.
        let square = [[-1.1, -1.0], [1.1, -1.0], [1.1, 1.0], [-1.1, 1.0]];
        assert!((off_line(&square) - 4.0).abs() < 1e-12);
        let turned = square.map(|[x, y]| [0.6 * x - 0.8 * y + 300.0, 0.8 * x + 0.6 * y - 70.0]);
        assert!((off_line(&turned) - 4.0).abs() < 1e-10);
        assert!(off_line(&[[1.0, 2.0], [2.0, 4.0], [5.0, 10.0]]) < 1e-24);
    }
}
