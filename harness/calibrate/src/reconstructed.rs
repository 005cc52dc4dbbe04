//! Reconstructions of other tools, adjusted anew: their cameras, orientations and points are start values of a free network.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::f64::consts::PI;
use std::sync::Arc;

use calibench_adjust::{Exterior, ObjectPoint, Use};
use calibench_diagnostics::nearest;
use calibench_model::camera::{Camera, CameraModel, NoCounterpart, Ray};
use calibench_model::observation::Start;
use calibench_model::reconstruction::{OrientedImage, ReconstructedCamera, TiePoint, TieSight};
use calibench_model::{ControlRow, LostRows, NamedCamera, Points, Pose, Reconstruction, upper_median};
use glob::Pattern;
use nalgebra::{Point3, Vector3};

use crate::distances::scale_by;
use crate::start::Starts;
use crate::{Calibration, CalibrationError, DatumChoice, LeftOut, Optics, Prepared, Settings, Shape, Survey, few, network};

/// Image points of an image, and images of a point, from which either is determined.
const FEWEST: (usize, usize) = (4, 2);

/// Of points that hold the frame: images at least, rays that part by this much, rad, and distance from the middle at most, in medians.
const HELD: (usize, f64, f64) = (3, 0.05, 3.0);
/// Fewer hold no frame better than all.
const ENOUGH: usize = 10;

/// What is done about image points whose object point lies behind its camera, where nothing is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Behind {
    /// They count, pictured by the line through the projection centre, as the formulas of most tools do.
    #[default]
    Count,
    /// They are left out.
    LeaveOut,
}

/// Which interior orientations are adjusted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Solved {
    /// Focal lengths and distortion, as far as the tool's own model has them, and no principal points.
    #[default]
    Lens,
    /// These parameters, of each camera.
    Named(Vec<String>),
}

/// A reconstruction as a network with start values.
#[derive(Clone, Debug)]
pub struct Reconstructed {
    /// What is to be adjusted.
    pub prepared: Prepared,
    /// Images that take no part, since too few of their points do.
    pub left_out_images: Vec<String>,
    /// Sights whose point lies behind its camera, as image and point.
    pub behind: Vec<[String; 2]>,
    /// Sights that the lens as the file has it does not picture, as image and point; they are left out.
    pub not_pictured: Vec<[String; 2]>,
}

/// How a sight begins.
#[derive(Clone, Copy, PartialEq)]
enum Begin {
    Before,
    Behind,
    NotPictured,
}

