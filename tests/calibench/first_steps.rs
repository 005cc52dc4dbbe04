//! What somebody types in the first ten minutes: boards by one name, folders, gates, families, a printed board, a demonstration.

use std::path::Path;

use crate::judge::board;
use crate::project::{copy_of, files, run, stderr, stdout};

fn good(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

fn fails(folder: &Path, arguments: &[&str], code: i32, said: &str) {
    let output = run(folder, arguments);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {}", stderr(&output));
    assert!(stderr(&output).contains(said), "{arguments:?}: expected {said}\n{}", stderr(&output));
}

#[test]
fn a_board_has_one_name_and_a_folder_is_its_photographs() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let images = board(here);
    let names: Vec<&str> = images.iter().map(String::as_str).collect();
    let with = |first: &[&'static str], photos: &[&'static str]| {
        let all: Vec<&str> = first.iter().copied().chain(photos.iter().copied()).collect();
        good(here, &all)
    };
    // The folder holds tables of the truth, too.
    let found = with(&["detect", "-q", "--board", "9x6:25"], &["board"]);
    assert_eq!(found.lines().count(), 1 + 54 * images.len());
    for same in [["--chessboard", "9x6:25"], ["--board", "chessboard:9x6:25"]] {
        assert_eq!(good(here, &[&["detect", "-q"][..], &same, &names].concat()), found, "{same:?}");
    }
    // Without a side squares have another one, and shapes other last digits.
    let places = |table: &str| table.lines().map(|line| line.split(',').take(5).collect::<Vec<_>>().join(",")).collect::<Vec<_>>();
    let bare = with(&["detect", "-q", "--board", "9x6"], &["board"]);
    assert_eq!(places(&bare), places(&found));
    assert_eq!(good(here, &[&["detect", "-q", "--chessboard", "9x6"][..], &names].concat()), bare);
    // Found and measured in one step, as in two.
    std::fs::write(here.join("approx.csv"), &bare).unwrap();
    let measured = with(&["measure", "-q", "--board", "9x6", "-m", "forstner"], &["board"]);
    assert_eq!(measured, with(&["measure", "-q", "--points", "approx.csv", "-m", "forstner"], &["board"]));
    let usual = with(&["measure", "-q", "--board", "9x6:25"], &["board"]);
    assert!(usual.contains("parametric_corner") && !usual.contains("forstner"), "{usual}");
    // Left out by who writes them as one by one.
    let calibrated = |photos: &[&str], board: &str| {
        let output = run(here, &[&["calibrate", "-q", board, "9x6:25", "--model", "opencv4", "--json"][..], photos].concat());
        stdout(&output)
    };
    assert!(calibrated(&["board"], "--board").contains("\"opencv"));
    assert_eq!(calibrated(&["board"], "--board"), calibrated(&names, "--chessboard"));
    fails(here, &["measure", "board"], 2, "--points <CSV>");
    fails(here, &["calibrate", "board"], 2, "--board <BOARD>");
    fails(here, &["judge", "board"], 2, "--board <BOARD>");
    fails(here, &["calibrate", "board", "--board", "9x6"], 2, "expected inner corners and the side of a square");
}

#[test]
fn what_a_folder_lacks_is_said_with_the_line_that_converts_it() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::create_dir(here.join("photos")).unwrap();
    let detect = ["detect", "photos", "--board", "9x6:25"];
    fails(here, &detect, 2, "photos: holds no photograph; expected PNG, JPEG, TIFF, PNM, BMP or WebP");
    std::fs::write(here.join("photos/a.HEIC"), b"\0\0\0\x18ftypheic\0\0\0\0mif1heic").unwrap();
    fails(here, &detect, 2, "which is a HEIC picture (`heif-convert photos/a.HEIC photos/a.png` converts it");
    fails(here, &["judge", "photos/a.HEIC", "--board", "9x6:25"], 2, "at least 6");
    fails(here, &["calibrate", "photos/a.HEIC", "--board", "9x6:25"], 2, "heif-convert photos/a.HEIC photos/a.png");
    // Beside one that is read it is left out, and said.
    let grey = calibench_model::Image::from_fn(64, 48, |_, _| 0.5);
    calibench_images::write_png(&here.join("photos/b"), &grey, false).unwrap();
    fails(here, &detect, 2, "photos: 1 photograph is taken, and not photos/a.HEIC");
}

