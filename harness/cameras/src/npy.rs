//! NumPy's arrays as files hold them: .npy, and the members of .npz.

use half::f16;

use super::CameraFileError;
use super::json::python;
use super::number::{shortened, shortest};
use super::tree::{self, Entry, Value};

const MAGIC: &[u8] = b"\x93NUMPY";
/// Numbers of an array that are read: of a larger one, which is no camera's, the shape is all that is known.
const MOST_NUMBERS: usize = 1 << 12;
/// Characters of a text at most.
const MOST_CHARACTERS: usize = 1 << 10;
/// Bytes of an array that may be needed: its head and its numbers, of 16 bytes at most.
pub(super) const MOST_BYTES: u64 = (1 << 17) + 16 * MOST_NUMBERS as u64;

/// Whether a file is one array.
pub(super) fn is_array(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Whether an array is one of Python objects.
pub(super) fn holds_objects(bytes: &[u8]) -> bool {
    parts(bytes).is_ok_and(|(head, _)| head.contains("'|O'"))
}

/// An array as an entry of a tree: a number or a text where it holds one, a matrix as a FileStorage has it where it has two sides besides those of 1, and a list
/// without values where it is no camera's.
///
/// # Errors
/// Bytes that are no array, a head that is none, fewer numbers than it says, Python objects.
pub(super) fn entry(bytes: &[u8]) -> Result<Entry, CameraFileError> {
    let (head, data) = parts(bytes)?;
    let head = python(head).map_err(|error| CameraFileError { line: None, ..error })?;
    let wrong = |problem: String| CameraFileError::new(problem);
    let without_line = |error: CameraFileError| CameraFileError { line: None, ..error };
    let Value::Scalar(descr) = &head.required("descr").map_err(without_line)?.value else {
        return Ok(no_camera_s());
    };
    let sides: Vec<usize> = head
        .required("shape")
        .and_then(|shape| shape.items()?.iter().map(side).collect::<Result<_, CameraFileError>>())
        .map_err(without_line)?;
    let fortran = head.text_of("fortran_order").map_err(without_line)? == "True";
    let count = sides.iter().try_fold(1_usize, |product, side| product.checked_mul(*side)).ok_or_else(|| wrong("is too large".into()))?;
    let kind = Kind::of(descr)?;
    if count > MOST_NUMBERS || count == 0 {
        return Ok(no_camera_s());
    }
    if let Kind::Text(width) = kind {
        let text = data.get(..4 * width).filter(|_| count == 1).map(|bytes| characters(bytes, descr.starts_with('>')));
        return Ok(text.map_or_else(no_camera_s, scalar));
    }
    let numbers = kind.numbers(data, count).ok_or_else(|| {
        wrong(format!("expected {count} numbers of {} bytes for the shape ({}), found {} bytes", kind.width(), shape(&sides), data.len()))
    })?;
    let numbers = if fortran { by_rows(&numbers, &sides) } else { numbers };
    Ok(match sides.iter().copied().filter(|side| *side > 1).collect::<Vec<_>>()[..] {
        [] => scalar(numbers[0].to_string()),
        [columns] => matrix(1, columns, &numbers),
        [rows, columns] => matrix(rows, columns, &numbers),
        _ => no_camera_s(),
    })
}

fn side(entry: &Entry) -> Result<usize, CameraFileError> {
    entry.text()?.parse().map_err(|_| entry.wrong("expected whole numbers from 0").of("shape"))
}

fn shape(sides: &[usize]) -> String {
    sides.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

/// The text of the head, and the bytes of the numbers.
fn parts(bytes: &[u8]) -> Result<(&str, &[u8]), CameraFileError> {
    let short = || CameraFileError::new("ends within the head of NumPy's array");
    let rest = bytes.strip_prefix(MAGIC).ok_or_else(|| CameraFileError::new("is no array of NumPy's: expected .npy"))?;
    let (length, rest) = match rest {
        [1, _, a, b, rest @ ..] => (usize::from(u16::from_le_bytes([*a, *b])), rest),
        [2 | 3, _, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, rest),
        [1..=3, ..] | [] => return Err(short()),
        [version, ..] => return Err(CameraFileError::new(format!("version {version} of .npy is not known; expected 1 to 3"))),
    };
    let (head, data) = rest.split_at_checked(length).ok_or_else(short)?;
    let head = std::str::from_utf8(head).map_err(|_| CameraFileError::new("the head of NumPy's array is no text"))?;
    Ok((head, data))
}

/// What is at no place of a camera's.
fn no_camera_s() -> Entry {
    Entry { line: 0, value: Value::List(Vec::new()) }
}

fn scalar(text: String) -> Entry {
    Entry { line: 0, value: Value::Scalar(text) }
}

fn matrix(rows: usize, columns: usize, numbers: &[f64]) -> Entry {
    let data = Value::List(numbers.iter().map(|&number| scalar(shortest(number))).collect());
    let data = ("data".to_owned(), Entry { line: 0, value: data });
    let parts = [("rows", rows.to_string()), ("cols", columns.to_string()), ("dt", "d".to_owned())];
    let mut entries: Vec<(String, Entry)> = parts.into_iter().map(|(name, text)| (name.to_owned(), scalar(text))).collect();
    entries.push(data);
    Entry { line: 0, value: Value::Map(entries) }
}

/// Text in four bytes a character, without zeros at its end.
fn characters(bytes: &[u8], big: bool) -> String {
    let code = |four: &[u8]| four.iter().enumerate().fold(0, |sum, (i, byte)| sum | u32::from(*byte) << (8 * if big { 3 - i } else { i }));
    let text: String = bytes.chunks_exact(4).map(|four| char::from_u32(code(four)).unwrap_or('\u{fffd}')).collect();
    text.trim_end_matches('\0').to_owned()
}

/// Numbers in columns, as Fortran has them, row by row.
fn by_rows(numbers: &[f64], sides: &[usize]) -> Vec<f64> {
    let place = |mut index: usize| {
        let (mut at, mut step) = (0, numbers.len());
        for side in sides.iter().rev() {
            step /= side;
            at += index % side * step;
            index /= side;
        }
        at
    };
    (0..numbers.len()).map(|index| numbers[place(index)]).collect()
}

/// What an array consists of, and the order of its bytes.
#[derive(Clone, Copy)]
enum Kind {
    /// Floats of so many bytes.
    Float(usize, bool),
    /// Whole numbers of so many bytes, with a sign or without.
    Whole(usize, bool, bool),
    /// Texts of so many characters.
    Text(usize),
}

impl Kind {
    fn of(descr: &str) -> Result<Self, CameraFileError> {
        let unknown = || {
            let expected = "expected floats of 2, 4 or 8 bytes, whole numbers, truth values or texts";
            CameraFileError::new(format!("holds `{}`; {expected}", shortened(descr)))
        };
        let mut characters = descr.chars();
        let big = characters.next() == Some('>');
        let kind = characters.next().ok_or_else(unknown)?;
        if kind == 'O' {
            let expected = "expected arrays: np.savez(FILE, camera_matrix=K, dist_coeffs=D)";
            return Err(CameraFileError::new(format!("holds Python objects, which only Python unpickles; {expected}")));
        }
        let width: usize = characters.as_str().parse().map_err(|_| unknown())?;
        match (kind, width) {
            ('f', 2 | 4 | 8) => Ok(Self::Float(width, big)),
            ('i', 1 | 2 | 4 | 8) => Ok(Self::Whole(width, true, big)),
            ('u', 1 | 2 | 4 | 8) | ('b', 1) => Ok(Self::Whole(width, false, big)),
            ('U', 0..=MOST_CHARACTERS) => Ok(Self::Text(width)),
            _ => Err(unknown()),
        }
    }

    fn width(self) -> usize {
        match self {
            Self::Float(width, _) | Self::Whole(width, ..) => width,
            Self::Text(width) => 4 * width,
        }
    }

    /// So many numbers; `None` where there are fewer bytes.
    fn numbers(self, data: &[u8], count: usize) -> Option<Vec<f64>> {
        let width = self.width();
        let (Self::Float(_, big) | Self::Whole(_, _, big)) = self else { return None };
        let number = |bytes: &[u8]| {
            let order = |i: usize| if big { width - 1 - i } else { i };
            let bits = bytes.iter().enumerate().fold(0_u64, |sum, (i, byte)| sum | u64::from(*byte) << (8 * order(i)));
            match self {
                Self::Float(2, _) => f16::from_bits(bits as u16).to_f64(),
                Self::Float(4, _) => f64::from(f32::from_bits(bits as u32)),
                Self::Whole(_, true, _) => (bits << (64 - 8 * width)).cast_signed().wrapping_shr(64 - 8 * width as u32) as f64,
                Self::Whole(_, false, _) => bits as f64,
                _ => f64::from_bits(bits),
            }
        };
        data.get(..width * count).map(|data| data.chunks_exact(width).map(number).collect())
    }
}

/// An array of floats as a file, of so many rows; without a row of one number alone.
pub(super) fn floats(shape: &[usize], numbers: &[f64]) -> Vec<u8> {
    whole("<f8", shape, numbers.iter().flat_map(|number| number.to_le_bytes()))
}

/// Whole numbers as a file.
pub(super) fn integers(shape: &[usize], numbers: &[i64]) -> Vec<u8> {
    whole("<i8", shape, numbers.iter().flat_map(|number| number.to_le_bytes()))
}

/// A text as a file.
pub(super) fn text(text: &str) -> Vec<u8> {
    let characters = text.chars().flat_map(|c| u32::from(c).to_le_bytes());
    whole(&format!("<U{}", text.chars().count().max(1)), &[], characters)
}

/// Version 1 of .npy: the head ends at a multiple of 64 bytes.
fn whole(descr: &str, sides: &[usize], data: impl Iterator<Item = u8>) -> Vec<u8> {
    let comma = if sides.len() == 1 { "," } else { "" };
    let mut head = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}{comma}), }}", shape(sides));
    let before = MAGIC.len() + 4;
    head.extend(std::iter::repeat_n(' ', 63 - (before + head.len()) % 64));
    head.push('\n');
    let mut bytes = [MAGIC, &[1, 0], &(head.len() as u16).to_le_bytes(), head.as_bytes()].concat();
    bytes.extend(data);
    bytes
}

