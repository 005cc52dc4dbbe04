//! Tests of acceptance as a user makes them: from measured points or lengths to a decision, in words, as JSON and as a picture.

use std::fmt::Write;
use std::path::Path;

use serde_json::Value;

use crate::calibrate::write;
use crate::project::{root, run, stderr, stdout};

/// Seven lines of five lengths, 200 to 1000, the measured ones longer by `error`, those of the last line by `last`.
pub fn lengths(error: f64, last: f64) -> String {
    let mut text = "line,from,to,calibrated,sigma,measured\n".to_owned();
    for place in 0..35 {
        let (line, length) = (place / 5 + 1, 200 * (place % 5 + 1));
        let measured = f64::from(length) + if line == 7 { last } else { error };
        writeln!(text, "{line},a,b{length},{length},0.004,{measured}").unwrap();
    }
    text
}

fn accept(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = run(folder, &[&["accept"][..], arguments].concat());
    (output.status.code(), stdout(&output) + &stderr(&output))
}

/// The example: the photographs give the points, the bars the scale, and the lengths are tested.
#[test]
fn photographs_of_seven_lines_are_accepted() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for name in ["points.csv", "scale.csv", "lengths.csv"] {
        std::fs::copy(root().join("examples/acceptance").join(name), here.join(name)).unwrap();
    }
    let calibrate = ["calibrate", "-q", "--points", "points.csv", "--distances", "scale.csv", "--size", "4032x3024", "--report", "report"];
    let calibrated = run(here, &calibrate);
    assert!(calibrated.status.success(), "{}", stderr(&calibrated));
    let usual = ["--lengths", "lengths.csv", "--measured", "report/points.csv", "--scale", "scale.csv", "--unit", "mm", "--limit"];
    let with = |more: &[&str]| accept(here, &[&usual[..], more].concat());
    let (code, words) = with(&["0.1,5e-5,0.2", "--plot", "errors.png"]);
    assert_eq!(code, Some(0), "{words}");
    assert!(words.starts_with("pass: all 35 tested lengths are within the limit 0.1 + 0.00005 L, at most 0.2 mm\n"), "{words}");
    assert!(words.contains("not checked against the standards' own text") && !words.contains("note:"), "{words}");
    assert!(std::fs::read(here.join("errors.png")).unwrap().starts_with(b"\x89PNG"));
    // Errors are those of the example, and as large as its network makes them: beyond a limit of 0.02, below one of 0.2.
    assert_eq!(with(&["0.02"]).0, Some(1));
    // Twice the volume is no longer suited by these lengths; tested bars are no test of the scale.
    let (code, words) = with(&["0.2", "--volume", "4000,4000,3000"]);
    assert!(code == Some(3) && words.contains("is 49.9 % of the volume's diagonal of 6403"), "{words}");
    write(here, "bars.csv", "target_a,target_b,distance,sigma\nL1F,L1A,3197.58,0.02\n");
    let (code, words) =
        accept(here, &["--lengths", "lengths.csv", "--measured", "report/points.csv", "--scale", "bars.csv", "--limit", "0.2"]);
    assert!(code == Some(3) && words.contains("note: 1 lengths gave the scale") && words.contains("6 measurement lines"), "{words}");
    // What the answer for programs says is what the words say.
    let json = run(here, &[&["accept"][..], &usual[..], &["0.1,5e-5,0.2", "--json"]].concat());
    let found: Value = serde_json::from_str(&stdout(&json)).unwrap();
    assert_eq!((found["decision"].as_str(), found["unit"].as_str()), (Some("pass"), Some("mm")));
    let all = found["lengths"]["lengths"].as_array().unwrap();
    assert!(
        all.len() == 35 && found["check_points"].is_null() && found["basis"].as_array().unwrap().iter().all(|one| one["checked"] == false)
    );
    for length in all {
        let number = |key: &str| length[key].as_f64().unwrap();
        assert!((number("measured") - number("calibrated") - number("error")).abs() < 1e-9 && number("error").abs() < number("limit"));
        assert!(number("error") != 0.0 && length["outcome"] == "pass", "{length}");
    }
}

#[test]
fn decisions_end_with_their_exit_codes() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for (name, error, last) in [("good.csv", 0.01, 0.01), ("near.csv", 0.01, 0.025), ("bad.csv", 0.01, 0.04)] {
        write(here, name, &lengths(error, last));
    }
    // Limit 0.03, standard uncertainty 0.004: 0.0234 passes still, 0.0366 fails. With U: 0.022 and 0.038. Without: 0.03.
    for (name, more, code, words) in [
        ("good.csv", &[][..], 0, "pass: all 35 tested lengths"),
        ("near.csv", &[], 3, "cannot tell: 5 of 35 tested lengths are too near the limit 0.03"),
        ("near.csv", &["--probability", "0.85"], 0, "decided at a probability of 85 %"),
        ("near.csv", &["--guard-band", "2"], 3, "with a guard band of 2 standard uncertainties"),
        ("near.csv", &["--guard-band", "0"], 0, "decided without the reference's uncertainty"),
        ("bad.csv", &[], 1, "fail: 5 of 35 tested lengths are beyond the limit 0.03"),
        ("bad.csv", &["--guard-band", "3"], 3, "cannot tell: 5 of 35"),
    ] {
        let (found, said) = accept(here, &[&["--lengths", name, "--limit", "0.03"], more].concat());
        assert!(found == Some(code) && said.contains(words), "{name} {more:?}: {found:?} {said}");
        assert!(said.contains("where the scale comes from is not stated") && said.contains("the measuring volume is not stated"), "{said}");
    }
    let rows: Vec<String> = lengths(0.0, 0.0).lines().take(35).map(str::to_owned).collect();
    write(here, "few.csv", &rows.join("\n"));
    let (code, said) = accept(here, &["--lengths", "few.csv", "--limit", "0.03"]);
    assert!(code == Some(3) && said.contains("not a whole test: 6 measurement lines have 5 tested lengths; expected 7"), "{said}");
    // Four-digit errors and their limits stand in a table.
    let (_, said) = accept(here, &["--lengths", "bad.csv", "--limit", "0.03"]);
    assert!(said.lines().any(|line| line.starts_with("| 7") && line.contains("+0.0400 | 0.0300 |") && line.contains("| fail")), "{said}");
}

