//! A folder of baselines: what is compared with it, and what a blessing writes.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::{NO_CORNER, holding, lost, measured, method};
use crate::{
    Baselines, Cells, Check, Coordinates, Entry, FigureSums, IndexError, Kept, Measured, MethodTable, Numbers, PointSums, Results, Table,
    Verdicts,
};
use calibench_records::figures::Quantity;

fn points(dx: f64) -> Table {
    holding(Coordinates::Errors, method((0..20).map(|trial| (trial, "a", measured([dx, 0.0], None)))))
}

fn figures(value: f64) -> Cells<FigureSums> {
    let mut method = MethodTable::new("1".into());
    method.figures.insert((0, Quantity::Parameter.of(&["c"])), [(0, Numbers { value, sigma: None, error: None })].into());
    let mut cells = Cells::new("f/s", "", 7, Coordinates::Errors);
    cells.add("", &holding(Coordinates::Errors, method));
    cells
}

fn sums(dx: f64) -> Cells<PointSums> {
    let mut cells = Cells::new("f/w", "", 7, Coordinates::Errors);
    cells.add("x", &points(dx));
    cells
}

/// A scenario with figures and a sweep; both lie at `dx`.
fn today(dx: f64) -> [Results; 2] {
    let of =
        |scenario: &str, measured, figures| Results { scenario: scenario.into(), deterministic: true, measured, figures, images: None };
    [of("f/s", Measured::Points(points(dx)), Some(figures(dx))), of("f/w", Measured::Sums(sums(dx)), None)]
}

fn words(word: &str) -> Verdicts {
    Verdicts([(["p/table-1".to_owned(), "1".to_owned(), "x".to_owned()], word.to_owned())].into())
}

fn bless(folder: &Path, all: &[Results], mut verdicts: Verdicts) -> String {
    let baselines = Baselines::open_or_new(folder).unwrap();
    let gone = baselines.gone(all, &verdicts, true).unwrap();
    let mut changes: Vec<_> = all.iter().flat_map(|one| baselines.changes(one)).collect();
    changes.extend(baselines.changed_verdicts(&mut verdicts, true));
    let news = changes.iter().map(|change| change.news.as_str()).collect();
    let mut written = 0;
    baselines.bless(&changes, &gone, &mut |path| written += usize::from(path.is_file())).unwrap();
    assert_eq!(written, changes.len());
    news
}

/// Messages of what a check of `all` finds.
fn found(folder: &Path, all: &[Results], verdicts: &Verdicts, whole: bool) -> Vec<String> {
    let (baselines, mut check) = (Baselines::open(folder).unwrap(), Check::new());
    all.iter().for_each(|one| baselines.compare(one, &mut check));
    baselines.compare_verdicts(verdicts, whole, &mut check);
    baselines.vanished(all, &[], &mut check).unwrap();
    check.conclude().into_iter().map(|finding| format!("{}: {}", finding.scenario, finding.message)).collect()
}

#[test]
fn what_was_blessed_is_compared_and_nothing_else_is_green() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path().join("baselines");
    assert!(matches!(Baselines::open(&folder), Err(IndexError::Missing(_))));
    let news = bless(&folder, &today(0.1), words("reproduces"));
    let expected = [
        "f/s: new baseline, 20 measured, 0 lost, 0 rejected",
        "f/s: new baseline of 1 points or figures in 1 cells",
        "f/w: new baseline of 20 points or figures in 1 cells",
        "published tables: verdicts of 1 cells",
    ];
    assert_eq!(news.lines().collect::<Vec<_>>(), expected);
    assert_eq!(found(&folder, &today(0.1), &words("reproduces"), true), Vec::<String>::new());
    assert_eq!(bless(&folder, &today(0.1), words("reproduces")), "", "nothing has changed");

    let worse = found(&folder, &today(0.2), &words("differs"), true);
    for what in ["f/s: ", "f/w@x: ", "p/table-1: "] {
        assert!(worse.iter().any(|finding| finding.starts_with(what)), "{what}: {worse:?}");
    }
    let mut other = words("reproduces");
    other.0.insert(["q/table-1".to_owned(), "1".to_owned(), "x".to_owned()], "differs".to_owned());
    bless(&folder, &today(0.1), other);
    assert_eq!(found(&folder, &today(0.1), &words("reproduces"), false), Vec::<String>::new(), "the other table was not asked for");
    assert_eq!(found(&folder, &today(0.1), &words("reproduces"), true).len(), 1, "its verdict is gone");

    let news = bless(&folder, &today(0.2), words("differs"));
    assert!(news.contains("f/s: gets worse:\n") && news.contains("f/w: gets worse:\n"), "{news}");
    assert!(news.contains("\n    p/table-1 ") || news.contains("published tables: verdicts of 1 cells\n    "), "{news}");
    assert_eq!(found(&folder, &today(0.2), &words("differs"), true), Vec::<String>::new());
}

