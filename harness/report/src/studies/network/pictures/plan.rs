//! The network from above, and the wall with control and check points.

use calibench_records::description::{Role, Target, Views};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::axes::Axes;
use crate::canvas::{COLOURS, Canvas, Mark};
use crate::field::{arrow, write};
use crate::labels::{Names, along};
use crate::sides::{Side, Sides, around};

const HEIGHT: i32 = 460;
/// The most that the wall is wide, px.
const WIDEST: f64 = 900.0;
/// Length of a line of sight, as a share of the depth of the network.
const SIGHT: f64 = 0.16;
const GREY: RGBColor = RGBColor(120, 120, 120);

type Marks = Vec<(Mark, RGBColor, (f64, f64))>;

/// From above: stations with their axes before the wall; those of the second step in orange. Beside it the wall from the front. Without a sheet there are its
/// points in its place. `None` without stations, or where the front is not known.
pub fn plan(views: &Views) -> Option<Canvas> {
    let ends = around(views)?;
    let sides = Sides::of(views.normal?, &ends);
    // From above the cameras stand below the wall, as a reader would stand before it.
    let (across, depth) = (sides.across, sides.towards.reversed());
    let places = || views.stations.iter().map(|station| &station.centre).chain(&ends);
    let ([left, right], [near, far]) = (across.span(places()), depth.span(places()));
    let room = 0.08 * (right - left);
    // One scale for both axes.
    let (x, y) = ([left - room, right + room], [near - room, far + room]);
    let width = (f64::from(HEIGHT) * (x[1] - x[0]) / (y[1] - y[0])).round() as i32;
    let axes = Axes { at: [70, 80, width, HEIGHT], x, y };
    let front = front_axes(&sides, &ends, views.extent.is_none(), 70 + width + 90);
    let mut canvas = Canvas::new((front.at[0] + front.at[2] + 40) as u32, (HEIGHT + 210) as u32);
    let object = if views.extent.is_some() { "wall" } else { "points" };
    canvas.text("The network from above", 20, (70, 20));
    canvas.text(&format!("The {object} from the front"), 20, (front.at[0] as u32, 20));
    let (mut marks, mut names) = (Vec::new(), Names::default());
    let sights: Vec<[(i32, i32); 2]> = views
        .stations
        .iter()
        .map(|station| {
            let (at, by) = ((across.of(&station.centre), depth.of(&station.centre)), SIGHT * (far - near));
            let to = (at.0 + by * across.along(&station.sight), at.1 + by * depth.along(&station.sight));
            [axes.place(at.0, at.1), axes.place(to.0, to.1)]
        })
        .collect();
    canvas.paint(|area| {
        axes.vertical(area, &depth.title(&views.unit));
        axes.horizontal(area, &across.title(&views.unit));
        if views.extent.is_some() {
            wall(area, &axes, views, (across, depth));
        }
        sights.iter().for_each(|[from, to]| arrow(area, *from, *to));
        front.vertical(area, &sides.up.title(&views.unit));
        front.horizontal(area, &across.title(&views.unit));
    });
    if views.extent.is_none() {
        marks.extend(views.targets.iter().map(|target| mark(target, axes.place(across.of(&target.surveyed), depth.of(&target.surveyed)))));
    }
    for station in &views.stations {
        let (px, py) = axes.place(across.of(&station.centre), depth.of(&station.centre));
        let look = if station.second_step { (Mark::Diamond, COLOURS[0]) } else { (Mark::Circle, COLOURS[1]) };
        marks.push((look.0, look.1, (f64::from(px), f64::from(py))));
        names.named.push((&station.name, (f64::from(px), f64::from(py))));
    }
    names.others.extend(sights.iter().flat_map(along));
    names.write(&mut canvas, &axes, 18);
    points(&mut canvas, views, (&front, &sides), &mut marks);
    canvas.marks(&marks);
    legend(&mut canvas, views, front.at[0] as u32);
    Some(canvas)
}

/// The wall from above: the diagonal of its box along which its targets lie.
fn wall(area: &crate::field::Area<'_>, axes: &Axes, views: &Views, (across, depth): (Side, Side)) {
    let [from, to] = wall_ends(views, (across, depth)).map(|(x, y)| axes.place(x, y));
    area.draw(&PathElement::new([from, to], ShapeStyle::from(&BLACK).stroke_width(5))).ok();
    write(area, "wall", ((from.0 + to.0) / 2, (from.1 + to.1) / 2 - 16), HPos::Center);
}

