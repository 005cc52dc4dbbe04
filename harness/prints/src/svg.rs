//! Pages as SVG, in mm. Arcs stay arcs.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

use calibench_model::escape;
use calibench_model::testfield::{Area, Curve};

use super::layout::Sheet;
use super::number;

/// A page as an SVG document of its true size; a user unit is a millimetre.
///
/// The areas are the paths of the group `plate`, outer ones first.
pub fn svg(sheet: &Sheet<'_>) -> String {
    let [width, height] = sheet.size.map(number);
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = writeln!(text, r#"<?xml version="1.0" encoding="UTF-8"?>"#);
    let _ =
        writeln!(text, r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" viewBox="0 0 {width} {height}">"#);
    let _ = writeln!(text, "<title>{}</title>", escaped(&sheet.label));
    let [low, high] = sheet.window;
    let (x, y) = (number(low[0]), number(sheet.size[1] - high[1]));
    let window = format!(r#"x="{x}" y="{y}" width="{}" height="{}""#, number(high[0] - low[0]), number(high[1] - low[1]));
    let _ = writeln!(text, r#"<clipPath id="window"><rect {window}/></clipPath>"#);
    let _ = writeln!(text, r#"<rect {window} fill="{}"/>"#, colour(sheet.ground()));
    let _ = writeln!(text, r#"<g id="plate" clip-path="url(#window)">"#);
    for (area, grey) in sheet.areas() {
        let _ = writeln!(text, r#"<path fill="{}" d="{}"/>"#, colour(grey), path(sheet, area));
    }
    text.push_str("</g>\n<g stroke=\"#000\" stroke-width=\"0.1\">\n");
    for [from, to] in sheet.marks() {
        let [x1, y1] = down(sheet, from).map(number);
        let [x2, y2] = down(sheet, to).map(number);
        let _ = writeln!(text, r#"<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}"/>"#);
    }
    text.push_str("</g>\n");
    let [x, y] = down(sheet, sheet.bar());
    let _ = writeln!(text, r#"<rect id="scale" x="{}" y="{}" width="100" height="1.5"/>"#, number(x), number(y - 1.5));
    let _ = writeln!(text, r#"<text x="{}" y="{}" font-family="sans-serif" font-size="3">100 mm</text>"#, number(x + 102.0), number(y));
    let label = escaped(&sheet.label);
    let _ = writeln!(text, r#"<text x="{}" y="{}" font-family="sans-serif" font-size="3">{label}</text>"#, number(x), number(y - 3.0));
    text.push_str("</svg>\n");
    text
}

/// A position on the page with y downwards.
fn down(sheet: &Sheet<'_>, [x, y]: [f64; 2]) -> [f64; 2] {
    [x, sheet.size[1] - y]
}

fn path(sheet: &Sheet<'_>, area: &Area) -> String {
    let at = |point| down(sheet, sheet.place(point)).map(number).join(" ");
    let mut d = area.outline.0.first().map_or(String::new(), |first| format!("M{}", at(first.at(0.0))));
    for curve in &area.outline.0 {
        match curve {
            Curve::Line { to, .. } => {
                let _ = write!(d, "L{}", at(*to));
            }
            Curve::Arc { radius, sweep, .. } => {
                // Quarters at most: the end points and the radius then determine the arc well. From u towards v is anticlockwise on the page.
                let pieces = (sweep.abs() / FRAC_PI_2 - 1e-9).ceil().max(1.0);
                let (radius, sense) = (number(radius * sheet.scale), u8::from(*sweep < 0.0));
                for i in 1..=pieces as usize {
                    let _ = write!(d, "A{radius} {radius} 0 0 {sense} {}", at(curve.at(i as f64 / pieces)));
                }
            }
        }
    }
    d + "Z"
}

fn colour(grey: f64) -> String {
    let level = (grey.clamp(0.0, 1.0) * 255.0).round() as u8;
    format!("#{level:02x}{level:02x}{level:02x}")
}

fn escaped(text: &str) -> String {
    escape::markup(text, |c| c.is_control().then_some("".into()))
}
