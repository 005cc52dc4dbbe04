//! The verdict in words, every one of them derived from the records.

use calibench_model::{escape, upper_median};
use calibench_records::judgement::{
    ALPHA, Beside, Cell, Estimate, HONEST, InUse, MARGIN_PX, Measured, OUTLIER_ALPHA, Published, Standing, StillHolds, Summary, Trusted,
};

use super::board;
use super::words::{chance, interval, listed};
use crate::markdown::fixed;
use crate::plain;

/// Share of the corners below which it is said on how many operators are compared.
const ALL_BUT: f64 = 0.98;

/// Which operator and which model, and how far.
pub fn verdict(summary: &Summary, trusted: &Trusted<'_>) -> String {
    let (cell, least) = (trusted.cell, trusted.least);
    let share = trusted.board();
    let mut lines: Vec<String> = share.iter().filter_map(|share| board::first(share, cell)).collect();
    lines.push(format!(
        "**Of these images trust `{}` with the model `{}`.** It predicts corners of photographs that took no part in the calibration to {}.",
        cell.method,
        cell.model,
        cell.holdout.map_or_else(String::new, |holdout| interval(&holdout))
    ));
    lines.extend(trusted.doubt().map(|why| format!("**In doubt**: {why}. Its limits do not hold.")));
    lines.push(format!(
        "**Operators**, with `{}`: {}{}{}",
        least.model,
        ranking(&trusted.operators, &least.method, |cell| (&cell.method, cell.holdout)),
        without(" Not judged with it: ", &trusted.unjudged, |cell| &cell.method),
        silent(summary)
    ));
    lines.extend(compared_on(summary));
    lines.push(models(trusted));
    lines.extend(share.and_then(|share| board::share(&share, cell)));
    lines.extend(how_far(trusted));
    lines.extend(beyond(summary, trusted));
    lines.push(outlying(cell));
    lines.extend(published(trusted));
    lines.push(
        "**What cannot be seen here**: an error that a camera of the same model can imitate, or that all photographs share with the field (points displaced \
         alike, a board that is not of the size given, coordinates that are not right), predicts itself. The pose of a photograph is resected from the other half of its corners."
            .into(),
    );
    lines.iter().map(|line| format!("- {line}\n")).collect()
}

/// Whether a camera in use still holds, in a sentence.
pub fn in_use(found: &InUse) -> String {
    let InUse { verdict, apart, error, margin } = found;
    let says = match verdict {
        StillHolds::Holds => "holds",
        StillHolds::Moved => "has moved",
        StillHolds::CannotTell => "cannot tell",
    };
    let known = if error.is_finite() {
        format!("which these photographs know to {} px in 99 of 100 cases", plain(*error))
    } else {
        "which these photographs cannot know: they are in doubt themselves".into()
    };
    format!(
        "**{says}**: the camera in use differs from the one of these photographs by {} px RMS over the frame after the best rotation, {known}; it holds up to {margin} px.",
        plain(*apart)
    )
}

/// Corners that some operator lost decide what the others are compared on: what is hard to measure is hard for all.
fn compared_on(summary: &Summary) -> Option<String> {
    let compared = || summary.methods.iter().filter(|method| summary.is_compared(&method.method));
    let of = compared().map(|method| method.of).max()?;
    if summary.common as f64 >= ALL_BUT * of as f64 {
        return None;
    }
    let lost = compared().filter(|method| method.found < method.of);
    let lost: Vec<String> = lost.map(|method| format!("`{}` {}", method.method, method.of - method.found)).collect();
    Some(format!(
        "**Compared on** {} of {of} corners, which all of them measured. Not measured were: {}; the figures of the others do not hold for these.",
        summary.common,
        listed(&lost)
    ))
}

