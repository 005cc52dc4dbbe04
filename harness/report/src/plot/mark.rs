//! What is drawn in a plot, each with what it says when it is pointed at.

use std::fmt::Write;

use crate::canvas::Mark;
use crate::markup::between_bars;

/// What a mark says, to what it belongs, and what it is.
#[derive(Clone, Debug, Default)]
pub(crate) struct Said {
    /// In the order of the names of its series.
    pub(crate) values: Vec<String>,
    /// What is chosen with it everywhere: an image.
    pub(crate) group: Option<usize>,
    /// Itself, among all that a page enlarges or shows twice.
    pub(crate) key: Option<usize>,
}

impl Said {
    /// Of values alone.
    pub(crate) fn of(values: impl IntoIterator<Item = String>) -> Self {
        Self { values: values.into_iter().collect(), ..Self::default() }
    }

    pub(super) fn attributes(&self) -> String {
        let mut text = String::new();
        if !self.values.is_empty() {
            let values: Vec<String> = self.values.iter().map(|value| between_bars(value)).collect();
            // Writing to a String cannot fail.
            let _ = write!(text, " data-t=\"{}\"", values.join("|"));
        }
        if let Some(group) = self.group {
            let _ = write!(text, " data-g=\"{group}\"");
        }
        if let Some(key) = self.key {
            let _ = write!(text, " data-k=\"{key}\"");
        }
        text
    }
}

/// What lies inside the axes of a plot; places are values of x and y.
#[derive(Clone, Debug)]
pub(super) enum Element {
    /// What follows is of a series: its colour, the name by which it is hidden, and what its values are called.
    Series {
        colour: usize,
        name: Option<String>,
        says: Vec<String>,
    },
    Symbol {
        shape: Shape,
        at: (f64, f64),
        said: Said,
    },
    Arrow {
        from: (f64, f64),
        to: (f64, f64),
        said: Said,
    },
    Cell {
        corners: [(f64, f64); 2],
        fill: Option<[u8; 3]>,
        said: Said,
    },
    Line {
        places: Vec<(f64, f64)>,
        said: Said,
    },
    Dashed(Vec<(f64, f64)>),
    Contour(Vec<[(f64, f64); 2]>),
    Dots(Vec<(f64, f64)>),
    Ring((f64, f64)),
    Whisker {
        x: f64,
        ends: [f64; 2],
        said: Said,
    },
    Note {
        at: (f64, f64),
        text: String,
        is_on_shade: bool,
    },
    Tag {
        at: (f64, f64),
        text: String,
    },
}

/// A line of a legend.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    /// The number of its colour.
    pub(super) colour: usize,
    /// Its symbol.
    pub(super) shape: Shape,
    /// What it stands for.
    pub(super) name: String,
    /// Whether that is the name of a series that is hidden by it.
    pub(super) is_series: bool,
}

/// A scale of shades beside a plot.
#[derive(Clone, Debug)]
pub(super) struct Shades {
    /// Its title.
    pub(super) title: String,
    /// What stands at which part of it, 0 to 1 from below.
    pub(super) levels: Vec<(f64, String)>,
}

/// The shape of a symbol; no two series of a plot share it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Circle,
    Cross,
    Triangle,
    Diamond,
    Square,
    Plus,
}

impl Shape {
    /// In the order of use.
    pub(crate) const ALL: [Self; 6] = [Self::Circle, Self::Cross, Self::Triangle, Self::Diamond, Self::Square, Self::Plus];

    /// As pictures draw it.
    pub(super) const fn mark(self) -> Mark {
        match self {
            Self::Circle => Mark::Circle,
            Self::Cross => Mark::Cross,
            Self::Triangle => Mark::Triangle,
            Self::Diamond => Mark::Diamond,
            Self::Square => Mark::Square,
            Self::Plus => Mark::Upright,
        }
    }

    /// Its outline about the origin, px of the drawing.
    pub(super) const fn path(self) -> &'static str {
        match self {
            Self::Circle => "M-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0 -7 0",
            Self::Cross => "M-3.5 -3.5L3.5 3.5M-3.5 3.5L3.5 -3.5",
            Self::Triangle => "M0 -4L4 3.5H-4Z",
            Self::Diamond => "M0 -4.5L4.5 0L0 4.5L-4.5 0Z",
            Self::Square => "M-3.5 -3.5H3.5V3.5H-3.5Z",
            Self::Plus => "M-4 0H4M0 -4V4",
        }
    }
}

/// A number in a drawing: a hundredth of a pixel is more than anybody sees.
pub(super) fn px(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.to_owned() }
}
