//! Images to PNG files, in strips of rows that are filtered and compressed side by side.
//!
//! Each strip is a chunk of the file and a block of its deflate stream. How rows are shared out among strips depends on the image's size alone: the bytes are
//! the same on any number of threads.

mod deflate;
mod filter;
mod huffman;

use std::io::{self, Write};

use calibench_model::{Image, level};
use multiversion::multiversion;
use rayon::prelude::*;

/// Bytes of a strip, about: enough for codes of its own to pay.
const STRIP: usize = 1 << 18;
/// Strips that are made before they are written, a thread: bounds the memory.
const BATCH: usize = 8;
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
const GREY: u8 = 0;
/// Deflate with a window of 32 kB, no dictionary, compressed fast.
const ZLIB: [u8; 2] = [0x78, 0x01];

/// A strip's chunk, and the checksum and number of what was compressed.
struct Strip {
    chunk: Vec<u8>,
    adler: u32,
    bytes: usize,
}

/// Writes an image as PNG of 8 or 16 bits a pixel; values outside [0, 1] are clipped, NaN is black.
///
/// # Errors
/// An image without pixels or with more on a side than PNG holds, and what the output refuses.
pub(super) fn encode(output: &mut dyn Write, image: &Image, sixteen_bits: bool) -> io::Result<()> {
    let side = |pixels: usize| i32::try_from(pixels).ok().filter(|&pixels| pixels > 0);
    let (Some(width), Some(height)) = (side(image.width()), side(image.height())) else {
        let why = format!("an image of {} x {} px cannot be written as PNG", image.width(), image.height());
        return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
    };
    let pixel = if sixteen_bits { 2 } else { 1 };
    let mut header = [0; 13];
    header[..4].copy_from_slice(&width.to_be_bytes());
    header[4..8].copy_from_slice(&height.to_be_bytes());
    (header[8], header[9]) = (8 * pixel as u8, GREY);
    output.write_all(SIGNATURE)?;
    output.write_all(&chunk(*b"IHDR", &header))?;
    let rows = STRIP.div_ceil(image.width() * pixel);
    let firsts: Vec<usize> = (0..image.height()).step_by(rows).collect();
    let mut adler = 1;
    for batch in firsts.chunks(BATCH * rayon::current_num_threads()) {
        let made = |&first: &usize| Strip::of(image, first, rows.min(image.height() - first), pixel);
        for strip in batch.par_iter().map(made).collect::<Vec<_>>() {
            output.write_all(&strip.chunk)?;
            adler = joined(adler, strip.adler, strip.bytes);
        }
    }
    output.write_all(&chunk(*b"IDAT", &[&deflate::LAST[..], &adler.to_be_bytes()].concat()))?;
    output.write_all(&chunk(*b"IEND", &[]))
}

impl Strip {
    /// That of `rows` rows from `first` on, of pixels of `pixel` bytes.
    fn of(image: &Image, first: usize, rows: usize, pixel: usize) -> Self {
        let n = image.width() * pixel;
        let [mut row, mut above, mut tried] = [(); 3].map(|()| vec![0; n]);
        if first > 0 {
            bytes_of(image.row(first - 1), pixel, &mut above);
        }
        let mut filtered = Vec::with_capacity(rows * (n + 1));
        for y in first..first + rows {
            bytes_of(image.row(y), pixel, &mut row);
            filter::append_filtered(&row, &above, pixel, &mut tried, &mut filtered);
            std::mem::swap(&mut row, &mut above);
        }
        let mut data = if first == 0 { ZLIB.to_vec() } else { Vec::new() };
        deflate::append(&filtered, &mut data);
        Self { chunk: chunk(*b"IDAT", &data), adler: simd_adler32::adler32(&filtered.as_slice()), bytes: filtered.len() }
    }
}

/// A row's grey values as bytes, the higher one first.
#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
fn bytes_of(grey: &[f32], pixel: usize, bytes: &mut [u8]) {
    if pixel == 1 {
        bytes.iter_mut().zip(grey).for_each(|(byte, &grey)| *byte = level(grey, u16::from(u8::MAX)) as u8);
    } else {
        let (pairs, _) = bytes.as_chunks_mut::<2>();
        pairs.iter_mut().zip(grey).for_each(|(pair, &grey)| *pair = level(grey, u16::MAX).to_be_bytes());
    }
}

/// A chunk: length, type, data, checksum.
fn chunk(kind: [u8; 4], data: &[u8]) -> Vec<u8> {
    let mut chunk = Vec::with_capacity(data.len() + 12);
    chunk.extend((data.len() as u32).to_be_bytes());
    chunk.extend(kind);
    chunk.extend(data);
    let crc = crc32fast::hash(&chunk[4..]);
    chunk.extend(crc.to_be_bytes());
    chunk
}

/// Adler-32 of two parts, one behind the other, from theirs; the second has `bytes` bytes.
///
/// Source: RFC 1950, Sect. 8.2: s1 is one more than the sum of the bytes, s2 the sum of all s1.
fn joined(first: u32, second: u32, bytes: usize) -> u32 {
    const BASE: u64 = 65521;
    let sums = |adler: u32| [u64::from(adler & 0xffff), u64::from(adler >> 16)];
    let ([a1, a2], [b1, b2]) = (sums(first), sums(second));
    let more = a1 + BASE - 1;
    let s1 = (more + b1) % BASE;
    let s2 = (a2 + b2 + bytes as u64 % BASE * (more % BASE)) % BASE;
    (s2 << 16 | s1) as u32
}

#[cfg(test)]
mod tests;
