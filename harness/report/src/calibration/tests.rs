//! The tables of a calibration, by formulas written out here: nothing of the projection or the statistics is shared with the code under test.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::path::Path;

use calibench_calibrate::{Calibration, DatumChoice, Optics, Prepared, Settings, prepare};
use calibench_files::OutputFolder;
use calibench_model::camera::ImageSize;
use calibench_model::{ControlRow, PixelPoint, PointRow, Start};

use super::{summary, tables};

const SIZE: ImageSize = ImageSize { width: 1000, height: 800 };
const PITCH_MM: f64 = 0.005;
const C: f64 = 8.0;
const SIGMA: f64 = 0.3;

/// X0, Y0, Z0, m and omega, phi, kappa, degrees.
const STATIONS: [[f64; 6]; 6] = [
    [0.0, 0.0, 4.0, 0.0, 0.0, 0.0],
    [1.5, 0.2, 3.8, -2.0, 21.0, 90.0],
    [-1.6, 0.1, 3.9, 1.0, -23.0, -90.0],
    [0.1, 1.4, 4.1, -19.0, 2.0, 180.0],
    [-0.2, -1.5, 3.7, 21.0, -1.0, 45.0],
    [0.9, 1.0, 3.6, -15.0, 13.0, -135.0],
];

pub(super) type Matrix = [[f64; 3]; 3];

/// `M = M_kappa M_phi M_omega`, multiplied out as Mikhail et al. print it.
pub(super) fn rotation([omega, phi, kappa]: [f64; 3]) -> Matrix {
    let [(so, co), (sp, cp), (sk, ck)] = [omega, phi, kappa].map(|degrees| (degrees * PI / 180.0).sin_cos());
    [
        [cp * ck, co * sk + so * sp * ck, so * sk - co * sp * ck],
        [-cp * sk, co * ck - so * sp * sk, so * ck + co * sp * sk],
        [sp, -so * cp, co * cp],
    ]
}

/// The picture of a point without distortion, px.
fn pictured(m: &Matrix, centre: [f64; 3], [c, x0, y0]: [f64; 3], point: [f64; 3]) -> [f64; 2] {
    let d = [0, 1, 2].map(|i| point[i] - centre[i]);
    let n = [0, 1, 2].map(|i| m[i][0] * d[0] + m[i][1] * d[1] + m[i][2] * d[2]);
    let (x, y) = (x0 - c * n[0] / n[2], y0 - c * n[1] / n[2]);
    [x / PITCH_MM + (f64::from(SIZE.width) - 1.0) / 2.0, (f64::from(SIZE.height) - 1.0) / 2.0 - y / PITCH_MM]
}

/// Roughly normal: twelve numbers of a linear congruential generator (Knuth's MMIX) less six.
fn noise(state: &mut u64) -> f64 {
    let mut uniform = || {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

fn targets() -> Vec<(String, [f64; 3])> {
    let at = |k: i32| [0.3 * f64::from(k % 5 - 2), 0.27 * f64::from(k / 5 - 2), 0.15 * f64::from(k % 3)];
    (0..25).map(|k| (format!("t{k}"), at(k))).collect()
}

/// A wall with noise, twice as much in y as in x: what is exchanged does not pass.
fn wall() -> Prepared {
    let mut state = 7;
    let mut points = Vec::new();
    for (index, [x, y, z, angles @ ..]) in STATIONS.iter().copied().enumerate() {
        for (target, at) in targets() {
            let [u, v] = pictured(&rotation(angles), [x, y, z], [C, 0.02, -0.03], at);
            assert!((0.0..1000.0).contains(&u) && (0.0..800.0).contains(&v), "{target} in {index}: {u}, {v}");
            let position = PixelPoint::new(u + 0.5 * SIGMA * noise(&mut state), v + SIGMA * noise(&mut state));
            points.push(PointRow { image: format!("i{index}"), target, start: Start::at(position) });
        }
    }
    let control =
        targets().into_iter().map(|(target, position)| ControlRow { sigmas: Some([1e-4; 3]), ..ControlRow::new(target, position) });
    let names = ["c", "x0", "y0", "k1", "p1"].map(str::to_owned);
    let optics =
        Optics { pitch_um: Some(1e3 * PITCH_MM), model: Some("photogrammetric".into()), solve: Some(names.into()), ..Optics::new(SIZE) };
    let settings = Settings { datum: DatumChoice::Control, ..Settings::new(vec![optics]) };
    prepare(points.iter().collect(), &control.collect::<Vec<_>>(), &settings).unwrap()
}

pub(super) type Row = HashMap<String, String>;

pub(super) fn rows(path: &Path) -> Vec<Row> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

pub(super) fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column}: {}", row[column]))
}

