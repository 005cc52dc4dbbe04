//! What is found, and how it reads.

use calibench_records::results::PointResult;

use super::{info, point, rejected, table};
use crate::{Check, Coordinates, Finding, Rules, Table, Tally, Verdict, compare, json, render, worse_than};

fn single(points: Vec<PointResult>) -> Table {
    table(Coordinates::Errors, &[info("m", "1"), info("n", "1")], &[points])
}

fn says(findings: &[Finding], method: &str, what: &str) -> bool {
    findings.iter().any(|finding| finding.fails() && finding.method == method && finding.message.contains(what))
}

#[test]
fn a_deterministic_point_may_not_get_worse_and_is_named_if_it_moves() {
    let base = single(vec![point(0, "a", [0.2, 0.0]), point(1, "a", [0.1, 0.0])]);
    let with = |dx: f64| single(vec![point(0, "a", [dx, 0.0]), point(1, "a", [0.1, 0.0])]);
    assert!(compare(&base, &with(0.2 + 9e-7), true).is_empty());
    for (dx, verdict, what) in [
        (0.200_002, Verdict::Fails, "worse"),
        (0.199_998, Verdict::Changed, "better, not blessed"),
        (-0.2, Verdict::Changed, "as far off, elsewhere"),
    ] {
        let findings = compare(&base, &with(dx), true);
        assert_eq!(findings.len(), 1);
        assert!(findings[0].verdict == verdict && findings[0].message.contains(what), "{findings:?}");
        assert_eq!(findings[0].target.as_deref(), Some("image/a"));
        assert!(findings[0].fails_by(Rules { strict: true, locked: false }));
    }
}

#[test]
fn a_deterministic_status_may_not_get_worse() {
    let base = single(vec![point(0, "a", [0.2, 0.0]), rejected(1, "a")]);
    let findings = compare(&base, &single(vec![rejected(0, "a"), point(1, "a", [2.0, 0.0])]), true);
    assert!(says(&findings, "m", "was measured, is rejected (no_corner)"));
    assert!(findings.iter().any(|f| f.verdict == Verdict::Changed && f.message == "was rejected (no_corner), is lost"), "{findings:?}");
    assert!(findings.iter().any(|f| f.metric == "rejected" && f.figures_are(0.0, 1.0)), "{findings:?}");
    let findings = compare(&base, &single(vec![point(0, "a", [f64::NAN, 0.0]), rejected(1, "a")]), true);
    assert!(says(&findings, "m", "was measured, is not a number"), "{findings:?}");
}

#[test]
fn photographs_are_compared_exactly() {
    let photo = |dx| table(Coordinates::Positions, &[info("m", "1")], &[vec![point(0, "a", [dx, 0.0])]]);
    assert!(compare(&photo(0.0), &photo(1e-7), false).is_empty());
    assert!(says(&compare(&photo(0.0), &photo(1e-5), false), "m", "moved"));
    assert!(says(&compare(&photo(0.0), &single(vec![point(0, "a", [0.0; 2])]), true), "", "bless anew"));
}

#[test]
fn a_new_version_with_the_same_figures_informs() {
    let of = |version| table(Coordinates::Errors, &[info("m", version)], &[vec![point(0, "a", [0.1; 2])]]);
    let findings = compare(&of("1"), &of("2"), true);
    assert_eq!(findings.len(), 1);
    assert!(!findings[0].fails() && findings[0].message.contains("from 1 to 2"));
}

#[test]
fn what_is_new_informs() {
    let base = table(Coordinates::Errors, &[info("m", "1")], &[vec![point(0, "a", [0.1; 2])]]);
    let now = single(vec![point(0, "a", [0.1; 2]), point(0, "b", [0.1; 2]), point(1, "a", [0.1; 2])]);
    let findings = compare(&base, &now, true);
    assert_eq!(findings.len(), 2);
    assert!(findings.iter().all(|finding| !finding.fails() && finding.message.contains("not blessed yet")));
    let mut check = Check::new();
    check.unblessed(&now);
    assert_eq!(check.conclude().len(), 2);
}

#[test]
fn findings_read_as_a_table() {
    let base = single(vec![point(0, "a", [0.2, 0.0]), point(1, "a", [0.1, 0.0])]);
    let mut check = Check::new();
    check.compare(&base, &single(vec![point(0, "a", [0.25, 0.0])]), true);
    let tally = check.tally();
    let text = render(&check.conclude(), Rules::default(), tally);
    let heading = "  scenario  method  target   metric  baseline       now     change\n";
    assert!(text.starts_with(&format!("Fails\n\n{heading}")), "{text}");
    assert!(text.contains("  f/s       m       image/a  dx      0.200000  0.250000  +0.050000  worse\n"), "{text}");
    assert!(text.contains("  f/s       n                points         1         0         -1  the method has no points\n"), "{text}");
    assert!(text.contains("\ncompared: 1 scenarios and cells of sweeps, 2 methods, 2 points,"), "{text}");
    let last =
        "The gate fails: 2 findings (m in f/s, n in f/s); 0 changed, 0 not blessed, 0 for information; family-wise error rate 0.001.\n";
    assert!(text.ends_with(last), "{text}");
    let holds = "The gate holds: nothing fails, 0 changed, 0 not blessed, 0 for information.\n";
    assert!(render(&[], Rules::default(), Tally::default()).ends_with(holds));
}

#[test]
fn names_cannot_speak_to_the_terminal() {
    let finding = Finding::new(Verdict::Fails, "f/\u{1b}[2Js", "m\n", "dx", "worse").at("v/\u{202e}t");
    let text = render(&[finding], Rules::default(), Tally::default());
    assert!(text.contains("f/\\u{1b}[2Js") && text.contains("m\\n") && text.contains("v/\\u{202e}t"), "{text}");
    assert!(!text.contains('\u{1b}') && !text.contains('\u{202e}'));
}

#[test]
fn json_says_what_fails_by_which_rules() {
    let findings = [Finding::new(Verdict::Changed, "f/s", "m", "position", "moved").figures(1.0, f64::NAN)];
    let of = |strict| {
        serde_json::from_str::<serde_json::Value>(&json(&findings, Rules { strict, locked: false }, Tally::default(), &[])).unwrap()
    };
    assert_eq!((&of(false)["holds"], &of(true)["holds"]), (&true.into(), &false.into()));
    assert_eq!(of(true)["findings"][0]["fails"], true);
    assert_eq!(of(true)["findings"][0]["verdict"], "changed");
    assert_eq!(of(true)["findings"][0]["baseline"], 1.0);
}

#[test]
fn a_blessing_for_the_worse_is_listed() {
    let base = single(vec![point(0, "a", [0.2, 0.0]), point(1, "a", [0.1, 0.0])]);
    let lines = worse_than(&base, &single(vec![point(0, "a", [0.25, 0.0])]));
    assert!(
        lines.contains(&"n: image/a: the target is missing: 1 of 1 points".to_owned()) || lines.iter().any(|l| l.starts_with("n: ")),
        "{lines:?}"
    );
    assert!(lines.contains(&"m: rmse_xy 0.200000 -> 0.250000 (+0.050000)".to_owned()), "{lines:?}");
    assert!(worse_than(&base, &base).is_empty());
}

impl Finding {
    fn figures_are(&self, baseline: f64, now: f64) -> bool {
        (self.baseline, self.now) == (Some(baseline), Some(now))
    }
}
