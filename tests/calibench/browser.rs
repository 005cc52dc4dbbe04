//! Pages that are one file, as a reader has them: in a browser without a network.

use std::path::Path;
use std::process::Command;

use crate::calibrate::{WALL, wall};
use crate::project::{copy_with, run, stderr, stdout};

/// A photograph's and a target's name that would do something on a page that does not escape them.
const PHOTO: &str = "<img src=x onerror=alert(1)>.png";
const TARGET: &str = "</script><script>alert(2)</script>";

/// Pages of calibrations and of a judgement, of names that are hostile among them.
pub fn pages(here: &Path) {
    let images = crate::judge::board(here);
    std::fs::rename(here.join(&images[0]), here.join("board").join(PHOTO)).unwrap();
    let photo = format!("board/{PHOTO}");
    let images: Vec<&str> = std::iter::once(photo.as_str()).chain(images[1..].iter().map(String::as_str)).collect();
    let made = run(here, &[&["calibrate", "--chessboard", "9x6:25", "-q", "--report", "pages/photographs"], &images[..]].concat());
    assert!(made.status.code() != Some(2), "{}", stderr(&made));
    let models = ["-m", "pixel", "-m", "parametric_corner", "--model", "opencv4:fx,fy,cx,cy", "--model", "opencv4+bent", "--splits", "3"];
    let made = run(here, &[&["judge", "--chessboard", "9x6:25", "-q", "--report", "pages/judgement"], &models[..], &images[..]].concat());
    assert!(made.status.success(), "{}", stderr(&made));
    for name in ["points.csv", "control.csv"] {
        let file = here.join("wall-points").join(name);
        let text = std::fs::read_to_string(&file).unwrap().replace("p1-1/1", &format!("\"{TARGET}\""));
        std::fs::write(file, text).unwrap();
    }
    let made = run(&here.join("wall-points"), &[&WALL[..], &["--datum", "free", "--snoop", "-q", "--report", "../pages/free"]].concat());
    assert!(made.status.code() != Some(2), "{}", stderr(&made));
}

/// A folder with what the pages are made of.
pub fn folder() -> tempfile::TempDir {
    let folder = wall();
    std::fs::create_dir(folder.path().join("wall-points")).unwrap();
    for name in ["points.csv", "control.csv"] {
        std::fs::rename(folder.path().join(name), folder.path().join("wall-points").join(name)).unwrap();
    }
    std::fs::create_dir(folder.path().join("pages")).unwrap();
    folder
}

#[test]
#[cfg_attr(not(browser), ignore = "no Chromium to open pages in: `./bootstrap browser` installs it")]
fn pages_answer_and_ask_for_nothing() {
    let folder = folder();
    pages(folder.path());
    open(&folder.path().join("pages"), &[]);
}

/// The cells of the tables of a Markdown text, and of a page, as a reader sees them.
#[test]
fn a_page_has_the_numbers_of_the_markdown() {
    let folder = folder();
    pages(folder.path());
    for (name, least) in [("photographs", 200), ("judgement", 100), ("free", 150)] {
        let read = |file: &str| std::fs::read_to_string(folder.path().join("pages").join(name).join(file)).unwrap();
        let (markdown, html) = (of_markdown(&read("README.md")), of_html(&read("report.html")));
        assert!(markdown.len() > least, "{name}: {}", markdown.len());
        assert_eq!(markdown, html, "{name}");
        assert!(read("report.html").len() < 5_000_000, "{name}");
        // Where there are photographs the longest 200 residuals are enlarged, each for a mark of its own.
        let page = read("report.html");
        let patches = page.matches("<figure class=\"patch\"").count();
        assert_eq!(patches, if name == "free" { 0 } else { 200 }, "{name}");
        let marked = (0..patches).filter(|key| page.matches(&format!(" data-k=\"{key}\"")).count() > 1).count();
        assert_eq!(marked, patches, "{name}");
    }
}

