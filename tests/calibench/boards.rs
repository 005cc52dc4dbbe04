//! `--board`: boards with markers, circles, with an origin or without, or ring codes, from images to a camera.

use std::collections::BTreeMap;
use std::path::Path;

use crate::project::{root, run, stderr, stdout};

/// Scenarios of `targets/` and their boards in a word; how far an approximate point may be off, px, and what measures it, with its largest error.
const BOARDS: [(&str, &str, &str, f64); 7] = [
    ("charuco", "charuco:10x7:38:26.6:DICT_4X4_50", "parametric_corner:window=15", 0.1),
    ("aprilgrid", "aprilgrid:6x4:48:0.3", "parametric_corner:window=11", 0.2),
    ("gridboard", "gridboard:6x4:48:14.4:DICT_6X6_250", "parametric_junction:window=15,arms=2", 0.1),
    ("circles", "circles:10x7:38:20", "ellipse_edges", 0.1),
    ("rings", "rings:12:10x7:38:10", "ellipse_edges", 0.1),
    ("puzzle", "puzzle:19x13:20:100,200", "parametric_corner:window=11", 0.1),
    ("dotted", "dotted:15x9:25", "parametric_corner:window=15", 0.1),
];
const SHOTS: [&str; 8] = ["s01-r1", "s01-r2", "s02-r1", "s02-r2", "s03-r1", "s03-r2", "s04-r1", "s04-r2"];

fn rendered(kind: &str) -> (tempfile::TempDir, String, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let project = root().display().to_string();
    let output = run(folder.path(), &["--root", &project, "render", &format!("targets/{kind}"), "-o", "c", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    (folder, project, SHOTS.map(|shot| format!("c/{shot}.png")).to_vec())
}

fn with<'a>(first: &[&'a str], photos: &'a [String], more: &[&'a str]) -> Vec<&'a str> {
    first.iter().copied().chain(photos.iter().map(String::as_str)).chain(more.iter().copied()).collect()
}

/// Positions by image and target.
fn positions(path: &Path) -> BTreeMap<(String, String), [f64; 2]> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let headers = reader.headers().unwrap().clone();
    let [image, target, x, y] =
        ["image", "target", "x", "y"].map(|name| headers.iter().position(|header| header == name).unwrap_or_else(|| panic!("{name}")));
    let number = |text: &str| text.parse().unwrap_or(f64::NAN);
    let row = |record: csv::StringRecord| ((record[image].to_owned(), record[target].to_owned()), [number(&record[x]), number(&record[y])]);
    reader.records().map(|record| row(record.unwrap())).collect()
}

fn truth(folder: &Path) -> BTreeMap<(String, String), [f64; 2]> {
    SHOTS.iter().flat_map(|shot| positions(&folder.join(format!("c/{shot}.csv")))).collect()
}

fn farthest(found: &BTreeMap<(String, String), [f64; 2]>, truth: &BTreeMap<(String, String), [f64; 2]>) -> f64 {
    found.iter().map(|(key, at)| (at[0] - truth[key][0]).hypot(at[1] - truth[key][1])).fold(0.0, f64::max)
}

/// What every kind of board must hold: found whole and by name, measured, its control that of the scenario, the camera found again.
#[test]
fn every_board_is_found_measured_and_calibrated_from() {
    for (kind, board, method, error) in BOARDS {
        let (folder, project, photos) = rendered(kind);
        let at = |name: &str| folder.path().join(name);
        let good = |arguments: &[&str]| {
            let output = run(folder.path(), arguments);
            assert!(output.status.success(), "{kind}: {arguments:?}\n{}", stderr(&output));
            output
        };
        good(&with(&["detect"], &photos, &["--board", board, "-o", "approx.csv", "-q"]));
        let (truth, mut found) = (truth(folder.path()), positions(&at("approx.csv")));
        assert_eq!(found.len(), truth.len(), "{kind}: all points of all images");
        if kind == "circles" {
            turned(&mut found, &truth);
        }
        assert!(farthest(&found, &truth) < 1.0, "{kind}: {}", farthest(&found, &truth));
        good(&with(&["measure"], &photos, &["--points", "approx.csv", "-m", method, "-o", "measured.csv", "-q"]));
        let mut measured = positions(&at("measured.csv"));
        measured.retain(|_, at| at[0].is_finite());
        assert!(measured.len() * 50 > truth.len() * 49, "{kind}: {} of {}", measured.len(), truth.len());
        if kind == "circles" {
            turned(&mut measured, &truth);
        }
        if kind != "rings" && kind != "circles" {
            assert!(farthest(&measured, &truth) < error, "{kind}: {}", farthest(&measured, &truth));
        }
        good(&["control", board, "-o", "control.csv"]);
        let same = |name: &str| std::fs::read_to_string(at(name)).unwrap().lines().skip(1).map(numbers).collect::<BTreeMap<_, _>>();
        assert_eq!(same("control.csv"), same("c/control.csv"), "{kind}");
        let output = run(folder.path(), &with(&["calibrate"], &photos, &["--board", board, "-m", method, "-o", "camera.json", "-q"]));
        assert!(matches!(output.status.code(), Some(0 | 3)), "{kind}: {}", stderr(&output));
        let apart = good(&["--root", &project, "diff", "camera.json", "c/camera.toml", "--radius", "350"]);
        let apart = stdout(&apart);
        let rms = apart.split_whitespace().nth(1).and_then(|number| number.parse::<f64>().ok());
        assert!(rms.is_some_and(|rms| rms < 0.02), "{kind}: {apart}");
    }
}

