//! Methods that find boards: one conformance test for all, OpenCV's too, and scenarios that ask them for what they do not know.

use calibench_measure::parameter::Domain;
use calibench_opencv::registry;
use calibench_run::origin::{check_origins, origin_of, origins};

use crate::project::{copy, run, stderr, table};

/// All of them, with the settings that change where points lie.
const ALL: [&str; 12] = [
    "detect",
    "calib_targets",
    "opencv_find_chessboard",
    "opencv_find_chessboard:sb=yes",
    "opencv_find_charuco",
    "opencv_find_charuco:corrected=yes",
    "opencv_find_aprilgrid",
    "opencv_find_aprilgrid:refinement=subpix",
    "opencv_find_aprilgrid:refinement=contour",
    "opencv_find_aprilgrid:refinement=apriltag",
    "opencv_find_aprilgrid:refinement=apriltag,corrected=yes",
    "opencv_find_circles",
];

#[test]
fn every_finder_has_its_points_where_it_states_them() {
    let registry = registry();
    for text in ALL {
        let method = registry.parse(text).unwrap();
        let Some(finder) = method.board_finder() else {
            // A build with an OpenCV whose markers are elsewhere says so.
            assert!(method.operator.as_ref().is_err_and(|why| why.contains("aruco")), "{text}");
            continue;
        };
        check_origins(finder, &origins(finder).unwrap()).unwrap_or_else(|wrong| panic!("{text}: {wrong}"));
    }
    let finders = registry.methods().iter().filter(|method| {
        registry
            .configure(method.name, &[])
            .is_ok_and(|method| method.board_finder().is_some() || method.name().starts_with("opencv_find_"))
    });
    let untested: Vec<&str> = finders.map(|method| method.name).filter(|name| !ALL.contains(name)).collect();
    assert!(untested.is_empty(), "not in the list: {untested:?}");
}

/// The half pixel of OpenCV's ChArUco boards: stated, measured, and taken out if asked.
#[test]
fn the_half_pixel_of_opencv_is_known_and_taken_out() {
    let board = "charuco:8x5:30:15:DICT_4X4_50".parse().unwrap();
    let registry = registry();
    for (text, expected) in [("opencv_find_charuco", 0.5), ("opencv_find_charuco:corrected=yes", 0.0), ("detect", 0.0)] {
        let method = registry.parse(text).unwrap();
        let Some(finder) = method.board_finder() else { continue };
        let found = origin_of(finder, board).unwrap();
        assert!(found.median[..2].iter().all(|median| (median - expected).abs() < 0.02), "{text}: {found:?}");
        assert_eq!(finder.origin(&board), [expected; 2], "{text}");
    }
}

const BOARD: &str = "[camera]\nsize = [640, 480]\npitch = 5.0\nc = 3.0\n[testfield]\nkind = \"board\"\nunit = \"mm\"\nboard = \"BOARD\"\nmargin = 8\n\
    [stations]\nkind = \"board\"\ntilts = [[10, 5]]\ndistances = [640]\nrolls = [0]\n[optics]\nblur = 0.6\n[sensor]\nadc_bits = 8\n\
    [pointing]\nsigma = 0.5\nwhole_pixels = true\n";

fn scenario(board: &str, method: &str) -> tempfile::TempDir {
    let project = copy();
    std::fs::create_dir_all(project.path().join("scenarios/mine")).unwrap();
    let head = "why = \"a test\"\nsource = \"ours\"\nseed = 1\n";
    let text = format!("{head}{}[[method]]\nname = \"{method}\"\n", BOARD.replace("BOARD", board));
    std::fs::write(project.path().join("scenarios/mine/board.toml"), text).unwrap();
    project
}

