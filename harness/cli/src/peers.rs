//! `calibench list peers`: what other tools' numbers mean, by what was asked of them.

use std::fmt::Write;

use crate::failure::Failure;

/// Columns tool, versions, question, answer, script (a name in `findings/`), date; lines of one tool and its versions stand together.
const TABLE: &str = include_str!("peers.csv");

/// The rows of the table, by its columns.
pub fn peer_rows() -> Result<Vec<[String; 6]>, Failure> {
    csv::Reader::from_reader(TABLE.as_bytes()).deserialize().map(|row| Ok(row?)).collect()
}

/// The table as `list` prints it.
pub fn peers() -> Result<String, Failure> {
    let mut text = String::new();
    let mut above = None;
    for [tool, versions, question, answer, script, date] in peer_rows()? {
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
