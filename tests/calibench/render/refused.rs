//! What cannot be pictured is refused by name, or is named in the truth.

use super::{BOARD, render, with_board};
use crate::project::{copy_with, run, stderr, stdout};

const FRONT: &str = "name = \"front\"";
const AT: &str = "at = [50, -40, 300]";
const TOWARDS: &str = "towards = [50, -40, 0]";
const CAMERA: &str = "size = [320, 240]\npitch = 10.0\nc = 3.2\nk1 = -0.01";
const SENSOR: &str = "full_well = 12000";

/// What of [`BOARD`] is replaced by what, and what is said.
const MISTAKES: &[(&str, &str, &[&str])] = &[
    (TOWARDS, "towards = [50, -40, 900]", &["mine.toml:16:8", "station `front` does not see the field: 0 of 20"]),
    (TOWARDS, "towards = [3000, -40, 0]", &["station `front` does not see the field"]),
    (AT, "at = [50, -40, -300]", &["station `front` does not see the field"]),
    (AT, "at = [50, -40, 0]", &["station `front`", "its pose is not determined"]),
    (AT, "at = [50, nan, 300]", &["mine.toml:17:6", "NaN"]),
    ("k1 = -0.01", "k1 = 0.5", &["station `front`: the distortion folds over 82 px from the image of the axis"]),
    ("k1 = -0.01", "k1 = nan", &["mine.toml:8:6", "NaN"]),
    ("c = 3.2", "c = -3.2", &["mine.toml:7:5", "0.001"]),
    ("c = 3.2", "", &["[camera] has no `c`"]),
    ("[320, 240]", "[100000, 100000]", &["mine.toml:5:8", "120 GB", "400 megapixels"]),
    ("[320, 240]", "[0, 240]", &["mine.toml:5:8"]),
    (CAMERA, "file = \"missing.toml\"", &["mine.toml:5:8", "missing.toml: No such file"]),
    (CAMERA, "file = \"scenarios\"", &["is a folder; expected a camera file"]),
    (CAMERA, "file = \"missing.toml\"\nk2 = 0.1", &["`file` beside an interior orientation"]),
    (CAMERA, "file = \"missing.toml\"\ny0 = 0.1", &["`file` beside an interior orientation"]),
    ("c = 3.2", "c = 3.2\nname = \"left\"", &["[camera] has a `name` and no `file`"]),
    ("blur = 0.6", "blur = 500", &["the blur is 500", "0.02 to 100 px"]),
    ("blur = 0.6", "blur = nan", &["mine.toml:20:8", "NaN"]),
    ("blur = 0.6", "defocus = 3", &["a defocus disc needs a Gaussian blur"]),
    ("blur = 0.6", "blur = 0.6\nmotion = { length = 8 }", &["mine.toml:21:10", "invalid type: a table, expected a list"]),
    ("square = 25", "square = 0", &["mine.toml:14:10"]),
    ("rows = 4", "rows = 100000", &["`rows` is 100000"]),
    ("unit = \"mm\"", "unit = \"furlong\"", &["furlong"]),
    ("\"chessboard\"", "\"chesboard\"", &["did you mean `chessboard`?"]),
    (SENSOR, "full_well = nan", &["mine.toml:22:13", "NaN"]),
    (SENSOR, "full_wel = 12000", &["did you mean `full_well`?"]),
    (FRONT, "name = \"../front\"", &["station `../front` is no plain file name"]),
    (FRONT, "name = \"a/b\"", &["station `a/b` is no plain file name"]),
    (FRONT, "name = \"stations\"", &["station `stations` has the name of another file"]),
    (FRONT, "name = \"a-noise-free\"", &["station `a-noise-free` has the name of another file"]),
    (
        "[[station]]",
        "[stations]\neach_trial = true\nkind = \"board\"\ntilts = [[0, 0]]\ndistances = [300]\n[[station]]",
        &["`each_trial` without"],
    ),
    ("[[station]]", "[stations]\neach_trial = true\n[[station]]", &["[stations] has no `kind`"]),
    (
        "[optics]",
        "[[station]]\nname = \"front\"\nat = [50, -40, 310]\ntowards = [50, -40, 0]\n[optics]",
        &["`front` stands here a second time"],
    ),
    ("[optics]", "[scene]\nwidth = 9\nheight = 9\nbackground = 0.5\n[optics]", &["more than one of [scene]"]),
];

