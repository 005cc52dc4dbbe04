//! The strength around a corner as in the paper's Fig. 1: a map and a surface of 7 x 7 pixels.

use calibench_model::PixelPoint;
use calibench_records::theory::{HALF as HALF_SIDE, SIDE, Strengths};
use plotters::prelude::*;

use super::part::{OPERATOR, Part, theory_of};
use crate::canvas::{Canvas, Mark};
use crate::field::shade;
use crate::figures::Layer;
use crate::load::{LoadError, Loaded};
use crate::markdown::fixed;
use crate::scene_figures::targets;

/// The image that is shown: the solid right angle.
const SHOWN: &str = "h";
/// Half the side of what is shown, px.
const HALF: i64 = HALF_SIDE as i64;
const CELL: u32 = 64;
const LEFT: u32 = 90;
const TOP: u32 = 60;

/// A corner's strengths with what is marked in them.
struct Peak {
    values: [[f64; SIDE]; SIDE],
    /// The largest of them.
    most: f64,
    pixel: (i64, i64),
    refined: PixelPoint,
    truth: PixelPoint,
}

/// The section on the strengths of `loaded`, where its records hold them.
///
/// # Errors
/// Records that cannot be read.
pub(super) fn section(loaded: &Loaded) -> Result<Option<Part>, LoadError> {
    let found = theory_of(loaded)?.and_then(|(label, all)| {
        let shown = all.into_iter().find(|theory| theory.target == SHOWN)?;
        Some(part(loaded, label, &peak(loaded, shown.strengths?)?))
    });
    Ok(found)
}

fn peak(loaded: &Loaded, Strengths { pixel, values, maximum }: Strengths) -> Option<Peak> {
    let view = &loaded.first.points.first()?.view;
    let (_, truth) = targets(loaded, view).into_iter().find(|(id, _)| id == SHOWN)?;
    Some(Peak { most: values[HALF_SIDE][HALF_SIDE], values, pixel, refined: maximum?, truth })
}

fn part(loaded: &Loaded, label: &str, peak: &Peak) -> Part {
    let text = format!(
        "## The strength around a corner\n\nHarris strength of 7 x 7 pixels at the solid right angle ({SHOWN}) of `{}` (`{}`), in units of its largest value, {:.3e} (grey values as fractions of full \
         scale, to the fourth power per px^4): the paper's Fig. 1. The dark area lies to the upper right; the maximum lies inside it, {:.2} px from the corner, and the paraboloid finds that \
         maximum well. The method is exact for what it looks for; what it looks for is not the corner.\n\n![Harris strength around a right angle, as a map and as a surface](strength.png)\n\n",
        loaded.name,
        label,
        peak.most,
        peak.refined.distance(peak.truth)
    );
    (text, Some(("strength.png".into(), picture(peak))))
}

fn picture(peak: &Peak) -> Canvas {
    let side = SIDE as u32 * CELL;
    let mut canvas = Canvas::new(LEFT + side + 640, TOP + side + 110);
    map(&mut canvas, peak);
    surface(&mut canvas, peak, LEFT + side + 30, side + TOP);
    canvas
}