fn ranking(others: &[(&Cell, f64)], best: &str, of: impl Fn(&Cell) -> (&str, Option<Estimate>)) -> String {
    let rms = |cell: &Cell| of(cell).1.map_or_else(String::new, |found| plain(found.value));
    let name = |cell: &Cell| of(cell).0.to_owned();
    let alike: Vec<String> =
        others.iter().filter(|(_, p)| *p > ALPHA).map(|(cell, _)| format!("`{}` ({} px)", name(cell), rms(cell))).collect();
    let worse: Vec<String> = others
        .iter()
        .filter(|(_, p)| *p <= ALPHA)
        .map(|(cell, p)| format!("`{}` ({} px, {})", name(cell), rms(cell), chance(*p)))
        .collect();
    if others.is_empty() {
        return format!("`{best}` has no other beside it.");
    }
    let mut text = format!("`{best}` has the least RMS.");
    text.push_str(&match alike.len() {
        0 => " None of the others is as good.".to_owned(),
        _ => format!(" Not to be told from it: {}.", listed(&alike)),
    });
    if !worse.is_empty() {
        text.push_str(&format!(" Worse: {}.", listed(&worse)));
    }
    text
}

/// Which models predict best, and what is lost with the one that is trusted.
fn models(trusted: &Trusted<'_>) -> String {
    let mut by_share: Vec<&Standing<'_>> = trusted.models.iter().filter(|standing| standing.share > 0.0).collect();
    by_share.sort_by(|a, b| b.share.total_cmp(&a.share));
    let share = |share: f64| if share < 0.01 { "below 1 %".into() } else { format!("{:.0} %", 100.0 * share) };
    let best: Vec<String> = by_share.iter().map(|standing| format!("`{}` in {}", standing.cell.model, share(standing.share))).collect();
    let own = trusted.models.iter().find(|standing| standing.cell == trusted.cell);
    let loss = own.and_then(|own| own.loss).filter(|loss| *loss > 0.0).map_or_else(String::new, |loss| {
        format!(
            " The camera with `{}` differs from that of the best model of each draw by {} px (RMS over the whole frame and all draws): so large an error is to be \
             expected for not knowing the true model.",
            trusted.cell.model,
            plain(loss)
        )
    });
    let simpler = match own {
        Some(own) if own.share < by_share.first().map_or(0.0, |best| best.share) => {
            format!(" It is chosen since least is lost with it, or for being simpler and the same within {MARGIN_PX} px.")
        }
        _ => String::new(),
    };
    format!(
        "**Models**, with `{}`: of photographs drawn again those not seen are predicted best, parameters allowed for, by {}.{loss}{simpler}{}",
        trusted.cell.method,
        listed(&best),
        without(" Not judged: ", &trusted.left_out, |cell| &cell.model)
    )
}

/// Cameras that could not be judged, and why.
fn without(before: &str, cells: &[&Cell], name: impl Fn(&Cell) -> &str) -> String {
    let why = |cell: &Cell| cell.trouble.as_deref().unwrap_or("not all photographs are predicted").to_owned();
    let each: Vec<String> = cells.iter().map(|cell| format!("`{}` ({})", name(cell), escape::markdown(&why(cell)))).collect();
    if each.is_empty() { String::new() } else { format!("{before}{}.", listed(&each)) }
}

/// Operators that measured nothing: they are missing above.
fn silent(summary: &Summary) -> String {
    let why = |method: &Measured| match (&method.unavailable, method.rejected.iter().max_by_key(|(_, count)| **count)) {
        (Some(why), _) => format!("unavailable: {}", escape::markdown(why)),
        (None, Some((reason, count))) => format!("{count} of {} points rejected, {}", method.of, escape::markdown(reason)),
        (None, None) => format!("none of {} points", method.of),
    };
    let nothing = summary.methods.iter().filter(|method| method.found == 0);
    let each: Vec<String> = nothing.map(|method| format!("`{}` ({})", method.method, why(method))).collect();
    if each.is_empty() { String::new() } else { format!(" **Measured nothing**: {}.", listed(&each)) }
}

