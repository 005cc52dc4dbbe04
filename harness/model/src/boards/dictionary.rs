//! Dictionaries of square markers: ArUco's and AprilTag's.

use std::sync::OnceLock;

/// A dictionary's name, the file of its codes, how many of them it has, and how many wrong cells leave a marker unmistakable.
struct Entry {
    name: &'static str,
    file: &'static str,
    side: usize,
    count: usize,
    correctable: u32,
}

macro_rules! entries {
    ($($name:literal, $file:literal, $side:literal, $count:literal, $correctable:literal;)*) => {
        [$(Entry {
            name: $name,
            file: include_str!(concat!("../../data/dictionaries/", $file, ".txt")),
            side: $side,
            count: $count,
            correctable: $correctable,
        }),*]
    };
}

/// By their names in OpenCV; smaller ones are the beginnings of larger ones. The last number is half of the smallest distance between two codes in any rotation, less one.
static ENTRIES: [Entry; 22] = entries! {
    "DICT_4X4_50", "4x4", 4, 50, 1;
    "DICT_4X4_100", "4x4", 4, 100, 1;
    "DICT_4X4_250", "4x4", 4, 250, 1;
    "DICT_4X4_1000", "4x4", 4, 1000, 0;
    "DICT_5X5_50", "5x5", 5, 50, 3;
    "DICT_5X5_100", "5x5", 5, 100, 3;
    "DICT_5X5_250", "5x5", 5, 250, 2;
    "DICT_5X5_1000", "5x5", 5, 1000, 2;
    "DICT_6X6_50", "6x6", 6, 50, 6;
    "DICT_6X6_100", "6x6", 6, 100, 5;
    "DICT_6X6_250", "6x6", 6, 250, 5;
    "DICT_6X6_1000", "6x6", 6, 1000, 4;
    "DICT_7X7_50", "7x7", 7, 50, 9;
    "DICT_7X7_100", "7x7", 7, 100, 8;
    "DICT_7X7_250", "7x7", 7, 250, 8;
    "DICT_7X7_1000", "7x7", 7, 1000, 6;
    "DICT_ARUCO_ORIGINAL", "original", 5, 1024, 0;
    "DICT_ARUCO_MIP_36h12", "mip-36h12", 6, 250, 5;
    "DICT_APRILTAG_16h5", "apriltag-16h5", 4, 30, 2;
    "DICT_APRILTAG_25h9", "apriltag-25h9", 5, 35, 4;
    "DICT_APRILTAG_36h10", "apriltag-36h10", 6, 2320, 4;
    "DICT_APRILTAG_36h11", "apriltag-36h11", 6, 587, 5;
};

/// The codes of square markers of one kind.
///
/// A code holds the inner cells of a marker, row by row from its upper left, 1 is white, the first cell the highest bit.
#[derive(Debug)]
pub struct Dictionary {
    /// Its name in OpenCV, as in `DICT_4X4_50`.
    pub name: &'static str,
    /// Inner cells to a side.
    pub side: usize,
    /// How many wrong cells leave a marker unmistakable.
    pub correctable: u32,
    /// The codes, by id.
    pub codes: Vec<u64>,
    sorted: Vec<(u64, u32, u32)>,
}

/// A marker that was told from its cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identified {
    /// Its id.
    pub id: u32,
    /// By how many quarter turns, clockwise, the marker is turned from upright.
    pub turns: u32,
    /// Wrong cells.
    pub wrong: u32,
}

impl Dictionary {
    /// The names of all dictionaries.
    pub fn names() -> impl Iterator<Item = &'static str> {
        ENTRIES.iter().map(|entry| entry.name)
    }

    /// The dictionary of a name, whatever its letters' case.
    pub fn named(name: &str) -> Option<&'static Self> {
        static READ: [OnceLock<Dictionary>; ENTRIES.len()] = [const { OnceLock::new() }; ENTRIES.len()];
        let index = ENTRIES.iter().position(|entry| entry.name.eq_ignore_ascii_case(name))?;
        Some(READ[index].get_or_init(|| Self::of(&ENTRIES[index])))
    }

    fn of(entry: &Entry) -> Self {
        let words = entry.file.lines().filter(|line| !line.starts_with('#')).flat_map(str::split_whitespace);
        let codes: Vec<u64> = words.take(entry.count).map(|word| u64::from_str_radix(word, 16).expect("our own file")).collect();
        let mut sorted: Vec<(u64, u32, u32)> = Vec::with_capacity(4 * codes.len());
        for (id, code) in codes.iter().enumerate() {
            let mut turned = *code;
            for turns in 0..4 {
                sorted.push((turned, id as u32, turns));
                turned = quarter_turn(turned, entry.side);
            }
        }
        sorted.sort_unstable();
        Self { name: entry.name, side: entry.side, correctable: entry.correctable, codes, sorted }
    }

    /// Whether an inner cell of marker `id` is white; rows and columns from its upper left.
    pub fn is_white(&self, id: u32, row: usize, column: usize) -> Option<bool> {
        let code = self.codes.get(id as usize)?;
        Some(code >> (self.side * self.side - 1 - (row * self.side + column)) & 1 == 1)
    }

    /// The marker whose cells these are but for `at_most` wrong ones, in any of the four rotations; `None` where two are equally near.
    pub fn identify(&self, cells: u64, at_most: u32) -> Option<Identified> {
        let found = self.sorted.binary_search_by(|(code, ..)| code.cmp(&cells));
        if let Ok(index) = found {
            let same = |i: usize| self.sorted.get(i).is_some_and(|other| other.0 == cells);
            let (_, id, turns) = self.sorted[index];
            let twice = same(index + 1) || index > 0 && same(index - 1);
            return (!twice).then_some(Identified { id, turns, wrong: 0 });
        }
        let (mut best, mut tied) = (Identified { id: 0, turns: 0, wrong: at_most + 1 }, false);
        for &(code, id, turns) in &self.sorted {
            let wrong = (code ^ cells).count_ones();
            if wrong < best.wrong {
                (best, tied) = (Identified { id, turns, wrong }, false);
            } else if wrong == best.wrong {
                tied = true;
            }
        }
        (best.wrong <= at_most && !tied).then_some(best)
    }
}

