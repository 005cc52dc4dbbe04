//! Several boards of one kind in a photograph, and boards of which nothing is known.

use std::collections::BTreeMap;
use std::path::Path;

use image::{ImageBuffer, Luma};

use crate::project::{run, stderr, stdout};

/// Stations that look past the board: where they stand beside the place that they look at, and how far that is from the board's middle upwards, mm.
const SHOTS: [([f64; 2], f64); 6] = [
    ([0.0, 0.0], -50.0),
    ([220.0, 30.0], 50.0),
    ([-220.0, 60.0], 0.0),
    ([20.0, 240.0], 40.0),
    ([0.0, -240.0], -40.0),
    ([160.0, 170.0], 20.0),
];
/// The side of the image on which the board is, and how far the stations look past it, mm.
const SIDES: [(&str, f64); 2] = [("left", 170.0), ("right", -170.0)];
/// Boards of some 180 x 120 mm, the middle of what is printed, and what measures them.
const BOARDS: [(&str, [f64; 2]); 4] = [
    ("charuco:6x4:30:21:DICT_4X4_50", [60.0, -30.0]),
    ("gridboard:4x3:36:10:DICT_4X4_50", [87.0, -64.0]),
    ("chessboard:7x4:22", [66.0, -33.0]),
    ("circles:7x5:25", [75.0, -50.0]),
];

/// A camera before a board that is in the left half of some images and in the right half of others: `rendered/left-1.png`, ... with their truth.
fn rendered(board: &str, [x, y]: [f64; 2]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut text = format!(
        "why = \"a test\"\nsource = \"ours\"\nseed = 4\n[camera]\nsize = [1280, 960]\npitch = 5.0\nc = 6.0\nx0 = 0.02\ny0 = -0.01\n\
         [testfield]\nkind = \"board\"\nunit = \"mm\"\nboard = \"{board}\"\nmargin = 12\n\
         [optics]\nblur = 0.7\nfill_factor_area = 0.8\n[sensor]\ngrey_noise = 0.004\n[pointing]\nsigma = 0.5\nwhole_pixels = true\n\
         [[method]]\nname = \"pixel\"\n"
    );
    for (side, past) in SIDES {
        for (shot, ([dx, dy], up)) in SHOTS.iter().enumerate() {
            // In the right half from elsewhere than in the left one.
            let turned = if side == "left" { [*dx, *dy] } else { [-*dy, *dx] };
            let (to, from) = ([x + past, y + up], [x + past + turned[0], y + up + turned[1]]);
            text += &format!(
                "[[station]]\nname = \"{side}-{}\"\nat = [{}, {}, 600]\ntowards = [{}, {}, 0]\n",
                shot + 1,
                from[0],
                from[1],
                to[0],
                to[1]
            );
        }
    }
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    let output = run(folder.path(), &["render", "scene.toml", "-o", "rendered", "-q"]);
    assert!(output.status.success(), "{board}: {}", stderr(&output));
    folder
}

fn single(side: &str, shot: usize) -> String {
    format!("rendered/{side}-{}.png", shot + 1)
}

/// Images of two boards: the left half of one and the right half of another.
fn joined(folder: &Path) -> Vec<String> {
    std::fs::create_dir(folder.join("two")).unwrap();
    let one = |shot: usize| {
        let [left, right] = ["left", "right"].map(|side| image::open(folder.join(single(side, shot))).unwrap().into_luma16());
        let both: ImageBuffer<Luma<u16>, Vec<u16>> =
            ImageBuffer::from_fn(left.width(), left.height(), |x, y| *if 2 * x < left.width() { &left } else { &right }.get_pixel(x, y));
        let name = format!("two/{}.png", shot + 1);
        both.save(folder.join(&name)).unwrap();
        name
    };
    (0..SHOTS.len()).map(one).collect()
}

fn with<'a>(first: &[&'a str], photos: &'a [String], more: &[&'a str]) -> Vec<&'a str> {
    first.iter().copied().chain(photos.iter().map(String::as_str)).chain(more.iter().copied()).collect()
}

/// Positions by image and target.
fn positions(path: &Path) -> BTreeMap<(String, String), [f64; 2]> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let headers = reader.headers().unwrap().clone();
    let [image, target, x, y] = ["image", "target", "x", "y"].map(|name| headers.iter().position(|header| header == name).unwrap());
    let number = |text: &str| text.parse().unwrap_or(f64::NAN);
    let row = |record: csv::StringRecord| ((record[image].to_owned(), record[target].to_owned()), [number(&record[x]), number(&record[y])]);
    reader.records().map(|record| row(record.unwrap())).collect()
}

/// What `PHOTO#BOARD` is called where the board is alone.
fn alone(view: &str) -> String {
    let (photo, board) = view.split_once(".png#").unwrap();
    format!("{}-{photo}.png", if board == "1" { "left" } else { "right" })
}

