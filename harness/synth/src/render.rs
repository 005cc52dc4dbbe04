//! A scene to its noise-free image.

use calibench_model::{Image, Scene};

use crate::optics::Optics;
use crate::pixel_centres::covered_centres;
use crate::raster::{Picture, Renderer};

/// The noise-free image: each grey value is the exact mean of the scene over the pixel's area (fill factor 1, no blur).
///
/// Summed in f64 and stored as f32: an error of at most 1e-7 of full scale.
///
/// # Panics
/// Never: no optics are always in range.
pub fn render(scene: &Scene) -> Image<'static> {
    let renderer = Renderer::new(&Optics::default(), scene.width, scene.height).expect("no blur, full aperture");
    renderer.render(&Picture::from(scene), &[])
}

/// The image as a program draws it that knows no partial coverage: each pixel has the grey value of the scene at its centre.
pub fn draw(scene: &Scene) -> Image<'static> {
    let mut grey = vec![scene.background; scene.width * scene.height];
    for polygon in &scene.polygons {
        let contrast = polygon.grey - scene.background;
        for (value, covered) in grey.iter_mut().zip(covered_centres(polygon, scene.width, scene.height)) {
            *value += contrast * covered;
        }
    }
    Image::new(scene.width, scene.height, grey.into_iter().map(|value| value as f32).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::{PixelPoint, Polygon};

    /// A corner of one area at (`x`, `y`) whose edges run right and down.
    fn corner(x: f64, y: f64) -> Scene {
        let vertices = [(x, y), (30.0, y), (30.0, 30.0), (x, 30.0)].map(|(x, y)| PixelPoint::new(x, y)).to_vec();
        let polygons = vec![Polygon { id: "corner".into(), vertices, grey: 0.15 }];
        Scene { width: 24, height: 24, background: 0.85, polygons, targets: Vec::new() }
    }

    #[test]
    fn an_axis_aligned_corner_is_the_product_of_its_two_edges_within_a_millionth_of_the_contrast() {
        for (x, y) in [(11.5, 11.5), (11.0, 12.25), (10.9, 11.3), (11.499_999, 12.5)] {
            let image = render(&corner(x, y));
            let covered = |edge: f64, pixel: usize| (pixel as f64 + 0.5 - edge).clamp(0.0, 1.0);
            for (row, column) in (0..24).flat_map(|row| (0..24).map(move |column| (row, column))) {
                let expected = 0.85 - 0.7 * covered(x, column) * covered(y, row);
                let error = (f64::from(image.at(column, row)) - expected).abs() / 0.7;
                assert!(error < 1e-6, "({x}, {y}) at ({column}, {row}): {error:e}");
            }
        }
    }

    #[test]
    fn areas_that_share_an_edge_leave_no_seam() {
        // Two triangles make the square of one polygon.
        let triangle = |vertices: [(f64, f64); 3]| Polygon {
            id: "t".into(),
            vertices: vertices.map(|(x, y)| PixelPoint::new(x, y)).to_vec(),
            grey: 0.1,
        };
        let (a, b, c, d) = ((2.3, 3.1), (17.9, 4.2), (16.4, 18.8), (3.7, 15.5));
        let halves = vec![triangle([a, b, c]), triangle([a, c, d])];
        let whole = vec![Polygon { vertices: [a, b, c, d].map(|(x, y)| PixelPoint::new(x, y)).to_vec(), ..halves[0].clone() }];
        let scene = |polygons| Scene { width: 22, height: 22, background: 0.9, polygons, targets: Vec::new() };
        let (halves, whole) = (render(&scene(halves)), render(&scene(whole)));
        assert!(halves.grey().iter().zip(whole.grey()).all(|(h, w)| (h - w).abs() < 2e-7));
    }
}