/// The tree of named arrays.
///
/// # Errors
/// A name that stands twice.
pub(super) fn named(arrays: Vec<(String, Entry)>) -> Result<Entry, CameraFileError> {
    Ok(Entry { line: 0, value: tree::map(arrays)? })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(descr: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        let head = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
        [MAGIC, &[1, 0], &(head.len() as u16).to_le_bytes(), head.as_bytes(), data].concat()
    }

    #[test]
    fn numbers_of_every_kind_are_read() {
        let one = |descr: &str, data: &[u8]| entry(&array(descr, "False", "()", data)).unwrap().number().unwrap();
        assert_eq!(one("<f2", &[0x00, 0x3e]), 1.5);
        assert_eq!(one(">f4", &1.25_f32.to_be_bytes()), 1.25);
        assert_eq!(one("<f8", &(-0.1_f64).to_le_bytes()), -0.1);
        assert_eq!(one("<i2", &(-3_i16).to_le_bytes()), -3.0);
        assert_eq!(one("|i1", &[0xff]), -1.0);
        assert_eq!(one("|u1", &[0xff]), 255.0);
        assert_eq!(one("<i8", &(-5_i64).to_le_bytes()), -5.0);
        assert_eq!(one("|b1", &[1]), 1.0);
        assert_eq!(entry(&array("<U3", "False", "()", b"a\0\0\0b\0\0\0\0\0\0\0")).unwrap().text(), Ok("ab"));
    }

    #[test]
    fn columns_become_rows() {
        let data: Vec<u8> = [1.0_f64, 4.0, 2.0, 5.0, 3.0, 6.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        for shape in ["(2, 3)", "(2, 1, 3)"] {
            let found = entry(&array("<f8", "True", shape, &data)).unwrap().matrix(9).unwrap();
            assert_eq!((found.rows, found.columns, found.data), (2, 3, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let found = entry(&floats(&[3], &[0.1, -2e-30, 7.0])).unwrap().matrix(3).unwrap();
        assert_eq!((found.rows, found.data), (1, vec![0.1, -2e-30, 7.0]));
        assert_eq!(entry(&integers(&[], &[-640])).unwrap().text(), Ok("-640"));
        assert_eq!(entry(&text("küche")).unwrap().text(), Ok("küche"));
        assert_eq!(floats(&[1, 5], &[0.0; 5]).len() % 8, 0);
    }

    #[test]
    fn mistakes_are_named() {
        for (bytes, expected) in [
            (array("<f8", "False", "(3, 3)", &[0; 71]), "expected 9 numbers of 8 bytes for the shape (3, 3), found 71 bytes"),
            (array("|O", "False", "()", &[]), "holds Python objects"),
            (array("<f16", "False", "()", &[0; 16]), "holds `<f16`"),
            (array("<f8", "False", "(x)", &[]), "expected"),
            (b"\x93NUMPY\x04\x00".to_vec(), "version 4 of .npy is not known"),
            (b"\x93NUMPY\x01\x00\xff\xff{".to_vec(), "ends within the head"),
        ] {
            let error = entry(&bytes).unwrap_err();
            assert!(error.problem.contains(expected), "{error}");
        }
        // Larger than any camera's, or with three sides: passed over.
        assert!(entry(&array("<f8", "False", "(9999, 2)", &[])).unwrap().items().unwrap().is_empty());
        assert!(entry(&array("<f8", "False", "(4, 3, 2)", &[0; 192])).unwrap().items().unwrap().is_empty());
    }
}
