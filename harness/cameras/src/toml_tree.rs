//! TOML as a tree with lines.

use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

use super::CameraFileError;
use super::tree::{self, Entry, Value};

/// Bytes at most: a TOML tree takes a multiple of its text.
pub(super) const LARGEST: usize = 1 << 20;

/// The tree of a text, names in its order.
///
/// # Errors
/// A text that is too large or no TOML, with its line.
pub(super) fn tree(text: &str) -> Result<Entry, CameraFileError> {
    if text.len() > LARGEST {
        return Err(CameraFileError::new(format!("is larger than {} MB; expected a camera", LARGEST >> 20)));
    }
    let table = DeTable::parse(text).map_err(|error| located(text, &error))?;
    Ok(Entry { line: 1, value: map(table.get_ref(), text)? })
}

/// `error` at its place in `text`.
pub(super) fn located(text: &str, error: &Error) -> CameraFileError {
    let problem = CameraFileError::new(error.message());
    let Some(span) = error.span() else { return problem };
    let before = &text[..text.floor_char_boundary(span.start)];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    problem.on_line(line_of(before)).in_column(before[line_start..].chars().count() + 1)
}

fn line_of(before: &str) -> usize {
    before.matches('\n').count() + 1
}

fn map(table: &DeTable<'_>, text: &str) -> Result<Value, CameraFileError> {
    let mut in_order: Vec<_> = table.iter().collect();
    in_order.sort_by_key(|(name, _)| name.span().start);
    let entries = in_order.into_iter().map(|(name, value)| Ok((name.get_ref().to_string(), entry(value, name.span().start, text)?)));
    tree::map(entries.collect::<Result<_, CameraFileError>>()?)
}

fn entry(value: &Spanned<DeValue<'_>>, start: usize, text: &str) -> Result<Entry, CameraFileError> {
    let line = line_of(text.get(..start).unwrap_or(text));
    // Between digits TOML may have underscores.
    let number = |digits: &str| Value::Scalar(digits.replace('_', ""));
    let value = match value.get_ref() {
        DeValue::String(text) => Value::Scalar(text.to_string()),
        DeValue::Integer(integer) => number(integer.as_str()),
        DeValue::Float(float) => number(float.as_str()),
        DeValue::Boolean(truth) => Value::Scalar(truth.to_string()),
        DeValue::Datetime(time) => Value::Scalar(time.to_string()),
        DeValue::Array(items) => {
            Value::List(items.iter().map(|item| entry(item, item.span().start, text)).collect::<Result<_, CameraFileError>>()?)
        }
        DeValue::Table(table) => map(table, text)?,
    };
    Ok(Entry { line, value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn toml_is_read_with_lines() {
        let found = tree("b = 1_000.5\n[a]\nlist = [1,\n  2.5]\nyes = true\n").unwrap();
        assert_eq!(found.entries().unwrap().iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["b", "a"]);
        assert_eq!(found.number_of("b"), Ok(1000.5));
        let a = found.required("a").unwrap();
        assert_eq!((a.line, a.required("list").unwrap().row(), a.text_of("yes")), (2, Ok(vec![1.0, 2.5]), Ok("true")));
        assert_eq!(a.required("list").unwrap().items().unwrap()[1].line, 4);
        let error = tree("a = 1\nb = ?\n").unwrap_err();
        assert_eq!((error.line, error.column), (Some(2), Some(5)));
        assert!(tree("a = 1\na = 2\n").is_err());
    }
}
