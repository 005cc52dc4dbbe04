//! The image scale on a page: a row for each method.

use calibench_records::figures::Quantity;

use crate::load::Loaded;
use crate::load::adjustments::Summaries;
use crate::markdown::{MarkdownTable, with_half};
use crate::studies::section::Section;
use crate::studies::shown::{OnPage, Shown};

/// The image scale along a line.
pub struct Scale;

impl Section for Scale {
    fn of(&self, loaded: &Loaded, _: OnPage<'_>) -> Shown {
        Shown { text: loaded.calibrations.as_ref().map(table).unwrap_or_default(), ..Shown::default() }
    }
}

/// Pixels to an object unit, mean over the trials ± half its 95 % interval.
pub fn table(found: &Summaries) -> String {
    let mut rows = MarkdownTable::new(&["method", "pixels to a unit"]);
    for method in &found.methods {
        let scale = found.get(method, Quantity::ImageScale).map(|summary| &summary.value);
        let cell = scale.and_then(|value| Some(with_half(value.mean()?, value.half(), 2)));
        rows.row([format!("`{method}`"), cell.unwrap_or_default()]);
    }
    format!("{}\n", rows.render())
}
