//! Markdown pieces.

pub use calibench_diagnostics::plain;
use std::fmt::Write;

/// A table; the first column is left-aligned, the others as their content asks.
pub struct MarkdownTable {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl MarkdownTable {
    /// An empty table.
    pub fn new(header: &[&str]) -> Self {
        Self { header: header.iter().map(|h| (*h).to_owned()).collect(), rows: Vec::new() }
    }

    /// Adds a row; missing cells stay empty.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// The table as Markdown, with its columns aligned so that the text reads well too.
    pub fn render(&self) -> String {
        let escaped = |cell: &str| bars(cell).replace('\n', " ");
        let cell = |row: &[String], column: usize| escaped(row.get(column).map_or("", String::as_str));
        let columns = self.header.len();
        let numeric = |column: usize| {
            let mut filled = self.rows.iter().map(|row| cell(row, column)).filter(|c| !c.is_empty()).peekable();
            column > 0 && filled.peek().is_some() && filled.all(|c| c.starts_with(|ch: char| ch.is_ascii_digit() || "-+−–<".contains(ch)))
        };
        let rows = || std::iter::once(&self.header).chain(&self.rows);
        let widths: Vec<usize> = (0..columns).map(|c| rows().map(|row| cell(row, c).chars().count()).max().unwrap_or(0).max(3)).collect();
        let mut text = String::new();
        for (index, row) in rows().enumerate() {
            for (column, &width) in widths.iter().enumerate() {
                let content = cell(row, column);
                // Writing to a String cannot fail.
                let _ = if numeric(column) { write!(text, "| {content:>width$} ") } else { write!(text, "| {content:<width$} ") };
            }
            text.push_str("|\n");
            if index == 0 {
                for (column, width) in widths.iter().enumerate() {
                    let dashes = "-".repeat(width - 1);
                    let _ = if numeric(column) { write!(text, "| {dashes}: ") } else { write!(text, "| {dashes}- ") };
                }
                text.push_str("|\n");
            }
        }
        text
    }
}

/// A cell whose bars do not end it: those that are escaped already stay.
fn bars(cell: &str) -> String {
    let mut out = String::with_capacity(cell.len());
    let mut escaped = false;
    for c in cell.chars() {
        if c == '|' && !escaped {
            out.push('\\');
        }
        escaped = c == '\\' && !escaped;
        out.push(c);
    }
    out
}

/// The anchor of a heading: lower case, blanks as hyphens, no punctuation.
pub fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).flat_map(char::to_lowercase).collect()
}

/// The list of a text's headings of level 2, with those of level 3 where there are hardly any others; nothing for fewer than three.
pub fn contents(text: &str) -> String {
    let of = |mark: &str| text.lines().filter_map(|line| line.strip_prefix(mark).map(|heading| (line, heading))).collect::<Vec<_>>();
    let mut headings = of("## ");
    if headings.len() < 3 {
        headings = text
            .lines()
            .filter_map(|line| ["## ", "### "].iter().find_map(|mark| line.strip_prefix(mark)).map(|heading| (line, heading)))
            .collect();
    }
    if headings.len() < 3 {
        return String::new();
    }
    let indent = |line: &str| if line.starts_with("### ") { "  " } else { "" };
    let lines: String = headings.iter().map(|(line, heading)| format!("{}- [{heading}](#{})\n", indent(line), anchor(heading))).collect();
    format!("**Contents**\n\n{lines}\n")
}

/// A number with `digits` decimals and a real minus sign kept as `-`; never `-0.000`.
pub fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    if text.starts_with('-') && text[1..].chars().all(|c| c == '0' || c == '.') { text[1..].to_owned() } else { text }
}

/// As [`fixed`] with a sign.
pub fn signed(value: f64, digits: usize) -> String {
    let text = fixed(value, digits);
    if text.starts_with('-') { text } else { format!("+{text}") }
}

/// The fraction of a pixel that `px` is, as in `1/18.9`.
pub fn fraction(px: f64) -> String {
    match px {
        0.0 => "exact".to_owned(),
        px if px < 1e-4 => "under 1/10000".to_owned(),
        px => format!("1/{:.1}", 1.0 / px),
    }
}

