//! Pages as PDF, in mm through the page's own transformation. Arcs become Bézier curves within 1e-4 mm.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

use calibench_model::testfield::{Area, Curve};
use pdf_writer::{Finish, Name, Pdf, Rect, Ref, TextStr};

use super::layout::Sheet;
use super::{PrintError, number};

/// Points of 1/72 inch in a millimetre.
const POINTS: f64 = 72.0 / 25.4;
/// The longest side of a page, mm: 14400 points.
const LONGEST: f64 = 5080.0;
/// The most that a Bézier curve may be off its arc, mm.
const OFF: f64 = 5e-5;

/// A PDF document of these pages. The same pages give the same bytes.
///
/// # Errors
/// [`PrintError::TooLarge`].
pub fn pdf(sheets: &[Sheet<'_>]) -> Result<Vec<u8>, PrintError> {
    let mut pdf = Pdf::new();
    let (catalog, tree, font, info) = (Ref::new(1), Ref::new(2), Ref::new(3), Ref::new(4));
    let page_ref = |index: usize| Ref::new(5 + 2 * index as i32);
    pdf.catalog(catalog).pages(tree);
    pdf.pages(tree).kids((0..sheets.len()).map(page_ref)).count(sheets.len() as i32);
    pdf.type1_font(font).base_font(Name(b"Helvetica")).encoding_predefined(Name(b"WinAnsiEncoding"));
    pdf.document_info(info).producer(TextStr("calibench"));
    for (index, sheet) in sheets.iter().enumerate() {
        let [width, height] = sheet.size;
        if width.max(height) > LONGEST {
            return Err(PrintError::TooLarge { plate: sheet.plate.id.clone(), width, height });
        }
        let (page_id, content) = (page_ref(index), Ref::new(6 + 2 * index as i32));
        let mut page = pdf.page(page_id);
        page.parent(tree).media_box(Rect::new(0.0, 0.0, (width * POINTS) as f32, (height * POINTS) as f32)).contents(content);
        page.resources().fonts().pair(Name(b"F"), font);
        page.finish();
        pdf.stream(content, drawing(sheet).as_bytes());
    }
    Ok(pdf.finish())
}

/// The page's content, written by hand: single precision, as libraries write it, is too coarse for a metre.
fn drawing(sheet: &Sheet<'_>) -> String {
    let mut text = format!("{POINTS:.12} 0 0 {POINTS:.12} 0 0 cm\n");
    let [low, high] = sheet.window;
    let window = format!("{} {} {} {} re", number(low[0]), number(low[1]), number(high[0] - low[0]), number(high[1] - low[1]));
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{} g {window} f", number(sheet.ground()));
    let _ = writeln!(text, "q {window} W n");
    for (area, grey) in sheet.areas() {
        let _ = writeln!(text, "{} g {} f", number(grey.clamp(0.0, 1.0)), path(sheet, area));
    }
    text.push_str("Q\n0 g 0.1 w\n");
    for [from, to] in sheet.marks() {
        let _ = writeln!(text, "{} m {} l S", pair(from), pair(to));
    }
    let [x, y] = sheet.bar();
    let _ = writeln!(text, "{} 100 1.5 re f", pair([x, y]));
    let _ = writeln!(text, "BT /F 3 Tf {} Td <{}> Tj ET", pair([x + 102.0, y]), hex("100 mm"));
    let _ = writeln!(text, "BT /F 3 Tf {} Td <{}> Tj ET", pair([x, y + 3.0]), hex(&sheet.label));
    text
}

fn pair(at: [f64; 2]) -> String {
    at.map(number).join(" ")
}

fn path(sheet: &Sheet<'_>, area: &Area) -> String {
    let at = |point| pair(sheet.place(point));
    let mut path = area.outline.0.first().map_or(String::new(), |first| format!("{} m", at(first.at(0.0))));
    for curve in &area.outline.0 {
        match *curve {
            Curve::Line { to, .. } => {
                let _ = write!(path, " {} l", at(to));
            }
            Curve::Arc { centre, radius, start, sweep } => {
                let pieces = pieces(radius * sheet.scale, sweep);
                let step = sweep / pieces;
                // Source: the tangents' length that puts the curve's middle on the arc.
                let reach = 4.0 / 3.0 * (0.25 * step).tan() * radius;
                for i in 0..pieces as usize {
                    let [from, to] = [i, i + 1].map(|i| (start + i as f64 * step).sin_cos());
                    let on = |(sine, cosine): (f64, f64), along: f64| {
                        at([centre[0] + radius * cosine - along * sine, centre[1] + radius * sine + along * cosine])
                    };
                    let _ = write!(path, " {} {} {} c", on(from, reach), on(to, -reach), on(to, 0.0));
                }
            }
        }
    }
    path + " h"
}

/// Pieces of an arc: a quarter's Bézier curve is off by 2.73e-4 of the radius, and the error falls with the sixth power of the angle.
fn pieces(radius: f64, sweep: f64) -> f64 {
    let quarters = sweep.abs() / FRAC_PI_2;
    (quarters * (2.73e-4 * radius / OFF).powf(1.0 / 6.0)).max(quarters - 1e-9).ceil().max(1.0)
}

/// Latin letters as WinAnsi codes; others as question marks.
fn hex(text: &str) -> String {
    let code = |c: char| u8::try_from(u32::from(c)).ok().filter(|code| (0x20..0x7f).contains(code) || *code >= 0xa0).unwrap_or(b'?');
    text.chars().map(|c| format!("{:02x}", code(c))).collect()
}
