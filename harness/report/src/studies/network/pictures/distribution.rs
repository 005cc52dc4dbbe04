//! All image points of the first trial over the frame.

use calibench_records::description::Views;
use plotters::prelude::*;

use crate::axes::Axes;
use crate::canvas::{COLOURS, Canvas};
use crate::load::Loaded;

/// The points of the first method, all images laid over one another.
pub fn distribution(loaded: &Loaded, views: &Views) -> Option<Canvas> {
    let points: Vec<_> =
        loaded.first.points.iter().filter(|point| point.method == 0).filter_map(|point| point.outcome.position()).collect();
    if points.is_empty() {
        return None;
    }
    let [width, height] = views.size.map(f64::from);
    let shown = (760.0 * height / width).round() as i32;
    let axes = Axes { at: [70, 80, 760, shown], x: [-0.5, width - 0.5], y: [height - 0.5, -0.5] };
    let mut canvas = Canvas::new(870, (shown + 150) as u32);
    canvas.text(
        &format!("All {} image points of the first trial, {} images laid over one another", points.len(), views.stations.len()),
        20,
        (70, 22),
    );
    canvas.paint(|area| {
        axes.horizontal(area, "x, px");
        let flipped = Axes { y: [height - 0.5, -0.5], ..axes };
        area.draw(&Rectangle::new([(70, 80), (830, 80 + shown)], BLACK)).ok();
        let values = crate::ticks::linear(0.0, height);
        for &value in &values {
            let (x, y) = flipped.place(-0.5, value);
            crate::field::write(area, &crate::axes::number(value, &values), (x - 8, y), plotters::style::text_anchor::HPos::Right);
        }
        crate::field::write(area, "y, px", (70, 64), plotters::style::text_anchor::HPos::Left);
        for point in points {
            area.draw(&Circle::new(axes.place(point.x, point.y), 3, COLOURS[1].filled())).ok();
        }
    });
    Some(canvas)
}
