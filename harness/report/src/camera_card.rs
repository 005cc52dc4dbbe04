//! A camera on a card: what it is, and what its parameters mean for the frame.

use calibench_model::camera::{Camera, CameraModel, ImageSize, Ray, fold, without_ray};
use calibench_model::convert::without_distortion;
use calibench_model::named_camera::{ParameterCovariance, PoseFrame};
use calibench_model::{NamedCamera, PixelPoint, escape};

use crate::plain;

/// A readable card of a camera: parameters in their units, angles of view in degrees, distortion in the corners in px.
pub fn camera_card(named: &NamedCamera) -> String {
    let camera = &named.camera;
    let size = camera.size();
    let mut text = String::new();
    let mut line = |name: &str, value: String| text.push_str(&format!("  {name:<11} {value}\n"));
    if !named.name.is_empty() {
        line("name", escape::name(&named.name).into_owned());
    }
    let convention = camera.convention();
    line("convention", format!("{}: {}", convention.name, convention.about));
    line("size", format!("{} x {} px", size.width, size.height));
    if let Some(pitch) = named.pitch_um {
        line(
            "pitch",
            format!(
                "{} um, so the sensor is {} x {} mm",
                plain(pitch),
                plain(f64::from(size.width) * pitch * 1e-3),
                plain(f64::from(size.height) * pitch * 1e-3)
            ),
        );
    }
    for parameter in camera.parameters() {
        let value = format!("{} {}", parameter.value, parameter.unit).trim_end().to_owned();
        let sigma = named.covariance.as_ref().and_then(|covariance| sigma(covariance, parameter.name));
        let sigma = sigma.map_or(String::new(), |sigma| format!(", sigma {} {}", plain(sigma), parameter.unit).trim_end().to_owned());
        line(parameter.name, value + &sigma);
    }
    line("view", view_in_words(camera));
    line("distortion", distortion_in_words(camera));
    line("one to one", one_to_one(camera));
    if let Some(pose) = &named.pose {
        let [x, y, z] = pose.position;
        let of = match named.pose_frame {
            PoseFrame::World => "the world",
            PoseFrame::FirstCamera => "the rig's first camera",
            PoseFrame::Rig => "the rig",
            PoseFrame::Imu => "the rig's inertial sensor",
        };
        line("position", format!("{x}, {y}, {z} in the axes of {of}"));
    }
    if let Some(covariance) = &named.covariance {
        line("covariance", format!("of {}", covariance.parameters.join(", ")));
    }
    for note in &named.notes {
        line("note", escape::name(note).into_owned());
    }
    text
}

/// Standard deviation of a parameter, in its unit; `None` for one that was held fixed.
pub(crate) fn sigma(covariance: &ParameterCovariance, name: &str) -> Option<f64> {
    let place = covariance.parameters.iter().position(|own| own == name)?;
    Some(covariance.values[place * (covariance.parameters.len() + 1)].sqrt())
}

fn middles(size: ImageSize) -> (f64, f64) {
    (f64::from(size.width - 1) / 2.0, f64::from(size.height - 1) / 2.0)
}

/// Angles of view, degrees: from side to side, from top to bottom and from corner to corner, by way of the middle of the frame, so that they may be above 180;
/// `None` where there is no ray.
pub(crate) fn view(camera: &Camera) -> [Option<f64>; 3] {
    let size = camera.size();
    let ((mx, my), (right, down)) = (middles(size), (f64::from(size.width - 1), f64::from(size.height - 1)));
    let ray = |(x, y): (f64, f64)| camera.unproject(PixelPoint::new(x, y)).ok();
    let middle = ray((mx, my));
    let angle = |a: (f64, f64), b: (f64, f64)| ray(a).zip(middle).zip(ray(b)).map(|((a, middle), b)| by_way_of(middle, a, b).to_degrees());
    [angle((0.0, my), (right, my)), angle((mx, 0.0), (mx, down)), angle((0.0, 0.0), (right, down))]
}

fn view_in_words(camera: &Camera) -> String {
    let [wide, high, across] = view(camera).map(|angle| angle.map_or("no ray".to_owned(), |angle| format!("{angle:.2}\u{b0}")));
    format!("{wide} wide, {high} high, {across} from corner to corner")
}

/// The angle between two rays on the side where `middle` lies, radians: below 2 pi.
fn by_way_of(middle: Ray, a: Ray, b: Ray) -> f64 {
    use std::f64::consts::{PI, TAU};
    let shorter = a.angle_to(b);
    if a.angle_to(middle) + middle.angle_to(b) > PI { TAU - shorter } else { shorter }
}

