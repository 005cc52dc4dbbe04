//! An answer against the true camera.

use calibench_adjust::{Distance, frame_uncertainty};
use calibench_model::camera::{Camera, CameraModel, ImageSize, Ray};
use calibench_model::convert::{Rotation, Vector, cell_share, difference_of_rays};
use calibench_model::{Covariance, PixelPoint};

use crate::{Answer, Lens};

/// Columns of the grid over the frame.
const COLUMNS: usize = 25;
/// Share of the frame's area that the true camera pictures and that has to be comparable.
const COMPARABLE: f64 = 0.99;
/// The length whose error is told, object units of mm.
pub const LENGTH_MM: f64 = 100.0;
/// The angle from the axis up to which lengths are compared, as its cosine: a plane across the axis is seen there.
const STEEPEST: f64 = 0.5;

/// Places over the frame, from the first pixel's centre to the last's, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Columns and rows.
    pub counts: (usize, usize),
    /// The places, px.
    pub places: Vec<PixelPoint>,
}

impl Grid {
    /// That of a frame: as many rows as make it square, at most as many as columns.
    pub fn new(size: ImageSize) -> Self {
        let (width, height) = (f64::from(size.width.max(2) - 1), f64::from(size.height.max(2) - 1));
        let rows = (((COLUMNS - 1) as f64 * height / width).round() as usize + 1).clamp(3, COLUMNS);
        let place = |row: usize, column: usize| {
            PixelPoint::new(width * column as f64 / (COLUMNS - 1) as f64, height * row as f64 / (rows - 1) as f64)
        };
        let places = (0..rows).flat_map(|row| (0..COLUMNS).map(move |column| place(row, column))).collect();
        Self { counts: (COLUMNS, rows), places }
    }

    /// Of each place whether something was measured not farther from it than its neighbours are.
    pub fn covered(&self, measured: &[PixelPoint]) -> Vec<bool> {
        let (columns, rows) = self.counts;
        let Some(last) = self.places.last() else { return Vec::new() };
        let step = [last.x / (columns - 1) as f64, last.y / (rows - 1) as f64];
        let mut covered = vec![false; self.places.len()];
        for at in measured {
            let [x, y] = [at.x / step[0], at.y / step[1]];
            for (row, column) in [(y.floor(), x.floor()), (y.floor(), x.ceil()), (y.ceil(), x.floor()), (y.ceil(), x.ceil())] {
                if row >= 0.0 && column >= 0.0 && (row as usize) < rows && (column as usize) < columns {
                    covered[row as usize * columns + column as usize] = true;
                }
            }
        }
        covered
    }
}

/// How far an answered camera is from the true one.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// Over the whole frame after the best rotation, RMS (2D), px.
    pub frame_px: f64,
    /// The same over the part where something was measured, after the rotation that is best there; `None` where hardly anything was.
    pub covered_px: Option<f64>,
    /// The rotation, as it shifts the middle of the frame, px.
    pub rotation_px: f64,
    /// The error of a length of 100 mm across the line of sight, at the distance of [`Truth::distance`], RMS over the frame, mm.
    pub length_mm: Option<f64>,
    /// What is stated, over the whole frame, RMS (2D), px.
    pub stated_px: Option<f64>,
    /// Mean square of errors over the frame in stated standard deviations, of x and y each: 1 where what is stated is true.
    pub z2_frame: Option<f64>,
    /// The same of the parameters, where the true camera has them too.
    pub z2_parameters: Option<f64>,
}

/// What is true.
pub struct Truth<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// The same in the model that was asked for, where that is one and the same.
    pub in_model: Option<Camera>,
    /// At which distance lengths are compared, mm.
    pub distance: f64,
}

