//! Which cause makes how much of an error.

use calibench_records::figures::{FigureName, Quantity};

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

/// All figures of a quantity: of what causes each is, in the order of the names.
fn named<'a>(found: &'a Summaries, set: &str, method: &str, quantity: Quantity) -> Vec<(Vec<&'a str>, &'a Summary)> {
    let mine = found.figures.iter().filter(|((m, s, name), _)| m == method && s == set && name.quantity() == quantity);
    mine.map(|((.., name), summary)| (name.parts(), summary)).collect()
}

fn table(found: &Summaries, set: &str, method: &str) -> Option<String> {
    let mut causes = named(found, set, method, Quantity::Alone);
    if causes.is_empty() {
        return None;
    }
    causes.sort_by(|a, b| b.1.value.mean.total_cmp(&a.1.value.mean));
    let get = |figure: FigureName| found.of_set(method, set, figure);
    let whole = |quantity: Quantity| get(quantity.into());
    let share = |name: &str| {
        let text = |summary: &Summary| Some(with_half(100.0 * summary.value.mean()?, summary.value.half().map(|half| 100.0 * half), 1));
        get(Quantity::Share.of(&[name])).and_then(text).unwrap_or_default()
    };
    let mut rows = MarkdownTable::new(&["cause", "on alone", "off alone", "share, %"]);
    for (cause, alone) in &causes {
        let cause = cause.concat();
        let without = hundredths(get(Quantity::Without.of(&[&cause])));
        rows.row([cause.clone(), hundredths(Some(alone)), without, share(&cause)]);
    }
    rows.row(["none of them".to_owned(), hundredths(whole(Quantity::NoCause)), hundredths(whole(Quantity::AllCauses)), share("none")]);
    rows.row(["beyond their sum".to_owned(), hundredths(whole(Quantity::Interactions)), String::new(), share("interactions")]);
    let mut pairs = named(found, set, method, Quantity::PairOfCauses);
    pairs.sort_by(|a, b| b.1.value.mean.total_cmp(&a.1.value.mean));
    let pair = |(causes, summary): &(Vec<&str>, &Summary)| format!("{} {}", causes.join(" with "), fixed(100.0 * summary.value.mean, 2));
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
