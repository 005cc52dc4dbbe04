//! A block as a network, adjusted.

use calibench_adjust::{
    Covariances, Datum, Exterior, ImageObservation, Interior, Network, ObjectPoint, Options, Solution, Status, Variance, adjust,
};
use calibench_model::PixelPoint;
use calibench_model::camera::Camera;
use calibench_scenario::Block;
use nalgebra::{Point3, Vector3};

use super::Job;
use super::held::held;
use super::sights::Sights;

/// An adjusted network of a block.
pub struct Solved {
    /// The choice of images: the places of their stations.
    pub chosen: Vec<usize>,
    /// The images that are in it: the places of their stations.
    pub images: Vec<usize>,
    /// The cameras of all groups; start values where a group has no image.
    pub cameras: Vec<Camera>,
    /// Of the cameras that are in the network: group, and names and standard deviations of parameters in their order.
    pub sigmas: Vec<(usize, Vec<(&'static str, f64)>)>,
    /// Object points: target, adjusted place, standard deviations (object units).
    pub points: Vec<(usize, Point3<f64>, [f64; 3])>,
    /// Residuals: place of the station, target, (vx, vy) in px.
    pub residuals: Vec<(usize, usize, [f64; 2])>,
    /// Standard deviation of an image coordinate, px; `None` without redundancy.
    pub sigma0_px: Option<f64>,
    /// Observations as a paper counts them, those that hold the frame among them.
    pub observations: usize,
    /// Coordinates that are held to fix the frame: among unknowns and observations.
    pub held: usize,
    /// Unknowns.
    pub unknowns: usize,
    /// Mean over the images of how many pixels an object unit has at the distance of the points' middle, px.
    pub scale: f64,
    /// Iterations.
    pub iterations: usize,
    /// Gross errors that were left out.
    pub gross: usize,
}

/// Groups of stations, and the cameras that correct what was measured in each.
pub type Corrected<'a> = (&'a [usize], &'a [Camera]);

/// Adjusts every choice of images of `block`.
///
/// # Errors
/// In words: what a network does not determine, or no convergence.
pub fn adjusted(job: &Job<'_>, block: &Block, sights: &Sights, corrected: Option<Corrected<'_>>) -> Result<Vec<Solved>, String> {
    let one = |chosen: &Vec<usize>| {
        solve(job, block, sights, corrected, chosen)
            .map_err(|why| if block.several { format!("{}: {why}", name(job, chosen)) } else { why })
    };
    block.images.iter().map(one).collect()
}

/// The name of a choice of images.
pub fn name(job: &Job<'_>, chosen: &[usize]) -> String {
    chosen.iter().map(|&image| job.stations[image].name.as_str()).collect::<Vec<_>>().join("+")
}

fn solve(job: &Job<'_>, block: &Block, sights: &Sights, corrected: Option<Corrected<'_>>, chosen: &[usize]) -> Result<Solved, String> {
    let images: Vec<usize> = chosen.iter().copied().filter(|&image| sights.images[image].pose.is_some()).collect();
    let gross = images.iter().flat_map(|&image| &sights.images[image].gross).filter(|target| block.targets.contains(target)).count();
    let (groups, used) = groups(block, corrected, &images);
    let mut network = Network { cameras: interiors(job, block, corrected, &used)?, ..Network::default() };
    let place = |group: usize| used.iter().position(|&other| other == group);
    for &image in &images {
        let (Some(camera), Some(pose)) = (place(groups[image]), sights.images[image].pose) else { continue };
        network.images.push(Exterior::free(job.stations[image].name.as_str(), camera, pose));
    }
    let targets = observe(job, block, sights, &images, &mut network);
    let held = hold(block, &targets, &mut network)?;
    let solution = adjust(&network, &Options::default()).map_err(|error| error.to_string())?;
    let covariances = solution.covariances(Variance::Estimated).map_err(|error| error.to_string())?;
    let mut cameras =
        vec![job.blocks.camera.into(); used.iter().max().map_or(0, |most| most + 1).max(groups.iter().max().map_or(1, |most| most + 1))];
    used.iter().zip(solution.cameras()).for_each(|(&group, camera)| cameras[group] = *camera);
    let residuals = solution.each_residual().filter_map(|r| Some((images[r.image], targets[r.point], r.v?))).collect();
    let counts = solution.counts();
    // Fixed coordinates are no unknowns: counted as unknowns and as constraints they are on both sides, as those of a minimal datum.
    let fixed = if block.height_sigma.is_some() { held } else { 0 };
    let sigma = |point: usize| std::array::from_fn(|axis| covariances.points[point][(axis, axis)].max(0.0).sqrt());
    Ok(Solved {
        chosen: chosen.to_vec(),
        cameras,
        sigmas: sigmas(&covariances, &used),
        points: targets.iter().zip(solution.points()).enumerate().map(|(i, (&target, at))| (target, *at, sigma(i))).collect(),
        residuals,
        sigma0_px: solution.sigma0().map(|sigma0| sigma0 * job.blocks.sigma_px),
        observations: counts.observations() + fixed,
        held,
        unknowns: counts.unknowns + fixed,
        scale: scale(job, &solution),
        iterations: solution.iterations(),
        gross,
        images,
    })
}

fn scale(job: &Job<'_>, solution: &Solution<'_>) -> f64 {
    let sum = solution.points().iter().map(|point| point.coords).sum::<Vector3<f64>>();
    let middle = sum / solution.points().len().max(1) as f64;
    let camera = job.blocks.camera.base;
    let of = |pose: &calibench_model::Pose| camera.c / (1e-3 * camera.pitch_um * (pose.centre.coords - middle).norm());
    solution.poses().iter().map(of).sum::<f64>() / solution.poses().len().max(1) as f64
}

/// Of each station its group, and the groups of `images` in their order.
fn groups<'a>(block: &'a Block, corrected: Option<Corrected<'a>>, images: &[usize]) -> (&'a [usize], Vec<usize>) {
    let groups = corrected.map_or(block.groups.as_slice(), |(groups, _)| groups);
    let mut used: Vec<usize> = images.iter().map(|&image| groups[image]).collect();
    used.sort_unstable();
    used.dedup();
    (groups, used)
}

fn interiors(job: &Job<'_>, block: &Block, corrected: Option<Corrected<'_>>, used: &[usize]) -> Result<Vec<Interior>, String> {
    let free: Vec<&str> = block.parameters.iter().map(String::as_str).collect();
    let interior = |&group: &usize| {
        let camera = corrected.and_then(|(_, cameras)| cameras.get(group)).copied().unwrap_or_else(|| job.blocks.camera.into());
        Interior::fixed(format!("group {}", group + 1), camera).free(&free).map_err(|error| error.to_string())
    };
    used.iter().map(interior).collect()
}

/// Adds points and observations to `network`; the targets of its points.
fn observe(job: &Job<'_>, block: &Block, sights: &Sights, images: &[usize], network: &mut Network) -> Vec<usize> {
    let count = job.field.targets.len();
    let (mut wanted, mut rays) = (vec![false; count], vec![0_usize; count]);
    block.targets.iter().for_each(|&target| wanted[target] = true);
    let choose = |&image: &usize| sights.images[image].chosen(job, image, &wanted, block.points_per_image);
    let seen: Vec<Vec<(usize, PixelPoint)>> = images.iter().map(choose).collect();
    seen.iter().flatten().for_each(|(target, _)| rays[*target] += 1);
    // A point of one ray is determined where its height is observed.
    let least = if block.height_sigma.is_some() { 1 } else { 2 };
    let targets: Vec<usize> = (0..count).filter(|&target| rays[target] >= least).collect();
    let mut places = vec![None; count];
    for (place, &target) in targets.iter().enumerate() {
        places[target] = Some(place);
        let target = &job.field.targets[target];
        let mut point = ObjectPoint::free(target.id.as_str(), target.surveyed);
        if let Some(sigma) = block.height_sigma {
            point.coordinates[2] = Status::Observed { value: target.surveyed.z, sigma };
        }
        network.points.push(point);
    }
    for (image, mine) in seen.iter().enumerate() {
        let of = |&(target, at): &(usize, PixelPoint)| Some(ImageObservation::new(image, places[target]?, at, job.blocks.sigma_px));
        network.observations.extend(mine.iter().filter_map(of));
    }
    targets
}

/// Fixes the frame of `network`: by a minimal datum, or, where all heights are observed, by two horizontal points. How many coordinates are held.
fn hold(block: &Block, targets: &[usize], network: &mut Network) -> Result<usize, String> {
    let mut rays = vec![0_usize; targets.len()];
    network.observations.iter().for_each(|observation| rays[observation.point] += 1);
    let able: Vec<usize> = (0..targets.len()).filter(|&point| rays[point] > 1).collect();
    let places: Vec<Point3<f64>> = able.iter().map(|&point| network.points[point].position).collect();
    let (horizontal, vertical) = held(&places).ok_or("no three points that are in two images each and not on a line")?;
    let (horizontal, vertical) = (horizontal.map(|i| able[i]), vertical.map(|i| able[i]));
    if block.height_sigma.is_none() {
        network.datum = Datum::Minimal { horizontal, vertical };
        return Ok(7);
    }
    for point in horizontal {
        network.points[point].coordinates[..2].fill(Status::Fixed);
    }
    Ok(4)
}

fn sigmas(covariances: &Covariances, used: &[usize]) -> Vec<(usize, Vec<(&'static str, f64)>)> {
    let of = |(camera, &group): (usize, &usize)| {
        let (names, matrix) = covariances.of_camera(camera);
        (group, names.iter().enumerate().map(|(i, name)| (*name, matrix[(i, i)].max(0.0).sqrt())).collect())
    };
    used.iter().enumerate().map(of).collect()
}
