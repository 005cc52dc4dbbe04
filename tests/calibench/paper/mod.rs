//! What is written for people agrees with what there is: links, commands, figures, tables, examples.

mod examples;
mod pages;
pub mod typed;

use crate::project::{root, run, stdout};
use pages::{Page, anchors, pages};

#[test]
fn the_readme_is_one_screen() {
    assert!(Page::read("README.md").text.len() <= 7000, "README.md has {} bytes", Page::read("README.md").text.len());
}

#[test]
fn links_lead_somewhere() {
    for page in pages() {
        for link in page.links() {
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = if file.is_empty() { root().join(&page.name) } else { root().join(&page.name).parent().unwrap().join(file) };
            assert!(target.exists(), "{}: {link} is not there", page.name);
            if !anchor.is_empty() {
                let text = std::fs::read_to_string(&target).unwrap();
                assert!(anchors(&text).contains(&anchor.to_owned()), "{}: {link}: no such heading in {:?}", page.name, anchors(&text));
            }
        }
    }
}

/// Every command that stands in an indented block or a console exists, with all its options.
#[test]
fn commands_and_options_exist() {
    let mut tried = 0;
    for page in pages() {
        for command in page.commands() {
            let words: Vec<&str> = command.split_whitespace().collect();
            let help = stdout(&run(&root(), &[words[0], "--help"]));
            assert!(help.contains("Usage:"), "{}: `calibench {command}`: no such command", page.name);
            for option in words.iter().filter_map(|word| word.trim_start_matches('[').strip_prefix("--")) {
                let option = option.trim_end_matches(']').split('=').next().unwrap();
                assert!(help.contains(&format!("--{option}")), "{}: `calibench {command}`: no option --{option}", page.name);
            }
            if words[0] == "list" {
                words[1..].iter().filter(|word| word.chars().all(char::is_alphabetic)).for_each(|word| {
                    assert!(help.contains(&format!("{word}:")), "{}: `calibench {command}`", page.name);
                });
            }
            tried += 1;
        }
    }
    assert!(tried > 100, "{tried}");
}

/// Each figure among the README's findings stands on the page that the finding links to.
#[test]
fn the_findings_stand_in_the_reports() {
    let readme = Page::read("README.md");
    let section = readme.text.split("## What was found").nth(1).unwrap().split("\n## ").next().unwrap();
    let findings: Vec<&str> = section.split("\n- ").skip(1).collect();
    assert_eq!(findings.len(), 9);
    for finding in findings {
        let linked = readme.links().into_iter().filter(|link| finding.contains(&format!("]({link})")));
        let text: String =
            linked.map(|link| std::fs::read_to_string(root().join(link.split('#').next().unwrap_or(&link))).unwrap()).collect();
        let figures: Vec<&str> = finding
            .split(|c: char| !(c.is_ascii_digit() || c == '.'))
            .map(|word| word.trim_end_matches('.'))
            .filter(|word| word.parse::<f64>().is_ok())
            .collect();
        assert!(!figures.is_empty(), "{finding}");
        // Counts are compared with what they count, below.
        for figure in figures.into_iter().filter(|figure| figure.contains('.')) {
            assert!(text.contains(figure), "{figure} stands in no report linked from: {finding}");
        }
    }
}

/// The page of a paper is one screen: all its figures were run, what it shows and links to is there, and it is short.
#[test]
fn the_pages_of_papers_are_one_screen() {
    let papers = calibench_report::published::papers(&root().join("reference/published"));
    assert_eq!(papers.len(), 4);
    for paper in papers {
        let [first, predictions] = ["README.md", "predictions.md"].map(|name| Page::read(&format!("reports/{paper}/{name}")));
        assert!(first.text.split_whitespace().count() < 800, "{paper}: {} words", first.text.split_whitespace().count());
        assert_eq!(first.text.matches("![").count(), 1, "{paper}: one picture");
        assert!(!Page::read(&format!("reports/{paper}/tables.md")).text.contains("(not run here)"), "{paper}: what was found out");
        for page in [first, predictions] {
            assert!(!page.text.contains("(not run here)"), "{}", page.name);
            for link in page.links() {
                assert!(root().join("reports").join(&paper).join(&link).is_file(), "{}: {link}", page.name);
            }
        }
    }
}

