//! Seconds of adjustments, one thread, beside Ceres Solver where a machine has it. `cargo bench --workspace --bench bundles`.
//!
//! Ceres gets the same observations and start values, and its optimum must be ours: `peers/ceres.rs`. Words after `--` choose problems by name.

#[path = "../peers/ceres.rs"]
mod ceres;
#[path = "../../tests/adjustment/networks.rs"]
mod networks;
#[path = "../../tests/adjustment/stands.rs"]
mod stands;

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use calibench_adjust::{Network, Options, Solution, Test, Variance, adjust};
use calibench_model::camera::CameraModel;

/// Differences above which the optima are not one: of the RMS (relative), of the parameters (in standard deviations), of these themselves (relative).
const SAME: [f64; 3] = [1e-9, 1e-3, 1e-5];

fn main() -> Result<(), Box<dyn Error>> {
    if std::env::args().any(|argument| argument == "--list" || argument == "--test") {
        return Ok(());
    }
    println!(
        "{:<44} {:>8} {:>8} {:>6} {:>10} {:>12} {:>10} {:>10}",
        "", "observed", "unknown", "steps", "solution s", "covariance s", "quality s", "sigma0 px"
    );
    for views in [17, 100, 1000, 5000] {
        race(&format!("board of 54 corners, {views} views"), || board(views), if views > 500 { 5 } else { 50 })?;
    }
    let (peer, mut required) = (ceres::Peer::compile(), Vec::new());
    beside(&peer, "36 images x 256 points, OpenCV's camera", || ring(networks::opencv(), &networks::FIVE), (9, 5.0), &mut required)?;
    beside(&peer, "200 images x 5000 points, OpenCV's camera", || flight(networks::opencv(), &networks::FIVE), (3, 2.0), &mut required)?;
    race("32 images of a bent stand, eight sets of Ebner's (0.1 s asked)", || stands::block(0.8, stands::Sets::Eight), 50)?;
    let names = ["c", "x0", "y0", "k1", "k2", "p1", "p2"];
    race("36 images x 256 points, photogrammetric", || ring(networks::photogrammetric(), &names), 9)?;
    race("200 images x 5000 points, photogrammetric", || flight(networks::photogrammetric(), &names), 3)?;
    race("1000 images x 37,746 points, OpenCV's camera", large, 1)?;
    if let Err(why) = peer {
        println!("{why}");
    }
    required.iter().for_each(|line| println!("{line}"));
    Ok(())
}

/// [`race`] beside Ceres, which it must beat so many times.
fn beside(
    peer: &Result<ceres::Peer, String>,
    what: &str,
    network: impl FnOnce() -> Network,
    (rounds, least): (usize, f64),
    required: &mut Vec<String>,
) -> Result<(), Box<dyn Error>> {
    let mut kept = None;
    let Some([ours, covariance]) = race(what, || kept.insert(network()).clone(), rounds)? else { return Ok(()) };
    let (Ok(peer), Some(network)) = (peer, kept) else { return Ok(()) };
    let solution = adjust(&network, &Options::default())?;
    let found = peer.solve(&network, ceres::Trust::Default, rounds, 1)?;
    same("its default", &found, &solution)?;
    let bold = peer.solve(&network, ceres::Trust::Bold, rounds, 0)?;
    same("1e8", &bold, &solution)?;
    let theirs = found.covariance.unwrap_or(f64::NAN);
    let mut row = |of: &str, least: f64, reached: f64| {
        if required.is_empty() {
            required.push(format!("\n{:<72} {:>9} {:>9}", "", "required", "reached"));
        }
        required.push(format!("{:<72} {least:>9.1} {reached:>9.1}", format!("{what}: {of}")));
    };
    row("solution / Ceres by default", least, found.seconds / ours);
    row("solution / Ceres, first trust region 1e8", least, bold.seconds / ours);
    row("covariance / Ceres' of interior and poses", least, theirs / covariance);
    Ok(())
}

