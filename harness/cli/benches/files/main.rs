//! Seconds of `calibrate` as a whole program, from files to a file, beside Python's OpenCV on the same files: `peer.py`.
//!
//! `cargo bench --workspace --bench files`, followed by `-- VIEWS...` for other numbers than 17, 100 and 1000. `CALIBENCH_PYTHON` names a Python that has
//! another OpenCV than that of `python3`. The best of three runs each, on all threads; both read, calibrate five coefficients, and end.

#[path = "../program.rs"]
mod program;

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use calibench_cameras::read_camera;
use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};
use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Vector3};
use rand_chacha::rand_core::Rng;

/// Views without an argument.
const VIEWS: [usize; 3] = [17, 100, 1000];
const SIZE: ImageSize = ImageSize { width: 1600, height: 1200 };
/// Corners of a row, rows, and the side of a square, mm.
const BOARD: (usize, usize, f64) = (9, 6, 30.0);
/// Half the range of the errors of an image coordinate, px.
const ERROR: f64 = 0.2;
const ROUNDS: usize = 3;
const PEER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/files/peer.py");

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "--list" || argument == "--test") {
        return Ok(());
    }
    let mut views: Vec<usize> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    if views.is_empty() {
        views.extend(VIEWS);
    }
    println!("{:>8} {:>12} {:>6} {:>12} {:>8} {:>12}   peer", "views", "calibench s", "MB", "OpenCV s", "times", "fx apart px");
    let folder = tempfile::tempdir()?;
    for views in views {
        write(views, folder.path())?;
        let runs = (0..ROUNDS).map(|_| ours(folder.path())).collect::<Result<Vec<_>, _>>()?;
        let ours = runs.iter().map(|run| run.seconds).fold(f64::INFINITY, f64::min);
        let peak = runs.iter().map(|run| run.peak as f64 / 1e6).fold(0.0, f64::max);
        let fx = read_camera(&folder.path().join("found.yaml"))?.cameras[0].camera.parameters()[0].value;
        match theirs(folder.path())? {
            None => println!("{views:>8} {ours:>12.3} {peak:>6.0} {:>12} {:>8} {:>12}   no OpenCV for Python", "-", "-", "-"),
            Some(Peer { seconds, version, fx: other }) => {
                let (times, apart) = (seconds / ours, (fx - other).abs());
                println!("{views:>8} {ours:>12.3} {peak:>6.0} {seconds:>12.3} {times:>8.1} {apart:>12.1e}   OpenCV {version}");
            }
        }
    }
    Ok(())
}

/// The program.
fn ours(folder: &Path) -> Result<program::Spent, Box<dyn Error>> {
    let size = format!("{}x{}", SIZE.width, SIZE.height);
    let words = [
        "calibrate",
        "--points",
        "points.csv",
        "--control",
        "control.csv",
        "--size",
        &size,
        "--model",
        "opencv5",
        "-o",
        "found.yaml",
        "-q",
    ];
    program::run(&words.map(str::to_owned), folder)
}

/// What the peer took and found.
struct Peer {
    seconds: f64,
    /// Of OpenCV.
    version: String,
    /// px.
    fx: f64,
}

/// The fastest run of the peer; `None` where there is none.
fn theirs(folder: &Path) -> Result<Option<Peer>, Box<dyn Error>> {
    let python = std::env::var("CALIBENCH_PYTHON").unwrap_or_else(|_| "python3".into());
    let mut best: Option<Peer> = None;
    for _ in 0..ROUNDS {
        let started = Instant::now();
        let arguments = [SIZE.width.to_string(), SIZE.height.to_string()];
        let Ok(output) = Command::new(&python).arg(PEER).arg(folder).args(arguments).output() else { return Ok(None) };
        let seconds = started.elapsed().as_secs_f64();
        if output.status.code() == Some(3) {
            return Ok(None);
        }
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
        }
        let said = String::from_utf8(output.stdout)?;
        let mut words = said.split_whitespace();
        let (version, fx) = (words.next().unwrap_or_default().to_owned(), words.nth(1).unwrap_or_default().parse()?);
        best = Some(best.filter(|best| best.seconds <= seconds).unwrap_or(Peer { seconds, version, fx }));
    }
    Ok(best)
}

/// Writes `points.csv` and `control.csv` of a board, each view with all corners in the frame.
fn write(views: usize, folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut distortion = [0.0; 14];
    distortion[..5].copy_from_slice(&[-0.11, 0.07, 4e-4, -6e-4, -0.012]);
    let camera: Camera = OpenCv { size: SIZE, fx: 1450.0, fy: 1446.0, cx: 812.0, cy: 590.0, distortion, coefficients: 5 }.into();
    let (columns, rows, side) = BOARD;
    let corners: Vec<(String, Point3<f64>)> = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (format!("r{}c{}", row + 1, column + 1), side * column as f64, side * row as f64)))
        .map(|(name, x, y)| (name, Point3::new(x, y, 0.0)))
        .collect();
    let control: String = corners.iter().map(|(name, at)| format!("{name},{},{},0\n", at.x, at.y)).collect();
    fs::write(folder.join("control.csv"), format!("target,X,Y,Z\n{control}"))?;
    let mut random = stream(Key { seed: 1, of: "files", trial: 0, view: "", target: "" }, Purpose::Layout);
    let mut within = |low: f64, high: f64| low + (high - low) * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let middle = Point3::new(side * (columns - 1) as f64 / 2.0, side * (rows - 1) as f64 / 2.0, 0.0);
    let mut text = String::from("image,target,x,y\n");
    let mut view = 0;
    while view < views {
        let from = Vector3::new(within(-200.0, 200.0), within(-200.0, 200.0), within(230.0, 420.0));
        let aim = middle + Vector3::new(within(-40.0, 40.0), within(-30.0, 30.0), 0.0);
        let Some(pose) = Pose::looking_at(middle + from, aim, Vector3::y(), within(-0.5, 0.5)) else { continue };
        let seen: Option<Vec<_>> = corners.iter().map(|(_, at)| camera.project(pose.ray(at)).ok().filter(|at| is_inside(*at))).collect();
        let Some(seen) = seen else { continue };
        for ((name, _), at) in corners.iter().zip(seen) {
            text += &format!("view_{view:05}.png,{name},{:.4},{:.4}\n", at.x + within(-ERROR, ERROR), at.y + within(-ERROR, ERROR));
        }
        view += 1;
    }
    Ok(fs::write(folder.join("points.csv"), text)?)
}

fn is_inside(at: calibench_model::PixelPoint) -> bool {
    (1.0..f64::from(SIZE.width - 2)).contains(&at.x) && (1.0..f64::from(SIZE.height - 2)).contains(&at.y)
}
