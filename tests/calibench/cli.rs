//! The command line as a user meets it.

use crate::project::{copy, root, run, stderr, stdout, table};

#[test]
fn lists_what_there_is() {
    let output = run(&root(), &["list", "scenarios"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stdout(&output).contains("galo-2011/corners\n") && stdout(&output).contains("photographs/opencv-left\n"));
    let methods = stdout(&run(&root(), &["list", "methods"]));
    for part in [
        "forstner (version",
        "harris_paraboloid",
        "opencv_subpix (version 4.",
        "opencv_chessboard_sb (version 4.",
        "window=11: side of the window, px; an odd number from 3 to 31",
    ] {
        assert!(methods.contains(part), "{part}\n{methods}");
    }
    assert!(stdout(&run(&root(), &["list", "tables"])).contains("galo-2011/table-1"));
}

#[test]
fn bad_input_exits_with_2_and_says_what_to_do() {
    let project = copy();
    let bad = project.path().join("bad.toml");
    std::fs::write(&bad, "why = 1\n").unwrap();
    let bad = bad.to_str().unwrap().to_owned();
    for (arguments, expected) in [
        (&["run", "galo-2011/cornrs"][..], "did you mean `galo-2011/corners`?"),
        (&["run", "corners", "corners/noise"], "asked for twice"),
        (&["run", &bad], "bad.toml:1:1"),
        (&["run", "missing.toml"], "missing.toml: No such file"),
        (&["run"], "required"),
        (&["run", "corners/noise", "-m", "forstner:windw=3"], "did you mean `window`?"),
        (&["run", "corners/noise", "-m", "forster"], "did you mean `forstner`?"),
        (&["run", "corners/noise", "-m", "forstner", "-m", "forstner:window=11"], "asked for twice"),
        (&["run", "corners/noise", "--trials", "0"], "0 is not in 1..=1000000"),
        (&["run", "galo-2011/corners", "--trials", "5"], "nothing is random"),
        (&["run", "corners/noise", "--seed", "-1"], "--seed"),
        (&["report", "galo"], "did you mean `galo-2011`?"),
        (&["report", "galo-2011"], "no scenario of `galo-2011` was run: `calibench run galo-2011` runs all "),
        (&["measure", "no.png", "--points", "no.csv"], "no.csv: No such file"),
        (&["detect", "no.png", "--chessboard", "9x6"], "no.png: No such file"),
        (&["detect", "no.png", "--chessboard", "9"], "expected inner corners as COLUMNSxROWS"),
        (&["list", "scenario"], "scenarios"),
        (&["--root", "nowhere", "list", "scenarios"], "--root nowhere: expected a folder"),
        (&["--threads", "0", "list", "scenarios"], "--threads"),
        (&["frobnicate"], "unrecognized subcommand"),
    ] {
        let output = run(project.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: expected {expected}\n{}", stderr(&output));
        assert!(!stderr(&output).contains("panicked"), "{arguments:?}");
    }
}

#[test]
fn outside_of_a_project_it_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["list", "scenarios"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--root DIR"), "{}", stderr(&output));
}

#[test]
fn show_prints_the_resolved_scenario_and_draws_it() {
    let project = copy();
    let output = run(project.path(), &["show", "galo-2011/corners"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let text = stdout(&output);
    let parsed: toml::Table = toml::from_str(&text).expect("the card is TOML");
    assert_eq!(parsed["scene"]["pixels"].as_str(), Some("area"));
    assert_eq!(
        parsed["method"].as_array().unwrap()[3]["sigma"].as_float().or(parsed["method"][3]["sigma"].as_integer().map(|i| i as f64)),
        Some(1.0)
    );
    assert!(text.contains("# target 1 (corner) at (22.5, 39.5), start (23, 40)"), "{text}");
    let preview = image::open(project.path().join("galo-2011-corners.png")).unwrap();
    assert!(preview.width() > 500);
}

#[test]
fn methods_trials_and_seed_can_be_changed() {
    let project = copy();
    let output = run(project.path(), &["run", "corners/noise", "-m", "pixel", "-m", "forstner:window=7", "--trials", "3", "--seed", "5"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let records = table(&project.path().join("records/corners/noise/records.csv.gz"));
    let first = records.lines().nth(1).unwrap();
    let own = |status: &str| first.contains(&format!(",px,{status},,5,"));
    assert!(first.starts_with("corners/noise,0,image,corner-90-at-0,pixel,1,") && (own("measured") || own("lost")), "{first}");
    // Header, and 3 trials of 8 targets with two methods.
    assert_eq!(records.lines().count(), 1 + 3 * 8 * 2);
    let numbers = |line: &str| line.split(',').skip(6).take(6).filter(|cell| !cell.is_empty()).count();
    let counts = |method: &str| records.lines().filter(|line| line.contains(method)).map(numbers).collect::<Vec<_>>();
    assert_eq!(counts(",pixel,"), vec![5; 24], "x, y, the truth of both and the bound");
    assert_eq!(counts(",forstner:window=7,"), vec![6; 24], "and its own standard deviation");
    assert!(records.contains("forstner:window=7") && !records.contains("harris"));
    let output = run(project.path(), &["run", "corners/noise", "--trials", "2", "--quiet"]);
    assert!(output.status.success() && stderr(&output).is_empty(), "{}", stderr(&output));
}

#[test]
fn a_file_of_ones_own_is_run_and_reported() {
    let project = copy();
    let own = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(project.path().join("scenarios/corners/noise.toml")).unwrap();
    let path = own.path().join("mine.toml");
    std::fs::write(&path, text.replace("trials = 200", "trials = 5")).unwrap();
    let output = run(project.path(), &["run", path.to_str().unwrap(), "--seed", "3"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let output = run(project.path(), &["report", "local"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let page = std::fs::read_to_string(project.path().join("reports/local/README.md")).unwrap();
    assert!(page.contains("Not the scenario as its file says: seed 3 in place of 20110513"), "{page}");
    assert!(page.contains("![The image with truth, approximate positions and the results of one method](mine.png)"), "{page}");
}

#[test]
fn a_very_long_image_is_shown_in_part() {
    let project = copy();
    let text = "why = \"A long strip.\"\nsource = \"a test\"\nseed = 1\n[scene]\nwidth = 60\nheight = 900000\nbackground = 0.5\n\
                [[scene.polygon]]\nid = \"a\"\ngrey = 0.1\nvertices = [[20, 20], [40, 20], [40, 40]]\n\
                [[scene.target]]\nid = \"1\"\nkind = \"corner\"\nat = [20, 20]\nstart = [21, 20]\n[[method]]\nname = \"pixel\"\n";
    std::fs::write(project.path().join("long.toml"), text).unwrap();
    let output = run(project.path(), &["show", "long.toml", "-o", "long.png"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(image::open(project.path().join("long.png")).unwrap().height() < 10_000);
}
