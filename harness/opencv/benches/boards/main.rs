//! Seconds to calibrate from views of a board, beside OpenCV in process, mrcal and Ceres Solver, on the same corners.
//!
//! `cargo bench --workspace --bench boards`, followed by `-- VIEWS...` for some of 17, 100 and 1000 alone. One thread, best of some rounds. OpenCV runs
//! with its default criteria (30 iterations at most, DBL_EPSILON), and until the parameters change by less than 1e-12 of their norm (100 iterations at
//! most). Debian's OpenCV 4.6 solves all unknowns as one dense system: 1000 views take it more than five minutes, so that it gets them, once and by
//! default, only where `-- opencv` asks for it. We stop when a step gains nothing. mrcal and Ceres, where a machine has them, get the start values of our
//! first row. That all reach one optimum is checked: `optima.rs`.

#[path = "../../../adjust/benches/peers/ceres.rs"]
mod ceres;
#[path = "../../../adjust/tests/adjustment/networks.rs"]
mod networks;
mod optima;
mod peers;
mod problem;
#[path = "../../tests/beside/optimum/theirs.rs"]
mod theirs;

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use calibench_adjust::{Network, Options, Variance, adjust};
use calibench_model::camera::CameraModel;
use theirs::calibrate;

/// OpenCV's criteria: iterations at most, and relative change of the parameters at which it stops.
const DEFAULT: (i32, f64) = (30, f64::EPSILON);
const TIGHT: (i32, f64) = (100, 1e-12);
/// Of the run that says where its optimum is.
const END: (i32, f64) = (100, f64::EPSILON);
/// Views up to which OpenCV runs without being asked for.
const MANY: usize = 100;

/// A ratio asked for, and that reached; `None` where the peer is not on this machine.
struct Required {
    what: String,
    least: f64,
    reached: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "--list" || argument == "--test") {
        return Ok(());
    }
    opencv::core::set_num_threads(1)?;
    println!("Boards of 54 corners, five coefficients, one thread; OpenCV {}", calibench_opencv::version());
    let (peer, mut required) = (ceres::Peer::compile(), Vec::new());
    let patient = arguments.iter().any(|argument| argument == "opencv");
    let wanted: Vec<usize> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    for (views, rounds) in [(17, 40), (100, 20), (1000, 5)] {
        if wanted.is_empty() || wanted.contains(&views) {
            required.extend(race(views, rounds, peer.as_ref().ok(), patient)?);
        }
    }
    println!("\n{:<72} {:>9} {:>9}", "", "required", "reached");
    for Required { what, least, reached } in required {
        let reached = reached.map_or_else(|| "not run".to_owned(), |reached| format!("{reached:.1}"));
        println!("{what:<72} {least:>9.1} {reached:>9}");
    }
    if let Err(why) = peer {
        println!("{why}");
    }
    Ok(())
}

/// A line of the table.
fn line(what: &str, seconds: f64, steps: Option<usize>, remark: &str) {
    let steps = steps.map_or_else(String::new, |steps| format!("{steps} steps"));
    println!("  {what:<48} {seconds:>10.5} s {steps:>9}  {remark}");
}

fn race(views: usize, rounds: usize, peer: Option<&ceres::Peer>, patient: bool) -> Result<Vec<Required>, Box<dyn Error>> {
    println!("\n{views} views");
    let network = problem::problem(views);
    let ours = ours(&network, views, rounds)?;
    let [mrcal, ceres @ ..] = same_start(&network, views, rounds, peer)?;
    let usual = if views <= MANY {
        Some(from_corners(&network, views, rounds)?)
    } else if patient {
        Some(once(&network, views)?)
    } else {
        println!("  OpenCV is not run: more than five minutes (cargo bench --workspace --bench boards -- {views} opencv)");
        None
    };
    let row = |what: &str, least: f64, reached: Option<f64>| Required { what: format!("{views} views: {what}"), least, reached };
    Ok(vec![
        row("given start values / mrcal, times faster", 10.0, mrcal.map(|seconds| seconds / ours.given)),
        row("given start values / Ceres by default, times faster", 10.0, ceres[0].map(|seconds| seconds / ours.given)),
        row("given start values / Ceres, first trust region 1e8, times faster", 10.0, ceres[1].map(|seconds| seconds / ours.given)),
        row("from corners alone / calibrateCamera by default, times faster", 10.0, usual.map(|usual| usual / ours.corners)),
        row("solution / covariance of all blocks", 1.0, Some(ours.given / ours.covariance)),
    ])
}

