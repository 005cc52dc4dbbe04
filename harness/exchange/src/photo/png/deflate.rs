//! Bytes to a block of a deflate stream: Huffman codes of its own, and runs of zeros. No other matches are sought, of which noise has none.
//!
//! As the crate fdeflate, but in blocks that can be made side by side, and with codes for what is in them.
//!
//! Source: RFC 1951.

use super::huffman::{Code, LONGEST, SYMBOLS, codes};

/// Ends a block.
const END: usize = 256;
/// The longest match.
const MOST: usize = 258;
/// Values that are looked at together.
const BLOCK: usize = 8;

/// Where values go, and runs.
trait Sink {
    fn eight(&mut self, values: [u8; BLOCK]);
    fn one(&mut self, value: u8);
    /// A match: `count` zeros behind a zero.
    fn zeros(&mut self, count: usize);
}

/// Values to literals and runs of zeros.
#[inline(always)]
fn feed(values: &[u8], sink: &mut impl Sink) {
    let mut run = 0;
    let (blocks, rest) = values.as_chunks::<BLOCK>();
    for block in blocks {
        if u64::from_ne_bytes(*block) == 0 {
            run += BLOCK;
            continue;
        }
        if run > 0 {
            feed_zeros(run, sink);
            run = 0;
        }
        sink.eight(*block);
    }
    if run > 0 {
        feed_zeros(run, sink);
    }
    rest.iter().for_each(|&value| sink.one(value));
}

fn feed_zeros(mut run: usize, sink: &mut impl Sink) {
    sink.one(0);
    run -= 1;
    while run >= 3 {
        let match_length = run.min(MOST);
        sink.zeros(match_length);
        run -= match_length;
    }
    (0..run).for_each(|_| sink.one(0));
}

/// The symbol of a match's length, the bits behind it, and how many.
fn length_symbol(length: usize) -> (usize, u64, u32) {
    if length == MOST {
        return (285, 0, 0);
    }
    let from = length - 3;
    if from < 8 {
        return (257 + from, 0, 0);
    }
    let extra = from.ilog2() - 2;
    let symbol = 257 + 4 * extra as usize + (from >> extra);
    (symbol, (from & ((1 << extra) - 1)) as u64, extra)
}

/// Counts symbols: literals in tables by turns, or equal ones would wait for each other.
struct Counter {
    tables: [[u32; 256]; 4],
    lengths: [u32; SYMBOLS],
}

impl Sink for Counter {
    #[inline(always)]
    fn eight(&mut self, values: [u8; BLOCK]) {
        for (i, &value) in values.iter().enumerate() {
            self.tables[i % 4][usize::from(value)] += 1;
        }
    }

    fn one(&mut self, value: u8) {
        self.tables[0][usize::from(value)] += 1;
    }

    fn zeros(&mut self, count: usize) {
        self.lengths[length_symbol(count).0] += 1;
    }
}

/// Writes symbols, the first bit lowest.
struct Writer<'a> {
    codes: &'a [Code; SYMBOLS],
    literals: [u32; 256],
    output: &'a mut [u8],
    at: usize,
    /// Bits that are not yet a byte, and how many.
    bits: u64,
    count: u32,
}

impl Writer<'_> {
    /// At most 56 bits.
    #[inline(always)]
    fn put(&mut self, bits: u64, count: u32) {
        self.bits |= bits << self.count;
        self.count += count;
        self.output[self.at..self.at + 8].copy_from_slice(&self.bits.to_le_bytes());
        let whole = self.count / 8;
        self.at += whole as usize;
        self.bits = self.bits.checked_shr(8 * whole).unwrap_or(0);
        self.count %= 8;
    }

    fn symbol(&mut self, symbol: usize) {
        let Code { bits, length } = self.codes[symbol];
        self.put(u64::from(bits), u32::from(length));
    }
}

