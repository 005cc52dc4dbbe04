//! A map that another program made, against the camera.

use std::path::Path;

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, Ray};
use calibench_model::convert::Spread;
use nalgebra::{Matrix2, Vector2};

use super::{Direction, StMapError, Undistorted, counterpart, file};

/// Places that a check needs.
const FEWEST: usize = 100;

/// How far a map is from that of a camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Pixels that both maps place.
    pub pixels: usize,
    /// Distance of the places, px of the source; `None` where the sizes differ.
    pub as_it_is: Option<Spread>,
    /// What remains with the best undistorted picture of any scale and place, px of the map for undistorting, of the source for redistorting.
    pub remaining: Spread,
    /// That picture.
    pub pinhole: Pinhole,
}

/// An undistorted picture without a size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinhole {
    /// Focal lengths along x and y, px; that along y is negative where t is counted the other way.
    pub focal: [f64; 2],
    /// Image of the axis, px from the centre of the first pixel.
    pub principal: PixelPoint,
}

/// Tangents (right, down) of a ray, where in the undistorted picture the map has it, and how far that is from the camera's.
struct Place {
    tangent: [f64; 2],
    picture: PixelPoint,
    /// In the source; `None` where the sizes of the maps differ.
    off: Option<(PixelPoint, f64)>,
}

/// Compares the map of a file with that of `camera`; of the source's size for redistorting nothing is known but `picture`.
///
/// # Errors
/// A file that cannot be read, a redistorting map of another size than the frame, a map with hardly any place in it.
pub fn check(path: &Path, camera: &Camera, picture: &Undistorted, direction: Direction, from_top: bool) -> Result<Check, StMapError> {
    let (size, places) = file::read(path)?;
    let name = || path.display().to_string();
    let shown = |size: ImageSize| format!("{} x {}", size.width, size.height);
    if direction == Direction::Redistort && size != camera.size() {
        let help = "expected a map of the frame for --redistort";
        return Err(StMapError::Size { file: name(), found: shown(size), expected: shown(camera.size()), help });
    }
    let source = if direction == Direction::Undistort { camera.size() } else { picture.size };
    let place = |(index, &[s, t]): (usize, &[f32; 2])| {
        let t = if from_top { t } else { 1.0 - t };
        let inside = s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0;
        let at = PixelPoint::new((index % size.width as usize) as f64, (index / size.width as usize) as f64);
        let theirs = calibench_model::CornerPoint { x: f64::from(s) * f64::from(source.width), y: f64::from(t) * f64::from(source.height) };
        inside.then(|| placed(camera, picture, direction, (at, theirs.to_pixel()), size))?
    };
    let places: Vec<Place> = places.iter().enumerate().filter_map(place).collect();
    if places.len() < FEWEST {
        return Err(StMapError::NoPlaces { file: name(), found: places.len() });
    }
    let pinhole = best(&places).ok_or_else(|| StMapError::NoPlaces { file: name(), found: places.len() })?;
    let remains = |place: &Place| (place.picture, pinhole.image(place.tangent).distance(place.picture));
    let as_it_is: Option<Vec<(PixelPoint, f64)>> = places.iter().map(|place| place.off).collect();
    Ok(Check {
        pixels: places.len(),
        as_it_is: as_it_is.map(|all| spread(all.into_iter())),
        remaining: spread(places.iter().map(remains)),
        pinhole,
    })
}

/// A pixel of the map and its place in the source, as the camera has it.
fn placed(
    camera: &Camera,
    picture: &Undistorted,
    direction: Direction,
    (at, theirs): (PixelPoint, PixelPoint),
    size: ImageSize,
) -> Option<Place> {
    let (in_frame, in_picture) = if direction == Direction::Undistort { (theirs, at) } else { (at, theirs) };
    let ray: Ray = camera.unproject(in_frame).ok()?;
    let (right, up) = ray.tangent()?;
    let same_size = direction == Direction::Redistort || size == picture.size;
    let off = same_size.then(|| counterpart(camera, picture, direction, at)).flatten().map(|ours| (at, ours.distance(theirs)));
    Some(Place { tangent: [right, -up], picture: in_picture, off })
}

impl Pinhole {
    fn image(&self, [x, y]: [f64; 2]) -> PixelPoint {
        PixelPoint::new(self.principal.x + self.focal[0] * x, self.principal.y + self.focal[1] * y)
    }
}

/// Two straight lines by least squares; `None` where the places determine none.
fn best(places: &[Place]) -> Option<Pinhole> {
    let line = |tangent: fn(&Place) -> f64, at: fn(&Place) -> f64| {
        let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
        for place in places {
            let row = Vector2::new(tangent(place), 1.0);
            normal += row * row.transpose();
            right += row * at(place);
        }
        normal.cholesky().map(|cholesky| cholesky.solve(&right))
    };
    let x = line(|place| place.tangent[0], |place| place.picture.x)?;
    let y = line(|place| place.tangent[1], |place| place.picture.y)?;
    Some(Pinhole { focal: [x[0], y[0]], principal: PixelPoint::new(x[1], y[1]) })
}

fn spread(distances: impl Iterator<Item = (PixelPoint, f64)>) -> Spread {
    let (mut sum, mut count, mut worst) = (0.0, 0.0, (PixelPoint::default(), 0.0));
    for (at, distance) in distances {
        (sum, count) = (sum + distance * distance, count + 1.0);
        if distance > worst.1 {
            worst = (at, distance);
        }
    }
    Spread { rms_px: (sum / f64::max(count, 1.0)).sqrt(), max_px: worst.1, at: worst.0 }
}
