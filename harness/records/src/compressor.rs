//! Compression of tables.

use std::io::{self, Write};

use zlib_rs::{Deflate, DeflateConfig, DeflateFlush, Status, Strategy};

/// What compresses a table into `output`, as gzip: the same bytes for the same rows, without a name or a time.
pub struct Compressor<W: Write> {
    output: W,
    deflate: Deflate,
    buffer: Vec<u8>,
}

/// Tables of noise are text of digits, in which short matches abound that take more bits than their digits: this strategy passes them over, which saves 6 %
/// at the same speed. The densest level saves another 4 % and takes twice as long: 52 MB of text a second, a hundredth of what measuring takes.
const CONFIG: (i32, Strategy) = (9, Strategy::Filtered);
/// The largest window, and a head and an end of gzip.
const WINDOW_BITS: i32 = 15 + 16;
/// Bytes that are handed on at once.
const BUFFER: usize = 1 << 16;

impl<W: Write> Compressor<W> {
    /// Nothing yet, to go to `output`.
    pub fn new(output: W) -> Self {
        Self::in_pieces(output, BUFFER)
    }

    /// `piece` bytes are handed on at once.
    fn in_pieces(output: W, piece: usize) -> Self {
        let (level, strategy) = CONFIG;
        let config = DeflateConfig { level, strategy, window_bits: WINDOW_BITS, ..DeflateConfig::default() };
        Self { output, deflate: Deflate::new_with_config(config), buffer: vec![0; piece] }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn finish(mut self) -> io::Result<()> {
        while self.step(&[], DeflateFlush::Finish)?.1 != Status::StreamEnd {}
        self.output.flush()
    }

    /// How many of the bytes were taken, and whether that was the end.
    fn step(&mut self, bytes: &[u8], flush: DeflateFlush) -> io::Result<(usize, Status)> {
        let (taken, made) = (self.deflate.total_in(), self.deflate.total_out());
        let status = self.deflate.compress(bytes, &mut self.buffer, flush).map_err(|error| io::Error::other(error.as_str()))?;
        let made = (self.deflate.total_out() - made) as usize;
        self.output.write_all(&self.buffer[..made])?;
        Ok(((self.deflate.total_in() - taken) as usize, status))
    }
}

impl<W: Write> Write for Compressor<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        loop {
            // Nothing is taken while what was made before fills the buffer.
            let (taken, _) = self.step(bytes, DeflateFlush::NoFlush)?;
            if taken > 0 || bytes.is_empty() {
                return Ok(taken);
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        // A flush in the middle would cost size; `finish` writes everything.
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;

    fn compressed(text: &[u8], piece: usize, buffer: usize) -> Vec<u8> {
        let mut file = Vec::new();
        let mut compressor = Compressor::in_pieces(&mut file, buffer);
        text.chunks(piece).for_each(|piece| compressor.write_all(piece).unwrap());
        compressor.finish().unwrap();
        file
    }

    #[test]
    fn another_reader_finds_every_byte_however_it_was_written() {
        // Digits that look like noise, more than a buffer of them.
        let text: String =
            (0..60_000_u64).map(|row| format!("{},{}\n", row, row.wrapping_mul(0x9e37_79b9_7f4a_7c15) % 1_000_000_007)).collect();
        for text in [text.as_bytes(), b"a,b\n", b""] {
            let file = compressed(text, 1 << 13, BUFFER);
            for (piece, buffer) in [(text.len().max(1), BUFFER), (1 << 13, 50), (text.len().max(1), 50)] {
                assert!(compressed(text, piece, buffer) == file, "pieces leave no trace");
            }
            let mut again = Vec::new();
            flate2::read::GzDecoder::new(&file[..]).read_to_end(&mut again).unwrap();
            assert!(again == text);
            assert_eq!(&file[4..8], [0; 4], "no time");
        }
    }

    #[test]
    fn a_full_output_is_an_error() {
        let mut ten_bytes = [0_u8; 10];
        let mut compressor = Compressor::new(&mut ten_bytes[..]);
        let written = compressor.write_all(&[0; 10]);
        assert!(written.and_then(|()| compressor.finish()).is_err());
    }
}
