//! Names of figures.

use std::collections::HashMap;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::{Arc, LazyLock};

use calibench_diagnostics::nearest;
use thiserror::Error;

use super::pattern::{Piece, filled, matched, pieces};
use super::{Entry, Group, Quantity};

/// What a figure is a value of: a quantity of the catalogue, and where that takes it, of what. Two are equal if they have the same text in the same group.
#[derive(Clone, Debug)]
pub struct FigureName {
    quantity: Quantity,
    text: Arc<str>,
}

/// How names of the least and the most of several networks end.
const LEAST: &str = ", least";
const MOST: &str = ", most";

impl Quantity {
    /// Its row of the catalogue.
    pub fn entry(self) -> &'static Entry {
        &Self::CATALOGUE[self as usize]
    }

    /// The figure of `parts`: what the places of its pattern stand for, in their order.
    ///
    /// # Panics
    /// In a test build, with another number of parts than the pattern has places.
    pub fn of(self, parts: &[&str]) -> FigureName {
        let pattern = self.entry().pattern;
        debug_assert_eq!(pieces(pattern).filter(|piece| !matches!(piece, Piece::Text(_))).count(), parts.len(), "{pattern}");
        FigureName { quantity: self, text: filled(pattern, parts).into() }
    }

    /// The figure itself, of a quantity whose pattern has no places.
    pub fn whole(self) -> FigureName {
        static WHOLE: LazyLock<Vec<Arc<str>>> = LazyLock::new(|| Quantity::CATALOGUE.iter().map(|entry| entry.pattern.into()).collect());
        debug_assert!(self.is_whole(), "{}", self.entry().pattern);
        FigureName { quantity: self, text: WHOLE[self as usize].clone() }
    }

    /// The least of it over several networks.
    pub fn least(self) -> FigureName {
        FigureName { quantity: self, text: format!("{}{LEAST}", self.entry().pattern).into() }
    }

    /// The most of it over several networks.
    pub fn most(self) -> FigureName {
        FigureName { quantity: self, text: format!("{}{MOST}", self.entry().pattern).into() }
    }

    /// Whether its pattern has no places.
    pub fn is_whole(self) -> bool {
        !self.entry().pattern.contains('{')
    }
}

impl From<Quantity> for FigureName {
    fn from(quantity: Quantity) -> Self {
        quantity.whole()
    }
}

impl FigureName {
    /// The figure of this name in files.
    ///
    /// # Errors
    /// A name that the catalogue does not have in this group.
    pub fn parse(group: Group, text: &str) -> Result<Self, UnknownFigure> {
        let found = |quantity: Quantity| Ok(Self { quantity, text: text.into() });
        let known = known();
        if let Some(quantity) = known.whole.get(&(group, text)) {
            return found(*quantity);
        }
        let extreme = text.strip_suffix(LEAST).or_else(|| text.strip_suffix(MOST)).and_then(|name| known.whole.get(&(group, name)));
        if let Some(quantity) = extreme.filter(|_| group == Group::Network) {
            return found(*quantity);
        }
        let mine = known.patterns.iter().filter(|(quantity, _)| quantity.entry().group == group);
        if let Some((quantity, _)) = mine.clone().find(|(_, pieces)| matched(pieces, text).is_some()) {
            return found(*quantity);
        }
        let names = Quantity::CATALOGUE.iter().filter(|entry| entry.group == group).map(|entry| entry.pattern);
        Err(UnknownFigure { group, name: text.to_owned(), nearest: nearest(text, names).map(str::to_owned) })
    }

    /// The quantity.
    pub const fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// The group.
    pub fn group(&self) -> Group {
        self.quantity.entry().group
    }

    /// As it stands in files, and on pages that list figures.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Its text, to be kept without a copy.
    pub const fn shared(&self) -> &Arc<str> {
        &self.text
    }

    /// What it is of: the texts in the places of its pattern, in their order.
    pub fn parts(&self) -> Vec<&str> {
        let pieces: Vec<Piece> = pieces(self.quantity.entry().pattern).collect();
        matched(&pieces, &self.text).unwrap_or_default()
    }
}

impl fmt::Display for FigureName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl PartialEq for FigureName {
    fn eq(&self, other: &Self) -> bool {
        let same = Arc::ptr_eq(&self.text, &other.text) || self.text == other.text;
        same && (self.quantity == other.quantity || self.group() == other.group())
    }
}

impl Eq for FigureName {}

impl Hash for FigureName {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.text.hash(state);
    }
}

impl PartialOrd for FigureName {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// By group, then by text.
impl Ord for FigureName {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.group().cmp(&other.group()).then_with(|| self.text.cmp(&other.text))
    }
}

/// A name that no figure has.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("no figure of `{}` is called `{name}`{}", group.name(), nearest.as_ref().map_or_else(String::new, |near| format!(": is `{near}` meant?")))]
pub struct UnknownFigure {
    /// In which group it was looked for.
    pub group: Group,
    /// The name.
    pub name: String,
    /// The name or pattern in the catalogue that is most like it.
    pub nearest: Option<String>,
}

struct Known {
    whole: HashMap<(Group, &'static str), Quantity>,
    /// Those with most literal text first: the more general ones are asked last.
    patterns: Vec<(Quantity, Vec<Piece>)>,
}

fn known() -> &'static Known {
    static KNOWN: LazyLock<Known> = LazyLock::new(|| {
        let (whole, with_places): (Vec<&Entry>, Vec<&Entry>) = Quantity::CATALOGUE.iter().partition(|entry| entry.quantity.is_whole());
        let mut patterns: Vec<(Quantity, Vec<Piece>)> =
            with_places.iter().map(|entry| (entry.quantity, pieces(entry.pattern).collect())).collect();
        let literal = |pieces: &[Piece]| -> usize {
            let length = |piece: &Piece| match piece {
                Piece::Text(text) => text.len(),
                Piece::OneOf(_) => 1,
                Piece::Any => 0,
            };
            pieces.iter().map(length).sum()
        };
        patterns.sort_by_key(|(_, pieces)| std::cmp::Reverse(literal(pieces)));
        Known { whole: whole.into_iter().map(|entry| ((entry.group, entry.pattern), entry.quantity)).collect(), patterns }
    });
    &KNOWN
}
