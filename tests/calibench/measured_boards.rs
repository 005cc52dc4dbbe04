//! `--save-board`, `--board-file`, `--board-scale`: a board whose print is known to be wrong, in rendered photographs; and OpenCV's samples, where they are.

use std::path::Path;

use calibench_exchange::read_board_corners;
use serde_json::Value;

use crate::calibrate::write;
use crate::project::{data, root, run, stderr, stdout};

const BOARD: &str = "9x6:25";

/// 22 photographs of a board whose corners are printed with errors of 0.08 mm: the first twelve in `first/`, the rest in `later/`; the truth beside them.
fn photographs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(root().join("scenarios/testfields/chessboard.toml")).unwrap();
    let (before, stations) = text.split_once("[stations]").unwrap();
    let rest = stations.split_once("\n[").unwrap().1;
    let before: String = before.lines().filter(|line| !line.starts_with("bend")).map(|line| format!("{line}\n")).collect();
    let before = before.trim_end().replace("[testfield]", "[testfield]\nprint_noise = 0.08");
    let random = "kind = \"random\"\ncount = 22\ndistance = [200, 350]\ntilt = 35\nroll = 180\naside = [60, 40]\n";
    write(folder.path(), "printed.toml", &format!("{before}\n\n[stations]\n{random}\n[{rest}"));
    let output = run(folder.path(), &["render", "printed.toml", "-o", "all", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let mut images: Vec<_> = std::fs::read_dir(folder.path().join("all")).unwrap().map(|entry| entry.unwrap().path()).collect();
    images.retain(|path| path.extension().is_some_and(|ending| ending == "png"));
    images.sort();
    assert_eq!(images.len(), 22);
    for (k, path) in images.iter().enumerate() {
        let into = folder.path().join(if k < 12 { "first" } else { "later" });
        std::fs::create_dir_all(&into).unwrap();
        std::fs::rename(path, into.join(path.file_name().unwrap())).unwrap();
    }
    folder
}

fn calibrated(folder: &Path, arguments: &[&str]) -> Value {
    let output = run(folder, &[&["calibrate", "-q", "--json", "--board", BOARD], arguments].concat());
    serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{arguments:?}: {}", stderr(&output)))
}

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
    stderr(&output)
}

#[test]
fn a_board_is_measured_and_serves_later_photographs() {
    let folder = photographs();
    let found = calibrated(folder.path(), &["first", "--save-board", "board.csv", "--report", "measured"]);
    let board = &found["board"]["measured"];
    assert_eq!((board["told"].as_bool(), board["datum"].as_str(), board["photographs"].as_u64()), (Some(true), Some("inner"), Some(12)));
    let [in_plane, sigma] = ["in_plane", "sigma_in_plane"].map(|key| board[key].as_f64().unwrap());
    assert!((0.08..0.16).contains(&in_plane) && sigma < 0.04, "{in_plane} {sigma}");
    assert!(board["halves"]["in_plane"]["correlation"].as_f64().unwrap() > 0.8, "{board}");
    let corners = read_board_corners(&folder.path().join("board.csv")).unwrap();
    assert_eq!((corners.len(), corners[53].target.as_str(), corners[53].nominal), (54, "r6c9", Some([200.0, -125.0, 0.0])));
    let page = std::fs::read_to_string(folder.path().join("measured/README.md")).unwrap();
    assert!(page.contains("board measured: 54 corners from 12 photographs") && page.contains("(board-corners.png)"), "{page}");
    assert!(folder.path().join("measured/board-corners.csv").is_file());
    let rms = |more: &[&str]| calibrated(folder.path(), &[&["later"], more].concat())["rms_px"].as_f64().unwrap();
    let (nominal, own) = (rms(&[]), rms(&["--board-file", "board.csv"]));
    assert!(own < 0.6 * nominal, "{own} {nominal}");

    let judged = |more: &[&str]| {
        let models =
            ["-m", "parametric_corner", "-m", "forstner:window=11", "-m", "saddle:window=7", "--model", "opencv4", "--splits", "2"];
        let output = run(folder.path(), &[&["judge", "-q", "later", "--board", BOARD], &models[..], more].concat());
        stdout(&output)
    };
    let first = judged(&[]);
    assert!(first.starts_with("- **Measure your board**: it decides."), "{first}");
    assert!(first.contains("--save-board board.csv") && first.contains("object units RMS off in the plane"), "{first}");
    let with = judged(&["--board-file", "board.csv"]);
    assert!(with.starts_with("- **Take that board file**: it decides."), "{with}");
    assert!(with.contains("those of the file, taken as exact"), "{with}");
}

