//! The figures of every method on a rendered scene.

use calibench_records::description::is_limited;
use calibench_records::score::{Errors, Pooled, Score, root};

use super::load::Loaded;
use super::markdown::{MarkdownTable, fixed, signed};
use super::room;

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
    let kinds = if loaded.head.methods.iter().any(|info| is_limited(&info.label)) { KINDS } else { "" };
    let room = room::sentence(&loaded.scenario, loaded.head.methods.iter().map(|info| &*info.label));
    format!(
        "{}\n{room}{kinds}{trials}, seed {}, errors in px, bounds of a {window} x {window} px window{discs}. [What the columns mean]({LEGEND_ANCHOR}).\n\n\
         <details><summary>Bias, scatter, common points, targets</summary>\n\n{}\n{}\n</details>\n",
        main.render(),
        loaded.head.run.seed,
        more.render(),
        by_target(loaded),
        window = loaded.scenario.bound_window,
        discs = loaded.scenario.bound_window_discs.map_or_else(String::new, |window| format!(", of discs {window} x {window} px")),
    )
}

/// What is to be known where methods measure different targets.
const KINDS: &str = "Methods with `kinds` measured targets of these kinds alone, so that rows stand on different points; a point is common if all methods that were to \
                     measure it did.\n\n";

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
    // Limited methods have only their own targets.
    let mut targets: Vec<&str> = Vec::new();
    for target in available().flat_map(|(_, score)| &score.targets) {
        if !targets.contains(&&*target.target) {
            targets.push(&target.target);
        }
    }
    let table = |title: &str, cell: &dyn Fn(&Errors, u64) -> String| {
        let of = |score: &Score, name: &str| {
            score.targets.iter().find(|target| &*target.target == name).map_or(String::new(), |t| cell(&t.whole, t.failed))
        };
        let labels: Vec<String> = available().map(|(info, _)| format!("`{}`", info.label)).collect();
        let names: Vec<String> = targets.iter().map(|&target| target.to_owned()).collect();
        // The longer list goes down the page.
        let down = labels.len() > names.len();
        let header: Vec<&str> = std::iter::once(title).chain(if down { &names } else { &labels }.iter().map(String::as_str)).collect();
        let mut rows = MarkdownTable::new(&header);
        if down {
            for (label, (_, score)) in labels.iter().zip(available()) {
                rows.row(std::iter::once(label.clone()).chain(names.iter().map(|name| of(score, name))));
            }
        } else {
            for name in &names {
                rows.row(std::iter::once(name.clone()).chain(available().map(|(_, score)| of(score, name))));
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

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use calibench_records::description::{Description, Study};
    use calibench_records::points::{RecordHead, RunInfo};
    use calibench_records::results::{MethodInfo, Trial};
    use calibench_records::score::{Scores, TargetScore};

    use super::*;
    use crate::tests::small::row;

    fn pooled(values: &[f64]) -> Pooled {
        let mut pooled = Pooled::default();
        values.iter().for_each(|value| pooled.add(&[*value]));
        pooled
    }

    fn errors(trials: &[(f64, f64)]) -> Errors {
        let mut errors = Errors::default();
        trials.iter().for_each(|error| errors.add(&[*error]));
        errors
    }

    /// 1 and 4: mean 2.5, standard error 1.5.
    #[test]
    fn means_stand_beside_their_standard_errors() {
        assert_eq!(with_error(&pooled(&[1.0, 4.0]), 2), "+2.50 \u{b1} 1.50");
        assert_eq!((with_error(&pooled(&[-1.0]), 1), with_error(&Pooled::default(), 1)), ("-1.0".into(), "none".into()));
    }

    /// Squares 1 and 4: the root of 2.5 is 1.5811, its standard error 1.5 / (2 * 1.5811) = 0.4743.
    #[test]
    fn the_error_of_a_root_is_that_of_the_square_over_twice_the_root() {
        assert_eq!(rmse_with_error(&errors(&[(1.0, 0.0), (0.0, -2.0)]), 4), "1.5811 \u{b1} 0.4743");
        assert_eq!(rmse_with_error(&errors(&[(0.0, 0.0), (0.0, 0.0)]), 2), "0.00", "exact");
        assert_eq!((rmse_with_error(&errors(&[(3.0, 4.0)]), 1), rmse_with_error(&Errors::default(), 1)), ("5.0".into(), "none".into()));
    }

    /// 1 of 4 is 25 %, with a standard error of sqrt(1/4 * 3/4 / 4).
    #[test]
    fn shares_have_the_error_of_the_binomial() {
        assert_eq!(share(1, 4), "1 (25.0 \u{b1} 21.7 %)");
        assert_eq!(
            (share(0, 4), share(0, 0), share(3, 0), share(2, 2)),
            ("0".into(), "0".into(), "3".into(), "2 (100.0 \u{b1} 0.0 %)".into())
        );
    }

    /// The bound: squares 4 and 9, t(0.995, 1) = 63.66: the lower end is cut at 0. Its own sigma: the root of the mean square is 2.5.
    #[test]
    fn ratios_are_roots_and_a_hopeful_sigma_is_less_than_one() {
        let score = |squares: &[f64]| Score { to_bound: pooled(squares), to_predicted: pooled(squares), ..Score::default() };
        let high = (6.5_f64 + 63.656_741 * 2.5).sqrt();
        assert_eq!(to_bound(&score(&[4.0, 9.0])), format!("2.550 (0.000 to {high:.3})"));
        assert_eq!((to_bound(&score(&[6.25])), to_bound(&score(&[]))), ("2.500".into(), String::new()));
        assert_eq!(
            (to_predicted(&score(&[6.25])), to_predicted(&score(&[0.0])), to_predicted(&score(&[]))),
            ("0.400".into(), String::new(), String::new())
        );
    }

    #[test]
    fn ten_common_points_are_a_basis_and_nine_are_none() {
        let cells = |count: usize| {
            let common = errors(&vec![(0.3, 0.4); count]);
            more_cells(&Score { common, ..Score::default() })
        };
        assert_eq!(cells(9)[4..], ["too few", "9"]);
        assert_eq!(cells(10)[4..], ["0.5000 \u{b1} 0.0000", "10"]);
        assert_eq!(cells(10)[..4], ["none", "none", "none", ""]);
    }

    #[test]
    fn points_are_counted_by_what_became_of_them() {
        let mut score = Score { measured: 6, lost: 1, rejected: [("border", 2), ("flat", 1)].into(), ..Score::default() };
        score.kept = errors(&[(0.3, 0.4)]);
        score.whole = errors(&[(3.0, 4.0)]);
        let expected = ["10", "2 border, 1 flat", "1 (10.0 \u{b1} 9.5 %)", "0.5000", "", "", "5.0000"];
        assert_eq!(main_cells(&score), expected);
        assert_eq!(reasons(&Score::default()), "0");
    }

    /// One method of a scenario by target, over so many trials: the longer list goes down.
    fn loaded(labels: &[&str], targets: &[&str], trials: u64) -> Loaded {
        let target = |name: &&str| TargetScore { target: (*name).into(), whole: errors(&[(0.3, 0.4)]), failed: u64::from(*name == "b") };
        let score = Score { targets: targets.iter().map(target).collect(), ..Score::default() };
        let info = |label: &&str| MethodInfo { label: (*label).into(), version: "1".into(), unavailable: None };
        let scenario = Description {
            why: String::new(),
            source: String::new(),
            notes: Vec::new(),
            seed: 1,
            trials,
            bound_window: 11,
            bound_window_discs: None,
            finders: Vec::new(),
            methods: Vec::new(),
            defaults: [].into(),
            study: Study::Scene,
            sweep: None,
        };
        Loaded {
            name: "s".into(),
            scenario,
            head: RecordHead { run: RunInfo::default(), methods: labels.iter().map(info).collect() },
            scores: Scores { methods: vec![score; labels.len()], trials, ..Scores::default() },
            first: Trial::default(),
            calibrations: None,
            folder: PathBuf::new(),
        }
    }

    #[test]
    fn the_longer_of_methods_and_targets_goes_down_the_page() {
        let text = by_target(&loaded(&["m", "n"], &["a", "b"], 2));
        assert_eq!(row(&text, &["b", "0.5000 (1)"]), ["b", "0.5000 (1)", "0.5000 (1)"], "as many: targets");
        assert_eq!(row(&text, &["a"]), ["a", "+0.300; +0.400", "+0.300; +0.400"]);
        let text = by_target(&loaded(&["m", "n", "k"], &["a", "b"], 2));
        assert_eq!(row(&text, &["`k`", "0.5000"]), ["`k`", "0.5000", "0.5000 (1)"]);
        let text = by_target(&loaded(&["m"], &["a", "b"], 2));
        assert_eq!(row(&text, &["a", "0.5000"]), ["a", "0.5000"]);
        assert_eq!(by_target(&loaded(&["m"], &["a"], 1)), "", "one trial has no scatter");
        let mut limited = loaded(&["m", "n:kinds=disc"], &["a", "b"], 2);
        limited.scores.methods[0].targets.remove(1);
        limited.scores.methods[1].targets.remove(0);
        let text = by_target(&limited);
        assert_eq!(row(&text, &["a", "0.5000"]), ["a", "0.5000", ""], "each stands with its own target");
        assert_eq!(row(&text, &["b", "", "0.5000 (1)"]).len(), 3);
        let page = section(&limited);
        assert!(page.contains("Methods with `kinds` measured targets of these kinds alone"), "{page}");
        assert!(!section(&loaded(&["m", "n"], &["a"], 2)).contains("Methods with `kinds`"));
    }

    #[test]
    fn nobody_leads_among_methods_for_different_targets() {
        let said = |labels: &[&str]| {
            let mut found = loaded(labels, &["a"], 2);
            let score = Score { measured: 2, kept: errors(&[(0.3, 0.4), (0.3, 0.4)]), ..Score::default() };
            found.scores.methods = vec![score; labels.len()];
            let mut answers = crate::answer::Answers::default();
            answers.scenario(&found);
            answers.paragraph()
        };
        assert_eq!(said(&["pixel", "m"]), "`m` has the least error, 0.500 px RMSE.");
        assert_eq!(said(&["pixel", "m", "n:kinds=disc"]), "");
    }

    #[test]
    fn one_trial_is_said_to_have_no_intervals() {
        assert!(section(&loaded(&["m"], &["a"], 1)).contains("One trial, without standard errors"));
        assert!(section(&loaded(&["m"], &["a"], 2)).contains("\n2 trials, seed 0"));
    }
}
