//! JSON and Python's literals, with lines; limits as for YAML.

use super::CameraFileError;
use super::number::shortened;
use super::tree::{self, Entry, Value};

/// Values at most: each takes memory.
const MOST_VALUES: usize = 1_000_000;
/// Depth of nesting at most.
const MOST_DEPTH: usize = 32;

/// The tree of a JSON text.
pub(super) fn json(text: &str) -> Result<Entry, CameraFileError> {
    json_without(text, "")
}

/// The tree of a JSON text without what is called `passed_over`, of which nothing is kept.
pub(super) fn json_without(text: &str, passed_over: &str) -> Result<Entry, CameraFileError> {
    Reader { text, at: 0, line: 1, values: 0, python: false, passed_over }.whole()
}

/// The tree of a text in Python's literals: single quotes, comments, commas at the end and bytes too.
pub(super) fn python(text: &str) -> Result<Entry, CameraFileError> {
    Reader { text, at: 0, line: 1, values: 0, python: true, passed_over: "" }.whole()
}

/// Text as it stands in JSON.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            c if c.is_control() => out.push_str(&format!("\\u{:04x}", c as u32)),
            c => out.push(c),
        }
    }
    out + "\""
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    line: usize,
    values: usize,
    python: bool,
    /// The name of what is not kept.
    passed_over: &'a str,
}

