//! Streams of a document.

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// zlib, as PDF has it.
pub fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut out = ZlibEncoder::new(Vec::new(), Compression::default());
    // Writing to memory cannot fail.
    let _ = std::io::Write::write_all(&mut out, bytes);
    out.finish().unwrap_or_default()
}
