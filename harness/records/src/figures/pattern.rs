//! Patterns of names: literal text, and places for what a figure is of.

use calibench_model::TargetKind;

/// The size groups of targets, as records name them.
pub const SIZES: [&str; 4] =
    ["small squares and triangles", "small crosses and discs", "large squares and triangles", "large crosses and discs"];
/// How a kind of target was decided: by itself, or jointly with the others of its size.
pub const HOW: [&str; 2] = ["single", "joint"];

/// Kinds of targets.
const KINDS: [&str; 7] = {
    let (mut names, mut i) = ([""; 7], 0);
    while i < names.len() {
        names[i] = TargetKind::ALL[i].name();
        i += 1;
    }
    names
};
/// The parameters of all camera models.
pub const PARAMETERS: [&str; 45] = [
    "c", "x0", "y0", "f", "fx", "fy", "cx", "cy", "k0", "k1", "k2", "k3", "k4", "k5", "k6", "p0", "p1", "p2", "p3", "p4", "b1", "b2", "e1",
    "e2", "e3", "e4", "e5", "e6", "e7", "e8", "e9", "e10", "e11", "e12", "s0", "s1", "s2", "s3", "s4", "ex", "ey", "skew", "alpha", "beta",
    "xi",
];

/// A piece of a pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Piece {
    /// This text.
    Text(&'static str),
    /// Any text that is not empty, as short as what follows allows.
    Any,
    /// One of these.
    OneOf(&'static [&'static str]),
}

/// The pieces of `pattern`.
pub fn pieces(pattern: &'static str) -> impl Iterator<Item = Piece> {
    let mut rest = pattern;
    std::iter::from_fn(move || {
        let at = rest.find('{').unwrap_or(rest.len());
        if at > 0 {
            let (text, after) = rest.split_at(at);
            rest = after;
            return Some(Piece::Text(text));
        }
        let (place, after) = rest.split_once('}')?;
        rest = after;
        Some(match place {
            "{size" => Piece::OneOf(&SIZES),
            "{how" => Piece::OneOf(&HOW),
            "{kind" => Piece::OneOf(&KINDS),
            "{parameter" => Piece::OneOf(&PARAMETERS),
            _ => Piece::Any,
        })
    })
}

/// What stands in the places of `pieces` in `text`; `None` if it is not of this pattern.
pub fn matched<'a>(pieces: &[Piece], text: &'a str) -> Option<Vec<&'a str>> {
    let Some((piece, rest)) = pieces.split_first() else { return text.is_empty().then(Vec::new) };
    let with = |taken: usize| {
        let (own, after) = text.split_at(taken);
        matched(rest, after).map(|mut parts| {
            parts.insert(0, own);
            parts
        })
    };
    match piece {
        Piece::Text(known) => matched(rest, text.strip_prefix(known)?),
        Piece::OneOf(known) => known.iter().filter(|one| text.starts_with(**one)).find_map(|one| with(one.len())),
        Piece::Any => text.char_indices().map(|(at, c)| at + c.len_utf8()).find_map(with),
    }
}

/// `pattern` with `parts` in its places, in their order.
pub fn filled(pattern: &'static str, parts: &[&str]) -> String {
    let mut parts = parts.iter();
    let mut text = String::new();
    for piece in pieces(pattern) {
        match piece {
            Piece::Text(known) => text.push_str(known),
            Piece::Any | Piece::OneOf(_) => text.push_str(parts.next().unwrap_or(&"?")),
        }
    }
    text
}
