//! A board and the poses in which cameras see it.

use calibench_records::description::{Description, Station, Views};
use nalgebra::{Point3, Vector3};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::Canvas;
use crate::axes::Axes;
use crate::canvas::{COLOURS, Mark};
use crate::field::{Area, arrow, write};
use crate::labels::{Names, along};
use crate::sides::{Side, Sides, around};

pub(crate) const CAPTION: &str =
    "The board and where cameras see it from, each with its line of sight: from the front, from the side and from above, to one scale";

/// Fewer stations are no set of poses.
const FEWEST: usize = 3;
/// How far targets may lie off their plane, as a share of the board's size.
const FLAT: f64 = 1e-3;
/// The picture's longest way across, object to px of the picture.
const WIDTH: f64 = 520.0;
/// Length of a line of sight, as a share of what is drawn across.
const SIGHT: f64 = 0.12;
/// Around the stations, as a share of what is drawn across.
const ROOM: f64 = 0.08;
const LEFT: i32 = 80;
const TOP: i32 = 80;
const GAP: i32 = 110;

/// The picture of a scenario with one chessboard and some stations; `None` for another.
pub(crate) fn of(scenario: &Description) -> Option<Canvas> {
    let views = scenario.study.views()?;
    is_board(views).then(|| picture(views)).flatten()
}

/// Whether all targets are corners of one flat board that is seen from some places.
pub(crate) fn is_board(views: &Views) -> bool {
    let (Some(normal), Some(first)) = (views.normal.map(Vector3::from), views.targets.first()) else { return false };
    let from_first = |at: &[f64; 3]| Vector3::from(*at) - Vector3::from(first.surveyed);
    let size = views.targets.iter().map(|target| from_first(&target.surveyed).norm()).fold(0.0, f64::max);
    let flat = |at: &[f64; 3]| from_first(at).dot(&normal).abs() <= FLAT * size;
    let corner = |kind: &str| kind == "chess_corner";
    views.stations.len() >= FEWEST && views.targets.iter().all(|target| corner(&target.kind) && flat(&target.surveyed))
}

/// A view of the board: what runs to the right and what upwards.
struct Drawing {
    title: &'static str,
    right: Side,
    up: Side,
    axes: Axes,
}

/// The three drawings of a board, to one scale.
fn drawings(views: &Views, ends: &[[f64; 3]; 2]) -> Option<[Drawing; 3]> {
    let Sides { across, up, towards } = Sides::of(views.normal?, ends);
    let away = towards.reversed();
    let all = || views.stations.iter().map(|station| &station.centre).chain(ends);
    let wide = |side: Side| side.span(all()).into_iter().rev().reduce(|high, low| high - low).unwrap_or(1.0);
    let room = ROOM * wide(across);
    let span = |side: Side| {
        let [low, high] = side.span(all());
        [low - room, high + room]
    };
    let scale = WIDTH / (wide(across) + 2.0 * room);
    let px = |side: Side| (scale * (wide(side) + 2.0 * room)).round() as i32;
    // As in a technical drawing: the view from the side beside the front, the one from above below it.
    let (second, below) = (LEFT + px(across) + GAP, TOP + px(up) + GAP);
    let drawing = |title, right: Side, up: Side, (left, top)| {
        let axes = Axes { at: [left, top, px(right), px(up)], x: span(right), y: span(up) };
        Drawing { title, right, up, axes }
    };
    Some([
        drawing("From the front", across, up, (LEFT, TOP)),
        drawing("From the side", towards, up, (second, TOP)),
        drawing("From above", across, away, (LEFT, below)),
    ])
}

fn picture(views: &Views) -> Option<Canvas> {
    let ends = around(views)?;
    let drawings = drawings(views, &ends)?;
    let [_, side, above] = drawings.each_ref().map(|drawing| drawing.axes.at);
    let mut canvas = Canvas::new((side[0] + side[2] + 40) as u32, (above[1] + above[3] + 70) as u32);
    let [left, right] = drawings[0].axes.x;
    for drawing in &drawings {
        draw(&mut canvas, drawing, views, &ends, SIGHT * (right - left));
    }
    legend(&mut canvas, (side[0], above[1]));
    Some(canvas)
}