#[test]
fn what_is_stated_of_a_board_is_said_and_what_is_not_too() {
    let folder = photographs();
    let plain = calibrated(folder.path(), &["first"]);
    let exact: Vec<&str> = plain["taken_as_exact"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert_eq!(
        exact,
        ["the scale of the board (--board-scale)", "the places of its points (--print-noise, --board-file, --board-shape free)"]
    );
    let stated = calibrated(folder.path(), &["first", "--board-scale", "1.01:2e-3", "--print-noise", "0.08"]);
    assert_eq!(stated["taken_as_exact"].as_array().unwrap().len(), 0);
    assert_eq!((stated["board"]["scale"]["sigma"].as_f64(), stated["board"]["print_noise"].as_f64()), (Some(2e-3), Some(0.08)));
    let noisy = calibrated(folder.path(), &["first", "--print-noise", "0.08"]);
    for (a, b) in noisy["images"].as_array().unwrap().iter().zip(stated["images"].as_array().unwrap()) {
        let [a, b] = [a, b].map(|image| image["centre"][2].as_f64().unwrap());
        assert!((b / a - 1.01).abs() < 1e-3, "{a} {b}");
    }
    let fx = |found: &Value| found["cameras"][0]["camera"]["parameters"].to_string();
    assert!(!fx(&noisy).is_empty());
    assert!(noisy["rms_px"].as_f64() < plain["rms_px"].as_f64(), "corners of the board may move");
}

#[test]
fn files_of_other_boards_and_other_mistakes_are_refused() {
    let folder = photographs();
    calibrated(folder.path(), &["first", "--save-board", "board.csv"]);
    let text = std::fs::read_to_string(folder.path().join("board.csv")).unwrap();
    let with = |name: &str, text: &str| {
        write(folder.path(), name, text);
        refused(folder.path(), &["calibrate", "-q", "later", "--board", BOARD, "--board-file", name])
    };
    let short: String = text.lines().take(54).map(|line| format!("{line}\n")).collect();
    assert!(with("short.csv", &short).contains("short.csv: holds 53 corners, and the board has 54: r6c9 is not there"));
    assert!(with("strange.csv", &text.replace("r6c9,", "q,")).contains("r6c9 is not there"));
    assert!(with("column.csv", &text.replacen("sZ", "sW", 1)).contains("column.csv:1, column `sW`: unknown"));
    assert!(with("infinite.csv", &text.replacen(",0,0,0,12", ",0,0,inf,12", 1)).contains("expected a finite number"));
    let other = refused(folder.path(), &["calibrate", "-q", "later", "--board", "9x6:40", "--board-file", "board.csv"]);
    assert!(other.contains("from where the board has it, and its next corner is 40.0 away"), "{other}");
    let judge = refused(folder.path(), &["judge", "-q", "later", "--board", "9x6:40", "--board-file", "board.csv"]);
    assert!(judge.contains("board.csv: `") && judge.contains("next corner is 40.0 away"), "{judge}");
    for (arguments, expected) in [
        (&["--save-board", "b.csv", "--board-shape", "bent"][..], "every corner is free when a board is measured"),
        (&["--save-board", "b.txt"], "--save-board b.txt: a table ends in .csv"),
        (&["--board-scale", "1.0003"], "is no scale of a board: expected true over nominal length and its standard deviation"),
        (&["--print-noise", "0"], "--print-noise"),
        (&["--board-file", "absent.csv"], "absent.csv"),
    ] {
        let words = refused(folder.path(), &[&["calibrate", "-q", "first", "--board", BOARD], arguments].concat());
        assert!(words.contains(expected), "{arguments:?}: {words}");
    }
    let few: Vec<String> = (1..4)
        .map(|k| std::fs::read_dir(folder.path().join("first")).unwrap().nth(k).unwrap().unwrap().path().display().to_string())
        .collect();
    let few: Vec<&str> = few.iter().map(String::as_str).collect();
    let words = refused(folder.path(), &[&["calibrate", "-q", "--board", BOARD, "--save-board", "few.csv"], &few[..]].concat());
    assert!(words.contains("3 photographs; expected 4") && !folder.path().join("few.csv").exists(), "{words}");
}

/// The board that OpenCV's photographs show: what one half of them measures halves the residuals of the other.
#[test]
#[cfg_attr(
    not(photographs),
    ignore = "the photographs left01.jpg to left14.jpg are absent: docs/scenarios.md says where they are looked for"
)]
fn half_of_opencvs_photographs_measure_the_board_of_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let photo = |k: &u32| data().join(format!("opencv-left/left{k:02}.jpg")).display().to_string();
    let numbers: Vec<u32> = (1..15).filter(|k| *k != 10).collect();
    let [first, later] = [0, 1].map(|half| numbers.iter().skip(half).step_by(2).map(photo).collect::<Vec<String>>());
    let of = |photos: &[String], more: &[&str]| {
        let photos: Vec<&str> = photos.iter().map(String::as_str).collect();
        calibrated(folder.path(), &[&photos[..], more].concat())
    };
    let measured = of(&first, &["--save-board", "board.csv"]);
    assert!(measured["board"]["measured"]["in_plane"].as_f64().is_some_and(|rms| (0.03..0.2).contains(&rms)), "{measured}");
    let [nominal, own] =
        [&["--board-shape", "flat"][..], &["--board-file", "board.csv"]].map(|more| of(&later, more)["rms_px"].as_f64().unwrap());
    assert!(own < 0.75 * nominal, "{own} {nominal}");
}
