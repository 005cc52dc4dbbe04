//! The figures of every method on a rendered scene.

use calibench_records::score::{Errors, Pooled, Score, root};

use super::load::Loaded;
use super::markdown::{MarkdownTable, fixed, signed};

/// Fewer common points than this are not worth a figure.
const FEW: u64 = 10;

/// The section's tables and what their columns mean.
pub fn section(loaded: &Loaded) -> String {
    if let Some(why) = loaded.unavailable() {
        return format!("**unavailable**: {why}.\n");
    }
    let (mut main, mut more) = (MarkdownTable::new(&MAIN), MarkdownTable::new(&MORE));
    let trials = loaded.scores.trials;
    for (info, score) in loaded.head.methods.iter().zip(&loaded.scores.methods) {
        let label = format!("`{}`", info.label);
        match &info.unavailable {
            Some(why) => main.row([label, "unavailable".into(), why.clone()]),
            None => {
                main.row(std::iter::once(label.clone()).chain(main_cells(score)));
                more.row(std::iter::once(label).chain(more_cells(score)));
            }
        }
    }
    let trials = match trials {
        1 => "One trial, without standard errors and intervals".to_owned(),
        _ => format!("{trials} trials"),
    };
    format!(
        "{}\n{trials}, seed {}, errors in px, bounds of a {window} x {window} px window. [What the columns mean]({LEGEND_ANCHOR}).\n\n\
         <details><summary>Bias, scatter, common points, targets</summary>\n\n{}\n{}\n</details>\n",
        main.render(),
        loaded.head.run.seed,
        more.render(),
        by_target(loaded),
        window = loaded.scenario.bound_window
    )
}

/// What is compared.
const MAIN: [&str; 8] = ["method", "points", "rejected", "lost", "RMSE", "95 %", "RMSE / bound (99 %)", "RMSE, lost too"];

/// What explains it.
const MORE: [&str; 7] = ["method", "bias x", "bias y", "scatter", "own sigma / scatter", "RMSE, common", "common points"];

/// The link to [`legend`].
const LEGEND_ANCHOR: &str = "#what-the-columns-mean";

/// What the columns of the tables mean, once for a page.
pub fn legend() -> String {
    let entries = [
        (
            "bias",
            "the mean error over all targets, in which opposite ones cancel (see the tables by target), in px; after \u{b1} stands the standard error from the scatter between trials",
        ),
        ("scatter", "the 2D deviation about the bias"),
        ("RMSE", "`sqrt(mean(dx^2 + dy^2))`, with the interval that holds it at 95 %"),
        (
            "rejected, lost",
            "refused by the method, with its reason; more than 1 px off. Both are counted and not averaged, except under `RMSE, lost too`",
        ),
        (
            "RMSE / bound",
            "`sqrt(mean(e^2 / trace of the bound))` over the kept points, with its 99 % interval. The bound is Cram\u{e9}r and Rao's, of a window in the noise-free image, for the position and \
             what the method estimates beside it. An operator that sees more of the image can be below 1, a biased one too",
        ),
        (
            "own sigma / scatter",
            "the same for the standard deviation that the method itself gives, turned over: 1 is honest, less is too hopeful",
        ),
    ];
    let entries: String = entries.iter().map(|(name, meaning)| format!("- **{name}**: {meaning}.\n")).collect();
    format!(
        "## What the columns mean\n\n{entries}- **common**: the points that every operator measured and none lost, whatever became of `pixel`: only there are operators compared on equal terms, and what \
         the worst of them loses drops out for all; fewer than {FEW} are no basis.\n"
    )
}

/// `value +- standard error`, with as many digits as asked.
fn with_error(pooled: &Pooled, digits: usize) -> String {
    match (pooled.mean(), pooled.standard_error()) {
        (Some(mean), Some(error)) => format!("{} \u{b1} {}", signed(mean, digits), fixed(error, digits)),
        (Some(mean), None) => signed(mean, digits),
        _ => "none".into(),
    }
}

/// The RMSE and, by the delta method, its standard error.
fn rmse_with_error(errors: &Errors, digits: usize) -> String {
    match (errors.rmse(), errors.square.standard_error()) {
        (Some(rmse), Some(error)) if rmse > 0.0 => format!("{} \u{b1} {}", fixed(rmse, digits), fixed(error / (2.0 * rmse), digits)),
        (Some(rmse), _) => fixed(rmse, digits),
        _ => "none".into(),
    }
}