/// A grid of circles looks the same upside down: of each image the numbering that agrees with the truth.
fn turned(found: &mut BTreeMap<(String, String), [f64; 2]>, truth: &BTreeMap<(String, String), [f64; 2]>) {
    for shot in SHOTS {
        let key = |row: usize, column: usize| (format!("{shot}.png"), format!("r{row}c{column}"));
        let first = found[&key(1, 1)];
        let true_first = truth[&key(1, 1)];
        if (first[0] - true_first[0]).hypot(first[1] - true_first[1]) < 2.0 {
            continue;
        }
        let places = (1..=7).flat_map(|row| (1..=10).map(move |column| (row, column)));
        let other: Vec<_> = places.filter_map(|(row, column)| Some((key(row, column), *found.get(&key(8 - row, 11 - column))?))).collect();
        found.extend(other);
    }
}

/// An origin among circles: dark or light they are found by name however they are turned, printed, measured, calibrated from and judged. Described without it
/// the grid is found, too, in doubt, and the words for it are said.
#[test]
fn circles_with_an_origin_are_a_board_like_the_others() {
    let word = "circles:10x7:38:20:30@r7c1";
    let text = std::fs::read_to_string(root().join("scenarios/targets/circles.toml")).unwrap();
    for light in [false, true] {
        let folder = tempfile::tempdir().unwrap();
        let levels = if light { "\npaper = 0.05\nink = 0.85" } else { "" };
        // OpenCV's finder knows no circles that are unlike the others.
        let marked = text
            .replace("[[method]]\nname = \"opencv_find_circles\"\n", "")
            .replace("diameter = 20\n", &format!("diameter = 20\nmarks = [\"30@r7c1\"]{levels}\n"));
        assert!(marked.contains("marks"));
        std::fs::write(folder.path().join("marked.toml"), marked.replace("rolls = [0, 90]", "rolls = [180, 250]")).unwrap();
        let asked = |arguments: &[&str], codes: &[i32]| {
            let output = run(folder.path(), arguments);
            assert!(output.status.code().is_some_and(|code| codes.contains(&code)), "{arguments:?}: {}", stderr(&output));
            output
        };
        asked(&["render", "marked.toml", "-o", "c", "-q"], &[0]);
        let photos = SHOTS.map(|shot| format!("c/{shot}.png")).to_vec();
        let found = asked(&with(&["detect"], &photos, &["--board", word, "-o", "approx.csv"]), &[0]);
        assert_eq!(stderr(&found).contains("light on dark in 8"), light, "{}", stderr(&found));
        let (truth, found) = (truth(folder.path()), positions(&folder.path().join("approx.csv")));
        assert_eq!(found.len(), truth.len());
        assert!(farthest(&found, &truth) < 1.0, "{}", farthest(&found, &truth));
        asked(&with(&["calibrate"], &photos, &["--board", word, "-o", "camera.json", "-q"]), &[0, 3]);
        let apart = stdout(&asked(&["diff", "camera.json", "c/camera.toml", "--radius", "350"], &[0]));
        let rms = apart.split_whitespace().nth(1).and_then(|number| number.parse::<f64>().ok());
        assert!(rms.is_some_and(|rms| rms < 0.02), "{apart}");
        let plain = asked(&with(&["detect"], &photos, &["--board", "circles:10x7:38:20", "-o", "plain.csv", "-q"]), &[3]);
        assert!(stderr(&plain).contains("circles:10x7:38:20:30@r"), "{}", stderr(&plain));
        if light {
            continue;
        }
        asked(&["control", word, "-o", "control.csv"], &[0]);
        assert_eq!(std::fs::read_to_string(folder.path().join("control.csv")).unwrap().lines().count(), 71);
        let printed = asked(&["print", "marked.toml", "-o", "sheet"], &[0]);
        assert!(stderr(&printed).contains("no target.yaml for Kalibr"), "{}", stderr(&printed));
        let judged = with(
            &["judge"],
            &photos,
            &["--board", word, "-m", "ellipse_edges", "-m", "centroid", "--model", "opencv4", "--splits", "2", "-q"],
        );
        assert!(stdout(&asked(&judged, &[0, 3])).contains("ellipse_edges"));
    }
}

