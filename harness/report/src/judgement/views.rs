//! RMS residuals of every photograph, by operator.

use calibench_records::judgement::{Cell, Summary};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::canvas::{Canvas, OwnMark};
use crate::field::{Area, write};
use crate::figures::Layer;
use crate::plain;

const LEFT: i32 = 70;
const TOP: i32 = 50;
const HEIGHT: i32 = 400;
const BELOW: i32 = 110;
const LINE: i32 = 26;
/// Between photographs, px of the picture, at least and in all.
const STEP: (i32, i32) = (26, 900);

/// Dots by photograph for each operator with `model`; ringed where it is named as outlying.
pub fn picture(summary: &Summary, model: &str) -> Canvas {
    let cells: Vec<&Cell> = summary.cells.iter().filter(|cell| &*cell.model == model && !cell.views.is_empty()).collect();
    let count = summary.views.len().max(1) as i32;
    let step = (STEP.1 / count).max(STEP.0);
    let width = count * step;
    let layers = Layer::methods(cells.iter().map(|cell| &*cell.method));
    let legend = (layers.len() as i32 + 1) / 2 + 1;
    let mut canvas = Canvas::new((LEFT + width + 30).max(760) as u32, (TOP + HEIGHT + BELOW + legend * LINE) as u32);
    let values: Vec<f64> = cells.iter().flat_map(|cell| cell.views.iter().map(|view| view.residual.0)).filter(|rms| *rms > 0.0).collect();
    let low = values.iter().copied().fold(f64::INFINITY, f64::min) / 1.2;
    let high = values.iter().copied().fold(0.0, f64::max) * 1.2;
    let span = (high / low).ln().max(1e-9);
    let y = |rms: f64| TOP + HEIGHT - ((rms.max(low) / low).ln() / span * f64::from(HEIGHT)).round() as i32;
    let x = |view: usize| LEFT + view as i32 * step + step / 2;
    canvas.paint(|area| axes(area, summary, (width, low, high), &y, &x));
    canvas.say_as(["photograph", "operator", "RMS residual, px", "points", "p of being like the others"]);
    let mut marks: Vec<OwnMark<'_>> = Vec::new();
    let mut rings = Vec::new();
    for (index, (cell, layer)) in cells.iter().zip(&layers).enumerate() {
        for view in &cell.views {
            let Some(place) = summary.views.iter().position(|name| *name == view.name) else { continue };
            let aside = (index as f64 - (cells.len() as f64 - 1.0) / 2.0) * f64::from(step) / (cells.len() as f64 + 2.0);
            let at = (f64::from(x(place)) + aside, f64::from(y(view.residual.0)));
            marks.push((Some(&cell.method), (layer.mark, layer.colour, at)));
            let (rms, points) = view.residual;
            let texts = [view.name.to_string(), cell.method.to_string(), plain(rms), points.to_string(), format!("{:.3}", view.p)];
            canvas.of(Some(&cell.method), |canvas| canvas.say(at, texts));
            if view.p < calibench_records::judgement::OUTLIER_ALPHA {
                rings.push((&*cell.method, (at.0.round() as i32, at.1.round() as i32)));
            }
        }
    }
    canvas.marks_of(&marks);
    for (method, ring) in rings {
        canvas.of(Some(method), |canvas| {
            canvas.paint(|area| {
                area.draw(&Circle::new(ring, 13, ShapeStyle::from(&BLACK).stroke_width(2))).ok();
            });
        });
    }
    key(&mut canvas, &layers);
    canvas
}

fn axes(area: &Area<'_>, summary: &Summary, (width, low, high): (i32, f64, f64), y: &dyn Fn(f64) -> i32, x: &dyn Fn(usize) -> i32) {
    write(area, "RMS residual (2D), px, logarithmic", (LEFT, TOP - 20), HPos::Left);
    let decades = (low.log10().floor() as i32)..=(high.log10().ceil() as i32);
    let ticks = decades.flat_map(|decade| [1.0, 1.5, 2.0, 3.0, 5.0, 7.0].map(|step| step * 10_f64.powi(decade)));
    for tick in ticks.filter(|tick| *tick > low && *tick < high) {
        area.draw(&PathElement::new([(LEFT, y(tick)), (LEFT + width, y(tick))], RGBColor(225, 225, 225))).ok();
        write(area, &plain(tick), (LEFT - 8, y(tick)), HPos::Right);
    }
    for (view, name) in summary.views.iter().enumerate() {
        let right = x(view) + (x(1) - x(0)) / 2;
        area.draw(&PathElement::new([(right, TOP), (right, TOP + HEIGHT)], RGBColor(225, 225, 225))).ok();
        let short = name.rsplit_once('.').map_or(&**name, |(stem, _)| stem);
        let style = ("sans-serif", 15).into_font().transform(FontTransform::Rotate90).color(&BLACK);
        area.draw(&Text::new(short.chars().take(14).collect::<String>(), (x(view) + 8, TOP + HEIGHT + 6), style)).ok();
    }
    area.draw(&Rectangle::new([(LEFT, TOP), (LEFT + width, TOP + HEIGHT)], BLACK)).ok();
}

fn key(canvas: &mut Canvas, layers: &[Layer]) {
    let top = TOP + HEIGHT + BELOW;
    for (index, layer) in layers.iter().enumerate() {
        let (x, y) = (LEFT + (index as i32 % 2) * 360, top + index as i32 / 2 * LINE);
        canvas.of(Some(&layer.name), |canvas| {
            canvas.marks(&[(layer.mark, layer.colour, (f64::from(x), f64::from(y)))]);
            canvas.text(&layer.name, 16, ((x + 18) as u32, y as u32));
        });
    }
    let y = top + (layers.len() as i32 + 1) / 2 * LINE;
    canvas.paint(|area| {
        area.draw(&Circle::new((LEFT, y), 10, ShapeStyle::from(&BLACK).stroke_width(2))).ok();
    });
    canvas.text("ringed: not like the other photographs", 16, ((LEFT + 18) as u32, y as u32));
}