/// A value, and where it is known half of its interval.
pub fn with_half(value: f64, half: Option<f64>, digits: usize) -> String {
    half.map_or_else(|| fixed(value, digits), |half| format!("{} ± {}", fixed(value, digits), fixed(half, digits)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_aligned_and_bars_escaped() {
        let mut table = MarkdownTable::new(&["method", "px"]);
        table.row(["a|b".to_owned(), "0.1".to_owned()]);
        table.row(["c".to_owned(), "-12.5".to_owned()]);
        assert_eq!(table.render(), "| method |    px |\n| ------ | ----: |\n| a\\|b   |   0.1 |\n| c      | -12.5 |\n");
    }

    #[test]
    fn headings_have_anchors_and_a_list() {
        assert_eq!(anchor("Table 1: accuracy of `a/b:window=11`, twice"), "table-1-accuracy-of-abwindow11-twice");
        assert_eq!(contents("# t\n\n## a\n\n## b\n"), "");
        assert_eq!(contents("## a\n### x\n## b\n"), "**Contents**\n\n- [a](#a)\n  - [x](#x)\n- [b](#b)\n\n");
        assert_eq!(contents("## a\n### x\n## b\n## C d\n"), "**Contents**\n\n- [a](#a)\n- [b](#b)\n- [C d](#c-d)\n\n");
    }

    #[test]
    fn numbers_have_no_negative_zero() {
        assert_eq!((fixed(-0.0004, 3), signed(-0.0004, 3), signed(-0.5, 1)), ("0.000".into(), "+0.000".into(), "-0.5".into()));
        assert_eq!(fraction(0.0529), "1/18.9");
        assert_eq!((fraction(0.0), fraction(1.2e-7)), ("exact".to_owned(), "under 1/10000".to_owned()));
    }

    #[test]
    fn a_bar_is_escaped_unless_it_is_already() {
        for (cell, expected) in [("a|b", "a\\|b"), ("a\\|b", "a\\|b"), ("a\\\\|b", "a\\\\\\|b"), ("||", "\\|\\|"), ("a\\b", "a\\b")] {
            assert_eq!(bars(cell), expected, "{cell}");
        }
    }

    #[test]
    fn a_column_is_numeric_where_every_filled_cell_is() {
        let mut table = MarkdownTable::new(&["1", "some", "none", "mixed", "signs"]);
        for (first, some, mixed, sign) in [("1", "", "2", "<0.1"), ("2", "7", "x\ny", "\u{2212}1"), ("3", "8", "", "+2")] {
            table.row([first, some, "", mixed, sign].map(str::to_owned));
        }
        table.row(["4".to_owned()]);
        let lines: Vec<String> = table.render().lines().map(str::to_owned).collect();
        assert_eq!(lines[1], "| --- | ---: | ---- | ----- | ----: |");
        assert_eq!(lines[2], "| 1   |      |      | 2     |  <0.1 |");
        assert_eq!(lines[3], "| 2   |    7 |      | x y   |    \u{2212}1 |");
        assert_eq!(lines[5], "| 4   |      |      |       |       |");
    }

    #[test]
    fn anchors_keep_hyphens_and_underscores() {
        assert_eq!(anchor("A_b-C (d)"), "a_b-c-d");
    }

    #[test]
    fn digits_and_fractions_keep_their_limits() {
        assert_eq!(
            (fixed(-0.05, 1), fixed(-10.0, 0), fixed(-0.0, 0), fixed(0.25, 1)),
            ("-0.1".into(), "-10".into(), "0".into(), "0.2".into())
        );
        assert_eq!((signed(2.5, 1), signed(0.0, 2)), ("+2.5".into(), "+0.00".into()));
        assert_eq!((fraction(1e-4), fraction(0.000_099), fraction(2.0)), ("1/10000.0".into(), "under 1/10000".into(), "1/0.5".into()));
    }
}
