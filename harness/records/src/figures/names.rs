//! Names of figures that come again and again.

use std::sync::Arc;

use super::{FigureName, Group, UnknownFigure};
use crate::interned::Interned;

/// Names of figures, each of which is looked up in the catalogue once.
#[derive(Debug, Default)]
pub struct FigureNames(Interned<(Group, Arc<str>), FigureName>);

impl FigureNames {
    /// Its place in the order in which names came, and the name.
    ///
    /// # Errors
    /// A name that the catalogue does not have in this group.
    pub fn get(&mut self, group: Group, text: &str) -> Result<(usize, FigureName), UnknownFigure> {
        let is = |known: &FigureName| known.text() == text && known.group() == group;
        self.0.get(is, || (group, text.into()), |(group, text)| FigureName::parse(*group, text))
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
