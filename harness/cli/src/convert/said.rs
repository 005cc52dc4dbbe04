//! What is said of many cameras: each text once, with how many it is about.

use std::collections::HashMap;

use calibench_model::escape;

/// Cameras of which each is told apart.
const TOLD_APART: usize = 20;
/// Texts of which each is kept: one more than are said.
const KEPT: usize = TOLD_APART + 2;

/// Texts so far; no more of them are kept than will be said.
#[derive(Default)]
pub struct Said {
    /// The first ones, each with its camera.
    first: Vec<Text>,
    /// How many there were.
    count: usize,
    /// Each once, with the first camera.
    once: Vec<Text>,
    places: HashMap<String, usize>,
    /// Of other texts.
    beyond: usize,
}

struct Text {
    camera: Option<String>,
    words: String,
    count: usize,
}

impl Said {
    /// A text about a camera, or about any.
    pub fn add(&mut self, camera: Option<&str>, text: &str) {
        let new = || Text { camera: camera.map(str::to_owned), words: text.to_owned(), count: 1 };
        self.count += 1;
        if self.first.len() < TOLD_APART {
            self.first.push(new());
        }
        if let Some(&place) = self.places.get(text) {
            self.once[place].count += 1;
        } else if self.once.len() < KEPT {
            self.places.insert(text.to_owned(), self.once.len());
            self.once.push(new());
        } else {
            self.beyond += 1;
        }
    }

    /// Says them on standard error.
    pub fn say(&self) {
        self.lines().iter().for_each(|line| say!("{line}"));
    }

    fn lines(&self) -> Vec<String> {
        if self.count <= TOLD_APART && self.first.iter().any(|text| text.camera.is_some()) {
            // What is about no camera alone is told once.
            let again = |at: usize| self.first[..at].iter().any(|before| before.camera.is_none() && before.words == self.first[at].words);
            let told = self.first.iter().enumerate().filter(|(at, text)| text.camera.is_some() || !again(*at));
            return told.map(|(_, text)| text.line(1)).collect();
        }
        let more = self.once.iter().skip(TOLD_APART + 1).map(|text| text.count).sum::<usize>() + self.beyond;
        let told = if more == 1 { KEPT } else { TOLD_APART + 1 };
        let mut lines: Vec<String> = self.once.iter().take(told).map(|text| text.line(text.count)).collect();
        if more > 1 {
            lines.push(format!("... and {more} more of these"));
        }
        lines
    }
}

impl Text {
    fn line(&self, count: usize) -> String {
        let (camera, text) = (self.camera.as_ref().map(|camera| escape::name(camera)), &self.words);
        match (camera, count) {
            (None, 1) => text.clone(),
            (None, count) => format!("{text} ({count} cameras)"),
            (Some(camera), 1) => format!("{camera}: {text}"),
            (Some(camera), count) => format!("{camera}: {text} (so are {} more)", count - 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(texts: impl Iterator<Item = (Option<String>, String)>) -> Vec<String> {
        let mut said = Said::default();
        texts.for_each(|(camera, text)| said.add(camera.as_deref(), &text));
        said.lines()
    }

    #[test]
    fn few_cameras_are_told_apart_and_many_are_counted() {
        let of = |count: usize, text: fn(usize) -> String| lines((0..count).map(|i| (Some(format!("c{i}")), text(i))));
        let exact = |_| "exact".to_owned();
        assert_eq!(of(2, exact), ["c0: exact", "c1: exact"]);
        assert_eq!(of(20, exact).len(), 20);
        assert_eq!(of(600, exact), ["c0: exact (so are 599 more)"]);
        let own = |i| format!("off by {i}");
        assert_eq!(of(22, own).len(), 22, "a last one is said in place of its number");
        let many = of(600, own);
        assert_eq!((many.len(), many[20].as_str(), many[21].as_str()), (22, "c20: off by 20", "... and 579 more of these"));
    }

    #[test]
    fn what_is_about_no_camera_alone_is_told_once() {
        let lost = |count: usize| lines((0..count).map(|_| (None, "lost".to_owned())));
        assert_eq!((lost(1), lost(600)), (vec!["lost".to_owned()], vec!["lost (600 cameras)".to_owned()]));
        let fold = [(Some("a".to_owned()), "exact".to_owned()), (None, "folds".to_owned()), (None, "folds".to_owned())];
        assert_eq!(lines(fold.into_iter()), ["a: exact", "folds"]);
    }
}
