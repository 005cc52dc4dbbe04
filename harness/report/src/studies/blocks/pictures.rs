//! Pictures of free networks: where cameras stand, heights, residuals of a pair.

use std::collections::BTreeMap;

use calibench_records::description::{Blocks, Views};
use calibench_records::figures::{Group, Quantity};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::axes::{Axes, whisker};
use crate::canvas::{COLOURS, Canvas, Mark};
use crate::field::{arrow, stretch, write};
use crate::load::Loaded;
use crate::load::adjustments::Summaries;
use crate::markdown::plain;

/// Side of a square panel, px of the picture.
const SIDE: i32 = 520;
/// Stations nearer to each other than this share of the picture stand at one place.
const ONE_PLACE: f64 = 1e-3;

/// The places of the stations in X and Y around the field, each with the names of those that stand there.
pub fn stations(views: &Views) -> Option<Canvas> {
    let [low, high] = views.extent?;
    let reach = views.stations.iter().flat_map(|station| [station.centre[0], station.centre[1]]).map(f64::abs).fold(0.0, f64::max);
    let reach = 1.25 * reach.max(high[0].abs()).max(high[1].abs());
    let axes = Axes { at: [90, 70, SIDE + 160, SIDE + 160], x: [-reach, reach], y: [-reach, reach] };
    let mut places: Vec<([f64; 3], Vec<&str>)> = Vec::new();
    for station in &views.stations {
        let near = |at: &[f64; 3]| at.iter().zip(station.centre).all(|(a, b)| (a - b).abs() < ONE_PLACE * reach);
        match places.iter_mut().find(|(at, _)| near(at)) {
            Some((_, names)) => names.push(&station.name),
            None => places.push((station.centre, vec![&station.name])),
        }
    }
    let mut canvas = Canvas::new((axes.at[2] + 140) as u32, (axes.at[3] + 160) as u32);
    canvas.text("Stations seen along the normal of the field, and the field", 20, (90, 22));
    let unit = &views.unit;
    canvas.paint(|area| {
        axes.vertical(area, &format!("Y, {unit}"));
        axes.horizontal(area, &format!("X, {unit}"));
        let corners = [axes.place(low[0], high[1]), axes.place(high[0], low[1])];
        area.draw(&Rectangle::new(corners, RGBColor(210, 210, 210).filled())).ok();
        area.draw(&Rectangle::new(corners, BLACK)).ok();
        let middle = axes.place(0.5 * (low[0] + high[0]), low[1]);
        write(area, "field", (middle.0, middle.1 + 14), HPos::Center);
    });
    let place = |at: &[f64; 3]| {
        let (x, y) = axes.place(at[0], at[1]);
        (f64::from(x), f64::from(y))
    };
    let marks: Vec<_> = places.iter().map(|(at, _)| (Mark::Circle, COLOURS[1], place(at))).collect();
    canvas.marks(&marks);
    for (at, names) in &places {
        let (x, y) = place(at);
        let text = if names.len() > 1 { format!("{} to {}", names[0], names[names.len() - 1]) } else { names[0].to_owned() };
        canvas.label(&text, 15, (x as u32 - 45, y as u32 + 20));
        canvas.label(&format!("Z = {:.0}", at[2]), 13, (x as u32 - 32, y as u32 + 36));
    }
    Some(canvas)
}

