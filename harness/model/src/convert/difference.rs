//! How far two cameras differ.

use super::fit::{Problem, State};
use super::grid::{Node, Region, Sight, Spread, Vector, axis, cell_share, nodes_in, normalise, spread};
use super::rotation::between;
use super::{COLUMNS, ConvertError, Rotation};
use crate::PixelPoint;
use crate::camera::{Camera, CameraModel, CameraParameter, DerivativeBuffer, ImageSize, NoCounterpart, Ray};

/// Places that a rotation is found at, at most.
const PLACES: usize = 20_000;

/// How to compare.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DifferenceOptions {
    /// The part of the frame to compare over; a radius counts from the first camera's principal point.
    pub region: Region,
    /// Compare after the best rotation: a rotation of the camera cannot be told from one of its exterior orientation.
    pub rotation: bool,
    /// Also compare after the best principal distance and principal point.
    pub compensation: bool,
    /// Columns of the grid; rows make it square.
    pub columns: usize,
    /// The size of the vectors is that on a grid so many times as fine: where a difference grows steeply, as towards a fold, that of few columns is some percent too large.
    pub finer: usize,
}

impl DifferenceOptions {
    /// [`Self::finer`] that is right to a hundredth.
    pub const FINE: usize = 8;
}

impl Default for DifferenceOptions {
    fn default() -> Self {
        Self { region: Region::Frame, rotation: true, compensation: false, columns: COLUMNS, finer: 1 }
    }
}

/// How far two cameras differ over the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Size of the vectors.
    pub spread: Spread,
    /// At the pixels of the first camera: to where the second pictures their rays, after the rotation.
    pub vectors: Vec<Vector>,
    /// Share of the region that is not compared, because one of the cameras folds over or does not picture it, 0 to 1.
    pub not_comparable: f64,
    /// Rotation of the first camera's rays before the second pictures them; none unless asked for.
    pub rotation: Rotation,
    /// After a change of principal distance and point as well, if asked for.
    pub compensated: Option<Compensated>,
    /// Principal distance of the first camera at its axis, px.
    pub focal_px: f64,
}

/// What is left after the best principal distance and point (and rotation, if that is free).
///
/// The second camera's image is scaled about its principal point and moved, its distortion with it: for models normalised by the focal length that is
/// f, cx and cy; for photogrammetric ones the coefficients follow c.
#[derive(Clone, Debug, PartialEq)]
pub struct Compensated {
    /// Size of what is left.
    pub spread: Spread,
    /// What is left.
    pub vectors: Vec<Vector>,
    /// Relative change of the second camera's principal distance, a number; 0 for none.
    pub scale: f64,
    /// Change of the second camera's principal point, px: right, down.
    pub shift: [f64; 2],
    /// The rotation that goes with it.
    pub rotation: Rotation,
}

impl Difference {
    /// What so many px are on an object at a `distance`, in the unit of this, across the line of sight: `px * distance / focal_px`.
    pub fn on_object(&self, px: f64, distance: f64) -> f64 {
        px * distance / self.focal_px
    }
}

/// How far `second` differs from `first`: pixels to rays by the first, a rotation, rays to pixels by the second.
///
/// With the roles exchanged the vectors change their sign, and else by terms of second order only: the difference times the change of scale between the two
/// images. The rotation is the least-squares one over the pixels that both cameras see; these stay the same through the fit.
///
/// # Errors
/// Cameras with images of different sizes, fewer than a handful of comparable pixels, a rotation that is not found.
pub fn difference(first: &Camera, second: &Camera, options: &DifferenceOptions) -> Result<Difference, ConvertError> {
    compared(first, second, options, None)
}

/// As [`difference`], after the rotation that is best at `places` of the first image (px), such as image points that were measured, and nowhere else: there
/// poses make up for a camera, and what differs beyond is not hidden by what agrees. Nothing is compensated. Of many places 20,000 count, spread over
/// their order.
///
/// # Errors
/// As of [`difference`]; fewer than a handful of places that both cameras picture.
pub fn difference_at(
    first: &Camera,
    second: &Camera,
    places: &[PixelPoint],
    options: &DifferenceOptions,
) -> Result<Difference, ConvertError> {
    let held = rotation_at(first, second, places)?;
    compared(first, second, &DifferenceOptions { compensation: false, ..*options }, Some(held))
}

