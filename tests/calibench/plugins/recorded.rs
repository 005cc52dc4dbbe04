//! A file of positions as a method: as exact as what measured them, and of no image but those that were measured.

use std::path::Path;
use std::process::Output;

use super::{notes, rows, versions, with_plugins};
use crate::project::{files, root, run, stderr, stdout, table};

/// The project with four rendered trials, their positions by `forstner` and the example that declares them.
fn project() -> tempfile::TempDir {
    let project = with_plugins(&[]);
    std::fs::copy(root().join("examples/plugins/recorded.toml"), project.path().join("methods/recorded.toml")).unwrap();
    let rendered = run(project.path(), &["render", "corners/noise", "--trials", "4", "-o", "pictures", "-q"]);
    assert!(rendered.status.success(), "{}", stderr(&rendered));
    let photos: Vec<String> = (0..4).map(|trial| format!("pictures/image-trial-{trial:04}.png")).collect();
    // As published: without the test for photographs.
    let measure = ["measure", "--points", "pictures/starts.csv", "-m", "forstner:significance=0", "-o", "methods/mine.csv", "-q"];
    let measured = run(project.path(), &[&measure[..], &photos.iter().map(String::as_str).collect::<Vec<_>>()].concat());
    assert!(measured.status.success(), "{}", stderr(&measured));
    project
}

fn measured(project: &Path, more: &[&str]) -> Output {
    run(project, &[&["run", "corners/noise", "--trials", "4", "-q", "-m", "forstner", "-m", "recorded"][..], more].concat())
}

/// Changes the file of positions.
fn edit(project: &Path, change: impl Fn(&str) -> String) {
    let path = project.join("methods/mine.csv");
    let text = std::fs::read_to_string(&path).unwrap();
    let changed = change(&text);
    assert_ne!(text, changed);
    std::fs::write(path, changed).unwrap();
}

