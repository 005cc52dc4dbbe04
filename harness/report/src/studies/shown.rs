//! What a section is, and what it needs to know of its page.

use crate::canvas::Pictures;

/// A section below the heading of its scenario.
#[derive(Default)]
pub struct Shown {
    /// Markdown.
    pub text: String,
    /// The pictures that the text names.
    pub pictures: Pictures,
    /// What the page says first of it, in words.
    pub answer: Option<String>,
    /// Whether methods are scored point by point, so that the page says which of them leads.
    pub scored: bool,
}

impl From<(String, Pictures)> for Shown {
    fn from((text, pictures): (String, Pictures)) -> Self {
        Self { text, pictures, ..Self::default() }
    }
}

/// What a section needs to know of its page.
#[derive(Clone, Copy)]
pub struct OnPage<'a> {
    /// How the names of its pictures begin.
    pub stem: &'a str,
    /// Whether a published table of adjustments stands on the scenario, so that all of its pictures are shown.
    pub illustrated: bool,
    /// Figures that the paper prints beside a sweep of adjustments, with their words.
    pub printed: &'a [(String, f64)],
}
