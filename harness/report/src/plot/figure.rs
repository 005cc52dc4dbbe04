//! A plot with its words.

use super::Plot;
use crate::Canvas;

/// A figure of a report.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// Its file without the ending.
    pub(crate) name: String,
    /// What it shows, in a sentence.
    pub(crate) caption: String,
    /// What its numbers are, in a line: below its picture, and after the caption in a page. May be empty.
    pub(crate) remark: String,
    /// What is drawn.
    pub(crate) plot: Plot,
}

impl Figure {
    /// The file of its picture.
    pub(crate) fn file(&self) -> String {
        format!("{}.png", self.name)
    }

    /// As a part of a page that answers.
    pub(crate) fn html(&self) -> String {
        let words = if self.remark.is_empty() { self.caption.clone() } else { format!("{} {}", self.caption, sentence(&self.remark)) };
        self.plot.figure(&words)
    }

    /// As a picture.
    pub(crate) fn picture(&self) -> Canvas {
        self.plot.picture(&self.remark)
    }
}

/// With a capital at its beginning and a stop at its end.
fn sentence(line: &str) -> String {
    let mut letters = line.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}.", letters.as_str())
}
