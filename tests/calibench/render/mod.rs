//! Images and their truth as a user gets them from `calibench render`.

mod projection;
mod refused;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use calibench_cameras::read_camera;
use calibench_scenario::Subject;
use calibench_scenario::catalogue::Catalogue;

use crate::project::{copy_with, files, program, root, run, stderr};
use projection::table;

/// A board of 4 x 5 squares from one station, with noise.
pub(crate) const BOARD: &str = r#"why = "To see what is written."
source = "a test"
seed = 3
[camera]
size = [320, 240]
pitch = 10.0
c = 3.2
k1 = -0.01
[testfield]
kind = "chessboard"
unit = "mm"
rows = 4
columns = 5
square = 25
[[station]]
name = "front"
at = [50, -40, 300]
towards = [50, -40, 0]
[optics]
blur = 0.6
[sensor]
full_well = 12000
read_noise = 12
adc_bits = 8
[pointing]
sigma = 0.7
whole_pixels = true
[[method]]
name = "pixel"
"#;

/// Renders into `folder` of `project`.
fn render(project: &Path, scenario: &str, folder: &str, more: &[&str]) -> PathBuf {
    let output = run(project, &[&["render", scenario, "-o", folder, "-q"], more].concat());
    assert!(output.status.success(), "{scenario} {more:?}: {}", stderr(&output));
    project.join(folder)
}

/// A project with [`BOARD`], in which `old` stands as `new`, as `mine.toml`.
pub(crate) fn with_board(old: &str, new: &str) -> tempfile::TempDir {
    let project = copy_with(&["testfields"]);
    assert!(BOARD.contains(old), "{old}");
    std::fs::write(project.path().join("mine.toml"), BOARD.replacen(old, new, 1)).unwrap();
    project
}

#[test]
fn every_station_has_its_image_and_truth_beside_the_camera_and_the_control() {
    let project = copy_with(&["testfields"]);
    let folder = render(project.path(), "testfields/wall", "out", &["--noise-free"]);
    let mut names: Vec<String> = files(&folder).iter().map(|(path, _)| path.display().to_string()).collect();
    names.retain(|name| !name.starts_with('.'));
    let mut expected: Vec<String> = ["camera.toml", "control.csv", "rendered.csv", "starts.csv", "stations.csv"].map(str::to_owned).into();
    for station in (1..=4).flat_map(|i| [format!("s0{i}-r1"), format!("s0{i}-r2")]) {
        expected.extend([".csv", ".png", "-noise-free.png"].map(|end| format!("{station}{end}")));
    }
    expected.sort();
    assert_eq!(names, expected);
    let image = image::open(folder.join("s01-r1.png")).unwrap();
    let bare = image::open(folder.join("s01-r1-noise-free.png")).unwrap();
    assert_eq!((image.width(), image.height(), image.color()), (1600, 1200, image::ColorType::L8));
    assert_eq!((bare.width(), bare.height(), bare.color()), (1600, 1200, image::ColorType::L16));
}

/// From the starts that the scenario's hand gives, and from the truth itself, with what each method must know of its targets.
#[test]
fn what_is_rendered_is_measured_from_its_starts_and_from_its_truth() {
    let project = with_board("", "");
    let folder = render(project.path(), "mine.toml", "out", &[]);
    let truth: BTreeMap<String, [f64; 2]> = table(&folder.join("front.csv"))
        .into_iter()
        .map(|row| (row["target"].clone(), ["x", "y"].map(|axis| row[axis].parse().unwrap())))
        .collect();
    for (points, method) in
        [("starts.csv", "parametric_corner"), ("starts.csv", "lsm"), ("front.csv", "lsm"), ("front.csv", "forstner:significance=0")]
    {
        let output = run(&folder, &["measure", "front.png", "--points", points, "-m", method, "-o", "measured.csv"]);
        assert!(output.status.success(), "{points}, {method}: {}", stderr(&output));
        let rows = table(&folder.join("measured.csv"));
        let off = rows.iter().filter(|row| row["status"] == "measured").map(|row| {
            let [x, y] = ["x", "y"].map(|axis| row[axis].parse::<f64>().unwrap());
            (x - truth[&row["target"]][0]).hypot(y - truth[&row["target"]][1])
        });
        let off: Vec<f64> = off.collect();
        assert!(off.len() + 2 >= rows.len() && rows.len() > 10, "{points}, {method}: {} of {}", off.len(), rows.len());
        assert!(off.iter().all(|off| *off < 0.5), "{points}, {method}: {off:?}");
    }
    // Starts are a hand's, and maps are those of an approximate orientation.
    let starts = table(&folder.join("starts.csv"));
    let far = starts.iter().filter(|row| (row["x"].parse::<f64>().unwrap() - truth[&row["target"]][0]).abs() > 0.05).count();
    assert!(2 * far > starts.len(), "{far} of {}", starts.len());
}

