//! Names in texts: on a terminal, in Markdown, XML, HTML and CSV, where some characters are commands.

use std::borrow::Cow;
use std::fmt::Write;

/// A message for a terminal: characters that move its cursor, colour it or turn the direction of writing stand as `\u{1b}`; line ends and tabs stay.
pub fn message(text: &str) -> Cow<'_, str> {
    with_codes(text, |c| is_command(c) && c != '\n' && c != '\t')
}

/// A name within a message: as [`message`], with line ends and tabs as `\n` and `\t`.
pub fn name(text: &str) -> Cow<'_, str> {
    with_codes(text, is_command)
}

/// A text of which places are counted in bytes: as [`message`], with as many question marks as a character has bytes.
pub fn in_place(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\t' => out.push(c),
            c if is_command(c) => out.extend(std::iter::repeat_n('?', c.len_utf8())),
            c => out.push(c),
        }
    }
    out
}

/// A name within Markdown: what Markdown or HTML would take for markup is escaped, so that the name reads as it is.
pub fn markdown(text: &str) -> Cow<'_, str> {
    let text = name(text);
    if !text.contains(is_markup) {
        return text;
    }
    let mut out = String::with_capacity(text.len() + 8);
    for (place, c) in text.char_indices() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            // Within a word it marks nothing.
            '_' if within_word(&text, place) => out.push(c),
            c if is_markup(c) => out.extend(['\\', c]),
            c => out.push(c),
        }
    }
    Cow::Owned(out)
}

/// A text within XML or HTML: `&`, `<` and `>` as entities, and of every other character what `other` has in its place, if anything.
pub fn markup<'t>(text: &str, other: impl Fn(char) -> Option<Cow<'t, str>>) -> String {
    let mut out = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            c => match other(c) {
                Some(instead) => out.push_str(&instead),
                None => out.push(c),
            },
        }
    }
    out
}

/// A name as code within Markdown, between as many back quotes as it takes.
pub fn code(text: &str) -> String {
    let text = name(text);
    let longest = text.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest + 1);
    let space = if text.starts_with('`') || text.ends_with('`') || text.is_empty() { " " } else { "" };
    format!("{fence}{space}{text}{space}{fence}")
}

/// A cell of CSV that no spreadsheet takes for a formula: `'` stands before a name that begins with `=`, `+`, `-`, `@`, a tab or a line end, and before
/// one that has `'` there already. Numbers stay. [`from_cell`] undoes it.
pub fn cell(text: &str) -> Cow<'_, str> {
    if begins_formula(text.trim_start_matches('\'')) && text.parse::<f64>().is_err() {
        Cow::Owned(format!("'{text}"))
    } else {
        Cow::Borrowed(text)
    }
}

/// The name of which [`cell`] made a cell.
pub fn from_cell(cell: &str) -> &str {
    match cell.strip_prefix('\'') {
        Some(name) if begins_formula(name.trim_start_matches('\'')) => name,
        _ => cell,
    }
}

fn begins_formula(text: &str) -> bool {
    text.starts_with(['=', '+', '-', '@', '\t', '\r', '\n'])
}

/// Whether a terminal may take a character for more than itself: control characters, those that turn the direction of writing, and those that end a line
/// or have no width.
pub fn is_command(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}')
}

fn is_markup(c: char) -> bool {
    matches!(c, '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '&' | '#' | '|' | '~' | '!' | '$')
}

fn within_word(text: &str, place: usize) -> bool {
    let before = text[..place].chars().next_back();
    let after = text[place + 1..].chars().next();
    before.is_some_and(char::is_alphanumeric) && after.is_some_and(char::is_alphanumeric)
}

fn with_codes(text: &str, command: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&command) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        match c {
            '\n' if command(c) => out.push_str("\\n"),
            '\r' if command(c) => out.push_str("\\r"),
            '\t' if command(c) => out.push_str("\\t"),
            // Writing to a String cannot fail.
            c if command(c) => drop(write!(out, "\\u{{{:x}}}", u32::from(c))),
            c => out.push(c),
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_is_not_commanded() {
        assert_eq!(message("a\n\tb \u{1b}[31mred\u{7}\r"), "a\n\tb \\u{1b}[31mred\\u{7}\\r");
        assert_eq!(name("a\nb\tc\u{9b}2J\u{202e}d"), "a\\nb\\tc\\u{9b}2J\\u{202e}d");
        let hostile = "a\u{1b}b\u{9b}c\u{202e}d\n\tµ";
        assert_eq!(in_place(hostile), "a?b??c???d\n\tµ");
        assert_eq!(in_place(hostile).len(), hostile.len());
        assert!(matches!(message("Förstner 3 µm, 測定"), Cow::Borrowed(_)));
    }

    #[test]
    fn markup_is_shown_as_it_is_written() {
        let quoted = |c: char| (c == '"').then_some("&quot;".into());
        assert_eq!(markup("<a b=\"c\"> & 'd'\n", quoted), "&lt;a b=&quot;c&quot;&gt; &amp; 'd'\n");
        assert_eq!(markup("a\u{7}b", |c| c.is_control().then(String::new).map(Cow::from)), "ab");
    }

    #[test]
    fn markdown_shows_a_name_as_it_is() {
        assert_eq!(markdown("a|b <script> [x](y) *z* &c"), "a\\|b &lt;script&gt; \\[x\\](y) \\*z\\* &amp;c");
        assert_eq!(markdown("left_01_a _b_\n# no title"), "left_01_a \\_b\\_\\\\n\\# no title");
        assert_eq!(markdown("IMG_0001.JPG"), "IMG_0001.JPG");
        assert_eq!(code("a"), "`a`");
        assert_eq!(code("a``b`c"), "```a``b`c```");
        assert_eq!(code("`a"), "`` `a ``");
    }

    #[test]
    fn cells_are_no_formulas_and_are_read_again() {
        for (text, expected) in [
            ("=1+2", "'=1+2"),
            ("+a", "'+a"),
            ("-a", "'-a"),
            ("@sum", "'@sum"),
            ("\t=1", "'\t=1"),
            ("'=1", "''=1"),
            ("''@", "'''@"),
            ("-12.5", "-12.5"),
            ("+3e-7", "+3e-7"),
            ("'quoted'", "'quoted'"),
            ("a=1", "a=1"),
            ("", ""),
        ] {
            assert_eq!(cell(text), expected);
            assert_eq!(from_cell(&cell(text)), text);
        }
    }
}
