//! Where two dark and two light sectors meet.

use calibench_model::Image;

use crate::ground::grey;
use crate::meeting::Meeting;
use crate::plane::{Linear, Point, distance, plus};

/// What is expected at a corner of squares.
pub(crate) struct Corner {
    /// Where, px.
    pub at: Point,
    /// Where on the board.
    pub plate: Point,
    /// The map from the board to the image there.
    pub linear: Linear,
    /// Half the side of the upright square around it that holds nothing else, object units.
    pub room: f64,
    /// Quarter turns, as of a board's point.
    pub turns: u32,
    /// Light less dark around it, fraction of full scale.
    pub contrast: f64,
}

/// The greatest and the least radius of what is looked at, px.
const RADIUS: [f64; 2] = [2.0, 7.0];
/// The share of the contrast by which light sectors are lighter than dark ones.
const SHARE: f64 = 0.35;

impl Corner {
    /// The nearest point from which all edges run straight, if dark and light lie around it as they should; `None` otherwise.
    pub(crate) fn found(&self, image: &Image) -> Option<Point> {
        let scale = [[1.0, 0.0], [0.0, 1.0]].map(|axis| self.linear.of(axis)).map(|[x, y]| x.hypot(y));
        let room = self.room * scale[0].min(scale[1]);
        let radius = (0.85 * room).clamp(RADIUS[0], RADIUS[1]);
        let mut at = self.at;
        for _ in 0..5 {
            let next = meeting(image, at, radius)?;
            let step = distance(next, at);
            at = next;
            if distance(at, self.at) > (0.5 * room).max(1.5) {
                return None;
            }
            if step < 0.02 {
                break;
            }
        }
        self.stands(image, at).then_some(at)
    }

    /// Whether the area towards a place on the board is dark and the three others are light.
    pub(crate) fn is_single(&self, image: &Image, towards: Point) -> bool {
        let step = 0.6 * self.room;
        let sector = |u: f64, v: f64| grey(image, plus(self.at, self.linear.of([u * step, v * step])));
        let [u, v] = [0, 1].map(|axis| (towards[axis] - self.plate[axis]).signum());
        let light = sector(-u, v).min(sector(u, -v)).min(sector(-u, -v));
        light - sector(u, v) > SHARE * self.contrast
    }

    fn stands(&self, image: &Image, at: Point) -> bool {
        let step = 0.6 * self.room;
        let sector = |u: f64, v: f64| grey(image, plus(at, self.linear.of([u * step, v * step])));
        let falling = [sector(1.0, -1.0), sector(-1.0, 1.0)];
        let rising = [sector(1.0, 1.0), sector(-1.0, -1.0)];
        let (dark, light) = if self.turns.is_multiple_of(2) { (falling, rising) } else { (rising, falling) };
        light[0].min(light[1]) - dark[0].max(dark[1]) > SHARE * self.contrast
    }
}

/// The point to which all gradients around `from` are closest to being at right angles; `None` at the image's border or on an edge.
fn meeting(image: &Image, from: Point, radius: f64) -> Option<Point> {
    let (column, row) = (from[0].round() as i64, from[1].round() as i64);
    let reach = radius.ceil() as i64;
    if !image.holds(column, row, reach + 1) {
        return None;
    }
    let mut meeting = Meeting::default();
    for (dx, dy) in (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy))) {
        let (px, py) = ((column + dx) as usize, (row + dy) as usize);
        let gx = f64::from(image.at(px + 1, py) - image.at(px - 1, py));
        let gy = f64::from(image.at(px, py + 1) - image.at(px, py - 1));
        meeting.add([px as f64 - from[0], py as f64 - from[1]], [gx, gy], radius);
    }
    meeting.place().map(|place| plus(from, place))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_saddle_is_found_and_its_colours_are_told() {
        let ramp = |off: f64| off.clamp(-1.0, 1.0);
        let image = Image::from_fn(40, 40, |x, y| (0.5 + 0.4 * ramp(x as f64 - 20.3) * ramp(y as f64 - 18.8)) as f32);
        // Light at the lower right in the image, where v is down.
        let corner =
            |turns, at| Corner { at, plate: [0.0, 0.0], linear: Linear([[1.0, 0.0], [0.0, -1.0]]), room: 6.0, turns, contrast: 0.8 };
        let found = corner(1, [21.0, 18.0]).found(&image).unwrap();
        assert!(distance(found, [20.3, 18.8]) < 0.1, "{found:?}");
        assert_eq!(corner(0, [21.0, 18.0]).found(&image), None);
        assert!(!corner(1, [20.3, 18.8]).is_single(&image, [5.0, 5.0]));
        assert_eq!(corner(1, [30.0, 30.0]).found(&image), None);
    }
}
