//! Pictures of photographs beside their twin.

use crate::Canvas;
use crate::json::{TwinAnswer, TwinCurves};
use crate::markdown::plain;
use crate::plot::{Axis, Plot, Said, Shape};

/// Colours of photographs and twin.
const COLOURS: [usize; 2] = [1, 0];

/// Names of files, what they show, and the pictures.
pub fn pictures(twin: &TwinAnswer) -> Vec<(&'static str, &'static str, Canvas)> {
    let mut all = vec![(
        "operators.png",
        "Hold-out of each operator in the photographs and in their twin: on the line both are the same.",
        operators(twin),
    )];
    let curves = [
        ("profile.png", "The mean profile of edges across, 0 dark and 1 bright.", &twin.profile, ["across the edge, px", "level"]),
        (
            "noise.png",
            "Noise of the insides of squares against their level.",
            &twin.noise,
            ["grey level", "standard deviation, grey levels"],
        ),
    ];
    for (name, said, curves, axes) in curves {
        all.extend(drawn(name, said, curves, axes).map(|picture| (name, said, picture)));
    }
    all
}

fn operators(twin: &TwinAnswer) -> Canvas {
    let pairs = || twin.operators.iter().filter_map(|one| Some((one, one.held_out_px?, one.twin_held_out_px?)));
    let ends =
        pairs().fold((f64::INFINITY, 1e-3), |(low, high): (f64, f64), (_, own, twin)| (own.min(twin).min(low), own.max(twin).max(high)));
    let (low, high) = (0.8 * ends.0.min(ends.1), 1.25 * ends.1);
    let axis = |title: &str| Axis { log: true, ..Axis::linear(title, [low, high]) };
    let mut plot =
        Plot::new("operators", "Hold-out of operators", axis("hold-out in the photographs, px"), axis("hold-out in the twin, px"), 420.0);
    plot.series(5, None, &[""]);
    plot.line(&[(low, low), (high, high)], &Said::default());
    for (place, (one, own, twin)) in pairs().enumerate() {
        let shape = Shape::ALL[place % Shape::ALL.len()];
        plot.series(place, None, &["operator", "photographs", "twin"]);
        let name = if one.is_maker { format!("{} (made the twin)", one.method) } else { one.method.clone() };
        plot.legend(place, shape, &name, false);
        plot.symbol(shape, (own, twin), &Said::of([one.method.clone(), plain(own), plain(twin)]));
    }
    plot.picture("on the line: the twin predicts the photographs")
}

/// Curves of both; `None` where a picture would be empty.
fn drawn(name: &str, said: &str, curves: &TwinCurves, [x, y]: [&str; 2]) -> Option<Canvas> {
    let all = || curves.photographs.iter().chain(&curves.twin);
    let ends = |k: usize| {
        let (low, high) = all().map(|at| at[k]).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let aside = (0.05 * (high - low)).max(1e-6);
        (low <= high).then_some([low - aside, high + aside])
    };
    let [low, high] = ends(1)?;
    let upright = if name == "noise.png" { [0.0, high] } else { [low, high] };
    let mut plot = Plot::new(name.trim_end_matches(".png"), said, Axis::linear(x, ends(0)?), Axis::linear(y, upright), 380.0);
    for ((places, colour), (shape, title)) in
        [&curves.photographs, &curves.twin].into_iter().zip(COLOURS).zip([(Shape::Circle, "photographs"), (Shape::Cross, "twin")])
    {
        plot.series(colour, None, &["x", "y"]);
        plot.legend(colour, shape, title, false);
        for &[x, y] in places {
            plot.symbol(shape, (x, y), &Said::of([x, y].map(plain)));
        }
    }
    Some(plot.picture(""))
}
