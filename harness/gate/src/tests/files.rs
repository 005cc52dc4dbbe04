//! Baselines and ceilings as files.

use std::fs;
use std::path::Path;

use calibench_records::results::PointResult;

use super::{info, point, rejected, table};
use crate::{Ceilings, Coordinates, Table, baseline_path, fingerprint, read_baseline, write_baseline};

fn example(coordinates: Coordinates) -> Table {
    let first = vec![
        PointResult { predicted: Some(0.012_345_67), ..point(0, "b", [0.1, -1e-12]) },
        point(0, "a", [1.0 / 3.0, 2.5]),
        rejected(1, "a"),
    ];
    table(coordinates, &[info("m:w=1,k=2", "1"), info("a", "2")], &[first, vec![point(0, "a", [-0.5, 0.25])]])
}

#[test]
fn a_baseline_is_read_as_it_was_written_and_written_as_it_was_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = baseline_path(folder.path(), "f/s");
    assert_eq!(path.file_name().unwrap(), "f--s.csv");
    for coordinates in [Coordinates::Errors, Coordinates::Positions] {
        let mut table = example(coordinates);
        table.text = fingerprint("why = 1");
        table.describe("a", "w=1,k=2".into(), "OpenCV 4.6.0".into());
        let sum = write_baseline(&path, &table).unwrap();
        let bytes = fs::read(&path).unwrap();
        let (again, checksum) = read_baseline(&path, "f/s").unwrap().unwrap();
        assert!(again.methods().eq(table.methods()) && checksum == sum);
        assert_eq!((again.seed, again.coordinates, again.trials(), &again.text), (7, coordinates, 2, &table.text));
        write_baseline(&path, &again).unwrap();
        assert_eq!(fs::read(&path).unwrap(), bytes);
    }
}

/// Before choices had names they were numbers, in labels and in settings; the rows name their method by its place.
#[test]
fn a_baseline_of_0_2_0_is_that_of_todays_method() {
    let folder = tempfile::tempdir().unwrap();
    let path = baseline_path(folder.path(), "f/s");
    let trials = [vec![point(0, "a", [0.5, 0.25])]];
    let mut old = table(Coordinates::Errors, &[info("lsm:window=13,neighbours=0", "2")], &trials);
    old.describe("lsm:window=13,neighbours=0", "window=13,shape=2,neighbours=0".into(), String::new());
    write_baseline(&path, &old).unwrap();
    let mut now = table(Coordinates::Errors, &[info("lsm:window=13,neighbours=counted", "2")], &trials);
    now.describe("lsm:window=13,neighbours=counted", "window=13,shape=chess_corner,neighbours=counted".into(), String::new());
    assert!(read_baseline(&path, "f/s").unwrap().unwrap().0.methods().eq(now.methods()));

    let ceiling =
        "[[ceiling]]\nscenario = 'f/s'\nmethod = 'lsm:window=13,neighbours=0'\nmetric = 'max_error'\nat_most = 0.1\nwhy = 'a test'\n";
    let found = Ceilings::parse("c.toml", ceiling).unwrap().check(&[&now]);
    assert!(found.len() == 1 && found[0].now == Some(0.5_f64.hypot(0.25)), "{found:?}");
}

#[test]
fn the_rows_are_sorted_and_have_their_decimals() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.csv");
    write_baseline(&path, &example(Coordinates::Errors)).unwrap();
    let expected = "method,trial,view,target,status,reason,dx,dy,sigma\n\
                    1,0,image,a,rejected,no_corner,,,\n\
                    2,0,image,a,lost,,0.333333333,2.500000000,\n\
                    2,0,image,b,measured,,0.100000000,0.000000000,0.0123457\n\
                    2,1,image,a,measured,,-0.500000000,0.250000000,\n";
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("# Blessed numbers of calibench") && text.ends_with(expected), "{text}");
    assert!(text.contains("# label = \"m:w=1,k=2\"\n# version = \"1\"\n# settings = \"\"\n# library = \"\"\n# rows = 3\n"), "{text}");
}

/// What reading the example says after `change` went over its text.
fn damaged(change: impl Fn(&str) -> String) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.csv");
    write_baseline(&path, &example(Coordinates::Errors)).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let changed = change(&text);
    assert_ne!(text, changed);
    fs::write(&path, changed).unwrap();
    read_baseline(&path, "f/s").unwrap_err().to_string()
}

