//! The interval over a plane of the volume, and what makes the most of it.

use calibench_task::{Budget, Map, Source, Task};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::unit_of;
use crate::Canvas;
use crate::canvas::COLOURS;
use crate::field::{Area, shade, write};
use crate::levels::Scale;
use crate::markdown::plain;

/// Longest side of a panel, px of the picture.
const PANEL: f64 = 440.0;
const LEFT: u32 = 80;
const TOP: u32 = 76;
/// Between the panels, and from row to row, px of the picture.
const GAP: (u32, u32) = (90, 96);
/// Room for the legends at the right.
const RIGHT: u32 = 280;
/// Height of a colour in a legend.
const STEP: i32 = 26;
/// The darkest colour of the scale.
const DARKEST: f64 = 0.9;

/// The colour of a source: that of its place in the order of all, dark grey and light ones after the six of methods.
fn colour(source: Source) -> RGBColor {
    const MORE: [RGBColor; 6] = [
        RGBColor(85, 85, 85),
        RGBColor(240, 228, 66),
        RGBColor(136, 34, 85),
        RGBColor(170, 170, 170),
        RGBColor(17, 119, 51),
        RGBColor(51, 34, 136),
    ];
    let place = Source::ALL.iter().position(|one| *one == source).unwrap_or(0);
    COLOURS.iter().chain(&MORE).nth(place).copied().unwrap_or(BLACK)
}

/// Where a map lies in the picture.
struct Panel<'m> {
    map: &'m Map,
    corner: (i32, i32),
    extent: (i32, i32),
}

/// A row of two panels for each map: half of the 95 % interval, and the source that makes the most of it.
pub fn maps(task: &Task, budget: &Budget, maps: &[Map]) -> Canvas {
    let sides = |map: &Map| map.extent.map(|[low, high]| high - low);
    let long = maps.iter().flat_map(sides).fold(f64::MIN_POSITIVE, f64::max);
    let extent = |map: &Map| {
        let [width, height] = sides(map).map(|side| (side / long * PANEL).round().max(40.0) as i32);
        (width, height)
    };
    let (width, height) = maps.iter().map(&extent).fold((0, 0), |most, one| (most.0.max(one.0), most.1.max(one.1)));
    let (width, height) = (width as u32, height as u32);
    let mut seen: Vec<Source> = maps.iter().flat_map(|map| &map.cells).flatten().map(|cell| cell.largest).collect();
    seen.sort_unstable();
    seen.dedup();
    let rows = maps.len().max(1) as u32;
    let legends = TOP + 60 + (8 + seen.len() as u32) * STEP as u32;
    let mut canvas = Canvas::new(LEFT + 2 * width + GAP.0 + RIGHT, (TOP + rows * (height + GAP.1)).max(legends));
    let halves: Vec<f64> = maps.iter().flat_map(|map| &map.cells).flatten().map(|cell| cell.half).collect();
    let unit = budget.components.first().and_then(|component| unit_of(task, component)).unwrap_or("object units");
    canvas.text(
        &format!("95 % interval of the {} over the volume: half of it, {unit}, and what makes the most of it", task.quantity.word()),
        20,
        (LEFT, 20),
    );
    let Some(scale) = Scale::of(&halves) else {
        canvas.text("nowhere in this plane can it be measured", 16, (LEFT, TOP));
        return canvas;
    };
    let levels = scale.levels();
    let band = |half: f64| shade(DARKEST * levels.iter().filter(|level| **level <= half).count() as f64 / levels.len().max(1) as f64);
    for (row, map) in (0..).zip(maps) {
        let top = TOP + row * (height + GAP.1);
        let panel = |column: u32| Panel { map, corner: ((LEFT + column * (width + GAP.0)) as i32, top as i32), extent: extent(map) };
        canvas.paint(|area| {
            panel(0).draw(area, task, |cell| band(cell.half));
            panel(1).draw(area, task, |cell| colour(cell.largest));
        });
    }
    let x = (LEFT + 2 * width + GAP.0 + 30) as i32;
    canvas.paint(|area| {
        let down = scale_legend(area, (x, TOP as i32), &levels, (&halves, unit));
        for (place, source) in (0..).zip(&seen) {
            let y = down + 40 + place * STEP;
            area.draw(&Rectangle::new([(x, y - 9), (x + 24, y + 9)], colour(*source).filled())).ok();
            write(area, source.words(), (x + 32, y), HPos::Left);
        }
    });
    canvas
}

