//! Curves of a figure over a swept key, in panels.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::axes::{Places, Scale};
use super::layout::{At, Dimension, Layout, title, value};
use super::metric::Estimate;
use crate::canvas::{COLOURS, Canvas, Mark};
use crate::field::{Area, write};
use crate::load::sweep::LoadedSweep;

/// The inside of a panel, px of the picture.
const PANEL: (u32, u32) = (500, 360);
const LEFT: u32 = 78;
const TOP: u32 = 50;
const RIGHT: u32 = 20;
const BOTTOM: u32 = 68;
const LINE: u32 = 26;
/// From one curve's marks to the next one's, px: bars that stand side by side are told apart.
const APART: f64 = 4.0;

const MARKS: [Mark; 5] = [Mark::Circle, Mark::Triangle, Mark::Cross, Mark::Diamond, Mark::Square];

/// After the palette, before it starts anew.
const GREY: RGBColor = RGBColor(90, 90, 90);

/// The look of a curve; colour and mark together are no other curve's among the first 35.
#[derive(Clone, Copy)]
struct Look {
    colour: RGBColor,
    mark: Mark,
    dashed: bool,
}

impl Look {
    fn of(index: usize) -> Self {
        let cycle = COLOURS.len() + 1;
        let colour = COLOURS.get(index % cycle).copied().unwrap_or(GREY);
        Self { colour, mark: MARKS[index % MARKS.len()], dashed: index / cycle % 2 == 1 }
    }
}

struct Curve {
    name: String,
    look: Look,
    points: Vec<Point>,
}

/// A place of a curve.
struct Point {
    /// From the left of the panel, px of the picture.
    at: f64,
    found: Option<Estimate>,
    /// The value along x, as its axis has it.
    x: String,
    trials: u64,
}

/// The sweep as curves with 95 % bars; `y` is logarithmic where the figures span a wide range, x where the sweep's steps are factors.
pub fn curves(loaded: &LoadedSweep, layout: &Layout) -> Canvas {
    let places = Places::of(&loaded.sweep.axes[layout.x]);
    let panels: Vec<(String, Vec<Curve>)> =
        layout.panels(loaded).into_iter().map(|(title, at)| (title, panel_curves(loaded, layout, &places, &at))).collect();
    let estimates = || panels.iter().flat_map(|(_, curves)| curves).flat_map(|curve| &curve.points).filter_map(|point| point.found);
    let scale = Scale::of(estimates().map(|found| found.value));
    let across = panels.len().min(if panels.len() > 4 { 3 } else { 2 }) as u32;
    let (width, height) = (LEFT + PANEL.0 + RIGHT, TOP + PANEL.1 + BOTTOM);
    let rows = (panels.len() as u32).div_ceil(across.max(1));
    let names: Vec<(String, Look)> =
        panels.first().map_or(Vec::new(), |(_, curves)| curves.iter().map(|c| (c.name.clone(), c.look)).collect());
    // What is told apart by a swept key is told apart in this picture alone.
    let is_method = layout.by == Dimension::Method;
    let column = names.iter().map(|(name, _)| name.chars().count() as u32 * 9 + 74).max().unwrap_or(1);
    let columns = ((across * width - LEFT) / column).max(1);
    let legend = (names.len() as u32).div_ceil(columns);
    let mut canvas = Canvas::new(across * width, rows * height + (legend + 1) * LINE);
    let facet = layout.facet.map_or_else(String::new, |facet| title(loaded, facet));
    canvas.say_as([&*facet, &title(loaded, layout.by), &axis_title(loaded, layout), layout.metric.title(), "95 % from", "to", "trials"]);
    for (index, (title, curves)) in (0_u32..).zip(&panels) {
        let origin = (index % across * width + LEFT, index / across * height + TOP);
        frame(&mut canvas, origin, &places, &scale, layout.metric.reference(), (title, &axis_title(loaded, layout), layout.metric.title()));
        let panel = layout.facet.map_or("", |_| title.rsplit(" = ").next().unwrap_or(title));
        curves.iter().for_each(|curve| canvas.of(is_method.then_some(&*curve.name), |canvas| draw(canvas, origin, &scale, curve, panel)));
    }
    let by = format!("{}{}; bars: 95 %", title(loaded, layout.by), layout.held(loaded));
    canvas.text(&by, 16, (LEFT, rows * height + LINE / 2));
    for (index, (name, look)) in (0_u32..).zip(&names) {
        let (x, y) = (LEFT + index % columns * column, rows * height + (index / columns + 1) * LINE + LINE / 2);
        canvas.of(is_method.then_some(&**name), |canvas| {
            line(canvas, &[(f64::from(x), f64::from(y)), (f64::from(x) + 44.0, f64::from(y))], *look);
            canvas.marks(&[(look.mark, look.colour, (f64::from(x) + 22.0, f64::from(y)))]);
            canvas.text(name, 16, (x + 54, y));
        });
    }
    canvas
}

fn axis_title(loaded: &LoadedSweep, layout: &Layout) -> String {
    super::units::titled(&loaded.sweep.axes[layout.x])
}

