//! ST-maps as images: EXR, TIFF, PNG.

use std::fs::File;
use std::io::{BufReader, Cursor};
use std::path::Path;

use calibench_files::photograph::{WRITER, marked};
use calibench_model::camera::ImageSize;
use exr::prelude::{Blocks, Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, SpecificChannels, Text, Vec2, WritableImage};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, Limits};
use tiff::encoder::{TiffEncoder, colortype};
use tiff::tags::Tag;

use super::{Pixel, StMap, StMapError};
use crate::photo::reader;

/// Memory of a map that is read, bytes.
const MOST_BYTES: u64 = 4 << 30;

/// A kind of image file that holds maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapFile {
    /// OpenEXR with floats of 32 bits.
    Exr,
    /// TIFF with floats of 32 bits.
    TiffFloat,
    /// TIFF with 16 bits.
    Tiff16,
    /// PNG with 16 bits.
    Png16,
}

impl MapFile {
    /// The endings of file names that are written.
    pub const ENDINGS: [&'static str; 4] = ["exr", "tif", "tiff", "png"];

    /// The kind of a file's ending; of TIFF's two the one with floats if asked for. `None` for another ending, and for a PNG of floats.
    pub fn of(path: &Path, float: bool) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "exr" => Some(Self::Exr),
            "tif" | "tiff" if float => Some(Self::TiffFloat),
            "tif" | "tiff" => Some(Self::Tiff16),
            "png" if !float => Some(Self::Png16),
            _ => None,
        }
    }

    /// Whether places are rounded to 65535 steps, and those outside of the source cut off.
    pub fn is_of_sixteen_bits(self) -> bool {
        matches!(self, Self::Tiff16 | Self::Png16)
    }

    /// How far a place may be from the exact one, px of the source.
    pub fn rounding(self, source: ImageSize) -> f64 {
        let longer = f64::from(source.width.max(source.height));
        let step = if self.is_of_sixteen_bits() { 1.0 / 65535.0 } else { f64::from(f32::EPSILON) };
        0.5 * step * longer
    }
}

/// The map as a file's bytes.
///
/// # Errors
/// What the encoder refuses.
pub fn encode(map: &StMap, file: MapFile) -> Result<Vec<u8>, StMapError> {
    let (width, height) = (map.size.width, map.size.height);
    let failed = |error: &dyn std::fmt::Display| StMapError::File(format!("cannot be written: {error}"));
    let mut out = Cursor::new(Vec::new());
    match file {
        MapFile::Exr => exr_of(map, &mut out).map_err(|error| failed(&error))?,
        MapFile::TiffFloat => tiff_of::<colortype::RGB32Float>(map.pixels.as_flattened(), (width, height), &mut out)?,
        MapFile::Tiff16 => tiff_of::<colortype::RGB16>(&levels(map), (width, height), &mut out)?,
        MapFile::Png16 => {
            let bytes: Vec<u8> = levels(map).into_iter().flat_map(u16::to_ne_bytes).collect();
            let encoder = PngEncoder::new_with_quality(&mut out, CompressionType::Fast, FilterType::Adaptive);
            encoder.write_image(&bytes, width, height, ExtendedColorType::Rgb16).map_err(|error| failed(&error))?;
            return Ok(marked(out.into_inner()));
        }
    }
    Ok(out.into_inner())
}

/// 65535 for 1; outside of the source all three are zero.
fn levels(map: &StMap) -> Vec<u16> {
    let level = |value: f32| (f64::from(value) * 65535.0).round() as u16;
    map.pixels.iter().flat_map(|&[s, t, inside]| if inside > 0.0 { [level(s), level(t), u16::MAX] } else { [0; 3] }).collect()
}

fn exr_of(map: &StMap, out: &mut Cursor<Vec<u8>>) -> exr::error::UnitResult {
    let (width, height) = (map.size.width as usize, map.size.height as usize);
    let channels = SpecificChannels::rgb(|Vec2(x, y)| {
        let [s, t, inside]: Pixel = map.pixels[y * width + x];
        (s, t, inside)
    });
    let attributes = LayerAttributes { software_name: Some(Text::from(WRITER)), ..LayerAttributes::default() };
    // Rows in their order: the same bytes on any number of threads.
    let encoding = Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    Image::from_layer(Layer::new((width, height), attributes, encoding, channels)).write().to_buffered(out)
}

fn tiff_of<C: colortype::ColorType>(data: &[C::Inner], (width, height): (u32, u32), out: &mut Cursor<Vec<u8>>) -> Result<(), StMapError>
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    let write = || {
        let mut encoder = TiffEncoder::new(out)?;
        let mut image = encoder.new_image::<C>(width, height)?;
        image.encoder().write_tag(Tag::Software, WRITER)?;
        image.write_data(data)
    };
    write().map_err(|error: tiff::TiffError| StMapError::File(format!("cannot be written: {error}")))
}

/// A map that any program wrote: its size, and s and t of each pixel.
///
/// # Errors
/// What is no image, or too large.
pub fn read(path: &Path) -> Result<(ImageSize, Vec<[f32; 2]>), StMapError> {
    let wrong = |error: &dyn std::fmt::Display| StMapError::File(format!("{}: not an ST-map that can be read: {error}", path.display()));
    let mut input = BufReader::new(File::open(path).map_err(|error| wrong(&error))?);
    let mut reader = reader(&mut input).map_err(|error| wrong(&error))?;
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MOST_BYTES);
    reader.limits(limits);
    let found = reader.decode().map_err(|error| wrong(&error))?;
    if found.color().bytes_per_pixel() == found.color().channel_count() {
        return Err(wrong(&"it has 8 bits, which are too coarse for places; expected EXR, or TIFF or PNG with 16 bits"));
    }
    let found = found.into_rgb32f();
    let size = ImageSize { width: found.width(), height: found.height() };
    Ok((size, found.pixels().map(|pixel| [pixel.0[0], pixel.0[1]]).collect()))
}
