//! A judgement as one file that answers questions: the text of the page, with figures in the place of its pictures.

use calibench_model::camera::ImageSize;
use calibench_records::judgement::{InUse, StillHolds, Summary, Trusted};

use super::{in_use, verdict};
use crate::corners::{Corner, Pictured, choose, over_frame, patches};
use crate::html::{Figures, Groups, Level, Page};
use crate::markup::escaped;

/// Where points were measured that a page of a judgement shows, and in which photographs.
#[derive(Default)]
pub struct Measured<'a> {
    /// The points of what is to be trusted with their residuals; photographs are numbered as in the summary.
    pub corners: Vec<Corner<'a>>,
    /// The photographs by their names, where they are at hand.
    pub photos: Vec<Pictured<'a>>,
    /// Their size, px.
    pub size: Option<ImageSize>,
}

/// The page: `text` is the Markdown page. `found` is what was found of a camera in use, if one was asked about; doubts were had before, of the photographs.
pub fn page(
    title: &str,
    text: &str,
    (summary, trusted): (&Summary, Option<&Trusted<'_>>),
    (found, doubts): (Option<&InUse>, &[String]),
    measured: Measured<'_>,
) -> String {
    let mut page = Page::new(title);
    match trusted {
        None => page.verdict(Level::Doubt, "Nothing could be judged", doubts.iter().cloned()),
        Some(trusted) => {
            let reasons = doubts.iter().cloned().chain(trusted.doubt().map(|why| format!("{why}: its limits do not hold")));
            let reasons: Vec<String> = reasons.collect();
            let (level, sentence) = head(summary, trusted, found, !reasons.is_empty());
            page.verdict(level, &sentence, reasons);
        }
    }
    let groups: Groups = summary.views.iter().enumerate().map(|(place, name)| (name.to_string(), place)).collect();
    // The parts of a judgement are sections of a page of their own here.
    let text = if text.contains("\n## ") { text.to_owned() } else { text.replace("\n### ", "\n## ") };
    let mut figures: Figures =
        trusted.map(|trusted| super::figures(summary, trusted)).into_iter().flatten().map(|one| (one.file(), one.html())).collect();
    page.markdown(&text, &mut figures, &groups);
    if let Some(trusted) = trusted {
        residuals(&mut page, trusted, measured);
    }
    page.render()
}

/// What the adjustment that is trusted left of each point, and the longest enlarged.
fn residuals(page: &mut Page, trusted: &Trusted<'_>, Measured { mut corners, photos, size }: Measured<'_>) {
    let Some(size) = size.filter(|_| !corners.is_empty()) else { return };
    choose(&mut corners);
    let enlarged = if photos.is_empty() { "" } else { " A click on one of the longest 200 shows its point enlarged." };
    let about = format!(
        "<p>With <code>{}</code> and <code>{}</code>, all photographs adjusted together.{enlarged}</p>\n",
        escaped(&trusted.cell.method),
        escaped(&trusted.cell.model)
    );
    page.section("Residuals over the frame", about + &over_frame("", "", size, corners.iter()).html());
    for (key, figure) in patches(&corners, &photos) {
        page.patch(key, &figure);
    }
}

fn head(summary: &Summary, trusted: &Trusted<'_>, found: Option<&InUse>, doubted: bool) -> (Level, String) {
    let bare = |text: &str| text.trim_start_matches("- ").replace(['*', '`'], "");
    if let Some(found) = found {
        let level = match found.verdict {
            StillHolds::Moved => Level::Bad,
            StillHolds::Holds if !doubted => Level::Good,
            StillHolds::Holds | StillHolds::CannotTell => Level::Doubt,
        };
        return (level, bare(&in_use(found)));
    }
    let first = verdict(summary, trusted);
    let level = match trusted.cell.split {
        _ if doubted => Level::Doubt,
        Some(_) => Level::Good,
        // Its sigmas were not tested.
        None => Level::Open,
    };
    (level, bare(first.lines().next().unwrap_or_default()))
}
