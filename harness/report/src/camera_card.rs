//! A camera on a card: what it is, and what its parameters mean for the frame.

use calibench_exchange::camera::{NamedCamera, PoseFrame};
use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, Ray, fold};
use calibench_model::convert::without_distortion;

use crate::plain;

/// A readable card of a camera: parameters in their units, angles of view in degrees, distortion in the corners in px.
pub fn camera_card(named: &NamedCamera) -> String {
    let camera = &named.camera;
    let size = camera.size();
    let mut text = String::new();
    let mut line = |name: &str, value: String| text.push_str(&format!("  {name:<11} {value}\n"));
    if !named.name.is_empty() {
        line("name", named.name.clone());
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
        line(parameter.name, format!("{} {}", parameter.value, parameter.unit).trim_end().to_owned());
    }
    line("view", view(camera));
    line("distortion", distortion(camera));
    line("one to one", one_to_one(camera));
    if let Some(pose) = &named.pose {
        let [x, y, z] = pose.position;
        let of = match named.pose_frame {
            PoseFrame::World => "the world",
            PoseFrame::FirstCamera => "the rig's first camera",
            PoseFrame::Imu => "the rig's inertial sensor",
        };
        line("position", format!("{x}, {y}, {z} in the axes of {of}"));
    }
    if let Some(covariance) = &named.covariance {
        line("covariance", format!("of {}", covariance.parameters.join(", ")));
    }
    for note in &named.notes {
        line("note", note.clone());
    }
    text
}

fn middles(size: ImageSize) -> (f64, f64) {
    (f64::from(size.width - 1) / 2.0, f64::from(size.height - 1) / 2.0)
}

/// Angles between the rays of opposite sides and corners.
fn view(camera: &Camera) -> String {
    let size = camera.size();
    let ((mx, my), (right, down)) = (middles(size), (f64::from(size.width - 1), f64::from(size.height - 1)));
    let angle = |a: (f64, f64), b: (f64, f64)| {
        let ray = |(x, y)| camera.unproject(PixelPoint::new(x, y)).ok();
        ray(a).zip(ray(b)).map_or("no ray".to_owned(), |(a, b)| format!("{:.2}\u{b0}", a.angle_to(b).to_degrees()))
    };
    format!(
        "{} wide, {} high, {} from corner to corner",
        angle((0.0, my), (right, my)),
        angle((mx, 0.0), (mx, down)),
        angle((0.0, 0.0), (right, down))
    )
}

/// How far the corners are from where the same camera without distortion pictures their rays.
fn distortion(camera: &Camera) -> String {
    let size = camera.size();
    let Some(ideal) = without_distortion(camera) else {
        return "not known: no camera without distortion agrees with it on its axis".into();
    };
    let (right, down) = (f64::from(size.width - 1), f64::from(size.height - 1));
    let corner = |x: f64, y: f64| {
        let at = PixelPoint::new(x, y);
        let there = camera.unproject(at).and_then(|ray| ideal.project(ray));
        there.map_or("no ray".to_owned(), |ideal| format!("{} px", plain(ideal.distance(at))))
    };
    format!(
        "{}, {}, {}, {} in the corners (clockwise from top left)",
        corner(0.0, 0.0),
        corner(right, 0.0),
        corner(right, down),
        corner(0.0, down)
    )
}

fn one_to_one(camera: &Camera) -> String {
    let axis = camera.project(Ray::from_tangent(0.0, 0.0)).ok();
    match (fold(camera), axis) {
        (None, _) => "over the whole frame".into(),
        (Some(fold), _) => format!(
            "only to {} px from the image of the axis: there the distortion folds over; {:.2} % of the frame have no ray",
            plain(fold.radius_px),
            100.0 * fold.share
        ),
    }
}
