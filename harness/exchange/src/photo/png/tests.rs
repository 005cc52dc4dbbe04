use proptest::prelude::*;

use super::*;

fn encoded(image: &Image, sixteen_bits: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    encode(&mut bytes, image, sixteen_bits).unwrap();
    bytes
}

/// A hash of the place: as noise.
fn noise(x: usize, y: usize) -> f32 {
    let mut hash = (x as u64) << 32 | y as u64;
    for _ in 0..3 {
        hash = (hash ^ hash >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    }
    (hash >> 40) as f32 / (1 << 24) as f32
}

/// Grey values of every kind: flat, a ramp, noise of any strength, runs of all lengths, and what is outside.
fn picture(width: usize, height: usize) -> Image {
    Image::from_fn(width, height, |x, y| match (y / 3) % 6 {
        0 => 0.25,
        1 => x as f32 / width as f32,
        2 => noise(x, y),
        3 => 0.5 + 0.02 * noise(x, y),
        4 => f32::from(x % (y + 2) == 0),
        _ => 3.0 * noise(x, y) - 1.0,
    })
}

/// The image that another's decoder, which checks both checksums, reads.
fn decoded(bytes: &[u8]) -> image::DynamicImage {
    image::load_from_memory_with_format(bytes, image::ImageFormat::Png).unwrap()
}

fn levels(image: &Image, top: u16) -> Vec<u16> {
    image.grey().iter().map(|&grey| (grey.clamp(0.0, 1.0) * f32::from(top)).round() as u16).collect()
}

/// Whether the zlib stream's checksum is that of what it holds: decoders of PNG do not look.
fn has_right_sum(bytes: &[u8]) -> bool {
    let mut data = Vec::new();
    let mut rest = &bytes[SIGNATURE.len()..];
    while let [a, b, c, d, kind @ ..] = rest {
        let n = u32::from_be_bytes([*a, *b, *c, *d]) as usize;
        if kind.starts_with(b"IDAT") {
            data.extend(&kind[4..4 + n]);
        }
        rest = &kind[n + 8..];
    }
    let raw = fdeflate::decompress_to_vec(&data).unwrap();
    simd_adler32::adler32(&raw.as_slice()).to_be_bytes() == data[data.len() - 4..]
}

#[test]
fn another_decoder_reads_what_was_written() {
    // More than one strip, and strips that do not end with the image.
    for (width, height) in [(1, 1), (1, 700), (700, 1), (7, 5), (640, 480), (1023, 1031), (300_000, 3)] {
        let image = picture(width, height);
        let (eight, sixteen) = (encoded(&image, false), encoded(&image, true));
        assert!(decoded(&eight).as_luma8().unwrap().as_raw() == &image.to_u8(), "{width} x {height}");
        assert!(decoded(&sixteen).as_luma16().unwrap().as_raw() == &levels(&image, u16::MAX), "{width} x {height}");
        assert!(has_right_sum(&eight) && has_right_sum(&sixteen), "{width} x {height}");
    }
}

#[test]
fn bytes_are_the_same_on_any_number_of_threads() {
    let image = picture(1500, 1400);
    let on = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| encoded(&image, false));
    assert!(on(1) == on(3) && on(1) == on(2));
}

#[test]
fn files_are_no_larger_than_those_of_a_fast_encoder() {
    use image::ImageEncoder;
    use image::codecs::png::{CompressionType, FilterType, PngEncoder};
    let camera = Image::from_fn(900, 900, |x, y| if (x / 60 + y / 60) % 2 == 0 { 0.2 } else { 0.8 } + 0.03 * (noise(x, y) - 0.5));
    let flat = Image::from_fn(900, 900, |x, y| if (x / 60 + y / 60) % 2 == 0 { 0.2 } else { 0.8 });
    for image in [camera, flat] {
        let mut other = Vec::new();
        let encoder = PngEncoder::new_with_quality(&mut other, CompressionType::Fast, FilterType::Adaptive);
        encoder.write_image(&image.to_u8(), 900, 900, image::ExtendedColorType::L8).unwrap();
        let ours = encoded(&image, false).len();
        assert!(ours <= other.len(), "{ours} and {}", other.len());
    }
}

#[test]
fn an_image_without_pixels_is_refused() {
    let error = encode(&mut Vec::new(), &Image::new(0, 3, Vec::new()), false).unwrap_err().to_string();
    assert!(error.contains("0 x 3"), "{error}");
}

proptest! {
    #[test]
    fn any_grey_values_come_back(width in 1_usize..40, values in prop::collection::vec(-0.1_f32..1.1, 40..400)) {
        let height = values.len() / width;
        let image = Image::new(width, height, values[..width * height].to_vec());
        let back = decoded(&encoded(&image, false)).into_luma8().into_raw();
        prop_assert_eq!(back, image.to_u8());
    }
}