/// Two boards in each of six photographs are twelve views: their points are where they are, and what is calibrated from them is, to the last bit of the points,
/// what twelve photographs of one board each tell.
#[test]
fn each_of_two_boards_is_a_view_with_a_pose_of_its_own() {
    for (board, middle) in BOARDS {
        let folder = rendered(board, middle);
        let here = folder.path();
        let both = joined(here);
        let good = |arguments: &[&str], codes: &[i32]| {
            let output = run(here, arguments);
            assert!(output.status.code().is_some_and(|code| codes.contains(&code)), "{board}: {arguments:?}\n{}", stderr(&output));
            output
        };
        let found = good(&with(&["detect"], &both, &["--board", board, "--all", "-o", "approx.csv"]), &[0]);
        assert!(stderr(&found).contains("found in 6 of 6 photographs, 12 times"), "{board}: {}", stderr(&found));
        let (mut truth, found) = (BTreeMap::new(), positions(&here.join("approx.csv")));
        for (side, _) in SIDES {
            (0..SHOTS.len()).for_each(|shot| truth.extend(positions(&here.join(single(side, shot).replace(".png", ".csv")))));
        }
        assert_eq!(found.len(), truth.len(), "{board}");
        for ((view, target), at) in &found {
            // A grid of circles looks the same upside down: all of these are seen upright.
            let there = truth[&(alone(view), target.clone())];
            assert!((at[0] - there[0]).hypot(at[1] - there[1]) < 1.0, "{board} {view} {target}: {at:?} {there:?}");
        }
        // By its points and by itself, in steps and at once.
        let singles: Vec<String> = SIDES.iter().flat_map(|(side, _)| (0..SHOTS.len()).map(|shot| single(side, shot))).collect();
        good(&with(&["calibrate"], &singles, &["--board", board, "-o", "alone.json", "-q"]), &[0, 3]);
        good(&with(&["calibrate"], &both, &["--board", board, "--all", "-o", "both.json", "--report", "page", "-q"]), &[0, 3]);
        let apart = |one: &str, other: &str| {
            let said = stdout(&good(&["diff", one, other, "--radius", "500"], &[0]));
            said.split_whitespace().nth(1).and_then(|number| number.parse::<f64>().ok()).unwrap_or_else(|| panic!("{said}"))
        };
        assert!(apart("alone.json", "both.json") < 1e-3, "{board}: {}", apart("alone.json", "both.json"));
        assert!(apart("both.json", "rendered/camera.toml") < 0.5, "{board}: {}", apart("both.json", "rendered/camera.toml"));
        let page = std::fs::read_to_string(here.join("page/README.md")).unwrap();
        let page = page.replace('\\', "");
        assert!(page.contains("1.png#1") && page.contains("6.png#2"), "{board}: {page}");
        // Measured in a step of its own, in the photograph of the view.
        let method = if board.starts_with("circles") { "centroid" } else { "forstner:window=9" };
        let measured = good(&with(&["measure"], &both, &["--points", "approx.csv", "-m", method, "-o", "measured.csv"]), &[0]);
        assert!(stderr(&measured).contains("measured"), "{}", stderr(&measured));
        assert_eq!(positions(&here.join("measured.csv")).keys().collect::<Vec<_>>(), found.keys().collect::<Vec<_>>(), "{board}");
    }
}

/// Without `--all` it is said that there are several, with the number of points of each; marks that cannot be told apart stay refused.
#[test]
fn several_boards_are_said_with_the_number_of_points_of_each() {
    for (board, middle) in BOARDS {
        let folder = rendered(board, middle);
        let both = joined(folder.path());
        let output = run(folder.path(), &with(&["detect"], &both[..2], &["--board", board, "-o", "approx.csv", "-q"]));
        let said = stderr(&output);
        let is_coded = board.starts_with("charuco") || board.starts_with("gridboard");
        assert_eq!(output.status.code(), Some(if is_coded { 2 } else { 3 }), "{board}: {said}");
        let points = stdout(&run(folder.path(), &["control", board])).lines().count() - 1;
        assert!(said.contains(&format!("2 boards of this kind are seen, from the left with {points}, {points} points")), "{board}: {said}");
        assert!(said.contains("--all takes each of them"), "{board}: {said}");
        assert_eq!(folder.path().join("approx.csv").exists(), !is_coded, "{board}");
        let single = [single("left", 0)];
        let one = run(folder.path(), &with(&["detect"], &single, &["--board", board, "--all", "-o", "one.csv"]));
        assert!(one.status.success() && stderr(&one).contains("1 of 1 photographs, 1 times"), "{board}: {}", stderr(&one));
        assert!(positions(&folder.path().join("one.csv")).keys().all(|(view, _)| view == "left-1.png#1"), "{board}");
    }
}

