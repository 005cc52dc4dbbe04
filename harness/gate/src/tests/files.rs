//! Baselines and ceilings as files.

use std::fs;
use std::path::Path;

use super::{info, point, rejected, table};
use crate::{Ceilings, Coordinates, Table, baseline_path, read_baseline, write_baseline};

fn example(coordinates: Coordinates) -> Table {
    let first = vec![point(0, "b", [0.1, -1e-12]), point(0, "a", [1.0 / 3.0, 2.5]), rejected(1, "a")];
    table(coordinates, &[info("m:w=1,k=2", "1"), info("a", "2")], &[first, vec![point(0, "a", [-0.5, 0.25])]])
}

#[test]
fn a_baseline_is_read_as_it_was_written_and_written_as_it_was_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = baseline_path(folder.path(), "f/s");
    assert_eq!(path.file_name().unwrap(), "f--s.csv");
    for coordinates in [Coordinates::Errors, Coordinates::Positions] {
        let table = example(coordinates);
        write_baseline(&path, &table).unwrap();
        let bytes = fs::read(&path).unwrap();
        let again = read_baseline(&path, "f/s").unwrap().unwrap();
        assert!(again.methods().eq(table.methods()));
        assert_eq!((again.seed, again.coordinates, again.trials()), (7, coordinates, 2));
        write_baseline(&path, &again).unwrap();
        assert_eq!(fs::read(&path).unwrap(), bytes);
    }
}

#[test]
fn the_rows_are_sorted_and_have_nine_decimals() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.csv");
    write_baseline(&path, &example(Coordinates::Errors)).unwrap();
    let expected = "method,version,seed,trial,view,target,status,reason,dx,dy\n\
                    a,2,7,0,image,a,rejected,no_corner,,\n\
                    \"m:w=1,k=2\",1,7,0,image,a,lost,,0.333333333,2.500000000\n\
                    \"m:w=1,k=2\",1,7,0,image,b,measured,,0.100000000,0.000000000\n\
                    \"m:w=1,k=2\",1,7,1,image,a,measured,,-0.500000000,0.250000000\n";
    assert_eq!(fs::read_to_string(&path).unwrap(), expected);
}

#[test]
fn mistakes_in_a_baseline_have_a_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.csv");
    assert!(read_baseline(&path, "f/s").unwrap().is_none());
    let header = "method,version,seed,trial,view,target,status,reason,dx,dy\n";
    let good = "m,1,7,0,v,t,measured,,0.1,0.2\n";
    for (rows, expected) in [
        ("m,1,7,0,v,t,measured,,0.1,x\n", "b.csv: line 2, column `dy`: found `x`"),
        (&format!("{good}m,1,7,0,v,t,measured,,0.1,0.2\n"), "line 3, column `target`: found `t`, the point is there twice"),
        (&format!("{good}m,2,7,0,v,u,measured,,0.1,0.2\n"), "line 3, column `version`"),
        (&format!("{good}m,1,8,0,v,u,measured,,0.1,0.2\n"), "line 3, column `seed`"),
        ("m,1,7,0,v,t,rejected,bored,,\n", "column `reason`: found `bored`"),
        ("m,1,7,0,v,t,fine,,0.1,0.2\n", "column `status`"),
        ("m,1,7,0,v\n", "line 2, column `all`"),
    ] {
        fs::write(&path, format!("{header}{rows}")).unwrap();
        let error = read_baseline(&path, "f/s").unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    fs::write(&path, "a,b\n").unwrap();
    assert!(read_baseline(&path, "f/s").unwrap_err().to_string().contains("line 1, column `all`: expected the columns"));
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
    assert!(Ceilings::read(Path::new("/nowhere/ceilings.toml")).unwrap().list.is_empty());
}
