//! Points of photographs and what an adjustment left of them, as a page shows them: over the frame, and the longest residuals enlarged.

mod patches;

use std::borrow::Cow;

use calibench_adjust::Use;
use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;

use crate::field::{MAP, stretch};
use crate::plain;
use crate::plot::{Figure, Plot, Said};

pub use patches::Pictured;
pub(crate) use patches::patches;

/// A point of a photograph with its residual.
#[derive(Clone, Debug)]
pub struct Corner<'a> {
    /// The place of its photograph among all.
    pub image: usize,
    /// What that is called.
    pub name: &'a str,
    /// The target.
    pub target: Cow<'a, str>,
    /// Where it was measured, px.
    pub at: PixelPoint,
    /// Adjusted less observed, x and y, px; `None` where it was left out and is not pictured.
    pub v: Option<[f64; 2]>,
    /// How it took part.
    pub used: Use,
    /// The larger of its normalised residuals, where they are known.
    pub normalised: Option<f64>,
    /// Its place among those that are enlarged: the longest first.
    pub(crate) key: Option<usize>,
}

/// Points that are enlarged.
const ENLARGED: usize = 200;
/// Arrows of a figure: of more than these the longest are drawn, and of the others some.
const MOST: usize = 4000;
/// The length that the residual at the 95th percentile is drawn with, in widths of the frame.
const LENGTH: f64 = 0.06;

const SAYS: [&str; 6] = ["image", "target", "residual, px", "vx, px", "vy, px", "normalised"];

impl<'a> Corner<'a> {
    /// A point that took part, with its residual, px.
    pub fn new((image, name): (usize, &'a str), target: impl Into<Cow<'a, str>>, at: PixelPoint, v: [f64; 2]) -> Self {
        Self { image, name, target: target.into(), at, v: Some(v), used: Use::Full, normalised: None, key: None }
    }

    /// The length of its residual, px.
    fn length(&self) -> Option<f64> {
        self.v.map(|[x, y]| x.hypot(y))
    }

    /// Of one that has no residual it is longer than any.
    fn longest_first(&self) -> f64 {
        self.length().unwrap_or(f64::INFINITY)
    }
}

/// Gives those with the longest residuals their keys.
pub(crate) fn choose(corners: &mut [Corner<'_>]) {
    let mut order: Vec<usize> = (0..corners.len()).collect();
    order.sort_by(|a, b| corners[*b].longest_first().total_cmp(&corners[*a].longest_first()).then(a.cmp(b)));
    for (key, place) in order.into_iter().take(ENLARGED).enumerate() {
        corners[place].key = Some(key);
    }
}

/// How many times too long vectors of these lengths, px, are drawn in a map `width` px wide, of an image of some size.
pub(crate) fn stretched(lengths: impl Iterator<Item = f64>, size: ImageSize, width: u32) -> f64 {
    let mut lengths: Vec<f64> = lengths.collect();
    lengths.sort_by(f64::total_cmp);
    let most = lengths.get(lengths.len() * 95 / 100).copied().unwrap_or(0.0);
    // Small maps get relatively longer vectors, so that they are seen.
    let share = if width < MAP { 2.0 * LENGTH } else { LENGTH };
    stretch(share * f64::from(size.width), most.max(1e-12))
}

/// The longest that a residual is drawn, as a share of the width of its frame.
const LONGEST: f64 = 0.15;

/// A residual as it is drawn, so many times too long, px. A blunder that is left out may be as long as the frame: its direction is enough.
pub(crate) fn shown([x, y]: [f64; 2], size: ImageSize, times: f64) -> [f64; 2] {
    let limit = LONGEST * f64::from(size.width) / (times * x.hypot(y)).max(f64::MIN_POSITIVE);
    let times = times * limit.min(1.0);
    [x * times, y * times]
}

/// Residuals as vectors over a frame.
pub(crate) struct Vectors {
    /// The vectors, each in the group of its image.
    pub(crate) plot: Plot,
    /// How long they are, in a line.
    pub(crate) remark: String,
}

/// The residuals of images of one size in one frame, at most so many of them, to be looked at so many px wide. Those without a residual are not in it.
pub(crate) fn vectors<'c, 'a: 'c>(
    id: &str,
    size: ImageSize,
    corners: impl Iterator<Item = &'c Corner<'a>>,
    (width, most): (u32, usize),
) -> Vectors {
    let mut all: Vec<&Corner<'_>> = corners.filter(|corner| corner.v.is_some()).collect();
    let count = all.len();
    // The order of equals is that in which they came.
    all.sort_by(|a, b| b.longest_first().total_cmp(&a.longest_first()));
    let every = count.saturating_sub(most / 2).div_ceil(most / 2).max(1);
    let drawn: Vec<&Corner<'_>> =
        all.iter().enumerate().filter(|(place, _)| *place < most / 2 || place % every == 0).map(|(_, corner)| *corner).collect();
    let in_use = || all.iter().filter(|corner| corner.used != Use::LeftOut).filter_map(|corner| corner.length());
    let times = stretched(in_use(), size, width);
    let mut plot = Plot::frame(id, "Residuals of all images", size);
    for (colour, is_full) in [(1, true), (0, false)] {
        plot.series(colour, None, &SAYS);
        for corner in drawn.iter().filter(|corner| (corner.used == Use::Full) == is_full) {
            arrow(&mut plot, corner, size, times);
        }
    }
    let doubted = all.iter().filter(|corner| corner.used != Use::Full).count();
    let doubted = if doubted > 0 { format!("; orange: {doubted} left out or of less weight") } else { String::new() };
    let cut = all.iter().filter(|corner| corner.length().is_some_and(|length| times * length > LONGEST * f64::from(size.width))).count();
    let cut = if cut > 0 { format!("; {cut} are longer than is drawn") } else { String::new() };
    let some =
        if every > 1 { format!("; of {count} the longest {} are drawn and one in {every} of the others", most / 2) } else { String::new() };
    let longest = plain(in_use().fold(0.0, f64::max));
    Vectors { plot, remark: format!("arrows {times} times their length; the longest {longest} px{doubted}{cut}{some}") }
}

/// The residuals of images of one size in one frame: the figure of the page and its picture, with what stands before its name and before its caption.
pub(crate) fn over_frame<'c, 'a: 'c>(prefix: &str, of: &str, size: ImageSize, corners: impl Iterator<Item = &'c Corner<'a>>) -> Figure {
    let name = format!("{prefix}residuals");
    let Vectors { plot, remark } = vectors(&name, size, corners, (MAP, MOST));
    let caption =
        format!("{of}Residuals (adjusted less observed) of all images together. In a page that answers a click chooses an image.");
    Figure { name, caption, remark, plot }
}

