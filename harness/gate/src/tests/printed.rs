//! Figures, lines and pages as they are printed.

use super::{NO_CORNER, holding, lost, measured, method};
use crate::{
    Coordinates, Entry, Finding, MethodTable, Rules, Table, Tally, Verdict, baseline_path, figures_path, junit, machine, render, worse_than,
};

fn finding(metric: &'static str) -> Finding {
    Finding::new(Verdict::Fails, "f/s", "m", metric, "so")
}

/// The cells of the one row that a finding prints, by their headings.
fn row(finding: &Finding) -> Vec<(String, String)> {
    let text = render(std::slice::from_ref(finding), Rules::default(), Tally::default());
    let lines: Vec<&str> = text.lines().skip(2).take(2).collect();
    let [heads, cells] = [0, 1].map(|line| lines[line].split_whitespace().map(str::to_owned).collect::<Vec<String>>());
    heads.into_iter().zip(cells).collect()
}

fn cell(finding: &Finding, head: &str) -> Option<String> {
    row(finding).into_iter().find(|(name, _)| name == head).map(|(_, cell)| cell)
}

#[test]
fn figures_are_printed_as_counts_or_to_a_millionth() {
    let printed = |value: f64| cell(&finding("x").figures(value, 7.0), "baseline").unwrap();
    for (value, text) in [
        (3.0, "3"),
        (-12.0, "-12"),
        (0.0, "0"),
        (999_999_999.0, "999999999"),
        (1e9, "1000000000.000000"),
        (-1e9, "-1000000000.000000"),
        (0.25, "0.250000"),
        (-0.000_012, "-0.000012"),
        (1e-5, "0.000010"),
        (9.9e-6, "9.9e-6"),
        (-2.5e-7, "-2.5e-7"),
    ] {
        assert_eq!(printed(value), text, "{value}");
    }
}

#[test]
fn a_change_has_its_sign() {
    let change = |old: f64, new: f64| cell(&finding("x").figures(old, new), "change").unwrap();
    assert_eq!(change(0.25, 0.5), "+0.250000");
    assert_eq!(change(0.5, 0.25), "-0.250000");
    assert_eq!(change(3.0, 5.0), "+2");
    assert_eq!(change(0.5, 0.5), "0", "nothing has no sign");
    assert_eq!(finding("x").change(), None);
    assert_eq!(Finding { baseline: Some(1.0), ..finding("x") }.change(), None);
}

#[test]
fn a_chance_is_printed_to_two_digits() {
    let p = |p: f64| cell(&Finding { p: Some(p), ..finding("x") }, "p").unwrap();
    assert_eq!((p(0.0), p(0.000_123)), ("0".to_owned(), "1.2e-4".to_owned()));
    assert_eq!(cell(&finding("x"), "p"), None, "a column without a value is left out");
}

#[test]
fn columns_are_as_wide_as_their_longest_cell() {
    let findings = [finding("x").at("a long name").figures(0.5, 12.25), finding("long metric").at("t").figures(7.0, 1.0)];
    let text = render(&findings, Rules::default(), Tally::default());
    let expected = "  scenario  method  target       metric       baseline        now      change\n\
                    \x20 f/s       m       a long name  x            0.500000  12.250000  +11.750000  so\n\
                    \x20 f/s       m       t            long metric         7          1          -6  so\n";
    assert!(text.starts_with(&format!("Fails\n\n{expected}")), "{text}");
}

#[test]
fn ten_findings_of_a_metric_are_listed_and_the_rest_counted() {
    let of = |count: usize| render(&vec![finding("x"); count], Rules::default(), Tally::default());
    let rows = |text: &str| text.lines().filter(|line| line.starts_with("  f/s")).count();
    assert!(rows(&of(10)) == 10 && !of(10).contains("more of"), "{}", of(10));
    assert!(rows(&of(13)) == 10 && of(13).contains("  and 3 more of x of m in f/s (all with --json)\n"), "{}", of(13));
    let mut both = vec![finding("x"); 10];
    both.push(finding("y"));
    assert_eq!(rows(&render(&both, Rules::default(), Tally::default())), 11, "another metric has its own ten");
}

