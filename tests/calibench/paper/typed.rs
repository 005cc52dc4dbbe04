//! Figures in what was found out about the tables of papers: most are filled in from records; those that are typed stand elsewhere, too.

use std::collections::BTreeSet;

use crate::project::root;

/// The tables of a paper by the names of their files, as they are written.
fn tables(paper: &str) -> Vec<(String, toml::Table)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(root().join("reference/published").join(paper)).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if path.extension().is_some_and(|ending| ending == "toml") && name != "predictions" {
            found.push((name, toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()));
        }
    }
    found.sort_by(|a, b| a.0.cmp(&b.0));
    found
}

fn findings(table: &toml::Table) -> Vec<String> {
    let all = table.get("findings").and_then(toml::Value::as_array).into_iter().flatten();
    all.map(|finding| finding.as_str().unwrap().replace('\n', " ")).collect()
}

/// That a finding about `table` of `paper` says `what`: a figure that a test has computed.
pub fn assert_says(paper: &str, table: &str, what: &str) {
    let all = tables(paper);
    let (_, table) = all.iter().find(|(name, _)| name == table).unwrap_or_else(|| panic!("{paper}: no {table}"));
    let said = findings(table);
    assert!(said.iter().any(|finding| finding.contains(what)), "`{what}` is not said: {said:?}");
}

/// Words without what is asked for in braces.
fn typed(text: &str) -> String {
    let mut out = String::new();
    for (place, part) in text.split('{').enumerate() {
        out.push_str(if place == 0 { part } else { part.split_once('}').unwrap().1 });
    }
    out
}

/// The numbers with a decimal point, without signs and powers of ten, as they are written.
fn decimals(text: &str) -> BTreeSet<String> {
    let words = text.split(|c: char| !(c.is_ascii_digit() || c == '.')).map(|word| word.trim_end_matches('.'));
    words.filter(|word| word.matches('.').count() == 1 && word.parse::<f64>().is_ok()).map(str::to_owned).collect()
}

/// Whether one of `among`, rounded, is `figure`; hundredths of it for what is printed in another unit.
fn stands(figure: &str, among: &BTreeSet<String>, times: &[f64]) -> bool {
    let (value, digits): (f64, usize) = (figure.parse().unwrap(), figure.split_once('.').unwrap().1.len());
    let near = |other: f64| (other - value).abs() <= 0.5 * 10_f64.powi(-i32::try_from(digits).unwrap()) * (1.0 + 1e-6);
    among.iter().filter_map(|other| other.parse::<f64>().ok()).any(|other| times.iter().any(|times| near(other * times)))
}

/// Figures that stand nowhere else, and the test that computes and reads them, or the program that prints them.
const HELD: [(&str, &str, &[&str], &str); 14] = [
    ("vosselman-1988", "table-3", &["15.9", "7.9", "7.7"], "recognise/examples/lessons.rs"),
    ("vosselman-1988", "table-4-ratios", &["1.25"], "what_is_computed_of_print_is_what_the_report_says"),
    ("vosselman-1988", "table-5", &["234.8", "255.7"], "what_is_computed_of_print_is_what_the_report_says"),
    ("galo-2011", "table-1", &["0.0007"], "table_1_determines_the_edges_at_5_9_and_10"),
    ("galo-2011", "table-2", &["3.5"], "run/examples/galo_networks/drawn.rs"),
    ("galo-2011", "table-2", &["0.164", "3.85", "1.53", "0.0804"], "only_y0_moves_farther_between_columns_than_in_plausible_networks"),
    ("galo-2011", "table-2", &["2.30", "1.87"], "the_altimetric_factor_has_nothing_to_do_with_y0"),
    ("galo-2011", "table-3", &["0.0216", "0.0302", "0.0285", "1.82"], "what_is_computed_of_print_is_what_the_report_of_galo_says"),
    ("galo-2011", "table-3", &["0.208", "0.178", "0.678", "0.682"], "residuals_are_reduced_less_in_oblique_images"),
    ("galo-2011", "table-4", &["0.851", "0.621", "2.093", "2.731"], "what_is_computed_of_print_is_what_the_report_of_galo_says"),
    ("zhu-2007", "table-1", &["1.42"], "run/examples/zhu_search"),
    ("canon-t3", "table-1", &["22.99", "19.182", "19.356"], "pixel_sizes_are_what_the_report_says"),
    ("canon-t3", "table-3", &["13.8"], "pixel_sizes_are_what_the_report_says"),
    ("canon-t3", "table-4-campaign", &["19.18"], "pixel_sizes_are_what_the_report_says"),
];

