use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;

use super::*;
use crate::Canvas;
use crate::canvas::Stroke;

#[test]
fn marks_are_where_their_values_are() {
    let mut plot = Plot::frame("f", "l", ImageSize { width: 101, height: 51 });
    assert_eq!(plot.place(plot.at(), (-0.5, -0.5)), (76.0, 30.0), "the outer corner of the first pixel");
    let (x, y) = plot.place(plot.at(), (100.5, 50.5));
    assert!((x - 836.0).abs() < 1e-9 && ((y - 30.0) - 760.0 * 51.0 / 101.0).abs() < 1e-9, "{x} {y}");
    plot.series(0, None, &["a"]);
    plot.arrow(PixelPoint::new(50.0, 25.0), (10.0, 5.0), &Said { values: vec!["1".into()], group: Some(2), key: Some(3) });
    let html = plot.figure("c");
    // The middle of the frame, and ten columns and five rows on: 760 / 101 px of the drawing each.
    assert!(html.contains("d=\"M456 221.88L531.25 259.5M"), "{html}");
    assert!(
        html.contains("data-t=\"1\" data-g=\"2\" data-k=\"3\"") && html.contains("data-x=\"-0.5 100.5\" data-y=\"-0.5 50.5\""),
        "{html}"
    );
    let log = Plot::new("g", "l", Axis { log: true, ..Axis::linear("x", [0.1, 10.0]) }, Axis::linear("y", [0.0, 4.0]), 200.0);
    let ((x, _), (_, y)) = (log.place(log.at(), (1.0, 0.0)), log.place(log.at(), (1.0, 1.0)));
    assert!((x - 456.0).abs() < 1e-9 && (y - 180.0).abs() < 1e-9, "y goes up: {x} {y}");
}

/// Everything that can be drawn, once.
fn all() -> Plot {
    let mut plot = Plot::new("f", "l", Axis::named("x", vec!["one".into(), "two".into()]), Axis::linear("y", [0.0, 10.0]), 380.0);
    plot.series(1, Some("method|a"), &["value"]);
    plot.cell([(0.0, 0.0), (0.5, 5.0)], Some([1, 2, 3]), &Said::of(["cell".to_owned()]));
    plot.symbol(Shape::Triangle, (1.0, 5.0), &Said { group: Some(4), ..Said::of(["7".to_owned()]) });
    plot.arrow(PixelPoint::new(0.0, 1.0), (1.0, 1.0), &Said { group: Some(5), ..Said::default() });
    plot.line(&[(0.0, 0.0), (1.0, 10.0)], &Said::default());
    plot.dashed(&[(0.0, 2.0), (1.0, 2.0)]);
    plot.contour(vec![[(0.0, 3.0), (0.5, 3.5)]]);
    plot.dots(vec![(0.25, 4.0)]);
    plot.ring((0.0, 6.0));
    plot.whisker(1.0, [7.0, 8.0], &Said::default());
    plot.note((0.5, 9.0), "note <b>", true);
    plot.tag((0.0, 9.0), "tag");
    plot.legend(1, Shape::Triangle, "method|a", true);
    plot.shades("px", &[(0.5, "half".into())]);
    plot
}

fn texts(canvas: &Canvas) -> Vec<&str> {
    canvas.strokes().iter().filter_map(|stroke| if let Stroke::Text(text) = stroke { Some(text.text.as_str()) } else { None }).collect()
}

