//! Huffman codes whose length is limited.

/// Symbols of literals, the end of a block and lengths of matches.
pub(super) const SYMBOLS: usize = 286;
/// The longest code, bits: four of them fit into a word beside what is left over of a byte.
pub(super) const LONGEST: usize = 12;

/// A code, its first bit lowest, and its length, bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Code {
    pub(super) bits: u16,
    pub(super) length: u8,
}

/// The codes of symbols that occur so often, at least two of them; of one that does not occur the length is zero.
pub(super) fn codes(counts: &[u32; SYMBOLS]) -> [Code; SYMBOLS] {
    let lengths = lengths(counts);
    let mut codes = [Code::default(); SYMBOLS];
    let mut next = 0_u16;
    for length in 1..=LONGEST as u8 {
        for (code, _) in codes.iter_mut().zip(&lengths).filter(|(_, own)| **own == length) {
            *code = Code { bits: next.reverse_bits() >> (16 - length), length };
            next += 1;
        }
        next <<= 1;
    }
    codes
}

/// The lengths of the codes, bits.
fn lengths(counts: &[u32; SYMBOLS]) -> [u8; SYMBOLS] {
    let mut symbols: Vec<usize> = (0..SYMBOLS).filter(|&symbol| counts[symbol] > 0).collect();
    symbols.sort_by_key(|&symbol| (counts[symbol], symbol));
    let leaves: Vec<u64> = symbols.iter().map(|&symbol| u64::from(counts[symbol])).collect();
    let mut of_length = limited(&depths(&leaves));
    let mut lengths = [0; SYMBOLS];
    // The rarest first.
    let mut length = LONGEST;
    for symbol in symbols {
        while of_length[length] == 0 {
            length -= 1;
        }
        of_length[length] -= 1;
        lengths[symbol] = length as u8;
    }
    lengths
}

/// The depth of each leaf of Huffman's tree; `leaves` are weights, the smallest first.
fn depths(leaves: &[u64]) -> Vec<usize> {
    let n = leaves.len();
    let mut weights = leaves.to_vec();
    let mut parents = vec![0; 2 * n - 1];
    let (mut leaf, mut inner) = (0, n);
    for node in n..2 * n - 1 {
        let mut least = || {
            let is_leaf = leaf < n && (inner >= weights.len() || weights[leaf] <= weights[inner]);
            let next = if is_leaf { &mut leaf } else { &mut inner };
            parents[*next] = node;
            *next += 1;
            weights[*next - 1]
        };
        let sum = least() + least();
        weights.push(sum);
    }
    let mut depths = vec![0; 2 * n - 1];
    for node in (0..2 * n - 2).rev() {
        depths[node] = depths[parents[node]] + 1;
    }
    depths.truncate(n);
    depths
}

/// How many codes have which length, none longer than [`LONGEST`]: those that are too long are cut, and shorter ones made longer for them.
fn limited(depths: &[usize]) -> [usize; LONGEST + 1] {
    let mut of_length = [0; LONGEST + 1];
    depths.iter().for_each(|&depth| of_length[depth.min(LONGEST)] += 1);
    let mut taken: usize = (1..=LONGEST).map(|length| of_length[length] << (LONGEST - length)).sum();
    while taken > 1 << LONGEST {
        of_length[LONGEST] -= 1;
        let shorter = (1..LONGEST).rev().find(|&length| of_length[length] > 0).unwrap_or(1);
        of_length[shorter] -= 1;
        of_length[shorter + 1] += 2;
        taken -= 1;
    }
    of_length
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sum of 2^-length in units of the longest code's: a complete code takes all.
    fn taken(lengths: &[u8; SYMBOLS]) -> usize {
        lengths.iter().filter(|length| **length > 0).map(|&length| 1 << (LONGEST - usize::from(length))).sum()
    }

    #[test]
    fn codes_are_complete_and_frequent_symbols_have_the_short_ones() {
        // Powers of two: without a limit the rarest would have 20 bits.
        let counts: [u32; SYMBOLS] = std::array::from_fn(|i| if i < 21 { 1 << i } else { 0 });
        let found = lengths(&counts);
        assert_eq!(taken(&found), 1 << LONGEST);
        assert!(found[..21].is_sorted_by(|a, b| a >= b) && found[20] == 1 && usize::from(found[0]) == LONGEST, "{found:?}");
        assert!(found[21..].iter().all(|&length| length == 0));
        let even = lengths(&[1; SYMBOLS]);
        assert!(taken(&even) == 1 << LONGEST && even.iter().all(|length| [8, 9].contains(length)));
    }

    #[test]
    fn without_need_of_a_limit_they_are_huffmans() {
        let mut counts = [0; SYMBOLS];
        counts[..6].copy_from_slice(&[45, 13, 12, 16, 9, 5]);
        assert_eq!(lengths(&counts)[..6], [1, 3, 3, 3, 4, 4]);
        let two = std::array::from_fn(|i| u32::from(i == 7 || i == 256));
        assert!(codes(&two)[7] == Code { bits: 0, length: 1 } && codes(&two)[256] == Code { bits: 1, length: 1 });
    }
}
