//! anipose's tables, and what its followers write.

use calibench_model::camera::{Camera, OpenCv};
use calibench_model::named_camera::PoseFrame;

use super::{read, seed};

#[test]
fn a_table_is_a_camera() {
    let text = seed("anipose.toml");
    let file = read(&text).unwrap();
    assert_eq!(file.format.name, "anipose");
    let [first, second] = &file.cameras[..] else { panic!("{file:?}") };
    assert_eq!((first.name.as_str(), second.name.as_str(), second.pose_frame), ("A", "B", PoseFrame::World));
    assert!(matches!(first.camera, Camera::OpenCv(OpenCv { fy: 501.0, coefficients: 5, .. })));
    assert!(matches!(second.camera, Camera::OpenCvFisheye(_)));
    let t = second.pose.unwrap().t();
    assert!(t.iter().zip([-200.0, 3.0, 40.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{t:?}");
    assert!(first.pose.is_some());
    // Without poses these tools write zeros.
    let alone = text.split("[cam_1]").next().unwrap();
    assert_eq!(read(alone).unwrap().cameras[0].pose, None);
}

#[test]
fn caliscope_s_own_file_is_read() {
    let text = seed("anipose.toml")
        .replace("[cam_0]\nname = \"A\"", "[cameras.1]\ncam_id = 1\nrotation_count = 1")
        .replace("[cam_1]\nname = \"B\"", "[cameras.2]");
    let text = text
        .replace("rotation = [ 0.0, 0.0, 0.0,]", "rotation = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]")
        .replace("0.01, 0.002, 0.0, 0.0,", "[0.01], [0.002], [0.0], [0.0]");
    let file = read(&(text + "[cameras.3]\nsize = [640, 480]\n")).unwrap();
    assert_eq!(file.cameras.iter().map(|named| named.name.as_str()).collect::<Vec<_>>(), ["1", "2"]);
    let notes = &file.cameras[0].notes;
    assert!(
        notes.iter().any(|note| note.contains("`rotation_count`")) && notes.iter().any(|note| note.contains("`3` has no `matrix`")),
        "{notes:?}"
    );
}

#[test]
fn mistakes_have_a_place() {
    let text = seed("anipose.toml");
    for (from, to, expected) in [
        ("500.0, 0.0", "-500.0, 0.0", "f:4, `cam_0.matrix`: expected focal lengths above zero"),
        ("[ 500.0, 0.0, 320.0,]", "[ 500.0, 0.0,]", "f:4, `cam_0.matrix`: expected 3 x 3, found 3 x 2"),
        ("0.0, 0.0, 0.0, 0.0,]\nrot", "0.0, 0.0,]\nrot", "f:5, `cam_0.distortions`: expected 4, 5, 8, 12 or 14 coefficients, found 3"),
        ("fisheye = true", "fisheye = 3", "f:16, `cam_1.fisheye`: expected true or false"),
        ("fisheye = true", "lens_model = 3", "f:16, `cam_1.lens_model`: is no key that is known of a lens"),
        ("-200.0, 3.0,", "-200.0,", "f:15, `cam_1.translation`: expected 3 numbers, found 2"),
        ("[ 640, 480,]", "[ 640, 0,]", "f:3, `cam_0.size`: expected a whole number of pixels"),
        ("0.1, -0.4, 0.02,", "[1, 0, 0], [0, 2, 0], [0, 0, 1]", "f:14, `cam_1.rotation`: expected a rotation"),
        ("name = \"A\"", "name = ?", "f:2:8: "),
    ] {
        assert!(text.contains(from), "{from}");
        let error = read(&text.replacen(from, to, 1)).unwrap_err();
        assert!(error.starts_with(expected), "{to}: {error}");
    }
}