/// The network of a reconstruction: `settings` with its cameras and a free datum, unless another minimal one is asked for.
///
/// # Errors
/// A point that an image shows twice, names of parameters that a camera does not have, a datum or distances of points that are not there, no image with enough points.
pub fn prepare_reconstruction(
    reconstruction: &Reconstruction,
    (solved, behind): (&Solved, Behind),
    settings: &Settings,
) -> Result<Reconstructed, CalibrationError> {
    names_are_unique(reconstruction)?;
    let reconstruction = &scaled(reconstruction, settings);
    let begins: Vec<Begin> = reconstruction.sights.iter().map(|sight| begin(reconstruction, sight)).collect();
    let counts = |begin: Begin| begin == Begin::Before || (begin == Begin::Behind && behind == Behind::Count);
    let images = images_in_use(reconstruction, &begins.iter().map(|begin| counts(*begin)).collect::<Vec<_>>());
    let datum = match &settings.datum {
        DatumChoice::Control | DatumChoice::Fixed | DatumChoice::Free => free_datum(reconstruction),
        other => other.clone(),
    };
    let settings = Settings { cameras: cameras(reconstruction, &images, solved)?, datum, ..settings.clone() };
    let taken: Vec<usize> = (0..reconstruction.sights.len()).filter(|&i| images.contains(&reconstruction.sights[i].image)).collect();
    let survey = survey(reconstruction, &taken)?;
    let (starts, owners) = starts(reconstruction, &survey, &settings, &taken, |sight| counts(begins[sight]));
    let (mut network, mut sights, mut left_out) = network::network(&survey, &owners, &starts, &settings)?;
    let mut place = 0;
    network.observations.retain_mut(|observation| {
        let begin = begins[taken[sights[place] as usize]];
        place += 1;
        observation.behind = begin == Begin::Behind;
        counts(begin)
    });
    let why = |begin| if begin == Begin::Behind { "its point lies behind the camera" } else { "the lens does not picture it" };
    sights.retain(|&sight| {
        let begin = begins[taken[sight as usize]];
        if !counts(begin) {
            left_out.push(LeftOut { sight: sight as usize, why: why(begin).into() });
        }
        counts(begin)
    });
    left_out.sort_by_key(|left_out| left_out.sight);
    let named = |which: Begin| begins.iter().zip(&reconstruction.sights).filter(move |(begin, _)| **begin == which);
    let names = |(_, sight): (&Begin, &TieSight)| {
        [reconstruction.images[sight.image].name.clone(), reconstruction.points[sight.point].name.clone()]
    };
    let left_out_images = (0..reconstruction.images.len()).filter(|image| !images.contains(image));
    Ok(Reconstructed {
        left_out_images: left_out_images.map(|image| reconstruction.images[image].name.clone()).collect(),
        behind: named(Begin::Behind).map(names).collect(),
        not_pictured: named(Begin::NotPictured).map(names).collect(),
        prepared: Prepared {
            plain: starts.cameras.clone(),
            origins: starts.origins,
            rivals: Vec::new(),
            shape: Shape::Untouched,
            held: Vec::new(),
            scatter: Vec::new(),
            eccentricity: None,
            lengths: network::lengths(&survey, &settings, &network)?,
            survey: Arc::new(survey),
            settings,
            network,
            sights,
            left_out,
            unmeasured: LostRows::default(),
            far: Vec::new(),
            disputed: Vec::new(),
            notes: Vec::new(),
            is_given: true,
        },
    })
}

impl Reconstructed {
    /// Notes which cameras the tool took as mounted rigidly to each other, of each such rig their indices in the reconstruction: here each image has a pose of its own.
    pub fn note_rigs(&mut self, reconstruction: &Reconstruction, rigs: &[Vec<usize>]) {
        let is_used = |name: &String| self.prepared.settings.cameras.iter().any(|optics| optics.name == *name);
        let words = |rig: &Vec<usize>| {
            let names = rig.iter().map(|&camera| reconstruction.cameras[camera].named.name.clone());
            let names: Vec<String> = names.filter(is_used).collect();
            (names.len() > 1).then(|| {
                format!(
                    "the file has cameras {} as a rig; here they are not: each image is adjusted with a pose of its own, and relative poses may differ from moment to moment",
                    few(&names)
                )
            })
        };
        self.prepared.notes = rigs.iter().filter_map(words).collect();
    }

    /// What is in doubt of the reconstruction itself, in words.
    pub fn doubts(&self, behind: Behind) -> Vec<String> {
        let what = match behind {
            Behind::Count => "they count, pictured by the line through the projection centre; `--behind leave-out` leaves them out",
            Behind::LeaveOut => "they are left out",
        };
        let of = |all: &[[String; 2]]| few(&all.iter().map(|[image, point]| format!("{point} in {image}")).collect::<Vec<_>>());
        let mut doubts = Vec::new();
        if !self.behind.is_empty() {
            let (count, names) = (self.behind.len(), of(&self.behind));
            doubts.push(format!("{count} image points are of points behind their cameras, where nothing is seen ({names}): {what}"));
        }
        if !self.not_pictured.is_empty() {
            let (count, names) = (self.not_pictured.len(), of(&self.not_pictured));
            doubts.push(format!("{count} image points are where the lens of the file has folded over ({names}): they are left out"));
        }
        if !self.left_out_images.is_empty() {
            let (count, names) = (self.left_out_images.len(), few(&self.left_out_images));
            doubts.push(format!("{count} images show fewer than {} points that others show too ({names}): they are left out", FEWEST.0));
        }
        doubts
    }
}

