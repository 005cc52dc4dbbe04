//! What `[free_network]` and `[rig]` read.

use std::borrow::Cow;

use calibench_measure::Registry;
use calibench_model::Pose;
use nalgebra::{Point3, Vector3};

use super::{Bar, Kind, Networks};
use crate::studies::StudyPlan;
use crate::{Study, Subject, ViewsSubject, parse};

const HEAD: &str = r#"why = "A board."
source = "ours"
seed = 3
[camera]
size = [1280, 960]
pitch = 5.0
c = 5.0
[testfield]
kind = "chessboard"
rows = 6
columns = 9
square = 25
[stations]
kind = "random"
count = 4
distance = [300, 500]
tilt = 35
each_trial = true
[pointing]
sigma = 0
whole_pixels = false
[[method]]
name = "pixel"
"#;
const FREE: &str =
    "[free_network]\nmodel = \"opencv5\"\nnoise_px = 0.1\nlengths = 3\n[[distance]]\nbetween = [\"r1c1\", \"r1c9\"]\nsigma = 0.02\n";
const RIG: &str = "[rig]\nmodel = \"opencv5\"\nnoise_px = 0.1\nsigma_px = 0.2\n[[mount]]\nname = \"left\"\n[[mount]]\nname = \"right\"\nat = [120, 0, 5]\nangles = [0, 10, 0]\n";

fn views(text: &str) -> Result<ViewsSubject, String> {
    let scenario = parse("s", "s.toml", text, &Registry::builtin()).map_err(|problems| problems.to_string())?;
    match scenario.subject {
        Subject::Views(views) => Ok(*views),
        _ => panic!("it has stations"),
    }
}

fn read(tables: &str) -> Result<Networks, String> {
    match views(&format!("{HEAD}{tables}"))?.study {
        Study::Networks(found) => Ok(*found),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_free_network_is_read_with_its_distances() {
    let found = read(FREE).unwrap();
    assert_eq!((found.model.as_str(), found.sigma_px, found.is_random()), ("opencv5", 0.1, true));
    assert_eq!(found.drawn, [("pixel".to_owned(), Some(0.1))]);
    let Kind::Free { distances, lengths, acceptance: None } = &found.kind else { panic!("{found:?}") };
    assert_eq!(distances[..], [Bar { between: [0, 8], sigma: 0.02 }]);
    // The first half of 54 targets with the second.
    assert_eq!(lengths[..], [[0, 27], [1, 28], [2, 29]]);
    let bare = read(FREE.split("lengths").next().unwrap()).unwrap();
    assert_eq!(bare.kind, Kind::Free { distances: Vec::new(), lengths: Vec::new(), acceptance: None });
}

#[test]
fn cameras_of_a_rig_are_where_their_mounts_have_them() {
    let subject = views(&format!("{HEAD}{RIG}")).unwrap();
    let Study::Networks(found) = &subject.study else { panic!("{:?}", subject.study) };
    assert_eq!((found.sigma_px, found.mounts().len()), (0.2, 2));
    let names: Vec<&str> = subject.stations.iter().map(|station| station.name.as_str()).collect();
    assert_eq!(names, ["left-s01", "left-s02", "left-s03", "left-s04", "right-s01", "right-s02", "right-s03", "right-s04"]);
    let pose = Pose { rotation: nalgebra::Matrix3::identity(), centre: Point3::new(1.0, 2.0, 3.0) };
    let station = calibench_synth::stations::Station::new("s".into(), pose);
    let cameras = found.cameras_at(Cow::Owned(vec![station]));
    assert_eq!(cameras[0].pose, pose);
    assert!((cameras[1].pose.centre - Point3::new(121.0, 2.0, 8.0)).norm() < 1e-12);
    // It looks 10 degrees aside: passive about y, the axis -z.
    let sight = -cameras[1].pose.rotation.row(2).transpose();
    let (sine, cosine) = 10.0_f64.to_radians().sin_cos();
    assert!((sight - Vector3::new(-sine, 0.0, -cosine)).norm() < 1e-12, "{sight}");
}

#[test]
fn what_is_wrong_with_the_tables_is_said() {
    for (text, old, new, message) in [
        (FREE, "opencv5", "opencv6", "`opencv6` is no camera model: expected one of photogrammetric,"),
        (FREE, "\"r1c9\"", "\"r1c99\"", "no target is called `r1c99`"),
        (FREE, "\"r1c1\", \"r1c9\"", "\"r1c1\"", "`between` is a list of 1: expected two targets"),
        (FREE, "sigma = 0.02", "sigma = 0", "0.000001"),
        (FREE, "[[distance]]\nbetween = [\"r1c1\", \"r1c9\"]\nsigma = 0.02\n", "", "`lengths` without a [[distance]]"),
        (RIG, "\"right\"", "\"left\"", "the mount `left` is listed twice"),
        (RIG, "\"right\"", "\"left-2\"", "`left-2` is no name of a mount"),
        (RIG, "[[mount]]\nname = \"right\"\nat = [120, 0, 5]\nangles = [0, 10, 0]\n", "", "[rig] with 1 [[mount]]: expected two at least"),
        (RIG, "noise_px = 0.1\n", "", "[rig] has no `noise_px`"),
    ] {
        assert!(text.contains(old), "{old}");
        let found = read(&text.replacen(old, new, 1)).unwrap_err();
        assert!(found.contains(message), "{message}: {found}");
    }
    let both = read(&format!("{FREE}{RIG}")).unwrap_err();
    assert!(both.contains("[rig] beside [free_network]: expected one of them"), "{both}");
    let alone = read("[[mount]]\nname = \"left\"\n").unwrap_err();
    assert!(alone.contains("[[mount]] without [rig]"), "{alone}");
}
