//! mrcal, where a machine has it (Debian: `apt-get install python3-mrcal`), on the same observations and from the same start values.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;
use std::{fs, io};

use calibench_adjust::Network;
use calibench_model::camera::CameraModel;

use crate::ceres::opencv_pose;

/// Pythons that may have mrcal: the one of the path, and Debian's.
const PYTHONS: [&str; 2] = ["python3", "/usr/bin/python3"];
const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/boards/peers.py");

/// What mrcal found.
pub(crate) struct Mrcal {
    /// Of the optimisation alone, the best round.
    pub(crate) seconds: f64,
    /// `sqrt(mean(vx^2 + vy^2))`, px.
    pub(crate) rms: f64,
    /// fx, fy, cx, cy, k1, k2, p1, p2, k3.
    pub(crate) parameters: Vec<f64>,
}

/// Solves `network`; `None` where mrcal is not on this machine.
pub(crate) fn mrcal(network: &Network, rounds: usize) -> io::Result<Option<Mrcal>> {
    let folder = std::env::temp_dir().join(format!("calibench-boards-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let found = write_problem(network, &folder).map(|()| solve(&folder, rounds));
    fs::remove_dir_all(&folder)?;
    found
}

fn solve(folder: &Path, rounds: usize) -> Option<Mrcal> {
    for python in PYTHONS {
        // One thread, as for all others.
        let run = Command::new(python).arg(SCRIPT).arg(folder).arg(rounds.to_string()).env("OMP_NUM_THREADS", "1").output();
        let Some(output) = run.ok().filter(|output| output.status.success()) else { continue };
        let text = String::from_utf8_lossy(&output.stdout);
        let numbers: Vec<f64> = text.split_whitespace().filter_map(|number| number.parse().ok()).collect();
        if let [seconds, rms, parameters @ ..] = &numbers[..] {
            return Some(Mrcal { seconds: *seconds, rms: *rms, parameters: parameters.to_vec() });
        }
    }
    None
}

fn write_problem(network: &Network, folder: &Path) -> io::Result<()> {
    let camera = &network.cameras[0].camera;
    let size = camera.size();
    let parameters: Vec<String> = camera.parameters().iter().map(|parameter| parameter.value.to_string()).collect();
    fs::write(folder.join("camera.txt"), format!("{} {} {}\n", size.width, size.height, parameters.join(" ")))?;
    let mut views = String::new();
    for image in &network.images {
        let numbers = opencv_pose(&image.pose).map(|number| number.to_string());
        let _ = writeln!(views, "{}", numbers.join(","));
    }
    fs::write(folder.join("views.csv"), views)?;
    let mut ordered: Vec<_> = network.observations.iter().collect();
    ordered.sort_by_key(|o| (o.image, o.point));
    let corners: String = ordered.iter().map(|o| format!("{},{}\n", o.position.x, o.position.y)).collect();
    fs::write(folder.join("corners.csv"), corners)
}
