//! One reconstruction in the files of four tools.

use std::fmt::Write;
use std::path::Path;

use calibench_model::camera::{Camera, CameraModel, ImageSize};
use calibench_model::{Pose, Reconstruction};
use nalgebra::{Point3, Vector3};

use crate::reconstructions::{read_reconstruction, write_colmap};

const SIZE: ImageSize = ImageSize { width: 800, height: 600 };
const LENS: [f64; 3] = [700.0, -0.1, 0.02];

fn poses() -> Vec<Pose> {
    let station = |i: u32| {
        let centre = Point3::new(f64::from(i) - 1.0, 0.3 * f64::from(i), 5.0);
        Pose::looking_at(centre, Point3::origin(), Vector3::y(), 0.4 * f64::from(i)).unwrap()
    };
    (0..3).map(station).collect()
}

fn points() -> Vec<Point3<f64>> {
    (0..12).map(|i: u32| Point3::new(f64::from(i % 4) - 1.5, f64::from(i / 4) - 1.0, 0.2 * f64::from(i % 3))).collect()
}

/// Where Bundler and BAL have the point: from the middle of the frame, y up. Written from the tools' own formulas.
fn from_middle(pose: &Pose, point: &Point3<f64>) -> [f64; 2] {
    let n = pose.rotation * (point - pose.centre);
    let p = [-n.x / n.z, -n.y / n.z];
    let r2 = p[0] * p[0] + p[1] * p[1];
    let [f, k1, k2] = LENS;
    p.map(|v| f * (1.0 + k1 * r2 + k2 * r2 * r2) * v)
}

/// Corner of the first pixel is (0, 0), y down.
fn corner(pose: &Pose, point: &Point3<f64>) -> [f64; 2] {
    let [x, y] = from_middle(pose, point);
    [400.0 + x, 300.0 - y]
}

fn rows(pose: &Pose, forward: bool) -> [[f64; 3]; 3] {
    let sign = if forward { [1.0, -1.0, -1.0] } else { [1.0; 3] };
    std::array::from_fn(|i| std::array::from_fn(|j| sign[i] * pose.rotation[(i, j)]))
}

fn shift(pose: &Pose, forward: bool) -> [f64; 3] {
    let t = -(pose.rotation * pose.centre.coords);
    if forward { [t.x, -t.y, -t.z] } else { t.into() }
}

fn bal() -> String {
    let (poses, points) = (poses(), points());
    let mut out = String::from("3 12 36\n");
    for (j, point) in points.iter().enumerate() {
        for (i, pose) in poses.iter().enumerate() {
            let [x, y] = from_middle(pose, point);
            writeln!(out, "{i} {j}     {x:e} {y:e}").unwrap();
        }
    }
    for pose in &poses {
        let turn = nalgebra::Rotation3::from_matrix_unchecked(pose.rotation).scaled_axis();
        for value in turn.iter().copied().chain(shift(pose, false)).chain(LENS) {
            writeln!(out, "{value:e}").unwrap();
        }
    }
    points.iter().for_each(|p| writeln!(out, "{}\n{}\n{}", p.x, p.y, p.z).unwrap());
    out
}

fn bundler() -> String {
    let (poses, points) = (poses(), points());
    let mut out = String::from("# Bundle file v0.3\n4 12\n");
    let line = |v: &[f64]| v.iter().map(f64::to_string).collect::<Vec<_>>().join(" ") + "\n";
    // The second image is one that was not oriented.
    for (place, pose) in [Some(0), None, Some(1), Some(2)].into_iter().map(|i: Option<usize>| (i, i.map(|i| &poses[i]))) {
        let Some(pose) = pose else {
            (0..5).for_each(|_| out.push_str("0 0 0\n"));
            continue;
        };
        assert!(place.is_some());
        out.push_str(&line(&LENS));
        rows(pose, false).iter().for_each(|row| out.push_str(&line(row)));
        out.push_str(&line(&shift(pose, false)));
    }
    for point in &points {
        out.push_str(&line(&[point.x, point.y, point.z]));
        out.push_str("10 20 30\n3");
        for (i, pose) in [0, 2, 3].into_iter().zip(&poses) {
            let [x, y] = from_middle(pose, point);
            write!(out, " {i} 7 {x} {y}").unwrap();
        }
        out.push('\n');
    }
    out
}

