//! How many networks keep what they must, over a swept value.

use plotters::prelude::*;

use crate::axes::{Axes, whisker};
use crate::canvas::{COLOURS, Canvas, METHOD_MARKS, OwnMark};
use crate::sweep::Estimate;

/// Shares over what is swept.
pub(super) struct Curve {
    /// The method.
    pub(super) method: String,
    /// Its name, with the values of what else is swept.
    pub(super) name: String,
    /// Value of the swept key, share of trials, %.
    pub(super) points: Vec<(f64, Estimate)>,
}

/// The curves; `x` says what is swept. `None` where one value alone is.
pub(super) fn picture(curves: &[Curve], x: &str) -> Option<Canvas> {
    let all = || curves.iter().flat_map(|curve| &curve.points).map(|point| point.0);
    let (low, high) = (all().reduce(f64::min)?, all().reduce(f64::max)?);
    if high <= low {
        return None;
    }
    let aside = 0.05 * (high - low);
    let axes = Axes { at: [70, 70, 720, 400], x: [low - aside, high + aside], y: [0.0, 105.0] };
    let mut canvas = Canvas::new(830, 550 + 24 * curves.len() as u32);
    canvas.text("Networks that keep their limits", 20, (70, 22));
    canvas.paint(|area| {
        axes.vertical(area, "of 100 networks; bars: 95 %");
        axes.horizontal(area, x);
    });
    canvas.say_as(["method", x, "of 100 networks", "95 % from", "to"]);
    let place = |(x, share): &(f64, Estimate)| {
        let (x, y) = axes.place(*x, share.value);
        (f64::from(x), f64::from(y))
    };
    let mut marks: Vec<OwnMark<'_>> = Vec::new();
    for (i, curve) in curves.iter().enumerate() {
        let of = Some(&*curve.method);
        let (mark, colour) = (METHOD_MARKS[i % METHOD_MARKS.len()], COLOURS[i % COLOURS.len()]);
        let y = 545 + 24 * i as u32;
        canvas.of(of, |canvas| {
            canvas.paint(|area| {
                let line: Vec<_> = curve.points.iter().map(|(x, share)| axes.place(*x, share.value)).collect();
                area.draw(&PathElement::new(line, ShapeStyle::from(&colour).stroke_width(2))).ok();
                for (x, share) in &curve.points {
                    whisker(area, &axes, *x, share.interval.unwrap_or((share.value, share.value)), colour);
                }
            });
            for point in &curve.points {
                canvas.say_estimate(place(point), &[&curve.name, &point.0.to_string()], (point.1.value, point.1.interval), &[]);
            }
            canvas.text(&curve.name, 16, (110, y));
        });
        marks.extend(curve.points.iter().map(|point| (of, (mark, colour, place(point)))));
        marks.push((of, (mark, colour, (90.0, f64::from(y)))));
    }
    canvas.marks_of(&marks);
    Some(canvas)
}