impl Score {
    /// Of `answer` where `measured` points were given; `None` without a camera.
    ///
    /// # Errors
    /// Why the camera cannot be compared, in words: it does not picture what the true one pictures.
    pub fn of(answer: &Answer, grid: &Grid, truth: &Truth<'_>, measured: &[PixelPoint]) -> Result<Option<Self>, String> {
        let Some(lens) = &answer.lens else { return Ok(None) };
        let rays = rays_of(lens, &grid.places);
        let share = |at: &PixelPoint| cell_share(truth.camera.size(), *at);
        let pictured: Vec<bool> = grid.places.iter().map(|at| truth.camera.unproject(*at).is_ok()).collect();
        let asked: f64 = grid.places.iter().zip(&pictured).filter(|(_, pictured)| **pictured).map(|(at, _)| share(at)).sum();
        let all = Compared::of(grid, &rays, &pictured, truth.camera)?;
        let found: f64 = all.vectors.iter().flatten().map(|vector| share(&vector.at)).sum();
        if found < COMPARABLE * asked {
            return Err(format!("it does not picture {:.0} % of the frame", 100.0 * (1.0 - found / asked)));
        }
        let covered = grid.covered(measured);
        let both: Vec<bool> = covered.iter().zip(&pictured).map(|(covered, pictured)| *covered && *pictured).collect();
        let covered_px = Compared::of(grid, &rays, &both, truth.camera).ok().map(|compared| compared.rms(truth.camera.size()));
        let uncertainty = uncertainty_of(answer, grid);
        let z = uncertainty.as_ref().map(|stated| all.z2(stated, truth.camera.size()));
        Ok(Some(Self {
            frame_px: all.rms(truth.camera.size()),
            covered_px,
            rotation_px: all.rotation.angle() * focal_px(truth.camera),
            length_mm: all.length(grid, truth, &rays),
            stated_px: uncertainty.as_ref().and_then(|stated| rms_stated(stated, grid, truth.camera.size())),
            z2_frame: z.flatten(),
            z2_parameters: z2_parameters(answer, truth),
        }))
    }
}

/// The rays of a lens at the places that were asked for.
pub fn rays_of(lens: &Lens, places: &[PixelPoint]) -> Vec<Option<Ray>> {
    match lens {
        Lens::Camera(named) => places.iter().map(|at| named.camera.unproject(*at).ok()).collect(),
        Lens::Rays(rays) => rays.clone(),
    }
}

/// Pixels to a radian in the middle of the frame.
fn focal_px(camera: &Camera) -> f64 {
    let size = camera.size();
    let middle = PixelPoint::new(0.5 * f64::from(size.width), 0.5 * f64::from(size.height));
    let aside = PixelPoint::new(middle.x + 1.0, middle.y);
    let (Ok(a), Ok(b)) = (camera.unproject(middle), camera.unproject(aside)) else { return f64::NAN };
    let [a, b] = [a, b].map(|ray| nalgebra::Vector3::new(ray.x, ray.y, ray.z));
    1.0 / a.angle(&b)
}

struct Compared {
    /// Of each place of the grid.
    vectors: Vec<Option<Vector>>,
    rotation: Rotation,
}

impl Compared {
    /// Over the places of `grid` that are `asked` for.
    fn of(grid: &Grid, rays: &[Option<Ray>], asked: &[bool], camera: &Camera) -> Result<Self, String> {
        let chosen: Vec<usize> = (0..grid.places.len()).filter(|&place| asked[place] && rays[place].is_some()).collect();
        let given: Vec<(PixelPoint, Ray)> = chosen.iter().filter_map(|&place| Some((grid.places[place], rays[place]?))).collect();
        let (found, rotation) = difference_of_rays(&given, camera).map_err(|error| error.to_string())?;
        let mut vectors = vec![None; grid.places.len()];
        chosen.into_iter().zip(found).for_each(|(place, vector)| vectors[place] = vector);
        Ok(Self { vectors, rotation })
    }

    fn rms(&self, size: ImageSize) -> f64 {
        mean(self.vectors.iter().flatten().map(|vector| (vector.length().powi(2), cell_share(size, vector.at)))).unwrap_or(f64::NAN).sqrt()
    }

    fn z2(&self, stated: &[Option<Covariance>], size: ImageSize) -> Option<f64> {
        let place = |(vector, stated): (&Option<Vector>, &Option<Covariance>)| {
            let (vector, stated) = ((*vector)?, (*stated)?);
            Some((0.5 * (vector.dx.powi(2) / stated.sxx + vector.dy.powi(2) / stated.syy), cell_share(size, vector.at)))
        };
        mean(self.vectors.iter().zip(stated).filter_map(place))
    }

