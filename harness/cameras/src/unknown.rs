//! A file that no format recognises: what it looks like, and which readers come nearest.

use std::collections::HashSet;

use super::json::json;
use super::number::shortened;
use super::source::Source;
use super::tree::{Entry, Value};
use super::{CameraFileError, CameraFormat};

/// Names that a message quotes at most.
const MOST_NAMED: usize = 6;
/// Bytes that are looked at for words.
const LOOKED_AT: usize = 1 << 16;
/// Share of a format's words below which it is not near.
const LEAST: f64 = 0.1;
/// Readers that are named.
const NEAREST: usize = 2;

/// How a text is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Syntax {
    Xml,
    Json,
    Other,
}

/// The error of a text that none of the formats recognises; `asked` gives each with its reason.
pub(super) fn text(source: &Source<'_>, asked: &[(&CameraFormat, String)]) -> CameraFileError {
    let (syntax, looks) = looks(source);
    let near = nearest(source.text, syntax, asked);
    let near: Vec<String> = near.iter().map(|(format, why)| format!("{} ({why})", format.name)).collect();
    let near = match near.len() {
        0 => "no reader comes near".to_owned(),
        1 => format!("the nearest reader is {}", near[0]),
        _ => format!("the nearest readers are {}", near.join(" and ")),
    };
    CameraFileError::new(format!("no camera file that is known: {looks}; {near}; `calibench list formats` lists all"))
}

/// What a file is that is no text, where its first bytes say it, and what would be read in its place.
pub(super) fn bytes(bytes: &[u8]) -> Option<CameraFileError> {
    const KNOWN: [(&[u8], &str); 11] = [
        (b"\x89PNG\r\n", "a PNG picture: `calibrate` and `judge` take photographs"),
        (b"\xff\xd8\xff", "a JPEG picture: `calibrate` and `judge` take photographs"),
        (b"II*\0", "a TIFF picture: `calibrate` and `judge` take photographs"),
        (b"MM\0*", "a TIFF picture: `calibrate` and `judge` take photographs"),
        (b"MATLAB ", "a MAT-file: write jsonencode(struct(cameraParams.Intrinsics)) into a .json"),
        (b"\x89HDF\r\n", "HDF5, as MATLAB's newer MAT-files are: write jsonencode(struct(cameraParams.Intrinsics)) into a .json"),
        (b"\x80\x03", "a Python pickle: save arrays with np.savez"),
        (b"\x80\x04", "a Python pickle: save arrays with np.savez"),
        (b"\x80\x05", "a Python pickle: save arrays with np.savez"),
        (b"PXR-USDC", "binary USD: `usdcat FILE -o FILE.usda` makes text of it"),
        (b"PK\x03\x04", "a ZIP archive that holds no .npy: unpack it"),
    ];
    let (_, what) = KNOWN.into_iter().find(|(magic, _)| bytes.starts_with(magic))?;
    Some(CameraFileError::new(format!("no camera file that is known: {what}")))
}

fn quoted<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<String> = names.map(|name| format!("`{}`", shortened(name))).collect();
    let more = names.len().saturating_sub(MOST_NAMED);
    let shown = names[..names.len() - more].join(", ");
    if more > 0 { format!("{shown} and {more} more") } else { shown }
}

fn looks(source: &Source<'_>) -> (Syntax, String) {
    if let Some(document) = &source.xml {
        return (Syntax::Xml, format!("XML of root `{}`", shortened(document.root_element().tag_name().name())));
    }
    let start = source.text.trim_start();
    if start.starts_with(['{', '[']) {
        return (Syntax::Json, like_json(source.text));
    }
    let first = source.lines().next().map_or("", |(_, line)| line);
    let names: Vec<&str> = source.lines().filter_map(|(_, line)| name(line)).collect();
    // Most lines of YAML, TOML and settings have a name.
    if names.len() * 2 > source.lines().count().min(50) {
        let mut seen = HashSet::new();
        return (Syntax::Other, format!("lines with the names {}", quoted(names.into_iter().filter(|name| seen.insert(*name)))));
    }
    (Syntax::Other, format!("text that begins with `{}`", shortened(first)))
}

fn like_json(text: &str) -> String {
    let names = |entry: &Entry| match &entry.value {
        Value::Map(entries) if !entries.is_empty() => Some(quoted(entries.iter().map(|(name, _)| name.as_str()))),
        _ => None,
    };
    match json(text) {
        Ok(root) => match (&root.value, names(&root)) {
            (_, Some(names)) => format!("JSON with the keys {names}"),
            (Value::List(items), _) => match items.first().and_then(names) {
                Some(names) => format!("a JSON list of {}, the first with the keys {names}", items.len()),
                None => format!("a JSON list of {}", items.len()),
            },
            _ => "JSON without keys".to_owned(),
        },
        Err(error) => format!("text that begins as JSON does and is none: line {}: {}", error.line.unwrap_or(1), error.problem),
    }
}

/// The name of a line `name: ...` or `name = ...`, and of a table `[name]`.
fn name(line: &str) -> Option<&str> {
    let is_name = |name: &&str| !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || "_-. ".contains(c));
    if let Some(table) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
        return Some(table).filter(is_name);
    }
    let end = line.find([':', '='])?;
    Some(line[..end].trim().trim_matches('"')).filter(is_name)
}

/// The words of a text, in small letters.
fn words(text: &str) -> HashSet<String> {
    let end = text.floor_char_boundary(LOOKED_AT);
    let parts = text[..end].split(|c: char| !(c.is_alphanumeric() || c == '_'));
    parts.filter(|word| word.chars().next().is_some_and(|c| !c.is_ascii_digit())).map(str::to_lowercase).collect()
}

/// The formats of whose words the text has the largest share, rare words counting more; those of another syntax half.
fn nearest<'a>(text: &str, syntax: Syntax, asked: &'a [(&'a CameraFormat, String)]) -> Vec<(&'a CameraFormat, &'a str)> {
    let there = words(text);
    let own = |format: &CameraFormat| format.words.split_whitespace().map(str::to_lowercase).collect::<HashSet<_>>();
    let all: Vec<HashSet<String>> = asked.iter().map(|(format, _)| own(format)).collect();
    let weight = |word: &String| 1.0 / all.iter().filter(|words| words.contains(word)).count().max(1) as f64;
    let sum = |words: Vec<&String>| words.into_iter().map(weight).sum::<f64>();
    let share = |words: &HashSet<String>| {
        let whole = sum(words.iter().collect());
        if whole > 0.0 { sum(words.intersection(&there).collect()) / whole } else { 0.0 }
    };
    let of = |format: &CameraFormat| match format.extension {
        "xml" | "xmp" => Syntax::Xml,
        "json" => Syntax::Json,
        _ => Syntax::Other,
    };
    let mut found: Vec<(f64, &CameraFormat, &str)> = Vec::new();
    for ((format, why), words) in asked.iter().zip(&all) {
        let share = share(words) * if of(format) == syntax { 1.0 } else { 0.5 };
        if share > 0.0 {
            found.push((share, *format, why.as_str()));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    if found.first().is_none_or(|(share, ..)| *share < LEAST) {
        return Vec::new();
    }
    found.into_iter().take(NEAREST).map(|(_, format, why)| (format, why)).collect()
}
