//! Simple cases, as similar triangles give them.

use calibench_model::NamedCamera;
use calibench_model::camera::Camera;
use calibench_model::named_camera::ParameterCovariance;

use super::*;
use crate::{Exact, KnownCamera, TaskError, map};

/// By hand, of a camera 800 above the middle of a length of 100 that lies across its axis; distortion is 0.04 % there.
#[test]
fn one_image_before_a_plane_costs_what_similar_triangles_say() {
    let text = format!("{DOWN}[temperature]\ndifference = 5\nsigma = 2\nexpansion = 2e-5\nexpansion_sigma = 1e-6\n");
    let named = camera(&[("fx", 1.0)]);
    let budget = Budget::of(&task(&text), &KnownCamera { halves: Some(1.25), ..KnownCamera::of(&named) }, None).unwrap();
    let length = &budget.components[0];
    near(length.named.value.unwrap(), 100.0, 1e-9);
    // Two image coordinates along the length, at 0.4 object units a pixel.
    near(of(&budget, Source::Image), 0.1 * 0.4 * 2.0_f64.sqrt(), 0.002);
    near(of(&budget, Source::Camera), 100.0 / 2000.0, 0.002);
    // 1.25^2 is 1 and 0.75^2.
    near(of(&budget, Source::Model), 0.75 * 100.0 / 2000.0, 0.002);
    // The camera or the plane nearer by so much; aside nothing changes.
    near(of(&budget, Source::Centres), 100.0 / 800.0 * 0.3, 1e-6);
    near(of(&budget, Source::Plane), 100.0 / 800.0 * 0.4, 1e-6);
    near(of(&budget, Source::Scale), 100.0 * 2e-4, 1e-6);
    near(of(&budget, Source::Temperature), 100.0 * 4e-5_f64.hypot(5e-6), 1e-6);
    // Turns and tilts about the middle lengthen one half and shorten the other.
    assert!(of(&budget, Source::Angles) < 1e-3 && of(&budget, Source::PlaneTilt) < 1e-3, "{budget:?}");
    let all: f64 = length.parts.iter().map(|part| part.sigma.powi(2)).sum();
    near(length.sigma, all.sqrt(), 1e-12);
    near(length.parts.iter().map(|part| part.share).sum(), 1.0, 1e-12);
    let [low, high] = length.interval().unwrap();
    near(high - low, 2.0 * 1.96 * length.sigma, 1e-4);
    assert!(budget.exact.is_empty() && !budget.is_bent(), "{budget:?}");
    assert_eq!(length.largest(), Some(Source::Image));
}

/// By hand, of the normal case: base 400, principal distance 2000 px, no distortion. Along the line of sight an end errs by Z^2 / (B c) times that of the parallax, across by Z / c of that of the mean.
#[test]
fn depth_costs_what_the_parallax_says() {
    let images = "[[image]]\ncentre = [-200, 0, 1000]\nangles = [0, 0, 0]\n[[image]]\ncentre = [200, 0, 1000]\nangles = [0, 0, 0]\n";
    let mut named = camera(&[]);
    if let Camera::OpenCv(camera) = &mut named.camera {
        camera.distortion[0] = 0.0;
    }
    let budget =
        |what: &str| Budget::of(&task(&format!("sigma = 0.1\n[measure]\n{what}\n{images}")), &KnownCamera::of(&named), None).unwrap();
    let end = |depth: f64| depth * depth / (400.0 * 2000.0) * 0.1 * 2.0_f64.sqrt();
    let length = budget("length = [[0, 0, 0], [0, 0, -200]]");
    near(length.components[0].sigma, end(1000.0).hypot(end(1200.0)), 1e-4);
    assert_eq!(length.exact, [Exact::Camera, Exact::Centres, Exact::Angles, Exact::Scale, Exact::Temperature]);
    assert_eq!(length.components[0].parts.len(), 1);
    let point = budget("point = [0, 0, 0]");
    near(point.components[2].sigma, end(1000.0), 1e-4);
    near(point.components[1].sigma, 1000.0 / 2000.0 * 0.1 / 2.0_f64.sqrt(), 1e-4);
    // Three points in the plane across: the one at the side tips it, by its height and by half of those of the others.
    let plane = budget("plane = [[-100, 0, 0], [100, 0, 0], [0, 60, 0]]");
    let tilts = [plane.components[1].sigma, plane.components[2].sigma].map(f64::to_radians);
    near(tilts[0], end(1000.0) * 1.5_f64.sqrt() / 60.0, 2e-3);
    near(tilts[1], end(1000.0) * 2.0_f64.sqrt() / 200.0, 2e-3);
    // An angle between two arms across: each arm turns by what its ends are apart.
    let angle = budget("angle = [[100, 0, 0], [0, 0, 0], [0, 100, 0]]");
    assert!(angle.components[0].named.in_degrees && !angle.exact.contains(&Exact::Scale));
    near(angle.components[0].named.value.unwrap(), 90.0, 1e-9);
    // A rotation about the line of sight: of four points at 100 from the middle the mean of four turns.
    let turn = budget("rotation = [[100, 0, 0], [-100, 0, 0], [0, 100, 0], [0, -100, 0]]");
    let across = 1000.0 / 2000.0 * 0.1 / 2.0_f64.sqrt();
    near(turn.components[2].sigma.to_radians(), across / 100.0 / 2.0, 2e-2);
}