#[test]
fn cameras_that_differ_too_much_fail_a_gate() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let images = board(here);
    let camera = |f: f64| {
        format!(
            "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ {f}, 0., 320., 0., {f}, 240., 0., 0., 1. ]\n\
             distortion_coefficients: !!opencv-matrix\n   rows: 4\n   cols: 1\n   dt: d\n   data: [ 0., 0., 0., 0. ]\n"
        )
    };
    std::fs::write(here.join("a.yaml"), camera(533.0)).unwrap();
    std::fs::write(here.join("b.yaml"), camera(540.0)).unwrap();
    let diff = |limit: &str| run(here, &["diff", "a.yaml", "b.yaml", "--limit", limit]);
    let words = stdout(&diff("10"));
    let rms: f64 = words.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert_eq!(diff("10").status.code(), Some(0));
    assert_eq!(diff(&(1.01 * rms).to_string()).status.code(), Some(0), "{words}");
    let over = diff(&(0.99 * rms).to_string());
    assert_eq!((over.status.code(), stdout(&over)), (Some(1), words));
    assert!(stderr(&over).contains("more than the "), "{}", stderr(&over));
    let json = run(here, &["diff", "a.yaml", "b.yaml", "--limit", "0.1", "--json"]);
    assert!(json.status.code() == Some(1) && stdout(&json).contains("\"is_kept\": false"), "{}", stdout(&json));
    assert!(stdout(&run(here, &["diff", "a.yaml", "b.yaml", "--json"])).contains("\"limit\": null"));
    fails(here, &["diff", "a.yaml", "b.yaml", "--limit", "0"], 2, "--limit");
    // The same of photographs: --limit is what --margin is.
    let judged = |option: &str, px: &str| {
        let names: Vec<&str> = images.iter().map(String::as_str).collect();
        let more = ["--camera", "b.yaml", "--model", "opencv4+bent", "--splits", "3", option, px];
        let output = run(here, &[&["judge", "-q", "--board", "9x6:25"][..], &names, &more].concat());
        (output.status.code(), stdout(&output).lines().next().unwrap_or_default().to_owned())
    };
    assert_eq!(judged("--limit", "0.5"), judged("--margin", "0.5"));
    assert_eq!(judged("--limit", "0.5").0, Some(1));
    assert_eq!(judged("--limit", "1000").0, Some(0));
}

#[test]
fn what_was_found_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let images = board(here);
    let noise = calibench_model::Image::from_fn(320, 240, |x, y| ((x * 7919 + y * 104_729) % 251) as f32 / 250.0);
    calibench_images::write_png(&here.join("board/none.png"), &noise, false).unwrap();
    good(here, &["detect", "-q", "board", "--board", "9x6:25", "--draw", "drawn", "-o", "points.csv"]);
    let drawn: Vec<_> = files(&here.join("drawn")).into_iter().filter(|(path, _)| path.extension().is_some_and(|e| e == "png")).collect();
    assert_eq!(drawn.len(), images.len() + 1, "those with a board, and one without");
    for (path, _) in &drawn {
        let picture = image::open(here.join("drawn").join(path)).unwrap().to_rgb8();
        // The marks are blue, green and orange on grey.
        let is_coloured = |p: &image::Rgb<u8>| p.0.iter().max().unwrap() - p.0.iter().min().unwrap() > 60;
        let coloured = picture.pixels().filter(|pixel| is_coloured(pixel)).count();
        assert!(coloured > 100, "{}: {coloured}", path.display());
    }
    fails(here, &["detect", "board", "--board", "unknown", "--draw", "other"], 2, "leave -o, --all and --draw out");
    std::fs::create_dir(here.join("mine")).unwrap();
    std::fs::write(here.join("mine/letter.txt"), "dear").unwrap();
    fails(here, &["detect", "board", "--board", "9x6", "--draw", "mine"], 2, "--draw mine: holds files that calibench did not write");
}

