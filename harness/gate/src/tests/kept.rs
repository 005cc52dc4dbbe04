//! What files keep of runs, cell by cell and figure by figure.

use std::fs;

use super::{NO_CORNER, holding, info, lost, measured, method, table};
use crate::{
    CeilingError, CeilingMetric, Ceilings, Cells, Coordinates, Entry, Found, Index, IndexError, Kept, MethodTable, PointSums, Table,
    Verdict, Verdicts, read_baseline, write_baseline,
};
use calibench_model::{Measurement, PixelPoint, Rejection};
use calibench_records::figures::{FigureName, Group, Quantity};
use calibench_records::results::{Calibrated, Figure, PointResult, Trial};

fn kept(dx: f64) -> Entry {
    measured([dx, 0.0], None)
}

fn errors(points: impl IntoIterator<Item = (u64, &'static str, Entry)>) -> Table {
    holding(Coordinates::Errors, method(points))
}

#[test]
fn sums_are_rows_of_counts_means_and_covariances() {
    let at = |x: f64, y: f64| measured([x, y], Some(0.5));
    let nan = lost([f64::NAN, 0.0]);
    let sums = PointSums::of(&method([(0, "a", at(0.1, 0.3)), (1, "a", at(0.3, -0.1)), (2, "a", nan), (0, "b", NO_CORNER)]));
    let rows: Vec<String> = sums.rows().iter().map(|row| row.join(",")).collect();
    assert_eq!(rows[0], format!(",{},,,,,,,,,,", sums.digest));
    // Deviations (-0.1, 0.2) and (0.1, -0.2).
    assert_eq!(rows[1], "a,,2,1,0,0.20000000,0.10000000,1.000000e-2,-2.000000e-2,4.000000e-2,0.5000000,1");
    assert_eq!(rows[2], "b,,0,0,1,,,,,,,", "nothing is measured, so nothing has a mean");
    assert_eq!((rows.len(), sums.count()), (3, 4));
    assert!(sums.rows().iter().all(|row| row.len() == PointSums::COLUMNS.len()));
}

#[test]
fn sums_with_and_without_points_are_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.csv");
    let nan = lost([f64::NAN, 0.0]);
    let mut cells: Cells<PointSums> = Cells::new("f/s", "text", 7, Coordinates::Positions);
    let points = [(0, "a", measured([0.125, 0.25], Some(0.5))), (1, "a", nan), (0, "b", NO_CORNER)];
    for label in ["x", "y"] {
        cells.add(label, &holding(Coordinates::Positions, method(points)));
    }
    let sum = cells.write(&path).unwrap();
    let (again, checksum) = Cells::<PointSums>::read(&path, "f/s").unwrap().unwrap();
    assert!(again == cells && checksum == sum);
    assert_eq!((again.len(), again.counts(), again.is_empty()), (2, [2, 6], false));
    let text = fs::read_to_string(&path).unwrap();
    let says = |old: &str, new: &str, expected: &str| {
        assert!(text.contains(old), "{old}: {text}");
        fs::write(&path, text.replacen(old, new, 1)).unwrap();
        let found = Cells::<PointSums>::read(&path, "f/s").err().unwrap().to_string();
        assert!(found.contains(expected), "{found}");
    };
    says("\n1,1,b,", "\n1,1,a,", "column `target`: found `a`, the target is there twice");
    says("\n1,1,a,", "\n3,1,a,", "column `cell`: found `3`, expected 1 to 2");
    says("\n1,1,a,", "\n0,1,a,", "column `cell`: found `0`, expected 1 to 2");
    says("\n1,1,a,", "\n1,2,a,", "column `method`: found `2`, expected 1 to 1");
    says("seed = \"7\"", "seed = \"x\"", "its head says seed x, expected a whole number");
    says("0.12500000", "0.12600000", "was edited after it was blessed");
    says("format = 2", "format = 1", "its head says format 1 and Sums, expected 2 and Sums");
    says("kind = \"sums\"", "kind = \"points\"", "its head says format 2 and Points, expected 2 and Sums");
    fs::write(&path, &text).unwrap();
    let other = Cells::<PointSums>::read(&path, "f/t").err().unwrap().to_string();
    assert!(other.contains("is the baseline of `f/s`, expected that of `f/t`"), "{other}");
    assert!(Cells::<PointSums>::read(&folder.path().join("none.csv"), "f/s").unwrap().is_none());
}