/// The optimum of Ceres is ours.
fn same(radius: &str, found: &ceres::Found, ours: &Solution) -> Result<(), Box<dyn Error>> {
    let covariance = found.covariance.map_or_else(String::new, |seconds| format!("{seconds:.5}"));
    let what = format!("  Ceres, {}, trust region {radius}", found.solver);
    println!("{what:<61} {:>6} {:>10.5} {covariance:>12}", found.steps, found.seconds);
    let differs = found.differs(ours)?;
    let sigmas = if found.covariance.is_some() { differs.sigmas } else { 0.0 };
    println!(
        "    differs by {:.1e} in the RMS, {:.1e} sigma in the parameters, {sigmas:.1e} in the sigmas",
        differs.root, differs.parameters
    );
    let differs = [differs.root, differs.parameters, sigmas];
    // Not a number is no agreement either.
    if differs.iter().zip(SAME).all(|(differs, most)| *differs <= most) { Ok(()) } else { Err("the optima are not one".into()) }
}

/// Solution and covariance, the best of some rounds, printed with covariances and reliability together; `None` if the problem is not asked for.
fn race(what: &str, network: impl FnOnce() -> Network, rounds: usize) -> Result<Option<[f64; 2]>, Box<dyn Error>> {
    if std::env::args().skip(1).any(|argument| !argument.starts_with('-') && !what.contains(&argument)) {
        return Ok(None);
    }
    let network = &network();
    let options = Options::default();
    let mut best = [f64::INFINITY; 3];
    for _ in 0..rounds {
        let clock = Instant::now();
        black_box(adjust(black_box(network), &options)?);
        best[0] = best[0].min(clock.elapsed().as_secs_f64());
    }
    let solution = adjust(network, &options)?;
    for _ in 0..rounds {
        let clock = Instant::now();
        black_box(solution.covariances(Variance::Estimated)?);
        best[1] = best[1].min(clock.elapsed().as_secs_f64());
        let clock = Instant::now();
        black_box(solution.quality(Variance::Estimated, Test::default())?);
        best[2] = best[2].min(clock.elapsed().as_secs_f64());
    }
    let (counts, sigma0) = (solution.counts(), solution.sigma0().unwrap_or(f64::NAN));
    let (observed, unknowns, steps) = (counts.observations(), counts.unknowns, solution.iterations());
    let [solved, covariance, quality] = best;
    println!("{what:<44} {observed:>8} {unknowns:>8} {steps:>6} {solved:>10.5} {covariance:>12.5} {quality:>10.5} {sigma0:>10.5}");
    Ok(Some([solved, covariance]))
}

fn board(views: usize) -> Network {
    let mut network = networks::board(networks::opencv(), views, 1);
    networks::free(&mut network, &networks::FIVE);
    let mut random = networks::random(2);
    networks::shake_pixels(&mut network, 0.2, &mut random);
    // As good as Zhang's closed form and a homography.
    networks::shake_poses(&mut network, 5.0, 0.02, &mut random);
    start(&mut network, 1.03);
    network
}

fn ring(camera: calibench_model::camera::Camera, names: &[&str]) -> Network {
    let mut network = networks::ring(camera, 36, 256, 1);
    prepared(&mut network, names, 0.05, 0.01, 32);
    network
}

fn flight(camera: calibench_model::camera::Camera, names: &[&str]) -> Network {
    let mut network = networks::flight(camera, 1);
    prepared(&mut network, names, 1.0, 0.01, 100);
    network
}

/// 25 strips of 40 images: 767,000 image points.
fn large() -> Network {
    let mut network = networks::block(networks::opencv(), [40, 25], [233, 162], 1);
    prepared(&mut network, &networks::FIVE, 1.0, 0.01, 100);
    network
}

fn prepared(network: &mut Network, names: &[&str], shift: f64, turn: f64, control: usize) {
    networks::free(network, names);
    networks::control(network, control, 1e-4 * shift);
    let mut random = networks::random(2);
    networks::shake_pixels(network, 0.2, &mut random);
    networks::shake_poses(network, shift, turn, &mut random);
    for point in &mut network.points {
        point.position += nalgebra::Vector3::from_fn(|_, _| shift * networks::normal(&mut random));
    }
    start(network, 1.02);
}

/// Principal distances off by a factor, distortion unknown.
fn start(network: &mut Network, factor: f64) {
    let interior = &mut network.cameras[0];
    let start = |p: &calibench_model::camera::CameraParameter| match p.name {
        "fx" | "fy" | "c" => p.value * factor,
        "cx" | "cy" => p.value.round(),
        _ => 0.0,
    };
    let values: Vec<f64> = interior.camera.parameters().iter().map(start).collect();
    interior.camera = interior.camera.with_parameters(&values);
}