fn draw(canvas: &mut Canvas, drawing: &Drawing, views: &Views, ends: &[[f64; 3]; 2], length: f64) {
    let Drawing { title, right, up, axes } = drawing;
    let place = |at: &[f64; 3]| axes.place(right.of(at), up.of(at));
    let sight = |station: &Station| {
        let to: [f64; 3] = (Point3::from(station.centre) + Vector3::from(station.sight) * length).into();
        [place(&station.centre), place(&to)]
    };
    let sights: Vec<[(i32, i32); 2]> = views.stations.iter().map(sight).collect();
    canvas.text(title, 18, (axes.at[0] as u32, (axes.at[1] - 40) as u32));
    canvas.paint(|area| {
        axes.vertical(area, &up.title(&views.unit));
        axes.horizontal(area, &right.title(&views.unit));
        board(area, ends.each_ref().map(place));
        sights.iter().for_each(|[from, to]| arrow(area, *from, *to));
    });
    let marks: Vec<_> = views.stations.iter().map(|station| place(&station.centre)).collect();
    canvas.marks(&marks.iter().map(|(x, y)| (Mark::Circle, COLOURS[1], (f64::from(*x), f64::from(*y)))).collect::<Vec<_>>());
    let named = views.stations.iter().zip(marks).map(|(station, (x, y))| (station.name.as_str(), (f64::from(x), f64::from(y))));
    Names { named: named.collect(), others: sights.iter().flat_map(along).collect() }.write(canvas, axes, 13);
}

/// The board, or its edge.
fn board(area: &Area<'_>, [a, b]: [(i32, i32); 2]) {
    let (left, right, up, down) = (a.0.min(b.0), a.0.max(b.0), a.1.min(b.1), a.1.max(b.1));
    // An edge is drawn so wide that it is seen.
    let widen = |low: i32, high: i32| if high - low < 4 { (low - 2, high + 2) } else { (low, high) };
    let ((left, right), (up, down)) = (widen(left, right), widen(up, down));
    area.draw(&Rectangle::new([(left, up), (right, down)], COLOURS[0].mix(0.45).filled())).ok();
    area.draw(&Rectangle::new([(left, up), (right, down)], COLOURS[0])).ok();
}

fn legend(canvas: &mut Canvas, (left, top): (i32, i32)) {
    canvas.marks(&[(Mark::Circle, COLOURS[1], (f64::from(left + 14), f64::from(top + 14)))]);
    canvas.paint(|area| {
        write(area, "camera, with its line of sight", (left + 34, top + 14), HPos::Left);
        board(area, [(left + 4, top + 32), (left + 24, top + 46)]);
        write(area, "board", (left + 34, top + 39), HPos::Left);
    });
}

#[cfg(test)]
mod tests {
    use calibench_records::description::Target;

    use super::*;

    /// A board of 240 x 150 mm in the plane of X and Y, seen from three places before it.
    fn views() -> Views {
        let corner = |x: f64, y: f64| Target { id: "a".into(), kind: "chess_corner".into(), surveyed: [x, y, 0.0], role: None };
        let station = |centre| Station { name: "1".into(), centre, sight: [0.0, 0.0, -1.0], second_step: false };
        Views {
            size: [4000, 3000],
            unit: "mm".into(),
            extent: Some([[-120.0, -75.0, 0.0], [120.0, 75.0, 0.0]]),
            normal: Some([0.0, 0.0, 1.0]),
            stations: [[300.0, 0.0, 600.0], [-400.0, 200.0, 700.0], [0.0, -300.0, 500.0]].map(station).into(),
            targets: vec![corner(-90.0, -60.0), corner(90.0, -60.0), corner(0.0, 60.0)],
            room: None,
        }
    }

    #[test]
    fn three_views_of_a_flat_chessboard_are_poses() {
        assert!(is_board(&views()));
        let two = Views { stations: views().stations[..2].to_vec(), ..views() };
        assert!(!is_board(&two));
        let with = |change: fn(&mut Target)| {
            let mut changed = views();
            change(&mut changed.targets[2]);
            is_board(&changed)
        };
        assert!(!with(|target| target.kind = "disc".into()) && !with(|target| target.surveyed[2] = 5.0));
        assert!(!is_board(&Views { targets: Vec::new(), ..views() }) && picture(&views()).is_some());
    }

    /// A millimetre is as long in all drawings and directions, and stations stand where a viewer expects them.
    #[test]
    fn drawings_have_one_scale_and_stand_as_in_a_technical_drawing() {
        let views = views();
        let [front, side, above] = drawings(&views, &views.extent.unwrap()).unwrap();
        for axes in [&front, &side, &above].map(|drawing| drawing.axes) {
            let scale = |px: i32, [low, high]: [f64; 2]| f64::from(px) / (high - low);
            let all = [scale(axes.at[2], axes.x), scale(axes.at[3], axes.y), scale(front.axes.at[2], front.axes.x)];
            assert!(all.iter().all(|one| (one / all[0] - 1.0).abs() < 0.005), "{all:?}");
        }
        let place = |drawing: &Drawing, at: [f64; 3]| drawing.axes.place(drawing.right.of(&at), drawing.up.of(&at));
        let (board, high) = ([0.0; 3], [-400.0, 200.0, 700.0]);
        assert!(place(&front, high).0 < place(&front, board).0 && place(&front, high).1 < place(&front, board).1, "left of and above it");
        assert!(place(&side, high).0 > place(&side, board).0 && place(&side, high).1 == place(&front, high).1, "before it, as high");
        assert!(place(&above, high).1 > place(&above, board).1 && place(&above, high).0 == place(&front, high).0, "before it, as far left");
    }
}
