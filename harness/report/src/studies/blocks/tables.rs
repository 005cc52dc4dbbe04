//! Tables of free networks.

use calibench_records::description::Blocks;
use calibench_records::figures::{Group, Quantity};

use crate::load::adjustments::{Summaries, Summary};
use crate::markdown::{MarkdownTable, fixed};

/// The names under which other figures than those of blocks stand.
const RESIDUALS: &str = "residuals";
const RECOGNITION: &str = "recognition";
/// Digits of sigma0: one more than elsewhere, for it is compared with what operators say of themselves.
const SIGMA0: usize = 4;

/// A figure's mean over the trials with half its 95 % interval.
fn mean(summary: Option<&Summary>, digits: usize) -> String {
    let text = |summary: &Summary| {
        let value = fixed(summary.value.mean()?, digits);
        // A count that is the same in all trials has no interval.
        let half = summary.value.half().map(|half| fixed(half, digits)).filter(|half| half.chars().any(|c| ('1'..='9').contains(&c)));
        Some(half.map_or(value.clone(), |half| format!("{value} ± {half}")))
    };
    summary.and_then(text).unwrap_or_default()
}

/// A figure by method and block.
struct Of<'a>(&'a Summaries, &'a str, &'a str);

impl<'a> Of<'a> {
    fn get(&self, quantity: Quantity) -> Option<&'a Summary> {
        self.0.of_set(self.1, self.2, quantity)
    }

    /// With the digits of the catalogue.
    fn shown(&self, quantity: Quantity) -> String {
        mean(self.get(quantity), quantity.entry().digits)
    }
}

/// Every block with every method: counts and sigma0.
pub fn blocks(found: &Summaries) -> String {
    let names = ["block", "method", "networks", "images", "points", "observations", "unknowns", "redundancy", "sigma0, px", "sigma0, um"];
    let mut rows = MarkdownTable::new(&[&names[..], &["gross errors", "rows over columns"]].concat());
    for set in found.sets.iter().filter(|set| *set != RESIDUALS && *set != RECOGNITION) {
        for method in &found.methods {
            let of = Of(found, method, set);
            let Some(_) = of.get(Quantity::Redundancy) else { continue };
            let networks = of.get(Quantity::Networks).map_or_else(|| "1".to_owned(), |_| of.shown(Quantity::Networks));
            let counts = [Quantity::Images, Quantity::Points, Quantity::Observations, Quantity::Unknowns, Quantity::Redundancy]
                .map(|count| of.shown(count));
            let sigmas = [
                mean(of.get(Quantity::Sigma0), SIGMA0),
                of.shown(Quantity::Sigma0Um),
                of.shown(Quantity::GrossErrors),
                of.shown(Quantity::RowsOverColumns),
            ];
            rows.row([set.clone(), format!("`{method}`"), networks].into_iter().chain(counts).chain(sigmas));
        }
    }
    format!(
        "### Blocks\n\nFree networks, mean of {} trials ± half its 95 % interval; of several networks their mean. Coordinates that hold the frame count as unknowns and as observations. \
         *Rows over columns*: root mean square residual in y over that in x.\n\n{}\n{}",
        found.trials,
        rows.render(),
        bends(found)
    )
}

/// Bends that were asked for.
fn bends(found: &Summaries) -> String {
    let mut lines = String::new();
    for set in &found.sets {
        for method in &found.methods {
            let of = Of(found, method, set);
            if let (Some(along), Some(_)) = (of.get(Quantity::BendX), of.get(Quantity::BendY)) {
                let single = along.value.deviation().map_or_else(String::new, |d| format!(" (a single trial scatters by {})", fixed(d, 3)));
                let (x, y) = (of.shown(Quantity::BendX), of.shown(Quantity::BendY));
                lines.push_str(&format!("- `{set}`, `{method}`: the object points bend by {x} along X{single} and by {y} along Y.\n"));
            }
        }
    }
    if lines.is_empty() { lines } else { format!("{lines}\n") }
}

/// How well the points of the blocks were located, where that is known.
pub fn location(found: &Summaries) -> String {
    let header =
        ["block", "method", "error of a coordinate, px", "sigma0, px", "own sigma, px", "own sigma / sigma0", "lost, %", "rejected, %"];
    let mut rows = MarkdownTable::new(&header);
    let mut any = false;
    let percent =
        |summary: Option<&Summary>| summary.and_then(|s| s.value.mean()).map_or_else(String::new, |share| fixed(100.0 * share, 2));
    for set in &found.sets {
        for method in &found.methods {
            let of = Of(found, method, set);
            let Some(_) = of.get(Quantity::CoordinateError) else { continue };
            any = true;
            let shown = [
                of.shown(Quantity::CoordinateError),
                mean(of.get(Quantity::Sigma0), SIGMA0),
                of.shown(Quantity::OwnSigma),
                of.shown(Quantity::OwnSigmaOverSigma0),
            ];
            let shares = [percent(of.get(Quantity::Lost)), percent(of.get(Quantity::Rejected))];
            rows.row([set.clone(), format!("`{method}`")].into_iter().chain(shown).chain(shares));
        }
    }
    if !any {
        return String::new();
    }
    format!(
        "### Location\n\n*Error of a coordinate*: root mean square against the truth, per axis, with all that is systematic in it. *Own sigma*: what the operator itself says. *Lost*: more than a pixel \
         from the truth.\n\n{}\n",
        rows.render()
    )
}

/// What residuals have in common in pairs of images.
pub fn residuals(found: &Summaries, told: &Blocks) -> String {
    let mut rows = MarkdownTable::new(&["method", "pairs", "correlation within pairs", "correlation across pairs"]);
    let mut any = false;
    for method in &found.methods {
        let of = Of(found, method, RESIDUALS);
        if of.get(Quantity::Pairs).is_some() {
            any = true;
            let shown = [Quantity::Pairs, Quantity::CorrelationWithin, Quantity::CorrelationAcross].map(|quantity| of.shown(quantity));
            rows.row([format!("`{method}`")].into_iter().chain(shown));
        }
    }
    if !any {
        return String::new();
    }
    let compared = told.compared.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    format!(
        "### Residuals in pairs of images\n\nCorrelation of the residuals of equal targets ({compared}) within {} pairs, the first of which is {} with {}, and of the first image of a pair with the \
         second of another.\n\n{}\n",
        told.pairs.len(),
        told.pairs.first().map_or("", |pair| &pair[0]),
        told.pairs.first().map_or("", |pair| &pair[1]),
        rows.render()
    )
}

/// Blocks that have no result in some trials, and why.
pub fn failures(found: &Summaries) -> String {
    let line = |((method, set, _), (count, why)): (&(String, String, Group), &(u64, String))| {
        format!("- `{set}`, `{method}`: {count} of {} trials have no result, the first because {why}.\n", found.trials)
    };
    let lines: String = found.failed.iter().map(line).collect();
    if lines.is_empty() { lines } else { format!("**Without a result:**\n\n{lines}\n") }
}