#[test]
fn check_points_are_held_against_classes_with_their_survey() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let (mut survey, mut measured) = ("target,X,Y,Z,sX,sY,sZ\n".to_owned(), "target,X,Y,Z\n".to_owned());
    for place in 0..31 {
        let sign = if place % 2 == 0 { 1.0 } else { -1.0 };
        writeln!(survey, "p{place},{place},0,0,0.006,0.008,0.05").unwrap();
        if place < 30 {
            writeln!(measured, "p{place},{},{},{}", f64::from(place) + sign * 0.03, sign * 0.04, sign * 0.12).unwrap();
        }
    }
    write(here, "survey.csv", &survey);
    write(here, "measured.csv", &measured);
    let usual = ["--check-points", "survey.csv", "--measured", "measured.csv", "--unit", "m"];
    let with = |more: &[&str]| accept(here, &[&usual[..], more].concat());
    // By hand: 0.05 and 0.01 horizontal, 0.12 and 0.05 vertical, together 0.0510, 0.13 and 0.1396.
    let (code, said) = with(&["--horizontal", "0.052", "--vertical", "0.131", "--3d", "0.14"]);
    assert!(
        code == Some(0) && said.starts_with("pass: horizontal 0.0510 m (class 0.052), vertical 0.130 m (class 0.131), 3D 0.140 m"),
        "{said}"
    );
    assert!(said.contains("1 check points were not measured") && said.contains("not measured: p30"), "{said}");
    assert_eq!(with(&["--vertical", "0.125"]).0, Some(1));
    assert_eq!(with(&["--vertical", "0.125", "--survey", "0,0"]).0, Some(0));
    let (code, said) = with(&[]);
    assert!(code == Some(3) && said.starts_with("cannot tell: no class was asked for"), "{said}");
    write(here, "measured.csv", &measured.lines().take(30).collect::<Vec<_>>().join("\n"));
    let (code, said) = with(&["--vertical", "1"]);
    assert!(code == Some(3) && said.starts_with("cannot tell: 29 check points were measured; expected 30 at least"), "{said}");
    let json = run(here, &[&["accept"][..], &usual[..], &["--vertical", "1", "--json"]].concat());
    let found: Value = serde_json::from_str(&stdout(&json)).unwrap();
    assert!(json.status.code() == Some(3) && found["unmet"][0]["subject"] == "too-few" && found["lengths"].is_null(), "{found}");
    assert!((found["check_points"]["accuracies"][1]["of_points"].as_f64().unwrap() - 0.12).abs() < 1e-12);
}

#[test]
fn bad_input_is_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    write(here, "l.csv", "line,from,to,calibrated,sigma\n1,a,b,100,0\n");
    write(here, "c.csv", "target,X,Y,Z\na,1,2,3\n");
    write(here, "d.csv", "target,X,Y,Z\nb,1,2,3\n");
    let l = ["--lengths", "l.csv"];
    for (arguments, words) in [
        (&[][..], "--check-points"),
        (&l, "--limit"),
        (&[&l[..], &["--limit", "0.1"]].concat(), "l.csv: no length is measured; expected the column measured, or --measured"),
        (&[&l[..], &["--limit", "0,0"]].concat(), "found `0,0`; expected a limit that leaves room"),
        (&[&l[..], &["--limit", "-1"]].concat(), "found `-1`; expected A,K,B"),
        (&[&l[..], &["--limit", "1", "--volume", "1,2"]].concat(), "expected three positive sides"),
        (&[&l[..], &["--limit", "1", "--probability", "1"]].concat(), "expected a probability from 0.5 to below 1"),
        (&[&l[..], &["--limit", "1", "--guard-band", "-1"]].concat(), "expected a number of at least 0"),
        (&[&l[..], &["--limit", "1", "--guard-band", "1", "--probability", "0.9"]].concat(), "cannot be used with"),
        (&[&l[..], &["--limit", "1", "--vertical", "1"]].concat(), "cannot be used with"),
        (&["--check-points", "c.csv"], "--measured"),
        (&["--check-points", "c.csv", "--measured", "d.csv"], "c.csv: no check point has the name of a measured point"),
        (&["--check-points", "c.csv", "--measured", "d.csv", "--survey", "1"], "expected two numbers of at least 0"),
        (&["--check-points", "c.csv", "--measured", "d.csv", "--limit", "1"], "cannot be used with"),
        (&["--check-points", "l.csv", "--measured", "d.csv"], "l.csv:1"),
    ] {
        let (code, said) = accept(here, arguments);
        assert!(code == Some(2) && said.contains(words), "{arguments:?}: {code:?} {said}");
    }
}