fn how_far(trusted: &Trusted<'_>) -> Option<String> {
    let cell = trusted.cell;
    let (centre, corner) = cell.uncertainty?;
    let over = trusted.limit.zip(cell.predicted).map_or_else(String::new, |(limit, predicted)| {
        let by_views = predicted.by_views.map_or_else(String::new, |by_views| format!(", {} px by leaving photographs out", plain(by_views)));
        format!(
            " over the whole frame the camera is within {} px RMS of the truth in 95 of 100 cases, after the best rotation (standard deviation {} px{by_views});",
            plain(limit),
            plain(predicted.formal)
        )
    });
    let mut text = format!(
        "**How far**:{over} the image of a point far away has a standard deviation of {} px in the centre of the frame and {} px in its worst corner.",
        plain(centre),
        plain(corner)
    );
    let Some(split) = cell.split else { return Some(text + " There were too few photographs to check it by halves.") };
    let found = format!(
        "{} times what the sigmas say over the frame, {} times mode by mode ({} splits, {})",
        fixed(split.ratio(), 2),
        fixed(split.modes, 2),
        split.count,
        chance(split.p)
    );
    let factor = trusted.inflation();
    text.push_str(&if split.p < HONEST {
        format!(
            " Halves of the photographs differ by {found}: **the sigmas are too small**. Enlarged by {}: {} px and {} px.",
            fixed(factor, 2),
            plain(factor * centre),
            plain(factor * corner)
        )
    } else {
        format!(" Halves of the photographs differ by {found}: no more than chance allows, so the sigmas may be believed.")
    });
    Some(text)
}

/// What the other models that predict best in some draws say where no corner was.
fn beyond(summary: &Summary, trusted: &Trusted<'_>) -> Option<String> {
    let cell = trusted.cell;
    let found: Vec<(&Cell, Beside)> =
        trusted.rivals().filter_map(|rival| Some((rival.cell, summary.beside(&cell.method, [&cell.model, &rival.cell.model])?))).collect();
    let (worst, apart) = found.iter().max_by(|a, b| a.1.frame.total_cmp(&b.1.frame))?;
    let seen = found.iter().filter_map(|(_, apart)| apart.seen).reduce(f64::max)?;
    Some(format!(
        "**Beyond the corners** nobody checked: the models that predict best in some of the draws agree with `{}` to {} px RMS or better where corners were \
         measured, but over the whole frame only to {} px RMS, and {} px at most (`{}`). What was photographed decides there, and not the model: see to points \
         in every corner of the frame.",
        cell.model,
        plain(seen),
        plain(apart.frame),
        plain(apart.most),
        worst.model
    ))
}

fn outlying(cell: &Cell) -> String {
    let named: Vec<String> = cell
        .outlying()
        .iter()
        .map(|view| format!("{} ({} px, {})", escape::code(&view.name), plain(view.residual.0), chance(view.p)))
        .collect();
    let middle = upper_median(cell.views.iter().map(|view| view.residual.0)).unwrap_or_default();
    match named.len() {
        0 => format!("**Outlying photographs**: none of {} (alpha {OUTLIER_ALPHA}; median RMS {} px).", cell.views.len(), plain(middle)),
        _ => format!(
            "**Outlying photographs**: {} of {}, where the median is {} px. Look at them, and calibrate without them.",
            listed(&named),
            cell.views.len(),
            plain(middle)
        ),
    }
}

fn published(trusted: &Trusted<'_>) -> Option<String> {
    let Published { beside: Beside { frame, most, seen }, predicted, .. } = trusted.cell.published?;
    let factor = trusted.inflation();
    let told = if frame <= 2.0 * factor * predicted { "within twice" } else { "more than twice" };
    let enlarged = if factor > 1.0 { format!(", enlarged {} px", plain(factor * predicted)) } else { String::new() };
    let seen = seen.map_or_else(String::new, |seen| format!(" Where corners were measured it differs by {} px RMS.", plain(seen)));
    Some(format!(
        "**The published calibration** differs by {} px RMS over the frame after the best rotation, {} px at most: {told} the standard deviation of ours \
         ({} px RMS over the frame{enlarged}).{seen}",
        plain(frame),
        plain(most),
        plain(predicted)
    ))
}
