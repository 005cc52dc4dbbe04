//! Networks that others made: the optimum is that of OpenCV's `calibrateCamera`.

use std::path::Path;

use calibench_calibrate::{GrossErrors, Optics, Risk, Settings, prepare};
use calibench_exchange::{read_control, read_points};
use calibench_model::Points;
use calibench_model::camera::{CameraModel, ImageSize};

/// Name, size, RMS (2D) and fx of OpenCV, px.
const NETWORKS: [(&str, [u32; 2], f64, f64); 3] =
    [("60", [4000, 3000], 0.206, 1328.2), ("98", [1280, 1024], 0.195, 582.9), ("1002", [4000, 3000], 0.205, 1418.6)];

#[test]
#[cfg_attr(not(networks), ignore = "the networks of others are absent: docs/scenarios.md says where they are looked for")]
fn wide_lenses_arrive_where_opencv_does() {
    let folder = Path::new(option_env!("CALIBENCH_NETWORKS").unwrap_or_default());
    for (name, [width, height], rms, fx) in NETWORKS {
        let points = read_points(&folder.join(format!("{name}.csv"))).unwrap().points;
        let control = read_control(&folder.join(format!("{name}.ctl.csv"))).unwrap();
        for model in ["opencv4", "opencv5"] {
            let optics = Optics { model: Some(model.into()), ..Optics::new(ImageSize { width, height }) };
            let prepared = prepare(points.clone(), &control, &Settings::new(vec![optics])).unwrap();
            let found = prepared.adjust().unwrap();
            let own = found.camera(0).parameters()[0].value;
            println!("{name} {model}: {} px RMS, fx {own}, from {:?}", found.rms_px(), prepared.origins);
            // The printed digits, and of five coefficients the printed fx.
            assert!(found.rms_px() < rms + 1.5e-3, "{name} {model}: {} px RMS", found.rms_px());
            assert!(model == "opencv4" || (own - fx).abs() < 0.06, "{name}: fx {own}");
        }
    }
}

/// Up to a third of the image points are off by up to a twentieth of the frame; the camera is that of the others, whose standard deviation is 0.5 px at most.
#[test]
#[cfg_attr(not(networks), ignore = "the networks of others are absent: docs/scenarios.md says where they are looked for")]
fn gross_errors_lead_no_wide_lens_astray() {
    let folder = Path::new(option_env!("CALIBENCH_NETWORKS").unwrap_or_default());
    for (name, [width, height], _, fx) in NETWORKS {
        let points = read_points(&folder.join(format!("{name}.csv"))).unwrap().points;
        let control = read_control(&folder.join(format!("{name}.ctl.csv"))).unwrap();
        for share in [0.0, 0.2, 0.33] {
            let optics = Optics { model: Some("opencv5".into()), ..Optics::new(ImageSize { width, height }) };
            let settings = Settings { gross: GrossErrors::Rejected(Risk::EachPoint), ..Settings::new(vec![optics]) };
            let (points, spoilt) = spoilt(&points, share, [width, height].map(|side| f64::from(side) / 20.0));
            let prepared = prepare(points, &control, &settings).unwrap();
            let found = prepared.adjust().unwrap();
            let own = found.camera(0).parameters()[0].value;
            println!("{name}, {spoilt} gross: {} left out, fx {own}, {} px RMS", found.found.len(), found.rms_px());
            assert!((own - fx).abs() < 1.5 && found.rms_px() < 0.25, "{name}, {share} gross: fx {own}, {} px RMS", found.rms_px());
        }
    }
}

/// The points, of which about a `share` is off by `by` or less, and how many are.
fn spoilt(points: &Points, share: f64, by: [f64; 2]) -> (Points, usize) {
    let (mut state, mut count, mut all) = (98_765_u64, 0, Points::default());
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for mut row in points.rows() {
        let [chosen, x, y] = [uniform(), uniform(), uniform()];
        if chosen < share {
            count += 1;
            row.start.position.x += (2.0 * x - 1.0) * by[0];
            row.start.position.y += (2.0 * y - 1.0) * by[1];
        }
        all.push(row.image, row.target, row.start);
    }
    (all, count)
}
