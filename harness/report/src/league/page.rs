//! The pages of the league.

use super::CLASSES;
use super::calls::calls;
use super::cells::{AS_GOOD, Cell, HONEST, Honesty, League};
use super::picture::{px, short};
use super::versions::pairs;
use crate::markdown::{MarkdownTable, contents, fixed};
use crate::plot::Figure;
use calibench_images::natural;

/// Systems that the first sentence names.
const LEADS: usize = 5;
/// The class in which nothing is wrong.
const GOOD: &str = "good";
/// What ours are called.
const OURS: &str = "calibench";

/// The first page: which system, for which case; `held_out` is the section on photographs.
pub fn first(league: &League, held_out: &str, figure: &Figure) -> String {
    let (trials, asked) = counts(league);
    let mut text = format!(
        "# League of calibration systems\n\n**{}**\n\n{asked} cells of {} calibrators and {} classes, {trials} calibrations; all get the same points in every trial. \
         Ours is among them: docs/BIAS.md of calibench says how that was kept fair. [Every class]({CLASSES}) with intervals, lengths, honesty, time and memory.\n\n",
        answer(league),
        league.calibrators.len(),
        league.classes.len(),
    );
    text.push_str(&format!("![{}]({})\n\n*{}*\n\n", figure.caption, figure.file(), figure.caption));
    text.push_str("## Which, for my case\n\n");
    text.push_str(&which(league));
    text.push_str("\n## What each says of itself\n\n");
    text.push_str(&honesty(league));
    text.push_str(held_out);
    text.push_str(&calls(league));
    text.push_str("\n## Versions of one system\n\n");
    text.push_str(&versions(league));
    text.push_str("\n## What the numbers mean\n\n");
    text.push_str(&meaning());
    text
}

fn counts(league: &League) -> (usize, usize) {
    let cells = (0..league.classes.len()).flat_map(|class| league.asked(class));
    cells.fold((0, 0), |(trials, cells), (_, cell)| (trials + cell.trials, cells + 1))
}

/// The page's answer in a sentence or two.
fn answer(league: &League) -> String {
    let all = league.classes.len();
    let good: Vec<Vec<usize>> = (0..all).map(|class| league.as_good(class)).collect();
    let mut leads: Vec<(usize, usize)> =
        (0..league.calibrators.len()).map(|one| (one, good.iter().filter(|places| places.contains(&one)).count())).collect();
    leads.sort_by_key(|(place, count)| (std::cmp::Reverse(*count), *place));
    // Of each system that call which is in most.
    let mut systems: Vec<&str> = Vec::new();
    leads.retain(|(one, count)| {
        let system = league.calibrators[*one].system.as_str();
        *count > 0 && !systems.contains(&system) && {
            systems.push(system);
            true
        }
    });
    let told: Vec<String> =
        leads.iter().take(LEADS).map(|(one, count)| format!("`{}` in {count}", league.calibrators[*one].name)).collect();
    let silent = |place: &usize| (0..all).filter_map(|class| league.cell(class, *place)).map(Cell::silent).sum::<usize>() > 0;
    let systems = (0..league.calibrators.len()).filter(silent).count();
    format!(
        "As good as the best of a class, with a camera in as many trials and never wrong without a word: {} of {all} classes. {systems} of {} calibrators are wrong and silent somewhere.",
        told.join(", "),
        league.calibrators.len()
    )
}

fn which(league: &League) -> String {
    let mut rows = MarkdownTable::new(&["class", "asked for", "best, px", "as good as the best", "wrong and silent"]);
    for (place, class) in league.classes.iter().enumerate() {
        let best = league.best(place).and_then(|best| league.cell(place, best)?.frame());
        let name = |one: &usize| {
            let doubted = league.cell(place, *one).filter(|cell| cell.ended[1] > 0);
            let doubted = doubted.map_or_else(String::new, |cell| format!(" (doubts {:.0} %)", cell.percent(cell.ended[1])));
            format!("`{}`{doubted}", league.calibrators[*one].name)
        };
        let share = |one: &usize| league.cell(place, *one).map_or(0.0, |cell| cell.percent(cell.silent()));
        let mut silent: Vec<usize> = league.asked(place).filter(|(_, cell)| cell.silent() > 0).map(|(one, _)| one).collect();
        silent.sort_by(|a, b| share(b).total_cmp(&share(a)));
        let told = by_system(league, &silent, |one| format!("`{}` {:.0} %", league.calibrators[*one].name, share(one)));
        let mut good = league.as_good(place);
        good.sort_by(|a, b| {
            let [a, b] = [a, b].map(|place| &league.calibrators[*place]);
            a.system.cmp(&b.system).then(natural(&b.version, &a.version)).then(a.name.len().cmp(&b.name.len()))
        });
        rows.row([
            format!("[{}]({CLASSES}#{})", short(&class.class), crate::markdown::anchor(short(&class.class))),
            format!("`{}`", class.model),
            best.map_or_else(|| "none".to_owned(), |(median, [low, high])| format!("{} ({} to {})", px(median), px(low), px(high))),
            by_system(league, &good, name),
            told,
        ]);
    }
    rows.render()
}

