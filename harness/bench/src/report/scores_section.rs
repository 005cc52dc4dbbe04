//! The figures of every method on a rendered scene.

use super::load::Loaded;
use super::markdown::{MarkdownTable, fixed, signed};
use crate::score::{Score, TargetScore};

/// The section's table and what its columns mean.
pub fn section(loaded: &Loaded) -> String {
    if let Some(why) = loaded.unavailable() {
        return format!("**unavailable**: {why}.\n");
    }
    let mut rows = MarkdownTable::new(&[
        "method",
        "points",
        "rejected",
        "lost",
        "bias x",
        "bias y",
        "scatter",
        "RMSE",
        "95 %",
        "RMSE, lost too",
        "RMSE, common points",
    ]);
    let trials = loaded.scores.trials;
    for (info, score) in loaded.head.methods.iter().zip(&loaded.scores.methods) {
        match &info.unavailable {
            Some(why) => rows.row([format!("`{}`", info.label), "unavailable".into(), why.clone()]),
            None => rows.row(cells(&info.label, score)),
        }
    }
    let interval =
        if trials > 1 { "the interval holds the RMSE at 95 %, from its scatter between trials" } else { "one trial has no interval" };
    format!(
        "{}\n{trials} {}, seed {}. Errors in px: bias is the mean error, scatter the 2D standard deviation about it, RMSE `sqrt(mean(dx^2 + dy^2))`; \
         {interval}. Lost points (more than 1 px off) and rejected ones are counted and not averaged, except under `lost too`; to compare methods, use the common \
         points, which all of them measured and none lost, and the counts beside them.\n\n{}",
        rows.render(),
        if trials == 1 { "trial" } else { "trials" },
        loaded.head.run.seed,
        by_target(loaded)
    )
}

/// RMSE of each method on each target, lost points too, with the number of points that it lost or rejected there.
fn by_target(loaded: &Loaded) -> String {
    let available = || loaded.head.methods.iter().zip(&loaded.scores.methods).filter(|(info, _)| info.unavailable.is_none());
    let mut header = vec!["RMSE by target, lost too".to_owned()];
    header.extend(available().map(|(info, _)| format!("`{}`", info.label)));
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    let targets = available().next().map_or(&[][..], |(_, score)| &score.targets);
    for (index, target) in targets.iter().enumerate() {
        let cell = |score: &Score| match score.targets.get(index) {
            Some(TargetScore { square, failed, .. }) => {
                let rmse = square.mean().map_or("none".to_owned(), |mean| fixed(mean.sqrt(), 4));
                if *failed > 0 { format!("{rmse} ({failed} failed)") } else { rmse }
            }
            None => String::new(),
        };
        rows.row(std::iter::once(target.target.to_string()).chain(available().map(|(_, score)| cell(score))));
    }
    rows.render()
}

fn cells(label: &str, score: &Score) -> Vec<String> {
    let px = |value: Option<f64>| value.map_or("none".into(), |value| fixed(value, 4));
    let bias = |value: Option<f64>| value.map_or("none".into(), |value| signed(value, 4));
    let interval = score.rmse_interval().map_or(String::new(), |(low, high)| format!("{} to {}", fixed(low, 4), fixed(high, 4)));
    vec![
        format!("`{label}`"),
        score.points().to_string(),
        reasons(score),
        share(score.lost, score.points()),
        bias(score.dx.mean()),
        bias(score.dy.mean()),
        px(score.scatter()),
        px(score.rmse()),
        interval,
        px(score.whole_square.mean().map(f64::sqrt)),
        px(score.common_square.mean().map(f64::sqrt)),
    ]
}

fn share(count: u64, of: u64) -> String {
    if count == 0 { "0".into() } else { format!("{count} ({:.1} %)", 100.0 * count as f64 / of as f64) }
}

/// Rejected points, by reason.
pub fn reasons(score: &Score) -> String {
    if score.rejected.is_empty() {
        return "0".into();
    }
    score.rejected.iter().map(|(why, count)| format!("{count} {why}")).collect::<Vec<_>>().join(", ")
}
