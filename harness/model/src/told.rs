//! What methods from outside leave to be known of how their results came about.
//!
//! It is kept so that what parts of a run tell adds up to what one run would have told: things that are said each once, cases by their number and the first.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

/// How many different things are told of one method.
pub const MOST: usize = 8;

/// What is told of one method.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Told {
    /// Things, each once; the first [`MOST`] in order stay, whichever came first.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    said: BTreeSet<String>,
    /// Of a file of positions how it fits the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    recalled: Option<Recalled>,
}

/// How a file of positions fits the images that were asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recalled {
    /// Its name.
    pub file: String,
    /// Images that were asked for.
    pub images: u64,
    /// Those of which it has no row, by trial and view.
    pub missing: Cases<(u64, String)>,
    /// Those that are not as they were rendered.
    pub other: Cases<(u64, String)>,
    /// Targets without a row in images of which it has one.
    pub absent: Cases<(u64, String, String)>,
    /// Whether grey values were rounded in the files of the images.
    pub rounded: bool,
}

/// Cases of one sort: how many, and the first of them, whichever thread or part came first.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cases<T> {
    count: u64,
    first: Option<T>,
}

impl<T> Default for Cases<T> {
    fn default() -> Self {
        Self { count: 0, first: None }
    }
}

impl<T: Ord + Clone> Cases<T> {
    /// Adds `count` cases, of which this is the first.
    pub fn add(&mut self, count: u64, first: &T) {
        self.count += count;
        if self.first.as_ref().is_none_or(|earlier| first < earlier) {
            self.first = Some(first.clone());
        }
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.first.is_none()
    }

    fn join(&mut self, other: &Self) {
        other.said(|count, first| self.add(count, first));
    }

    /// How many and the first, if there are any.
    fn said<S>(&self, say: impl FnOnce(u64, &T) -> S) -> Option<S> {
        self.first.as_ref().map(|first| say(self.count, first))
    }
}

impl Told {
    /// Some things.
    pub fn said(things: impl IntoIterator<Item = String>) -> Self {
        let mut told = Self::default();
        told.add(things);
        told
    }

    /// How a file of positions fits.
    pub const fn recalled(recalled: Recalled) -> Self {
        Self { said: BTreeSet::new(), recalled: Some(recalled) }
    }

    fn add(&mut self, things: impl IntoIterator<Item = String>) {
        self.said.extend(things);
        while self.said.len() > MOST {
            self.said.pop_last();
        }
    }

    /// With what the same method tells of other trials.
    pub fn join(&mut self, other: &Self) {
        self.add(other.said.iter().cloned());
        match (&mut self.recalled, &other.recalled) {
            (Some(own), Some(other)) => own.join(other),
            (own @ None, Some(other)) => *own = Some(other.clone()),
            (_, None) => {}
        }
    }

    /// All of it in words.
    pub fn notes(&self) -> Vec<String> {
        self.said.iter().cloned().chain(self.recalled.iter().flat_map(Recalled::notes)).collect()
    }
}

impl Recalled {
    /// With how it fits other images.
    pub fn join(&mut self, other: &Self) {
        self.images += other.images;
        self.rounded |= other.rounded;
        self.missing.join(&other.missing);
        self.other.join(&other.other);
        self.absent.join(&other.absent);
    }

    fn notes(&self) -> Vec<String> {
        let Self { file, images, missing, other, absent, rounded } = self;
        let missing = missing.said(|count, (trial, view)| {
            format!("`{file}` has no row of {count} of {images} images, that of view `{view}` in trial {trial} for one")
        });
        let other = other.said(|count, (trial, view)| {
            format!(
                "{count} of {images} images are not those that were rendered for `{file}`, that of view `{view}` in trial {trial} for one: render and measure again"
            )
        });
        let absent = absent.said(|count, (trial, view, target)| {
            format!("`{file}` has no row of {count} targets in images that it has, `{target}` of view `{view}` in trial {trial} for one")
        });
        let rounded = rounded.then(|| "grey values were rounded or clipped in the files of the images that were measured".to_owned());
        [missing, other, absent, rounded].into_iter().flatten().collect()
    }
}

/// What methods of these names tell, in words: each once, since settings of one program tell the same.
pub fn notes<'m>(methods: impl IntoIterator<Item = (&'m str, Told)>) -> Vec<(&'m str, String)> {
    let mut found: Vec<(&str, String)> = Vec::new();
    for (name, told) in methods {
        for note in told.notes().into_iter().map(|note| (name, note)) {
            if !found.contains(&note) {
                found.push(note);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(parts: &[Told]) -> Told {
        let mut all = Told::default();
        parts.iter().for_each(|part| all.join(part));
        all
    }

    #[test]
    fn parts_tell_together_what_one_run_tells_in_whatever_order() {
        let thing = |i: u32| format!("thing {i:02}");
        let whole = Told::said((0..20).map(thing));
        assert_eq!(whole.notes(), (0..8).map(thing).collect::<Vec<_>>());
        let parts = [Told::said((5..20).rev().map(thing)), Told::default(), Told::said((0..6).map(thing))];
        let [a, b, c] = &parts;
        assert_eq!(joined(&parts), whole);
        assert_eq!(joined(&[c.clone(), a.clone(), b.clone()]), whole);
    }

    #[test]
    fn cases_are_counted_and_the_first_is_the_first() {
        let part = |images: u64, missing: &[(u64, &str)], rounded: bool| {
            let mut recalled = Recalled { file: "mine.csv".into(), images, rounded, ..Recalled::default() };
            missing.iter().for_each(|(trial, view)| recalled.missing.add(1, &(*trial, (*view).to_owned())));
            Told::recalled(recalled)
        };
        let (first, second) = (part(3, &[], true), part(4, &[(5, "b"), (5, "a")], false));
        assert_eq!(first.notes().len(), 1);
        let both = joined(&[second.clone(), first.clone()]);
        assert_eq!(both, joined(&[first, second]));
        let expected = "`mine.csv` has no row of 2 of 7 images, that of view `a` in trial 5 for one";
        assert_eq!(both.notes(), [expected, "grey values were rounded or clipped in the files of the images that were measured"]);
    }

    #[test]
    fn settings_of_one_program_tell_a_thing_once() {
        let told = || Told::said(["slow".to_owned()]);
        let all = notes([("mine", told()), ("mine", told()), ("yours", told())]);
        assert_eq!(all, [("mine", "slow".to_owned()), ("yours", "slow".to_owned())]);
    }
}
