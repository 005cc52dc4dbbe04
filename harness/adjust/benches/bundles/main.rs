//! Seconds of adjustments, one thread. `cargo bench -p calibench-adjust --bench bundles`.

#[path = "../../tests/adjustment/scenes.rs"]
mod scenes;

use std::hint::black_box;
use std::time::Instant;

use calibench_adjust::{AdjustError, Network, Options, Variance, adjust};
use calibench_model::camera::CameraModel;

fn main() -> Result<(), AdjustError> {
    if std::env::args().any(|argument| argument == "--list" || argument == "--test") {
        return Ok(());
    }
    println!(
        "{:<44} {:>8} {:>8} {:>6} {:>10} {:>12} {:>10}",
        "", "observed", "unknown", "steps", "solution s", "covariance s", "sigma0 px"
    );
    for views in [17, 100, 1000, 5000] {
        race(&format!("board of 54 corners, {views} views"), || board(views), if views > 500 { 5 } else { 50 })?;
    }
    race("36 images x 256 points, OpenCV's camera", || ring(scenes::opencv(), &scenes::FIVE), 9)?;
    race("200 images x 5000 points, OpenCV's camera", || flight(scenes::opencv(), &scenes::FIVE), 3)?;
    let names = ["c", "x0", "y0", "k1", "k2", "p1", "p2"];
    race("36 images x 256 points, photogrammetric", || ring(scenes::photogrammetric(), &names), 9)?;
    race("200 images x 5000 points, photogrammetric", || flight(scenes::photogrammetric(), &names), 3)
}

/// The best of some rounds.
fn race(what: &str, network: impl FnOnce() -> Network, rounds: usize) -> Result<(), AdjustError> {
    if std::env::args().skip(1).any(|argument| !argument.starts_with('-') && !what.contains(&argument)) {
        return Ok(());
    }
    let network = &network();
    let options = Options::default();
    let mut best = [f64::INFINITY; 2];
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
    }
    let (counts, sigma0) = (solution.counts(), solution.sigma0().unwrap_or(f64::NAN));
    let (observed, unknowns, steps) = (counts.observations(), counts.unknowns, solution.iterations());
    println!("{what:<44} {observed:>8} {unknowns:>8} {steps:>6} {:>10.5} {:>12.5} {sigma0:>10.5}", best[0], best[1]);
    Ok(())
}

fn board(views: usize) -> Network {
    let mut network = scenes::board(scenes::opencv(), views, 1);
    scenes::free(&mut network, &scenes::FIVE);
    let mut random = scenes::random(2);
    scenes::shake_pixels(&mut network, 0.2, &mut random);
    // As good as Zhang's closed form and a homography.
    scenes::shake_poses(&mut network, 5.0, 0.02, &mut random);
    start(&mut network, 1.03);
    network
}

fn ring(camera: calibench_model::camera::Camera, names: &[&str]) -> Network {
    let mut network = scenes::ring(camera, 36, 256, 1);
    prepared(&mut network, names, 0.05, 0.01, 32);
    network
}

fn flight(camera: calibench_model::camera::Camera, names: &[&str]) -> Network {
    let mut network = scenes::flight(camera, 1);
    prepared(&mut network, names, 1.0, 0.01, 100);
    network
}

fn prepared(network: &mut Network, names: &[&str], shift: f64, turn: f64, control: usize) {
    scenes::free(network, names);
    scenes::control(network, control, 1e-4 * shift);
    let mut random = scenes::random(2);
    scenes::shake_pixels(network, 0.2, &mut random);
    scenes::shake_poses(network, shift, turn, &mut random);
    for point in &mut network.points {
        point.position += nalgebra::Vector3::from_fn(|_, _| shift * scenes::normal(&mut random));
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