impl Sink for Writer<'_> {
    #[inline(always)]
    fn eight(&mut self, values: [u8; BLOCK]) {
        for four in values.as_chunks::<4>().0 {
            let [a, b, c, d] = four.map(|value| self.literals[usize::from(value)]);
            let code = |literal: u32| u64::from(literal & 0xffff);
            let length = |literal: u32| literal >> 16;
            let ab = code(a) | code(b) << length(a);
            let cd = code(c) | code(d) << length(c);
            let first = length(a) + length(b);
            self.put(ab | cd << first, first + length(c) + length(d));
        }
    }

    fn one(&mut self, value: u8) {
        self.symbol(usize::from(value));
    }

    fn zeros(&mut self, count: usize) {
        let (symbol, extra, bits) = length_symbol(count);
        self.symbol(symbol);
        // Behind it the distance, 1, whose code is one zero.
        self.put(extra, bits + 1);
    }
}

/// Appends a block of a deflate stream, which is not its last, that ends with a whole byte.
pub(super) fn append(values: &[u8], output: &mut Vec<u8>) {
    let counts = counted(values);
    let codes = codes(&counts);
    let literals = std::array::from_fn(|i| u32::from(codes[i].bits) | u32::from(codes[i].length) << 16);
    let at = output.len();
    output.resize(at + room(&counts, &codes), 0);
    let mut writer = Writer { codes: &codes, literals, output, at, bits: 0, count: 0 };
    head(&codes, &mut writer);
    feed(values, &mut writer);
    writer.symbol(END);
    // An empty block that is stored has its length, twice, at whole bytes, wherever the one before ended.
    writer.put(0, 3);
    let fill = (8 - writer.count) % 8;
    writer.put(0, fill);
    writer.put(0xffff_0000, 32);
    let end = writer.at;
    output.truncate(end);
}

/// How often each symbol occurs.
fn counted(values: &[u8]) -> [u32; SYMBOLS] {
    let mut counter = Counter { tables: [[0; 256]; 4], lengths: [0; SYMBOLS] };
    feed(values, &mut counter);
    let mut counts = counter.lengths;
    for table in &counter.tables {
        counts.iter_mut().zip(table).for_each(|(count, add)| *count += add);
    }
    counts[END] = 1;
    counts
}

/// Bytes that a block does not exceed: its symbols, with the most bits behind those of matches, its head, its end, and the word that is written last.
fn room(counts: &[u32; SYMBOLS], codes: &[Code; SYMBOLS]) -> usize {
    const BEHIND: u64 = 6;
    const REST: usize = 256;
    let symbols: u64 = counts.iter().zip(codes).map(|(&count, code)| u64::from(count) * u64::from(code.length)).sum();
    let matches: u64 = counts[END + 1..].iter().map(|&count| BEHIND * u64::from(count)).sum();
    (symbols + matches).div_ceil(8) as usize + REST
}

/// The last block, with nothing in it.
pub(super) const LAST: [u8; 2] = [3, 0];

/// The order in which the lengths of the codes for lengths stand.
const ORDER: [usize; 19] = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];

/// The head of a block with codes of its own. Lengths of codes, 0 to [`LONGEST`], are written with 3 bits (0 to 2) or 4.
fn head(codes: &[Code; SYMBOLS], writer: &mut Writer<'_>) {
    // Not the last; dynamic codes; 286 symbols, 1 distance, 19 code lengths.
    writer.put(2 << 1, 3);
    writer.put(0x1d | 0xf << 10, 14);
    let length = |value: usize| match value {
        0..3 => 3,
        3..=LONGEST => 4,
        _ => 0,
    };
    ORDER.iter().for_each(|&value| writer.put(u64::from(length(value)), 3));
    // Canonical codes, as everywhere: three of three bits, then those of four.
    let code = |value: usize| if value < 3 { value as u16 } else { (3 << 1) + (value - 3) as u16 };
    let mut write = |value: usize| writer.put(u64::from(code(value).reverse_bits() >> (16 - length(value))), length(value));
    codes.iter().for_each(|code| write(usize::from(code.length)));
    // The one distance.
    write(1);
}