/// How far rays are from those of `camera`: where it pictures each after the best rotation, less the place that it came with; `None` for one that it does not
/// picture. Of a camera of which nothing but rays is known, or one of a model that there is not here.
///
/// Places are weighted by their share of the area, as those of a grid from the first pixel to the last ([`cell_share`]). The rotation is the least-squares one over
/// the places that `camera` pictures from the start.
///
/// # Errors
/// Fewer than a handful of rays that `camera` pictures, a rotation that is not found.
pub fn difference_of_rays(rays: &[(PixelPoint, Ray)], camera: &Camera) -> Result<(Vec<Option<Vector>>, Rotation), ConvertError> {
    let sight = |&(point, ray): &(PixelPoint, Ray)| Sight { node: Node { point, weight: cell_share(camera.size(), point) }, ray };
    let mut sights: Vec<Sight> = rays.iter().map(sight).collect();
    let start = between(&sights, camera);
    sights.retain(|sight| camera.project(start.apply(sight.ray)).is_ok());
    if sights.len() < 5 {
        return Err(ConvertError::NotPictured { share: 1.0 });
    }
    normalise(&mut sights);
    let rotation = Problem { sights: &sights, free: &[], rotation: true }.solve(State { camera: *camera, rotation: start })?.rotation;
    let vector = |&(at, ray): &(PixelPoint, Ray)| {
        let found = camera.project(rotation.apply(ray)).ok().filter(|found| found.is_finite())?;
        Some(Vector { at, dx: found.x - at.x, dy: found.y - at.y })
    };
    Ok((rays.iter().map(vector).collect(), rotation))
}

fn rotation_at(first: &Camera, second: &Camera, places: &[PixelPoint]) -> Result<Rotation, ConvertError> {
    let sight = |&point: &PixelPoint| first.unproject(point).ok().map(|ray| Sight { node: Node { point, weight: 1.0 }, ray });
    let some = places.iter().step_by(places.len().div_ceil(PLACES).max(1));
    let mut sights: Vec<Sight> = some.filter_map(sight).collect();
    let start = between(&sights, second);
    sights.retain(|sight| second.project(start.apply(sight.ray)).is_ok());
    if sights.len() < 5 {
        return Err(ConvertError::NotPictured { share: 1.0 });
    }
    normalise(&mut sights);
    let problem = Problem { sights: &sights, free: &[], rotation: true };
    Ok(problem.solve(State { camera: *second, rotation: start })?.rotation)
}

/// The difference after the best rotation, or after one that is held.
fn compared(first: &Camera, second: &Camera, options: &DifferenceOptions, held: Option<Rotation>) -> Result<Difference, ConvertError> {
    if first.size() != second.size() {
        return Err(ConvertError::Target { fault: "the cameras' images differ in size" });
    }
    let nodes = nodes_in(first, options.region, options.columns)?;
    let total: f64 = nodes.iter().map(|node| node.weight).sum();
    let mut sights: Vec<Sight> =
        nodes.into_iter().filter_map(|node| first.unproject(node.point).ok().map(|ray| Sight { node, ray })).collect();
    let start = match held {
        Some(rotation) => rotation,
        None if options.rotation => between(&sights, second),
        None => Rotation::identity(),
    };
    sights.retain(|sight| second.project(start.apply(sight.ray)).is_ok());
    let compared: f64 = sights.iter().map(|sight| sight.node.weight).sum();
    if sights.len() < 5 {
        return Err(ConvertError::NotPictured { share: 1.0 });
    }
    normalise(&mut sights);
    let problem = Problem { sights: &sights, free: &[], rotation: options.rotation };
    let start = State { camera: *second, rotation: start };
    let state = if options.rotation && held.is_none() { problem.solve(start)? } else { start };
    let vectors = problem.residuals(&state).ok_or(ConvertError::NotConverged)?;
    let compensated = if options.compensation { Some(compensate(first, &sights, &state, options)?) } else { None };
    let not_comparable = (1.0 - compared / total).max(0.0);
    let (spread, rotation) = (finely(first, &state, options, spread(&sights, &vectors))?, state.rotation);
    Ok(Difference { spread, vectors, not_comparable, rotation, compensated, focal_px: focal_px(first)? })
}

