//! What is drawn, kept as it is drawn.

use std::convert::Infallible;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters_backend::text_anchor::{Pos, VPos};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind};

use super::series::Owner;

/// Where is drawn.
pub(crate) type Area<'a> = DrawingArea<Recorder<'a>, Shift>;

/// Colour and width of a line, px.
#[derive(Clone, Copy)]
pub(crate) struct Pen {
    pub(crate) colour: BackendColor,
    pub(crate) width: u32,
}

impl Pen {
    fn of(style: &impl BackendStyle) -> Self {
        Self { colour: style.color(), width: style.stroke_width() }
    }
}

impl BackendStyle for Pen {
    fn color(&self) -> BackendColor {
        self.colour
    }

    fn stroke_width(&self) -> u32 {
        self.width
    }
}

/// The side of an em of the pictures' font, in heights of its text: Noto Sans reaches 1069 thousandths of an em up and 293 down.
pub(crate) const EM: f64 = 1.0 / 1.362;
/// How high capitals and digits are, and how far letters reach up, em.
const CAPITALS: f64 = 0.714;
const UP: f64 = 1.069;

/// A text.
#[derive(Clone)]
pub(crate) struct Written {
    pub(crate) text: String,
    pub(crate) at: BackendCoord,
    pub(crate) size: f64,
    pub(crate) colour: BackendColor,
    pub(crate) anchor: Pos,
    pub(crate) transform: FontTransform,
    /// On a white rim.
    pub(crate) has_rim: bool,
}

impl Written {
    /// How far its baseline lies below its place, px; of a text that is turned, before it is turned.
    pub(crate) fn baseline(&self) -> f64 {
        let part = match self.anchor.v_pos {
            VPos::Top => UP,
            VPos::Center => 0.5 * CAPITALS,
            VPos::Bottom => 0.0,
        };
        part * self.size * EM
    }
}

/// Something that was drawn; places are px of the picture.
#[derive(Clone)]
pub(crate) enum Stroke {
    /// Single pixels of one colour side by side: where the first is, and how many.
    Dots(BackendCoord, i32, BackendColor),
    Line([BackendCoord; 2], Pen),
    Rectangle([BackendCoord; 2], Pen, bool),
    Path(Vec<BackendCoord>, Pen),
    Circle(BackendCoord, u32, Pen, bool),
    Polygon(Vec<BackendCoord>, BackendColor),
    Text(Written),
    /// A part of an image, each pixel `zoom` px wide; `None` is outside of the image.
    Pixels {
        at: (u32, u32),
        columns: u32,
        zoom: u32,
        levels: Vec<Option<u8>>,
    },
    /// What follows belongs to a series, or to none.
    Belongs(Option<Owner>),
    /// What a place says, in the order of the names of the picture's values.
    Said(BackendCoord, Vec<String>),
}

/// Keeps what is drawn.
pub(crate) struct Recorder<'a> {
    strokes: &'a mut Vec<Stroke>,
    size: (u32, u32),
}

impl<'a> Recorder<'a> {
    pub(super) fn new(strokes: &'a mut Vec<Stroke>, size: (u32, u32)) -> Self {
        Self { strokes, size }
    }

    fn keep(&mut self, stroke: Stroke) {
        self.strokes.push(stroke);
    }
}

fn is_same(a: BackendColor, b: BackendColor) -> bool {
    a.rgb == b.rgb && a.alpha == b.alpha
}

type Kept = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for Recorder<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Kept {
        Ok(())
    }

    fn present(&mut self) -> Kept {
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, color: BackendColor) -> Kept {
        if let Some(Stroke::Dots((x, y), count, colour)) = self.strokes.last_mut()
            && (*x + *count, *y) == point
            && is_same(*colour, color)
        {
            *count += 1;
        } else {
            self.keep(Stroke::Dots(point, 1, color));
        }
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Kept {
        self.keep(Stroke::Line([from, to], Pen::of(style)));
        Ok(())
    }

    fn draw_rect<S: BackendStyle>(&mut self, upper_left: BackendCoord, bottom_right: BackendCoord, style: &S, fill: bool) -> Kept {
        self.keep(Stroke::Rectangle([upper_left, bottom_right], Pen::of(style), fill));
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Kept {
        self.keep(Stroke::Path(path.into_iter().collect(), Pen::of(style)));
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(&mut self, center: BackendCoord, radius: u32, style: &S, fill: bool) -> Kept {
        self.keep(Stroke::Circle(center, radius, Pen::of(style), fill));
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, vert: I, style: &S) -> Kept {
        self.keep(Stroke::Polygon(vert.into_iter().collect(), style.color()));
        Ok(())
    }

    fn draw_text<T: BackendTextStyle>(&mut self, text: &str, style: &T, pos: BackendCoord) -> Kept {
        let (size, colour, anchor, transform) = (style.size(), style.color(), style.anchor(), style.transform());
        self.keep(Stroke::Text(Written { text: text.to_owned(), at: pos, size, colour, anchor, transform, has_rim: false }));
        Ok(())
    }
}
