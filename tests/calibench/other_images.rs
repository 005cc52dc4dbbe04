//! The same camera in other images: resampled, a part of them, turned; and commands that are given images of another size than their camera's.

use std::path::Path;

use calibench_cameras::read_camera;
use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, Ray};
use nalgebra::{Rotation3, Vector3};

use crate::cameras::{CAMERA, folder, good};
use crate::project::{run, stderr, stdout};

fn camera(path: &Path) -> Camera {
    read_camera(path).unwrap_or_else(|error| panic!("{error}")).cameras[0].camera
}

/// A camera of other images pictures rays, turned with its axes, where the images' places come to.
fn agrees(before: &Camera, after: &Camera, ray: impl Fn(Ray) -> Ray, place: impl Fn(PixelPoint) -> PixelPoint) {
    let size = before.size();
    for (x, y) in (0..=8).flat_map(|x| (0..=6).map(move |y| (f64::from(x) / 8.0, f64::from(y) / 6.0))) {
        let at = PixelPoint::new(x * f64::from(size.width - 1), y * f64::from(size.height - 1));
        let found = after.project(ray(before.unproject(at).unwrap())).unwrap();
        assert!(found.distance(place(at)) < 1e-9, "{at:?}: {found:?}, expected {:?}", place(at));
    }
}

#[test]
fn a_camera_is_resampled_cut_and_turned_with_half_pixels_where_they_belong() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let before = camera(&at("camera.yml"));
    let same = |ray: Ray| ray;
    let text = good(folder.path(), &["convert", "camera.yml", "--size", "800x600", "-o", "half.yml"]);
    assert!(text.contains("in other images: 1600 x 1200 px, times 1/2: 800 x 600 px"), "{text}");
    let halved = |p: PixelPoint| PixelPoint::new(0.5 * (p.x + 0.5) - 0.5, 0.5 * (p.y + 0.5) - 0.5);
    agrees(&before, &camera(&at("half.yml")), same, halved);
    // cx is (810 + 0.5) / 2 - 0.5.
    assert!(std::fs::read_to_string(at("half.yml")).unwrap().contains("4.0475"));
    good(folder.path(), &["convert", "half.yml", "--scale", "2", "-o", "back.xml"]);
    agrees(&before, &camera(&at("back.xml")), same, same_place);
    good(folder.path(), &["convert", "camera.yml", "--binned", "3", "--to", "metashape", "-o", "third.xml"]);
    agrees(&before, &camera(&at("third.xml")), same, |p| PixelPoint::new((p.x + 0.5) / 3.0 - 0.5, (p.y + 0.5) / 3.0 - 0.5));
    // A video mode: 16 to 9 out of the middle, resampled.
    let mode = ["convert", "camera.yml", "--crop", "0,150,1600,900", "--size", "1280x720", "--to", "colmap", "-o", "cameras.txt"];
    good(folder.path(), &mode);
    agrees(&before, &camera(&at("cameras.txt")), same, |p| PixelPoint::new(0.8 * (p.x + 0.5) - 0.5, 0.8 * (p.y - 149.5) - 0.5));
    // Portrait: the left side is up, and what pointed right points down.
    let said = good(folder.path(), &["convert", "camera.yml", "--turn", "90", "-o", "upright.yml"]);
    assert!(said.contains("turned by 90 degrees clockwise: 1200 x 1600 px"), "{said}");
    let turned = |ray: Ray| Ray { x: ray.y, y: -ray.x, z: ray.z };
    agrees(&before, &camera(&at("upright.yml")), turned, |p| PixelPoint::new(1199.0 - p.y, p.x));
    good(folder.path(), &["convert", "upright.yml", "--turn", "270", "-o", "round.yml"]);
    agrees(&before, &camera(&at("round.yml")), same, same_place);
}

fn same_place(at: PixelPoint) -> PixelPoint {
    at
}

