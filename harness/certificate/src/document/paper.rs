//! Pages that are written and drawn on, in points from the upper left corner.

use std::fmt::Write;

use calibench_prints::{Font, Lettering};

/// A4, points.
pub const SIZE: [f64; 2] = [595.276, 841.89];
/// Red, green and blue of what is written, and of what is said beside it.
pub const INK: [f64; 3] = [0.0, 0.0, 0.0];
pub const GREY: [f64; 3] = [0.36, 0.36, 0.36];

/// How a text looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Points.
    pub size: f64,
    /// Noto Sans Bold in place of Noto Sans.
    pub bold: bool,
    /// Red, green, blue, 0 to 1.
    pub colour: [f64; 3],
}

impl Style {
    /// Black.
    pub const fn plain(size: f64) -> Self {
        Self { size, bold: false, colour: INK }
    }

    /// Black and bold.
    pub const fn bold(size: f64) -> Self {
        Self { size, bold: true, colour: INK }
    }

    /// What is less important.
    pub const fn grey(size: f64) -> Self {
        Self { size, bold: false, colour: GREY }
    }

    /// In another colour.
    pub const fn coloured(self, colour: [f64; 3]) -> Self {
        Self { colour, ..self }
    }
}

/// All pages.
pub struct Paper {
    pub(super) pages: Vec<String>,
    pub(super) regular: Lettering,
    pub(super) bold: Lettering,
}

impl Paper {
    /// One page, empty.
    pub fn new() -> Self {
        Self { pages: vec![String::new()], regular: Lettering::new(Font::Regular), bold: Lettering::new(Font::Bold) }
    }

    /// Goes on to another page.
    pub fn turn(&mut self) {
        self.pages.push(String::new());
    }

    fn say(&mut self, line: &str) {
        if let Some(page) = self.pages.last_mut() {
            page.push_str(line);
            page.push('\n');
        }
    }

    fn lettering(&self, style: Style) -> &Lettering {
        if style.bold { &self.bold } else { &self.regular }
    }

    /// What can be written of a text: letters that the fonts do not have, and commands, by their numbers.
    pub fn written(&self, text: &str) -> String {
        let mut out = String::with_capacity(text.len());
        for letter in text.chars() {
            match letter {
                '\n' | '\t' | '\r' => out.push(' '),
                letter if !letter.is_control() && self.regular.has(letter) && self.bold.has(letter) => out.push(letter),
                letter => out.push_str(&format!("[U+{:04X}]", u32::from(letter))),
            }
        }
        out
    }

    /// How wide a text is, points.
    pub fn width(&self, text: &str, style: Style) -> f64 {
        self.lettering(style).width(&self.written(text)) * style.size
    }

    /// Writes a text whose base line begins at a place.
    pub fn write(&mut self, [x, y]: [f64; 2], style: Style, text: &str) {
        let text = self.written(text);
        let (name, lettering) = if style.bold { ("B", &mut self.bold) } else { ("R", &mut self.regular) };
        let (letters, _) = lettering.set(&text);
        if !letters.is_empty() {
            let (colour, size) = (parts(style.colour), style.size);
            self.say(&format!("BT {colour} rg /{name} {size} Tf {x:.2} {:.2} Td <{letters}> Tj ET", SIZE[1] - y));
        }
    }

    /// Writes a text whose base line ends at a place.
    pub fn write_before(&mut self, [x, y]: [f64; 2], style: Style, text: &str) {
        let width = self.width(text, style);
        self.write([x - width, y], style, text);
    }

    /// Writes as much of a text as has room, with an ellipsis in the middle of what is longer.
    pub fn write_within(&mut self, at: [f64; 2], style: Style, text: &str, room: f64) {
        let text = self.shortened(text, style, room);
        self.write(at, style, &text);
    }