fn openmvg() -> String {
    let (poses, points) = (poses(), points());
    let [f, k1, k2] = LENS;
    let camera = format!(
        "{{\"key\": 5, \"value\": {{\"polymorphic_id\": 2147483649, \"polymorphic_name\": \"pinhole_radial_k3\", \"ptr_wrapper\": {{\"id\": 2147483650, \"data\": \
         {{\"width\": 800, \"height\": 600, \"focal_length\": {f}, \"principal_point\": [400.0, 300.0], \"disto_k3\": [{k1}, {k2}, 0.0]}}}}}}}}"
    );
    let view = |i: usize, pose: u64| {
        format!(
            "{{\"key\": {i}, \"value\": {{\"polymorphic_id\": 1073741824, \"ptr_wrapper\": {{\"id\": 2147483660, \"data\": {{\"local_path\": \"/\", \"filename\": \"i{i}.jpg\", \
             \"width\": 800, \"height\": 600, \"id_view\": {i}, \"id_intrinsic\": 5, \"id_pose\": {pose}}}}}}}}}"
        )
    };
    let views: Vec<String> = (0..3).map(|i| view(i, i as u64)).chain([view(3, 4_294_967_295)]).collect();
    let pose = |(i, pose): (usize, &Pose)| {
        format!(
            "{{\"key\": {i}, \"value\": {{\"rotation\": {:?}, \"center\": {:?}}}}}",
            rows(pose, true),
            <[f64; 3]>::from(pose.centre.coords)
        )
    };
    let seen = |point: &Point3<f64>| {
        let one = |(i, pose): (usize, &Pose)| format!("{{\"key\": {i}, \"value\": {{\"id_feat\": 1, \"x\": {:?}}}}}", corner(pose, point));
        poses.iter().enumerate().map(one).collect::<Vec<_>>().join(", ")
    };
    let point = |(j, point): (usize, &Point3<f64>)| {
        format!("{{\"key\": {j}, \"value\": {{\"X\": {:?}, \"observations\": [{}]}}}}", <[f64; 3]>::from(point.coords), seen(point))
    };
    let list = |all: Vec<String>| all.join(",\n");
    format!(
        "{{\"sfm_data_version\": \"0.3\", \"root_path\": \"\", \"views\": [{}], \"intrinsics\": [{camera}], \"extrinsics\": [{}], \"structure\": [{}], \"control_points\": []}}",
        list(views),
        list(poses.iter().enumerate().map(pose).collect()),
        list(points.iter().enumerate().map(point).collect())
    )
}

/// COLMAP's text model in the words of its documentation.
fn colmap(folder: &Path) {
    let (poses, points) = (poses(), points());
    let [f, k1, k2] = LENS;
    std::fs::write(folder.join("cameras.txt"), format!("# one\n7 RADIAL 800 600 {f} 400 300 {k1} {k2}\n")).unwrap();
    let mut images = String::from("# two lines each\n");
    for (i, pose) in poses.iter().enumerate() {
        let r = nalgebra::Matrix3::from_fn(|a, b| rows(pose, true)[a][b]);
        let q = nalgebra::UnitQuaternion::from_rotation_matrix(&nalgebra::Rotation3::from_matrix_unchecked(r));
        let [x, y, z] = shift(pose, true);
        writeln!(images, "{} {} {} {} {} {x} {y} {z} 7 a photo {i}.jpg", i + 1, q.w, q.i, q.j, q.k).unwrap();
        let seen = |(j, point): (usize, &Point3<f64>)| {
            let [x, y] = corner(pose, point);
            format!("{x} {y} {} 3.5 4.5 -1", 100 + j)
        };
        images += &(points.iter().enumerate().map(seen).collect::<Vec<_>>().join(" ") + "\n");
    }
    std::fs::write(folder.join("images.txt"), images).unwrap();
    let point = |(j, p): (usize, &Point3<f64>)| format!("{} {} {} {} 9 9 9 0.5 1 0 2 0 3 0\n", 100 + j, p.x, p.y, p.z);
    std::fs::write(folder.join("points3D.txt"), points.iter().enumerate().map(point).collect::<String>()).unwrap();
}

/// Cameras, poses, points and sights are those that were written; each camera pictures each point where it was seen.
fn is_the_scene(found: &Reconstruction, camera_per_image: bool, origin: [f64; 2], what: &str) {
    let (poses, points) = (poses(), points());
    assert_eq!((found.images.len(), found.points.len(), found.sights.len()), (3, 12, 36), "{what}");
    assert_eq!(found.cameras.len(), if camera_per_image { 3 } else { 1 }, "{what}");
    for (image, pose) in found.images.iter().zip(&poses) {
        assert!(
            (image.pose.rotation - pose.rotation).amax() < 1e-9 && (image.pose.centre - pose.centre).amax() < 1e-9,
            "{what}: {}",
            image.name
        );
    }
    assert!(found.points.iter().zip(&points).all(|(found, point)| (found.position - point).amax() < 1e-12), "{what}");
    for sight in &found.sights {
        let image = &found.images[sight.image];
        let camera = found.cameras[image.camera].named.camera;
        let at = camera.project(image.pose.ray(&found.points[sight.point].position)).unwrap();
        assert!((at.x - sight.position.x).hypot(at.y - sight.position.y) < 1e-9, "{what}: {at:?} {sight:?}");
        let [x, y] = corner(&poses[sight.image], &points[sight.point]);
        assert!((sight.position.x - x + origin[0]).abs() < 1e-9 && (sight.position.y - y + origin[1]).abs() < 1e-9, "{what}");
    }
}