/// Heights over X and over Y, of the first method and block that have them.
pub fn heights(found: &Summaries, views: &Views) -> Option<Canvas> {
    let places: BTreeMap<&str, [f64; 3]> = views.targets.iter().map(|target| (target.id.as_str(), target.surveyed)).collect();
    let (method, set) = found.figures.keys().find(|(.., name)| name.group() == Group::Object).map(|(method, set, ..)| (method, set))?;
    let mine = found.figures.iter().filter(|((m, s, name), _)| name.quantity() == Quantity::ObjectZ && m == method && s == set);
    let points: Vec<([f64; 3], f64, f64)> = mine
        .filter_map(|((.., name), summary)| {
            let first = summary.first?;
            Some((*places.get(*name.parts().first()?)?, first.value, first.sigma.unwrap_or(0.0)))
        })
        .collect();
    let reach = 1.1 * points.iter().flat_map(|(at, ..)| [at[0].abs(), at[1].abs()]).fold(0.0, f64::max);
    let span =
        points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, z, sigma)| [low.min(z - sigma), high.max(z + sigma)]);
    let room = 0.12 * (span[1] - span[0]).max(1e-9);
    let y = [span[0] - room, span[1] + room];
    let mut canvas = Canvas::new((2 * SIDE + 250) as u32, 560);
    canvas.text(&format!("Object point heights, block {set}, {method}"), 20, (90, 22));
    let unit = &views.unit;
    let names = ["X", "Y", "Z", "standard deviation of Z"].map(|name| format!("{name}, {unit}"));
    canvas.say_as(names.iter().map(String::as_str));
    for (panel, axis) in ["X", "Y"].into_iter().enumerate() {
        let axes = Axes { at: [90 + panel as i32 * (SIDE + 90), 70, SIDE, 400], x: [-reach, reach], y };
        let mut marks = Vec::new();
        for (at, z, sigma) in &points {
            let (x, y) = axes.place(at[panel], *z);
            canvas.say((f64::from(x), f64::from(y)), [plain(at[0]), plain(at[1]), plain(*z), plain(*sigma)]);
        }
        canvas.paint(|area| {
            axes.vertical(area, &format!("Z, {unit}; whiskers: one standard deviation"));
            axes.horizontal(area, &format!("{axis}, {unit}"));
            for (at, z, sigma) in &points {
                whisker(area, &axes, at[panel], (z - sigma, z + sigma), COLOURS[1]);
                let (x, y) = axes.place(at[panel], *z);
                marks.push((Mark::Circle, COLOURS[1], (f64::from(x), f64::from(y))));
            }
        });
        canvas.marks(&marks);
    }
    Some(canvas)
}

/// The residuals of the first pair of images, each as an arrow at its place in the frame.
pub fn pair(loaded: &Loaded, found: &Summaries, views: &Views, told: &Blocks) -> Option<Canvas> {
    let [first, second] = told.pairs.first()?;
    let method = found.residuals.first().map(|(method, ..)| method)?;
    let index = loaded.method(method)?;
    let [a, b] = [first, second].map(|image| of_image(loaded, found, told, (method, index), image));
    let longest = a.iter().chain(&b).map(|(_, v)| v[0].hypot(v[1])).fold(0.0, f64::max);
    if longest <= 0.0 {
        return None;
    }
    let by = stretch(f64::from(views.size[0]) / 12.0, longest);
    let height = SIDE * views.size[1] as i32 / views.size[0] as i32;
    let mut canvas = Canvas::new((2 * SIDE + 250) as u32, (height + 170) as u32);
    canvas.text(&format!("Residuals of {}, {method}", told.compared.join(", ")), 20, (90, 22));
    for (panel, (image, vectors)) in (0..).zip([(first, &a), (second, &b)]) {
        let [width, rows] = views.size.map(f64::from);
        let axes = Axes { at: [90 + panel * (SIDE + 90), 70, SIDE, height], x: [0.0, width], y: [rows, 0.0] };
        canvas.paint(|area| {
            axes.vertical(area, &format!("image {image}: y, px"));
            axes.horizontal(area, "x, px");
            for ([x, y], [dx, dy]) in vectors {
                arrow(area, axes.place(*x, *y), axes.place(x + by * dx, y + by * dy));
            }
        });
    }
    canvas.text(&format!("arrows {by} times too long; longest {} px", plain(longest)), 16, (90, (height + 148) as u32));
    Some(canvas)
}

type Vectors = Vec<([f64; 2], [f64; 2])>;

/// Place and residual of every point of the compared blocks in an image.
fn of_image(loaded: &Loaded, found: &Summaries, told: &Blocks, (method, index): (&str, usize), image: &str) -> Vectors {
    let mut residuals: BTreeMap<&str, [f64; 2]> = BTreeMap::new();
    for ((m, name, value), set) in found.residuals.iter().zip(&found.sets_of_residuals) {
        let rest = name.strip_prefix(image).and_then(|rest| rest.strip_prefix('/'));
        let Some((target, axis)) = rest.and_then(|rest| rest.rsplit_once('/')) else { continue };
        if m == method && told.compared.contains(set) {
            residuals.entry(target).or_default()[usize::from(axis == "y")] = *value;
        }
    }
    let points = loaded.first.points.iter().filter(|point| point.method == index && *point.view == *image);
    points
        .filter_map(|point| {
            let at = point.outcome.position()?;
            Some(([at.x, at.y], *residuals.get(&*point.target)?))
        })
        .collect()
}
