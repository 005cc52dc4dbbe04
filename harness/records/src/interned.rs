//! What comes again and again.

use std::collections::HashMap;
use std::convert::Infallible;
use std::hash::Hash;
use std::sync::Arc;

/// Things, each of which is made once. They come in the same order again and again: the one that is next is tried first, after the one that was last.
#[derive(Debug)]
pub(crate) struct Interned<K, T> {
    order: Vec<T>,
    places: HashMap<K, usize>,
    last: usize,
}

impl<K, T> Default for Interned<K, T> {
    fn default() -> Self {
        Self { order: Vec::new(), places: HashMap::new(), last: 0 }
    }
}

impl<K: Eq + Hash, T: Clone> Interned<K, T> {
    /// The one that `is` meant, and its place in the order in which they first came; one that is new is made of its key.
    pub(crate) fn get<E>(
        &mut self,
        is: impl Fn(&T) -> bool,
        key: impl FnOnce() -> K,
        make: impl FnOnce(&K) -> Result<T, E>,
    ) -> Result<(usize, T), E> {
        let near = [self.last, self.last + 1].into_iter().find(|guess| self.order.get(*guess).is_some_and(&is));
        self.last = match near {
            Some(place) => place,
            None => {
                let key = key();
                match self.places.get(&key) {
                    Some(place) => *place,
                    None => {
                        let new = make(&key)?;
                        self.order.push(new);
                        self.places.insert(key, self.order.len() - 1);
                        self.order.len() - 1
                    }
                }
            }
        };
        Ok((self.last, self.order[self.last].clone()))
    }
}

/// Names, each of which is kept once.
#[derive(Default)]
pub(crate) struct Names(Interned<Arc<str>, Arc<str>>);

impl Names {
    pub(crate) fn get(&mut self, name: &str) -> Arc<str> {
        let Ok((_, found)) = self.0.get(|known| **known == *name, || name.into(), |key| Ok::<_, Infallible>(key.clone()));
        found
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
