//! Names, each kept once.

use std::fmt;
use std::hash::BuildHasher;

use hashbrown::{DefaultHashBuilder, HashTable};

/// Different names in the order in which they came, each with its place.
#[derive(Clone, Default)]
pub struct Names {
    /// All names, one after the other.
    text: String,
    /// Where each ends.
    ends: Vec<usize>,
    places: HashTable<u32>,
    hasher: DefaultHashBuilder,
}

impl Names {
    /// The place of `name`, which is added if it is new.
    ///
    /// # Panics
    /// Beyond 2^32 names.
    pub fn place(&mut self, name: &str) -> usize {
        let hash = self.hasher.hash_one(name);
        let Self { text, ends, places, hasher } = self;
        if let Some(&place) = places.find(hash, |&place| at(text, ends, place as usize) == name) {
            return place as usize;
        }
        let place = u32::try_from(ends.len()).expect("fewer than 2^32 names");
        text.push_str(name);
        ends.push(text.len());
        places.insert_unique(hash, place, |&place| hasher.hash_one(at(text, ends, place as usize)));
        place as usize
    }

    /// The place of `name`, if it is there.
    pub fn find(&self, name: &str) -> Option<usize> {
        let same = |&place: &u32| self.get(place as usize) == name;
        self.places.find(self.hasher.hash_one(name), same).map(|&place| place as usize)
    }

    /// The name at a place.
    ///
    /// # Panics
    /// If there are not as many.
    pub fn get(&self, place: usize) -> &str {
        at(&self.text, &self.ends, place)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// None at all.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// All names, in their order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &str> {
        (0..self.len()).map(|place| self.get(place))
    }
}

fn at<'t>(text: &'t str, ends: &[usize], place: usize) -> &'t str {
    let start = place.checked_sub(1).map_or(0, |before| ends[before]);
    &text[start..ends[place]]
}

impl PartialEq for Names {
    fn eq(&self, other: &Self) -> bool {
        self.ends == other.ends && self.text == other.text
    }
}

impl fmt::Debug for Names {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl<S: AsRef<str>> FromIterator<S> for Names {
    fn from_iter<I: IntoIterator<Item = S>>(all: I) -> Self {
        let mut names = Self::default();
        all.into_iter().for_each(|name| {
            names.place(name.as_ref());
        });
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_name_has_one_place() {
        let mut names = Names::default();
        let places: Vec<usize> = ["b", "a", "", "b", "ab", "a"].iter().map(|name| names.place(name)).collect();
        assert_eq!(places, [0, 1, 2, 0, 3, 1]);
        assert_eq!(names.iter().collect::<Vec<_>>(), ["b", "a", "", "ab"]);
        assert_eq!((names.find("ab"), names.find("c"), names.len()), (Some(3), None, 4));
        let many: Names = (0..5000).map(|i| format!("t{i}")).collect();
        assert!((0..5000).all(|i| many.find(&format!("t{i}")) == Some(i) && many.get(i) == format!("t{i}")));
    }
}