/// A line of a control file: name and coordinates, those that are zero without a sign.
fn numbers(line: &str) -> (String, Vec<String>) {
    let mut cells = line.split(',');
    let name = cells.next().unwrap().to_owned();
    (name, cells.take(3).map(|cell| format!("{:.9}", cell.parse::<f64>().unwrap() + 0.0)).collect())
}

#[test]
fn what_is_no_such_board_is_refused_by_name() {
    let (folder, _, photos) = rendered("charuco");
    for (board, said) in [
        ("charuco:10x7:38:26.6:DICT_5X5_50", "DICT_4X4"),
        ("charuco:7x10:38:26.6:DICT_4X4_50", "another board"),
        ("charuco:10x7:38:20:DICT_4X4_50", "another board"),
        ("charuco:10x7:38:26.6:DICT_4X4_100:50", "markers"),
        ("aprilgrid:6x4:48:0.3", "35 markers of DICT_4X4_50 are seen"),
        ("gridboard:6x4:48:14.4:DICT_4X4_50", "another board"),
        ("rings:12:10x7:38:10", "round areas"),
        ("puzzle:19x13:20:100,200", "another pattern"),
        ("dotted:9x6:38", "nowhere three as the board has them"),
    ] {
        let output = run(folder.path(), &with(&["detect"], &photos[..2], &["--board", board, "-o", "no.csv", "-q"]));
        assert_eq!(output.status.code(), Some(2), "{board}: {}", stderr(&output));
        let text = stderr(&output);
        assert!(text.contains(&format!("{}: ", photos[0])) && text.contains(said), "{board}: {text}");
        assert!(!folder.path().join("no.csv").exists(), "{board}");
    }
    for (word, said) in [
        ("charuco:10x7", "no side of a square; expected charuco:COLUMNSxROWS"),
        ("chaurco:10x7:38:26.6:DICT_4X4_50", "is no kind of board"),
        ("missing.yaml", "missing.yaml"),
    ] {
        let output = run(folder.path(), &["control", word]);
        assert!(output.status.code() == Some(2) && stderr(&output).contains(said), "{word}: {}", stderr(&output));
    }
}

#[test]
fn kalibrs_target_file_is_a_board() {
    let folder = tempfile::tempdir().unwrap();
    let text = "target_type: 'aprilgrid'\ntagCols: 6\ntagRows: 4\ntagSize: 48\ntagSpacing: 0.3\n";
    std::fs::write(folder.path().join("target.yaml"), text).unwrap();
    let [file, word] = ["target.yaml", "aprilgrid:6x4:48:0.3"].map(|board| stdout(&run(folder.path(), &["control", board])));
    assert!(file == word && file.lines().count() == 97, "{file}");
    std::fs::write(folder.path().join("target.yaml"), text.replace("tagSize: 48", "tagSize: -1")).unwrap();
    let output = run(folder.path(), &["control", "target.yaml"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("`tag` is -1"), "{}", stderr(&output));
}

/// What is printed goes to Kalibr with its own description, in metres, which is also read here: the same points, a thousandth.
#[test]
fn a_printed_board_comes_with_its_target_file() {
    for (kind, named) in [
        ("chessboard", true),
        ("aprilgrid", true),
        ("circles", true),
        ("charuco", false),
        ("gridboard", false),
        ("rings", false),
        ("puzzle", false),
        ("dotted", false),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let project = root().display().to_string();
        let print = || run(folder.path(), &["--root", &project, "print", &format!("targets/{kind}"), "-o", "sheet"]);
        let output = print();
        assert!(output.status.success(), "{kind}: {}", stderr(&output));
        assert!(print().status.success(), "{kind}: a folder of ours is replaced");
        let written = folder.path().join("sheet/target.yaml");
        assert_eq!(written.exists(), named, "{kind}");
        assert_eq!(stderr(&output).contains("no target.yaml for Kalibr"), !named, "{kind}: {}", stderr(&output));
        if !named {
            continue;
        }
        let of = |board: &str| {
            let output = run(folder.path(), &["control", board]);
            assert!(output.status.success(), "{kind}: {}", stderr(&output));
            stdout(&output).lines().skip(1).map(numbers).collect::<Vec<_>>()
        };
        let (read, known) = (of("sheet/target.yaml"), of(in_a_word(kind)));
        assert_eq!(read.len(), known.len(), "{kind}");
        for ((name, at), (other, there)) in read.iter().zip(&known) {
            assert_eq!(name, other, "{kind}");
            let number = |text: &String| text.parse::<f64>().unwrap();
            let same = |(metres, mm)| (1e3 * number(metres) - number(mm)).abs() < 1e-6;
            assert!(at.iter().zip(there).all(same), "{kind} {name}: {at:?} m, {there:?} mm");
        }
    }
}

fn in_a_word(kind: &str) -> &'static str {
    BOARDS.iter().find(|(name, ..)| *name == kind).map_or("chessboard:9x6:38", |(_, word, ..)| word)
}

