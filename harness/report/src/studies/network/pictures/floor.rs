//! The reduction factor over a swept value.

use plotters::prelude::*;

use crate::axes::{Axes, whisker};
use crate::canvas::{COLOURS, Canvas, METHOD_MARKS, OwnMark};

/// Circles and crosses over what is swept.
pub struct Curve {
    /// The method.
    pub method: String,
    /// Its name.
    pub name: String,
    /// Value of the swept key, reduction factor, half its 95 % interval.
    pub points: Vec<(f64, f64, f64)>,
}

/// What the picture says of itself.
pub struct Words<'a> {
    /// Its title.
    pub title: &'a str,
    /// What is swept, with its unit.
    pub x: &'a str,
    /// The method that the factors are against.
    pub reference: &'a str,
    /// The parameters over which they are means.
    pub parameters: &'a str,
}

impl Words<'_> {
    /// What is upwards.
    pub fn factor(&self) -> String {
        format!("reduction factor against {}, mean over {}; bars: 95 %", self.reference, self.parameters)
    }
}

/// Curves of reduction factors; `printed` is the paper's, for a line.
pub fn floor(curves: &[Curve], words: &Words<'_>, printed: &[(String, f64)]) -> Option<Canvas> {
    let x = words.x;
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let widest = all().map(|p| p.0).fold(0.0, f64::max);
    if widest <= 0.0 {
        return None;
    }
    let highest = all().map(|p| p.1 + p.2).fold(1.0, f64::max);
    let axes = Axes { at: [70, 70, 720, 400], x: [0.0, widest * 1.03], y: [0.0, highest * 1.08] };
    let mut canvas = Canvas::new(830, 550 + 24 * curves.len() as u32);
    canvas.text(words.title, 20, (70, 22));
    let grey = RGBColor(120, 120, 120);
    canvas.paint(|area| {
        axes.vertical(area, &words.factor());
        axes.horizontal(area, x);
        for (i, (name, value)) in printed.iter().enumerate() {
            axes.level(area, *value, grey);
            let (left, y) = axes.place(0.01 * widest, *value);
            // The first above its line, the next below.
            let aside = if i == 0 { -10 } else { 12 };
            crate::field::write(area, name, (left + 4, y + aside), plotters::style::text_anchor::HPos::Left);
        }
    });
    canvas.say_as(["method", x, "reduction factor", "95 % from", "to"]);
    let place = |p: &(f64, f64, f64)| {
        let (x, y) = axes.place(p.0, p.1);
        (f64::from(x), f64::from(y))
    };
    for (i, curve) in curves.iter().enumerate() {
        canvas.of(Some(&curve.method), |canvas| {
            let colour = COLOURS[i % COLOURS.len()];
            canvas.paint(|area| {
                let line: Vec<_> = curve.points.iter().map(|p| axes.place(p.0, p.1)).collect();
                area.draw(&PathElement::new(line, ShapeStyle::from(&colour).stroke_width(2))).ok();
                for (x, y, half) in &curve.points {
                    whisker(area, &axes, *x, (y - half, y + half), colour);
                }
            });
            for p in &curve.points {
                canvas.say_estimate(place(p), &[&curve.name, &p.0.to_string()], (p.1, Some((p.1 - p.2, p.1 + p.2))), &[]);
            }
        });
    }
    let mut marks: Vec<OwnMark<'_>> = Vec::new();
    for (i, curve) in curves.iter().enumerate() {
        let look = (METHOD_MARKS[i % METHOD_MARKS.len()], COLOURS[i % COLOURS.len()]);
        let of = Some(&*curve.method);
        marks.extend(curve.points.iter().map(|p| (of, (look.0, look.1, place(p)))));
        let y = 545 + 24 * i as u32;
        marks.push((of, (look.0, look.1, (90.0, f64::from(y)))));
        canvas.of(of, |canvas| canvas.text(&curve.name, 16, (110, y)));
    }
    canvas.marks_of(&marks);
    Some(canvas)
}