/// A camera that is known to 10 px costs 0.5 in 100 where its pose is stated, and next to nothing where a board in the plane gives the pose with the same camera.
#[test]
fn what_a_pose_makes_up_for_costs_nothing() {
    let named = camera(&[("fx", 10.0), ("fy", 10.0)]);
    let known = KnownCamera::of(&named);
    let stated = Budget::of(&task(DOWN), &known, None).unwrap();
    let text = format!("{DOWN}[control]\nsigma = 0.05\nflatness_sigma = 0.1\n");
    let held = Budget::of(&task(&text), &known, Some(&board())).unwrap();
    near(of(&stated, Source::Camera), 0.5, 0.01);
    // fx and fy are known to 10 px and not to be the same: what they differ by is left.
    assert!(of(&held, Source::Camera) < 0.35 * of(&stated, Source::Camera), "{held:?}");
    assert!(of(&held, Source::Centres) == 0.0 && of(&held, Source::ControlImage) > 0.0 && of(&held, Source::ControlPoints) > 0.0);
    assert!(of(&held, Source::Flatness) > 0.0);
    assert_eq!(held.exact, [Exact::Model, Exact::Temperature]);
}

/// Errors of a board's points are the same in all images: as many images as one likes leave them.
#[test]
fn what_the_board_errs_does_not_average_out_over_images() {
    let named = camera(&[]);
    let image = |x: i32| format!("[[image]]\ncentre = [{x}, 0, 700]\ntarget = [0, 0, 0]\n");
    let text = |count: i32| {
        let images: String = (0..count).map(|k| image(600 * k / (count - 1) - 300)).collect();
        format!("sigma = 0.1\n[measure]\nlength = [[-50, 0, 0], [50, 0, 0]]\n{images}")
    };
    let budget = |count: i32| Budget::of(&task(&text(count)), &KnownCamera::of(&named), Some(&board())).unwrap();
    let (few, many) = (budget(3), budget(12));
    assert!(of(&many, Source::Image) < 0.6 * of(&few, Source::Image), "{many:?}");
    assert!(of(&many, Source::ControlPoints) > 0.8 * of(&few, Source::ControlPoints), "{few:?}{many:?}");
}

/// Over a plane across a vertical camera a length of one direction costs the same at places that mirror each other, and more outside.
#[test]
fn a_map_is_as_even_as_its_geometry() {
    let named = camera(&[("fx", 1.0), ("fy", 1.0), ("k1", 0.002)]);
    let found = map(&task(DOWN), &KnownCamera::of(&named), None, 0.0).unwrap();
    assert_eq!((found.at, found.grid[0]), (Some(("Z", 0.0)), 48));
    let cell = |column: usize, row: usize| found.cells[row * found.grid[0] + column];
    let (middle, row) = (found.grid[0] / 2, found.grid[1] / 2);
    let [left, right] = [cell(10, row), cell(found.grid[0] - 11, row)].map(|cell| cell.unwrap().half);
    near(left, right, 0.02);
    assert!(left > 1.1 * cell(middle, row).unwrap().half, "{left}");
    // Beside the frame an end is not seen.
    assert!(cell(0, row).is_none() && cell(middle, 0).is_some());
    let pair = format!("sigma = 0.1\n[measure]\npoint = [0, 0, 0]\n{PAIR}");
    let [here, behind] = [0.0, -100.0].map(|offset| map(&task(&pair), &KnownCamera::of(&named), None, offset).unwrap());
    assert_eq!(behind.at, Some(("Z", -100.0)));
    let least = |map: &crate::Map| map.cells.iter().flatten().map(|cell| cell.half).fold(f64::INFINITY, f64::min);
    assert!(least(&behind) > least(&here));
}

#[test]
fn what_cannot_be_measured_says_why() {
    let named = camera(&[]);
    let error =
        |text: &str, control: Option<&[ControlRow]>| Budget::of(&task(text), &KnownCamera::of(&named), control).unwrap_err().to_string();
    let missed = "point 2 of what is measured lies in the frame of 0 images; expected 1";
    assert_eq!(error(&DOWN.replace("[50, 0, 0]]", "[900, 0, 0]]"), None), missed);
    assert!(
        error(&DOWN.replace("[50, 0, 0]]", "[50, 0, 5]]"), None)
            .starts_with("point 2 of what is measured lies 5.000e0 off the known plane")
    );
    assert!(error(DOWN, Some(&board()[..3])).starts_with("image 1 shows 3 control points"));
    // On a line.
    assert!(error(DOWN, Some(&board()[..9])).starts_with("image 1 shows 9 control points"));
    let mut deep = board();
    deep[0].position[2] = 40.0;
    assert_eq!(
        Budget::of(&task(&format!("{DOWN}[control]\nflatness_sigma = 1\n")), &KnownCamera::of(&named), Some(&deep)).unwrap_err(),
        TaskError::NoBoard
    );
    let known = NamedCamera { covariance: Some(ParameterCovariance::new(vec!["c".into()], vec![1.0]).unwrap()), ..named.clone() };
    assert_eq!(Budget::of(&task(DOWN), &KnownCamera::of(&known), None).unwrap_err(), TaskError::Parameter("c".into()));
    let straight = DOWN.replace("length = [[-50, 0, 0], [50, 0, 0]]", "angle = [[-50, 0, 0], [0, 0, 0], [50, 0, 0]]");
    assert!(error(&straight, None).starts_with("an angle of 0 or 180 degrees"));
}