#[test]
fn an_answer_says_what_images_it_is_of() {
    let folder = folder();
    let text =
        stdout(&run(folder.path(), &["convert", "camera.yml", "--crop", "100,0,1000,900", "--binned", "2", "--turn", "270", "--json"]));
    let found: serde_json::Value = serde_json::from_str(&text).unwrap();
    let images = &found["cameras"][0]["images"];
    let size = |value: &serde_json::Value| [value["width"].as_u64().unwrap(), value["height"].as_u64().unwrap()];
    assert_eq!((size(&images["of"]), size(&images["size"])), ([1600, 1200], [450, 500]), "{text}");
    assert!(
        images["offset"] == serde_json::json!([100.0, 0.0])
            && images["scale"] == serde_json::json!([0.5, 0.5])
            && images["turn_deg"] == 270
    );
}

#[test]
fn a_file_without_a_size_takes_it_and_no_other() {
    let folder = folder();
    let bare: String = CAMERA.lines().filter(|line| !line.starts_with("image_")).map(|line| format!("{line}\n")).collect();
    std::fs::write(folder.path().join("bare.yml"), bare).unwrap();
    let at = |name: &str| folder.path().join(name);
    good(folder.path(), &["convert", "bare.yml", "--size", "1600x1200", "--to", "opencv", "-o", "stated.yml"]);
    // With the fewest coefficients that hold it.
    agrees(&camera(&at("camera.yml")), &camera(&at("stated.yml")), |ray| ray, same_place);
    good(folder.path(), &["convert", "bare.yml", "--size", "1600x1200", "--crop", "0,0,800,600", "--scale", "2", "-o", "part.yml"]);
    good(folder.path(), &["convert", "camera.yml", "--crop", "0,0,800,600", "--size", "1600x1200", "-o", "same.yml"]);
    assert_eq!(camera(&at("part.yml")), camera(&at("same.yml")));
}

