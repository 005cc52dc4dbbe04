//! Texts that are not UTF-8 and say so: by a byte order mark, or by an XML declaration.

use std::borrow::Cow;

use encoding_rs::{Encoding, UTF_8};

use super::CameraFileError;

/// An XML declaration is no longer than this, bytes.
const DECLARATION: usize = 200;

/// `bytes` in UTF-8: decoded where a byte order mark says UTF-16 or an XML declaration names another encoding (Latin-1, Windows-1252, ...); all others as they are.
///
/// # Errors
/// Bytes that are none of the encoding that is stated, or an encoding that is not known.
pub(super) fn in_utf8(bytes: &[u8]) -> Result<Cow<'_, [u8]>, CameraFileError> {
    let (encoding, mark) = match Encoding::for_bom(bytes) {
        Some(found) => found,
        None => (declared(bytes)?, 0),
    };
    if encoding == UTF_8 {
        return Ok(Cow::Borrowed(bytes));
    }
    let decoded = encoding.decode_without_bom_handling_and_without_replacement(&bytes[mark..]);
    let wrong =
        || CameraFileError::new(format!("says that it is in {}, and holds bytes that are not; expected these, or UTF-8", encoding.name()));
    Ok(Cow::Owned(decoded.ok_or_else(wrong)?.into_owned().into_bytes()))
}

/// The encoding that an XML declaration names; UTF-8 without one.
fn declared(bytes: &[u8]) -> Result<&'static Encoding, CameraFileError> {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(DECLARATION)]);
    let declaration = head.strip_prefix("<?xml").and_then(|rest| rest.split_once("?>")).map(|(declaration, _)| declaration);
    let label = declaration.and_then(|text| {
        let value = text.split_once("encoding")?.1.trim_start().strip_prefix('=')?.trim_start();
        let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
        value[1..].split_once(quote).map(|(label, _)| label)
    });
    let Some(label) = label else { return Ok(UTF_8) };
    let found = Encoding::for_label(label.as_bytes());
    // Without a byte order mark a declaration that can be read byte by byte is in no encoding of two bytes.
    let found = found.map(|encoding| if encoding.is_ascii_compatible() { encoding } else { UTF_8 });
    found.ok_or_else(|| {
        CameraFileError::new(format!("encoding `{}` is not known; expected UTF-8", super::number::shortened(label))).on_line(1)
    })
}
