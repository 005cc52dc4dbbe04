//! Images within a drawing.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use plotters_backend::{BackendColor, BackendCoord};

/// From this width on, px, what is shown is a photograph as a whole, not its pixels.
const WHOLE: u32 = 200;
/// A photograph as a whole has at most as many columns.
const COLUMNS: u32 = 640;
/// Its quality as JPEG, percent.
const QUALITY: u8 = 70;
/// What is outside of an image.
const OUTSIDE: u8 = 245;

/// An image as a part of a drawing.
pub(crate) struct Embedded {
    /// Its upper left corner, px of the drawing.
    pub(crate) at: BackendCoord,
    /// Its width and height, px of the drawing.
    pub(crate) size: (u32, u32),
    /// The image itself.
    pub(crate) raster: Raster,
}

/// An image as it is shown.
pub(crate) struct Raster {
    /// Its columns and rows.
    pub(crate) size: (u32, u32),
    /// Its grey values, or red, green, blue and opacity, 8 bits each, row by row.
    pub(crate) samples: Vec<u8>,
    /// What they are.
    pub(crate) kind: Kind,
}

/// What the samples of an image are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Grey values that are kept as they are.
    Grey,
    /// Grey values of a photograph as a whole, which may lose what nobody sees.
    Photograph,
    /// Red, green, blue and opacity.
    Rgba,
}

impl Raster {
    /// As the address of an image within a page.
    pub(super) fn url(&self) -> String {
        let (width, height) = self.size;
        let mut file = Vec::new();
        // Writing to memory cannot fail; the size is that of the samples.
        let media = if self.kind == Kind::Photograph {
            let _ = JpegEncoder::new_with_quality(&mut file, QUALITY).write_image(&self.samples, width, height, ExtendedColorType::L8);
            "jpeg"
        } else {
            let colours = if self.kind == Kind::Rgba { ExtendedColorType::Rgba8 } else { ExtendedColorType::L8 };
            let encoder = PngEncoder::new_with_quality(&mut file, CompressionType::Default, FilterType::Adaptive);
            let _ = encoder.write_image(&self.samples, width, height, colours);
            "png"
        };
        format!("data:image/{media};base64,{}", STANDARD.encode(file))
    }
}

/// A part of an image of `columns` pixels a row, each `zoom` px wide: as it is, or, of a photograph as a whole, a reduced copy.
pub(crate) fn part(at: (u32, u32), (columns, zoom): (u32, u32), levels: &[Option<u8>]) -> Embedded {
    let rows = levels.len() as u32 / columns.max(1);
    let pixels: Vec<u8> = levels.iter().map(|level| level.unwrap_or(OUTSIDE)).collect();
    let raster = if columns < WHOLE {
        Raster { size: (columns, rows), samples: pixels, kind: Kind::Grey }
    } else {
        let (samples, size) = reduced(&pixels, (columns, rows), columns.div_ceil(COLUMNS));
        Raster { size, samples, kind: Kind::Photograph }
    };
    Embedded { at: (at.0 as i32, at.1 as i32), size: (columns * zoom, rows * zoom), raster }
}

/// Single pixels, transparent between them: the first of some side by side, how many they are, and their colour.
pub(crate) fn dots(dots: impl Iterator<Item = (BackendCoord, i32, BackendColor)> + Clone) -> Embedded {
    let left = dots.clone().map(|((x, _), ..)| x).min().unwrap_or(0);
    let right = dots.clone().map(|((x, _), count, _)| x + count - 1).max().unwrap_or(0);
    let rows = dots.clone().map(|((_, y), ..)| y);
    let (top, bottom) = (rows.clone().min().unwrap_or(0), rows.max().unwrap_or(0));
    let (width, height) = ((right - left + 1) as usize, (bottom - top + 1) as usize);
    let mut pixels = vec![0; 4 * width * height];
    for ((x, y), count, BackendColor { alpha, rgb: (r, g, b) }) in dots {
        let place = (y - top) as usize * width + (x - left) as usize;
        let pixel = [r, g, b, (255.0 * alpha).round() as u8];
        pixels.as_chunks_mut().0[place..place + count as usize].fill(pixel);
    }
    let size = (width as u32, height as u32);
    Embedded { at: (left, top), size, raster: Raster { size, samples: pixels, kind: Kind::Rgba } }
}

/// Means of squares of `by` pixels; what is left over at the right and below is of smaller ones.
fn reduced(pixels: &[u8], (columns, rows): (u32, u32), by: u32) -> (Vec<u8>, (u32, u32)) {
    let size = (columns.div_ceil(by), rows.div_ceil(by));
    let mean = |place: u32| {
        let (left, top) = (place % size.0 * by, place / size.0 * by);
        let (right, bottom) = ((left + by).min(columns), (top + by).min(rows));
        let row = |y: u32| {
            pixels[(y * columns + left) as usize..(y * columns + right) as usize].iter().map(|level| u32::from(*level)).sum::<u32>()
        };
        let count = (right - left) * (bottom - top);
        (((top..bottom).map(row).sum::<u32>() + count / 2) / count) as u8
    };
    ((0..size.0 * size.1).map(mean).collect(), size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(raster: &Raster) -> image::DynamicImage {
        let url = raster.url();
        let bytes = STANDARD.decode(url.split_once(',').map(|(_, data)| data).unwrap()).unwrap();
        image::load_from_memory(&bytes).unwrap()
    }

    #[test]
    fn a_window_keeps_each_pixel_and_a_photograph_its_means() {
        let levels: Vec<Option<u8>> = (0..6).map(|k| (k != 4).then_some(40 * k)).collect();
        let window = part((7, 8), (3, 5), &levels);
        assert_eq!((window.at, window.size), ((7, 8), (15, 10)));
        assert_eq!(decoded(&window.raster).to_luma8().into_raw(), [0, 40, 80, 120, OUTSIDE, 200]);

        // Columns of 1300 px: halves are dark and bright, with stripes that the means take away.
        let level = |k: u32| Some(if k % 1300 < 600 { 40 } else { 160 } + if (k % 1300).is_multiple_of(3) { 30 } else { 0 });
        let whole = part((0, 0), (1300, 1), &(0..1300 * 31).map(level).collect::<Vec<_>>());
        assert_eq!(whole.size, (1300, 31));
        let small = decoded(&whole.raster).to_luma8();
        assert_eq!(small.dimensions(), (434, 11));
        let near = |x: u32, level: u8| assert!(small.get_pixel(x, 5).0[0].abs_diff(level) <= 4, "{x}: {:?}", small.get_pixel(x, 5));
        near(20, 50);
        near(400, 170);
    }

    #[test]
    fn single_pixels_stand_where_they_were_drawn() {
        let red = BackendColor { alpha: 1.0, rgb: (255, 0, 0) };
        let found = dots([((10, 20), 1, red), ((11, 21), 2, red)].into_iter());
        assert_eq!((found.at, found.size), ((10, 20), (3, 2)));
        let image = decoded(&found.raster).to_rgba8();
        let drawn: Vec<(u32, u32)> =
            image.enumerate_pixels().filter(|(.., pixel)| pixel.0 == [255, 0, 0, 255]).map(|(x, y, _)| (x, y)).collect();
        assert_eq!(drawn, [(0, 0), (1, 1), (2, 1)]);
    }
}
