//! Sweeps: mistakes have places, cells are the plain scenario and independent of each other, plots hold the scores.

use std::path::Path;

use calibench_measure::Registry;
use calibench_records::stored;
use calibench_report::sweep::{Choice, Layout, LayoutError, LoadedSweep, Metric, load, write_numbers};
use calibench_scenario::{parse, parse_cell};

use crate::project::{copy, files, program, run, stderr, table};

const BASE: &str = r#"why = "To see what a sweep does."
source = "a test"
seed = 7
trials = 3

SWEEP
[scene]
width = 80
height = 70
background = 0.8
grey_noise = 0.02
phase = "uniform"

[scene.pointing]
sigma = 0.3
whole_pixels = true

[[scene.polygon]]
id = "a"
grey = 0.2
vertices = [[20, 20], [60, 20], [60, 50], [20, 50]]

[[scene.target]]
id = "1"
kind = "corner"
at = [20, 20]

[[scene.target]]
id = "2"
kind = "corner"
at = [60, 50]

[optics]
blur = 0.6

[[method]]
name = "pixel"

[[method]]
name = "forstner"
window = 9
"#;

fn text(sweep: &str) -> String {
    BASE.replace("SWEEP", sweep)
}

/// A scenario whose `[sweep]` has these lines: three trials of two targets, two methods.
pub fn swept(lines: &str) -> String {
    text(&format!("[sweep]\n{lines}\n"))
}

fn diagnostics(lines: &str) -> String {
    match parse("family/test", "test.toml", &swept(lines), &Registry::builtin()) {
        Ok(_) => panic!("accepted: {lines}"),
        Err(problems) => problems.to_string(),
    }
}

#[test]
fn each_mistake_in_a_sweep_is_one_diagnostic_with_its_place() {
    // [sweep] is line 6.
    let cases: &[(&str, &str, &[&str])] = &[
        ("", "6:2", &["[sweep] has no key"]),
        ("\"optics.blurr\" = [1, 2]", "7:1", &["unknown key `blurr` in [optics]", "did you mean `blur`"]),
        ("\"optcs.blur\" = [1, 2]", "7:1", &["unknown key `optcs`", "did you mean `optics`"]),
        ("\"method.windw\" = [7, 9]", "7:1", &["no method of the scenario has a parameter `windw`", "did you mean `window`"]),
        ("\"method.forstnr.window\" = [7, 9]", "7:1", &["called `forstnr`", "did you mean `forstner`"]),
        ("\"scene.polygon.9.grey\" = [0.1, 0.2]", "7:1", &["names no key of the file"]),
        ("\"optics.blur\" = 1", "7:17", &["has one value", "a list of values or a range"]),
        ("\"optics.blur\" = []", "7:17", &["has no value"]),
        ("\"optics.blur\" = [0.5, 1, 0.50]", "7:26", &["listed twice"]),
        ("\"optics.blur\" = [0.5, -1]", "7:23", &["number from 0", "found -1", "in the cell blur=-1"]),
        ("\"method.window\" = [7, 8]", "7:23", &["odd"]),
        ("\"scene.polygon.a.vertices\" = [[[20, 20], [60, 20],\n [60, \"x\"]]]", "8:7", &["string \"x\"", "a number"]),
        ("\"optics.blur\" = { from = 0, to = 3, count = 4, scale = \"log\" }", "7:26", &["ends above 0"]),
        ("\"optics.blur\" = { from = 1, to = 1, count = 4 }", "7:34", &["ends where it begins"]),
        ("\"optics.blur\" = { from = 1, to = 2, cont = 4 }", "7:37", &["unknown key `cont` in the range", "did you mean `count`"]),
        ("\"optics.blur\" = { from = 1, to = 2, count = 999 }\nseed = { from = 1, to = 999, count = 999 }", "6:2", &["998001 cells"]),
        ("optics.blur = [1, 2]\n\"optics.blur\" = [3]", "7:8", &["swept by", "too"]),
    ];
    for (lines, place, parts) in cases {
        let found = diagnostics(lines);
        assert!(found.starts_with(&format!("test.toml:{place}: ")), "{lines}\n{found}\nexpected {place}");
        for part in *parts {
            assert!(found.contains(part), "{lines}\n{found}\nlacks `{part}`");
        }
    }
    let odd = diagnostics("\"method.window\" = [8, 7, 9]");
    assert_eq!(odd.lines().count(), 1, "{odd}");
}