fn read(name: &str, text: &str, size: Option<ImageSize>) -> Result<Reconstruction, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    read_reconstruction(&path, size).map(|file| file.reconstruction).map_err(|error| error.to_string())
}

#[test]
fn four_tools_say_the_same() {
    is_the_scene(&read("problem.txt", &bal(), Some(SIZE)).unwrap(), true, [0.5; 2], "BAL");
    let found = read("bundle.out", &bundler(), Some(SIZE)).unwrap();
    is_the_scene(&found, true, [0.5; 2], "Bundler");
    assert_eq!(found.images.iter().map(|image| image.name.as_str()).collect::<Vec<_>>(), ["0", "2", "3"]);
    assert_eq!(found.notes, ["1 images that are not oriented were left out"]);
    let found = read("sfm_data.json", &openmvg(), None).unwrap();
    is_the_scene(&found, false, [0.0; 2], "OpenMVG");
    assert_eq!(found.cameras[0].lens, ["f", "k1", "k2", "k3"]);
    let folder = tempfile::tempdir().unwrap();
    colmap(folder.path());
    for path in [folder.path().to_owned(), folder.path().join("images.txt")] {
        let found = read_reconstruction(&path, None).unwrap();
        is_the_scene(&found.reconstruction, false, [0.5; 2], "COLMAP");
        assert_eq!((found.tool, found.reconstruction.images[1].name.as_str()), ("COLMAP", "a photo 1.jpg"));
        assert_eq!(
            (found.reconstruction.cameras[0].lens.as_slice(), found.reconstruction.points[3].name.as_str()),
            (&["f", "k1", "k2"][..], "103")
        );
    }
}

#[test]
fn without_a_size_the_frame_holds_all_points() {
    for (name, text) in [("problem.txt", bal()), ("bundle.out", bundler())] {
        let found = read(name, &text, None).unwrap();
        let size = found.cameras[0].named.camera.size();
        let inside = |v: f64, side: u32| (0.0..f64::from(side) - 1.0).contains(&v);
        assert!(
            found.sights.iter().all(|sight| inside(sight.position.x, size.width) && inside(sight.position.y, size.height)),
            "{name}: {size:?}"
        );
        assert!(found.cameras.iter().all(|camera| camera.principal_point.is_empty()), "{name}");
    }
}