/// The size of the vectors on the finer grid; `coarse` is that on the other.
fn finely<T: CameraModel>(first: &Camera, state: &State<T>, options: &DifferenceOptions, coarse: Spread) -> Result<Spread, ConvertError> {
    if options.finer < 2 {
        return Ok(coarse);
    }
    let nodes = nodes_in(first, options.region, options.finer * (options.columns.max(3) - 1) + 1)?;
    let sight = |node: Node| {
        let ray = first.unproject(node.point).ok()?;
        let (found, at) = (state.camera.project(state.rotation.apply(ray)).ok().filter(|found| found.is_finite())?, node.point);
        Some((Sight { node, ray }, Vector { at, dx: found.x - at.x, dy: found.y - at.y }))
    };
    let (mut sights, vectors): (Vec<Sight>, Vec<Vector>) = nodes.into_iter().filter_map(sight).unzip();
    normalise(&mut sights);
    Ok(spread(&sights, &vectors))
}

fn compensate(first: &Camera, sights: &[Sight], state: &State<Camera>, options: &DifferenceOptions) -> Result<Compensated, ConvertError> {
    let camera = Enlarged { camera: &state.camera, centre: axis(&state.camera)?, scale: 0.0, shift: [0.0; 2] };
    let problem = Problem { sights, free: &[0, 1, 2], rotation: options.rotation };
    let state = problem.solve(State { camera, rotation: state.rotation })?;
    let vectors = problem.residuals(&state).ok_or(ConvertError::NotConverged)?;
    let Enlarged { scale, shift, .. } = state.camera;
    let spread = finely(first, &state, options, spread(sights, &vectors))?;
    Ok(Compensated { spread, vectors, scale, shift, rotation: state.rotation })
}

/// Geometric mean of the scales along the axes, px.
fn focal_px(camera: &Camera) -> Result<f64, ConvertError> {
    let [x, y] = camera.derivatives(Ray::from_tangent(0.0, 0.0))?.by_ray;
    Ok((x[0] * y[1] - x[1] * y[0]).abs().sqrt())
}

/// A camera whose image is scaled about its principal point and moved.
#[derive(Clone, Copy, Debug)]
struct Enlarged<'a> {
    camera: &'a Camera,
    centre: PixelPoint,
    scale: f64,
    shift: [f64; 2],
}

impl Enlarged<'_> {
    fn image(&self, point: PixelPoint) -> PixelPoint {
        let s = 1.0 + self.scale;
        PixelPoint::new(
            self.centre.x + s * (point.x - self.centre.x) + self.shift[0],
            self.centre.y + s * (point.y - self.centre.y) + self.shift[1],
        )
    }
}

impl CameraModel for Enlarged<'_> {
    fn size(&self) -> ImageSize {
        self.camera.size()
    }

    fn parameters(&self) -> Vec<CameraParameter> {
        let parameter = |name, unit, value| CameraParameter { name, unit, value };
        vec![parameter("scale", "", self.scale), parameter("dx", "px", self.shift[0]), parameter("dy", "px", self.shift[1])]
    }

    fn with_parameters(&self, values: &[f64]) -> Self {
        Self { scale: values[0], shift: [values[1], values[2]], ..*self }
    }

    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
        self.camera.project(ray).map(|point| self.image(point))
    }

    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart> {
        let back = |value: f64, centre: f64, shift: f64| centre + (value - shift - centre) / (1.0 + self.scale);
        self.camera.unproject(PixelPoint::new(back(point.x, self.centre.x, self.shift[0]), back(point.y, self.centre.y, self.shift[1])))
    }

    fn derivatives_into(&self, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart> {
        self.camera.derivatives_into(ray, into)?;
        let by_scale = [into.point.x - self.centre.x, into.point.y - self.centre.y];
        into.point = self.image(into.point);
        into.by_ray = into.by_ray.map(|row| row.map(|value| value * (1.0 + self.scale)));
        into.clear();
        into.extend([by_scale, [1.0, 0.0], [0.0, 1.0]]);
        Ok(())
    }

    fn fold_towards(&self, angle: f64) -> Option<PixelPoint> {
        self.camera.fold_towards(angle).map(|point| self.image(point))
    }
}