#[test]
fn boards_are_judged() {
    let (folder, _, photos) = rendered("aprilgrid");
    let arguments = with(
        &["judge"],
        &photos,
        &[
            "--board",
            "aprilgrid:6x4:48:0.3",
            "-m",
            "parametric_corner",
            "-m",
            "pixel",
            "--model",
            "opencv4",
            "--splits",
            "2",
            "--report",
            "page",
            "-q",
        ],
    );
    let output = run(folder.path(), &arguments);
    assert!(matches!(output.status.code(), Some(0 | 3)), "{}", stderr(&output));
    assert!(stdout(&output).contains("parametric_corner"), "{}", stdout(&output));
    let page = std::fs::read_to_string(folder.path().join("page/README.md")).unwrap();
    assert!(page.contains("`aprilgrid:6x4:48:0.3`"), "{page}");
}

/// A small sweep over two boards, from its records to the page: what is found, how well, and what the camera is worth.
#[test]
fn boards_are_compared_on_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(root().join("scenarios/targets/by-noise.toml")).unwrap();
    let mut small =
        text.replace("    \"charuco:10x7:38:26.6:DICT_4X4_50\",\n    \"aprilgrid:6x4:48:0.3\",\n    \"circles:10x7:38:20\",\n", "");
    for (from, to) in [
        ("[0.003, 0.01, 0.03, 0.1]", "[0.003, 0.03]"),
        ("trials = 4", "trials = 2"),
        ("size = [1280, 960]\npitch = 5.0", "size = [640, 480]\npitch = 10.0"),
        ("count = 12", "count = 5"),
        ("bound_window_discs = 81", "bound_window_discs = 41"),
    ] {
        assert!(small.contains(from), "{from}");
        small = small.replace(from, to);
    }
    std::fs::create_dir_all(folder.path().join("scenarios/targets")).unwrap();
    std::fs::create_dir_all(folder.path().join("reference")).unwrap();
    std::fs::write(folder.path().join("scenarios/targets/by-noise.toml"), small).unwrap();
    let project = folder.path().display().to_string();
    for command in [["run", "targets/by-noise"], ["report", "targets"]] {
        let output = run(folder.path(), &[&["--root", &project][..], &command[..], &["-q"][..]].concat());
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let page = std::fs::read_to_string(folder.path().join("reports/targets/which-target.md")).unwrap();
    let row = |noise: &str, board: &str| -> Vec<String> {
        let cells = |line: &str| line.split('|').map(|cell| cell.trim().trim_matches('`').to_owned()).collect::<Vec<_>>();
        page.lines()
            .map(cells)
            .find(|cells| cells.len() == 13 && cells[1] == noise && cells[2] == board)
            .unwrap_or_else(|| panic!("{page}"))
    };
    for board in ["chessboard", "rings"] {
        let camera = |noise: &str| row(noise, board)[8].split(' ').next().unwrap().parse::<f64>().unwrap();
        assert!(camera("0.03") > 2.0 * camera("0.003"), "{page}");
        let predicted = |noise: &str| row(noise, board)[9].parse::<f64>().unwrap();
        assert!((predicted("0.03") / predicted("0.003") - 10.0).abs() < 5.0, "{page}");
    }
    let found = row("0.003", "chessboard");
    assert_eq!((found[3].as_str(), found[4].as_str(), found[5].as_str()), ("parametric_corner:window=15", "100.0", "0"));
    assert!((0.8..1.3).contains(&found[7].parse::<f64>().unwrap()), "{page}");
    let index = std::fs::read_to_string(folder.path().join("reports/targets/README.md")).unwrap();
    assert!(index.contains("(which-target.md)") && folder.path().join("reports/targets/by-noise.png").is_file());
}