fn panel_curves(loaded: &LoadedSweep, layout: &Layout, places: &Places, at: &At) -> Vec<Curve> {
    let shown = layout.shown(loaded, layout.by);
    let middle = (shown.len() as f64 - 1.0) / 2.0;
    let curve = |(index, place): (usize, usize)| {
        let at = at.with(layout.by, place);
        let aside = (index as f64 - middle) * APART.min(24.0 / middle.max(1.0));
        let point = |(x, part): (usize, &f64)| {
            let at = at.with(Dimension::Axis(layout.x), x);
            let trials = loaded.cells.get(at.cell(loaded)).map_or(0, |cell| cell.trials);
            Point { at: part * f64::from(PANEL.0) + aside, found: layout.estimate(loaded, &at), x: places.labels[x].clone(), trials }
        };
        let mut points: Vec<_> = places.parts.iter().enumerate().map(point).collect();
        points.sort_by(|a, b| a.at.total_cmp(&b.at));
        let look = Look::of(index);
        Curve { name: value(loaded, layout.by, place), look, points }
    };
    shown.into_iter().enumerate().map(curve).collect()
}

/// Frame, grid, ticks, the reference and titles of a panel whose upper left corner is `origin`.
fn frame(
    canvas: &mut Canvas,
    (x, y): (u32, u32),
    places: &Places,
    scale: &Scale,
    reference: Option<f64>,
    (title, below, left): (&str, &str, &str),
) {
    let (left_px, top, right, bottom) = (x as i32, y as i32, (x + PANEL.0) as i32, (y + PANEL.1) as i32);
    canvas.paint(|area: &Area<'_>| {
        for (value, label) in scale.ticks() {
            let at = bottom - (scale.part(value) * f64::from(PANEL.1)).round() as i32;
            area.draw(&PathElement::new([(left_px, at), (right, at)], RGBColor(225, 225, 225))).ok();
            write(area, &label, (left_px - 8, at), HPos::Right);
        }
        for (part, label) in places.ticks(PANEL.0) {
            let at = left_px + (part * f64::from(PANEL.0)).round() as i32;
            area.draw(&PathElement::new([(at, top), (at, bottom)], RGBColor(225, 225, 225))).ok();
            write(area, label, (at, bottom + 20), HPos::Center);
        }
        if let Some(value) = reference {
            let at = bottom - (scale.part(value) * f64::from(PANEL.1)).round() as i32;
            area.draw(&PathElement::new([(left_px, at), (right, at)], BLACK)).ok();
        }
        area.draw(&Rectangle::new([(left_px, top), (right, bottom)], BLACK)).ok();
        write(area, below, ((left_px + right) / 2, bottom + 44), HPos::Center);
        write(area, left, (left_px, top - 14), HPos::Left);
        write(area, title, (right, top - 14), HPos::Right);
    });
}

fn draw(canvas: &mut Canvas, (x, y): (u32, u32), scale: &Scale, curve: &Curve, panel: &str) {
    let (left, bottom) = (f64::from(x), f64::from(y + PANEL.1));
    let high = |value: f64| bottom - scale.part(value) * f64::from(PANEL.1);
    let mut run: Vec<(f64, f64)> = Vec::new();
    let mut marks = Vec::new();
    for point in &curve.points {
        // A curve ends where nothing was measured.
        let Some(estimate) = point.found else {
            line(canvas, &run, curve.look);
            run.clear();
            continue;
        };
        let at = left + point.at;
        let before = [panel, &curve.name, &point.x];
        canvas.say_estimate((at, high(estimate.value)), &before, (estimate.value, estimate.interval), &[&point.trials.to_string()]);
        run.push((at, high(estimate.value)));
        marks.push((curve.look.mark, curve.look.colour, (at, high(estimate.value))));
        if let Some((low, top)) = estimate.interval {
            let bar = [(at.round() as i32, high(low).round() as i32), (at.round() as i32, high(top).round() as i32)];
            canvas.paint(|area: &Area<'_>| {
                area.draw(&PathElement::new(bar, curve.look.colour)).ok();
                for (x, y) in bar {
                    area.draw(&PathElement::new([(x - 3, y), (x + 3, y)], curve.look.colour)).ok();
                }
            });
        }
    }
    line(canvas, &run, curve.look);
    canvas.marks(&marks);
}

/// A line through points, whole or in dashes.
fn line(canvas: &mut Canvas, points: &[(f64, f64)], look: Look) {
    let style = ShapeStyle::from(&look.colour).stroke_width(2);
    let whole = |(x, y): (f64, f64)| (x.round() as i32, y.round() as i32);
    canvas.paint(|area: &Area<'_>| {
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            if !look.dashed {
                area.draw(&PathElement::new([whole(a), whole(b)], style)).ok();
                continue;
            }
            let count = ((b.0 - a.0).hypot(b.1 - a.1) / 12.0).ceil().max(1.0) as usize;
            let on = |part: f64| whole((a.0 + (b.0 - a.0) * part, a.1 + (b.1 - a.1) * part));
            for dash in 0..count {
                let part = |end: f64| (dash as f64 + end) / count as f64;
                area.draw(&PathElement::new([on(part(0.0)), on(part(0.6))], style)).ok();
            }
        }
    });
}
