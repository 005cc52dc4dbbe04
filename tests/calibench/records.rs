//! `calibench records`: what a run left is printed as it is stored, and plainly.

use crate::project::{copy, run, stderr, stdout, table};
use crate::sweeps::swept;

#[test]
fn records_are_printed_as_they_are_stored() {
    let project = copy();
    std::fs::create_dir_all(project.path().join("scenarios/t")).unwrap();
    std::fs::write(project.path().join("scenarios/t/s.toml"), swept("\"optics.blur\" = [0.5, 0.9]")).unwrap();
    let done = run(project.path(), &["run", "t/s", "-m", "forstner:window=9"]);
    assert!(done.status.success(), "{}", stderr(&done));
    let print = |arguments: &[&str]| {
        let printed = run(project.path(), &[&["records"], arguments].concat());
        assert!(printed.status.success(), "{arguments:?}: {}", stderr(&printed));
        stdout(&printed)
    };
    let whole = print(&["t/s", "--csv"]);
    let part = print(&["t/s", "--csv", "--at", "blur=0.9"]);
    let rows = |text: &str| text.lines().skip(1).map(str::to_owned).collect::<Vec<_>>();
    // Three trials of two targets by one method, in two cells and in one.
    assert_eq!((rows(&whole).len(), rows(&part).len()), (12, 6));
    assert_eq!(rows(&whole)[6..], rows(&part));
    let cells = std::fs::read_dir(project.path().join("records/t/s")).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = cells.map(|cell| cell.join("records.csv.gz")).filter(|file| file.is_file()).collect();
    files.sort();
    assert_eq!(files.iter().flat_map(|file| rows(&table(file))).collect::<Vec<_>>(), rows(&whole));
    assert_eq!(print(&[files[1].to_str().unwrap(), "--csv"]), part);
    // Plainly: what is the same in all rows once, and every number as it is in the CSV.
    let plain = print(&["t/s", "--at", "blur=0.9"]);
    assert_eq!(plain.matches("forstner:window=9").count(), 1, "{plain}");
    let mut csv = csv::Reader::from_reader(part.as_bytes());
    let x = csv.headers().unwrap().iter().position(|name| name == "x").unwrap();
    for row in csv.records() {
        let row = row.unwrap();
        assert!(plain.contains(&row[x]), "{}: {plain}", &row[x]);
    }
}

#[test]
fn what_is_not_there_is_said() {
    let project = copy();
    let refused = |arguments: &[&str], part: &str| {
        let printed = run(project.path(), &[&["records"], arguments].concat());
        assert_eq!(printed.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&printed).contains(part) && stdout(&printed).is_empty(), "{arguments:?}: {}", stderr(&printed));
    };
    refused(&["galo-2011/corners"], "no records of `galo-2011/corners`: run it first");
    refused(&["galo-2011/cornrs"], "galo-2011/corners");
    let done = run(project.path(), &["run", "galo-2011/corners"]);
    assert!(done.status.success(), "{}", stderr(&done));
    refused(&["galo-2011/corners", "--table", "adjustments"], "the run adjusts nothing");
    refused(&["galo-2011/corners", "--at", "blur=1"], "these records are not of a sweep");
}
