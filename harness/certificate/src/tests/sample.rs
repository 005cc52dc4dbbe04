//! A record as `calibrate` writes it, of a camera that nobody has.

use serde_json::{Value, json};

use crate::record::{CameraRecord, Certificate, Equipment, Fields, FileEntry, FrameRecord, PlaceRecord, RECORD, Record, Role};
use crate::{digest_of, line};

/// The answer, with so many doubts.
fn answer(doubts: usize) -> Value {
    let names = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"];
    let values = [1_213.482_71, 1_213.517_09, 639.128_3, 478.902_4, -0.214_38, 0.083_12, 0.000_312, -0.000_118];
    let sigmas = [0.412, 0.398, 0.287, 0.305, 0.0011, 0.0043, 0.000_081, 0.000_078];
    let parameters: Vec<Value> = (0..8)
        .map(|i| json!({"name": names[i], "value": values[i], "unit": if i < 4 { "px" } else { "" }, "sigma": sigmas[i]}))
        .chain([json!({"name": "k3", "value": 0.0, "unit": "", "sigma": null})])
        .collect();
    let rho = |i: usize, j: usize| if i == j { 1.0 } else { [0.987, -0.12, 0.07, 0.31][(i + j) % 4] };
    let covariance: Vec<Vec<f64>> = (0..8).map(|i| (0..8).map(|j| rho(i, j) * sigmas[i] * sigmas[j]).collect()).collect();
    let solved: Vec<Value> = (0..8)
        .map(
            |i| json!({"parameter": names[i], "sigma": sigmas[i], "sigma_by_images": sigmas[i] * 1.4, "t": null, "p": null, "held": false}),
        )
        .collect();
    let long = "rows of an image were exposed one after the other, or camera or board moved meanwhile: residuals within an image belong together; photograph what \
                stands still, with a tripod, or take a global shutter";
    json!({
        "command": "calibrate", "schema": 1, "calibench": "0.2.0",
        "doubts": (0..doubts).map(|i| format!("{}: {long}", i + 1)).collect::<Vec<_>>(),
        "doubted": [], "suspected": [], "untested": ["the precision of image points: no --sigma was given"],
        "warnings": ["fx and fy are hardly told apart: correlation 0.987"],
        "datum": "control points are fixed",
        "counts": {"images": 12, "image_points": 648, "not_in_full": 3, "left_out": 0, "unmeasured": 0, "targets": 54, "control_points": 54, "observations": 1296,
                   "constraints": 0, "unknowns": 80, "redundancy": 1216},
        "sigma_px": 0.1, "sigma_is_assumed": true, "sigma0": 0.7312, "rms_px": 0.1018,
        "cameras": [{"name": "camera", "start": "homographies", "images": 12,
            "camera": {"name": "", "convention": "opencv5", "unverified": null, "size": {"width": 1280, "height": 960}, "pitch_um": 3.75, "parameters": parameters,
                       "covariance": {"parameters": names, "values": covariance}, "pose": null, "notes": []},
            "over_frame": {"formal_px": 0.1873, "by_images_px": 0.2645, "limit_px": 5.0}, "solved": solved, "next": null, "why_no_next": null}],
        "lengths": [{"targets": ["r1c1", "r6c9"], "length": 235.849_1, "sigma": 0.0123, "measured": null, "sigma_measured": null, "redundancy": null, "w": null}],
        "correlated": [], "checks": [], "rivals": [],
        "board": {"shape": "flat", "why": null, "bend": [0.012, -0.034, 0.005], "sigma": [0.021, 0.025, 0.011], "p": 0.312},
        "images": [], "rejected": [], "sets": []
    })
}

fn frame() -> FrameRecord {
    let grid = [48, 36];
    let sigma = |x: f64, y: f64| 0.05 + 0.9 * (x * x + y * y).powi(2);
    let at = |k: usize| (2.0 * (k % 48) as f64 / 47.0 - 1.0, 2.0 * (k / 48) as f64 / 35.0 - 1.0);
    let names = [
        "upper left corner",
        "upper side",
        "upper right corner",
        "left side",
        "middle",
        "right side",
        "lower left corner",
        "lower side",
        "lower right corner",
    ];
    let place = |(i, name): (usize, &&str)| {
        let (x, y) = ((i % 3) as f64, (i / 3) as f64);
        PlaceRecord { name: (*name).into(), x: 639.5 * x, y: 479.5 * y, sigma_px: Some(sigma(x - 1.0, y - 1.0)), measured: i == 4 }
    };
    FrameRecord {
        grid,
        sigma_px: (0..48 * 36).map(|k| Some(sigma(at(k).0, at(k).1))).collect(),
        measured: (0..48 * 36).map(|k| at(k).0.abs() < 0.85 && at(k).1.abs() < 0.8).collect(),
        places: names.iter().enumerate().map(place).collect(),
    }
}

/// A certificate with so many doubts and photographs, and the list of digests.
pub fn sample(doubts: usize, photographs: usize) -> (Certificate, String) {
    let file = |role, path: String| FileEntry { role, path, bytes: 2_345_678 };
    let name = |i: usize| {
        if i % 7 == 3 {
            format!("photographs/a very long name/of a folder that/somebody made/in a hurry/IMG_{i:04}.JPG")
        } else {
            format!("photographs/IMG_{i:04}.JPG")
        }
    };
    let files: Vec<FileEntry> =
        (0..photographs).map(|i| file(Role::Photograph, name(i))).chain([file(Role::Camera, "camera.yaml".into())]).collect();
    let list = files.iter().map(|file| line(&digest_of(file.path.as_bytes()), &file.path)).collect();
    let equipment = Equipment {
        photographs,
        camera: Some("Canon EOS 1100D".into()),
        serial: Some("123076048974".into()),
        lens: Some("EF-S18-55mm f/3.5-5.6 IS II".into()),
        focal_mm: Some(18.0),
        f_number: Some(8.0),
        first: Some("2026-05-01 12:00:00".into()),
        last: Some("2026-05-01 12:09:41".into()),
        ..Equipment::default()
    };
    let record = Record {
        certificate: RECORD,
        calibench: "0.2.0".into(),
        calibration: answer(doubts),
        groups: Some(12),
        method: Some("parametric_corner:window=15".into()),
        board: Some("chessboard:9x6:25".into()),
        cameras: vec![CameraRecord { equipment: vec![equipment], frame: Some(frame()) }],
        tasks: Vec::new(),
        files,
        without_digest: Vec::new(),
    };
    let fields =
        Fields { by: Some("The operator, Laboratory of Photogrammetry".into()), place: Some("Somewhere".into()), ..Fields::default() };
    (Certificate { fields, camera: 0, record }, list)
}