impl Calibration<'_> {
    /// `given` with cameras, images and points as they were adjusted, and the image points that took part; and the mean length of the residuals of each point, px.
    pub fn reconstruction(&self, given: &Reconstruction) -> (Reconstruction, Vec<f64>) {
        let network = &self.prepared.network;
        let mut adjusted = Reconstruction::default();
        let by_name: HashMap<&str, &ReconstructedCamera> =
            given.cameras.iter().map(|camera| (camera.named.name.as_str(), camera)).collect();
        for (index, optics) in self.prepared.settings.cameras.iter().enumerate() {
            let before = by_name[optics.name.as_str()];
            let named = NamedCamera { camera: *self.camera(index), ..before.named.clone() };
            adjusted.cameras.push(ReconstructedCamera { named, ..before.clone() });
        }
        let image =
            |(exterior, pose): (&Exterior, &Pose)| OrientedImage { name: exterior.name.clone(), camera: exterior.camera, pose: *pose };
        adjusted.images = network.images.iter().zip(self.solution.poses()).map(image).collect();
        let point = |(point, position): (&ObjectPoint, &Point3<f64>)| TiePoint { name: point.name.clone(), position: *position };
        adjusted.points = network.points.iter().zip(self.solution.points()).map(point).collect();
        let mut lengths = vec![(0.0, 0_u32); network.points.len()];
        for residual in self.solution.each_residual().filter(|residual| residual.used != Use::LeftOut) {
            let observation = &network.observations[residual.observation];
            adjusted.sights.push(TieSight { image: observation.image, point: observation.point, position: observation.position });
            let Some([x, y]) = residual.v else { continue };
            lengths[observation.point].0 += x.hypot(y);
            lengths[observation.point].1 += 1;
        }
        (adjusted, lengths.into_iter().map(|(sum, count)| sum / f64::from(count)).collect())
    }
}

/// The reconstruction in the units of the distances, where there are any.
fn scaled<'r>(reconstruction: &'r Reconstruction, settings: &Settings) -> Cow<'r, Reconstruction> {
    let at: HashMap<&str, Point3<f64>> = match settings.distances[..] {
        [] => HashMap::new(),
        _ => reconstruction.points.iter().map(|point| (point.name.as_str(), point.position)).collect(),
    };
    let Some(scale) = scale_by(&settings.distances, |name| at.get(name).copied()) else { return Cow::Borrowed(reconstruction) };
    let mut scaled = reconstruction.clone();
    scaled.images.iter_mut().for_each(|image| image.pose.centre *= scale);
    scaled.points.iter_mut().for_each(|point| point.position *= scale);
    Cow::Owned(scaled)
}

/// Inner constraints over the points that images hold well, so that none of those that lie far off holds the frame.
fn free_datum(reconstruction: &Reconstruction) -> DatumChoice {
    let mut rays: Vec<Vec<Vector3<f64>>> = vec![Vec::new(); reconstruction.points.len()];
    for sight in &reconstruction.sights {
        rays[sight.point].push(reconstruction.points[sight.point].position - reconstruction.images[sight.image].pose.centre);
    }
    let is_wide =
        |rays: &Vec<Vector3<f64>>| rays.len() >= HELD.0 && rays.iter().any(|ray| (HELD.1..PI - HELD.1).contains(&ray.angle(&rays[0])));
    let wide: Vec<&TiePoint> = reconstruction.points.iter().zip(&rays).filter(|(_, rays)| is_wide(rays)).map(|(point, _)| point).collect();
    let middle = [0, 1, 2].map(|axis| upper_median(wide.iter().map(|point| point.position[axis])).unwrap_or_default());
    let off = |point: &TiePoint| (point.position - Point3::from(middle)).norm();
    let most = HELD.2 * upper_median(wide.iter().map(|point| off(point))).unwrap_or_default();
    let held: Vec<String> = wide.into_iter().filter(|point| off(point) <= most).map(|point| point.name.clone()).collect();
    if held.len() == reconstruction.points.len() || held.len() < ENOUGH { DatumChoice::Free } else { DatumChoice::FreeOver(held) }
}