#[test]
fn mistakes_have_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.csv");
    write_baseline(&path, &errors([(0, "a", kept(0.125)), (1, "a", kept(0.25)), (2, "a", kept(0.5))])).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let wrong = text.replace("0.250000000", "x");
    let line = 1 + wrong.lines().position(|line| line.contains(",x,")).unwrap();
    fs::write(&path, &wrong).unwrap();
    let found = read_baseline(&path, "f/s").unwrap_err().to_string();
    assert!(found.contains(&format!("line {line}, column `dx`: found `x`, expected a number")), "{line}: {found}");
    // A mark that never ends, and columns that are others.
    let header = 1 + text.lines().position(|line| line.starts_with("method,")).unwrap();
    fs::write(&path, text.replace("method,trial", "method,trail")).unwrap();
    let found = read_baseline(&path, "f/s").unwrap_err().to_string();
    assert!(found.contains(&format!("line {header}, column `all`: expected the columns method,trial,")), "{header}: {found}");
    let mut bytes = text.clone().into_bytes();
    bytes.extend(b"1,3,image,\xff,measured,,0,0,\n");
    fs::write(&path, bytes).unwrap();
    assert!(read_baseline(&path, "f/s").unwrap_err().to_string().contains("is no text"));
    assert!(read_baseline(folder.path(), "f/s").is_err(), "a folder is no file");
}

#[test]
fn every_reason_and_status_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.csv");
    let reasons = (0..).zip(Rejection::ALL).map(|(trial, why)| (trial, "r", Entry::Rejected(why)));
    let rest = [(0, "a", Entry::Lost(Found { at: [1.5, f64::NAN], sigma: Some(0.5) })), (1, "a", measured([0.125, -0.25], None))];
    let all = method(reasons.chain(rest));
    write_baseline(&path, &holding(Coordinates::Errors, all.clone())).unwrap();
    let (again, _) = read_baseline(&path, "f/s").unwrap().unwrap();
    let again = again.method("m").unwrap();
    assert_eq!(again.points.len(), all.points.len());
    assert_eq!(again.counts(), [1, 1, Rejection::ALL.len()]);
    for (place, entry) in &all.points {
        assert_eq!(format!("{:?}", again.points[place]), format!("{entry:?}"));
    }
}

#[test]
fn methods_that_were_not_there_are_not_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.csv");
    let mut table = errors([(0, "a", kept(0.125))]);
    let mut absent = method([(0, "a", kept(0.5))]);
    absent.unavailable = Some("not built".into());
    *table.method_mut(&"n".into(), &"1".into()) = absent;
    write_baseline(&path, &table).unwrap();
    let (again, _) = read_baseline(&path, "f/s").unwrap().unwrap();
    assert_eq!(again.methods().map(|(label, _)| label.to_string()).collect::<Vec<_>>(), ["m"]);
    let mut cells: Cells<PointSums> = Cells::new("f/s", "", 7, Coordinates::Errors);
    assert!(cells.is_empty());
    cells.add("", &table);
    assert_eq!((cells.counts(), cells.is_empty()), ([1, 1], false));
    let mut none: Cells<PointSums> = Cells::new("f/s", "", 7, Coordinates::Errors);
    none.add("", &errors([]));
    assert!(none.is_empty() && none.len() == 1, "a method without a point");
}

/// Cells `x` and `y` with an error of 0.1 and of `dx`; text, seed, and the method's version, parameters and library.
fn cells(dx: f64, text: &str, seed: u64, [version, settings, library]: [&str; 3]) -> Cells<PointSums> {
    let mut cells = Cells::new("f/s", text, seed, Coordinates::Errors);
    for (label, dx) in [("x", 0.1), ("y", dx)] {
        let mut method = method([(0, "a", kept(dx))]);
        (method.version, method.settings, method.library) = (version.into(), settings.into(), library.into());
        cells.add(label, &holding(Coordinates::Errors, method));
    }
    cells
}

