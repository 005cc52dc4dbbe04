//! The principal point from halves, from all but one, and from all.

use calibench_records::judgement::Principal;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::canvas::{COLOURS, Canvas, Mark};
use crate::field::write;
use crate::plain;

const SIDE: i32 = 520;
const LEFT: i32 = 80;
const TOP: i32 = 40;
const BELOW: i32 = 180;
/// Half axes of the ellipse that holds 95 % of a normal distribution in the plane, in standard deviations.
pub const NINETY_FIVE: f64 = 2.4477;

/// The standard deviations of a half's point as predicted, x and y, px, and how far around the middle what is shown reaches, px.
pub fn extent(principal: &Principal) -> ((f64, f64), f64) {
    let all = principal.all;
    let halves = || principal.halves.iter().flatten();
    let mean = |axis: usize| (halves().map(|half| half[axis].1.powi(2)).sum::<f64>() / halves().count().max(1) as f64).sqrt();
    let half = (mean(0), mean(1));
    let points = halves().chain(&principal.without);
    let off = points.map(|point| (point[0].0 - all[0].0).abs().max((point[1].0 - all[1].0).abs())).fold(0.0, f64::max);
    (half, 1.08 * off.max(NINETY_FIVE * half.0.max(half.1)).max(NINETY_FIVE * all[0].1.max(all[1].1)).max(1e-9))
}

/// A scatter with predicted ellipses. Their axes are those of the frame: x and y hardly depend on each other.
pub fn picture(principal: &Principal) -> Canvas {
    let all = principal.all;
    let middle = (all[0].0, all[1].0);
    let halves: Vec<_> = principal.halves.iter().flatten().collect();
    let (half, reach) = extent(principal);
    let at = |x: f64, y: f64| {
        let part = |value: f64| f64::from(SIDE) * (0.5 + 0.5 * value / reach);
        (f64::from(LEFT) + part(x - middle.0), f64::from(TOP) + part(y - middle.1))
    };
    let mut canvas = Canvas::new((LEFT + SIDE + 60) as u32, (TOP + SIDE + BELOW) as u32);
    let whole = |(x, y): (f64, f64)| (x.round() as i32, y.round() as i32);
    canvas.paint(|area| {
        for i in 0..=4 {
            let part = f64::from(i) / 2.0 - 1.0;
            let (x, _) = whole(at(middle.0 + part * reach, middle.1));
            let (_, y) = whole(at(middle.0, middle.1 + part * reach));
            area.draw(&PathElement::new([(x, TOP), (x, TOP + SIDE)], RGBColor(225, 225, 225))).ok();
            area.draw(&PathElement::new([(LEFT, y), (LEFT + SIDE, y)], RGBColor(225, 225, 225))).ok();
            write(area, &format!("{:.1}", middle.0 + part * reach), (x, TOP + SIDE + 16), HPos::Center);
            write(area, &format!("{:.1}", middle.1 + part * reach), (LEFT - 8, y), HPos::Right);
        }
        area.draw(&Rectangle::new([(LEFT, TOP), (LEFT + SIDE, TOP + SIDE)], BLACK)).ok();
        for (sigma, colour) in [(half, COLOURS[1]), ((all[0].1, all[1].1), BLACK)] {
            let ellipse = (0..=72).map(|i| {
                let (sine, cosine) = (f64::from(i) * std::f64::consts::TAU / 72.0).sin_cos();
                whole(at(middle.0 + NINETY_FIVE * sigma.0 * cosine, middle.1 + NINETY_FIVE * sigma.1 * sine))
            });
            area.draw(&PathElement::new(ellipse.collect::<Vec<_>>(), ShapeStyle::from(&colour).stroke_width(2))).ok();
        }
        write(area, "x, px", (LEFT + SIDE / 2, TOP + SIDE + 38), HPos::Center);
        write(area, "y, px", (LEFT - 8, TOP - 18), HPos::Right);
    });
    let mut marks: Vec<_> = halves.iter().map(|point| (Mark::Circle, COLOURS[1], at(point[0].0, point[1].0))).collect();
    marks.extend(principal.without.iter().map(|point| (Mark::Cross, COLOURS[0], at(point[0].0, point[1].0))));
    marks.push((Mark::Plus, BLACK, at(middle.0, middle.1)));
    canvas.marks(&marks);
    let key = [
        (Mark::Circle, COLOURS[1], format!("from a half; 95 % ellipse as predicted ({} px, {} px)", plain(half.0), plain(half.1))),
        (Mark::Cross, COLOURS[0], "from all photographs but those of a fold".into()),
        (Mark::Plus, BLACK, format!("from all; 95 % ellipse as predicted ({} px, {} px)", plain(all[0].1), plain(all[1].1))),
    ];
    for (index, (mark, colour, text)) in (0..).zip(key) {
        let y = TOP + SIDE + 72 + index * 32;
        canvas.marks(&[(mark, colour, (f64::from(LEFT), f64::from(y)))]);
        canvas.text(&text, 16, ((LEFT + 24) as u32, y as u32));
    }
    canvas
}
