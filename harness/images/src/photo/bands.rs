//! PNG files that are written fast: bands of rows, each compressed for itself, on all threads.

use std::io::{self, Write};
use std::ops::Range;

use calibench_files::pipelined::pipelined;
use calibench_model::Image;
use fdeflate::Compressor;
use png::chunk::IDAT;

use super::begin;
use super::filters::{ABOVE, AVERAGE, LEFT, Rows, filter, size};

/// Bytes of levels that a band has, about: with the grey values that they are made from it stays in a processor's own memory.
const BAND: usize = 1 << 18;
/// Bands that are compressed while those before them are written.
const BATCH: usize = 32;
/// Bytes before and after what is compressed: a head, and the checksum.
const HEAD: usize = 2;
const END: usize = 4;
/// In the first byte of a block: that no other follows.
const FINAL: u8 = 1;
/// The first bits of a block of codes of its own, behind which no other follows.
const ONLY_BLOCK: u8 = FINAL | 2 << 1;
/// A block of nothing, whose first three bits are zero, fills the byte; then these follow: its length, twice.
const EMPTY: [u8; 4] = [0, 0, 0xff, 0xff];
/// The modulus of the checksum (Adler-32).
const ADLER: u64 = 65521;

/// Encodes an image as PNG of 8 or 16 bits, compressed fast; values outside [0, 1] are clipped, NaN is black.
///
/// # Errors
/// What the output refuses.
pub fn encode_png(output: &mut dyn Write, image: &Image, sixteen_bits: bool) -> io::Result<()> {
    let rows = Rows::of(image, sixteen_bits);
    let (mut writer, mut stream) = (begin(output, image, sixteen_bits)?, Stream::of(&rows));
    each_band(&rows, |mut band| writer.write_chunk(IDAT, stream.next(&mut band)).map_err(io::Error::other))?;
    writer.finish().map_err(io::Error::other)
}

/// Hands the bands of an image to `take`, one after the other.
fn each_band(rows: &Rows<'_>, take: impl FnMut(Band) -> io::Result<()>) -> io::Result<()> {
    let height = (BAND / rows.filtered_stride()).max(1);
    let bands = (0..rows.count()).step_by(height).map(|first| first..(first + height).min(rows.count()));
    pipelined(bands, BATCH, |band| Band::of(rows, band), take)
}

/// Rows that were compressed.
struct Band {
    rows: Range<usize>,
    /// A stream of its own, with head and end.
    stream: Vec<u8>,
}

impl Band {
    fn of(all: &Rows<'_>, rows: Range<usize>) -> io::Result<Self> {
        let mut filtered = Filtered::new(all.stride());
        let mut compressor = Compressor::new(Vec::with_capacity(all.filtered_stride() * rows.len()))?;
        all.each(rows.clone(), |here, above| compressor.write_data(filtered.best(here, above, all.width)))?;
        let stream = compressor.finish()?;
        // What [`open`] relies on.
        let is_known = stream.get(HEAD).is_some_and(|head| head & 7 == ONLY_BLOCK) && stream[stream.len() - END - 1] != 0;
        if is_known { Ok(Self { rows, stream }) } else { Err(io::Error::other("PNG: the compressor writes other blocks than it did")) }
    }
}

/// A row as each filter leaves it, behind the number of the filter.
struct Filtered([Vec<u8>; 3]);

impl Filtered {
    fn new(stride: usize) -> Self {
        Self([LEFT, ABOVE, AVERAGE].map(|filter| {
            let mut row = vec![0; stride + 1];
            row[0] = filter;
            row
        }))
    }

    /// That which leaves least.
    fn best(&mut self, here: &[u8], above: &[u8], width: usize) -> &[u8] {
        let [left, up, mean] = &mut self.0;
        filter::<LEFT>(here, above, width, &mut left[1..]);
        filter::<ABOVE>(here, above, width, &mut up[1..]);
        filter::<AVERAGE>(here, above, width, &mut mean[1..]);
        self.0.iter().min_by_key(|row| size(&row[1..])).map_or(&[], |row| row)
    }
}

/// One stream that is made of those of all bands.
struct Stream<'a> {
    rows: &'a Rows<'a>,
    /// The two sums of the checksum of what was written.
    sums: [u64; 2],
}

impl<'a> Stream<'a> {
    fn of(rows: &'a Rows<'_>) -> Self {
        Self { rows, sums: [1, 0] }
    }

    /// The bytes with which the stream goes on.
    fn next<'b>(&mut self, Band { rows, stream }: &'b mut Band) -> &'b [u8] {
        let checksum = stream.split_off(stream.len() - END).iter().fold(0, |sum, byte| sum << 8 | u64::from(*byte));
        self.add([checksum & 0xffff, checksum >> 16], (self.rows.filtered_stride() * rows.len()) as u64);
        if rows.end == self.rows.count() {
            stream.extend(((self.sums[1] << 16 | self.sums[0]) as u32).to_be_bytes());
        } else {
            open(stream);
        }
        &stream[if rows.start == 0 { 0 } else { HEAD }..]
    }

    /// Adds `bytes` that have the sums `a` and `b` alone.
    fn add(&mut self, [a, b]: [u64; 2], bytes: u64) {
        let before = self.sums[0] + ADLER - 1;
        self.sums = [(before + a) % ADLER, (self.sums[1] + b + bytes % ADLER * (before % ADLER)) % ADLER];
    }
}

