//! Strokes by what they belong to, and what is said at places.

use std::collections::BTreeMap;
use std::fmt::Write;

use plotters_backend::BackendCoord;

use super::letters::Lettering;
use super::pencil::Pencil;
use crate::Canvas;
use crate::canvas::{Depth, Owner, Stroke};
use crate::markup::{between_bars, escaped};

/// The names of the series and of the values that are said, as attributes of what holds them.
pub(super) fn attributes(canvas: &Canvas) -> String {
    let list = |attribute: &str, names: &[String]| {
        let names: Vec<String> = names.iter().map(|name| between_bars(name)).collect();
        if names.is_empty() { String::new() } else { format!(" data-{attribute}=\"{}\"", names.join("|")) }
    };
    format!("{}{}", list("of", canvas.series()), list("names", canvas.says()))
}

/// What belongs to no series, and above it one group a series and depth; at last what is said.
///
/// A series is gathered from all panels of a picture: so it is hidden at once, and what is of one style is one path.
pub(super) fn groups(strokes: &[Stroke]) -> String {
    let pencil = || Pencil::new(Lettering::OfPage);
    let (mut below, mut owned) = (pencil(), BTreeMap::<(Depth, usize), Pencil>::new());
    let mut said = BTreeMap::<Option<usize>, Vec<(BackendCoord, &[String])>>::new();
    let mut owner = None;
    for run in strokes.chunk_by(|a, b| !is_aside(a) && !is_aside(b)) {
        match run {
            [Stroke::Belongs(of)] => owner = *of,
            [Stroke::Said(at, values)] => said.entry(owner.map(|Owner { series, .. }| series)).or_default().push((*at, values)),
            run => owner.map_or(&mut below, |Owner { series, depth }| owned.entry((depth, series)).or_insert_with(pencil)).strokes(run),
        }
    }
    let mut out = below.end();
    for ((_, series), pen) in owned {
        // Writing to a String cannot fail.
        let _ = write!(out, "<g data-m=\"{series}\">{}</g>", pen.end());
    }
    for (series, said) in said {
        let series = series.map_or_else(String::new, |series| format!(" data-m=\"{series}\""));
        let _ = write!(out, "<g{series} data-p=\"{}\"/>", points(&said));
    }
    out
}

/// All strokes as they were drawn, those of a series in groups that are called as it is: programs that draw show its name.
pub(super) fn named(canvas: &Canvas) -> String {
    let mut out = String::new();
    let mut owner = None;
    for run in canvas.strokes().chunk_by(|a, b| !is_aside(a) && !is_aside(b)) {
        match run {
            [Stroke::Belongs(of)] => owner = *of,
            [Stroke::Said(..)] => {}
            run => {
                let mut pencil = Pencil::new(Lettering::OfText);
                pencil.strokes(run);
                let drawn = pencil.end();
                // Writing to a String cannot fail.
                let _ = match owner.and_then(|Owner { series, .. }| canvas.series().get(series)) {
                    Some(name) => write!(out, "<g><title>{}</title>{drawn}</g>", escaped(name)),
                    None => write!(out, "{drawn}"),
                };
            }
        }
    }
    out
}

fn is_aside(stroke: &Stroke) -> bool {
    matches!(stroke, Stroke::Belongs(_) | Stroke::Said(..))
}

/// A line a place: its x and y, then its values between bars. An empty value is that of the place before: most of them repeat it.
fn points(said: &[(BackendCoord, &[String])]) -> String {
    let mut last: &[String] = &[];
    let lines = said.iter().map(|((x, y), values)| {
        let before = std::mem::replace(&mut last, values);
        let value = |(place, value): (usize, &String)| if before.get(place) == Some(value) { String::new() } else { between_bars(value) };
        let values: Vec<String> = values.iter().enumerate().map(value).collect();
        format!("{x} {y}|{}", values.join("|"))
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use plotters::prelude::*;

    use super::super::Drawing;
    use super::*;
    use crate::canvas::Mark;

    fn canvas() -> Canvas {
        let mut canvas = Canvas::new(100, 100);
        canvas.say_as(["blur, px", "RMSE, px", "<b>|c"]);
        for (name, y) in [("a", 10), ("b|<", 30), ("a", 50)] {
            canvas.of(Some(name), |canvas| {
                canvas.paint(|area| {
                    area.draw(&PathElement::new([(1, y), (9, y)], RED)).ok();
                });
                canvas.say((1.4, f64::from(y)), ["0.3".into(), format!("0.{y}"), "<i>".into()]);
                canvas.say((9.0, f64::from(y)), ["0.5".into(), format!("0.{y}"), "<i>".into()]);
            });
        }
        canvas.marks_of(&[(Some("a"), (Mark::Circle, RED, (9.0, 10.0))), (None, (Mark::Plus, BLACK, (20.0, 20.0)))]);
        canvas
    }

    #[test]
    fn a_series_is_one_group_over_all_panels_below_its_marks() {
        let html = Drawing::of(&canvas()).figure("f", "c");
        assert!(html.contains("data-of=\"a|b\\|&lt;\" data-names=\"blur, px|RMSE, px|&lt;b&gt;\\|c\""), "{html}");
        let lines = "<g data-m=\"0\"><path stroke=\"#f00\" d=\"M1 10h8m-8 40h8\"/></g><g data-m=\"1\"><path";
        assert_eq!(html.matches(lines).count(), 1, "{html}");
        let place = |what: &str| html.find(what).unwrap_or_else(|| panic!("{what}: {html}"));
        assert!(place(lines) < place("<g data-m=\"0\"><path stroke=\"#fff\""), "the rim of a mark is above all lines");
        assert!(place("stroke=\"#000\"") < place(lines), "what belongs to nothing is below");
    }

    #[test]
    fn what_is_said_stands_at_its_place_and_repeats_nothing() {
        let html = Drawing::of(&canvas()).figure("f", "c");
        let said = "<g data-m=\"0\" data-p=\"1 10|0.3|0.10|&lt;i&gt;\n9 10|0.5||\n1 50|0.3|0.50|\n9 50|0.5||\"/>";
        assert_eq!(html.matches(said).count(), 1, "{html}");
    }

    #[test]
    fn a_picture_without_series_says_nothing_of_them() {
        let mut canvas = Canvas::new(10, 10);
        canvas.marks(&[(Mark::Circle, RED, (5.0, 5.0))]);
        let html = Drawing::of(&canvas).figure("f", "c");
        assert!(
            !html.contains("data-m") && !html.contains("data-of") && !html.contains("data-p") && !html.contains("data-names"),
            "{html}"
        );
    }
}
