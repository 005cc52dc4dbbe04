//! What to photograph next: in words, drawn, and as a figure.

use std::f64::consts::FRAC_PI_4;
use std::fmt::Write;

use calibench_calibrate::{Calibration, Next, Photograph};
use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, ImageSize};

use super::figures::named;
use super::uncertainty::measured;
use crate::hull::Hull;
use crate::markdown::MarkdownTable;
use crate::plain;
use crate::plot::{Figure, Plot, Said, Shape};

/// An arrow's length as a share of the frame's width.
const ARROW: f64 = 0.06;

/// The section of a page, for all cameras: text, pictures, and figures in their place.
pub(super) struct NextSection {
    pub(super) text: String,
    pub(super) figures: Vec<Figure>,
}

impl NextSection {
    pub(super) fn of(calibration: &Calibration<'_>) -> Self {
        let mut section = Self { text: String::new(), figures: Vec::new() };
        for camera in 0..calibration.cameras() {
            let _ = write!(section.text, "\n## What to photograph next{}\n\n", calibration.of(camera));
            match calibration.next(camera) {
                Ok(next) => section.camera(calibration, camera, &next),
                Err(why) => {
                    let _ = writeln!(section.text, "Nothing is proposed: {why}.");
                }
            }
        }
        section
    }

    fn camera(&mut self, calibration: &Calibration<'_>, camera: usize, next: &Next) {
        let (prefix, whose) = named(calibration, camera);
        let (size, taken) = (calibration.camera(camera).size(), Hull::of(&measured(calibration, camera)));
        let name = format!("{prefix}next");
        let plot = plot(next, size, &taken, &name);
        let caption = format!(
            "{whose}Where these photographs would have the control in the frame: its outline, and an arrow to the side that is nearer. The outline without a \
             number surrounds what was measured so far."
        );
        let doubts = calibration.doubts().len();
        let first = if doubts > 0 {
            "**The calibration is in doubt: what is in doubt comes first, further photographs do not mend it.** "
        } else {
            ""
        };
        let _ = write!(
            self.text,
            "{first}Over the frame the camera pictures what is far away with a standard deviation of {} px (RMS, after the best rotation). One more photograph like those \
             so far makes that {} px; of several thousand others these lower it most, each taken after those above it:\n\n{}\n{}\n\n![{caption}]({name}.png)\n\n{caption}\n",
            plain(next.before),
            plain(next.usual),
            table(next, size).render(),
            limits(next)
        );
        self.figures.push(Figure { name, caption, remark: remark(next), plot });
    }
}

/// How far each photograph after the other lowers the uncertainty, in a line.
fn remark(next: &Next) -> String {
    let then: Vec<String> =
        next.photographs.iter().enumerate().map(|(index, one)| format!("with {}: {}", index + 1, plain(one.uncertainty))).collect();
    format!("standard deviation over the frame, px: now {}; {}", plain(next.before), then.join(", "))
}

fn table(next: &Next, size: ImageSize) -> MarkdownTable {
    let columns = ["photograph", "middle", "x px", "y px", "tilt", "nearer", "u axis to the", "distance", "points", "then px"];
    let mut table = MarkdownTable::new(&columns);
    for (index, one) in next.photographs.iter().enumerate() {
        table.row([
            (index + 1).to_string(),
            place(one.middle, size).to_owned(),
            format!("{:.0}", one.middle.x),
            format!("{:.0}", one.middle.y),
            format!("{:.0}\u{b0}", one.tilt.to_degrees()),
            one.nearer.map_or("none", direction).to_owned(),
            direction(one.along).to_owned(),
            plain(one.depth),
            one.points.len().to_string(),
            plain(one.uncertainty),
        ]);
    }
    table
}

fn limits(next: &Next) -> String {
    let whole = if next.whole { "; all control is in view, as in the photographs so far" } else { "" };
    format!(
        "`middle`: where in the frame the middle of the control points is to be. `tilt`: the angle between their plane and the image. `nearer`: the side of them that is \
         nearer to the camera. `distance`: how far their middle is away, along the camera's axis, in object units. `then`: the standard deviation with this photograph added. \
         Taken for granted: the model is right, points are measured as precisely as so far, and the distance is one of those so far{whole}."
    )
}

