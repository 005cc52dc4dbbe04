//! A scene to its noise-free image.

use calibench_model::{Image, Polygon, Scene};

use crate::coverage::{centres, coverage};

/// The noise-free image: each grey value is the exact mean of the scene over the pixel's area (fill factor 1, no blur).
///
/// Summed in f64 and stored as f32: an error of at most 1e-7 of full scale.
pub fn render(scene: &Scene) -> Image {
    paint(scene, coverage)
}

/// The image as a program draws it that knows no partial coverage: each pixel has the grey value of the scene at its centre.
pub fn draw(scene: &Scene) -> Image {
    paint(scene, centres)
}

fn paint(scene: &Scene, coverage: fn(&Polygon, usize, usize) -> Vec<f64>) -> Image {
    let mut grey = vec![scene.background; scene.width * scene.height];
    for polygon in &scene.polygons {
        let contrast = polygon.grey - scene.background;
        for (value, covered) in grey.iter_mut().zip(coverage(polygon, scene.width, scene.height)) {
            *value += contrast * covered;
        }
    }
    Image::new(scene.width, scene.height, grey.into_iter().map(|value| value as f32).collect())
}
