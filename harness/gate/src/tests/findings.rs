//! What is found, and how it reads.

use calibench_records::results::PointResult;

use super::{info, point, rejected, table};
use crate::{Check, Coordinates, Finding, Table, compare, render, worse_than};

fn single(points: Vec<PointResult>) -> Table {
    table(Coordinates::Errors, &[info("m", "1"), info("n", "1")], &[points])
}

fn says(findings: &[Finding], method: &str, what: &str) -> bool {
    findings.iter().any(|finding| finding.fails() && finding.method == method && finding.message.contains(what))
}

#[test]
fn a_deterministic_point_may_not_move_either_way() {
    let base = single(vec![point(0, "a", [0.2, 0.0]), point(1, "a", [0.1, 0.0])]);
    let with = |dx: f64| single(vec![point(0, "a", [dx, 0.0]), point(1, "a", [0.1, 0.0])]);
    assert!(compare(&base, &with(0.2 + 9e-7), true).is_empty());
    for (dx, what) in [(0.200_002, "worse"), (0.199_998, "better, not blessed"), (-0.2, "as far off")] {
        let findings = compare(&base, &with(dx), true);
        assert_eq!(findings.len(), 1);
        assert!(says(&findings, "m", what), "{findings:?}");
        assert_eq!(findings[0].target.as_deref(), Some("image/a"));
    }
}

#[test]
fn a_deterministic_status_may_not_change() {
    let base = single(vec![point(0, "a", [0.2, 0.0]), rejected(1, "a")]);
    let findings = compare(&base, &single(vec![rejected(0, "a"), point(1, "a", [2.0, 0.0])]), true);
    assert!(says(&findings, "m", "was measured, is rejected (no_corner)"));
    assert!(says(&findings, "n", "was rejected (no_corner), is lost"));
    assert!(findings.iter().any(|f| f.metric == "rejected" && f.figures_are(0.0, 1.0)), "{findings:?}");
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
fn too_few_pairs_are_said_to_be_untested() {
    let trials = |shift: f64| vec![vec![point(0, "a", [0.1 + shift, 0.0])]; 9];
    let of = |shift| table(Coordinates::Errors, &[info("m", "1")], &trials(shift));
    let findings = compare(&of(0.0), &of(0.5), false);
    assert!(findings.iter().any(|finding| finding.message.contains("not tested: 9 pairs")));
    assert!(findings.iter().all(|finding| !finding.fails()));
}

#[test]
fn findings_read_as_a_table() {
    let base = single(vec![point(0, "a", [0.2, 0.0]), point(1, "a", [0.1, 0.0])]);
    let text = render(&compare(&base, &single(vec![point(0, "a", [0.25, 0.0])]), true));
    let heading = "  scenario  method  target   metric  baseline       now     change\n";
    assert!(text.starts_with(&format!("Fails\n\n{heading}")), "{text}");
    assert!(text.contains("  f/s       m       image/a  dx      0.200000  0.250000  +0.050000  worse\n"), "{text}");
    assert!(text.contains("  f/s       n                points         1         0         -1  the method has no points\n"), "{text}");
    assert!(text.ends_with("The gate fails: 2 findings (m in f/s, n in f/s), 0 for information; family-wise error rate 0.001.\n"));
    assert_eq!(render(&[]), "The gate holds: nothing fails, 0 for information.\n");
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