#[test]
fn both_drawings_show_every_element() {
    let plot = all();
    let (html, canvas) = (plot.figure("c"), plot.picture("remark"));
    for class in ["cell", "mark", "arrow", "line", "dashed", "contour", "dots", "ring", "bar", "note dark", "note tag"] {
        assert!(html.contains(&format!("class=\"{class}\"")), "{class}: {html}");
    }
    for text in ["note &lt;b&gt;", "tag", "half", "one", "method|a"] {
        assert!(html.contains(&format!(">{text}<")) || html.contains(&format!("> {text}<")), "{text}: {html}");
    }
    let texts = texts(&canvas);
    for text in ["l", "note <b>", "tag", "half", "px", "one", "two", "x", "y", "method|a", "remark"] {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
    assert_eq!((canvas.series(), canvas.says()), (&["method|a".to_owned()][..], &["value".to_owned()][..]));
    // Without one element a picture has fewer strokes: none of them is drawn by another.
    let whole = canvas.strokes().len();
    for skipped in 1..plot.elements.len() {
        let mut less = plot.clone();
        less.elements.remove(skipped);
        assert!(less.picture("remark").strokes().len() < whole, "{:?}", plot.elements[skipped]);
        assert!(less.figure("c").len() < html.len(), "{:?}", plot.elements[skipped]);
    }
}

/// 900 px of a picture are 760 of a drawing, and the axes begin at (70, 50).
#[test]
fn a_picture_has_its_marks_where_the_page_has_them() {
    let canvas = all().picture("");
    let said = canvas.strokes().iter().find_map(|stroke| if let Stroke::Said(at, values) = stroke { Some((*at, values)) } else { None });
    assert_eq!(said, Some(((70 + 675, 50 + 225), &vec!["7".to_owned()])));
    let cell =
        canvas.strokes().iter().find_map(|stroke| if let Stroke::Rectangle(corners, _, true) = stroke { Some(*corners) } else { None });
    assert_eq!(cell, Some([(70 + 225, 50 + 225), (70 + 450, 50 + 450)]));
}

/// Half of the first arrow is outside at the right, the second one is as a whole.
#[test]
fn a_picture_draws_nothing_outside_its_axes() {
    let mut plot = Plot::frame("f", "l", ImageSize { width: 900, height: 450 });
    plot.series(1, None, &[]);
    plot.arrow(PixelPoint::new(859.5, 199.5), (80.0, 40.0), &Said::default());
    plot.arrow(PixelPoint::new(-100.0, 10.0), (50.0, 5.0), &Said::default());
    plot.line(&[(-80.5, 99.5), (9.5, 99.5), (9.5, 9.5)], &Said::default());
    let canvas = plot.picture("");
    let paths: Vec<&Vec<(i32, i32)>> = canvas
        .strokes()
        .iter()
        .filter_map(|stroke| if let Stroke::Path(path, pen) = stroke { (pen.colour.rgb != (0, 0, 0)).then_some(path) } else { None })
        .collect();
    assert_eq!(paths, [&vec![(930, 250), (970, 270)], &vec![(70, 150), (80, 150)], &vec![(80, 150), (80, 60)]]);
}

#[test]
fn panels_show_each_group_alone() {
    let groups = [(5, "five".to_owned()), (4, "four".to_owned()), (6, "six".to_owned())];
    let canvas = panels(&all(), &groups, "remark");
    assert_eq!(texts(&canvas).iter().filter(|text| ["five", "four", "six", "remark"].contains(text)).count(), 4);
    let lines =
        |stroke: &Stroke, from: (i32, i32)| matches!(stroke, Stroke::Path(path, _) if path.first() == Some(&from) && path.len() == 2);
    // The arrow from (0, 1): in the first panel of 300 x 150 px at (12, 36), and in no other.
    let arrows: Vec<bool> = [12, 324, 636].map(|left| canvas.strokes().iter().any(|stroke| lines(stroke, (left + 75, 36 + 135)))).to_vec();
    assert_eq!(arrows, [true, false, false]);
}

#[test]
fn a_figure_says_its_remark_once() {
    let figure = Figure { name: "f".into(), caption: "What it is.".into(), remark: "so many px".into(), plot: all() };
    assert!(figure.html().contains("<figcaption>What it is. So many px.</figcaption>"));
    assert_eq!(texts(&figure.picture()).iter().filter(|text| **text == "so many px").count(), 1);
    assert_eq!(figure.file(), "f.png");
}