#[test]
fn what_is_not_blessed_what_is_gone_and_what_was_tampered_with_are_named() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    bless(folder, &[], words("reproduces"));
    let none = found(folder, &today(0.1), &words("reproduces"), true);
    let unblessed = |what: &str| assert!(none.iter().any(|finding| finding.contains(what)), "{what}: {none:?}");
    ["not blessed yet: 1 cells", "figures of adjustments: not blessed yet", "not blessed"].into_iter().for_each(unblessed);

    bless(folder, &today(0.1), words("reproduces"));
    let without = |all: [Results; 2]| all.map(|one| Results { figures: None, ..one });
    let found_now = found(folder, &without(today(0.1)), &words("reproduces"), true);
    assert_eq!(found_now, ["f/s: there are no figures of adjustments any more"]);
    let absent = today(0.1).map(|one| Results { measured: Measured::NotCompared("unavailable: x".into()), figures: None, ..one });
    assert_eq!(
        found(folder, &absent, &words("reproduces"), true),
        ["f/s: not compared: unavailable: x", "f/w: not compared: unavailable: x"]
    );
    let gone = Baselines::open(folder).unwrap().gone(&absent, &words("reproduces"), true).unwrap();
    assert_eq!(gone, Vec::<std::path::PathBuf>::new(), "not compared is not gone");
    assert!(absent.iter().all(|one| one.table().is_none()) && today(0.1)[0].table().is_some());

    let [_, sweep] = today(0.1);
    let gone = found(folder, &[sweep], &words("reproduces"), true);
    assert!(gone.len() == 2 && gone.iter().all(|finding| finding.contains("the scenario is gone")), "{gone:?}");
    for copy in ["x--y.csv", "f--w.csv"] {
        fs::copy(folder.join("f--s.csv"), folder.join(copy)).unwrap();
    }
    fs::write(folder.join("notes.csv"), "kept by somebody\n").unwrap();
    let found_now = found(folder, &today(0.1), &words("reproduces"), true);
    assert!(found_now.iter().any(|finding| finding.starts_with("x/y: there is no such scenario")), "{found_now:?}");
    assert!(found_now.iter().any(|finding| finding.starts_with("f/w: ")), "{found_now:?}");
    assert!(!found_now.iter().any(|finding| finding.contains("notes")), "{found_now:?}");
    // A file that is not as it was blessed is replaced as if there were none.
    let news = bless(folder, &today(0.1), words("reproduces"));
    assert_eq!(news, "f/w: new baseline of 20 points or figures in 1 cells\n");
    let [_, sweep] = today(0.1);
    bless(folder, &[sweep], words("reproduces"));
    assert!(!folder.join("f--s.csv").exists() && !folder.join("f--s.figures.csv").exists());
    assert!(!folder.join("x--y.csv").exists() && folder.join("notes.csv").exists(), "only what a blessing wrote goes");
}