fn map(canvas: &mut Canvas, peak: &Peak) {
    let count = SIDE;
    let corner = |column: usize, row: usize| ((LEFT + column as u32 * CELL) as i32, (TOP + row as u32 * CELL) as i32);
    canvas.paint(|area| {
        for (row, column) in (0..count).flat_map(|row| (0..count).map(move |column| (row, column))) {
            let part = peak.values[row][column] / peak.most;
            let ends = [corner(column, row), corner(column + 1, row + 1)];
            area.draw(&Rectangle::new(ends, shade(part).filled())).ok();
        }
    });
    for (row, column) in (0..count).flat_map(|row| (0..count).map(move |column| (row, column))) {
        let (x, y) = corner(column, row);
        canvas.label(&fixed(peak.values[row][column] / peak.most, 2), 15, (x as u32 + 17, y as u32 + CELL - 11));
    }
    for index in 0..count {
        let (x, y) = corner(index, index);
        canvas.text(&format!("{}", peak.pixel.0 - HALF + index as i64), 15, (x as u32 + CELL / 2 - 12, TOP + count as u32 * CELL + 14));
        canvas.text(&format!("{}", peak.pixel.1 - HALF + index as i64), 15, (LEFT - 36, y as u32 + CELL / 2));
    }
    let place = |at: PixelPoint| {
        let along = |value: f64, pixel: i64, origin: u32| f64::from(origin) + (value - (pixel - HALF) as f64 + 0.5) * f64::from(CELL);
        (along(at.x, peak.pixel.0, LEFT), along(at.y, peak.pixel.1, TOP))
    };
    let pixel = PixelPoint::new(peak.pixel.0 as f64, peak.pixel.1 as f64);
    let refined = Layer::methods(std::iter::once(OPERATOR)).remove(0);
    let marks = [
        (Mark::Plus, BLACK, peak.truth, "true corner"),
        (Mark::Square, BLACK, pixel, "strongest pixel"),
        (refined.mark, refined.colour, peak.refined, "maximum of the paraboloid"),
    ];
    canvas.marks(&marks.map(|(mark, colour, at, _)| (mark, colour, place(at))));
    canvas.text("Harris strength / largest (number at each pixel)", 17, (LEFT, TOP - 30));
    canvas.text("y, px", 16, (LEFT - 84, TOP + 8));
    let below = TOP + count as u32 * CELL;
    canvas.text("x, px", 16, (LEFT + count as u32 * CELL / 2 - 20, below + 40));
    for (index, (mark, colour, _, name)) in (0_u32..).zip(marks) {
        let x = LEFT + 16 + index * 172;
        canvas.marks(&[(mark, colour, (f64::from(x), f64::from(below + 78)))]);
        canvas.text(name, 16, (x + 18, below + 78));
    }
}

fn surface(canvas: &mut Canvas, peak: &Peak, left: u32, height: u32) {
    let value = |x: i64, y: i64| peak.values[(y + HALF) as usize][(x + HALF) as usize] / peak.most;
    let least = (-HALF..=HALF).flat_map(|y| (-HALF..=HALF).map(move |x| (x, y))).map(|(x, y)| value(x, y)).fold(0.0, f64::min);
    canvas.paint(|area| {
        let (_, right) = area.split_horizontally(left as i32);
        let (upper, _) = right.split_vertically(height as i32);
        let half = HALF as f64;
        // The builder's vertical axis is its second.
        let chart = ChartBuilder::on(&upper).margin(20).margin_top(TOP).build_cartesian_3d(-half..half, least..1.0, -half..half);
        let Ok(mut chart) = chart else { return };
        chart.with_projection(|mut projection| {
            (projection.yaw, projection.pitch, projection.scale) = (0.6, 0.45, 0.8);
            projection.into_matrix()
        });
        chart
            .configure_axes()
            .light_grid_style(BLACK.mix(0.15))
            .max_light_lines(2)
            .x_labels(7)
            .y_labels(5)
            .z_labels(7)
            .x_formatter(&|x| format!("{x:+.0}"))
            .z_formatter(&|y| format!("{y:+.0}"))
            .label_style(("sans-serif", 14))
            .draw()
            .ok();
        let at = |x: i64, y: i64| (x as f64, value(x, y), y as f64);
        for (x, y) in (-HALF..HALF).flat_map(|y| (-HALF..HALF).map(move |x| (x, y))) {
            let corners = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            let part = corners.iter().map(|corner| corner.1).sum::<f64>() / 4.0;
            chart.draw_series([Polygon::new(corners, shade(part).mix(0.85).filled())]).ok();
            chart.draw_series([PathElement::new([corners[0], corners[1], corners[2], corners[3], corners[0]], BLACK.mix(0.6))]).ok();
        }
    });
    canvas.text("The same as a surface; x and y from the strongest pixel", 17, (left + 30, TOP - 30));
    canvas.text("strength / largest", 16, (left + 30, TOP + 40));
    canvas.text("x, px", 16, (left + 170, height - 30));
    canvas.text("y, px", 16, (left + 470, height - 60));
}
