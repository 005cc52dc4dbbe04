//! Ceres Solver, where a machine has it (Debian: `apt-get install libceres-dev`), on the same observations and from the same start values.
//!
//! `ceres.cpp` is compiled here for this processor (`c++ -O3 -march=native`); the library itself is as the system built it.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use calibench_adjust::{AdjustError, Network, Precision, Solution, Status, Variance};
use calibench_model::camera::CameraModel;

const SOURCE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../adjust/benches/peers/ceres.cpp");
/// Parameters of the five-coefficient model.
const INTERIOR: usize = 9;
/// Relative change of the sum of squares at which it stops. At its default, 1e-6, the sum of squares is right to some 1e-9.
const TOLERANCE: &str = "1e-12";

/// How boldly its first steps go.
#[derive(Clone, Copy)]
pub(crate) enum Trust {
    /// Its default: a trust region of 1e4.
    Default,
    /// 1e8: nearly Gauss-Newton's steps from the start, as far as the problem is good-natured the fastest.
    Bold,
}

/// The program, compiled.
pub(crate) struct Peer(PathBuf);

/// What Ceres found.
pub(crate) struct Found {
    /// Of the solution alone, the best round.
    pub(crate) seconds: f64,
    /// Its linear solver, the faster one of two.
    pub(crate) solver: String,
    /// Its steps.
    pub(crate) steps: usize,
    /// Weighted sum of squares.
    pub(crate) cost: f64,
    /// fx, fy, cx, cy, k1, k2, p1, p2, k3.
    pub(crate) parameters: [f64; INTERIOR],
    /// Their standard deviations, a priori.
    pub(crate) sigmas: [f64; INTERIOR],
    /// Of the covariance of the interior orientation and of every pose, the best round.
    pub(crate) covariance: Option<f64>,
}

/// How far two results are from each other, at most.
pub(crate) struct Differs {
    /// Root of the sum of squares, relative.
    pub(crate) root: f64,
    /// Parameters of the camera, in their standard deviations.
    pub(crate) parameters: f64,
    /// Standard deviations of the parameters, relative.
    pub(crate) sigmas: f64,
}

impl Peer {
    /// Compiles the program unless that is done; an error says why there is none.
    pub(crate) fn compile() -> Result<Self, String> {
        let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("peer-ceres");
        let newer = |a: &Path, b: &Path| Some(a.metadata().ok()?.modified().ok()? > b.metadata().ok()?.modified().ok()?);
        if newer(&program, Path::new(SOURCE)) == Some(true) {
            return Ok(Self(program));
        }
        let part = program.with_extension(std::process::id().to_string());
        let eigen = Command::new("pkg-config").args(["--cflags", "eigen3"]).output();
        let eigen = eigen.ok().filter(|output| output.status.success()).map(|output| String::from_utf8_lossy(&output.stdout).into_owned());
        let compiler = std::env::var("CXX").unwrap_or_else(|_| "c++".to_owned());
        let run = Command::new(&compiler)
            .args(["-std=c++17", "-O3", "-march=native", "-DNDEBUG"])
            .args(eigen.as_deref().unwrap_or("-I/usr/include/eigen3").split_whitespace())
            .args([SOURCE, "-o"])
            .arg(&part)
            .args(["-lceres", "-lglog"])
            .output();
        let output = run.map_err(|error| format!("Ceres is not run: {compiler}: {error} (apt-get install g++ libceres-dev)"))?;
        if !output.status.success() {
            let text = String::from_utf8_lossy(&output.stderr).into_owned();
            let why = text.lines().find(|line| line.contains("error")).unwrap_or("it does not compile").to_owned();
            return Err(format!("Ceres is not run: apt-get install libceres-dev ({why})"));
        }
        std::fs::rename(&part, &program).map_err(|error| format!("Ceres is not run: {}: {error}", program.display()))?;
        Ok(Self(program))
    }

    /// Solves `network`, a single camera of OpenCV's five coefficients with all of them, all poses, and all or no points unknown.
    pub(crate) fn solve(&self, network: &Network, trust: Trust, rounds: usize, covariances: usize) -> Result<Found, String> {
        let radius = match trust {
            Trust::Default => "1e4",
            Trust::Bold => "1e8",
        };
        let mut command = Command::new(&self.0);
        command.args([&rounds.to_string(), TOLERANCE, radius, &covariances.to_string()]).env("OMP_NUM_THREADS", "1");
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().map_err(|error| error.to_string())?;
        if let Some(mut input) = child.stdin.take() {
            input.write_all(problem(network).as_bytes()).map_err(|error| error.to_string())?;
        }
        let output = child.wait_with_output().map_err(|error| error.to_string())?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        read(&text).filter(|_| output.status.success()).ok_or_else(|| format!("Ceres failed: {} {text}", output.status))
    }
}