#[test]
fn what_was_cut_or_edited_is_said() {
    for (damage, old, new, expected) in [
        ("a digit", "0.333333333", "0.333333334", "was edited after it was blessed"),
        ("a fingerprint", "seed = \"7\"", "seed = \"8\"", "was edited after it was blessed"),
        ("a word", "measured", "mesured", "column `status`: found `mesured`, expected measured, lost or rejected"),
        ("a number", "2.500000000", "x", "column `dy`: found `x`, expected a number"),
        ("a method", "\n2,1,", "\n3,1,", "column `method`: found `3`, expected 1 to 2"),
        ("a point twice", "\n2,1,image,a,measured,,", "\n2,0,image,b,measured,,", "the point is there twice"),
        ("a column", "dx,dy,sigma", "dx,dy", "expected the columns"),
        ("the scenario", "f/s", "f/t", "is the baseline of `f/t`, expected that of `f/s`"),
        ("a key", "# seed", "# sed", "its head means nothing (unknown field `sed`"),
    ] {
        let message = damaged(|text| text.replacen(old, new, 1));
        assert!(message.contains(expected), "{damage}: {message}");
    }
    let cut = |lines: usize| damaged(|text| text.lines().take(text.lines().count() - lines).map(|line| format!("{line}\n")).collect());
    assert!(cut(1).contains("3 rows are there, its head says 4: rows were cut or added"), "{}", cut(1));
    assert!(damaged(|text| text.trim_end().trim_end_matches(',').trim_end_matches('0').to_owned()).contains("edited"));
    assert!(damaged(|text| text.lines().skip(1).collect::<Vec<_>>().join("\n")).contains("has no head with fingerprints"));
    assert!(read_baseline(Path::new("/nowhere/b.csv"), "f/s").unwrap().is_none());
}

#[test]
fn line_ends_of_another_system_are_no_edit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.csv");
    write_baseline(&path, &example(Coordinates::Errors)).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace('\n', "\r\n")).unwrap();
    assert!(read_baseline(&path, "f/s").is_ok());
    assert_eq!(fingerprint("a\nb\n"), fingerprint("a\r\nb"));
    assert_ne!(fingerprint("a\nb"), fingerprint("ab"));
}

fn ceiling(metric: &str, at_most: &str) -> String {
    format!("[[ceiling]]\nscenario = \"f/s\"\nmethod = \"m:w=1,k=2\"\nmetric = \"{metric}\"\nat_most = {at_most}\nwhy = \"so\"\n")
}

#[test]
fn ceilings_are_held_against_the_run() {
    let run = example(Coordinates::Errors);
    // Two points are kept, one of three is lost.
    let rmse = f64::midpoint(0.01, 0.3125).sqrt();
    for (metric, value) in [("rmse_xy", rmse), ("lost_share", 1.0 / 3.0), ("rejected_share", 0.0), ("max_error", 2.5_f64.hypot(1.0 / 3.0))]
    {
        let holds = Ceilings::parse("c", &ceiling(metric, &format!("{:.7}", value + 1e-6))).unwrap();
        assert!(holds.check(&[&run]).is_empty(), "{metric}");
        if value > 0.0 {
            let breaks = Ceilings::parse("c", &ceiling(metric, &format!("{:.7}", value - 1e-6))).unwrap();
            let findings = breaks.check(&[&run]);
            assert!(findings[0].fails() && findings[0].metric == metric && findings[0].method == "m:w=1,k=2");
        }
    }
}

#[test]
fn a_ceiling_that_cannot_be_held_against_anything_fails() {
    let ceilings = Ceilings::parse("c", &ceiling("rmse_xy", "1.0")).unwrap();
    let message = |runs: &[&Table]| ceilings.check(runs)[0].message.clone();
    assert!(message(&[]).contains("the scenario was not run"));
    assert!(message(&[&table(Coordinates::Errors, &[], &[])]).contains("the method was not run"));
    assert!(message(&[&example(Coordinates::Positions)]).contains("no such figure"));
    let mut absent = info("m:w=1,k=2", "1");
    absent.unavailable = Some("not built".into());
    assert!(message(&[&table(Coordinates::Errors, &[absent], &[])]).contains("unavailable: not built"));
}

#[test]
fn mistakes_in_ceilings_have_a_place() {
    let error = |text: &str| Ceilings::parse("c.toml", text).unwrap_err().to_string();
    assert!(
        error(&(ceiling("rmse_xy", "1.0") + "colour = 1\n")).starts_with("c.toml:7:1: unknown field `colour`"),
        "{}",
        error(&(ceiling("rmse_xy", "1.0") + "colour = 1\n"))
    );
    assert!(error(&ceiling("rmse", "1.0")).contains("c.toml:4:10: unknown variant `rmse`"));
    assert!(error(&ceiling("rmse_xy", "-1.0")).contains("expected a number that is not negative"));
    assert!(error("[[ceilings]]\n").contains("c.toml:1:3: unknown field `ceilings`"));
    assert!(Ceilings::read(Path::new("/nowhere/ceilings.toml")).unwrap_err().to_string().contains("there is no such file"));
}
