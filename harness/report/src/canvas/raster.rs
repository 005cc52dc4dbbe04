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

#[cfg(test)]
mod tests {
    use calibench_model::Image;
    use plotters::prelude::*;

    use crate::Canvas;
    use crate::canvas::Stroke;

    /// Pixel by pixel, as a picture says what it shows.
    fn grey(canvas: &Canvas, (x, y): (u32, u32)) -> [u8; 3] {
        let at = 3 * (y * canvas.width() + x) as usize;
        super::pixels(canvas.strokes(), (canvas.width(), canvas.height()))[at..at + 3].try_into().unwrap()
    }

    /// An image of 3 x 2 px from its pixel (-1, 0) on, each 2 px wide, beyond the right and the lower side of the picture.
    #[test]
    fn an_enlarged_part_is_hatched_outside_the_image_and_cut_at_the_sides_of_the_picture() {
        let image = Image::from_fn(3, 2, |x, y| (10 * (1 + x + 3 * y)) as f32 / 255.0);
        let mut canvas = Canvas::new(9, 7);
        canvas.enlarge(&image, (-1, 0), (5, 3), 2, (3, 2));
        for (x, y) in (0..7_u32).flat_map(|y| (0..9_u32).map(move |x| (x, y))) {
            let expected = match (x.checked_sub(3), y.checked_sub(2)) {
                (Some(column), Some(row)) if (2..8).contains(&column) && row < 4 => (10 * (column / 2 + 3 * (row / 2))) as u8,
                (Some(column), Some(row)) if (column + row) % 8 == 0 => 200,
                _ => 255,
            };
            assert_eq!(grey(&canvas, (x, y)), [expected; 3], "({x}, {y})");
        }
        canvas.enlarge(&image, (0, 0), (3, 2), 4, (9, 0));
        canvas.enlarge(&image, (0, 0), (3, 2), 4, (20, 20));
    }

    /// Dots of one colour side by side are one stroke: a map of colours has as many as its colours change, not as it has pixels.
    #[test]
    fn dots_side_by_side_are_one_stroke_and_stay_where_they_are() {
        let mut canvas = Canvas::new(8, 3);
        let dots = [((1, 1), RED), ((2, 1), RED), ((3, 1), BLUE), ((4, 1), BLUE), ((6, 1), BLUE), ((7, 2), BLUE)];
        canvas.paint(|area| dots.iter().for_each(|(at, colour)| area.draw_pixel(*at, colour).unwrap()));
        let counts: Vec<i32> =
            canvas.strokes().iter().filter_map(|one| if let Stroke::Dots(_, n, _) = one { Some(*n) } else { None }).collect();
        assert_eq!(counts, [2, 2, 1, 1]);
        for at in (0..3).flat_map(|y| (0..8).map(move |x| (x, y))) {
            let expected = dots.iter().find(|(dot, _)| *dot == at).map_or(WHITE, |(_, colour)| *colour);
            assert_eq!(grey(&canvas, (at.0 as u32, at.1 as u32)), [expected.0, expected.1, expected.2], "{at:?}");
        }
    }
}