#[test]
fn each_mistake_is_told_with_its_culprit_and_nothing_is_written() {
    let project = copy_with(&["testfields"]);
    for (old, new, parts) in MISTAKES {
        assert_eq!(BOARD.matches(old).count(), 1, "`{old}` stands once");
        std::fs::write(project.path().join("mine.toml"), BOARD.replace(old, new)).unwrap();
        let output = run(project.path(), &["render", "mine.toml", "-o", "out"]);
        // The picture breaks long lines.
        let said = stderr(&output).replace("│ ", "").split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(output.status.code(), Some(2), "{new}: {said}");
        for part in *parts {
            assert!(said.contains(part), "{new}: expected {part}\n{said}");
        }
        assert!(!said.contains("panicked") && !project.path().join("out").exists(), "{new}: {said}");
    }
}

#[test]
fn what_is_doubtful_is_named_in_the_truth() {
    for (old, new, warning) in
        [("blur = 0.6", "blur = 50", "blurred beyond its own size"), (AT, "at = [50, -40, 12000]", "smaller than a pixel")]
    {
        let project = with_board(old, new);
        let output = run(project.path(), &["render", "mine.toml", "-o", "out"]);
        assert!(output.status.success(), "{}", stderr(&output));
        assert!(stdout(&output).contains(&format!("front: 20 of 20 targets: {warning}")), "{}", stdout(&output));
        let truth = std::fs::read_to_string(project.path().join("out/front.csv")).unwrap();
        assert_eq!(truth.lines().filter(|line| line.ends_with(warning)).count(), 20, "{truth}");
    }
}

#[test]
fn a_folder_of_the_users_own_is_never_replaced() {
    let project = copy_with(&["testfields"]);
    let own = project.path().join("own");
    std::fs::create_dir(&own).unwrap();
    std::fs::write(own.join("thesis.txt"), "years of work").unwrap();
    for command in ["render", "print"] {
        for (place, expected) in [("own", "holds files that calibench did not write"), ("own/thesis.txt", "is a file; expected a folder")] {
            let output = run(project.path(), &[command, "testfields/house", "-o", place]);
            assert_eq!(output.status.code(), Some(2));
            assert!(stderr(&output).contains(expected), "{}", stderr(&output));
        }
        assert_eq!(std::fs::read_to_string(own.join("thesis.txt")).unwrap(), "years of work");
    }
    // A new folder, an empty one and one of calibench's own are filled.
    std::fs::create_dir(project.path().join("empty")).unwrap();
    render(project.path(), "testfields/house", "empty", &[]);
    let folder = render(project.path(), "testfields/house", "empty", &["--station", "side"]);
    assert!(folder.join("side.png").is_file() && !folder.join("front.png").exists());
}

#[test]
fn what_the_command_line_asks_for_must_be_there() {
    let project = copy_with(&["testfields"]);
    for (arguments, expected) in [
        (&["render", "testfields/house", "-o", "out", "--station", "back"][..], "no station is called `back`; expected one of front, side"),
        (&["render", "galo-2011/corners", "-o", "out", "--station", "front"], "no station is called `front`"),
        (&["render", "photographs/opencv-left", "-o", "out"], "nothing to render"),
        (&["print", "galo-2011/corners", "-o", "out"], "no testfield to print"),
        (&["render", "testfields/house", "-o", ".."], "expected the name of a folder"),
        (&["render", "testfields/hose", "-o", "out"], "did you mean `testfields/house`?"),
        (&["render", "testfields/house"], "--output"),
    ] {
        let output = run(project.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: expected {expected}\n{}", stderr(&output));
        assert!(!project.path().join("out").exists());
    }
}
