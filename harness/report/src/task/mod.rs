//! What a task costs, in words and as a picture.

mod picture;

use calibench_task::{Budget, Component, Task};

use crate::markdown::{MarkdownTable, plain};

pub use picture::maps;

/// Beyond this the ends of intervals are said to be elsewhere than the derivatives say.
const FAILS: &str =
    "the errors are so large that what is measured does not follow from them in a line, or fails: the interval is not to be relied on";

/// Why a budget is not to be relied on; `camera` is what is in doubt of the calibration itself.
pub fn doubts(budget: &Budget, has_covariance: bool, camera: &[String]) -> Vec<String> {
    let unknown = "the camera's file says nothing of its uncertainty: the camera is taken as exact, and the interval is too short";
    let unknown = (!has_covariance).then(|| unknown.to_owned());
    let bent = budget.is_bent().then(|| FAILS.to_owned());
    camera.iter().map(|doubt| format!("the calibration: {doubt}")).chain(unknown).chain(bent).collect()
}

/// The unit of a number.
pub(crate) fn unit_of<'a>(task: &'a Task, component: &Component) -> Option<&'a str> {
    if component.named.in_degrees { Some("degrees") } else { task.unit.as_deref() }
}

/// What is measured with its 95 % interval, a table of what makes that up, and what is taken as exact.
pub fn of_task(task: &Task, budget: &Budget) -> String {
    let mut text = String::new();
    for component in &budget.components {
        let unit = unit_of(task, component);
        let with_unit = |number: f64| unit.map_or_else(|| plain(number), |unit| format!("{} {unit}", plain(number)));
        let value = component.named.value.map_or_else(String::new, |value| format!(" {}", with_unit(value)));
        text.push_str(&format!(
            "{}{value}: within \u{b1} {} in 95 of 100 measurements (standard uncertainty {})\n",
            component.named.name,
            with_unit(component.half()),
            with_unit(component.sigma)
        ));
    }
    text.push('\n');
    text.push_str(&table(task, budget));
    text.push('\n');
    for exact in &budget.exact {
        text.push_str(&format!("taken as exact: {}\n", exact.words()));
    }
    if budget.uncorrelated {
        text.push_str(
            "note: the camera's file has no correlations of its parameters: taken as independent, which makes most intervals too long\n",
        );
    }
    text
}

/// What each source makes alone, and its share of the variance, for each number.
fn table(task: &Task, budget: &Budget) -> String {
    let several = budget.components.len() > 1;
    let heads = budget.components.iter().flat_map(|component| {
        let of = if several { format!("{}, ", component.named.name) } else { String::new() };
        let unit = unit_of(task, component).map_or_else(String::new, |unit| format!(", {unit}"));
        let sigma = if several { format!("{}{unit}", component.named.name) } else { format!("standard uncertainty{unit}") };
        [sigma, format!("{of}share, %")]
    });
    let heads: Vec<String> = std::iter::once("source".to_owned()).chain(heads).collect();
    let mut table = MarkdownTable::new(&heads.iter().map(String::as_str).collect::<Vec<_>>());
    let sources = budget.components.first().map_or(0, |component| component.parts.len());
    for place in 0..sources {
        let parts = budget.components.iter().map(|component| component.parts[place]);
        let cells = parts.clone().flat_map(|part| [plain(part.sigma), format!("{:.1}", 100.0 * part.share)]);
        let words = budget.components[0].parts[place].source.words().to_owned();
        table.row(std::iter::once(words).chain(cells));
    }
    table.render()
}