#[test]
fn what_is_written_is_read_again() {
    let before = read("problem.txt", &bal(), Some(SIZE)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in write_colmap(&before, &[0.25; 12]).unwrap() {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let after = read_reconstruction(folder.path(), None).unwrap().reconstruction;
    is_the_scene(&after, true, [0.5; 2], "written");
    let same = |(a, b): (&Camera, &Camera)| a.parameters().iter().zip(b.parameters()).all(|(a, b)| (a.value - b.value).abs() < 1e-9);
    let cameras = |all: &Reconstruction| all.cameras.iter().map(|camera| camera.named.camera).collect::<Vec<_>>();
    assert!(cameras(&before).iter().zip(&cameras(&after)).all(same));
}

#[test]
fn mistakes_are_named_with_their_place() {
    let cut = |text: &str, lines: usize| text.lines().take(lines).collect::<Vec<_>>().join("\n");
    let wrong = [
        (
            "problem.txt",
            bal().replacen("\n2 0 ", "\n3 0 ", 1),
            "problem.txt:4, `an observation: camera, point, x, y`: camera 3 is not there; expected 0 to 2",
        ),
        ("problem.txt", cut(&bal(), 40), "ends before the nine numbers of camera 0"),
        ("problem.txt", bal() + "1\n", "expected the end of the file, found `1`"),
        ("problem.txt", bal().replacen("\n7e2\n", "\n-7e2\n", 1), "expected a number above zero, found -700"),
        ("bundle.out", bundler().replacen(" 3 7 ", " 4 7 ", 1), "`point 0`: camera 4 is not there; expected 0 to 3"),
        ("bundle.out", cut(&bundler(), 25), "ends before"),
        ("sfm_data.json", openmvg().replacen("\"center\"", "\"centre\"", 1), "has no `center`"),
        ("x.txt", "BZh91AY".into(), "is compressed; expected a plain file: bunzip2 makes it one"),
        ("x.txt", "hello\n".into(), "is no reconstruction that is known; expected a problem of Bundle Adjustment in the Large"),
    ];
    for (name, text, expected) in wrong {
        let error = read(name, &text, Some(SIZE)).unwrap_err();
        assert!(error.contains(expected), "{expected}: {error}");
    }
    let folder = tempfile::tempdir().unwrap();
    colmap(folder.path());
    let edited = |name: &str, from: &str, to: &str| {
        colmap(folder.path());
        let path = folder.path().join(name);
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{from}");
        std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
        read_reconstruction(folder.path(), None).map(|_| ()).unwrap_err().to_string()
    };
    for (name, from, to, expected) in [
        ("images.txt", " 7 a photo", " 8 a photo", "camera 8 is not in the list of cameras"),
        ("images.txt", " -1\n", " \n", "expected X, Y, POINT3D_ID of each point, found 71 words"),
        ("points3D.txt", "101 ", "100 ", "point 100 stands twice; expected each once"),
        ("points3D.txt", "100 -1.5", "100 x", "points3D.txt:1: expected a finite number"),
    ] {
        let error = edited(name, from, to);
        assert!(error.contains(expected), "{expected}: {error}");
    }
    std::fs::remove_file(folder.path().join("points3D.txt")).unwrap();
    let error = read_reconstruction(folder.path(), None).unwrap_err().to_string();
    assert!(error.contains("holds neither points3D.bin nor points3D.txt"), "{error}");
}

/// Three cameras on a rig and one by itself, as COLMAP 3.12 writes them: with an IMU, which is no camera.
#[test]
fn cameras_that_colmap_took_as_a_rig_are_known() {
    let folder = tempfile::tempdir().unwrap();
    colmap(folder.path());
    let cameras: String = [7, 9, 4, 5].iter().map(|id| format!("{id} SIMPLE_PINHOLE 800 600 700 400 300\n")).collect();
    std::fs::write(folder.path().join("cameras.txt"), cameras).unwrap();
    let rigs = || {
        let found = read_reconstruction(folder.path(), None).unwrap();
        (found.rigs, found.reconstruction.notes)
    };
    assert_eq!(rigs(), (Vec::new(), Vec::new()));
    let pose = "0.5 0.5 0.5 0.5 1 2 3";
    let text = format!("# rigs\n1 4 CAMERA 9 IMU 1 1 {pose} CAMERA 7 1 {pose} CAMERA 4 0\n2 1 CAMERA 5\n");
    std::fs::write(folder.path().join("rigs.txt"), &text).unwrap();
    assert_eq!(rigs(), (vec![vec![1, 0, 2]], Vec::new()));
    for (from, to, why) in [
        (" 0\n", "\n", "rigs.txt:2, `HAS_POSE`: expected another word, found the end of the line"),
        ("1 4", "1 3", "rigs.txt:2: expected the end of the line, found `CAMERA`"),
        ("IMU 1", "IMU x", "rigs.txt:2, `SENSOR_ID`: expected a whole number, found `x`"),
    ] {
        std::fs::write(folder.path().join("rigs.txt"), text.replacen(from, to, 1)).unwrap();
        let (rigs, notes) = rigs();
        assert!(rigs.is_empty() && notes.len() == 1 && notes[0].contains(why), "{notes:?}");
        assert!(notes[0].ends_with("whether cameras are a rig is not known"), "{notes:?}");
    }
    // The same in bytes, which come before text.
    let mut bytes = 2_u64.to_le_bytes().to_vec();
    let words = |bytes: &mut Vec<u8>, words: &[u32]| words.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
    words(&mut bytes, &[1, 3, 0, 9, 1, 1]);
    bytes.push(1);
    bytes.extend([0; 56]);
    words(&mut bytes, &[0, 4]);
    bytes.push(0);
    words(&mut bytes, &[2, 1, 0, 5]);
    std::fs::write(folder.path().join("rigs.bin"), &bytes).unwrap();
    assert_eq!(rigs(), (vec![vec![1, 2]], Vec::new()));
    std::fs::write(folder.path().join("rigs.bin"), &bytes[..bytes.len() - 1]).unwrap();
    assert!(rigs().1[0].contains("rigs.bin, `rig 2 of 2`: the file of"), "{:?}", rigs().1);
}
