//! The page that lists all reports, each with its answer.

use std::fs;
use std::io;
use std::path::Path;

use calibench_files::at;

use crate::places::PAGE;

/// Writes the page that lists the reports that are there: each with the first paragraph of its page, which is its answer.
///
/// # Errors
/// What the file system refuses.
pub fn write_index(reports: &Path) -> io::Result<()> {
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
        lines.push_str(&format!("- **[{name}]({name}/{PAGE})**: {}\n", first_paragraph(&page, name)));
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
        write_index(folder.path()).unwrap();
        let text = fs::read_to_string(folder.path().join(PAGE)).unwrap();
        assert!(text.ends_with("- **[a](a/README.md)**: None.\n- **[b](b/README.md)**: The answer, with [a link](b/x.md).\n"), "{text}");
    }
}