#[test]
fn what_makes_no_camera_is_refused_by_name() {
    let folder = folder();
    let with_skew = ["convert", "camera.yml", "--to", "metashape", "-o", "m.xml"];
    good(folder.path(), &with_skew);
    let skewed = std::fs::read_to_string(folder.path().join("m.xml")).unwrap().replace("<k1>", "<b2>0.5</b2>\n  <k1>");
    std::fs::write(folder.path().join("skewed.xml"), skewed).unwrap();
    good(folder.path(), &["convert", "camera.yml", "--to", "photogrammetric", "--pitch", "4", "-o", "p.toml"]);
    for (arguments, expected) in [
        (
            &["convert", "camera.yml", "--crop", "0,400,1600,900"][..],
            "--crop: the part of 1600 x 900 px from column 0 and row 400 on reaches beyond images of 1600 x 1200 px",
        ),
        (&["convert", "camera.yml", "--crop", "0,0,16"], "as in 0,150,1600,900"),
        (&["convert", "camera.yml", "--binned", "1300"], "--binned: of 1600 x 1200 px that makes images of 1 x 0 px"),
        (&["convert", "camera.yml", "--size", "800x600", "--scale", "0.5"], "expected one of --size, --scale, --binned"),
        (&["convert", "camera.yml", "--scale", "0.5", "--binned", "2"], "cannot be used with"),
        (&["convert", "camera.yml", "--turn", "45"], "expected 90, 180 or 270: degrees, clockwise"),
        (&["convert", "camera.yml"], "--to <CONVENTION>"),
        (&["convert", "camera.yml", "--size", "1600x1200"], "--to: expected, as the images stay what they are, 1600 x 1200 px"),
        (&["convert", "skewed.xml", "--turn", "90"], "--turn: turned by 90 degrees: `metashape` has no place for what b2 becomes"),
        (&["convert", "p.toml", "--size", "800x800"], "--size: columns times 1/2, rows times 2/3: `photogrammetric` has one focal length"),
    ] {
        let output = run(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stdout(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: expected {expected}\n{}", stderr(&output));
    }
    good(folder.path(), &["convert", "skewed.xml", "--turn", "180", "-o", "s.xml"]);
    // With two focal lengths, squeezed images are no trouble.
    good(folder.path(), &["convert", "camera.yml", "--size", "800x800", "-o", "squeezed.yml"]);
}

#[test]
fn cameras_of_two_sizes_are_compared_where_they_are_said_to_be_one() {
    let folder = folder();
    good(folder.path(), &["convert", "camera.yml", "--size", "800x600", "-o", "half.yml"]);
    let output = run(folder.path(), &["diff", "half.yml", "camera.yml"]);
    let said = stderr(&output);
    assert!(
        output.status.code() == Some(2) && said.contains("differ in size: 800 x 600 px and 1600 x 1200 px; expected the same"),
        "{said}"
    );
    assert!(said.contains("perhaps the same camera, its images times 1/2; --same-camera takes it so"), "{said}");
    let text = good(folder.path(), &["diff", "half.yml", "camera.yml", "--same-camera"]);
    let rms: f64 = text.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert!(rms < 1e-9 && text.contains("taken as the same camera in another size: 1600 x 1200 px, times 1/2: 800 x 600 px"), "{text}");
    // Half a pixel of principal point forgotten is a quarter of one in images of half the size.
    let naive = std::fs::read_to_string(folder.path().join("half.yml")).unwrap().replace("4.0475", "4.0500").replace("2.9475", "2.9500");
    std::fs::write(folder.path().join("naive.yml"), naive).unwrap();
    let text = good(folder.path(), &["diff", "naive.yml", "camera.yml", "--same-camera", "--no-rotation"]);
    let rms: f64 = text.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert!((rms - 0.125_f64.sqrt()).abs() < 1e-3, "{text}");
    // Of a turned camera sizes do not say which way.
    good(folder.path(), &["convert", "camera.yml", "--turn", "90", "-o", "upright.yml"]);
    let output = run(folder.path(), &["diff", "camera.yml", "upright.yml", "--same-camera"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("`calibench convert upright.yml --turn 90` (or 270)"), "{}", stderr(&output));
}

/// Turns about x, y and the axis of a board before the camera, radians, and where its middle is, object units: x right, y down.
const VIEWS: [([f64; 3], [f64; 2]); 10] = [
    ([-0.5, 0.4, 0.0], [-70.0, -50.0]),
    ([0.5, 0.3, 0.2], [60.0, -40.0]),
    ([0.1, -0.5, 1.5], [0.0, 0.0]),
    ([-0.3, -0.4, 0.4], [-60.0, 40.0]),
    ([0.45, -0.2, -0.3], [70.0, 50.0]),
    ([0.0, 0.5, 0.8], [0.0, -50.0]),
    ([-0.5, 0.0, -1.2], [60.0, 0.0]),
    ([0.3, 0.45, 2.9], [-50.0, 0.0]),
    ([0.05, 0.1, 0.1], [10.0, 5.0]),
    ([-0.4, 0.35, -0.6], [0.0, 45.0]),
];

/// `control.csv` of a chessboard, and its corners in images of half the size as `points.csv`, up to 0.03 px off.
fn simulated(folder: &Path, whole: &Camera) {
    good(folder, &["control", "9x6:25", "-o", "control.csv"]);
    let control = std::fs::read_to_string(folder.join("control.csv")).unwrap();
    let mut points = String::from("image,target,x,y\n");
    let mut count = 0_u32;
    for (view, ([a, b, c], [x, y])) in VIEWS.into_iter().enumerate() {
        let about = |axis: Vector3<f64>, angle: f64| Rotation3::from_scaled_axis(axis * angle);
        let turn = about(Vector3::x(), a) * about(Vector3::y(), b) * about(Vector3::z(), c);
        for row in control.lines().skip(1) {
            let cells: Vec<&str> = row.split(',').collect();
            let [across, up] = [1, 2].map(|column| cells[column].parse::<f64>().unwrap());
            // Seen from before: y of the board is up, and its z points at the camera.
            let seen = turn * Vector3::new(across - 100.0, -(up + 62.5), 0.0) + Vector3::new(x, y, 330.0 + 15.0 * view as f64);
            let at = whole.project(Ray { x: seen.x, y: -seen.y, z: -seen.z }).unwrap();
            count += 1;
            let off = |factor: u32, of: u32| 0.06 * (f64::from(count * factor % of) / f64::from(of) - 0.5);
            let [u, v] = [0.5 * (at.x + 0.5) - 0.5 + off(7919, 101), 0.5 * (at.y + 0.5) - 0.5 + off(10_473, 97)];
            if (0.0..=799.0).contains(&u) && (0.0..=599.0).contains(&v) {
                points.push_str(&format!("i{view}.png,{},{u:.6},{v:.6}\n", cells[0]));
            }
        }
    }
    assert!(points.lines().count() > 450, "{points}");
    std::fs::write(folder.join("points.csv"), points).unwrap();
}

#[test]
fn images_of_half_the_size_are_judged_and_calibrated_with_the_camera_of_the_whole() {
    let folder = folder();
    simulated(folder.path(), &camera(&folder.path().join("camera.yml")));
    let with = |arguments: &[&str], more: &[&str]| {
        let usual = ["--points", "points.csv", "--size", "800x600", "--model", "opencv5"];
        run(folder.path(), &[arguments, &usual[..], more].concat())
    };
    let refused = |output: std::process::Output| {
        let said = stderr(&output);
        let expected = "is of images of 1600 x 1200 px, and these have 800 x 600 px: perhaps the same camera, its images times 1/2; --same-camera takes it so";
        assert!(output.status.code() == Some(2) && said.contains(expected), "{said}");
    };
    let judge = |camera: &str, more: &[&str]| {
        let judged = with(&["judge", "-q", "--chessboard", "9x6:25", "--splits", "3", "--margin", "0.5", "--camera", camera], more);
        (judged.status.code(), stdout(&judged), judged)
    };
    refused(judge("camera.yml", &[]).2);
    let (code, says, output) = judge("camera.yml", &["--same-camera"]);
    assert!(code == Some(0) && says.starts_with("- **holds**: "), "{says}{}", stderr(&output));
    assert!(stderr(&output).contains("camera.yml: taken as the same camera in another size: 1600 x 1200 px, times 1/2: 800 x 600 px"));
    std::fs::write(folder.path().join("moved.yml"), CAMERA.replace("1500.", "1530.")).unwrap();
    let (code, says, _) = judge("moved.yml", &["--same-camera"]);
    assert!(code == Some(1) && says.starts_with("- **has moved**: "), "{says}");
    let start = ["calibrate", "--control", "control.csv", "--start", "camera.yml"];
    refused(with(&start, &[]));
    // Held, it is that very camera; adjusted, it stays there.
    for (more, most) in [(&["--same-camera", "--solve", "none", "-o", "half.yml"][..], 1e-9), (&["--same-camera", "-o", "half.yml"], 0.2)] {
        let output = with(&start, more);
        assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
        let text = good(folder.path(), &["diff", "half.yml", "camera.yml", "--same-camera"]);
        let rms: f64 = text.split("difference").nth(1).and_then(|rest| rest.split_whitespace().next()).unwrap().parse().unwrap();
        assert!(rms < most, "{more:?}: {text}");
    }
}

/// What commands make of the camera of the whole, said to be the same, is what they make of that of half the size; and they refuse it where nobody says so.
#[test]
fn every_command_takes_the_camera_of_another_size_where_it_is_said_to_be_the_same() {
    let folder = folder();
    let here = folder.path();
    simulated(here, &camera(&here.join("camera.yml")));
    good(here, &["convert", "camera.yml", "--size", "800x600", "-o", "half.yml"]);
    let photo = image::GrayImage::from_fn(800, 600, |x, y| image::Luma([(x * 7 + y * 13) as u8]));
    photo.save(here.join("photo.png")).unwrap();
    good(here, &["resect", "-q", "--camera", "half.yml", "--points", "points.csv", "--control", "control.csv", "-o", "stations.csv"]);
    let factor = "is of images of 1600 x 1200 px, and these have 800 x 600 px: perhaps the same camera, its images times 1/2; --same-camera takes it so";
    let taken = "camera.yml: taken as the same camera in another size: 1600 x 1200 px, times 1/2: 800 x 600 px";
    let points = ["--points", "points.csv", "-q"];
    let pair = ["orient", "--left", "i0.png", "--right", "i3.png", "--base", "100"];
    for (arguments, is_of_points) in [
        ([&["resect", "--control", "control.csv"][..], &points].concat(), true),
        ([&["intersect", "--stations", "stations.csv"][..], &points].concat(), true),
        ([&pair[..], &points].concat(), true),
        (vec!["undistort", "-q", "points.csv"], true),
        (vec!["undistort", "-q", "photo.png", "--frame", "crop"], false),
    ] {
        let (out, size): (_, &[&str]) = if is_of_points { ("o.csv", &["--size", "800x600"]) } else { ("flat", &[]) };
        let written = || {
            let file = if is_of_points { out } else { "flat/photo.png" };
            std::fs::read(here.join(file)).unwrap_or_else(|error| panic!("{arguments:?}: {error}"))
        };
        let of = |camera: &str, more: &[&str]| run(here, &[&arguments[..], &["--camera", camera, "-o", out], more].concat());
        let half = of("half.yml", &[]);
        let expected = written();
        let refused = of("camera.yml", size);
        assert!(refused.status.code() == Some(2) && stderr(&refused).contains(factor), "{arguments:?}: {}", stderr(&refused));
        let same = of("camera.yml", &[size, &["--same-camera"]].concat());
        assert_eq!(half.status.code(), same.status.code(), "{arguments:?}: {}", stderr(&same));
        assert!(stderr(&same).contains(taken), "{arguments:?}: {}", stderr(&same));
        assert!(written() == expected, "{arguments:?}");
    }
    let serve = ["point", "photo.png", "--serve", "--idle", "0.01", "--camera", "camera.yml"];
    let refused = run(here, &serve);
    assert!(refused.status.code() == Some(2) && stderr(&refused).contains(factor), "{}", stderr(&refused));
    let same = run(here, &[&serve[..], &["--same-camera"]].concat());
    assert!(same.status.success() && stderr(&same).contains(taken), "{}", stderr(&same));
}

/// Points that lie in no pixel of a camera's images are said, since the images may be of another size.
#[test]
fn points_beyond_the_images_of_a_camera_are_in_doubt() {
    let folder = folder();
    let here = folder.path();
    simulated(here, &camera(&here.join("camera.yml")));
    good(here, &["convert", "camera.yml", "--size", "800x600", "-o", "half.yml"]);
    good(here, &["convert", "camera.yml", "--size", "400x300", "-o", "quarter.yml"]);
    good(here, &["resect", "-q", "--camera", "half.yml", "--points", "points.csv", "--control", "control.csv", "-o", "stations.csv"]);
    let of = |camera: &str| {
        ["intersect", "-q", "--points", "points.csv", "--stations", "stations.csv", "--camera", camera, "-o", "o.csv"].map(str::to_owned)
    };
    let said = |camera: &str| stderr(&run(here, &of(camera).each_ref().map(String::as_str)));
    assert!(!said("half.yml").contains("lie outside"), "{}", said("half.yml"));
    let told = said("quarter.yml");
    assert!(told.contains(" points lie outside the images: is the camera's size that of the images (--size says theirs)"), "{told}");
    let undistorted = run(here, &["undistort", "points.csv", "--camera", "quarter.yml", "-o", "o.csv"]);
    assert!(stderr(&undistorted).contains(" of the points that are given lie outside of their pictures"), "{}", stderr(&undistorted));
}

/// A file that states no size is of the images that it is first used for, and of no others.
#[test]
fn a_camera_without_a_size_serves_photographs_of_one_size() {
    let folder = folder();
    let here = folder.path();
    let bare: String = CAMERA.lines().filter(|line| !line.starts_with("image_")).map(|line| format!("{line}\n")).collect();
    std::fs::write(here.join("bare.yml"), bare).unwrap();
    for (name, width, height) in [("a.png", 1600, 1200), ("b.png", 800, 600)] {
        image::GrayImage::new(width, height).save(here.join(name)).unwrap();
    }
    let serve = |photos: &[&str]| run(here, &[&["point", "--serve", "--idle", "0.01", "--camera", "bare.yml"], photos].concat());
    assert!(serve(&["a.png"]).status.success(), "{}", stderr(&serve(&["a.png"])));
    let refused = serve(&["a.png", "b.png"]);
    assert!(refused.status.code() == Some(2) && stderr(&refused).contains("times 1/2"), "{}", stderr(&refused));
    // Of pictures that are undistorted the size need not be said either.
    good(here, &["undistort", "-q", "a.png", "--camera", "bare.yml", "-o", "flat"]);
}