/// A direction, radians from the image's right to its top, in words.
fn direction(angle: f64) -> &'static str {
    const NAMES: [&str; 8] = ["right", "upper right", "top", "upper left", "left", "lower left", "bottom", "lower right"];
    NAMES[(angle / FRAC_PI_4).round().rem_euclid(8.0) as usize % 8]
}

/// A place of the frame in words, by thirds of it.
fn place(at: PixelPoint, size: ImageSize) -> &'static str {
    const NAMES: [[&str; 3]; 3] =
        [["upper left", "top", "upper right"], ["left", "middle", "right"], ["lower left", "bottom", "lower right"]];
    let third = |value: f64, length: u32| ((3.0 * (value + 0.5) / f64::from(length)) as usize).min(2);
    NAMES[third(at.y, size.height)][third(at.x, size.width)]
}

/// Where the arrow of a photograph ends, px.
fn end(one: &Photograph, size: ImageSize) -> Option<(f64, f64)> {
    let length = ARROW * f64::from(size.width);
    one.nearer.map(|towards| (length * towards.cos(), -length * towards.sin()))
}

fn plot(next: &Next, size: ImageSize, taken: &Hull, id: &str) -> Plot {
    let mut plot = Plot::frame(id, "What to photograph next", size);
    plot.series(7, None, &["measured so far"]);
    plot.dashed(&taken.outline());
    for (index, one) in next.photographs.iter().enumerate() {
        plot.series(index + 1, None, &["photograph", "tilt, degrees", "distance", "standard deviation then, px"]);
        let said = Said::of([(index + 1).to_string(), format!("{:.0}", one.tilt.to_degrees()), plain(one.depth), plain(one.uncertainty)]);
        plot.line(&Hull::of(&one.points).outline(), &Said::default());
        plot.symbol(Shape::ALL[index % Shape::ALL.len()], (one.middle.x, one.middle.y), &said);
        if let Some(end) = end(one, size) {
            plot.arrow(one.middle, end, &Said::default());
        }
        plot.note((one.middle.x - 0.03 * f64::from(size.width), one.middle.y), &(index + 1).to_string(), false);
    }
    plot
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::Pose;
    use nalgebra::{Matrix3, Point3};

    #[test]
    fn an_arrow_points_to_the_side_that_is_named() {
        let size = ImageSize { width: 300, height: 200 };
        let one = |towards: f64| Photograph {
            pose: Pose { rotation: Matrix3::identity(), centre: Point3::origin() },
            middle: PixelPoint::new(150.0, 100.0),
            depth: 1.0,
            tilt: 0.5,
            nearer: Some(towards),
            along: 0.0,
            points: Vec::new(),
            uncertainty: 1.0,
        };
        for eighth in -3..=4 {
            let towards = f64::from(eighth) * FRAC_PI_4;
            let (dx, dy) = end(&one(towards), size).unwrap();
            // The frame so small that the arrow leaves its middle third.
            let small = ImageSize { width: 30, height: 30 };
            assert_eq!(place(PixelPoint::new(14.5 + dx, 14.5 + dy), small), direction(towards), "{eighth}");
        }
        assert_eq!(end(&Photograph { nearer: None, ..one(0.0) }, size), None);
    }

    #[test]
    fn directions_and_places_have_names() {
        let named: Vec<&str> = (-4..=4).map(|i| direction(f64::from(i) * FRAC_PI_4)).collect();
        assert_eq!(named, ["left", "lower left", "bottom", "lower right", "right", "upper right", "top", "upper left", "left"]);
        let size = ImageSize { width: 300, height: 200 };
        let at = |x, y| place(PixelPoint::new(x, y), size);
        assert_eq!([at(10.0, 10.0), at(150.0, 10.0), at(299.0, 199.0), at(150.0, 100.0)], ["upper left", "top", "lower right", "middle"]);
    }
}
