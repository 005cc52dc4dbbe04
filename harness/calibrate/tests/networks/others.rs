//! Networks that others made: the optimum is that of OpenCV's `calibrateCamera`.

use std::path::Path;

use calibench_calibrate::{Optics, Settings, prepare};
use calibench_exchange::{read_control, read_points};
use calibench_model::camera::{CameraModel, ImageSize};

/// Name, size, RMS (2D) and fx of OpenCV, px.
const NETWORKS: [(&str, [u32; 2], f64, f64); 3] =
    [("60", [4000, 3000], 0.206, 1328.2), ("98", [1280, 1024], 0.195, 582.9), ("1002", [4000, 3000], 0.205, 1418.6)];

#[test]
#[cfg_attr(not(networks), ignore = "the networks of others are absent: see the README, `Data`")]
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
