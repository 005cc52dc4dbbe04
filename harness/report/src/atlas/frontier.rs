//! Accuracy against speed: every method as a point, the ones that nobody beats in both joined by a line.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::canvas::{COLOURS, Canvas, Mark};
use crate::field::{Area, write};
use crate::labels::{Box2, place};
use crate::markdown::plain;
use crate::ticks;

/// A method with its speed and error.
#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    /// Name and setting.
    pub name: String,
    /// Points per second.
    pub speed: f64,
    /// RMSE, px.
    pub rmse: f64,
}

/// The places of those that no other one beats: none is at least as fast and at least as exact, and better in one of both. From the slowest to the fastest.
pub fn front(spots: &[Spot]) -> Vec<usize> {
    let beats = |a: &Spot, b: &Spot| a.speed >= b.speed && a.rmse <= b.rmse && (a.speed > b.speed || a.rmse < b.rmse);
    let mut front: Vec<usize> = (0..spots.len()).filter(|&index| !spots.iter().any(|other| beats(other, &spots[index]))).collect();
    front.sort_by(|&a, &b| spots[a].speed.total_cmp(&spots[b].speed));
    front
}

const INSIDE: (f64, f64) = (1150.0, 760.0);
const LEFT: f64 = 90.0;
const TOP: f64 = 60.0;
const RIGHT: f64 = 30.0;
const BOTTOM: f64 = 70.0;

/// A logarithmic scale over whole decades and their 1, 2, 5.
struct Decades {
    low: f64,
    high: f64,
}

impl Decades {
    fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let (low, high) = (values.clone().fold(f64::INFINITY, f64::min), values.fold(0.0, f64::max));
        // Room for labels at both ends.
        Self { low: low / 2.0, high: high * 2.0 }
    }

    fn part(&self, value: f64) -> f64 {
        (value / self.low).ln() / (self.high / self.low).ln()
    }

    fn ticks(&self) -> Vec<f64> {
        ticks::decades(self.low, self.high, &[1.0, 2.0, 5.0])
    }
}

/// Where points and labels are, px of the picture.
pub struct Plan {
    points: Vec<(f64, f64)>,
    /// The boxes of the labels.
    pub labels: Vec<Option<Box2>>,
}

/// Lays the points and their labels out.
pub fn plan(spots: &[Spot]) -> Plan {
    let (x, y) = scales(spots);
    let at = |spot: &Spot| (LEFT + x.part(spot.speed) * INSIDE.0, TOP + (1.0 - y.part(spot.rmse)) * INSIDE.1);
    let points: Vec<(f64, f64)> = spots.iter().map(at).collect();
    let sizes: Vec<(f64, f64)> = spots.iter().map(|spot| (spot.name.chars().count() as f64 * 8.6 + 6.0, 20.0)).collect();
    let area = Box2 { x: LEFT + 4.0, y: TOP + 4.0, width: INSIDE.0 - 8.0, height: INSIDE.1 - 8.0 };
    let labels = place(&points, &sizes, area);
    Plan { points, labels }
}

fn scales(spots: &[Spot]) -> (Decades, Decades) {
    (Decades::of(spots.iter().map(|spot| spot.speed)), Decades::of(spots.iter().map(|spot| spot.rmse)))
}

