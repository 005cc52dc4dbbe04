//! The two pages.

mod board;
mod first;
mod frame;
mod second;
mod table;

use crate::answer::Answer;
use crate::budget::Budget;
use crate::document::{GREY, Paper, SIZE, Style};
use crate::record::Certificate;

/// Where text begins and ends, points.
const LEFT: f64 = 50.0;
const RIGHT: f64 = SIZE[0] - 50.0;
/// What is written below ends here.
const BOTTOM: f64 = SIZE[1] - 62.0;
/// Where digests begin: hexadecimal digits are not all of one width.
const DIGESTS: f64 = RIGHT - 262.0;
/// The colours of titles, of what is in doubt, and of its ground.
const TITLE: [f64; 3] = [0.07, 0.21, 0.33];
const DOUBT: [f64; 3] = [0.66, 0.08, 0.08];
const PALE: [f64; 3] = [0.99, 0.93, 0.92];
const RULE: [f64; 3] = [0.72, 0.75, 0.78];
/// Text, text in tables, and what is said beside them.
const TEXT: Style = Style::plain(8.6);
const SMALL: Style = Style::plain(7.0);
const NOTE: Style = Style::grey(7.0);

/// What the pages are written from.
pub struct Told<'a> {
    pub certificate: &'a Certificate,
    pub answer: &'a Answer,
    pub budget: &'a Budget,
    /// The digest of all.
    pub digest: &'a str,
    /// The list of digests.
    pub list: &'a str,
    /// Why it is in doubt.
    pub doubts: &'a [String],
}

/// The title.
pub fn title(in_doubt: bool) -> &'static str {
    if in_doubt { "Calibration certificate: in doubt" } else { "Calibration certificate" }
}

/// Both pages.
pub fn pages(told: &Told<'_>) -> Paper {
    let mut paper = Paper::new();
    first::write(&mut paper, told);
    foot(&mut paper, told, 1);
    paper.turn();
    second::write(&mut paper, told);
    foot(&mut paper, told, 2);
    paper
}

/// The certificate's number: the first digits of its digest.
fn number(digest: &str) -> String {
    digest.as_bytes().chunks(4).take(4).map(String::from_utf8_lossy).collect::<Vec<_>>().join(" ")
}

fn foot(paper: &mut Paper, told: &Told<'_>, page: usize) {
    let y = SIZE[1] - 46.0;
    paper.line([LEFT, y - 9.0], [RIGHT, y - 9.0], (0.5, RULE));
    let words = "States what a program computed of the files whose digests it holds. No accredited calibration; not signed digitally.";
    paper.write([LEFT, y], NOTE, words);
    paper.write_before([RIGHT, y], NOTE, &format!("page {page} of 2"));
    paper.write([LEFT, y + 10.0], NOTE, "SHA-256 of the record and of all digests");
    paper.write([DIGESTS, y + 10.0], NOTE, told.digest);
}

/// A section's title; returns where its text begins.
fn section(paper: &mut Paper, y: f64, number: usize, title: &str) -> f64 {
    paper.write([LEFT, y], Style::bold(9.5).coloured(TITLE), &format!("{number}   {title}"));
    paper.line([LEFT, y + 3.5], [RIGHT, y + 3.5], (0.6, TITLE));
    y + 16.0
}

/// A name and what it is, in as many lines as it takes, three at most; returns where the next begins.
fn fact(paper: &mut Paper, y: f64, name: &str, words: &str) -> f64 {
    const INDENT: f64 = 118.0;
    paper.write([LEFT, y], TEXT.coloured(GREY), name);
    bounded(paper, [LEFT + INDENT, y], (TEXT, RIGHT - LEFT - INDENT, 12.0), words, 3)
}

/// A paragraph; returns where the next begins.
fn paragraph(paper: &mut Paper, y: f64, style: Style, words: &str, most: usize) -> f64 {
    bounded(paper, [LEFT, y], (style, RIGHT - LEFT, style.size * 1.3), words, most)
}

/// Lines of a text within a width, so many at most; the last ends with an ellipsis where more is left.
fn bounded(paper: &mut Paper, [x, y]: [f64; 2], (style, width, step): (Style, f64, f64), words: &str, most: usize) -> f64 {
    let lines = paper.lines(words, style, width);
    let shown = lines.len().min(most);
    for (index, line) in lines.iter().take(shown).enumerate() {
        let is_cut = index + 1 == shown && lines.len() > most;
        let text = if is_cut { paper.shortened(&format!("{line} \u{2026}"), style, width) } else { line.clone() };
        paper.write([x, y + index as f64 * step], style, &text);
    }
    y + shown as f64 * step
}
