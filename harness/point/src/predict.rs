//! Where the other targets of an image must be, once some are known.

use calibench_adjust::approximate::{Control, Search, Shape, Tolerance, homography, resect};
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};
use calibench_model::{ControlRow, PixelPoint, Pose};
use nalgebra::Point3;

/// Height over their plane, as a share of their extent, up to which points are taken for those of a plane.
const FLAT: f64 = 0.02;
/// Focal lengths that are tried where no camera is given, in longer sides of the image.
const FOCAL: std::ops::Range<f64> = 0.4..8.0;
/// How many of them.
const TRIED: usize = 40;
/// Points that a prediction takes at least.
const NEEDED: usize = 4;

/// Targets that were not pointed at, and where they must be.
#[derive(Clone, Debug, PartialEq)]
pub struct Predicted {
    /// Names and places in the image, px; only those inside it.
    pub targets: Vec<(String, PixelPoint)>,
    /// By what they were predicted and how well that fits, in words.
    pub how: String,
}

/// Where the targets of `control` that are not among `pointed` must be in an image of this size.
///
/// With a camera by resection. Without one, from points of a plane by its homography, for the targets of that plane; else by resection with the focal length
/// that fits best, without distortion. So predictions without a camera are approximate.
///
/// # Errors
/// In words: fewer than four known points, points on a line.
pub fn predict(
    control: &[ControlRow],
    pointed: &[(String, PixelPoint)],
    size: ImageSize,
    camera: Option<&Camera>,
) -> Result<Predicted, String> {
    let known = |name: &str| control.iter().find(|row| row.target == name).map(|row| Point3::from(row.position));
    let seen: Vec<Control> = pointed.iter().filter_map(|(name, image)| Some(Control { object: known(name)?, image: *image })).collect();
    if seen.len() < NEEDED {
        return Err(format!("{} of {NEEDED} points with control", seen.len()));
    }
    let others: Vec<(&str, Point3<f64>)> = control
        .iter()
        .filter(|row| pointed.iter().all(|(name, _)| *name != row.target))
        .map(|row| (row.target.as_str(), Point3::from(row.position)))
        .collect();
    let (map, how) = match camera {
        Some(camera) => by_resection(*camera, &seen).ok_or("no pose fits these points: is one of them another target?")?,
        None => {
            let shape = Shape::of(seen.iter().map(|point| point.object));
            if shape.relative()[0] <= FLAT {
                by_plane(shape, &seen)?
            } else {
                by_best_focal_length(size, &seen).ok_or("no pose fits these points: is one of them another target?")?
            }
        }
    };
    let inside = |p: &PixelPoint| (-0.5..f64::from(size.width) - 0.5).contains(&p.x) && (-0.5..f64::from(size.height) - 0.5).contains(&p.y);
    let targets = others.into_iter().filter_map(|(name, place)| Some((name.to_owned(), map(&place).filter(inside)?))).collect();
    Ok(Predicted { targets, how: format!("Predicted from {} points by {how}", seen.len()) })
}

type Map = Box<dyn Fn(&Point3<f64>) -> Option<PixelPoint>>;

fn rms(map: &Map, seen: &[Control]) -> Option<f64> {
    let squares = seen.iter().map(|point| Some(map(&point.object)?.distance(point.image).powi(2)));
    let sum: f64 = squares.sum::<Option<f64>>()?;
    Some((sum / seen.len() as f64).sqrt())
}

fn by_plane(plane: Shape, seen: &[Control]) -> Result<(Map, String), String> {
    let pairs: Vec<_> = seen.iter().map(|point| (plane.in_plane(&point.object), [point.image.x, point.image.y])).collect();
    let found = homography(&pairs).map_err(|error| error.to_string())?;
    let map: Map = Box::new(move |point| {
        // From one end to the other it is twice as far as a root mean square tells of four corners.
        if plane.height(point).abs() > FLAT * 2.0 * plane.extents[0] {
            return None;
        }
        found.map(plane.in_plane(point)).map(|[x, y]| PixelPoint::new(x, y))
    });
    let fit = rms(&map, seen).unwrap_or(0.0);
    let fits = if seen.len() == NEEDED {
        "which four points always fit: a wrong name among them would not show".to_owned()
    } else {
        format!("to {fit:.2} px (RMS)")
    };
    Ok((map, format!("their plane, {fits}")))
}