#[test]
fn cells_are_compared_with_what_identifies_them() {
    let plain = ["1", "k=1", "A"];
    let found = |old: &Cells<PointSums>, new: &Cells<PointSums>| {
        old.compare(new).into_iter().map(|f| (f.verdict, f.scenario, f.metric)).collect::<Vec<_>>()
    };
    let whole = |verdict, metric| vec![(verdict, "f/s".to_owned(), metric)];
    let base = cells(0.1, "t", 7, plain);
    assert_eq!(found(&base, &base), []);
    assert_eq!(found(&base, &cells(0.1, "t", 8, plain)), whole(Verdict::Fails, "seed"));
    assert_eq!(found(&base, &cells(0.1, "u", 7, plain)), whole(Verdict::Changed, "scenario"));
    for (old, new) in [("", "u"), ("t", ""), ("t", "t")] {
        assert_eq!(found(&cells(0.1, old, 7, plain), &cells(0.1, new, 7, plain)), [], "{old} {new}");
    }
    assert_eq!(found(&base, &cells(0.1, "t", 7, ["2", "k=1", "A"])), whole(Verdict::Changed, "version"));
    assert_eq!(found(&base, &cells(0.1, "t", 7, ["2", "k=1", "B"])), whole(Verdict::Informs, "version"));
    assert_eq!(found(&base, &cells(0.1, "t", 7, ["1", "k=2", "A"])), whole(Verdict::Changed, "parameters"));
    for (old, new) in [("", "k=2"), ("k=1", "")] {
        assert_eq!(found(&cells(0.1, "t", 7, ["1", old, "A"]), &cells(0.1, "t", 7, ["1", new, "A"])), [], "{old} {new}");
    }
    // An error that is smaller in one cell: a change, for information if another library made it; with another text it fails.
    let smaller = |library, text| found(&base, &cells(0.05, text, 7, ["1", "k=1", library]));
    assert_eq!(smaller("A", "t"), [(Verdict::Changed, "f/s@y".to_owned(), "digest")]);
    assert_eq!(smaller("B", "t"), [(Verdict::Informs, "f/s@y".to_owned(), "digest")]);
    let edited = [(Verdict::Changed, "f/s@y".to_owned(), "digest"), (Verdict::Fails, "f/s".to_owned(), "scenario")];
    assert_eq!(smaller("A", "u"), edited);
    let larger = found(&base, &cells(0.2, "t", 7, ["1", "k=1", "B"]));
    assert!(larger.iter().any(|(verdict, _, metric)| (*verdict, *metric) == (Verdict::Fails, "rms_error")), "worse is worse: {larger:?}");
}

/// Debian's own linear algebra and another one end elsewhere; the same one must not.
#[test]
fn what_a_solver_makes_of_another_linear_algebra_informs() {
    let with = |dx: f64, lapack: &str| {
        let mut cells: Cells<PointSums> = Cells::new("f/s", "", 7, Coordinates::Errors);
        let version = format!("1, opencv_subpix:window=11 4.6.0, calibrateCamera 4.6.0 with {lapack}");
        let points = method([(0, "a", kept(dx))]).points;
        cells.add("x", &holding(Coordinates::Errors, MethodTable { points, ..MethodTable::new(version.into()) }));
        cells
    };
    let found = |a: &Cells<PointSums>, b: &Cells<PointSums>| a.compare(b).into_iter().map(|f| (f.verdict, f.metric)).collect::<Vec<_>>();
    let base = with(0.1, "lapack/liblapack.so.3.11.0");
    assert_eq!(found(&base, &with(0.099, "lapack/liblapack.so.3.11.0")), [(Verdict::Changed, "digest")]);
    let other = found(&base, &with(0.099, "openblas-pthread/liblapack.so.3"));
    assert!(other.contains(&(Verdict::Informs, "digest")) && other.iter().all(|(verdict, _)| *verdict == Verdict::Informs), "{other:?}");
}