#[test]
fn parts_are_titled_and_counted_by_the_rules() {
    let verdicts = [Verdict::Fails, Verdict::Changed, Verdict::Changed, Verdict::Unblessed, Verdict::Unblessed, Verdict::Unblessed];
    let mut findings: Vec<Finding> = verdicts.into_iter().map(|verdict| Finding { verdict, ..finding("x") }).collect();
    findings.extend(vec![Finding { verdict: Verdict::Informs, ..finding("x") }; 4]);
    let text = |strict, locked| render(&findings, Rules { strict, locked }, Tally::default());
    let counts = "2 changed, 3 not blessed, 4 for information";
    for (strict, locked, fails, changed, unblessed) in [
        (false, false, 1, "Changed\n", "Not blessed\n"),
        (true, false, 3, "Changed without a bless: fails\n", "Not blessed\n"),
        (false, true, 4, "Changed\n", "Not blessed: fails\n"),
        (true, true, 6, "Changed without a bless: fails\n", "Not blessed: fails\n"),
    ] {
        let text = text(strict, locked);
        assert!(text.contains(&format!("The gate fails: {fails} findings (m in f/s); {counts};")), "{text}");
        assert!(text.contains(changed) && text.contains(unblessed) && text.contains("For information\n"), "{text}");
    }
    let holds = render(&findings[6..], Rules { strict: true, locked: true }, Tally::default());
    assert!(holds.contains("The gate holds: nothing fails, 0 changed, 0 not blessed, 4 for information."), "{holds}");
}

#[test]
fn the_tally_says_what_was_compared() {
    let tally = Tally { scenarios: 1, methods: 2, changed: 3, points: 4, figures: 5, cells: 6, ceilings: 7 };
    let expected = "compared: 1 scenarios and cells of sweeps, 2 methods, 4 points, 5 figures of adjustments, 6 published cells, 7 ceilings; \
                    3 methods have other numbers\n";
    assert!(render(&[], Rules::default(), tally).starts_with(expected));
}

#[test]
fn signs_that_turn_text_round_are_written_out() {
    for (sign, hidden) in [
        ('\u{2029}', false),
        ('\u{202a}', true),
        ('\u{202e}', true),
        ('\u{202f}', false),
        ('\u{2065}', false),
        ('\u{2066}', true),
        ('\u{2069}', true),
        ('\u{206a}', false),
        ('\u{7f}', true),
    ] {
        let text = render(&[finding("x").at(format!("a{sign}b"))], Rules::default(), Tally::default());
        assert_eq!(text.contains(sign), !hidden, "{}", sign.escape_default());
    }
}

#[test]
fn a_test_case_says_what_failed_and_what_informs() {
    let informs = |message: &str| Finding { verdict: Verdict::Informs, message: message.into(), ..finding("y") };
    let findings = [finding("x").at("t").figures(1.0, 2.5), informs("a\"b\u{1}\n\u{fffe}&")];
    let text = junit(&findings, &[("f/s".into(), String::new())], Rules::default());
    let expected = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
                    <testsuite name=\"calibench check\" tests=\"2\" failures=\"1\">\n\
                    \x20 <testcase classname=\"f/s\" name=\"scenario\"/>\n\
                    \x20 <testcase classname=\"f/s\" name=\"m\">\n\
                    \x20   <failure message=\"x of t: so: 1 blessed, 2.5 now\">x of t: so: 1 blessed, 2.5 now</failure>\n\
                    \x20   <system-out>y: a&quot;b\\u{1}\n\\u{fffe}&amp;</system-out>\n\
                    \x20 </testcase>\n</testsuite>\n";
    assert_eq!(text, expected);
}

#[test]
fn findings_fail_by_their_verdict_and_the_rules() {
    let fails = |verdict| {
        let finding = Finding { verdict, ..finding("x") };
        [(false, false), (true, false), (false, true)].map(|(strict, locked)| finding.fails_by(Rules { strict, locked }))
    };
    assert_eq!(fails(Verdict::Fails), [true, true, true]);
    assert_eq!(fails(Verdict::Changed), [false, true, false]);
    assert_eq!(fails(Verdict::Unblessed), [false, false, true]);
    assert_eq!(fails(Verdict::Informs), [false, false, false]);
}

