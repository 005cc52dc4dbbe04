use calibench_diagnostics::Problems;
use calibench_model::camera::{ImageSize, Photogrammetric};
use calibench_synth::optics::{Motion, Optics};
use calibench_synth::sensor::{Gradient, Per};
use calibench_synth::testfield::{Chessboard, Levels};

use super::*;
use toml::de::DeTable;

const KEY: Key<'_> = Key { seed: 1, of: "test", trial: 0, view: "", target: "" };

fn field() -> Testfield {
    let levels = Levels::default();
    let board = Chessboard { rows: 6, columns: 9, square: 30.0, margin: 15.0, bend: None, print_noise: 0.0, levels, background: 0.5 };
    board.generate(KEY).unwrap()
}

fn camera() -> Camera {
    let size = ImageSize { width: 1000, height: 800 };
    Photogrammetric { size, pitch_um: 5.0, c: 8.0, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] }.into()
}

/// The stations of a text, or its problems as `line:column: message (help)`.
fn stations(text: &str) -> Result<Vec<Station>, String> {
    stations_before(&field(), text)
}

fn stations_before(field: &Testfield, text: &str) -> Result<Vec<Station>, String> {
    let (root, errors) = DeTable::parse_recoverable(text);
    assert!(errors.is_empty(), "{errors:?}");
    let mut root = Section { name: "the scenario", span: 0..1, table: root.into_inner() };
    let mut problems = Vec::new();
    let given = root.take_tables("station", "[[station]]", &mut problems).unwrap_or_default();
    let section = root.take_table("stations", "[stations]", &mut problems);
    let plan = read(section, given, &mut problems);
    assert_eq!(plan.is_some(), problems.is_empty());
    let made = plan.map(|plan| plan.generate(field, &camera(), KEY).map_err(|error| problems.push(plan.problem(&error))));
    made.and_then(Result::ok).ok_or_else(|| Problems { file: "f".into(), text: text.into(), problems }.to_string())
}

fn refused(text: &str, message: &str) {
    let found = stations(text).unwrap_err();
    assert!(found.contains(message), "{text}\n{found}\nexpected {message}");
}

#[test]
fn every_kind_is_read() {
    let count = |text: &str| stations(text).unwrap().len();
    let ring = "[stations]\nkind = \"convergent\"\ncount = 4\nangle = 30\ndistances = [800, 900]\nrolls = [0, 90, 180, 270]\nsees = 0.9";
    assert_eq!(count(ring), 16);
    assert_eq!(count("[stations]\nkind = \"arc\"\ncount = 3\nconvergence = 60\ndistances = [800]\nheights = [0, 50]"), 3);
    assert_eq!(count("[stations]\nkind = \"board\"\ntilts = [[0, 0], [30, -20]]\ndistances = [800, 1000]"), 4);
    assert_eq!(count("[stations]\nkind = \"stand\"\nphis = [0, 30, 45]\nturns = [0, 90]\nrolls = [0, 90]\ndistance = 800"), 10);
    assert_eq!(count("[stations]\nkind = \"random\"\ncount = 25\ndistance = [700, 1200]\ntilt = 40\nroll = 180\naside = [50, 50]"), 25);
}