fn by_resection(camera: Camera, seen: &[Control]) -> Option<(Map, String)> {
    let against = Search { seed: 1, tolerance: Tolerance::Unknown };
    let pose: Pose = resect(&camera, seen, None).or_else(|_| resect(&camera, seen, Some(&against))).ok()?.pose;
    let map: Map = Box::new(move |point| camera.project(pose.ray(point)).ok());
    let fit = rms(&map, seen)?;
    Some((map, format!("resection, to {fit:.2} px (RMS)")))
}

fn by_best_focal_length(size: ImageSize, seen: &[Control]) -> Option<(Map, String)> {
    let side = f64::from(size.width.max(size.height));
    let tried = |index: usize| {
        let share = FOCAL.start * (FOCAL.end / FOCAL.start).powf(index as f64 / (TRIED - 1) as f64);
        let (map, _) = by_resection(pinhole(size, share * side), seen)?;
        Some((rms(&map, seen)?, share, map))
    };
    let (fit, share, map) = (0..TRIED).filter_map(tried).min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((map, format!("resection without distortion, focal length {:.0} px, to {fit:.2} px (RMS)", share * side)))
}

fn pinhole(size: ImageSize, focal: f64) -> Camera {
    let [cx, cy] = [size.width, size.height].map(|side| (f64::from(side) - 1.0) / 2.0);
    OpenCv { size, fx: focal, fy: focal, cx, cy, distortion: [0.0; 14], coefficients: 5 }.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    const SIZE: ImageSize = ImageSize { width: 1600, height: 1200 };

    fn scene(depth: f64) -> (Vec<ControlRow>, Vec<(String, PixelPoint)>, Camera) {
        let camera = pinhole(SIZE, 1800.0);
        let pose = Pose::looking_at(Point3::new(1.0, -2.0, 9.0), Point3::new(0.2, 0.1, 0.0), Vector3::y(), 0.1).unwrap();
        let places = (0..12).map(|i| [f64::from(i % 4) - 1.5, f64::from(i / 4) - 1.0, depth * f64::from((i * 5) % 7)]);
        let control: Vec<_> = places.enumerate().map(|(i, place)| ControlRow::new(format!("t{i}"), place)).collect();
        let image = |row: &ControlRow| (row.target.clone(), camera.project(pose.ray(&row.position.into())).unwrap());
        let images = control.iter().map(image).collect();
        (control, images, camera)
    }

    fn farthest(found: &Predicted, truth: &[(String, PixelPoint)]) -> f64 {
        let off = |(name, place): &(String, PixelPoint)| truth.iter().find(|(other, _)| other == name).unwrap().1.distance(*place);
        found.targets.iter().map(off).fold(0.0, f64::max)
    }

    #[test]
    fn four_points_of_a_plane_give_the_others() {
        let (control, truth, _) = scene(0.0);
        let four = [0, 3, 8, 11].map(|i| truth[i].clone());
        let found = predict(&control, &four, SIZE, None).unwrap();
        assert_eq!(found.targets.len(), 8);
        assert!(farthest(&found, &truth) < 1e-6, "{}", farthest(&found, &truth));
        assert!(found.how.contains("would not show"), "{}", found.how);
        assert_eq!(predict(&control, &four[..3], SIZE, None).unwrap_err(), "3 of 4 points with control");
        let line = [0, 1, 2, 3].map(|i| truth[i].clone());
        assert!(predict(&control, &line, SIZE, None).is_err());
    }

    /// A plane's picture says nothing of what is before or behind it.
    #[test]
    fn what_is_off_the_plane_is_not_predicted_by_it() {
        let (mut control, truth, _) = scene(0.0);
        control.extend(
            [("before", 0.5), ("behind", -0.5), ("all but on it", 0.01)].map(|(name, z)| ControlRow::new(name.to_owned(), [0.5, 0.0, z])),
        );
        let four = [0, 3, 8, 11].map(|i| truth[i].clone());
        let found = predict(&control, &four, SIZE, None).unwrap();
        assert_eq!(found.targets.len(), 9);
        assert!(found.targets.iter().all(|(name, _)| !["before", "behind"].contains(&name.as_str())), "{found:?}");
    }

    #[test]
    fn points_in_space_give_the_others() {
        let (control, truth, camera) = scene(0.3);
        let some = [0, 3, 5, 8, 11, 6].map(|i| truth[i].clone());
        let found = predict(&control, &some, SIZE, Some(&camera)).unwrap();
        assert_eq!(found.targets.len(), 6);
        assert!(farthest(&found, &truth) < 1e-3, "{}", farthest(&found, &truth));
        let found = predict(&control, &some, SIZE, None).unwrap();
        assert_eq!(found.targets.len(), 6);
        assert!(farthest(&found, &truth) < 10.0, "{}: {}", farthest(&found, &truth), found.how);
    }
}
