//! Grey levels as they come through a pipe.

use std::io::{self, BufRead};

use calibench_images::photo::MOST_BYTES;
use calibench_model::Image;
use calibench_model::camera::ImageSize;

/// Characters of a number in a head.
const DIGITS: usize = 9;

/// A frame as it was decoded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Still {
    /// Columns and rows, px.
    pub size: ImageSize,
    /// Grey levels, row by row; 255 is white.
    pub levels: Vec<u8>,
}

impl Still {
    /// Its grey values.
    pub fn image(&self) -> Image<'static> {
        let grey = self.levels.iter().map(|&level| f32::from(level) / 255.0).collect();
        Image::new(self.size.width as usize, self.size.height as usize, grey)
    }
}

/// The next picture; `None` where there is none, or only a part of one, as of a program that ended.
///
/// # Errors
/// In words, what is there instead; [`io::Error`] as text.
pub(crate) fn next(input: &mut impl BufRead) -> Result<Option<Still>, String> {
    match read(input) {
        Ok(still) => still.map(Some),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
        Err(error) => Err(error.to_string()),
    }
}

/// A picture, or in words what is there instead.
fn read(input: &mut impl BufRead) -> io::Result<Result<Still, String>> {
    let mut magic = [0; 2];
    input.read_exact(&mut magic)?;
    if magic != *b"P5" {
        return Ok(Err(format!("the bytes {magic:02x?}")));
    }
    let mut numbers = [0; 3];
    for number in &mut numbers {
        match self::number(input)? {
            Some(found) => *number = found,
            None => return Ok(Err("a head without columns, rows and white".into())),
        }
    }
    let [width, height, white] = numbers;
    let count = u64::from(width) * u64::from(height);
    if count == 0 || white != 255 {
        return Ok(Err(format!("{width} x {height} px with {white} for white")));
    }
    if count * 4 > MOST_BYTES {
        return Ok(Err(format!("{width} x {height} px, which take more than {} MB", MOST_BYTES >> 20)));
    }
    let mut levels = vec![0; count as usize];
    input.read_exact(&mut levels)?;
    Ok(Ok(Still { size: ImageSize { width, height }, levels }))
}

/// A number, with the blank before it where there is one, and the one behind it.
fn number(input: &mut impl BufRead) -> io::Result<Option<u32>> {
    let mut text = String::new();
    loop {
        let mut byte = [0];
        input.read_exact(&mut byte)?;
        match byte[0] {
            digit @ b'0'..=b'9' if text.len() < DIGITS => text.push(char::from(digit)),
            b' ' | b'\n' if text.is_empty() => {}
            b' ' | b'\n' => return Ok(text.parse().ok()),
            _ => return Ok(None),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(mut bytes: &[u8]) -> Vec<Result<Still, String>> {
        std::iter::from_fn(|| next(&mut bytes).transpose()).take(9).collect()
    }

    #[test]
    fn pictures_come_one_after_the_other() {
        let found = all(b"P5\n3 2\n255\n\x00\x01\x02\xff\x0a\x20P5\n1 1\n255\n\x07P5\n2 2\n255\n\x00");
        assert_eq!(found.len(), 2, "the third is cut short");
        let first = found[0].as_ref().unwrap();
        assert_eq!((first.size.width, first.size.height, first.levels.as_slice()), (3, 2, &[0, 1, 2, 255, 10, 32][..]));
        assert_eq!(first.image().at(0, 1), 1.0);
        assert!((first.image().at(2, 0) - 2.0 / 255.0).abs() < 1e-7);
        assert!(all(b"").is_empty() && all(b"P").is_empty());
    }

    #[test]
    fn what_is_no_picture_is_named() {
        for (bytes, said) in [
            (&b"P6\n1 1\n255\n\0\0\0"[..], "the bytes [50, 36]"),
            (b"P5\n0 4\n255\n", "0 x 4 px with 255"),
            (b"P5\n1 4\n65535\n", "1 x 4 px with 65535"),
            (b"P5\n-1 4\n255\n", "a head without"),
            (b"P5\n1234567890 4\n255\n", "a head without"),
            (b"P5\n999999999 999999999\n255\n", "which take more than"),
        ] {
            let found = all(bytes);
            assert!(found[0].as_ref().unwrap_err().starts_with(said) || found[0].as_ref().unwrap_err().contains(said), "{found:?}");
        }
    }
}