/// The cells after a quarter turn clockwise.
fn quarter_turn(code: u64, side: usize) -> u64 {
    let bit = |row: usize, column: usize| code >> (side * side - 1 - (row * side + column)) & 1;
    let cells = (0..side).flat_map(|row| (0..side).map(move |column| (row, column)));
    cells.fold(0, |turned, (row, column)| turned << 1 | bit(side - 1 - column, row))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The smallest distance between the codes of two markers in any rotation, and of one to itself turned.
    fn least_distance(dictionary: &Dictionary) -> u32 {
        let all = &dictionary.sorted;
        let upright = all.iter().filter(|(_, _, turns)| *turns == 0);
        upright
            .flat_map(|a| all.iter().filter(move |b| (b.1, b.2) != (a.1, 0)).map(move |b| (a.0 ^ b.0).count_ones()))
            .min()
            .expect("several codes")
    }

    #[test]
    fn every_dictionary_is_read_whole_and_corrects_what_it_says() {
        for name in Dictionary::names() {
            let dictionary = Dictionary::named(name).unwrap();
            let entry = ENTRIES.iter().find(|entry| entry.name == name).unwrap();
            assert_eq!(dictionary.codes.len(), entry.count, "{name}");
            assert!(dictionary.codes.iter().all(|code| code >> (entry.side * entry.side) == 0), "{name}");
            if entry.count <= 300 {
                let least = least_distance(dictionary);
                assert!(2 * dictionary.correctable < least.max(1), "{name}: {least}");
            }
        }
        // Their names say it.
        for (name, least) in [("DICT_APRILTAG_16h5", 5), ("DICT_APRILTAG_25h9", 9), ("DICT_ARUCO_MIP_36h12", 12)] {
            assert_eq!(least_distance(Dictionary::named(name).unwrap()), least, "{name}");
        }
        assert!(Dictionary::named("DICT_8X8_50").is_none());
        assert!(std::ptr::eq(Dictionary::named("dict_4x4_50").unwrap(), Dictionary::named("DICT_4X4_50").unwrap()));
    }

    #[test]
    fn a_marker_is_told_in_every_rotation_and_with_wrong_cells() {
        let dictionary = Dictionary::named("DICT_APRILTAG_36h11").unwrap();
        for id in [0, 1, 17, 586] {
            let mut cells = dictionary.codes[id as usize];
            for turns in 0..4 {
                assert_eq!(dictionary.identify(cells, 0), Some(Identified { id, turns, wrong: 0 }));
                let damaged = cells ^ 0b1_0000_0100_0000_0010_0001;
                assert_eq!(dictionary.identify(damaged, 5), Some(Identified { id, turns, wrong: 4 }));
                assert_eq!(dictionary.identify(damaged, 3), None);
                cells = quarter_turn(cells, 6);
            }
            assert_eq!(cells, dictionary.codes[id as usize]);
        }
    }

    #[test]
    fn cells_are_counted_from_the_upper_left() {
        // The first marker of the smallest dictionary, as OpenCV draws it: 1011, 0101, 0011, 0010.
        let dictionary = Dictionary::named("DICT_4X4_50").unwrap();
        let rows = [0b1011, 0b0101, 0b0011, 0b0010];
        for (row, cells) in rows.into_iter().enumerate() {
            for column in 0..4 {
                assert_eq!(dictionary.is_white(0, row, column), Some(cells >> (3 - column) & 1 == 1), "{row} {column}");
            }
        }
        assert_eq!(dictionary.is_white(50, 0, 0), None);
    }
}
