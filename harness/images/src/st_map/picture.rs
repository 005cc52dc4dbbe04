//! The picture of a camera without distortion.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, Ray};

use super::StMapError;

/// An undistorted picture is no more than so many times as wide and as high as the frame.
const MOST_SIDES: u32 = 4;
/// Columns and rows at most.
const MOST: u32 = 1 << 16;

/// How much larger the undistorted picture is than the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Overscan {
    /// By so many percent, half of it on each side; zero is the frame's own size.
    Percent(f64),
    /// As much as holds every pixel of the frame.
    All,
}

/// A picture of a camera without distortion: alike in scale on the axis, with the same surplus left and right and above and below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Undistorted {
    /// Its size.
    pub size: ImageSize,
    /// Focal lengths along x and y, px: the camera's on its axis.
    pub focal: [f64; 2],
    /// Image of the axis, px from the centre of its first pixel.
    pub principal: PixelPoint,
    /// Columns added left and right, rows added above and below, px.
    pub surplus: [u32; 2],
}

impl Undistorted {
    /// The undistorted picture of `camera`.
    ///
    /// # Errors
    /// No ray along the axis; rays that no plane of a bearable size holds.
    pub fn of(camera: &Camera, overscan: Overscan) -> Result<Self, StMapError> {
        let axis = camera.derivatives(Ray::from_tangent(0.0, 0.0))?;
        // By the ray's components, of which y points up and the image down.
        let focal = [axis.by_ray[0][0], -axis.by_ray[1][1]];
        let plain = Self { size: camera.size(), focal, principal: axis.point, surplus: [0; 2] };
        let ImageSize { width, height } = plain.size;
        let surplus = match overscan {
            Overscan::Percent(percent) => [width, height].map(|side| (f64::from(side) * percent / 200.0).round().max(0.0) as u32),
            Overscan::All => plain.missing(camera)?,
        };
        let sides = [(width, surplus[0]), (height, surplus[1])].map(|(side, more)| u64::from(side) + 2 * u64::from(more));
        let [Ok(width), Ok(height)] = sides.map(|side| u32::try_from(side).ok().filter(|side| *side <= MOST).ok_or(())) else {
            return Err(StMapError::TooLarge { width: sides[0], height: sides[1], most: MOST });
        };
        let principal = PixelPoint::new(axis.point.x + f64::from(surplus[0]), axis.point.y + f64::from(surplus[1]));
        Ok(Self { size: ImageSize { width, height }, principal, surplus, ..plain })
    }

    /// The ray of a place in the picture.
    pub fn ray(&self, at: PixelPoint) -> Ray {
        Ray::from_tangent((at.x - self.principal.x) / self.focal[0], -(at.y - self.principal.y) / self.focal[1])
    }

    /// The place of a ray in the picture; `None` for one that does not point forward.
    pub fn image(&self, ray: Ray) -> Option<PixelPoint> {
        let (right, up) = ray.tangent()?;
        Some(PixelPoint::new(self.principal.x + self.focal[0] * right, self.principal.y - self.focal[1] * up))
    }

    /// What the picture lacks on each side to hold the centres of all pixels at the frame's border.
    fn missing(&self, camera: &Camera) -> Result<[u32; 2], StMapError> {
        let ImageSize { width, height } = self.size;
        let (right, bottom) = (f64::from(width - 1), f64::from(height - 1));
        let columns = (0..width).flat_map(|x| [0.0, bottom].map(|y| PixelPoint::new(f64::from(x), y)));
        let rows = (0..height).flat_map(|y| [0.0, right].map(|x| PixelPoint::new(x, f64::from(y))));
        let (mut most, mut angle): ([f64; 2], f64) = ([0.0; 2], 0.0);
        for at in columns.chain(rows) {
            // What has no ray is in no picture.
            let Ok(ray) = camera.unproject(at) else { continue };
            angle = angle.max(ray.angle_to(Ray::from_tangent(0.0, 0.0)));
            let Some(PixelPoint { x, y }) = self.image(ray) else {
                most = [f64::INFINITY; 2];
                continue;
            };
            most = [most[0].max(-x).max(x - right), most[1].max(-y).max(y - bottom)];
        }
        let sides = [width, height].map(|side| f64::from(side) * f64::from(MOST_SIDES - 1) / 2.0);
        if most[0] > sides[0] || most[1] > sides[1] {
            return Err(StMapError::TooWide { angle: angle.to_degrees(), sides: MOST_SIDES });
        }
        Ok(most.map(|more| more.ceil() as u32))
    }
}