#[test]
fn a_method_that_is_new_in_a_cell_is_not_blessed() {
    let with = |second: bool| {
        let mut cells: Cells<PointSums> = Cells::new("f/s", "", 7, Coordinates::Errors);
        for (label, more) in [("x", true), ("y", second)] {
            let mut table = errors([(0, "a", kept(0.1))]);
            if more {
                *table.method_mut(&"n".into(), &"1".into()) = method([(0, "a", kept(0.1))]);
            }
            cells.add(label, &table);
        }
        cells
    };
    let found =
        |old: bool, new: bool| with(old).compare(&with(new)).into_iter().map(|f| (f.verdict, f.scenario, f.method)).collect::<Vec<_>>();
    assert_eq!(found(false, true), [(Verdict::Unblessed, "f/s@y".to_owned(), "n".to_owned())]);
    assert_eq!(found(true, false), [(Verdict::Fails, "f/s@y".to_owned(), "n".to_owned())]);
    assert_eq!(with(true).values().count(), 4);
}

fn figure(coordinates: Coordinates, metric: CeilingMetric, points: &[(u64, &'static str, Entry)]) -> Option<f64> {
    metric.figure(coordinates, &method(points.iter().copied()))
}

#[test]
fn figures_under_ceilings_by_hand() {
    use CeilingMetric::{LostShare, MaxError, RejectedShare, RmseXy};
    let away = lost([1.2, 1.6]);
    let points = [(0, "a", measured([0.3, 0.4], None)), (0, "b", measured([0.0, -0.1], None)), (0, "c", away), (0, "d", NO_CORNER)];
    let of = |metric| figure(Coordinates::Errors, metric, &points).unwrap();
    assert!((of(RmseXy) - 0.13_f64.sqrt()).abs() < 1e-12 && (of(MaxError) - 2.0).abs() < 1e-12);
    assert_eq!((of(LostShare), of(RejectedShare)), (0.25, 0.25));
    let all = [RmseXy, LostShare, RejectedShare, MaxError];
    assert_eq!(all.map(|metric| figure(Coordinates::Positions, metric, &points)), [None, None, Some(0.25), None]);
    assert_eq!(all.map(|metric| figure(Coordinates::Errors, metric, &[])), [None; 4]);
    assert_eq!(all.map(|metric| figure(Coordinates::Errors, metric, &points[3..])), [None, Some(0.0), Some(1.0), None]);
    assert_eq!(figure(Coordinates::Errors, MaxError, &[points[0], (1, "a", lost([f64::NAN, 0.0]))]), Some(f64::INFINITY));
    assert_eq!(all.map(CeilingMetric::name), ["rmse_xy", "lost_share", "rejected_share", "max_error"]);
}

fn ceiling(at_most: &str, why: &str) -> String {
    format!("[[ceiling]]\nscenario = \"f/s\"\nmethod = \"m\"\nmetric = \"max_error\"\nat_most = {at_most}\nwhy = \"{why}\"\n")
}

#[test]
fn what_is_at_its_ceiling_is_not_above_it() {
    let run = errors([(0, "a", measured([0.5, 0.0], None))]);
    let check = |at_most: &str| Ceilings::parse("c", &ceiling(at_most, " so ")).unwrap().check(&[&errors([]), &run][1..]);
    assert!(check("0.5").is_empty() && check("0.6").is_empty());
    let above = check("0.25");
    assert_eq!((above.len(), above[0].baseline, above[0].now), (1, Some(0.25), Some(0.5)));
    assert_eq!(above[0].message, "above its ceiling (so)");
    let unheld = Ceilings::parse("c", &ceiling("0.25", "so")).unwrap().check(&[]);
    assert_eq!((unheld[0].baseline, unheld[0].now), (Some(0.25), None));
    for (at_most, why, said) in [("inf", "so", "`at_most` is inf"), ("nan", "so", "`at_most` is NaN"), ("1.0", " ", "`why` is empty")] {
        assert!(Ceilings::parse("c", &ceiling(at_most, why)).unwrap_err().to_string().contains(said), "{at_most}");
    }
    assert_eq!(Ceilings::parse("c", &ceiling("0", "so")).unwrap().list[0].at_most, 0.0);
}

#[test]
fn ceilings_are_read_from_their_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ceilings.toml");
    fs::write(&path, ceiling("0.5", "so")).unwrap();
    assert_eq!(Ceilings::read(&path).unwrap(), Ceilings::parse("c", &ceiling("0.5", "so")).unwrap());
    fs::write(&path, "").unwrap();
    assert_eq!(Ceilings::read(&path).unwrap(), Ceilings::default());
    fs::write(&path, "x").unwrap();
    assert!(matches!(Ceilings::read(&path), Err(CeilingError::Problems(_))));
    assert!(matches!(Ceilings::read(folder.path()), Err(CeilingError::File { .. })), "a folder is no file");
    assert!(matches!(Ceilings::read(&folder.path().join("none")), Err(CeilingError::Missing(_))));
}

fn adjusted(set: usize, figures: Vec<Figure>) -> Calibrated {
    Calibrated { method: 0, set, outcome: Ok(figures), check_failed: None }
}

fn entries(adjusted: Vec<Calibrated>) -> MethodTable {
    let mut table = table(Coordinates::Errors, &[info("m", "1")], &[]);
    table.add(&Trial { number: 3, calibrations: adjusted, ..Trial::default() });
    table.method("m").unwrap().clone()
}

/// What a detector found is judged point by point, and by what it missed and mistook; of an adjustment the points are not.
#[test]
fn counts_of_detections_stand_beside_their_points() {
    let point = || {
        PointResult::scored(
            "v".into(),
            "t".into(),
            0,
            PixelPoint::new(10.0, 20.0),
            Ok(Measurement { position: PixelPoint::new(10.25, 20.0), covariance: None }),
        )
    };
    let counts = |names: [&str; 4]| {
        let values = [10.0, 8.0, 9.0, 1.0];
        let named = |name: &str| FigureName::parse(Group::Network, name).unwrap();
        names.into_iter().zip(values).map(|(name, value)| Figure::plain(named(name), value, "")).collect::<Vec<_>>()
    };
    let places = |figures: Vec<Figure>| {
        let mut table = table(Coordinates::Errors, &[info("m", "1")], &[]);
        table.add(&Trial { points: vec![point()], calibrations: vec![adjusted(0, figures)], ..Trial::default() });
        let found = table.method("m").unwrap().clone();
        found.points.iter().map(|(place, entry)| (place.to_string(), entry.coordinates())).collect::<Vec<_>>()
    };
    let found = places(counts(["board/targets/all", "board/labelled/all", "board/labels/all", "board/wrong labels/all"]));
    let expected = [("adjustment/recognition board", [0.2, 1.0 / 9.0]), ("v/t", [0.25, 0.0])];
    assert_eq!(found.len(), 2, "{found:?}");
    for ((name, at), (place, [x, y])) in found.iter().zip(expected) {
        let [dx, dy] = at.unwrap();
        assert!(name == place && (dx - x).abs() < 1e-8 && (dy - y).abs() < 1e-8, "{name} {at:?}");
    }
    let found = places(counts(["modern/targets/all", "modern/labelled/all", "modern/labels/all", "modern/wrong labels/all"]));
    assert_eq!(found.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["adjustment/recognition modern"]);
}

#[test]
fn adjustments_are_two_points_and_their_figures() {
    let check = |unit, xy: f64, z: f64| {
        let check = [(Quantity::RmseXy, xy), (Quantity::RmseZ, z)].map(|(quantity, value)| Figure::plain(quantity, value, unit));
        [Figure::plain(Quantity::OverFrame, 0.25, "px")].into_iter().chain(check).collect::<Vec<_>>()
    };
    let points = |found: &MethodTable| {
        let at = |(place, entry): (&crate::Place, &Entry)| (place.to_string(), entry.coordinates());
        found.points.iter().map(at).collect::<Vec<_>>()
    };
    let two = |camera, check| {
        [("trial 3 adjustment/camera", camera), ("trial 3 adjustment/check points", check)].map(|(name, at)| (name.to_owned(), at))
    };
    assert_eq!(points(&entries(vec![adjusted(0, check("m", 0.002, 0.003))])), two(Some([0.25, 0.0]), Some([2.0, 3.0])), "m are mm");
    let mut both = entries(vec![adjusted(0, check("mm", 0.5, 0.75)), adjusted(1, check("mm", 9.0, 9.0))]);
    assert_eq!(points(&both), two(Some([0.25, 0.0]), Some([0.5, 0.75])), "the first set");
    assert_eq!(both.figures.len(), 6);
    assert_eq!(both.figures.remove(&(1, Quantity::RmseZ.into())).unwrap()[&3].value, 9.0);
    let failed = Calibrated { outcome: Err("no".into()), ..adjusted(0, Vec::new()) };
    let failed = entries(vec![failed]);
    assert_eq!((points(&failed), failed.counts()), (two(None, None).to_vec(), [0, 0, 2]));
    // Without a second step there are no check points; one that failed is rejected.
    let camera = || check("mm", 0.5, 0.75).into_iter().take(2).collect::<Vec<_>>();
    assert_eq!(points(&entries(vec![adjusted(0, camera())])), two(Some([0.25, 0.0]), None)[..1]);
    let second = Calibrated { check_failed: Some("no".into()), ..adjusted(0, camera()) };
    assert_eq!(points(&entries(vec![second])), two(Some([0.25, 0.0]), None));
    // Residuals of single points are no figures to compare.
    let residual = Figure::plain(Quantity::ResidualX.of(&["6", "left/3"]), 0.5, "px");
    let with = Figure { sigma: Some(0.5), error: Some(0.125), ..Figure::plain(Quantity::Parameter.of(&["c"]), 30.0, "mm") };
    let found = entries(vec![adjusted(0, vec![residual, with])]).figures;
    assert_eq!(found.keys().cloned().collect::<Vec<_>>(), [(0, Quantity::Parameter.of(&["c"]))]);
    let numbers = found.values().next().unwrap()[&3];
    assert_eq!((numbers.value, numbers.sigma, numbers.error), (30.0, Some(0.5), Some(0.125)));
}

#[test]
fn a_list_of_files_is_kept_up() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    let mut index = Index::default();
    assert!(!index.lists(&path));
    index.bless(&path, "12".into());
    assert!(index.lists(&path) && !index.lists(&folder.path().join("b.csv")));
    assert_eq!(index.mistake(&path, Some("12")), None);
    index.forget(&path);
    assert!(!index.lists(&path) && index.files.is_empty());
    assert!(matches!(Index::read(folder.path()), Err(IndexError::Missing(_))));
    assert!(matches!(Index::read(&path.join("none")), Err(IndexError::Missing(_))));
    fs::create_dir(folder.path().join(crate::INDEX)).unwrap();
    assert!(matches!(Index::read(folder.path()), Err(IndexError::File { .. })), "a folder is no file");
}