    /// The RMS error of lengths between places of a row or column that are about 100 mm apart on a plane across the axis.
    fn length(&self, grid: &Grid, truth: &Truth<'_>, rays: &[Option<Ray>]) -> Option<f64> {
        let on_plane = |ray: Ray| {
            let ray = nalgebra::Vector3::new(ray.x, ray.y, ray.z);
            (-ray.z >= STEEPEST * ray.norm()).then(|| ray * (truth.distance / -ray.z))
        };
        let (columns, rows) = grid.counts;
        let seen: Vec<_> = (0..grid.places.len())
            .map(|place| Some((on_plane(truth.camera.unproject(grid.places[place]).ok()?)?, on_plane(self.rotation.apply(rays[place]?))?)))
            .collect();
        let mut errors = Vec::new();
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let Some(from) = seen[row * columns + column] else { continue };
            let along = [
                (column + 1..columns).map(|other| row * columns + other).collect::<Vec<_>>(),
                (row + 1..rows).map(|other| other * columns + column).collect(),
            ];
            for ends in along {
                let lengths = ends.into_iter().filter_map(|end| seen[end].map(|to| ((to.0 - from.0).norm(), (to.1 - from.1).norm())));
                let nearest = lengths.min_by(|a, b| (a.0 - LENGTH_MM).abs().total_cmp(&(b.0 - LENGTH_MM).abs()));
                errors.extend(
                    nearest
                        .filter(|(length, _)| (0.5..2.0).contains(&(length / LENGTH_MM)))
                        .map(|(length, found)| ((found - length) * LENGTH_MM / length).powi(2)),
                );
            }
        }
        (!errors.is_empty()).then(|| (errors.iter().sum::<f64>() / errors.len() as f64).sqrt())
    }
}

/// The weighted mean of values with weights; `None` of nothing.
fn mean(values: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let (sum, weights) = values.fold((0.0, 0.0), |(sum, weights), (value, weight)| (sum + value * weight, weights + weight));
    (weights > 0.0).then(|| sum / weights)
}

/// What an answer states of each place.
fn uncertainty_of(answer: &Answer, grid: &Grid) -> Option<Vec<Option<Covariance>>> {
    if !answer.precision.at_grid.is_empty() {
        return Some(answer.precision.at_grid.clone());
    }
    let (Some((names, matrix)), Some(Lens::Camera(named))) = (&answer.precision.covariance, &answer.lens) else { return None };
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let found = frame_uncertainty(&named.camera, (&names, matrix), grid.counts, Distance::Far).ok()?;
    // Places without a ray are left out of it.
    let mut found = found.into_iter().peekable();
    let at = |place: &PixelPoint| found.next_if(|one| one.at.distance(*place) < 1e-6).map(|one| one.covariance);
    Some(grid.places.iter().map(at).collect())
}

fn rms_stated(stated: &[Option<Covariance>], grid: &Grid, size: ImageSize) -> Option<f64> {
    let place = |(at, own): (&PixelPoint, &Option<Covariance>)| own.map(|own| (own.sxx + own.syy, cell_share(size, *at)));
    mean(grid.places.iter().zip(stated).filter_map(place)).map(f64::sqrt)
}

fn z2_parameters(answer: &Answer, truth: &Truth<'_>) -> Option<f64> {
    let (Some(Lens::Camera(named)), Some(truth)) = (&answer.lens, truth.in_model) else { return None };
    let sigmas: Vec<(&str, f64)> = match &answer.precision.covariance {
        Some((names, matrix)) => names.iter().enumerate().map(|(i, name)| (name.as_str(), matrix[(i, i)].sqrt())).collect(),
        None => answer.precision.sigmas.iter().map(|(name, sigma)| (name.as_str(), *sigma)).collect(),
    };
    let (own, truth) = (named.camera.parameters(), truth.parameters());
    let z2 = |(name, sigma): (&str, f64)| {
        let value = own.iter().find(|parameter| parameter.name == name)?.value;
        let true_value = truth.iter().find(|parameter| parameter.name == name)?.value;
        (sigma > 0.0).then(|| (((value - true_value) / sigma).powi(2), 1.0))
    };
    mean(sigmas.into_iter().filter_map(z2))
}