#[test]
fn a_family_is_run_and_reported_as_far_as_it_was_run() {
    let project = copy_of(&["corners/"]);
    let here = project.path();
    let corners = here.join("scenarios/corners");
    std::fs::copy(corners.join("noise.toml"), corners.join("again.toml")).unwrap();
    let scenarios: Vec<String> = files(&here.join("scenarios/corners")).into_iter().map(|(path, _)| path.display().to_string()).collect();
    assert!(scenarios.len() > 1, "{scenarios:?}");
    fails(here, &["report", "corners"], 2, "no scenario of `corners` was run: `calibench run corners` runs all ");
    assert!(stderr(&run(here, &["report", "-q"])).contains("not run, so that there is no report of them: corners"));
    good(here, &["run", "corners/noise", "--trials", "2", "-q"]);
    let output = run(here, &["report", "-q"]);
    assert!(
        output.status.success()
            && stderr(&output).contains(&format!("corners: {} of {} scenarios were not run", scenarios.len() - 1, scenarios.len()))
    );
    let page = std::fs::read_to_string(here.join("reports/corners/README.md")).unwrap();
    assert!(
        page.contains("**Not run**, so that nothing is said of them here: `corners/") && page.contains("`calibench run corners` runs all"),
        "{page}"
    );
    good(here, &["run", "corners", "--trials", "2", "-q"]);
    let output = run(here, &["report", "corners", "-q"]);
    assert!(output.status.success() && stderr(&output).is_empty(), "{}", stderr(&output));
    assert!(!std::fs::read_to_string(here.join("reports/corners/README.md")).unwrap().contains("**Not run**"));
}

#[test]
fn a_board_is_printed_outside_of_a_project() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    assert_eq!(good(here, &["print", "--board", "9x6:25", "--paper", "A4", "-q"]), "board\n");
    let names: Vec<String> = files(&here.join("board")).into_iter().map(|(path, _)| path.display().to_string()).collect();
    assert!(names.contains(&"chessboard-9x6-25.pdf".to_owned()) && names.contains(&"target.yaml".to_owned()), "{names:?}");
    let pdf = String::from_utf8_lossy(&std::fs::read(here.join("board/chessboard-9x6-25.pdf")).unwrap()).into_owned();
    assert_eq!((pdf.matches("/MediaBox").count(), pdf.contains("[0 0 841.88")), (1, true), "one sheet of A4, across");
    fails(here, &["print", "--board", "9x6:40", "--paper", "a4"], 2, "expected lengths of 62 % of these");
    fails(here, &["print", "--board", "aprilgrid:6x6:0.088:0.3", "--paper", "a4"], 2, "--unit m says so");
    fails(here, &["print"], 2, "expected --board BOARD");
}

#[test]
fn lists_are_told_to_programs() {
    let folder = tempfile::tempdir().unwrap();
    for (what, name) in
        [("methods", "forstner"), ("formats", "kalibr"), ("conventions", "opencv"), ("figures", "sigma0"), ("peers", "apriltag-python")]
    {
        let answer: serde_json::Value = serde_json::from_str(&good(folder.path(), &["list", what, "--json"])).unwrap();
        assert_eq!((answer["command"].as_str(), answer["what"].as_str()), (Some("list"), Some(what)));
        let items = answer["items"].as_array().unwrap();
        assert!(items.iter().any(|item| item["name"] == name) && items.iter().all(|item| item["about"].is_string()), "{what}");
    }
}

#[test]
fn a_demonstration_needs_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    assert_eq!(good(here, &["demo", "-q"]), "calibench-demo/report.html\n");
    let demo = here.join("calibench-demo");
    let page = std::fs::read_to_string(demo.join("report.html")).unwrap();
    for part in ["calibench judge photographs --board 9x6:25", "Exit code 3", "px RMS from the true one", "picture-3", "standard deviation"]
    {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(files(&demo.join("photographs")).iter().filter(|(path, _)| path.extension().is_some_and(|e| e == "png")).count(), 13);
    // What it said of itself is what `calibrate` says, not what a file without correlations would have.
    let calibrated = run(&demo, &["calibrate", "-q", "photographs", "--board", "9x6:25"]);
    let known = stdout(&calibrated).lines().find_map(|line| line.strip_prefix("known to ")?.split(' ').next().map(str::to_owned)).unwrap();
    assert!(page.contains(&format!("it said of itself {known} px")), "{known}");
    // What is on the page came out of the photographs: another camera is not as near.
    assert!(page.contains("class=\"verdict good\""), "what the camera says of itself holds");
    good(here, &["demo", "-q"]);
    std::fs::write(demo.join("board.toml"), "mine").unwrap();
    fails(here, &["demo"], 2, "is no folder of a demonstration");
}
