//! What was drawn, as pixels.

use plotters::prelude::*;
use plotters_backend::BackendColor;

use super::recorder::{Stroke, Written};

/// RGB, 8 bits, row by row, on white.
pub(super) fn pixels(strokes: &[Stroke], size: (u32, u32)) -> Vec<u8> {
    let mut pixels = vec![255; size.0 as usize * size.1 as usize * 3];
    for stroke in strokes {
        if let Stroke::Pixels { at, columns, zoom, levels } = stroke {
            enlarged(&mut pixels, size, *at, (*columns, *zoom), levels);
        } else {
            // Drawing into memory can only fail outside the picture, where nothing is to be seen.
            draw(&mut BitMapBackend::with_buffer(&mut pixels, size), stroke).ok();
        }
    }
    pixels
}

fn draw<B: DrawingBackend>(backend: &mut B, stroke: &Stroke) -> Result<(), plotters_backend::DrawingErrorKind<B::ErrorType>> {
    match stroke {
        Stroke::Pixel(at, colour) => backend.draw_pixel(*at, *colour),
        Stroke::Line([from, to], pen) => backend.draw_line(*from, *to, pen),
        Stroke::Rectangle([from, to], pen, fill) => backend.draw_rect(*from, *to, pen, *fill),
        Stroke::Path(path, pen) => backend.draw_path(path.iter().copied(), pen),
        Stroke::Circle(at, radius, pen, fill) => backend.draw_circle(*at, *radius, pen, *fill),
        Stroke::Polygon(corners, colour) => backend.fill_polygon(corners.iter().copied(), colour),
        Stroke::Text(text) => write(backend, text),
        Stroke::Pixels { .. } | Stroke::Belongs(_) | Stroke::Said(..) => Ok(()),
    }
}

fn write<B: DrawingBackend>(backend: &mut B, text: &Written) -> Result<(), plotters_backend::DrawingErrorKind<B::ErrorType>> {
    let font = ("sans-serif", text.size).into_font().transform(text.transform.clone());
    let style = |colour: BackendColor| TextStyle { color: colour, ..TextStyle::from(font.clone()).pos(text.anchor) };
    if text.has_rim {
        let white = style(BackendColor { alpha: 1.0, rgb: (255, 255, 255) });
        for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
            backend.draw_text(&text.text, &white, (text.at.0 + dx, text.at.1 + dy))?;
        }
    }
    backend.draw_text(&text.text, &style(text.colour), text.at)
}

/// Pixels of an image, each of some px of the picture; outside the image hatched white.
fn enlarged(pixels: &mut [u8], (width, height): (u32, u32), (x, y): (u32, u32), (columns, zoom): (u32, u32), levels: &[Option<u8>]) {
    let rows = levels.len() as u32 / columns.max(1);
    for (row, column) in (0..rows * zoom).flat_map(|row| (0..columns * zoom).map(move |column| (row, column))) {
        if x + column >= width || y + row >= height {
            continue;
        }
        let hatched = if (column + row).is_multiple_of(8) { 200 } else { 255 };
        let level = levels[(row / zoom * columns + column / zoom) as usize].unwrap_or(hatched);
        let at = ((y + row) as usize * width as usize + (x + column) as usize) * 3;
        pixels[at..at + 3].fill(level);
    }
}
