//! All reports as one file.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use rayon::prelude::*;

use crate::html::{Converted, Drawing, Page, Section, explorer, in_place};
use crate::markup::escaped;
use crate::places::PAGE;
use crate::{Composed, Places, ReportError, compose, composed};

/// The name of the file.
pub const ONE_FILE: &str = "report.html";

/// The pages of a family as sections of the one file, with their anchors.
pub struct FamilyPages {
    sections: Vec<Section>,
    /// The first paragraph of the family's page, as HTML.
    answer: String,
    family: String,
    explorer: Option<serde_json::Value>,
}

/// The pages of a family from its records and published tables, or, where nothing of it could be measured here, from the report that is there.
///
/// # Errors
/// As [`compose`].
pub fn family_pages(places: &Places, family: &str, scenarios: &[String]) -> Result<FamilyPages, ReportError> {
    let kept;
    let composed = match compose(places, family, scenarios)? {
        Some(composed) => {
            kept = false;
            composed
        }
        None => {
            kept = true;
            Composed::page(composed::kept(places, family)?, Vec::new())
        }
    };
    let drawn: BTreeMap<&str, Drawing> = composed.pictures.par_iter().map(|(name, canvas)| (name.as_str(), Drawing::of(canvas))).collect();
    let folder = places.reports.join(family);
    let mut pages = FamilyPages { sections: Vec::new(), answer: String::new(), family: family.to_owned(), explorer: composed.explorer };
    for (file, text) in &composed.pages {
        let id = page_id(family, file);
        let mut figure = |name: &str, caption: &str| match drawn.get(name) {
            Some(drawing) => Some(drawing.figure(&format!("{id}--{name}"), caption)),
            None if kept => still(&folder.join(name), caption),
            None => None,
        };
        let link = |target: &str| anchor_of(family, file, target);
        let Converted { title, lead, body } = in_place(text, &id, &mut figure, &link);
        if file == PAGE {
            pages.answer = lead;
        }
        let heading = if title.is_empty() { escaped(family) } else { title };
        pages.sections.push(Section { anchor: id, heading, body });
    }
    Ok(pages)
}

/// A picture of an older report.
fn still(path: &Path, caption: &str) -> Option<String> {
    let png = std::fs::read(path).ok()?;
    let caption = escaped(caption);
    Some(format!(
        "<figure><img alt=\"{caption}\" src=\"data:image/png;base64,{}\"><figcaption>{caption}</figcaption></figure>\n",
        STANDARD.encode(png)
    ))
}

/// The file of all these pages.
pub fn one_file(families: &[FamilyPages]) -> String {
    let mut page = Page::new("Reports");
    let item = |one: &FamilyPages| {
        format!("<li><a href=\"#{0}\"><strong>{1}</strong></a>: {2}</li>\n", page_id(&one.family, PAGE), escaped(&one.family), one.answer)
    };
    let answers: String = families.iter().map(item).collect();
    page.section("The answer of each page", format!("<ul>\n{answers}</ul>\n"));
    if let Some(data) = families.iter().find_map(|one| one.explorer.as_ref()) {
        page.section("Which operator for my images", explorer::body(data));
    }
    families.iter().flat_map(|one| &one.sections).for_each(|section| page.add(section.clone()));
    without_dead_links(&page.render())
}

/// The anchor of a page: of a family its name, of what stands beside its own page the name of both.
fn page_id(family: &str, file: &str) -> String {
    let stem = file.strip_suffix(".md").unwrap_or(file);
    if file == PAGE { family.to_owned() } else { format!("{family}-{stem}") }
}

/// The anchor in the one file that a link of a page of a family goes to; `None` for what is not in it.
fn anchor_of(family: &str, page: &str, target: &str) -> Option<String> {
    if target.contains("://") {
        return None;
    }
    let (file, anchor) = target.split_once('#').map_or((target, None), |(file, anchor)| (file, Some(anchor)));
    let path = if file.is_empty() { Path::new(family).join(page) } else { resolved(&Path::new(family).join(file))? };
    let mut parts = path.iter().map(|part| part.to_string_lossy());
    let (family, file) = (parts.next()?.into_owned(), parts.next()?.into_owned());
    if parts.next().is_some() || Path::new(&file).extension().is_none_or(|ending| ending != "md") {
        return None;
    }
    let id = page_id(&family, &file);
    Some(anchor.map_or(id.clone(), |anchor| format!("{id}--{anchor}")))
}

/// Without `..`; `None` for what is above the reports.
fn resolved(path: &Path) -> Option<PathBuf> {
    let mut found = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir if !found.pop() => return None,
            Component::Normal(name) => found.push(name),
            _ => {}
        }
    }
    Some(found)
}

/// Links to places that are not on the page become text.
fn without_dead_links(html: &str) -> String {
    let places: BTreeSet<&str> = html.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let mut pieces = html.split("<a href=\"#");
    let mut out = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let Some((target, rest)) = piece.split_once('"') else { continue };
        if places.contains(target) {
            out.push_str(&format!("<a href=\"#{target}\"{rest}"));
        } else {
            out.push_str(&format!("<a{rest}"));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_go_to_pages_in_the_file_or_are_text() {
        let of = |target: &str| anchor_of("atlas", "which-operator.md", target);
        assert_eq!(of("README.md").as_deref(), Some("atlas"));
        assert_eq!(of("#discs").as_deref(), Some("atlas-which-operator--discs"));
        assert_eq!(of("neighbours.md#a-b").as_deref(), Some("atlas-neighbours--a-b"));
        assert_eq!(of("../galo-2011/README.md#table-1").as_deref(), Some("galo-2011--table-1"));
        for outside in ["numbers.csv", "../../docs/methods.md", "https://example.org/x.md", "../x/y/z.md", "../README.md"] {
            assert_eq!(of(outside), None, "{outside}");
        }
        let html = "<p id=\"here\"><a href=\"#here\">a</a> <a href=\"#gone\">b</a></p>";
        assert_eq!(without_dead_links(html), "<p id=\"here\"><a href=\"#here\">a</a> <a>b</a></p>");
    }
}
