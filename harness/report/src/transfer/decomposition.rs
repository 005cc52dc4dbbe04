//! Which cause makes how much of an error.

use calibench_records::results::Group;

use super::cases::hundredths;
use crate::load::adjustments::{Summaries, Summary};
use crate::markdown::{MarkdownTable, fixed, with_half};

/// How many pairs of causes are shown.
const PAIRS: usize = 5;

/// Every split of an error, with the method that it belongs to.
pub fn tables(found: &Summaries) -> String {
    let all = found.sets.iter().flat_map(|set| found.methods.iter().map(move |method| (set, method)));
    all.filter_map(|(set, method)| table(found, set, method)).collect()
}

/// The figures whose names begin with `prefix`: what follows it, in the order of the names.
fn named<'a>(found: &'a Summaries, set: &str, method: &str, prefix: &str) -> Vec<(&'a str, &'a Summary)> {
    let of = |((m, s, group, name), summary): (&'a (String, String, Group, String), &'a Summary)| {
        (m == method && s == set && *group == Group::Check).then(|| Some((name.strip_prefix(prefix)?, summary)))?
    };
    found.figures.iter().filter_map(of).collect()
}

fn table(found: &Summaries, set: &str, method: &str) -> Option<String> {
    let mut causes = named(found, set, method, "alone/");
    if causes.is_empty() {
        return None;
    }
    causes.sort_by(|a, b| b.1.value.mean.total_cmp(&a.1.value.mean));
    let get = |name: &str| found.of_set(method, set, Group::Check, name);
    let share = |name: &str| {
        let text = |summary: &Summary| Some(with_half(100.0 * summary.value.mean()?, summary.value.half().map(|half| 100.0 * half), 1));
        get(&format!("share/{name}")).and_then(text).unwrap_or_default()
    };
    let mut rows = MarkdownTable::new(&["cause", "on alone", "off alone", "share, %"]);
    for (cause, alone) in &causes {
        let without = hundredths(get(&format!("without/{cause}")));
        rows.row([(*cause).to_owned(), hundredths(Some(alone)), without, share(cause)]);
    }
    rows.row(["none of them".to_owned(), hundredths(get("none")), hundredths(get("all")), share("none")]);
    rows.row(["beyond their sum".to_owned(), hundredths(get("interactions")), String::new(), share("interactions")]);
    let mut pairs = named(found, set, method, "pair/");
    pairs.sort_by(|a, b| b.1.value.mean.total_cmp(&a.1.value.mean));
    let pair = |(name, summary): &(&str, &Summary)| format!("{} {}", name.replace('+', " with "), fixed(100.0 * summary.value.mean, 2));
    let pairs: Vec<String> = pairs.iter().take(PAIRS).map(pair).collect();
    Some(format!(
        "### {}: {method}\n\nThe planimetric error of check points, root mean square in hundredths of the object unit, mean of {} trials ± half its 95 % interval: with each cause on alone, and with each off while all others are on (in the row \
         *none of them*: all off, all on). *Share*: of the mean square of the whole error, what the cause alone adds, projected on the whole; with what is there without any cause and what all together make beyond their sum the shares are 100 %. \
         A share below zero is a cause that the others make good.\n\n{}\nWhat two causes make beyond the sum of both alone is most for: {}.\n\n",
        set,
        found.trials,
        rows.render(),
        pairs.join(", ")
    ))
}