fn main_cells(score: &Score) -> [String; 7] {
    let interval = score.kept.rmse_interval().map_or(String::new(), |(low, high)| format!("{} to {}", fixed(low, 4), fixed(high, 4)));
    [
        score.points().to_string(),
        reasons(score),
        share(score.lost, score.points()),
        score.kept.rmse().map_or("none".into(), |value| fixed(value, 4)),
        interval,
        to_bound(score),
        rmse_with_error(&score.whole, 4),
    ]
}

fn more_cells(score: &Score) -> [String; 6] {
    let common = score.common.square.count();
    [
        with_error(&score.kept.dx, 4),
        with_error(&score.kept.dy, 4),
        score.kept.scatter().map_or("none".into(), |value| fixed(value, 4)),
        to_predicted(score),
        if common < FEW { "too few".into() } else { rmse_with_error(&score.common, 4) },
        common.to_string(),
    ]
}

/// `1.02 (0.99 to 1.05)`, or nothing where there is no bound.
fn to_bound(score: &Score) -> String {
    match root(&score.to_bound, 0.99) {
        None => String::new(),
        Some((ratio, None)) => fixed(ratio, 3),
        Some((ratio, Some((low, high)))) => format!("{} ({} to {})", fixed(ratio, 3), fixed(low, 3), fixed(high, 3)),
    }
}

/// What the method says of its own scatter.
fn to_predicted(score: &Score) -> String {
    root(&score.to_predicted, 0.99).filter(|(ratio, _)| *ratio > 0.0).map_or(String::new(), |(ratio, _)| fixed(1.0 / ratio, 3))
}

/// A count and its share with the standard error of the binomial.
fn share(count: u64, of: u64) -> String {
    if count == 0 || of == 0 {
        return count.to_string();
    }
    let part = count as f64 / of as f64;
    format!("{count} ({:.1} \u{b1} {:.1} %)", 100.0 * part, 100.0 * (part * (1.0 - part) / of as f64).sqrt())
}

/// Rejected points, by reason.
pub fn reasons(score: &Score) -> String {
    if score.rejected.is_empty() {
        return "0".into();
    }
    score.rejected.iter().map(|(why, count)| format!("{count} {why}")).collect::<Vec<_>>().join(", ")
}

/// Bias and RMSE of each method on each target, lost points too.
fn by_target(loaded: &Loaded) -> String {
    let trials = loaded.scores.trials;
    if trials < 2 {
        return String::new();
    }
    let available = || loaded.head.methods.iter().zip(&loaded.scores.methods).filter(|(info, _)| info.unavailable.is_none());
    let targets = available().next().map_or(&[][..], |(_, score)| &score.targets);
    let table = |title: &str, cell: &dyn Fn(&Errors, u64) -> String| {
        let of = |score: &Score, index: usize| score.targets.get(index).map_or(String::new(), |t| cell(&t.whole, t.failed));
        let labels: Vec<String> = available().map(|(info, _)| format!("`{}`", info.label)).collect();
        let names: Vec<String> = targets.iter().map(|target| target.target.to_string()).collect();
        // The longer list goes down the page.
        let down = labels.len() > names.len();
        let header: Vec<&str> = std::iter::once(title).chain(if down { &names } else { &labels }.iter().map(String::as_str)).collect();
        let mut rows = MarkdownTable::new(&header);
        if down {
            for (label, (_, score)) in labels.iter().zip(available()) {
                rows.row(std::iter::once(label.clone()).chain((0..names.len()).map(|index| of(score, index))));
            }
        } else {
            for (index, name) in names.iter().enumerate() {
                rows.row(std::iter::once(name.clone()).chain(available().map(|(_, score)| of(score, index))));
            }
        }
        rows.render()
    };
    let bias = table("bias x; bias y", &|errors, _| format!("{}; {}", with_error(&errors.dx, 3), with_error(&errors.dy, 3)));
    let rmse = table("RMSE (failed)", &|errors, failed| {
        let rmse = rmse_with_error(errors, 4);
        if failed > 0 { format!("{rmse} ({failed})") } else { rmse }
    });
    let by = if loaded.scores.groups.is_empty() { "target" } else { "kind of target" };
    format!("By {by}, lost points too, over {trials} trials; in brackets how many points were lost or rejected:\n\n{bias}\n{rmse}")
}