#[test]
fn a_board_that_a_finder_does_not_know_is_a_mistake_of_the_scenario() {
    let project = scenario("rings:12:10x7:38:10", "opencv_find_circles");
    let output = run(project.path(), &["run", "mine/board"]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        said.contains("`opencv_find_circles` finds boards, and it finds grids of circles alone") && said.contains("board.toml"),
        "{said}"
    );
    let output = run(project.path(), &["run", "corners/noise", "-m", "detect"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("`detect` finds boards, and in `corners/noise` there is no testfield that is one"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn photographs_are_not_measured_by_a_finder() {
    let project = copy();
    let output = run(project.path(), &["measure", "x.png", "--points", "y.csv", "-m", "detect"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("it finds boards in whole images"), "{}", stderr(&output));
}

/// Upright and on its side, a board that is seen whole is found whole by those that find it.
#[test]
fn a_board_on_its_side_is_counted_whole() {
    let project = copy();
    let methods = ["detect", "calib_targets", "opencv_find_chessboard"];
    let arguments = ["run", "targets/chessboard", "--trials", "1", "-m", methods[0], "-m", methods[1], "-m", methods[2]];
    let output = run(project.path(), &arguments);
    assert!(output.status.success(), "{}", stderr(&output));
    let records = table(&project.path().join("records/targets/chessboard/records.csv.gz"));
    for method in methods {
        for view in ["s01-r1", "s01-r2", "s02-r2"] {
            let measured = records
                .lines()
                .filter(|line| line.contains(&format!(",{view},")) && line.contains(&format!(",{method},")) && line.contains(",measured,"));
            assert_eq!(measured.count(), 54, "{method}, {view}");
        }
    }
}

/// Seen in part and in every turn, OpenCV's reading of three dots and ours are the same corners of the board, by name.
#[test]
fn opencv_and_ours_number_a_board_with_three_dots_alike() {
    let project = scenario("dotted:15x9:25:11,2", "detect");
    let file = project.path().join("scenarios/mine/board.toml");
    let stations = "kind = \"random\"\ncount = 12\ndistance = [300, 420]\ntilt = 30\nroll = 180\naside = [60, 40]\nsees = 0.4\n";
    let text = std::fs::read_to_string(&file).unwrap();
    let text = text.replace("kind = \"board\"\ntilts = [[10, 5]]\ndistances = [640]\nrolls = [0]\n", stations);
    let text = format!("{text}[[method]]\nname = \"opencv_find_chessboard\"\nsb = 1\n");
    std::fs::write(&file, text).unwrap();
    let output = run(project.path(), &["run", "mine/board", "--trials", "4"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let records = table(&project.path().join("records/mine/board/records.csv.gz"));
    let header: Vec<&str> = records.lines().next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|column| *column == name).unwrap();
    let [x, y, x_true, y_true, status] = ["x", "y", "x_true", "y_true", "status"].map(column);
    let offs = |method: &str| -> Vec<f64> {
        let rows = records.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let measured = rows.filter(|row| row[column("method")].starts_with(method) && row[status] == "measured");
        let off = |row: &[&str], [measured, truth]: [usize; 2]| row[measured].parse::<f64>().unwrap() - row[truth].parse::<f64>().unwrap();
        measured.map(|row| off(&row, [x, x_true]).hypot(off(&row, [y, y_true]))).collect()
    };
    let (ours, theirs) = (offs("detect"), offs("opencv_find_chessboard"));
    // A wrong name would be a square, some 60 px, off.
    assert!(ours.iter().chain(&theirs).all(|off| *off < 1.0), "{:?}", ours.iter().chain(&theirs).copied().fold(0.0, f64::max));
    assert!(theirs.len() > 1000 && ours.len() >= theirs.len(), "{} {}", ours.len(), theirs.len());
    assert!(records.lines().any(|line| line.contains("rejected")), "not all of every board is in view");
}

/// At the rim of a frame the lens puts a marker elsewhere than a homography of the others.
#[test]
fn a_sound_board_at_the_rim_of_a_distorted_frame_is_in_no_doubt() {
    let project = scenario("charuco:10x7:25:17.5:DICT_4X4_50", "detect");
    let file = project.path().join("scenarios/mine/board.toml");
    let stations = "kind = \"random\"\ncount = 2\ndistance = [320, 500]\ntilt = 40\nroll = 180\naside = [90, 70]\nsees = 0.7\n";
    let text = std::fs::read_to_string(&file).unwrap();
    let text = text
        .replace("seed = 1\n", "seed = 13\n")
        .replace("size = [640, 480]\npitch = 5.0\nc = 3.0", "size = [1280, 960]\npitch = 5.0\nc = 6.0\nk1 = -0.01");
    let text = text.replace("kind = \"board\"\ntilts = [[10, 5]]\ndistances = [640]\nrolls = [0]\n", stations);
    std::fs::write(&file, text).unwrap();
    assert!(run(project.path(), &["render", "mine/board", "-o", "rendered"]).status.success());
    let output = run(project.path(), &["detect", "rendered/s01.png", "--board", "charuco:10x7:25:17.5:DICT_4X4_50", "-o", "found.csv"]);
    assert!(output.status.success() && !stderr(&output).contains("doubt"), "{}", stderr(&output));
}

/// Every point of the board has a row, and the counts say the same.
#[test]
fn rows_and_counts_of_a_finder_agree() {
    let project = scenario("charuco:10x7:38:26.6:DICT_4X4_50", "detect");
    let output = run(project.path(), &["run", "mine/board"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let records = project.path().join("records/mine/board");
    let rows = table(&records.join("records.csv.gz"));
    let measured = rows.lines().filter(|line| line.contains(",measured,")).count();
    assert_eq!((rows.lines().skip(1).count(), measured), (54, 54));
    let counts = table(&records.join("calibrations.csv.gz"));
    let count = |what: &str| {
        let line = counts.lines().find(|line| line.contains(&format!("board/{what}/all"))).unwrap();
        line.split(',').nth(6).unwrap().parse::<f64>().unwrap()
    };
    assert_eq!([count("targets"), count("labels"), count("labelled"), count("wrong labels"), count("off")], [54.0, 54.0, 54.0, 0.0, 0.0]);
}

/// Baselines of 0.2.0 and older have the numbers of choices: each is read as the method is called today, and no choice is forgotten.
#[test]
fn choices_in_older_baselines_are_read_by_their_names() {
    let registry = registry();
    let mut seen = 0;
    for method in registry.methods() {
        for parameter in method.parameters {
            let Domain::Named(names) = parameter.domain else { continue };
            for place in 0..names.len() {
                let old = format!("{}={place}", parameter.name);
                let now = registry.parse(&format!("{}:{old}", method.name)).unwrap();
                let named = now.settings.written().find(|(name, _)| *name == parameter.name).map(|(name, value)| format!("{name}={value}"));
                assert_eq!(Some(calibench_records::spelling::present_settings(method.name, &old)), named, "{}", method.name);
                seen += 1;
            }
        }
    }
    assert!(seen > 40, "{seen}");
}
