//! The page that lists all reports, each with its answer.

use std::fs;
use std::io;
use std::path::Path;

use calibench_files::at;

use crate::Written;
use crate::places::PAGE;

/// What is said of a report that was made elsewhere and could not be made again.
const KEPT: &str = " (kept as it was made elsewhere: nothing of it can be measured here)";

/// Writes the page that lists the reports that are there: each with the first paragraph of its page, which is its answer. Those that were `written` now say whether they are
/// older ones that were kept; of others that stays as it was.
///
/// # Errors
/// What the file system refuses.
pub fn write_index(reports: &Path, written: &[Written]) -> io::Result<()> {
    let before = fs::read_to_string(reports.join(PAGE)).unwrap_or_default();
    let is_of = |page: &Path, name: &str| page.parent().and_then(Path::file_name).is_some_and(|folder| folder == name);
    let is_kept = |name: &str| {
        let now = written.iter().find_map(|one| match one {
            Written::New(page) => is_of(page, name).then_some(false),
            Written::Kept(page) => is_of(page, name).then_some(true),
        });
        now.unwrap_or_else(|| before.contains(&format!("({name}/{PAGE})**{KEPT}")))
    };
    let mut names: Vec<String> = Vec::new();
    for entry in fs::read_dir(reports).map_err(|error| at(reports, &error))? {
        let entry = entry.map_err(|error| at(reports, &error))?;
        if entry.path().join(PAGE).is_file() {
            names.extend(entry.file_name().into_string());
        }
    }
    names.sort();
    let mut lines = String::new();
    for name in &names {
        let path = reports.join(name).join(PAGE);
        let page = fs::read_to_string(&path).map_err(|error| at(&path, &error))?;
        let kept = if is_kept(name) { KEPT } else { "" };
        lines.push_str(&format!("- **[{name}]({name}/{PAGE})**{kept}: {}\n", first_paragraph(&page, name)));
    }
    let text = format!(
        "# Reports\n\nThe answer of each page; behind it stand the figures. Made by `calibench report` from the records of `calibench run` and the published tables; nothing here is written by \
         hand.\n\n{lines}"
    );
    calibench_files::folder::write_beside(reports, PAGE, text.as_bytes())
}

/// What follows the title, up to an empty line, on one line; its links start from the folder above.
fn first_paragraph(page: &str, folder: &str) -> String {
    let lines = page.lines().skip(1).skip_while(|line| line.is_empty()).take_while(|line| !line.is_empty());
    lines.collect::<Vec<_>>().join(" ").replace("](", &format!("]({folder}/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_report_stands_there_with_its_answer() {
        let folder = tempfile::tempdir().unwrap();
        for (name, page) in [("b", "# b\n\nThe answer,\nwith [a link](x.md).\n\nMore.\n"), ("a", "# a\n\nNone.\n")] {
            fs::create_dir(folder.path().join(name)).unwrap();
            fs::write(folder.path().join(name).join(PAGE), page).unwrap();
        }
        fs::create_dir(folder.path().join("empty")).unwrap();
        let ends = |written: &[Written], end: &str| {
            write_index(folder.path(), written).unwrap();
            let text = fs::read_to_string(folder.path().join(PAGE)).unwrap();
            assert!(text.ends_with(end), "{text}");
        };
        let page = |name: &str| folder.path().join(name).join(PAGE);
        let as_made = "- **[a](a/README.md)**: None.\n- **[b](b/README.md)**: The answer, with [a link](b/x.md).\n";
        ends(&[], as_made);
        // One that is kept says so until it is made again.
        let kept = as_made.replace("(b/README.md)**:", &format!("(b/README.md)**{KEPT}:"));
        ends(&[Written::New(page("a")), Written::Kept(page("b"))], &kept);
        ends(&[Written::New(page("a"))], &kept);
        ends(&[Written::New(page("b"))], as_made);
    }
}