/// The distortion of a corner of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Corner {
    /// The camera has no ray there.
    NoRay,
    /// The ray is there: it is the plane that ends at 90 degrees.
    NotInPlane,
    /// So far from where the same camera without distortion pictures the ray, px.
    Moved(f64),
}

/// The corners of the frame, clockwise from top left; `None` where no camera without distortion agrees with this one on its axis.
pub(crate) fn corners(camera: &Camera) -> Option<[Corner; 4]> {
    let size = camera.size();
    let ideal = without_distortion(camera)?;
    let (right, down) = (f64::from(size.width - 1), f64::from(size.height - 1));
    let corner = |(x, y): (f64, f64)| {
        let at = PixelPoint::new(x, y);
        match camera.unproject(at).map(|ray| ideal.project(ray)) {
            Err(_) => Corner::NoRay,
            Ok(Err(_)) => Corner::NotInPlane,
            Ok(Ok(ideal)) => Corner::Moved(ideal.distance(at)),
        }
    };
    Some([(0.0, 0.0), (right, 0.0), (right, down), (0.0, down)].map(corner))
}

fn distortion_in_words(camera: &Camera) -> String {
    let Some(corners) = corners(camera) else {
        return "not known: no camera without distortion agrees with it on its axis".into();
    };
    let words = corners.map(|corner| match corner {
        Corner::NoRay => "no ray".to_owned(),
        Corner::NotInPlane => "not in a plane".to_owned(),
        Corner::Moved(px) => format!("{} px", plain(px)),
    });
    format!("{} in the corners (clockwise from top left)", words.join(", "))
}

fn one_to_one(camera: &Camera) -> String {
    let lost = 100.0 * without_ray(camera);
    match fold(camera) {
        None if lost == 0.0 => "over the whole frame".into(),
        None => format!("where there are rays: {lost:.2} % of the frame have none, since the model ends before"),
        Some(fold) => format!(
            "only to {} px from the image of the axis: there the distortion folds over; {lost:.2} % of the frame have no ray",
            plain(fold.radius_px),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::camera::OpenCvFisheye;

    /// An equidistant camera of a field of view from side to side, degrees.
    fn equidistant(degrees: f64, size: ImageSize, k: [f64; 4]) -> Camera {
        let ((cx, cy), half) = (middles(size), f64::from(size.width - 1) / 2.0);
        let f = half / (degrees / 2.0).to_radians();
        OpenCvFisheye { size, fx: f, fy: f, cx, cy, skew: 0.0, k }.into()
    }

    fn card(camera: Camera) -> String {
        camera_card(&NamedCamera::new("", camera))
    }

    const SIZE: ImageSize = ImageSize { width: 1201, height: 601 };

    #[test]
    fn a_view_may_be_above_180_degrees() {
        // Equidistant: angles are lengths in the image; the diagonal is sqrt(5) / 2 of the width.
        for width in [90.0, 160.0, 179.99, 180.01, 200.0, 220.0, 300.0] {
            let said = card(equidistant(width, SIZE, [0.0; 4]));
            let expected =
                format!("{width:.2}\u{b0} wide, {:.2}\u{b0} high, {:.2}\u{b0} from corner to corner", width / 2.0, width * 1.25_f64.sqrt());
            assert!(said.contains(&expected), "{expected}\n{said}");
            assert!(said.contains("over the whole frame") && !said.contains("no ray"), "{said}");
            assert_eq!(said.contains("not in a plane"), width * 1.25_f64.sqrt() > 180.0, "{said}");
        }
    }

    #[test]
    fn sigmas_stand_beside_what_was_estimated_and_names_are_escaped() {
        let mut named = NamedCamera::new("a\n  view  1\u{b0}", equidistant(90.0, SIZE, [0.0; 4]));
        let covariance = ParameterCovariance::new(vec!["cx".into(), "k1".into()], vec![0.0625, 0.0, 0.0, 1e-6]);
        named.covariance = Some(covariance.unwrap());
        let said = camera_card(&named);
        let of = |name: &str| said.lines().find(|line| line.split_whitespace().next() == Some(name)).unwrap().to_owned();
        assert!(of("cx").ends_with("600 px, sigma 0.250 px") && of("k1").ends_with("0, sigma 0.00100"), "{said}");
        assert!(!of("cy").contains("sigma") && said.contains("a\\n  view"), "{said}");
    }

    #[test]
    fn a_frame_that_the_model_does_not_fill_is_not_one_to_one() {
        // Corners at 190 degrees from the axis.
        let said = card(equidistant(340.0, SIZE, [0.0; 4]));
        assert!(said.contains("340.00\u{b0} wide") && said.contains("no ray from corner to corner"), "{said}");
        assert!(!said.contains("over the whole frame") && said.contains("have none, since the model ends before"), "{said}");
    }
}
