//! How far numbers of each image's own scatter, as images tell: over networks of which all is known.

use calibench_calibrate::{Optics, Prepared, Settings, prepare};
use calibench_exchange::points::parse_points;
use calibench_model::camera::{Camera, CameraModel};

use super::network::{Scene, board, lens, noise, optics};

const TRIALS: u64 = 24;
const TRUTH: [f64; 4] = [1450.0, 1446.0, 812.0, 590.0];

/// Three times seven sides of the board, each time from farther off; `scatter` of principal distance and point, px.
fn prepared(seed: u64, scatter: [f64; 3], names: &str) -> Prepared {
    let scene = Scene { sigma: 0.1, ..board(lens()) };
    let (mut text, mut state) = (String::from("image,target,x,y\n"), 1000 + seed);
    for image in 0..3 * scene.poses.len() {
        let mut pose = scene.poses[image % scene.poses.len()];
        pose.centre.z += 25.0 * (image / scene.poses.len()) as f64;
        let own = scatter.map(|sigma| sigma * noise(&mut state));
        let shift = [own[0], own[0] * TRUTH[1] / TRUTH[0], own[1], own[2]];
        let values = scene.camera.parameters().into_iter().enumerate();
        let values: Vec<f64> = values.map(|(k, parameter)| parameter.value + shift.get(k).unwrap_or(&0.0)).collect();
        let camera: Camera = scene.camera.with_parameters(&values);
        for (target, position) in scene.targets.iter().enumerate() {
            let Ok(seen) = camera.project(pose.ray(position)) else { continue };
            let (x, y) = (seen.x + scene.sigma * noise(&mut state), seen.y + scene.sigma * noise(&mut state));
            text += &format!("{image}.png,t{target},{x},{y}\n");
        }
    }
    let points = parse_points("points.csv", text.as_bytes()).unwrap().points;
    let per_image = names.split(',').map(|name| name.parse().unwrap()).collect();
    let cameras = vec![Optics { per_image, pitch_um: None, ..optics("opencv5") }];
    prepare(points, &scene.known(), &Settings { sigma_px: Some(0.1), ..Settings::new(cameras) }).unwrap()
}

/// Mean squares of the scatter found and of the camera's errors in its standard deviations.
fn squares(scatter: [f64; 3]) -> ([f64; 3], [f64; 4]) {
    let (mut found, mut errors) = ([0.0; 3], [0.0; 4]);
    for seed in 0..TRIALS {
        let prepared = prepared(seed, scatter, "c,x0,y0");
        (0..3).for_each(|k| found[k] += prepared.scatter[k].sigma.powi(2) / TRIALS as f64);
        let calibration = prepared.adjust().unwrap();
        for (k, parameter) in calibration.camera(0).parameters().iter().take(4).enumerate() {
            errors[k] += (parameter.value - TRUTH[k]).powi(2) / calibration.covariances.interior[(k, k)] / TRIALS as f64;
        }
    }
    (found, errors)
}

#[test]
fn it_is_found_without_bias_and_the_camera_is_as_good_as_it_says() {
    let truth = [6.0, 2.0, 2.0];
    let (found, errors) = squares(truth);
    // Of 21 images a variance is known to a third at best, of 24 networks to a fifteenth: four times that, and what poses take up.
    (0..3).for_each(|k| assert!((0.6..1.5).contains(&(found[k] / truth[k].powi(2))), "{found:?}"));
    // Four standard deviations of a mean of 24 squares.
    errors.iter().for_each(|square| assert!((square - 1.0).abs() < 4.0 * (2.0 / TRIALS as f64).sqrt(), "{errors:?}"));
}

#[test]
fn none_is_found_where_there_is_none() {
    let (found, errors) = squares([0.0; 3]);
    found.iter().for_each(|square| assert!(square.sqrt() < 0.5, "{found:?}"));
    errors.iter().for_each(|square| assert!((square - 1.0).abs() < 4.0 * (2.0 / TRIALS as f64).sqrt(), "{errors:?}"));
    let unseen = (0..TRIALS).filter(|seed| prepared(*seed, [0.0; 3], "c,x0,y0").scatter[0].sigma == 0.0).count();
    assert!(unseen as u64 > TRIALS / 3, "{unseen}");
}

#[test]
fn what_is_stated_is_taken() {
    let prepared = prepared(3, [6.0, 2.0, 2.0], "c:6,x0:2,y0:2");
    assert!(prepared.scatter.is_empty());
    let stated: Vec<f64> = prepared.network.per_image.iter().map(|own| own.sigma).collect();
    assert_eq!(stated, [6.0, 2.0, 2.0]);
}
