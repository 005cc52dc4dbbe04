//! Reports as one file: a page that is readable without JavaScript, and answers with it. It asks for nothing and is a function of what it is made of.

mod drawing;
mod embedded;
pub(crate) mod explorer;
mod from_markdown;
mod scene;

use std::fmt::Write;

use crate::markup::escaped;

pub(crate) use drawing::{Drawing, svg};
pub(crate) use embedded::{Embedded, Kind, dots, part};
pub(crate) use from_markdown::{Converted, Figures, Groups, in_place};
pub(crate) use scene::{Scene, ScenePoint, Station};

/// The part of the script that every page begins with, ours and others': elements, files that are handed out, cells of CSV.
pub const HELPERS: &str = include_str!("assets/helpers.js");

/// The script, in the order in which its parts build on each other.
const SCRIPT: [&str; 16] = [
    HELPERS,
    include_str!("assets/state.js"),
    include_str!("assets/files.js"),
    include_str!("assets/tip.js"),
    include_str!("assets/choose.js"),
    include_str!("assets/series.js"),
    include_str!("assets/table.js"),
    include_str!("assets/gestures.js"),
    include_str!("assets/ticks.js"),
    include_str!("assets/plot.js"),
    include_str!("assets/space.js"),
    include_str!("assets/draw.js"),
    include_str!("assets/scene.js"),
    include_str!("assets/verdicts.js"),
    include_str!("assets/toolbar.js"),
    include_str!("assets/start.js"),
];
/// What comes before its last part on a page with an explorer.
const EXPLORER: [&str; 3] = [include_str!("assets/interpolate.js"), include_str!("assets/frontier.js"), include_str!("assets/explorer.js")];
/// The style of all pages: its colours are variables, which a dark theme changes.
pub const STYLE: &str = include_str!("assets/page.css");

/// A browser that obeys this sends no request, whatever the page says.
pub const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

/// The verdict at the head of a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Level {
    /// All was tested, and no doubt was found.
    Good,
    /// No doubt was found, but not all was tested: that is never green.
    Open,
    /// Something is in doubt.
    Doubt,
    /// A gate failed.
    Bad,
}

impl Level {
    const fn class(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Open => "open",
            Self::Doubt => "doubt",
            Self::Bad => "bad",
        }
    }
}

/// A page under way.
pub(crate) struct Page {
    title: String,
    verdict: Option<(Level, String)>,
    reasons: Vec<String>,
    sections: Vec<Section>,
    patches: String,
}

/// A section: its anchor, its heading and what is below it, as HTML.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    pub(crate) anchor: String,
    pub(crate) heading: String,
    pub(crate) body: String,
}

impl Page {
    /// A page with a title.
    pub(crate) fn new(title: &str) -> Self {
        Self { title: title.to_owned(), verdict: None, reasons: Vec::new(), sections: Vec::new(), patches: String::new() }
    }

    /// Puts the verdict into a sentence, with its reasons below.
    pub(crate) fn verdict(&mut self, level: Level, sentence: &str, reasons: impl IntoIterator<Item = String>) {
        self.verdict = Some((level, sentence.to_owned()));
        self.reasons = reasons.into_iter().collect();
    }

    /// Adds a section of HTML.
    pub(crate) fn section(&mut self, heading: &str, body: String) {
        self.sections.push(Section { anchor: crate::markdown::anchor(heading), heading: escaped(heading), body });
    }

    /// Adds a section.
    pub(crate) fn add(&mut self, section: Section) {
        self.sections.push(section);
    }

    /// Adds the sections of a Markdown text; pictures become figures, rows of tables belong to groups.
    pub(crate) fn markdown(&mut self, text: &str, figures: &mut Figures, groups: &Groups) {
        self.sections.extend(from_markdown::sections(text, figures, groups));
    }

    /// Adds an enlarged part of an image, which is shown where the mark of that key is chosen.
    pub(crate) fn patch(&mut self, key: usize, figure: &str) {
        // Writing to a String cannot fail.
        let _ = write!(self.patches, "<figure class=\"patch\" data-k=\"{key}\">{figure}</figure>");
    }

    fn script(&self) -> String {
        let explorer = if self.sections.iter().any(|one| one.body.contains(explorer::MARK)) { EXPLORER.concat() } else { String::new() };
        let (last, rest) = SCRIPT.split_last().unwrap_or((&"", &[]));
        format!("{}{explorer}{last}", rest.concat())
    }

    /// The page.
    pub(crate) fn render(&self) -> String {
        let title = escaped(&self.title);
        let verdict = self
            .verdict
            .as_ref()
            .map_or(String::new(), |(level, sentence)| format!("<p class=\"verdict {}\">{}</p>", level.class(), escaped(sentence)));
        let reasons: String = self.reasons.iter().map(|reason| format!("<li>{}</li>", escaped(reason))).collect();
        let reasons = if reasons.is_empty() { reasons } else { format!("<ul class=\"reasons\">{reasons}</ul>") };
        let links: String = self.sections.iter().map(|one| format!("<a href=\"#{}\">{}</a>\n", one.anchor, one.heading)).collect();
        let section = |one: &Section| format!("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", one.anchor, one.heading, one.body);
        let sections: String = self.sections.iter().map(section).collect();
        let patches = if self.patches.is_empty() { String::new() } else { format!("<div class=\"patches\">{}</div>", self.patches) };
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
             <header><h1>{title}</h1>{verdict}{reasons}</header>\n<nav>\n{links}</nav>\n<main>\n{sections}</main>\n\
             <footer>Made by calibench {}.</footer>\n{patches}\n<script>(() => {{\n\"use strict\";\n{}}})();</script>\n</body>\n</html>\n",
            env!("CARGO_PKG_VERSION"),
            self.script()
        )
    }
}

#[cfg(test)]
mod tests;
