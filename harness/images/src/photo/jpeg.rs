//! JPEGs that end early: segments are walked up to the end mark; nothing is decoded.

use std::io::{self, BufRead, ErrorKind, Read, SeekFrom};

use super::Input;

/// Second byte of the end mark.
const END_OF_IMAGE: u8 = 0xd9;

/// Whether the end mark of the image that starts here follows. Leaves the input where it was.
pub(crate) fn is_whole(mut input: &mut dyn Input) -> io::Result<bool> {
    let start = input.stream_position()?;
    let walked = walk(&mut input);
    input.seek(SeekFrom::Start(start))?;
    match walked {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}

/// Ends behind the end mark, or with an error at the end of the file.
fn walk(input: &mut impl BufRead) -> io::Result<()> {
    loop {
        match marker(input)? {
            END_OF_IMAGE => return Ok(()),
            // Stuffed bytes, restart marks and the start of the image stand alone. Entropy-coded data is looked over for the next mark.
            0x00 | 0x01 | 0xd0..=0xd8 => {}
            _ => {
                let mut length = [0; 2];
                input.read_exact(&mut length)?;
                let length = u64::from(u16::from_be_bytes(length)).saturating_sub(2);
                if io::copy(&mut input.take(length), &mut io::sink())? < length {
                    return Err(ErrorKind::UnexpectedEof.into());
                }
            }
        }
    }
}

/// The byte after the next 0xff, of which there may be several.
fn marker(input: &mut impl BufRead) -> io::Result<u8> {
    loop {
        let buffer = input.fill_buf()?;
        if buffer.is_empty() {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        let Some(place) = buffer.iter().position(|&byte| byte == 0xff) else {
            let all = buffer.len();
            input.consume(all);
            continue;
        };
        input.consume(place + 1);
        let mut byte = [0xff];
        while byte == [0xff] {
            input.read_exact(&mut byte)?;
        }
        return Ok(byte[0]);
    }
}