/// Takes the end from a compressed stream, so that another block may follow at a whole byte.
fn open(stream: &mut Vec<u8>) {
    stream[HEAD] &= !FINAL;
    // The last bit of the code that ends a block is 1; those after it are zero. Three of them begin the empty block.
    let unused = stream.last().map_or(0, |byte| byte.leading_zeros());
    if unused < 3 {
        stream.push(0);
    }
    stream.extend(EMPTY);
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use zlib_rs::{InflateConfig, ReturnCode, decompress_slice};

    use super::super::parse_photo;
    use super::*;

    fn encoded(image: &Image, sixteen_bits: bool) -> Vec<u8> {
        let mut file = Vec::new();
        encode_png(&mut file, image, sixteen_bits).unwrap();
        file
    }

    fn chance(x: usize, y: usize) -> f32 {
        let mixed = (y as u32).wrapping_mul(0x9e37_79b9).rotate_left(13) ^ (x as u32).wrapping_mul(0x85eb_ca6b);
        (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d).rotate_left(16) as f32 / u32::MAX as f32
    }

    /// What the chunks of image data hold together, and how many they are.
    fn data(file: &[u8]) -> (Vec<u8>, usize) {
        let (mut rest, mut data, mut chunks) = (&file[8..], Vec::new(), 0);
        while let Some((head, behind)) = rest.split_first_chunk::<8>() {
            let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
            if &head[4..] == b"IDAT" {
                data.extend_from_slice(&behind[..length]);
                chunks += 1;
            }
            rest = &behind[length + 4..];
        }
        (data, chunks)
    }

    /// Streams end at every bit of a byte; the reader of another library checks the sum of all.
    #[test]
    fn bands_are_one_stream_wherever_they_end() {
        let mut ends = BTreeSet::new();
        for width in 1021..1045 {
            let height = 3 * BAND / width;
            // Flat, smooth and noisy parts.
            let image = Image::from_fn(width, height, |x, y| match (x / 300, y / 200 % 2) {
                (0, _) => 0.25,
                (1, _) => (x + y) as f32 / 2000.0,
                (_, noise) => 0.5 + 0.2 * noise as f32 * chance(x, y),
            });
            let (stream, chunks) = data(&encoded(&image, false));
            let mut rows = vec![0; (width + 1) * height];
            let (found, code) = decompress_slice(&mut rows, &stream, InflateConfig::default());
            assert_eq!((code, found.len(), chunks), (ReturnCode::Ok, (width + 1) * height, height.div_ceil(BAND / (width + 1))), "{width}");
            let end = |band: Band| {
                ends.extend(band.stream.iter().rev().nth(END).map(|byte| byte.leading_zeros()));
                Ok(())
            };
            each_band(&Rows::of(&image, false), end).unwrap();
        }
        assert_eq!(ends, (0..8).collect());
    }

    #[test]
    fn every_level_is_read_again_on_any_number_of_threads() {
        for (width, height) in [(1, 1), (1, 140_000), (140_000, 3), (3, 2), (2100, BATCH * 130)] {
            for sixteen_bits in [false, true] {
                let image = Image::from_fn(width, height, |x, y| if y % 64 < 40 { chance(x, y) } else { x as f32 / width as f32 });
                let top = if sixteen_bits { 65535.0 } else { 255.0 };
                let file = encoded(&image, sixteen_bits);
                let read = parse_photo(std::path::Path::new("a.png"), &file).unwrap().image;
                let nearest = |grey: &f32| (grey * top).round() / top;
                assert!(
                    read.grey().iter().eq(image.grey().iter().map(nearest).collect::<Vec<_>>().iter()),
                    "{width} x {height}, {sixteen_bits}"
                );
                for threads in [1, 3] {
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                    assert!(pool.install(|| encoded(&image, sixteen_bits)) == file, "{width} x {height} on {threads}");
                }
            }
        }
    }

    #[test]
    fn each_filter_serves_what_it_is_for() {
        let filters = |grey: fn(usize, usize) -> f32| {
            let image = Image::from_fn(256, 64, grey);
            let (stream, _) = data(&encoded(&image, false));
            let mut rows = vec![0; 257 * 64];
            decompress_slice(&mut rows, &stream, InflateConfig::default()).0.chunks(257).skip(1).map(|row| row[0]).collect::<BTreeSet<u8>>()
        };
        assert_eq!(filters(|x, _| x as f32 / 255.0), [ABOVE].into());
        assert_eq!(filters(|_, y| 0.2 + 0.6 * (y % 2) as f32), [LEFT].into());
        assert_eq!(filters(|x, y| 0.5 + 0.1 * chance(x, y)), [AVERAGE].into());
    }

    /// Whoever takes the bytes may refuse them.
    #[test]
    fn what_the_output_refuses_is_an_error() {
        struct Full(usize);
        impl Write for Full {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                self.0 = self.0.checked_sub(bytes.len()).ok_or_else(|| io::Error::other("full"))?;
                Ok(bytes.len())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let image = Image::from_fn(3000, 3000, chance);
        for room in [0, 20, 1000, 1 << 20] {
            assert!(encode_png(&mut Full(room), &image, false).unwrap_err().to_string().contains("full"), "{room}");
        }
    }
}