#[test]
fn verdicts_name_their_cell() {
    let cell = |row: &str, word: &str| ([String::from("p/table-1"), row.to_owned(), "x".to_owned()], word.to_owned());
    let of = |word: &str| Verdicts([cell("1", word)].into());
    let found = of("differs").compare(&of("not comparable"));
    assert_eq!((found[0].target.as_deref(), &*found[0].message), (Some("1, x"), "was: differs, is: not comparable"));
    let verdict = |old: &str, new: &str| of(old).compare(&of(new)).first().map(|f| f.verdict);
    assert_eq!(verdict("not comparable", "differs"), Some(Verdict::Changed));
    assert_eq!(verdict("not comparable", "not comparable"), None);
    assert_eq!(verdict("reproduces", "not comparable"), Some(Verdict::Fails));
    assert!(Verdicts::path(std::path::Path::new("b")).ends_with("published.verdicts.csv"));
}

#[test]
fn methods_are_named_once_and_described() {
    let mut table = table(Coordinates::Errors, &[info("m", "1"), info("n", "2")], &[]);
    // Records name what they meet: the first two are known.
    table.name_methods(&[info("m", "1"), info("n", "2"), info("o", "3")]);
    assert_eq!(table.methods().map(|(label, m)| format!("{label}{}", m.version)).collect::<String>(), "m1n2o3");
    table.add(&Trial { number: 0, points: vec![super::point(2, "a", [0.1, 0.0])], ..Trial::default() });
    assert_eq!(table.method("o").unwrap().points.len(), 1);
    table.describe("n", "k=1".into(), "A".into());
    let n = table.method("n").unwrap();
    assert_eq!((n.settings.as_str(), n.library.as_str()), ("k=1", "A"));
    assert_eq!(crate::fingerprint("a").len(), 32);
    assert_ne!(crate::fingerprint("a"), crate::fingerprint("b"));
}
