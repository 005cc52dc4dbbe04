//! JPEG as a camera writes it, there and back.

use calibench_model::Image;
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageFormat, load_from_memory_with_format};

use super::SensorError;

/// The image of 8 bits that is left of `image` after JPEG of `quality`, from 1 to 100. Grey values are rounded to 8 bits before.
///
/// The encoder cuts coefficients to whole numbers before it divides and rounds them: at quality 100 the error is 0.60 levels rms where rounding would
/// leave 0.41.
///
/// # Errors
/// [`SensorError::JpegSize`] if a side is longer than JPEG's 65535 px or the image is empty, [`SensorError::Jpeg`] if the codec refuses.
pub fn through_jpeg(mut image: Image<'static>, quality: u8) -> Result<Image<'static>, SensorError> {
    let (width, height) = (image.width(), image.height());
    let side = |length: usize| u16::try_from(length).ok().filter(|&length| length > 0).ok_or(SensorError::JpegSize { width, height });
    let (columns, rows) = (side(width)?, side(height)?);
    let mut file = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(&mut file, quality);
    encoder.encode(&image.to_u8(), u32::from(columns), u32::from(rows), ExtendedColorType::L8)?;
    let decoded = load_from_memory_with_format(&file, ImageFormat::Jpeg)?.into_luma8();
    for (grey, &level) in image.grey_mut().iter_mut().zip(decoded.as_raw()) {
        *grey = f32::from(level) / 255.0;
    }
    Ok(image)
}