/// Numbers are written with all their digits and the images have 8 bits: not one digit of a record differs.
#[test]
fn what_an_operator_measured_in_files_scores_as_the_operator() {
    let project = project();
    let output = measured(project.path(), &["--threads", "1"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let (own, file) = (rows(project.path(), "forstner"), rows(project.path(), "recorded"));
    assert!(own.len() == 32 && own == file, "{own:?}\n{file:?}");
    assert!(!notes(project.path()).contains("mine.csv"), "nothing is wrong with it");
    let version = versions(project.path(), "recorded");
    assert!(version.len() == 1 && version[0].starts_with("1 ("), "{version:?}");
    let tested = stdout(&run(project.path(), &["plugin", "test", "methods/recorded.toml"]));
    assert!(tested.contains("ok      its file") && tested.contains("32 positions in 4 images"), "{tested}");
    // Another seed, another scenario, more trials than were rendered.
    let other = measured(project.path(), &["--seed", "5"]);
    assert!(other.status.success() && rows(project.path(), "recorded")[0].contains("unavailable"), "{}", stderr(&other));
    assert!(stderr(&run(project.path(), &["run", "corners/noise", "--seed", "5", "-m", "recorded"])).contains("this run has the seed 5"));
    edit(project.path(), |text| text.replacen("measured,\n", "measured,\n\n", 1));
    let more = run(project.path(), &["run", "corners/noise", "--trials", "5", "-q", "-m", "forstner", "-m", "recorded", "--threads", "2"]);
    assert!(more.status.success());
    let file = rows(project.path(), "recorded");
    assert!(file[..32] == own && file[32..].iter().all(|row| row.contains("rejected,not_given")), "{file:?}");
    assert!(notes(project.path()).contains("no row of 1 of 5 images"), "{}", notes(project.path()));
    assert!(stderr(&more).contains("in trial 4 for one"), "{}", stderr(&more));
    assert_ne!(versions(project.path(), "recorded"), version, "a changed file");
}

#[test]
fn rows_that_are_swapped_missing_or_of_other_images_show() {
    let project = project();
    let two = |text: &str, change: &dyn Fn(&mut Vec<String>)| -> String {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        change(&mut lines);
        lines.join("\n") + "\n"
    };
    edit(project.path(), |text| two(text, &|lines| drop(lines.remove(3))));
    assert!(measured(project.path(), &[]).status.success());
    let (own, file) = (rows(project.path(), "forstner"), rows(project.path(), "recorded"));
    let different: Vec<&String> = own.iter().zip(&file).filter(|(a, b)| a != b).map(|(_, b)| b).collect();
    assert!(different.len() == 1 && different[0].contains("rejected,not_given"), "{different:?}");
    // The scenario was changed after the images were made.
    let scenario = project.path().join("scenarios/corners/noise.toml");
    let text = std::fs::read_to_string(&scenario).unwrap();
    std::fs::write(&scenario, text.replace("grey_noise = 0.02", "grey_noise = 0.021")).unwrap();
    assert!(measured(project.path(), &[]).status.success());
    assert!(rows(project.path(), "recorded").iter().all(|row| row.contains("rejected,other_image")));
    assert!(notes(project.path()).contains("4 of 4 images are not those that were rendered"), "{}", notes(project.path()));
}

#[test]
fn a_wrong_file_is_refused_with_its_line() {
    let project = project();
    let good = std::fs::read_to_string(project.path().join("methods/mine.csv")).unwrap();
    for (old, new, expected) in [
        ("image-trial-0002.png", "image-trial-02.png", "mine.csv:18, column `image`"),
        (
            "chess-at-15",
            "ches-at-15",
            "mine.csv:7, column `target`: no target of the scenario `corners/noise` is called `ches-at-15`; did you mean",
        ),
        ("corner-90-at-30", "corner-90-at-0", "mine.csv:3: target `corner-90-at-0`"),
    ] {
        assert!(good.contains(old));
        std::fs::write(project.path().join("methods/mine.csv"), good.replacen(old, new, 1)).unwrap();
        let output = measured(project.path(), &[]);
        assert_eq!(output.status.code(), Some(2), "{new}");
        assert!(stderr(&output).contains(expected), "{expected}\n{}", stderr(&output));
    }
    std::fs::write(project.path().join("methods/mine.csv"), &good).unwrap();
    let arguments = ["measure", "pictures/image-trial-0000.png", "--points", "pictures/starts.csv", "-m", "recorded"];
    let output = run(project.path(), &arguments);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("a file of positions measures nothing"), "{}", stderr(&output));
}

/// The trials of one folder are those that are rendered one by one, and stations of each trial have their own truth.
#[test]
fn trials_are_rendered_together_as_they_are_alone() {
    let project = with_plugins(&[]);
    let render = |arguments: &[&str]| {
        let output = run(project.path(), &[&["render", "corners/noise", "-q"][..], arguments].concat());
        assert!(output.status.success(), "{}", stderr(&output));
    };
    render(&["--trials", "3", "-o", "all"]);
    render(&["--trial", "2", "-o", "one"]);
    let [all, one] = ["all", "one"].map(|folder| files(&project.path().join(folder)));
    let bytes = |files: &[(std::path::PathBuf, Vec<u8>)], name: &str| {
        files.iter().find(|(path, _)| path == Path::new(name)).unwrap_or_else(|| panic!("{name}")).1.clone()
    };
    assert!(bytes(&all, "image-trial-0002.png") == bytes(&one, "image.png"));
    let text = |files: &[_], name: &str| String::from_utf8(bytes(files, name)).unwrap();
    assert_eq!(text(&all, "image-trial-0002.csv").replace("-trial-0002", ""), text(&one, "image.csv"));
    let of_one = |all: String| all.lines().filter(|line| line.contains("0002")).collect::<Vec<_>>().join("\n").replace("-trial-0002", "");
    for name in ["starts.csv", "rendered.csv"] {
        let own = text(&one, name);
        assert_eq!(of_one(text(&all, name)), own.split_once('\n').unwrap().1.trim_end(), "{name}");
    }
    let refused = run(project.path(), &["render", "galo-2011/corners", "--trials", "2", "-o", "none"]);
    assert!(refused.status.code() == Some(2) && stderr(&refused).contains("nothing is random"), "{}", stderr(&refused));
}

const PHOTOGRAPHS: &str = r#"
why = "Three photographs."
source = "a test"
seed = 0

[photographs]
folder = "opencv-left"
files = ["left01.jpg", "left02.jpg", "left03.jpg"]
board = "9x6"

[[method]]
name = "forstner"
"#;

/// Photographs and corners are known by their names.
#[cfg_attr(
    not(photographs),
    ignore = "the photographs left01.jpg to left14.jpg are absent: docs/scenarios.md says where they are looked for"
)]
#[test]
fn photographs_of_a_scenario_have_files_of_positions_too() {
    let toml = "[[method]]\nname = \"recorded\"\nfile = \"mine.csv\"\nphotographs = \"photographs/few\"\n";
    let project = with_plugins(&[("recorded.toml", toml)]);
    std::fs::write(project.path().join("scenarios/photographs/few.toml"), PHOTOGRAPHS).unwrap();
    let positions = |method: &str| -> Vec<String> {
        let records = table(&project.path().join("records/photographs/few/records.csv.gz"));
        let cells = records.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let own = cells.filter(|cells| cells[4].split(':').next() == Some(method));
        own.map(|cells| [&cells[2..4], &cells[6..8]].concat().join(",")).collect()
    };
    assert!(run(project.path(), &["run", "photographs/few", "-q"]).status.success());
    let own = positions("forstner");
    std::fs::write(project.path().join("methods/mine.csv"), format!("image,target,x,y\n{}\n", own.join("\n"))).unwrap();
    let output = run(project.path(), &["run", "photographs/few", "-q", "-m", "recorded"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(own.len() == 3 * 54 && positions("recorded") == own);
    std::fs::write(project.path().join("methods/mine.csv"), "image,target,x,y\nleft04.jpg,r1c1,3,4\n").unwrap();
    let output = run(project.path(), &["run", "photographs/few", "-q", "-m", "recorded"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("no photograph of"), "{}", stderr(&output));
}