/// Without what marks and escapes, and without spaces.
fn bare(text: &str) -> String {
    let entities = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#39;", "'"), ("&amp;", "&")];
    let text = entities.iter().fold(text.to_owned(), |text, (entity, c)| text.replace(entity, c));
    text.chars().filter(|c| !c.is_whitespace() && !"\\*`".contains(*c)).collect()
}

fn of_markdown(text: &str) -> Vec<String> {
    let rows = text.lines().filter(|line| line.starts_with('|') && !line.starts_with("| --") && !line.starts_with("| :-"));
    rows.flat_map(|row| row.trim_matches('|').split(" | ").map(|cell| bare(&without_links(cell))).collect::<Vec<_>>()).collect()
}

fn without_links(text: &str) -> String {
    let (mut out, mut rest) = (String::new(), text);
    while let Some((before, after)) = rest.split_once("](") {
        out.push_str(&before.replacen('[', "", 1));
        rest = after.split_once(')').map_or("", |(_, rest)| rest);
    }
    out + rest
}

fn of_html(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for cell in text.split("<t").skip(1).filter(|cell| cell.starts_with("d>") || cell.starts_with("d ") || cell.starts_with("h ")) {
        let end = cell.find("</t").unwrap();
        let mut plain = String::new();
        let mut is_tag = false;
        for c in cell[cell.find('>').unwrap() + 1..end].chars() {
            match c {
                '<' => is_tag = true,
                '>' => is_tag = false,
                c if !is_tag => plain.push(c),
                _ => {}
            }
        }
        found.push(bare(&plain));
    }
    found
}

/// All reports as one file: the numbers of each page of the Markdown, no more than 5 MB, the same bytes again; and the explorer in Chromium.
#[test]
fn all_reports_are_one_file_with_the_numbers_of_the_markdown() {
    let project = copy_with(&["atlas"]);
    let here = project.path();
    let mut names: Vec<String> = std::fs::read_dir(here.join("scenarios/atlas"))
        .unwrap()
        .map(|entry| format!("atlas/{}", entry.unwrap().path().file_stem().unwrap().to_str().unwrap()))
        .collect();
    names.sort();
    let ran: Vec<&str> = ["run", "-q", "--trials", "2"].into_iter().chain(names.iter().map(String::as_str)).collect();
    for command in [&ran[..], &["report", "-q", "atlas"], &["report", "-q", "--html", "atlas"]] {
        let done = run(here, command);
        assert!(done.status.success(), "{command:?}: {}", stderr(&done));
    }
    let (folder, page) = (here.join("reports/html"), here.join("reports/html/report.html"));
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.len() < 5_000_000 && html.contains("<svg"), "{}", html.len());
    let shown = of_html(&html);
    for file in ["README.md", "which-operator.md", "neighbours.md"] {
        let cells = of_markdown(&std::fs::read_to_string(here.join("reports/atlas").join(file)).unwrap());
        assert!(cells.len() > 30 && shown.windows(cells.len()).any(|part| part == cells), "{file}");
    }
    // Curves answer: their methods are named once a figure, their places with all of their values.
    assert!(html.matches(" data-of=\"").count() > 10 && html.matches(" data-p=\"").count() > 50);
    assert!(run(here, &["report", "-q", "--html", "atlas", "--threads", "1"]).status.success());
    assert!(std::fs::read_to_string(&page).unwrap() == html, "other bytes from the same records");

    open(&folder, &["test_explorer.py", "test_drawings.py", "test_page.py"]);
}

/// Opens the pages of a folder in the browser and runs these tests on them, or all.
fn open(pages: &Path, tests: &[&str]) {
    let Some(environment) = option_env!("CALIBENCH_BROWSER").filter(|_| cfg!(browser)) else { return };
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/browser"));
    let done = Command::new(Path::new(environment).join("bin/python"))
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider"])
        .args(if tests.is_empty() { vec![folder.to_owned()] } else { tests.iter().map(|test| folder.join(test)).collect() })
        .env("CALIBENCH_PAGES", pages)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    assert!(done.status.success(), "{}{}", stdout(&done), stderr(&done));
}
