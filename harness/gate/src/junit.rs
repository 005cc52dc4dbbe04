//! The findings of a check as JUnit XML, one test case for each method of each scenario.

use std::collections::BTreeMap;
use std::fmt::Write;

use calibench_model::escape;

use super::finding::{Finding, Rules};

/// A document with a test case for each of `compared` (scenario, method) and for every other pair that a finding is about: a case fails
/// if a finding about it does by `rules`; what only informs is its output.
pub fn junit(findings: &[Finding], compared: &[(String, String)], rules: Rules) -> String {
    let mut cases: BTreeMap<(&str, &str), Vec<&Finding>> = compared.iter().map(|(s, m)| ((s.as_str(), m.as_str()), Vec::new())).collect();
    for finding in findings {
        cases.entry((&finding.scenario, &finding.method)).or_default().push(finding);
    }
    let fails = |found: &Vec<&Finding>| found.iter().any(|finding| finding.fails_by(rules));
    let failures = cases.values().filter(|found| fails(found)).count();
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    // Writing to a String cannot fail.
    let _ = writeln!(text, "<testsuite name=\"calibench check\" tests=\"{}\" failures=\"{failures}\">", cases.len());
    for ((scenario, method), found) in &cases {
        let method = if method.is_empty() { "scenario" } else { method };
        let _ = write!(text, "  <testcase classname=\"{}\" name=\"{}\"", xml(scenario), xml(method));
        if found.is_empty() {
            text.push_str("/>\n");
            continue;
        }
        text.push_str(">\n");
        let (failing, others): (Vec<&&Finding>, Vec<&&Finding>) = found.iter().partition(|finding| finding.fails_by(rules));
        if let Some(first) = failing.first() {
            let lines: Vec<String> = failing.iter().map(|finding| line(finding)).collect();
            let _ = writeln!(text, "    <failure message=\"{}\">{}</failure>", xml(&line(first)), xml(&lines.join("\n")));
        }
        if !others.is_empty() {
            let lines: Vec<String> = others.iter().map(|finding| line(finding)).collect();
            let _ = writeln!(text, "    <system-out>{}</system-out>", xml(&lines.join("\n")));
        }
        text.push_str("  </testcase>\n");
    }
    text + "</testsuite>\n"
}

fn line(finding: &Finding) -> String {
    let target = finding.target.as_ref().map_or_else(String::new, |target| format!(" of {target}"));
    let figures = match (finding.baseline, finding.now) {
        (Some(old), Some(new)) => format!(": {old} blessed, {new} now"),
        _ => String::new(),
    };
    format!("{}{target}: {}{figures}", finding.metric, finding.message)
}

/// Text that XML can hold: marks as entities; characters that it forbids, written out.
fn xml(text: &str) -> String {
    escape::markup(text, |c| match c {
        '"' => Some("&quot;".into()),
        '\n' => None,
        c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => Some(c.escape_default().to_string().into()),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Verdict;

    #[test]
    fn a_case_fails_if_a_finding_does() {
        let findings = [
            Finding::new(Verdict::Fails, "f/s", "m<1>", "dx", "worse").figures(0.1, 0.2),
            Finding::new(Verdict::Changed, "f/s", "n", "dx", "better"),
        ];
        let compared = [("f/s".to_owned(), "n".to_owned()), ("f/s".to_owned(), "o".to_owned())];
        let text = junit(&findings, &compared, Rules::default());
        assert!(text.contains("tests=\"3\" failures=\"1\""), "{text}");
        assert!(text.contains("name=\"m&lt;1&gt;\">\n    <failure message=\"dx: worse: 0.1 blessed, 0.2 now\">"), "{text}");
        assert!(text.contains("name=\"n\">\n    <system-out>dx: better</system-out>") && text.contains("name=\"o\"/>"), "{text}");
        let strict = junit(&findings, &compared, Rules { strict: true, locked: false });
        assert!(strict.contains("failures=\"2\""), "{strict}");
    }
}