/// A typed figure is printed, put in, or stands on the pages in a table of records: when records change, the pages do, and the figure has to follow.
#[test]
fn figures_that_are_typed_stand_in_print_in_scenarios_or_in_tables() {
    let mut unused: BTreeSet<(&str, &str, &str)> =
        HELD.iter().flat_map(|(paper, table, figures, _)| figures.iter().map(|figure| (*paper, *table, *figure))).collect();
    for paper in calibench_report::published::papers(&root().join("reference/published")) {
        let read = |name: &str| std::fs::read_to_string(root().join("reports").join(&paper).join(name)).unwrap();
        let rows = read("tables.md")
            .lines()
            .filter(|line| line.starts_with('|') || line.starts_with("- ("))
            .map(str::to_owned)
            .collect::<Vec<_>>();
        let pages = decimals(&(rows.join("\n") + &read("runs.md")));
        let mut put_in = BTreeSet::new();
        for entry in std::fs::read_dir(root().join("scenarios").join(&paper)).unwrap() {
            put_in.extend(decimals(&std::fs::read_to_string(entry.unwrap().path()).unwrap()));
        }
        let tables = tables(&paper);
        let mut printed = BTreeSet::new();
        for (_, table) in &tables {
            let cells = table.get("cell").and_then(toml::Value::as_array).into_iter().flatten();
            cells.for_each(|cell| printed.extend(decimals(cell["printed"].as_str().unwrap())));
        }
        for (name, table) in &tables {
            for figure in findings(table).iter().flat_map(|finding| decimals(&typed(finding))) {
                let held = HELD.iter().find(|(of, table, figures, _)| *of == paper && table == name && figures.contains(&figure.as_str()));
                if let Some((of, table, figures, _)) = held {
                    figures.iter().filter(|held| **held == figure).for_each(|held| {
                        unused.remove(&(*of, *table, *held));
                    });
                } else {
                    let known =
                        stands(&figure, &printed, &[1.0, 100.0]) || stands(&figure, &put_in, &[1.0]) || stands(&figure, &pages, &[1.0]);
                    assert!(
                        known,
                        "{paper}, {name}: {figure} is typed, and stands nowhere else: ask for it in braces, or compute it in a test"
                    );
                }
            }
        }
    }
    assert!(unused.is_empty(), "typed nowhere: {unused:?}");
    for (.., by) in HELD {
        let is_program = by.contains('/') && root().join("harness").join(by).exists();
        let is_test = ["galo", "galo_networks", "vosselman", "paper/typed"]
            .into_iter()
            .any(|file| std::fs::read_to_string(root().join(format!("tests/calibench/{file}.rs"))).unwrap().contains(&format!("fn {by}(")));
        assert!(is_program || is_test, "{by} is not there");
    }
}

#[test]
fn figures_in_words_are_found() {
    assert_eq!(typed("a {ours t | 0.5 | c} b 0.25"), "a  b 0.25");
    assert_eq!(
        decimals("1/18.9, -0.25 px, 3 and 4.7. See 1.2.3, 2.72e-5").into_iter().collect::<Vec<_>>(),
        ["0.25", "18.9", "2.72", "4.7"]
    );
    let among = BTreeSet::from(["0.2386".to_owned()]);
    assert!(stands("0.239", &among, &[1.0]) && stands("23.9", &among, &[1.0, 100.0]) && !stands("0.238", &among, &[1.0, 100.0]));
}

/// What the findings on the Canon T3 compute of its Table 1: pixel sizes, and c of OpenCV through them.
#[test]
fn pixel_sizes_are_what_the_report_says() {
    let (printed, columns, rows) = (5.38085, 4272.0, 2848.0);
    let [width, height] = [columns, rows].map(|side: f64| side * printed / 1000.0);
    assert_says("canon-t3", "table-1", &format!("would be {width:.2} mm wide"));
    let through = |sensor: f64| 18.525 * printed / (1000.0 * sensor / columns);
    assert_says("canon-t3", "table-1", &format!("it would be {:.3} mm through the 5.381 um of the others", through(22.2)));
    assert_says("canon-t3", "table-1", &format!("through 5.150 um {:.3} mm", through(22.0)));
    assert_says("canon-t3", "table-4-campaign", &format!("= {:.2} mm", through(22.2)));
    assert_says("canon-t3", "table-3", &format!("the corners are at {:.1} mm", 0.5 * width.hypot(height)));
}