/// The colours of the intervals from the largest downwards, with the lengths at their borders; returns where they end.
fn scale_legend(area: &Area<'_>, (x, y): (i32, i32), levels: &[f64], (halves, unit): (&[f64], &str)) -> i32 {
    let count = levels.len() as i32 + 1;
    let down = y + count * STEP;
    for band in 0..count {
        let low = down - band * STEP;
        let part = DARKEST * f64::from(band) / levels.len().max(1) as f64;
        area.draw(&Rectangle::new([(x, low - STEP), (x + 24, low)], shade(part).filled())).ok();
        area.draw(&Rectangle::new([(x, low - STEP), (x + 24, low)], BLACK)).ok();
    }
    for (border, value) in (1..).zip(levels) {
        write(area, &value.to_string(), (x + 32, down - border * STEP), HPos::Left);
    }
    let [least, most] = halves.iter().fold([f64::INFINITY, 0.0], |[least, most], half| [half.min(least), half.max(most)]);
    write(area, &format!("{} at least", plain(least)), (x + 32, down), HPos::Left);
    write(area, &format!("{} at most", plain(most)), (x + 32, down - count * STEP), HPos::Left);
    write(area, unit, (x, y - 18), HPos::Left);
    down
}

impl Panel<'_> {
    fn draw(&self, area: &Area<'_>, task: &Task, of: impl Fn(&calibench_task::Cell) -> RGBColor) {
        let (left, top) = self.corner;
        let (width, height) = self.extent;
        let [columns, rows] = self.map.grid;
        let edge = |place: usize, count: usize, px: i32| (place as f64 / count as f64 * f64::from(px)).round() as i32;
        for (index, cell) in self.map.cells.iter().enumerate() {
            let Some(cell) = cell else { continue };
            let (column, row) = (index % columns, index / columns);
            let x = [column, column + 1].map(|place| left + edge(place, columns, width));
            // The second axis goes up.
            let y = [row, row + 1].map(|place| top + height - edge(place, rows, height));
            area.draw(&Rectangle::new([(x[0], y[1]), (x[1], y[0])], of(cell).filled())).ok();
        }
        area.draw(&Rectangle::new([(left, top), (left + width, top + height)], BLACK)).ok();
        self.axes(area, task.unit.as_deref());
        self.place_of_task(area, task);
    }

    fn axes(&self, area: &Area<'_>, unit: Option<&str>) {
        let ((left, top), (width, height)) = (self.corner, self.extent);
        let [first, second] = self.map.extent;
        for step in 0..=2 {
            let at = |[low, high]: [f64; 2]| plain(low + (high - low) * f64::from(step) / 2.0);
            write(area, &at(first), (left + width * step / 2, top + height + 14), HPos::Center);
            write(area, &at(second), (left - 8, top + height - height * step / 2), HPos::Right);
        }
        let unit = unit.map_or_else(String::new, |unit| format!(", {unit}"));
        write(area, &format!("{}{unit}", self.map.axes[0]), (left + width / 2, top + height + 34), HPos::Center);
        write(area, &format!("{}{unit}", self.map.axes[1]), (left - 8, top - 16), HPos::Right);
        if let Some((axis, at)) = self.map.at {
            write(area, &format!("at {axis} = {}", plain(at)), (left + width / 2, top - 16), HPos::Center);
        }
    }

    /// A black ring where the task itself is, in white, where the axes of the map are those of the object.
    fn place_of_task(&self, area: &Area<'_>, task: &Task) {
        let ((left, top), (width, height)) = (self.corner, self.extent);
        let points = task.quantity.points();
        let axis = |name: &str| ["X", "Y", "Z"].iter().position(|one| *one == name);
        let (Some(first), Some(second)) = (axis(&self.map.axes[0]), axis(&self.map.axes[1])) else { return };
        let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
        let part = |value: f64, [low, high]: [f64; 2]| (value - low) / (high - low);
        let [x, y] = [part(mean(first), self.map.extent[0]), part(mean(second), self.map.extent[1])];
        let at = (left + (x * f64::from(width)).round() as i32, top + height - (y * f64::from(height)).round() as i32);
        area.draw(&Circle::new(at, 6, WHITE.stroke_width(4))).ok();
        area.draw(&Circle::new(at, 6, BLACK.stroke_width(2))).ok();
    }
}
