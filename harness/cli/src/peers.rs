//! `calibench list peers`: what other tools' numbers mean, by what was asked of them.

use std::fmt::Write;

use crate::failure::Failure;

/// Columns tool, versions, question, answer, script (a name in `findings/`), date; lines of one tool and its versions stand together.
const TABLE: &str = include_str!("peers.csv");

/// The table as `list` prints it.
pub fn peers() -> Result<String, Failure> {
    let mut text = String::new();
    let mut above = None;
    for row in csv::Reader::from_reader(TABLE.as_bytes()).deserialize() {
        let (tool, versions, question, answer, script, date): (String, String, String, String, String, String) = row?;
        let head = format!("{tool} ({versions})");
        // Writing to a String cannot fail.
        if above.as_ref() != Some(&head) {
            let _ = writeln!(text, "{head}");
        }
        let _ = writeln!(text, "    {question}\n        {answer}\n        findings/{script}.sh, {date}");
        above = Some(head);
    }
    Ok(text)
}