#[test]
fn without_a_sensor_the_image_is_the_noise_free_one() {
    let project = with_board("[sensor]\nfull_well = 12000\nread_noise = 12\nadc_bits = 8\n", "");
    let folder = render(project.path(), "mine.toml", "out", &["--noise-free"]);
    let [image, bare] = ["front.png", "front-noise-free.png"].map(|name| std::fs::read(folder.join(name)).unwrap());
    assert!(image == bare);
}

#[test]
fn the_noise_is_what_lies_between_the_image_and_the_noise_free_one() {
    // 12000 e at full scale, 12 e of read noise and 8 bit: the shot noise of each grey value, and its share of the rest.
    let project = with_board("", "");
    let folder = render(project.path(), "mine.toml", "out", &["--noise-free"]);
    let [image, bare] = ["front.png", "front-noise-free.png"].map(|name| image::open(folder.join(name)).unwrap().into_luma16());
    let (mut sum, mut squares, mut n) = (0.0, 0.0, 0.0);
    for (noisy, true_grey) in image.pixels().zip(bare.pixels()) {
        let (noisy, true_grey) = (f64::from(noisy.0[0]) / 65535.0, f64::from(true_grey.0[0]) / 65535.0);
        let variance = true_grey / 12000.0 + (12.0_f64 / 12000.0).powi(2) + (1.0_f64 / 255.0).powi(2) / 12.0;
        let deviation = (noisy - true_grey) / variance.sqrt();
        (sum, squares, n) = (sum + deviation, squares + deviation * deviation, n + 1.0);
    }
    // Five standard deviations of a mean and of a variance.
    let n: f64 = n;
    assert!((sum / n).abs() < 5.0 / n.sqrt(), "mean {}", sum / n);
    assert!((squares / n - 1.0).abs() < 5.0 * (2.0 / n).sqrt() + 0.005, "variance {}", squares / n);
}

#[test]
fn the_camera_file_holds_the_camera_of_the_scenario() {
    let project = copy_with(&["testfields"]);
    for name in ["testfields/chessboard", "testfields/wall"] {
        let folder = render(project.path(), name, "out", &[]);
        let read = read_camera(&folder.join("camera.toml")).unwrap();
        let scenario = Catalogue::new(root().join("scenarios")).load(name, &calibench_opencv::registry()).unwrap();
        let Subject::Views(subject) = &scenario.subject else { panic!("{name} pictures a testfield") };
        assert_eq!(read.cameras.len(), 1);
        assert_eq!(read.cameras[0].camera, subject.camera, "{name}");
    }
}

#[test]
fn the_same_bytes_on_one_thread_on_two_and_again() {
    let project = copy_with(&["testfields"]);
    for name in ["testfields/chessboard", "testfields/house"] {
        let one = files(&render(project.path(), name, "one", &["--threads", "1", "--noise-free"]));
        for threads in ["2", "2", "3"] {
            let other = files(&render(project.path(), name, "other", &["--threads", threads, "--noise-free"]));
            assert_eq!(one.len(), other.len());
            for ((path, bytes), (other_path, other_bytes)) in one.iter().zip(&other) {
                assert!(path == other_path && bytes == other_bytes, "{name} on {threads} threads: {}", path.display());
            }
        }
        let reseeded = files(&render(project.path(), name, "other", &["--seed", "4", "--noise-free"]));
        let differ = one.iter().zip(&reseeded).filter(|(a, b)| a != b).map(|(a, _)| a.0.display().to_string());
        // Another seed changes the noise, and so what is clipped, and nothing else.
        let unexpected: Vec<String> = differ.filter(|name| name.contains("noise-free") || name == "camera.toml").collect();
        assert_eq!(unexpected, [""; 0]);
    }
}

