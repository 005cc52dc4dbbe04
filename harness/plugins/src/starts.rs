//! What a declaration says of where its program looks.

use std::collections::BTreeMap;
use std::ops::Range;

use calibench_model::boards::KINDS;
use serde::Deserialize;
use toml::Spanned;

/// How near a detection must be to a target unless the file says otherwise, px.
const RADIUS: f64 = 5.0;

/// How far a detector may say that its points lie outwards, px.
const OUTWARDS: f64 = 10.0;

/// What a plug-in is told of where to look.
#[derive(Clone, Debug, PartialEq)]
pub enum Starts {
    /// Approximate positions: it answers each of them.
    Given,
    /// Nothing: it finds what there is in the image, and of each target the nearest within this radius, px, counts.
    None {
        /// The radius, px.
        radius: f64,
    },
    /// The board: it finds it in the whole image, its points by name.
    Board(Boards),
}

/// What a plug-in that finds boards says of itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Boards {
    /// The kinds of board that it finds, as options write them; none: all.
    pub kinds: Vec<String>,
    /// Whether (0, 0) is the outer corner of the first pixel in its answers.
    pub from_corner: bool,
    /// How far its points lie away from the middle of their marker, or of the board, px, by kind; of other kinds not at all.
    pub outwards: BTreeMap<String, f64>,
}

/// How far points lie outwards, px: of all kinds of board, or of each.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "expected a number of px, or one for each kind, as in { aprilgrid = -2.7 }")]
pub enum Outwards {
    All(f64),
    Each(BTreeMap<String, f64>),
}

/// The key `starts`, and those that belong to one of its values alone.
pub struct Wire {
    pub starts: Option<Spanned<String>>,
    pub radius: Option<Spanned<f64>>,
    pub boards: Option<Spanned<Vec<String>>>,
    pub origin: Option<Spanned<String>>,
    pub outwards: Option<Spanned<Outwards>>,
}

/// What they say; mistakes are handed to `wrong`.
pub fn checked(wire: &Wire, wrong: &mut impl FnMut(Range<usize>, String)) -> Starts {
    let Wire { starts, radius, boards, origin, outwards } = wire;
    let word = starts.as_ref().map_or("given", |word| word.as_ref().as_str());
    if let Some(radius) = radius.as_ref().filter(|_| word != "none") {
        wrong(radius.span(), "`radius` is for starts = \"none\"".into());
    }
    let for_boards = [
        boards.as_ref().map(|boards| ("boards", boards.span())),
        origin.as_ref().map(|origin| ("origin", origin.span())),
        outwards.as_ref().map(|outwards| ("outwards", outwards.span())),
    ];
    for (key, span) in for_boards.into_iter().flatten().filter(|_| word != "board") {
        wrong(span, format!("`{key}` is for starts = \"board\""));
    }
    match word {
        "given" => Starts::Given,
        "none" => Starts::None { radius: near(radius.as_ref(), wrong) },
        "board" => Starts::Board(Boards {
            kinds: kinds(boards.as_ref(), wrong),
            from_corner: from_corner(origin.as_ref(), wrong),
            outwards: outwards.as_ref().map_or_else(BTreeMap::new, |outwards| far(outwards, wrong)),
        }),
        other => {
            let span = starts.as_ref().map_or(0..0, Spanned::span);
            wrong(span, format!("`{other}` is not known: expected \"given\", \"none\" or \"board\""));
            Starts::Given
        }
    }
}

fn near(radius: Option<&Spanned<f64>>, wrong: &mut impl FnMut(Range<usize>, String)) -> f64 {
    let Some(radius) = radius else { return RADIUS };
    let near = *radius.as_ref();
    if !(near > 0.0 && near <= 100.0) {
        wrong(radius.span(), format!("expected a radius from more than 0 to 100 px, found {near}"));
    }
    near
}

fn far(outwards: &Spanned<Outwards>, wrong: &mut impl FnMut(Range<usize>, String)) -> BTreeMap<String, f64> {
    let known = KINDS.map(|(name, ..)| name);
    let by_kind = match outwards.as_ref() {
        Outwards::All(far) => known.map(|kind| (kind.to_owned(), *far)).into(),
        Outwards::Each(by_kind) => by_kind.clone(),
    };
    for (kind, far) in &by_kind {
        if !known.contains(&kind.as_str()) {
            wrong(outwards.span(), no_kind(kind));
        }
        if far.is_nan() || far.abs() > OUTWARDS {
            wrong(outwards.span(), format!("expected px from -{OUTWARDS} to {OUTWARDS}, found {far}"));
            break;
        }
    }
    by_kind
}

fn no_kind(kind: &str) -> String {
    format!("`{kind}` is no kind of board: expected some of {}", KINDS.map(|(name, ..)| name).join(", "))
}

fn kinds(boards: Option<&Spanned<Vec<String>>>, wrong: &mut impl FnMut(Range<usize>, String)) -> Vec<String> {
    let Some(boards) = boards else { return Vec::new() };
    let known = KINDS.map(|(name, ..)| name);
    for kind in boards.as_ref().iter().filter(|kind| !known.contains(&kind.as_str())) {
        wrong(boards.span(), no_kind(kind));
    }
    boards.as_ref().clone()
}

fn from_corner(origin: Option<&Spanned<String>>, wrong: &mut impl FnMut(Range<usize>, String)) -> bool {
    match origin.map(|origin| (origin.as_ref().as_str(), origin.span())) {
        None | Some(("centre", _)) => false,
        Some(("corner", _)) => true,
        Some((other, span)) => {
            wrong(span, format!("`{other}` is not known: expected \"centre\" of the first pixel or its outer \"corner\""));
            false
        }
    }
}