#[test]
fn given_stations_stand_as_they_are_given_and_come_first() {
    let text = r#"[[station]]
name = "above"
at = [120, -75, 800]
angles = [0, 0, 90]
[[station]]
name = "aside"
at = [400, -75, 700]
towards = [120, -75, 0]
roll = 90
[stations]
kind = "board"
tilts = [[0, 0]]
distances = [800]
middle = [130, -75, 0]
"#;
    let stations = stations(text).unwrap();
    let names: Vec<&str> = stations.iter().map(|station| station.name.as_str()).collect();
    assert_eq!(names, ["above", "aside", "s01"]);
    let angles = stations[0].pose.angles();
    assert!(angles[0].abs() < 1e-15 && angles[1].abs() < 1e-15 && (angles[2] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    let towards = stations[1].pose.camera_from_world(&Point3::new(120.0, -75.0, 0.0));
    assert!(towards.x.abs() < 1e-9 && towards.y.abs() < 1e-9 && towards.z < 0.0);
    // A quarter turn: the field's upwards direction is the image's x.
    let up = stations[1].pose.rotation * Vector3::y();
    assert!((up.x - 1.0).abs() < 1e-12);
    assert!((stations[2].pose.centre - Point3::new(130.0, -75.0, 800.0)).norm() < 1e-9);
}

#[test]
fn mistakes_are_told_with_their_places() {
    let board = "[stations]\nkind = \"board\"\n";
    refused("[stations]\ncount = 3", "1:2: [stations] has no `kind`");
    refused("[stations]\nkind = \"bord\"", "2:8: `kind` of [stations] is one of convergent, arc, board, random, stand; found `bord`");
    refused(&format!("{board}distances = [800]"), "[stations] has no `tilts`");
    refused(&format!("{board}tilts = [[0, 0]]\ndistances = []"), "4:13: `distances` is empty");
    refused(&format!("{board}tilts = [[0, 89]]\ndistances = [800]"), "3:9: `tilts` is 89: expected -85 to 85 degrees");
    refused(&format!("{board}tilts = [[0]]\ndistances = [800]"), "expected 2 numbers in brackets, found 1");
    refused(&format!("{board}tilts = [[0, 0]]\ndistances = [800]\nsees = 2"), "5:8: expected a number from 0 to 1");
    refused(&format!("{board}tilts = [[0, 0]]\ndistances = [800]\nup = [0, 0, 1]"), "its pose is not determined");
    refused(&format!("{board}tilts = [[0, 0]]\ndistances = [100]\nsees = 1"), "1:2: station `s01` does not see the field");
    let random = "[stations]\nkind = \"random\"\ncount = 2\n";
    refused(&format!("{random}distance = [9, 5]\ntilt = 10"), "4:12: `distance` is 5: expected at least the first, 9");
    refused(&format!("{random}distance = [5, 9]\ntilt = 10"), "none of 1000 random poses within the bounds sees enough of the field");
}

#[test]
fn a_stand_says_its_bend_in_degrees_and_object_units() {
    let text = "[stations]\nkind = \"stand\"\nphis = [30]\nturns = [90]\ndistance = 800\nbend = 0.8\nbend_reach = 100\nbend_across = 30";
    let station = stations(text).unwrap().remove(0);
    let bend = station.bend.unwrap();
    assert_eq!((station.name.as_str(), bend.peak, bend.reach, bend.middle), ("1111", 0.8, 100.0, [120.0, -75.0]));
    assert!((bend.across + 60_f64.to_radians()).abs() < 1e-12, "{bend:?}");
    assert!((station.pose.centre - Point3::new(120.0, -75.0, 0.0)).norm() - 800.0 < 1e-9);
    assert_eq!(stations(&text.replace("0.8\n", "0\n")).unwrap()[0].bend, None, "none at all, for sweeps");
}

#[test]
fn mistakes_of_a_stand_are_told_with_their_places() {
    let stand = "[stations]\nkind = \"stand\"\nphis = [0, 30]\ndistance = 800\n";
    refused("[stations]\nkind = \"stand\"\nphis = [0]", "[stations] has no `distance`");
    refused(&stand.replace("[0, 30]", "[0, 86]"), "3:8: `phis` is 86: expected -85 to 85 degrees");
    refused(&stand.replace("[0, 30]", "[]"), "3:8: `phis` is empty");
    refused(&format!("{stand}turns = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]"), "5:9: `turns` has 10 values: expected at most 9");
    refused(&format!("{stand}bend = 1"), "5:8: `bend` without `bend_reach`: expected both or none");
    refused(&format!("{stand}bend_reach = 1"), "5:14: `bend_reach` without `bend`");
    refused(&format!("{stand}bend_across = 1"), "5:15: `bend_across` without `bend`");
    refused(&format!("{stand}bend = 100\nbend_reach = 100"), "5:8: `bend` is 100: expected at most");
    refused(&format!("{stand}facing = [0, 0, 1]"), "5:10: `facing` with `kind = \"stand\"`");
    let before = |field: &Testfield, text: &str| stations_before(field, text).unwrap_err();
    let (mut two, mut bent) = (field(), field());
    two.plates.push(two.plates[0].clone());
    bent.plates[0].bend = Some(calibench_model::Bend { peak: 1.0, middle: [0.0, 0.0], across: 0.0, reach: 100.0, along: 0.0 });
    assert!(
        before(&two, &format!("{stand}bend = 1\nbend_reach = 100")).contains("5:8: a stand bends a testfield of one sheet: this one has 2")
    );
    let found = before(&bent, &format!("{stand}bend = 1\nbend_reach = 100"));
    assert!(found.contains("5:8: the stand bends plate `board`, which is bent itself"), "{found}");
    refused(&format!("{stand}each_trial = true"), "`each_trial` without `kind = \"random\"`");
}

#[test]
fn mistakes_of_given_stations_are_told_by_name() {
    let station = "[[station]]\nname = \"a\"\nat = [120, -75, 800]\n";
    refused(station, "2:8: station `a` does not say how it is turned (give `angles` or `towards`)");
    refused(&format!("{station}angles = [0, 0, 0]\ntowards = [0, 0, 0]"), "2:8: station `a` has both");
    refused(&format!("{station}angles = [0, 0, 0]\nroll = 3"), "they belong to `towards`");
    refused(&format!("{station}towards = [120, -75, 800]"), "2:8: station `a` looks along the field's upwards direction, or stands");
    refused(&format!("{station}angles = [180, 0, 0]"), "2:8: station `a` does not see the field: 0 of 54 targets inside the frame");
    refused(&format!("{station}angles = [0, 0, 0]\n{station}angles = [0, 0, 0]"), "6:8: station `a` stands here a second time");
    refused("[[station]]\nname = \" \"\nat = [1, 2, 3]\nangles = [0, 0, 0]", "2:8: station ` ` has a name that cannot be read");
}

const ABOVE: &str = "[[station]]\nname = \"a\"\nat = [120, -75, 800]\nangles = [0, 0, 0.12345678901234567]\n";

#[test]
fn a_station_has_what_it_says_of_its_own_and_its_angles_to_the_last_digit() {
    let own = "blur = 0.9\nmotion = [0, 2]\nexposure = 1.1\nveil = -0.03\ngradient_across = [0.1, -0.2]";
    let stations = stations(&format!("{ABOVE}{own}\n{}", ABOVE.replacen("\"a\"", "\"b\"", 1))).unwrap();
    let motion = Motion { length: 2.0, direction: std::f64::consts::FRAC_PI_2 };
    let gradient = Gradient { x: 0.1, y: -0.2, per: Per::Frame };
    let expected = Own { blur: Some(0.9), motion: Some(motion), exposure: Some(1.1), veil: Some(-0.03), gradient: Some(gradient) };
    assert_eq!([stations[0].own, stations[1].own], [expected, Own::default()]);
    assert_eq!(stations[0].pose, stations[1].pose);
    assert!((stations[0].pose.angles()[2].to_degrees() - 0.123_456_789_012_345_67).abs() < 1e-15);
    refused(&format!("{ABOVE}veil = -0.6"), "expected a number from -0.5 to 1, found -0.6");
    refused(&format!("{ABOVE}exposure = 0"), "expected a number from 0.000001 to 1000000, found 0");
    refused(&format!("{ABOVE}gradient_across = [0.1]"), "expected 2 numbers in a list, found 1");
}

#[test]
fn what_a_station_says_of_its_own_must_go_with_lens_and_sensor() {
    let text = format!("{ABOVE}motion = [3, 0]\n");
    let root = DeTable::parse(&text).unwrap().into_inner();
    let mut root = Section { name: "the scenario", span: 0..1, table: root };
    let mut problems = Vec::new();
    let given = root.take_tables("station", "[[station]]", &mut problems).unwrap_or_default();
    let plan = read(None, given, &mut problems).unwrap();
    plan.check_imaging(&Imaging { optics: Optics { blur: 0.5, ..Optics::default() }, sensor: None }, &mut problems);
    assert!(problems.is_empty(), "{problems:?}");
    plan.check_imaging(&Imaging::default(), &mut problems);
    let told = Problems { file: "f".into(), text: text.clone(), problems }.to_string();
    assert!(told.contains("2:8: station `a`: a motion needs a Gaussian blur of at least 0.1 px"), "{told}");
}