#[test]
fn what_is_rendered_is_what_a_run_measures_in() {
    let stations = "[stations]\nkind = \"random\"\ncount = 2\ndistance = [280, 320]\ntilt = 20\neach_trial = true\n";
    let given = "[[station]]\nname = \"front\"\nat = [50, -40, 300]\ntowards = [50, -40, 0]\n";
    for new in [given, stations] {
        let project = with_board(given, new);
        assert!(run(project.path(), &["run", "mine.toml", "-q", "--trials", "2"]).status.success());
        let folder = render(project.path(), "mine.toml", "out", &[]);
        let mut compared = 0;
        // Records keep what a page shows of it: its levels of 8 bits.
        let levels = |path: &Path| calibench_images::read_photo(path).unwrap().image.to_u8();
        let records = project.path().join("records/local/mine");
        for (path, _) in files(&records) {
            if path.extension().is_some_and(|end| end == "png") {
                assert!(levels(&folder.join(&path)) == levels(&records.join(&path)), "{}", path.display());
                compared += 1;
            }
        }
        assert!(compared > 0);
        // Another trial: other noise, and other stations only where each trial has its own.
        let next = render(project.path(), "mine.toml", "next", &["--trial", "1"]);
        let differs = |name: &str| std::fs::read(folder.join(name)).unwrap() != std::fs::read(next.join(name)).unwrap();
        let image = if new == given { "front.png" } else { "s01.png" };
        assert!(differs(image));
        let poses = |folder: &Path| -> Vec<String> {
            let text = std::fs::read_to_string(folder.join("stations.csv")).unwrap();
            text.lines().map(|line| line.split(',').take(7).collect::<Vec<_>>().join(",")).collect()
        };
        assert_eq!(poses(&folder) != poses(&next), new == stations);
    }
}

#[test]
fn one_station_has_the_image_that_it_has_among_all() {
    let project = copy_with(&["testfields"]);
    let all = files(&render(project.path(), "testfields/wall", "all", &[]));
    let one = files(&render(project.path(), "testfields/wall", "one", &["--station", "s03-r2"]));
    let image = |files: &[(PathBuf, Vec<u8>)]| files.iter().find(|(path, _)| path.ends_with("s03-r2.png")).unwrap().1.clone();
    assert!(image(&all) == image(&one));
    assert_eq!(one.iter().filter(|(path, _)| path.extension().is_some_and(|end| end == "png")).count(), 1);
}

#[test]
fn records_are_read_without_the_camera_file_that_they_were_made_with() {
    for file in ["own.toml", "../cameras/own.toml"] {
        let camera = format!("file = \"{file}\"\n");
        let project = with_board("size = [320, 240]\npitch = 10.0\nc = 3.2\nk1 = -0.01\n", &camera);
        let own = project.path().join("scenarios/own");
        std::fs::create_dir(&own).unwrap();
        std::fs::create_dir(project.path().join("scenarios/cameras")).unwrap();
        std::fs::rename(project.path().join("mine.toml"), own.join("mine.toml")).unwrap();
        let made = render(project.path(), "testfields/chessboard", "made", &[]).join("camera.toml");
        std::fs::copy(made, own.join(file)).unwrap();
        let output = run(project.path(), &["run", "own/mine", "-q"]);
        assert!(output.status.success(), "{}", stderr(&output));
        std::fs::remove_file(own.join(file)).unwrap();
        let output = run(project.path(), &["report", "own", "-q"]);
        assert!(output.status.success(), "{file}: {}", stderr(&output));
        assert!(project.path().join("reports/own/README.md").is_file());
    }
}

#[test]
fn a_render_that_fails_or_is_killed_leaves_the_old_folder() {
    let project = copy_with(&["testfields"]);
    let before = files(&render(project.path(), "testfields/house", "out", &[]));
    std::fs::write(project.path().join("fold.toml"), BOARD.replace("k1 = -0.01", "k1 = 0.5")).unwrap();
    let failed = run(project.path(), &["render", "fold.toml", "-o", "out"]);
    assert_eq!(failed.status.code(), Some(2));
    assert!(files(&project.path().join("out")) == before);
    std::fs::write(project.path().join("large.toml"), BOARD.replace("[320, 240]\npitch = 10.0", "[16000, 12000]\npitch = 0.2")).unwrap();
    let mut killed = 0;
    for milliseconds in [5, 50, 100, 200, 400] {
        let mut child = program(project.path()).args(["render", "large.toml", "-o", "out", "-q"]).spawn().unwrap();
        sleep(Duration::from_millis(milliseconds));
        killed += u32::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(files(&project.path().join("out")) == before, "killed after {milliseconds} ms");
    }
    assert!(killed > 0);
    assert!(files(&render(project.path(), "testfields/house", "out", &[])) == before);
    let left = std::fs::read_dir(project.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert_eq!(left.filter(|name| name.starts_with(".calibench-partial")).count(), 0, "nothing half written is left");
}
