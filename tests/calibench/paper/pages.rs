//! The pages that are written by hand, and what can be found in them.

use crate::project::root;

/// A page of Markdown.
pub struct Page {
    /// Its path below the project's folder.
    pub name: String,
    pub text: String,
}

/// README, CONTRIBUTING, the changelog, all of docs/ and the folders in it, and the list of reports.
pub fn pages() -> Vec<Page> {
    let mut names: Vec<String> = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "reports/README.md"].map(String::from).to_vec();
    let mut folders = vec!["docs".to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root().join(&folder)).unwrap() {
            let entry = entry.unwrap();
            let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
            if entry.file_type().unwrap().is_dir() { folders.push(name) } else { names.push(name) }
        }
    }
    names.retain(|name| std::path::Path::new(name).extension().is_some_and(|ending| ending == "md"));
    names.sort();
    names.iter().map(|name| Page::read(name)).collect()
}

impl Page {
    pub fn read(name: &str) -> Self {
        let text = std::fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        Self { name: name.to_owned(), text }
    }

    /// What its links and pictures lead to.
    pub fn links(&self) -> Vec<String> {
        self.text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).map(str::to_owned).collect()
    }

    /// The commands of `calibench` in its indented blocks and consoles, without comments and what the shell does with them.
    pub fn commands(&self) -> Vec<String> {
        let shown = |line: &&str| line.starts_with("    ") || line.starts_with("$ ");
        let commands = self.text.lines().filter(shown).filter_map(|line| line.trim_start_matches("$ ").trim().strip_prefix("calibench "));
        // The first of alternatives: `list scenarios | methods`.
        let alone = |line: &str| {
            [" # ", " | ", " > ", " && ", "; "].iter().fold(line, |line, end| line.split(end).next().unwrap()).trim().to_owned()
        };
        commands.map(alone).filter(|line| !line.starts_with('-')).collect()
    }

    /// Its fenced blocks, each with the text before it; what is indented as a whole loses that.
    pub fn fenced(&self) -> Vec<(String, String)> {
        let mut found = Vec::new();
        let (mut before, mut block): (String, Option<Vec<&str>>) = (String::new(), None);
        for line in self.text.lines() {
            match (&mut block, line.trim_start().starts_with("```")) {
                (None, true) => block = Some(Vec::new()),
                (None, false) => before.push_str(line),
                (Some(lines), false) => lines.push(line),
                (Some(lines), true) => {
                    found.push((before.clone(), unindented(lines)));
                    block = None;
                }
            }
        }
        found
    }
}

/// In a list the fence is indented by three.
fn unindented(lines: &[&str]) -> String {
    let listed = lines.iter().all(|line| line.is_empty() || line.starts_with("   "));
    let strip = |line: &&str| if listed { line.get(3..).unwrap_or("").to_owned() } else { (*line).to_owned() };
    lines.iter().map(strip).collect::<Vec<_>>().join("\n")
}

/// The anchors of a page's headings.
pub fn anchors(text: &str) -> Vec<String> {
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let anchor = |heading: &str| -> String {
        let kept = heading.trim_start_matches('#').trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.map(|c| if c == ' ' { '-' } else { c }).flat_map(char::to_lowercase).collect()
    };
    headings.map(anchor).collect()
}