/// Names, system by system: where there are more than two of one, the first, and how many more there are.
fn by_system(league: &League, places: &[usize], name: impl Fn(&usize) -> String) -> String {
    let system = |place: &usize| league.calibrators[*place].system.as_str();
    let mut systems: Vec<&str> = Vec::new();
    for one in places.iter().map(system) {
        if !systems.contains(&one) {
            systems.push(one);
        }
    }
    let of = |one: &str| {
        let own: Vec<&usize> = places.iter().filter(|place| system(place) == one).collect();
        match own[..] {
            [first, _, _, ..] => format!("{} and {} more of {one}", name(first), own.len() - 1),
            _ => own.into_iter().map(&name).collect::<Vec<_>>().join(", "),
        }
    };
    systems.into_iter().map(of).collect::<Vec<_>>().join(", ")
}

fn honesty(league: &League) -> String {
    let mut rows = MarkdownTable::new(&[
        "calibrator",
        "system",
        "version",
        "honest",
        "cautious",
        "overconfident",
        "states nothing",
        "wrong and silent, %",
        "RMS in `good`, px",
        "seconds",
    ]);
    for (place, one) in league.calibrators.iter().enumerate() {
        let cells: Vec<&Cell> =
            (0..league.classes.len()).filter_map(|class| league.cell(class, place)).filter(|cell| cell.trials > 0).collect();
        let of = |honesty: Honesty| cells.iter().filter(|cell| cell.honesty() == honesty).count().to_string();
        let (silent, trials) = cells.iter().fold((0, 0), |(silent, trials), cell| (silent + cell.silent(), trials + cell.trials));
        let good = league.classes.iter().position(|class| short(&class.class) == GOOD).and_then(|class| league.cell(class, place));
        let mut seconds: Vec<f64> = cells.iter().filter_map(|cell| cell.seconds()).collect();
        seconds.sort_by(f64::total_cmp);
        rows.row([
            format!("`{}`", one.name),
            one.system.clone(),
            one.version.clone(),
            of(Honesty::Honest),
            of(Honesty::Cautious),
            of(Honesty::Overconfident),
            of(Honesty::Silent),
            format!("{:.1}", 100.0 * silent as f64 / f64::max(trials as f64, 1.0)),
            good.and_then(Cell::rms).map_or_else(String::new, |rms| fixed(rms, 3)),
            seconds.get(seconds.len() / 2).map_or_else(String::new, |seconds| fixed(*seconds, 3)),
        ]);
    }
    format!(
        "Classes by what the mean square of errors in stated standard deviations is there; the RMS of residuals as each states it where every coordinate has 0.1 px of noise \
         (0.14 is a distance, 0.10 a coordinate, less is without redundancy); the median of a calibration's processor time.\n\n{}",
        rows.render()
    )
}

fn versions(league: &League) -> String {
    let mut lines = Vec::new();
    for pair in pairs(league) {
        let [a, b] = pair.places.map(|place| &league.calibrators[place]);
        let what = format!("`{}` {} and `{}` {}", a.name, a.version, b.name, b.version);
        if pair.differing.is_empty() {
            lines.push(format!("- {what}: the same numbers in all {} classes.", pair.classes));
            continue;
        }
        let told = pair.differing.iter().map(|(class, ratio)| {
            let ratio = ratio.map_or_else(String::new, |(ratio, [low, high])| format!(" ({ratio:.2} times, {low:.2} to {high:.2})"));
            format!("{}{ratio}", short(&league.classes[*class].class))
        });
        lines.push(format!(
            "- {what}: other numbers in {} of {} classes: {}.",
            pair.differing.len(),
            pair.classes,
            told.collect::<Vec<_>>().join(", ")
        ));
    }
    if lines.is_empty() { "Of no system two versions were asked in one configuration.\n".to_owned() } else { lines.join("\n") + "\n" }
}