#[test]
fn the_grid_is_the_product_and_methods_are_named_without_what_is_swept() {
    let lines =
        "\"optics.blur\" = { from = 0.25, to = 4, count = 5, scale = \"log\" }\nmethod.window = [7, 11]\nscene.polygon.a.grey = [0.1]";
    let scenario = parse("family/test", "test.toml", &swept(lines), &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"));
    let sweep = scenario.sweep.as_ref().unwrap();
    assert_eq!((sweep.cells(), sweep.label(3)), (10, "blur=0.5, window=11, grey=0.1".into()));
    let cell = parse_cell(&scenario, sweep, 3, &Registry::builtin()).unwrap();
    let labels: Vec<&str> = cell.methods.iter().map(|method| method.label.as_str()).collect();
    assert_eq!(labels, ["pixel", "forstner:window=11"]);
    assert!(sweep.axes[0].log && cell.sweep.is_none());
}

/// A project whose scenario `t/s` has this text, run with `extra` arguments.
fn project(text: &str, extra: &[&str]) -> tempfile::TempDir {
    let project = copy();
    std::fs::create_dir_all(project.path().join("scenarios/t")).unwrap();
    std::fs::write(project.path().join("scenarios/t/s.toml"), text).unwrap();
    let output = run(project.path(), &[&["run", "t/s", "--quiet"], extra].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    project
}

/// The rows of a records file without its first column, the scenario's name.
fn rows(project: &Path, file: &str) -> Vec<Vec<String>> {
    let mut csv = csv::Reader::from_reader(stored::open(&project.join("records/t/s").join(file)).unwrap());
    csv.records().map(|row| row.unwrap().iter().skip(1).map(str::to_owned).collect()).collect()
}

#[test]
fn a_cell_is_the_plain_scenario_with_its_values_whichever_other_cells_there_are() {
    let many = project(&swept("\"optics.blur\" = [0.3, 0.9, 1.5]\n\"method.window\" = [7, 11]"), &[]);
    let few = project(&swept("\"method.window\" = [11, 5]\n\"optics.blur\" = [0.9]"), &[]);
    let plain = project(&text("").replace("blur = 0.6", "blur = 0.9").replace("window = 9", "window = 11"), &[]);
    let expected = rows(plain.path(), "records.csv.gz");
    assert_eq!(expected.len(), 3 * 2 * 2, "trials, targets, methods");
    assert!(rows(many.path(), "cell-0004/records.csv.gz") == expected);
    assert!(rows(few.path(), "cell-0001/records.csv.gz") == expected);
    assert!(rows(many.path(), "cell-0003/records.csv.gz") != expected);
    let head = table(&many.path().join("records/t/s/cell-0004/records.csv.gz"));
    assert!(head.contains("\"t/s@blur=0.9, window=11\""), "records carry the values of the cell");
}

#[test]
fn a_cell_in_which_nothing_is_random_is_run_once() {
    let fixed = text("[sweep]\n\"scene.grey_noise\" = [0, 0.02]\n")
        .replace("phase = \"uniform\"", "")
        .replace("[scene.pointing]\nsigma = 0.3\nwhole_pixels = true\n", "");
    let fixed = fixed
        .replace("at = [20, 20]\n", "at = [20, 20]\nstart = [20, 21]\n")
        .replace("at = [60, 50]\n", "at = [60, 50]\nstart = [60, 50]\n");
    let project = project(&fixed, &["--trials", "4"]);
    let trials = |file| rows(project.path(), file).iter().map(|row| row[0].clone()).collect::<std::collections::BTreeSet<_>>().len();
    assert_eq!((trials("cell-0001/records.csv.gz"), trials("cell-0002/records.csv.gz")), (1, 4));
}

fn loaded(project: &Path) -> LoadedSweep {
    load(&project.join("records"), "t/s").unwrap().unwrap()
}

#[test]
fn plots_hold_the_scores_and_their_numbers_stand_beside_them() {
    let project = project(&swept("\"optics.blur\" = [0.3, 0.9, 1.5]\n\"scene.grey_noise\" = [0.01, 0.04]"), &[]);
    let sweep = loaded(project.path());
    for (name, arguments) in [
        ("curves", &["--x", "blur", "--y", "rmse", "--by", "method"][..]),
        ("noise", &["--x", "grey_noise", "--y", "bias", "--by", "optics.blur", "-m", "forstner"]),
        ("map", &["--map", "grey_noise", "--y", "scatter"]),
        ("held", &["--y", "lost", "--at", "grey_noise=0.04"]),
        ("bound", &["--y", "ratio", "--facet", "method", "--by", "grey_noise"]),
    ] {
        let picture = format!("{name}.png");
        let output = run(project.path(), &[&["plot", "t/s", "-o", &picture], arguments].concat());
        assert!(output.status.success(), "{name}: {}", stderr(&output));
        let image = image::open(project.path().join(&picture)).unwrap();
        assert!(image.width() > 400 && image.to_luma8().pixels().any(|pixel| pixel.0[0] < 60), "{name}");
        let mut csv = csv::Reader::from_path(project.path().join(format!("{name}.csv"))).unwrap();
        let found: Vec<csv::StringRecord> = csv.records().map(Result::unwrap).collect();
        assert!(found.len() >= 6, "{name}: {}", found.len());
        for row in &found {
            let cell = (0..sweep.sweep.cells.len()).find(|&cell| sweep.sweep.values(cell).iter().zip(row).all(|(v, text)| v.text == text));
            let method = sweep.methods.iter().position(|method| method.name == row[2]).unwrap();
            let score = sweep.score(cell.unwrap(), method).unwrap();
            let metric = [Metric::Rmse, Metric::Bias, Metric::Scatter, Metric::Lost, Metric::Ratio];
            let metric = metric.into_iter().find(|metric| metric.name().0 == &row[3]).unwrap();
            let expected = metric.of(score).map_or(String::new(), |found| found.value.to_string());
            assert_eq!((&row[5], &row[8], &row[9]), (expected.as_str(), score.points().to_string().as_str(), "3"), "{name}");
        }
    }
    let report = run(project.path(), &["report", "t", "--quiet"]);
    assert!(report.status.success(), "{}", stderr(&report));
    let page = std::fs::read_to_string(project.path().join("reports/t/README.md")).unwrap();
    assert!(page.contains("![RMSE over optics.blur by method](s.png)") && page.contains("| 0.3 "), "{page}");
    assert!(project.path().join("reports/t/s.png").is_file());
}

#[test]
fn what_a_plot_cannot_show_is_said() {
    let project =
        project(&swept("\"optics.blur\" = [0.3, 0.9]\n\"scene.grey_noise\" = [0.01, 0.04]\nscene.polygon.a.grey = [0.1, 0.3]"), &[]);
    let sweep = loaded(project.path());
    let layout = |choice: Choice| Layout::new(&sweep, &choice, Metric::Rmse, false);
    let name = |name: &str| Some(name.to_owned());
    assert!(matches!(layout(Choice::default()), Err(LayoutError::Left(names, _)) if names == "`grey_noise` and `grey`"));
    assert!(
        matches!(layout(Choice { x: name("blr"), ..Choice::default() }), Err(LayoutError::Unknown { proposal: Some(near), .. }) if near == "blur")
    );
    assert!(matches!(layout(Choice { x: name("method"), ..Choice::default() }), Err(LayoutError::MethodOnAxis)));
    assert!(matches!(layout(Choice { facet: name("blur"), ..Choice::default() }), Err(LayoutError::Twice(_))));
    let at = vec![("grey".to_owned(), "0.2".to_owned())];
    assert!(matches!(layout(Choice { at, ..Choice::default() }), Err(LayoutError::NoValue { .. })));
    let at = vec![("grey".to_owned(), "0.30".to_owned())];
    let held = layout(Choice { at, ..Choice::default() }).unwrap();
    let mut bytes = Vec::new();
    write_numbers(&mut bytes, &sweep, &held).unwrap();
    let csv = String::from_utf8(bytes).unwrap();
    assert_eq!((csv.lines().count(), csv.matches(",0.3,").count()), (1 + 8, 8), "all at grey 0.3\n{csv}");
    let plain = run(project.path(), &["plot", "corners/noise"]);
    assert!(!plain.status.success() && stderr(&plain).contains("has no [sweep]"));
}

#[test]
fn the_same_seed_writes_the_same_bytes_on_any_number_of_threads() {
    let project = project(&swept("\"optics.blur\" = [0.3, 0.9]"), &[]);
    let first = files(&project.path().join("records"));
    for threads in ["1", "2"] {
        let status = program(project.path()).args(["run", "t/s", "--quiet", "--threads", threads]).status().unwrap();
        assert!(status.success());
        assert!(files(&project.path().join("records")) == first, "{threads} threads");
    }
}
