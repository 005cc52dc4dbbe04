//! Names of figures that come again and again.

use std::collections::HashMap;
use std::sync::Arc;

use super::{FigureName, Group, UnknownFigure};

/// Names of figures, each of which is looked up in the catalogue once. They come in the same order again and again: the one that is next is tried first,
/// after the one that was last.
#[derive(Debug, Default)]
pub struct FigureNames {
    order: Vec<FigureName>,
    places: HashMap<(Group, Arc<str>), usize>,
    last: usize,
}

impl FigureNames {
    /// Its place in the order in which names came, and the name.
    ///
    /// # Errors
    /// A name that the catalogue does not have in this group.
    pub fn get(&mut self, group: Group, text: &str) -> Result<(usize, FigureName), UnknownFigure> {
        for guess in [self.last, self.last + 1] {
            if self.order.get(guess).is_some_and(|known| known.text() == text && known.group() == group) {
                self.last = guess;
                return Ok((guess, self.order[guess].clone()));
            }
        }
        let key: (Group, Arc<str>) = (group, text.into());
        if let Some(place) = self.places.get(&key) {
            self.last = *place;
            return Ok((*place, self.order[*place].clone()));
        }
        let new = FigureName::parse(group, text)?;
        self.last = self.order.len();
        self.order.push(new.clone());
        self.places.insert(key, self.last);
        Ok((self.last, new))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_looked_up_once_in_whatever_order_it_comes() {
        let mut names = FigureNames::default();
        let all: Vec<usize> =
            [(Group::Iop, "c"), (Group::Iop, "x0"), (Group::Network, "sigma0"), (Group::Iop, "c"), (Group::Network, "sigma0")]
                .into_iter()
                .map(|(group, text)| names.get(group, text).unwrap().0)
                .collect();
        assert_eq!(all, [0, 1, 2, 0, 2]);
        assert!(names.get(Group::Network, "sigma").is_err());
        assert_eq!(names.get(Group::Iop, "x0").unwrap().0, 1);
    }
}