/// Our seconds.
struct Ours {
    given: f64,
    corners: f64,
    covariance: f64,
}

fn ours(network: &Network, views: usize, rounds: usize) -> Result<Ours, Box<dyn Error>> {
    let (control, size) = (problem::control(network, views), network.cameras[0].camera.size());
    let options = Options::default();
    let [mut given, mut corners, mut covariance] = [f64::INFINITY; 3];
    for _ in 0..rounds {
        let clock = Instant::now();
        black_box(adjust(black_box(network), &options)?);
        given = given.min(clock.elapsed().as_secs_f64());
        let clock = Instant::now();
        let started = problem::from_corners(network, &control, size)?;
        let solution = adjust(&started, &options)?;
        corners = corners.min(clock.elapsed().as_secs_f64());
        let clock = Instant::now();
        black_box(solution.covariances(Variance::Estimated)?);
        covariance = covariance.min(clock.elapsed().as_secs_f64());
    }
    line("given start values", given, Some(adjust(network, &options)?.iterations()), "");
    line("from corners alone", corners, None, "");
    line("covariance of all blocks", covariance, None, "");
    Ok(Ours { given, corners, covariance })
}

/// Seconds of mrcal and of Ceres (by default, and boldly) from the start values given, where they are on this machine; they must reach our optimum.
fn same_start(network: &Network, views: usize, rounds: usize, peer: Option<&ceres::Peer>) -> Result<[Option<f64>; 3], Box<dyn Error>> {
    let solution = adjust(network, &Options::default())?;
    let mrcal = peers::mrcal(network, rounds)?;
    match &mrcal {
        Some(found) => line("mrcal, given start values", found.seconds, None, &optima::mrcal(&solution, found)?),
        None => println!("  mrcal is not run: apt-get install python3-mrcal"),
    }
    let mrcal = mrcal.map(|found| found.seconds);
    let Some(peer) = peer else { return Ok([mrcal, None, None]) };
    let covariances = if views > MANY { 1 } else { 3 };
    let found = peer.solve(network, ceres::Trust::Default, rounds, covariances)?;
    line(&format!("Ceres, {}, given start values", found.solver), found.seconds, Some(found.steps), &optima::ceres(&solution, &found)?);
    if let Some(seconds) = found.covariance {
        line("Ceres, covariance of interior and poses", seconds, None, "");
    }
    let bold = peer.solve(network, ceres::Trust::Bold, rounds, 0)?;
    line("Ceres, first trust region 1e8", bold.seconds, Some(bold.steps), &optima::ceres(&solution, &bold)?);
    Ok([mrcal, Some(found.seconds), Some(bold.seconds)])
}

/// Seconds of OpenCV from the corners alone, by default.
fn from_corners(network: &Network, views: usize, rounds: usize) -> Result<f64, Box<dyn Error>> {
    let (board, solution) = (problem::board(network, views), adjust(network, &Options::default())?);
    let (mut best, mut found) = ([f64::INFINITY; 2], Vec::new());
    for _ in 0..rounds.div_ceil(4) {
        found.clear();
        for ((steps, change), best) in [DEFAULT, TIGHT].into_iter().zip(&mut best) {
            let clock = Instant::now();
            found.push(calibrate(&board, steps, change)?);
            *best = best.min(clock.elapsed().as_secs_f64());
        }
    }
    line("OpenCV by default, from corners alone", best[0], None, &optima::differences(&solution, &found[0])?);
    line("OpenCV until 1e-12, from corners alone", best[1], None, &optima::differences(&solution, &found[1])?);
    let end = calibrate(&board, END.0, END.1)?;
    println!("  OpenCV after {} iterations {}", END.0, optima::opencv(&solution, &end)?);
    println!("  {}", optima::nearer(network, &solution, &end)?);
    Ok(best[0])
}

/// [`from_corners`] by default alone, and once.
fn once(network: &Network, views: usize) -> Result<f64, Box<dyn Error>> {
    let (board, solution) = (problem::board(network, views), adjust(network, &Options::default())?);
    let clock = Instant::now();
    let found = calibrate(&board, DEFAULT.0, DEFAULT.1)?;
    let seconds = clock.elapsed().as_secs_f64();
    line("OpenCV by default, from corners alone, once", seconds, None, &optima::differences(&solution, &found)?);
    Ok(seconds)
}
