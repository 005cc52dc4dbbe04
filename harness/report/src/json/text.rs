//! JSON that is safe on a terminal.

use std::io::{self, Write};

use calibench_model::escape::is_command;
use serde_json::ser::{Formatter, PrettyFormatter};

/// Indented JSON, with characters that command a terminal or turn the direction of writing as `\u` and four digits.
#[derive(Default)]
pub(super) struct Plain<'a> {
    indented: PrettyFormatter<'a>,
}

impl Formatter for Plain<'_> {
    fn write_string_fragment<W: ?Sized + Write>(&mut self, writer: &mut W, fragment: &str) -> io::Result<()> {
        let mut rest = fragment;
        while let Some((at, c)) = rest.char_indices().find(|(_, c)| is_command(*c)) {
            writer.write_all(&rest.as_bytes()[..at])?;
            // All of them are in the first plane: one unit of UTF-16 each.
            write!(writer, "\\u{:04x}", u32::from(c))?;
            rest = &rest[at + c.len_utf8()..];
        }
        writer.write_all(rest.as_bytes())
    }

    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.indented.begin_array(writer)
    }

    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.indented.end_array(writer)
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.indented.begin_array_value(writer, first)
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.indented.end_array_value(writer)
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.indented.begin_object(writer)
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.indented.end_object(writer)
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.indented.begin_object_key(writer, first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.indented.begin_object_value(writer)
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.indented.end_object_value(writer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Serialize;

    #[test]
    fn a_terminal_is_not_commanded_and_the_text_comes_back() {
        let names = ["a\u{1b}[2Jb\n\t\"c\\", "\u{9b}31m", "\u{202e}gnp.exe", "\u{feff}", "K\u{e4}mera \u{1f4f7}", "\u{7f}", ""];
        let mut out = Vec::new();
        names.serialize(&mut serde_json::Serializer::with_formatter(&mut out, Plain::default())).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(!text.chars().any(|c| is_command(c) && c != '\n'), "{text:?}");
        assert_eq!(serde_json::from_str::<Vec<String>>(&text).unwrap(), names);
        assert!(text.contains("K\u{e4}mera") && text.contains("\\u009b31m"), "{text}");
    }

    #[test]
    fn numbers_that_are_none_are_null() {
        assert_eq!(serde_json::to_string(&[f64::NAN, f64::INFINITY, 1.5]).unwrap(), "[null,null,1.5]");
    }
}