fn arrow(plot: &mut Plot, corner: &Corner<'_>, size: ImageSize, times: f64) {
    let Some(v) = corner.v else { return };
    let said = Said {
        values: vec![
            corner.name.to_owned(),
            corner.target.to_string(),
            plain(v[0].hypot(v[1])),
            plain(v[0]),
            plain(v[1]),
            corner.normalised.map(plain).unwrap_or_default(),
        ],
        group: Some(corner.image),
        key: corner.key,
    };
    let [x, y] = shown(v, size, times);
    plot.arrow(corner.at, (x, y), &said);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(image: usize, target: &str, v: Option<[f64; 2]>) -> Corner<'_> {
        Corner { v, ..Corner::new((image, "i"), target, PixelPoint::new(10.0, 20.0), [0.0; 2]) }
    }

    #[test]
    fn the_longest_come_first_and_before_them_what_is_not_pictured() {
        let mut all = vec![
            corner(0, "a", Some([0.1, 0.0])),
            corner(0, "b", None),
            corner(1, "c", Some([0.3, -0.4])),
            corner(1, "d", Some([0.0, 0.1])),
        ];
        choose(&mut all);
        assert_eq!(all.iter().map(|corner| corner.key).collect::<Vec<_>>(), [Some(2), Some(0), Some(1), Some(3)]);
        let mut many: Vec<Corner<'_>> = (0..300).map(|i| corner(0, "a", Some([f64::from(i), 0.0]))).collect();
        choose(&mut many);
        assert!(many.iter().enumerate().all(|(i, corner)| corner.key == (i >= 100).then_some(299 - i)), "the longest 200");
    }

    #[test]
    fn what_has_no_residual_is_not_drawn() {
        let all = [corner(3, "a", Some([0.3, 0.4])), corner(4, "b", None)];
        let html = over_frame("r-", "x: ", ImageSize { width: 100, height: 50 }, all.iter()).html();
        assert_eq!(html.matches("class=\"arrow\"").count(), 1, "{html}");
        assert!(
            html.contains("data-t=\"i|a|0.500|0.300|0.400|\" data-g=\"3\"")
                && html.contains(">x: Residuals")
                && html.contains("longest 0.500 px"),
            "{html}"
        );
        assert!(!html.contains("longer than is drawn"), "{html}");
    }

    /// Arrows that are cut short are no measure, which is said.
    #[test]
    fn arrows_that_are_cut_short_are_counted() {
        let mut all = vec![corner(0, "a", Some([0.3, 0.4])); 40];
        all.push(Corner { used: Use::LeftOut, ..corner(0, "b", Some([30.0, 0.0])) });
        let html = over_frame("", "", ImageSize { width: 100, height: 50 }, all.iter()).html();
        assert!(html.contains("longest 0.500 px; orange: 1 left out or of less weight; 1 are longer than is drawn"), "{html}");
    }
}