pub(super) fn written(test: impl FnOnce(&Calibration<'_>, &Path)) {
    let folder = tempfile::tempdir().unwrap();
    let tables_at = folder.path().join("report");
    let prepared = wall();
    let calibration = prepared.adjust().unwrap();
    OutputFolder::open(&tables_at)
        .unwrap()
        .replace(|folder| tables::write(&calibration, &[super::uncertainty::maps(&calibration, 0)], folder))
        .unwrap();
    test(&calibration, &tables_at);
}

/// Adjusted less observed, the adjusted one from the other tables: poses in degrees, parameters, object points.
#[test]
fn residuals_are_what_the_other_tables_picture_less_what_was_measured() {
    written(|_, folder| {
        let parameters: HashMap<String, f64> =
            rows(&folder.join("parameters.csv")).iter().map(|row| (row["parameter"].clone(), number(row, "value"))).collect();
        let points: HashMap<String, [f64; 3]> =
            rows(&folder.join("points.csv")).iter().map(|row| (row["target"].clone(), ["X", "Y", "Z"].map(|c| number(row, c)))).collect();
        let stations: HashMap<String, (Matrix, [f64; 3])> = rows(&folder.join("stations.csv"))
            .iter()
            .map(|row| {
                let angles = ["omega_deg", "phi_deg", "kappa_deg"].map(|c| number(row, c));
                (row["image"].clone(), (rotation(angles), ["X0", "Y0", "Z0"].map(|c| number(row, c))))
            })
            .collect();
        let interior = ["c", "x0", "y0"].map(|name| parameters[name]);
        let residuals = rows(&folder.join("residuals.csv"));
        assert_eq!(residuals.len(), 6 * 25);
        let mut squares = [0.0; 2];
        for row in &residuals {
            let (m, centre) = &stations[&row["image"]];
            let adjusted = [number(row, "x") + number(row, "vx"), number(row, "y") + number(row, "vy")];
            squares = [squares[0] + number(row, "vx").powi(2), squares[1] + number(row, "vy").powi(2)];
            // Distortion is a correction of what is measured: the adjusted point, corrected, is the straight picture.
            let xb = (adjusted[0] - 499.5) * PITCH_MM - interior[1];
            let yb = (399.5 - adjusted[1]) * PITCH_MM - interior[2];
            let (r2, k1, p1) = (xb * xb + yb * yb, parameters["k1"], parameters["p1"]);
            let ideal = [xb - xb * k1 * r2 - p1 * (r2 + 2.0 * xb * xb), yb - yb * k1 * r2 - 2.0 * p1 * xb * yb];
            let straight = pictured(m, *centre, [interior[0], 0.0, 0.0], points[&row["target"]]);
            let found = [499.5 + ideal[0] / PITCH_MM, 399.5 - ideal[1] / PITCH_MM];
            for (found, expected) in found.iter().zip(straight) {
                assert!((found - expected).abs() < 1e-6, "{row:?}: {found} is not {expected}");
            }
        }
        assert!(squares[1] > 2.5 * squares[0], "the noise in y is twice that in x: {squares:?}");
    });
}

#[test]
fn standard_deviations_are_those_of_the_errors_in_the_unit_of_their_column() {
    written(|_, folder| {
        let (mut turns, mut shifts) = (Vec::new(), Vec::new());
        for (row, [x, y, z, angles @ ..]) in rows(&folder.join("stations.csv")).iter().zip(STATIONS) {
            let (found, truth) = (rotation(["omega_deg", "phi_deg", "kappa_deg"].map(|c| number(row, c))), rotation(angles));
            // M found times M true transposed is a small rotation about the camera's axes.
            let small = |i: usize, j: usize| (0..3).map(|k| found[i][k] * truth[j][k]).sum::<f64>() * 180.0 / PI;
            let errors = [small(2, 1), small(0, 2), small(1, 0)];
            for (error, column) in errors.iter().zip(["sx_deg", "sy_deg", "sz_deg"]) {
                turns.push(error / number(row, column));
            }
            for ((truth, column), sigma) in [x, y, z].iter().zip(["X0", "Y0", "Z0"]).zip(["sX0", "sY0", "sZ0"]) {
                shifts.push((number(row, column) - truth) / number(row, sigma));
            }
        }
        for ratios in [turns, shifts] {
            let rms = (ratios.iter().map(|ratio| ratio * ratio).sum::<f64>() / ratios.len() as f64).sqrt();
            assert!((0.4..1.8).contains(&rms), "errors are {rms} standard deviations: {ratios:?}");
        }
    });
}

#[test]
fn an_image_s_rms_is_that_of_its_residuals() {
    written(|calibration, folder| {
        let residuals = rows(&folder.join("residuals.csv"));
        for row in rows(&folder.join("stations.csv")) {
            let own: Vec<f64> = residuals
                .iter()
                .filter(|residual| residual["image"] == row["image"])
                .map(|residual| number(residual, "vx").powi(2) + number(residual, "vy").powi(2))
                .collect();
            assert_eq!(own.len() as f64, number(&row, "points"));
            let rms = (own.iter().sum::<f64>() / own.len() as f64).sqrt();
            assert!((number(&row, "rms_px") / rms - 1.0).abs() < 1e-9, "{}: {rms}", row["rms_px"]);
        }
        let all: f64 = residuals.iter().map(|row| number(row, "vx").powi(2) + number(row, "vy").powi(2)).sum();
        assert!((calibration.rms_px() / (all / residuals.len() as f64).sqrt() - 1.0).abs() < 1e-9);
    });
}

#[test]
fn a_parameter_s_row_is_its_value_over_its_sigma_and_what_is_fixed_has_none() {
    written(|calibration, folder| {
        let found = rows(&folder.join("parameters.csv"));
        assert_eq!(found.len(), 10);
        for row in &found {
            if ["c", "x0", "y0", "k1", "p1"].contains(&row["parameter"].as_str()) {
                assert_eq!(row["status"], "free");
                let t = number(row, "value") / number(row, "sigma");
                assert!((number(row, "t") / t - 1.0).abs() < 1e-9, "{row:?}");
            } else {
                assert_eq!([&row["status"], &row["sigma"], &row["t"], &row["p"]], ["fixed", "", "", ""]);
            }
        }
        let value = |name: &str| found.iter().find(|row| row["parameter"] == name).map(|row| (number(row, "value"), number(row, "sigma")));
        let (c, sigma) = value("c").unwrap();
        assert!((c - C).abs() < 5.0 * sigma && sigma < 0.05, "{c} +- {sigma} mm");
        let text = summary(calibration);
        assert!(text.contains("photogrammetric") && text.contains("redundancy"), "{text}");
    });
}