/// Everything is found again by its name.
fn names_are_unique(reconstruction: &Reconstruction) -> Result<(), CalibrationError> {
    differ("images", reconstruction.images.iter().map(|image| image.name.as_str()))?;
    differ("cameras", reconstruction.cameras.iter().map(|camera| camera.named.name.as_str()))?;
    differ("points", reconstruction.points.iter().map(|point| point.name.as_str()))
}

fn differ<'a>(what: &str, mut names: impl Iterator<Item = &'a str>) -> Result<(), CalibrationError> {
    let mut seen = HashSet::new();
    let again = names.find(|name| !seen.insert(*name)).map(|name| format!("two {what} are called `{name}`; expected names that differ"));
    again.map_or(Ok(()), |why| Err(CalibrationError::Reconstruction { why }))
}

fn begin(reconstruction: &Reconstruction, sight: &TieSight) -> Begin {
    let image = &reconstruction.images[sight.image];
    let (camera, ray) = (&reconstruction.cameras[image.camera].named.camera, image.pose.ray(&reconstruction.points[sight.point].position));
    match camera.project(ray) {
        Ok(_) => Begin::Before,
        Err(NoCounterpart::Behind) if camera.project(Ray { x: -ray.x, y: -ray.y, z: -ray.z }).is_ok() => Begin::Behind,
        Err(_) => Begin::NotPictured,
    }
}

/// Images that show enough points which other images show too.
fn images_in_use(reconstruction: &Reconstruction, counts: &[bool]) -> HashSet<usize> {
    let mut images: HashSet<usize> = (0..reconstruction.images.len()).collect();
    loop {
        let (mut of_point, mut of_image) = (vec![0_usize; reconstruction.points.len()], vec![0_usize; reconstruction.images.len()]);
        let in_use = || reconstruction.sights.iter().zip(counts).filter(|(sight, counts)| **counts && images.contains(&sight.image));
        in_use().for_each(|(sight, _)| of_point[sight.point] += 1);
        in_use().filter(|(sight, _)| of_point[sight.point] >= FEWEST.1).for_each(|(sight, _)| of_image[sight.image] += 1);
        let before = images.len();
        images.retain(|&image| of_image[image] >= FEWEST.0);
        if images.len() == before {
            return images;
        }
    }
}

/// The cameras of the images in use, in the file's order, each with the names of its images.
fn cameras(reconstruction: &Reconstruction, images: &HashSet<usize>, solved: &Solved) -> Result<Vec<Optics>, CalibrationError> {
    let mut of_camera: BTreeMap<usize, Vec<Pattern>> = BTreeMap::new();
    for (index, image) in reconstruction.images.iter().enumerate().filter(|(index, _)| images.contains(index)) {
        let pattern = Pattern::new(&Pattern::escape(&image.name))
            .map_err(|_| CalibrationError::Reconstruction { why: reconstruction.images[index].name.clone() })?;
        of_camera.entry(image.camera).or_default().push(pattern);
    }
    if of_camera.is_empty() {
        let why = format!("no image shows {} points or more that others show too", FEWEST.0);
        return Err(CalibrationError::Reconstruction { why });
    }
    let optics = |(camera, images): (usize, Vec<Pattern>)| {
        let ReconstructedCamera { named, lens, .. } = &reconstruction.cameras[camera];
        let solve = match solved {
            Solved::Lens => lens.iter().map(|name| (*name).to_owned()).collect(),
            Solved::Named(names) => known(names, &named.camera, &named.name)?,
        };
        let start = named.camera;
        let model = Some(model(&start).to_owned());
        Ok(Optics { name: named.name.clone(), images, model, solve: Some(solve), start: Some(start), ..Optics::new(start.size()) })
    };
    of_camera.into_iter().map(optics).collect()
}