/// The picture; lower and further to the right is better.
pub fn picture(spots: &[Spot], title: &str) -> Canvas {
    let mut canvas = Canvas::new((LEFT + INSIDE.0 + RIGHT) as u32, (TOP + INSIDE.1 + BOTTOM) as u32);
    canvas.text(title, 18, (LEFT as u32, 20));
    if spots.is_empty() {
        return canvas;
    }
    let (plan, front, (x, y)) = (plan(spots), front(spots), scales(spots));
    let whole = |(x, y): (f64, f64)| (x.round() as i32, y.round() as i32);
    canvas.paint(|area: &Area<'_>| {
        let grey = RGBColor(225, 225, 225);
        for tick in x.ticks() {
            let at = LEFT + x.part(tick) * INSIDE.0;
            area.draw(&PathElement::new([whole((at, TOP)), whole((at, TOP + INSIDE.1))], grey)).ok();
            write(area, &short(tick), whole((at, TOP + INSIDE.1 + 18.0)), HPos::Center);
        }
        for tick in y.ticks() {
            let at = TOP + (1.0 - y.part(tick)) * INSIDE.1;
            area.draw(&PathElement::new([whole((LEFT, at)), whole((LEFT + INSIDE.0, at))], grey)).ok();
            write(area, &format!("{}", (tick * 1e9).round() / 1e9), whole((LEFT - 8.0, at)), HPos::Right);
        }
        area.draw(&Rectangle::new([whole((LEFT, TOP)), whole((LEFT + INSIDE.0, TOP + INSIDE.1))], BLACK)).ok();
        write(area, "points per second, one thread", whole((LEFT + INSIDE.0 / 2.0, TOP + INSIDE.1 + 46.0)), HPos::Center);
        write(area, "RMSE, px", whole((LEFT, TOP - 14.0)), HPos::Left);
        let line: Vec<(i32, i32)> = front.iter().map(|&index| whole(plan.points[index])).collect();
        area.draw(&PathElement::new(line, ShapeStyle::from(&COLOURS[0]).stroke_width(2))).ok();
    });
    canvas.say_as(["method", "points per second, one thread", "RMSE, px"]);
    for ((spot, point), label) in spots.iter().zip(&plan.points).zip(&plan.labels) {
        canvas.of(Some(&spot.name), |canvas| {
            canvas.say(*point, [spot.name.clone(), short(spot.speed), plain(spot.rmse)]);
            let Some(label) = label else { return };
            let near = (point.0.clamp(label.x, label.x + label.width), point.1.clamp(label.y, label.y + label.height));
            canvas.paint(|area| {
                area.draw(&PathElement::new([whole(*point), whole(near)], RGBColor(150, 150, 150))).ok();
            });
        });
    }
    let mark = |index: usize| if front.contains(&index) { (Mark::Circle, COLOURS[0]) } else { (Mark::Cross, COLOURS[1]) };
    let own = |index: usize| (Some(&*spots[index].name), (mark(index).0, mark(index).1, plan.points[index]));
    canvas.marks_of(&(0..spots.len()).map(own).collect::<Vec<_>>());
    for (spot, label) in spots.iter().zip(&plan.labels) {
        if let Some(label) = label {
            let at = ((label.x + 3.0) as u32, (label.y + label.height / 2.0) as u32);
            canvas.of(Some(&spot.name), |canvas| canvas.label(&spot.name, 16, at));
        }
    }
    canvas
}

