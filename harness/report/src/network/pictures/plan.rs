//! The network from above, and the wall with control and check points.

use calibench_records::description::{Role, Views};
use nalgebra::{Point3, Vector3};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::axes::Axes;
use crate::canvas::{COLOURS, Canvas, Mark};
use crate::field::{arrow, write};

const HEIGHT: i32 = 460;
/// The most that the wall is wide, px.
const WIDEST: f64 = 900.0;
const NAMES: [&str; 3] = ["X", "Y", "Z"];

/// Along the wall, up, and away from it: numbers of coordinates. A wall is longer than it is high.
struct Sides {
    across: usize,
    up: usize,
    depth: usize,
}

impl Sides {
    fn of(views: &Views, low: &Point3<f64>, high: &Point3<f64>) -> Option<Self> {
        let normal = Vector3::from(views.normal?).abs();
        let depth = normal.imax();
        let [a, b] = [[1, 2], [0, 2], [0, 1]][depth];
        let (across, up) = if high[a] - low[a] >= high[b] - low[b] { (a, b) } else { (b, a) };
        Some(Self { across, up, depth })
    }
}

/// From above: stations with their axes before the wall; those of the second step in orange. Beside it the wall from the front.
pub fn plan(views: &Views) -> Option<Canvas> {
    let [low, high] = views.extent?.map(Point3::from);
    let sides = Sides::of(views, &low, &high)?;
    let Sides { across, up, depth } = sides;
    let centres: Vec<_> = views.stations.iter().map(|station| Point3::from(station.centre)).collect();
    let span = |of: &dyn Fn(&Point3<f64>) -> f64| {
        let values = centres.iter().map(of).chain([of(&low), of(&high)]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)])
    };
    let ([left, right], [near, far]) = (span(&|p| p[across]), span(&|p| p[depth]));
    let room = 0.08 * (right - left);
    // One scale for both axes; from above the cameras stand below the wall, as a reader would stand before it.
    let (x, y) = ([left - room, right + room], [-far - room, -near + room]);
    let width = (f64::from(HEIGHT) * (x[1] - x[0]) / (y[1] - y[0])).round() as i32;
    let axes = Axes { at: [70, 80, width, HEIGHT], x, y };
    let front = front_axes([low[across], high[across]], [low[up], high[up]], 70 + width + 90);
    let mut canvas = Canvas::new((front.at[0] + front.at[2] + 40) as u32, (HEIGHT + 210) as u32);
    let unit = &views.unit;
    canvas.text("The network from above", 20, (70, 20));
    canvas.text("The wall from the front", 20, (front.at[0] as u32, 20));
    canvas.paint(|area| {
        axes.vertical(area, &format!("-{}, {unit}", NAMES[depth]));
        axes.horizontal(area, &format!("{}, {unit}", NAMES[across]));
        let wall = [axes.place(low[across], -low[depth]), axes.place(high[across], -high[depth])];
        area.draw(&PathElement::new(wall, ShapeStyle::from(&BLACK).stroke_width(5))).ok();
        let named = axes.place(0.5 * (low[across] + high[across]), -0.5 * (low[depth] + high[depth]));
        write(area, "wall", (named.0, named.1 - 16), HPos::Center);
        for (station, centre) in views.stations.iter().zip(&centres) {
            let to = centre + Vector3::from(station.sight) * (0.16 * (far - near));
            arrow(area, axes.place(centre[across], -centre[depth]), axes.place(to[across], -to[depth]));
        }
        front.vertical(area, &format!("{}, {unit}", NAMES[up]));
        front.horizontal(area, &format!("{}, {unit}", NAMES[across]));
    });
    let mut marks = Vec::new();
    for (station, centre) in views.stations.iter().zip(&centres) {
        let (px, py) = axes.place(centre[across], -centre[depth]);
        let look = if station.second_step { (Mark::Diamond, COLOURS[0]) } else { (Mark::Circle, COLOURS[1]) };
        marks.push((look.0, look.1, (f64::from(px), f64::from(py))));
        canvas.label(&station.name, 18, (px as u32 + 10, py as u32 + 14));
    }
    points(&mut canvas, views, (&front, &sides), &mut marks);
    canvas.marks(&marks);
    legend(&mut canvas, front.at[0] as u32);
    Some(canvas)
}

fn front_axes(x: [f64; 2], y: [f64; 2], left: i32) -> Axes {
    let width = (f64::from(HEIGHT) * (x[1] - x[0]) / (y[1] - y[0])).min(WIDEST);
    let height = width * (y[1] - y[0]) / (x[1] - x[0]);
    Axes { at: [left, 80, width.round() as i32, height.round() as i32], x, y }
}

fn points(canvas: &mut Canvas, views: &Views, (axes, sides): (&Axes, &Sides), marks: &mut Vec<(Mark, RGBColor, (f64, f64))>) {
    for target in &views.targets {
        let (x, y) = axes.place(target.surveyed[sides.across], target.surveyed[sides.up]);
        let look = match target.role {
            Some(Role::Control) => (Mark::Triangle, COLOURS[0]),
            Some(Role::Check) => (Mark::Cross, COLOURS[1]),
            None => (Mark::Square, RGBColor(120, 120, 120)),
        };
        marks.push((look.0, look.1, (f64::from(x), f64::from(y))));
        if look.0 == Mark::Triangle {
            // To the left near the right side.
            let room = 8 * target.id.chars().count() as i32 + 16;
            let left = if x + room > axes.at[0] + axes.at[2] { x - room } else { x + 10 };
            canvas.label(&target.id, 14, (left.max(0) as u32, (y - 12).max(0) as u32));
        }
    }
}

fn legend(canvas: &mut Canvas, second: u32) {
    let grey = RGBColor(120, 120, 120);
    let rows = [
        (70, 0, Mark::Circle, COLOURS[1], "station of the calibration"),
        (70, 1, Mark::Diamond, COLOURS[0], "station of the second step too"),
        (second, 0, Mark::Triangle, COLOURS[0], "control point of the second step"),
        (second, 1, Mark::Cross, COLOURS[1], "check point"),
        (second, 2, Mark::Square, grey, "calibration alone"),
    ];
    for (x, row, mark, colour, text) in rows {
        let y = (HEIGHT + 145) as u32 + row * 24;
        canvas.marks(&[(mark, colour, (f64::from(x + 14), f64::from(y)))]);
        canvas.paint(|area| write(area, text, (x as i32 + 34, y as i32), HPos::Left));
    }
}