/// What is blessed passes the strictest check, whatever it is.
#[test]
fn a_blessing_leaves_what_a_check_accepts() {
    let nan = f64::NAN;
    let entries = [measured([0.1, 0.2], Some(123.456_789_1)), measured([nan, 0.1], Some(nan)), lost([5e8, nan]), NO_CORNER];
    let numbers = [[1e9, 0.0], [nan, 1.0], [f64::INFINITY, f64::INFINITY], [-1e-300, 1e-300]];
    let mut kinds = vec![("empty", MethodTable::new("1".into()))];
    let named = |entries: &[Entry]| method(entries.iter().enumerate().flat_map(|(i, entry)| (0..3).map(move |t| (t, NAMES[i], *entry))));
    kinds.push(("points", named(&entries)));
    kinds.push(("rejected alone", named(&[NO_CORNER])));
    let mut adjusted = named(&entries[..1]);
    adjusted.images = named(&entries).points;
    for (place, [value, sigma]) in numbers.into_iter().enumerate() {
        let numbers = Numbers { value, sigma: Some(sigma), error: Some(value) };
        adjusted.figures.insert((place, Quantity::Parameter.of(&["c"])), (0..3).map(|trial| (trial, numbers)).collect());
    }
    kinds.push(("adjusted", adjusted.clone()));
    kinds.push(("figures alone", MethodTable { points: BTreeMap::default(), images: BTreeMap::default(), ..adjusted }));
    for coordinates in [Coordinates::Errors, Coordinates::Positions] {
        for (what, method) in &kinds {
            let folder = tempfile::tempdir().unwrap();
            let table = holding(coordinates, method.clone());
            let all = || [swept(&table, false), swept(&table, true)];
            bless(folder.path(), &all(), Verdicts::default());
            assert_eq!(found(folder.path(), &all(), &Verdicts::default(), true), Vec::<String>::new(), "{what}, {coordinates:?}");
            // What made a file and does not any more is blessed away, also by itself.
            let bare = holding(coordinates, named(&entries[..1]));
            let one = [swept(&bare, false)];
            let baselines = Baselines::open(folder.path()).unwrap();
            let (changes, gone) = (baselines.changes(&one[0]), baselines.gone(&one, &Verdicts::default(), false).unwrap());
            let baselines = Baselines::open(folder.path()).unwrap();
            baselines.bless(&changes, &gone, &mut |_| ()).unwrap();
            let [_, sweep] = all();
            drop(changes);
            let [one] = one;
            assert_eq!(found(folder.path(), &[one, sweep], &Verdicts::default(), true), Vec::<String>::new(), "{what}, {coordinates:?}");
        }
    }
    // Verdicts of which none is left.
    let folder = tempfile::tempdir().unwrap();
    bless(folder.path(), &today(0.1), words("reproduces"));
    bless(folder.path(), &today(0.1), Verdicts::default());
    assert_eq!(found(folder.path(), &today(0.1), &Verdicts::default(), true), Vec::<String>::new());
    assert!(folder.path().join(crate::CEILINGS).is_file(), "a check asks for it");
}

const NAMES: [&str; 4] = ["a", "b", "c", "d"];

/// The run of `table` as a scenario, or as one that is `swept` with it in both cells.
fn swept(table: &Table, swept: bool) -> Results {
    let name = if swept { "f/w" } else { "f/s" };
    let labels: &[&str] = if swept { &["x=1", "x=2"] } else { &[""] };
    let measured = if swept { Measured::Sums(cells(name, table, labels)) } else { Measured::Points(table.clone()) };
    let (figures, images) = (cells(name, table, labels), cells(name, table, labels));
    Results {
        scenario: name.into(),
        deterministic: false,
        measured,
        figures: (!figures.is_empty()).then_some(figures),
        images: (!images.is_empty()).then_some(images),
    }
}

fn cells<T: Kept>(name: &str, table: &Table, labels: &[&str]) -> Cells<T> {
    let mut cells = Cells::new(name, "", 7, table.coordinates);
    labels.iter().for_each(|label| cells.add(label, table));
    cells
}