fn read(text: &str) -> Option<Found> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let [seconds, solver, steps, cost, rest @ ..] = &words[..] else { return None };
    let numbers: Vec<f64> = rest.iter().map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let covariance = *numbers.get(2 * INTERIOR)?;
    Some(Found {
        seconds: seconds.parse().ok()?,
        solver: (*solver).to_owned(),
        steps: steps.parse().ok()?,
        cost: cost.parse().ok()?,
        parameters: numbers[..INTERIOR].try_into().ok()?,
        sigmas: numbers[INTERIOR..2 * INTERIOR].try_into().ok()?,
        covariance: (covariance >= 0.0).then_some(covariance),
    })
}

/// The problem as `ceres.cpp` reads it.
fn problem(network: &Network) -> String {
    let known = |point: &calibench_adjust::ObjectPoint| match point.coordinates {
        [Status::Observed { value: x, sigma }, Status::Observed { value: y, .. }, Status::Observed { value: z, .. }] => {
            Some([x, y, z, sigma])
        }
        _ => None,
    };
    let controls: Vec<(usize, [f64; 4])> = network.points.iter().enumerate().filter_map(|(i, point)| Some((i, known(point)?))).collect();
    let is_free = network.points.iter().any(|point| point.coordinates[0] != Status::Fixed);
    let (images, points, observations) = (network.images.len(), network.points.len(), network.observations.len());
    let mut text = format!("{images} {points} {observations} {} {}\n", controls.len(), u8::from(is_free));
    let mut line = |numbers: &[f64]| {
        for number in numbers {
            let _ = write!(text, "{number} ");
        }
        text.push('\n');
    };
    line(&network.cameras[0].camera.parameters().iter().map(|parameter| parameter.value).collect::<Vec<_>>());
    for image in &network.images {
        line(&opencv_pose(&image.pose));
    }
    network.points.iter().for_each(|point| line(point.position.coords.as_slice()));
    for o in &network.observations {
        let Precision::Sigma(sigma) = o.precision else { continue };
        line(&[o.image as f64, o.point as f64, o.position.x, o.position.y, sigma]);
    }
    controls.iter().for_each(|(i, [x, y, z, sigma])| line(&[*i as f64, *x, *y, *z, *sigma]));
    text
}

/// Rotation by rows and translation with x right, y down, z forward: of our axes x right, y up, z backwards, the second and the third turn round.
pub(crate) fn opencv_pose(pose: &calibench_model::Pose) -> [f64; 12] {
    let rotation = nalgebra::Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, -1.0, -1.0)) * pose.rotation;
    let translation = -(rotation * pose.centre.coords);
    std::array::from_fn(|i| if i < 9 { rotation[(i / 3, i % 3)] } else { translation[i - 9] })
}

impl Found {
    /// How far `ours` is from it.
    pub(crate) fn differs(&self, ours: &Solution) -> Result<Differs, AdjustError> {
        let apriori: Vec<f64> = standard_deviations(ours, Variance::Apriori)?;
        let pairs = self.sigmas.iter().zip(&apriori);
        Ok(Differs {
            root: ((self.cost / ours.cost()).sqrt() - 1.0).abs(),
            parameters: in_sigmas(ours, &self.parameters)?,
            sigmas: pairs.map(|(theirs, ours)| (theirs / ours - 1.0).abs()).fold(0.0, f64::max),
        })
    }
}

/// The largest difference of `parameters` from those of our first camera, in standard deviations (of the estimated variance factor).
pub(crate) fn in_sigmas(ours: &Solution, parameters: &[f64]) -> Result<f64, AdjustError> {
    let sigmas = standard_deviations(ours, Variance::Estimated)?;
    let pairs = ours.cameras()[0].parameters().into_iter().zip(parameters).zip(sigmas);
    Ok(pairs.map(|((ours, theirs), sigma)| (theirs - ours.value).abs() / sigma).fold(0.0, f64::max))
}

fn standard_deviations(ours: &Solution, variance: Variance) -> Result<Vec<f64>, AdjustError> {
    Ok(ours.covariances(variance)?.interior.diagonal().iter().map(|variance| variance.sqrt()).collect())
}
