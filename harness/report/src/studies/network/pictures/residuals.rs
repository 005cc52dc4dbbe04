//! Residuals of the first trial by image point, and of all trials by the convergence of the image.

use calibench_records::description::{Station, Views};
use calibench_records::figures::Quantity;
use nalgebra::Vector3;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::axes::{Axes, whisker};
use crate::canvas::{COLOURS, Canvas, METHOD_MARKS, OwnMark};
use crate::field::write;
use crate::load::adjustments::Summaries;

const WIDTH: i32 = 1100;
const PANEL: i32 = 150;
const STEP: i32 = PANEL + 70;

/// A panel for each of the first three methods: residuals in x and y over the image points, image by image.
pub fn residuals(found: &Summaries) -> Option<Canvas> {
    let methods: Vec<&String> = found.methods.iter().filter(|m| found.residuals.iter().any(|(method, ..)| method == *m)).take(3).collect();
    let largest = found.residuals.iter().map(|(.., v)| v.abs()).fold(0.0, f64::max);
    if methods.is_empty() || largest <= 0.0 {
        return None;
    }
    let mut canvas = Canvas::new((WIDTH + 110) as u32, (80 + STEP * methods.len() as i32 + 10) as u32);
    canvas.text("Residuals of the first trial, image by image (upright lines)", 20, (70, 20));
    legend(&mut canvas, 46);
    for (panel, method) in (0..).zip(methods) {
        let mine: Vec<(&str, &str, f64)> = found
            .residuals
            .iter()
            .filter(|(m, ..)| m == method)
            .filter_map(|(_, name, v)| Some((name.split('/').next()?, name.rsplit('/').next()?, *v)))
            .collect();
        let count = mine.len() as f64 / 2.0;
        let axes = Axes { at: [70, 100 + STEP * panel, WIDTH, PANEL], x: [0.0, count], y: [-largest * 1.05, largest * 1.05] };
        canvas.paint(|area| {
            axes.vertical(area, &format!("({}) {method}: residual, px", char::from(b'a' + panel as u8)));
            images(area, &axes, &mine);
            for (i, (_, axis, v)) in mine.iter().enumerate() {
                let colour = if *axis == "x" { COLOURS[1] } else { COLOURS[0] };
                area.draw(&Circle::new(axes.place(i as f64 / 2.0, *v), 2, colour.filled())).ok();
            }
        });
    }
    Some(canvas)
}

fn legend(canvas: &mut Canvas, y: i32) {
    canvas.paint(|area| {
        for (x, axis, colour) in [(80, "in x", COLOURS[1]), (170, "in y", COLOURS[0])] {
            area.draw(&Circle::new((x, y), 4, colour.filled())).ok();
            write(area, axis, (x + 12, y), HPos::Left);
        }
    });
}

/// Upright lines between images, and their names below.
fn images(area: &crate::field::Area<'_>, axes: &Axes, rows: &[(&str, &str, f64)]) {
    let mut first = 0;
    for i in 1..=rows.len() {
        if i < rows.len() && rows[i].0 == rows[first].0 {
            continue;
        }
        let end = axes.place(i as f64 / 2.0, axes.y[0]);
        area.draw(&PathElement::new([end, (end.0, axes.at[1])], RGBColor(160, 160, 160))).ok();
        let middle = axes.place((first + i) as f64 / 4.0, axes.y[0]);
        write(area, &format!("image {}", rows[first].0), (middle.0, middle.1 + 14), HPos::Center);
        first = i;
    }
}

/// Root mean square residual of each image, the least oblique first, mean over the trials with the scatter of single trials; methods side by side.
pub fn by_convergence(found: &Summaries, views: &Views) -> Option<Canvas> {
    let normal = Vector3::from(views.normal?);
    let angle = |station: &Station| (-Vector3::from(station.sight).dot(&normal)).clamp(-1.0, 1.0).acos().to_degrees();
    let mut images: Vec<(f64, &str)> = views.stations.iter().map(|station| (angle(station), &*station.name)).collect();
    images.sort_by(|a, b| a.0.total_cmp(&b.0));
    let figure = |method: &str, name: &str| found.get(method, Quantity::ImageResidual.of(&[name])).map(|s| s.value);
    let values = found.methods.iter().flat_map(|m| images.iter().filter_map(move |(_, name)| Some(figure(m, name)?.mean)));
    let highest = values.fold(0.0, f64::max);
    if highest <= 0.0 {
        return None;
    }
    let axes = Axes { at: [70, 70, 1100, 380], x: [0.0, images.len() as f64], y: [0.0, highest * 1.35] };
    let rows = found.methods.len() as u32;
    let mut canvas = Canvas::new(1210, 520 + rows * 24);
    canvas.text("Residuals by the convergence of the image", 20, (70, 22));
    canvas.paint(|area| {
        axes.vertical(area, "root mean square residual per axis, px; whiskers: twice the standard deviation of single trials");
        for (place, (angle, name)) in (0..).zip(&images) {
            let (x, y) = axes.place(f64::from(place), axes.y[0]);
            area.draw(&PathElement::new([(x, y), (x, axes.at[1])], RGBColor(200, 200, 200))).ok();
            write(area, &format!("{name}: {angle:.0}\u{b0}"), (axes.place(f64::from(place) + 0.5, axes.y[0]).0, y + 16), HPos::Center);
        }
        write(
            area,
            "image: angle between its axis and the wall's normal",
            (axes.at[0] + axes.at[2] / 2, axes.at[1] + axes.at[3] + 38),
            HPos::Center,
        );
    });
    canvas.say_as([
        "image",
        "method",
        "angle, degrees",
        "RMS residual per axis, px",
        "two deviations of single trials from",
        "to",
        "trials",
    ]);
    let mut marks: Vec<OwnMark<'_>> = Vec::new();
    for (m, method) in found.methods.iter().enumerate() {
        let (mark, colour) = (METHOD_MARKS[m % METHOD_MARKS.len()], COLOURS[m % COLOURS.len()]);
        canvas.of(Some(method), |canvas| {
            for (place, (angle, name)) in images.iter().enumerate() {
                let Some(value) = figure(method, name) else { continue };
                let across = place as f64 + (m + 1) as f64 / (found.methods.len() + 1) as f64;
                let scatter = 2.0 * value.deviation().unwrap_or(0.0);
                let ends = ((value.mean - scatter).max(0.0), value.mean + scatter);
                canvas.paint(|area| whisker(area, &axes, across, ends, colour));
                let (x, y) = axes.place(across, value.mean);
                marks.push((Some(method), (mark, colour, (f64::from(x), f64::from(y)))));
                let degrees = format!("{angle:.1}");
                let before = [*name, method.as_str(), &degrees];
                let interval = value.deviation().map(|_| ends);
                canvas.say_estimate((f64::from(x), f64::from(y)), &before, (value.mean, interval), &[&value.count.to_string()]);
            }
            let y = 525 + m as u32 * 24;
            canvas.marks(&[(mark, colour, (90.0, f64::from(y)))]);
            canvas.text(method, 16, (110, y));
        });
    }
    canvas.marks_of(&marks);
    Some(canvas)
}