fn meaning() -> String {
    format!(
        "- **px**: distance from the true camera over the whole frame after the best rotation, RMS (2D) on a grid; the median over trials, with its 95 % interval by order statistics.\n\
         - **trials**: those of the class, and 300 of whoever takes less than 0.2 s of a processor for each; the best is the best of those that all have, and others are held against it by those that both have.\n\
         - **as good as the best**: errors of the same trials in pairs; the geometric mean of their ratio to the best is not shown to be above {AS_GOOD} (t-test, Holm over the calibrators of a class, 5 %), cameras in as many trials, never wrong and silent; what it doubted itself stands behind its name.\n\
         - **wrong and silent**: a camera, no word against it, and farther off than five of its stated standard deviations and than 1 px (than 1 px, where nothing is stated).\n\
         - **honest**: the 95 % interval of the mean square of errors in stated standard deviations meets {} to {}; over the frame where a covariance is stated, of the parameters where standard deviations alone are.\n\
         - **not comparable**: a camera that does not picture all of the frame. In the tables of classes calibench's own are bold.\n\
         - One cell again: `calibench league CLASS --system NAME --fresh`. Made by `calibench report league` from `reference/league`.\n",
        HONEST[0], HONEST[1]
    )
}

/// Every class with every calibrator.
pub fn classes(league: &League) -> String {
    let mut text = String::new();
    for (place, class) in league.classes.iter().enumerate() {
        text.push_str(&format!("## {}\n\n{} Asked for: `{}`.\n\n", short(&class.class), class.why.trim(), class.model));
        text.push_str(&table(league, place));
        text.push_str(&unavailable(league, place));
        text.push('\n');
    }
    format!("# Every class of the league\n\n[The league](README.md) says what the columns mean.\n\n{}{text}", contents(&text))
}

fn table(league: &League, class: usize) -> String {
    let header = [
        "calibrator",
        "trials",
        "px",
        "95 %",
        "times the best",
        "where measured, px",
        "100 mm, mm",
        "z²",
        "",
        "doubtful, %",
        "refused, %",
        "failed, %",
        "not comparable, %",
        "wrong and silent, %",
        "s",
        "MB",
        "says",
    ];
    let mut rows = MarkdownTable::new(&header);
    let best = league.best(class);
    let mut asked: Vec<(usize, &Cell)> = league.asked(class).collect();
    let key = |cell: &Cell| cell.frame().map_or(f64::INFINITY, |(median, _)| median);
    asked.sort_by(|a, b| key(a.1).total_cmp(&key(b.1)));
    for (place, cell) in asked {
        let Some((median, [low, high])) = cell.frame() else { continue };
        let ratio = best.and_then(|best| league.ratio(class, [place, best])).map_or_else(String::new, |(ratio, [low, high])| {
            if Some(place) == best { String::new() } else { format!("{ratio:.2} ({low:.2} to {high:.2})") }
        });
        let z2 = cell.z2().map_or_else(String::new, |(mean, half, parameters)| {
            let half = half.map_or_else(String::new, |half| format!(" ± {}", few(half)));
            format!("{}{half}{}", few(mean), if parameters { " (parameters)" } else { "" })
        });
        let percent = |count: usize| if count == 0 { String::new() } else { format!("{:.0}", cell.percent(count)) };
        let mm = |value: Option<f64>| value.map_or_else(String::new, |value| fixed(value, 3));
        let bold = if league.calibrators[place].system == OURS { "**" } else { "" };
        rows.row([
            format!("{bold}`{}`{bold}", league.calibrators[place].name),
            cell.trials.to_string(),
            precise(median),
            format!("{} to {}", precise(low), precise(high)),
            ratio,
            cell.covered().map_or_else(String::new, precise),
            mm(cell.length()),
            z2,
            cell.honesty().word().to_owned(),
            percent(cell.ended[1]),
            percent(cell.ended[2]),
            percent(cell.ended[3]),
            percent(cell.incomparable()),
            percent(cell.silent()),
            mm(cell.seconds()),
            cell.peak.map_or_else(String::new, |mb| fixed(mb, 0)),
            said(cell),
        ]);
    }
    rows.render()
}

/// What was said most often, if it was said often.
pub fn said(cell: &Cell) -> String {
    const LONGEST: usize = 90;
    let Some((text, count)) = cell.said().filter(|(_, count)| 10 * count >= cell.trials) else { return String::new() };
    let start: String = text.chars().take(LONGEST).collect();
    let more = if start.len() < text.len() { "…" } else { "" };
    format!("{count} times: {}{more}", calibench_model::escape::markdown(&start))
}

pub fn precise(value: f64) -> String {
    match value {
        value if !value.is_finite() => "none".to_owned(),
        value if value < 10.0 => fixed(value, 3),
        value => fixed(value, 1),
    }
}

/// A number to few digits, however large.
fn few(value: f64) -> String {
    if value < 100.0 { fixed(value, 2) } else { format!("{value:.1e}") }
}

fn unavailable(league: &League, class: usize) -> String {
    let names: Vec<String> = (0..league.calibrators.len())
        .filter(|one| league.cell(class, *one).is_some_and(|cell| cell.unavailable.is_some()))
        .map(|one| format!("`{}`", league.calibrators[one].name))
        .collect();
    if names.is_empty() { String::new() } else { format!("\nNot asked, for want of the model: {}.\n", names.join(", ")) }
}
