//! Views that a calibrator was not told: what its camera predicts of them.

use calibench_adjust::approximate::{RayControl, resect_by_rays};
use calibench_model::PixelPoint;
use nalgebra::Point3;

use crate::score::rays_of;
use crate::{Lens, TaskImage};

/// With fewer points to resect from, a view says nothing.
const FEWEST: usize = 6;
/// Pixels that are asked for each point: its own, the next along the row, the next down.
const ASKED: usize = 3;

/// Views left out.
#[derive(Clone, Debug)]
pub struct HeldOut {
    /// Of each view: places among the object points, and image points, px.
    views: Vec<Vec<(usize, PixelPoint)>>,
    /// Object units.
    objects: Vec<Point3<f64>>,
    /// Parts of the object points, each as whether a point is in it: a view is resected from what is in it, and the rest is predicted.
    parts: [Vec<Vec<bool>>; 2],
}

/// How well views are predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Predicted {
    /// Distances of points from where they are predicted, after a resection from every other point, RMS (2D), px.
    pub interleaved_px: f64,
    /// The same after a resection from one side of the board, px: errors of the camera are carried on.
    pub across_px: f64,
}

impl HeldOut {
    /// `images` left out, of these object points; the pose comes from the points of each of the `interleaved` parts, and of each of the `sides`.
    pub fn new(images: &[&TaskImage], objects: Vec<Point3<f64>>, interleaved: &[Vec<bool>], sides: &[Vec<bool>]) -> Self {
        Self { views: images.iter().map(|image| image.points.clone()).collect(), objects, parts: [interleaved.to_vec(), sides.to_vec()] }
    }

    /// Pixels whose rays are to be asked for.
    pub fn grid(&self) -> Vec<PixelPoint> {
        let beside = |(_, at): &(usize, PixelPoint)| [*at, PixelPoint::new(at.x + 1.0, at.y), PixelPoint::new(at.x, at.y + 1.0)];
        self.views.iter().flatten().flat_map(beside).collect()
    }

    /// What a camera with these rays at [`Self::grid`] predicts.
    ///
    /// # Errors
    /// In words: too few points to resect from, a pixel without a ray, no pose.
    pub fn predicted(&self, lens: &Lens) -> Result<Predicted, String> {
        let rays = rays_of(lens, &self.grid());
        let mut rays = rays.chunks_exact(ASKED);
        let mut views = Vec::with_capacity(self.views.len());
        for view in &self.views {
            let control = |(place, at): &(usize, PixelPoint)| {
                let of_point = match rays.next() {
                    Some(&[Some(at), Some(right), Some(down)]) => RayControl::new(self.objects[*place], at, [right, down]),
                    _ => None,
                };
                let control = of_point.ok_or_else(|| format!("it does not say where pixel ({:.1}, {:.1}) looks", at.x, at.y))?;
                Ok((*place, control))
            };
            views.push(view.iter().map(control).collect::<Result<Vec<_>, String>>()?);
        }
        let [interleaved_px, across_px] = [0, 1].map(|kind| rms(&views, &self.parts[kind]));
        Ok(Predicted { interleaved_px: interleaved_px?, across_px: across_px? })
    }
}

/// The RMS distance (2D, px) of all points of `views` that are not in a part, from where the poses from those that are in it predict them.
fn rms(views: &[Vec<(usize, RayControl)>], parts: &[Vec<bool>]) -> Result<f64, String> {
    let (mut sum, mut count) = (0.0, 0_usize);
    for (view, part) in views.iter().flat_map(|view| parts.iter().map(move |part| (view, part))) {
        let known: Vec<RayControl> = view.iter().filter(|(place, _)| part[*place]).map(|(_, point)| *point).collect();
        if known.len() < FEWEST {
            return Err(format!("{} points of a view to resect from, at least {FEWEST} are needed", known.len()));
        }
        let pose = resect_by_rays(&known).map_err(|error| error.to_string())?.pose;
        for (_, point) in view.iter().filter(|(place, _)| !part[*place]) {
            let [x, y] = point.residual(&pose).ok_or_else(|| "a point lies behind its ray".to_owned())?;
            (sum, count) = (sum + x * x + y * y, count + 1);
        }
    }
    if count == 0 { Err("no point is left to predict".to_owned()) } else { Ok((sum / count as f64).sqrt()) }
}

