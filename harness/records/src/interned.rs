//! Names that come again and again.

use std::collections::HashMap;
use std::sync::Arc;

/// Names, each of which is kept once. They come in the same order again and again: the one that is next is tried first, after the one that was last.
#[derive(Default)]
pub(crate) struct Names {
    order: Vec<Arc<str>>,
    places: HashMap<Arc<str>, usize>,
    last: usize,
}

impl Names {
    pub(crate) fn get(&mut self, name: &str) -> Arc<str> {
        for guess in [self.last, self.last + 1] {
            if self.order.get(guess).is_some_and(|known| **known == *name) {
                self.last = guess;
                return self.order[guess].clone();
            }
        }
        self.last = self.places.get(name).copied().unwrap_or_else(|| {
            let new: Arc<str> = name.into();
            self.order.push(new.clone());
            self.places.insert(new, self.order.len() - 1);
            self.order.len() - 1
        });
        self.order[self.last].clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_kept_once_in_whatever_order_it_comes() {
        let mut names = Names::default();
        let all: Vec<Arc<str>> = ["a", "b", "c", "a", "c", "b", "b"].into_iter().map(|name| names.get(name)).collect();
        assert_eq!(all.iter().map(|name| &**name).collect::<String>(), "abcacbb");
        for (again, first) in [(3, 0), (4, 2), (5, 1), (6, 1)] {
            assert!(Arc::ptr_eq(&all[again], &all[first]));
        }
    }
}