/// The README counts printed figures as the pages of the papers do together.
#[test]
fn printed_figures_are_counted_as_on_their_pages() {
    let pages: String = calibench_report::published::papers(&root().join("reference/published"))
        .iter()
        .map(|paper| Page::read(&format!("reports/{paper}/README.md")).text.lines().nth(2).unwrap().to_lowercase() + "\n")
        .collect();
    let number = |text: &str| {
        text.trim_start_matches(|c: char| !c.is_ascii_digit()).split(|c: char| !c.is_ascii_digit()).next()?.parse::<usize>().ok()
    };
    let readme = Page::read("README.md").text.replace("\n  ", " ").replace(['[', ']'], "");
    for (in_pages, in_readme) in [
        ("printed figures", "printed figures"),
        ("consequences of fitted figures", "consequences of fitted ones"),
        ("reconstructions", "reconstructions"),
        ("definitions and arithmetic", "definitions and arithmetic"),
    ] {
        let of = |text: &str, name: &str| -> Vec<usize> {
            let before = |line: &str| line.rsplit(' ').next().and_then(number);
            text.match_indices(&format!(" {name}")).filter_map(|(at, _)| before(&text[..at])).collect()
        };
        let (sum, told) = (of(&pages, in_pages).iter().sum::<usize>(), of(&readme, in_readme));
        assert_eq!(told, [sum], "{in_readme}: README and the pages of the papers");
    }
    assert_eq!(pages.matches("none is a prediction").count(), 4, "README: none was predicted");
}

/// The table of crates in the page on architecture is what Cargo knows.
#[test]
fn the_table_of_crates_is_that_of_cargo() {
    let page = Page::read("docs/ARCHITECTURE.md");
    let mut rows: Vec<(String, Vec<String>)> = Vec::new();
    for line in page.text.lines().filter(|line| line.starts_with("| `") && line.matches('|').count() == 4) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let mut needs: Vec<String> = cells[2].split(", ").map(|need| need.trim_matches('`').to_owned()).filter(|n| !n.is_empty()).collect();
        needs.sort();
        rows.push((cells[0].trim_matches('`').to_owned(), needs));
    }
    rows.sort();
    let mut crates: Vec<(String, Vec<String>)> = Vec::new();
    for entry in std::fs::read_dir(root().join("harness")).unwrap() {
        let manifest = entry.unwrap().path().join("Cargo.toml");
        let Ok(text) = std::fs::read_to_string(&manifest) else { continue };
        let value: toml::Table = toml::from_str(&text).unwrap();
        let name = manifest.parent().unwrap().file_name().unwrap().to_string_lossy().into_owned();
        let needed = value.get("dependencies").and_then(toml::Value::as_table).into_iter().flat_map(toml::Table::keys);
        let mut needs: Vec<String> = needed.filter_map(|key| key.strip_prefix("calibench-")).map(str::to_owned).collect();
        needs.sort();
        crates.push((name, needs));
    }
    crates.sort();
    assert_eq!(rows, crates, "docs/ARCHITECTURE.md: the table of crates");
}

/// What CONTRIBUTING quotes stands in the example that was linked last before it.
#[test]
fn what_is_quoted_stands_in_the_examples() {
    let page = Page::read("CONTRIBUTING.md");
    let mut quoted = 0;
    for (before, block) in page.fenced() {
        let file = before.rsplit("](examples/").next().unwrap().split(')').next().unwrap();
        let example = std::fs::read_to_string(root().join("examples").join(file)).unwrap();
        assert!(example.contains(&block), "{file} does not contain\n{block}");
        quoted += 1;
    }
    assert_eq!(quoted, 5);
}

#[test]
fn every_method_has_its_row() {
    let page = Page::read("docs/methods.md");
    let rows: String = page.text.lines().filter(|line| line.starts_with("| `")).collect();
    for method in calibench_opencv::registry().methods() {
        assert!(rows.contains(&format!("`{}`", method.name)), "docs/methods.md has no row for {}", method.name);
    }
}

/// The keys and metrics of published tables are all described, and no others.
#[test]
fn keys_and_metrics_of_published_tables_are_described() {
    let page = Page::read("docs/published-tables.md");
    let first_cells =
        page.text.lines().filter(|line| line.starts_with("| `")).map(|line| line.trim_matches('|').split('|').next().unwrap());
    let mut described: Vec<String> =
        first_cells.flat_map(|cell| cell.split(", ")).map(|name| name.trim().trim_matches(['`', '[', ']']).to_owned()).collect();
    described.sort();
    described.dedup();
    let schema = calibench_report::published::schema();
    let mut names: Vec<String> = Vec::new();
    let keys = |of: &serde_json::Value| of["properties"].as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    names.extend(keys(&schema));
    names.extend(keys(&schema["$defs"]["Cell"]));
    let metrics = schema["$defs"]["Metric"]["oneOf"].as_array().unwrap();
    names.extend(metrics.iter().map(|metric| metric["const"].as_str().unwrap().to_owned()));
    names.sort();
    names.dedup();
    assert_eq!(described, names);
}
