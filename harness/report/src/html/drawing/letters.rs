//! Texts of a drawing.

use std::fmt::Write;

use plotters::style::FontTransform;
use plotters_backend::text_anchor::{HPos, VPos};

use super::colour::hex;
use crate::canvas::{EM, Written};
use crate::markup::escaped;

/// The size of a drawing's text, px, as the page's style has it.
const USUAL_SIZE: f64 = 15.0;

/// The white rim of a text.
const RIM: &str = " stroke=\"#fff\" stroke-width=\"2\"";

/// Who says how texts look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lettering {
    /// The style of the page that the drawing stands in.
    OfPage,
    /// The text itself: the drawing is a file of its own, and is opened by programs that know no style sheets.
    OfText,
}

/// Adds a text.
pub(super) fn write(out: &mut String, text: &Written, lettering: Lettering) {
    let (x, y) = text.at;
    let turn = match text.transform {
        FontTransform::None => String::new(),
        FontTransform::Rotate90 => format!(" transform=\"rotate(90 {x} {y})\""),
        FontTransform::Rotate180 => format!(" transform=\"rotate(180 {x} {y})\""),
        FontTransform::Rotate270 => format!(" transform=\"rotate(270 {x} {y})\""),
    };
    let letters = escaped(&text.text);
    // Writing to a String cannot fail.
    let _ = if lettering == Lettering::OfPage {
        let rim = if text.has_rim { format!("{RIM} paint-order=\"stroke\"") } else { String::new() };
        write!(out, "<text x=\"{x}\" y=\"{y}\"{}{turn}{rim}>{letters}</text>", style(text))
    } else {
        // Not all programs know `paint-order` (CairoSVG 2.9.1 does not, and draws the rim over the letters): the rim is a text of its own below.
        let style = attributes(text);
        let rim = if text.has_rim { format!("<text x=\"{x}\" y=\"{y}\"{style}{turn}{RIM}>{letters}</text>") } else { String::new() };
        write!(out, "{rim}<text x=\"{x}\" y=\"{y}\"{style}{turn}>{letters}</text>")
    };
}

/// All of it as attributes; the height of the place is that of the baseline, which all programs agree on.
fn attributes(text: &Written) -> String {
    let anchor = match text.anchor.h_pos {
        HPos::Left => "",
        HPos::Center => " text-anchor=\"middle\"",
        HPos::Right => " text-anchor=\"end\"",
    };
    let size = text.size * EM;
    let down = text.baseline();
    let opacity = if text.colour.alpha < 1.0 { format!(" fill-opacity=\"{:.2}\"", text.colour.alpha) } else { String::new() };
    format!(" dy=\"{down:.2}\" font-size=\"{size:.2}\" fill=\"{}\"{opacity}{anchor}", hex(text.colour))
}

/// What differs from the usual text of a drawing, which the page's style says: from the middle of its height, beginning at its place.
fn style(text: &Written) -> String {
    let anchor = match text.anchor.h_pos {
        HPos::Left => "",
        HPos::Center => " class=\"m\"",
        HPos::Right => " class=\"e\"",
    };
    // A letter of the pictures' font is as many px high as eleven twelfths of one of a browser's.
    let size = (text.size * 11.0 / 12.0).round();
    let mut parts = Vec::new();
    match text.anchor.v_pos {
        VPos::Top => parts.push("dominant-baseline:text-before-edge".to_owned()),
        VPos::Center => {}
        VPos::Bottom => parts.push("dominant-baseline:auto".to_owned()),
    }
    if size != USUAL_SIZE {
        parts.push(format!("font-size:{size}px"));
    }
    if text.colour.rgb != (0, 0, 0) {
        parts.push(format!("fill:{}", hex(text.colour)));
    }
    if text.colour.alpha < 1.0 {
        parts.push(format!("fill-opacity:{:.2}", text.colour.alpha));
    }
    if parts.is_empty() { anchor.to_owned() } else { format!(" style=\"{}\"{anchor}", parts.join(";")) }
}