#[test]
fn the_machine_is_named_by_its_architecture() {
    let name = machine();
    let known =
        if std::env::consts::ARCH == "x86_64" { &["x86_64 AVX-512", "x86_64 AVX2", "x86_64 SSE2"][..] } else { &[std::env::consts::ARCH] };
    assert!(known.contains(&name.as_str()), "{name}");
}

#[test]
fn files_are_named_by_their_scenario() {
    let folder = std::path::Path::new("b");
    assert_eq!(baseline_path(folder, "f/s/t"), folder.join("f--s--t.csv"));
    assert_eq!(figures_path(folder, "f/s/t"), folder.join("f--s--t.figures.csv"));
}

fn with(coordinates: Coordinates, points: impl IntoIterator<Item = (u64, &'static str, Entry)>) -> Table {
    holding(coordinates, method(points))
}

#[test]
fn a_blessing_for_the_worse_is_said_in_figures() {
    let kept = |dx: f64, dy: f64| measured([dx, dy], None);
    let points = |second: Entry, third: Entry| [(0, "a", kept(0.3, 0.4)), (1, "a", second), (0, "b", third), (1, "b", kept(0.0, 0.0))];
    let base = with(Coordinates::Errors, points(kept(0.3, 0.4), kept(0.0, 0.0)));
    // Means of a: (0.3, 0.4), then (0.45, 0.6). Squares 0.25 + 1 of four points, before 0.25 + 0.25.
    let larger = worse_than(&base, &with(Coordinates::Errors, points(kept(0.6, 0.8), kept(0.0, 0.0))));
    let expected = [
        "m: image/a: |mean error| 0.500000 -> 0.750000 (+0.250000)",
        "m: max_error 0.500000 -> 1.000000 (+0.500000)",
        "m: rmse_xy 0.353553 -> 0.559017 (+0.205464)",
    ];
    assert_eq!(larger, expected);
    let gone = worse_than(&base, &with(Coordinates::Errors, points(lost([0.0, 1.5]), NO_CORNER)));
    let expected = [
        "m: lost_share 0.000000 -> 0.250000 (+0.250000)",
        "m: max_error 0.500000 -> 1.500000 (+1.000000)",
        "m: rejected_share 0.000000 -> 0.250000 (+0.250000)",
    ];
    assert_eq!(gone, expected);
    assert!(worse_than(&base, &with(Coordinates::Errors, points(kept(0.3, 0.2), kept(0.0, 0.0)))).is_empty(), "better");
    assert!(worse_than(&base, &with(Coordinates::Errors, points(kept(0.3, 0.4 + 1e-7), kept(0.0, 0.0)))).is_empty(), "last bits");
    let mut absent: MethodTable = method(points(kept(3.0, 4.0), kept(0.0, 0.0)));
    absent.unavailable = Some("not built".into());
    let lines = worse_than(&base, &holding(Coordinates::Errors, absent));
    assert_eq!(lines, ["m: the method is unavailable: not built"]);
}

#[test]
fn a_blessing_that_moves_points_of_photographs_is_said() {
    let at = |x: f64, y: f64| measured([x, y], None);
    let base = with(Coordinates::Positions, [(0, "a", at(10.0, 20.0)), (0, "b", at(30.0, 40.0)), (0, "c", NO_CORNER)]);
    let now = |a: Entry, b: Entry| worse_than(&base, &with(Coordinates::Positions, [(0, "a", a), (0, "b", b), (0, "c", at(1.0, 1.0))]));
    assert_eq!(now(at(10.3, 20.4), at(30.0, 39.75)), ["m: 2 points moved, by up to 0.500000 px"]);
    assert_eq!(now(at(10.0, 20.25), at(30.0, 40.0)), ["m: 1 points moved, by up to 0.250000 px"]);
    assert!(now(at(10.0, 20.0 + 1e-7), at(30.0, 40.0)).is_empty());
    assert_eq!(now(at(10.0, 20.0), NO_CORNER), [""; 0], "as many are rejected as were");
    // The coordinates are no errors: neither their root mean square nor their means say anything.
    let errors = with(Coordinates::Errors, [(0, "a", at(0.1, 0.0))]);
    assert!(worse_than(&errors, &with(Coordinates::Errors, [(0, "a", at(-0.1, 0.0))])).is_empty(), "moved, and as far off");
}
