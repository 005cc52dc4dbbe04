//! What other tools' numbers mean: the table, its page, and the scripts that hold its lines.

use std::collections::BTreeSet;
use std::fs;

use crate::project::{root, run, stdout};

/// The columns of the table.
const COLUMNS: [&str; 6] = ["tool", "versions", "question", "answer", "script", "date"];

fn table() -> Vec<[String; 6]> {
    let mut reader = csv::Reader::from_path(root().join("harness/cli/src/peers.csv")).unwrap();
    assert_eq!(reader.headers().unwrap(), &COLUMNS[..]);
    reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect::<Vec<_>>().try_into().unwrap()).collect()
}

/// Names of the scripts in `findings/`.
fn scripts() -> BTreeSet<String> {
    let paths = fs::read_dir(root().join("findings")).unwrap().map(|entry| entry.unwrap().path());
    paths.map(|path| path.file_name().unwrap().to_str().unwrap().strip_suffix(".sh").expect("scripts alone").to_owned()).collect()
}

#[test]
fn every_line_has_a_script_and_every_script_a_line() {
    let rows = table();
    assert!(rows.len() >= 30, "{} lines", rows.len());
    let held: BTreeSet<String> = rows.iter().map(|row| row[4].clone()).collect();
    assert_eq!(held, scripts());
    let questions: BTreeSet<_> = rows.iter().map(|row| &row[..3]).collect();
    assert_eq!(questions.len(), rows.len(), "a question of one tool is answered once");
    for row in &rows {
        assert!(row.iter().all(|cell| !cell.is_empty() && cell.trim() == cell && !cell.contains(['|', '\n'])), "{row:?}");
        let date: Vec<usize> = row[5].split('-').map(str::len).collect();
        assert!(date == [4, 2, 2] && row[5].chars().all(|c| c.is_ascii_digit() || c == '-'), "{row:?}");
    }
}

/// They are short, stop at the first failure, and say so at their end where all is as stated.
#[test]
fn scripts_are_of_one_form() {
    for name in scripts() {
        let script = fs::read_to_string(root().join(format!("findings/{name}.sh"))).unwrap();
        assert!(script.lines().count() < 120, "{name}: {} lines", script.lines().count());
        assert!(script.starts_with("#!/usr/bin/env bash\n# ") && script.contains("\n# Seen: "), "{name}: says what was seen");
        assert!(script.contains("\nset -euo pipefail\n") && script.ends_with("\necho \"as stated\"\n"), "{name}");
        assert!(!script.contains("calibench"), "{name}: asks the tools alone");
    }
}

#[test]
fn the_page_and_the_command_show_the_table() {
    let page = fs::read_to_string(root().join("docs/peers.md")).unwrap();
    let shown: Vec<&str> = page.lines().filter(|line| line.starts_with("| ")).skip(1).collect();
    let expected: Vec<String> = table()
        .iter()
        .map(|[tool, versions, question, answer, script, date]| {
            format!("| {tool} | {versions} | {question} | {answer} | [`{script}`](../findings/{script}.sh) | {date} |")
        })
        .collect();
    assert_eq!(shown, expected);
    let said = stdout(&run(&root(), &["list", "peers"]));
    let mut rest = said.as_str();
    for [tool, versions, question, answer, script, date] in table() {
        assert!(said.contains(&format!("{tool} ({versions})\n")), "{tool}");
        let lines = format!("    {question}\n        {answer}\n        findings/{script}.sh, {date}\n");
        rest = &rest[rest.find(&lines).unwrap_or_else(|| panic!("not in its place: {lines}")) + lines.len()..];
    }
    assert!(rest.is_empty(), "{rest}");
}
