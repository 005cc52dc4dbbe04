//! The truth files against the collinearity equations, written out a second time from the definitions alone.

use std::collections::HashMap;
use std::path::Path;

use super::render;
use crate::project::copy_with;

/// The rows of a table as maps from column to cell.
pub(super) fn table(path: &Path) -> Vec<HashMap<String, String>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &str| columns.iter().map(|name| (*name).to_owned()).zip(line.split(',').map(str::to_owned)).collect();
    lines.map(row).collect()
}

fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column}: {}", row[column]))
}

/// A camera file: image size, pitch, c, x0, y0 and the distortion.
struct Camera {
    size: [f64; 2],
    pitch: f64,
    interior: [f64; 3],
    distortion: [f64; 7],
}

impl Camera {
    fn read(path: &Path) -> Self {
        let text: toml::Table = toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let value = |table: &str, key: &str| {
            let value = &text[table][key];
            value.as_float().or(value.as_integer().map(|whole| whole as f64)).unwrap()
        };
        let distortion = ["k1_per_mm2", "k2_per_mm4", "k3_per_mm6", "p1_per_mm", "p2_per_mm", "b1", "b2"];
        Self {
            size: [value("image", "width_px"), value("image", "height_px")],
            pitch: value("image", "pitch_um") / 1000.0,
            interior: ["c_mm", "x0_mm", "y0_mm"].map(|key| value("interior_orientation", key)),
            distortion: distortion.map(|key| value("distortion", key)),
        }
    }

    /// The correction of measured coordinates, reduced to the principal point, mm.
    fn correction(&self, x: f64, y: f64) -> [f64; 2] {
        let [k1, k2, k3, p1, p2, b1, b2] = self.distortion;
        let r2 = x * x + y * y;
        let radial = k1 * r2 + k2 * r2.powi(2) + k3 * r2.powi(3);
        [x * radial + p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y + b1 * x + b2 * y, y * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * y * y)]
    }

    /// The pixel of ideal coordinates, mm: the measured ones are found as the fixed point of "ideal plus correction".
    fn pixel(&self, ideal: [f64; 2]) -> [f64; 2] {
        let mut measured = ideal;
        for _ in 0..200 {
            let [dx, dy] = self.correction(measured[0], measured[1]);
            measured = [ideal[0] + dx, ideal[1] + dy];
        }
        let [_, x0, y0] = self.interior;
        let [width, height] = self.size;
        [(measured[0] + x0) / self.pitch + (width - 1.0) / 2.0, (height - 1.0) / 2.0 - (measured[1] + y0) / self.pitch]
    }
}

/// `M_kappa M_phi M_omega (X - X0)`, angles in degrees.
fn turned(angles: [f64; 3], by: [f64; 3]) -> [f64; 3] {
    let [(so, co), (sp, cp), (sk, ck)] = angles.map(|angle| angle.to_radians().sin_cos());
    let [x, y, z] = by;
    // omega about x, then phi about y, then kappa about z; each turns the axes.
    let (y, z) = (co * y + so * z, -so * y + co * z);
    let (x, z) = (cp * x - sp * z, sp * x + cp * z);
    [ck * x + sk * y, -sk * x + ck * y, z]
}

/// Compares every image of `scenario`; the number of targets compared.
fn compare(scenario: &str) -> usize {
    let project = copy_with(&["testfields"]);
    let folder = render(project.path(), scenario, "out", &[]);
    let camera = Camera::read(&folder.join("camera.toml"));
    let mut compared = 0;
    for station in table(&folder.join("stations.csv")) {
        let centre = ["X0", "Y0", "Z0"].map(|column| number(&station, column));
        let angles = ["omega_deg", "phi_deg", "kappa_deg"].map(|column| number(&station, column));
        for target in table(&folder.join(format!("{}.csv", station["image"]))) {
            assert_eq!(target["image"], format!("{}.png", station["image"]));
            let object = ["X", "Y", "Z"].map(|column| number(&target, column));
            let [u, v, w] = turned(angles, std::array::from_fn(|i| object[i] - centre[i]));
            let inside = target["visibility"] == "visible" || target["visibility"] == "clipped";
            if !inside {
                continue;
            }
            let c = camera.interior[0];
            let [x, y] = camera.pixel([-c * u / w, -c * v / w]);
            let error = (x - number(&target, "x")).hypot(y - number(&target, "y"));
            assert!(error < 1e-8, "{scenario}, {}, {}: {error:e} px", station["image"], target["target"]);
            compared += 1;
        }
    }
    compared
}

#[test]
fn the_truth_of_a_bent_board_is_the_projection_of_its_corners() {
    assert_eq!(compare("testfields/chessboard"), 16 * 54);
}

#[test]
fn the_truth_of_a_wall_is_the_projection_of_its_targets() {
    assert!(compare("testfields/wall") > 600);
}

#[test]
fn control_points_are_the_targets_to_the_accuracy_of_the_survey() {
    let project = copy_with(&["testfields"]);
    let folder = render(project.path(), "testfields/wall", "out", &["--station", "s01-r1"]);
    let control = table(&folder.join("control.csv"));
    let truth = table(&folder.join("s01-r1.csv"));
    assert_eq!(control.len(), truth.len());
    let mut squares = 0.0;
    for (known, target) in control.iter().zip(&truth) {
        assert_eq!(known["target"], target["target"]);
        squares += ["X", "Y", "Z"].iter().map(|axis| (number(known, axis) - number(target, axis)).powi(2)).sum::<f64>();
    }
    let count = 3.0 * control.len() as f64;
    let ratio = squares / count / 0.0002_f64.powi(2);
    // The mean square of normal deviates, within five of its standard deviations.
    assert!((ratio - 1.0).abs() < 5.0 * (2.0 / count).sqrt(), "{ratio}");
}