/// The ends of the wall from above, along it and in depth.
pub(crate) fn wall_ends(views: &Views, (across, depth): (Side, Side)) -> [(f64, f64); 2] {
    let ends = views.extent.unwrap_or_default();
    let ([left, right], [near, far]) = (across.span(ends.iter()), depth.span(ends.iter()));
    let places = || views.targets.iter().map(|target| (across.of(&target.surveyed), depth.of(&target.surveyed)));
    let count = places().count().max(1) as f64;
    let middle = places().fold((0.0, 0.0), |sum, at| (sum.0 + at.0 / count, sum.1 + at.1 / count));
    let rising = places().map(|at| (at.0 - middle.0) * (at.1 - middle.1)).sum::<f64>() >= 0.0;
    let (first, last) = if rising { (near, far) } else { (far, near) };
    [(left, first), (right, last)]
}

/// Points without a sheet have room around them.
fn front_axes(sides: &Sides, ends: &[[f64; 3]; 2], roomy: bool, left: i32) -> Axes {
    let ([x0, x1], [y0, y1]) = (sides.across.span(ends.iter()), sides.up.span(ends.iter()));
    let room = (if roomy { 0.06 } else { 0.03 }) * (x1 - x0);
    let (x, y) = ([x0 - room, x1 + room], [y0 - room, y1 + room]);
    let width = (f64::from(HEIGHT) * (x[1] - x[0]) / (y[1] - y[0])).min(WIDEST);
    let height = width * (y[1] - y[0]) / (x[1] - x[0]);
    Axes { at: [left, 80, width.round() as i32, height.round() as i32], x, y }
}

fn mark(target: &Target, (x, y): (i32, i32)) -> (Mark, RGBColor, (f64, f64)) {
    let (mark, colour) = match target.role {
        Some(Role::Control) => (Mark::Triangle, COLOURS[0]),
        Some(Role::Check) => (Mark::Cross, COLOURS[1]),
        None => (Mark::Square, GREY),
    };
    (mark, colour, (f64::from(x), f64::from(y)))
}

fn points(canvas: &mut Canvas, views: &Views, (axes, sides): (&Axes, &Sides), marks: &mut Marks) {
    // Names of all would hide each other: those of control points, or of check points where these are alone.
    let named = if views.targets.iter().any(|target| target.role == Some(Role::Control)) { Role::Control } else { Role::Check };
    let mut names = Names::default();
    for target in &views.targets {
        let (x, y) = axes.place(sides.across.of(&target.surveyed), sides.up.of(&target.surveyed));
        marks.push(mark(target, (x, y)));
        if target.role == Some(named) {
            names.named.push((&target.id, (f64::from(x), f64::from(y))));
        } else {
            names.others.push((f64::from(x), f64::from(y)));
        }
    }
    names.write(canvas, axes, 14);
}

/// What there is, and no more.
fn legend(canvas: &mut Canvas, views: &Views, second: u32) {
    let stepped = |step: bool| views.stations.iter().any(|station| station.second_step == step);
    let has = |role: Option<Role>| views.targets.iter().any(|target| target.role == role);
    let control = has(Some(Role::Control));
    let station = if stepped(true) { "station of the calibration" } else { "station" };
    let other = if control || has(Some(Role::Check)) { "calibration alone" } else { "target" };
    let rows = [
        (70, stepped(false), Mark::Circle, COLOURS[1], station),
        (70, stepped(true), Mark::Diamond, COLOURS[0], if stepped(false) { "station of the second step too" } else { "station" }),
        (second, control, Mark::Triangle, COLOURS[0], "control point of the second step"),
        (second, has(Some(Role::Check)), Mark::Cross, COLOURS[1], "check point"),
        (second, has(None), Mark::Square, GREY, other),
    ];
    for left in [70, second] {
        let shown = rows.iter().filter(|(x, there, ..)| *x == left && *there);
        for (row, (x, _, mark, colour, text)) in (0..).zip(shown) {
            let y = (HEIGHT + 145) as u32 + row * 24;
            canvas.marks(&[(*mark, *colour, (f64::from(x + 14), f64::from(y)))]);
            canvas.paint(|area| write(area, text, (*x as i32 + 34, y as i32), HPos::Left));
        }
    }
}
