//! Numbers that may stand only once.

/// Numbers so far, with their places, 8 bytes each.
#[derive(Default)]
pub(super) struct Numbers {
    all: Vec<(u32, u32)>,
    rises: bool,
}

impl Numbers {
    /// Takes one that stands in a place, a line or a number of cameras.
    pub fn push(&mut self, id: u32, place: usize) {
        self.rises = self.all.last().is_none_or(|(last, _)| self.rises && *last < id);
        self.all.push((id, u32::try_from(place).unwrap_or(u32::MAX)));
    }

    /// The first one that stood before: it, its first place and this one.
    pub fn twice(&mut self) -> Option<(u32, usize, usize)> {
        // As tools write them, in order.
        if self.rises {
            return None;
        }
        self.all.sort_unstable();
        let same = self.all.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1);
        same.map(|same| (same[0].0, same[0].1 as usize, same[1].1 as usize)).min_by_key(|(.., again)| *again)
    }
}

/// Whether names are numbers that differ, as far as they have been seen.
pub(super) struct Names(Option<Numbers>);

impl Default for Names {
    fn default() -> Self {
        Self(Some(Numbers::default()))
    }
}

impl Names {
    /// Takes one.
    pub fn push(&mut self, name: &str) {
        match (name.parse(), &mut self.0) {
            (Ok(number), Some(numbers)) => numbers.push(number, 0),
            _ => self.0 = None,
        }
    }

    /// Whether all are numbers that differ.
    pub fn are_numbers(mut self) -> bool {
        self.0.as_mut().is_some_and(|numbers| numbers.twice().is_none())
    }
}