/// `names`, if the camera has them all.
fn known(names: &[String], camera: &Camera, of: &str) -> Result<Vec<String>, CalibrationError> {
    let own: Vec<&str> = camera.parameters().iter().map(|parameter| parameter.name).collect();
    match names.iter().find(|name| !own.contains(&name.as_str())) {
        None => Ok(names.to_vec()),
        Some(stranger) => {
            let near = nearest(stranger, own.iter().copied()).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            let why = format!("camera {of} has no parameter `{stranger}`; it has {}{near}", own.join(", "));
            Err(CalibrationError::Reconstruction { why })
        }
    }
}

/// What the model of a camera is called for [`crate::MODELS`].
fn model(camera: &Camera) -> &'static str {
    match camera {
        Camera::OpenCv(camera) => match camera.coefficients {
            4 => "opencv4",
            5 => "opencv5",
            8 => "opencv8",
            12 => "opencv12",
            _ => "opencv14",
        },
        Camera::OpenCvFisheye(_) => "opencv-fisheye",
        Camera::Agisoft(_) => "metashape",
        Camera::Eucm(_) => "eucm",
        Camera::Fov(_) => "fov",
        Camera::PrismFisheye(_) => "prism-fisheye",
        other => other.convention().name,
    }
}

/// The image points that are `taken`, in this order, and the object points as their start values.
fn survey(reconstruction: &Reconstruction, taken: &[usize]) -> Result<Survey, CalibrationError> {
    let mut points = Points::with_capacity(taken.len());
    for sight in taken.iter().map(|&index| &reconstruction.sights[index]) {
        points.push(&reconstruction.images[sight.image].name, &reconstruction.points[sight.point].name, Start::at(sight.position));
    }
    if let Some((_, second)) = points.twice() {
        let row = points.row(second);
        let why = format!("image {} shows point {} twice; expected each point once an image", row.image, row.target);
        return Err(CalibrationError::Reconstruction { why });
    }
    let rows: Vec<ControlRow> = reconstruction.points.iter().map(|point| ControlRow::new(&point.name, point.position.into())).collect();
    Survey::new(points, &rows)
}

/// Start values as the file has them, and the camera of each image.
fn starts(
    reconstruction: &Reconstruction,
    survey: &Survey,
    settings: &Settings,
    taken: &[usize],
    counts: impl Fn(usize) -> bool,
) -> (Starts, Vec<usize>) {
    let by_name: HashMap<&str, usize> =
        reconstruction.images.iter().enumerate().map(|(index, image)| (image.name.as_str(), index)).collect();
    let camera_of: HashMap<&str, usize> =
        settings.cameras.iter().enumerate().map(|(index, optics)| (optics.name.as_str(), index)).collect();
    let image_of = |name: &String| &reconstruction.images[by_name[name.as_str()]];
    let owners = survey.images.iter().map(|name| camera_of[reconstruction.cameras[image_of(name).camera].named.name.as_str()]).collect();
    let mut rays = vec![0_usize; survey.targets()];
    (0..survey.sights()).filter(|&sight| counts(taken[sight])).for_each(|sight| rays[survey.sight(sight).target] += 1);
    let point = |(target, rays): (usize, &usize)| match (survey.known(target), *rays >= FEWEST.1) {
        (Some(position), true) => Ok(position),
        _ => Err("one image alone shows its point".to_owned()),
    };
    let starts = Starts {
        cameras: settings.cameras.iter().filter_map(|optics| optics.start).collect(),
        origins: settings.cameras.iter().map(|_| "the reconstruction".to_owned()).collect(),
        poses: survey.images.iter().map(|name| image_of(name).pose).collect(),
        points: rays.iter().enumerate().map(point).collect(),
    };
    (starts, owners)
}