    /// The text, or its begin and end with an ellipsis between.
    pub fn shortened(&self, text: &str, style: Style, room: f64) -> String {
        let text = self.written(text);
        if self.width(&text, style) <= room {
            return text;
        }
        let letters: Vec<char> = text.chars().collect();
        let of = |kept: usize| -> String {
            let head = kept / 2;
            letters[..head].iter().chain(&['\u{2026}']).chain(&letters[letters.len() - (kept - head)..]).collect()
        };
        (0..letters.len()).rev().map(of).find(|short| self.width(short, style) <= room).unwrap_or_default()
    }

    /// The lines of a text within a width; a word that is longer is parted.
    pub fn lines(&self, text: &str, style: Style, width: f64) -> Vec<String> {
        let mut lines = vec![String::new()];
        for word in self.written(text).split_whitespace() {
            let line = lines.last_mut().map(std::mem::take).unwrap_or_default();
            let joined = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
            if self.width(&joined, style) <= width {
                if let Some(last) = lines.last_mut() {
                    *last = joined;
                }
                continue;
            }
            if line.is_empty() {
                lines.pop();
            } else if let Some(last) = lines.last_mut() {
                *last = line;
            }
            lines.extend(self.parted(word, style, width));
        }
        lines
    }

    /// A word in pieces that have room.
    fn parted(&self, word: &str, style: Style, width: f64) -> Vec<String> {
        let mut pieces = vec![String::new()];
        for letter in word.chars() {
            let last = pieces.last_mut().map(std::mem::take).unwrap_or_default();
            let longer = format!("{last}{letter}");
            let fits = last.is_empty() || self.width(&longer, style) <= width;
            if let Some(place) = pieces.last_mut() {
                *place = if fits { longer } else { last };
            }
            if !fits {
                pieces.push(letter.to_string());
            }
        }
        pieces
    }

    /// Draws a line.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], (weight, colour): (f64, [f64; 3])) {
        let (y0, y1) = (SIZE[1] - from[1], SIZE[1] - to[1]);
        self.say(&format!("{} RG {weight} w {:.2} {y0:.2} m {:.2} {y1:.2} l S", parts(colour), from[0], to[0]));
    }

    /// Fills a rectangle; `at` is its upper left corner.
    pub fn fill(&mut self, at: [f64; 2], size: [f64; 2], colour: [f64; 3]) {
        let y = SIZE[1] - at[1] - size[1];
        self.say(&format!("{} rg {:.2} {y:.2} {:.2} {:.2} re f", parts(colour), at[0], size[0], size[1]));
    }
}

fn parts(colour: [f64; 3]) -> String {
    let mut text = String::new();
    for part in colour {
        // Writing to a String cannot fail.
        let _ = write!(text, "{part:.3} ");
    }
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_broken_within_its_width_and_nothing_is_lost() {
        let paper = Paper::new();
        let style = Style::plain(8.0);
        let text = "one two three a_very_long_name_of_a_photograph_that_has_no_room_at_all.jpeg four";
        for width in [20.0, 60.0, 1000.0] {
            let lines = paper.lines(text, style, width);
            assert!(lines.iter().all(|line| paper.width(line, style) <= width), "{lines:?}");
            assert_eq!(lines.concat().replace(' ', ""), text.replace(' ', ""), "{lines:?}");
        }
        assert_eq!(paper.lines(text, style, 1000.0).len(), 1);
        assert_eq!(paper.lines("", style, 10.0), [""]);
    }

    #[test]
    fn what_is_too_long_keeps_both_ends() {
        let paper = Paper::new();
        let style = Style::plain(8.0);
        let short = paper.shortened("photographs/of/a/long/way/IMG_0001.JPG", style, 90.0);
        assert!(short.starts_with("photo") && short.ends_with("01.JPG") && short.contains('\u{2026}'), "{short}");
        assert!(paper.width(&short, style) <= 90.0);
        assert_eq!(paper.shortened("a", style, 90.0), "a");
    }

    #[test]
    fn letters_without_a_glyph_are_named() {
        let paper = Paper::new();
        assert_eq!(paper.written("a\u{4e2d}\u{1b}\nb"), "a[U+4E2D][U+001B] b");
        assert_eq!(paper.written("\u{3c3}\u{b1}\u{f6}"), "\u{3c3}\u{b1}\u{f6}");
    }
}