impl Reader<'_> {
    fn whole(mut self) -> Result<Entry, CameraFileError> {
        let entry = self.value(0)?;
        self.space();
        match self.peek() {
            None => Ok(entry),
            Some(_) => Err(self.wrong("expected the end of the file")),
        }
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn step(&mut self) {
        self.line += usize::from(self.peek() == Some(b'\n'));
        self.at += 1;
    }

    fn wrong(&self, expected: &str) -> CameraFileError {
        let rest = self.text.get(self.at..).unwrap_or("");
        let found = if rest.is_empty() { "the end".to_owned() } else { format!("`{}`", shortened(rest.lines().next().unwrap_or(""))) };
        CameraFileError::new(format!("{expected}, found {found}")).on_line(self.line)
    }

    /// Skips white space and, in Python, comments.
    fn space(&mut self) {
        while let Some(byte) = self.peek() {
            if byte.is_ascii_whitespace() {
                self.step();
            } else if self.python && byte == b'#' {
                while self.peek().is_some_and(|byte| byte != b'\n') {
                    self.step();
                }
            } else {
                return;
            }
        }
    }

    fn value(&mut self, depth: usize) -> Result<Entry, CameraFileError> {
        self.space();
        let line = self.line;
        self.values += 1;
        if self.values > MOST_VALUES {
            return Err(CameraFileError::new(format!("more than {MOST_VALUES} values; expected a camera")).on_line(line));
        }
        if depth > MOST_DEPTH {
            return Err(CameraFileError::new(format!("more than {MOST_DEPTH} values inside each other; expected a camera")).on_line(line));
        }
        let value = match self.peek() {
            Some(b'{') => self.map(depth)?,
            Some(b'[') => Value::List(self.list(depth, b']')?),
            Some(b'(') if self.python => Value::List(self.list(depth, b')')?),
            Some(b'"') => Value::Scalar(self.string()?),
            Some(b'\'') if self.python => Value::Scalar(self.string()?),
            _ => Value::Scalar(self.word()?),
        };
        Ok(Entry { line, value })
    }

    fn list(&mut self, depth: usize, end: u8) -> Result<Vec<Entry>, CameraFileError> {
        self.step();
        let mut items = Vec::new();
        while !self.ends(end, items.is_empty())? {
            items.push(self.value(depth + 1)?);
        }
        Ok(items)
    }

    fn map(&mut self, depth: usize) -> Result<Value, CameraFileError> {
        self.step();
        let (mut entries, mut first) = (Vec::new(), true);
        while !self.ends(b'}', first)? {
            first = false;
            let name = match self.peek() {
                Some(b'"') => self.string()?,
                Some(b'\'') if self.python => self.string()?,
                _ => return Err(self.wrong("expected a name in quotes")),
            };
            self.space();
            if self.peek() != Some(b':') {
                return Err(self.wrong("expected `:`"));
            }
            self.step();
            if !self.passed_over.is_empty() && name == self.passed_over {
                self.pass()?;
            } else {
                entries.push((name, self.value(depth + 1)?));
            }
        }
        tree::map(entries)
    }

    /// Steps over a value, whose brackets alone are looked at.
    fn pass(&mut self) -> Result<(), CameraFileError> {
        self.space();
        let mut depth = 0_usize;
        loop {
            match self.peek() {
                None => return Err(self.wrong("expected the end of a value")),
                Some(b'"') => drop(self.string()?),
                Some(b'{' | b'[') => {
                    depth += 1;
                    self.step();
                }
                Some(b'}' | b']') if depth > 0 => {
                    depth -= 1;
                    self.step();
                }
                Some(b',' | b'}' | b']') if depth == 0 => return Ok(()),
                Some(_) => self.step(),
            }
        }
    }

    /// Steps over a comma or the end of a list; true at the end.
    fn ends(&mut self, end: u8, first: bool) -> Result<bool, CameraFileError> {
        self.space();
        if self.peek() == Some(end) {
            self.step();
            return Ok(true);
        }
        if first {
            return Ok(false);
        }
        if self.peek() != Some(b',') {
            return Err(self.wrong(&format!("expected `,` or `{}`", end as char)));
        }
        self.step();
        self.space();
        if self.python && self.peek() == Some(end) {
            self.step();
            return Ok(true);
        }
        Ok(false)
    }

    fn string(&mut self) -> Result<String, CameraFileError> {
        let Some(quote) = self.peek() else { return Err(self.wrong("expected a text")) };
        let opened = self.line;
        self.step();
        let mut out = String::new();
        loop {
            let rest = self.text.get(self.at..).unwrap_or("");
            let Some(c) = rest.chars().next() else {
                return Err(CameraFileError::new("expected the end of a text in quotes, found the end of the file").on_line(opened));
            };
            if c as u32 == u32::from(quote) {
                self.step();
                return Ok(out);
            }
            if c == '\\' {
                self.step();
                out.push(self.escaped()?);
                continue;
            }
            self.line += usize::from(c == '\n');
            self.at += c.len_utf8();
            out.push(c);
        }
    }

    /// The character after a backslash.
    fn escaped(&mut self) -> Result<char, CameraFileError> {
        let rest = self.text.get(self.at..).unwrap_or("");
        let Some(c) = rest.chars().next() else { return Err(self.wrong("expected a character after `\\`")) };
        if c == 'u' {
            let code = rest.get(1..5).and_then(|digits| u32::from_str_radix(digits, 16).ok());
            let code = code.ok_or_else(|| self.wrong("expected four digits after `\\u`"))?;
            self.at += 5;
            // Halves of characters beyond the first plane do not matter in names of cameras.
            return Ok(char::from_u32(code).unwrap_or('\u{fffd}'));
        }
        self.line += usize::from(c == '\n');
        self.at += c.len_utf8();
        Ok(match c {
            'n' => '\n',
            't' => '\t',
            'r' => '\r',
            other => other,
        })
    }

    /// A number or a word such as `true`; in Python bytes as well.
    fn word(&mut self) -> Result<String, CameraFileError> {
        let start = self.at;
        while self.peek().is_some_and(|byte| byte.is_ascii_alphanumeric() || b"+-._".contains(&byte)) {
            self.step();
        }
        let word = self.text.get(start..self.at).unwrap_or("");
        if self.python && word == "b" && matches!(self.peek(), Some(b'\'' | b'"')) {
            return self.string();
        }
        let known = ["true", "false", "null", "True", "False", "None", "NaN", "Infinity", "-Infinity"].contains(&word);
        if known || word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
            return Ok(word.to_owned());
        }
        self.at = start;
        Err(self.wrong("expected a value"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_is_read_with_lines() {
        let tree = json("{\"a\": [1, -2.5e3,\n true], \"b\\u0041\\n\": {\"c\": \"x\\\"y\"}}").unwrap();
        assert_eq!(tree.required("a").unwrap().items().unwrap()[1].number(), Ok(-2500.0));
        assert_eq!(tree.required("a").unwrap().items().unwrap()[2].line, 2);
        assert_eq!(tree.required("bA\n").unwrap().text_of("c").unwrap(), "x\\\"y".replace('\\', ""));
        for (text, expected) in [
            ("{\"a\": 1,}", "expected a name in quotes, found `}`"),
            ("{'a': 1}", "expected a name in quotes"),
            ("[1\n2]", "expected `,` or `]`, found `2]`"),
            ("[1] x", "expected the end of the file, found `x`"),
            ("[x]", "expected a value, found `x]`"),
            ("\"abc", "found the end of the file"),
            ("{\"a\": 1, \"a\": 2}", "stands twice"),
            ("", "expected a value, found the end"),
        ] {
            let error = json(text).unwrap_err();
            assert!(error.problem.contains(expected), "{text}: {error}");
        }
        assert_eq!(json("[1,\n\n]").unwrap_err().line, Some(3));
    }

    #[test]
    fn what_is_passed_over_is_not_kept() {
        let tree = json_without("{\"points\": {\"1\": [1, \"}\", {}]\n},\n\"a\": {\"points\": 7, \"b\": 1}}", "points").unwrap();
        let a = tree.required("a").unwrap();
        assert!(tree.key("points").unwrap().is_none() && a.key("points").unwrap().is_none());
        assert_eq!((a.line, a.number_of("b")), (3, Ok(1.0)));
        assert!(json_without("{\"points\": [1", "points").unwrap_err().problem.contains("expected the end of a value"));
    }

    #[test]
    fn python_is_read() {
        let tree = python("# made by\n{ 'a': [1, 2,], # more\n 'b': b'{#[x',\n 'c': (3,), }\n").unwrap();
        assert_eq!(tree.required("a").unwrap().row(), Ok(vec![1.0, 2.0]));
        assert_eq!((tree.text_of("b"), tree.required("c").unwrap().row()), (Ok("{#[x"), Ok(vec![3.0])));
    }

    #[test]
    fn what_is_quoted_comes_back() {
        for text in ["", "a\"b\\c\nd\te", "\u{1}é"] {
            assert_eq!(json(&quoted(text)).unwrap().value_text(), text);
        }
    }

    impl Entry {
        fn value_text(&self) -> &str {
            match &self.value {
                Value::Scalar(text) => text,
                other => panic!("{other:?}"),
            }
        }
    }
}
