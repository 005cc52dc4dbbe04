//! Colours of a drawing.

use plotters_backend::BackendColor;

/// As SVG writes it, with three digits where they are enough.
pub(super) fn hex(BackendColor { rgb: (r, g, b), .. }: BackendColor) -> String {
    if [r, g, b].iter().all(|part| part % 17 == 0) {
        format!("#{:x}{:x}{:x}", r / 17, g / 17, b / 17)
    } else {
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

/// What is filled or drawn in a colour, as attributes.
pub(super) fn paint(what: &str, colour: BackendColor) -> String {
    let alpha = if colour.alpha < 1.0 { format!(" {what}-opacity=\"{:.2}\"", colour.alpha) } else { String::new() };
    format!("{what}=\"{}\"{alpha}", hex(colour))
}