#[cfg(test)]
mod tests {
    use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};
    use calibench_model::{NamedCamera, Pose};
    use calibench_random::{Key, Purpose, stream};
    use nalgebra::Vector3;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    const SIZE: ImageSize = ImageSize { width: 1280, height: 960 };

    fn camera(fx: f64, k1: f64) -> Camera {
        let mut distortion = [0.0; 14];
        distortion[0] = k1;
        OpenCv { size: SIZE, fx, fy: fx, cx: 640.0, cy: 480.0, distortion, coefficients: 4 }.into()
    }

    fn objects() -> Vec<Point3<f64>> {
        (0..54).map(|i| Point3::new(f64::from(i % 9) * 25.0, f64::from(i / 9) * -25.0, 0.0)).collect()
    }

    /// Three views by `camera`, with errors of standard deviation `noise`, px.
    fn held_out(camera: &Camera, noise: f64) -> HeldOut {
        let view = |k: u32| {
            let (sin, cos) = (f64::from(k) * 2.1).sin_cos();
            let centre = Point3::new(100.0 + 130.0 * cos, -60.0 + 130.0 * sin, 260.0);
            let pose = Pose::looking_at(centre, Point3::new(100.0, -60.0, 0.0), Vector3::y(), 0.5 * f64::from(k)).unwrap();
            let name = k.to_string();
            let mut rng = stream(Key { seed: 63, of: "held out", trial: 0, view: &name, target: "" }, Purpose::DrawnPoint);
            let mut error = || -> f64 { noise * Distribution::<f64>::sample(&StandardNormal, &mut rng) };
            let point = |(i, object): (usize, &Point3<f64>)| {
                let at = camera.project(pose.ray(object)).unwrap();
                (i, PixelPoint::new(at.x + error(), at.y + error()))
            };
            TaskImage { name: name.clone(), points: objects().iter().enumerate().map(point).collect() }
        };
        let images: Vec<TaskImage> = (0..3).map(view).collect();
        let interleaved = [0, 1].map(|k| (0..54).map(|i| (i % 9 + i / 9) % 2 == k).collect::<Vec<bool>>());
        let sides = [true, false].map(|left| (0..54).map(|i| (2 * (i % 9) < 9) == left).collect::<Vec<bool>>());
        HeldOut::new(&images.iter().collect::<Vec<_>>(), objects(), &interleaved, &sides)
    }

    fn lens(camera: Camera) -> Lens {
        Lens::Camera(Box::new(NamedCamera::new("c", camera)))
    }

    #[test]
    fn the_true_camera_predicts_exactly_and_noise_is_noise() {
        let true_one = camera(920.0, -0.2);
        let exact = held_out(&true_one, 0.0).predicted(&lens(true_one)).unwrap();
        assert!(exact.interleaved_px < 1e-6 && exact.across_px < 1e-6, "{exact:?}");
        let noisy = held_out(&true_one, 0.2).predicted(&lens(true_one)).unwrap();
        // 0.283 px of the points themselves (2D), and what poses from 27 others add.
        assert!((0.27..0.34).contains(&noisy.interleaved_px) && noisy.across_px > noisy.interleaved_px, "{noisy:?}");
    }

    /// Whether a camera is given as one or by its rays: the same prediction.
    #[test]
    fn rays_predict_as_their_camera_does() {
        let held_out = held_out(&camera(920.0, -0.2), 0.1);
        let other = lens(camera(930.0, -0.15));
        let rays = Lens::Rays(rays_of(&other, &held_out.grid()));
        let [by_camera, by_rays] = [&other, &rays].map(|lens| held_out.predicted(lens).unwrap());
        assert_eq!(by_camera, by_rays);
        assert!(by_camera.interleaved_px > 0.3 && by_camera.across_px > 1.5 * by_camera.interleaved_px, "{by_camera:?}");
    }

    #[test]
    fn what_cannot_be_predicted_is_said() {
        let true_one = camera(920.0, -0.2);
        let mut few = held_out(&true_one, 0.0);
        few.views[1].truncate(8);
        assert!(few.predicted(&lens(true_one)).unwrap_err().contains("at least 6 are needed"));
        let whole = held_out(&true_one, 0.0);
        let mut rays = rays_of(&lens(true_one), &whole.grid());
        rays[4] = None;
        assert!(whole.predicted(&Lens::Rays(rays)).unwrap_err().starts_with("it does not say where pixel ("));
    }
}
