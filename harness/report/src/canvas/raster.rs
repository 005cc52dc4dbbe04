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
        Stroke::Dots((x, y), count, colour) => (*x..x + count).try_for_each(|x| backend.draw_pixel((x, *y), *colour)),
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
    let (width, left, zoom) = (width as usize, width.min(x) as usize, zoom as usize);
    let shown = (columns as usize * zoom).min(width - left);
    if shown == 0 {
        return;
    }
    // The rows of the picture that show each row of the image.
    let lines = pixels.chunks_exact_mut(3 * width).take(height as usize).skip(y as usize).enumerate();
    for ((row, line), levels) in lines.zip(levels.chunks_exact(columns as usize).flat_map(|levels| std::iter::repeat_n(levels, zoom))) {
        let line = &mut line[3 * left..3 * (left + shown)];
        for (place, (pixel, level)) in line.chunks_mut(3 * zoom).zip(levels).enumerate() {
            match level {
                Some(level) => pixel.fill(*level),
                None => hatch(pixel, place * zoom + row),
            }
        }
    }
}

/// A part of a row, of which `from` is the number of the first diagonal.
fn hatch(pixels: &mut [u8], from: usize) {
    for (place, pixel) in pixels.chunks_exact_mut(3).enumerate() {
        pixel.fill(if (from + place).is_multiple_of(8) { 200 } else { 255 });
    }
}
