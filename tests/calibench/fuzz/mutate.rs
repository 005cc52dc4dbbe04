//! Files that are not quite what they were.

use rand::{Rng, RngExt};

/// Numbers that readers stumble over.
const NUMBERS: [&str; 22] = [
    "0",
    "-0",
    "-1",
    "1",
    "2",
    "255",
    "65536",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "18446744073709551616",
    "1e300",
    "-1e300",
    "1e-320",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "1.7976931348623157e308",
    "0x10",
    "1,5",
    "",
];
/// Pieces of the formats' grammars, and names that command a terminal, a spreadsheet or a page.
const PIECES: [&str; 28] = [
    ",",
    ";",
    "\n",
    "\r\n",
    "\"",
    "\"\"",
    "'",
    "=",
    "[",
    "]",
    "[[",
    "{",
    "}",
    "<",
    "</",
    "/>",
    "<!--",
    "<![CDATA[",
    "&amp;",
    "#",
    ":",
    "- ",
    "%",
    "\0",
    "\u{1b}[2J",
    "=1+2",
    "|`*",
    "\u{feff}",
];
/// Changes of one file at most.
const MOST_CHANGES: u32 = 4;
/// A mutated file is no longer, bytes.
const LONGEST: usize = 1 << 16;

/// `seed` after one to four changes: of bits, bytes, ranges, lines, numbers and pieces; or crossed with `other`.
pub fn mutated(random: &mut impl Rng, seed: &[u8], other: &[u8]) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..random.random_range(1..=MOST_CHANGES) {
        change(random, &mut bytes, other);
        bytes.truncate(LONGEST);
    }
    bytes
}

fn change(random: &mut impl Rng, bytes: &mut Vec<u8>, other: &[u8]) {
    let range = range_in(random, bytes.len());
    match random.random_range(0..12) {
        0 if !bytes.is_empty() => {
            let place = random.random_range(0..bytes.len());
            bytes[place] ^= 1 << random.random_range(0..8);
        }
        1 if !bytes.is_empty() => {
            let place = random.random_range(0..bytes.len());
            bytes[place] = random.random();
        }
        2 => drop(bytes.drain(range)),
        3 => {
            let copy = bytes[range].to_vec();
            insert(random, bytes, &copy);
        }
        4 => bytes.truncate(range.start),
        5 => {
            let piece = PIECES[random.random_range(0..PIECES.len())];
            insert(random, bytes, piece.as_bytes());
        }
        6 => {
            let part = other[range_in(random, other.len())].to_vec();
            insert(random, bytes, &part);
        }
        7 => lines(random, bytes),
        8 => {
            // The head of one and the tail of the other.
            bytes.truncate(range.start);
            bytes.extend(&other[random.random_range(0..=other.len())..]);
        }
        _ => number(random, bytes),
    }
}

fn range_in(random: &mut impl Rng, length: usize) -> std::ops::Range<usize> {
    let start = random.random_range(0..=length);
    let most = if random.random() { 8 } else { length };
    start..(start + random.random_range(0..=most)).min(length)
}

fn insert(random: &mut impl Rng, bytes: &mut Vec<u8>, part: &[u8]) {
    let place = random.random_range(0..=bytes.len());
    bytes.splice(place..place, part.iter().copied());
}

/// A line is left out, said again or exchanged with another.
fn lines(random: &mut impl Rng, bytes: &mut Vec<u8>) {
    let mut lines: Vec<Vec<u8>> = bytes.split_inclusive(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
    if lines.is_empty() {
        return;
    }
    let (one, other) = (random.random_range(0..lines.len()), random.random_range(0..lines.len()));
    match random.random_range(0..3) {
        0 => drop(lines.remove(one)),
        1 => lines.insert(other, lines[one].clone()),
        _ => lines.swap(one, other),
    }
    *bytes = lines.concat();
}

/// A number is replaced by another one.
fn number(random: &mut impl Rng, bytes: &mut Vec<u8>) {
    let is_digit = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+' | b'e');
    let starts: Vec<usize> =
        (0..bytes.len()).filter(|&i| bytes[i].is_ascii_digit() && (i == 0 || !is_digit(&bytes[i - 1]) || bytes[i - 1] == b'-')).collect();
    if starts.is_empty() {
        return;
    }
    let start = starts[random.random_range(0..starts.len())];
    let end = start + bytes[start..].iter().take_while(|byte| is_digit(byte)).count();
    let instead = NUMBERS[random.random_range(0..NUMBERS.len())];
    bytes.splice(start..end, instead.bytes());
}