#[test]
fn each_of_two_boards_is_judged_as_a_view() {
    let (board, middle) = BOARDS[0];
    let folder = rendered(board, middle);
    let both = joined(folder.path());
    let asked = ["--board", board, "--all", "-m", "parametric_corner", "-m", "pixel", "--model", "opencv4:fx,fy,cx,cy", "--splits", "2"];
    let output = run(folder.path(), &with(&["judge"], &both, &[&asked[..], &["--json", "-q"]].concat()));
    assert!(matches!(output.status.code(), Some(0 | 3)), "{}", stderr(&output));
    let answer: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(answer["operator"], "parametric_corner:window=15", "{answer}");
    let photographs = answer["photographs"].as_array().unwrap();
    assert_eq!(photographs.len(), 12, "{answer}");
    for (shot, board) in (1..=6).flat_map(|shot| [(shot, 1), (shot, 2)]) {
        let name = format!("\"{shot}.png#{board}\"");
        assert_eq!(photographs.iter().filter(|one| one.to_string().contains(&name)).count(), 1, "{name}: {answer}");
    }
}

/// `detect --board unknown` names what is there, and by its words it is found.
#[test]
fn a_board_of_which_nothing_is_known_is_named() {
    for (board, middle) in BOARDS {
        let folder = rendered(board, middle);
        let photos: Vec<String> = (0..3).map(|shot| single("left", shot)).collect();
        let output = run(folder.path(), &with(&["detect"], &photos, &["--board", "unknown"]));
        assert!(output.status.success(), "{board}: {}", stderr(&output));
        let said = stdout(&output);
        let words = said.lines().last().unwrap().strip_prefix("--board ").unwrap_or_else(|| panic!("{said}"));
        let kind = board.split(':').take(2).collect::<Vec<_>>().join(":");
        assert!(words.starts_with(&kind), "{board}: {said}");
        let found = run(folder.path(), &with(&["detect"], &photos, &["--board", words, "-o", "approx.csv", "-q"]));
        assert!(found.status.success(), "{board}: {}", stderr(&found));
        let points = stdout(&run(folder.path(), &["control", board])).lines().count() - 1;
        assert_eq!(positions(&folder.path().join("approx.csv")).len(), 3 * points, "{board}");
    }
}

#[test]
fn the_error_of_a_wrong_count_names_the_board_that_is_there() {
    for ((board, middle), asked, named) in [
        (
            BOARDS[0],
            "charuco:7x4:30:21:DICT_5X5_50",
            "a ChArUco board of 6 x 4 squares, a dark square at the upper left, DICT_4X4_50, 12 markers from 0 to 11: try --board charuco:6x4:30:21:DICT_4X4_50",
        ),
        (
            BOARDS[1],
            "charuco:6x4:30:21:DICT_4X4_50",
            "a GridBoard of 4 x 3 markers, DICT_4X4_50, 12 markers from 0 to 11: try --board gridboard:4x3:1:0.28:DICT_4X4_50",
        ),
        (BOARDS[2], "chessboard:8x4:22", "a chessboard of 7 x 4 inner corners: try --board chessboard:7x4:22"),
        (BOARDS[3], "circles:8x5:25", "a symmetric grid of 7 x 5 circles: try --board circles:7x5:25:12.5"),
    ] {
        let folder = rendered(board, middle);
        let photos = [single("left", 0), single("right", 1)];
        let output = run(folder.path(), &with(&["detect"], &photos, &["--board", asked, "-q"]));
        assert_eq!(output.status.code(), Some(2), "{board}: {}", stderr(&output));
        assert!(stderr(&output).contains(named), "{board}: {}", stderr(&output));
    }
}

#[test]
fn what_is_no_board_is_not_named() {
    let folder = tempfile::tempdir().unwrap();
    let flat: ImageBuffer<Luma<u8>, Vec<u8>> = ImageBuffer::from_fn(200, 150, |x, _| Luma([100 + (x / 40) as u8]));
    flat.save(folder.path().join("flat.png")).unwrap();
    for (arguments, said) in [
        (&["detect", "flat.png", "--board", "unknown"][..], "no board that is known was found"),
        (&["detect", "flat.png", "--board", "unknown", "-o", "a.csv"], "leave -o, --all and --draw out"),
        (&["detect", "flat.png", "--board", "unknown", "--all"], "leave -o, --all and --draw out"),
        (&["detect", "flat.png", "--board", "unknwon"], "is no kind of board"),
        (&["calibrate", "flat.png", "--board", "unknown"], "`detect --board unknown` names the board that is there"),
        (&["detect", "flat.png", "--board", "gridboard:5x7:40:10:DICT_6X6_250", "--all"], "no board was found"),
    ] {
        let output = run(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{arguments:?}: {}", stderr(&output));
    }
}
