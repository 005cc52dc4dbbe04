//! Plug-ins that are asked for boards: their answers by name, in a stream and by files, and answers that do not fit.

use super::with_plugins;
use crate::project::{run, stderr, stdout, table};

/// Answers with the true places of `control.csv`-like names it is told beforehand: it knows nothing of the image.
const STREAM: &str = r#"
import json, sys
way = json.loads(sys.stdin.buffer.readline())["parameters"]["way"]
print(json.dumps({"version": "7"}), flush=True)
for line in sys.stdin.buffer:
    asked = json.loads(line)
    sys.stdin.buffer.read(asked["bytes"])
    assert "starts" not in asked and asked["board"] == "charuco:10x7:38:26.6:DICT_4X4_50" and len(asked["names"]) == 54
    names, xy = asked["names"][:2], [[1.0, 2.0], [3.0, 4.0]]
    if way == 1: names = ["r1c1", "r99c1"]
    if way == 2: names = ["r1c1", "r1c1"]
    if way == 3: names = ["r1c1"]
    if way == 4: names = xy = []
    print(json.dumps({"image": asked["image"], "names": names, "xy": xy}), flush=True)
"#;

const FOLDER: &str = r#"
test "$CALIBENCH_BOARD" = "charuco:10x7:38:26.6:DICT_4X4_50" || exit 3
test ! -e points.csv || exit 4
printf 'image,target,x,y\n0001.png,r1c1,1,2\n0001.png,r6c9,3.5,4.5\n' > measured.csv
"#;

const TOML: &str = r#"
[[plugin]]
name = "board_py"
command = ["python3", "board.py"]
starts = "board"
boards = ["charuco"]
origin = "corner"
parameters = { way = { default = 0, min = 0, max = 9 } }

[[plugin]]
name = "board_sh"
command = ["sh", "board.sh"]
mode = "folder"
starts = "board"
"#;

fn project() -> tempfile::TempDir {
    with_plugins(&[("board.py", STREAM), ("board.sh", FOLDER), ("boards.toml", TOML)])
}

/// Rows of the first image of a method: target, position or reason.
fn rows(project: &tempfile::TempDir, method: &str) -> Vec<String> {
    let records = table(&project.path().join("records/targets/charuco/records.csv.gz"));
    let cells = records.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let first = cells.filter(|cells| cells[1] == "0" && cells[2] == "s01-r1" && cells[4].starts_with(method));
    first.map(|cells| format!("{} {} {} {}", cells[3], cells[6], cells[7], cells[14])).collect()
}

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn points_are_told_by_name_in_a_stream_and_by_files() {
    let project = project();
    let output = run(project.path(), &["run", "targets/charuco", "--trials", "1", "-m", "board_py", "-m", "board_sh"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let streamed = rows(&project, "board_py");
    assert_eq!(
        (streamed.len(), streamed[0].as_str(), streamed[1].as_str()),
        (54, "r1c1 0.5 1.5 ", "r1c2 2.5 3.5 "),
        "from the pixel's corner"
    );
    assert_eq!(streamed[2], "r1c3   not_detected");
    let filed = rows(&project, "board_sh");
    assert_eq!((filed[0].as_str(), filed[53].as_str()), ("r1c1 1 2 ", "r6c9 3.5 4.5 "));
    let counts = table(&project.path().join("records/targets/charuco/calibrations.csv.gz"));
    let count = |method: &str, what: &str| {
        let line =
            counts.lines().find(|line| line.contains(&format!(",{method},")) && line.contains(&format!("board/{what}/all"))).unwrap();
        line.split(',').nth(6).unwrap().parse::<f64>().unwrap()
    };
    assert_eq!(["targets", "labels", "labelled", "off"].map(|what| count("board_py", what)), [432.0, 16.0, 0.0, 16.0]);
}

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn answers_that_do_not_fit_reject_the_image_and_are_told() {
    let project = project();
    for (way, reason, told) in [
        (1, "malformed", "has no point `r99c1`"),
        (2, "malformed", "stands twice"),
        (3, "malformed", "`names` has 1 entries"),
        (4, "not_detected", ""),
    ] {
        let method = format!("board_py:way={way}");
        let output = run(project.path(), &["run", "targets/charuco", "--trials", "1", "-m", "detect", "-m", &method]);
        assert!(output.status.success() && stderr(&output).contains(told), "{way}: {}", stderr(&output));
        let rows = rows(&project, "board_py");
        assert!(rows.len() == 54 && rows.iter().all(|row| row.ends_with(reason)), "{way}: {}", rows[0]);
    }
}

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn a_test_of_the_plugin_finds_its_origin_wanting() {
    let project = project();
    let output = run(project.path(), &["plugin", "test", "methods/boards.toml"]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("FAILED  boards at 16 phases are found") && said.contains("board_py 7 ("), "{said}");
    let output = run(project.path(), &["run", "targets/rings", "--trials", "1", "-m", "board_py"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("it finds these alone: charuco"), "{}", stderr(&output));
}
