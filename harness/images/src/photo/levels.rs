//! Photographs of which parts are asked for.

use std::io::BufReader;
use std::path::Path;

use calibench_model::Image;
use image::DynamicImage;

use super::{PhotoError, decoded, grey, open};

/// A photograph as it was decoded, upright: one or two bytes a pixel and channel, of which parts become grey values.
#[derive(Clone, Debug)]
pub struct Levels(DynamicImage);

/// As [`super::read_photo`], with the levels of the file in place of grey values: a quarter of the memory where they have 8 bits.
///
/// # Errors
/// As [`super::read_photo`].
pub fn read_levels(path: &Path) -> Result<Levels, PhotoError> {
    let (mut image, turn, _share) = decoded(path, &mut BufReader::new(open(path)?))?;
    if let Some(turn) = turn {
        turn.apply_to_levels(&mut image);
    }
    Ok(Levels(image))
}

impl Levels {
    /// Columns, px.
    pub fn width(&self) -> usize {
        self.0.width() as usize
    }

    /// Rows, px.
    pub fn height(&self) -> usize {
        self.0.height() as usize
    }

    /// The grey values of at most `columns` x `rows` px from pixel (`left`, `top`) on: of what of them is inside.
    pub fn part(&self, (left, top): (usize, usize), (columns, rows): (usize, usize)) -> Image<'static> {
        let (left, top) = (left.min(self.width()), top.min(self.height()));
        let (columns, rows) = (columns.min(self.width() - left), rows.min(self.height() - top));
        let strip = grey::of_rows(&self.0, top..top + rows);
        let grey = (0..rows).flat_map(|row| &strip.row(row)[left..left + columns]).copied().collect();
        Image::new(columns, rows, grey)
    }

    /// The grey values of the photograph `factor` times smaller: [`Image::reduced`].
    pub fn reduced(&self, factor: usize) -> Image<'static> {
        let (columns, rows) = (self.width() / factor, self.height() / factor);
        let mut grey = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            grey.extend(grey::of_rows(&self.0, row * factor..(row + 1) * factor).reduced(factor).grey());
        }
        Image::new(columns, rows, grey)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Turn, read_photo};
    use super::*;
    use image::codecs::png::PngEncoder;
    use image::{ExtendedColorType, ImageEncoder, metadata::Orientation};

    /// Numbers of all sizes, as PNG.
    fn written(folder: &Path, (width, height): (u32, u32), colour: ExtendedColorType) -> std::path::PathBuf {
        let path = folder.join(format!("{colour:?}.png"));
        let count = width * height * u32::from(colour.bits_per_pixel()) / 8;
        let bytes: Vec<u8> = (0..count).map(|k| (k * k / 7 + k) as u8).collect();
        PngEncoder::new(std::fs::File::create(&path).unwrap()).write_image(&bytes, width, height, colour).unwrap();
        path
    }

    #[test]
    fn parts_and_reduced_copies_are_those_of_the_whole() {
        use ExtendedColorType::{L8, L16, La8, Rgb8, Rgb16, Rgba16};
        let folder = tempfile::tempdir().unwrap();
        for colour in [L8, L16, La8, Rgb8, Rgb16, Rgba16] {
            let path = written(folder.path(), (23, 17), colour);
            let (whole, levels) = (read_photo(&path).unwrap().image, read_levels(&path).unwrap());
            for factor in [1, 2, 5] {
                assert_eq!(levels.reduced(factor), whole.reduced(factor), "{colour:?}");
            }
            let part = levels.part((20, 3), (9, 4));
            assert_eq!(part, Image::from_fn(3, 4, |x, y| whole.at(20 + x, 3 + y)), "{colour:?}");
            assert_eq!(levels.part((23, 20), (5, 5)).grey(), [0.0; 0]);
        }
    }

    #[test]
    fn levels_are_turned_as_grey_values_are() {
        let image = DynamicImage::ImageLuma8(image::GrayImage::from_fn(4, 3, |x, y| image::Luma([(10 * y + x) as u8])));
        for turn in (2..=8).filter_map(|exif| Turn::of(Orientation::from_exif(exif)?)) {
            let mut turned = image.clone();
            turn.apply_to_levels(&mut turned);
            let all = |image: &DynamicImage| grey::of_rows(image, 0..image.height() as usize);
            assert_eq!(all(&turned), turn.apply(&all(&image)), "{turn}");
        }
    }
}