/// 1000 as 1k, 2000000 as 2M.
pub fn short(value: f64) -> String {
    let (value, unit) = if value >= 1e6 {
        (value / 1e6, "M")
    } else if value >= 1e3 {
        (value / 1e3, "k")
    } else {
        (value, "")
    };
    format!("{}{unit}", (value * 100.0).round() / 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spot(speed: f64, rmse: f64) -> Spot {
        Spot { name: format!("method:window={speed}"), speed, rmse }
    }

    #[test]
    fn the_front_holds_those_that_nobody_beats() {
        let spots = [spot(100.0, 0.01), spot(1000.0, 0.02), spot(900.0, 0.03), spot(50.0, 0.01), spot(5000.0, 0.5), spot(1000.0, 0.02)];
        assert_eq!(front(&spots), [0, 1, 5, 4], "equals stand beside each other, the slower of equal error does not");
        assert!(front(&[]).is_empty());
    }

    #[test]
    fn every_spot_has_a_label_of_its_own() {
        let spots: Vec<Spot> = (0..24).map(|i| spot(1e4 * 1.02_f64.powi(i * 7 % 5), 0.02 * 1.03_f64.powi(i * 5 % 7))).collect();
        let labels: Vec<Box2> = plan(&spots).labels.into_iter().map(|label| label.expect("room")).collect();
        for (i, label) in labels.iter().enumerate() {
            assert!(labels[..i].iter().all(|other| !label.overlaps(other)));
        }
    }

    /// A picture of three methods over whole decades: 100 to 10000 points a second, 0.001 to 0.1 px. The first two are the front.
    fn drawn() -> (image::RgbImage, Plan) {
        let of = |name: &str, speed, rmse| Spot { name: name.into(), speed, rmse };
        let spots = [of("slow", 200.0, 0.002), of("fast", 5000.0, 0.05), of("beaten", 1000.0, 0.05)];
        let mut png = Vec::new();
        picture(&spots, "title").encode(&mut png).unwrap();
        (image::load_from_memory(&png).unwrap().to_rgb8(), plan(&spots))
    }

    fn is(image: &image::RgbImage, (x, y): (u32, u32), colour: RGBColor) -> bool {
        image.get_pixel(x, y).0 == [colour.0, colour.1, colour.2]
    }

    /// The box (left, top, right, bottom) of what is darker than grey within the ranges.
    fn dark(image: &image::RgbImage, x: std::ops::Range<u32>, y: std::ops::Range<u32>) -> Option<[u32; 4]> {
        let all =
            y.flat_map(|y| x.clone().map(move |x| (x, y))).filter(|(x, y)| image.get_pixel(*x, *y).0.iter().all(|level| *level < 120));
        all.fold(None, |found, (x, y)| {
            let [left, top, right, bottom] = found.unwrap_or([x, y, x, y]);
            Some([left.min(x), top.min(y), right.max(x), bottom.max(y)])
        })
    }

    fn middle([left, top, right, bottom]: [u32; 4]) -> (f64, f64) {
        (f64::from(left + right) / 2.0, f64::from(top + bottom) / 2.0)
    }

    /// Two decades of 1150 px and of 760 px: 2 lies log 2 / 2 = 0.1505 of the way, 5 at 0.3495.
    #[test]
    fn lines_stand_at_one_two_and_five_of_each_decade() {
        let (image, _) = drawn();
        assert_eq!(image.dimensions(), (1270, 890));
        let grey = RGBColor(225, 225, 225);
        let columns: Vec<u32> = (0..1270).filter(|x| is(&image, (*x, 300), grey)).collect();
        assert_eq!(columns, [263, 492, 665, 838, 1067]);
        let rows: Vec<u32> = (0..890).filter(|y| is(&image, (400, *y), grey)).collect();
        assert_eq!(rows, [174, 326, 440, 554, 706]);
        for (x, y) in [(90, 300), (1240, 300), (400, 60), (400, 820)] {
            assert!(is(&image, (x, y), BLACK), "the frame at {x}, {y}");
        }
        assert!(
            (855..890).all(|y| is(&image, (492, y), WHITE)) && (1242..1270).all(|x| is(&image, (x, 326), WHITE)),
            "lines end at the frame"
        );
    }

    #[test]
    fn scales_are_lettered_below_and_on_the_left() {
        let (image, _) = drawn();
        for (x, width) in [(492, 40), (665, 40), (838, 40)] {
            let (found, height) = middle(dark(&image, x - width..x + width, 823..855).expect("a number"));
            assert!((found - f64::from(x)).abs() < 4.0 && (height - 838.0).abs() < 4.0, "{found} {height}");
        }
        for y in [326, 440, 554] {
            let found = dark(&image, 0..89, y - 15..y + 15).expect("a number");
            assert!((72..=82).contains(&found[2]) && (middle(found).1 - f64::from(y)).abs() < 4.0, "{found:?}");
        }
        let below = middle(dark(&image, 300..1200, 856..885).expect("points per second"));
        assert!((below.0 - 665.0).abs() < 4.0 && (below.1 - 866.0).abs() < 5.0, "{below:?}");
        let above = dark(&image, 86..600, 35..58).expect("RMSE, px");
        assert!((89..94).contains(&above[0]) && (middle(above).1 - 46.0).abs() < 5.0, "{above:?}");
    }

    #[test]
    fn the_front_is_joined_and_the_others_are_crosses() {
        let (image, plan) = drawn();
        let near = |(x, y): (u32, u32), colour| (x - 2..=x + 2).any(|x| (y - 2..=y + 2).any(|y| is(&image, (x, y), colour)));
        assert!(near((665, 440), COLOURS[0]) && near((464, 573), COLOURS[0]) && near((866, 307), COLOURS[0]), "from end to end");
        assert!(near((269, 706), COLOURS[0]) && near((1073, 174), COLOURS[0]), "circles");
        assert!(is(&image, (665, 174), COLOURS[1]) && near((671, 180), COLOURS[1]), "a cross");
        for label in plan.labels.iter().flatten() {
            let (left, top) = (label.x.round() as u32, label.y.round() as u32);
            let found = dark(&image, left..left + label.width as u32 + 40, top..top + 20).expect("a name");
            assert!((3..8).contains(&(found[0] - left)), "{found:?} in {label:?}");
            assert!((middle(found).1 - label.y - 10.0).abs() < 5.0, "{found:?} in {label:?}");
            assert!(f64::from(found[2]) < label.x + label.width, "a name fits: {found:?} in {label:?}");
            assert!(f64::from(found[2] - found[0]) > label.width / 3.0, "and has no more room than it needs: {found:?} in {label:?}");
        }
    }

    #[test]
    fn labels_stay_within_the_frame() {
        let crowd = |speed: f64, rmse: f64| (0..30).map(move |_| spot(speed, rmse));
        let spots: Vec<Spot> = crowd(1.0, 1e-6).chain(crowd(1e9, 1.0)).chain(crowd(1.0, 1.0)).chain(crowd(1e9, 1e-6)).collect();
        let labels = plan(&spots).labels;
        assert!(labels.iter().all(Option::is_some), "there is room for all");
        for label in labels.iter().flatten() {
            assert!(label.x >= 94.0 && label.x + label.width <= 1236.0 && label.y >= 64.0 && label.y + label.height <= 816.0, "{label:?}");
        }
    }

    #[test]
    fn large_numbers_are_shortened() {
        let numbers = [1.0, 0.25, 999.0, 1000.0, 1500.0, 12_340.0, 1e6, 2.5e6];
        assert_eq!(numbers.map(short), ["1", "0.25", "999", "1k", "1.5k", "12.34k", "1M", "2.5M"]);
    }

    #[test]
    fn nothing_to_show_is_a_blank_picture() {
        let mut png = Vec::new();
        picture(&[], "").encode(&mut png).unwrap();
        assert!(image::load_from_memory(&png).unwrap().to_rgb8().pixels().all(|pixel| pixel.0 == [255; 3]));
    }
}
